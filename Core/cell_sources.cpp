// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cell_sources.h"

#include <array>
#include <cmath>

namespace undecimate
{

namespace
{

struct Point
{
  double x;
  double y;
};

double orientation(const Point& a, const Point& b, const Point& c)
{
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

using Corners = std::array<Point, 3>;

// Area that two counterclockwise triangles share: one is clipped by the edges of the other
// (Sutherland, Hodgman: Reentrant polygon clipping, CACM 17 (1974)).
double sharedArea(const Corners& subject, const Corners& window)
{
  std::array<Point, 8> polygon{ subject[0], subject[1], subject[2] };
  int size = 3;
  for (int edge = 0; edge < 3; ++edge)
  {
    const Point& a = window[edge];
    const Point& b = window[nextCorner(edge)];
    std::array<Point, 8> clipped;
    int count = 0;
    for (int i = 0; i < size; ++i)
    {
      const Point& p = polygon[i];
      const Point& q = polygon[i + 1 == size ? 0 : i + 1];
      const double sideP = orientation(a, b, p);
      const double sideQ = orientation(a, b, q);
      if (sideP >= 0.0)
      {
        clipped[count++] = p;
      }
      if ((sideP > 0.0 && sideQ < 0.0) || (sideP < 0.0 && sideQ > 0.0))
      {
        const double t = sideP / (sideP - sideQ);
        clipped[count++] = { p.x + t * (q.x - p.x), p.y + t * (q.y - p.y) };
      }
    }
    polygon = clipped;
    size = count;
    if (size < 3)
    {
      return 0.0;
    }
  }
  double area = 0.0;
  for (int i = 1; i + 1 < size; ++i)
  {
    area += orientation(polygon[0], polygon[i], polygon[i + 1]);
  }
  return 0.5 * area;
}

} // namespace

void findCellSources(const TriangleTopology& topology, const Hole& hole,
  const HoleTriangulation& filling, unsigned char* sources)
{
  std::array<Vector, kMaximumPatchCells + 1> ring;
  const Vector center = topology.node(hole.node).position;
  for (int i = 0; i < hole.size; ++i)
  {
    ring[i] = topology.node(hole.ring[i]).position - center;
  }
  Vector normal{ 0.0, 0.0, 0.0 };
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    normal = normal + cross(ring[i], ring[i + 1 == hole.size ? 0 : i + 1]);
  }
  const Vector axis =
    std::abs(normal.x) < std::abs(normal.y) ? Vector{ 1.0, 0.0, 0.0 } : Vector{ 0.0, 1.0, 0.0 };
  Vector u = cross(axis, normal);
  const double length = std::sqrt(dot(u, u));
  u = (length > 0.0 ? 1.0 / length : 0.0) * u;
  Vector v = cross(normal, u);
  const double height = std::sqrt(dot(v, v));
  v = (height > 0.0 ? 1.0 / height : 0.0) * v;
  std::array<Point, kMaximumPatchCells + 1> flat;
  for (int i = 0; i < hole.size; ++i)
  {
    flat[i] = { dot(ring[i], u), dot(ring[i], v) };
  }
  for (int t = 0; t < filling.count; ++t)
  {
    const auto& corners = filling.triangles[t];
    const Corners added{ flat[corners[0]], flat[corners[1]], flat[corners[2]] };
    double largest = -1.0;
    for (int i = 0; i < hole.triangleCount; ++i)
    {
      const Corners old{ Point{ 0.0, 0.0 }, flat[i], flat[i + 1 == hole.size ? 0 : i + 1] };
      const double area = sharedArea(added, old);
      if (area > largest)
      {
        largest = area;
        sources[t] = static_cast<unsigned char>(i);
      }
    }
  }
}

} // namespace undecimate
