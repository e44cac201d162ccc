// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ear_cutting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace undecimate
{

EarCutting::EarCutting(const Vector* ring, int size, const Vector& normal)
  : size_(size)
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
    this->x_[i + 1] = ring[i].*x - slopeX * depth;
    this->y_[i + 1] = ring[i].*y - slopeY * depth;
    this->previous_[i] = static_cast<unsigned char>(i == 0 ? size - 1 : i - 1);
    this->next_[i] = static_cast<unsigned char>(i == size - 1 ? 0 : i + 1);
  }
  this->x_[0] = this->x_[size];
  this->y_[0] = this->y_[size];
  this->x_[size + 1] = this->x_[1];
  this->y_[size + 1] = this->y_[1];
  const double square = 1.0 + slopeX * slopeX + slopeY * slopeY;
  this->xx_ = square - slopeX * slopeX;
  this->xy_ = -2.0 * slopeX * slopeY;
  this->yy_ = square - slopeY * slopeY;
  this->flat_ = kFlat / std::sqrt(square);
}

void EarCutting::findEars()
{
  const double* x = this->x_.data();
  const double* y = this->y_.data();
  for (int i = 0; i < this->size_; ++i)
  {
    this->quality_[i] =
      this->height({ x[i], y[i] }, { x[i + 1], y[i + 1] }, { x[i + 2], y[i + 2] });
  }
  for (int i = 0; i < this->size_; ++i)
  {
    this->reflex_[this->reflexCount_] = static_cast<unsigned char>(i);
    this->reflexCount_ += this->quality_[i] > 0.0 ? 0 : 1;
  }
  for (int i = 0; i < this->size_; ++i)
  {
    const bool ear = this->quality_[i] > this->flat_ &&
      (this->reflexCount_ == 0 || this->isEmpty(this->previous_[i], i, this->next_[i]));
    this->quality_[i] = ear ? this->quality_[i] : kNotAnEar;
  }
}

} // namespace undecimate
