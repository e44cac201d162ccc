// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file time_lanes.h
/// @brief Geometry at all time steps at once: a lane for each step (see time_rows.h).
///
/// A point is three rows of lanes. All functions take the number of lanes, which is 4 or a multiple
/// of 8, and are written so that compilers turn the loops over lanes into vector instructions.
/// Single precision: points are to be relative to one nearby.

#ifndef UNDECIMATE_CORE_TIME_LANES_H
#define UNDECIMATE_CORE_TIME_LANES_H

namespace undecimate
{

/// Rows of a triangle that is prepared for distances.
constexpr int kTriangleRows = 32;

/// Rows of a quadric: a symmetric matrix A (xx xy xz yy yz zz), a vector b and a number c, which
/// give the weighted sum of squared distances d'Ad + 2b'd + c at a place d from the quadric's own;
/// and the sum of the weights.
constexpr int kQuadricRows = 11;
constexpr int kQuadricWeight = 10;

/// Prepare a triangle for minimumDistances(); where it has no area it is infinitely far away.
/// @param[out] triangle kTriangleRows * lanes
void prepareTriangle(int lanes, const float* a, const float* b, const float* c, float* triangle);

/// squares[i] = min(squares[i], squared distance of the point to some triangles).
/// @param triangles one behind the other
void minimumDistances(
  int lanes, const float* triangles, int count, const float* point, float* squares);

/// The same of one triangle, and where it is the nearest so far errors[i] = the squared difference
/// between the value interpolated from the triangle's corners and the point's, added over all
/// components, times scale^2, largest over the arrays.
struct LaneValues
{
  const float* corners[3]; ///< rows of each component
  const float* point;
  int components;
  float scale;
};
void minimumDistances(int lanes, const float* triangle, const float* point,
  const LaneValues* arrays, int arrayCount, float* squares, float* errors);

/// squares[i] = max(squares[i], squared distance of the point to the line from a to b).
void maximumDistanceToEdge(
  int lanes, const float* a, const float* b, const float* point, float* squares);

/// difference = a - b, for `rows` rows.
void subtract(int lanes, int rows, const float* a, const float* b, float* difference);

/// mean = 0.5 (a + b) of two points.
void middle(int lanes, const float* a, const float* b, float* mean);

/// point = (1 - fraction) a + fraction b of two points.
void pointBetween(int lanes, const float* a, const float* b, float fraction, float* point);

/// The mean of four rows of any number.
void center(
  int lanes, int rows, const float* a, const float* b, const float* c, const float* d, float* mean);

/// The mean of some points.
void mean(int lanes, const float* const* points, int count, float* mean);

/// At each step the number of the point nearest to a place; the first of several.
/// @param points 3 * lanes * count, count 1 or more
/// @param[out] nearest one for each lane
void nearestPoints(int lanes, const float* points, int count, const float* place, int* nearest);

/// to[i] = max(to[i], from[i])
void raise(int lanes, const float* from, float* to);

/// to[i] = min(to[i], from[i])
void lower(int lanes, const float* from, float* to);

/// The largest value of a row.
float largest(int lanes, const float* row);

/// Whether a[i] <= b[i] everywhere.
bool isAtMost(int lanes, const float* a, const float* b);

/// Whether a cell may take the place of another one at all steps: it turns by less than the angle
/// of kMinimumCosine, is no needle, and a quad has no corner that points inwards. At steps where
/// the old one is bad itself (a needle, without area, or with such a corner) anything goes.
/// @param oldCorners, newCorners 3 or 4 points in order
bool mayReplaceCell(int lanes, const float* const* oldCorners, int oldCount,
  const float* const* newCorners, int newCount);

/// What it counts where mayReplaceCell() refuses: at such steps squares[i] = max(squares[i], square
/// of kFoldWeight times the new cell's longest edge). Parameters as there.
void raiseByFolds(int lanes, const float* const* oldCorners, int oldCount,
  const float* const* newCorners, int newCount, float* squares);
constexpr float kFoldWeight = 0.5F;

/// Cosine of the largest turn of a cell, and the smallest shape (1 = equilateral) of a corner's
/// triangle.
constexpr float kMinimumCosine = 0.15F;
constexpr float kMinimumCellShape = 1e-3F;

/// Add the quadric of a cell's plane to those of its corners: [W06] 2, the normal is the mean of
/// the unit normals at the corners, the place the centre of gravity.
/// @param corners 3 or 4 points in order
/// @param[in,out] quadrics one for each corner
void addCellQuadrics(int lanes, const float* const* corners, int count, float* const* quadrics);

/// Add the quadric of the plane through a boundary edge, perpendicular to its cell, to those of its
/// ends. @param corners of the cell; the edge is the one behind corner `edge`
void addBoundaryQuadrics(int lanes, const float* const* corners, int count, int edge, float weight,
  float* const* quadrics);

/// squares[i] = weighted sum at d of a quadric.
void quadricValues(int lanes, const float* quadric, const float* d, float* squares);

/// to += from, whose own place is at -d from the place of `to`.
void mergeQuadric(int lanes, const float* from, const float* d, float* to);

} // namespace undecimate

#endif
