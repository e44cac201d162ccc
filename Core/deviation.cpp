// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "deviation.h"

#include "diagonal.h"
#include "fold_rule.h"
#include "original_surface.h"
#include "triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace undecimate
{

namespace
{

// The queue does not go by the error alone. Nodes are best spent on the mean error of a linear
// interpolation where error times area is the same all over, and on the root mean square where
// error times the root of the area is. So the cost is the deviation times this power of the area of
// the hole (in mean holes): as much as the mean gains without a price in the largest deviation; and
// the errors of arrays, of which the mean counts as much as the largest, times that power.
constexpr double kDistancePower = 1.0 / 16.0;
constexpr double kArrayPower = 1.0 / 2.0;
constexpr double kMeanHole = 6.0; // triangles

constexpr Vector kOrigin{ 0.0, 0.0, 0.0 };
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Among triangulations of nearly equal cost the better-shaped one wins: what a degenerate triangle
// costs more than an equilateral one, as a fraction of the size of the hole.
constexpr double kShapeWeight = 1e-3;

// Holes of up to so many nodes are filled with the best of all triangulations; larger ones compare
// ear cutting and some fans.
constexpr int kMaximumCompared = 16;
constexpr int kMaximumFans = 12;
constexpr int kMaximumPairs = kMaximumCompared * (kMaximumCompared - 1) / 2;
constexpr int kMaximumTriples = kMaximumPairs * (kMaximumCompared - 2) / 3;

// Cosine of two neighbours that lie on each other.
constexpr double kFolded = -0.985;

// Where so few nodes were removed, triangles are looked at more closely.
constexpr std::size_t kFewSamples = 32;

// Samples are compared in chunks that stay in the cache.
constexpr int kChunk = 256;

// Positions of pairs i < j and triples i < j < k in lists that do not depend on the hole's size.
constexpr int pairNumber(int i, int j)
{
  return j * (j - 1) / 2 + i;
}
constexpr int tripleNumber(int i, int j, int k)
{
  return k * (k - 1) * (k - 2) / 6 + j * (j - 1) / 2 + i;
}

using Triple = std::array<unsigned char, 3>;

double squaredDistanceToSegment(const Vector& p, const Vector& a, const Vector& b)
{
  const Vector ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0.0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
  const Vector d = p - (a + t * ab);
  return dot(d, d);
}

/// A unit vector in 64 bits, for MeshNode::sum, and back, of any length.
constexpr double kPackedUnit = 32767.0;

std::uint64_t packed(const Vector& unit)
{
  const auto part = [](double value) -> std::uint64_t {
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(kPackedUnit * value)));
  };
  return part(unit.x) | part(unit.y) << 16 | part(unit.z) << 32;
}

Vector unpacked(std::uint64_t bits)
{
  const auto part = [bits](int shift) -> double
  { return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits >> shift)); };
  return { part(0), part(16), part(32) };
}

/// Room for at least so many values; what was there is kept, and nothing is cleared.
void grow(std::vector<float>& row, std::size_t size)
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

} // namespace

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
  std::vector<unsigned char> undefined; // empty if there is none

  // Nodes removed so far: a list for each triangle (its head is Triangle::first), and one for each
  // boundary edge (by its first node), if there is a boundary.
  std::vector<Index> next;
  std::vector<Index> boundaryFirst;
  std::vector<Index> boundaryNext;

  Shared(const TriangleMeshView& mesh, TriangleTopology& topology_,
    const std::vector<NodalArrayView>& arrays_)
    : topology(topology_)
    , original(mesh, topology_)
    , heightField(topology_)
    , arrays(arrays_)
  {
  }
};

struct DeviationCriterion::Internals
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
  double costFactor = 1.0;          // of the error, for the queue
  double arrayFactor = 1.0;         // of the arrays' errors, besides
  Rows samples;                     // the node, then the nodes removed before
  std::vector<Index> sampleNodes;   // all of them
  std::vector<float> nearest;       // of these, squares
  Rows between;                     // middles of original edges and triangles
  std::vector<std::uint64_t> marks; // a bit a node: of the hole, see betweenSquare()
  bool untouched = false;           // all triangles of the hole are original ones
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

  // Triangles of ring nodes that may be part of the new surface.
  struct Candidate
  {
    bool valid = false;
    double shape = 0.0;
    Vector normal;       // unit
    float square = 0.0F; // largest over the samples in it
  };
  std::array<Candidate, kMaximumTriples> candidates;
  std::array<float, kMaximumPairs> crossings; // of new edges, see crossingSquares()
  std::vector<float> sides;                   // a row of a chunk for each pair
  std::array<float, kChunk> flatX;            // samples in the plane, a chunk
  std::array<float, kChunk> flatY;
  std::array<float, std::size_t{ 2 } * kChunk> chunkValues;

  // Rows of samples for each triangle of one triangulation.
  std::vector<float> squares;
  std::vector<float> errors;
  std::vector<float> weightB;
  std::vector<float> weightC;
  std::vector<float> sums;
  std::array<std::array<bool, kMaximumPatchCells + 1>, kMaximumPatchCells + 1> forbidden;
  std::vector<int> refused; // candidates that may not be part of the new surface

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
    Squares squares;
    HoleTriangulation filling;
  };
  Best best;
  std::vector<unsigned char> assignment; // triangle of the best filling for each sample

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
  const float* chunkErrors(const Hole& hole, const Triple& t, int first, int count);
  bool chooseTriangulation(const Hole& hole, HoleTriangulation& filling) const;
  void fillRow(const Hole& hole, const Triple& t, int row);
  Squares sampleSquares(int count) const;
  void gatherBetween(const Hole& hole, const HoleTriangulation& filling);
  double betweenSquare(const Hole& hole, const HoleTriangulation& filling, double square);
  double reverseSquare(const Hole& hole, const HoleTriangulation& filling, double square) const;
  void offer(const Hole& hole, const HoleTriangulation& filling);
  double shapeTerm(double shape) const { return kShapeWeight * this->radius * (1.0 - shape); }
  void compareAll(const Hole& hole);
  void compareSome(const Hole& hole);
  bool findBest(const Hole& hole);
  bool findAllowed(const Hole& hole);
  bool forbidExisting(const Hole& hole);
  bool liesOn(const Hole& hole, int triangle) const;
  bool refuseFolded(const Hole& hole);
  void assign(const HoleTriangulation& filling);
  double cost() const;
  double error() const;
};

DeviationCriterion::DeviationCriterion(const TriangleMeshView& mesh, TriangleTopology& topology,
  const std::vector<NodalArrayView>& arrays, double scalarWeight)
{
  const auto shared = std::make_shared<Shared>(mesh, topology, arrays);
  Shared& in = *shared;
  const Index nodeCount = topology.nodeCount();
  const double diagonal = diagonalOf(topology);
  in.unit = diagonal > 0.0 ? 1.0 / diagonal : 0.0;
  if (scalarWeight > 0.0)
  {
    for (const NodalArrayView& array : arrays)
    {
      in.arrayRanges.push_back(arrayRange(array, nodeCount));
      const double range = in.arrayRanges.back().size;
      in.arrayScales.push_back(range > 0.0 ? scalarWeight / range : 0.0);
      in.useArrays = in.useArrays || range > 0.0;
    }
    for (Index node = 0; node < nodeCount; ++node)
    {
      if (!std::all_of(arrays.begin(), arrays.end(),
            [node](const NodalArrayView& array) { return isFinite(array, node); }))
      {
        in.undefined.resize(nodeCount, 0);
        in.undefined[node] = 1;
        topology.node(node).kept = true;
      }
    }
  }
  for (Index t = 0; t < topology.triangleCount(); ++t)
  {
    const auto& nodes = topology.triangle(t).nodes;
    const Vector a = in.unit * topology.node(nodes[0]).position;
    const Vector normal = cross(in.unit * topology.node(nodes[1]).position - a,
      in.unit * topology.node(nodes[2]).position - a);
    const double area = 0.5 * std::sqrt(dot(normal, normal));
    in.holeArea += std::isfinite(area) ? kMeanHole * area : 0.0;
  }
  for (Index node = 0; node < nodeCount; ++node)
  {
    topology.node(node).sum = packed(in.original.normal(node));
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
  this->internals_ = std::make_unique<Internals>(shared);
}

DeviationCriterion::DeviationCriterion(std::unique_ptr<Internals> internals)
  : internals_(std::move(internals))
{
}

DeviationCriterion::~DeviationCriterion() = default;
DeviationCriterion::DeviationCriterion(DeviationCriterion&& other) noexcept = default;

DeviationCriterion DeviationCriterion::forThread() const
{
  return DeviationCriterion(std::make_unique<Internals>(this->internals_->shared));
}

void DeviationCriterion::setTrianglesLeft(Index count)
{
  this->internals_->triangleCount = count;
}

// Geometry of the hole, relative to its node.
bool DeviationCriterion::Internals::prepare(const Hole& hole)
{
  const Vector center = this->topology.node(hole.node).position;
  double square = 0.0;
  for (int i = 0; i < hole.size; ++i)
  {
    if (!this->undefined.empty() && this->undefined[hole.ring[i]])
    {
      return false;
    }
    const MeshNode& node = this->topology.node(hole.ring[i]);
    this->ring[i] = this->unit * (node.position - center);
    this->ringNormals[i] = unpacked(node.sum);
    square = std::max(square, dot(this->ring[i], this->ring[i]));
  }
  this->radius = std::sqrt(square);
  this->normal = kOrigin;
  double area = 0.0;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    this->oldNormals[i] = cross(this->ring[i], this->ring[i + 1 == hole.size ? 0 : i + 1]);
    this->normal = this->normal + this->oldNormals[i];
    area += 0.5 * std::sqrt(dot(this->oldNormals[i], this->oldNormals[i]));
  }
  const double ratio = area * this->triangleCount / this->holeArea;
  this->costFactor = std::pow(ratio, kDistancePower);
  this->arrayFactor = this->useArrays ? std::pow(ratio, kArrayPower - kDistancePower) : 1.0;
  const double length = std::sqrt(dot(this->normal, this->normal));
  if (!(length > 0.0) || !std::isfinite(length))
  {
    return false;
  }
  this->normal = (1.0 / length) * this->normal;
  return true;
}

void DeviationCriterion::Internals::gatherSamples(const Hole& hole)
{
  const Vector center = this->topology.node(hole.node).position;
  this->samples.clear();
  this->sampleNodes.clear();
  this->samples.add(kOrigin);
  this->sampleNodes.push_back(hole.node);
  this->untouched = true;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    const TriangleTopology::Triangle& triangle =
      this->topology.triangle(triangleOf(hole.corners[i]));
    this->untouched = this->untouched && triangle.spare == 0;
    for (Index node = triangle.first; node != kNone; node = this->next[node])
    {
      this->samples.add(this->unit * (this->topology.node(node).position - center));
      this->sampleNodes.push_back(node);
    }
  }
  this->sampleRows = this->samples.padded();
  if (!this->useArrays)
  {
    return;
  }
  this->values.clear();
  for (std::size_t n = 0; n < this->arrays.size(); ++n)
  {
    for (int component = 0; component < this->arrays[n].components; ++component)
    {
      const std::size_t end = this->values.size() + this->sampleRows.size;
      for (const Index node : this->sampleNodes)
      {
        this->values.push_back(this->value(n, component, node));
      }
      this->values.resize(end, this->value(n, component, hole.node));
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
      if (!triangle.follows(this->oldNormals[from]))
      {
        return candidate;
      }
    }
    else if (this->forbidden[from][to])
    {
      return candidate;
    }
  }
  candidate.valid = onRing || triangle.follows(this->normal);
  candidate.shape = triangle.shape();
  candidate.normal = triangle.normal();
  return candidate;
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

// All triangles of a small hole, and the edges that they would add.
void DeviationCriterion::Internals::judgeAll(const Hole& hole)
{
  for (int j = 1; j < hole.size; ++j)
  {
    for (int i = 0; i < j; ++i)
    {
      this->crossings[pairNumber(i, j)] = this->isRingEdge(hole, i, j)
        ? 0.0F
        : static_cast<float>(this->crossingSquares(hole, i, j).largest());
    }
  }
  int number = 0;
  for (int k = 2; k < hole.size; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      for (int i = 0; i < j; ++i)
      {
        this->candidates[number++] = this->judge(hole,
          { static_cast<unsigned char>(i), static_cast<unsigned char>(j),
            static_cast<unsigned char>(k) });
      }
    }
  }
  for (const int triple : this->refused)
  {
    this->candidates[triple].valid = false;
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
    int number = 0;
    for (int k = 2; k < hole.size; ++k)
    {
      for (int j = 1; j < k; ++j)
      {
        for (int i = 0; i < j; ++i, ++number)
        {
          Candidate& candidate = this->candidates[number];
          if (!candidate.valid)
          {
            continue;
          }
          const auto side = [&](int from, int to) -> const float*
          {
            return isOutline(from, to)
              ? kInside.data()
              : this->sides.data() + std::size_t{ 1 } * kChunk * pairNumber(from, to);
          };
          const Triple t{ static_cast<unsigned char>(i), static_cast<unsigned char>(j),
            static_cast<unsigned char>(k) };
          const float* extra = this->useArrays ? this->chunkErrors(hole, t, first, count) : nullptr;
          const float square = largestSquaredHeight(chunk, candidate.normal,
            dot(candidate.normal, this->ring[i]), { side(i, j), side(j, k), side(i, k) }, extra);
          candidate.square = std::max(candidate.square, square);
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

// The triangulation with the smallest sum of the fourth powers of its triangles' costs (their
// squares squared): nearly the one whose worst triangle is best, and the others are good too.
// Dynamic programming over the parts of the polygon behind each pair of nodes (G. T. Klincsek:
// Minimal triangulations of polygonal domains, Annals of Discrete Mathematics 9 (1980)).
bool DeviationCriterion::Internals::chooseTriangulation(
  const Hole& hole, HoleTriangulation& filling) const
{
  std::array<double, kMaximumPairs> sums;
  std::array<unsigned char, kMaximumPairs> apexes;
  const double scale = 1.0 / (this->radius * this->radius);
  for (int span = 1; span < hole.size; ++span)
  {
    for (int i = 0; i + span < hole.size; ++i)
    {
      const int k = i + span;
      const int here = pairNumber(i, k);
      sums[here] = span == 1 ? 0.0 : HUGE_VAL;
      for (int j = i + 1; j < k; ++j)
      {
        const Candidate& candidate = this->candidates[tripleNumber(i, j, k)];
        const int before = pairNumber(i, j);
        const int behind = pairNumber(j, k);
        if (!candidate.valid)
        {
          continue;
        }
        const double distance = std::max({ candidate.square, this->crossings[before],
          this->crossings[behind], this->crossings[here] });
        const double shape = this->shapeTerm(candidate.shape);
        const double square = scale * (distance + shape * shape);
        const double sum = sums[before] + sums[behind] + square * square;
        if (sum < sums[here])
        {
          sums[here] = sum;
          apexes[here] = static_cast<unsigned char>(j);
        }
      }
    }
  }
  if (!(sums[pairNumber(0, hole.size - 1)] < HUGE_VAL))
  {
    return false;
  }
  filling.count = 0;
  std::array<std::array<unsigned char, 2>, kMaximumCompared> parts;
  int left = 0;
  parts[left++] = { 0, static_cast<unsigned char>(hole.size - 1) };
  while (left > 0)
  {
    const auto [i, k] = parts[--left];
    const unsigned char j = apexes[pairNumber(i, k)];
    filling.triangles[filling.count++] = { i, j, k };
    if (j > i + 1)
    {
      parts[left++] = { i, j };
    }
    if (k > j + 1)
    {
      parts[left++] = { j, k };
    }
  }
  // Parts before wholes: each triangle is an ear then.
  std::reverse(filling.triangles.begin(), filling.triangles.begin() + filling.count);
  return true;
}

// Distances (and array errors) of all samples to one triangle of a triangulation.
void DeviationCriterion::Internals::fillRow(const Hole& hole, const Triple& t, int row)
{
  const int size = this->sampleRows.size;
  float* squareRow = this->squares.data() + std::size_t{ 1 } * row * size;
  DistanceTriangle triangle;
  triangle.set(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
  if (!this->useArrays)
  {
    triangle.squaredDistances(this->sampleRows, squareRow);
    return;
  }
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
    if (this->useArrays)
    {
      std::copy_n(this->errors.data() + begin, kRowBlock, error);
    }
    for (int k = 1; k < count; ++k)
    {
      const std::size_t at = std::size_t{ 1 } * k * size + begin;
      const float* row = this->squares.data() + at;
      if (this->useArrays)
      {
        const float* errorRow = this->errors.data() + at;
        for (int i = 0; i < kRowBlock; ++i)
        {
          error[i] = row[i] < nearest[i] ? errorRow[i] : error[i];
        }
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
  for (std::size_t s = 0; s < this->sampleNodes.size(); ++s)
  {
    const Index node = this->sampleNodes[s];
    const int own = filling.count == 0 ? 0 : this->assignment[s];
    this->original.visitTriangles(node,
      [&](const std::array<Index, 3>& corners)
      {
        bool across = filling.count == 0;
        for (const Index corner : corners)
        {
          if (corner == node)
          {
            continue;
          }
          if ((mark(corner) & bit(corner)) == 0)
          {
            return;
          }
          const std::int32_t value = this->topology.node(corner).value;
          if (value < kRing)
          {
            // Each triangle once: by its first node that was removed.
            if (corner < node)
            {
              return;
            }
            across = across || value != own;
          }
          else if (!across)
          {
            const Triple& t = filling.triangles[own];
            across = std::find(t.begin(), t.end(), value - kRing) == t.end();
          }
        }
        if (across)
        {
          add(corners);
        }
      });
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
  if (this->between.count == 0)
  {
    return square;
  }
  std::vector<float>& nearest = this->nearest;
  nearest.assign(paddedSize(static_cast<int>(this->between.count)), kInfinity);
  const auto measure = [&](const Vector& a, const Vector& b, const Vector& c)
  {
    DistanceTriangle triangle;
    if (!triangle.set(a, b, c))
    {
      return;
    }
    const PointRows rows = this->between.padded();
    grow(this->squares, rows.size);
    triangle.squaredDistances(rows, this->squares.data());
    for (int i = 0; i < rows.size; ++i)
    {
      nearest[i] = this->squares[i] < nearest[i] ? this->squares[i] : nearest[i];
    }
  };
  for (int t = 0; t < filling.count; ++t)
  {
    const Triple& corners = filling.triangles[t];
    measure(this->ring[corners[0]], this->ring[corners[1]], this->ring[corners[2]]);
  }
  // A removed node on the ring has original triangles on both sides of it: what is far away may be
  // near the triangles around the hole.
  std::size_t far = 0;
  for (std::size_t i = 0; i < this->between.count; ++i)
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
  this->between.padded();
  std::fill(nearest.begin() + far, nearest.begin() + this->between.count, 0.0F);
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
  const Hole& hole, const HoleTriangulation& filling, double square) const
{
  const Vector center = this->topology.node(hole.node).position;
  const double scale = 1.0 / this->unit;
  const auto measure = [&](const Vector& place)
  {
    // Start at the nearest of the removed nodes.
    int nearest = 0;
    float least = kInfinity;
    const float x = static_cast<float>(place.x);
    const float y = static_cast<float>(place.y);
    const float z = static_cast<float>(place.z);
    for (int s = 0; s < static_cast<int>(this->sampleNodes.size()); ++s)
    {
      const float dx = this->sampleRows.x[s] - x;
      const float dy = this->sampleRows.y[s] - y;
      const float dz = this->sampleRows.z[s] - z;
      const float distance = dx * dx + dy * dy + dz * dz;
      nearest = distance < least ? s : nearest;
      least = distance < least ? distance : least;
    }
    const double found = this->original.squaredDistance(
      center + scale * place, this->sampleNodes[nearest], square * scale * scale);
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

// Measure a triangulation, and keep it if it is the best so far.
void DeviationCriterion::Internals::offer(const Hole& hole, const HoleTriangulation& filling)
{
  Squares largest{ this->fixedSquare, 0.0 };
  double shape = 1.0;
  grow(this->squares, std::size_t{ 1 } * filling.count * this->sampleRows.size);
  grow(this->errors, this->useArrays ? this->squares.size() : 0);
  for (int t = 0; t < filling.count; ++t)
  {
    const Triple& triangle = filling.triangles[t];
    const Candidate candidate = hole.size <= kMaximumCompared
      ? this->candidates[tripleNumber(triangle[0], triangle[1], triangle[2])]
      : this->judge(hole, triangle);
    if (!candidate.valid)
    {
      return;
    }
    shape = std::min(shape, candidate.shape);
    for (int c = 0; c < 3; ++c)
    {
      const int i = std::min(triangle[c], triangle[nextCorner(c)]);
      const int j = std::max(triangle[c], triangle[nextCorner(c)]);
      if (!this->isRingEdge(hole, i, j))
      {
        if (this->useArrays || hole.size > kMaximumCompared)
        {
          largest.include(this->crossingSquares(hole, i, j));
        }
        else
        {
          largest.include({ this->crossings[pairNumber(i, j)], 0.0 });
        }
      }
    }
  }
  for (int t = 0; t < filling.count; ++t)
  {
    this->fillRow(hole, filling.triangles[t], t);
  }
  largest.include(this->sampleSquares(filling.count));
  const double score = std::sqrt(largest.largest()) + this->shapeTerm(shape);
  if (score < this->best.score)
  {
    this->best.found = true;
    this->best.score = score;
    this->best.squares = largest;
    this->best.filling = filling;
    this->assign(filling);
  }
}

// The best of all triangulations of a small hole.
void DeviationCriterion::Internals::compareAll(const Hole& hole)
{
  this->judgeAll(hole);
  this->measureCandidates(hole);
  HoleTriangulation filling;
  if (this->chooseTriangulation(hole, filling))
  {
    this->offer(hole, filling);
  }
}

// Ear cutting and some fans of a large hole.
void DeviationCriterion::Internals::compareSome(const Hole& hole)
{
  EarCutting ears(this->ring.data(), hole.size, this->normal);
  HoleTriangulation filling;
  if (ears.cut([&](int i, int j) { return !this->forbidden[i][j]; }, filling))
  {
    this->offer(hole, filling);
  }
  const int stride = (hole.size + kMaximumFans - 1) / kMaximumFans;
  for (int apex = 0; apex < hole.size; apex += stride)
  {
    filling.count = 0;
    for (int k = 1; k + 1 < hole.size; ++k)
    {
      const auto at = [&](int offset)
      { return static_cast<unsigned char>((apex + offset) % hole.size); };
      filling.triangles[filling.count++] = { at(0), at(k), at(k + 1) };
    }
    this->offer(hole, filling);
  }
}

// The triangle of a triangulation that each sample is nearest to.
void DeviationCriterion::Internals::assign(const HoleTriangulation& filling)
{
  const int size = this->sampleRows.size;
  const int nodes = static_cast<int>(this->sampleNodes.size());
  this->assignment.assign(nodes, 0);
  for (int s = 0; s < nodes; ++s)
  {
    float nearest = this->squares[s];
    for (int t = 1; t < filling.count; ++t)
    {
      const float square = this->squares[std::size_t{ 1 } * t * size + s];
      if (square < nearest)
      {
        nearest = square;
        this->assignment[s] = static_cast<unsigned char>(t);
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
    // The triangle at a corner of the boundary goes; what it had is measured to the edge that
    // stays.
    Squares largest{ this->fixedSquare, 0.0 };
    const Vector center = this->topology.node(hole.node).position;
    const Vector along = this->ring[1] - this->ring[0];
    for (const Index node : this->sampleNodes)
    {
      const Vector place = this->unit * (this->topology.node(node).position - center);
      largest.include({ squaredDistanceToSegment(place, this->ring[0], this->ring[1]), 0.0 });
      if (this->useArrays)
      {
        const double fraction = dot(place - this->ring[0], along) / dot(along, along);
        largest.include({ 0.0,
          this->arraySquare({ hole.ring[0], hole.ring[1], fraction }, { node, node, 0.0 }) });
      }
    }
    this->best.found = true;
    this->best.squares = largest;
    this->best.filling.count = 0;
    return true;
  }
  if (hole.size <= kMaximumCompared)
  {
    this->compareAll(hole);
  }
  else
  {
    this->compareSome(hole);
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

// Whether a triangle of the best filling would lie on a neighbour where the old one did not.
bool DeviationCriterion::Internals::liesOn(const Hole& hole, int triangle) const
{
  const auto place = [&](Index node) { return this->topology.node(node).position; };
  const auto isFolded = [](const Vector& a, const Vector& b)
  {
    const double product = dot(a, b);
    return product < 0.0 && product * product > kFolded * kFolded * dot(a, a) * dot(b, b);
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
      if (isFolded(normal, outer) && !isFolded(this->oldNormals[from], outer))
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
      if (shared && isFolded(normal, normalOf(u)))
      {
        return true;
      }
    }
  }
  return false;
}

// Refuse the triangles of the best filling of a small hole that would lie on a neighbour; true if
// there were any.
bool DeviationCriterion::Internals::refuseFolded(const Hole& hole)
{
  bool any = false;
  for (int t = 0; t < this->best.filling.count; ++t)
  {
    if (this->liesOn(hole, t))
    {
      any = true;
      if (hole.size <= kMaximumCompared)
      {
        Triple sorted = this->best.filling.triangles[t];
        std::sort(sorted.begin(), sorted.end());
        this->refused.push_back(tripleNumber(sorted[0], sorted[1], sorted[2]));
      }
    }
  }
  return any;
}

// Best triangulation of a hole that makes no edge that exists.
bool DeviationCriterion::Internals::findAllowed(const Hole& hole)
{
  bool found = this->findBest(hole);
  bool forbade = false;
  while (found && this->forbidExisting(hole))
  {
    forbade = true;
    found = this->findBest(hole);
  }
  for (int i = 0; forbade && i < hole.size; ++i)
  {
    std::fill_n(this->forbidden[i].begin(), hole.size, false);
  }
  return found;
}

double DeviationCriterion::Internals::cost() const
{
  return this->costFactor * std::sqrt(this->best.squares.largest());
}

double DeviationCriterion::Internals::error() const
{
  const Squares& squares = this->best.squares;
  return std::sqrt(
    std::max(squares.distance, squares.array / (this->arrayFactor * this->arrayFactor)));
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
  if (!in.findAllowed(hole))
  {
    return false;
  }
  filling = in.best.filling;
  cost = in.cost();
  return true;
}

double DeviationCriterion::confirm(const Hole& hole, HoleTriangulation& filling, double& cost)
{
  Internals& in = *this->internals_;
  bool folded = false;
  bool found = true;
  while (found && in.refuseFolded(hole))
  {
    folded = true;
    found = hole.size <= kMaximumCompared && in.findAllowed(hole);
  }
  in.refused.clear();
  if (!found)
  {
    cost = HUGE_VAL;
    return cost;
  }
  if (folded)
  {
    filling = in.best.filling;
  }
  // While the hole's triangles are original ones, its node and the crossings of the edges have told
  // it all.
  if (!in.untouched)
  {
    const double error = in.error() * in.error();
    const double square = in.reverseSquare(hole, filling, in.betweenSquare(hole, filling, error));
    // Arrays count no less in a small hole than in a mean one.
    in.best.squares.include({ square, 0.0 });
  }
  cost = in.cost();
  return in.error();
}

void DeviationCriterion::removed(const Hole& hole, const HoleTriangulation& filling)
{
  Internals& in = *this->internals_;
  in.triangleCount -= hole.triangleCount - filling.count;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    TriangleTopology::Triangle& triangle = in.topology.triangle(triangleOf(hole.corners[i]));
    triangle.first = kNone;
    triangle.spare = 1; // no longer an original one
  }
  for (std::size_t s = 0; s < in.sampleNodes.size(); ++s)
  {
    const Index node = in.sampleNodes[s];
    const Index slot =
      triangleOf(filling.count == 0 ? hole.outer[0] : hole.corners[in.assignment[s]]);
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
