// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file fold_rule.h
/// @brief Which triangles of ring nodes may fill a hole without folding the surface.
///
/// A new triangle may not turn away too far from the old one on the same ring edge, or, if it has
/// no ring edge, from the mean normal of the hole. Needles may turn less: one that stands across
/// the surface is a fold, however near it is. And a height field stays one: if all triangles of the
/// input face the same way along an axis, so do all new ones.
///
/// On a coarse mesh of a round part old triangles meet at such angles that most nodes could not go
/// by that. Who compares triangles with the original surface besides may allow wide turns.

#ifndef UNDECIMATE_CORE_FOLD_RULE_H
#define UNDECIMATE_CORE_FOLD_RULE_H

#include "threads.h"
#include "triangle_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>

namespace undecimate
{

/// How far a triangle may turn away from the old ones.
enum class Turn
{
  Small, ///< the rule above
  Wide,  ///< up to 120 degrees; needles as before. That says less of folds
};

/// A triangle of three nodes of a hole's ring, in the order of the ring.
class FilledTriangle
{
public:
  /// Cosine of the largest turn, for well-shaped triangles and for needles, and the shape (1 =
  /// equilateral) from which on a triangle is well-shaped.
  static constexpr double kMinimumCosine = 0.15;
  static constexpr double kNeedleCosine = 0.9;
  static constexpr double kNeedleShape = 0.1;

  /// Cosine of the largest wide turn.
  static constexpr double kWideCosine = -0.5;

  /// Below this shape a triangle counts as degenerate.
  static constexpr double kMinimumShape = 1e-4;

  // Roots are taken only where they are needed: this runs for every triangle that is considered.
  FilledTriangle(const Vector& a, const Vector& b, const Vector& c)
    : cross_(cross(b - a, c - a))
    , square_(dot(this->cross_, this->cross_))
    , edges_(dot(b - a, b - a) + dot(c - a, c - a) + dot(c - b, c - b))
  {
    if (this->shapeBelow(kNeedleShape) && !this->degenerate())
    {
      this->minimumCosine_ =
        kMinimumCosine + (kNeedleCosine - kMinimumCosine) * (1.0 - this->shape() / kNeedleShape);
    }
  }

  bool degenerate() const { return !(this->square_ > 0.0) || this->shapeBelow(kMinimumShape); }

  /// 4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle.
  double shape() const { return 2.0 * std::sqrt(3.0 * this->square_) / this->edges_; }

  /// Unit normal, unless degenerate.
  Vector normal() const { return (1.0 / std::sqrt(this->square_)) * this->cross_; }

  /// Whether the normal's cosine with a direction of any length is larger than a number.
  bool faces(const Vector& direction, double cosine) const
  {
    const double product = dot(this->cross_, direction);
    return product * std::abs(product) >
      cosine * std::abs(cosine) * this->square_ * dot(direction, direction);
  }

  /// Whether the triangle, not degenerate, may be beside one with such a normal (of any length).
  bool follows(const Vector& oldNormal, Turn turn = Turn::Small) const
  {
    const bool wide = turn == Turn::Wide && !this->shapeBelow(kNeedleShape);
    return this->faces(oldNormal, wide ? kWideCosine : this->minimumCosine_);
  }

  /// Whether the normal points away from a direction of any length.
  bool opposes(const Vector& direction) const { return dot(this->cross_, direction) < 0.0; }

private:
  // shape() < limit
  bool shapeBelow(double limit) const
  {
    return 12.0 * this->square_ < limit * limit * this->edges_ * this->edges_;
  }

  Vector cross_;
  double square_; // of cross_
  double edges_;  // sum of the squared edges
  double minimumCosine_ = kMinimumCosine;
};

/// The direction along an axis that all triangles of a height field face.
class HeightFieldDirection
{
public:
  /// Looks at all triangles that have an area, by the nodes' positions; most other meshes are told
  /// by their first few.
  /// @param threads to share the work out among, or null; the result is the same
  explicit HeightFieldDirection(const TriangleTopology& topology, Threads* threads = nullptr)
  {
    std::array<bool, 6> facing{ true, true, true, true, true, true };
    bool any = false;
    std::mutex mutex;
    doInShares(threads, topology.triangleCount(),
      [&](const Share& share)
      {
        std::unique_lock<std::mutex> lock(mutex);
        std::array<bool, 6> faces = facing; // as others have left it: a share may face one way
        lock.unlock();
        const bool some = addFaces(topology, share, faces);
        lock.lock();
        any = any || some;
        std::transform(
          facing.begin(), facing.end(), faces.begin(), facing.begin(), std::logical_and<bool>());
      });
    for (int i = 0; any && i < 6; ++i)
    {
      if (facing[i])
      {
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        this->direction_ = { i < 2 ? sign : 0.0, i == 2 || i == 3 ? sign : 0.0,
          i > 3 ? sign : 0.0 };
        this->known_ = true;
      }
    }
  }

  /// Of a unit normal's component: what is less is rounding.
  static constexpr double kSmallest = 1e-9;

  bool known() const { return this->known_; }

  /// A unit vector, or zero if there is none.
  const Vector& direction() const { return this->direction_; }

  bool allows(const FilledTriangle& triangle) const
  {
    return !this->known_ || triangle.faces(this->direction_, kSmallest);
  }

private:
  // Which directions all triangles of a share face; false if none has an area.
  static bool addFaces(
    const TriangleTopology& topology, const Share& share, std::array<bool, 6>& facing)
  {
    bool any = false;
    for (Index t = share.begin; t < share.end; ++t)
    {
      const auto& nodes = topology.triangle(t).nodes;
      const Vector& a = topology.node(nodes[0]).position;
      const Vector n =
        cross(topology.node(nodes[1]).position - a, topology.node(nodes[2]).position - a);
      if (!(dot(n, n) > 0.0))
      {
        continue;
      }
      any = true;
      const double along[6] = { n.x, -n.x, n.y, -n.y, n.z, -n.z };
      bool left = false;
      for (int i = 0; i < 6; ++i)
      {
        facing[i] = facing[i] && along[i] > 0.0;
        left = left || facing[i];
      }
      if (!left)
      {
        return true;
      }
    }
    return any;
  }

  Vector direction_{ 0.0, 0.0, 0.0 };
  bool known_ = false;
};

/// The ring of a hole and the triangles that filled it, seen from the removed node.
struct HoleRing
{
  std::array<Vector, kMaximumPatchCells + 1> nodes;
  std::array<Vector, kMaximumPatchCells> oldNormals; ///< of the removed triangles, twice their area
  Vector normal{ 0.0, 0.0, 0.0 };                    ///< their sum

  HoleRing(const TriangleTopology& topology, const Hole& hole)
  {
    const Vector center = topology.node(hole.node).position;
    for (int i = 0; i < hole.size; ++i)
    {
      this->nodes[i] = topology.node(hole.ring[i]).position - center;
    }
    for (int i = 0; i < hole.triangleCount; ++i)
    {
      this->oldNormals[i] = cross(this->nodes[i], this->nodes[i + 1 == hole.size ? 0 : i + 1]);
      this->normal = this->normal + this->oldNormals[i];
    }
  }

  /// Whether no triangle of a filling folds the surface.
  bool isUnfolded(const Hole& hole, const HoleTriangulation& filling,
    const HeightFieldDirection& heightField) const
  {
    for (int t = 0; t < filling.count; ++t)
    {
      const auto& corners = filling.triangles[t];
      const FilledTriangle triangle(
        this->nodes[corners[0]], this->nodes[corners[1]], this->nodes[corners[2]]);
      if (triangle.degenerate() || !heightField.allows(triangle))
      {
        return false;
      }
      bool onRing = false;
      for (int c = 0; c < 3; ++c)
      {
        const int from = corners[c];
        const int to = corners[nextCorner(c)];
        if (from < hole.triangleCount && to == (from + 1 == hole.size ? 0 : from + 1))
        {
          onRing = true;
          if (!triangle.follows(this->oldNormals[from]))
          {
            return false;
          }
        }
      }
      if (!onRing && !triangle.follows(this->normal))
      {
        return false;
      }
    }
    return true;
  }
};

} // namespace undecimate

#endif
