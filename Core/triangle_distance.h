// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file triangle_distance.h
/// @brief Squared distances of many points to one triangle, without branches.
///
/// In the frame of each edge (along it, and inwards in the triangle's plane) the distance to the
/// edge is the inward offset and the excess beyond its ends; inside all three edges only the height
/// over the plane is left. Written so that compilers turn the loops into vector instructions.

#ifndef UNDECIMATE_CORE_TRIANGLE_DISTANCE_H
#define UNDECIMATE_CORE_TRIANGLE_DISTANCE_H

#include "ear_cutting.h"

#include <vector>

namespace undecimate
{

/// Points as three arrays of equal length, padded to whole vectors (see paddedSize()).
struct PointRows
{
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  int size = 0; ///< padded
};

/// Rows are handled in blocks of so many floats.
constexpr int kRowBlock = 8;

inline int paddedSize(int size)
{
  return (size + kRowBlock - 1) / kRowBlock * kRowBlock;
}

/// A triangle prepared for distances.
class DistanceTriangle
{
public:
  DistanceTriangle() = default;

  /// @return false if the triangle has no area (the object is then not to be used)
  bool set(const Vector& a, const Vector& b, const Vector& c);

  /// squares[i] = squared distance of point i.
  void squaredDistances(const PointRows& points, float* squares) const;

  /// As squaredDistances(), and the weights of corners b and c at the closest point.
  void closestPoints(const PointRows& points, float* squares, float* weightB, float* weightC) const;

  struct Edge
  {
    float along[3];   // unit vector
    float start;      // of the edge's first corner, along the edge
    float inwards[3]; // unit vector in the plane
    float side;       // of the edge, inwards
    float length;
    float inverseHeight; // of the opposite corner over the edge
  };
  Edge edges[3];
  float normal[3];
  float height;
};

/// The triangles of a hole, prepared and measured together.
class DistanceTriangles
{
public:
  /// @param ring of the hole
  /// @param filling of triangles that have an area
  void set(const Vector* ring, const HoleTriangulation& filling);

  /// Of each point, the squared distance to the nearest triangle, and which one that is (the first
  /// of those at the same distance). At least one triangle.
  void findNearest(const PointRows& points, float* squares, int* triangles) const;

  /// Mark the points that lie over or under a triangle and whose height there has a square of at
  /// most `enough`: they surely have such a triangle near. Less work than findNearest().
  /// @param[out] marks 1 or 0 for each point
  void markNear(const PointRows& points, float enough, int* marks) const;

private:
  using Row = float[kMaximumPatchCells];

  DistanceTriangle at(int t) const;

  friend struct DistanceKernels; // vector clones are no members

  int count_ = 0;
  double corners_[3][3][kMaximumPatchCells] = {}; // corner, axis
  // As in DistanceTriangle, a row each.
  Row along_[3][3] = {};
  Row start_[3] = {};
  Row inwards_[3][3] = {};
  Row side_[3] = {};
  Row length_[3] = {};
  Row normal_[3] = {};
  Row height_ = {};
};

/// The point nearest to a place; of points at the same distance the first.
int nearestPoint(const PointRows& points, float x, float y, float z);

/// Coordinates of points along two axes.
void project(const PointRows& points, const Vector& axisX, const Vector& axisY, float* x, float* y);

/// sides[i] = dx y[i] - dy x[i] - offset: positive on the left of a line along (dx, dy).
void sidesOfLine(
  const float* x, const float* y, int size, float dx, float dy, float offset, float* sides);

/// Sides of points against the three edges of a triangle a, b, c: on the left of a-b and of b-c, on
/// the right of a-c.
struct SideRows
{
  const float* ab;
  const float* bc;
  const float* ac;
};

/// The largest of (normal . point - offset)^2, and of extra[i] (may be null), over the points
/// inside; 0 if there are none. Points on an edge are inside.
float largestSquaredHeight(const PointRows& points, const Vector& normal, double offset,
  const SideRows& sides, const float* extra);

} // namespace undecimate

#endif
