// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file quadric_criterion.h
/// @brief The criterion Quadric: how far a node's neighbour is from the original triangles that the
/// node stands for.
///
/// Source: M. Garland, P. S. Heckbert, Surface Simplification Using Quadric Error Metrics, SIGGRAPH
/// 1997, sections 4 to 6: the sum of the squared distances of a point to a set of planes is a
/// quadratic function of the point, 10 numbers however many the planes are. A node starts with the
/// planes of its triangles, weighted by a third of their areas, and, at the boundary, with planes
/// that stand on the boundary edges. When it is removed its planes go to one node of its ring,
/// which stands for them from then on.
///
/// The cost of a node is the least over the nodes of its ring (at the boundary over its two
/// neighbours there) of the root of the weighted mean of the squared distances to the planes, as a
/// fraction of the diagonal of the bounding box. It is an estimate, and a mean: single points of
/// the original surface may be several times as far away. The hole is filled by a fan around the
/// ring node of the least cost, if the fold rule and the mesh allow that, else around the next one.
/// (Ear cutting where no fan is allowed was tried: its triangles are not what the cost is of, and
/// the surface was farther away in the mean.)
///
/// A neighbour of a removed node is evaluated when its turn comes. Until then it has the place in
/// the queue that expect() gives, from nodes that are in the cache anyway: half as many evaluations
/// as with the places before.
///
/// Memory: 32 bytes a node.

#ifndef UNDECIMATE_CORE_QUADRIC_CRITERION_H
#define UNDECIMATE_CORE_QUADRIC_CRITERION_H

#include "fold_rule.h"
#include "large_array.h"
#include "triangle_topology.h"

#include <array>
#include <memory>

namespace undecimate
{

/// Weighted sum of squared distances to planes, as a function of the place x seen from a node:
/// x.A x + 2 b.x + c. The planes' normals are unit vectors, so the sum of the weights is the trace
/// of A.
struct Quadric
{
  double xx = 0.0;
  double yy = 0.0;
  double zz = 0.0;
  double xy = 0.0;
  double yz = 0.0;
  double zx = 0.0;
  Vector b{ 0.0, 0.0, 0.0 };
  double c = 0.0;

  void add(const Quadric& other);

  double weight() const { return this->xx + this->yy + this->zz; }

  Vector timesA(const Vector& p) const
  {
    return { this->xx * p.x + this->xy * p.y + this->zx * p.z,
      this->xy * p.x + this->yy * p.y + this->yz * p.z,
      this->zx * p.x + this->yz * p.y + this->zz * p.z };
  }

  double at(const Vector& p) const { return dot(p, this->timesA(p) + 2.0 * this->b) + this->c; }

  /// The same function, seen from the place p.
  Quadric seenFrom(const Vector& p) const;
};

class QuadricCriterion
{
public:
  /// Neighbours of a removed node are evaluated when their turn comes.
  static constexpr bool kLazy = true;
  static constexpr bool isLazy() { return true; }

  /// @param topology with the positions of the nodes; their values and sums are ours from now on
  /// @param threads to share the work out among, or null; the result is the same
  explicit QuadricCriterion(TriangleTopology& topology, Threads* threads = nullptr);

  /// The same, for another thread: both may be used at the same time for nodes that share no node
  /// of their rings.
  QuadricCriterion forThread() const { return *this; }

  /// As DeviationCriterion::setTrianglesLeft(); here they do not matter.
  void setTrianglesLeft(Index /*count*/) {}

  /// Cost in the original mesh, whatever may be in the way; false if the node has no neighbour to
  /// go to. Once for each node, before it is in a queue. O(1).
  bool evaluate(Index node, double& cost) const;

  /// Gather the hole of a node and find its least cost; false if it cannot be closed. The filling
  /// is made by confirm(), which only those that are about to go need.
  bool retriangulate(Index node, Hole& hole, HoleTriangulation& filling, double& cost);

  /// Fill the hole of the last retriangulate().
  /// @param[out] cost infinite if every fan flips a triangle or makes an edge that exists
  /// @return the error, which is the cost
  double confirm(const Hole& hole, HoleTriangulation& filling, double& cost);

  /// Take note of a removal (of the node and filling of the last confirm()).
  void removed(const Hole& hole, const HoleTriangulation& filling);

  /// Whether expect() has news of a ring node of the hole of the last confirm(), in most cases.
  bool isNext(Index node, const Hole& hole) const
  {
    return node == this->heir_ || this->topology_.node(node).value == hole.node;
  }

  /// What a ring node is expected to cost after the removal of the hole's node; false if nothing is
  /// known that would change it.
  /// @param isRough its turn may come later than its cost says, for fewer evaluations
  bool expect(Index node, const Hole& hole, bool isRough, double& cost);

  /// Give the memory back, that of all threads. Nothing may be called any more.
  void release() { undecimate::release(*this->memory_); }

  /// Ask for what evaluating a node reads here.
  void prefetch(Index node) const { undecimate::prefetch(&this->stored_[node]); }

private:
  /// Eight of a quadric's ten numbers, half a cache line; the other two are in MeshNode::sum.
  /// MeshNode::value is the best neighbour that is known.
  struct alignas(32) Stored
  {
    float xx, yy, zz, xy, yz, zx, x, y;
  };
  struct Candidate
  {
    double order;
    double square; // of the cost
    int position;  // in the ring
  };

  Quadric quadric(Index node) const;
  void store(Index node, const Quadric& quadric);
  double meanSquare(const Quadric& quadric, Index from, Index to) const;
  template <typename Nodes>
  void addPlanes(const Nodes& share);
  template <typename Nodes>
  void findCosts(const Nodes& share);
  void prefetchExpected(const Hole& hole) const;
  bool fillByFan(
    const Hole& hole, const HoleRing& ring, int apex, HoleTriangulation& filling) const;

  TriangleTopology& topology_;
  HeightFieldDirection heightField_;
  double unit_ = 0.0; // 1 / diagonal
  std::shared_ptr<LargeArray<Stored, 2>> memory_;
  Stored* stored_;                                           // there
  std::array<Candidate, kMaximumPatchCells + 1> candidates_; // of the last retriangulate()
  int candidateCount_ = 0;
  Index heir_ = kNone; // the ring node that gets the quadric
};

} // namespace undecimate

#endif
