// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file deviation.h
/// @brief The criterion Deviation: how far the new surface is from the original one.
///
/// The cost of a way to fill the hole of a node is the largest of
///   (a) the distance to the new triangles of the node, and of every node that was removed from the
///       hole's triangles before;
///   (b) the distance between each new edge and the old edges that it crosses;
/// as a fraction of the diagonal of the bounding box. Two surfaces of flat pieces are farthest
/// apart at a node of one of them or where two of their edges cross, so (a) and (b) see the whole
/// change of a step. The way back, from the new edges and triangles to the original surface
/// (original_surface.h), is measured for a removal that is about to be made. At the boundary also
/// (c) the distance of the removed boundary nodes to the new
/// boundary edge. A nodal array is compared at the same places: its error, |interpolated - value| /
/// range, times a weight, counts if it is larger.
///
/// Holes of up to 16 nodes get the best of all triangulations: seen along the mean normal each
/// sample lies in one triangle of any triangulation, so the triangles (20 for six nodes) are
/// measured once, and dynamic programming finds the set with the least sum of the fourth powers of
/// their costs, which is nearly the least largest one and keeps the others small. Larger holes
/// compare ear cutting and fans. The cost of the triangulation that was chosen is then measured by
/// nearest distances.
///
/// Refused are new triangles that turn away from the old ones on their ring edges, needles more
/// strictly than others (if no others fill the hole, all but needles may turn by up to 120
/// degrees); that turn away from the original normals at all three corners; that lie on a
/// neighbour; and that face away from the original surface below them.
///
/// Cost and error are two things: the queue goes by the error times the 16th root of the hole's
/// area, that of arrays times the area itself, for the sake of the mean error, which counts more at
/// last, when few triangles are left (deviation.md); a shape weight makes holes that leave bad
/// triangles wait.
///
/// Samples are relative to the removed node and in single precision, and so is the choice among
/// triangulations; what is about to be made is judged in double precision once more.

#ifndef UNDECIMATE_CORE_DEVIATION_H
#define UNDECIMATE_CORE_DEVIATION_H

#include "array_range.h"
#include "triangle_topology.h"

#include <memory>
#include <vector>

namespace undecimate
{

class DeviationCriterion
{
public:
  /// Neighbours of a removed node are evaluated when their turn comes,
  static constexpr bool kLazy = true;
  /// unless few triangles are left: then each removal counts, and they are evaluated at once.
  bool isLazy() const;

  /// As in HashQueueDecimationOptions.
  struct Weights
  {
    double scalar;
    double shape;
  };

  /// Nodes where an array is NaN or infinite are kept from now on.
  /// @param topology with the positions of the nodes
  /// @param threads to share the work out among, or null; the result is the same
  DeviationCriterion(TriangleTopology& topology, const std::vector<NodalArrayView>& arrays,
    const Weights& weights, Threads* threads = nullptr);
  ~DeviationCriterion();
  DeviationCriterion(DeviationCriterion&& other) noexcept;

  /// The same, for another thread: both may be used at the same time for nodes that share no node
  /// of their rings.
  DeviationCriterion forThread() const;

  /// Tell how many triangles of the mesh are left, where others remove some, too.
  void setTrianglesLeft(Index count);

  /// Cost of the best triangulation; false if there is none.
  bool evaluate(Index node, double& cost);

  /// The best triangulation of a node's hole; false if there is none. The cost may be less than it
  /// really is, see confirm().
  bool retriangulate(Index node, Hole& hole, HoleTriangulation& filling, double& cost);

  /// Look closer at the last retriangulate(): at places between the nodes of the original surface,
  /// and the way back to it. Only removals that are about to be made need this.
  /// @param[in,out] filling another one if the first would lie on its surroundings
  /// @param[in,out] cost not smaller than before; infinite if there is no filling that does not
  /// @return the error: the deviation, or the weighted error of the arrays if that is larger
  double confirm(const Hole& hole, HoleTriangulation& filling, double& cost);

  /// Take note of a removal (of the node and filling of the last retriangulate()).
  void removed(const Hole& hole, const HoleTriangulation& filling);

private:
  struct Shared;
  struct Internals;
  explicit DeviationCriterion(std::unique_ptr<Internals> internals);
  std::unique_ptr<Internals> internals_;
};

} // namespace undecimate

#endif
