// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Decimation by several threads: the same result for any number of them, and all that holds for
// the serial one.

#include "testing/decimated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::expectSame;
using testing::Mesh;

Mesh field(int n)
{
  return testing::heightField(n, n,
    [n](double x, double y)
    { return 0.05 * n * (std::sin(9.0 * x / n) * std::cos(7.0 * y / n) + x * y / (n * n)); });
}

std::vector<float> valuesOf(const Mesh& mesh)
{
  return testing::valuesOn(
    mesh, [](double x, double y, double z) { return std::sin(0.1 * x) + 0.2 * y * z; });
}

HashQueueDecimationOptions parallelOptions(Criterion criterion, int threads = 2)
{
  HashQueueDecimationOptions options;
  options.criterion = criterion;
  options.parallel = true;
  options.threads = threads;
  return options;
}

class Parallel : public ::testing::TestWithParam<Criterion>
{
protected:
  void start(int n, int threads = 2)
  {
    mesh = field(n);
    values = valuesOf(mesh);
    options = parallelOptions(GetParam(), threads);
    options.arrays = { testing::arrayOf(values) };
  }

  Mesh mesh;
  std::vector<float> values;
  HashQueueDecimationOptions options;
};

TEST_P(Parallel, TheNumberOfThreadsDoesNotMatter)
{
  this->start(90, 1);
  options.targetReduction = 0.85;
  options.trackCellSources = true;
  const Decimated one(mesh, options);
  ASSERT_GT(one.steps(), 5000);
  for (const int threads : { 2, 3, 7, 0, 2 })
  {
    SCOPED_TRACE(threads);
    options.threads = threads;
    expectSame(one.result, Decimated(mesh, options).result);
  }
}

TEST_P(Parallel, StopsWhereTheSerialOneDoes)
{
  this->start(80);
  options.targetReduction = 1.0;
  options.targetNodes = 777;
  Decimated nodes(mesh, options);
  EXPECT_EQ(nodes.result.record.baseNodeCount, 777);
  EXPECT_EQ(nodes.result.stopReason, StopReason::TargetNodes);
  EXPECT_EQ(nodes.result.error, nodes.cursor.error());

  options.targetNodes = 0;
  options.targetTriangles = 3001;
  Decimated triangles(mesh, options);
  EXPECT_LE(triangles.result.record.baseCellCount, 3001);
  EXPECT_GE(triangles.result.record.baseCellCount, 3000);
  EXPECT_EQ(triangles.result.stopReason, StopReason::TargetTriangles);

  options.targetTriangles = 0;
  options.targetReduction = 0.0;
  Decimated none(mesh, options);
  EXPECT_EQ(none.steps(), 0);
  EXPECT_EQ(none.result.stopReason, StopReason::TargetReduction);
}

TEST_P(Parallel, MaximumErrorIsKept)
{
  this->start(80);
  options.targetReduction = 1.0;
  options.maximumError = GetParam() == Criterion::AngleToXYPlane ? 8.0
    : GetParam() == Criterion::ScalarDifference                  ? 0.02
    : GetParam() == Criterion::Quadric                           ? 5e-4
                                                                 : 2e-3;
  Decimated parallel(mesh, options);
  options.parallel = false;
  Decimated serial(mesh, options);
  EXPECT_EQ(parallel.result.stopReason, StopReason::MaximumError);
  EXPECT_LE(parallel.result.error, options.maximumError * (1.0 + 1e-6));
  const double ratio = static_cast<double>(parallel.result.record.baseNodeCount) /
    static_cast<double>(serial.result.record.baseNodeCount);
  // The two means are no distances: another order changes more.
  const bool distance = GetParam() == Criterion::Deviation || GetParam() == Criterion::Quadric;
  const double most = distance ? 1.1 : 1.3;
  EXPECT_GT(ratio, 1.0 / most);
  EXPECT_LT(ratio, most);
}

TEST_P(Parallel, AllThatCanGoGoes)
{
  this->start(60);
  options.targetReduction = 1.0;
  Decimated parallel(mesh, options);
  EXPECT_EQ(parallel.result.stopReason, StopReason::NoRemovableNode);
  EXPECT_LT(parallel.result.record.baseNodeCount, 100);
  parallel.cursor.moveTo(parallel.steps());
  EXPECT_TRUE(testing::isOriginal(parallel.cursor, mesh));
}

TEST_P(Parallel, SmallMeshesAreLeftToTheSerialAlgorithm)
{
  this->start(40, 3);
  const Decimated parallel(mesh, options);
  options.parallel = false;
  expectSame(parallel.result, Decimated(mesh, options).result);
}

TEST_P(Parallel, CancelIsHeard)
{
  this->start(80, 3);
  options.targetReduction = 0.99;
  for (const double when : { 0.0, 0.1, 0.5, 0.9 })
  {
    Monitor monitor([when](double fraction) { return fraction < when; });
    HashQueueDecimationResult result;
    EXPECT_EQ(decimate(mesh.view(), options, monitor, result).status, Status::Cancelled) << when;
    EXPECT_TRUE(result.record.nodeOrder.empty());
  }
  Monitor monitor(
    [](double fraction) -> bool
    {
      if (fraction > 0.3)
      {
        throw std::runtime_error("the window is closed");
      }
      return true;
    });
  HashQueueDecimationResult result;
  const Outcome outcome = decimate(mesh.view(), options, monitor, result);
  EXPECT_EQ(outcome.status, Status::Cancelled);
  EXPECT_NE(outcome.message.find("the window is closed"), std::string::npos) << outcome.message;
}

TEST_P(Parallel, ProgressRisesToOne)
{
  this->start(80);
  std::vector<double> told;
  Monitor monitor(
    [&told](double fraction)
    {
      told.push_back(fraction);
      return true;
    });
  HashQueueDecimationResult result;
  ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
  EXPECT_GT(told.size(), 5U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Criteria, Parallel,
  ::testing::Values(Criterion::Deviation, Criterion::ScalarDifference, Criterion::AngleToXYPlane,
    Criterion::Quadric));

struct Kind
{
  const char* name;
  Mesh (*make)(std::mt19937& random);
};

Mesh randomField(std::mt19937& random)
{
  Mesh mesh = testing::hills(70, 60);
  testing::flipEdges(mesh, random, true);
  return mesh;
}

Mesh randomTorus(std::mt19937& random)
{
  Mesh mesh = testing::torus(80, 45);
  testing::flipEdges(mesh, random, false);
  return mesh;
}

// With a sixteenth of its triangles missing.
Mesh randomSieve(std::mt19937& random)
{
  return testing::sieve(randomTorus(random), random, 16);
}

class ParallelMeshes : public ::testing::TestWithParam<Kind>
{
};

TEST_P(ParallelMeshes, KeepTheirPropertiesAtEveryLevel)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE(std::string(GetParam().name) + ", seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Mesh mesh = testing::shuffled(GetParam().make(random), random);
    ASSERT_TRUE(testing::isManifoldAndOriented(mesh.triangles));
    const int euler = testing::eulerCharacteristic(mesh.triangles);
    const std::vector<float> values = valuesOf(mesh);
    HashQueueDecimationOptions options =
      parallelOptions(seed % 2 == 0 ? Criterion::Deviation : Criterion::ScalarDifference);
    options.targetReduction = 1.0;
    options.arrays = { testing::arrayOf(values) };
    options.intervalSpacing =
      seed % 2 == 0 ? IntervalSpacing::Logarithmic : IntervalSpacing::Exponential;
    options.trackCellSources = seed > 2;
    options.preserveBoundary = seed == 3;
    Decimated decimated(mesh, options);
    options.parallel = false;
    const Index serialSteps = Decimated(mesh, options).steps();
    ASSERT_GT(decimated.steps(), 0.9 * serialSteps);
    ASSERT_LT(decimated.steps(), 1.1 * serialSteps);
    for (Index step = 0; step <= decimated.steps(); step += 1 + decimated.steps() / 12)
    {
      decimated.cursor.moveTo(step);
      const std::vector<Index> triangles = testing::originalNumbers(decimated.cursor);
      ASSERT_TRUE(testing::isManifoldAndOriented(triangles)) << "step " << step;
      ASSERT_TRUE(testing::hasNoDegenerateOrRepeated(triangles)) << "step " << step;
      ASSERT_EQ(testing::eulerCharacteristic(triangles), euler) << "step " << step;
      if (options.preserveBoundary)
      {
        ASSERT_EQ(testing::boundaryEdges(triangles), testing::boundaryEdges(mesh.triangles));
      }
    }
    decimated.cursor.moveTo(decimated.steps());
    ASSERT_TRUE(testing::isOriginal(decimated.cursor, mesh));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ParallelMeshes,
  ::testing::Values(
    Kind{ "Field", randomField }, Kind{ "Torus", randomTorus }, Kind{ "Sieve", randomSieve }),
  [](const ::testing::TestParamInfo<Kind>& info) { return std::string(info.param.name); });

// Of each level the error of the parallel decimation against the serial one. The largest error of
// few nodes hangs on one of them: 0.94 to 1.13 at 2 % of fields of this kind.
TEST(ParallelDeviation, IsAboutAsNearAsTheSerialOne)
{
  const Mesh mesh = field(120);
  HashQueueDecimationOptions options = parallelOptions(Criterion::Deviation);
  options.targetReduction = 0.98;
  Decimated parallel(mesh, options);
  options.parallel = false;
  Decimated serial(mesh, options);
  double sum = 0.0;
  for (const double left : { 0.5, 0.2, 0.1, 0.05, 0.02 })
  {
    const Index nodes = static_cast<Index>(left * mesh.nodeCount());
    parallel.cursor.moveTo(std::max(0, nodes - parallel.result.record.baseNodeCount));
    serial.cursor.moveTo(std::max(0, nodes - serial.result.record.baseNodeCount));
    const double ratio = parallel.cursor.error() / serial.cursor.error();
    EXPECT_LT(ratio, 1.15) << left;
    sum += std::log(ratio);
  }
  EXPECT_LT(std::exp(sum / 5.0), 1.04);
}

class ParallelFarFromTheGoal : public ::testing::TestWithParam<Criterion>
{
protected:
  // More triangles than the exact order begins with.
  Mesh mesh = field(235);
  HashQueueDecimationOptions options = parallelOptions(GetParam(), 1);

  ParallelFarFromTheGoal()
  {
    EXPECT_GT(mesh.triangleCount(), 105000);
    options.targetReduction = 0.97;
  }
};

// The rough order does not depend on threads, and the result is as near as the serial one's.
TEST_P(ParallelFarFromTheGoal, TheOrderIsARoughOneToo)
{
  Decimated one(mesh, options);
  options.threads = 3;
  expectSame(one.result, Decimated(mesh, options).result);
  options.parallel = false;
  const Decimated serial(mesh, options);
  EXPECT_LT(one.result.error, 1.1 * serial.result.error);
  EXPECT_GT(one.result.error, serial.result.error / 1.1);
  one.cursor.moveTo(one.steps());
  EXPECT_TRUE(testing::isOriginal(one.cursor, mesh));
}

// A node far away puts all others into one part, which is left to one thread from the start to the
// goal: step by step as without threads, and rough where they are.
TEST_P(ParallelFarFromTheGoal, OnePartIsDecimatedAsTheSerialOneDoes)
{
  mesh.points.insert(mesh.points.end(), { -1e7, -1e7, -1e7 });
  const Decimated parallel(mesh, options);
  options.parallel = false;
  expectSame(parallel.result, Decimated(mesh, options).result);
}

INSTANTIATE_TEST_SUITE_P(
  Criteria, ParallelFarFromTheGoal, ::testing::Values(Criterion::Deviation, Criterion::Quadric));

// All costs are equal; nodes must not go part by part.
TEST(ParallelDeviation, FlatMeshesThinOutEvenly)
{
  const int n = 100;
  const Mesh mesh = testing::flatGrid(n, n);
  HashQueueDecimationOptions options = parallelOptions(Criterion::Deviation);
  options.targetReduction = 0.75;
  Decimated decimated(mesh, options);
  EXPECT_LT(decimated.result.error, 1e-6);
  std::array<int, 16> counts{};
  for (const Index node : decimated.baseNodes())
  {
    ++counts[node / n / 25 * 4 + node % n / 25];
  }
  for (const int count : counts)
  {
    EXPECT_GT(count, 625 / 8) << "of 625 nodes";
    EXPECT_LT(count, 625 / 2) << "of 625 nodes";
  }
}

TEST(ParallelHostile, OddMeshesStayWhole)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Mesh plain = field(70);
  std::vector<std::pair<const char*, Mesh>> meshes;
  meshes.emplace_back("outlier", plain);
  meshes.back().second.points[3] = 1e30;
  meshes.emplace_back("NaN", plain);
  for (Index i = 0; i < plain.nodeCount(); i += 97)
  {
    meshes.back().second.points[3 * i + i % 3] = nan;
  }
  meshes.emplace_back("all NaN", plain);
  for (double& x : meshes.back().second.points)
  {
    x = nan;
  }
  meshes.emplace_back("one place", plain);
  for (double& x : meshes.back().second.points)
  {
    x = 1.0;
  }
  meshes.emplace_back("too large for a double", plain);
  for (double& x : meshes.back().second.points)
  {
    x = std::fmod(x, 2.0) < 1.0 ? -1e308 : 1e308;
  }
  meshes.emplace_back("repeated and degenerate triangles", plain);
  for (Index t = 0; t < 300; t += 3)
  {
    const Index a = plain.triangles[3 * t];
    meshes.back().second.addTriangle(a, plain.triangles[3 * t + 1], plain.triangles[3 * t + 2]);
    meshes.back().second.addTriangle(a, a, plain.triangles[3 * t + 1]);
    meshes.back().second.addTriangle(a, plain.triangles[3 * t + 1], plain.nodeCount() - 1 - a);
  }
  meshes.emplace_back("touching pieces", testing::tJoint(40));
  meshes.back().second.append(plain);
  meshes.emplace_back("no triangle", plain);
  meshes.back().second.triangles.clear();
  meshes.emplace_back("nothing", Mesh());
  for (const Criterion criterion :
    { Criterion::Deviation, Criterion::ScalarDifference, Criterion::Quadric })
  {
    for (const auto& [name, mesh] : meshes)
    {
      SCOPED_TRACE(name);
      const std::vector<float> values(mesh.nodeCount() + 1, 0.5F);
      HashQueueDecimationOptions options = parallelOptions(criterion, 3);
      options.arrays = { testing::arrayOf(values) };
      options.targetReduction = 1.0;
      Decimated decimated(mesh, options);
      ASSERT_TRUE(testing::hasNoDegenerateOrRepeated(testing::originalNumbers(decimated.cursor)) ||
        std::string(name) == "repeated and degenerate triangles");
      decimated.cursor.moveTo(decimated.steps());
      ASSERT_TRUE(testing::isOriginal(decimated.cursor, mesh));
    }
  }
}

TEST(ParallelHostile, KeptNodesStay)
{
  const Mesh mesh = field(70);
  std::vector<unsigned char> keep(mesh.nodeCount(), 1);
  for (Index i = 0; i < mesh.nodeCount(); i += 3)
  {
    keep[i] = 0;
  }
  TriangleMeshView view = mesh.view();
  view.keep = keep.data();
  HashQueueDecimationOptions options = parallelOptions(Criterion::Deviation);
  options.targetReduction = 1.0;
  const Decimated decimated(view, options);
  EXPECT_GT(decimated.steps(), 1000);
  for (const Index node : decimated.removed())
  {
    ASSERT_FALSE(keep[node]) << node;
  }
}

} // namespace
} // namespace undecimate
