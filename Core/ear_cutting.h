// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ear_cutting.h
/// @brief Triangulates the hole of a removed node by cutting ears.
///
/// Source: [K03] section 1.3, after the classical algorithm of computational geometry (an ear is a
/// triangle of three consecutive nodes of a polygon that contains no other node of it). Here in the
/// plane of the mean normal of the hole's old triangles, and the best-shaped ear goes first.

#ifndef UNDECIMATE_CORE_EAR_CUTTING_H
#define UNDECIMATE_CORE_EAR_CUTTING_H

#include "triangle_topology.h"

#include <array>

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

/// The polygon of a hole in the plane, and which of its corners are ears.
class EarCutting
{
public:
  /// @param ring size points, counterclockwise seen against the normal
  /// @param size 3 .. kMaximumPatchCells + 1
  /// @param normal of the plane, any length but 0
  EarCutting(const Vector* ring, int size, const Vector& normal);

  /// Cut the polygon into size - 2 triangles.
  /// @param mayConnect bool(int i, int j): whether the ring nodes i and j may be connected
  /// @return false if no ear is left that may be cut; `filling` is then unspecified
  /// Complexity: O(size^2).
  template <typename MayConnect>
  bool cut(MayConnect&& mayConnect, HoleTriangulation& filling)
  {
    filling.count = 0;
    while (this->left_ > 3)
    {
      const int ear = this->bestEar();
      if (ear < 0)
      {
        return false;
      }
      if (!mayConnect(this->previous_[ear], this->next_[ear]))
      {
        this->quality_[ear] = kNotAnEar;
        continue;
      }
      this->emit(ear, filling);
      this->take(ear);
    }
    const int last = this->anyLeft_;
    if (!(this->height(last) > kFlat))
    {
      return false;
    }
    this->emit(last, filling);
    return true;
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

  double height(int i) const;
  double earQuality(int i, double height) const;
  int bestEar() const;
  void take(int ear);
  void emit(int i, HoleTriangulation& filling) const
  {
    filling.triangles[filling.count++] = { static_cast<unsigned char>(this->previous_[i]),
      static_cast<unsigned char>(i), static_cast<unsigned char>(this->next_[i]) };
  }

  std::array<Point, kCapacity> points_;
  std::array<double, kCapacity> quality_;
  std::array<int, kCapacity> previous_;
  std::array<int, kCapacity> next_;
  int left_;
  int anyLeft_ = 0;
  bool convex_ = true;
};

} // namespace undecimate

#endif
