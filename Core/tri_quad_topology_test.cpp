// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// The proof of [W06] section 7 as a property: a collapse that fulfils P1*, P2 and P3 leaves a valid
// mesh valid. And the other way round: without any one of them random collapses break meshes soon.

#include "testing/tri_quad_meshes.h"

#include <gtest/gtest.h>

#include <string>

namespace undecimate
{
namespace
{

using testing::Cells;
using testing::MixedMesh;

Cells cellsNow(const TriQuadTopology& topology)
{
  Cells cells;
  for (Index slot = 0; slot < topology.cellCount(); ++slot)
  {
    const Index* cell = topology.cell(slot);
    if (std::any_of(cell, cell + 4, [](Index n) { return n != kNone; }))
    {
      cells.push_back({ cell[0], cell[1], cell[2], cell[3] });
    }
  }
  return cells;
}

MixedMesh randomMesh(unsigned seed, std::mt19937& random)
{
  const double triangles = std::array<double, 4>{ 0.0, 0.15, 0.5, 1.0 }[random() % 4];
  const auto size = [&](int least) { return least + static_cast<int>(random() % 4); };
  switch (seed % 5)
  {
    case 0:
      return testing::mixedGrid(size(2), size(2), false, false, triangles, random);
    case 1:
      return testing::mixedGrid(size(3), size(2), true, false, triangles, random);
    case 2:
      return testing::mixedGrid(size(3), size(3), true, true, triangles, random);
    case 3:
      return testing::mixedBox(1 + static_cast<int>(random() % 2), triangles, random);
    default:
    {
      // Two pieces: each is a mesh of its own.
      MixedMesh mesh = testing::mixedBox(1, triangles, random);
      const MixedMesh other = testing::mixedGrid(size(2), 2, false, false, triangles, random);
      const Index first = mesh.nodeCount();
      mesh.positions[0].insert(
        mesh.positions[0].end(), other.positions[0].begin(), other.positions[0].end());
      for (auto cell : other.cells)
      {
        for (Index& node : cell)
        {
          node += node == kNone ? 0 : first;
        }
        mesh.cells.push_back(cell);
      }
      return mesh;
    }
  }
}

struct Outcomes
{
  int collapses = 0;
  int meshes = 0;
  int invalid = 0; // meshes that broke
  std::string first;
};

/// Random collapses as the rules allow until none is left, on many meshes.
Outcomes collapseRandomly(const CollapseRules& rules, unsigned seeds)
{
  Outcomes outcomes;
  for (unsigned seed = 0; seed < seeds; ++seed)
  {
    std::mt19937 random(seed);
    const MixedMesh mesh = randomMesh(seed, random);
    const auto valid = testing::isValidMesh(mesh.cells);
    if (!valid)
    {
      continue; // two quads around a tube, say
    }
    ++outcomes.meshes;
    TriQuadTopology topology(mesh.view(), rules);
    std::vector<Index> nodes(mesh.nodeCount());
    for (Index i = 0; i < mesh.nodeCount(); ++i)
    {
      nodes[i] = i;
    }
    std::set<Index> left(nodes.begin(), nodes.end());
    bool moved = true;
    bool broken = false;
    while (moved && !broken)
    {
      moved = false;
      std::shuffle(nodes.begin(), nodes.end(), random);
      for (const Index node : nodes)
      {
        Fan fan;
        if (!left.count(node) || !topology.gather(node, fan) || fan.cellCount == 0)
        {
          continue;
        }
        const auto start = static_cast<int>(random() % fan.neighbourCount);
        for (int k = 0; k < fan.neighbourCount; ++k)
        {
          const Index target = fan.neighbours[(start + k) % fan.neighbourCount];
          if (!topology.mayCollapse(fan, target))
          {
            continue;
          }
          topology.collapse(fan, target);
          left.erase(node);
          ++outcomes.collapses;
          moved = true;
          auto sound = testing::isValidMesh(cellsNow(topology));
          std::set<Index> used;
          for (const auto& cell : cellsNow(topology))
          {
            const auto corners = testing::cornersOf(cell);
            used.insert(corners.begin(), corners.end());
          }
          if (sound && used != left)
          {
            sound = ::testing::AssertionFailure() << "a node has lost all its cells";
          }
          if (!sound)
          {
            broken = true;
            ++outcomes.invalid;
            outcomes.first = outcomes.first.empty()
              ? "seed " + std::to_string(seed) + ": " + sound.message()
              : outcomes.first;
          }
          break;
        }
        if (broken)
        {
          break;
        }
      }
    }
  }
  return outcomes;
}

constexpr unsigned kSeeds = 600;

TEST(TriQuadTopology, CollapsesKeepMeshesValid)
{
  const Outcomes outcomes = collapseRandomly({}, kSeeds);
  EXPECT_EQ(outcomes.invalid, 0) << outcomes.first;
  EXPECT_GT(outcomes.meshes, 500);
  EXPECT_GT(outcomes.collapses, 5000);
}

// Each rule is needed: the same test fails without it.
TEST(TriQuadTopology, TheRuleForTrianglesIsNotEnough)
{
  CollapseRules rules;
  rules.neighbours = NeighbourRule::FirstOrder;
  EXPECT_GT(collapseRandomly(rules, kSeeds).invalid, 0) << "P1 in the place of P1*";
}

TEST(TriQuadTopology, TheNeighbourRuleIsNeeded)
{
  CollapseRules rules;
  rules.neighbours = NeighbourRule::None;
  EXPECT_GT(collapseRandomly(rules, kSeeds).invalid, 0) << "no P1*";
}

TEST(TriQuadTopology, TheBoundaryRuleIsNeeded)
{
  CollapseRules rules;
  rules.boundaryEdge = false;
  EXPECT_GT(collapseRandomly(rules, kSeeds).invalid, 0) << "no P2";
}

TEST(TriQuadTopology, TheRuleForTheLastNodesIsNeeded)
{
  CollapseRules rules;
  rules.lastNodes = false;
  EXPECT_GT(collapseRandomly(rules, kSeeds).invalid, 0) << "no P3";
}

// Three quads around a tube: the paper asks nothing but P2 of edges between quads, but here an edge
// would get four cells.
TEST(TriQuadTopology, QuadEdgesNeedTheNeighbourRuleToo)
{
  std::mt19937 random(1);
  const MixedMesh mesh = testing::mixedGrid(3, 4, true, false, 0.0, random);
  const auto tryAll = [&](const CollapseRules& rules)
  {
    TriQuadTopology topology(mesh.view(), rules);
    Fan fan;
    EXPECT_TRUE(topology.gather(6, fan)); // second row, inside
    const bool may = topology.mayCollapse(fan, 7);
    if (may)
    {
      topology.collapse(fan, 7);
    }
    return std::make_pair(may, static_cast<bool>(testing::isValidMesh(cellsNow(topology))));
  };
  EXPECT_EQ(tryAll({}), std::make_pair(false, true));
  CollapseRules rules;
  rules.neighbours = NeighbourRule::None;
  EXPECT_EQ(tryAll(rules), std::make_pair(true, false));
}

// A grid of 4 x 4 quads. Node 12 is the middle, and 2 the middle of a side.
class QuadGrid : public ::testing::Test
{
protected:
  QuadGrid()
    : topology(this->mesh.view())
  {
  }

  std::mt19937 random{ 1 };
  const MixedMesh mesh = testing::mixedGrid(4, 4, false, false, 0.0, this->random);
  TriQuadTopology topology;
  Fan fan;
};

// [W06] fig. 3: two quads become triangles, nothing else changes.
TEST_F(QuadGrid, QuadEdgeMakesTriangles)
{
  ASSERT_TRUE(topology.gather(12, fan)); // the middle
  EXPECT_FALSE(fan.boundary);
  EXPECT_EQ(fan.cellCount, 4);
  EXPECT_EQ(fan.neighbourCount, 4);
  ASSERT_TRUE(topology.mayCollapse(fan, 13));
  topology.collapse(fan, 13);
  const Cells cells = cellsNow(topology);
  EXPECT_EQ(cells.size(), 16U);
  EXPECT_EQ(std::count_if(cells.begin(), cells.end(),
              [](const auto& cell) { return testing::cornersOf(cell).size() == 3; }),
    2);
  EXPECT_TRUE(testing::isValidMesh(cells));
}

TEST_F(QuadGrid, RefusesNodesThatAreNoNeighbours)
{
  ASSERT_TRUE(topology.gather(12, fan));
  EXPECT_FALSE(topology.mayCollapse(fan, 18)) << "across a quad";
  EXPECT_FALSE(topology.mayCollapse(fan, 24));
}

TEST_F(QuadGrid, BoundaryNodesStayOnTheBoundary)
{
  ASSERT_TRUE(topology.gather(2, fan));
  EXPECT_TRUE(fan.boundary);
  EXPECT_TRUE(topology.mayCollapse(fan, 1));
  EXPECT_FALSE(topology.mayCollapse(fan, 7)) << "inwards";
}

TEST(TriQuadTopology, SplitsTJoints)
{
  const MixedMesh mesh = testing::mixedTJoint(4);
  const TriQuadTopology topology(mesh.view());
  // Each of the five nodes of the joint: two sides of the floor and the wall.
  EXPECT_EQ(topology.copyCount(), mesh.nodeCount() + 2 * 5);
  int copies = 0;
  for (Index copy = 11; copy != kNone; copy = topology.nextCopy(copy))
  {
    EXPECT_EQ(topology.nodeOf(copy), 11);
    Fan fan;
    ASSERT_TRUE(topology.gather(copy, fan));
    EXPECT_TRUE(fan.boundary);
    EXPECT_EQ(fan.cellCount, 2);
    ++copies;
  }
  EXPECT_EQ(copies, 3);
  EXPECT_EQ(topology.kind(11), TriQuadNodeKind::Seam);
  EXPECT_EQ(topology.kind(6), TriQuadNodeKind::Interior);
  EXPECT_EQ(topology.kind(0), TriQuadNodeKind::Boundary);
}

TEST(TriQuadTopology, SplitsParts)
{
  std::mt19937 random(1);
  MixedMesh mesh = testing::mixedGrid(4, 4, false, false, 0.0, random);
  mesh.parts.resize(16);
  for (Index c = 0; c < 16; ++c)
  {
    mesh.parts[c] = c % 4 < 2 ? 7 : 3;
  }
  const TriQuadTopology topology(mesh.view());
  EXPECT_EQ(topology.copyCount(), mesh.nodeCount() + 5);
  EXPECT_EQ(topology.kind(12), TriQuadNodeKind::Seam);
  EXPECT_EQ(topology.kind(11), TriQuadNodeKind::Interior);
  EXPECT_FALSE(topology.hasFreeEdge(12));
  EXPECT_TRUE(topology.hasFreeEdge(2));
}

TEST(TriQuadTopology, LeavesBadCellsOut)
{
  std::mt19937 random(1);
  MixedMesh mesh = testing::mixedGrid(6, 6, false, false, 0.0, random);
  mesh.cells[0][1] = mesh.cells[0][0];  // a node twice
  mesh.cells.push_back(mesh.cells[20]); // a cell twice
  std::rotate(mesh.cells[36].begin(), mesh.cells[36].begin() + 1, mesh.cells[36].end());
  const Index lone = mesh.addNode(9.0, 9.0, 0.0); // no cell
  const TriQuadTopology topology(mesh.view());
  for (const Index cell : { 0, 20 })
  {
    for (const Index node : testing::cornersOf(mesh.cells[cell]))
    {
      EXPECT_EQ(topology.kind(node), TriQuadNodeKind::Irregular);
    }
  }
  EXPECT_EQ(topology.kind(lone), TriQuadNodeKind::Unused);
  EXPECT_EQ(topology.kind(5 * 7 + 1), TriQuadNodeKind::Interior);
}

// Two quads that share two edges break M2 at the node between the edges.
TEST(TriQuadTopology, LeavesNodesOfTwoCellsOut)
{
  MixedMesh mesh;
  for (int i = 0; i < 5; ++i)
  {
    mesh.addNode(i, i * i, 0.0);
  }
  mesh.cells = { { 0, 1, 2, 3 }, { 0, 3, 2, 4 } };
  const TriQuadTopology topology(mesh.view());
  for (Index node = 0; node < 5; ++node)
  {
    EXPECT_EQ(topology.kind(node), TriQuadNodeKind::Irregular);
  }
}

TEST(TriQuadTopology, GivesTheCellsBack)
{
  const MixedMesh mesh = testing::mixedTJoint(4);
  TriQuadTopology topology(mesh.view());
  const std::vector<Index> cells = topology.takeCells();
  EXPECT_TRUE(std::equal(cells.begin(), cells.end(), mesh.cells[0].data()));
}

} // namespace
} // namespace undecimate
