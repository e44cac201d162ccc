// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hole_candidates.h
/// @brief All triangles of ring nodes that may fill a small hole, judged, measured and compared.
///
/// Triangles i < j < k stand one behind the other: all with the corners j, k, over i, then those
/// with the next j, then with the next k. Their corners are laid out in the same order, so that
/// vector instructions judge eight triangles at a time. The same results come out on every machine:
/// each triangle has its own arithmetic, in the same order, and no fused multiply-adds.
///
/// All of it is in single precision, of a ring that is scaled to a size of about 1: enough to
/// choose by. What was chosen and is to be made should be judged once more, in double precision.

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
constexpr int kMaximumTriples = kMaximumPairs * (kMaximumCompared - 2) / 3;

/// Number of a pair i < j in a list that does not depend on the hole's size.
constexpr int pairNumber(int i, int j)
{
  return j * (j - 1) / 2 + i;
}

/// Positions in the ring of the corners of a triangle.
using Triple = std::array<unsigned char, 3>;

/// Number of a triangle of sorted corners in such a list.
inline int tripleNumber(const Triple& t)
{
  return t[2] * (t[2] - 1) * (t[2] - 2) / 6 + pairNumber(t[0], t[1]);
}

/// Memory: 56 KiB, of which a hole of six nodes uses 3.
class HoleCandidates
{
public:
  /// Begin a hole: place its ring.
  /// @param ring size points, relative to the removed node
  /// @param size 3 .. kMaximumCompared
  /// @param boundary whether the edge from the last node to the first is a new one
  void place(const Vector* ring, int size, bool boundary);

  /// Find out which triangles may be part of the new surface: none that is degenerate, breaks the
  /// fold rule (fold_rule.h) or points away from the original normals at all three corners. The
  /// hole's old triangles are those of its ring edges and the removed node.
  /// @param ringNormals of the original surface, any length
  /// @param normal of the hole, a unit vector
  /// @param turn how far the triangles may turn away from the old ones
  void judge(const Vector* ringNormals, const Vector& normal,
    const HeightFieldDirection& heightField, Turn turn = Turn::Small);

  /// Rule a triangle of sorted corners out, or all triangles with an edge i < j.
  void refuse(const Triple& t) { this->blocked_[tripleNumber(t)] = HUGE_VALF; }
  void forbidEdge(int i, int j);

  /// Squared distances between the new edges and the old ones that they cross. Two surfaces of flat
  /// pieces are farthest apart at a node of one of them or where two of their edges cross.
  void findCrossings(const Vector& normal);

  /// Of the edge i < j; 0 for an edge of the ring.
  float crossing(int i, int j) const { return this->crossing_[pairNumber(i, j)]; }
  void setCrossing(int i, int j, float square) { this->crossing_[pairNumber(i, j)] = square; }

  /// Largest squared height of the points over each triangle in which they lie, as seen along an
  /// axis. Points outside the hole count for the triangle on the ring edge that they lie behind.
  /// @param count of the points, without those that pad their rows
  /// @param axisX, axisY perpendicular unit vectors of the plane
  void measure(const PointRows& points, int count, const Vector& axisX, const Vector& axisY);

  /// As found; of sorted corners.
  bool isAllowed(const Triple& t) const { return this->blocked_[tripleNumber(t)] == 0.0F; }
  double shape(const Triple& t) const { return this->shape_[tripleNumber(t)]; }
  Vector normal(const Triple& t) const
  {
    const int at = tripleNumber(t);
    return { this->normalX_[at], this->normalY_[at], this->normalZ_[at] };
  }
  float offset(const Triple& t) const { return this->offset_[tripleNumber(t)]; }
  float square(const Triple& t) const { return this->square_[tripleNumber(t)]; }

  /// Of a triangle that was measured elsewhere.
  void setSquare(const Triple& t, float square) { this->square_[tripleNumber(t)] = square; }

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
  // Loops take steps of so many, and go beyond the end of a list: what is there does not count.
  static constexpr int kLanes = 8;
  template <typename Number>
  using Row = Number[kMaximumCompared + kLanes];
  using Pairs = float[kMaximumPairs + 2 * kLanes];
  using Triangles = float[kMaximumTriples + 2 * kLanes];

  // Vector clones are no members.
  friend struct HoleKernels;

  int size_ = 0;
  bool boundary_ = false;
  double scale_ = 1.0; // from places to scaled ones, a power of two
  // The ring, and scaled.
  Row<double> places_[3] = {};
  Row<float> ring_[3] = {};
  Row<float> originals_[3] = {};  // normals of the original surface
  Row<float> oldNormals_[3] = {}; // unit
  // Pairs.
  Pairs crossing_ = {};
  Pairs lineX_ = {}; // in the plane
  Pairs lineY_ = {};
  Pairs lineOffset_ = {};
  // Triangles: corners, scaled, and up to two directions that each has to follow.
  Triangles corners_[3][3] = {};
  Triangles directions_[2][3] = {};
  Triangles blocked_ = {}; // 0, or infinite if it may not be
  Triangles shape_ = {};
  Triangles cost_ = {};
  Triangles normalX_ = {}; // unit
  Triangles normalY_ = {};
  Triangles normalZ_ = {};
  Triangles offset_ = {};
  Triangles square_ = {};
  std::vector<float> sides_; // of the points in the plane, a row for each pair
};

} // namespace undecimate

#endif
