// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file original_surface.h
/// @brief How far a point is from the surface as it was before any node went.

#ifndef UNDECIMATE_CORE_ORIGINAL_SURFACE_H
#define UNDECIMATE_CORE_ORIGINAL_SURFACE_H

#include "large_array.h"
#include "triangle_topology.h"
#include "types.h"

namespace undecimate
{

/// The original triangles around each node.
///
/// Memory: 28 bytes a node. Construction O(nodes + triangles).
class OriginalSurface
{
public:
  /// Both must outlive this; the topology's nodes keep their positions.
  OriginalSurface(const TriangleMeshView& mesh, const TriangleTopology& topology);

  /// Squared distance from a point to the surface near a node. Walks from the triangles around the
  /// node to those around the corners of the nearest one, and so on until no nearer one is found:
  /// the result is exact where the distance has no other minimum in between, and never too small.
  /// @param start a node near the point, of at least one triangle
  /// @param enough a squared distance; the first one found that is not larger is returned
  /// Complexity: O(triangles around the nodes that are visited).
  double squaredDistance(const Vector& point, Index start, double enough) const;

  /// Visit(corners) for each original triangle around a node.
  template <typename Visit>
  void visitTriangles(Index node, Visit&& visit) const
  {
    for (Index i = this->first_[node]; i < this->first_[node + 1]; ++i)
    {
      visit(this->corners(this->triangles_[i]));
    }
  }

  /// Unit normal at a node: that of the triangles around it, weighted by their areas. Zero where
  /// there is none, as without a triangle.
  Vector normal(Index node) const;

private:
  static constexpr int kMaximumVisits = 32; // of nodes, in a walk

  std::array<Index, 3> corners(Index triangle) const
  {
    const std::size_t i = std::size_t{ 3 } * triangle;
    if (this->mesh_.wideTriangles)
    {
      const std::int64_t* nodes = this->mesh_.wideTriangles + i;
      return { static_cast<Index>(nodes[0]), static_cast<Index>(nodes[1]),
        static_cast<Index>(nodes[2]) };
    }
    const Index* nodes = this->mesh_.triangles + i;
    return { nodes[0], nodes[1], nodes[2] };
  }

  const TriangleMeshView& mesh_;
  const TriangleTopology& topology_;
  LargeArray<Index> first_;
  LargeArray<Index> triangles_;
};

} // namespace undecimate

#endif
