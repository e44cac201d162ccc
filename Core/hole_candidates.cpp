// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hole_candidates.h"

#include "compiler.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

namespace
{

// Points are compared in chunks that stay in the cache.
constexpr int kChunk = 256;

// Up to so many points are measured one by one.
constexpr int kFewPoints = 3;

// Where the normals of the ring's nodes and those of the old triangles are all within such an angle
// of the hole's normal, no triangle that follows an old one can point away from the nodes' normals:
// cosine of half of what the largest turn leaves of a right angle.
constexpr float kSmoothCosine = 0.9972F;

// Of a unit normal in single precision, along the axis of a height field: what is less is rounding.
constexpr float kRounding = 1e-6F;

// Corners of the pairs, in their order.
struct PairTable
{
  float first[kMaximumPairs + 8] = {};
  float second[kMaximumPairs + 8] = {};
  constexpr PairTable()
  {
    for (int j = 1, at = 0; j < kMaximumCompared; ++j)
    {
      for (int i = 0; i < j; ++i, ++at)
      {
        this->first[at] = static_cast<float>(i);
        this->second[at] = static_cast<float>(j);
      }
    }
  }
};
constexpr PairTable kPairs;

UNDECIMATE_INLINE float larger(float a, float b)
{
  return a > b ? a : b;
}

// What FilledTriangle::follows() asks for.
// @param widest of well-shaped triangles
UNDECIMATE_INLINE float minimumCosine(float shape, float widest)
{
  constexpr float kNeedle = static_cast<float>(FilledTriangle::kNeedleShape);
  constexpr float kCosine = static_cast<float>(FilledTriangle::kMinimumCosine);
  constexpr float kStricter =
    static_cast<float>(FilledTriangle::kNeedleCosine - FilledTriangle::kMinimumCosine);
  return shape < kNeedle ? kCosine + kStricter * (1.0F - shape / kNeedle) : widest;
}

} // namespace

// The loops, compiled for wider vectors as well.
struct HoleKernels
{
  static constexpr int kLanes = HoleCandidates::kLanes;

  // Copy the beginning of a row, or repeat a value; whole vectors, so that a few more are written.
  template <int Count>
  static UNDECIMATE_INLINE void copy(const float* from, float* to)
  {
    UNDECIMATE_LANES
    for (int i = 0; i < Count; ++i)
    {
      to[i] = from[i];
    }
  }
  template <int Count>
  static UNDECIMATE_INLINE void repeat(float value, float* to)
  {
    UNDECIMATE_LANES
    for (int i = 0; i < Count; ++i)
    {
      to[i] = value;
    }
  }
  template <int Count>
  static void spreadAxis(HoleCandidates& h, int axis, float normal);
  static void spread(HoleCandidates& h, const Vector& normal);
  static void findOldNormals(HoleCandidates& h);
  static bool isSmooth(const HoleCandidates& h, const Vector& normal);
  static void judge(HoleCandidates& h, const HeightFieldDirection& heightField, float widest);
  static void refuseOpposing(HoleCandidates& h);
  static void refuseReversed(HoleCandidates& h, const Vector& normal);
  static void findCrossings(HoleCandidates& h, const Vector& normal);
  static void findLines(HoleCandidates& h, const Vector& axisX, const Vector& axisY);
  static void measureFew(
    HoleCandidates& h, const PointRows& points, const float* x, const float* y, int count);
  static void measureMany(HoleCandidates& h, const PointRows& points, const float* __restrict__ x,
    const float* __restrict__ y, bool first);
  static void weigh(HoleCandidates& h, float scale, float shapeWeight);
  template <int Size>
  static float sumUp(const HoleCandidates& h, unsigned char (*apexes)[kMaximumCompared]);
};

// Unit normals of the old triangles; NaN where one has no area, which nothing follows.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::findOldNormals(HoleCandidates& h)
{
  for (auto& row : h.ring_)
  {
    row[h.size_] = row[0];
  }
  for (int begin = 0; begin < h.size_; begin += kLanes)
  {
    for (int i = begin; i < begin + kLanes; ++i)
    {
      const float x = h.ring_[1][i] * h.ring_[2][i + 1] - h.ring_[2][i] * h.ring_[1][i + 1];
      const float y = h.ring_[2][i] * h.ring_[0][i + 1] - h.ring_[0][i] * h.ring_[2][i + 1];
      const float z = h.ring_[0][i] * h.ring_[1][i + 1] - h.ring_[1][i] * h.ring_[0][i + 1];
      const float inverse = 1.0F / std::sqrt(x * x + y * y + z * z);
      h.oldNormals_[0][i] = inverse * x;
      h.oldNormals_[1][i] = inverse * y;
      h.oldNormals_[2][i] = inverse * z;
    }
  }
}

UNDECIMATE_VECTOR_CLONES
bool HoleKernels::isSmooth(const HoleCandidates& h, const Vector& normal)
{
  const float x = static_cast<float>(normal.x);
  const float y = static_cast<float>(normal.y);
  const float z = static_cast<float>(normal.z);
  const int old = h.boundary_ ? h.size_ - 1 : h.size_;
  int smooth = 0;
  for (int i = 0; i < h.size_; ++i)
  {
    const float nX = h.originals_[0][i];
    const float nY = h.originals_[1][i];
    const float nZ = h.originals_[2][i];
    const float along = nX * x + nY * y + nZ * z;
    const float limit = kSmoothCosine * kSmoothCosine * (nX * nX + nY * nY + nZ * nZ);
    const float oldAlong =
      h.oldNormals_[0][i] * x + h.oldNormals_[1][i] * y + h.oldNormals_[2][i] * z;
    smooth += (along > 0.0F) & (along * along > limit) & ((oldAlong > kSmoothCosine) | (i >= old));
  }
  return smooth == h.size_;
}

// Of all triangles, the corners and the directions to follow along an axis. A triangle follows the
// old triangles on its ring edges, or without any the hole's normal.
// @tparam Count that the longest run of triangles with the same j and k has at most
template <int Count>
UNDECIMATE_INLINE void HoleKernels::spreadAxis(HoleCandidates& h, int axis, float normal)
{
  const int last = h.size_ - 1;
  const float* ring = h.ring_[axis];
  const float* old = h.oldNormals_[axis];
  float* a = h.corners_[0][axis];
  float* b = h.corners_[1][axis];
  float* c = h.corners_[2][axis];
  float* first = h.directions_[0][axis];
  float* second = h.directions_[1][axis];
  int at = 0;
  for (int k = 2; k <= last; ++k)
  {
    for (int j = 1; j < k; at += j, ++j)
    {
      const bool adjacent = j + 1 == k;
      copy<Count>(ring, a + at);
      repeat<Count>(ring[j], b + at);
      repeat<Count>(ring[k], c + at);
      const float direction = adjacent ? old[j] : normal;
      const float before = old[j - 1];
      repeat<Count>(direction, first + at);
      repeat<Count>(direction, second + at);
      first[at + j - 1] = adjacent ? direction : before;
      second[at + j - 1] = before;
    }
  }
  // The edge from the last node to the first one; of a ring of three it is the third.
  at -= pairNumber(0, last);
  for (int j = 1; j < last && last > 2 && !h.boundary_; at += j, ++j)
  {
    (j + 1 < last ? first : second)[at] = old[last];
    second[at] = j == 1 ? second[at] : old[last];
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::spread(HoleCandidates& h, const Vector& normal)
{
  const float normals[3] = { static_cast<float>(normal.x), static_cast<float>(normal.y),
    static_cast<float>(normal.z) };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (h.size_ <= kLanes + 1)
    {
      spreadAxis<kLanes>(h, axis, normals[axis]);
    }
    else
    {
      spreadAxis<kMaximumCompared>(h, axis, normals[axis]);
    }
  }
}

// @param widest cosine of the largest turn of well-shaped triangles
UNDECIMATE_VECTOR_CLONES
void HoleKernels::judge(HoleCandidates& h, const HeightFieldDirection& heightField, float widest)
{
  constexpr float kFlat = static_cast<float>(FilledTriangle::kMinimumShape);
  const float axisX = static_cast<float>(heightField.direction().x);
  const float axisY = static_cast<float>(heightField.direction().y);
  const float axisZ = static_cast<float>(heightField.direction().z);
  const float minimumAlong = heightField.known() ? kRounding : -1.0F; // without an axis it is 0
  const float inverseScale = static_cast<float>(1.0 / h.scale_);
  const float twoRoots = static_cast<float>(2.0 * std::sqrt(3.0));
  const int count = h.size_ * (h.size_ - 1) * (h.size_ - 2) / 6;
  for (int begin = 0; begin < count; begin += kLanes)
  {
    UNDECIMATE_LANES
    for (int t = begin; t < begin + kLanes; ++t)
    {
      const float aX = h.corners_[0][0][t];
      const float aY = h.corners_[0][1][t];
      const float aZ = h.corners_[0][2][t];
      const float abX = h.corners_[1][0][t] - aX;
      const float abY = h.corners_[1][1][t] - aY;
      const float abZ = h.corners_[1][2][t] - aZ;
      const float acX = h.corners_[2][0][t] - aX;
      const float acY = h.corners_[2][1][t] - aY;
      const float acZ = h.corners_[2][2][t] - aZ;
      const float bcX = h.corners_[2][0][t] - h.corners_[1][0][t];
      const float bcY = h.corners_[2][1][t] - h.corners_[1][1][t];
      const float bcZ = h.corners_[2][2][t] - h.corners_[1][2][t];
      const float x = abY * acZ - abZ * acY;
      const float y = abZ * acX - abX * acZ;
      const float z = abX * acY - abY * acX;
      const float length = std::sqrt(x * x + y * y + z * z);
      const float edges = (abX * abX + abY * abY + abZ * abZ) +
        (acX * acX + acY * acY + acZ * acZ) + (bcX * bcX + bcY * bcY + bcZ * bcZ);
      const float shape = twoRoots * length / edges;
      const float inverse = 1.0F / length;
      const float nX = inverse * x;
      const float nY = inverse * y;
      const float nZ = inverse * z;
      const float cosine = minimumCosine(shape, widest);
      const float first =
        nX * h.directions_[0][0][t] + nY * h.directions_[0][1][t] + nZ * h.directions_[0][2][t];
      const float second =
        nX * h.directions_[1][0][t] + nY * h.directions_[1][1][t] + nZ * h.directions_[1][2][t];
      const float along = nX * axisX + nY * axisY + nZ * axisZ;
      // So that NaN is refused.
      const bool allowed =
        (shape >= kFlat) & (first > cosine) & (second > cosine) & (along > minimumAlong);
      h.normalX_[t] = nX;
      h.normalY_[t] = nY;
      h.normalZ_[t] = nZ;
      h.shape_[t] = shape;
      h.offset_[t] = inverseScale * (nX * aX + nY * aY + nZ * aZ);
      h.blocked_[t] = allowed ? 0.0F : HUGE_VALF;
    }
  }
  if (h.size_ == 3 && !h.boundary_)
  {
    const float third = h.normalX_[0] * h.oldNormals_[0][2] + h.normalY_[0] * h.oldNormals_[1][2] +
      h.normalZ_[0] * h.oldNormals_[2][2];
    h.blocked_[0] = third > minimumCosine(h.shape_[0], widest) ? h.blocked_[0] : HUGE_VALF;
  }
}

// Many small turns would add up to an upside-down triangle.
void HoleKernels::refuseOpposing(HoleCandidates& h)
{
  int at = 0;
  for (int k = 2; k < h.size_; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      for (int i = 0; i < j; ++i, ++at)
      {
        const auto opposes = [&](int node)
        {
          return h.normalX_[at] * h.originals_[0][node] + h.normalY_[at] * h.originals_[1][node] +
            h.normalZ_[at] * h.originals_[2][node] <
            0.0F;
        };
        if (opposes(i) && opposes(j) && opposes(k))
        {
          h.blocked_[at] = HUGE_VALF;
        }
      }
    }
  }
}

// Seen along the hole's normal they would lie upside down, and points would be on no side of them.
void HoleKernels::refuseReversed(HoleCandidates& h, const Vector& normal)
{
  const float x = static_cast<float>(normal.x);
  const float y = static_cast<float>(normal.y);
  const float z = static_cast<float>(normal.z);
  for (int t = 0; t < h.size_ * (h.size_ - 1) * (h.size_ - 2) / 6; ++t)
  {
    const float along = h.normalX_[t] * x + h.normalY_[t] * y + h.normalZ_[t] * z;
    h.blocked_[t] = along > 0.0F ? h.blocked_[t] : HUGE_VALF;
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::findCrossings(HoleCandidates& h, const Vector& normal)
{
  const float normalX = static_cast<float>(normal.x);
  const float normalY = static_cast<float>(normal.y);
  const float normalZ = static_cast<float>(normal.z);
  const float inverseScale = static_cast<float>(1.0 / (h.scale_ * h.scale_));
  const int last = h.size_ - 1;
  // The ends of the pairs, where the corners of the triangles were.
  auto& from = h.corners_[0];
  auto& to = h.corners_[1];
  for (int axis = 0; axis < 3; ++axis)
  {
    const float* row = h.ring_[axis];
    for (int j = 1, at = 0; j <= last; at += j, ++j)
    {
      copy<kMaximumCompared>(row, from[axis] + at);
      repeat<kMaximumCompared>(row[j], to[axis] + at);
    }
  }
  for (int begin = 0; begin < pairNumber(0, h.size_); begin += kLanes)
  {
    float edgeX[kLanes];
    float edgeY[kLanes];
    float edgeZ[kLanes];
    float left[kLanes]; // of the edge is the node: 1 or 0
    float largest[kLanes];
    UNDECIMATE_LANES
    for (int l = 0; l < kLanes; ++l)
    {
      const int t = begin + l;
      edgeX[l] = to[0][t] - from[0][t];
      edgeY[l] = to[1][t] - from[1][t];
      edgeZ[l] = to[2][t] - from[2][t];
      const float x = edgeZ[l] * from[1][t] - edgeY[l] * from[2][t];
      const float y = edgeX[l] * from[2][t] - edgeZ[l] * from[0][t];
      const float z = edgeY[l] * from[0][t] - edgeX[l] * from[1][t];
      left[l] = x * normalX + y * normalY + z * normalZ >= 0.0F ? 1.0F : 0.0F;
      largest[l] = 0.0F;
    }
    for (int k = 0; k <= last; ++k)
    {
      const float kX = h.ring_[0][k];
      const float kY = h.ring_[1][k];
      const float kZ = h.ring_[2][k];
      const float position = static_cast<float>(k);
      const float across = h.boundary_ ? 0.0F : 1.0F; // whether there are edges on the far side
      UNDECIMATE_LANES
      for (int l = 0; l < kLanes; ++l)
      {
        const int t = begin + l;
        const float x = edgeY[l] * kZ - edgeZ[l] * kY;
        const float y = edgeZ[l] * kX - edgeX[l] * kZ;
        const float z = edgeX[l] * kY - edgeY[l] * kX;
        const float square = x * x + y * y + z * z;
        const float height = from[0][t] * x + from[1][t] * y + from[2][t] * z;
        // The old edges between both ends, or those of the other side, whichever lie across from
        // the node.
        const float below = position - kPairs.first[t];
        const float above = kPairs.second[t] - position;
        const float side = (below < above ? below : above) * (left[l] + left[l] - 1.0F);
        const float quotient =
          side > 0.0F ? larger(left[l], across) * (height * height / square) : 0.0F;
        largest[l] = quotient > largest[l] ? quotient : largest[l];
      }
    }
    UNDECIMATE_LANES
    for (int l = 0; l < kLanes; ++l)
    {
      h.crossing_[begin + l] = inverseScale * largest[l];
    }
  }
  for (int j = 1; j <= last; ++j)
  {
    h.crossing_[pairNumber(j - 1, j)] = 0.0F;
  }
  if (!h.boundary_)
  {
    h.crossing_[pairNumber(0, last)] = 0.0F;
  }
}

// The lines of all pairs in the plane.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::findLines(HoleCandidates& h, const Vector& axisX, const Vector& axisY)
{
  float x[kMaximumCompared + kLanes];
  float y[kMaximumCompared + kLanes];
  for (int begin = 0; begin < h.size_; begin += kLanes)
  {
    for (int i = begin; i < begin + kLanes; ++i)
    {
      x[i] = static_cast<float>(
        h.places_[0][i] * axisX.x + h.places_[1][i] * axisX.y + h.places_[2][i] * axisX.z);
      y[i] = static_cast<float>(
        h.places_[0][i] * axisY.x + h.places_[1][i] * axisY.y + h.places_[2][i] * axisY.z);
    }
  }
  for (int j = 1, at = 0; j < h.size_; at += j, ++j)
  {
    const float toX = x[j];
    const float toY = y[j];
    for (int begin = 0; begin < j; begin += kLanes)
    {
      for (int i = begin; i < begin + kLanes; ++i)
      {
        const float dx = toX - x[i];
        const float dy = toY - y[i];
        h.lineX_[at + i] = dx;
        h.lineY_[at + i] = dy;
        h.lineOffset_[at + i] = dx * y[i] - dy * x[i];
      }
    }
  }
}

// Few points: one at a time, and triangles side by side.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::measureFew(
  HoleCandidates& h, const PointRows& points, const float* x, const float* y, int count)
{
  const int last = h.size_ - 1;
  float sides[kFewPoints][kMaximumPairs + kLanes];
  for (int s = 0; s < count; ++s)
  {
    const float atX = x[s];
    const float atY = y[s];
    for (int begin = 0; begin < pairNumber(0, h.size_); begin += kLanes)
    {
      for (int p = begin; p < begin + kLanes; ++p)
      {
        sides[s][p] = h.lineX_[p] * atY - h.lineY_[p] * atX - h.lineOffset_[p];
      }
    }
    for (int j = 1; j <= last; ++j)
    {
      sides[s][pairNumber(j - 1, j)] = 0.0F;
    }
    sides[s][pairNumber(0, last)] = 0.0F;
  }
  int at = 0;
  for (int k = 2; k <= last; ++k)
  {
    for (int j = 1; j < k; at += j, ++j)
    {
      for (int begin = 0; begin < j; begin += kLanes)
      {
        float* largest = h.square_ + at + begin;
        for (int s = 0; s < count; ++s)
        {
          const float* rowJ = sides[s] + pairNumber(begin, j);
          const float* rowK = sides[s] + pairNumber(begin, k);
          const float jk = sides[s][pairNumber(j, k)];
          UNDECIMATE_LANES
          for (int l = 0; l < kLanes; ++l)
          {
            const int t = at + begin + l;
            const float height = h.normalX_[t] * points.x[s] + h.normalY_[t] * points.y[s] +
              h.normalZ_[t] * points.z[s] - h.offset_[t];
            const float least = rowJ[l] < jk ? rowJ[l] : jk;
            const float inside = least < -rowK[l] ? least : -rowK[l];
            const float square = inside >= 0.0F ? height * height : 0.0F;
            const float before = s == 0 ? 0.0F : largest[l];
            largest[l] = before > square ? before : square;
          }
        }
      }
    }
  }
}

// Many points: side by side, and one triangle at a time.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::measureMany(HoleCandidates& h, const PointRows& points,
  const float* __restrict__ x, const float* __restrict__ y, bool first)
{
  const int last = h.size_ - 1;
  const auto sideRow = [&h](int i, int j)
  { return h.sides_.data() + std::size_t{ 1 } * kChunk * pairNumber(i, j); };
  for (int j = 1; j <= last; ++j)
  {
    for (int i = 0; i < j; ++i)
    {
      // On the line of an edge of the outline: inside on either side.
      const bool outline = j == i + 1 || (i == 0 && j == last);
      const int pair = pairNumber(i, j);
      float* __restrict__ row = sideRow(i, j);
      const float dx = outline ? 0.0F : h.lineX_[pair];
      const float dy = outline ? 0.0F : h.lineY_[pair];
      const float offset = outline ? 0.0F : h.lineOffset_[pair];
      for (int begin = 0; begin < points.size; begin += kRowBlock)
      {
        for (int s = begin; s < begin + kRowBlock; ++s)
        {
          row[s] = dx * y[s] - dy * x[s] - offset;
        }
      }
    }
  }
  int t = 0;
  for (int k = 2; k <= last; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      const float* jk = sideRow(j, k);
      for (int i = 0; i < j; ++i, ++t)
      {
        if (h.blocked_[t] != 0.0F)
        {
          continue;
        }
        const float* ij = sideRow(i, j);
        const float* ik = sideRow(i, k);
        const float nx = h.normalX_[t];
        const float ny = h.normalY_[t];
        const float nz = h.normalZ_[t];
        const float offset = h.offset_[t];
        float largest[kRowBlock] = {};
        for (int begin = 0; begin < points.size; begin += kRowBlock)
        {
          for (int l = 0; l < kRowBlock; ++l)
          {
            const int s = begin + l;
            const float height = nx * points.x[s] + ny * points.y[s] + nz * points.z[s] - offset;
            const float least = ij[s] < jk[s] ? ij[s] : jk[s];
            const float inside = least < -ik[s] ? least : -ik[s];
            const float square = inside >= 0.0F ? height * height : 0.0F;
            largest[l] = largest[l] > square ? largest[l] : square;
          }
        }
        float square = first ? 0.0F : h.square_[t];
        for (const float one : largest)
        {
          square = larger(square, one);
        }
        h.square_[t] = square;
      }
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::weigh(HoleCandidates& h, float scale, float shapeWeight)
{
  int at = 0;
  for (int k = 2; k < h.size_; ++k)
  {
    for (int j = 1; j < k; at += j, ++j)
    {
      const float jk = h.crossing_[pairNumber(j, k)];
      for (int begin = 0; begin < j; begin += kLanes)
      {
        const float* rowJ = h.crossing_ + pairNumber(begin, j);
        const float* rowK = h.crossing_ + pairNumber(begin, k);
        UNDECIMATE_LANES
        for (int l = 0; l < kLanes; ++l)
        {
          const int t = at + begin + l;
          const float ij = rowJ[l];
          const float ik = rowK[l];
          const float over = h.square_[t];
          const float edge = ij > ik ? ij : ik;
          const float inside = over > jk ? over : jk;
          const float shape = shapeWeight * (1.0F - h.shape_[t]);
          const float square = scale * (edge > inside ? edge : inside) + shape * shape;
          h.cost_[t] = square * square + h.blocked_[t];
        }
      }
    }
  }
}

void HoleCandidates::place(const Vector* ring, int size, bool boundary)
{
  this->size_ = size;
  this->boundary_ = boundary;
  double largest = 0.0;
  for (int i = 0; i < size; ++i)
  {
    this->places_[0][i] = ring[i].x;
    this->places_[1][i] = ring[i].y;
    this->places_[2][i] = ring[i].z;
    largest = std::max(largest, dot(ring[i], ring[i]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  this->scale_ = std::ldexp(1.0, -exponent / 2);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < size; ++i)
    {
      this->ring_[axis][i] = static_cast<float>(this->scale_ * this->places_[axis][i]);
    }
  }
  HoleKernels::findOldNormals(*this);
}

void HoleCandidates::judge(const Vector* ringNormals, const Vector& normal,
  const HeightFieldDirection& heightField, Turn turn)
{
  for (int i = 0; i < this->size_; ++i)
  {
    this->originals_[0][i] = static_cast<float>(ringNormals[i].x);
    this->originals_[1][i] = static_cast<float>(ringNormals[i].y);
    this->originals_[2][i] = static_cast<float>(ringNormals[i].z);
  }
  HoleKernels::spread(*this, normal);
  HoleKernels::judge(*this, heightField,
    static_cast<float>(
      turn == Turn::Small ? FilledTriangle::kMinimumCosine : FilledTriangle::kWideCosine));
  if (turn == Turn::Wide || !HoleKernels::isSmooth(*this, normal))
  {
    HoleKernels::refuseOpposing(*this);
  }
}

void HoleCandidates::forbidEdge(int i, int j)
{
  for (int other = 0; other < this->size_; ++other)
  {
    if (other != i && other != j)
    {
      Triple t{ static_cast<unsigned char>(i), static_cast<unsigned char>(j),
        static_cast<unsigned char>(other) };
      std::sort(t.begin(), t.end());
      this->refuse(t);
    }
  }
}

void HoleCandidates::findCrossings(const Vector& normal)
{
  HoleKernels::findCrossings(*this, normal);
}

void HoleCandidates::measure(
  const PointRows& points, int count, const Vector& axisX, const Vector& axisY)
{
  HoleKernels::findLines(*this, axisX, axisY);
  std::array<float, kChunk> x;
  std::array<float, kChunk> y;
  if (count <= kFewPoints)
  {
    project(points, axisX, axisY, x.data(), y.data());
    HoleKernels::measureFew(*this, points, x.data(), y.data(), count);
    return;
  }
  const std::size_t rows = pairNumber(0, this->size_);
  if (this->sides_.size() < kChunk * rows)
  {
    this->sides_.resize(kChunk * rows);
  }
  for (int first = 0; first < points.size; first += kChunk)
  {
    const PointRows chunk{ points.x + first, points.y + first, points.z + first,
      std::min(kChunk, points.size - first) };
    project(chunk, axisX, axisY, x.data(), y.data());
    HoleKernels::measureMany(*this, chunk, x.data(), y.data(), first == 0);
  }
}

// The least sum over the part of the polygon behind each pair, and the apex of the triangle there.
template <int Size>
UNDECIMATE_INLINE float HoleKernels::sumUp(
  const HoleCandidates& h, unsigned char (*apexes)[kMaximumCompared])
{
  const int last = (Size > 0 ? Size : h.size_) - 1;
  float sums[kMaximumCompared][kMaximumCompared]; // [i][k]: of the part behind the edge i, k
  for (int i = 0; i < last; ++i)
  {
    sums[i][i + 1] = 0.0F;
  }
  for (int span = 2; span <= last; ++span)
  {
    for (int i = 0; i + span <= last; ++i)
    {
      const int k = i + span;
      const float* costs = h.cost_ + k * (k - 1) * (k - 2) / 6;
      float least = HUGE_VALF;
      int apex = 0;
      for (int j = i + 1; j < k; ++j)
      {
        const float sum = sums[i][j] + sums[j][k] + costs[pairNumber(i, j)];
        apex = sum < least ? j : apex;
        least = sum < least ? sum : least;
      }
      sums[i][k] = least;
      apexes[i][k] = static_cast<unsigned char>(apex);
    }
  }
  return sums[0][last];
}

bool HoleCandidates::choose(double scale, double shapeWeight, HoleTriangulation& filling)
{
  HoleKernels::weigh(
    *this, static_cast<float>(scale), static_cast<float>(std::sqrt(scale) * shapeWeight));
  const int last = this->size_ - 1;
  unsigned char apexes[kMaximumCompared][kMaximumCompared];
  // Most holes have so many nodes: their loops are unrolled.
  const float sum = this->size_ == 5 ? HoleKernels::sumUp<5>(*this, apexes)
    : this->size_ == 6               ? HoleKernels::sumUp<6>(*this, apexes)
    : this->size_ == 7               ? HoleKernels::sumUp<7>(*this, apexes)
                                     : HoleKernels::sumUp<0>(*this, apexes);
  if (!(sum < HUGE_VALF))
  {
    return false;
  }
  filling.count = 0;
  std::array<std::array<unsigned char, 2>, kMaximumCompared> parts;
  int left = 0;
  parts[left++] = { 0, static_cast<unsigned char>(last) };
  while (left > 0)
  {
    const auto [i, k] = parts[--left];
    const unsigned char j = apexes[i][k];
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

} // namespace undecimate
