// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ear_cutting.h"

#include <cmath>

namespace undecimate
{

EarCutting::EarCutting(const Vector* ring, int size, const Vector& normal)
  : left_(size)
{
  // Any basis of the plane will do: start from the axis that is farthest from the normal.
  const Vector axis = std::abs(normal.x) <= std::abs(normal.y) && std::abs(normal.x) <= std::abs(normal.z)
    ? Vector{ 1.0, 0.0, 0.0 }
    : std::abs(normal.y) <= std::abs(normal.z) ? Vector{ 0.0, 1.0, 0.0 } : Vector{ 0.0, 0.0, 1.0 };
  const double length = std::sqrt(dot(normal, normal));
  const Vector n = (1.0 / length) * normal;
  Vector u = cross(axis, n);
  u = (1.0 / std::sqrt(dot(u, u))) * u;
  const Vector v = cross(n, u);
  for (int i = 0; i < size; ++i)
  {
    this->points_[i] = { dot(ring[i], u), dot(ring[i], v) };
    this->previous_[i] = i == 0 ? size - 1 : i - 1;
    this->next_[i] = i == size - 1 ? 0 : i + 1;
  }
  for (int i = 0; i < size; ++i)
  {
    this->quality_[i] = this->height(i);
    this->convex_ = this->convex_ && this->quality_[i] > 0.0;
  }
  for (int i = 0; i < size; ++i)
  {
    this->quality_[i] = this->earQuality(i, this->quality_[i]);
  }
}

namespace
{
template <typename Point>
double orientation(const Point& a, const Point& b, const Point& c)
{
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
template <typename Point>
double squaredLength(const Point& a, const Point& b)
{
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}
} // namespace

// Height of the ear over its base, the edge that would be new, in units of the base; negative for a
// reflex corner. The larger, the shorter the new edge and the less the angle it cuts off.
double EarCutting::height(int i) const
{
  const Point& a = this->points_[this->previous_[i]];
  const Point& b = this->points_[i];
  const Point& c = this->points_[this->next_[i]];
  const double base = squaredLength(a, c);
  return base > 0.0 ? orientation(a, b, c) / base : 0.0;
}

double EarCutting::earQuality(int i, double height) const
{
  if (!(height > kFlat))
  {
    return kNotAnEar;
  }
  // What is left of a convex polygon is convex, and no corner lies in an ear.
  if (this->convex_)
  {
    return height;
  }
  const Point& a = this->points_[this->previous_[i]];
  const Point& b = this->points_[i];
  const Point& c = this->points_[this->next_[i]];
  for (int k = this->next_[this->next_[i]]; k != this->previous_[i]; k = this->next_[k])
  {
    const Point& p = this->points_[k];
    if (orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0)
    {
      return kNotAnEar;
    }
  }
  return height;
}

int EarCutting::bestEar() const
{
  int best = -1;
  double quality = 0.0;
  int i = this->anyLeft_;
  for (int k = 0; k < this->left_; ++k, i = this->next_[i])
  {
    if (this->quality_[i] > quality)
    {
      quality = this->quality_[i];
      best = i;
    }
  }
  return best;
}

void EarCutting::take(int ear)
{
  const int previous = this->previous_[ear];
  const int next = this->next_[ear];
  this->next_[previous] = next;
  this->previous_[next] = previous;
  this->anyLeft_ = previous;
  --this->left_;
  this->quality_[previous] = this->earQuality(previous, this->height(previous));
  this->quality_[next] = this->earQuality(next, this->height(next));
}

} // namespace undecimate
