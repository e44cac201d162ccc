// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file diagonal.h
/// @brief The length in which distances are told.

#ifndef UNDECIMATE_CORE_DIAGONAL_H
#define UNDECIMATE_CORE_DIAGONAL_H

#include "triangle_topology.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

/// Length of the diagonal of the box around all finite points that a triangle uses; 0 if there is
/// none or it is infinite. O(triangles).
inline double diagonalOf(const TriangleTopology& topology)
{
  Vector low{ HUGE_VAL, HUGE_VAL, HUGE_VAL };
  Vector high{ -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  for (Index t = 0; t < topology.triangleCount(); ++t)
  {
    for (const Index node : topology.triangle(t).nodes)
    {
      const Vector& p = topology.node(node).position;
      if (isFinite(p))
      {
        low = { std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z) };
        high = { std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z) };
      }
    }
  }
  const Vector size = high - low;
  const double diagonal = std::sqrt(dot(size, size));
  return std::isfinite(diagonal) ? diagonal : 0.0;
}

} // namespace undecimate

#endif
