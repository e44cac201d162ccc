// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "quadric_criterion.h"

#include "testing/decimated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::Mesh;

struct Plane
{
  Vector normal;
  Vector point;
  double weight;

  double square(const Vector& p) const
  {
    const double distance = dot(this->normal, p - this->point);
    return this->weight * distance * distance;
  }
};

TEST(Quadric, IsTheSumOfTheSquaredDistancesFromWhereverItIsSeen)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] { return Vector{ number(random), number(random), number(random) }; };
  for (int run = 0; run < 100; ++run)
  {
    // Planes through a, seen from a, and planes through b, seen from b.
    const Vector a = vector();
    const Vector b = vector();
    std::vector<Plane> planes;
    Quadric seen[2];
    for (int i = 0; i < 6; ++i)
    {
      Vector normal = vector();
      normal = (1.0 / std::sqrt(dot(normal, normal))) * normal;
      planes.push_back({ normal, i % 2 == 0 ? a : b, 1.0 + number(random) });
      const double w = planes.back().weight;
      Quadric& q = seen[i % 2];
      Quadric one;
      one.xx = w * normal.x * normal.x;
      one.yy = w * normal.y * normal.y;
      one.zz = w * normal.z * normal.z;
      one.xy = w * normal.x * normal.y;
      one.yz = w * normal.y * normal.z;
      one.zx = w * normal.z * normal.x;
      q.add(one);
    }
    Quadric all = seen[0].seenFrom(b - a);
    all.add(seen[1]);
    const Vector p = vector();
    double expected = 0.0;
    double weight = 0.0;
    for (const Plane& plane : planes)
    {
      expected += plane.square(p);
      weight += plane.weight;
    }
    EXPECT_NEAR(all.at(p - b), expected, 1e-12);
    EXPECT_NEAR(all.weight(), weight, 1e-12);
  }
}

double costOf(const QuadricCriterion& criterion, Index node)
{
  double cost = -1.0;
  EXPECT_TRUE(criterion.evaluate(node, cost)) << node;
  return cost;
}

//   3---------2      A pyramid without its base: the base is 2 wide, node 4 is 1 above its middle.
//   |  \   /  |      The diagonal of the box is 3.
//   |    4    |
//   |  /   \  |      Node 4 at any corner: in two of the planes, sqrt(2) from the other two, which
//   0---------1      are as heavy: root of (0 + 0 + 2 + 2) / 4 = 1.
//
// Node 0 at node 1: in the plane of triangle 0-1-4 and in the one that stands on edge 0-1; sqrt(2)
// from that of 0-4-3 and from the one on edge 3-0, again half of the weight: 1.
TEST(QuadricCriterion, CostsByHand)
{
  const Mesh mesh = testing::pyramid();
  TriangleTopology topology(mesh.view());
  const QuadricCriterion criterion(topology);
  for (Index node = 0; node < 5; ++node)
  {
    EXPECT_NEAR(costOf(criterion, node), 1.0 / 3.0, 1e-6) << node;
  }
}

TEST(QuadricCriterion, ThreadsDoNotMatter)
{
  const Mesh mesh = testing::hills(400, 300);
  TriangleTopology topology(mesh.view());
  const QuadricCriterion criterion(topology);
  for (const int count : { 2, 5 })
  {
    Threads threads(count);
    TriangleTopology shared(mesh.view(), &threads);
    const QuadricCriterion parallel(shared, &threads);
    for (Index node = 0; node < mesh.nodeCount(); ++node)
    {
      ASSERT_EQ(costOf(parallel, node), costOf(criterion, node));
      ASSERT_EQ(shared.node(node).value, topology.node(node).value);
    }
  }
}

//   1----3----5      A roof from above: slopes of 1, the ridge 2-3 is 1 high, all 2 deep. The
//   |  / |  / |      diagonal of the box is 3.
//   0----2----4
//
// Node 2 stands for triangle 0-2-3 on the left, two triangles on the right, each of area sqrt(2),
// and for the planes y = 0 on its boundary edges, of weight 2 each. It may go to 0 or 4, which lie
// in y = 0. Node 4 is the better one: only the left slope is sqrt(2) away from it.
TEST(QuadricCriterion, CostsAtABoundaryByHand)
{
  Mesh mesh;
  for (int i = 0; i < 3; ++i)
  {
    mesh.addNode(i, 0.0, i == 1 ? 1.0 : 0.0);
    mesh.addNode(i, 2.0, i == 1 ? 1.0 : 0.0);
  }
  for (const Index low : { 0, 2 })
  {
    mesh.addTriangle(low, low + 2, low + 3);
    mesh.addTriangle(low, low + 3, low + 1);
  }
  TriangleTopology topology(mesh.view());
  const QuadricCriterion criterion(topology);
  const double area = std::sqrt(2.0);
  const double at4 = 2.0 * (area / 3.0) / (area + 4.0);
  EXPECT_NEAR(costOf(criterion, 2), std::sqrt(at4) / 3.0, 1e-6);
}

// Whatever is left in a plane lies in it.
TEST(QuadricCriterion, FlatMeshesCostNothing)
{
  for (Mesh mesh : { testing::flatGrid(17, 13), testing::flatGrid(30, 3) })
  {
    std::mt19937 random(16);
    testing::flipEdges(mesh, random, true);
    HashQueueDecimationOptions options;
    options.criterion = Criterion::Quadric;
    options.targetReduction = 1.0;
    options.maximumError = 1e-6;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.cursor.nodeCount(), 4);
    EXPECT_EQ(decimated.cursor.cellCount(), 2);
    EXPECT_TRUE(testing::looksUp(mesh, testing::originalNumbers(decimated.cursor)));
  }
}

// In a plane that no axis is in rounding is all that is left.
TEST(QuadricCriterion, TiltedPlanesCostNothingButRounding)
{
  Mesh mesh = testing::flatGrid(40, 40);
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    double* p = mesh.points.data() + 3 * i;
    p[2] = 0.37 * p[0] - 0.61 * p[1] + 1000.0;
  }
  HashQueueDecimationOptions options;
  options.criterion = Criterion::Quadric;
  options.preserveBoundary = true;
  options.targetReduction = 1.0;
  const Decimated decimated(mesh, options);
  EXPECT_LE(decimated.result.error, 1e-4);
  EXPECT_LT(decimated.cursor.nodeCount(), 4 * 40 + 10);
}

TEST(QuadricCriterion, SharpEdgesAndCornersStay)
{
  for (const int n : { 2, 3, 6, 12 })
  {
    const Mesh mesh = testing::cube(n);
    HashQueueDecimationOptions options;
    options.criterion = Criterion::Quadric;
    options.targetReduction = 1.0;
    options.maximumError = 1e-6;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.cursor.nodeCount(), 8) << n;
    EXPECT_EQ(decimated.cursor.cellCount(), 12) << n;
    for (const Index node : decimated.baseNodes())
    {
      for (const double x : mesh.point(node))
      {
        EXPECT_TRUE(x == 0.0 || x == n) << "node " << node << " is no corner";
      }
    }
  }
}

// The first removal is the cheapest of all nodes in the original mesh, found by going through all
// planes and all edges.
TEST(QuadricCriterion, TheFirstErrorIsTheLeastOfAll)
{
  std::mt19937 random(5);
  for (int run = 0; run < 5; ++run)
  {
    Mesh mesh = testing::torus(20, 14);
    std::uniform_real_distribution<double> off(-0.03, 0.03);
    for (double& x : mesh.points)
    {
      x += off(random);
    }
    std::vector<std::vector<Plane>> planes(mesh.nodeCount());
    const auto at = [&](Index node)
    {
      const auto p = mesh.point(node);
      return Vector{ p[0], p[1], p[2] };
    };
    const double size = testing::diagonalOf(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    {
      const Index* nodes = mesh.triangles.data() + t;
      const Vector normal = cross(at(nodes[1]) - at(nodes[0]), at(nodes[2]) - at(nodes[0]));
      const double length = std::sqrt(dot(normal, normal));
      for (int c = 0; c < 3; ++c)
      {
        planes[nodes[c]].push_back({ (1.0 / length) * normal, at(nodes[0]), length });
      }
    }
    double least = HUGE_VAL;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Index from = mesh.triangles[t + c];
        double sum = 0.0;
        double weight = 0.0;
        for (const Plane& plane : planes[from])
        {
          sum += plane.square(at(mesh.triangles[t + nextCorner(c)]));
          weight += plane.weight;
        }
        least = std::min(least, std::sqrt(sum / weight) / size);
      }
    }
    HashQueueDecimationOptions options;
    options.criterion = Criterion::Quadric;
    options.targetReduction = 1.0;
    options.targetNodes = mesh.nodeCount() - 1;
    const Decimated decimated(mesh, options);
    ASSERT_EQ(decimated.steps(), 1);
    // Intervals of the queue are 0.8 % wide.
    EXPECT_NEAR(decimated.result.error, least, 0.01 * least);
  }
}

TEST(QuadricCriterion, PlaceAndSizeDoNotMatter)
{
  const Mesh mesh = testing::roundedTorus();
  HashQueueDecimationOptions options;
  options.criterion = Criterion::Quadric;
  const Decimated here(mesh, options);
  for (const double move : { 64.0, -4096.0, 1048576.0 })
  {
    const Decimated there(testing::moved(mesh, move), options);
    EXPECT_EQ(here.removed(), there.removed());
    EXPECT_EQ(here.result.record.stepErrors, there.result.record.stepErrors);
  }
  for (const double factor : { 0x1p10, 0x1p-30, 1e-12, 1e22, 1e-30, 1e30 })
  {
    const Decimated other(testing::scaled(mesh, factor), options);
    EXPECT_EQ(other.result.stopReason, StopReason::TargetReduction) << factor;
    EXPECT_NEAR(other.result.error, here.result.error, 0.3 * here.result.error) << factor;
  }
}

// NaN, infinite and huge coordinates: their nodes are kept, with all that cannot go because of
// them; the rest goes, and every error is a number.
TEST(QuadricCriterion, BadCoordinatesAreLeftAlone)
{
  const double bad[] = { NAN, INFINITY, -INFINITY };
  Mesh mesh = testing::hills(20, 20);
  for (int i = 0; i < 3; ++i)
  {
    mesh.points[3 * (45 + 100 * i) + i] = bad[i];
  }
  HashQueueDecimationOptions options;
  options.criterion = Criterion::Quadric;
  options.targetReduction = 1.0;
  Decimated decimated(mesh, options);
  EXPECT_EQ(decimated.result.nonFiniteNodes, 3);
  EXPECT_GT(decimated.steps(), 200);
  for (const float error : decimated.result.record.stepErrors)
  {
    ASSERT_TRUE(std::isfinite(error));
  }
  decimated.cursor.moveTo(decimated.steps());
  EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));

  // So large that the diagonal is infinite: nothing can be told, and nothing breaks.
  for (double& x : mesh.points)
  {
    x = std::isfinite(x) ? x * 1e300 : 0.0;
  }
  Decimated huge(mesh, options);
  EXPECT_EQ(huge.result.error, 0.0);
  huge.cursor.moveTo(huge.steps());
  EXPECT_TRUE(testing::isOriginal(huge.cursor, mesh));
}

} // namespace
} // namespace undecimate
