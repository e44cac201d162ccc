// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file vector.h
/// @brief A vector in space, and what is done with it everywhere.

#ifndef UNDECIMATE_CORE_VECTOR_H
#define UNDECIMATE_CORE_VECTOR_H

#include <cmath>

namespace undecimate
{

struct Vector
{
  // Not initialized: arrays of them are filled by their owners, and often only in part.
  double x;
  double y;
  double z;
};

inline Vector operator-(const Vector& a, const Vector& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}
inline Vector operator+(const Vector& a, const Vector& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}
inline Vector operator*(double s, const Vector& a)
{
  return { s * a.x, s * a.y, s * a.z };
}
inline double dot(const Vector& a, const Vector& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector cross(const Vector& a, const Vector& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
inline bool isFinite(const Vector& a)
{
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

} // namespace undecimate

#endif
