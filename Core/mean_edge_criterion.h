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
#include "triangle_topology.h"

#include <cstdlib>

namespace undecimate
{

class MeanEdgeCriterion
{
public:
  /// Costs are always up to date: neighbours of a removed node are re-evaluated at once.
  static constexpr bool kLazy = false;
  static constexpr bool isLazy() { return false; }

  /// Scalar Difference by an array, or Angle to XY Plane without one. Nodes where the array is NaN
  /// or infinite are kept from now on; a difference to such a node counts as the whole range.
  /// @param topology with the positions of the nodes; their values and sums are ours from now on
  /// @param threads to share the work out among, or null; the result is the same
  MeanEdgeCriterion(
    TriangleTopology& topology, const NodalArrayView* array, Threads* threads = nullptr);

  /// The same, for another thread: both may be used at the same time for nodes that share no node
  /// of their rings.
  MeanEdgeCriterion forThread() const { return *this; }

  /// As DeviationCriterion::setTrianglesLeft(); here they do not matter.
  void setTrianglesLeft(Index /*count*/) {}

  /// Mean over the edges at a node, in [0, 1]. O(1).
  bool evaluate(Index node, double& cost) const
  {
    const std::uint64_t sum = this->topology_.node(node).sum;
    const std::uint64_t edges = sum / kEdge;
    cost = edges > 0 ? static_cast<double>(static_cast<std::int64_t>(sum % kEdge)) /
        static_cast<double>(static_cast<std::int64_t>(edges)) * (1.0 / kUnit)
                     : 0.0;
    return true;
  }

  /// Fill the hole of a node by ear cutting; false if that is not possible without flipping a
  /// triangle or making an edge or a triangle that exists.
  bool retriangulate(Index node, Hole& hole, HoleTriangulation& filling, double& cost);

  /// Take note of a removal.
  void removed(const Hole& hole, const HoleTriangulation& filling);

private:
  static constexpr double kUnit = 1 << 30;
  static constexpr auto kWhole = static_cast<std::int64_t>(kUnit);

  // MeshNode::value is the scalar in units of 2^-30 of its range, -1 if it is not finite.
  // MeshNode::sum is the sum of the quantities and, above it, the number of the edges, which are
  // added as one. More than 65535 edges overflow, but no such node can be removed, and the sum is
  // right again when it has fewer.
  static constexpr std::uint64_t kEdge = std::uint64_t{ 1 } << 47;

  std::uint64_t edgeSum(const MeshNode& a, const MeshNode& b, Index indexA, Index indexB) const
  {
    const std::int64_t quantity =
      this->scalar_ ? scalarDifference(a.value, b.value) : this->otherQuantity(indexA, indexB);
    return kEdge + static_cast<std::uint64_t>(quantity);
  }
  static std::int64_t scalarDifference(std::int32_t a, std::int32_t b)
  {
    return a < 0 || b < 0 ? kWhole : std::abs(a - b);
  }
  std::int64_t otherQuantity(Index a, Index b) const;
  void addEdge(Index a, Index b);
  void setValues(double lowest, const Share& share);
  template <typename Nodes>
  void addEdges(const Nodes& share);

  TriangleTopology& topology_;
  HeightFieldDirection heightField_;
  const NodalArrayView* array_;
  bool scalar_;
  double scale_ = 0.0; // of a vector array: 1 / range
};

} // namespace undecimate

#endif
