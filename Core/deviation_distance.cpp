// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "deviation_internals.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

// The boundary polygon: all nodes removed from it must be near the new boundary edge.
void DeviationCriterion::Internals::boundarySquare(const Hole& hole)
{
  this->fixedSquare = 0.0;
  if (!hole.boundary)
  {
    return;
  }
  const int last = hole.size - 1;
  const Vector center = this->topology.node(hole.node).position;
  const auto measure = [&](const Vector& p)
  {
    this->fixedSquare =
      std::max(this->fixedSquare, squaredDistanceToSegment(p, this->ring[last], this->ring[0]));
  };
  measure(kOrigin);
  for (const Index edge : { hole.node, hole.ring[last] })
  {
    for (Index node = this->boundaryFirst[edge]; node != kNone; node = this->boundaryNext[node])
    {
      measure(this->unit * (this->topology.node(node).position - center));
    }
  }
}

// Squared error of the arrays between two places, the largest of them.
double DeviationCriterion::Internals::arraySquare(const EdgePlace& p, const EdgePlace& q) const
{
  double largest = 0.0;
  for (std::size_t n = 0; n < this->arrays.size(); ++n)
  {
    const NodalArrayView& array = this->arrays[n];
    double sum = 0.0;
    for (int component = 0; component < array.components; ++component)
    {
      const auto valueAt = [&](const EdgePlace& place)
      {
        const float* values = array.values + component;
        const double from = values[std::size_t{ 1 } * array.components * place.from];
        const double to = values[std::size_t{ 1 } * array.components * place.to];
        return from + std::clamp(place.fraction, 0.0, 1.0) * (to - from);
      };
      const double difference =
        this->arrayFactor * this->arrayScales[n] * (valueAt(p) - valueAt(q));
      sum += difference * difference;
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

// Where a new edge crosses the old ones its distance to the old surface has its extremes: two
// surfaces of flat pieces are farthest apart at a node of one or at a crossing of their edges.
DeviationCriterion::Internals::Squares DeviationCriterion::Internals::crossingSquares(
  const Hole& hole, int i, int j) const
{
  const Vector& a = this->ring[i];
  const Vector along = this->ring[j] - a;
  // The old edges between i and j, or those of the other side, whichever lie across from the node.
  const bool nodeOnLeft = dot(cross(along, kOrigin - a), this->normal) >= 0.0;
  Squares largest;
  const auto measure = [&](int k)
  {
    const Vector& old = this->ring[k];
    const Vector m = cross(along, old);
    const double square = dot(m, m);
    const double height = dot(a, m);
    if (height * height > largest.distance * square)
    {
      largest.distance = height * height / square;
    }
    if (this->useArrays && square > 0.0)
    {
      largest.array = std::max(largest.array,
        this->arraySquare({ hole.ring[i], hole.ring[j], dot(cross(old, a), m) / square },
          { hole.node, hole.ring[k], dot(cross(along, a), m) / square }));
    }
  };
  if (nodeOnLeft)
  {
    for (int k = i + 1; k < j; ++k)
    {
      measure(k);
    }
  }
  else if (!hole.boundary)
  {
    for (int k = 0; k < i; ++k)
    {
      measure(k);
    }
    for (int k = j + 1; k < hole.size; ++k)
    {
      measure(k);
    }
  }
  return largest;
}

// Distances and array errors of all samples to one triangle of a triangulation.
void DeviationCriterion::Internals::fillRow(const Hole& hole, const Triple& t, int row)
{
  const int size = this->sampleRows.size;
  float* squareRow = this->squares.data() + std::size_t{ 1 } * row * size;
  DistanceTriangle triangle;
  triangle.set(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
  grow(this->weightB, size);
  grow(this->weightC, size);
  grow(this->sums, size);
  triangle.closestPoints(this->sampleRows, squareRow, this->weightB.data(), this->weightC.data());
  float* __restrict__ errorRow = this->errors.data() + std::size_t{ 1 } * row * size;
  std::fill_n(errorRow, size, 0.0F);
  const float* __restrict__ wB = this->weightB.data();
  const float* __restrict__ wC = this->weightC.data();
  const float* __restrict__ value = this->values.data();
  float* __restrict__ sum = this->sums.data();
  for (std::size_t n = 0; n < this->arrays.size(); ++n)
  {
    const NodalArrayView& array = this->arrays[n];
    std::fill_n(sum, size, 0.0F);
    for (int component = 0; component < array.components; ++component, value += size)
    {
      const auto valueAt = [&](int corner)
      { return this->value(n, component, hole.ring[t[corner]]); };
      const float a = valueAt(0);
      const float ab = valueAt(1) - a;
      const float ac = valueAt(2) - a;
      for (int i = 0; i < size; ++i)
      {
        const float difference = a + wB[i] * ab + wC[i] * ac - value[i];
        sum[i] += difference * difference;
      }
    }
    for (int i = 0; i < size; ++i)
    {
      errorRow[i] = errorRow[i] > sum[i] ? errorRow[i] : sum[i];
    }
  }
}

// Largest over the samples of the squared distance to the nearest triangle; there are no arrays.
DeviationCriterion::Internals::Squares DeviationCriterion::Internals::nearestSquares(
  const HoleTriangulation& filling)
{
  const int size = this->sampleRows.size;
  grow(this->nearest, size);
  grow(this->nearestTriangles, size);
  this->triangles.set(this->ring.data(), filling);
  this->triangles.findNearest(
    this->sampleRows, this->nearest.data(), this->nearestTriangles.data());
  return { *std::max_element(this->nearest.begin(), this->nearest.begin() + size), 0.0 };
}

// Largest over the samples of the squared distance to the nearest triangle, and of the arrays'
// error there.
DeviationCriterion::Internals::Squares DeviationCriterion::Internals::sampleSquares(int count) const
{
  const int size = this->sampleRows.size;
  float largest = 0.0F;
  float largestError = 0.0F;
  for (int begin = 0; begin < size; begin += kRowBlock)
  {
    float nearest[kRowBlock];
    float error[kRowBlock] = {};
    std::copy_n(this->squares.data() + begin, kRowBlock, nearest);
    std::copy_n(this->errors.data() + begin, kRowBlock, error);
    for (int k = 1; k < count; ++k)
    {
      const std::size_t at = std::size_t{ 1 } * k * size + begin;
      const float* row = this->squares.data() + at;
      const float* errorRow = this->errors.data() + at;
      for (int i = 0; i < kRowBlock; ++i)
      {
        error[i] = row[i] < nearest[i] ? errorRow[i] : error[i];
      }
      for (int i = 0; i < kRowBlock; ++i)
      {
        nearest[i] = row[i] < nearest[i] ? row[i] : nearest[i];
      }
    }
    for (int i = 0; i < kRowBlock; ++i)
    {
      largest = nearest[i] > largest ? nearest[i] : largest;
      largestError = error[i] > largestError ? error[i] : largestError;
    }
  }
  return { largest, largestError };
}

// Ask for what confirm() reads besides what is known of the hole.
void DeviationCriterion::Internals::prefetchConfirmed(const Hole& hole) const
{
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    if (hole.outer[i] != kNoCorner)
    {
      const TriangleTopology::Triangle& outer = this->topology.triangle(triangleOf(hole.outer[i]));
      this->topology.prefetchNode(outer.nodes[cornerOf(hole.outer[i])]);
    }
  }
  if (!this->untouched)
  {
    for (const Index node : this->sampleNodes)
    {
      this->original.prefetchNode(node);
    }
  }
}

// Collect places in the original triangles and on their edges in the hole. A triangle whose corners
// all went to one new triangle is no farther from it than they are, since distances from a convex
// set are convex: only those that lie over several new triangles count.
void DeviationCriterion::Internals::gatherBetween(
  const Hole& hole, const HoleTriangulation& filling)
{
  constexpr std::int32_t kRing = 256; // + position in the ring: of the ring nodes
  const auto mark = [this](Index node) -> std::uint64_t&
  { return this->marks[static_cast<std::size_t>(node) / 64]; };
  const auto bit = [](Index node) { return std::uint64_t{ 1 } << (node % 64); };
  const auto enter = [&](Index node, std::int32_t value)
  {
    mark(node) |= bit(node);
    this->topology.node(node).value = value;
  };
  for (const Index node : this->sampleNodes)
  {
    this->original.prefetchRing(node);
  }
  for (std::size_t s = 0; s < this->sampleNodes.size(); ++s)
  {
    enter(this->sampleNodes[s], filling.count == 0 ? 0 : this->assignment[s]);
  }
  for (int i = 0; i < hole.size; ++i)
  {
    enter(hole.ring[i], kRing + i);
  }
  const Vector center = this->topology.node(hole.node).position;
  const bool few = this->sampleNodes.size() <= kFewSamples;
  this->between.clear();
  const auto add = [&](const std::array<Index, 3>& corners)
  {
    std::array<Vector, 3> places;
    for (int c = 0; c < 3; ++c)
    {
      places[c] = this->unit * (this->topology.node(corners[c]).position - center);
    }
    this->between.add((1.0 / 3.0) * (places[0] + places[1] + places[2]));
    for (int c = 0; few && c < 3; ++c)
    {
      this->between.add((1.0 / 6.0) * (places[0] + places[1] + places[2]) + 0.5 * places[c]);
    }
    for (int c = 0; c < 3; ++c)
    {
      // The triangle beside has the edge the other way round.
      const int next = nextCorner(c);
      if (corners[c] < corners[next])
      {
        this->between.add(0.5 * (places[c] + places[next]));
        if (few)
        {
          this->between.add(0.75 * places[c] + 0.25 * places[next]);
          this->between.add(0.25 * places[c] + 0.75 * places[next]);
        }
      }
    }
  };
  // Of a node of a triangle: which new triangle it went to, or where in the ring it is.
  constexpr std::int32_t kOutside = -1;
  const auto placeOf = [&](Index node)
  { return (mark(node) & bit(node)) == 0 ? kOutside : this->topology.node(node).value; };
  for (std::size_t s = 0; s < this->sampleNodes.size(); ++s)
  {
    const Index node = this->sampleNodes[s];
    const int own = filling.count == 0 ? 0 : this->assignment[s];
    const Triple& triangle = filling.triangles[own];
    const auto isAcross = [&](std::int32_t place)
    {
      return place < kRing
        ? place != own
        : std::find(triangle.begin(), triangle.end(), place - kRing) == triangle.end();
    };
    Index before = kNone;
    std::int32_t placeBefore = kOutside;
    bool acrossBefore = false;
    for (const Index entry : this->original.ring(node))
    {
      const Index corner = OriginalSurface::nodeOf(entry);
      std::int32_t place = placeOf(corner);
      // Each triangle once: by its first node that was removed.
      if (place != kOutside && place < kRing && corner < node)
      {
        place = kOutside;
      }
      const bool across = place != kOutside && (filling.count == 0 || isAcross(place));
      if (!OriginalSurface::isFanStart(entry) && place != kOutside && placeBefore != kOutside &&
        (across || acrossBefore))
      {
        add({ node, before, corner });
      }
      before = corner;
      placeBefore = place;
      acrossBefore = across;
    }
  }
  for (const Index node : this->sampleNodes)
  {
    mark(node) = 0;
  }
  for (int i = 0; i < hole.size; ++i)
  {
    mark(hole.ring[i]) = 0;
  }
}

// Largest squared distance from places between the original nodes to the new surface, or `square`
// if that is larger: over a valley they are farther from it than the nodes.
double DeviationCriterion::Internals::betweenSquare(
  const Hole& hole, const HoleTriangulation& filling, double square)
{
  this->gatherBetween(hole, filling);
  const std::size_t places = this->between.count;
  if (places == 0)
  {
    return square;
  }
  // Without arrays the best filling of a small hole is the one that was measured last.
  if (this->useArrays || hole.size == 2 || hole.size > kMaximumCompared)
  {
    this->triangles.set(this->ring.data(), filling);
  }
  grow(this->nearestTriangles, this->between.count + kRowBlock);
  // Most lie over a new triangle and near enough.
  this->triangles.markNear(
    this->between.padded(), static_cast<float>(square), this->nearestTriangles.data());
  std::size_t left = 0;
  for (std::size_t i = 0; i < places; ++i)
  {
    this->between.move(i, left);
    left += this->nearestTriangles[i] == 0 ? 1 : 0;
  }
  if (left == 0)
  {
    return square;
  }
  this->between.count = left;
  const PointRows unsure = this->between.padded();
  std::vector<float>& nearest = this->nearest;
  grow(nearest, unsure.size);
  this->triangles.findNearest(unsure, nearest.data(), this->nearestTriangles.data());
  // A removed node on the ring has original triangles on both sides of it: what is far away may be
  // near the triangles around the hole.
  std::size_t far = 0;
  for (std::size_t i = 0; i < left; ++i)
  {
    if (nearest[i] > square)
    {
      this->between.move(i, far);
      nearest[far++] = nearest[i];
    }
  }
  if (far == 0)
  {
    return square;
  }
  this->between.count = far;
  const PointRows rows = this->between.padded();
  grow(this->squares, rows.size);
  const auto measure = [&](const Vector& a, const Vector& b, const Vector& c)
  {
    DistanceTriangle triangle;
    if (!triangle.set(a, b, c))
    {
      return;
    }
    triangle.squaredDistances(rows, this->squares.data());
    for (std::size_t i = 0; i < far; ++i)
    {
      nearest[i] = this->squares[i] < nearest[i] ? this->squares[i] : nearest[i];
    }
  };
  const Vector center = this->topology.node(hole.node).position;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    if (hole.outer[i] != kNoCorner)
    {
      const auto& nodes = this->topology.triangle(triangleOf(hole.outer[i])).nodes;
      const auto place = [&](int c)
      { return this->unit * (this->topology.node(nodes[c]).position - center); };
      measure(place(0), place(1), place(2));
    }
  }
  return std::max<double>(square, *std::max_element(nearest.begin(), nearest.begin() + far));
}

// Largest squared distance from the new surface back to the original one, or `square` if that is
// larger: along each new edge and at the middle of each new triangle.
double DeviationCriterion::Internals::reverseSquare(
  const Hole& hole, const HoleTriangulation& filling, double square)
{
  const Vector center = this->topology.node(hole.node).position;
  const double scale = 1.0 / this->unit;
  const auto measure = [&](const Vector& place)
  {
    // Start at the nearest of the removed nodes.
    const int nearest = nearestPoint(this->sampleRows, static_cast<float>(place.x),
      static_cast<float>(place.y), static_cast<float>(place.z));
    const Vector point = center + scale * place;
    const double enough = square * scale * scale;
    if (this->original.isNear(point, this->sampleNodes[nearest], enough))
    {
      return;
    }
    const double found = this->original.squaredDistance(point, this->sampleNodes[nearest], enough);
    square = std::max(square, found * this->unit * this->unit);
  };
  for (int t = 0; t < filling.count; ++t)
  {
    const Vector& a = this->ring[filling.triangles[t][0]];
    const Vector& b = this->ring[filling.triangles[t][1]];
    const Vector& c = this->ring[filling.triangles[t][2]];
    measure((1.0 / 3.0) * (a + b + c));
    if (t + 1 < filling.count)
    {
      measure(0.5 * (a + c));
      measure(0.25 * a + 0.75 * c);
      measure(0.75 * a + 0.25 * c);
    }
  }
  return square;
}

} // namespace undecimate
