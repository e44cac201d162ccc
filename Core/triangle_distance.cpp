// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "triangle_distance.h"

#include "compiler.h"

#include <cmath>
#include <limits>

namespace undecimate
{

bool DistanceTriangle::set(const Vector& a, const Vector& b, const Vector& c)
{
  const Vector corners[3] = { a, b, c };
  Vector n = cross(b - a, c - a);
  const double area = std::sqrt(dot(n, n));
  if (!(area > 0.0))
  {
    return false;
  }
  n = (1.0 / area) * n;
  for (int k = 0; k < 3; ++k)
  {
    const Vector& from = corners[k];
    Vector along = corners[nextCorner(k)] - from;
    const double length = std::sqrt(dot(along, along));
    along = (1.0 / length) * along;
    const Vector inwards = cross(n, along);
    this->edges[k] = { { static_cast<float>(along.x), static_cast<float>(along.y),
                         static_cast<float>(along.z) },
      static_cast<float>(dot(along, from)),
      { static_cast<float>(inwards.x), static_cast<float>(inwards.y),
        static_cast<float>(inwards.z) },
      static_cast<float>(dot(inwards, from)), static_cast<float>(length),
      static_cast<float>(length / area) };
  }
  this->normal[0] = static_cast<float>(n.x);
  this->normal[1] = static_cast<float>(n.y);
  this->normal[2] = static_cast<float>(n.z);
  this->height = static_cast<float>(dot(n, a));
  return true;
}

namespace
{

inline float larger(float a, float b)
{
  return a > b ? a : b;
}
inline float smaller(float a, float b)
{
  return a < b ? a : b;
}

inline float inProduct(const float* v, float x, float y, float z)
{
  return v[0] * x + v[1] * y + v[2] * z;
}

// Squared distance within the plane to an edge, and the side of it.
inline float edgeSquare(const DistanceTriangle::Edge& edge, float x, float y, float z, float& side)
{
  side = inProduct(edge.inwards, x, y, z) - edge.side;
  const float along = inProduct(edge.along, x, y, z) - edge.start;
  const float excess = larger(larger(-along, along - edge.length), 0.0F);
  return side * side + excess * excess;
}

inline float squaredDistance(const DistanceTriangle& t, float x, float y, float z)
{
  float side0;
  float side1;
  float side2;
  const float square0 = edgeSquare(t.edges[0], x, y, z, side0);
  const float square1 = edgeSquare(t.edges[1], x, y, z, side1);
  const float square2 = edgeSquare(t.edges[2], x, y, z, side2);
  const float inside = smaller(smaller(side0, side1), side2);
  const float nearest = smaller(smaller(square0, square1), square2);
  const float height = inProduct(t.normal, x, y, z) - t.height;
  return height * height + (inside >= 0.0F ? 0.0F : nearest);
}

UNDECIMATE_VECTOR_CLONES
void fillSquares(const DistanceTriangle& triangle, const float* __restrict__ x,
  const float* __restrict__ y, const float* __restrict__ z, int size, float* __restrict__ squares)
{
  const DistanceTriangle t = triangle;
  for (int i = 0; i < size; ++i)
  {
    squares[i] = squaredDistance(t, x[i], y[i], z[i]);
  }
}

inline float fractionAlong(const DistanceTriangle::Edge& edge, float x, float y, float z)
{
  const float along = (inProduct(edge.along, x, y, z) - edge.start) / edge.length;
  return smaller(larger(along, 0.0F), 1.0F);
}

UNDECIMATE_VECTOR_CLONES
void fillClosest(const DistanceTriangle& triangle, const float* __restrict__ x,
  const float* __restrict__ y, const float* __restrict__ z, int size, float* __restrict__ squares,
  float* __restrict__ weightB, float* __restrict__ weightC)
{
  const DistanceTriangle t = triangle;
  for (int i = 0; i < size; ++i)
  {
    float side0;
    float side1;
    float side2;
    const float square0 = edgeSquare(t.edges[0], x[i], y[i], z[i], side0);
    const float square1 = edgeSquare(t.edges[1], x[i], y[i], z[i], side1);
    const float square2 = edgeSquare(t.edges[2], x[i], y[i], z[i], side2);
    const bool inside = smaller(smaller(side0, side1), side2) >= 0.0F;
    const float nearest = smaller(smaller(square0, square1), square2);
    const float height = inProduct(t.normal, x[i], y[i], z[i]) - t.height;
    squares[i] = height * height + (inside ? 0.0F : nearest);
    // Edge 0 runs from a to b, edge 1 from b to c, edge 2 from c to a.
    const float on0 = fractionAlong(t.edges[0], x[i], y[i], z[i]);
    const float on1 = fractionAlong(t.edges[1], x[i], y[i], z[i]);
    const float on2 = fractionAlong(t.edges[2], x[i], y[i], z[i]);
    const bool first = square0 <= nearest;
    const bool second = square1 <= nearest;
    const float outsideB = first ? on0 : (second ? 1.0F - on1 : 0.0F);
    const float outsideC = first ? 0.0F : (second ? on1 : 1.0F - on2);
    weightB[i] = inside ? side2 * t.edges[2].inverseHeight : outsideB;
    weightC[i] = inside ? side0 * t.edges[0].inverseHeight : outsideC;
  }
}

} // namespace

void DistanceTriangle::squaredDistances(const PointRows& points, float* squares) const
{
  fillSquares(*this, points.x, points.y, points.z, points.size, squares);
}

void DistanceTriangle::closestPoints(
  const PointRows& points, float* squares, float* weightB, float* weightC) const
{
  fillClosest(*this, points.x, points.y, points.z, points.size, squares, weightB, weightC);
}

// The loops, compiled for wider vectors as well.
struct DistanceKernels
{
  static void set(DistanceTriangles& d, int count);
  static void findNearest(const DistanceTriangles& d, const PointRows& points,
    float* __restrict__ squares, int* __restrict__ triangles);
  static void markNear(
    const DistanceTriangles& d, const PointRows& points, float enough, int* __restrict__ marks);
};

// As DistanceTriangle::set(), of several triangles at a time.
UNDECIMATE_VECTOR_CLONES
void DistanceKernels::set(DistanceTriangles& d, int count)
{
  constexpr int kSetBlock = 4;
  static_assert(kMaximumPatchCells % kSetBlock == 0, "whole vectors");
  const auto corner = [&d](int c, int t) -> Vector {
    return { d.corners_[c][0][t], d.corners_[c][1][t], d.corners_[c][2][t] };
  };
  for (int begin = 0; begin < count; begin += kSetBlock)
  {
    double normals[3][kSetBlock];
    for (int i = 0; i < kSetBlock; ++i)
    {
      const Vector a = corner(0, begin + i);
      const Vector n = cross(corner(1, begin + i) - a, corner(2, begin + i) - a);
      const double area = std::sqrt(dot(n, n));
      const double inverse = 1.0 / area;
      normals[0][i] = inverse * n.x;
      normals[1][i] = inverse * n.y;
      normals[2][i] = inverse * n.z;
    }
    for (int i = 0; i < kSetBlock; ++i)
    {
      const Vector n{ normals[0][i], normals[1][i], normals[2][i] };
      d.normal_[0][begin + i] = static_cast<float>(n.x);
      d.normal_[1][begin + i] = static_cast<float>(n.y);
      d.normal_[2][begin + i] = static_cast<float>(n.z);
      d.height_[begin + i] = static_cast<float>(dot(n, corner(0, begin + i)));
    }
    for (int k = 0; k < 3; ++k)
    {
      const int next = nextCorner(k);
      for (int i = 0; i < kSetBlock; ++i)
      {
        const Vector n{ normals[0][i], normals[1][i], normals[2][i] };
        const Vector from = corner(k, begin + i);
        Vector along = corner(next, begin + i) - from;
        const double length = std::sqrt(dot(along, along));
        along = (1.0 / length) * along;
        const Vector inwards = cross(n, along);
        d.along_[k][0][begin + i] = static_cast<float>(along.x);
        d.along_[k][1][begin + i] = static_cast<float>(along.y);
        d.along_[k][2][begin + i] = static_cast<float>(along.z);
        d.start_[k][begin + i] = static_cast<float>(dot(along, from));
        d.inwards_[k][0][begin + i] = static_cast<float>(inwards.x);
        d.inwards_[k][1][begin + i] = static_cast<float>(inwards.y);
        d.inwards_[k][2][begin + i] = static_cast<float>(inwards.z);
        d.side_[k][begin + i] = static_cast<float>(dot(inwards, from));
        d.length_[k][begin + i] = static_cast<float>(length);
      }
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void DistanceKernels::findNearest(const DistanceTriangles& d, const PointRows& points,
  float* __restrict__ squares, int* __restrict__ triangles)
{
  for (int begin = 0; begin < points.size; begin += kRowBlock)
  {
    float least[kRowBlock];
    int nearest[kRowBlock];
    for (int i = 0; i < kRowBlock; ++i)
    {
      least[i] = std::numeric_limits<float>::infinity();
      nearest[i] = 0;
    }
    for (int k = 0; k < d.count_; ++k)
    {
      const DistanceTriangle t = d.at(k);
      for (int i = 0; i < kRowBlock; ++i)
      {
        const float square =
          squaredDistance(t, points.x[begin + i], points.y[begin + i], points.z[begin + i]);
        nearest[i] = square < least[i] ? k : nearest[i];
        least[i] = smaller(square, least[i]);
      }
    }
    for (int i = 0; i < kRowBlock; ++i)
    {
      squares[begin + i] = least[i];
      triangles[begin + i] = nearest[i];
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void DistanceKernels::markNear(
  const DistanceTriangles& d, const PointRows& points, float enough, int* __restrict__ marks)
{
  for (int begin = 0; begin < points.size; begin += kRowBlock)
  {
    int near[kRowBlock] = {};
    for (int k = 0; k < d.count_; ++k)
    {
      UNDECIMATE_LANES
      for (int i = 0; i < kRowBlock; ++i)
      {
        const float x = points.x[begin + i];
        const float y = points.y[begin + i];
        const float z = points.z[begin + i];
        const auto side = [&](int edge)
        {
          return d.inwards_[edge][0][k] * x + d.inwards_[edge][1][k] * y +
            d.inwards_[edge][2][k] * z - d.side_[edge][k];
        };
        const float side0 = side(0);
        const float side1 = side(1);
        const float side2 = side(2);
        const float height =
          d.normal_[0][k] * x + d.normal_[1][k] * y + d.normal_[2][k] * z - d.height_[k];
        near[i] |=
          (side0 >= 0.0F) & (side1 >= 0.0F) & (side2 >= 0.0F) & (height * height <= enough);
      }
    }
    for (int i = 0; i < kRowBlock; ++i)
    {
      marks[begin + i] = near[i];
    }
  }
}

UNDECIMATE_INLINE DistanceTriangle DistanceTriangles::at(int t) const
{
  DistanceTriangle triangle;
  for (int k = 0; k < 3; ++k)
  {
    DistanceTriangle::Edge& edge = triangle.edges[k];
    for (int axis = 0; axis < 3; ++axis)
    {
      edge.along[axis] = this->along_[k][axis][t];
      edge.inwards[axis] = this->inwards_[k][axis][t];
    }
    edge.start = this->start_[k][t];
    edge.side = this->side_[k][t];
    edge.length = this->length_[k][t];
    edge.inverseHeight = 0.0F; // not needed for distances
    triangle.normal[k] = this->normal_[k][t];
  }
  triangle.height = this->height_[t];
  return triangle;
}

void DistanceTriangles::set(const Vector* ring, const HoleTriangulation& filling)
{
  this->count_ = filling.count;
  for (int t = 0; t < filling.count; ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Vector& p = ring[filling.triangles[t][c]];
      this->corners_[c][0][t] = p.x;
      this->corners_[c][1][t] = p.y;
      this->corners_[c][2][t] = p.z;
    }
  }
  DistanceKernels::set(*this, filling.count);
}

void DistanceTriangles::findNearest(const PointRows& points, float* squares, int* triangles) const
{
  DistanceKernels::findNearest(*this, points, squares, triangles);
}

void DistanceTriangles::markNear(const PointRows& points, float enough, int* marks) const
{
  DistanceKernels::markNear(*this, points, enough, marks);
}

UNDECIMATE_VECTOR_CLONES
int nearestPoint(const PointRows& points, float x, float y, float z)
{
  float lanes[kRowBlock];
  int numbers[kRowBlock];
  for (int i = 0; i < kRowBlock; ++i)
  {
    lanes[i] = std::numeric_limits<float>::infinity();
    numbers[i] = i;
  }
  for (int begin = 0; begin < points.size; begin += kRowBlock)
  {
    UNDECIMATE_LANES
    for (int i = 0; i < kRowBlock; ++i)
    {
      const float dx = points.x[begin + i] - x;
      const float dy = points.y[begin + i] - y;
      const float dz = points.z[begin + i] - z;
      const float square = dx * dx + dy * dy + dz * dz;
      numbers[i] = square < lanes[i] ? begin + i : numbers[i];
      lanes[i] = smaller(square, lanes[i]);
    }
  }
  float least = lanes[0];
  int nearest = numbers[0];
  for (int i = 1; i < kRowBlock; ++i)
  {
    const bool first = lanes[i] < least || (lanes[i] == least && numbers[i] < nearest);
    nearest = first ? numbers[i] : nearest;
    least = smaller(lanes[i], least);
  }
  return nearest;
}

UNDECIMATE_VECTOR_CLONES
void project(const PointRows& points, const Vector& axisX, const Vector& axisY,
  float* __restrict__ x, float* __restrict__ y)
{
  const float ux = static_cast<float>(axisX.x);
  const float uy = static_cast<float>(axisX.y);
  const float uz = static_cast<float>(axisX.z);
  const float vx = static_cast<float>(axisY.x);
  const float vy = static_cast<float>(axisY.y);
  const float vz = static_cast<float>(axisY.z);
  for (int i = 0; i < points.size; ++i)
  {
    x[i] = ux * points.x[i] + uy * points.y[i] + uz * points.z[i];
    y[i] = vx * points.x[i] + vy * points.y[i] + vz * points.z[i];
  }
}

UNDECIMATE_VECTOR_CLONES
void sidesOfLine(const float* __restrict__ x, const float* __restrict__ y, int size, float dx,
  float dy, float offset, float* __restrict__ sides)
{
  for (int i = 0; i < size; ++i)
  {
    sides[i] = dx * y[i] - dy * x[i] - offset;
  }
}

namespace
{

UNDECIMATE_VECTOR_CLONES
void largestHeights(const PointRows& points, const float* n, float offset, const SideRows& sides,
  float* __restrict__ largest)
{
  for (int begin = 0; begin < points.size; begin += kRowBlock)
  {
    for (int k = 0; k < kRowBlock; ++k)
    {
      const int i = begin + k;
      const float height = inProduct(n, points.x[i], points.y[i], points.z[i]) - offset;
      const float inside = smaller(smaller(sides.ab[i], sides.bc[i]), -sides.ac[i]);
      const float square = inside >= 0.0F ? height * height : 0.0F;
      largest[k] = larger(largest[k], square);
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void largestExtras(
  int size, const SideRows& sides, const float* __restrict__ extra, float* __restrict__ largest)
{
  for (int begin = 0; begin < size; begin += kRowBlock)
  {
    for (int k = 0; k < kRowBlock; ++k)
    {
      const int i = begin + k;
      const float inside = smaller(smaller(sides.ab[i], sides.bc[i]), -sides.ac[i]);
      largest[k] = larger(largest[k], inside >= 0.0F ? extra[i] : 0.0F);
    }
  }
}

} // namespace

float largestSquaredHeight(const PointRows& points, const Vector& normal, double offset,
  const SideRows& sides, const float* extra)
{
  const float n[3] = { static_cast<float>(normal.x), static_cast<float>(normal.y),
    static_cast<float>(normal.z) };
  float largest[kRowBlock] = {};
  largestHeights(points, n, static_cast<float>(offset), sides, largest);
  if (extra)
  {
    largestExtras(points.size, sides, extra, largest);
  }
  float result = 0.0F;
  for (const float square : largest)
  {
    result = larger(result, square);
  }
  return result;
}

} // namespace undecimate
