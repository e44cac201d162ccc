// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// What must hold for any mesh at any level: edges stay manifold and oriented, each node has one
// fan, no triangle is degenerate or repeated, the Euler characteristic and the number of boundary
// loops stay, plane meshes do not flip, and level 1 is the original.

#include "testing/decimated.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::Mesh;

struct Kind
{
  const char* name;
  Mesh (*make)(std::mt19937& random);
};

Mesh randomField(std::mt19937& random)
{
  // Nodes off the grid on hills of slopes of at most 0.3.
  std::uniform_real_distribution<double> off(-0.2, 0.2);
  Mesh mesh =
    testing::hills(10 + static_cast<int>(random() % 14), 10 + static_cast<int>(random() % 14));
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    mesh.points[3 * i] += off(random);
    mesh.points[3 * i + 1] += off(random);
  }
  testing::flipEdges(mesh, random, true);
  return mesh;
}

Mesh randomPlane(std::mt19937& random)
{
  Mesh mesh = randomField(random);
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    mesh.points[3 * i + 2] = 0.0;
  }
  return mesh;
}

Mesh randomTorus(std::mt19937& random)
{
  Mesh mesh =
    testing::torus(8 + static_cast<int>(random() % 12), 6 + static_cast<int>(random() % 8));
  testing::flipEdges(mesh, random, false);
  return mesh;
}

Mesh randomDisc(std::mt19937& random)
{
  Mesh mesh =
    testing::disc(2 + static_cast<int>(random() % 6), 5 + static_cast<int>(random() % 70));
  testing::flipEdges(mesh, random, false);
  return mesh;
}

Mesh randomCube(std::mt19937& random)
{
  Mesh mesh = testing::cube(2 + static_cast<int>(random() % 5));
  testing::flipEdges(mesh, random, false);
  return mesh;
}

// A torus with triangles missing: many boundary loops.
Mesh randomSieve(std::mt19937& random)
{
  for (;;)
  {
    const Mesh holed = testing::sieve(randomTorus(random), random, 8);
    // Holes may touch in a node; those that do are another test's.
    if (testing::hasOneFanAtEachNode(holed.triangles) || random() % 20 == 0)
    {
      return holed;
    }
  }
}

/// Closed chains of boundary edges.
int boundaryLoops(const std::vector<Index>& triangles)
{
  std::map<Index, std::vector<Index>> beside;
  for (const auto& [a, b] : testing::boundaryEdges(triangles))
  {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  int loops = 0;
  while (!beside.empty())
  {
    ++loops;
    std::vector<Index> open{ beside.begin()->first };
    while (!open.empty())
    {
      const Index node = open.back();
      open.pop_back();
      const auto found = beside.find(node);
      if (found != beside.end())
      {
        open.insert(open.end(), found->second.begin(), found->second.end());
        beside.erase(found);
      }
    }
  }
  return loops;
}

constexpr double kNever = 2.0;

struct Case
{
  Kind kind;
  Criterion criterion;
  /// All triangles look up as long as more than this fraction of them is left. (With a few left
  /// there is not much of a field, and its boundary may be anywhere.)
  double looksUpAbove;
};

class RandomMeshes : public ::testing::TestWithParam<Case>
{
};

TEST_P(RandomMeshes, KeepTheirPropertiesAtEveryLevel)
{
  const auto& [kind, criterion, looksUpAbove] = GetParam();
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Mesh mesh = testing::shuffled(kind.make(random), random);
    ASSERT_TRUE(testing::isManifoldAndOriented(mesh.triangles));
    const bool oneFan = static_cast<bool>(testing::hasOneFanAtEachNode(mesh.triangles));
    const int euler = testing::eulerCharacteristic(mesh.triangles);
    const int loops = boundaryLoops(mesh.triangles);
    const std::vector<float> values = testing::valuesOn(
      mesh, [](double x, double y, double z) { return std::sin(x) + 0.2 * y * z; });

    HashQueueDecimationOptions options;
    options.criterion = criterion;
    options.targetReduction = 1.0;
    options.maximumError = HUGE_VAL;
    options.arrays = { testing::arrayOf(values) };
    options.intervalSpacing =
      seed % 2 == 0 ? IntervalSpacing::Logarithmic : IntervalSpacing::Exponential;
    options.trackCellSources = seed % 3 == 0;
    options.preserveBoundary = seed % 4 == 0;
    options.scalarWeight = seed % 3 == 1 ? 0.0 : 0.1;
    Decimated decimated(mesh, options);
    ASSERT_EQ(decimated.result.stopReason, StopReason::NoRemovableNode);
    ASSERT_GT(decimated.steps(), 0);

    const Index stride = 1 + decimated.steps() / 60;
    for (Index step = 0; step <= decimated.steps(); step += stride)
    {
      decimated.cursor.moveTo(step);
      const std::vector<Index> triangles = testing::originalNumbers(decimated.cursor);
      ASSERT_TRUE(testing::isManifoldAndOriented(triangles)) << "step " << step;
      ASSERT_TRUE(testing::hasNoDegenerateOrRepeated(triangles)) << "step " << step;
      ASSERT_EQ(testing::eulerCharacteristic(triangles), euler) << "step " << step;
      if (oneFan)
      {
        ASSERT_TRUE(testing::hasOneFanAtEachNode(triangles)) << "step " << step;
        ASSERT_EQ(boundaryLoops(triangles), loops) << "step " << step;
      }
      if (triangles.size() > looksUpAbove * static_cast<double>(mesh.triangles.size()))
      {
        ASSERT_TRUE(testing::looksUp(mesh, triangles)) << "step " << step;
      }
      if (options.preserveBoundary)
      {
        ASSERT_EQ(testing::boundaryEdges(triangles), testing::boundaryEdges(mesh.triangles));
      }
    }
    decimated.cursor.moveTo(decimated.steps());
    ASSERT_TRUE(testing::isOriginal(decimated.cursor, mesh));
  }
}

constexpr Kind kPlane{ "Plane", randomPlane };
constexpr Kind kField{ "Field", randomField };
constexpr Kind kTorus{ "Torus", randomTorus };
constexpr Kind kDisc{ "Disc", randomDisc };
constexpr Kind kCube{ "Cube", randomCube };
constexpr Kind kSieve{ "Sieve", randomSieve };

std::string nameOf(const ::testing::TestParamInfo<Case>& info)
{
  const char* const criteria[] = { "Deviation", "ScalarDifference", "AngleToXYPlane", "Quadric" };
  return std::string(info.param.kind.name) + criteria[static_cast<int>(info.param.criterion)];
}

INSTANTIATE_TEST_SUITE_P(Kinds, RandomMeshes,
  ::testing::Values(Case{ kPlane, Criterion::Deviation, 0.0 },
    Case{ kField, Criterion::Deviation, 0.1 }, Case{ kTorus, Criterion::Deviation, kNever },
    Case{ kDisc, Criterion::Deviation, kNever }, Case{ kCube, Criterion::Deviation, kNever },
    Case{ kSieve, Criterion::Deviation, kNever }, Case{ kPlane, Criterion::ScalarDifference, 0.0 },
    Case{ kField, Criterion::ScalarDifference, 0.1 },
    Case{ kTorus, Criterion::ScalarDifference, kNever },
    Case{ kDisc, Criterion::ScalarDifference, kNever },
    Case{ kCube, Criterion::ScalarDifference, kNever },
    Case{ kSieve, Criterion::ScalarDifference, kNever },
    Case{ kPlane, Criterion::AngleToXYPlane, 0.0 }, Case{ kField, Criterion::AngleToXYPlane, 0.1 },
    Case{ kTorus, Criterion::AngleToXYPlane, kNever },
    Case{ kSieve, Criterion::AngleToXYPlane, kNever }, Case{ kPlane, Criterion::Quadric, 0.0 },
    Case{ kField, Criterion::Quadric, 0.1 }, Case{ kTorus, Criterion::Quadric, kNever },
    Case{ kDisc, Criterion::Quadric, kNever }, Case{ kCube, Criterion::Quadric, kNever },
    Case{ kSieve, Criterion::Quadric, kNever }),
  nameOf);

} // namespace
} // namespace undecimate
