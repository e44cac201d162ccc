// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "deviation.h"

#include "deviation_internals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace undecimate
{

namespace
{

// The queue does not go by the error alone. Nodes are best spent on the mean error of a linear
// interpolation where error times area is the same all over, and on the root mean square where
// error times the root of the area is. So the cost is the deviation times this power of the area of
// the hole (in mean holes): as much as the mean gains without a price in the largest deviation; and
// the errors of arrays, of which the mean counts as much as the largest, times their area.
constexpr double kDistancePower = 1.0 / 16.0;
constexpr double kArrayPower = 1.0;
constexpr double kMeanHole = 6.0; // triangles

// From here on costs are kept up to date: 2 % off the errors of the last levels (means of 44
// cases), for milliseconds.
constexpr double kFewTriangles = 3000.0;

// And from here on, without arrays, more counts for the mean: another power of the area, and a
// power of the samples' root mean square distance as a fraction of the largest one (or of this,
// where it is less). 3 % off the root mean square of the last levels, and 1 % on the largest
// deviation (means of 48 cases).
constexpr double kLastDistancePower = 0.09;
constexpr double kMeanPower = 0.15;
constexpr double kLeastMean = 0.2;

// The distance is measured at many places, but not at all: elsewhere it may be a little larger. So
// much is added to the error, which is to be trusted (deviation.md).
constexpr double kMargin = 1.05;

} // namespace

DeviationCriterion::DeviationCriterion(TriangleTopology& topology,
  const std::vector<NodalArrayView>& arrays, const Weights& weights, Threads* threads)
{
  const auto shared = std::make_shared<Shared>(topology, arrays, threads);
  Shared& in = *shared;
  const Index nodeCount = topology.nodeCount();
  const double diagonal = diagonalOf(topology, threads);
  in.unit = diagonal > 0.0 ? 1.0 / diagonal : 0.0;
  in.shapeWeight = kShapeWeight + weights.shape;
  in.shapeCost = weights.shape;
  if (weights.scalar > 0.0)
  {
    for (const NodalArrayView& array : arrays)
    {
      in.arrayRanges.push_back(arrayRange(array, nodeCount));
      const double range = in.arrayRanges.back().size;
      in.arrayScales.push_back(range > 0.0 ? weights.scalar / range : 0.0);
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
  doInShares(threads, nodeCount,
    [&](const Share& share)
    {
      for (Index node = share.begin; node < share.end; ++node)
      {
        topology.node(node).sum = packed(in.original.normal(node));
      }
    });
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
  this->few = this->triangleCount < kFewTriangles && !this->useArrays;
  this->costFactor = std::pow(ratio, this->few ? kLastDistancePower : kDistancePower);
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
  this->sampleNodes.clear();
  this->sampleNodes.push_back(hole.node);
  this->untouched = true;
  for (int i = 0; i < hole.triangleCount; ++i)
  {
    const TriangleTopology::Triangle& triangle =
      this->topology.triangle(triangleOf(hole.corners[i]));
    this->untouched = this->untouched && triangle.spare == 0;
    for (Index node = triangle.first; node != kNone; node = this->next[node])
    {
      this->topology.prefetchNode(node);
      this->sampleNodes.push_back(node);
    }
  }
  this->samples.clear();
  for (const Index node : this->sampleNodes)
  {
    this->samples.add(this->unit * (this->topology.node(node).position - center));
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

// Measure a triangulation, and keep it if it is the best so far.
void DeviationCriterion::Internals::offer(const Hole& hole, const HoleTriangulation& filling)
{
  Squares largest{ this->fixedSquare, 0.0 };
  double shape = 1.0;
  for (int t = 0; t < filling.count; ++t)
  {
    const Triple& triangle = filling.triangles[t];
    const Candidate candidate = hole.size <= kMaximumCompared
      ? Candidate{ this->candidates.isAllowed(triangle), this->candidates.shape(triangle) }
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
          largest.include({ this->candidates.crossing(i, j), 0.0 });
        }
      }
    }
  }
  if (this->useArrays)
  {
    grow(this->squares, std::size_t{ 1 } * filling.count * this->sampleRows.size);
    grow(this->errors, this->squares.size());
    for (int t = 0; t < filling.count; ++t)
    {
      this->fillRow(hole, filling.triangles[t], t);
    }
    largest.include(this->sampleSquares(filling.count));
  }
  else
  {
    largest.include(this->nearestSquares(filling));
  }
  const double score = std::sqrt(largest.largest()) + this->shapeTerm(shape);
  if (score < this->best.score)
  {
    this->best.found = true;
    this->best.score = score;
    this->best.squares = largest;
    this->best.shape = shape;
    this->best.filling = filling;
    if (this->few)
    {
      const auto* distances = this->nearest.data();
      const std::size_t count = this->sampleNodes.size();
      this->best.meanSquare =
        std::max(this->fixedSquare, std::accumulate(distances, distances + count, 0.0) / count);
    }
    if (this->useArrays)
    {
      this->assign(filling);
    }
    else
    {
      this->assignment.swap(this->nearestTriangles);
    }
  }
}

// The best of all triangulations of a small hole.
void DeviationCriterion::Internals::compareAll(const Hole& hole)
{
  this->judgeAll(hole);
  this->measureCandidates(hole);
  HoleTriangulation filling;
  if (this->candidates.choose(
        1.0 / (this->radius * this->radius), this->shapeWeight * this->radius, filling))
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
        this->assignment[s] = t;
      }
    }
  }
}

// Best triangulation of a hole by cost, of triangles that make no wider turn than `turn`.
bool DeviationCriterion::Internals::findBestWithin(const Hole& hole)
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
    this->best.meanSquare = largest.distance;
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

// Best triangulation of a hole by cost; existing edges are not looked for. On a coarse mesh more
// than half of the nodes could not go without wide turns; whether they fold the surface is found
// out when it is their turn.
bool DeviationCriterion::Internals::findBest(const Hole& hole)
{
  this->turn = Turn::Small;
  if (this->findBestWithin(hole))
  {
    return true;
  }
  this->turn = Turn::Wide;
  return this->findBestWithin(hole);
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
        this->anyForbidden = true;
        any = true;
      }
    }
  }
  return any;
}

// Best triangulation of a hole that makes no edge that exists.
bool DeviationCriterion::Internals::findAllowed(const Hole& hole)
{
  bool found = this->findBest(hole);
  while (found && this->forbidExisting(hole))
  {
    found = this->findBest(hole);
  }
  for (int i = 0; this->anyForbidden && i < hole.size; ++i)
  {
    std::fill_n(this->forbidden[i].begin(), hole.size, false);
  }
  this->anyForbidden = false;
  return found;
}

double DeviationCriterion::Internals::cost() const
{
  const double shapeCost = this->shapeCost * this->radius * (1.0 - this->best.shape);
  double error = std::sqrt(this->best.squares.largest());
  if (this->few && error > 0.0)
  {
    const double mean = std::sqrt(this->best.meanSquare) / error;
    error *= std::pow(std::max(kLeastMean, mean), kMeanPower);
  }
  return this->costFactor * (error + shapeCost);
}

bool DeviationCriterion::isLazy() const
{
  return this->internals_->triangleCount >= kFewTriangles;
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
  in.prefetchConfirmed(hole);
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
  Internals::Squares& squares = in.best.squares;
  const double array = squares.array / (in.arrayFactor * in.arrayFactor);
  // While the hole's triangles are original ones, its node and the crossings of the edges have told
  // it all.
  if (!in.untouched)
  {
    const double known = std::max(squares.distance, array);
    const double square = in.reverseSquare(hole, filling, in.betweenSquare(hole, filling, known));
    // Arrays count no less in a small hole than in a mean one.
    squares.include({ square > known ? square : 0.0, array });
  }
  cost = in.cost();
  return std::sqrt(std::max(kMargin * kMargin * squares.distance, array));
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
