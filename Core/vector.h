// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file vector.h
/// @brief A vector in space, and what is done with it everywhere.

#ifndef UNDECIMATE_CORE_VECTOR_H
#define UNDECIMATE_CORE_VECTOR_H

#include "compiler.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

/// Always inlined, so that a caller that is compiled for wider vector instructions takes it along.
template <class Number>
struct VectorOf
{
  // Not initialized: arrays of them are filled by their owners, and often only in part.
  Number x;
  Number y;
  Number z;

  friend UNDECIMATE_INLINE VectorOf operator-(const VectorOf& a, const VectorOf& b)
  {
    return { a.x - b.x, a.y - b.y, a.z - b.z };
  }
  friend UNDECIMATE_INLINE VectorOf operator+(const VectorOf& a, const VectorOf& b)
  {
    return { a.x + b.x, a.y + b.y, a.z + b.z };
  }
  friend UNDECIMATE_INLINE VectorOf operator*(Number s, const VectorOf& a)
  {
    return { s * a.x, s * a.y, s * a.z };
  }
  friend UNDECIMATE_INLINE Number dot(const VectorOf& a, const VectorOf& b)
  {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend UNDECIMATE_INLINE VectorOf cross(const VectorOf& a, const VectorOf& b)
  {
    return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
  }
  friend UNDECIMATE_INLINE bool isFinite(const VectorOf& a)
  {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
  }
};

using Vector = VectorOf<double>;

/// The box around points, at first around none.
struct Box
{
  Vector low{ HUGE_VAL, HUGE_VAL, HUGE_VAL };
  Vector high{ -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };

  void add(const Vector& p)
  {
    this->low = { std::min(this->low.x, p.x), std::min(this->low.y, p.y),
      std::min(this->low.z, p.z) };
    this->high = { std::max(this->high.x, p.x), std::max(this->high.y, p.y),
      std::max(this->high.z, p.z) };
  }

  /// Its corners; those of an empty one change nothing.
  void add(const Box& other)
  {
    this->low = { std::min(this->low.x, other.low.x), std::min(this->low.y, other.low.y),
      std::min(this->low.z, other.low.z) };
    this->high = { std::max(this->high.x, other.high.x), std::max(this->high.y, other.high.y),
      std::max(this->high.z, other.high.z) };
  }
};

} // namespace undecimate

#endif
