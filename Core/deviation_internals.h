// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file deviation_internals.h
/// @brief State of the criterion Deviation, shared by its source files: deviation.cpp is the
/// criterion as the queue sees it, deviation_triangles.cpp finds the triangles that may fill a hole
/// and the best set of them, and deviation_distance.cpp measures how far the surfaces are apart.

#ifndef UNDECIMATE_CORE_DEVIATION_INTERNALS_H
#define UNDECIMATE_CORE_DEVIATION_INTERNALS_H

#include "deviation.h"
#include "diagonal.h"
#include "fold_rule.h"
#include "hole_candidates.h"
#include "large_array.h"
#include "original_surface.h"
#include "triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace undecimate
{

constexpr Vector kOrigin{ 0.0, 0.0, 0.0 };
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Among triangulations of nearly equal cost the better-shaped one wins: what a degenerate triangle
// costs more than an equilateral one, as a fraction of the size of the hole.
constexpr double kShapeWeight = 1e-3;

// Holes of more than kMaximumCompared nodes compare ear cutting and some fans.
constexpr int kMaximumFans = 12;

// Cosine of two neighbours that lie on each other.
constexpr double kFolded = -0.985;

// Cosine with the original normals at its nodes below which a triangle is compared with the
// original surface itself.
constexpr double kTurned = 0.3;

// Where so few nodes were removed, triangles are looked at more closely.
constexpr std::size_t kFewSamples = 32;

// Samples are compared in chunks that stay in the cache.
constexpr int kChunk = 256;

inline double squaredDistanceToSegment(const Vector& p, const Vector& a, const Vector& b)
{
  const Vector ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0.0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
  const Vector d = p - (a + t * ab);
  return dot(d, d);
}

/// A unit vector in 64 bits, for MeshNode::sum, and back, of any length.
constexpr double kPackedUnit = 32767.0;

inline std::uint64_t packed(const Vector& unit)
{
  const auto part = [](double value) -> std::uint64_t {
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(kPackedUnit * value)));
  };
  return part(unit.x) | part(unit.y) << 16 | part(unit.z) << 32;
}

inline Vector unpacked(std::uint64_t bits)
{
  const auto part = [bits](int shift) -> double
  { return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits >> shift)); };
  return { part(0), part(16), part(32) };
}

/// Room for at least so many values; what was there is kept, and nothing is cleared.
template <typename Number>
void grow(std::vector<Number>& row, std::size_t size)
{
  if (row.size() < size)
  {
    row.resize(size + size / 2);
  }
}

/// Points as rows, relative to the removed node.
struct Rows
{
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  std::size_t count = 0;

  void clear() { this->count = 0; }
  void add(const Vector& p)
  {
    if (this->count == this->x.size())
    {
      grow(this->x, this->count + kRowBlock);
      grow(this->y, this->count + kRowBlock);
      grow(this->z, this->count + kRowBlock);
    }
    this->x[this->count] = static_cast<float>(p.x);
    this->y[this->count] = static_cast<float>(p.y);
    this->z[this->count] = static_cast<float>(p.z);
    ++this->count;
  }

  void move(std::size_t from, std::size_t to)
  {
    this->x[to] = this->x[from];
    this->y[to] = this->y[from];
    this->z[to] = this->z[from];
  }

  /// Repeat the first point up to whole vectors.
  PointRows padded()
  {
    const int size = paddedSize(static_cast<int>(this->count));
    while (this->count < static_cast<std::size_t>(size))
    {
      this->add({ this->x[0], this->y[0], this->z[0] });
    }
    return { this->x.data(), this->y.data(), this->z.data(), size };
  }
};

// What all threads know.
struct DeviationCriterion::Shared
{
  TriangleTopology& topology;
  OriginalSurface original;
  HeightFieldDirection heightField;
  double holeArea = 0.0; // of the mean hole, were there one triangle
  double unit = 0.0;     // 1 / diagonal: distances are in diagonals from the start

  // Nodal arrays: an error e of array k counts as the distance arrayScales[k] * e. Holes at nodes
  // where an array is undefined (NaN) stay open.
  const std::vector<NodalArrayView>& arrays;
  std::vector<double> arrayScales;
  std::vector<ArrayRange> arrayRanges;
  bool useArrays = false;
  double shapeWeight = 0.0;             // of the choice of a triangulation
  double shapeCost = 0.0;               // of the queue
  std::vector<unsigned char> undefined; // empty if there is none

  // Nodes removed so far: a list for each triangle (its head is Triangle::first), and one for each
  // boundary edge (by its first node), if there is a boundary.
  std::vector<Index> next;
  std::vector<Index> boundaryFirst;
  std::vector<Index> boundaryNext;

  Shared(TriangleTopology& topology_, const std::vector<NodalArrayView>& arrays_, Threads* threads)
    : topology(topology_)
    , original(topology_, threads)
    , heightField(topology_, threads)
    , arrays(arrays_)
  {
  }
};

struct alignas(kCacheLine) DeviationCriterion::Internals
{
  std::shared_ptr<Shared> shared;
  TriangleTopology& topology = shared->topology;
  const OriginalSurface& original = shared->original;
  const HeightFieldDirection& heightField = shared->heightField;
  double triangleCount = shared->topology.triangleCount(); // that are left
  const double holeArea = shared->holeArea;
  const double unit = shared->unit;
  const std::vector<NodalArrayView>& arrays = shared->arrays;
  const std::vector<double>& arrayScales = shared->arrayScales;
  const std::vector<ArrayRange>& arrayRanges = shared->arrayRanges;
  const bool useArrays = shared->useArrays;
  const double shapeWeight = shared->shapeWeight;
  const double shapeCost = shared->shapeCost;
  const std::vector<unsigned char>& undefined = shared->undefined;
  std::vector<Index>& next = shared->next;
  std::vector<Index>& boundaryFirst = shared->boundaryFirst;
  std::vector<Index>& boundaryNext = shared->boundaryNext;

  // The hole at hand.
  std::array<Vector, kMaximumPatchCells + 1> ring;
  std::array<Vector, kMaximumPatchCells + 1> ringNormals; // of the original surface
  std::array<Vector, kMaximumPatchCells> oldNormals;
  Vector normal;
  double radius = 0.0;
  bool few = false;                 // triangles are left, and there are no arrays
  double costFactor = 1.0;          // of the error, for the queue
  double arrayFactor = 1.0;         // of the arrays' errors, besides
  Rows samples;                     // the node, then the nodes removed before
  std::vector<Index> sampleNodes;   // all of them
  std::vector<float> nearest;       // of these, squares
  Rows between;                     // middles of original edges and triangles
  std::vector<std::uint64_t> marks; // a bit a node: of the hole, see betweenSquare()
  bool untouched = false;           // all triangles of the hole are original ones
  bool anyForbidden = false;        // edges, see below
  Turn turn = Turn::Small;          // that triangles may make
  std::vector<float> values;        // of the arrays: a row of samples for each component
  PointRows sampleRows;
  double fixedSquare = 0.0; // what every triangulation costs: the new boundary edge

  // The hole in the plane of its mean normal.
  Vector axisX;
  Vector axisY;
  struct Point
  {
    float x;
    float y;
  };
  std::array<Point, kMaximumCompared> flat;

  // Triangles of ring nodes that may be part of the new surface: of small holes all, of large ones
  // one at a time.
  HoleCandidates candidates;
  struct Candidate
  {
    bool valid = false;
    double shape = 0.0;
  };
  // Samples of arrays in the plane, a chunk: the sides of each pair, places, errors.
  std::vector<float> sides;
  std::array<float, kChunk> flatX;
  std::array<float, kChunk> flatY;
  std::array<float, std::size_t{ 2 } * kChunk> chunkValues;

  // Of one triangulation: the triangle that each sample is nearest to.
  DistanceTriangles triangles;
  std::vector<int> nearestTriangles;

  // Where there are arrays, rows of samples for each triangle.
  std::vector<float> squares;
  std::vector<float> errors;
  std::vector<float> weightB;
  std::vector<float> weightC;
  std::vector<float> sums;
  std::array<std::array<bool, kMaximumPatchCells + 1>, kMaximumPatchCells + 1> forbidden;
  std::vector<Triple> refused; // candidates that may not be part of the new surface

  struct Squares
  {
    double distance = 0.0;
    double array = 0.0; // of the arrays' errors, with their scales and arrayFactor

    double largest() const { return std::max(this->distance, this->array); }
    void include(const Squares& other)
    {
      this->distance = std::max(this->distance, other.distance);
      this->array = std::max(this->array, other.array);
    }
  };
  struct Best
  {
    bool found = false;
    double score = HUGE_VAL;
    double shape = 0.0; // of the worst triangle
    Squares squares;
    double meanSquare = 0.0; // of the samples' distances, where there are few triangles
    HoleTriangulation filling;
  };
  Best best;
  std::vector<int> assignment; // triangle of the best filling for each sample

  explicit Internals(std::shared_ptr<Shared> shared_)
    : shared(std::move(shared_))
    , marks(static_cast<std::size_t>(this->topology.nodeCount()) / 64 + 1, 0)
  {
    for (auto& row : this->forbidden)
    {
      row.fill(false);
    }
  }

  bool prepare(const Hole& hole);
  void gatherSamples(const Hole& hole);
  void addSampleValues(const Hole& hole);
  // A value of array n in the unit of distances, from its lowest one: neither a large offset nor a
  // strange unit reaches single precision.
  float value(std::size_t n, int component, Index node) const
  {
    const NodalArrayView& array = this->arrays[n];
    const double value = array.values[std::size_t{ 1 } * array.components * node + component];
    return static_cast<float>(
      this->arrayFactor * this->arrayScales[n] * (value - this->arrayRanges[n].lowest[component]));
  }

  void boundarySquare(const Hole& hole);
  Candidate judge(const Hole& hole, const Triple& t) const;
  struct EdgePlace
  {
    Index from;
    Index to;
    double fraction; // of the edge; clamped
  };
  double arraySquare(const EdgePlace& p, const EdgePlace& q) const;
  Squares crossingSquares(const Hole& hole, int i, int j) const;
  bool isRingEdge(const Hole& hole, int i, int j) const
  {
    return j == i + 1 || (!hole.boundary && i == 0 && j == hole.size - 1);
  }
  void judgeAll(const Hole& hole);
  void measureCandidates(const Hole& hole);
  void measureWithArrays(const Hole& hole);
  const float* chunkErrors(const Hole& hole, const Triple& t, int first, int count);
  void fillRow(const Hole& hole, const Triple& t, int row);
  Squares sampleSquares(int count) const;
  Squares nearestSquares(const HoleTriangulation& filling);
  void prefetchConfirmed(const Hole& hole) const;
  void gatherBetween(const Hole& hole, const HoleTriangulation& filling);
  double betweenSquare(const Hole& hole, const HoleTriangulation& filling, double square);
  double reverseSquare(const Hole& hole, const HoleTriangulation& filling, double square);
  void offer(const Hole& hole, const HoleTriangulation& filling);
  double shapeTerm(double shape) const { return this->shapeWeight * this->radius * (1.0 - shape); }
  void compareAll(const Hole& hole);
  void compareSome(const Hole& hole);
  bool findBestWithin(const Hole& hole);
  bool findBest(const Hole& hole);
  bool findAllowed(const Hole& hole);
  bool forbidExisting(const Hole& hole);
  bool liesOn(const Hole& hole, int triangle) const;
  bool facesAway(const Hole& hole, const Triple& t) const;
  bool refuseFolded(const Hole& hole);
  void assign(const HoleTriangulation& filling);
  double cost() const;
};

} // namespace undecimate

#endif
