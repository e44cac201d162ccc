// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hole_candidates.h
/// @brief All triangles of ring nodes that may fill a small hole, judged, measured and compared.
///
/// Triangles i < j < k stand in rows: one for each pair j < k, which runs over i. What belongs to
/// the pair j, k is the same for a whole row, and what belongs to i, (i, j) or (i, k) lies side by
/// side: vector instructions do several triangles at a time. The same results come out on every
/// machine: each triangle has its own arithmetic, in the same order, and no fused multiply-adds.

#ifndef UNDECIMATE_CORE_HOLE_CANDIDATES_H
#define UNDECIMATE_CORE_HOLE_CANDIDATES_H

#include "fold_rule.h"
#include "triangle_distance.h"
#include "triangle_topology.h"
#include "vector.h"

#include <array>
#include <vector>

namespace undecimate
{

/// Holes of up to so many nodes are filled with the best of all triangulations.
constexpr int kMaximumCompared = 16;

constexpr int kMaximumPairs = kMaximumCompared * (kMaximumCompared - 1) / 2;

/// Number of a pair i < j in a list that does not depend on the hole's size.
constexpr int pairNumber(int i, int j)
{
  return j * (j - 1) / 2 + i;
}

/// Positions in the ring of the corners of a triangle.
using Triple = std::array<unsigned char, 3>;

/// Memory: 70 KiB, of which a hole of six nodes uses 7.
class HoleCandidates
{
public:
  /// Begin a hole: place its ring.
  /// @param ring size points, relative to the removed node
  /// @param size 3 .. kMaximumCompared
  /// @param boundary whether the edge from the last node to the first is a new one
  void place(const Vector* ring, int size, bool boundary);

  /// Find out which triangles may be part of the new surface: none that is degenerate, breaks the
  /// fold rule (fold_rule.h) or points away from the original normals at all three corners.
  /// @param ringNormals of the original surface, any length
  /// @param oldNormals of the hole's triangles, any length: triangle i has ring edge i, i + 1
  /// @param normal of the hole
  void judge(const Vector* ringNormals, const Vector* oldNormals, const Vector& normal,
    const HeightFieldDirection& heightField);

  /// Rule a triangle of sorted corners out, or all triangles with an edge i < j.
  void refuse(const Triple& t) { this->blocked_[rowOf(t[1], t[2])][t[0]] = HUGE_VAL; }
  void forbidEdge(int i, int j);

  /// Squared distances between the new edges and the old ones that they cross. Two surfaces of flat
  /// pieces are farthest apart at a node of one of them or where two of their edges cross.
  void findCrossings(const Vector& normal);

  /// Of the edge i < j; 0 for an edge of the ring.
  float crossing(int i, int j) const { return this->crossing_[j][i]; }
  void setCrossing(int i, int j, float square) { this->crossing_[j][i] = square; }

  /// Largest squared height of the points over each triangle in which they lie, as seen along an
  /// axis. Points outside the hole count for the triangle on the ring edge that they lie behind.
  /// @param count of the points, without those that pad their rows
  /// @param axisX, axisY perpendicular unit vectors of the plane
  void measure(const PointRows& points, int count, const Vector& axisX, const Vector& axisY);

  /// As found; of sorted corners.
  bool isAllowed(const Triple& t) const { return this->blocked_[rowOf(t[1], t[2])][t[0]] == 0.0; }
  double shape(const Triple& t) const { return this->shape_[rowOf(t[1], t[2])][t[0]]; }
  Vector normal(const Triple& t) const
  {
    const int row = rowOf(t[1], t[2]);
    return { this->normalX_[row][t[0]], this->normalY_[row][t[0]], this->normalZ_[row][t[0]] };
  }
  float offset(const Triple& t) const { return this->offset_[rowOf(t[1], t[2])][t[0]]; }
  float square(const Triple& t) const { return this->square_[rowOf(t[1], t[2])][t[0]]; }

  /// Of a triangle that was measured elsewhere.
  void setSquare(const Triple& t, float square) { this->square_[rowOf(t[1], t[2])][t[0]] = square; }

  /// The triangulation with the smallest sum of the fourth powers of its triangles' costs (their
  /// squares squared): nearly the one whose worst triangle is best, and the others are good too.
  /// Dynamic programming over the parts of the polygon behind each pair of nodes (G. T. Klincsek:
  /// Minimal triangulations of polygonal domains, Annals of Discrete Mathematics 9 (1980)).
  /// @param scale of squared distances
  /// @param shapeWeight what a degenerate triangle costs more than an equilateral one, as a
  /// distance
  /// @return false if there is none
  bool choose(double scale, double shapeWeight, HoleTriangulation& filling);

private:
  // Loops over a row take steps of so many, and go beyond its end: what is there does not count.
  static constexpr int kLanes = 4;
  template <typename Number>
  using Row = Number[kMaximumCompared];
  static int rowOf(int j, int k) { return pairNumber(j, k); }

  // Vector clones are no members.
  friend struct HoleKernels;

  int size_ = 0;
  bool boundary_ = false;
  // The ring.
  Row<double> x_ = {};
  Row<double> y_ = {};
  Row<double> z_ = {};
  Row<double> originalX_ = {};
  Row<double> originalY_ = {};
  Row<double> originalZ_ = {};
  // Pairs: from i to j, at [j][i].
  Row<double> edgeX_[kMaximumCompared] = {};
  Row<double> edgeY_[kMaximumCompared] = {};
  Row<double> edgeZ_[kMaximumCompared] = {};
  Row<double> edgeSquare_[kMaximumCompared] = {};
  Row<float> crossing_[kMaximumCompared] = {};
  Row<float> lineX_[kMaximumCompared] = {}; // in the plane
  Row<float> lineY_[kMaximumCompared] = {};
  Row<float> lineOffset_[kMaximumCompared] = {};
  // Triangles.
  Row<double> blocked_[kMaximumPairs] = {}; // 0, or infinite if it may not be
  Row<double> shape_[kMaximumPairs] = {};
  Row<double> cost_[kMaximumPairs] = {};
  Row<float> normalX_[kMaximumPairs] = {}; // unit
  Row<float> normalY_[kMaximumPairs] = {};
  Row<float> normalZ_[kMaximumPairs] = {};
  Row<float> offset_[kMaximumPairs] = {};
  Row<float> square_[kMaximumPairs] = {};
  std::vector<float> sides_; // of the points in the plane, a row for each pair
};

} // namespace undecimate

#endif
