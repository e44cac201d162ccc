// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "deviation.h"

#include "polygon_triangulations.h"
#include "triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace undecimate
{

namespace
{

constexpr Vector kOrigin{ 0.0, 0.0, 0.0 };
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A new triangle may not turn away from the old one on the same ring edge by more than this.
constexpr double kMinimumCosine = 0.1;

// Below this shape (1 = equilateral) a triangle counts as degenerate.
constexpr double kMinimumShape = 1e-4;

// Among triangulations of nearly equal cost the better-shaped one wins: what a degenerate triangle
// costs more than an equilateral one, as a fraction of the size of the hole.
constexpr double kShapeWeight = 1e-3;

// The same for the order of the nodes: keeps flat regions even.
constexpr double kShapeOrderWeight = 1e-6;

// Holes of more nodes than have listed triangulations compare so many fans.
constexpr int kMaximumFans = 12;

using Triple = PolygonTriangulations::Triangle;

/// 4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle.
double shapeOf(const Vector& a, const Vector& b, const Vector& c, const Vector& normal)
{
  const Vector ab = b - a;
  const Vector bc = c - b;
  const Vector ca = a - c;
  const double edges = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
  return edges > 0.0 ? 2.0 * std::sqrt(3.0) * std::sqrt(dot(normal, normal)) / edges : 0.0;
}

double squaredDistanceToSegment(const Vector& p, const Vector& a, const Vector& b)
{
  const Vector ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0.0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
  const Vector d = p - (a + t * ab);
  return dot(d, d);
}

/// The box of all finite points that a triangle uses.
double diagonalOf(const TriangleTopology& topology, const MeshPoints& points)
{
  Vector low{ HUGE_VAL, HUGE_VAL, HUGE_VAL };
  Vector high{ -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  for (Index t = 0; t < topology.triangleCount(); ++t)
  {
    for (const Index node : topology.triangle(t).nodes)
    {
      if (points.finite(node))
      {
        const Vector p = points[node];
        low = { std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z) };
        high = { std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z) };
      }
    }
  }
  const Vector size = high - low;
  const double diagonal = std::sqrt(dot(size, size));
  return std::isfinite(diagonal) ? diagonal : 0.0;
}

/// Points as rows, relative to the removed node.
struct Rows
{
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;

  void clear()
  {
    this->x.clear();
    this->y.clear();
    this->z.clear();
  }
  void add(const Vector& p)
  {
    this->x.push_back(static_cast<float>(p.x));
    this->y.push_back(static_cast<float>(p.y));
    this->z.push_back(static_cast<float>(p.z));
  }
  int size() const { return static_cast<int>(this->x.size()); }

  /// Repeat the first point up to whole vectors.
  PointRows padded()
  {
    const int size = paddedSize(this->size());
    this->x.resize(size, this->x.front());
    this->y.resize(size, this->y.front());
    this->z.resize(size, this->z.front());
    return { this->x.data(), this->y.data(), this->z.data(), size };
  }
};

} // namespace

struct DeviationCriterion::Internals
{
  TriangleTopology& topology;
  const MeshPoints& points;
  double inverseDiagonal = 0.0;

  // Nodal arrays: an error e of array k counts as the distance arrayScales[k] * e.
  const std::vector<NodalArrayView>& arrays;
  std::vector<double> arrayScales;
  bool useArrays = false;

  // Nodes removed so far: a list for each triangle (its head is Triangle::first), and one for each
  // boundary edge (by its first node), if there is a boundary.
  std::vector<Index> next;
  std::vector<Index> boundaryFirst;
  std::vector<Index> boundaryNext;

  // The hole at hand.
  std::array<Vector, kMaximumPatchCells + 1> ring;
  std::array<Vector, kMaximumPatchCells> oldNormals;
  Vector normal;
  double radius = 0.0;
  Rows samples; // node, middles of its edges, nodes removed before
  std::vector<Index> sampleNodes; // of the samples after the middles
  int firstNodeSample = 0;
  std::vector<float> values; // of the arrays: a row of samples for each component
  PointRows sampleRows;
  Rows probes; // middles of new edges and centroids of new triangles
  std::vector<float> probeSquares;
  double fixedSquare = 0.0; // what every triangulation costs: the new boundary edge

  struct Candidate
  {
    bool valid = false;
    double shape = 0.0;
    float reverse = 0.0F; // squared: its centroid and its new edges to the old triangles
  };
  std::vector<Candidate> candidates;
  std::vector<float> squares; // a row of samples for each candidate
  std::vector<float> errors;  // the same for the arrays' errors
  std::vector<float> weightB;
  std::vector<float> weightC;
  std::array<std::array<bool, kMaximumPatchCells + 1>, kMaximumPatchCells + 1> forbidden;

  struct Best
  {
    bool found = false;
    double score = HUGE_VAL;
    double square = 0.0;
    double shape = 0.0;
    HoleTriangulation filling;
    std::array<int, kMaximumPatchCells> rows; // of its triangles in `squares`
  };
  Best best;
  std::vector<unsigned char> assignment; // triangle of the best filling for each node sample

  Internals(TriangleTopology& topology_, const MeshPoints& points_,
    const std::vector<NodalArrayView>& arrays_)
    : topology(topology_)
    , points(points_)
    , arrays(arrays_)
  {
  }

  bool prepare(const Hole& hole);
  void gatherSamples(const Hole& hole);
  void addSampleValues(const Hole& hole);
  void boundarySquare(const Hole& hole);
  Candidate judge(const Hole& hole, const Triple& t) const;
  void probe(const Hole& hole, const std::vector<Triple>& triangles);
  void fillRow(const Hole& hole, const Triple& t, int row);
  void compareListed(const Hole& hole);
  void compareLarge(const Hole& hole);
  void offer(const Triple* triangles, const int* rows, int count, double shape, double reverse);
  double sampleSquare(const int* rows, int count, double limit) const;
  bool findBest(const Hole& hole);
  bool forbidExisting(const Hole& hole);
  void assign(const HoleTriangulation& filling);
  double cost() const;
};

DeviationCriterion::DeviationCriterion(TriangleTopology& topology, const MeshPoints& points,
  const std::vector<NodalArrayView>& arrays, double scalarWeight,
  std::vector<unsigned char>& kept)
  : internals_(std::make_unique<Internals>(topology, points, arrays))
{
  Internals& in = *this->internals_;
  const Index nodeCount = static_cast<Index>(kept.size());
  const double diagonal = diagonalOf(topology, points);
  in.inverseDiagonal = diagonal > 0.0 ? 1.0 / diagonal : 0.0;
  if (scalarWeight > 0.0)
  {
    for (const NodalArrayView& array : arrays)
    {
      keepNonFinite(array, kept);
      const double range = arrayRange(array, nodeCount).size;
      in.arrayScales.push_back(range > 0.0 ? scalarWeight * diagonal / range : 0.0);
      in.useArrays = in.useArrays || range > 0.0;
    }
  }
  in.next.assign(nodeCount, kNone);
  for (Index node = 0; node < nodeCount; ++node)
  {
    if (topology.kind(node) == NodeKind::Boundary)
    {
      in.boundaryFirst.assign(nodeCount, kNone);
      in.boundaryNext.assign(nodeCount, kNone);
      break;
    }
  }
  for (auto& row : in.forbidden)
  {
    row.fill(false);
  }
}

DeviationCriterion::~DeviationCriterion() = default;

// Geometry of the hole, relative to its node.
bool DeviationCriterion::Internals::prepare(const Hole& hole)
{
  const Vector center = this->points[hole.node];
  double square = 0.0;
  for (int i = 0; i < hole.size; ++i)
  {
    this->ring[i] = this->points[hole.ring[i]] - center;
    square = std::max(square, dot(this->ring[i], this->ring[i]));
  }
  this->radius = std::sqrt(square);
  this->normal = kOrigin;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    this->oldNormals[i] = cross(this->ring[i], this->ring[i + 1 == hole.size ? 0 : i + 1]);
    this->normal = this->normal + this->oldNormals[i];
  }
  return std::isfinite(square);
}

void DeviationCriterion::Internals::gatherSamples(const Hole& hole)
{
  const Vector center = this->points[hole.node];
  this->samples.clear();
  this->sampleNodes.clear();
  this->samples.add(kOrigin);
  for (int i = 0; i < hole.size; ++i)
  {
    this->samples.add(0.5 * this->ring[i]);
  }
  this->firstNodeSample = this->samples.size();
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    for (Index node = this->topology.triangle(triangleOf(hole.corners[i])).first; node != kNone;
         node = this->next[node])
    {
      this->samples.add(this->points[node] - center);
      this->sampleNodes.push_back(node);
    }
  }
  this->sampleRows = this->samples.padded();
  if (this->useArrays)
  {
    this->addSampleValues(hole);
  }
}

void DeviationCriterion::Internals::addSampleValues(const Hole& hole)
{
  const int size = this->sampleRows.size;
  this->values.clear();
  for (const NodalArrayView& array : this->arrays)
  {
    for (int component = 0; component < array.components; ++component)
    {
      const auto valueAt = [&](Index node) {
        return array.values[std::size_t{ 1 } * array.components * node + component];
      };
      const std::size_t start = this->values.size();
      const float own = valueAt(hole.node);
      this->values.push_back(own);
      for (int i = 0; i < hole.size; ++i)
      {
        this->values.push_back(0.5F * (own + valueAt(hole.ring[i])));
      }
      for (const Index node : this->sampleNodes)
      {
        this->values.push_back(valueAt(node));
      }
      this->values.resize(start + size, own);
    }
  }
}

// The boundary polygon: all nodes removed from it must be near the new boundary edge.
void DeviationCriterion::Internals::boundarySquare(const Hole& hole)
{
  this->fixedSquare = 0.0;
  if (!hole.boundary)
  {
    return;
  }
  const int last = hole.size - 1;
  const Vector center = this->points[hole.node];
  const auto measure = [&](const Vector& p) {
    this->fixedSquare = std::max(
      this->fixedSquare, squaredDistanceToSegment(p, this->ring[last], this->ring[0]));
  };
  measure(kOrigin);
  for (const Index edge : { hole.node, hole.ring[last] })
  {
    for (Index node = this->boundaryFirst[edge]; node != kNone; node = this->boundaryNext[node])
    {
      measure(this->points[node] - center);
    }
  }
}

// Whether a triangle of ring nodes may be part of the new surface.
DeviationCriterion::Internals::Candidate DeviationCriterion::Internals::judge(
  const Hole& hole, const Triple& t) const
{
  Candidate candidate;
  const int last = hole.size - 1;
  const Vector& a = this->ring[t[0]];
  const Vector& b = this->ring[t[1]];
  const Vector& c = this->ring[t[2]];
  const Vector n = cross(b - a, c - a);
  candidate.shape = shapeOf(a, b, c, n);
  if (!(candidate.shape > kMinimumShape))
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
      const Vector& old = this->oldNormals[from];
      if (!(dot(n, old) > kMinimumCosine * std::sqrt(dot(n, n) * dot(old, old))))
      {
        return candidate;
      }
    }
    else if (this->forbidden[from][to])
    {
      return candidate;
    }
  }
  if (!onRing && !(dot(n, this->normal) > 0.0))
  {
    return candidate;
  }
  candidate.valid = true;
  return candidate;
}

// Sample (c): middles of the new edges and centroids of the new triangles against the old ones.
void DeviationCriterion::Internals::probe(const Hole& hole, const std::vector<Triple>& triangles)
{
  this->probes.clear();
  const int last = hole.size - 1;
  for (int i = 0; i < hole.size; ++i)
  {
    for (int j = i + 1; j < hole.size; ++j)
    {
      this->probes.add(0.5 * (this->ring[i] + this->ring[j]));
    }
  }
  const int firstCentroid = this->probes.size();
  for (const Triple& t : triangles)
  {
    this->probes.add((1.0 / 3.0) * (this->ring[t[0]] + this->ring[t[1]] + this->ring[t[2]]));
  }
  const PointRows rows = this->probes.padded();
  this->probeSquares.assign(rows.size, kInfinity);
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    DistanceTriangle old;
    if (old.set(kOrigin, this->ring[i], this->ring[i + 1 == hole.size ? 0 : i + 1]))
    {
      old.lowerSquaredDistances(rows, this->probeSquares.data());
    }
  }
  const auto edgeProbe = [&](int i, int j) {
    // Position of pair (i, j), i < j, in the list above.
    return this->probeSquares[i * hole.size - i * (i + 1) / 2 + j - i - 1];
  };
  for (std::size_t k = 0; k < triangles.size(); ++k)
  {
    Candidate& candidate = this->candidates[k];
    const Triple& t = triangles[k];
    candidate.reverse = this->probeSquares[firstCentroid + k];
    for (int corner = 0; corner < 3; ++corner)
    {
      const int i = std::min(t[corner], t[nextCorner(corner)]);
      const int j = std::max(t[corner], t[nextCorner(corner)]);
      const bool ringEdge = j == i + 1 || (!hole.boundary && i == 0 && j == last);
      if (!ringEdge)
      {
        candidate.reverse = std::max(candidate.reverse, edgeProbe(i, j));
      }
    }
  }
}

// Distances (and array errors) of all samples to one candidate triangle.
void DeviationCriterion::Internals::fillRow(const Hole& hole, const Triple& t, int row)
{
  DistanceTriangle triangle;
  triangle.set(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
  const int size = this->sampleRows.size;
  float* squareRow = this->squares.data() + std::size_t{ 1 } * row * size;
  if (!this->useArrays)
  {
    triangle.squaredDistances(this->sampleRows, squareRow);
    return;
  }
  this->weightB.resize(size);
  this->weightC.resize(size);
  triangle.closestPoints(
    this->sampleRows, squareRow, this->weightB.data(), this->weightC.data());
  float* __restrict__ errorRow = this->errors.data() + std::size_t{ 1 } * row * size;
  std::fill_n(errorRow, size, 0.0F);
  const float* __restrict__ wB = this->weightB.data();
  const float* __restrict__ wC = this->weightC.data();
  const float* __restrict__ value = this->values.data();
  std::vector<float>& sum = this->probeSquares; // free at this point
  for (std::size_t k = 0; k < this->arrays.size(); ++k)
  {
    const NodalArrayView& array = this->arrays[k];
    const float scale = static_cast<float>(this->arrayScales[k] * this->arrayScales[k]);
    sum.assign(size, 0.0F);
    float* __restrict__ sumRow = sum.data();
    for (int component = 0; component < array.components; ++component, value += size)
    {
      const auto valueAt = [&](int corner) {
        return array
          .values[std::size_t{ 1 } * array.components * hole.ring[t[corner]] + component];
      };
      const float a = valueAt(0);
      const float ab = valueAt(1) - a;
      const float ac = valueAt(2) - a;
      for (int i = 0; i < size; ++i)
      {
        const float difference = a + wB[i] * ab + wC[i] * ac - value[i];
        sumRow[i] += difference * difference;
      }
    }
    for (int i = 0; i < size; ++i)
    {
      const float error = scale * sumRow[i];
      errorRow[i] = errorRow[i] > error ? errorRow[i] : error;
    }
  }
}

// Largest over the samples of the squared distance to the nearest of some candidates, and of the
// arrays' error there; gives up once it is over the limit.
double DeviationCriterion::Internals::sampleSquare(const int* rows, int count, double limit) const
{
  const int size = this->sampleRows.size;
  const float* base = this->squares.data();
  const float* errorBase = this->errors.data();
  float largest = 0.0F;
  for (int begin = 0; begin < size; begin += kRowBlock)
  {
    float nearest[kRowBlock];
    std::copy_n(base + std::size_t{ 1 } * rows[0] * size + begin, kRowBlock, nearest);
    if (!this->useArrays)
    {
      for (int k = 1; k < count; ++k)
      {
        const float* row = base + std::size_t{ 1 } * rows[k] * size + begin;
        for (int i = 0; i < kRowBlock; ++i)
        {
          nearest[i] = row[i] < nearest[i] ? row[i] : nearest[i];
        }
      }
    }
    else
    {
      float error[kRowBlock];
      std::copy_n(errorBase + std::size_t{ 1 } * rows[0] * size + begin, kRowBlock, error);
      for (int k = 1; k < count; ++k)
      {
        const float* row = base + std::size_t{ 1 } * rows[k] * size + begin;
        const float* errorRow = errorBase + std::size_t{ 1 } * rows[k] * size + begin;
        for (int i = 0; i < kRowBlock; ++i)
        {
          const bool nearer = row[i] < nearest[i];
          error[i] = nearer ? errorRow[i] : error[i];
          nearest[i] = nearer ? row[i] : nearest[i];
        }
      }
      for (int i = 0; i < kRowBlock; ++i)
      {
        nearest[i] = error[i] > nearest[i] ? error[i] : nearest[i];
      }
    }
    for (int i = 0; i < kRowBlock; ++i)
    {
      largest = nearest[i] > largest ? nearest[i] : largest;
    }
    if (largest > limit)
    {
      return HUGE_VAL;
    }
  }
  return largest;
}

// Compare one triangulation with the best so far.
void DeviationCriterion::Internals::offer(
  const Triple* triangles, const int* rows, int count, double shape, double reverse)
{
  const double shapeTerm = kShapeWeight * this->radius * (1.0 - shape);
  const double room = this->best.score - shapeTerm;
  if (!(room > 0.0))
  {
    return;
  }
  const double limit = room * room;
  double square = std::max(this->fixedSquare, reverse);
  if (!(square < limit))
  {
    return;
  }
  square = std::max(square, this->sampleSquare(rows, count, limit));
  const double score = std::sqrt(square) + shapeTerm;
  if (!(score < this->best.score))
  {
    return;
  }
  this->best.found = true;
  this->best.score = score;
  this->best.square = square;
  this->best.shape = shape;
  this->best.filling.count = count;
  for (int k = 0; k < count; ++k)
  {
    this->best.filling.triangles[k] = triangles[k];
    this->best.rows[k] = rows[k];
  }
}

void DeviationCriterion::Internals::compareListed(const Hole& hole)
{
  const PolygonTriangulations& all = PolygonTriangulations::of(hole.size);
  const std::vector<Triple>& triangles = all.triangles();
  this->candidates.resize(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k)
  {
    this->candidates[k] = this->judge(hole, triangles[k]);
  }
  this->probe(hole, triangles);
  const int size = this->sampleRows.size;
  this->squares.resize(std::size_t{ 1 } * triangles.size() * size);
  this->errors.resize(this->useArrays ? this->squares.size() : 0);
  std::array<bool, 84> filled{};
  const int each = all.trianglesEach();
  for (int i = 0; i < all.count(); ++i)
  {
    const unsigned char* set = all.triangulation(i);
    double shape = 1.0;
    double reverse = 0.0;
    bool valid = true;
    for (int k = 0; k < each && valid; ++k)
    {
      const Candidate& candidate = this->candidates[set[k]];
      valid = candidate.valid;
      shape = std::min(shape, candidate.shape);
      reverse = std::max<double>(reverse, candidate.reverse);
    }
    const double room = this->best.score - kShapeWeight * this->radius * (1.0 - shape);
    if (!valid || !(room > 0.0) || !(reverse < room * room))
    {
      continue;
    }
    std::array<Triple, kMaximumListedPolygon> chosen;
    std::array<int, kMaximumListedPolygon> rows;
    for (int k = 0; k < each; ++k)
    {
      rows[k] = set[k];
      chosen[k] = triangles[set[k]];
      if (!filled[set[k]])
      {
        filled[set[k]] = true;
        this->fillRow(hole, chosen[k], rows[k]);
      }
    }
    this->offer(chosen.data(), rows.data(), each, shape, reverse);
  }
}

// Ear cutting and some fans.
void DeviationCriterion::Internals::compareLarge(const Hole& hole)
{
  std::vector<Triple> triangles;
  const auto compare = [&]() {
    this->candidates.resize(triangles.size());
    double shape = 1.0;
    for (std::size_t k = 0; k < triangles.size(); ++k)
    {
      this->candidates[k] = this->judge(hole, triangles[k]);
      if (!this->candidates[k].valid)
      {
        return;
      }
      shape = std::min(shape, this->candidates[k].shape);
    }
    this->probe(hole, triangles);
    double reverse = 0.0;
    std::array<int, kMaximumPatchCells> rows;
    this->squares.resize(triangles.size() * this->sampleRows.size);
    this->errors.resize(this->useArrays ? this->squares.size() : 0);
    for (std::size_t k = 0; k < triangles.size(); ++k)
    {
      reverse = std::max<double>(reverse, this->candidates[k].reverse);
      rows[k] = static_cast<int>(k);
      this->fillRow(hole, triangles[k], rows[k]);
    }
    const double before = this->best.score;
    this->offer(triangles.data(), rows.data(), static_cast<int>(triangles.size()), shape, reverse);
    if (this->best.score < before)
    {
      // The rows will be overwritten by the next candidate.
      this->assign(this->best.filling);
    }
  };

  EarCutting ears(this->ring.data(), hole.size, this->normal);
  HoleTriangulation filling;
  if (ears.cut([&](int i, int j) { return !this->forbidden[i][j]; }, filling))
  {
    triangles.assign(filling.triangles.begin(), filling.triangles.begin() + filling.count);
    compare();
  }
  const int stride = (hole.size + kMaximumFans - 1) / kMaximumFans;
  for (int apex = 0; apex < hole.size; apex += stride)
  {
    triangles.clear();
    for (int k = 1; k + 1 < hole.size; ++k)
    {
      const auto at = [&](int offset) {
        return static_cast<unsigned char>((apex + offset) % hole.size);
      };
      triangles.push_back({ at(0), at(k), at(k + 1) });
    }
    compare();
  }
}

// The triangle of the best filling that each removed node is nearest to.
void DeviationCriterion::Internals::assign(const HoleTriangulation& filling)
{
  const int size = this->sampleRows.size;
  const int nodes = static_cast<int>(this->sampleNodes.size());
  this->assignment.assign(nodes + 1, 0);
  for (int s = -1; s < nodes; ++s)
  {
    const int sample = s < 0 ? 0 : this->firstNodeSample + s;
    float nearest = kInfinity;
    for (int k = 0; k < filling.count; ++k)
    {
      const float square =
        this->squares[std::size_t{ 1 } * this->best.rows[k] * size + sample];
      if (square < nearest)
      {
        nearest = square;
        this->assignment[s + 1] = static_cast<unsigned char>(k);
      }
    }
  }
}

// Best triangulation of a hole by cost; existing edges are not looked for.
bool DeviationCriterion::Internals::findBest(const Hole& hole)
{
  this->best.found = false;
  this->best.score = HUGE_VAL;
  if (hole.size == 2)
  {
    // The triangle at a corner of the boundary goes; what it had is measured to the edge that stays.
    double square = this->fixedSquare;
    const Vector center = this->points[hole.node];
    for (const Index node : this->sampleNodes)
    {
      square = std::max(square,
        squaredDistanceToSegment(this->points[node] - center, this->ring[0], this->ring[1]));
    }
    this->best.found = true;
    this->best.square = square;
    this->best.shape = 1.0;
    this->best.filling.count = 0;
    return true;
  }
  if (hole.size <= kMaximumListedPolygon)
  {
    this->compareListed(hole);
    if (this->best.found)
    {
      this->assign(this->best.filling);
    }
  }
  else
  {
    this->compareLarge(hole);
  }
  return this->best.found;
}

// Forbid the edges of the best filling that exist already; true if there were any.
bool DeviationCriterion::Internals::forbidExisting(const Hole& hole)
{
  bool any = false;
  const int last = hole.size - 1;
  for (int t = 0; t < this->best.filling.count; ++t)
  {
    const auto& triangle = this->best.filling.triangles[t];
    for (int c = 0; c < 3; ++c)
    {
      const int from = triangle[c];
      const int to = triangle[nextCorner(c)];
      const bool inside = to != from + 1 && !(from == last && to == 0) && from < to;
      if (inside && this->topology.mayHaveEdge(hole.ring[from], hole.ring[to]))
      {
        this->forbidden[from][to] = true;
        this->forbidden[to][from] = true;
        any = true;
      }
    }
  }
  return any;
}

double DeviationCriterion::Internals::cost() const
{
  return std::sqrt(this->best.square) * this->inverseDiagonal;
}

bool DeviationCriterion::evaluate(Index node, double& cost)
{
  Hole hole;
  Internals& in = *this->internals_;
  if (!in.topology.gather(node, hole) || !in.topology.isClosable(hole) || !in.prepare(hole))
  {
    return false;
  }
  in.boundarySquare(hole);
  in.gatherSamples(hole);
  if (!in.findBest(hole))
  {
    return false;
  }
  cost = in.cost();
  return true;
}

bool DeviationCriterion::retriangulate(
  Index node, Hole& hole, HoleTriangulation& filling, double& cost)
{
  Internals& in = *this->internals_;
  if (!in.topology.gather(node, hole) || !in.topology.isClosable(hole) || !in.prepare(hole))
  {
    return false;
  }
  in.boundarySquare(hole);
  in.gatherSamples(hole);
  bool found = in.findBest(hole);
  bool forbade = false;
  while (found && in.forbidExisting(hole))
  {
    forbade = true;
    found = in.findBest(hole);
  }
  if (forbade)
  {
    for (int i = 0; i < hole.size; ++i)
    {
      std::fill_n(in.forbidden[i].begin(), hole.size, false);
    }
  }
  if (found)
  {
    filling = in.best.filling;
    cost = in.cost();
  }
  return found;
}

void DeviationCriterion::removed(
  const Hole& hole, const HoleTriangulation& filling)
{
  Internals& in = *this->internals_;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    in.topology.triangle(triangleOf(hole.corners[i])).first = kNone;
  }
  const int nodes = static_cast<int>(in.sampleNodes.size());
  for (int s = -1; s < nodes; ++s)
  {
    const Index node = s < 0 ? hole.node : in.sampleNodes[s];
    const Index slot = filling.count == 0
      ? triangleOf(hole.outer[0])
      : triangleOf(hole.corners[in.assignment[s + 1]]);
    Index& first = in.topology.triangle(slot).first;
    in.next[node] = first;
    first = node;
  }
  if (hole.boundary)
  {
    // The lists of both old boundary edges and the node itself go to the new edge.
    Index& first = in.boundaryFirst[hole.ring[hole.size - 1]];
    in.boundaryNext[hole.node] = in.boundaryFirst[hole.node];
    Index tail = hole.node;
    while (in.boundaryNext[tail] != kNone)
    {
      tail = in.boundaryNext[tail];
    }
    in.boundaryNext[tail] = first;
    first = hole.node;
  }
}

} // namespace undecimate
