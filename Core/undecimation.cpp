// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimation.h"

#include "compiler.h"
#include "guarded.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace undecimate
{

namespace
{

constexpr int kTriangleCorners = 3;
constexpr int kMixedCorners = 4;

// A shape's parts (see RecordView).
template <int Corners>
struct Shape
{
  int oldCount;
  int newCount;
  int extra;
  const unsigned char* oldCells;
  const unsigned char* newCells;
  const unsigned char* sources;

  Shape(const RecordView& record, Index step)
  {
    const unsigned char* bytes = record.shapes + record.shapeOffsets[record.stepShapes[step]];
    this->oldCount = bytes[0];
    this->newCount = bytes[1];
    this->extra = bytes[2];
    this->oldCells = bytes + 3;
    this->newCells = this->oldCells + Corners * this->oldCount;
    this->sources = this->newCells + Corners * this->newCount;
  }
};

} // namespace

Outcome Undecimation::open(const RecordView& record, const Index* baseCells, Monitor* monitor)
{
  return guarded("Not enough memory to open the record.", *this,
    [&] { return this->check(record, baseCells, MonitorShare(monitor)); });
}

// The work of open(): take the record and the cells, and walk to the finest level and back.
Outcome Undecimation::check(
  const RecordView& record, const Index* baseCells, const MonitorShare& progress)
{
  constexpr double validation = 0.3; // of the time
  if (Outcome o = validateRecord(record, baseCells, progress.part(0.0, validation)); !o)
  {
    return o;
  }
  this->cells_.resize(static_cast<std::size_t>(record.cornersPerCell) * record.cellCount);
  this->sources_.resize(record.hasSources ? record.cellCount : 0);
  this->record_ = record;
  this->standAtBase(baseCells);
  // Whether the steps fit together shows only when they are walked.
  const MonitorShare walk = progress.part(validation, 1.0);
  if (Outcome o = record.cornersPerCell == kTriangleCorners ? this->walkAll<kTriangleCorners>(walk)
                                                            : this->walkAll<kMixedCorners>(walk);
      !o)
  {
    return o;
  }
  this->standAtBase(baseCells);
  return walk.update(1.0) ? Outcome{} : Outcome{ Status::Cancelled, "Cancelled." };
}

// Undo all steps, as far as they fit together.
template <int Corners>
Outcome Undecimation::walkAll(const MonitorShare& walk)
{
  while (this->steps_ < this->record_.stepCount)
  {
    if (!walk.updateAt(this->steps_, this->record_.stepCount))
    {
      return { Status::Cancelled, "Cancelled." };
    }
    if (!this->isNextStepSound<Corners>())
    {
      return { Status::InvalidRecord,
        "Record array 'Patches' is damaged: step " + std::to_string(this->steps_) +
          " does not fit the cells of its level." };
    }
    this->refine<Corners>();
  }
  return {};
}

void Undecimation::standAtBase(const Index* baseCells)
{
  std::copy_n(baseCells,
    static_cast<std::size_t>(this->record_.cornersPerCell) * this->record_.baseCellCount,
    this->cells_.begin());
  if (this->record_.hasSources)
  {
    std::copy_n(this->record_.baseSources, this->record_.baseCellCount, this->sources_.begin());
  }
  this->steps_ = 0;
  this->cellCount_ = this->record_.baseCellCount;
  this->patchPosition_ = 0;
  this->lostPosition_ = 0;
}

// Whether all new cells of the next step agree on what node a local number is. If they do not,
// coarsen() would not undo refine(), and nodes could stay in levels that do not have them.
template <int Corners>
bool Undecimation::isNextStepSound() const
{
  const Shape<Corners> shape(this->record_, this->steps_);
  const Index* slots = this->record_.patches + this->patchPosition_;
  const Index* cells = this->cells_.data();
  Index locals[256];
  for (int i = 0; i < shape.newCount; ++i)
  {
    const Index* cell = cells + std::size_t{ Corners } * slots[i];
    for (int corner = 0; corner < Corners; ++corner)
    {
      locals[shape.newCells[Corners * i + corner]] = cell[corner];
    }
  }
  for (int i = 0; i < shape.newCount; ++i)
  {
    const Index* cell = cells + std::size_t{ Corners } * slots[i];
    for (int corner = 0; corner < Corners; ++corner)
    {
      const int local = shape.newCells[Corners * i + corner];
      if (locals[local] != cell[corner] ||
        (Corners != kTriangleCorners && (local == kNoLocal) != (cell[corner] == kNone)))
      {
        return false;
      }
    }
  }
  return true;
}

bool Undecimation::moveTo(Index steps, Monitor* monitor)
{
  const Index goal = std::clamp<Index>(steps, 0, this->record_.stepCount);
  if (!monitor)
  {
    this->walkTo(goal);
    return true;
  }
  constexpr Index pace = 1 << 14; // steps between two looks at the monitor
  const Index start = this->steps_;
  try
  {
    while (this->steps_ != goal)
    {
      if (!monitor->update(static_cast<double>(this->steps_ - start) / (goal - start)))
      {
        return false;
      }
      this->walkTo(std::clamp(goal, this->steps_ - std::min(pace, this->steps_),
        this->steps_ + std::min(pace, this->record_.stepCount - this->steps_)));
    }
    return monitor->update(1.0);
  }
  catch (...)
  {
    return false;
  }
}

void Undecimation::walkTo(Index goal)
{
  if (this->record_.cornersPerCell == kTriangleCorners)
  {
    this->walk<kTriangleCorners>(goal);
  }
  else
  {
    this->walk<kMixedCorners>(goal);
  }
}

template <int Corners>
void Undecimation::walk(Index goal)
{
  while (this->steps_ < goal)
  {
    this->refine<Corners>();
  }
  while (this->steps_ > goal)
  {
    this->coarsen<Corners>();
  }
}

Index Undecimation::stepsForLevel(double level) const
{
  if (!(level > 0.0))
  {
    return 0;
  }
  return static_cast<Index>(std::llround(std::min(level, 1.0) * this->record_.stepCount));
}

Index Undecimation::stepsForError(double error) const
{
  const float* begin = this->record_.stepErrors;
  const float* end = begin + this->record_.stepCount;
  return static_cast<Index>(
    std::partition_point(begin, end, [error](float e) { return e > error; }) - begin);
}

double Undecimation::error() const
{
  return this->steps_ < this->record_.stepCount ? this->record_.stepErrors[this->steps_] : 0.0;
}

// Bring node baseNodeCount + steps_ back: old cells take the place of the new ones.
template <int Corners>
void Undecimation::refine()
{
  const Shape<Corners> shape(this->record_, this->steps_);
  const Index* slots = this->record_.patches + this->patchPosition_;
  Index* cells = this->cells_.data();
  Index locals[256];
  locals[kNoLocal] = kNone;
  locals[0] = this->record_.baseNodeCount + this->steps_;
  int largest = 0;
  for (int i = 0; i < shape.newCount; ++i)
  {
    const Index* cell = cells + std::size_t{ Corners } * slots[i];
    for (int corner = 0; corner < Corners; ++corner)
    {
      const int local = shape.newCells[Corners * i + corner];
      locals[local] = cell[corner];
      if (Corners == kTriangleCorners || local != kNoLocal)
      {
        largest = std::max(largest, local);
      }
    }
  }
  for (int i = 0; i < shape.extra; ++i)
  {
    locals[largest + 1 + i] = slots[shape.newCount + i];
  }
  for (int i = 0; i < shape.oldCount; ++i)
  {
    const Index slot = i < shape.newCount ? slots[i] : this->cellCount_ + i - shape.newCount;
    Index* cell = cells + std::size_t{ Corners } * slot;
    for (int corner = 0; corner < Corners; ++corner)
    {
      cell[corner] = locals[shape.oldCells[Corners * i + corner]];
    }
  }
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells];
    std::fill_n(old, shape.oldCount, kNone);
    for (int i = 0; i < shape.newCount; ++i)
    {
      old[shape.sources[i]] = this->sources_[slots[i]];
    }
    for (int i = 0; i < shape.oldCount; ++i)
    {
      const Index slot = i < shape.newCount ? slots[i] : this->cellCount_ + i - shape.newCount;
      this->sources_[slot] =
        old[i] != kNone ? old[i] : this->record_.lostSources[this->lostPosition_++];
    }
  }
  this->patchPosition_ += shape.newCount + shape.extra;
  this->cellCount_ += shape.oldCount - shape.newCount;
  ++this->steps_;
}

// The reverse of refine().
template <int Corners>
void Undecimation::coarsen()
{
  --this->steps_;
  const Shape<Corners> shape(this->record_, this->steps_);
  this->patchPosition_ -= shape.newCount + shape.extra;
  this->cellCount_ -= shape.oldCount - shape.newCount;
  const Index* slots = this->record_.patches + this->patchPosition_;
  Index* cells = this->cells_.data();
  Index locals[256];
  locals[kNoLocal] = kNone;
  for (int i = 0; i < shape.oldCount; ++i)
  {
    const Index slot = i < shape.newCount ? slots[i] : this->cellCount_ + i - shape.newCount;
    const Index* cell = cells + std::size_t{ Corners } * slot;
    for (int corner = 0; corner < Corners; ++corner)
    {
      locals[shape.oldCells[Corners * i + corner]] = cell[corner];
    }
  }
  for (int i = 0; i < shape.newCount; ++i)
  {
    Index* cell = cells + std::size_t{ Corners } * slots[i];
    for (int corner = 0; corner < Corners; ++corner)
    {
      cell[corner] = locals[shape.newCells[Corners * i + corner]];
    }
  }
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells];
    std::uint64_t heirs = 0;
    for (int i = 0; i < shape.oldCount; ++i)
    {
      const Index slot = i < shape.newCount ? slots[i] : this->cellCount_ + i - shape.newCount;
      old[i] = this->sources_[slot];
    }
    for (int i = 0; i < shape.newCount; ++i)
    {
      heirs |= std::uint64_t{ 1 } << shape.sources[i];
      this->sources_[slots[i]] = old[shape.sources[i]];
    }
    this->lostPosition_ -= shape.oldCount - countBits(heirs);
  }
}

} // namespace undecimate
