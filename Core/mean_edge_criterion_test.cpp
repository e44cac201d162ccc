// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mean_edge_criterion.h"

#include "hash_queue_decimation.h"
#include "testing/decimated.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace undecimate
{
namespace
{

using testing::Mesh;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

NodalArrayView viewOf(const std::vector<float>& values, int components = 1)
{
  NodalArrayView view;
  view.values = values.data();
  view.components = components;
  view.name = "Result";
  return view;
}

/// Mean over the neighbours of a node, found by going through all triangles.
template <typename Quantity>
double meanOverNeighbours(const std::vector<Index>& triangles, Index node, Quantity&& quantity)
{
  std::set<Index> neighbours;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      if (triangles[i + c] == node)
      {
        neighbours.insert(triangles[i + (c + 1) % 3]);
        neighbours.insert(triangles[i + (c + 2) % 3]);
      }
    }
  }
  double sum = 0.0;
  for (const Index other : neighbours)
  {
    sum += quantity(node, other);
  }
  return neighbours.empty() ? 0.0 : sum / static_cast<double>(neighbours.size());
}

// [K03] 1.1, second criterion, by hand. Values in brackets, range 10.
//
//   3(0)----2(10)      node 4: (|4-0| + |4-2| + |4-10| + |4-0|) / 4 = 16 / 4 = 4 -> 0.4
//   |  \   /  |        node 0: 1, 3 and 4: (2 + 0 + 4) / 3 = 2               -> 0.2
//   |  4(4)   |        node 1: 0, 2 and 4: (2 + 8 + 2) / 3 = 4               -> 0.4
//   |  /   \  |        node 2: 1, 3 and 4: (8 + 10 + 6) / 3 = 8              -> 0.8
//   0(0)----1(2)       node 3: 0, 2 and 4: (0 + 10 + 4) / 3 = 14 / 3         -> 0.4667
TEST(FiveNodes, ScalarDifferenceByHand)
{
  const Mesh mesh = testing::pyramid();
  const std::vector<float> values{ 0.0F, 2.0F, 10.0F, 0.0F, 4.0F };
  const NodalArrayView array = viewOf(values);
  TriangleTopology topology(mesh.view());
  const MeanEdgeCriterion criterion(topology, &array);
  const double expected[] = { 0.2, 0.4, 0.8, 14.0 / 30.0, 0.4 };
  for (Index node = 0; node < 5; ++node)
  {
    double cost = -1.0;
    ASSERT_TRUE(criterion.evaluate(node, cost));
    EXPECT_NEAR(cost, expected[node], 1e-8) << node;
  }
}

// [K03] 1.1, first criterion: the spokes rise 1 over sqrt(2), 35.26 degrees; the sides are flat.
TEST(FiveNodes, AngleToXYPlaneByHand)
{
  const Mesh mesh = testing::pyramid();
  TriangleTopology topology(mesh.view());
  const MeanEdgeCriterion criterion(topology, nullptr);
  const double spoke = std::atan(1.0 / std::sqrt(2.0)) / std::acos(0.0);
  double cost = -1.0;
  ASSERT_TRUE(criterion.evaluate(4, cost));
  EXPECT_NEAR(cost, spoke, 1e-8);
  ASSERT_TRUE(criterion.evaluate(0, cost));
  EXPECT_NEAR(cost, spoke / 3.0, 1e-8);
}

// The first node that goes is the one with the smallest mean difference: node 0, drawn above. Its
// two triangles become one, and the value of the removal is its error. (Node 4 has to lie beyond
// the line from 1 to 3, else the new triangle would be folded.)
TEST(FiveNodes, DecimationRemovesTheCheapestNodeFirst)
{
  Mesh mesh = testing::pyramid();
  mesh.points[12] = 1.3;
  mesh.points[13] = 1.3;
  mesh.points[14] = 0.1;
  const std::vector<float> values{ 0.0F, 2.0F, 10.0F, 0.0F, 4.0F };
  HashQueueDecimationOptions options;
  options.criterion = Criterion::ScalarDifference;
  options.arrays = { viewOf(values) };
  options.targetReduction = 1.0;
  options.targetTriangles = 3;
  Monitor monitor;
  HashQueueDecimationResult result;
  ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
  ASSERT_EQ(result.record.stepErrors.size(), 1U);
  EXPECT_EQ(result.record.nodeOrder.back(), 0);
  EXPECT_NEAR(result.error, 0.2, 1e-7);
  EXPECT_EQ(result.stopReason, StopReason::TargetTriangles);
}

// With all removals undone one by one the error of each step is the paper's value of the removed
// node just before: found anew by going through all triangles of the level.
TEST(MeanEdgeCriterion, ErrorsOfADecimationAreTheMeansOfTheLevels)
{
  std::mt19937 random(10);
  for (const bool angle : { false, true })
  {
    Mesh mesh = testing::hills(14, 13);
    testing::flipEdges(mesh, random, true);
    mesh = testing::shuffled(mesh, random);
    std::vector<float> values;
    for (Index i = 0; i < mesh.nodeCount(); ++i)
    {
      values.push_back(static_cast<float>(std::sin(0.4 * mesh.point(i)[0]) * mesh.point(i)[1]));
    }
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double range = static_cast<double>(*high) - *low;
    HashQueueDecimationOptions options;
    options.criterion = angle ? Criterion::AngleToXYPlane : Criterion::ScalarDifference;
    options.arrays = { viewOf(values) };
    options.targetReduction = 1.0;
    options.maximumError = HUGE_VAL;
    Monitor monitor;
    HashQueueDecimationResult result;
    ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
    ASSERT_GT(result.record.stepErrors.size(), 100U);

    Undecimation cursor;
    ASSERT_TRUE(cursor.open(result.record.view(), result.baseTriangles.data()));
    double largest = 0.0;
    for (Index step = cursor.stepCount(); step > 0; --step)
    {
      cursor.moveTo(step);
      const Index node = result.record.nodeOrder[cursor.nodeCount() - 1];
      const double value = meanOverNeighbours(testing::originalNumbers(cursor), node,
        [&](Index a, Index b)
        {
          if (!angle)
          {
            return std::abs(static_cast<double>(values[a]) - values[b]) / range;
          }
          const auto p = mesh.point(a);
          const auto q = mesh.point(b);
          return std::atan2(std::abs(p[2] - q[2]), std::hypot(p[0] - q[0], p[1] - q[1])) * 90.0 /
            std::acos(0.0);
        });
      largest = std::max(largest, value);
      cursor.moveTo(step - 1);
      ASSERT_NEAR(cursor.error(), largest, 1e-5 * (angle ? 90.0 : 1.0)) << "step " << step;
    }
  }
}

TEST(MeanEdgeCriterion, VectorsCompareByTheNormOfTheDifference)
{
  const Mesh mesh = testing::strip(1);
  // Differences: 0-1 (3, 4, 0) = 5, 1-2 (-3, -4, 12), norm 13, 0-2 (0, 0, 12) = 12; the box has the
  // diagonal sqrt(9 + 16 + 144) = 13.
  const std::vector<float> values{ 0, 0, 0, /**/ 3, 4, 0, /**/ 0, 0, 12 };
  const NodalArrayView array = viewOf(values, 3);
  TriangleTopology topology(mesh.view());
  const MeanEdgeCriterion criterion(topology, &array);
  double cost = 0.0;
  criterion.evaluate(0, cost);
  EXPECT_NEAR(cost, (5.0 + 12.0) / 2.0 / 13.0, 1e-8);
  criterion.evaluate(1, cost);
  EXPECT_NEAR(cost, (5.0 + 13.0) / 2.0 / 13.0, 1e-8);
}

TEST(MeanEdgeCriterion, ThreadsDoNotMatter)
{
  const Mesh mesh = testing::hills(400, 300);
  const std::vector<float> values =
    testing::valuesOn(mesh, [](double x, double y, double z) { return x * y + z; });
  const NodalArrayView array = viewOf(values);
  TriangleTopology topology(mesh.view());
  const MeanEdgeCriterion criterion(topology, &array);
  for (const int count : { 2, 5 })
  {
    Threads threads(count);
    TriangleTopology shared(mesh.view(), &threads);
    const MeanEdgeCriterion parallel(shared, &array, &threads);
    for (Index node = 0; node < mesh.nodeCount(); ++node)
    {
      double serialCost = 0.0;
      double cost = 0.0;
      ASSERT_EQ(parallel.evaluate(node, cost), criterion.evaluate(node, serialCost));
      ASSERT_EQ(cost, serialCost);
    }
  }
}

TEST(FiveNodes, NonFiniteValuesAreKeptAndCountAsTheWholeRange)
{
  const Mesh mesh = testing::pyramid();
  for (const float odd : { kNaN, std::numeric_limits<float>::infinity() })
  {
    const std::vector<float> values{ 0.0F, 2.0F, odd, 0.0F, 4.0F };
    const NodalArrayView array = viewOf(values);
    TriangleTopology topology(mesh.view());
    const MeanEdgeCriterion criterion(topology, &array);
    for (Index node = 0; node < 5; ++node)
    {
      EXPECT_EQ(topology.node(node).kept, node == 2) << node;
    }
    double cost = 0.0;
    criterion.evaluate(1, cost); // range 4: 2 / 4, whole, 2 / 4
    EXPECT_NEAR(cost, 2.0 / 3.0, 1e-8);
  }
}

TEST(FiveNodes, ConstantArraysCostNothing)
{
  const Mesh mesh = testing::pyramid();
  const std::vector<float> values(5, 3.5F);
  const NodalArrayView array = viewOf(values);
  TriangleTopology topology(mesh.view());
  const MeanEdgeCriterion criterion(topology, &array);
  for (Index node = 0; node < 5; ++node)
  {
    double cost = -1.0;
    criterion.evaluate(node, cost);
    EXPECT_EQ(cost, 0.0);
  }
}

// A node whose triangle lies upside down under another one has no hole in any plane.
TEST(MeanEdgeCriterion, FoldedHolesAreRefused)
{
  Mesh mesh;
  mesh.addNode(0.0, 0.0, 0.0);
  mesh.addNode(1.0, 0.0, 0.0);
  mesh.addNode(0.0, 1.0, 0.0);
  mesh.addNode(0.4, 0.4, 0.0); // folded back over (0, 1, 2)
  mesh.addNode(-1.0, -1.0, 0.0);
  mesh.addTriangle(0, 1, 2);
  mesh.addTriangle(0, 2, 3);
  mesh.addTriangle(0, 3, 4);
  mesh.addTriangle(0, 4, 1);
  TriangleTopology topology(mesh.view());
  MeanEdgeCriterion criterion(topology, nullptr);
  Hole hole;
  HoleTriangulation filling;
  double cost = 0.0;
  EXPECT_FALSE(criterion.retriangulate(0, hole, filling, cost));
}

} // namespace
} // namespace undecimate
