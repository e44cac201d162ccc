// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file mean_edge_criterion.h
/// @brief The two criteria of [K03] 1.1: means, over the edges at a node, of a quantity of the
/// edge.
///
/// *Scalar Difference*: |f_i - f_j| as a fraction of the range of f (vectors: the norm of the
/// difference). *Angle to XY Plane*: the angle between the edge and the plane z = 0, as a fraction
/// of 90 degrees. Both are the same seen from either end of the edge, so a removal updates the sums
/// of its neighbours by the edges that go and come, in O(1) each, without walking around them.
/// The sums are integers (quantities in units of 2^-30), so they never drift.

#ifndef UNDECIMATE_CORE_MEAN_EDGE_CRITERION_H
#define UNDECIMATE_CORE_MEAN_EDGE_CRITERION_H

#include "fold_rule.h"
#include "large_array.h"
#include "mesh_points.h"
#include "triangle_topology.h"

#include <cstdlib>
#include <vector>

namespace undecimate
{

class MeanEdgeCriterion
{
public:
  /// Costs are always up to date: neighbours of a removed node are re-evaluated at once.
  static constexpr bool kLazy = false;

  /// Scalar Difference by an array, or Angle to XY Plane without one. Nodes where the array is NaN
  /// or infinite are `kept`; a difference to such a node counts as the whole range.
  MeanEdgeCriterion(const TriangleTopology& topology, const MeshPoints& points,
    const NodalArrayView* array, std::vector<unsigned char>& kept);

  /// Mean over the edges at a node, in [0, 1]. O(1).
  bool evaluate(Index node, double& cost) const
  {
    const Node& n = this->nodes_[node];
    cost = n.edges > 0 ? static_cast<double>(n.sum) / n.edges / kUnit : 0.0;
    return true;
  }

  void prefetch(Index node) const { __builtin_prefetch(&this->nodes_[node]); }

  /// Fill the hole of a node by ear cutting; false if that is not possible without flipping a
  /// triangle or making an edge or a triangle that exists.
  bool retriangulate(Index node, Hole& hole, HoleTriangulation& filling, double& cost);

  /// Take note of a removal.
  void removed(const Hole& hole, const HoleTriangulation& filling);

private:
  static constexpr double kUnit = 1 << 30;
  static constexpr auto kWhole = static_cast<std::int64_t>(kUnit);

  struct Node
  {
    std::int64_t sum = 0;
    std::int32_t edges = 0;
    std::int32_t value = 0; // of a scalar, in units of 2^-30 of its range; -1 = not finite
  };

  std::int64_t quantity(Index a, Index b) const
  {
    return this->scalar_ ? this->scalarDifference(this->nodes_[a].value, this->nodes_[b].value)
                         : this->otherQuantity(a, b);
  }
  static std::int64_t scalarDifference(std::int32_t a, std::int32_t b)
  {
    return a < 0 || b < 0 ? kWhole : std::abs(a - b);
  }
  std::int64_t otherQuantity(Index a, Index b) const;
  void addEdge(Index a, Index b, int sign);

  const TriangleTopology& topology_;
  const MeshPoints& points_;
  HeightFieldDirection heightField_;
  const NodalArrayView* array_;
  bool scalar_;
  double scale_ = 0.0; // of a vector array: 1 / range
  LargeArray<Node, 2> nodes_;
};

} // namespace undecimate

#endif
