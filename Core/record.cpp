// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record.h"

#include "hole_code.h"
#include "large_array.h"
#include "record_shapes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace undecimate
{

namespace
{

// Their bits can be counted.
constexpr std::int64_t kMostLostCodes = std::numeric_limits<std::int64_t>::max() / 16;

// Whether only the last corner of a cell is empty, if any.
template <typename Corner>
bool isFace(const Corner* cell, Corner none)
{
  return std::find(cell, cell + kTriangleCorners, none) == cell + kTriangleCorners;
}

Outcome damaged(const char* array, std::int64_t entry, const char* why)
{
  return { Status::InvalidRecord,
    std::string("Record array '") + array + "' is damaged at entry " + std::to_string(entry) +
      ": " + why + "." };
}

Outcome cancelled()
{
  return { Status::Cancelled, "Cancelled." };
}

Outcome checkPresence(const RecordView& record, const Index* baseCells)
{
  struct Array
  {
    const void* values;
    std::int64_t size;
    const char* name;
  };
  const bool hasLostList = record.hasSources && !record.hasCodes;
  const Array arrays[] = { { record.nodeOrder, record.nodeCount, "NodeOrder" },
    { record.cellOrder, record.stepsOrderCells() ? 0 : record.cellCount, "CellOrder" },
    { record.stepErrors, record.stepCount, "StepErrors" },
    { record.patches, record.hasCodes ? 0 : record.patchSize, "Patches" },
    { record.stepHoles, record.hasCodes ? record.stepCount : 0, "StepHoles" },
    { record.codes, record.hasCodes ? 1 : 0, "HoleCodes" },
    { record.stepShapes, record.hasCodes ? 0 : record.stepCount, "StepShapes" },
    { record.shapeOffsets, record.hasCodes ? 0 : 1, "ShapeOffsets" },
    { record.shapes, record.hasCodes ? 0 : record.shapeCount, "Shapes" },
    { record.baseSources, record.hasSources ? record.baseCellCount : 0, "BaseSources" },
    { record.lostSources, hasLostList ? record.lostSourceSize : 0, "LostSources" },
    { record.lostSourceCodes, record.stepsOrderCells() ? 1 : 0, "LostSources" },
    { baseCells, record.baseCellCount, "cells of the coarse mesh" } };
  for (const Array& array : arrays)
  {
    if (!array.values && array.size > 0)
    {
      return { Status::InvalidRecord,
        std::string("Record array '") + array.name + "' is missing." };
    }
  }
  return {};
}

Outcome checkPermutation(
  const Index* order, Index count, const char* name, const MonitorShare& progress)
{
  std::vector<bool> seen(count, false);
  for (Index i = 0; i < count; ++i)
  {
    if (!progress.updateAt(i, count))
    {
      return cancelled();
    }
    if (order[i] < 0 || order[i] >= count || seen[order[i]])
    {
      return damaged(name, i, "not a permutation");
    }
    seen[order[i]] = true;
  }
  return {};
}

// A shape may only use local numbers that the cursor will have filled when it needs them, in both
// directions.
Outcome checkShape(const RecordView& record, Index shape)
{
  const Index begin = record.shapeOffsets[shape];
  const Index end = record.shapeOffsets[shape + 1];
  if (end - begin < 3)
  {
    return damaged("ShapeOffsets", shape, "shape too short");
  }
  const unsigned char* bytes = record.shapes + begin;
  const int oldCount = bytes[0];
  const int newCount = bytes[1];
  const int extra = bytes[2];
  const int corners = record.cornersPerCell;
  const Index size = 3 + corners * (oldCount + newCount) + (record.hasSources ? newCount : 0);
  const int mostNew = corners == kTriangleCorners ? oldCount - 1 : oldCount;
  if (end - begin != size || oldCount < 1 || oldCount > kMaximumPatchCells || newCount > mostNew)
  {
    return damaged("Shapes", begin, "wrong counts");
  }
  const unsigned char* oldCells = bytes + 3;
  const unsigned char* newCells = oldCells + corners * oldCount;
  std::array<bool, kMaximumLocals> inOld{};
  std::array<bool, kMaximumLocals> inNew{};
  const bool mixed = corners == kMostCorners;
  for (int i = 0; mixed && i < oldCount + newCount; ++i)
  {
    if (!isFace(oldCells + corners * i, kNoLocal))
    {
      return damaged("Shapes", begin + 3 + corners * i, "a cell of fewer than three corners");
    }
  }
  int largest = 0;
  for (int i = 0; i < corners * oldCount; ++i)
  {
    if (mixed && oldCells[i] == kNoLocal)
    {
      continue;
    }
    inOld[oldCells[i]] = true;
    largest = std::max<int>(largest, oldCells[i]);
  }
  for (int i = 0; i < corners * newCount; ++i)
  {
    if (mixed && newCells[i] == kNoLocal)
    {
      continue;
    }
    if (newCells[i] == 0 || !inOld[newCells[i]])
    {
      return damaged("Shapes", begin + 3 + corners * oldCount + i, "unknown local node");
    }
    inNew[newCells[i]] = true;
  }
  if (!inOld[0] || extra > largest)
  {
    return damaged("Shapes", begin, "the removed node is missing");
  }
  for (int local = 1; local <= largest; ++local)
  {
    const bool listed = local > largest - extra;
    if (!inOld[local] || inNew[local] == listed)
    {
      return damaged("Shapes", begin, "a local node is not to be found");
    }
  }
  if (record.hasSources)
  {
    const unsigned char* sources = newCells + corners * newCount;
    for (int i = 0; i < newCount; ++i)
    {
      if (sources[i] >= oldCount)
      {
        return damaged("Shapes", begin, "unknown source");
      }
    }
  }
  return {};
}

Outcome checkShapes(const RecordView& record)
{
  if (record.shapeOffsets[0] != 0)
  {
    return damaged("ShapeOffsets", 0, "must start at 0");
  }
  for (Index shape = 0; shape < record.shapeCount; ++shape)
  {
    if (record.shapeOffsets[shape + 1] < record.shapeOffsets[shape])
    {
      return damaged("ShapeOffsets", shape + 1, "decreases");
    }
  }
  for (Index shape = 0; shape < record.shapeCount; ++shape)
  {
    if (Outcome o = checkShape(record, shape); !o)
    {
      return o;
    }
  }
  return {};
}

// What the form of a step takes of the record's other arrays.
struct StepCounts
{
  int oldCount = 0;
  int newCount = 0;
  int extra = 0;
  int lostSources = 0; // of shapes, if there are sources
};

// The steps of a record with shapes, in their order; the shapes are sound.
class ShapeSteps
{
public:
  static constexpr const char* kPatches = "Patches"; // the array that has them

  explicit ShapeSteps(const RecordView& record)
    : record_(record)
  {
  }

  // The next step; its patch() and the place of that follow.
  Outcome next(StepCounts& counts)
  {
    const Index step = this->step_++;
    const Index shape = this->record_.stepShapes[step];
    if (shape < 0 || shape >= this->record_.shapeCount)
    {
      return damaged("StepShapes", step, "no such shape");
    }
    const unsigned char* bytes = this->record_.shapes + this->record_.shapeOffsets[shape];
    counts.oldCount = bytes[0];
    counts.newCount = bytes[1];
    counts.extra = bytes[2];
    if (this->record_.hasSources)
    {
      counts.lostSources = lostSourceCount(bytes, this->record_.cornersPerCell);
    }
    this->begin_ = this->end_;
    this->end_ += counts.newCount + counts.extra;
    if (this->end_ > this->record_.patchSize)
    {
      return damaged(kPatches, this->record_.patchSize, "too short");
    }
    return {};
  }

  Index patch(int i) const { return this->record_.patches[this->begin_ + i]; }
  std::int64_t entry(int i) const { return this->begin_ + i; }

  Outcome finish() const
  {
    return this->end_ == this->record_.patchSize ? Outcome{}
                                                 : damaged(kPatches, this->end_, "too long");
  }

private:
  const RecordView& record_;
  Index step_ = 0;
  std::int64_t begin_ = 0; // of the patch
  std::int64_t end_ = 0;
};

// The steps of a record with codes, which are checked on the way.
class CodeSteps
{
public:
  static constexpr const char* kPatches = "HoleCodes";

  explicit CodeSteps(const RecordView& record)
    : record_(record)
    , numberBits_(record.numberBits())
    , code_(kHoles[0], nullptr, false, 0)
  {
  }

  Outcome next(StepCounts& counts)
  {
    const HoleCounts& hole = kHoles[this->record_.stepHoles[this->step_]];
    if (hole.oldCount == 0)
    {
      return damaged("StepHoles", this->step_, "no such hole");
    }
    const bool hasSources = this->record_.hasSources;
    const std::int64_t begin = this->end_;
    this->begin_ = begin;
    this->end_ += hole.codeSize(hasSources, this->numberBits_);
    ++this->step_;
    if (this->end_ + kPackedPadding > this->record_.codeSize)
    {
      return damaged("HoleCodes", this->record_.codeSize, "too short");
    }
    this->code_ = HoleCode(hole, this->record_.codes + begin, hasSources, this->numberBits_);
    const HoleCode& code = this->code_;
    for (int i = 0; i < hole.oldCount; ++i)
    {
      if (code.corner(i) >= kTriangleCorners)
      {
        return damaged("HoleCodes", begin, "unknown corner");
      }
    }
    std::array<bool, kMaximumPolygon> gone{};
    for (int i = 0; i < hole.newCount; ++i)
    {
      const int ear = code.ear(i);
      if (ear >= hole.ringSize || gone[ear])
      {
        return damaged("HoleCodes", begin, "an ear is not in the hole");
      }
      gone[ear] = true;
    }
    for (int i = 0; hasSources && i < hole.newCount; ++i)
    {
      if (code.source(i) >= hole.oldCount)
      {
        return damaged("HoleCodes", begin, "unknown source");
      }
    }
    counts.oldCount = hole.oldCount;
    counts.newCount = hole.newCount;
    counts.extra = hole.extra;
    return {};
  }

  Index patch(int i) const { return this->code_.number(i); }
  std::int64_t entry(int /*i*/) const { return this->begin_; }

  Outcome finish() const
  {
    return this->end_ + kPackedPadding == this->record_.codeSize
      ? Outcome{}
      : damaged("HoleCodes", this->end_, "too long");
  }

private:
  const RecordView& record_;
  int numberBits_;
  HoleCode code_;
  Index step_ = 0;
  std::int64_t begin_ = 0; // of the code
  std::int64_t end_ = 0;
};

template <typename Steps>
Outcome checkSteps(const RecordView& record, const MonitorShare& progress)
{
  Steps steps(record);
  std::int64_t lost = 0;
  std::int64_t cells = record.baseCellCount;
  for (Index step = 0; step < record.stepCount; ++step)
  {
    if (!progress.updateAt(step, record.stepCount))
    {
      return cancelled();
    }
    StepCounts counts;
    if (Outcome o = steps.next(counts); !o)
    {
      return o;
    }
    std::array<Index, kMaximumPatchCells> slots;
    for (int i = 0; i < counts.newCount; ++i)
    {
      const Index slot = steps.patch(i);
      if (slot < 0 || slot >= cells)
      {
        return damaged(Steps::kPatches, steps.entry(i), "no such cell");
      }
      if (std::find(slots.begin(), slots.begin() + i, slot) != slots.begin() + i)
      {
        return damaged(Steps::kPatches, steps.entry(i), "a cell is listed twice");
      }
      slots[i] = slot;
    }
    for (int i = counts.newCount; i < counts.newCount + counts.extra; ++i)
    {
      const Index node = steps.patch(i);
      if (node < 0 || node >= record.baseNodeCount + step)
      {
        return damaged(Steps::kPatches, steps.entry(i), "no such node");
      }
    }
    cells += counts.oldCount - counts.newCount;
    lost += counts.lostSources;
    const float error = record.stepErrors[step];
    if (!(error >= 0.0F) || (step > 0 && error > record.stepErrors[step - 1]))
    {
      return damaged("StepErrors", step, "errors must not increase from step to step");
    }
  }
  if (Outcome o = steps.finish(); !o)
  {
    return o;
  }
  if (cells != record.cellCount)
  {
    return damaged(record.hasCodes ? "StepHoles" : "StepShapes", record.stepCount,
      "the steps do not lead to all cells");
  }
  if (record.hasSources && !record.hasCodes && lost != record.lostSourceSize)
  {
    return damaged("LostSources", lost, "wrong length");
  }
  return {};
}

Outcome checkSources(const Index* sources, std::int64_t count, Index cellCount, const char* name)
{
  for (std::int64_t i = 0; i < count; ++i)
  {
    if (sources[i] < 0 || sources[i] >= cellCount)
    {
      return damaged(name, i, "no such cell");
    }
  }
  return {};
}

/// The order that puts the survivors first, in their original order, and then the others in the
/// order in which they come back.
struct RecordOrder
{
  std::vector<Index> order;   // original number at each position
  LargeArray<Index> position; // and the other way round

  void set(Index count, const std::vector<Index>& comingBack)
  {
    this->order.resize(count);
    this->position.assign(count, kNone);
    Index next = count - static_cast<Index>(comingBack.size());
    for (const Index i : comingBack)
    {
      this->order[next] = i;
      this->position[i] = next++;
    }
    next = 0;
    for (Index i = 0; i < count; ++i)
    {
      if (this->position[i] == kNone)
      {
        this->order[next] = i;
        this->position[i] = next++;
      }
    }
  }
};

} // namespace

RecordView Record::view() const
{
  RecordView v;
  v.nodeCount = this->nodeCount;
  v.cellCount = this->cellCount;
  v.baseNodeCount = this->baseNodeCount;
  v.baseCellCount = this->baseCellCount;
  v.stepCount = static_cast<Index>(this->stepErrors.size());
  v.shapeCount = static_cast<Index>(this->shapeOffsets.size()) - 1;
  v.cornersPerCell = this->cornersPerCell;
  v.hasCodes = this->hasCodes;
  v.hasSources = this->hasSources;
  v.nodeOrder = this->nodeOrder.data();
  v.cellOrder = this->cellOrder.data();
  v.stepHoles = this->stepHoles.data();
  v.codes = this->codes.data();
  v.codeSize = static_cast<std::int64_t>(this->codes.size());
  v.stepShapes = this->stepShapes.data();
  v.stepErrors = this->stepErrors.data();
  v.patches = this->patches.data();
  v.patchSize = static_cast<std::int64_t>(this->patches.size());
  v.shapeOffsets = this->shapeOffsets.data();
  v.shapes = this->shapes.data();
  v.baseSources = this->baseSources.data();
  v.lostSources = this->lostSources.data();
  v.lostSourceSize = static_cast<std::int64_t>(this->lostSources.size());
  v.lostSourceCodes = this->lostSourceCodes.data();
  v.lostCodeSize = static_cast<std::int64_t>(this->lostSourceCodes.size());
  return v;
}

std::size_t Record::byteSize() const
{
  return sizeof(Index) *
    (this->nodeOrder.size() + this->cellOrder.size() + this->stepShapes.size() +
      this->patches.size() + this->shapeOffsets.size() + this->baseSources.size() +
      this->lostSources.size()) +
    sizeof(float) * this->stepErrors.size() + this->shapes.size() + this->stepHoles.size() +
    this->codes.size() + this->lostSourceCodes.size();
}

Outcome validateRecord(
  const RecordView& record, const Index* baseCells, const MonitorShare& progress)
{
  if (record.nodeCount < 0 || record.cellCount < 0 || record.baseNodeCount < 0 ||
    record.baseCellCount < 0 || record.shapeCount < 0 || record.patchSize < 0 ||
    record.lostSourceSize < 0 || record.baseCellCount > record.cellCount ||
    record.stepCount != record.nodeCount - record.baseNodeCount || record.stepCount < 0 ||
    record.cornersPerCell < kTriangleCorners || record.cornersPerCell > kMostCorners ||
    (record.hasCodes && (record.cornersPerCell != kTriangleCorners || record.codeSize < 1)) ||
    (record.stepsOrderCells() &&
      (record.lostCodeSize < kPackedPadding || record.lostCodeSize > kMostLostCodes)))
  {
    return { Status::InvalidRecord, "The record's counts contradict each other." };
  }
  if (Outcome o = checkPresence(record, baseCells); !o)
  {
    return o;
  }
  if (Outcome o =
        checkPermutation(record.nodeOrder, record.nodeCount, "NodeOrder", progress.part(0.0, 0.2));
      !o)
  {
    return o;
  }
  if (Outcome o = record.stepsOrderCells() ? Outcome{}
                                           : checkPermutation(record.cellOrder, record.cellCount,
                                               "CellOrder", progress.part(0.2, 0.5));
      !o)
  {
    return o;
  }
  if (Outcome o = record.hasCodes ? Outcome{} : checkShapes(record); !o)
  {
    return o;
  }
  const int corners = record.cornersPerCell;
  const bool mixed = corners == kMostCorners;
  for (std::int64_t i = 0; i < std::int64_t{ corners } * record.baseCellCount; ++i)
  {
    const bool none = mixed && baseCells[i] == kNone;
    if (!none && (baseCells[i] < 0 || baseCells[i] >= record.baseNodeCount))
    {
      return damaged("cells of the coarse mesh", i / corners, "no such node");
    }
    if (i % corners == 0 && mixed && !isFace(baseCells + i, kNone))
    {
      return damaged("cells of the coarse mesh", i / corners, "fewer than three corners");
    }
  }
  if (record.hasSources)
  {
    if (Outcome o =
          checkSources(record.baseSources, record.baseCellCount, record.cellCount, "BaseSources");
        !o)
    {
      return o;
    }
    if (Outcome o = checkSources(record.lostSources, record.hasCodes ? 0 : record.lostSourceSize,
          record.cellCount, "LostSources");
        !o)
    {
      return o;
    }
  }
  const MonitorShare rest = progress.part(0.5, 1.0);
  return record.hasCodes ? checkSteps<CodeSteps>(record, rest)
                         : checkSteps<ShapeSteps>(record, rest);
}

// Steps in the order of removal and in original numbers; finish() reverses and renumbers.
struct RecordBuilder::Internals
{
  Index nodeCount = 0;
  Index cellCount = 0;
  Record record;
  std::vector<Index> removedNodes;
  std::vector<Index> freedSlots; // step after step
  std::vector<Index> sources;    // current source of each slot, if tracked
  ShapeTable shapeTable;
  float largestError = 0.0F;
};

RecordBuilder::RecordBuilder(
  Index nodeCount, Index cellCount, bool trackSources, Index plannedSteps, int cornersPerCell)
  : internals_(std::make_unique<Internals>())
{
  Internals& in = *this->internals_;
  in.nodeCount = nodeCount;
  in.cellCount = cellCount;
  in.record.hasSources = trackSources;
  in.record.cornersPerCell = cornersPerCell;
  // Memory that is not used in the end is not touched either; growing lists would be copied.
  constexpr std::size_t kPatch = 4; // entries a step: that many cells, and seldom more
  const std::size_t steps = static_cast<std::size_t>(std::clamp(plannedSteps, 0, nodeCount));
  in.record.stepShapes.reserve(steps);
  in.record.stepErrors.reserve(steps);
  in.record.patches.reserve(kPatch * steps);
  in.removedNodes.reserve(steps);
  in.freedSlots.reserve(2 * steps);
  if (trackSources)
  {
    in.sources.resize(cellCount);
    for (Index i = 0; i < cellCount; ++i)
    {
      in.sources[i] = i;
    }
  }
}

RecordBuilder::~RecordBuilder() = default;

Index RecordBuilder::stepCount() const
{
  return static_cast<Index>(this->internals_->removedNodes.size());
}

double RecordBuilder::error() const
{
  return this->internals_->largestError;
}

void RecordBuilder::append(const Step& step)
{
  if (this->internals_->record.cornersPerCell == kTriangleCorners)
  {
    this->appendCells<kTriangleCorners>(step);
  }
  else
  {
    this->appendCells<kMostCorners>(step);
  }
}

template <int Corners>
void RecordBuilder::appendCells(const Step& step)
{
  Internals& in = *this->internals_;
  Record& record = in.record;
  const EncodedStep encoded = encode<Corners>(step, record.hasSources);
  if (record.hasSources)
  {
    inheritSources(
      step.sources, step.oldCount, step.newCount, step.slots, in.sources, record.lostSources);
  }
  record.stepShapes.push_back(in.shapeTable.number(encoded.shape, encoded.size, record));
  in.largestError = std::max(in.largestError, static_cast<float>(step.error));
  record.stepErrors.push_back(in.largestError);
  add(record.patches, step.slots, step.newCount);
  add(record.patches, encoded.extraNodes.data(), encoded.extra);
  in.removedNodes.push_back(step.node);
  add(in.freedSlots, step.slots + step.newCount, step.oldCount - step.newCount);
}

Record RecordBuilder::finish(
  const CornersOf& cornersOf, std::vector<Index>& baseCells, Threads* threads)
{
  Internals& in = *this->internals_;
  Record record = std::move(in.record);
  in.shapeTable.clear();
  const Index steps = static_cast<Index>(in.removedNodes.size());
  const auto run = [threads](Index count, const std::function<void(Index)>& job)
  {
    if (threads)
    {
      threads->run(count, [&job](Index i, int /*thread*/) { job(i); });
      return;
    }
    for (Index i = 0; i < count; ++i)
    {
      job(i);
    }
  };
  const auto shapeOf = [&record](Index step)
  { return record.shapes.data() + record.shapeOffsets[record.stepShapes[step]]; };
  const auto reverseChunk = [](Index* begin, int size)
  {
    std::reverse(begin, begin + size);
    return begin + size;
  };

  // Reverse the steps. A list of chunks is reversed in place: the whole, then each chunk.
  std::reverse(record.stepShapes.begin(), record.stepShapes.end());
  const auto reverseFreed = [&]
  {
    std::reverse(in.freedSlots.begin(), in.freedSlots.end());
    Index* freed = in.freedSlots.data();
    for (Index step = 0; step < steps; ++step)
    {
      const unsigned char* shape = shapeOf(step);
      freed = reverseChunk(freed, shape[0] - shape[1]);
    }
  };
  const auto reverseOthers = [&]
  {
    std::reverse(in.removedNodes.begin(), in.removedNodes.end());
    std::reverse(record.stepErrors.begin(), record.stepErrors.end());
    std::reverse(record.lostSources.begin(), record.lostSources.end());
    Index* lost = record.lostSources.data();
    for (Index step = 0; record.hasSources && step < steps; ++step)
    {
      lost = reverseChunk(lost, lostSourceCount(shapeOf(step), record.cornersPerCell));
    }
  };
  const std::function<void()> reversals[] = { reverseFreed, reverseOthers,
    [&record] { std::reverse(record.patches.begin(), record.patches.end()); } };
  run(3, [&reversals](Index i) { reversals[i](); });

  record.nodeCount = in.nodeCount;
  record.cellCount = in.cellCount;
  record.baseNodeCount = in.nodeCount - steps;
  record.baseCellCount = in.cellCount - static_cast<Index>(in.freedSlots.size());
  RecordOrder nodes;
  RecordOrder slots;
  run(2,
    [&](Index i)
    {
      i == 0 ? slots.set(in.cellCount, in.freedSlots) : nodes.set(in.nodeCount, in.removedNodes);
      release(i == 0 ? in.freedSlots : in.removedNodes);
    });
  record.nodeOrder = std::move(nodes.order);
  record.cellOrder = std::move(slots.order);

  // Renumber the patches, in blocks of steps. First where those of each block begin.
  constexpr Index kBlock = 1 << 15;
  const Index blocks = steps / kBlock + 1;
  const auto blockEnd = [steps](Index block)
  { return block < steps / kBlock ? (block + 1) * kBlock : steps; };
  std::vector<std::size_t> begins(blocks + std::size_t{ 1 }, 0);
  run(blocks,
    [&](Index block)
    {
      for (Index step = block * kBlock; step < blockEnd(block); ++step)
      {
        const unsigned char* shape = shapeOf(step);
        begins[block + std::size_t{ 1 }] += shape[1] + shape[2];
      }
    });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  run(blocks,
    [&](Index block)
    {
      Index* patch = record.patches.data() + begins[block];
      for (Index step = block * kBlock; step < blockEnd(block); ++step)
      {
        const unsigned char* shape = shapeOf(step);
        Index* extras = patch + shape[1];
        Index* end = reverseChunk(patch, shape[1] + shape[2]);
        for (; patch != extras; ++patch)
        {
          *patch = slots.position[*patch];
        }
        for (; patch != end; ++patch)
        {
          *patch = nodes.position[*patch];
        }
      }
    });
  release(slots.position);

  const std::size_t corners = record.cornersPerCell;
  baseCells.resize(corners * record.baseCellCount);
  for (Index slot = 0; slot < record.baseCellCount; ++slot)
  {
    Index* cell = baseCells.data() + corners * slot;
    cornersOf(record.cellOrder[slot], cell);
    for (std::size_t corner = 0; corner < corners; ++corner)
    {
      cell[corner] = cell[corner] == kNone ? kNone : nodes.position[cell[corner]];
    }
  }
  if (record.hasSources)
  {
    record.baseSources.resize(record.baseCellCount);
    for (Index slot = 0; slot < record.baseCellCount; ++slot)
    {
      record.baseSources[slot] = in.sources[record.cellOrder[slot]];
    }
    release(in.sources);
  }
  return record;
}

} // namespace undecimate
