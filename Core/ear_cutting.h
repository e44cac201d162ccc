// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ear_cutting.h
/// @brief Triangulates the hole of a removed node by cutting ears.
///
/// Source: [K03] section 1.3, after the classical algorithm of computational geometry (an ear is a
/// triangle of three consecutive nodes of a polygon that contains no other node of it). Here in the
/// plane of the mean normal of the hole's old triangles, and the best-shaped ear goes first.
/// Orientation and containment are the same in every affine image of that plane, so the ring is
/// projected along the normal onto a coordinate plane; lengths and areas are those of the true
/// plane.

#ifndef UNDECIMATE_CORE_EAR_CUTTING_H
#define UNDECIMATE_CORE_EAR_CUTTING_H

#include "triangle_topology.h"
#include "vector.h"

#include <array>

namespace undecimate
{

/// The polygon of a hole in the plane, and which of its corners are ears.
class EarCutting
{
public:
  /// @param ring size points, counterclockwise seen against the normal
  /// @param size 3 .. kMaximumPatchCells + 1
  /// @param normal of the plane, any length but 0
  EarCutting(const Vector* ring, int size, const Vector& normal);

  /// Whether the first `count` of the triangles (origin, ring[i], ring[i + 1]) all lie upside up,
  /// so that the plane shows a hole around the origin as it is.
  bool seesFan(int count) const
  {
    const double* x = this->x_.data() + 1;
    const double* y = this->y_.data() + 1;
    int up = 0;
    for (int i = 0; i < count; ++i)
    {
      up += x[i] * y[i + 1] - y[i] * x[i + 1] > 0.0 ? 1 : 0;
    }
    return up == count;
  }

  /// Cut the polygon into size - 2 triangles. Once only.
  /// @param mayConnect bool(int i, int j): whether the ring nodes i and j may be connected
  /// @return false if no ear is left that may be cut; `filling` is then unspecified
  /// Complexity: O(size^2).
  template <typename MayConnect>
  bool cut(MayConnect&& mayConnect, HoleTriangulation& filling)
  {
    filling.count = 0;
    int left = this->size_;
    int last = 0;
    if (left > 3)
    {
      this->findEars();
    }
    while (left > 3)
    {
      const int ear = this->bestEar();
      if (ear < 0)
      {
        return false;
      }
      const int previous = this->previous_[ear];
      const int next = this->next_[ear];
      this->quality_[ear] = kNotAnEar;
      if (!mayConnect(previous, next))
      {
        continue;
      }
      emit(previous, ear, next, filling);
      this->next_[previous] = static_cast<unsigned char>(next);
      this->previous_[next] = static_cast<unsigned char>(previous);
      last = previous;
      if (--left > 3)
      {
        this->evaluate(previous);
        this->evaluate(next);
      }
    }
    const int previous = this->previous_[last];
    const int next = this->next_[last];
    emit(previous, last, next, filling);
    return this->height(previous, last, next) > this->flat_;
  }

private:
  static constexpr int kCapacity = kMaximumPatchCells + 1;
  static constexpr double kNotAnEar = -1.0;
  // Height over base below which an ear counts as degenerate (an equilateral one has 0.87).
  static constexpr double kFlat = 1e-5;

  struct Point
  {
    double x;
    double y;
  };

  static double orientation(const Point& a, const Point& b, const Point& c)
  {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  Point point(int i) const { return { this->x_[i + 1], this->y_[i + 1] }; }

  static void emit(int previous, int ear, int next, HoleTriangulation& filling)
  {
    filling.triangles[filling.count++] = { static_cast<unsigned char>(previous),
      static_cast<unsigned char>(ear), static_cast<unsigned char>(next) };
  }

  // Height of the ear i over its base, the edge that would be new, in units of the base and of the
  // plane's slope (see flat_); negative for a reflex corner. The larger, the shorter the new edge
  // and the less the angle it cuts off.
  double height(int previous, int i, int next) const
  {
    return this->height(this->point(previous), this->point(i), this->point(next));
  }

  double height(const Point& a, const Point& b, const Point& c) const
  {
    const double x = c.x - a.x;
    const double y = c.y - a.y;
    const double base = (this->xx_ * x + this->xy_ * y) * x + this->yy_ * y * y;
    const double height = orientation(a, b, c) / base;
    return base > 0.0 ? height : 0.0;
  }

  void evaluate(int i)
  {
    const int previous = this->previous_[i];
    const int next = this->next_[i];
    const double height = this->height(previous, i, next);
    this->quality_[i] =
      height > this->flat_ && this->isEmpty(previous, i, next) ? height : kNotAnEar;
  }

  // Whether no other corner lies in the triangle at corner i. If any does a reflex one does; a
  // corner that was cut lies outside what is left.
  bool isEmpty(int previous, int i, int next) const
  {
    const Point a = this->point(previous);
    const Point b = this->point(i);
    const Point c = this->point(next);
    for (int k = 0; k < this->reflexCount_; ++k)
    {
      const int corner = this->reflex_[k];
      const Point p = this->point(corner);
      if (corner != previous && corner != i && corner != next && orientation(a, b, p) >= 0.0 &&
        orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0)
      {
        return false;
      }
    }
    return true;
  }

  int bestEar() const
  {
    int best = -1;
    double quality = 0.0;
    for (int i = 0; i < this->size_; ++i)
    {
      const bool better = this->quality_[i] > quality;
      quality = better ? this->quality_[i] : quality;
      best = better ? i : best;
    }
    return best;
  }

  void findEars();

  // Corner i is at i + 1; the last one stands before the first, and the first behind the last.
  std::array<double, kCapacity + 2> x_;
  std::array<double, kCapacity + 2> y_;
  std::array<double, kCapacity> quality_;
  std::array<unsigned char, kCapacity> previous_;
  std::array<unsigned char, kCapacity> next_;
  std::array<unsigned char, kCapacity> reflex_; // not convex at first: none becomes so later
  int reflexCount_ = 0;
  int size_;
  // Squared length of (x, y) in the true plane: xx x^2 + xy x y + yy y^2.
  double xx_;
  double xy_;
  double yy_;
  double flat_; // kFlat over the ratio of a true area to a projected one
};

} // namespace undecimate

#endif
