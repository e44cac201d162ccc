// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "original_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

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

OriginalSurface::OriginalSurface(const TriangleTopology& topology, Threads* threads)
  : topology_(topology)
  , first_(topology.nodeCount() + std::size_t{ 1 }, 0)
{
  // A fan has a node more than triangles. Where triangles make no fan each of them is one.
  const Index triangleCount = topology.triangleCount();
  topology.doInNodeShares(threads,
    [&](const auto& share)
    {
      topology.visitTriangles(share,
        [&](Index t, const auto& ours)
        {
          for (const Index node : topology.triangle(t).nodes)
          {
            if (ours.has(node))
            {
              this->first_[node] += topology.isManifold(node) ? 1 : 2;
            }
          }
        });
    });
  Index sum = 0;
  for (Index node = 0; node < topology.nodeCount(); ++node)
  {
    const Index count = this->first_[node] + (topology.isManifold(node) ? 1 : 0);
    this->first_[node] = sum;
    sum += count;
  }
  this->first_[topology.nodeCount()] = sum;
  this->entries_.resize(sum);
  std::atomic<bool> anyOther{ false };
  doInShares(threads, topology.nodeCount(),
    [&](const Share& share)
    {
      for (Index node = share.begin; node < share.end; ++node)
      {
        if (!topology.isManifold(node))
        {
          anyOther.store(true, std::memory_order_relaxed);
          continue;
        }
        Index* entry = this->entries_.data() + this->first_[node];
        topology.visitFan(node, [&entry](Index other) { *entry++ = other; });
        entry = this->entries_.data() + this->first_[node];
        *entry = ~*entry;
      }
    });
  std::vector<Index> filled(anyOther ? topology.nodeCount() : 0, 0); // of the nodes without a fan
  for (Index t = 0; t < triangleCount && !filled.empty(); ++t)
  {
    const auto& nodes = topology.triangle(t).nodes;
    for (int c = 0; c < 3; ++c)
    {
      if (!topology.isManifold(nodes[c]))
      {
        Index* entry = this->entries_.data() + this->first_[nodes[c]] + filled[nodes[c]];
        entry[0] = ~nodes[nextCorner(c)];
        entry[1] = nodes[previousCorner(c)];
        filled[nodes[c]] += 2;
      }
    }
  }
}

Vector OriginalSurface::normal(Index node) const
{
  Vector sum{ 0.0, 0.0, 0.0 };
  const Vector& center = this->topology_.node(node).position;
  Vector before{ 0.0, 0.0, 0.0 };
  for (const Index entry : this->ring(node))
  {
    const Vector place = this->topology_.node(nodeOf(entry)).position - center;
    if (!isFanStart(entry))
    {
      sum = sum + cross(before, place);
    }
    before = place;
  }
  const double length = std::sqrt(squaredLength(sum));
  return length > 0.0 && std::isfinite(length) ? (1.0 / length) * sum : Vector{ 0.0, 0.0, 0.0 };
}

bool OriginalSurface::isNear(const Vector& point, Index node, double enough) const
{
  constexpr double kRounding = 1e-12; // of the square of the distance from the node
  const Vector& center = this->topology_.node(node).position;
  const Vector seen = point - center;
  const double limit = enough - kRounding * dot(seen, seen);
  const double rest = dot(seen, seen) - limit;
  Vector before{ 0.0, 0.0, 0.0 };
  double alongBefore = 0.0;
  double squareBefore = 0.0;
  for (const Index entry : this->ring(node))
  {
    const Vector edge = this->topology_.node(nodeOf(entry)).position - center;
    const double along = dot(edge, seen);
    const double square = dot(edge, edge);
    if (!isFanStart(entry))
    {
      // Barycentric coordinates, times the determinant, and with them the height's square: what
      // the part of the point's place in the plane leaves.
      const double product = dot(before, edge);
      const double determinant = squareBefore * square - product * product;
      const double b = square * alongBefore - product * along;
      const double c = squareBefore * along - product * alongBefore;
      if (b >= 0.0 && c >= 0.0 && b + c <= determinant &&
        rest * determinant <= b * alongBefore + c * along)
      {
        return determinant > 0.0;
      }
    }
    before = edge;
    alongBefore = along;
    squareBefore = square;
  }
  return false;
}

OriginalSurface::Nearest OriginalSurface::nearest(
  const Vector& point, Index start, double enough) const
{
  std::array<Index, kMaximumVisits> visited;
  int visits = 0;
  const auto isVisited = [&](Index node) {
    return std::find(visited.begin(), visited.begin() + visits, node) != visited.begin() + visits;
  };
  Nearest nearest{ HUGE_VAL, { start, start, start } };
  while (visits < kMaximumVisits)
  {
    const auto next = std::find_if_not(nearest.nodes.begin(), nearest.nodes.end(), isVisited);
    if (next == nearest.nodes.end())
    {
      break;
    }
    const Index node = *next;
    const Vector center = this->topology_.node(node).position - point;
    Index before = kNone;
    Vector placeBefore{ 0.0, 0.0, 0.0 };
    bool knownBefore = false;
    for (const Index entry : this->ring(node))
    {
      const Index other = nodeOf(entry);
      const Vector place = this->topology_.node(other).position - point;
      // The triangles around a node that was visited were met there.
      const bool known = isVisited(other);
      if (!isFanStart(entry) && !known && !knownBefore)
      {
        const double square = squaredDistanceToTriangle(center, placeBefore, place);
        if (square < nearest.square)
        {
          nearest = { square, { node, before, other } };
          if (square <= enough)
          {
            return nearest;
          }
        }
      }
      before = other;
      placeBefore = place;
      knownBefore = known;
    }
    visited[visits++] = node;
  }
  return nearest;
}

bool OriginalSurface::facesAway(
  const Vector& point, const Nearest& nearest, const Vector& direction) const
{
  constexpr double kRounding = 1e-9;
  for (const Index node : nearest.nodes)
  {
    const Vector center = this->topology_.node(node).position - point;
    const double enough = nearest.square + kRounding * squaredLength(center);
    Vector before{ 0.0, 0.0, 0.0 };
    for (const Index entry : this->ring(node))
    {
      const Vector place = this->topology_.node(nodeOf(entry)).position - point;
      if (!isFanStart(entry) && dot(cross(before - center, place - center), direction) < 0.0 &&
        squaredDistanceToTriangle(center, before, place) <= enough)
      {
        return true;
      }
      before = place;
    }
  }
  return false;
}

} // namespace undecimate
