// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Steps that wait in removed nodes: the record shows what that of RecordBuilder shows, which gets
// the same steps as they are made.

#include "removal_steps.h"

#include "cell_sources.h"
#include "mean_edge_criterion.h"
#include "testing/meshes.h"
#include "testing/same_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Mesh;

/// Hands a removal to a RecordBuilder.
void append(RecordBuilder& builder, const TriangleTopology& topology, const Hole& hole,
  const HoleTriangulation& filling, double error)
{
  std::vector<Index> slots;
  std::vector<unsigned char> oldCells(std::size_t{ 3 } * hole.triangleCount);
  std::vector<unsigned char> newCells;
  std::vector<unsigned char> sources(kMaximumPatchCells);
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    slots.push_back(triangleOf(hole.corners[i]));
    const auto& nodes = topology.triangle(slots.back()).nodes;
    for (int c = 0; c < 3; ++c)
    {
      const auto* end = hole.ring.begin() + hole.size;
      const auto* place = std::find(hole.ring.begin(), end, nodes[c]);
      oldCells[3 * i + c] =
        static_cast<unsigned char>(place == end ? 0 : place - hole.ring.begin() + 1);
    }
  }
  for (int i = 0; i < filling.count; ++i)
  {
    for (const unsigned char corner : filling.triangles[i])
    {
      newCells.push_back(static_cast<unsigned char>(corner + 1));
    }
  }
  findCellSources(topology, hole, filling, sources.data());
  RecordBuilder::Step step;
  step.node = hole.node;
  step.ring = hole.ring.data();
  step.ringSize = hole.size;
  step.oldCount = hole.triangleCount;
  step.newCount = filling.count;
  step.slots = slots.data();
  step.oldCells = oldCells.data();
  step.newCells = newCells.data();
  step.sources = sources.data();
  step.error = error;
  builder.append(step);
}

Record finish(RecordBuilder& builder, const TriangleTopology& topology, std::vector<Index>& base)
{
  return builder.finish(
    [&topology](Index cell, Index* corners)
    {
      const auto& nodes = topology.triangle(cell).nodes;
      std::copy(nodes.begin(), nodes.end(), corners);
    },
    base);
}

/// A node with `count` triangles, all around it or half around.
Mesh wheel(int count, bool boundary)
{
  Mesh mesh;
  const int rim = boundary ? count + 1 : count;
  mesh.points = { 0.0F, 0.0F, 0.0F };
  for (int i = 0; i < rim; ++i)
  {
    const double angle = std::acos(-1.0) * (boundary ? 1.0 * i / count : 2.0 * i / count);
    mesh.points.insert(mesh.points.end(),
      { static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0F });
  }
  for (int i = 0; i < count; ++i)
  {
    // The node is another corner each time.
    const std::array<Index, 3> nodes{ 0, i + 1, (i + 1) % rim + 1 };
    for (int c = 0; c < 3; ++c)
    {
      mesh.triangles.push_back(nodes[(c + i) % 3]);
    }
  }
  return mesh;
}

/// A fan around ring node `apex`.
HoleTriangulation fan(const Hole& hole, int apex)
{
  HoleTriangulation filling;
  filling.count = hole.size - 2;
  for (int i = 0; i < filling.count; ++i)
  {
    const auto at = [&](int place)
    { return static_cast<unsigned char>((apex + place) % hole.size); };
    filling.triangles[i] = { at(0), at(i + 1), at(i + 2) };
  }
  return filling;
}

struct Setting
{
  bool sources;
  bool keepPositions;
  bool boundary;
};

class OneStep : public ::testing::TestWithParam<Setting>
{
};

// Steps of all sizes: those that fit into the node and those that do not.
TEST_P(OneStep, RecordIsThatOfTheBuilder)
{
  const auto [sources, keepPositions, boundary] = GetParam();
  for (int count = boundary ? 2 : 3; count <= kMaximumPatchCells; ++count)
  {
    SCOPED_TRACE(count);
    const Mesh mesh = wheel(count, boundary);
    TriangleTopology topology(mesh.view());
    StepWriter writer(sources, keepPositions);
    RecordBuilder builder(mesh.nodeCount(), mesh.triangleCount(), sources);
    Hole hole;
    ASSERT_TRUE(topology.gather(0, hole));
    ASSERT_EQ(hole.triangleCount, count);
    const HoleTriangulation filling = fan(hole, count / 2);
    append(builder, topology, hole, filling, 0.25);
    topology.node(0).value = 77;
    const Vector position = topology.node(0).position;
    topology.replace(hole, filling);
    writer.write(topology, hole, filling, 0.25);
    EXPECT_EQ(topology.kind(0), NodeKind::Removed);
    EXPECT_EQ(cellsGone(topology.node(0)), boundary ? 1 : 2);
    if (keepPositions)
    {
      EXPECT_EQ(topology.node(0).value, 77);
      EXPECT_EQ(topology.node(0).position.x, position.x);
      EXPECT_EQ(topology.node(0).position.y, position.y);
      EXPECT_EQ(topology.node(0).position.z, position.z);
    }

    std::vector<Index> base;
    std::vector<Index> sameBase;
    const Record same = finish(builder, topology, sameBase);
    std::vector<Index> removed{ 0 };
    const Record record = recordOf(topology, removed, sources, base);
    EXPECT_TRUE(record.hasCodes);
    testing::expectSameLevels(record, base, same, sameBase, 1);
  }
}

TEST_P(OneStep, UndoBringsTheTrianglesBack)
{
  const auto [sources, keepPositions, boundary] = GetParam();
  for (int count = boundary ? 2 : 3; count <= kMaximumPatchCells; ++count)
  {
    const Mesh mesh = wheel(count, boundary);
    TriangleTopology topology(mesh.view());
    StepWriter writer(sources, keepPositions);
    Hole hole;
    ASSERT_TRUE(topology.gather(0, hole));
    const HoleTriangulation filling = fan(hole, 0);
    topology.replace(hole, filling);
    writer.write(topology, hole, filling, 0.0);
    undo(topology, 0);
    for (Index i = 0; i < mesh.triangleCount(); ++i)
    {
      EXPECT_TRUE(std::equal(topology.triangle(i).nodes.begin(), topology.triangle(i).nodes.end(),
        mesh.triangles.begin() + std::ptrdiff_t{ 3 } * i))
        << count << ", triangle " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, OneStep,
  ::testing::Values(Setting{ false, false, false }, Setting{ false, true, false },
    Setting{ true, false, false }, Setting{ true, true, false }, Setting{ false, false, true },
    Setting{ true, true, true }));

// A corner with one triangle leaves nothing in its place.
TEST(RemovalSteps, CornersThatAreNotFilled)
{
  const Mesh mesh = testing::flatGrid(3, 3);
  for (const bool keepPositions : { false, true })
  {
    TriangleTopology topology(mesh.view());
    Index corner = 0;
    Hole hole;
    while (topology.gather(corner, hole) && hole.triangleCount > 1)
    {
      ++corner;
    }
    ASSERT_EQ(hole.size, 2);
    RecordBuilder builder(mesh.nodeCount(), mesh.triangleCount(), false);
    StepWriter writer(false, keepPositions);
    HoleTriangulation filling;
    append(builder, topology, hole, filling, 0.5);
    topology.replace(hole, filling);
    writer.write(topology, hole, filling, 0.5);
    std::vector<Index> base;
    std::vector<Index> sameBase;
    const Record same = finish(builder, topology, sameBase);
    undo(topology, corner);
    const auto& nodes = topology.triangle(triangleOf(hole.corners[0])).nodes;
    EXPECT_TRUE(std::equal(nodes.begin(), nodes.end(),
      mesh.triangles.begin() + std::ptrdiff_t{ 3 } * triangleOf(hole.corners[0])));
    std::vector<Index> removed{ corner };
    const Record record = recordOf(topology, removed, false, base);
    testing::expectSameLevels(record, base, same, sameBase, 1);
  }
}

// Nearly all nodes of a mesh, in the order of their numbers; so many that the record is made in
// several blocks if there are threads.
TEST(RemovalSteps, ManyStepsByAnyNumberOfThreads)
{
  const Mesh mesh = testing::hills(130, 130);
  for (const bool sources : { false, true })
  {
    for (int threadCount = 0; threadCount <= 3; ++threadCount)
    {
      SCOPED_TRACE(threadCount);
      TriangleTopology topology(mesh.view());
      MeanEdgeCriterion criterion(topology, nullptr);
      StepWriter writer(sources, false);
      RemovalChain chain(topology);
      RecordBuilder builder(mesh.nodeCount(), mesh.triangleCount(), sources);
      Hole hole;
      HoleTriangulation filling;
      double cost = 0.0;
      std::vector<Index> expected;
      for (Index i = 0; i < mesh.nodeCount(); ++i)
      {
        const Index node = static_cast<Index>(std::int64_t{ 7919 } * i % mesh.nodeCount());
        if (!criterion.retriangulate(node, hole, filling, cost))
        {
          continue;
        }
        const double error = std::abs(std::sin(i));
        append(builder, topology, hole, filling, error);
        topology.replace(hole, filling);
        criterion.removed(hole, filling);
        writer.write(topology, hole, filling, error);
        chain.append(node);
        expected.push_back(node);
      }
      ASSERT_GT(expected.size(), 12000U);
      ASSERT_EQ(chain.count(), static_cast<Index>(expected.size()));
      std::vector<Index> removed = chain.nodes();
      EXPECT_EQ(removed, expected);
      std::vector<Index> base;
      std::vector<Index> sameBase;
      const Record same = finish(builder, topology, sameBase);
      std::unique_ptr<Threads> threads;
      if (threadCount > 0)
      {
        threads = std::make_unique<Threads>(threadCount);
      }
      const Record record = recordOf(topology, removed, sources, base, threads.get());
      testing::expectSameLevels(record, base, same, sameBase, 15);
    }
  }
}

TEST(RemovalSteps, NoStepsLeaveTheMeshAsItIs)
{
  const Mesh mesh = testing::hills(5, 5);
  TriangleTopology topology(mesh.view());
  EXPECT_TRUE(RemovalChain(topology).nodes().empty());
  std::vector<Index> removed;
  std::vector<Index> base;
  const Record record = recordOf(topology, removed, true, base);
  EXPECT_EQ(record.baseNodeCount, mesh.nodeCount());
  EXPECT_EQ(record.baseSources.size(), base.size() / 3);
  EXPECT_TRUE(std::equal(base.begin(), base.end(), mesh.triangles.begin(), mesh.triangles.end()));
}

} // namespace
} // namespace undecimate
