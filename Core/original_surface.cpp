// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "original_surface.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

namespace
{

double squaredLength(const Vector& v)
{
  return dot(v, v);
}

// Squared distance from the origin to a triangle, by the region of the plane that it lies in: at a
// corner, beside an edge, or inside (C. Ericson: Real-Time Collision Detection (2005), 5.1.5).
double squaredDistanceToTriangle(const Vector& a, const Vector& b, const Vector& c)
{
  const Vector ab = b - a;
  const Vector ac = c - a;
  const double d1 = -dot(ab, a);
  const double d2 = -dot(ac, a);
  if (d1 <= 0.0 && d2 <= 0.0)
  {
    return squaredLength(a);
  }
  const double d3 = -dot(ab, b);
  const double d4 = -dot(ac, b);
  if (d3 >= 0.0 && d4 <= d3)
  {
    return squaredLength(b);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3)
  {
    return squaredLength(a + (d1 / (d1 - d3)) * ab);
  }
  const double d5 = -dot(ab, c);
  const double d6 = -dot(ac, c);
  if (d6 >= 0.0 && d5 <= d6)
  {
    return squaredLength(c);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6)
  {
    return squaredLength(a + (d2 / (d2 - d6)) * ac);
  }
  const double va = d3 * d6 - d5 * d4;
  const double alongB = d4 - d3;
  const double alongC = d5 - d6;
  if (va <= 0.0 && alongB >= 0.0 && alongC >= 0.0 && alongB + alongC > 0.0)
  {
    return squaredLength(b + (alongB / (alongB + alongC)) * (c - b));
  }
  const Vector normal = cross(ab, ac);
  const double square = squaredLength(normal);
  const double height = dot(normal, a);
  return square > 0.0 ? height * height / square
                      : std::min({ squaredLength(a), squaredLength(b), squaredLength(c) });
}

} // namespace

OriginalSurface::OriginalSurface(const TriangleMeshView& mesh, const TriangleTopology& topology)
  : mesh_(mesh)
  , topology_(topology)
  , first_(topology.nodeCount() + std::size_t{ 1 }, 0)
  , triangles_(std::size_t{ 3 } * topology.triangleCount())
{
  // Filled from the back, so that first_ ends where it should begin.
  for (Index t = 0; t < topology.triangleCount(); ++t)
  {
    for (const Index node : this->corners(t))
    {
      ++this->first_[node];
    }
  }
  Index sum = 0;
  for (Index& first : this->first_)
  {
    sum += first;
    first = sum;
  }
  for (Index t = topology.triangleCount() - 1; t >= 0; --t)
  {
    for (const Index node : this->corners(t))
    {
      this->triangles_[--this->first_[node]] = t;
    }
  }
}

Vector OriginalSurface::normal(Index node) const
{
  Vector sum{ 0.0, 0.0, 0.0 };
  for (Index i = this->first_[node]; i < this->first_[node + 1]; ++i)
  {
    const std::array<Index, 3> corners = this->corners(this->triangles_[i]);
    const Vector& a = this->topology_.node(corners[0]).position;
    sum = sum +
      cross(this->topology_.node(corners[1]).position - a,
        this->topology_.node(corners[2]).position - a);
  }
  const double length = std::sqrt(squaredLength(sum));
  return length > 0.0 && std::isfinite(length) ? (1.0 / length) * sum : Vector{ 0.0, 0.0, 0.0 };
}

double OriginalSurface::squaredDistance(const Vector& point, Index start, double enough) const
{
  std::array<Index, kMaximumVisits> visited;
  int visits = 0;
  const auto isVisited = [&](Index node) {
    return std::find(visited.begin(), visited.begin() + visits, node) != visited.begin() + visits;
  };
  double nearest = HUGE_VAL;
  std::array<Index, 3> best{ start, start, start }; // corners of the nearest triangle
  while (visits < kMaximumVisits)
  {
    const auto next = std::find_if_not(best.begin(), best.end(), isVisited);
    if (next == best.end())
    {
      break;
    }
    const Index node = *next;
    visited[visits++] = node;
    for (Index i = this->first_[node]; i < this->first_[node + 1]; ++i)
    {
      const std::array<Index, 3> corners = this->corners(this->triangles_[i]);
      const double square =
        squaredDistanceToTriangle(this->topology_.node(corners[0]).position - point,
          this->topology_.node(corners[1]).position - point,
          this->topology_.node(corners[2]).position - point);
      if (square < nearest)
      {
        nearest = square;
        best = corners;
        if (nearest <= enough)
        {
          return nearest;
        }
      }
    }
  }
  return nearest;
}

} // namespace undecimate
