// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file tri_quad_topology.h
/// @brief Triangles and quads around nodes, and the half-edge collapse with its preconditions.
///
/// Source: [W06] S. Wundrak, T. Henn, A. Stork: Dynamic Progressive Triangle-Quadrilateral Meshes,
/// WSCG 2006, sections 2 and 7. A collapse moves all cells of node v0 to its neighbour v1:
/// triangles that have both vanish, quads that have both become triangles. A mesh is valid if
///   (M1) it is a manifold with boundary,
///   (M2) an inner node has three neighbours or more,
///   (M3) a cell has three nodes or more,
/// and it stays valid under a collapse of v0 into v1 if
///   (P1*) each node that shares a cell with v0 and a cell with v1 shares one with both,
///   (P2) the edge is a boundary edge if both nodes are boundary nodes,
///   (P3) more than four nodes are left if neither is a boundary node, else more than three.
///
/// Where this goes beyond the paper:
/// - P1* is asked of every edge. The paper asks nothing but P2 of edges between two quads, but
/// three
///   quads around a tube show that this makes an edge with four cells.
/// - P3 counts the nodes of the connected component, for each one is a mesh of its own.
/// - A boundary node is only moved along its boundary.
///
/// **Copies.** Non-manifold meshes are made manifold first ([W06] 2): a node whose cells form
/// several fans is split into one *copy* for each. Fans are connected across edges that have
/// exactly two cells (of the same part, if parts are given), so T joints and borders of parts
/// become *seams*: boundaries of several sheets that lie upon each other. Copies exist in here
/// only. A node of a seam is removed with all its copies at once, along the seam, and so the sheets
/// stay together, and the record knows original nodes only. Ends and crossings of seams stay.
///
/// Orientation plays no part: the cells of shell models often are not oriented alike.

#ifndef UNDECIMATE_CORE_TRI_QUAD_TOPOLOGY_H
#define UNDECIMATE_CORE_TRI_QUAD_TOPOLOGY_H

#include "large_array.h"
#include "record.h"
#include "types.h"

#include <array>
#include <vector>

namespace undecimate
{

/// Corners of a cell's slot; a triangle has kNone at one of them (input and record: the last).
constexpr int kTriQuadCorners = 4;

/// A mesh of triangles and quads in the caller's memory. Positions are not part of it.
struct TriQuadMeshView
{
  std::int64_t nodeCount = 0;
  const Index* cells = nullptr; ///< 4 * cellCount node numbers in [0, nodeCount); the last is kNone
                                ///< in triangles
  std::int64_t cellCount = 0;
  const Index* parts = nullptr; ///< part of each cell: borders between parts stay lines; or null
  const unsigned char* keep = nullptr; ///< nodeCount flags, nonzero = never remove; or null
};

/// Which nodes P1* looks at. Anything but SecondOrder is for tests that show what it is good for.
enum class NeighbourRule
{
  SecondOrder, ///< P1*: nodes of the same cell
  FirstOrder,  ///< P1 of triangle meshes: nodes of the same edge
  None
};

/// The preconditions; all hold by default.
struct CollapseRules
{
  NeighbourRule neighbours = NeighbourRule::SecondOrder;
  bool boundaryEdge = true; ///< P2
  bool lastNodes = true;    ///< P3
};

/// A corner of a cell: slot << 2 | corner.
using CellCorner = std::uint32_t;
constexpr CellCorner kNoCellCorner = ~CellCorner{ 0 };

inline Index slotOf(CellCorner corner)
{
  return static_cast<Index>(corner >> 2);
}
inline int placeOf(CellCorner corner)
{
  return static_cast<int>(corner & 3);
}

/// The cells around one copy.
struct Fan
{
  Index copy = kNone;
  bool boundary = false; ///< the fan is open
  int cellCount = 0;
  int neighbourCount = 0;
  std::array<CellCorner, kMaximumPatchCells> corners;          ///< of the copy
  std::array<Index, kMaximumPatchCells + 1> neighbours;        ///< copies across its edges
  std::array<unsigned char, kMaximumPatchCells + 1> edgeCells; ///< cells at each of the edges: 1, 2
};

enum class TriQuadNodeKind : unsigned char
{
  Interior,  ///< one closed fan
  Boundary,  ///< one open fan
  Seam,      ///< several fans
  Unused,    ///< no cell has it
  Irregular, ///< of a cell that has a node twice or exists twice, or around a node that breaks M2
};

/// Cells and the list of cells of each copy.
///
/// Cells that are degenerate, exist twice or break M2 are no part of the topology; they stay as
/// they are with all their nodes, which are Irregular. Memory: 32 bytes a cell, 12 bytes a node.
class TriQuadTopology
{
public:
  /// @param mesh checked by the caller: node numbers in range
  /// Complexity: O(cells).
  explicit TriQuadTopology(const TriQuadMeshView& mesh, const CollapseRules& rules = {});

  Index nodeCount() const { return this->nodeCount_; }
  Index copyCount() const { return static_cast<Index>(this->first_.size()); }
  Index cellCount() const { return static_cast<Index>(this->cells_.size() / kTriQuadCorners); }

  /// Four copies; kNone at one of them in a triangle, at all of them in a cell that vanished.
  const Index* cell(Index slot) const
  {
    return this->cells_.data() + std::size_t{ kTriQuadCorners } * slot;
  }

  /// The cells as they are now, with nodes in the place of copies and the empty corner last. Frees
  /// the topology.
  std::vector<Index> takeCells();

  Index nodeOf(Index copy) const
  {
    return copy < this->nodeCount_ ? copy : this->extraNodes_[copy - this->nodeCount_];
  }
  /// The first copy of a node has the node's number; this gives the others. kNone at the end.
  Index nextCopy(Index copy) const
  {
    return this->nextCopies_.empty() ? kNone : this->nextCopies_[copy];
  }
  TriQuadNodeKind kind(Index node) const { return this->kinds_[node]; }

  /// Whether the node is on an edge with only one cell.
  bool hasFreeEdge(Index node) const { return this->freeEdge_[node]; }

  /// The cells around a copy; false if there are more than kMaximumPatchCells.
  bool gather(Index copy, Fan& fan) const;

  /// Whether the copy of a fan may go to one of its neighbours. All copies of a node go together.
  /// @param fan gathered, and nothing was collapsed since
  bool mayCollapse(const Fan& fan, Index target) const;

  /// Move the cells of the fan to a neighbour. What was gathered around here is out of date then.
  void collapse(const Fan& fan, Index target);

  /// Copies that are left in the connected component of a copy.
  Index componentSize(Index copy) const { return this->componentNodes_[this->component_[copy]]; }

  /// The cell with the edge of two copies that is not `slot`; kNone if there is none.
  Index cellAcross(Index copy, Index other, Index slot) const;

  /// For those who look a little ahead: bring the first corner of a node into the cache.
  void prefetch(Index node) const { __builtin_prefetch(&this->first_[node]); }

private:
  friend class TriQuadBuilder;

  Index* cellAt(Index slot) { return this->cells_.data() + std::size_t{ kTriQuadCorners } * slot; }
  static int before(const Index* cell, int place);
  static int behind(const Index* cell, int place);
  bool keepsNeighbourRule(const Fan& fan, Index target) const;
  bool keepsSheetsApart(const Fan& fan, Index target) const;
  bool hasTwin(const Fan& fan, int i, Index target) const;
  bool hasEdge(Index copy, Index other) const;
  bool hasEdgeToNode(Index copy, Index node) const;
  int countCells(Index copy) const;
  void unlink(Index copy, CellCorner corner);

  CollapseRules rules_;
  Index nodeCount_;
  LargeArray<Index, 0> cells_;
  LargeArray<CellCorner, 1> next_;  // in the list of the corner's copy
  LargeArray<CellCorner, 2> first_; // of each copy
  std::vector<Index> extraNodes_;   // of the copies behind nodeCount_
  std::vector<Index> nextCopies_;   // empty if no node has several
  std::vector<bool> boundary_;      // of a copy; a collapse changes none that stays
  std::vector<bool> freeEdge_;
  std::vector<TriQuadNodeKind> kinds_;
  std::vector<Index> component_;      // of a copy
  std::vector<Index> componentNodes_; // copies that are left in it
};

} // namespace undecimate

#endif
