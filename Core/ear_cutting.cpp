// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ear_cutting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace undecimate
{

EarCutting::EarCutting(const Vector* ring, int size, const Vector& normal)
  : left_(size)
{
  // Project along the largest component of the normal, call it z, and see the plane from above.
  double Vector::*x = &Vector::x;
  double Vector::*y = &Vector::y;
  double Vector::*z = &Vector::z;
  if (std::abs(normal.*z) < std::max(std::abs(normal.*x), std::abs(normal.*y)))
  {
    std::swap(x, z);
    std::swap(x, y);
    if (std::abs(normal.*z) < std::abs(normal.*x))
    {
      std::swap(x, z);
      std::swap(x, y);
    }
  }
  if (normal.*z < 0.0)
  {
    std::swap(x, y);
  }
  const double slopeX = normal.*x / normal.*z;
  const double slopeY = normal.*y / normal.*z;
  for (int i = 0; i < size; ++i)
  {
    const double depth = ring[i].*z;
    this->points_[i] = { ring[i].*x - slopeX * depth, ring[i].*y - slopeY * depth };
    this->previous_[i] = i == 0 ? size - 1 : i - 1;
    this->next_[i] = i == size - 1 ? 0 : i + 1;
  }
  const double square = 1.0 + slopeX * slopeX + slopeY * slopeY;
  const double scale = 1.0 / std::sqrt(square);
  this->xx_ = scale * (square - slopeX * slopeX);
  this->xy_ = scale * -2.0 * slopeX * slopeY;
  this->yy_ = scale * (square - slopeY * slopeY);
}

void EarCutting::findEars()
{
  std::array<double, kCapacity> heights;
  for (int i = 0; i < this->left_; ++i)
  {
    heights[i] = this->height(i);
    if (!(heights[i] > 0.0))
    {
      this->reflex_[this->reflexCount_++] = i;
    }
  }
  for (int i = 0; i < this->left_; ++i)
  {
    this->evaluate(i, heights[i]);
  }
}

} // namespace undecimate
