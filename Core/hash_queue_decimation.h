// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hash_queue_decimation.h
/// @brief Removes nodes of a triangle mesh, cheapest first, and records each removal.
///
/// Sources: [K03] S. Krivograd, G. Hren, B. Zalik, A. Jezernik: A Fast Triangular-Mesh
/// Decimation-and-Undecimation Algorithm for Transferring FEM Results via the Web, Journal of
/// Mechanical Engineering 49 (2003). The driver is the algorithm of section 1, steps 1 to 7; the
/// queue is hash_queue.h, the retriangulation ear_cutting.h; the criterion Deviation is ours
/// (deviation.h), Quadric that of Garland and Heckbert (quadric_criterion.h).

#ifndef UNDECIMATE_CORE_HASH_QUEUE_DECIMATION_H
#define UNDECIMATE_CORE_HASH_QUEUE_DECIMATION_H

#include "hash_queue.h"
#include "monitor.h"
#include "record.h"

#include <limits>
#include <vector>

namespace undecimate
{

/// What a node's removal costs.
enum class Criterion
{
  /// Distance between the original surface and the new one, as a fraction of the diagonal of the
  /// bounding box, and the error of nodal arrays, whichever is larger (deviation.h). The default.
  Deviation,
  /// [K03] 1.1: mean difference between the node's value of the first array and its neighbours', as
  /// a fraction of the array's range.
  ScalarDifference,
  /// [K03] 1.1: mean angle between the edges at the node and the plane z = 0, in degrees.
  AngleToXYPlane,
  /// Root of the mean of the squared distances of the node's best neighbour to the planes of the
  /// original triangles that the node stands for, as a fraction of the diagonal of the bounding box
  /// (quadric_criterion.h). A mean and an estimate, but fast.
  Quadric
};

struct HashQueueDecimationOptions
{
  Criterion criterion = Criterion::Deviation;

  /// Stops; the first one that is reached counts.
  double targetReduction = 0.9;     ///< fraction of the triangles to remove, in [0, 1]
  std::int64_t targetNodes = 0;     ///< stop at this many nodes; 0 = off
  std::int64_t targetTriangles = 0; ///< stop at this many triangles; 0 = off
  /// Largest error: no step with a larger one is made. In the unit of the criterion (fraction of
  /// the diagonal or of the range, or degrees); 0 or more, infinite = no limit.
  double maximumError = std::numeric_limits<double>::infinity();

  IntervalSpacing intervalSpacing = IntervalSpacing::Logarithmic;
  /// k of [K03] eq. 1: mean number of nodes in an interval, > 0. Exponential spacing only.
  double intervalNodes = 4.0;

  /// Never remove a node of a boundary edge.
  bool preserveBoundary = false;

  /// Nodal arrays that steer. ScalarDifference needs one and uses the first; Deviation takes any
  /// number: an error of the fraction f of an array's range counts as the deviation scalarWeight *
  /// f.
  std::vector<NodalArrayView> arrays;
  double scalarWeight = 0.055; ///< >= 0; 0 = geometry only. Deviation only.

  /// How much well-shaped triangles are worth: a hole whose worst new triangle is degenerate costs
  /// this fraction of the hole's radius more than one of equilateral triangles. Its error stays
  /// what it is. >= 0; 0 = among nearly equal errors only. Deviation only.
  double shapeWeight = 0.0;

  /// Decimate by several threads (parallel_decimation.h). The result is not that of the serial
  /// algorithm, but about as good, and does not depend on the number of threads.
  bool parallel = false;
  int threads = 0; ///< with `parallel`; 0 = as many as cores

  /// Record from which cell each new cell takes its values (needed if there is cell data).
  bool trackCellSources = false;
};

/// What ended the decimation.
enum class StopReason
{
  TargetReduction,
  TargetNodes,
  TargetTriangles,
  MaximumError,
  NoRemovableNode ///< all nodes that are left are kept, or their removal would break the mesh
};

/// A word for messages, such as "target reduction".
const char* toString(StopReason reason);

struct HashQueueDecimationResult
{
  Record record;
  std::vector<Index> baseTriangles; ///< of the coarsest level, 3 corners each, record order
  StopReason stopReason = StopReason::NoRemovableNode;
  double error = 0.0; ///< of the coarsest level, in the unit of the criterion

  /// Nodes that were never candidates, by reason (a node counts once, first reason that fits).
  Index requestedNodes = 0;   ///< flagged in the input's `keep`
  Index nonFiniteNodes = 0;   ///< a coordinate is NaN or infinite
  Index unusedNodes = 0;      ///< no triangle has it
  Index degenerateNodes = 0;  ///< of a triangle that has a node twice, or that exists twice
  Index nonManifoldNodes = 0; ///< on an edge with more than two triangles, or with misoriented
                              ///< neighbours, or two surfaces touch there (bow tie)
  Index boundaryNodes = 0;    ///< preserveBoundary
};

/// Decimate a triangle mesh.
///
/// Any triangles are accepted: degenerate or repeated ones, non-manifold edges and bow ties stay as
/// they are at every level, with their nodes. A removal is refused (the node is tried again when
/// its surroundings change) when every triangulation of the hole flips a triangle or makes an edge
/// or a triangle that exists. So each edge has at most two triangles at every level if it had
/// before.
///
/// @param mesh the input; not changed
/// @param options see there
/// @param monitor progress and cancel
/// @param[out] result complete on Ok, empty otherwise
/// Complexity: O(nodes); Deviation O(nodes log(nodes / nodes left)).
/// Memory: bytes a node at the largest moment, the result included: 160 with the means, 165 with
/// Quadric, 215 with Deviation, and 4 to 30 more with `parallel` (memory.md).
/// Threads: the monitor is asked in the caller's thread only.
/// Throws nothing: exceptions of the monitor's callback end the call as Cancelled.
Outcome decimate(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options,
  Monitor& monitor, HashQueueDecimationResult& result);

} // namespace undecimate

#endif
