// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "time_lanes.h"

#include "compiler.h"
#include "vector.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace undecimate
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Loops are compiled for both numbers of lanes there are, so that no vector is left half empty: a
// few, and whole blocks.
constexpr int kFewLanes = 4;
UNDECIMATE_INLINE int wholeBlocks(int lanes)
{
  return lanes & ~7;
}

UNDECIMATE_INLINE float larger(float a, float b)
{
  return a > b ? a : b;
}
UNDECIMATE_INLINE float smaller(float a, float b)
{
  return a < b ? a : b;
}

using V = VectorOf<float>;

UNDECIMATE_INLINE V at(const float* rows, int lanes, int i)
{
  return { rows[i], rows[lanes + i], rows[2 * lanes + i] };
}
UNDECIMATE_INLINE void put(const V& v, float* rows, int lanes, int i)
{
  rows[i] = v.x;
  rows[lanes + i] = v.y;
  rows[2 * lanes + i] = v.z;
}
// 1 / length, 0 of nothing.
UNDECIMATE_INLINE float inverseLength(const V& v)
{
  const float square = dot(v, v);
  return square > 0.0F ? 1.0F / std::sqrt(square) : 0.0F;
}

// Rows of a prepared triangle. Of each edge: direction, its start along it, the direction inwards,
// the edge's place along that, its length.
constexpr int kEdgeRows = 9;
constexpr int kAlong = 0;
constexpr int kStart = 3;
constexpr int kInwards = 4;
constexpr int kSide = 7;
constexpr int kLength = 8;
constexpr int kNormalRow = 3 * kEdgeRows;
constexpr int kHeight = kNormalRow + 3;
constexpr int kFar = kHeight + 1;
static_assert(kFar + 1 == kTriangleRows, "");

} // namespace

namespace
{

UNDECIMATE_INLINE void prepareTriangleAt(int lanes, const float* __restrict__ a,
  const float* __restrict__ b, const float* __restrict__ c, float* __restrict__ triangle)
{
  float* __restrict__ normalRows = triangle + kNormalRow * lanes;
  for (int i = 0; i < lanes; ++i)
  {
    const V p = at(a, lanes, i);
    const V full = cross(at(b, lanes, i) - p, at(c, lanes, i) - p);
    const float inverse = inverseLength(full);
    const V normal = inverse * full;
    put(normal, normalRows, lanes, i);
    triangle[kHeight * lanes + i] = dot(normal, p);
    triangle[kFar * lanes + i] = inverse > 0.0F ? 0.0F : kInfinity;
  }
  const float* const from[3] = { a, b, c };
  const float* const to[3] = { b, c, a };
  for (int k = 0; k < 3; ++k)
  {
    const float* __restrict__ f = from[k];
    const float* __restrict__ t = to[k];
    float* __restrict__ edge = triangle + k * kEdgeRows * lanes;
    for (int i = 0; i < lanes; ++i)
    {
      const V start = at(f, lanes, i);
      const V full = at(t, lanes, i) - start;
      const float inverse = inverseLength(full);
      const V along = inverse * full;
      const V inwards = cross(at(normalRows, lanes, i), along);
      put(along, edge + kAlong * lanes, lanes, i);
      edge[kStart * lanes + i] = dot(along, start);
      put(inwards, edge + kInwards * lanes, lanes, i);
      edge[kSide * lanes + i] = dot(inwards, start);
      edge[kLength * lanes + i] = dot(along, full);
    }
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void prepareTriangle(int lanes, const float* __restrict__ a, const float* __restrict__ b,
  const float* __restrict__ c, float* __restrict__ triangle)
{
  if (lanes == kFewLanes)
  {
    prepareTriangleAt(kFewLanes, a, b, c, triangle);
  }
  else
  {
    prepareTriangleAt(wholeBlocks(lanes), a, b, c, triangle);
  }
}

namespace
{

// Squared distance within the plane to an edge, and the side of it.
UNDECIMATE_INLINE float edgeSquare(const float* edge, int lanes, int i, const V& p, float& side)
{
  side = dot(at(edge + kInwards * lanes, lanes, i), p) - edge[kSide * lanes + i];
  const float along = dot(at(edge + kAlong * lanes, lanes, i), p) - edge[kStart * lanes + i];
  const float excess = larger(larger(-along, along - edge[kLength * lanes + i]), 0.0F);
  return side * side + excess * excess;
}

UNDECIMATE_INLINE float squaredDistance(
  const float* triangle, int lanes, int i, const V& p, float* sides)
{
  const float* const second = triangle + kEdgeRows * lanes;
  const float square0 = edgeSquare(triangle, lanes, i, p, sides[0]);
  const float square1 = edgeSquare(second, lanes, i, p, sides[1]);
  const float square2 = edgeSquare(second + kEdgeRows * lanes, lanes, i, p, sides[2]);
  const float outside = smaller(smaller(square0, square1), square2);
  const float inmost = smaller(smaller(sides[0], sides[1]), sides[2]);
  const float height =
    dot(at(triangle + kNormalRow * lanes, lanes, i), p) - triangle[kHeight * lanes + i];
  return (inmost >= 0.0F ? 0.0F : outside) + height * height + triangle[kFar * lanes + i];
}

} // namespace

namespace
{

UNDECIMATE_INLINE void minimumDistancesAt(int lanes, const float* __restrict__ triangles, int count,
  const float* __restrict__ point, float* __restrict__ squares)
{
  for (int k = 0; k < count; ++k)
  {
    const float* __restrict__ triangle =
      triangles + static_cast<std::ptrdiff_t>(kTriangleRows) * lanes * k;
    for (int i = 0; i < lanes; ++i)
    {
      float sides[3];
      const float square = squaredDistance(triangle, lanes, i, at(point, lanes, i), sides);
      squares[i] = smaller(squares[i], square);
    }
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void minimumDistances(int lanes, const float* __restrict__ triangles, int count,
  const float* __restrict__ point, float* __restrict__ squares)
{
  if (lanes == kFewLanes)
  {
    minimumDistancesAt(kFewLanes, triangles, count, point, squares);
  }
  else
  {
    minimumDistancesAt(wholeBlocks(lanes), triangles, count, point, squares);
  }
}

UNDECIMATE_VECTOR_CLONES
void minimumDistances(int lanes, const float* __restrict__ triangle,
  const float* __restrict__ point, const LaneValues* arrays, int arrayCount,
  float* __restrict__ squares, float* __restrict__ errors)
{
  for (int i = 0; i < lanes; ++i)
  {
    float sides[3];
    const float square = squaredDistance(triangle, lanes, i, at(point, lanes, i), sides);
    if (!(square < squares[i]))
    {
      continue;
    }
    squares[i] = square;
    // The weight of a corner is the distance from the opposite edge, beyond it 0, of all three.
    float weights[3];
    float sum = 0.0F;
    for (int k = 0; k < 3; ++k)
    {
      const int opposite = (k + 1) % 3;
      weights[k] =
        larger(sides[opposite], 0.0F) * triangle[(opposite * kEdgeRows + kLength) * lanes + i];
      sum += weights[k];
    }
    const float inverse = sum > 0.0F ? 1.0F / sum : 0.0F;
    float error = 0.0F;
    for (int n = 0; n < arrayCount; ++n)
    {
      const LaneValues& array = arrays[n];
      float total = 0.0F;
      for (int c = 0; c < array.components; ++c)
      {
        const int j = c * lanes + i;
        const float value = inverse *
          (weights[0] * array.corners[0][j] + weights[1] * array.corners[1][j] +
            weights[2] * array.corners[2][j]);
        const float difference = array.scale * (value - array.point[j]);
        total += difference * difference;
      }
      error = larger(error, total);
    }
    errors[i] = error;
  }
}

namespace
{

UNDECIMATE_INLINE void maximumDistanceToEdgeAt(int lanes, const float* __restrict__ a,
  const float* __restrict__ b, const float* __restrict__ point, float* __restrict__ squares)
{
  for (int i = 0; i < lanes; ++i)
  {
    const V start = at(a, lanes, i);
    const V full = at(b, lanes, i) - start;
    const V offset = at(point, lanes, i) - start;
    const float square = dot(full, full);
    const float fraction = square > 0.0F ? dot(offset, full) / square : 0.0F;
    const float clamped = smaller(larger(fraction, 0.0F), 1.0F);
    const V rest = offset - clamped * full;
    squares[i] = larger(squares[i], dot(rest, rest));
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void maximumDistanceToEdge(int lanes, const float* __restrict__ a, const float* __restrict__ b,
  const float* __restrict__ point, float* __restrict__ squares)
{
  if (lanes == kFewLanes)
  {
    maximumDistanceToEdgeAt(kFewLanes, a, b, point, squares);
  }
  else
  {
    maximumDistanceToEdgeAt(wholeBlocks(lanes), a, b, point, squares);
  }
}

namespace
{

UNDECIMATE_INLINE void subtractAt(int lanes, int rows, const float* __restrict__ a,
  const float* __restrict__ b, float* __restrict__ difference)
{
  for (int i = 0; i < rows * lanes; ++i)
  {
    difference[i] = a[i] - b[i];
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void subtract(int lanes, int rows, const float* __restrict__ a, const float* __restrict__ b,
  float* __restrict__ difference)
{
  if (lanes == kFewLanes)
  {
    subtractAt(kFewLanes, rows, a, b, difference);
  }
  else
  {
    subtractAt(wholeBlocks(lanes), rows, a, b, difference);
  }
}

void middle(
  int lanes, const float* __restrict__ a, const float* __restrict__ b, float* __restrict__ mean)
{
  for (int i = 0; i < 3 * lanes; ++i)
  {
    mean[i] = 0.5F * (a[i] + b[i]);
  }
}

void pointBetween(int lanes, const float* __restrict__ a, const float* __restrict__ b,
  float fraction, float* __restrict__ point)
{
  for (int i = 0; i < 3 * lanes; ++i)
  {
    point[i] = (1.0F - fraction) * a[i] + fraction * b[i];
  }
}

void center(int lanes, int rows, const float* __restrict__ a, const float* __restrict__ b,
  const float* __restrict__ c, const float* __restrict__ d, float* __restrict__ mean)
{
  for (int i = 0; i < rows * lanes; ++i)
  {
    mean[i] = 0.25F * ((a[i] + b[i]) + (c[i] + d[i]));
  }
}

void mean(int lanes, const float* const* points, int count, float* __restrict__ mean)
{
  const float share = 1.0F / static_cast<float>(count);
  for (int i = 0; i < 3 * lanes; ++i)
  {
    float sum = points[0][i];
    for (int k = 1; k < count; ++k)
    {
      sum += points[k][i];
    }
    mean[i] = share * sum;
  }
}

UNDECIMATE_VECTOR_CLONES
void nearestPoints(int lanes, const float* __restrict__ points, int count,
  const float* __restrict__ place, int* __restrict__ nearest)
{
  // Lanes are 4 or a multiple of 8: some at a time, with their smallest squares at hand.
  constexpr int kBlock = 4;
  for (int first = 0; first < lanes; first += kBlock)
  {
    float least[kBlock] = { kInfinity, kInfinity, kInfinity, kInfinity };
    int number[kBlock] = { 0, 0, 0, 0 };
    for (int k = 0; k < count; ++k)
    {
      const float* point = points + 3 * lanes * static_cast<std::ptrdiff_t>(k) + first;
      for (int i = 0; i < kBlock; ++i)
      {
        const float x = point[i] - place[first + i];
        const float y = point[lanes + i] - place[lanes + first + i];
        const float z = point[2 * lanes + i] - place[2 * lanes + first + i];
        const float square = x * x + y * y + z * z;
        const bool nearer = square < least[i];
        least[i] = nearer ? square : least[i];
        number[i] = nearer ? k : number[i];
      }
    }
    for (int i = 0; i < kBlock; ++i)
    {
      nearest[first + i] = number[i];
    }
  }
}

void raise(int lanes, const float* __restrict__ from, float* __restrict__ to)
{
  for (int i = 0; i < lanes; ++i)
  {
    to[i] = larger(to[i], from[i]);
  }
}

void lower(int lanes, const float* __restrict__ from, float* __restrict__ to)
{
  for (int i = 0; i < lanes; ++i)
  {
    to[i] = smaller(to[i], from[i]);
  }
}

float largest(int lanes, const float* row)
{
  // Four chains at a time.
  float most[4] = { row[0], row[1], row[2], row[3] };
  for (int i = 4; i < lanes; i += 4)
  {
    for (int k = 0; k < 4; ++k)
    {
      most[k] = larger(most[k], row[i + k]);
    }
  }
  return larger(larger(most[0], most[1]), larger(most[2], most[3]));
}

bool isAtMost(int lanes, const float* a, const float* b)
{
  for (int i = 0; i < lanes; i += kFewLanes)
  {
    int above = 0;
    for (int k = i; k < i + kFewLanes; ++k)
    {
      above += !(a[k] <= b[k]);
    }
    if (above != 0)
    {
      return false;
    }
  }
  return true;
}

namespace
{

// Twice the normal of the whole cell: of a quad the cross product of its diagonals.
UNDECIMATE_INLINE V cellNormal(const float* const* corners, int count, int lanes, int i)
{
  const V a = at(corners[0], lanes, i);
  const V c = at(corners[2], lanes, i);
  if (count == 3)
  {
    return cross(at(corners[1], lanes, i) - a, c - a);
  }
  return cross(c - a, at(corners[3], lanes, i) - at(corners[1], lanes, i));
}

// What makes a cell bad beside a normal: the triangle of a corner is a needle, or a quad's corner
// points inwards.
UNDECIMATE_INLINE bool isBadCell(
  const float* const* corners, int count, int lanes, int i, const V& normal)
{
  bool bad = false;
  for (int k = 0; k < count; ++k)
  {
    const V p = at(corners[k], lanes, i);
    const V next = at(corners[k + 1 == count ? 0 : k + 1], lanes, i) - p;
    const V previous = at(corners[k == 0 ? count - 1 : k - 1], lanes, i) - p;
    const V corner = cross(next, previous);
    const V across = next - previous;
    const float edges = dot(next, next) + dot(previous, previous) + dot(across, across);
    const float limit = kMinimumCellShape * edges;
    bad |= !(12.0F * dot(corner, corner) > limit * limit);
    bad |= !(dot(corner, normal) > 0.0F);
    if (count == 3)
    {
      break;
    }
  }
  return bad;
}

// Whether a cell would be bad in the place of another one at a step, and that cell's normal.
template <int OldCount, int NewCount>
UNDECIMATE_INLINE bool becomesBad(
  int lanes, const float* const* oldCorners, const float* const* newCorners, int i, V& before)
{
  before = cellNormal(oldCorners, OldCount, lanes, i);
  const V now = cellNormal(newCorners, NewCount, lanes, i);
  const float both = dot(before, now);
  const float squares = dot(before, before) * dot(now, now);
  const bool turns = !(both > 0.0F && both * both > kMinimumCosine * kMinimumCosine * squares);
  return turns || isBadCell(newCorners, NewCount, lanes, i, now);
}

// Whether a cell may not take the place of another one at a step.
template <int OldCount, int NewCount>
UNDECIMATE_INLINE bool isRefused(
  int lanes, const float* const* oldCorners, const float* const* newCorners, int i)
{
  V before;
  const bool bad = becomesBad<OldCount, NewCount>(lanes, oldCorners, newCorners, i, before);
  return bad && !isBadCell(oldCorners, OldCount, lanes, i, before);
}

template <int OldCount, int NewCount>
UNDECIMATE_INLINE int countRefused(
  int lanes, const float* const* oldCorners, const float* const* newCorners)
{
  // Few become bad, and only then the old cell matters.
  int badLanes = 0;
  for (int i = 0; i < lanes; ++i)
  {
    V before;
    badLanes += becomesBad<OldCount, NewCount>(lanes, oldCorners, newCorners, i, before);
  }
  if (badLanes == 0)
  {
    return 0;
  }
  int refused = 0;
  for (int i = 0; i < lanes; ++i)
  {
    refused += isRefused<OldCount, NewCount>(lanes, oldCorners, newCorners, i);
  }
  return refused;
}

template <int OldCount, int NewCount>
UNDECIMATE_INLINE bool isAllowed(
  int lanes, const float* const* oldCorners, const float* const* newCorners)
{
  return (lanes == kFewLanes
             ? countRefused<OldCount, NewCount>(kFewLanes, oldCorners, newCorners)
             : countRefused<OldCount, NewCount>(wholeBlocks(lanes), oldCorners, newCorners)) == 0;
}

} // namespace

UNDECIMATE_VECTOR_CLONES
bool mayReplaceCell(int lanes, const float* const* oldCorners, int oldCount,
  const float* const* newCorners, int newCount)
{
  if (oldCount == 3)
  {
    return isAllowed<3, 3>(lanes, oldCorners, newCorners);
  }
  if (newCount == 3)
  {
    return isAllowed<4, 3>(lanes, oldCorners, newCorners);
  }
  return isAllowed<4, 4>(lanes, oldCorners, newCorners);
}

namespace
{

template <int OldCount, int NewCount>
void raiseByFoldsOf(
  int lanes, const float* const* oldCorners, const float* const* newCorners, float* squares)
{
  for (int i = 0; i < lanes; ++i)
  {
    float longest = 0.0F;
    for (int k = 0; k < NewCount; ++k)
    {
      const V edge = at(newCorners[(k + 1) % NewCount], lanes, i) - at(newCorners[k], lanes, i);
      longest = larger(longest, dot(edge, edge));
    }
    const bool refused = isRefused<OldCount, NewCount>(lanes, oldCorners, newCorners, i);
    squares[i] = refused ? larger(squares[i], kFoldWeight * kFoldWeight * longest) : squares[i];
  }
}

} // namespace

void raiseByFolds(int lanes, const float* const* oldCorners, int oldCount,
  const float* const* newCorners, int newCount, float* squares)
{
  if (oldCount == 3)
  {
    raiseByFoldsOf<3, 3>(lanes, oldCorners, newCorners, squares);
  }
  else if (newCount == 3)
  {
    raiseByFoldsOf<4, 3>(lanes, oldCorners, newCorners, squares);
  }
  else
  {
    raiseByFoldsOf<4, 4>(lanes, oldCorners, newCorners, squares);
  }
}

namespace
{

// The quadric of a plane, at a place that is so far above it.
UNDECIMATE_INLINE void addPlane(
  float* quadric, int lanes, int i, const V& normal, float height, float weight)
{
  const float values[kQuadricRows] = { normal.x * normal.x, normal.x * normal.y,
    normal.x * normal.z, normal.y * normal.y, normal.y * normal.z, normal.z * normal.z,
    normal.x * height, normal.y * height, normal.z * height, height * height, 1.0F };
  for (int row = 0; row < kQuadricRows; ++row)
  {
    quadric[row * lanes + i] += weight * values[row];
  }
}

// The unit normal of a cell as [W06] has it, and its area.
template <int Count>
UNDECIMATE_INLINE V meanNormal(const float* const* corners, int lanes, int i, float& area)
{
  V sum{ 0.0F, 0.0F, 0.0F };
  for (int k = 0; k < (Count == 3 ? 1 : Count); ++k)
  {
    const V p = at(corners[k], lanes, i);
    const V next = at(corners[(k + 1) % Count], lanes, i) - p;
    const V corner = cross(next, at(corners[(k + Count - 1) % Count], lanes, i) - p);
    sum = sum + inverseLength(corner) * corner;
  }
  const V whole = cellNormal(corners, Count, lanes, i);
  area = 0.5F * std::sqrt(dot(whole, whole));
  return inverseLength(sum) * sum;
}

template <int Count>
UNDECIMATE_INLINE void addCell(int lanes, const float* const* corners, float* const* quadrics)
{
  for (int i = 0; i < lanes; ++i)
  {
    float area;
    const V normal = meanNormal<Count>(corners, lanes, i, area);
    V middle = at(corners[0], lanes, i);
    for (int k = 1; k < Count; ++k)
    {
      middle = middle + at(corners[k], lanes, i);
    }
    middle = (1.0F / Count) * middle;
    for (int k = 0; k < Count; ++k)
    {
      addPlane(quadrics[k], lanes, i, normal, dot(normal, at(corners[k], lanes, i) - middle), area);
    }
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void addCellQuadrics(int lanes, const float* const* corners, int count, float* const* quadrics)
{
  if (count == 3)
  {
    addCell<3>(lanes, corners, quadrics);
  }
  else
  {
    addCell<4>(lanes, corners, quadrics);
  }
}

UNDECIMATE_VECTOR_CLONES
void addBoundaryQuadrics(
  int lanes, const float* const* corners, int count, int edge, float weight, float* const* quadrics)
{
  const int end = edge + 1 == count ? 0 : edge + 1;
  for (int i = 0; i < lanes; ++i)
  {
    const V along = at(corners[end], lanes, i) - at(corners[edge], lanes, i);
    const V whole = cellNormal(corners, count, lanes, i);
    const V across = cross(whole, along);
    const V normal = inverseLength(across) * across;
    const float area = weight * dot(along, along);
    addPlane(quadrics[edge], lanes, i, normal, 0.0F, area);
    addPlane(quadrics[end], lanes, i, normal, 0.0F, area);
  }
}

namespace
{

// The value of a quadric at a place, not below 0, and its matrix times the place.
UNDECIMATE_INLINE float quadricValue(const float* q, int n, int i, const V& p, V& product)
{
  product = { q[i] * p.x + q[n + i] * p.y + q[2 * n + i] * p.z,
    q[n + i] * p.x + q[3 * n + i] * p.y + q[4 * n + i] * p.z,
    q[2 * n + i] * p.x + q[4 * n + i] * p.y + q[5 * n + i] * p.z };
  const float value = (product.x + 2.0F * q[6 * n + i]) * p.x +
    (product.y + 2.0F * q[7 * n + i]) * p.y + (product.z + 2.0F * q[8 * n + i]) * p.z +
    q[9 * n + i];
  return larger(value, 0.0F);
}

UNDECIMATE_INLINE void quadricValuesAt(int lanes, const float* __restrict__ quadric,
  const float* __restrict__ d, float* __restrict__ squares)
{
  for (int i = 0; i < lanes; ++i)
  {
    V product;
    squares[i] = quadricValue(quadric, lanes, i, at(d, lanes, i), product);
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void quadricValues(int lanes, const float* __restrict__ quadric, const float* __restrict__ d,
  float* __restrict__ squares)
{
  if (lanes == kFewLanes)
  {
    quadricValuesAt(kFewLanes, quadric, d, squares);
  }
  else
  {
    quadricValuesAt(wholeBlocks(lanes), quadric, d, squares);
  }
}

namespace
{

UNDECIMATE_INLINE void mergeQuadricAt(
  int lanes, const float* __restrict__ from, const float* __restrict__ d, float* __restrict__ to)
{
  const float* const q = from;
  const int n = lanes;
  for (int i = 0; i < lanes; ++i)
  {
    V product;
    const float value = quadricValue(q, n, i, at(d, lanes, i), product);
    for (int row = 0; row < 6; ++row)
    {
      to[row * n + i] += q[row * n + i];
    }
    to[6 * n + i] += q[6 * n + i] + product.x;
    to[7 * n + i] += q[7 * n + i] + product.y;
    to[8 * n + i] += q[8 * n + i] + product.z;
    to[9 * n + i] += value;
    to[10 * n + i] += q[10 * n + i];
  }
}

} // namespace

UNDECIMATE_VECTOR_CLONES
void mergeQuadric(
  int lanes, const float* __restrict__ from, const float* __restrict__ d, float* __restrict__ to)
{
  if (lanes == kFewLanes)
  {
    mergeQuadricAt(kFewLanes, from, d, to);
  }
  else
  {
    mergeQuadricAt(wholeBlocks(lanes), from, d, to);
  }
}

} // namespace undecimate
