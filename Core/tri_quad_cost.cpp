// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tri_quad_cost.h"

#include "array_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace undecimate
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Weight of a boundary edge's plane against that of a cell as large as the edge's square.
constexpr float kBoundaryWeight = 1.0F;

// From so many removed nodes in a patch on the way back is measured. The cells of smaller ones are
// near the original ones. With 8, and only quarters of edges measured, the true error of the crash
// box (4 % of the nodes, 31 steps) is 8 % above the one that was found, with 4 and eighths 2 %, in
// 1.25 times the time. Meshes that do not move are folded less: there it costs nodes that flat
// places need (wing box at 5 % of the nodes: 0.64 instead of 0.10 % of the diagonal).
constexpr int kRemovedForFull = 4;
constexpr int kRemovedForFullAtRest = 8;

// Smaller deviations are rounding of single precision and say nothing: such nodes go in the order
// in which they come, evenly over flat places, so that fewer are left there that cannot go without
// an error (wing box at 5 % of the nodes: 0.095 % of the diagonal was estimated, now 0.010).
constexpr double kRoundingCost = 1e-6;

// So many times are cells around the original cells measured, too, before a distance counts.
constexpr int kRoundsBack = 2;

std::uint64_t lineKey(Index a, Index b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint32_t>(std::max(a, b));
}

// The corners of a cell that has some; pointers to their rows.
template <typename RowsOf>
int cornerRows(const unsigned char* cell, const float** rows, RowsOf&& rowsOf)
{
  int count = 0;
  for (int k = 0; k < kTriQuadCorners; ++k)
  {
    if (cell[k] != kNoLocal)
    {
      rows[count++] = rowsOf(cell[k]);
    }
  }
  return count;
}

} // namespace

int TriQuadPatch::newCell(int cell, unsigned char to, std::array<unsigned char, 4>& corners) const
{
  corners = this->cells[cell];
  const bool both = std::find(corners.begin(), corners.end(), to) != corners.end();
  const bool triangle = std::find(corners.begin(), corners.end(), kNoLocal) != corners.end();
  *std::find(corners.begin(), corners.end(), static_cast<unsigned char>(0)) = both ? kNoLocal : to;
  return both ? (triangle ? 0 : 3) : (triangle ? 3 : 4);
}

int TriQuadPatch::quadsLost(unsigned char to) const
{
  int lost = 0;
  for (int i = 0; i < this->cellCount; ++i)
  {
    const auto& cell = this->cells[i];
    lost += std::find(cell.begin(), cell.end(), to) != cell.end() &&
      std::find(cell.begin(), cell.end(), kNoLocal) == cell.end();
  }
  return lost;
}

bool TriQuadPatch::hasTwins(unsigned char to) const
{
  for (int i = 0; i < this->cellCount; ++i)
  {
    std::array<unsigned char, 4> cell;
    const bool stays = this->newCell(i, to, cell) != 0;
    std::sort(cell.begin(), cell.end());
    for (int j = i + 1; j < this->cellCount && stays; ++j)
    {
      std::array<unsigned char, 4> other;
      if (this->fanOf[j] != this->fanOf[i] && this->newCell(j, to, other) != 0)
      {
        std::sort(other.begin(), other.end());
        if (other == cell)
        {
          return true;
        }
      }
    }
  }
  return false;
}

TriQuadCost::TriQuadCost(const TriQuadMeshView& mesh, TriQuadTopology& topology,
  const TimeRows& positions, const TriQuadDecimationOptions& options,
  std::vector<unsigned char>& kept)
  : topology_(topology)
  , positions_(positions)
  , options_(options)
  , kept_(kept)
  , lanes_(positions.lanes())
  , moves_(positions.steps() > 1)
  , mesh_(mesh)
  , shared_(std::make_shared<Shared>())
{
  this->arrayOffsets_.push_back(0);
  const bool steer = options.criterion == TriQuadCriterion::Deviation && options.scalarWeight > 0.0;
  for (std::size_t n = 0; steer && n < options.arrays.size(); ++n)
  {
    const TimeRows& rows = *options.arrays[n].rows;
    std::array<float, kMaximumComponents> low;
    std::array<float, kMaximumComponents> high;
    low.fill(kInfinity);
    high.fill(-kInfinity);
    for (Index node = 0; node < rows.nodeCount(); ++node)
    {
      const float* row = rows.at(node);
      for (int c = 0; c < rows.components() && rows.isFinite(node); ++c, row += this->lanes_)
      {
        low[c] = std::min(low[c], *std::min_element(row, row + rows.steps()));
        high[c] = std::max(high[c], *std::max_element(row, row + rows.steps()));
      }
    }
    double square = 0.0;
    for (int c = 0; c < rows.components(); ++c)
    {
      const double size = low[c] <= high[c] ? static_cast<double>(high[c]) - low[c] : 0.0;
      square += size * size;
    }
    this->arrayScales_.push_back(
      square > 0.0 ? static_cast<float>(options.scalarWeight / std::sqrt(square)) : 0.0F);
    this->arrayOffsets_.push_back(this->arrayOffsets_.back() + rows.components());
  }
  this->laneValues_.resize(this->arrayScales_.size());

  // A cell with an undefined node cannot be measured, so it never changes.
  const auto isDefined = [&](Index node)
  {
    bool defined = positions.isFinite(node);
    for (std::size_t n = 0; n < this->arrayScales_.size(); ++n)
    {
      defined = defined && options.arrays[n].rows->isFinite(node);
    }
    return defined;
  };
  for (Index slot = 0; slot < topology.cellCount(); ++slot)
  {
    const Index* cell = topology.cell(slot);
    const bool defined = std::all_of(cell, cell + kTriQuadCorners,
      [&](Index copy) { return copy == kNone || isDefined(topology.nodeOf(copy)); });
    for (int k = 0; !defined && k < kTriQuadCorners; ++k)
    {
      if (cell[k] != kNone)
      {
        kept[topology.nodeOf(cell[k])] = 1;
      }
    }
  }

  if (options.criterion == TriQuadCriterion::Deviation)
  {
    this->shared_->firstRemoved.assign(topology.cellCount(), kNone);
    this->shared_->nextRemoved.assign(topology.copyCount(), kNone);
    this->shared_->nextOnLine.assign(topology.nodeCount(), kNone);
    this->findOriginals();
    this->nearestPlaces_.resize(this->lanes_);
    this->cellRows_.resize(std::size_t{ 3 } * (kTriQuadCorners + 1) * this->lanes_);
  }
  const std::size_t lanes = this->lanes_;
  this->relative_.resize(3 * lanes * (kMaximumRing + 1));
  this->point_.resize(3 * lanes);
  this->middle_.resize(3 * lanes);
  this->nearest_.resize(lanes);
  this->cellNearest_.resize(lanes);
  this->errors_.resize(lanes);
  this->squares_.resize(lanes);
  this->buildQuadrics();
}

// The input's cells around each node, in their order.
void TriQuadCost::findOriginals()
{
  const std::size_t corners = std::size_t{ kTriQuadCorners } * this->mesh_.cellCount;
  const Index* nodes = this->mesh_.cells;
  this->shared_->firstOriginal.assign(this->mesh_.nodeCount + 1, 0);
  for (std::size_t i = 0; i < corners; ++i)
  {
    if (nodes[i] != kNone)
    {
      ++this->shared_->firstOriginal[nodes[i]];
    }
  }
  // The ends of the lists, which become their begins while they are filled.
  std::partial_sum(this->shared_->firstOriginal.begin(), this->shared_->firstOriginal.end(),
    this->shared_->firstOriginal.begin());
  this->shared_->originalsOf.resize(this->shared_->firstOriginal.back());
  for (std::size_t i = corners; i-- > 0;)
  {
    if (nodes[i] != kNone)
    {
      this->shared_->originalsOf[--this->shared_->firstOriginal[nodes[i]]] =
        static_cast<Index>(i / kTriQuadCorners);
    }
  }
}

void TriQuadCost::buildQuadrics()
{
  const TriQuadTopology& t = this->topology_;
  this->shared_->quadrics.resize(std::size_t{ kQuadricRows } * this->lanes_ * t.nodeCount());
  std::fill(this->shared_->quadrics.begin(), this->shared_->quadrics.end(), 0.0F);
  Fan fan;
  for (Index slot = 0; slot < t.cellCount(); ++slot)
  {
    const Index* cell = t.cell(slot);
    const float* corners[kTriQuadCorners];
    float* quadrics[kTriQuadCorners];
    int count = 0;
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (cell[k] != kNone)
      {
        corners[count] = this->positions_.at(t.nodeOf(cell[k]));
        quadrics[count++] = this->quadric(t.nodeOf(cell[k]));
      }
    }
    addCellQuadrics(this->lanes_, corners, count, quadrics);
  }
  for (Index copy = 0; copy < t.copyCount(); ++copy)
  {
    if (t.kind(t.nodeOf(copy)) == TriQuadNodeKind::Interior || !t.gather(copy, fan))
    {
      continue;
    }
    for (int i = 0; i < fan.neighbourCount; ++i)
    {
      // Each edge once, with its cell.
      if (fan.edgeCells[i] != 1 || fan.neighbours[i] < copy)
      {
        continue;
      }
      for (int j = 0; j < fan.cellCount; ++j)
      {
        const Index* cell = t.cell(slotOf(fan.corners[j]));
        const float* corners[kTriQuadCorners];
        float* quadrics[kTriQuadCorners];
        int count = 0;
        int here = 0;
        int there = -1;
        for (int k = 0; k < kTriQuadCorners; ++k)
        {
          if (cell[k] != kNone)
          {
            here = cell[k] == copy ? count : here;
            there = cell[k] == fan.neighbours[i] ? count : there;
            corners[count] = this->positions_.at(t.nodeOf(cell[k]));
            quadrics[count++] = this->quadric(t.nodeOf(cell[k]));
          }
        }
        if (there >= 0)
        {
          const int edge = (here + 1) % count == there ? here : there;
          addBoundaryQuadrics(this->lanes_, corners, count, edge, kBoundaryWeight, quadrics);
          break;
        }
      }
    }
  }
}

void TriQuadCost::prefetch(Index node) const
{
  __builtin_prefetch(this->positions_.at(node));
  __builtin_prefetch(
    this->shared_->quadrics.data() + std::size_t{ kQuadricRows } * this->lanes_ * node);
}

// The cells around a node, with all its copies. False if it may not go anywhere.
bool TriQuadCost::gather(Index node, TriQuadPatch& patch)
{
  const TriQuadTopology& t = this->topology_;
  patch.node = node;
  patch.fanCount = 0;
  patch.cellCount = 0;
  patch.ringSize = 0;
  for (Index copy = node; copy != kNone; copy = t.nextCopy(copy))
  {
    if (patch.fanCount == TriQuadPatch::kMaximumFans)
    {
      return false;
    }
    Fan& fan = patch.fans[patch.fanCount];
    if (!t.gather(copy, fan) || fan.cellCount == 0 ||
      patch.cellCount + fan.cellCount > kMaximumPatchCells)
    {
      return false;
    }
    for (int i = 0; i < fan.cellCount; ++i)
    {
      patch.slots[patch.cellCount] = slotOf(fan.corners[i]);
      patch.fanOf[patch.cellCount] = static_cast<unsigned char>(patch.fanCount);
      const Index* cell = t.cell(slotOf(fan.corners[i]));
      auto& locals = patch.cells[patch.cellCount++];
      for (int k = 0; k < kTriQuadCorners; ++k)
      {
        if (cell[k] == kNone || cell[k] == copy)
        {
          locals[k] = cell[k] == kNone ? kNoLocal : 0;
          continue;
        }
        const Index other = t.nodeOf(cell[k]);
        const auto* end = patch.ring.begin() + patch.ringSize;
        const auto* found = std::find(patch.ring.cbegin(), end, other);
        if (found == end)
        {
          patch.ring[patch.ringSize++] = other;
        }
        locals[k] = static_cast<unsigned char>(found - patch.ring.cbegin() + 1);
      }
    }
    ++patch.fanCount;
  }
  if (!this->findLine(patch))
  {
    return false;
  }
  this->gatherRows(patch);
  return true;
}

void TriQuadCost::gatherRows(const TriQuadPatch& patch)
{
  const float* center = this->positions_.at(patch.node);
  std::fill_n(this->relative_.begin(), 3 * this->lanes_, 0.0F);
  for (int i = 0; i < patch.ringSize; ++i)
  {
    subtract(this->lanes_, 3, this->positions_.at(patch.ring[i]), center,
      this->relative_.data() + std::size_t{ 3 } * this->lanes_ * (i + 1));
  }
}

// The copies that lie in the cells, and their positions behind those of the ring.
void TriQuadCost::gatherRemoved(const TriQuadPatch& patch)
{
  this->removed_.clear();
  for (int i = 0; i < patch.cellCount; ++i)
  {
    for (Index copy = this->shared_->firstRemoved[patch.slots[i]]; copy != kNone;
         copy = this->shared_->nextRemoved[copy])
    {
      this->removed_.push_back({ copy, i });
    }
  }
  const std::size_t size = std::size_t{ 3 } * this->lanes_;
  const std::size_t first = patch.ringSize + 1;
  const std::size_t end = first + this->removed_.size();
  this->relative_.resize(std::max(this->relative_.size(), size * end));
  for (std::size_t place = first; place < end; ++place)
  {
    subtract(this->lanes_, 3,
      this->positions_.at(this->topology_.nodeOf(this->removed_[place - first].copy)),
      this->positions_.at(patch.node), this->relative_.data() + size * place);
  }
}

// The two nodes beside it on the boundary. On a seam all sheets must have the same two.
bool TriQuadCost::findLine(TriQuadPatch& patch) const
{
  patch.line[0] = 0;
  patch.line[1] = 0;
  for (int f = 0; f < patch.fanCount; ++f)
  {
    const Fan& fan = patch.fans[f];
    if (!fan.boundary)
    {
      return patch.fanCount == 1;
    }
    unsigned char ends[2] = { 0, 0 };
    int count = 0;
    for (int i = 0; i < fan.neighbourCount; ++i)
    {
      if (fan.edgeCells[i] == 1 && count < 2)
      {
        const Index node = this->topology_.nodeOf(fan.neighbours[i]);
        ends[count++] = static_cast<unsigned char>(
          std::find(patch.ring.begin(), patch.ring.begin() + patch.ringSize, node) -
          patch.ring.begin() + 1);
      }
    }
    if (count != 2 || ends[0] == ends[1])
    {
      return false;
    }
    if (f == 0)
    {
      patch.line[0] = ends[0];
      patch.line[1] = ends[1];
    }
    else if (std::minmax(ends[0], ends[1]) != std::minmax(patch.line[0], patch.line[1]))
    {
      return false;
    }
  }
  return true;
}

// The neighbours, best first by the quadrics.
void TriQuadCost::rankTargets(const TriQuadPatch& patch)
{
  this->targetCount_ = 0;
  const float* own = this->quadric(patch.node);
  const auto add = [&](unsigned char local)
  {
    const Index node = patch.ring[local - 1];
    if (this->topology_.kind(node) == TriQuadNodeKind::Irregular)
    {
      return;
    }
    float* squares = this->squares_.data();
    quadricValues(this->lanes_, own, this->position(local), squares);
    const float* other = this->quadric(node);
    const int lanes = this->lanes_;
    const bool distance = this->options_.criterion == TriQuadCriterion::Quadrics;
    for (int i = 0; i < lanes; ++i)
    {
      squares[i] += other[9 * lanes + i];
    }
    double rank = this->combine(squares);
    if (distance && this->options_.quadWeight > 0.0)
    {
      rank += this->options_.quadWeight * patch.quadsLost(local);
    }
    this->targets_[this->targetCount_++] = { local, rank };
  };
  if (patch.line[0] != 0)
  {
    add(patch.line[0]);
    add(patch.line[1]);
  }
  else
  {
    const Fan& fan = patch.fans[0];
    for (int i = 0; i < fan.neighbourCount; ++i)
    {
      const Index node = this->topology_.nodeOf(fan.neighbours[i]);
      add(static_cast<unsigned char>(
        std::find(patch.ring.begin(), patch.ring.begin() + patch.ringSize, node) -
        patch.ring.begin() + 1));
    }
  }
  std::stable_sort(this->targets_.begin(), this->targets_.begin() + this->targetCount_,
    [](const Target& a, const Target& b) { return a.rank < b.rank; });
}

double TriQuadCost::combine(const float* squares) const
{
  const int steps = this->positions_.steps();
  if (this->options_.timeError == TimeError::Maximum)
  {
    return std::sqrt(largest(this->lanes_, squares));
  }
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
  {
    sum += squares[i];
  }
  return std::sqrt(sum / steps);
}

bool TriQuadCost::mayGo(TriQuadPatch& patch, unsigned char target)
{
  const Index node = patch.ring[target - 1];
  for (int f = 0; f < patch.fanCount; ++f)
  {
    const Fan& fan = patch.fans[f];
    Index copy = kNone;
    for (int i = 0; i < fan.neighbourCount && copy == kNone; ++i)
    {
      if (this->topology_.nodeOf(fan.neighbours[i]) == node)
      {
        copy = fan.neighbours[i];
      }
    }
    const auto* end = patch.targetCopies.begin() + f;
    if (copy == kNone || std::find(patch.targetCopies.cbegin(), end, copy) != end ||
      !this->topology_.mayCollapse(fan, copy))
    {
      return false;
    }
    patch.targetCopies[f] = copy;
  }
  return patch.fanCount == 1 || !patch.hasTwins(target);
}

// Call use(old corners, their number, new corners, their number) for the cells that stay, as long
// as it returns true.
template <typename Use>
bool TriQuadCost::forChangedCells(const TriQuadPatch& patch, unsigned char target, Use&& use) const
{
  const auto rowsOf = [this](unsigned char local) { return this->position(local); };
  for (int i = 0; i < patch.cellCount; ++i)
  {
    std::array<unsigned char, 4> cell;
    if (patch.newCell(i, target, cell) == 0)
    {
      continue;
    }
    const float* before[kTriQuadCorners];
    const float* now[kTriQuadCorners];
    const int beforeCount = cornerRows(patch.cells[i].data(), before, rowsOf);
    const int nowCount = cornerRows(cell.data(), now, rowsOf);
    if (!use(before, beforeCount, now, nowCount))
    {
      return false;
    }
  }
  return true;
}

bool TriQuadCost::keepsCells(const TriQuadPatch& patch, unsigned char target) const
{
  return this->forChangedCells(patch, target,
    [this](const float* const* before, int beforeCount, const float* const* now, int nowCount)
    { return mayReplaceCell(this->lanes_, before, beforeCount, now, nowCount); });
}

// What the cells that fold count joins squares_.
void TriQuadCost::measureFolds(const TriQuadPatch& patch, unsigned char target)
{
  this->forChangedCells(patch, target,
    [this](const float* const* before, int beforeCount, const float* const* now, int nowCount)
    {
      raiseByFolds(this->lanes_, before, beforeCount, now, nowCount, this->squares_.data());
      return true;
    });
}

// What the folds in squares_ count becomes part of the quadrics' cost: a distance, weighted as the
// planes are.
void TriQuadCost::addQuadrics(const TriQuadPatch& patch, unsigned char target)
{
  const int lanes = this->lanes_;
  const float* own = this->quadric(patch.node);
  const float* other = this->quadric(patch.ring[target - 1]);
  quadricValues(lanes, own, this->position(target), this->errors_.data());
  for (int i = 0; i < lanes; ++i)
  {
    const float weight = own[kQuadricWeight * lanes + i] + other[kQuadricWeight * lanes + i];
    this->squares_[i] = weight * this->squares_[i] + this->errors_[i] + other[9 * lanes + i];
  }
}

// The neighbours that the topology allows, the one with the smallest folds first.
void TriQuadCost::rankFolds(TriQuadPatch& patch)
{
  int count = 0;
  for (int i = 0; i < this->targetCount_; ++i)
  {
    const unsigned char target = this->targets_[i].local;
    if (this->mayGo(patch, target))
    {
      std::fill(this->squares_.begin(), this->squares_.end(), 0.0F);
      this->measureFolds(patch, target);
      if (this->options_.criterion == TriQuadCriterion::Quadrics)
      {
        this->addQuadrics(patch, target);
      }
      const double rank =
        this->combine(this->squares_.data()) + this->options_.quadWeight * patch.quadsLost(target);
      this->targets_[count++] = { target, rank };
    }
  }
  this->targetCount_ = count;
  std::stable_sort(this->targets_.begin(), this->targets_.begin() + count,
    [](const Target& a, const Target& b) { return a.rank < b.rank; });
}

void TriQuadCost::Triangles::clear()
{
  this->corners.clear();
  this->firsts.assign(1, 0);
  this->ready.clear();
  this->centerCount = 0;
}

const float* TriQuadCost::cornerPosition(const Triangles& triangles, int corner) const
{
  return corner < kCenters
    ? this->position(corner)
    : triangles.centers.data() + std::size_t{ 3 } * this->lanes_ * (corner - kCenters);
}

void TriQuadCost::addCell(const unsigned char* cell, Triangles& triangles)
{
  int corners[kTriQuadCorners];
  int count = 0;
  for (int k = 0; k < kTriQuadCorners; ++k)
  {
    if (cell[k] != kNoLocal)
    {
      corners[count++] = cell[k];
    }
  }
  if (count == 3)
  {
    triangles.corners.push_back({ corners[0], corners[1], corners[2] });
  }
  else if (count == 4)
  {
    const int number = triangles.centerCount++;
    for (int k = 0; k < 4; ++k)
    {
      triangles.corners.push_back({ corners[k], corners[(k + 1) % 4], kCenters + number });
    }
  }
  triangles.firsts.push_back(static_cast<int>(triangles.corners.size()));
  triangles.ready.push_back(false);
}

// The triangles of a cell, prepared for distances. Many cells are never asked for.
const float* TriQuadCost::preparedCell(Triangles& triangles, int cell)
{
  const std::size_t lanes = this->lanes_;
  const std::size_t begin = triangles.firsts[cell];
  const std::size_t end = triangles.firsts[cell + 1];
  if (triangles.ready[cell])
  {
    return triangles.prepared.data() + kTriangleRows * lanes * begin;
  }
  triangles.ready[cell] = true;
  if (end - begin == kTriQuadCorners)
  {
    const std::size_t number = triangles.corners[begin][2] - kCenters;
    int corners[kTriQuadCorners];
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      corners[k] = triangles.corners[begin + k][0];
    }
    triangles.centers.resize(std::max(triangles.centers.size(), 3 * lanes * (number + 1)));
    center(this->lanes_, 3, this->position(corners[0]), this->position(corners[1]),
      this->position(corners[2]), this->position(corners[3]),
      triangles.centers.data() + 3 * lanes * number);
    const std::size_t rows = this->arrayOffsets_.back();
    triangles.centerValues.resize(
      std::max(triangles.centerValues.size(), rows * lanes * (number + 1)));
    for (std::size_t n = 0; n < this->arrayScales_.size(); ++n)
    {
      const auto valuesOf = [&](int k) { return this->cornerValues(triangles, corners[k], n); };
      center(this->lanes_, this->arrayOffsets_[n + 1] - this->arrayOffsets_[n], valuesOf(0),
        valuesOf(1), valuesOf(2), valuesOf(3),
        triangles.centerValues.data() + lanes * (rows * number + this->arrayOffsets_[n]));
    }
  }
  triangles.prepared.resize(
    std::max(triangles.prepared.size(), kTriangleRows * lanes * triangles.corners.size()));
  for (std::size_t t = begin; t < end; ++t)
  {
    const auto& c = triangles.corners[t];
    prepareTriangle(this->lanes_, this->cornerPosition(triangles, c[0]),
      this->cornerPosition(triangles, c[1]), this->cornerPosition(triangles, c[2]),
      triangles.prepared.data() + kTriangleRows * lanes * t);
  }
  return triangles.prepared.data() + kTriangleRows * lanes * begin;
}

const float* TriQuadCost::cornerValues(
  const Triangles& triangles, int corner, std::size_t array) const
{
  const std::size_t lanes = this->lanes_;
  if (corner >= kCenters)
  {
    return triangles.centerValues.data() +
      lanes *
      (this->arrayOffsets_.back() * static_cast<std::size_t>(corner - kCenters) +
        this->arrayOffsets_[array]);
  }
  const Index node = corner == 0 ? this->patch_->node : this->patch_->ring[corner - 1];
  return this->options_.arrays[array].rows->at(node);
}

// The distance of a point to some cells joins squares_, as far as it is larger there. Begin with
// the cell that is probably near it.
void TriQuadCost::measurePoint(
  Triangles& triangles, int beginCell, int endCell, int firstCell, const float* point)
{
  const int lanes = this->lanes_;
  float* nearest = this->nearest_.data();
  std::fill_n(nearest, lanes, kInfinity);
  for (int i = beginCell - 1; i < endCell; ++i)
  {
    const int cell = i < beginCell ? firstCell : i;
    const int count = triangles.firsts[cell + 1] - triangles.firsts[cell];
    if (count == 0 || i == firstCell)
    {
      continue;
    }
    minimumDistances(lanes, this->preparedCell(triangles, cell), count, point, nearest);
    if (isAtMost(lanes, nearest, this->squares_.data()))
    {
      return;
    }
  }
  raise(lanes, nearest, this->squares_.data());
}

// The distance of a removed node to some new cells and the error of the arrays there join squares_.
void TriQuadCost::measureNode(int beginCell, int endCell, const float* point, Index node)
{
  const int lanes = this->lanes_;
  Triangles& triangles = this->newTriangles_;
  float* nearest = this->nearest_.data();
  std::fill_n(nearest, lanes, kInfinity);
  for (int cell = beginCell; cell < endCell; ++cell)
  {
    const float* prepared = this->preparedCell(triangles, cell);
    for (int t = triangles.firsts[cell]; t < triangles.firsts[cell + 1]; ++t)
    {
      for (std::size_t n = 0; n < this->laneValues_.size(); ++n)
      {
        LaneValues& values = this->laneValues_[n];
        for (int k = 0; k < 3; ++k)
        {
          values.corners[k] = this->cornerValues(triangles, triangles.corners[t][k], n);
        }
        values.point = this->options_.arrays[n].rows->at(node);
        values.components = this->options_.arrays[n].rows->components();
        values.scale = this->arrayScales_[n];
      }
      minimumDistances(lanes, prepared, point, this->laneValues_.data(),
        static_cast<int>(this->laneValues_.size()), nearest, this->errors_.data());
      prepared += std::size_t{ kTriangleRows } * lanes;
    }
  }
  raise(lanes, nearest, this->squares_.data());
  raise(lanes, this->errors_.data(), this->squares_.data());
}

// The new cell that is nearest to a point over all steps.
int TriQuadCost::homeOf(int beginCell, int endCell, const float* point)
{
  const int lanes = this->lanes_;
  int home = beginCell;
  float homeSquare = kInfinity;
  for (int cell = beginCell; cell < endCell; ++cell)
  {
    const int count = this->newTriangles_.firsts[cell + 1] - this->newTriangles_.firsts[cell];
    if (count == 0)
    {
      continue;
    }
    std::fill_n(this->cellNearest_.data(), lanes, kInfinity);
    minimumDistances(lanes, this->preparedCell(this->newTriangles_, cell), count, point,
      this->cellNearest_.data());
    const float square = largest(lanes, this->cellNearest_.data());
    if (square < homeSquare)
    {
      homeSquare = square;
      home = cell;
    }
  }
  return home;
}

// The slot beyond the edge that is left of a fan of one triangle.
Index TriQuadCost::cellBehind(const TriQuadPatch& patch, int fan, unsigned char target) const
{
  const TriQuadTopology& t = this->topology_;
  const Fan& f = patch.fans[fan];
  const Index slot = slotOf(f.corners[0]);
  const Index* cell = t.cell(slot);
  Index behind = kNone;
  for (int k = 0; k < kTriQuadCorners; ++k)
  {
    const Index third = cell[k];
    if (third != kNone && third != f.copy && t.nodeOf(third) != patch.ring[target - 1])
    {
      behind = t.cellAcross(patch.targetCopies[fan], third, slot);
    }
  }
  return behind;
}

TriQuadCost::NewCells TriQuadCost::newCellsOf(const TriQuadPatch& patch, int fan) const
{
  NewCells cells{ 0, 0, false };
  while (patch.fanOf[cells.begin] != fan)
  {
    ++cells.begin;
  }
  cells.end = cells.begin;
  while (cells.end < patch.cellCount && patch.fanOf[cells.end] == fan)
  {
    ++cells.end;
  }
  cells.vanish = this->newTriangles_.firsts[cells.begin] == this->newTriangles_.firsts[cells.end];
  return cells;
}

// The node and those removed from its cells, to the new cells of their fans.
void TriQuadCost::measureRemoved(const TriQuadPatch& patch, unsigned char target)
{
  const int lanes = this->lanes_;
  const float* edge[2] = { this->position(target),
    this->position(patch.line[0] == target ? patch.line[1] : patch.line[0]) };
  std::size_t next = 0; // of removed_, which are in the order of the cells
  for (int fan = 0; fan < patch.fanCount; ++fan)
  {
    const NewCells cells = this->newCellsOf(patch, fan);
    const auto measureOne = [&](const float* point, int firstCell, Index node)
    {
      if (cells.vanish)
      {
        maximumDistanceToEdge(lanes, edge[0], edge[1], point, this->squares_.data());
      }
      else if (!this->laneValues_.empty())
      {
        this->measureNode(cells.begin, cells.end, point, node);
      }
      else
      {
        this->measurePoint(this->newTriangles_, cells.begin, cells.end, firstCell, point);
      }
    };
    measureOne(this->position(0), cells.begin, patch.node);
    for (; next < this->removed_.size() && this->removed_[next].cell < cells.end; ++next)
    {
      if (this->isTooFar())
      {
        return;
      }
      measureOne(this->position(patch.ringSize + 1 + static_cast<int>(next)),
        this->removed_[next].cell, this->topology_.nodeOf(this->removed_[next].copy));
    }
  }
}

void TriQuadCost::findHomes(TriQuadPatch& patch)
{
  this->estimated_ = nullptr;
  this->patch_ = &patch;
  this->gatherRows(patch);
  this->gatherRemoved(patch);
  this->addNewCells(patch, patch.target);
  patch.homes.clear();
  std::size_t next = 0;
  for (int fan = 0; fan < patch.fanCount; ++fan)
  {
    const NewCells cells = this->newCellsOf(patch, fan);
    const Index behind = cells.vanish ? this->cellBehind(patch, fan, patch.target) : kNone;
    const auto homeOfCopy = [&](const float* point)
    { return cells.vanish ? behind : patch.slots[this->homeOf(cells.begin, cells.end, point)]; };
    patch.homes.push_back({ patch.fans[fan].copy, homeOfCopy(this->position(0)) });
    for (; next < this->removed_.size() && this->removed_[next].cell < cells.end; ++next)
    {
      patch.homes.push_back({ this->removed_[next].copy,
        homeOfCopy(this->position(patch.ringSize + 1 + static_cast<int>(next))) });
    }
  }
}

// Call use(other, fan's first cell, and the end) for each edge from the target that no cell has
// yet.
template <typename Use>
void TriQuadCost::forNewEdges(const TriQuadPatch& patch, unsigned char target, Use&& use) const
{
  int begin = 0;
  for (int f = 0; f < patch.fanCount; ++f)
  {
    int end = begin;
    while (end < patch.cellCount && patch.fanOf[end] == f)
    {
      ++end;
    }
    const Fan& fan = patch.fans[f];
    for (int i = 0; i < fan.neighbourCount; ++i)
    {
      const Index node = this->topology_.nodeOf(fan.neighbours[i]);
      const auto other = static_cast<unsigned char>(
        std::find(patch.ring.begin(), patch.ring.begin() + patch.ringSize, node) -
        patch.ring.begin() + 1);
      bool isNew = other != target;
      for (int c = begin; c < end && isNew; ++c)
      {
        std::array<unsigned char, 4> cell;
        const auto& old = patch.cells[c];
        isNew = patch.newCell(c, target, cell) != 0 ||
          std::find(old.begin(), old.end(), other) == old.end();
      }
      if (isNew)
      {
        use(other, begin, end);
      }
    }
    begin = end;
  }
}

// The middles of new edges to the old cells: what the removed nodes do not see, such as a ridge
// that flips.
void TriQuadCost::measureNewEdges(const TriQuadPatch& patch, unsigned char target)
{
  this->forNewEdges(patch, target,
    [&](unsigned char other, int begin, int end)
    {
      middle(this->lanes_, this->position(target), this->position(other), this->point_.data());
      int first = begin;
      while (std::find(patch.cells[first].begin(), patch.cells[first].end(), other) ==
        patch.cells[first].end())
      {
        ++first;
      }
      this->measurePoint(this->oldTriangles_, begin, end, first, this->point_.data());
    });
}

// The node of a row of relative_.
Index TriQuadCost::nodeOfPlace(int place) const
{
  const TriQuadPatch& patch = *this->patch_;
  if (place <= patch.ringSize)
  {
    return place == 0 ? patch.node : patch.ring[place - 1];
  }
  return this->topology_.nodeOf(this->removed_[place - patch.ringSize - 1].copy);
}

// The number of one of the input's cells in originals_.
int TriQuadCost::originalNumber(Index cell)
{
  auto& all = this->originals_;
  int& slot = this->originalSlots_[cell % this->originalSlots_.size()];
  if (slot >= static_cast<int>(all.size()) || all[slot].cell != cell)
  {
    const auto found =
      std::find_if(all.begin(), all.end(), [cell](const Original& o) { return o.cell == cell; });
    slot = static_cast<int>(found - all.begin());
    if (found == all.end())
    {
      all.push_back({ cell, 0, false });
    }
  }
  return slot;
}

// The input's cells around a node join nearestOriginals_.
void TriQuadCost::addOriginals(Index node)
{
  const auto end = node == kNone ? 0 : this->shared_->firstOriginal[node + 1];
  for (Index k = node == kNone ? 0 : this->shared_->firstOriginal[node]; k < end; ++k)
  {
    const int number = this->originalNumber(this->shared_->originalsOf[k]);
    if (this->originals_[number].sample != this->sample_)
    {
      this->originals_[number].sample = this->sample_;
      this->nearestOriginals_.push_back(number);
    }
  }
}

// The distance of a point to the original cells around the nodes that are nearest to it at some
// step joins squares_; where it counts, to those around these, too.
void TriQuadCost::measureSampleBack(const float* point)
{
  if (this->isTooFar())
  {
    return;
  }
  const int lanes = this->lanes_;
  const int places = this->patch_->ringSize + 1 + static_cast<int>(this->removed_.size());
  nearestPoints(lanes, this->relative_.data(), places, point, this->nearestPlaces_.data());
  ++this->sample_;
  this->nearestOriginals_.clear();
  for (auto place = this->nearestPlaces_.begin(); place != this->nearestPlaces_.end(); ++place)
  {
    if (std::find(this->nearestPlaces_.begin(), place, *place) != place)
    {
      continue;
    }
    this->addOriginals(this->nodeOfPlace(*place));
  }
  std::fill_n(this->nearest_.data(), lanes, kInfinity);
  std::size_t measured = 0;
  for (int round = 0; round <= kRoundsBack; ++round)
  {
    const std::size_t count = this->nearestOriginals_.size();
    for (std::size_t i = measured; i < count; ++i)
    {
      this->measureOriginal(this->nearestOriginals_[i], point);
      if (isAtMost(lanes, this->nearest_.data(), this->squares_.data()))
      {
        return;
      }
    }
    if (round == kRoundsBack ||
      largest(lanes, this->nearest_.data()) <= largest(lanes, this->squares_.data()))
    {
      break;
    }
    // The nodes nearest to it may have gone from cells of other patches.
    for (std::size_t i = measured; i < count; ++i)
    {
      const Index* nodes = this->mesh_.cells +
        std::size_t{ kTriQuadCorners } * this->originals_[this->nearestOriginals_[i]].cell;
      std::for_each(
        nodes, nodes + kTriQuadCorners, [this](Index node) { this->addOriginals(node); });
    }
    measured = count;
  }
  raise(lanes, this->nearest_.data(), this->squares_.data());
}

// The distance of a point to one of originals_ joins nearest_.
void TriQuadCost::measureOriginal(int number, const float* point)
{
  const auto lanes = static_cast<std::size_t>(this->lanes_);
  const std::size_t size = lanes * kTriangleRows * kTriQuadCorners;
  Original& original = this->originals_[number];
  const Index* nodes = this->mesh_.cells + std::size_t{ kTriQuadCorners } * original.cell;
  const int triangles = nodes[kTriQuadCorners - 1] == kNone ? 1 : kTriQuadCorners;
  if (!original.ready)
  {
    original.ready = true;
    this->preparedRows_.resize(std::max(this->preparedRows_.size(), size * (number + 1)));
    const float* rows[kTriQuadCorners + 1];
    const int count = triangles == 1 ? 3 : kTriQuadCorners;
    for (int k = 0; k < count; ++k)
    {
      float* row = this->cellRows_.data() + 3 * lanes * k;
      subtract(this->lanes_, 3, this->positions_.at(nodes[k]),
        this->positions_.at(this->patch_->node), row);
      rows[k] = row;
    }
    if (count == kTriQuadCorners)
    {
      float* middle = this->cellRows_.data() + 3 * lanes * kTriQuadCorners;
      center(this->lanes_, 3, rows[0], rows[1], rows[2], rows[3], middle);
      rows[count] = middle;
    }
    for (int k = 0; k < triangles; ++k)
    {
      prepareTriangle(this->lanes_, rows[k], rows[(k + 1) % count],
        rows[count == 3 ? 2 : kTriQuadCorners],
        this->preparedRows_.data() + size * number + lanes * kTriangleRows * k);
    }
  }
  minimumDistances(this->lanes_, this->preparedRows_.data() + size * number, triangles, point,
    this->nearest_.data());
}

// The distance of the new cells to the original ones joins squares_: at points of new edges and
// within the cells.
void TriQuadCost::measureBack(const TriQuadPatch& patch, unsigned char target)
{
  const int lanes = this->lanes_;
  this->forNewEdges(patch, target,
    [&](unsigned char other, int /*begin*/, int /*end*/)
    {
      middle(lanes, this->position(target), this->position(other), this->middle_.data());
      this->measureSampleBack(this->middle_.data());
      this->measureHalfwayBack(this->position(target));
      this->measureHalfwayBack(this->position(other));
      if (!this->moves_)
      {
        return;
      }
      // Most of the places where a surface is farthest are near the middle of an edge.
      for (const float fraction : { 0.375F, 0.625F })
      {
        pointBetween(
          lanes, this->position(target), this->position(other), fraction, this->point_.data());
        this->measureSampleBack(this->point_.data());
      }
    });
  for (int i = 0; i < patch.cellCount; ++i)
  {
    std::array<unsigned char, 4> cell;
    if (patch.newCell(i, target, cell) == 0)
    {
      continue;
    }
    const float* rows[kTriQuadCorners];
    const int count =
      cornerRows(cell.data(), rows, [this](unsigned char local) { return this->position(local); });
    mean(lanes, rows, count, this->middle_.data());
    this->measureSampleBack(this->middle_.data());
    for (int k = 0; k < count; ++k)
    {
      this->measureHalfwayBack(rows[k]);
    }
  }
}

// The same between middle_ and a corner.
void TriQuadCost::measureHalfwayBack(const float* corner)
{
  middle(this->lanes_, corner, this->middle_.data(), this->point_.data());
  this->measureSampleBack(this->point_.data());
}

Index TriQuadCost::firstOnLine(Index a, Index b) const
{
  const auto found = this->shared_->lines.find(lineKey(a, b));
  return found == this->shared_->lines.end() ? kNone : found->second;
}

// The nodes removed from the two edges of a boundary that become one.
void TriQuadCost::measureLine(const TriQuadPatch& patch, unsigned char target)
{
  const int lanes = this->lanes_;
  const unsigned char other = patch.line[0] == target ? patch.line[1] : patch.line[0];
  const float* a = this->position(target);
  const float* b = this->position(other);
  maximumDistanceToEdge(lanes, a, b, this->position(0), this->squares_.data());
  for (const unsigned char end : { target, other })
  {
    for (Index node = this->firstOnLine(patch.node, patch.ring[end - 1]); node != kNone;
         node = this->shared_->nextOnLine[node])
    {
      subtract(
        lanes, 3, this->positions_.at(node), this->positions_.at(patch.node), this->point_.data());
      maximumDistanceToEdge(lanes, a, b, this->point_.data(), this->squares_.data());
    }
  }
}

// Whether a target is out of the race. The sum over the steps is only known at the end.
bool TriQuadCost::isTooFar() const
{
  return this->options_.timeError == TimeError::Maximum &&
    this->limit_<kInfinity&& this->combine(this->squares_.data())> this->limit_;
}

// The criterion Deviation for one target but for the way back into squares_, as far as it is below
// limit_.
void TriQuadCost::measure(const TriQuadPatch& patch, unsigned char target)
{
  std::fill(this->squares_.begin(), this->squares_.end(), 0.0F);
  if (patch.folds)
  {
    this->measureFolds(patch, target);
  }
  if (patch.line[0] != 0)
  {
    this->measureLine(patch, target);
  }
  if (!this->isTooFar())
  {
    this->addNewCells(patch, target);
    this->measureRemoved(patch, target);
  }
  // Most edges are nearer to the old cells than the removed nodes to the new ones.
  if (!this->isTooFar())
  {
    this->measureNewEdges(patch, target);
  }
}

// The quadrics' distance for one target.
double TriQuadCost::quadricError(const TriQuadPatch& patch, unsigned char target)
{
  const int lanes = this->lanes_;
  float* squares = this->squares_.data();
  const float* own = this->quadric(patch.node);
  const float* other = this->quadric(patch.ring[target - 1]);
  quadricValues(lanes, own, this->position(target), squares);
  for (int i = 0; i < lanes; ++i)
  {
    const float weight = own[kQuadricWeight * lanes + i] + other[kQuadricWeight * lanes + i];
    squares[i] = weight > 0.0F ? (squares[i] + other[9 * lanes + i]) / weight : 0.0F;
  }
  if (patch.folds)
  {
    this->measureFolds(patch, target);
  }
  return this->combine(squares);
}

bool TriQuadCost::hasMore(const TriQuadPatch& patch) const
{
  if (this->options_.criterion != TriQuadCriterion::Deviation)
  {
    return false;
  }
  if (patch.folds)
  {
    return true;
  }
  return patch.removedCount >= (this->moves_ ? kRemovedForFull : kRemovedForFullAtRest);
}

void TriQuadCost::addOldCells(const TriQuadPatch& patch)
{
  this->oldTriangles_.clear();
  for (int i = 0; i < patch.cellCount; ++i)
  {
    this->addCell(patch.cells[i].data(), this->oldTriangles_);
  }
}

void TriQuadCost::addNewCells(const TriQuadPatch& patch, unsigned char target)
{
  this->newTriangles_.clear();
  for (int i = 0; i < patch.cellCount; ++i)
  {
    std::array<unsigned char, 4> cell;
    if (patch.newCell(i, target, cell) == 0)
    {
      cell.fill(kNoLocal);
    }
    this->addCell(cell.data(), this->newTriangles_);
  }
}

bool TriQuadCost::isAllowed(TriQuadPatch& patch, unsigned char target)
{
  return this->mayGo(patch, target) && (patch.folds || this->keepsCells(patch, target));
}

// Gather a patch and find the first target that is allowed; false if there is none.
bool TriQuadCost::findFirstTarget(Index node, TriQuadPatch& patch)
{
  this->patch_ = &patch;
  patch.folds = false;
  if (!this->gather(node, patch))
  {
    return false;
  }
  this->rankTargets(patch);
  this->firstTarget_ = 0;
  while (this->firstTarget_ < this->targetCount_ &&
    !this->isAllowed(patch, this->targets_[this->firstTarget_].local))
  {
    ++this->firstTarget_;
  }
  if (this->firstTarget_ == this->targetCount_)
  {
    this->rankFolds(patch);
    if (this->targetCount_ == 0)
    {
      return false;
    }
    this->firstTarget_ = 0;
    patch.folds = true;
  }
  patch.target = this->targets_[this->firstTarget_].local;
  patch.cost = this->targets_[this->firstTarget_].rank;
  return true;
}

bool TriQuadCost::evaluate(Index node, Effort effort, TriQuadPatch& patch)
{
  const bool full = effort == Effort::Full;
  const bool goesOn = full && this->estimated_ == &patch && patch.node == node;
  this->estimated_ = nullptr;
  if (!goesOn && !this->findFirstTarget(node, patch))
  {
    return false;
  }
  if (this->options_.criterion != TriQuadCriterion::Deviation)
  {
    patch.error = this->quadricError(patch, patch.target);
    // The copies that were found last are those of the last neighbour that was ranked.
    return !patch.folds || this->mayGo(patch, patch.target);
  }
  if (patch.folds && !full)
  {
    patch.error = patch.cost - this->options_.quadWeight * patch.quadsLost(patch.target);
    return true;
  }
  if (!goesOn)
  {
    this->originals_.clear();
    this->gatherRemoved(patch);
    patch.removedCount = static_cast<int>(this->removed_.size());
    this->addOldCells(patch);
  }
  const int wanted = full ? this->options_.candidates : 1;
  patch.cost = std::numeric_limits<double>::infinity();
  std::array<Index, TriQuadPatch::kMaximumFans> bestCopies{};
  int compared = 0;
  for (int i = this->firstTarget_; i < this->targetCount_ && compared < wanted; ++i)
  {
    const unsigned char target = this->targets_[i].local;
    // Of the first one it is known, and its copies were found.
    const bool isFirst = i == this->firstTarget_;
    if ((!isFirst || patch.folds) && !this->isAllowed(patch, target))
    {
      continue;
    }
    const double extra = this->options_.quadWeight * patch.quadsLost(target);
    this->limit_ = patch.cost - extra;
    if (isFirst && goesOn)
    {
      this->squares_ = patch.squares;
    }
    else
    {
      this->measure(patch, target);
    }
    if (full && !this->isTooFar())
    {
      this->measureBack(patch, target);
    }
    const double error = this->combine(this->squares_.data());
    if (error + extra < patch.cost)
    {
      patch.target = target;
      patch.error = error;
      patch.cost = error + extra;
      bestCopies = patch.targetCopies;
      patch.squares = this->squares_;
    }
    ++compared;
  }
  patch.targetCopies = bestCopies;
  patch.cost = std::max(patch.cost, kRoundingCost);
  // Infinite where all new cells are without area at some step.
  const bool mayGo = patch.cost < std::numeric_limits<double>::infinity();
  this->estimated_ = mayGo && !full ? &patch : nullptr;
  return mayGo;
}

void TriQuadCost::collapsed(const TriQuadPatch& patch)
{
  this->estimated_ = nullptr;
  const Index target = patch.ring[patch.target - 1];
  subtract(this->lanes_, 3, this->positions_.at(target), this->positions_.at(patch.node),
    this->point_.data());
  mergeQuadric(this->lanes_, this->quadric(patch.node), this->point_.data(), this->quadric(target));
  if (this->options_.criterion != TriQuadCriterion::Deviation)
  {
    return;
  }
  this->shared_->worst.resize(this->lanes_, 0.0F);
  raise(this->lanes_, patch.squares.data(), this->shared_->worst.data());
  for (int i = 0; i < patch.cellCount; ++i)
  {
    this->shared_->firstRemoved[patch.slots[i]] = kNone;
  }
  for (const TriQuadPatch::Home& home : patch.homes)
  {
    if (home.slot != kNone)
    {
      this->shared_->nextRemoved[home.copy] = this->shared_->firstRemoved[home.slot];
      this->shared_->firstRemoved[home.slot] = home.copy;
    }
  }
  if (patch.line[0] != 0)
  {
    // The lists of both edges and the node itself go to the new edge.
    const unsigned char end = patch.line[0] == patch.target ? patch.line[1] : patch.line[0];
    const Index other = patch.ring[end - 1];
    Index first = patch.node;
    this->shared_->nextOnLine[first] = kNone;
    for (const Index side : { target, other })
    {
      Index node = this->firstOnLine(patch.node, side);
      this->shared_->lines.erase(lineKey(patch.node, side));
      while (node != kNone)
      {
        const Index next = this->shared_->nextOnLine[node];
        this->shared_->nextOnLine[node] = first;
        first = node;
        node = next;
      }
    }
    this->shared_->lines[lineKey(target, other)] = first;
  }
}

std::vector<double> TriQuadCost::distances(const TimeRows& positions) const
{
  if (this->options_.criterion != TriQuadCriterion::Deviation)
  {
    return {};
  }
  const int lanes = positions.lanes();
  const TriQuadTopology& t = this->topology_;
  std::vector<float> largestSquares(lanes, 0.0F);
  std::vector<float> corners(std::size_t{ 5 } * 3 * lanes); // four and the center
  std::vector<float> prepared(std::size_t{ kTriangleRows } * lanes);
  std::vector<float> points;
  std::vector<float> squares;
  for (Index slot = 0; slot < t.cellCount(); ++slot)
  {
    if (this->shared_->firstRemoved[slot] == kNone)
    {
      continue;
    }
    const Index* cell = t.cell(slot);
    const float* origin = nullptr;
    const float* rows[5];
    int count = 0;
    for (int k = 0; k < kTriQuadCorners; ++k)
    {
      if (cell[k] != kNone)
      {
        const float* position = positions.at(t.nodeOf(cell[k]));
        origin = origin ? origin : position;
        float* row = corners.data() + std::size_t{ 3 } * lanes * count;
        subtract(lanes, 3, position, origin, row);
        rows[count++] = row;
      }
    }
    std::size_t samples = 0;
    for (Index copy = this->shared_->firstRemoved[slot]; copy != kNone;
         copy = this->shared_->nextRemoved[copy])
    {
      points.resize(std::max(points.size(), 3 * lanes * (samples + 1)));
      subtract(lanes, 3, positions.at(t.nodeOf(copy)), origin, points.data() + 3 * lanes * samples);
      ++samples;
    }
    squares.assign(lanes * samples, kInfinity);
    if (count == 4)
    {
      float* middle = corners.data() + std::size_t{ 12 } * lanes;
      center(lanes, 3, rows[0], rows[1], rows[2], rows[3], middle);
      rows[4] = middle;
    }
    for (int k = 0; k < (count == 4 ? 4 : 1); ++k)
    {
      prepareTriangle(
        lanes, rows[k], rows[(k + 1) % count], rows[count == 4 ? 4 : 2], prepared.data());
      for (std::size_t i = 0; i < samples; ++i)
      {
        minimumDistances(
          lanes, prepared.data(), 1, points.data() + 3 * lanes * i, squares.data() + lanes * i);
      }
    }
    for (std::size_t i = 0; i < samples; ++i)
    {
      for (int lane = 0; lane < lanes; ++lane)
      {
        const float square = squares[lanes * i + lane];
        if (square < kInfinity)
        {
          largestSquares[lane] = std::max(largestSquares[lane], square);
        }
      }
    }
  }
  std::vector<double> distances;
  distances.reserve(positions.steps());
  for (int step = 0; step < positions.steps(); ++step)
  {
    distances.push_back(std::sqrt(static_cast<double>(largestSquares[step])));
  }
  return distances;
}

std::vector<double> TriQuadCost::stepErrors() const
{
  std::vector<double> errors;
  for (int i = 0; i < this->positions_.steps() && !this->shared_->worst.empty(); ++i)
  {
    errors.push_back(std::sqrt(static_cast<double>(this->shared_->worst[i])));
  }
  return errors;
}

} // namespace undecimate
