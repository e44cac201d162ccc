// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue_decimation.h"

#include "fold_rule.h"
#include "testing/closest_point.h"
#include "testing/decimated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace undecimate
{
namespace
{

using testing::arrayOf;
using testing::Decimated;
using testing::expectSame;
using testing::Mesh;
using testing::valuesOn;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Outcome outcomeOf(const Mesh& mesh, const HashQueueDecimationOptions& options,
  HashQueueDecimationResult* result = nullptr)
{
  Monitor monitor;
  HashQueueDecimationResult own;
  return decimate(mesh.view(), options, monitor, result ? *result : own);
}

std::vector<Index> baseTriangles(const Decimated& decimated)
{
  std::vector<Index> triangles = decimated.result.baseTriangles;
  for (Index& node : triangles)
  {
    node = decimated.result.record.nodeOrder[node];
  }
  return triangles;
}

void expectUntouched(const Mesh& mesh, const Decimated& decimated)
{
  EXPECT_EQ(decimated.steps(), 0);
  EXPECT_EQ(decimated.result.baseTriangles, mesh.triangles);
  EXPECT_EQ(decimated.result.error, 0.0);
}

// ---------------------------------------------------------------------------------------------
// All criteria with both spacings
// ---------------------------------------------------------------------------------------------

struct Setting
{
  Criterion criterion;
  IntervalSpacing spacing;
};

class EverySetting : public ::testing::TestWithParam<Setting>
{
protected:
  EverySetting()
    : mesh(testing::hills(24, 21))
    , values(valuesOn(mesh, [](double x, double y, double) { return std::sin(0.3 * x) + 0.1 * y; }))
  {
    options.criterion = GetParam().criterion;
    options.intervalSpacing = GetParam().spacing;
    options.maximumError = kInfinity;
    options.arrays = { arrayOf(values) };
  }

  Mesh mesh;
  std::vector<float> values;
  HashQueueDecimationOptions options;
};

TEST_P(EverySetting, TargetReductionIsReachedExactly)
{
  for (const double reduction : { 0.0, 0.001, 0.1, 0.5, 0.75, 0.9 })
  {
    options.targetReduction = reduction;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.result.stopReason, StopReason::TargetReduction);
    // A step removes one or two triangles.
    const double left = (1.0 - reduction) * mesh.triangleCount();
    EXPECT_LE(decimated.cursor.cellCount(), std::ceil(left - 1e-9)) << reduction;
    EXPECT_GE(decimated.cursor.cellCount(), std::ceil(left - 1e-9) - 1.0) << reduction;
  }
}

TEST_P(EverySetting, TargetNodesIsReachedExactly)
{
  options.targetReduction = 1.0;
  for (const Index nodes :
    { mesh.nodeCount() + 10, mesh.nodeCount(), mesh.nodeCount() - 1, 200, 60 })
  {
    options.targetNodes = nodes;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.result.stopReason, StopReason::TargetNodes) << nodes;
    EXPECT_EQ(decimated.cursor.nodeCount(), std::min(nodes, mesh.nodeCount()));
  }
}

TEST_P(EverySetting, TargetTrianglesIsReachedExactly)
{
  options.targetReduction = 1.0;
  for (const Index triangles :
    { mesh.triangleCount() + 10, mesh.triangleCount(), mesh.triangleCount() - 1, 300, 100 })
  {
    options.targetTriangles = triangles;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.result.stopReason, StopReason::TargetTriangles) << triangles;
    const Index goal = std::min(triangles, mesh.triangleCount());
    EXPECT_LE(decimated.cursor.cellCount(), goal);
    EXPECT_GE(decimated.cursor.cellCount(), goal - 1);
  }
}

TEST_P(EverySetting, TheFirstStopThatIsReachedCounts)
{
  options.targetReduction = 0.5;
  options.targetTriangles = mesh.triangleCount() * 3 / 4;
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetTriangles);
  options.targetTriangles = mesh.triangleCount() / 4;
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetReduction);
  options.targetNodes = mesh.nodeCount() * 9 / 10;
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetNodes);
  options.maximumError = 0.0;
  options.criterion = Criterion::ScalarDifference;
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::MaximumError);
}

TEST_P(EverySetting, MaximumErrorIsKept)
{
  options.targetReduction = 1.0;
  const double unit = GetParam().criterion == Criterion::AngleToXYPlane ? 90.0 : 1.0;
  Index before = 0;
  for (const double fraction : { 0.0, 1e-3, 5e-3, 2e-2, 6e-2 })
  {
    options.maximumError = unit * fraction;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.result.stopReason, StopReason::MaximumError) << fraction;
    // The record keeps its errors in single precision.
    const float limit = static_cast<float>(options.maximumError);
    EXPECT_LE(decimated.result.error, limit) << fraction;
    for (const float error : decimated.result.record.stepErrors)
    {
      ASSERT_LE(error, limit);
    }
    EXPECT_GE(decimated.steps(), before);
    before = decimated.steps();
  }
  EXPECT_GT(before, 10);
}

TEST_P(EverySetting, LargeMaximumErrorsAreNoLimit)
{
  options.targetReduction = 1.0;
  options.targetNodes = 40;
  const double noLimit = GetParam().criterion == Criterion::AngleToXYPlane ? 90.0 : 1.0;
  options.maximumError = noLimit;
  const Decimated decimated(mesh, options);
  options.maximumError = kInfinity;
  const Decimated infinite(mesh, options);
  expectSame(decimated.result, infinite.result);
  EXPECT_EQ(decimated.result.stopReason, StopReason::TargetNodes);
}

TEST_P(EverySetting, EverythingRemovableGoesWithoutLimits)
{
  options.targetReduction = 1.0;
  options.maximumError = kInfinity;
  const Decimated decimated(mesh, options);
  EXPECT_EQ(decimated.result.stopReason, StopReason::NoRemovableNode);
  EXPECT_LT(decimated.cursor.nodeCount(), mesh.nodeCount() / 5);
}

TEST_P(EverySetting, TheErrorIsThatOfLevelZero)
{
  const Decimated decimated(mesh, options);
  EXPECT_EQ(decimated.result.error, static_cast<double>(decimated.result.record.stepErrors[0]));
  EXPECT_EQ(decimated.result.error, decimated.cursor.error());
}

TEST_P(EverySetting, BoundaryIsPreservedOnRequest)
{
  options.targetReduction = 1.0;
  options.preserveBoundary = true;
  const Decimated decimated(mesh, options);
  EXPECT_EQ(
    testing::boundaryEdges(baseTriangles(decimated)), testing::boundaryEdges(mesh.triangles));
  EXPECT_EQ(decimated.result.boundaryNodes, 2 * (24 + 21) - 4);
  EXPECT_GT(decimated.steps(), 100);
}

TEST_P(EverySetting, KeepFlagsAreHeard)
{
  std::vector<unsigned char> keep(mesh.nodeCount(), 0);
  std::set<Index> expected;
  for (Index i = 3; i < mesh.nodeCount(); i += 17)
  {
    keep[i] = static_cast<unsigned char>(1 + i % 255);
    expected.insert(i);
  }
  options.targetReduction = 1.0;
  TriangleMeshView view = mesh.view();
  view.keep = keep.data();
  const Decimated decimated(view, options);
  const std::set<Index> left = decimated.baseNodes();
  EXPECT_TRUE(std::includes(left.begin(), left.end(), expected.begin(), expected.end()));
  EXPECT_EQ(decimated.result.requestedNodes, static_cast<Index>(expected.size()));
  EXPECT_GT(decimated.steps(), mesh.nodeCount() / 2);

  std::fill(keep.begin(), keep.end(), static_cast<unsigned char>(1));
  const Decimated none(view, options);
  expectUntouched(mesh, none);
  EXPECT_EQ(none.result.stopReason, StopReason::NoRemovableNode);
}

TEST_P(EverySetting, TwoRunsAreTheSame)
{
  const Decimated first(mesh, options);
  const Decimated second(mesh, options);
  expectSame(first.result, second.result);
}

// All coordinates are multiples of 1/256: the same in float.
TEST_P(EverySetting, FloatAndDoubleAreTheSame)
{
  std::vector<float> floats;
  for (double& x : mesh.points)
  {
    x = std::round(256.0 * x) / 256.0;
    floats.push_back(static_cast<float>(x));
  }
  const Decimated fromDouble(mesh, options);
  TriangleMeshView view = mesh.view();
  view.pointsDouble = nullptr;
  view.pointsFloat = floats.data();
  const Decimated fromFloat(view, options);
  expectSame(fromDouble.result, fromFloat.result);
}

TEST_P(EverySetting, TheResultOfAnEarlierCallIsForgotten)
{
  HashQueueDecimationResult result;
  ASSERT_TRUE(outcomeOf(testing::moebius(9),
    options.criterion == Criterion::ScalarDifference ? HashQueueDecimationOptions() : options,
    &result));
  ASSERT_TRUE(outcomeOf(mesh, options, &result));
  expectSame(result, Decimated(mesh, options).result);
  EXPECT_EQ(result.nonManifoldNodes, 0);
}

INSTANTIATE_TEST_SUITE_P(Settings, EverySetting,
  ::testing::Values(Setting{ Criterion::Deviation, IntervalSpacing::Logarithmic },
    Setting{ Criterion::Deviation, IntervalSpacing::Exponential },
    Setting{ Criterion::ScalarDifference, IntervalSpacing::Logarithmic },
    Setting{ Criterion::ScalarDifference, IntervalSpacing::Exponential },
    Setting{ Criterion::AngleToXYPlane, IntervalSpacing::Logarithmic },
    Setting{ Criterion::AngleToXYPlane, IntervalSpacing::Exponential },
    Setting{ Criterion::Quadric, IntervalSpacing::Logarithmic },
    Setting{ Criterion::Quadric, IntervalSpacing::Exponential }));

TEST(HashQueueDecimation, AnyIntervalNodes)
{
  const Mesh mesh = testing::hills(15, 15);
  const std::vector<float> values =
    valuesOn(mesh, [](double x, double y, double) { return x * y; });
  HashQueueDecimationOptions options;
  options.intervalSpacing = IntervalSpacing::Exponential;
  options.arrays = { arrayOf(values) };
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::ScalarDifference, Criterion::Quadric })
  {
    options.criterion = criterion;
    for (const double k : { 1e-9, 0.01, 1.0, 4.0, 1e3, 1e30, kInfinity })
    {
      options.intervalNodes = k;
      const Decimated decimated(mesh, options);
      EXPECT_EQ(decimated.result.stopReason, StopReason::TargetReduction) << k;
    }
  }
}

// ---------------------------------------------------------------------------------------------
// Requests that are refused, each with its name
// ---------------------------------------------------------------------------------------------

TEST(HashQueueDecimation, BadOptionsAreNamed)
{
  const Mesh mesh = testing::flatGrid(4, 4);
  const std::vector<float> values(mesh.nodeCount() * 10, 1.0F);
  const auto expectRefused = [&](const char* name, auto&& spoil)
  {
    HashQueueDecimationOptions options;
    spoil(options);
    HashQueueDecimationResult result;
    const Outcome outcome = outcomeOf(mesh, options, &result);
    EXPECT_EQ(outcome.status, Status::InvalidArgument) << name;
    EXPECT_NE(outcome.message.find(name), std::string::npos) << outcome.message;
    EXPECT_EQ(result.record.nodeCount, 0);
    EXPECT_TRUE(result.baseTriangles.empty());
  };
  using Options = HashQueueDecimationOptions;
  for (const double bad : { -0.1, 1.1, kNaN, kInfinity, -kInfinity })
  {
    expectRefused("TargetReduction", [&](Options& o) { o.targetReduction = bad; });
  }
  for (const double bad : { -1e-9, kNaN, -kInfinity })
  {
    expectRefused("MaximumError", [&](Options& o) { o.maximumError = bad; });
  }
  for (const double bad : { 0.0, -1.0, kNaN })
  {
    expectRefused("IntervalNodes", [&](Options& o) { o.intervalNodes = bad; });
  }
  for (const double bad : { -0.5, kNaN, kInfinity })
  {
    expectRefused("ScalarWeight", [&](Options& o) { o.scalarWeight = bad; });
    expectRefused("ShapeWeight", [&](Options& o) { o.shapeWeight = bad; });
  }
  expectRefused("TargetNodes", [](Options& o) { o.targetNodes = -1; });
  expectRefused("TargetTriangles", [](Options& o) { o.targetTriangles = -1; });
  for (const int components : { 0, -1, 10 })
  {
    expectRefused("Result", [&](Options& o) { o.arrays = { arrayOf(values, components) }; });
  }
  expectRefused("Result",
    [&](Options& o)
    {
      o.arrays = { arrayOf(values), arrayOf(values) };
      o.arrays[1].values = nullptr;
    });
  expectRefused("Scalar Difference", [](Options& o) { o.criterion = Criterion::ScalarDifference; });
}

TEST(HashQueueDecimation, WrongNodeNumbersAreNamed)
{
  for (const Index bad : { Index{ -1 }, Index{ 16 }, std::numeric_limits<Index>::max(),
         std::numeric_limits<Index>::min() })
  {
    Mesh mesh = testing::flatGrid(4, 4);
    mesh.triangles[3 * 7 + 1] = bad;
    const Outcome outcome = outcomeOf(mesh, {});
    EXPECT_EQ(outcome.status, Status::InvalidArgument);
    EXPECT_NE(outcome.message.find("Triangle 7"), std::string::npos) << outcome.message;
    EXPECT_NE(outcome.message.find(std::to_string(bad)), std::string::npos) << outcome.message;
  }
}

TEST(HashQueueDecimation, TooLargeMeshesAreRefusedBeforeTheyAreRead)
{
  TriangleMeshView view;
  view.nodeCount = std::int64_t{ 1 } << 31;
  Monitor monitor;
  HashQueueDecimationResult result;
  EXPECT_EQ(decimate(view, {}, monitor, result).status, Status::TooLarge);
  view.nodeCount = 3;
  view.triangleCount = std::int64_t{ 1 } << 31;
  EXPECT_EQ(decimate(view, {}, monitor, result).status, Status::TooLarge);
}

// ---------------------------------------------------------------------------------------------
// Odd meshes
// ---------------------------------------------------------------------------------------------

TEST(HashQueueDecimation, EmptyMesh)
{
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    for (const auto spacing : { IntervalSpacing::Logarithmic, IntervalSpacing::Exponential })
    {
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      options.intervalSpacing = spacing;
      options.trackCellSources = true;
      const Mesh mesh;
      const Decimated decimated(mesh, options);
      expectUntouched(mesh, decimated);
      EXPECT_EQ(decimated.cursor.nodeCount(), 0);
    }
  }
}

TEST(HashQueueDecimation, NoNumberOfNodesIsNoStop)
{
  HashQueueDecimationOptions options;
  EXPECT_NE(Decimated(Mesh(), options).result.stopReason, StopReason::TargetNodes);
}

// Out of the box only TargetReduction stops, whatever the criterion and its unit.
TEST(HashQueueDecimation, DefaultsHaveNoMaximumError)
{
  const Mesh mesh = testing::hills(24, 21);
  const std::vector<float> values =
    valuesOn(mesh, [](double x, double y, double) { return std::sin(0.3 * x) + 0.1 * y; });
  for (const Criterion criterion : { Criterion::Deviation, Criterion::ScalarDifference,
         Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    HashQueueDecimationOptions options;
    options.criterion = criterion;
    options.arrays = { arrayOf(values) };
    EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetReduction);
  }
}

TEST(HashQueueDecimation, PointsWithoutTriangles)
{
  Mesh mesh;
  mesh.addNode(0.0, 0.0, 0.0);
  mesh.addNode(1.0, 0.0, 0.0);
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  const Decimated decimated(mesh, options);
  expectUntouched(mesh, decimated);
  EXPECT_EQ(decimated.result.unusedNodes, 2);
}

/// Meshes of which nothing can be removed.
struct Stuck
{
  const char* name;
  Mesh mesh;
};

std::vector<Stuck> stuckMeshes()
{
  std::vector<Stuck> all;
  all.push_back({ "tetrahedron", testing::tetrahedron() });
  all.push_back({ "single triangle", testing::strip(1) });
  Mesh pair = testing::strip(1);
  pair.addTriangle(pair.triangles[0], pair.triangles[2], pair.triangles[1]);
  all.push_back({ "closed pair", pair });
  Mesh twice = testing::strip(1);
  twice.addTriangle(twice.triangles[0], twice.triangles[1], twice.triangles[2]);
  all.push_back({ "repeated triangle", twice });
  Mesh degenerate = testing::flatGrid(3, 3);
  for (std::size_t i = 0; i < degenerate.triangles.size(); i += 3)
  {
    degenerate.triangles[i + 1] = degenerate.triangles[i];
  }
  all.push_back({ "all degenerate", degenerate });
  Mesh fan; // five triangles on one edge
  fan.addNode(0.0, 0.0, 0.0);
  fan.addNode(0.0, 0.0, 1.0);
  for (int i = 0; i < 5; ++i)
  {
    fan.addTriangle(0, 1, fan.addNode(std::cos(1.2 * i), std::sin(1.2 * i), 0.5));
  }
  all.push_back({ "non-manifold fan", fan });
  Mesh zero = testing::flatGrid(4, 4);
  std::fill(zero.points.begin(), zero.points.end(), 2.5);
  all.push_back({ "all nodes in one place", zero });
  return all;
}

TEST(HashQueueDecimation, StuckMeshesStayAsTheyAre)
{
  for (const Stuck& stuck : stuckMeshes())
  {
    for (const Criterion criterion : { Criterion::Deviation, Criterion::ScalarDifference,
           Criterion::AngleToXYPlane, Criterion::Quadric })
    {
      const std::vector<float> values =
        valuesOn(stuck.mesh, [](double x, double y, double z) { return x + y + z; });
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      options.arrays = { arrayOf(values) };
      options.targetReduction = 1.0;
      options.trackCellSources = true;
      const Decimated decimated(stuck.mesh, options);
      SCOPED_TRACE(stuck.name);
      EXPECT_EQ(decimated.result.stopReason, StopReason::NoRemovableNode);
      if (std::string(stuck.name) == "all nodes in one place")
      {
        // Its corners with one triangle may go: they leave nothing open.
        EXPECT_GT(decimated.cursor.cellCount(), 0);
      }
      else
      {
        expectUntouched(stuck.mesh, decimated);
      }
    }
  }
}

TEST(HashQueueDecimation, ReasonsForKeptNodesAreCounted)
{
  Index touching = kNone;
  const Mesh tie = testing::bowTie(2, touching);
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  {
    const Decimated decimated(tie, options);
    EXPECT_EQ(decimated.result.nonManifoldNodes, 1);
    EXPECT_EQ(decimated.result.unusedNodes, 1);
    EXPECT_EQ(decimated.baseNodes().count(touching), 1U);
  }
  {
    const Decimated decimated(testing::tJoint(3), options);
    EXPECT_EQ(decimated.result.nonManifoldNodes, 4);
  }
  {
    Mesh mesh = testing::flatGrid(5, 5);
    mesh.addTriangle(6, 7, 7);
    EXPECT_EQ(Decimated(mesh, options).result.degenerateNodes, 2);
  }
  {
    Mesh mesh = testing::flatGrid(5, 5);
    mesh.points[3 * 12] = kNaN;
    mesh.points[3 * 3 + 1] = kInfinity;
    EXPECT_EQ(Decimated(mesh, options).result.nonFiniteNodes, 2);
  }
}

TEST(HashQueueDecimation, StripsGoToOneTriangle)
{
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    HashQueueDecimationOptions options;
    options.criterion = criterion;
    options.targetReduction = 1.0;
    options.maximumError = kInfinity;
    const Mesh mesh = testing::strip(15);
    Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.cursor.cellCount(), 1);
    EXPECT_EQ(decimated.cursor.nodeCount(), 3);
    decimated.cursor.moveTo(decimated.steps());
    EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
  }
}

// A strip of which one triangle lies upside down: the neighbours do not agree, their nodes stay.
TEST(HashQueueDecimation, StripWithAFlippedTriangle)
{
  Mesh mesh = testing::strip(9);
  std::swap(mesh.triangles[3 * 4], mesh.triangles[3 * 4 + 1]);
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  Decimated decimated(mesh, options);
  EXPECT_GT(decimated.result.nonManifoldNodes, 0);
  const std::set<Index> left = decimated.baseNodes();
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(left.count(mesh.triangles[3 * 4 + c]), 1U);
  }
  decimated.cursor.moveTo(decimated.steps());
  EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
}

// Odd triangles stay, the rest of the mesh is decimated around them, at every level.
TEST(HashQueueDecimation, OddTrianglesStayWithTheirNodes)
{
  Index touching = kNone;
  std::vector<Mesh> meshes{ testing::tJoint(6), testing::bowTie(4, touching),
    testing::moebius(24) };
  Mesh mixed = testing::hills(12, 12);
  mixed.addTriangle(40, 40, 41);
  mixed.addTriangle(mixed.triangles[30], mixed.triangles[31], mixed.triangles[32]);
  mixed.addTriangle(100, 100, 100);
  mixed.addNode(3.0, 3.0, 3.0);
  meshes.push_back(mixed);
  Mesh flaps = testing::tetrahedron(); // see triangle_topology_test
  for (const auto& edge : { std::pair<Index, Index>{ 0, 1 }, { 1, 2 }, { 2, 0 } })
  {
    const Index flap = flaps.addNode(1.0 + edge.first, 1.0 + edge.second, -1.0);
    flaps.addTriangle(edge.first, edge.second, flap);
  }
  meshes.push_back(flaps);
  Mesh upsideDown = testing::tetrahedron();
  std::swap(upsideDown.triangles[0], upsideDown.triangles[1]);
  meshes.push_back(upsideDown);

  const auto repeated = [](const std::vector<Index>& triangles)
  {
    std::map<std::array<Index, 3>, int> copies;
    int count = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
      std::array<Index, 3> t{ triangles[i], triangles[i + 1], triangles[i + 2] };
      std::sort(t.begin(), t.end());
      count += ++copies[t] > 1 || t[0] == t[1] || t[1] == t[2];
    }
    return count;
  };
  for (std::size_t m = 0; m < meshes.size(); ++m)
  {
    const Mesh& mesh = meshes[m];
    for (const Criterion criterion :
      { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
    {
      SCOPED_TRACE("mesh " + std::to_string(m));
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      options.targetReduction = 1.0;
      options.maximumError = kInfinity;
      Decimated decimated(mesh, options);
      const int largestUse = testing::largestEdgeUse(mesh.triangles);
      const int odd = repeated(mesh.triangles);
      const int euler = testing::eulerCharacteristic(mesh.triangles);
      for (Index step = 0; step <= decimated.steps(); ++step)
      {
        decimated.cursor.moveTo(step);
        const std::vector<Index> triangles = testing::originalNumbers(decimated.cursor);
        ASSERT_LE(testing::largestEdgeUse(triangles), largestUse) << step;
        ASSERT_EQ(repeated(triangles), odd) << step;
        ASSERT_EQ(testing::eulerCharacteristic(triangles), euler) << step;
      }
      EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
    }
  }
}

TEST(HashQueueDecimation, NonFiniteCoordinatesStay)
{
  for (const double odd : { kNaN, kInfinity, -kInfinity, 1e308 })
  {
    for (const Criterion criterion :
      { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
    {
      Mesh mesh = testing::hills(14, 14);
      const Index node = 5 * 14 + 6;
      mesh.points[3 * node + 1] = odd;
      mesh.points[3 * 0 + 2] = odd; // a corner with one neighbour triangle on either side
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      options.targetReduction = 1.0;
      options.maximumError = kInfinity;
      Decimated decimated(mesh, options);
      if (!std::isfinite(odd))
      {
        EXPECT_EQ(decimated.result.nonFiniteNodes, 2);
        EXPECT_EQ(decimated.baseNodes().count(node), 1U);
        EXPECT_GT(decimated.steps(), 20);
      }
      EXPECT_TRUE(std::isfinite(decimated.result.error));
      decimated.cursor.moveTo(decimated.steps());
      EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
    }
  }
}

TEST(HashQueueDecimation, AllCoordinatesNonFinite)
{
  Mesh mesh = testing::flatGrid(4, 4);
  std::fill(mesh.points.begin(), mesh.points.end(), kNaN);
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    HashQueueDecimationOptions options;
    options.criterion = criterion;
    expectUntouched(mesh, Decimated(mesh, options));
  }
}

// A patch of no area amid a grid: two rows of nodes coincide.
TEST(HashQueueDecimation, ZeroAreaPatch)
{
  Mesh mesh = testing::hills(12, 12);
  for (int x = 0; x < 12; ++x)
  {
    for (int c = 0; c < 3; ++c)
    {
      mesh.points[3 * (5 * 12 + x) + c] = mesh.points[3 * (6 * 12 + x) + c];
    }
  }
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    HashQueueDecimationOptions options;
    options.criterion = criterion;
    options.targetReduction = 1.0;
    options.maximumError = kInfinity;
    Decimated decimated(mesh, options);
    EXPECT_GT(decimated.steps(), 20);
    EXPECT_TRUE(std::isfinite(decimated.result.error));
    const std::vector<Index> triangles = baseTriangles(decimated);
    EXPECT_TRUE(testing::isManifoldAndOriented(triangles));
    EXPECT_TRUE(testing::hasNoDegenerateOrRepeated(triangles));
  }
}

// ---------------------------------------------------------------------------------------------
// Nodal arrays
// ---------------------------------------------------------------------------------------------

TEST(NodalArrays, NonFiniteValuesStay)
{
  const Mesh mesh = testing::hills(16, 16);
  std::vector<float> values = valuesOn(mesh, [](double x, double y, double) { return x * y; });
  const std::set<Index> odd{ 0, 17, 100, 137, 255 };
  for (const Index node : odd)
  {
    values[node] = node % 2 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                 : std::numeric_limits<float>::infinity();
  }
  for (const Criterion criterion : { Criterion::Deviation, Criterion::ScalarDifference })
  {
    HashQueueDecimationOptions options;
    options.criterion = criterion;
    options.arrays = { arrayOf(values) };
    options.targetReduction = 1.0;
    const Decimated decimated(mesh, options);
    const std::set<Index> left = decimated.baseNodes();
    EXPECT_TRUE(std::includes(left.begin(), left.end(), odd.begin(), odd.end()));
    EXPECT_GT(decimated.steps(), 100);
    EXPECT_TRUE(std::isfinite(decimated.result.error));
  }
}

// What is undefined must not spread: on a flat mesh with a constant result a triangle with a NaN
// corner shows no value, so a node of other triangles may not end up under one for free.
TEST(NodalArrays, UndefinedRegionsDoNotGrow)
{
  const Mesh mesh = testing::flatGrid(21, 21);
  std::vector<float> values = valuesOn(mesh, [](double x, double, double) { return x; });
  const Index middle = 10 * 21 + 10;
  values[middle] = std::numeric_limits<float>::quiet_NaN();
  HashQueueDecimationOptions options;
  options.arrays = { arrayOf(values) };
  options.targetReduction = 1.0;
  options.maximumError = 0.01;
  const Decimated decimated(mesh, options);
  const auto undefinedArea = [&](const std::vector<Index>& triangles)
  {
    double area = 0.0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
      if (std::count(triangles.begin() + i, triangles.begin() + i + 3, middle) > 0)
      {
        area += testing::areaFromAbove(mesh, triangles.data() + i) / 2.0;
      }
    }
    return area;
  };
  ASSERT_EQ(undefinedArea(mesh.triangles), 3.0);
  EXPECT_LE(undefinedArea(baseTriangles(decimated)), 6.0);
}

TEST(NodalArrays, WeightZeroEqualsNoArrays)
{
  const Mesh mesh = testing::hills(16, 16);
  const std::vector<float> values =
    valuesOn(mesh, [](double x, double y, double) { return std::sin(x) * y; });
  HashQueueDecimationOptions options;
  const Decimated without(mesh, options);
  options.arrays = { arrayOf(values) };
  options.scalarWeight = 0.0;
  const Decimated weightless(mesh, options);
  expectSame(without.result, weightless.result);
}

TEST(NodalArrays, ConstantArraysChangeNothing)
{
  const Mesh mesh = testing::hills(16, 16);
  const std::vector<float> values(mesh.nodeCount(), 42.0F);
  HashQueueDecimationOptions options;
  const Decimated without(mesh, options);
  options.arrays = { arrayOf(values) };
  const Decimated constant(mesh, options);
  expectSame(without.result, constant.result);
}

TEST(NodalArrays, UnitsOfTheArrayDoNotMatter)
{
  const Mesh mesh = testing::hills(16, 16);
  std::vector<float> values = valuesOn(
    mesh, [](double x, double y, double) { return std::round(64.0 * std::sin(x) * y) / 64.0; });
  HashQueueDecimationOptions options;
  options.arrays = { arrayOf(values) };
  for (const Criterion criterion : { Criterion::Deviation, Criterion::ScalarDifference })
  {
    options.criterion = criterion;
    const Decimated one(mesh, options);
    std::vector<float> scaled = values;
    for (float& value : scaled)
    {
      value *= 1048576.0F;
    }
    options.arrays = { arrayOf(scaled) };
    const Decimated other(mesh, options);
    options.arrays = { arrayOf(values) };
    expectSame(one.result, other.result);
  }
}

/// Largest difference between the interpolated and the true value at any node, over the range.
double largestValueError(
  const Mesh& mesh, const Decimated& decimated, const std::vector<float>& values)
{
  const std::vector<Index> triangles = baseTriangles(decimated);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double largest = 0.0;
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    const auto p = mesh.point(node);
    double best = 1e30;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
      const auto a = mesh.point(triangles[i]);
      const auto b = mesh.point(triangles[i + 1]);
      const auto c = mesh.point(triangles[i + 2]);
      const auto area = [](const std::array<double, 3>& u, const std::array<double, 3>& v,
                          const std::array<double, 3>& w)
      { return (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0]); };
      const double whole = area(a, b, c);
      const double wa = area(p, b, c) / whole;
      const double wb = area(a, p, c) / whole;
      const double wc = 1.0 - wa - wb;
      if (std::min({ wa, wb, wc }) >= -1e-9)
      {
        const double value =
          wa * values[triangles[i]] + wb * values[triangles[i + 1]] + wc * values[triangles[i + 2]];
        best = std::min(best, std::abs(value - values[node]));
      }
    }
    if (best < 1e30)
    {
      largest = std::max(largest, best);
    }
  }
  return largest / (static_cast<double>(*high) - *low);
}

// On a flat mesh only the result costs: an error of the fraction f of the range counts as the
// deviation scalarWeight * f, so MaximumError bounds f by MaximumError / scalarWeight.
TEST(NodalArrays, MaximumErrorBoundsTheScalarsError)
{
  const Mesh mesh = testing::flatGrid(26, 24);
  const std::vector<float> bump = valuesOn(mesh,
    [](double x, double y, double)
    { return std::exp(-0.02 * ((x - 9.0) * (x - 9.0) + (y - 12.0) * (y - 12.0))); });
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  options.arrays = { arrayOf(bump) };
  for (const double weight : { 0.1, 1.0 })
  {
    for (const double f : { 0.01, 0.05 })
    {
      options.scalarWeight = weight;
      options.maximumError = weight * f;
      const Decimated decimated(mesh, options);
      EXPECT_EQ(decimated.result.stopReason, StopReason::MaximumError);
      EXPECT_GT(decimated.steps(), mesh.nodeCount() / 3);
      EXPECT_LE(largestValueError(mesh, decimated, bump), 1.02 * f) << weight << " " << f;
    }
  }
}

// Two arrays: both are heard. One alone leaves the other one's bump unseen.
TEST(NodalArrays, TwoArraysSteerTogether)
{
  const Mesh mesh = testing::flatGrid(26, 24);
  const auto bump = [&](double cx, double cy)
  {
    return valuesOn(mesh,
      [=](double x, double y, double)
      { return std::exp(-0.05 * ((x - cx) * (x - cx) + (y - cy) * (y - cy))); });
  };
  const std::vector<float> left = bump(6.0, 12.0);
  const std::vector<float> right = bump(19.0, 11.0);
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  options.scalarWeight = 0.1;
  options.maximumError = 0.003;
  options.arrays = { arrayOf(left) };
  const Decimated one(mesh, options);
  options.arrays = { arrayOf(left), arrayOf(right) };
  const Decimated both(mesh, options);
  EXPECT_LE(largestValueError(mesh, one, left), 0.031);
  EXPECT_GT(largestValueError(mesh, one, right), 0.1);
  EXPECT_LE(largestValueError(mesh, both, left), 0.031);
  EXPECT_LE(largestValueError(mesh, both, right), 0.031);
  EXPECT_LT(both.steps(), one.steps());
}

// A vector whose norm is constant but that turns: only the norm of the difference sees it.
TEST(NodalArrays, VectorsAreComparedByTheirDifference)
{
  const Mesh mesh = testing::flatGrid(30, 12);
  std::vector<float> vectors;
  std::vector<float> cosine;
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    const double angle = 0.25 * mesh.point(i)[0];
    vectors.push_back(static_cast<float>(std::cos(angle)));
    vectors.push_back(static_cast<float>(std::sin(angle)));
    vectors.push_back(0.0F);
    cosine.push_back(static_cast<float>(std::cos(angle)));
  }
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  options.scalarWeight = 0.1;
  options.maximumError = 0.002;
  options.arrays = { arrayOf(vectors, 3) };
  const Decimated decimated(mesh, options);
  EXPECT_EQ(decimated.result.stopReason, StopReason::MaximumError);
  // The diagonal of the vectors' box is sqrt(2) of the cosine's range.
  EXPECT_LE(largestValueError(mesh, decimated, cosine), 0.02 * std::sqrt(2.0) * 1.02);
  // A scalar is a vector of one component.
  options.arrays = { arrayOf(cosine) };
  const Decimated scalar(mesh, options);
  std::vector<float> padded;
  for (const float value : cosine)
  {
    padded.insert(padded.end(), 3, 0.0F);
    padded[padded.size() - 2] = value;
  }
  options.arrays = { arrayOf(padded, 3) };
  const Decimated vector(mesh, options);
  EXPECT_EQ(scalar.removed(), vector.removed());
}

// ---------------------------------------------------------------------------------------------
// Shapes that must survive
// ---------------------------------------------------------------------------------------------

TEST(Deviation, FlatMeshesCostNothing)
{
  for (Mesh mesh : { testing::flatGrid(17, 13), testing::flatGrid(30, 3) })
  {
    std::mt19937 random(16);
    testing::flipEdges(mesh, random, true);
    HashQueueDecimationOptions options;
    options.targetReduction = 1.0;
    options.maximumError = 1e-6;
    const Decimated decimated(mesh, options);
    EXPECT_LE(decimated.result.error, 1e-6);
    // The four corners and two triangles are left, and they cover the same rectangle.
    EXPECT_EQ(decimated.cursor.nodeCount(), 4);
    EXPECT_EQ(decimated.cursor.cellCount(), 2);
    EXPECT_TRUE(testing::looksUp(mesh, baseTriangles(decimated)));
  }
}

/// A torus with a rough skin.
Mesh crumpled(unsigned int seed, double roughness)
{
  Mesh mesh = testing::torus(72, 36);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-roughness, roughness);
  for (double& x : mesh.points)
  {
    x += shift(random);
  }
  return mesh;
}

Vector crossOf(const Mesh& mesh, const Index* corners)
{
  std::array<Vector, 3> p;
  for (int c = 0; c < 3; ++c)
  {
    const auto at = mesh.point(corners[c]);
    p[c] = { at[0], at[1], at[2] };
  }
  return cross(p[1] - p[0], p[2] - p[0]);
}

/// Triangles that are turned away from the mesh's normals at all their corners.
int turnedOver(const Mesh& mesh, const std::vector<Index>& triangles)
{
  std::vector<Vector> normals(mesh.nodeCount(), Vector{ 0.0, 0.0, 0.0 });
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    Vector& normal = normals[mesh.triangles[i]];
    normal = normal + crossOf(mesh, mesh.triangles.data() + i / 3 * 3);
  }
  int count = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    const Vector normal = crossOf(mesh, triangles.data() + i);
    count += std::all_of(triangles.begin() + i, triangles.begin() + i + 3,
               [&](Index node) { return dot(normal, normals[node]) < 0.0; })
      ? 1
      : 0;
  }
  return count;
}

/// The ends of the edges where the cosine of the two triangles' normals is less.
std::vector<std::pair<Index, Index>> edgesBelow(
  const Mesh& mesh, const std::vector<Index>& triangles, double cosine)
{
  std::map<std::pair<Index, Index>, Vector> behind;
  std::vector<std::pair<Index, Index>> edges;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    const Vector normal = crossOf(mesh, triangles.data() + i);
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Index from = triangles[i + c];
      const Index to = triangles[i + (c + 1) % 3];
      const auto other = behind.find({ to, from });
      if (other != behind.end())
      {
        const Vector& n = other->second;
        if (dot(n, normal) < cosine * std::sqrt(dot(n, n) * dot(normal, normal)))
        {
          edges.emplace_back(from, to);
        }
      }
      behind[{ from, to }] = normal;
    }
  }
  return edges;
}

/// Edges whose two triangles lie on each other, within 8 degrees.
std::size_t folds(const Mesh& mesh, const std::vector<Index>& triangles)
{
  return edgesBelow(mesh, triangles, -0.99).size();
}

/// New triangles that face away from the nearest original triangles, seen from seven places.
int facingAway(const Mesh& mesh, const std::vector<Index>& triangles)
{
  const auto place = [&](Index node)
  {
    const std::array<double, 3> p = mesh.point(node);
    return Vector{ p[0], p[1], p[2] };
  };
  constexpr double kThird = 1.0 / 3.0;
  constexpr double kWeights[7][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0.5, 0.5 },
    { 0.5, 0, 0.5 }, { 0.5, 0.5, 0 }, { kThird, kThird, kThird } };
  std::set<std::set<Index>> originals;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
  {
    originals.insert({ mesh.triangles.begin() + i, mesh.triangles.begin() + i + 3 });
  }
  int count = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    const Index* nodes = triangles.data() + i;
    const Vector normal = crossOf(mesh, nodes);
    bool away = originals.count({ nodes, nodes + 3 }) == 0;
    for (const auto& weight : kWeights)
    {
      // A little inside.
      Vector p{ 0.0, 0.0, 0.0 };
      for (int c = 0; c < 3; ++c)
      {
        p = p + (0.95 * weight[c] + 0.05 / 3.0) * place(nodes[c]);
      }
      double least = HUGE_VAL;
      bool nearestAway = false;
      for (std::size_t t = 0; away && t < mesh.triangles.size(); t += 3)
      {
        const Index* old = mesh.triangles.data() + t;
        const double square =
          testing::closestPoint(p, place(old[0]), place(old[1]), place(old[2])).square;
        if (square < least)
        {
          least = square;
          nearestAway = dot(crossOf(mesh, old), normal) < 0.0;
        }
      }
      away = nearestAway;
    }
    count += away ? 1 : 0;
  }
  return count;
}

// Many small turns must not add up to a fold.
TEST(Deviation, RoughSurfacesDoNotFold)
{
  for (const double roughness : { 0.03, 0.06, 0.09 })
  {
    const Mesh mesh = crumpled(7, roughness);
    const std::size_t foldsBefore = folds(mesh, mesh.triangles);
    for (const double reduction : { 0.5, 0.9, 0.97 })
    {
      HashQueueDecimationOptions options;
      options.targetReduction = reduction;
      const Decimated decimated(mesh, options);
      const std::vector<Index> triangles = baseTriangles(decimated);
      EXPECT_LE(turnedOver(mesh, triangles), turnedOver(mesh, mesh.triangles))
        << roughness << " " << reduction;
      EXPECT_LE(folds(mesh, triangles), foldsBefore) << roughness << " " << reduction;
      if (reduction >= 0.9) // the others are many
      {
        EXPECT_EQ(facingAway(mesh, triangles), 0) << roughness << " " << reduction;
      }
    }
  }
}

// Between the few triangles of a coarse round part are large angles: its nodes can still go, down
// to two more than the least torus there is, and nothing folds.
TEST(Deviation, CoarseRoundPartsThinOut)
{
  using Size = std::pair<int, int>;
  for (const auto& [around, across] :
    { Size{ 24, 6 }, { 24, 12 }, { 48, 6 }, { 96, 6 }, { 96, 8 }, { 96, 12 } })
  {
    SCOPED_TRACE(std::to_string(around) + " x " + std::to_string(across));
    const Mesh mesh = testing::torus(around, across);
    HashQueueDecimationOptions options;
    options.targetReduction = 1.0;
    Decimated decimated(mesh, options);
    EXPECT_LE(decimated.result.record.baseNodeCount, 9);
    const std::vector<Index> triangles = baseTriangles(decimated);
    EXPECT_TRUE(testing::isManifoldAndOriented(triangles));
    EXPECT_EQ(testing::eulerCharacteristic(triangles), 0);
    EXPECT_EQ(folds(mesh, triangles), 0);
    EXPECT_EQ(turnedOver(mesh, triangles), 0);
    EXPECT_EQ(facingAway(mesh, triangles), 0);
    decimated.cursor.moveTo(decimated.steps());
    EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
  }
}

TEST(Deviation, CubesGoToTwelveTriangles)
{
  for (const int n : { 2, 3, 6 })
  {
    const Mesh mesh = testing::cube(n);
    HashQueueDecimationOptions options;
    options.targetReduction = 1.0;
    options.maximumError = 1e-6;
    const Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.cursor.nodeCount(), 8) << n;
    EXPECT_EQ(decimated.cursor.cellCount(), 12) << n;
    EXPECT_LE(decimated.result.error, 1e-6);
    const std::set<Index> left = decimated.baseNodes();
    for (Index i = 0; i < mesh.nodeCount(); ++i)
    {
      const auto p = mesh.point(i);
      const bool corner =
        (p[0] == 0 || p[0] == n) && (p[1] == 0 || p[1] == n) && (p[2] == 0 || p[2] == n);
      if (corner)
      {
        EXPECT_EQ(left.count(i), 1U) << "corner " << p[0] << " " << p[1] << " " << p[2];
      }
    }
  }
}

/// A cube whose places are moved; its faces stay smooth and its edges sharp.
Mesh bentCube(int n, const std::function<Vector(const Vector&)>& place)
{
  Mesh mesh = testing::cube(n);
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    const auto p = mesh.point(node);
    const Vector moved = place({ p[0] / n, p[1] / n, p[2] / n });
    std::copy_n(&moved.x, 3, mesh.points.begin() + std::ptrdiff_t{ 3 } * node);
  }
  return mesh;
}

// Without a feature angle: what cuts a sharp edge is far from it.
TEST(Deviation, SharpEdgesStaySharp)
{
  constexpr double kSharp = 0.77; // 40 degrees
  const Mesh mesh = bentCube(24,
    [](const Vector& p)
    {
      const double angle = 1.5 * p.x;
      const double radius = 1.0 + 0.7 * p.y;
      return Vector{ radius * std::cos(angle), radius * std::sin(angle),
        p.z + 0.2 * std::sin(3.0 * p.x) };
    });
  const auto place = [&](Index node)
  {
    const auto p = mesh.point(node);
    return Vector{ p[0], p[1], p[2] };
  };
  const auto before = edgesBelow(mesh, mesh.triangles, kSharp);
  ASSERT_EQ(before.size(), 12U * 24U);
  for (const double reduction : { 0.8, 0.95, 0.98 })
  {
    HashQueueDecimationOptions options;
    options.targetReduction = reduction;
    const Decimated decimated(mesh, options);
    const auto after = edgesBelow(mesh, baseTriangles(decimated), kSharp);
    // Each node of an edge is as near to a sharp edge of the result as the surfaces are.
    const double error = decimated.result.error * testing::diagonalOf(mesh);
    double farthest = 0.0;
    for (const auto& edge : before)
    {
      double least = HUGE_VAL;
      for (const auto& [from, to] : after)
      {
        const Vector a = place(from);
        least =
          std::min(least, testing::closestPoint(place(edge.first), a, place(to), place(to)).square);
      }
      farthest = std::max(farthest, std::sqrt(least));
    }
    EXPECT_LE(farthest, 1.5 * error) << reduction;
  }
}

// The two sides of a sheet that is thin against its extent stay apart: it keeps its volume.
TEST(Deviation, ThinPartsDoNotCollapse)
{
  const Mesh mesh = bentCube(30,
    [](const Vector& p) {
      return Vector{ p.x, p.y, 0.01 * p.z + 0.1 * std::sin(4.0 * p.x) };
    });
  const auto volume = [&](const std::vector<Index>& triangles)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
      const auto p = mesh.point(triangles[i]);
      sum += dot({ p[0], p[1], p[2] }, crossOf(mesh, triangles.data() + i)) / 6.0;
    }
    return sum;
  };
  ASSERT_NEAR(volume(mesh.triangles), 0.01, 1e-6);
  for (const double reduction : { 0.8, 0.95, 0.98 })
  {
    HashQueueDecimationOptions options;
    options.targetReduction = reduction;
    const Decimated decimated(mesh, options);
    EXPECT_NEAR(volume(baseTriangles(decimated)), 0.01, 0.0005) << reduction;
  }
}

TEST(Deviation, ARoughOrderFarFromTheGoalDoesNotMatterThere)
{
  const Mesh mesh = testing::hills(240, 240);
  ASSERT_GT(mesh.triangleCount(), 110000);
  HashQueueDecimationOptions options;
  options.targetReduction = 0.98;
  const Decimated rough(mesh, options);
  options.maximumError = 1.0; // with which the order is always exact
  const Decimated exact(mesh, options);
  EXPECT_NE(rough.removed(), exact.removed());
  EXPECT_NEAR(rough.result.error, exact.result.error, 0.05 * exact.result.error);
  EXPECT_NEAR(rough.cursor.nodeCount(), exact.cursor.nodeCount(), 0.05 * exact.cursor.nodeCount());
}

TEST(Deviation, PlaceDoesNotMatter)
{
  const Mesh mesh = testing::roundedTorus();
  HashQueueDecimationOptions options;
  const Decimated here(mesh, options);
  for (const double move : { 64.0, -4096.0, 1048576.0 })
  {
    const Decimated there(testing::moved(mesh, move), options);
    expectSame(here.result, there.result);
  }
}

TEST(Deviation, SizeDoesNotMatter)
{
  const Mesh mesh = testing::roundedTorus();
  HashQueueDecimationOptions options;
  const Decimated one(mesh, options);
  for (const int exponent : { 10, -10, 40, -30 })
  {
    const Decimated other(testing::scaled(mesh, std::ldexp(1.0, exponent)), options);
    EXPECT_EQ(one.removed(), other.removed()) << exponent;
    EXPECT_NEAR(one.result.error, other.result.error, 1e-6 * one.result.error) << exponent;
  }
}

// From atoms in metres to galaxies in centimetres.
TEST(Deviation, ExtremeSizesWork)
{
  const Mesh mesh = testing::roundedTorus();
  HashQueueDecimationOptions options;
  const Decimated one(mesh, options);
  for (const double factor : { 1e-12, 1e22, 1e-30, 1e30 })
  {
    const Decimated other(testing::scaled(mesh, factor), options);
    EXPECT_EQ(other.result.stopReason, StopReason::TargetReduction) << factor;
    EXPECT_NEAR(other.result.error, one.result.error, 0.3 * one.result.error) << factor;
  }
}

Vector vectorAt(const Mesh& mesh, Index node)
{
  const auto p = mesh.point(node);
  return { p[0], p[1], p[2] };
}

/// Shapes of the triangles of level 0, worst first.
std::vector<double> shapesOf(const Mesh& mesh, const Decimated& decimated)
{
  std::vector<double> shapes;
  const std::vector<Index> triangles = baseTriangles(decimated);
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    shapes.push_back(FilledTriangle(vectorAt(mesh, triangles[t]), vectorAt(mesh, triangles[t + 1]),
      vectorAt(mesh, triangles[t + 2]))
                       .shape());
  }
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

// A cylinder's best triangles are long ones along its axis. The larger the weight the better are
// the shapes, and the larger is the error that is paid, which stays a true one.
TEST(Deviation, ShapeWeightMakesTrianglesWellShaped)
{
  const Mesh mesh = testing::heightField(40, 40,
    [](double x, double /*y*/)
    { return std::sqrt(std::max(0.0, 25.0 * 25.0 - (x - 20) * (x - 20))); });
  HashQueueDecimationOptions options;
  double worstBefore = 0.0;
  double medianBefore = 0.0;
  double errorBefore = 0.0;
  for (const double weight : { 0.0, 0.02, 0.1 })
  {
    SCOPED_TRACE(weight);
    options.shapeWeight = weight;
    Decimated decimated(mesh, options);
    const std::vector<double> shapes = shapesOf(mesh, decimated);
    EXPECT_GT(shapes[shapes.size() / 20], 1.1 * worstBefore);
    EXPECT_GT(shapes[shapes.size() / 2], 1.05 * medianBefore);
    EXPECT_GE(decimated.result.error, errorBefore);
    worstBefore = shapes[shapes.size() / 20];
    medianBefore = shapes[shapes.size() / 2];
    errorBefore = decimated.result.error;
    decimated.cursor.moveTo(decimated.steps());
    EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
  }
}

// The error that is claimed bounds the distance of every removed node to the coarse surface: found
// by brute force. A removed node is measured to the triangles of its patch, so the claim may only
// be too large.
TEST(Deviation, ErrorsBoundTheDistanceOfRemovedNodes)
{
  std::mt19937 random(17);
  for (Mesh mesh : { testing::hills(22, 20), testing::torus(24, 16), testing::cube(5) })
  {
    testing::flipEdges(mesh, random, false);
    HashQueueDecimationOptions options;
    for (const double reduction : { 0.5, 0.8, 0.9 })
    {
      options.targetReduction = reduction;
      const Decimated decimated(mesh, options);
      const double diagonal = testing::diagonalOf(mesh);
      const std::vector<Index> triangles = baseTriangles(decimated);
      double largest = 0.0;
      for (const Index node : decimated.removed())
      {
        double nearest = 1e30;
        for (std::size_t i = 0; i < triangles.size(); i += 3)
        {
          nearest = std::min(nearest,
            testing::closestPoint(vectorAt(mesh, node), vectorAt(mesh, triangles[i]),
              vectorAt(mesh, triangles[i + 1]), vectorAt(mesh, triangles[i + 2]))
              .square);
        }
        largest = std::max(largest, std::sqrt(nearest));
      }
      EXPECT_LE(largest / diagonal, decimated.result.error * 1.01 + 1e-6) << reduction;
    }
  }
}

// ---------------------------------------------------------------------------------------------
// Golden traces: a change of the order must be deliberate
// ---------------------------------------------------------------------------------------------

//   8----9---10---11
//   |  / |  / |  / |        Heights (and values): node 5 is a peak of 3/8, node 6 of 1/8,
//   4----5----6----7        all others lie at 0.
//   |  / |  / |  / |
//   0----1----2----3
class TwelveNodes : public ::testing::Test
{
protected:
  TwelveNodes()
    : mesh(testing::heightField(4, 3,
        [](int x, int y) {
          return y != 1 ? 0.0 : x == 1 ? 0.375 : x == 2 ? 0.125 : 0.0;
        }))
    , values(valuesOn(mesh, [](double, double, double z) { return z; }))
  {
    options.targetReduction = 1.0;
    options.maximumError = kInfinity;
    options.arrays = { arrayOf(values) };
  }

  std::vector<Index> trace(Criterion criterion)
  {
    options.criterion = criterion;
    return Decimated(mesh, options).removed();
  }

  Mesh mesh;
  std::vector<float> values;
  HashQueueDecimationOptions options;
};

// By hand, as sum of the differences in eighths / edges / 3 (the range):
//   start: 3 and 8: 0; 2 and 7: 1/12; 11: 1/9; 4 and 9: 1/4; 0, 1, 10: 1/3; 6: 7/18; 5: 17/18
//   3 goes (before 8, first in first out): 2 and 7 become 1/9 and stand behind 11
//   8 goes: 4 and 9 become 1/3 and stand behind 0, 1, 10
//   11 and 2 go (1/9); 7 would fold (10, 6, 1) and waits outside; 1 and 10 go to the end of 1/3
//   0 and 9 go (1/3); 1 and 10 would leave flat triangles, 4 would fold one: they wait
//   6 goes (5/12): 7 is 1/3 now and goes; 1, 4 and 10 are joined, and 5 goes last
TEST_F(TwelveNodes, ScalarDifference)
{
  EXPECT_EQ(trace(Criterion::ScalarDifference), (std::vector<Index>{ 3, 8, 11, 2, 0, 9, 6, 7, 5 }));
}

TEST_F(TwelveNodes, AngleToXYPlane)
{
  EXPECT_EQ(trace(Criterion::AngleToXYPlane), (std::vector<Index>{ 3, 8, 11, 2, 0, 10, 5, 4, 6 }));
}

TEST_F(TwelveNodes, Deviation)
{
  EXPECT_EQ(trace(Criterion::Deviation), (std::vector<Index>{ 2, 6, 1, 10, 4, 7, 9, 5, 0 }));
}

// By hand: node 2 may go to 1 or 3. Node 3 lies in all planes but that of 2-7-6, whose normal is
// (1, -1, 8) / sqrt(66): a distance of 1 / sqrt(66). Weights: a third of the areas, which are
// sqrt(65) / 16 (1-2-6), 1/2 (2-3-7) and sqrt(66) / 16 (2-7-6), and 1 for each boundary edge.
TEST_F(TwelveNodes, Quadric)
{
  EXPECT_EQ(trace(Criterion::Quadric), (std::vector<Index>{ 2, 7, 1, 10, 4, 9, 6, 5, 11 }));
  const double tilted = std::sqrt(66.0) / 48.0;
  const double weight = std::sqrt(65.0) / 48.0 + 1.0 / 6.0 + tilted + 2.0;
  const double diagonal = std::sqrt(9.0 + 4.0 + 9.0 / 64.0);
  options.targetNodes = 11;
  EXPECT_NEAR(
    Decimated(mesh, options).result.error, std::sqrt(tilted / 66.0 / weight) / diagonal, 1e-8);
}

} // namespace
} // namespace undecimate
