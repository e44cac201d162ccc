// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file removal_steps.h
/// @brief The steps of a decimation of triangles, each in the memory of the node that it removed.
///
/// A removed node's cache line is at hand and no longer needed: a step of up to ten old triangles
/// fits there, so that a decimation needs no memory for its record until it ends and the triangles
/// are free. The record (hole_code.h) is made at the end, by several threads if there are some.
///
/// Memory: none beside the nodes for most steps; about 5 bytes for each old triangle of larger ones
/// (from 11 triangles on, or from 5 if the positions are to stay).

#ifndef UNDECIMATE_CORE_REMOVAL_STEPS_H
#define UNDECIMATE_CORE_REMOVAL_STEPS_H

#include "record.h"
#include "threads.h"
#include "triangle_topology.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace undecimate
{

/// Writes steps into removed nodes. Each thread has one; all must live until recordOf() is done.
class StepWriter
{
public:
  /// @param trackSources steps also tell from which old triangle each new one takes its values
  /// @param keepPositions MeshNode::position and MeshNode::value of removed nodes stay as they are
  StepWriter(bool trackSources, bool keepPositions);

  /// The removal of a hole's node, when the topology and all others are done with it. Of the node
  /// nothing but `kind` is left, and what the constructor was told to keep.
  void write(
    TriangleTopology& topology, const Hole& hole, const HoleTriangulation& filling, double error);

private:
  unsigned char* allocate(std::size_t size);

  bool trackSources_;
  bool keepPositions_;
  std::array<unsigned char, kMaximumPatchCells> sources_;
  std::vector<std::unique_ptr<unsigned char[]>> blocks_; // for the steps that do not fit
  std::size_t used_ = 0;                                 // of the last block
};

/// The order of removals, as a chain through the removed nodes.
class RemovalChain
{
public:
  explicit RemovalChain(TriangleTopology& topology)
    : topology_(topology)
  {
  }

  /// The next removed node, after its step was written.
  void append(Index node);

  Index count() const { return this->count_; }

  /// All of them. O(count).
  std::vector<Index> nodes() const;

private:
  // Each node knows the one that was removed so many steps later: the next ones can be fetched
  // while one is read.
  static constexpr Index kAhead = 16;

  TriangleTopology& topology_;
  std::array<Index, kAhead> first_;
  std::array<Index, kAhead> last_;
  Index count_ = 0;
};

/// Triangles that the removal of a node took away: 2, or 1 at the boundary.
int cellsGone(const MeshNode& removed);

/// Undo the last removal that is not undone yet. Restores TriangleTopology::Triangle::nodes and
/// nothing else.
void undo(TriangleTopology& topology, Index removed);

/// The record of a decimation. Frees the memory of the topology.
/// @param removed all removed nodes in the order of their removal; empty afterwards
/// @param hasSources as the steps were written
/// @param[out] baseTriangles the triangles of the coarsest level, in record order
/// @param threads to share the work out among, or null; the result is the same
/// Complexity: O(nodes + triangles).
Record recordOf(TriangleTopology& topology, std::vector<Index>& removed, bool hasSources,
  std::vector<Index>& baseTriangles, Threads* threads = nullptr);

} // namespace undecimate

#endif
