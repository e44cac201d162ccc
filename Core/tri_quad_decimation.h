// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file tri_quad_decimation.h
/// @brief Decimation of meshes of triangles and quads that move over time.
///
/// Nodes go one by one, by half-edge collapse into a neighbour (tri_quad_topology.h), and each
/// removal is a step of the record, so the topology of a level is the same at all time steps, and
/// nodes that are left keep their places and values at each of them. The next node comes from the
/// hash queue.
///
/// What the removal of a node costs:
/// - **Quadrics**: [W06] sections 2 and 3. Each node has the quadric of the planes of its cells for
///   each time step (quads: mean of the normals at the corners, through the centre of gravity),
///   and, along boundaries, of the planes through the boundary edges perpendicular to the cells. A
///   collapse adds the quadrics. Its cost is the largest value over the time steps (method 1* of
///   the paper), or the sum, as the distance: root of the squared distances' mean, weighted by
///   area.
/// - **Deviation** (ours, the default): at each time step the distance to the new cells of every
///   node that has been removed from the cells around, the distance of the middles of new edges to
///   the old cells, and along boundaries that of removed nodes to the new boundary edge; the
///   largest over all of these and all time steps. Before a node goes from whose cells several have
///   been removed, points of the new cells and edges are measured to the original cells, too, and
///   some neighbours are compared so. Which ones, and where a node goes before, say the quadrics.
///
/// A node that could only go by folding a cell may do so where all else costs more: half of the
/// cell's longest edge counts as an error then, with Quadrics weighted as the planes are.
///
/// Sources: [W06] S. Wundrak, T. Henn, A. Stork: Dynamic Progressive Triangle-Quadrilateral Meshes,
/// WSCG 2006. [GH97] M. Garland, P. S. Heckbert: Surface Simplification Using Quadric Error
/// Metrics, SIGGRAPH 1997. Queue: hash_queue.h.

#ifndef UNDECIMATE_CORE_TRI_QUAD_DECIMATION_H
#define UNDECIMATE_CORE_TRI_QUAD_DECIMATION_H

#include "hash_queue_decimation.h"
#include "monitor.h"
#include "record.h"
#include "time_rows.h"
#include "tri_quad_topology.h"

#include <limits>
#include <vector>

namespace undecimate
{

enum class TriQuadCriterion
{
  Deviation,
  Quadrics
};

/// How the errors of the time steps become one.
enum class TimeError
{
  Maximum, ///< [W06] 1*
  Sum      ///< method 1 of the paper; as the root of the mean square
};

/// A nodal result over time that steers.
struct TimeArray
{
  const TimeRows* rows = nullptr; ///< of the same steps as the positions
  std::string name;               ///< for messages
};

struct TriQuadDecimationOptions
{
  TriQuadCriterion criterion = TriQuadCriterion::Deviation;
  TimeError timeError = TimeError::Maximum;

  /// Stops; the first one that is reached counts.
  double targetReduction = 0.9; ///< fraction of the nodes to remove, in [0, 1]
  std::int64_t targetNodes = 0; ///< stop at this many nodes; 0 = off
  /// Largest error: no step with a larger one is made. Fraction of the diagonal; 0 or more.
  double maximumError = std::numeric_limits<double>::infinity();

  /// Never remove a node of an edge with only one cell.
  bool preserveBoundary = false;

  /// What a quad that becomes a triangle counts, as a fraction of the diagonal: the larger, the
  /// longer quads stay. It changes the order of the removals and not their errors. 0 or more.
  double quadWeight = 0.0;

  /// Nodal arrays that steer, with Deviation: an error of the fraction f of an array's range (over
  /// all steps) counts as the deviation scalarWeight * f.
  std::vector<TimeArray> arrays;
  double scalarWeight = 0.1; ///< 0 or more; 0 = geometry only

  /// Positions at more steps than those that count, in the same frame: at the end the distance of
  /// each removed node to the cell that it lies in is measured at all of them. Deviation only; or
  /// null.
  const TimeRows* allPositions = nullptr;

  /// Neighbours of a node, best first by quadrics, that Deviation compares before the node goes if
  /// several nodes have been removed around it. 1 or more.
  int candidates = 4;

  /// Threads; the result does not depend on their number. 0 or less = as many as cores.
  int threads = 0;
};

struct TriQuadDecimationResult
{
  Record record;                ///< of four corners a cell, without sources
  std::vector<Index> baseCells; ///< of the coarsest level, in record order
  StopReason stopReason = StopReason::NoRemovableNode;
  double error = 0.0; ///< of the coarsest level, as a fraction of the diagonal

  /// Deviation: largest distance at each step of a removed node to the cells that took its place
  /// when it was measured last; the steps are those of the positions. Quadrics: empty.
  std::vector<double> stepErrors;

  /// With TriQuadDecimationOptions::allPositions: the distance at the end, at each of their steps.
  std::vector<double> allStepErrors;

  /// Nodes that were never candidates, by reason (a node counts once, first reason that fits).
  Index requestedNodes = 0; ///< flagged in the input's `keep`
  Index nonFiniteNodes = 0; ///< of a cell with a position or value that is NaN or infinite
  Index unusedNodes = 0;    ///< no cell has it
  Index irregularNodes =
    0; ///< of degenerate or repeated cells, or of two cells that share two edges
  Index boundaryNodes = 0; ///< preserveBoundary
  /// Nodes where the surface is no manifold, or where parts meet: they go only along such lines.
  Index seamNodes = 0;
};

/// Decimate a mesh of triangles and quads.
///
/// @param mesh the input; not changed
/// @param positions of the nodes at the steps that count, in a frame with diagonal 1
/// @param options see there
/// @param monitor progress and cancel
/// @param[out] result complete on Ok, empty otherwise
/// Complexity: O(nodes * steps); Deviation O(nodes * steps * log(nodes / nodes left)).
/// Memory: 44 bytes a node and lane for the quadrics (lanesFor()), 150 to 230 bytes a node for the
/// rest, besides the positions (memory.md).
/// Throws nothing: exceptions of the monitor's callback end the call as Cancelled.
Outcome decimateTriQuad(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, Monitor& monitor, TriQuadDecimationResult& result);

/// Decimate with as few steps as it takes: the fewest steps are chosen, one after the other, for
/// which the error at the others is at most `factor` times the largest error at the chosen ones.
/// With these alone the decimation can only keep their errors smaller than with all, so the error
/// over all steps is about `factor` times, at most, what it is if all steps count.
///
/// Begins with the first, the last and the step farthest from both; each round decimates with
/// Deviation, measures all steps, and adds the worst.
/// @param positions of all steps
/// @param options their arrays are of all steps
/// @param factor 1 or more
/// @param[out] steps those that were chosen, in increasing order
Outcome decimateTriQuadAutomatically(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, double factor, Monitor& monitor,
  TriQuadDecimationResult& result, std::vector<int>& steps);

} // namespace undecimate

#endif
