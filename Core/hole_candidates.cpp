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

constexpr double kPositions[kMaximumCompared] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14,
  15 };

/// What a row of triangles is judged by.
struct Judgement
{
  const Vector* ringNormals;
  const Vector* oldNormals;
  Vector normal;
  Vector axis;   // of a height field
  double noAxis; // 1 if it is none, else 0
};

/// The triangles of a row, as they are judged.
struct JudgedRow
{
  double x[kMaximumCompared]; // normals
  double y[kMaximumCompared];
  double z[kMaximumCompared];
  double square[kMaximumCompared]; // of these
  double minimumCosine[kMaximumCompared];
  double blocked[kMaximumCompared]; // without the fold rule
  double normalX[kMaximumCompared]; // unit
  double normalY[kMaximumCompared];
  double normalZ[kMaximumCompared];
  double offset[kMaximumCompared];
};

// As FilledTriangle::follows().
UNDECIMATE_INLINE bool follows(const JudgedRow& row, int i, const Vector& direction)
{
  const double product = row.x[i] * direction.x + row.y[i] * direction.y + row.z[i] * direction.z;
  const double cosine = row.minimumCosine[i];
  return product > 0.0 &&
    product * product > cosine * cosine * row.square[i] * dot(direction, direction);
}

UNDECIMATE_INLINE float larger(float a, float b)
{
  return a > b ? a : b;
}

} // namespace

// The loops, compiled for wider vectors as well.
struct HoleKernels
{
  static constexpr int kLanes = HoleCandidates::kLanes;

  static void findEdges(HoleCandidates& h);
  static void judge(HoleCandidates& h, const Judgement& by);
  static void findCrossings(HoleCandidates& h, const Vector& normal);
  static void findLines(HoleCandidates& h, const Vector& axisX, const Vector& axisY);
  static void measureFew(
    HoleCandidates& h, const PointRows& points, const float* x, const float* y, int count);
  static void measureMany(HoleCandidates& h, const PointRows& points, const float* __restrict__ x,
    const float* __restrict__ y, bool first);
  static void weigh(HoleCandidates& h, double scale, double shapeWeight);
};

UNDECIMATE_VECTOR_CLONES
void HoleKernels::findEdges(HoleCandidates& h)
{
  for (int j = 1; j < h.size_; ++j)
  {
    for (int begin = 0; begin < j; begin += kLanes)
    {
      for (int i = begin; i < begin + kLanes; ++i)
      {
        const double x = h.x_[j] - h.x_[i];
        const double y = h.y_[j] - h.y_[i];
        const double z = h.z_[j] - h.z_[i];
        h.edgeX_[j][i] = x;
        h.edgeY_[j][i] = y;
        h.edgeZ_[j][i] = z;
        h.edgeSquare_[j][i] = x * x + y * y + z * z;
      }
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::judge(HoleCandidates& h, const Judgement& by)
{
  constexpr double kNeedle = FilledTriangle::kNeedleShape;
  constexpr double kFlat = FilledTriangle::kMinimumShape;
  constexpr double kCosine = FilledTriangle::kMinimumCosine;
  constexpr double kStricter = FilledTriangle::kNeedleCosine - FilledTriangle::kMinimumCosine;
  constexpr double kAxis = HeightFieldDirection::kSmallest;
  const int last = h.size_ - 1;
  JudgedRow row;
  for (int k = 2; k <= last; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      const int number = HoleCandidates::rowOf(j, k);
      const bool adjacent = k == j + 1;
      const Vector direction = adjacent ? by.oldNormals[j] : by.normal;
      const double directionSquare = dot(direction, direction);
      const double edgeSquare = h.edgeSquare_[k][j];
      const Vector normalJ = by.ringNormals[j];
      const Vector normalK = by.ringNormals[k];
      for (int begin = 0; begin < j; begin += kLanes)
      {
        for (int i = begin; i < begin + kLanes; ++i)
        {
          const double abX = h.edgeX_[j][i];
          const double abY = h.edgeY_[j][i];
          const double abZ = h.edgeZ_[j][i];
          const double acX = h.edgeX_[k][i];
          const double acY = h.edgeY_[k][i];
          const double acZ = h.edgeZ_[k][i];
          const double x = abY * acZ - abZ * acY;
          const double y = abZ * acX - abX * acZ;
          const double z = abX * acY - abY * acX;
          const double square = x * x + y * y + z * z;
          const double edges = h.edgeSquare_[j][i] + h.edgeSquare_[k][i] + edgeSquare;
          const double shape = 2.0 * std::sqrt(3.0 * square) / edges;
          const bool degenerate = !(square > 0.0) | (12.0 * square < kFlat * kFlat * edges * edges);
          const bool needle = 12.0 * square < kNeedle * kNeedle * edges * edges;
          const double cosine =
            needle & !degenerate ? kCosine + kStricter * (1.0 - shape / kNeedle) : kCosine;
          // Many small turns would add up to an upside-down triangle.
          const bool opposes =
            (x * h.originalX_[i] + y * h.originalY_[i] + z * h.originalZ_[i] < 0.0) &
            (x * normalJ.x + y * normalJ.y + z * normalJ.z < 0.0) &
            (x * normalK.x + y * normalK.y + z * normalK.z < 0.0);
          const double along = x * by.axis.x + y * by.axis.y + z * by.axis.z;
          const bool down = !((along + by.noAxis > 0.0) &
            (along * along + by.noAxis > kAxis * kAxis * square * (1.0 - by.noAxis)));
          const double blocked = degenerate | opposes | down ? HUGE_VAL : 0.0;
          const double product = x * direction.x + y * direction.y + z * direction.z;
          const bool turned =
            !((product > 0.0) & (product * product > cosine * cosine * square * directionSquare));
          const double inverse = 1.0 / std::sqrt(square);
          const double normalX = inverse * x;
          const double normalY = inverse * y;
          const double normalZ = inverse * z;
          row.x[i] = x;
          row.y[i] = y;
          row.z[i] = z;
          row.square[i] = square;
          row.minimumCosine[i] = cosine;
          row.blocked[i] = blocked;
          h.blocked_[number][i] = turned ? HUGE_VAL : blocked;
          h.shape_[number][i] = shape;
          row.normalX[i] = normalX;
          row.normalY[i] = normalY;
          row.normalZ[i] = normalZ;
          row.offset[i] = normalX * h.x_[i] + normalY * h.y_[i] + normalZ * h.z_[i];
        }
        for (int i = begin; i < begin + kLanes; ++i)
        {
          h.normalX_[number][i] = static_cast<float>(row.normalX[i]);
          h.normalY_[number][i] = static_cast<float>(row.normalY[i]);
          h.normalZ_[number][i] = static_cast<float>(row.normalZ[i]);
          h.offset_[number][i] = static_cast<float>(row.offset[i]);
        }
      }
      // The two triangles that have a ring edge besides the row's.
      const auto followToo = [&](int i, int edge, bool onRing)
      {
        if (!follows(row, i, by.oldNormals[edge]))
        {
          h.blocked_[number][i] = HUGE_VAL;
        }
        else if (!onRing)
        {
          h.blocked_[number][i] = row.blocked[i];
        }
      };
      followToo(j - 1, j - 1, adjacent);
      if (k == last && !h.boundary_)
      {
        followToo(0, last, adjacent || j == 1);
      }
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::findCrossings(HoleCandidates& h, const Vector& normal)
{
  const double across = h.boundary_ ? 0.0 : 1.0; // whether there are edges on the node's far side
  for (int j = 2; j < h.size_; ++j)
  {
    const int width = (j + kLanes - 2) / kLanes * kLanes;
    double largest[kMaximumCompared];
    double left[kMaximumCompared]; // of the edge is the node: 1 or 0
    for (int i = 0; i < width; ++i)
    {
      const double x = h.edgeZ_[j][i] * h.y_[i] - h.edgeY_[j][i] * h.z_[i];
      const double y = h.edgeX_[j][i] * h.z_[i] - h.edgeZ_[j][i] * h.x_[i];
      const double z = h.edgeY_[j][i] * h.x_[i] - h.edgeX_[j][i] * h.y_[i];
      left[i] = x * normal.x + y * normal.y + z * normal.z >= 0.0 ? 1.0 : 0.0;
      largest[i] = 0.0;
    }
    for (int k = 0; k < h.size_; ++k)
    {
      if (k == j)
      {
        continue;
      }
      const double inside = k < j ? 1.0 : 0.0;
      const double kX = h.x_[k];
      const double kY = h.y_[k];
      const double kZ = h.z_[k];
      const double position = k;
      for (int i = 0; i < width; ++i)
      {
        const double x = h.edgeY_[j][i] * kZ - h.edgeZ_[j][i] * kY;
        const double y = h.edgeZ_[j][i] * kX - h.edgeX_[j][i] * kZ;
        const double z = h.edgeX_[j][i] * kY - h.edgeY_[j][i] * kX;
        const double square = x * x + y * y + z * z;
        const double height = h.x_[i] * x + h.y_[i] * y + h.z_[i] * z;
        // The old edges between i and j, or those of the other side, whichever lie across from the
        // node.
        const double between = kPositions[i] < position ? inside : 0.0;
        const double beyond = kPositions[i] == position ? 0.0 : across * (1.0 - between);
        const double crossed = left[i] > 0.0 ? between : beyond;
        const double heightSquare = height * height * crossed;
        largest[i] = heightSquare > largest[i] * square ? heightSquare / square : largest[i];
      }
    }
    for (int i = 0; i < width; ++i)
    {
      h.crossing_[j][i] = static_cast<float>(largest[i]);
    }
    h.crossing_[j][j - 1] = 0.0F;
  }
  h.crossing_[1][0] = 0.0F;
  if (!h.boundary_)
  {
    h.crossing_[h.size_ - 1][0] = 0.0F;
  }
}

// The lines of all pairs in the plane.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::findLines(HoleCandidates& h, const Vector& axisX, const Vector& axisY)
{
  const int last = h.size_ - 1;
  float x[kMaximumCompared];
  float y[kMaximumCompared];
  for (int begin = 0; begin <= last; begin += kLanes)
  {
    for (int i = begin; i < begin + kLanes; ++i)
    {
      x[i] = static_cast<float>(h.x_[i] * axisX.x + h.y_[i] * axisX.y + h.z_[i] * axisX.z);
      y[i] = static_cast<float>(h.x_[i] * axisY.x + h.y_[i] * axisY.y + h.z_[i] * axisY.z);
    }
  }
  for (int j = 1; j <= last; ++j)
  {
    for (int begin = 0; begin < j; begin += kLanes)
    {
      for (int i = begin; i < begin + kLanes; ++i)
      {
        const float dx = x[j] - x[i];
        const float dy = y[j] - y[i];
        h.lineX_[j][i] = dx;
        h.lineY_[j][i] = dy;
        h.lineOffset_[j][i] = dx * y[i] - dy * x[i];
      }
    }
  }
}

// Few points: one at a time, and the triangles of a row side by side.
UNDECIMATE_VECTOR_CLONES
void HoleKernels::measureFew(
  HoleCandidates& h, const PointRows& points, const float* x, const float* y, int count)
{
  const int last = h.size_ - 1;
  for (int s = 0; s < count; ++s)
  {
    const float atX = x[s];
    const float atY = y[s];
    const float pX = points.x[s];
    const float pY = points.y[s];
    const float pZ = points.z[s];
    float sides[kMaximumCompared][kMaximumCompared]; // as the pairs
    for (int j = 1; j <= last; ++j)
    {
      for (int begin = 0; begin < j; begin += kLanes)
      {
        for (int i = begin; i < begin + kLanes; ++i)
        {
          sides[j][i] = h.lineX_[j][i] * atY - h.lineY_[j][i] * atX - h.lineOffset_[j][i];
        }
      }
      sides[j][j - 1] = 0.0F;
    }
    sides[last][0] = 0.0F;
    for (int k = 2; k <= last; ++k)
    {
      for (int j = 1; j < k; ++j)
      {
        const int number = HoleCandidates::rowOf(j, k);
        const float jk = sides[k][j];
        for (int begin = 0; begin < j; begin += kLanes)
        {
          for (int i = begin; i < begin + kLanes; ++i)
          {
            const float height = h.normalX_[number][i] * pX + h.normalY_[number][i] * pY +
              h.normalZ_[number][i] * pZ - h.offset_[number][i];
            const float ij = sides[j][i];
            const float least = ij < jk ? ij : jk;
            const float ik = -sides[k][i];
            const float inside = least < ik ? least : ik;
            const float square = inside >= 0.0F ? height * height : 0.0F;
            const float before = s == 0 ? 0.0F : h.square_[number][i];
            h.square_[number][i] = before > square ? before : square;
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
      float* __restrict__ row = sideRow(i, j);
      const float dx = outline ? 0.0F : h.lineX_[j][i];
      const float dy = outline ? 0.0F : h.lineY_[j][i];
      const float offset = outline ? 0.0F : h.lineOffset_[j][i];
      for (int begin = 0; begin < points.size; begin += kRowBlock)
      {
        for (int s = begin; s < begin + kRowBlock; ++s)
        {
          row[s] = dx * y[s] - dy * x[s] - offset;
        }
      }
    }
  }
  for (int k = 2; k <= last; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      const int number = HoleCandidates::rowOf(j, k);
      const float* jk = sideRow(j, k);
      for (int i = 0; i < j; ++i)
      {
        if (h.blocked_[number][i] != 0.0)
        {
          continue;
        }
        const float* ij = sideRow(i, j);
        const float* ik = sideRow(i, k);
        const float nx = h.normalX_[number][i];
        const float ny = h.normalY_[number][i];
        const float nz = h.normalZ_[number][i];
        const float offset = h.offset_[number][i];
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
        float square = first ? 0.0F : h.square_[number][i];
        for (const float one : largest)
        {
          square = larger(square, one);
        }
        h.square_[number][i] = square;
      }
    }
  }
}

UNDECIMATE_VECTOR_CLONES
void HoleKernels::weigh(HoleCandidates& h, double scale, double shapeWeight)
{
  for (int k = 2; k < h.size_; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      const int number = HoleCandidates::rowOf(j, k);
      const float jk = h.crossing_[k][j];
      for (int begin = 0; begin < j; begin += kLanes)
      {
        for (int i = begin; i < begin + kLanes; ++i)
        {
          const float ij = h.crossing_[j][i];
          const float ik = h.crossing_[k][i];
          float largest = h.square_[number][i];
          largest = largest > ij ? largest : ij;
          largest = largest > ik ? largest : ik;
          largest = largest > jk ? largest : jk;
          const double shape = shapeWeight * (1.0 - h.shape_[number][i]);
          const double square = scale * (static_cast<double>(largest) + shape * shape);
          h.cost_[number][i] = square * square + h.blocked_[number][i];
        }
      }
    }
  }
}

void HoleCandidates::place(const Vector* ring, int size, bool boundary)
{
  this->size_ = size;
  this->boundary_ = boundary;
  for (int i = 0; i < size; ++i)
  {
    this->x_[i] = ring[i].x;
    this->y_[i] = ring[i].y;
    this->z_[i] = ring[i].z;
  }
  HoleKernels::findEdges(*this);
}

void HoleCandidates::judge(const Vector* ringNormals, const Vector* oldNormals,
  const Vector& normal, const HeightFieldDirection& heightField)
{
  for (int i = 0; i < this->size_; ++i)
  {
    this->originalX_[i] = ringNormals[i].x;
    this->originalY_[i] = ringNormals[i].y;
    this->originalZ_[i] = ringNormals[i].z;
  }
  HoleKernels::judge(*this,
    { ringNormals, oldNormals, normal, heightField.direction(), heightField.known() ? 0.0 : 1.0 });
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

bool HoleCandidates::choose(double scale, double shapeWeight, HoleTriangulation& filling)
{
  HoleKernels::weigh(*this, scale, shapeWeight);
  const int last = this->size_ - 1;
  double sums[kMaximumCompared][kMaximumCompared]; // [i][k]: of the part behind the edge i, k
  unsigned char apexes[kMaximumCompared][kMaximumCompared];
  for (int i = 0; i < last; ++i)
  {
    sums[i][i + 1] = 0.0;
  }
  for (int span = 2; span <= last; ++span)
  {
    for (int i = 0; i + span <= last; ++i)
    {
      const int k = i + span;
      double least = HUGE_VAL;
      int apex = 0;
      for (int j = i + 1; j < k; ++j)
      {
        const double sum = sums[i][j] + sums[j][k] + this->cost_[rowOf(j, k)][i];
        apex = sum < least ? j : apex;
        least = sum < least ? sum : least;
      }
      sums[i][k] = least;
      apexes[i][k] = static_cast<unsigned char>(apex);
    }
  }
  if (!(sums[0][last] < HUGE_VAL))
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
