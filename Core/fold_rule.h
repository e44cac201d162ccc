// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file fold_rule.h
/// @brief Which triangles of ring nodes may fill a hole without folding the surface.
///
/// A new triangle may not turn away too far from the old one on the same ring edge, or, if it has no
/// ring edge, from the mean normal of the hole. Needles may turn less: one that stands across the
/// surface is a fold, however near it is.

#ifndef UNDECIMATE_CORE_FOLD_RULE_H
#define UNDECIMATE_CORE_FOLD_RULE_H

#include "ear_cutting.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

/// A triangle of three nodes of a hole's ring, in the order of the ring.
class FilledTriangle
{
public:
  /// Cosine of the largest turn, for well-shaped triangles and for needles, and the shape (1 =
  /// equilateral) from which on a triangle is well-shaped.
  static constexpr double kMinimumCosine = 0.15;
  static constexpr double kNeedleCosine = 0.9;
  static constexpr double kNeedleShape = 0.1;

  /// Below this shape a triangle counts as degenerate.
  static constexpr double kMinimumShape = 1e-4;

  FilledTriangle(const Vector& a, const Vector& b, const Vector& c)
  {
    const Vector ab = b - a;
    const Vector ac = c - a;
    const Vector bc = c - b;
    const Vector n = cross(ab, ac);
    const double area = std::sqrt(dot(n, n));
    const double edges = dot(ab, ab) + dot(bc, bc) + dot(ac, ac);
    this->shape_ = area > 0.0 ? 2.0 * std::sqrt(3.0) * area / edges : 0.0;
    if (this->shape_ > kMinimumShape)
    {
      this->normal_ = (1.0 / area) * n;
      this->minimumCosine_ = kMinimumCosine +
        (kNeedleCosine - kMinimumCosine) * std::max(0.0, 1.0 - this->shape_ / kNeedleShape);
    }
  }

  bool degenerate() const { return !(this->shape_ > kMinimumShape); }

  /// 4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle.
  double shape() const { return this->shape_; }

  /// Unit normal, unless degenerate.
  const Vector& normal() const { return this->normal_; }

  /// Whether the triangle, not degenerate, may be beside one with such a normal (of any length).
  bool follows(const Vector& oldNormal) const
  {
    const double cosine = dot(this->normal_, oldNormal);
    return cosine > 0.0 &&
      cosine * cosine > this->minimumCosine_ * this->minimumCosine_ * dot(oldNormal, oldNormal);
  }

private:
  double shape_;
  double minimumCosine_ = 1.0;
  Vector normal_;
};

} // namespace undecimate

#endif
