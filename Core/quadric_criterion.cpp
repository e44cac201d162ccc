// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "quadric_criterion.h"

#include "diagonal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace undecimate
{

namespace
{

// Of a plane on a boundary edge, in squares of the edge: as much as that of a square beside it.
constexpr double kBoundaryWeight = 1.0;

// Among ring nodes of nearly equal cost the nearer one wins: what a distance between two nodes
// counts as a distance to the planes, squared.
constexpr double kLengthWeight = 1e-6;

// What a node whose best neighbour went is expected to cost, as a fraction of what the heir would:
// another neighbour may be better. Lower means more evaluations and a more exact order.
constexpr double kOtherNeighbour = 0.7;

// Twice the area of a triangle, squared: below it has no normal.
constexpr double kSmallestSquare = 1e-300;

// Planes without an area have no weight.
double inverseWeight(const Quadric& quadric)
{
  const double weight = quadric.weight();
  return weight > 0.0 ? 1.0 / weight : 0.0;
}

double meanSquareAt(const Quadric& quadric, double inverseWeight, const Vector& place)
{
  const double mean = quadric.at(place) * inverseWeight;
  // Rounding may take it below 0.
  return std::isfinite(mean) ? std::max(mean, 0.0) : HUGE_VAL;
}

} // namespace

void Quadric::add(const Quadric& other)
{
  this->xx += other.xx;
  this->yy += other.yy;
  this->zz += other.zz;
  this->xy += other.xy;
  this->yz += other.yz;
  this->zx += other.zx;
  this->b = this->b + other.b;
  this->c += other.c;
}

Quadric Quadric::seenFrom(const Vector& p) const
{
  Quadric moved = *this;
  moved.c = this->at(p);
  moved.b = this->b + this->timesA(p);
  return moved;
}

QuadricCriterion::QuadricCriterion(TriangleTopology& topology, Threads* threads)
  : topology_(topology)
  , heightField_(topology, threads)
  , memory_(std::make_shared<LargeArray<Stored, 2>>(topology.nodeCount()))
  , stored_(this->memory_->data())
{
  const double diagonal = diagonalOf(topology, threads);
  this->unit_ = diagonal > 0.0 ? 1.0 / diagonal : 0.0;
  topology.doInNodeShares(threads,
    [this](const auto& share)
    {
      this->addPlanes(share);
      this->findCosts(share);
    });
}

Quadric QuadricCriterion::quadric(Index node) const
{
  const Stored& s = this->stored_[node];
  std::array<float, 2> rest;
  std::memcpy(rest.data(), &this->topology_.node(node).sum, sizeof(rest));
  return { s.xx, s.yy, s.zz, s.xy, s.yz, s.zx, { s.x, s.y, rest[0] }, rest[1] };
}

void QuadricCriterion::store(Index node, const Quadric& q)
{
  const auto number = [](double value) { return static_cast<float>(value); };
  this->stored_[node] = { number(q.xx), number(q.yy), number(q.zz), number(q.xy), number(q.yz),
    number(q.zx), number(q.b.x), number(q.b.y) };
  const std::array<float, 2> rest{ number(q.b.z), number(q.c) };
  std::memcpy(&this->topology_.node(node).sum, rest.data(), sizeof(rest));
}

// To some of the nodes. All these planes go through the node itself, so they add nothing but to A.
template <typename Nodes>
void QuadricCriterion::addPlanes(const Nodes& share)
{
  std::fill(this->stored_ + share.begin, this->stored_ + share.end,
    Stored{ 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F });
  // Weight over the square of the normal's length.
  const auto addPlane = [&](const auto& ours, Index node, const Vector& normal, double factor)
  {
    if (!ours.has(node))
    {
      return;
    }
    Stored& s = this->stored_[node];
    const Vector weighted = factor * normal;
    s.xx += static_cast<float>(weighted.x * normal.x);
    s.yy += static_cast<float>(weighted.y * normal.y);
    s.zz += static_cast<float>(weighted.z * normal.z);
    s.xy += static_cast<float>(weighted.x * normal.y);
    s.yz += static_cast<float>(weighted.y * normal.z);
    s.zx += static_cast<float>(weighted.z * normal.x);
  };
  this->topology_.visitTriangles(share,
    [&](Index t, const auto& ours)
    {
      const TriangleTopology::Triangle& triangle = this->topology_.triangle(t);
      if (std::none_of(triangle.nodes.begin(), triangle.nodes.end(),
            [&](Index node) { return ours.has(node); }))
      {
        return;
      }
      const auto at = [&](int c) { return this->topology_.node(triangle.nodes[c]).position; };
      const Vector normal = cross(this->unit_ * (at(1) - at(0)), this->unit_ * (at(2) - at(0)));
      const double square = dot(normal, normal);
      if (!(square > kSmallestSquare) || !std::isfinite(square))
      {
        return;
      }
      const double third = 1.0 / (6.0 * std::sqrt(square)); // of the area
      for (int c = 0; c < 3; ++c)
      {
        addPlane(ours, triangle.nodes[c], normal, third);
      }
      for (int c = 0; c < 3; ++c)
      {
        if (triangle.across[c] == kNoCorner)
        {
          const int from = nextCorner(c);
          const int to = previousCorner(c);
          // As long as the edge times the normal, and weighted by the edge's square.
          const Vector upright = cross(this->unit_ * (at(to) - at(from)), normal);
          addPlane(ours, triangle.nodes[from], upright, kBoundaryWeight / square);
          addPlane(ours, triangle.nodes[to], upright, kBoundaryWeight / square);
        }
      }
    });
}

// Of some of the nodes.
template <typename Nodes>
void QuadricCriterion::findCosts(const Nodes& share)
{
  for (Index i = share.begin; i < share.end; ++i)
  {
    setFirstCost(this->topology_.node(i), std::numeric_limits<float>::infinity());
  }
  const auto compare = [&](
                         const auto& ours, Index from, Index to, bool boundary, const Vector& place)
  {
    MeshNode& node = this->topology_.node(from);
    if (!ours.has(from) || (node.kind == NodeKind::Boundary && !boundary))
    {
      return;
    }
    // Only A is not 0 yet.
    const Stored& s = this->stored_[from];
    const Quadric quadric{ s.xx, s.yy, s.zz, s.xy, s.yz, s.zx };
    const double mean = dot(place, quadric.timesA(place)) * inverseWeight(quadric);
    const float square = static_cast<float>(std::max(mean, 0.0));
    if (std::isfinite(mean) && square < firstCost(node))
    {
      setFirstCost(node, square); // still its square
      node.value = to;
    }
  };
  this->topology_.visitTriangles(share,
    [&](Index t, const auto& ours)
    {
      const TriangleTopology::Triangle& triangle = this->topology_.triangle(t);
      for (int c = 0; c < 3; ++c)
      {
        // Each edge once: from its boundary side, or from the smaller of its two corners.
        const Corner across = triangle.across[c];
        if (across == kNoCorner || makeCorner(t, c) < across)
        {
          const Index a = triangle.nodes[nextCorner(c)];
          const Index b = triangle.nodes[previousCorner(c)];
          if (!ours.has(a) && !ours.has(b))
          {
            continue;
          }
          const Vector place =
            this->unit_ * (this->topology_.node(b).position - this->topology_.node(a).position);
          compare(ours, a, b, across == kNoCorner, place);
          compare(ours, b, a, across == kNoCorner, place);
        }
      }
    });
}

double QuadricCriterion::meanSquare(const Quadric& quadric, Index from, Index to) const
{
  const Vector place =
    this->unit_ * (this->topology_.node(to).position - this->topology_.node(from).position);
  return meanSquareAt(quadric, inverseWeight(quadric), place);
}

bool QuadricCriterion::evaluate(Index node, double& cost) const
{
  cost = std::sqrt(static_cast<double>(firstCost(this->topology_.node(node))));
  return cost < HUGE_VAL;
}

bool QuadricCriterion::retriangulate(
  Index node, Hole& hole, HoleTriangulation& filling, double& cost)
{
  filling.count = 0;
  if (!this->topology_.gather(node, hole) || !this->topology_.isClosable(hole))
  {
    return false;
  }
  const Quadric quadric = this->quadric(node);
  const double inverse = inverseWeight(quadric);
  MeshNode& center = this->topology_.node(node);
  const int stride = hole.boundary ? hole.size - 1 : 1;
  double least = HUGE_VAL;
  this->candidateCount_ = 0;
  for (int i = 0; i < hole.size; i += stride)
  {
    const Vector place =
      this->unit_ * (this->topology_.node(hole.ring[i]).position - center.position);
    const double square = meanSquareAt(quadric, inverse, place);
    if (square < HUGE_VAL)
    {
      this->candidates_[this->candidateCount_++] = { square + kLengthWeight * dot(place, place),
        square, i };
    }
    if (square < least)
    {
      least = square;
      center.value = hole.ring[i];
    }
  }
  cost = std::sqrt(least);
  return this->candidateCount_ > 0;
}

double QuadricCriterion::confirm(const Hole& hole, HoleTriangulation& filling, double& cost)
{
  const HoleRing ring(this->topology_, hole);
  const auto end = this->candidates_.begin() + this->candidateCount_;
  for (auto candidate = this->candidates_.begin(); candidate != end; ++candidate)
  {
    std::iter_swap(candidate,
      std::min_element(
        candidate, end, [](const Candidate& a, const Candidate& b) { return a.order < b.order; }));
    if (hole.size == 2 || this->fillByFan(hole, ring, candidate->position, filling))
    {
      this->heir_ = hole.ring[candidate->position];
      this->prefetchExpected(hole);
      cost = std::sqrt(candidate->square);
      return cost;
    }
  }
  cost = HUGE_VAL;
  return cost;
}

// The quadrics that removed() and expect() are about to read.
void QuadricCriterion::prefetchExpected(const Hole& hole) const
{
  for (int i = 0; i < hole.size; ++i)
  {
    const Index node = hole.ring[i];
    if (this->isNext(node, hole))
    {
      this->prefetch(node);
    }
  }
}

bool QuadricCriterion::fillByFan(
  const Hole& hole, const HoleRing& ring, int apex, HoleTriangulation& filling) const
{
  const auto behind = [&hole](int i) { return i + 1 == hole.size ? 0 : i + 1; };
  filling.count = hole.size - 2;
  int ear = behind(apex);
  for (int t = 0; t < filling.count; ++t)
  {
    const int next = behind(ear);
    // The last triangle makes no edge.
    if (t + 1 < filling.count && this->topology_.mayHaveEdge(hole.ring[apex], hole.ring[next]))
    {
      return false;
    }
    filling.triangles[t] = { static_cast<unsigned char>(apex), static_cast<unsigned char>(ear),
      static_cast<unsigned char>(next) };
    ear = next;
  }
  return ring.isUnfolded(hole, filling, this->heightField_);
}

void QuadricCriterion::removed(const Hole& hole, const HoleTriangulation& /*filling*/)
{
  const Vector place = this->unit_ *
    (this->topology_.node(this->heir_).position - this->topology_.node(hole.node).position);
  Quadric sum = this->quadric(hole.node).seenFrom(place);
  sum.add(this->quadric(this->heir_));
  this->store(this->heir_, sum);
}

bool QuadricCriterion::expect(Index node, const Hole& hole, bool isRough, double& cost)
{
  MeshNode& center = this->topology_.node(node);
  if (node != this->heir_)
  {
    if (center.value != hole.node)
    {
      return false;
    }
    center.value = this->heir_;
    cost = (isRough ? 1.0 : kOtherNeighbour) *
      std::sqrt(this->meanSquare(this->quadric(node), node, this->heir_));
    return true;
  }
  if (center.kind != NodeKind::Interior)
  {
    return false; // its neighbours on the boundary are not known here
  }
  // All nodes of the ring are neighbours of the heir now, and the best one before may still be.
  const Quadric quadric = this->quadric(node);
  const double inverse = inverseWeight(quadric);
  const Index before = center.value;
  double least = HUGE_VAL;
  const auto compare = [&](Index to)
  {
    const Vector place = this->unit_ * (this->topology_.node(to).position - center.position);
    const double square = meanSquareAt(quadric, inverse, place);
    if (square < least)
    {
      least = square;
      center.value = to;
    }
  };
  for (int i = 0; i < hole.size; ++i)
  {
    if (hole.ring[i] != node)
    {
      compare(hole.ring[i]);
    }
  }
  if (this->topology_.kind(before) != NodeKind::Removed)
  {
    compare(before);
  }
  cost = std::sqrt(least);
  return true;
}

} // namespace undecimate
