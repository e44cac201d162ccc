// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file triangle_topology.h
/// @brief Which triangles meet at an edge and around a node, kept up to date while nodes go.

#ifndef UNDECIMATE_CORE_TRIANGLE_TOPOLOGY_H
#define UNDECIMATE_CORE_TRIANGLE_TOPOLOGY_H

#include "compiler.h"
#include "hash_queue.h"
#include "large_array.h"
#include "record.h"
#include "threads.h"
#include "types.h"
#include "vector.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace undecimate
{

/// A corner of a triangle: triangle << 2 | corner (0..2).
using Corner = std::uint32_t;
constexpr Corner kNoCorner = ~Corner{ 0 };

inline Index triangleOf(Corner corner)
{
  return static_cast<Index>(corner >> 2);
}
inline int cornerOf(Corner corner)
{
  return static_cast<int>(corner & 3);
}
inline Corner makeCorner(Index triangle, int corner)
{
  return static_cast<Corner>(triangle) << 2 | static_cast<Corner>(corner);
}
inline int nextCorner(int corner)
{
  return corner == 2 ? 0 : corner + 1;
}
inline int previousCorner(int corner)
{
  return corner == 0 ? 2 : corner - 1;
}

/// The hole that the removal of a node leaves: a polygon of `size` ring nodes, counterclockwise as
/// the surface is oriented, and the triangles that filled it.
struct Hole
{
  Index node = kNone;
  bool boundary = false; ///< the node is on the boundary: the ring is open, and the polygon's last
                         ///< edge, ring[size - 1] -> ring[0], is the new boundary edge
  int triangleCount = 0; ///< size, or size - 1 at the boundary
  int size = 0;
  std::array<Index, kMaximumPatchCells + 1> ring;
  std::array<Corner, kMaximumPatchCells> corners; ///< of the node: triangle i is (node, ring[i],
                                                  ///< ring[i + 1])
  std::array<Corner, kMaximumPatchCells>
    outer; ///< behind ring edge i: corner of the triangle there
           ///< that is opposite to the edge, or kNoCorner
};

/// A triangulation of a hole: corners are positions in Hole::ring. Each triangle is an ear of what
/// the ones before have left of the polygon: (the corner before the ear, the ear, the one behind).
struct HoleTriangulation
{
  int count = 0; ///< Hole::size - 2 triangles
  std::array<std::array<unsigned char, 3>, kMaximumPatchCells> triangles;
};

/// What the triangles around a node look like.
enum class NodeKind : unsigned char
{
  Interior,    ///< one closed fan
  Boundary,    ///< one open fan
  Unused,      ///< no triangle has it
  Degenerate,  ///< of a triangle that has a node twice, or exists twice
  NonManifold, ///< on an edge with more than two or with misoriented triangles, or a bow tie
  Removed
};

/// All that is known about a node: one cache line, since the nodes are visited in an order that
/// memory does not know. Besides the topology's own part there is room for those who work on it.
/// Of a removed node only `kind` is still needed here.
struct alignas(64) MeshNode
{
  NodeKind kind = NodeKind::Unused;
  bool kept = false;            ///< free for the user: is never removed
  std::int32_t value = 0;       ///< free for the user, 0 at first
  Vector position;              ///< undefined if the topology was made without positions
  std::uint64_t neighbours = 0; ///< topology: see TriangleTopology::mayHaveEdge()
  std::uint64_t sum = 0;        ///< free for the user
  QueueLinks links;             ///< free for the user: its place in a hash queue
  Corner corner = kNoCorner;    ///< topology: of one of its triangles
};
static_assert(sizeof(MeshNode) == 64, "a cache line");
template <>
inline constexpr bool kMadeByOwner<MeshNode> = true;

/// The first cost of a node waits where its place in the queue will be: the node is in none yet.
inline void setFirstCost(MeshNode& node, float cost)
{
  static_assert(sizeof(cost) == sizeof(node.links.next), "");
  std::memcpy(&node.links.next, &cost, sizeof(cost));
}
inline float firstCost(const MeshNode& node)
{
  float cost = 0.0F;
  std::memcpy(&cost, &node.links.next, sizeof(cost));
  return cost;
}

/// Triangles with their neighbours across each edge (a corner table), and one corner for each node.
///
/// Edges between manifold nodes have one or two triangles; an edge of more than two, or between
/// misoriented triangles, is open for all of them and its nodes are NonManifold.
/// Memory: 32 bytes a triangle and 64 bytes a node. Construction O(nodes + triangles).
class TriangleTopology
{
public:
  struct alignas(32) Triangle // two fill a cache line
  {
    std::array<Index, 3> nodes;
    std::array<Corner, 3> across; ///< across[c]: the corner opposite to this triangle's corner c
    Index first;                  ///< free for the user: a node, kNone at first
    Index spare;                  ///< free for the user, 0 at first
  };

  /// @param triangles 3 * triangleCount node numbers in [0, nodeCount)
  TriangleTopology(const Index* triangles, Index triangleCount, Index nodeCount);

  /// With the positions of the nodes. The mesh must be valid (triangles as above).
  /// @param threads to share the work out among, or null; the result is the same
  explicit TriangleTopology(const TriangleMeshView& mesh, Threads* threads = nullptr);

  Index nodeCount() const { return static_cast<Index>(this->nodes_.size()); }
  Index triangleCount() const { return static_cast<Index>(this->triangles_.size()); }
  Triangle& triangle(Index t) { return this->triangles_[t]; }
  const Triangle& triangle(Index t) const { return this->triangles_[t]; }
  MeshNode& node(Index n) { return this->nodes_[n]; }
  const MeshNode& node(Index n) const { return this->nodes_[n]; }
  NodeKind kind(Index node) const { return this->nodes_[node].kind; }

  /// One fan, closed or open: only such nodes can be removed.
  bool isManifold(Index node) const { return this->nodes_[node].kind <= NodeKind::Boundary; }

  /// Bring the data around a node that will be gathered soon into the cache, in five stages that
  /// each use what the ones before have brought: the node, its triangle, the triangles beside that,
  /// those beside these, and the nodes around it with the triangles behind them and the nodes in
  /// Triangle::first.
  void prefetchNode(Index node) const { prefetch(&this->nodes_[node]); }
  void prefetchTriangle(Index node) const { this->prefetchTriangleOf(this->nodes_[node].corner); }
  void prefetchNeighbours(Index node) const
  {
    const Corner corner = this->nodes_[node].corner;
    if (corner != kNoCorner)
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      this->prefetchTriangleOf(t.across[nextCorner(cornerOf(corner))]);
      this->prefetchTriangleOf(t.across[previousCorner(cornerOf(corner))]);
    }
  }
  void prefetchSecondNeighbours(Index node) const
  {
    const Corner corner = this->nodes_[node].corner;
    if (corner != kNoCorner)
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      const Corner behind = t.across[nextCorner(cornerOf(corner))];
      if (behind != kNoCorner)
      {
        this->prefetchTriangleOf(
          this->triangles_[triangleOf(behind)].across[previousCorner(cornerOf(behind))]);
      }
      const Corner before = t.across[previousCorner(cornerOf(corner))];
      if (before != kNoCorner)
      {
        this->prefetchTriangleOf(
          this->triangles_[triangleOf(before)].across[nextCorner(cornerOf(before))]);
      }
    }
  }
  void prefetchRing(Index node) const
  {
    constexpr int kEnough = 8; // rings are rarely larger
    const Corner start = this->nodes_[node].corner;
    Corner corner = start;
    for (int i = 0; i < kEnough && corner != kNoCorner; ++i)
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      const int c = cornerOf(corner);
      this->prefetchNode(t.nodes[nextCorner(c)]);
      this->prefetchTriangleOf(t.across[c]);
      if (t.first != kNone)
      {
        this->prefetchNode(t.first);
      }
      const Corner opposite = t.across[nextCorner(c)];
      corner = opposite == kNoCorner
        ? kNoCorner
        : makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
      if (corner == start)
      {
        break;
      }
    }
  }

  /// Gather the ring of a manifold node.
  /// @return false if it has more than kMaximumPatchCells triangles
  bool gather(Index node, Hole& hole) const;

  /// Whether a condition holds for all nodes that share an edge with a manifold one. Reads of the
  /// triangles around it nothing but their nodes and what lies across the edges at the node.
  template <typename Condition>
  bool allAround(Index node, Condition&& condition) const
  {
    const Corner start = this->nodes_[node].corner;
    Corner corner = start;
    do
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      const int c = cornerOf(corner);
      if (!condition(t.nodes[nextCorner(c)]))
      {
        return false;
      }
      const Corner opposite = t.across[nextCorner(c)];
      if (opposite == kNoCorner)
      {
        return condition(t.nodes[previousCorner(c)]) && this->allBefore(start, condition);
      }
      corner = makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
    } while (corner != start);
    return true;
  }

  /// Visit(node) for the nodes around a manifold one, counterclockwise as the surface is oriented;
  /// around an interior node for the first one again at the end. Of a mesh as it was made: later
  /// the fan of a boundary node may not begin at its corner.
  template <typename Visit>
  void visitFan(Index node, Visit&& visit) const
  {
    const Corner start = this->nodes_[node].corner;
    Corner corner = start;
    visit(this->triangles_[triangleOf(start)].nodes[nextCorner(cornerOf(start))]);
    do
    {
      const Triangle& t = this->triangles_[triangleOf(corner)];
      visit(t.nodes[previousCorner(cornerOf(corner))]);
      const Corner opposite = t.across[nextCorner(cornerOf(corner))];
      corner = opposite == kNoCorner
        ? kNoCorner
        : makeCorner(triangleOf(opposite), nextCorner(cornerOf(opposite)));
    } while (corner != kNoCorner && corner != start);
  }

  /// Whether two nodes share an edge, or, if neither is manifold, it cannot be ruled out.
  /// O(1) for most pairs without an edge, else O(triangles around a manifold one).
  bool mayHaveEdge(Index a, Index b) const
  {
    return (this->nodes_[a].neighbours & signature(b)) != 0 &&
      (this->nodes_[b].neighbours & signature(a)) != 0 && this->findEdge(a, b);
  }

  /// Whether a hole can be closed at all, whatever the triangulation: it has a polygon, the new
  /// boundary edge does not exist, and a hole of three nodes would not repeat a triangle.
  bool isClosable(const Hole& hole) const;

  /// Put a triangulation in the place of the hole's triangles: new triangle i takes the slot of old
  /// triangle i. The other slots are free afterwards.
  void replace(const Hole& hole, const HoleTriangulation& filling);

  /// As undecimate::doInShares() for the nodes, for jobs that visit the triangles of their share:
  /// in so few shares that together they visit hardly more triangles than there are, but one for
  /// each thread at least.
  template <typename Job>
  void doInNodeShares(Threads* threads, const Job& job) const
  {
    doInShares(
      threads, this->nodeCount(), job, this->sharesPerThread(threads ? threads->count() : 1));
  }

  /// Visit(t, ours) for all triangles that have a node of a share, and others: ours is the share,
  /// or Whole where all nodes of the triangle are known to be in it. Where the numbers of triangles
  /// and nodes run together, as most do, the others are few. Before the first replace() only.
  template <typename Visit>
  void visitTriangles(const Share& nodes, Visit&& visit) const
  {
    const Whole whole{ nodes };
    for (Index begin = 0; begin < this->triangleCount(); begin += kNodeRangeTriangles)
    {
      const NodeRange range = this->ranges_.empty()
        ? NodeRange{ 0, this->nodeCount() - 1 }
        : this->ranges_[static_cast<std::size_t>(begin / kNodeRangeTriangles)];
      const Index count = std::min(kNodeRangeTriangles, this->triangleCount() - begin);
      if (range.lowest >= nodes.begin && range.highest < nodes.end)
      {
        for (Index t = begin; t < begin + count; ++t)
        {
          visit(t, whole);
        }
      }
      else if (range.highest >= nodes.begin && range.lowest < nodes.end)
      {
        for (Index t = begin; t < begin + count; ++t)
        {
          visit(t, nodes);
        }
      }
    }
  }
  template <typename Visit>
  void visitTriangles(const Whole& nodes, Visit&& visit) const
  {
    for (Index t = 0; t < this->triangleCount(); ++t)
    {
      visit(t, nodes);
    }
  }

  /// Free the memory of the nodes, or of the triangles. Only the others may be used any more.
  void freeNodes() { release(this->nodes_); }
  void freeTriangles() { release(this->triangles_); }

private:
  // All nodes that ever shared an edge with a node, as bits: most pairs without an edge are told by
  // them at once.
  static std::uint64_t signature(Index node)
  {
    return std::uint64_t{ 1 } << (static_cast<std::uint32_t>(node) * 2654435769U >> 26);
  }
  void meet(Index a, Index b)
  {
    this->nodes_[a].neighbours |= signature(b);
    this->nodes_[b].neighbours |= signature(a);
  }

  void prefetchTriangleOf(Corner corner) const
  {
    if (corner != kNoCorner)
    {
      prefetch(&this->triangles_[triangleOf(corner)]);
    }
  }
  // allAround() for the triangles of an open fan that lie before a corner.
  template <typename Condition>
  bool allBefore(Corner corner, Condition&& condition) const
  {
    for (;;)
    {
      const Triangle& before = this->triangles_[triangleOf(corner)];
      const Corner opposite = before.across[previousCorner(cornerOf(corner))];
      if (opposite == kNoCorner)
      {
        return true;
      }
      corner = makeCorner(triangleOf(opposite), previousCorner(cornerOf(opposite)));
      if (!condition(this->triangles_[triangleOf(corner)].nodes[nextCorner(cornerOf(corner))]))
      {
        return false;
      }
    }
  }
  bool findEdge(Index a, Index b) const;
  bool haveEdge(Index a, Index b) const;
  bool fillsExistingTriangle(const Hole& hole) const;
  template <typename Number>
  void build(const Number* triangles, Threads* threads);
  void connect();
  bool connectShare(const Share& share, LargeArray<Corner, 2>& next);
  bool connect(Threads& threads);
  void findRanges(Index begin, Index end);
  Index sharesPerThread(Index threads) const;
  void markDegenerate(Threads* threads);
  void markNodes(Threads* threads);

  // The nodes of so many triangles each; with threads only, and as the mesh was made.
  struct NodeRange
  {
    Index lowest;
    Index highest;
  };
  static constexpr Index kNodeRangeTriangles = 1 << 10;

  LargeArray<Triangle> triangles_;
  LargeArray<MeshNode, 1> nodes_;
  std::vector<NodeRange> ranges_;
};

} // namespace undecimate

#endif
