// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file mesh_parts.h
/// @brief Cuts the nodes that are left of a mesh into parts, for several threads.
///
/// The bounding cube is divided into small cells in the order of a Morton curve, and the curve is
/// cut into pieces with about equal numbers of nodes. The cube's place is another one in each
/// round, so that the seams between the parts move. Parts depend on the mesh and the round only.

#ifndef UNDECIMATE_CORE_MESH_PARTS_H
#define UNDECIMATE_CORE_MESH_PARTS_H

#include "large_array.h"
#include "threads.h"
#include "triangle_topology.h"
#include "types.h"

#include <cstdint>
#include <vector>

namespace undecimate
{

/// Memory: 18 bytes a node; while it cuts up to 8 MiB, and 4 bytes for each pair of an old and a
/// new part.
class MeshParts
{
public:
  /// All nodes of the mesh. Before the first cut the parts are blocks of nodes in their order, and
  /// has() may not be called.
  /// @param topology with positions
  /// @param threads must outlive this
  MeshParts(const TriangleTopology& topology, Threads& threads);

  /// Cut the nodes that are left.
  /// @param round the number of the cut, from 0: it places the seams
  /// @param partNodes wanted nodes of a part, 1 or more. Where many nodes share a cell a part may
  /// be larger; there are at most 2^12 parts.
  /// Complexity: O(nodes left + cells).
  void cut(int round, Index partNodes);

  /// All nodes that are left, in one part.
  void join();

  Index count() const { return static_cast<Index>(this->parts_.size()); }

  /// Nodes of a part.
  Index* begin(Index part) { return this->nodes_.data() + this->parts_[part].begin; }
  Index* end(Index part) { return this->nodes_.data() + this->parts_[part].end; }

  /// Forget the nodes of a part from `end` on: they were removed.
  void shorten(Index part, const Index* end)
  {
    this->parts_[part].end = static_cast<Index>(end - this->nodes_.data());
  }

  /// Give the memory back. Nothing may be called any more.
  void release();

  /// Whether a node is in a part.
  bool has(Index part, Index node) const
  {
    return this->partOf_[node] == static_cast<std::uint16_t>(part);
  }

private:
  struct Range
  {
    Index begin;
    Index end;
  };

  Index nodesLeft() const;

  Threads& threads_;
  std::vector<Range> parts_;
  LargeArray<Index> nodes_;
  LargeArray<Index> spare_;
  LargeArray<std::uint32_t> places_; // in the bounding cube
  LargeArray<std::uint32_t> cells_;  // or parts, in the order of nodes_, while it cuts
  std::vector<std::uint16_t> partOf_;
};

} // namespace undecimate

#endif
