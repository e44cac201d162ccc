// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file closest_point.h
/// @brief Closest point of a triangle, in double precision, for tests.

#ifndef UNDECIMATE_CORE_TESTING_CLOSEST_POINT_H
#define UNDECIMATE_CORE_TESTING_CLOSEST_POINT_H

#include "ear_cutting.h"

namespace undecimate
{
namespace testing
{

/// Squared distance, and the weights of b and c.
struct Closest
{
  double square;
  double weightB;
  double weightC;
};

/// Closest point of a triangle by the regions of its corners, edges and inside, in double precision
/// (C. Ericson: Real-Time Collision Detection, 2005, section 5.1.5): another way than the code's.
inline Closest closestPoint(const Vector& p, const Vector& a, const Vector& b, const Vector& c)
{
  const Vector ab = b - a;
  const Vector ac = c - a;
  const auto at = [&](double v, double w)
  {
    const Vector d = p - (a + v * ab + w * ac);
    return Closest{ dot(d, d), v, w };
  };
  const double d1 = dot(ab, p - a);
  const double d2 = dot(ac, p - a);
  if (d1 <= 0.0 && d2 <= 0.0)
  {
    return at(0.0, 0.0);
  }
  const double d3 = dot(ab, p - b);
  const double d4 = dot(ac, p - b);
  if (d3 >= 0.0 && d4 <= d3)
  {
    return at(1.0, 0.0);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
  {
    return at(d1 / (d1 - d3), 0.0);
  }
  const double d5 = dot(ab, p - c);
  const double d6 = dot(ac, p - c);
  if (d6 >= 0.0 && d5 <= d6)
  {
    return at(0.0, 1.0);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
  {
    return at(0.0, d2 / (d2 - d6));
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
  {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(1.0 - w, w);
  }
  const double sum = va + vb + vc;
  return at(vb / sum, vc / sum);
}

} // namespace testing
} // namespace undecimate

#endif
