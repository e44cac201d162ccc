// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "deviation_internals.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace undecimate
{

// Whether a triangle of ring nodes may be part of the new surface.
DeviationCriterion::Internals::Candidate DeviationCriterion::Internals::judge(
  const Hole& hole, const Triple& t) const
{
  Candidate candidate;
  const int last = hole.size - 1;
  const FilledTriangle triangle(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
  if (triangle.degenerate() || !this->heightField.allows(triangle))
  {
    return candidate;
  }
  // Many small turns would add up to an upside-down triangle.
  if (std::all_of(t.begin(), t.end(),
        [&](unsigned char i) { return triangle.opposes(this->ringNormals[i]); }))
  {
    return candidate;
  }
  bool onRing = false;
  for (int k = 0; k < 3; ++k)
  {
    const int from = t[k];
    const int to = t[nextCorner(k)];
    const bool ringEdge = to == from + 1 || (!hole.boundary && from == last && to == 0);
    if (ringEdge)
    {
      onRing = true;
      if (!triangle.follows(this->oldNormals[from], this->turn))
      {
        return candidate;
      }
    }
    else if (this->forbidden[from][to])
    {
      return candidate;
    }
  }
  candidate.valid = onRing || triangle.follows(this->normal, this->turn);
  candidate.shape = triangle.shape();
  return candidate;
}

// All triangles of a small hole, and the edges that they would add.
void DeviationCriterion::Internals::judgeAll(const Hole& hole)
{
  HoleCandidates& all = this->candidates;
  all.place(this->ring.data(), hole.size, hole.boundary);
  all.judge(this->ringNormals.data(), this->normal, this->heightField, this->turn);
  if (!this->useArrays)
  {
    all.findCrossings(this->normal);
  }
  for (int j = 1; j < hole.size && (this->useArrays || this->anyForbidden); ++j)
  {
    for (int i = 0; i < j; ++i)
    {
      if (this->useArrays)
      {
        all.setCrossing(i, j,
          this->isRingEdge(hole, i, j)
            ? 0.0F
            : static_cast<float>(this->crossingSquares(hole, i, j).largest()));
      }
      if (this->forbidden[i][j])
      {
        all.forbidEdge(i, j);
      }
    }
  }
  for (const Triple& t : this->refused)
  {
    all.refuse(t);
  }
}

// Largest squared height of the samples over each candidate triangle in which they lie, as seen
// along the hole's normal. Every triangulation shares the samples out among its triangles in this
// way, so that its cost is that of its worst triangle. A sample outside the hole counts for the
// triangle on the ring edge that it lies behind.
void DeviationCriterion::Internals::measureCandidates(const Hole& hole)
{
  const Vector axis =
    std::abs(this->normal.x) < 0.6 ? Vector{ 1.0, 0.0, 0.0 } : Vector{ 0.0, 1.0, 0.0 };
  Vector u = cross(axis, this->normal);
  u = (1.0 / std::sqrt(dot(u, u))) * u;
  this->axisX = u;
  this->axisY = cross(this->normal, u);
  if (this->useArrays)
  {
    this->measureWithArrays(hole);
  }
  else
  {
    this->candidates.measure(
      this->sampleRows, static_cast<int>(this->sampleNodes.size()), this->axisX, this->axisY);
  }
}

// The same of the squared errors of arrays, where they are larger.
void DeviationCriterion::Internals::measureWithArrays(const Hole& hole)
{
  for (int i = 0; i < hole.size; ++i)
  {
    this->flat[i] = { static_cast<float>(dot(this->ring[i], this->axisX)),
      static_cast<float>(dot(this->ring[i], this->axisY)) };
  }
  grow(this->sides, std::size_t{ 1 } * kChunk * pairNumber(0, hole.size));
  static const std::array<float, kChunk> kInside{}; // on the line: inside on either side
  const auto isOutline = [last = hole.size - 1](int i, int j)
  { return j == i + 1 || (i == 0 && j == last); };
  for (int first = 0; first < this->sampleRows.size; first += kChunk)
  {
    const int count = std::min(kChunk, this->sampleRows.size - first);
    const PointRows chunk{ this->sampleRows.x + first, this->sampleRows.y + first,
      this->sampleRows.z + first, count };
    project(chunk, this->axisX, this->axisY, this->flatX.data(), this->flatY.data());
    for (int j = 1; j < hole.size; ++j)
    {
      for (int i = 0; i < j; ++i)
      {
        float* row = this->sides.data() + std::size_t{ 1 } * kChunk * pairNumber(i, j);
        if (!isOutline(i, j))
        {
          const float dx = this->flat[j].x - this->flat[i].x;
          const float dy = this->flat[j].y - this->flat[i].y;
          sidesOfLine(this->flatX.data(), this->flatY.data(), count, dx, dy,
            dx * this->flat[i].y - dy * this->flat[i].x, row);
        }
      }
    }
    for (int k = 2; k < hole.size; ++k)
    {
      for (int j = 1; j < k; ++j)
      {
        for (int i = 0; i < j; ++i)
        {
          const Triple t{ static_cast<unsigned char>(i), static_cast<unsigned char>(j),
            static_cast<unsigned char>(k) };
          if (!this->candidates.isAllowed(t))
          {
            continue;
          }
          const auto side = [&](int from, int to) -> const float*
          {
            return isOutline(from, to)
              ? kInside.data()
              : this->sides.data() + std::size_t{ 1 } * kChunk * pairNumber(from, to);
          };
          const float square =
            largestSquaredHeight(chunk, this->candidates.normal(t), this->candidates.offset(t),
              { side(i, j), side(j, k), side(i, k) }, this->chunkErrors(hole, t, first, count));
          this->candidates.setSquare(
            t, first == 0 ? square : std::max(this->candidates.square(t), square));
        }
      }
    }
  }
}

// Squared errors of the arrays over a candidate triangle: each component is a linear function of
// the place in the plane.
const float* DeviationCriterion::Internals::chunkErrors(
  const Hole& hole, const Triple& t, int first, int count)
{
  float* __restrict__ largest = this->chunkValues.data();
  float* __restrict__ sum = largest + kChunk;
  const float* __restrict__ x = this->flatX.data();
  const float* __restrict__ y = this->flatY.data();
  std::fill_n(largest, count, 0.0F);
  const Point& a = this->flat[t[0]];
  const float bx = this->flat[t[1]].x - a.x;
  const float by = this->flat[t[1]].y - a.y;
  const float cx = this->flat[t[2]].x - a.x;
  const float cy = this->flat[t[2]].y - a.y;
  const float determinant = bx * cy - by * cx;
  if (!(determinant > 0.0F))
  {
    return largest;
  }
  const float* __restrict__ value = this->values.data() + first;
  for (std::size_t n = 0; n < this->arrays.size(); ++n)
  {
    const NodalArrayView& array = this->arrays[n];
    std::fill_n(sum, count, 0.0F);
    for (int component = 0; component < array.components;
         ++component, value += this->sampleRows.size)
    {
      const auto valueAt = [&](int corner)
      { return this->value(n, component, hole.ring[t[corner]]); };
      const float f = valueAt(0);
      const float fb = valueAt(1) - f;
      const float fc = valueAt(2) - f;
      const float gx = (fb * cy - fc * by) / determinant;
      const float gy = (fc * bx - fb * cx) / determinant;
      const float f0 = f - gx * a.x - gy * a.y;
      for (int s = 0; s < count; ++s)
      {
        const float difference = f0 + gx * x[s] + gy * y[s] - value[s];
        sum[s] += difference * difference;
      }
    }
    for (int s = 0; s < count; ++s)
    {
      largest[s] = largest[s] > sum[s] ? largest[s] : sum[s];
    }
  }
  return largest;
}

// Whether a triangle of the best filling would lie on a neighbour more closely than the old one
// did.
bool DeviationCriterion::Internals::liesOn(const Hole& hole, int triangle) const
{
  const auto place = [&](Index node) { return this->topology.node(node).position; };
  // Above 0 it does not matter which.
  const auto cosine = [](const Vector& a, const Vector& b)
  {
    const double product = dot(a, b);
    return product < 0.0 ? product / std::sqrt(dot(a, a) * dot(b, b)) : 0.0;
  };
  const auto normalOf = [&](const Triple& t)
  {
    const Vector& a = this->ring[t[0]];
    return cross(this->ring[t[1]] - a, this->ring[t[2]] - a);
  };
  const HoleTriangulation& filling = this->best.filling;
  const Triple& t = filling.triangles[triangle];
  const Vector normal = normalOf(t);
  for (int c = 0; c < 3; ++c)
  {
    const int from = t[c];
    const int to = t[nextCorner(c)];
    const bool last = from + 1 == hole.size;
    if (to == (last ? 0 : from + 1) && !(last && hole.boundary))
    {
      if (hole.outer[from] == kNoCorner)
      {
        continue;
      }
      const auto& nodes = this->topology.triangle(triangleOf(hole.outer[from])).nodes;
      const Vector a = place(nodes[0]);
      const Vector outer = cross(place(nodes[1]) - a, place(nodes[2]) - a);
      const double now = cosine(normal, outer);
      if (now < kFolded && !(cosine(this->oldNormals[from], outer) <= now))
      {
        return true;
      }
      continue;
    }
    for (int other = 0; other < triangle; ++other)
    {
      const Triple& u = filling.triangles[other];
      const bool shared = std::find(u.begin(), u.end(), from) != u.end() &&
        std::find(u.begin(), u.end(), to) != u.end();
      if (shared && cosine(normal, normalOf(u)) < kFolded)
      {
        return true;
      }
    }
  }
  return false;
}

// Whether a triangle would point away from the original surface, seen from seven places in it: from
// all of them to the nearest original triangles. Many small turns would add up to that.
bool DeviationCriterion::Internals::facesAway(const Hole& hole, const Triple& t) const
{
  const FilledTriangle triangle(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
  if (std::all_of(t.begin(), t.end(),
        [&](unsigned char i) { return triangle.faces(this->ringNormals[i], kTurned); }))
  {
    return false;
  }
  // A little inside, so that the corner at a sharp edge is compared with its own side.
  constexpr double kInside = 0.95;
  constexpr double kWeights[7][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0.5, 0.5 },
    { 0.5, 0, 0.5 }, { 0.5, 0.5, 0 }, { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 } };
  const auto place = [&](Index node) -> const Vector&
  { return this->topology.node(node).position; };
  const Vector a = place(hole.ring[t[0]]);
  const Vector b = place(hole.ring[t[1]]);
  const Vector c = place(hole.ring[t[2]]);
  const Vector middle = (1.0 / 3.0) * (a + b + c);
  return std::all_of(std::begin(kWeights), std::end(kWeights),
    [&](const auto& weight)
    {
      const Vector point =
        (1.0 - kInside) * middle + kInside * (weight[0] * a + weight[1] * b + weight[2] * c);
      // The walk may end at a sheet that is not the nearest one: several walks.
      Index start = hole.node;
      double square = HUGE_VAL;
      for (const Index node : this->sampleNodes)
      {
        const Vector away = place(node) - point;
        if (dot(away, away) < square)
        {
          square = dot(away, away);
          start = node;
        }
      }
      OriginalSurface::Nearest nearest = this->original.nearest(point, start, 0.0);
      for (const unsigned char corner : t)
      {
        const OriginalSurface::Nearest other =
          this->original.nearest(point, hole.ring[corner], 0.0);
        if (other.square < nearest.square)
        {
          nearest = other;
        }
      }
      return this->original.facesAway(point, nearest, triangle.normal());
    });
}

// Refuse the triangles of the best filling of a small hole that would lie on a neighbour or point
// away from the original surface, or that double precision rules out; true if there were any.
bool DeviationCriterion::Internals::refuseFolded(const Hole& hole)
{
  bool any = false;
  const bool small = hole.size <= kMaximumCompared;
  for (int t = 0; t < this->best.filling.count; ++t)
  {
    const Triple& triangle = this->best.filling.triangles[t];
    if ((small && !this->judge(hole, triangle).valid) || this->liesOn(hole, t) ||
      this->facesAway(hole, triangle))
    {
      any = true;
      if (small)
      {
        Triple sorted = triangle;
        std::sort(sorted.begin(), sorted.end());
        this->refused.push_back(sorted);
      }
    }
  }
  return any;
}

} // namespace undecimate
