// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file original_surface.h
/// @brief How far a point is from the surface as it was before any node went.

#ifndef UNDECIMATE_CORE_ORIGINAL_SURFACE_H
#define UNDECIMATE_CORE_ORIGINAL_SURFACE_H

#include "compiler.h"
#include "large_array.h"
#include "triangle_topology.h"
#include "types.h"

#include <array>

namespace undecimate
{

/// The original triangles around each node, as fans: the nodes around it, so that every two of them
/// in a row make a triangle with it, counterclockwise as the surface is oriented.
///
/// Memory: 32 bytes a node. Construction O(nodes + triangles).
class OriginalSurface
{
public:
  /// @param topology of the original mesh; must outlive this, and its nodes keep their positions
  /// @param threads to share the work out among, or null; the result is the same
  explicit OriginalSurface(const TriangleTopology& topology, Threads* threads = nullptr);

  /// Squared distance from a point to the surface near a node. Walks from the triangles around the
  /// node to those around the corners of the nearest one, and so on until no nearer one is found:
  /// the result is exact where the distance has no other minimum in between, and never too small.
  /// @param start a node near the point, of at least one triangle
  /// @param enough a squared distance; the first one found that is not larger is returned
  /// Complexity: O(triangles around the nodes that are visited).
  double squaredDistance(const Vector& point, Index start, double enough) const
  {
    return this->nearest(point, start, enough).square;
  }

  /// A triangle and the squared distance to it.
  struct Nearest
  {
    double square;
    std::array<Index, 3> nodes; ///< in the order of the surface
  };

  /// The same, and the triangle that is nearest.
  Nearest nearest(const Vector& point, Index start, double enough) const;

  /// Whether a triangle that is no farther from the point than the nearest one (more than one is
  /// nearest at an edge) faces away from a direction.
  bool facesAway(const Vector& point, const Nearest& nearest, const Vector& direction) const;

  /// Whether a point lies over or under one of the triangles around a node, and the square of its
  /// height there is surely at most `enough`: what squaredDistance() finds is then not larger.
  /// Takes less time.
  bool isNear(const Vector& point, Index node, double enough) const;

  /// The nodes around a node, as entries: the first node of a fan is marked. The fan of an interior
  /// node ends where it began.
  struct Ring
  {
    const Index* first;
    const Index* last;
    const Index* begin() const { return this->first; }
    const Index* end() const { return this->last; }
  };
  Ring ring(Index node) const
  {
    return { this->entries_.data() + this->first_[node],
      this->entries_.data() + this->first_[node + 1] };
  }
  static bool isFanStart(Index entry) { return entry < 0; }
  static Index nodeOf(Index entry) { return entry < 0 ? ~entry : entry; }

  /// Bring the ring of a node that has one into the cache, in two stages.
  void prefetchNode(Index node) const { prefetch(&this->first_[node]); }
  void prefetchRing(Index node) const
  {
    prefetch(this->ring(node).begin());
    prefetch(this->ring(node).end() - 1); // it may reach into another line
  }

  /// Unit normal at a node: that of the triangles around it, weighted by their areas. Zero where
  /// there is none, as without a triangle.
  Vector normal(Index node) const;

private:
  static constexpr int kMaximumVisits = 32; // of nodes, in a walk

  const TriangleTopology& topology_;
  LargeArray<Index> first_;
  LargeArray<Index> entries_;
};

} // namespace undecimate

#endif
