// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "triangle_topology.h"

#include "testing/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Mesh;

TriangleTopology topologyOf(const Mesh& mesh)
{
  return TriangleTopology(mesh.triangles.data(), mesh.triangleCount(), mesh.nodeCount());
}

std::vector<Index> ringOf(const Hole& hole)
{
  return { hole.ring.begin(), hole.ring.begin() + hole.size };
}

/// Turn a closed ring so that it starts with its smallest node.
std::vector<Index> turned(std::vector<Index> ring)
{
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

Index count(const TriangleTopology& topology, Index nodes, NodeKind kind)
{
  Index n = 0;
  for (Index i = 0; i < nodes; ++i)
  {
    n += topology.kind(i) == kind;
  }
  return n;
}

TEST(TriangleTopology, Corners)
{
  const Corner corner = makeCorner(1234567, 2);
  EXPECT_EQ(triangleOf(corner), 1234567);
  EXPECT_EQ(cornerOf(corner), 2);
  EXPECT_EQ(nextCorner(2), 0);
  EXPECT_EQ(previousCorner(0), 2);
}

TEST(TriangleTopology, NothingAtAll)
{
  const TriangleTopology topology(nullptr, 0, 0);
  EXPECT_EQ(topology.triangleCount(), 0);
  EXPECT_EQ(topology.triangleCount(), 0);
}

//  6---7---8
//  | / | / |
//  3---4---5
//  | / | / |
//  0---1---2
TEST(TriangleTopology, GridOfNine)
{
  const Mesh mesh = testing::flatGrid(3, 3);
  const TriangleTopology topology = topologyOf(mesh);
  EXPECT_EQ(topology.kind(4), NodeKind::Interior);
  EXPECT_EQ(count(topology, 9, NodeKind::Boundary), 8);

  Hole hole;
  ASSERT_TRUE(topology.gather(4, hole));
  EXPECT_FALSE(hole.boundary);
  EXPECT_EQ(hole.triangleCount, 6);
  EXPECT_EQ(turned(ringOf(hole)), (std::vector<Index>{ 0, 1, 5, 8, 7, 3 }));

  // At the boundary the ring is open, from the first to the last node counterclockwise.
  ASSERT_TRUE(topology.gather(1, hole));
  EXPECT_TRUE(hole.boundary);
  EXPECT_EQ(hole.triangleCount, 3);
  EXPECT_EQ(ringOf(hole), (std::vector<Index>{ 2, 5, 4, 0 }));
  ASSERT_TRUE(topology.gather(2, hole));
  EXPECT_EQ(ringOf(hole), (std::vector<Index>{ 5, 1 }));

  EXPECT_TRUE(topology.mayHaveEdge(0, 4));
  EXPECT_TRUE(topology.mayHaveEdge(4, 0));
  EXPECT_FALSE(topology.mayHaveEdge(1, 3));
  EXPECT_FALSE(topology.mayHaveEdge(0, 8));
}

TEST(TriangleTopology, HoleKnowsItsTrianglesAndWhatLiesBehind)
{
  const Mesh mesh = testing::torus(7, 5);
  const TriangleTopology topology = topologyOf(mesh);
  EXPECT_EQ(count(topology, mesh.nodeCount(), NodeKind::Interior), mesh.nodeCount());
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    Hole hole;
    ASSERT_TRUE(topology.gather(node, hole));
    ASSERT_EQ(hole.size, 6);
    EXPECT_EQ(hole.node, node);
    for (int i = 0; i < hole.triangleCount; ++i)
    {
      const auto& t = topology.triangle(triangleOf(hole.corners[i]));
      const int c = cornerOf(hole.corners[i]);
      EXPECT_EQ(t.nodes[c], node);
      EXPECT_EQ(t.nodes[nextCorner(c)], hole.ring[i]);
      EXPECT_EQ(t.nodes[previousCorner(c)], hole.ring[(i + 1) % hole.size]);
      ASSERT_NE(hole.outer[i], kNoCorner);
      const auto& behind = topology.triangle(triangleOf(hole.outer[i]));
      const int o = cornerOf(hole.outer[i]);
      EXPECT_EQ(behind.nodes[nextCorner(o)], hole.ring[(i + 1) % hole.size]);
      EXPECT_EQ(behind.nodes[previousCorner(o)], hole.ring[i]);
    }
  }
}

TEST(TriangleTopology, EdgesAreFoundInEveryMesh)
{
  std::mt19937 random(3);
  for (Mesh mesh : { testing::hills(9, 8), testing::torus(8, 7), testing::disc(3, 9),
         testing::cube(3), testing::strip(12) })
  {
    testing::flipEdges(mesh, random, false);
    mesh = testing::shuffled(mesh, random);
    const TriangleTopology topology = topologyOf(mesh);
    std::set<std::pair<Index, Index>> edges;
    for (Index t = 0; t < mesh.triangleCount(); ++t)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Index a = mesh.triangles[3 * t + c];
        const Index b = mesh.triangles[3 * t + (c + 1) % 3];
        edges.insert({ a, b });
        edges.insert({ b, a });
      }
    }
    for (Index a = 0; a < mesh.nodeCount(); ++a)
    {
      ASSERT_TRUE(topology.isManifold(a));
      for (Index b = 0; b < mesh.nodeCount(); ++b)
      {
        ASSERT_EQ(topology.mayHaveEdge(a, b), edges.count({ a, b }) == 1) << a << " " << b;
      }
    }
  }
}

TEST(TriangleTopology, UnusedNodes)
{
  Mesh mesh = testing::flatGrid(3, 3);
  mesh.addNode(9.0, 9.0, 9.0);
  const TriangleTopology topology = topologyOf(mesh);
  EXPECT_EQ(topology.kind(9), NodeKind::Unused);
  EXPECT_FALSE(topology.isManifold(9));
}

TEST(TriangleTopology, DegenerateAndRepeatedTriangles)
{
  Mesh mesh = testing::flatGrid(5, 5);
  mesh.addTriangle(6, 6, 7); // a node twice
  const Index a = mesh.addNode(9.0, 0.0, 0.0);
  const Index b = mesh.addNode(10.0, 0.0, 0.0);
  const Index c = mesh.addNode(9.0, 1.0, 0.0);
  mesh.addTriangle(a, b, c);
  mesh.addTriangle(a, c, b); // the same again, upside down
  const Index d = mesh.addNode(9.0, 0.0, 5.0);
  const Index e = mesh.addNode(10.0, 0.0, 5.0);
  const Index f = mesh.addNode(9.0, 1.0, 5.0);
  mesh.addTriangle(d, e, f);
  mesh.addTriangle(e, f, d); // the same again
  const TriangleTopology topology = topologyOf(mesh);
  for (const Index node : { Index{ 6 }, Index{ 7 }, a, b, c })
  {
    EXPECT_EQ(topology.kind(node), NodeKind::Degenerate) << node;
  }
  for (const Index node : { d, e, f })
  {
    EXPECT_FALSE(topology.isManifold(node)) << node;
  }
  EXPECT_EQ(topology.kind(12), NodeKind::Interior);
}

TEST(TriangleTopology, NonManifoldEdges)
{
  const Mesh mesh = testing::tJoint(3);
  const TriangleTopology topology = topologyOf(mesh);
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    EXPECT_EQ(topology.kind(node) == NodeKind::NonManifold, node <= 3) << node;
  }
  // The second column of a sheet: interior but for its ends.
  EXPECT_EQ(topology.kind(4 + 1), NodeKind::Interior);
}

TEST(TriangleTopology, BowTie)
{
  Index touching = kNone;
  const Mesh mesh = testing::bowTie(2, touching);
  const TriangleTopology topology = topologyOf(mesh);
  EXPECT_EQ(topology.kind(touching), NodeKind::NonManifold);
  EXPECT_EQ(count(topology, mesh.nodeCount(), NodeKind::NonManifold), 1);
  EXPECT_EQ(count(topology, mesh.nodeCount(), NodeKind::Unused), 1);
}

TEST(TriangleTopology, TwoOpenFansTouchInANode)
{
  //  1---2   3---4
  //    \ |   | /
  //      0 (shared)
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
  {
    mesh.addNode(i, i % 2, 0.0);
  }
  mesh.addTriangle(0, 2, 1);
  mesh.addTriangle(0, 4, 3);
  const TriangleTopology topology = topologyOf(mesh);
  EXPECT_EQ(topology.kind(0), NodeKind::NonManifold);
  EXPECT_EQ(topology.kind(1), NodeKind::Boundary);
}

TEST(TriangleTopology, MisorientedNeighbours)
{
  Mesh mesh = testing::flatGrid(5, 5);
  // Turn one triangle in the middle upside down.
  std::swap(mesh.triangles[3 * 10], mesh.triangles[3 * 10 + 1]);
  const TriangleTopology topology = topologyOf(mesh);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(topology.kind(mesh.triangles[3 * 10 + c]), NodeKind::NonManifold);
  }
  EXPECT_EQ(count(topology, 25, NodeKind::NonManifold), 3);
}

TEST(TriangleTopology, MoebiusBandHasASeam)
{
  const Mesh mesh = testing::moebius(12);
  const TriangleTopology topology = topologyOf(mesh);
  // The five nodes of the seam: across it the orientation turns.
  EXPECT_EQ(count(topology, mesh.nodeCount(), NodeKind::NonManifold), 5);
}

TEST(TriangleTopology, TooManyTrianglesAtANode)
{
  for (const int around : { kMaximumPatchCells, kMaximumPatchCells + 1 })
  {
    const Mesh mesh = testing::disc(1, around);
    const TriangleTopology topology = topologyOf(mesh);
    Hole hole;
    EXPECT_EQ(topology.gather(0, hole), around <= kMaximumPatchCells);
  }
}

TEST(TriangleTopology, ClosableHoles)
{
  Hole hole;
  {
    // Any node of a tetrahedron: the filling would repeat the opposite triangle.
    const Mesh mesh = testing::tetrahedron();
    const TriangleTopology topology = topologyOf(mesh);
    ASSERT_TRUE(topology.gather(0, hole));
    EXPECT_FALSE(topology.isClosable(hole));
  }
  {
    // A single triangle: nothing would be left.
    const Mesh mesh = testing::strip(1);
    const TriangleTopology topology = topologyOf(mesh);
    ASSERT_TRUE(topology.gather(0, hole));
    EXPECT_FALSE(topology.isClosable(hole));
  }
  {
    // A corner with one triangle that has a neighbour.
    const Mesh mesh = testing::strip(2);
    const TriangleTopology topology = topologyOf(mesh);
    ASSERT_TRUE(topology.gather(0, hole));
    EXPECT_TRUE(topology.isClosable(hole));
    // A corner with both triangles: its new boundary edge joins the two others, which is new.
    ASSERT_TRUE(topology.gather(1, hole));
    EXPECT_TRUE(topology.isClosable(hole));
  }
  {
    // A triangle with one refined side: without node 3 the boundary edge 0-1 would be there twice.
    //      2
    //    / | \            both triangles have node 3, and (0, 1, 4) lies below
    //  0---3---1
    //   \     /
    //      4
    Mesh mesh;
    for (int i = 0; i < 5; ++i)
    {
      mesh.addNode(i, i * i, 0.0);
    }
    mesh.addTriangle(0, 3, 2);
    mesh.addTriangle(3, 1, 2);
    mesh.addTriangle(0, 4, 1);
    const TriangleTopology topology = topologyOf(mesh);
    ASSERT_TRUE(topology.gather(3, hole));
    EXPECT_FALSE(topology.isClosable(hole));
  }
  {
    const Mesh mesh = testing::flatGrid(3, 3);
    const TriangleTopology topology = topologyOf(mesh);
    ASSERT_TRUE(topology.gather(4, hole));
    EXPECT_TRUE(topology.isClosable(hole));
  }
}

// The triangle that would fill the hole may exist behind edges that are not connected: here the
// base of a tetrahedron is upside down.
TEST(TriangleTopology, TriangleBehindMisorientedEdgesIsNotRepeated)
{
  Mesh mesh = testing::tetrahedron();
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  const TriangleTopology topology = topologyOf(mesh);
  ASSERT_EQ(topology.kind(3), NodeKind::Interior);
  Hole hole;
  ASSERT_TRUE(topology.gather(3, hole));
  EXPECT_FALSE(topology.isClosable(hole));
}

// The same behind edges of three triangles each: the base has flaps at all its edges.
TEST(TriangleTopology, TriangleBehindNonManifoldEdgesIsNotRepeated)
{
  Mesh mesh = testing::tetrahedron();
  for (const auto& edge : { std::pair<Index, Index>{ 0, 1 }, { 1, 2 }, { 2, 0 } })
  {
    const Index flap = mesh.addNode(1.0 + edge.first, 1.0 + edge.second, -1.0);
    mesh.addTriangle(edge.first, edge.second, flap);
  }
  const TriangleTopology topology = topologyOf(mesh);
  ASSERT_EQ(topology.kind(3), NodeKind::Interior);
  Hole hole;
  ASSERT_TRUE(topology.gather(3, hole));
  EXPECT_FALSE(topology.isClosable(hole));
}

//   3-------2        3-------2
//   | \   / |        | \     |
//   |   4   |   ->   |   \   |      by (0, 1, 3) and (1, 2, 3)
//   | /   \ |        |     \ |
//   0-------1        0-------1
TEST(TriangleTopology, ReplaceKeepsNeighbours)
{
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
  {
    mesh.addNode(i == 1 || i == 2, i == 2 || i == 3, 0.0);
  }
  for (int i = 0; i < 4; ++i)
  {
    mesh.addTriangle(4, i, (i + 1) % 4);
  }
  TriangleTopology topology = topologyOf(mesh);
  Hole hole;
  ASSERT_TRUE(topology.gather(4, hole));
  ASSERT_EQ(hole.size, 4);
  const auto at = [&](Index node)
  {
    return static_cast<unsigned char>(
      std::find(hole.ring.begin(), hole.ring.begin() + 4, node) - hole.ring.begin());
  };
  HoleTriangulation filling;
  filling.count = 2;
  filling.triangles[0] = { at(3), at(0), at(1) };
  filling.triangles[1] = { at(1), at(2), at(3) };
  EXPECT_FALSE(topology.mayHaveEdge(1, 3));
  topology.replace(hole, filling);
  EXPECT_EQ(topology.kind(4), NodeKind::Removed);
  EXPECT_TRUE(topology.mayHaveEdge(1, 3));
  EXPECT_FALSE(topology.mayHaveEdge(0, 2));
  ASSERT_TRUE(topology.gather(1, hole));
  EXPECT_EQ(ringOf(hole), (std::vector<Index>{ 2, 3, 0 }));
  ASSERT_TRUE(topology.gather(0, hole));
  EXPECT_EQ(ringOf(hole), (std::vector<Index>{ 1, 3 }));
}

// After many random replacements the structure equals one that is built anew from its cells.
TEST(TriangleTopology, StaysWhatANewOneWouldBe)
{
  std::mt19937 random(4);
  for (Mesh mesh : { testing::torus(9, 8), testing::disc(4, 9), testing::cube(4) })
  {
    testing::flipEdges(mesh, random, false);
    TriangleTopology topology = topologyOf(mesh);
    std::vector<bool> freeSlot(mesh.triangleCount(), false);
    for (int attempt = 0; attempt < 400; ++attempt)
    {
      const Index node = static_cast<Index>(random() % static_cast<unsigned>(mesh.nodeCount()));
      Hole hole;
      if (!topology.isManifold(node) || !topology.gather(node, hole) || !topology.isClosable(hole))
      {
        continue;
      }
      HoleTriangulation filling;
      filling.count = 0;
      bool possible = true;
      for (int k = 1; k + 1 < hole.size; ++k)
      {
        possible =
          possible && (k + 2 == hole.size || !topology.mayHaveEdge(hole.ring[0], hole.ring[k + 1]));
        filling.triangles[filling.count++] = { 0, static_cast<unsigned char>(k),
          static_cast<unsigned char>(k + 1) };
      }
      if (!possible)
      {
        continue;
      }
      topology.replace(hole, filling);
      for (int i = filling.count; i < hole.triangleCount; ++i)
      {
        freeSlot[triangleOf(hole.corners[i])] = true;
      }
      std::vector<Index> cells;
      for (Index slot = 0; slot < mesh.triangleCount(); ++slot)
      {
        if (!freeSlot[slot])
        {
          const auto& nodes = topology.triangle(slot).nodes;
          cells.insert(cells.end(), nodes.begin(), nodes.end());
        }
      }
      ASSERT_TRUE(testing::isManifoldAndOriented(cells));
      ASSERT_TRUE(testing::hasNoDegenerateOrRepeated(cells));
      ASSERT_TRUE(testing::hasOneFanAtEachNode(cells));
      const TriangleTopology anew(
        cells.data(), static_cast<Index>(cells.size() / 3), mesh.nodeCount());
      for (Index i = 0; i < mesh.nodeCount(); ++i)
      {
        if (topology.kind(i) == NodeKind::Removed)
        {
          ASSERT_EQ(anew.kind(i), NodeKind::Unused);
          continue;
        }
        ASSERT_EQ(topology.kind(i), anew.kind(i)) << i;
        Hole before;
        Hole after;
        ASSERT_EQ(topology.gather(i, before), anew.gather(i, after));
        ASSERT_EQ(before.boundary, after.boundary);
        if (before.boundary)
        {
          ASSERT_EQ(ringOf(before), ringOf(after));
        }
        else
        {
          ASSERT_EQ(turned(ringOf(before)), turned(ringOf(after)));
        }
      }
    }
  }
}

TEST(TriangleTopology, ThreadsDoNotMatter)
{
  std::mt19937 random(3);
  Mesh holed = testing::shuffled(testing::torus(60, 30), random);
  holed.triangles.resize(holed.triangles.size() - 300);
  Mesh repeated = holed;
  repeated.addTriangle(holed.triangles[0], holed.triangles[2], holed.triangles[1]);
  Mesh degenerate = holed;
  degenerate.addTriangle(5, 5, 9);
  Index touching = kNone;
  const Mesh large = testing::hills(400, 300);
  Mesh largeRepeated = large;
  largeRepeated.addTriangle(large.triangles[0], large.triangles[1], large.triangles[2]);
  for (const Mesh& mesh : { holed, repeated, degenerate, testing::tJoint(20),
         testing::bowTie(8, touching), large, largeRepeated, Mesh() })
  {
    const TriangleTopology serial(mesh.view());
    for (const int count : { 1, 2, 5 })
    {
      Threads threads(count);
      const TriangleTopology parallel(mesh.view(), &threads);
      ASSERT_EQ(parallel.nodeCount(), serial.nodeCount());
      ASSERT_EQ(parallel.triangleCount(), serial.triangleCount());
      for (Index t = 0; t < serial.triangleCount(); ++t)
      {
        ASSERT_EQ(parallel.triangle(t).nodes, serial.triangle(t).nodes);
        ASSERT_EQ(parallel.triangle(t).across, serial.triangle(t).across);
        ASSERT_EQ(parallel.triangle(t).first, serial.triangle(t).first);
        ASSERT_EQ(parallel.triangle(t).spare, serial.triangle(t).spare);
      }
      for (Index i = 0; i < serial.nodeCount(); ++i)
      {
        ASSERT_EQ(parallel.node(i).neighbours, serial.node(i).neighbours);
        ASSERT_EQ(parallel.node(i).corner, serial.node(i).corner);
        ASSERT_EQ(parallel.node(i).kind, serial.node(i).kind);
        ASSERT_EQ(parallel.node(i).position.x, serial.node(i).position.x);
      }
    }
  }
}

// Whether numbers run together decides how finely the work is shared out, not what is visited.
TEST(TriangleTopology, SharesVisitTheTrianglesOfTheirNodes)
{
  std::mt19937 random(4);
  const Mesh ordered = testing::hills(400, 300);
  for (const Mesh& mesh : { ordered, testing::shuffled(ordered, random), testing::torus(6, 5) })
  {
    Threads threads(3);
    const TriangleTopology topology(mesh.view(), &threads);
    std::vector<std::atomic<int>> visits(3 * static_cast<std::size_t>(topology.triangleCount()));
    std::atomic<int> shares{ 0 };
    std::atomic<Index> all{ 0 };
    topology.doInNodeShares(&threads,
      [&](const auto& share)
      {
        ++shares;
        topology.visitTriangles(share,
          [&](Index t, const auto& ours)
          {
            ++all;
            for (int c = 0; c < 3; ++c)
            {
              const Index node = topology.triangle(t).nodes[c];
              ASSERT_EQ(ours.has(node), share.has(node));
              visits[3 * static_cast<std::size_t>(t) + c] += ours.has(node) ? 1 : 0;
            }
          });
      });
    EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](int times) { return times == 1; }));
    if (mesh.triangles == ordered.triangles)
    {
      EXPECT_GT(shares, threads.count());
      EXPECT_LE(all, 1.25 * topology.triangleCount());
    }
    else
    {
      EXPECT_EQ(shares, threads.count());
    }
  }
}

// Shares that end at, before and behind the first and last nodes of ranges of triangles.
TEST(TriangleTopology, NoNodeIsTakenForOneOfAShareBesideIt)
{
  Mesh mesh;
  for (Index node = 0; node < 12000; node += 3)
  {
    mesh.addNode(node, 0.0, 0.0);
    mesh.addNode(node, 1.0, 0.0);
    mesh.addNode(node, 0.0, 1.0);
    mesh.addTriangle(node, node + 1, node + 2);
  }
  Threads threads(2);
  const TriangleTopology topology(mesh.view(), &threads);
  for (const Index middle : { 3 * 1024, 2 * 3 * 1024 })
  {
    for (Index begin = middle - 2; begin <= middle + 2; ++begin)
    {
      for (Index end = middle + 3 * 1024 - 2; end <= middle + 3 * 1024 + 2; ++end)
      {
        const Share share{ begin, end };
        Index found = 0;
        topology.visitTriangles(share,
          [&](Index t, const auto& ours)
          {
            for (const Index node : topology.triangle(t).nodes)
            {
              ASSERT_EQ(ours.has(node), share.has(node)) << node;
              found += ours.has(node) ? 1 : 0;
            }
          });
        EXPECT_EQ(found, end - begin);
      }
    }
  }
}

} // namespace
} // namespace undecimate
