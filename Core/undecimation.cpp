// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimation.h"

#include "compiler.h"
#include "guarded.h"
#include "hole_code.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace undecimate
{

namespace
{

constexpr int kTriangleCorners = 3;
constexpr int kMixedCorners = 4;

constexpr int kAhead = 48; // entries of patches from a step to the one whose cells are fetched

// The forms of steps (see RecordView), as the cursor reads them. Each visits the corners of its new
// and of its old cells: visit(cell, corner, local number). Number 0 is the removed node, and those
// from firstListed on are the nodes that the patch lists.

// A step that has a shape.
template <int Corners>
class ShapeStep
{
public:
  static constexpr int kCorners = Corners;

  static int codeSize(const RecordView& /*record*/, Index /*step*/) { return 0; }

  ShapeStep(const RecordView& record, Index step, std::int64_t /*codePosition*/)
  {
    const unsigned char* bytes = record.shapes + record.shapeOffsets[record.stepShapes[step]];
    this->oldCount = bytes[0];
    this->newCount = bytes[1];
    this->extra = bytes[2];
    this->oldCells_ = bytes + 3;
    this->newCells_ = this->oldCells_ + Corners * this->oldCount;
    this->sources_ = this->newCells_ + Corners * this->newCount;
  }

  int oldCount;
  int newCount;
  int extra;

  int firstListed() const
  {
    int largest = 0;
    for (int i = 0; this->extra > 0 && i < Corners * this->newCount; ++i)
    {
      const int local = this->newCells_[i];
      if (Corners == kTriangleCorners || local != kNoLocal)
      {
        largest = std::max(largest, local);
      }
    }
    return largest + 1;
  }
  template <typename Visit>
  void visitNew(Visit&& visit) const
  {
    visitCells(this->newCells_, this->newCount, visit);
  }
  template <typename Visit>
  void visitOld(Visit&& visit) const
  {
    visitCells(this->oldCells_, this->oldCount, visit);
  }
  int source(int newCell) const { return this->sources_[newCell]; }

private:
  template <typename Visit>
  static void visitCells(const unsigned char* locals, int count, Visit& visit)
  {
    for (int i = 0; i < count; ++i)
    {
      for (int corner = 0; corner < Corners; ++corner)
      {
        visit(i, corner, *locals++);
      }
    }
  }

  const unsigned char* oldCells_;
  const unsigned char* newCells_;
  const unsigned char* sources_;
};

// A step that has a code: the nodes of the ring are 1, 2, ...
class CodeStep
{
public:
  static constexpr int kCorners = kTriangleCorners;

  static int codeSize(const RecordView& record, Index step)
  {
    return kHoles[record.stepHoles[step]].codeSize(record.hasSources);
  }

  CodeStep(const RecordView& record, Index step, std::int64_t codePosition)
    : CodeStep(kHoles[record.stepHoles[step]], record.codes + codePosition)
  {
  }

  int oldCount;
  int newCount;
  int extra;

  static constexpr int firstListed() { return 1; } // only a hole without new cells lists nodes

  template <typename Visit>
  void visitNew(Visit&& visit) const
  {
    EarCutPolygon polygon(this->ringSize_);
    for (int i = 0; i < this->newCount; ++i)
    {
      polygon.cut(this->code_.ear(i),
        [&](unsigned char before, unsigned char ear, unsigned char behind)
        {
          visit(i, 0, before + 1);
          visit(i, 1, ear + 1);
          visit(i, 2, behind + 1);
        });
    }
  }
  template <typename Visit>
  void visitOld(Visit&& visit) const
  {
    static constexpr int kNext[] = { 1, 2, 0 };
    static constexpr int kPrevious[] = { 2, 0, 1 };
    for (int i = 0; i < this->oldCount; ++i)
    {
      const int corner = this->code_.corner(i);
      visit(i, corner, 0);
      visit(i, kNext[corner], i + 1);
      visit(i, kPrevious[corner], i + 1 == this->ringSize_ ? 1 : i + 2);
    }
  }
  int source(int newCell) const { return this->code_.source(newCell); }

private:
  CodeStep(const HoleCounts& counts, const unsigned char* code)
    : oldCount(counts.oldCount)
    , newCount(counts.newCount)
    , extra(counts.extra)
    , code_(counts, code)
    , ringSize_(counts.ringSize)
  {
  }

  HoleCode code_;
  int ringSize_;
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
  if (Outcome o = record.hasCodes ? this->walkAll<CodeStep>(walk)
        : record.cornersPerCell == kTriangleCorners
        ? this->walkAll<ShapeStep<kTriangleCorners>>(walk)
        : this->walkAll<ShapeStep<kMixedCorners>>(walk);
      !o)
  {
    return o;
  }
  this->standAtBase(baseCells);
  return walk.update(1.0) ? Outcome{} : Outcome{ Status::Cancelled, "Cancelled." };
}

// Undo all steps, as far as they fit together.
template <typename Step>
Outcome Undecimation::walkAll(const MonitorShare& walk)
{
  while (this->steps_ < this->record_.stepCount)
  {
    if (!walk.updateAt(this->steps_, this->record_.stepCount))
    {
      return { Status::Cancelled, "Cancelled." };
    }
    if (!this->isNextStepSound<Step>())
    {
      return { Status::InvalidRecord,
        "Record array 'Patches' is damaged: step " + std::to_string(this->steps_) +
          " does not fit the cells of its level." };
    }
    this->refine<Step>();
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
  this->codePosition_ = 0;
  this->lostPosition_ = 0;
}

// Whether all new cells of the next step agree on what node a local number is. If they do not,
// coarsen() would not undo refine(), and nodes could stay in levels that do not have them.
template <typename Step>
bool Undecimation::isNextStepSound() const
{
  const Step step(this->record_, this->steps_, this->codePosition_);
  const Index* slots = this->record_.patches + this->patchPosition_;
  const Index* cells = this->cells_.data();
  const auto nodeAt = [slots, cells](int cell, int corner)
  { return cells[std::size_t{ Step::kCorners } * slots[cell] + corner]; };
  Index locals[256];
  step.visitNew([&](int cell, int corner, int local) { locals[local] = nodeAt(cell, corner); });
  bool sound = true;
  step.visitNew(
    [&](int cell, int corner, int local)
    {
      const Index node = nodeAt(cell, corner);
      sound = sound && locals[local] == node &&
        (Step::kCorners == kTriangleCorners || (local == kNoLocal) == (node == kNone));
    });
  return sound;
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
  if (this->record_.hasCodes)
  {
    this->walk<CodeStep>(goal);
  }
  else if (this->record_.cornersPerCell == kTriangleCorners)
  {
    this->walk<ShapeStep<kTriangleCorners>>(goal);
  }
  else
  {
    this->walk<ShapeStep<kMixedCorners>>(goal);
  }
}

template <typename Step>
void Undecimation::walk(Index goal)
{
  while (this->steps_ < goal)
  {
    this->refine<Step>();
  }
  while (this->steps_ > goal)
  {
    this->coarsen<Step>();
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

// Steps read and write cells here and there: those of later steps are fetched meanwhile.
template <int Corners>
void Undecimation::prefetchCells(std::int64_t patchPosition, int count) const
{
  const std::int64_t begin = std::max<std::int64_t>(0, patchPosition);
  const std::int64_t end = std::min(this->record_.patchSize, patchPosition + count);
  for (std::int64_t i = begin; i < end; ++i)
  {
    prefetch(this->cells_.data() + std::ptrdiff_t{ Corners } * this->record_.patches[i]);
  }
}

// Bring node baseNodeCount + steps_ back: old cells take the place of the new ones.
template <typename Step>
void Undecimation::refine()
{
  constexpr std::size_t corners = Step::kCorners;
  const Step step(this->record_, this->steps_, this->codePosition_);
  const Index* slots = this->record_.patches + this->patchPosition_;
  this->prefetchCells<Step::kCorners>(this->patchPosition_ + kAhead, step.newCount);
  const auto slotOf = [this, slots, &step](int i)
  { return i < step.newCount ? slots[i] : this->cellCount_ + i - step.newCount; };
  Index* cells = this->cells_.data();
  Index locals[256];
  step.visitNew([&](int cell, int corner, int local)
    { locals[local] = cells[corners * slots[cell] + corner]; });
  locals[kNoLocal] = kNone;
  locals[0] = this->record_.baseNodeCount + this->steps_;
  std::copy_n(slots + step.newCount, step.extra, locals + step.firstListed());
  step.visitOld([&](int cell, int corner, int local)
    { cells[corners * slotOf(cell) + corner] = locals[local]; });
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells];
    std::fill_n(old, step.oldCount, kNone);
    for (int i = 0; i < step.newCount; ++i)
    {
      old[step.source(i)] = this->sources_[slots[i]];
    }
    for (int i = 0; i < step.oldCount; ++i)
    {
      this->sources_[slotOf(i)] =
        old[i] != kNone ? old[i] : this->record_.lostSources[this->lostPosition_++];
    }
  }
  this->patchPosition_ += step.newCount + step.extra;
  this->codePosition_ += Step::codeSize(this->record_, this->steps_);
  this->cellCount_ += step.oldCount - step.newCount;
  ++this->steps_;
}

// The reverse of refine().
template <typename Step>
void Undecimation::coarsen()
{
  constexpr std::size_t corners = Step::kCorners;
  --this->steps_;
  this->codePosition_ -= Step::codeSize(this->record_, this->steps_);
  const Step step(this->record_, this->steps_, this->codePosition_);
  this->patchPosition_ -= step.newCount + step.extra;
  this->cellCount_ -= step.oldCount - step.newCount;
  const Index* slots = this->record_.patches + this->patchPosition_;
  this->prefetchCells<Step::kCorners>(this->patchPosition_ - kAhead, step.newCount);
  const auto slotOf = [this, slots, &step](int i)
  { return i < step.newCount ? slots[i] : this->cellCount_ + i - step.newCount; };
  Index* cells = this->cells_.data();
  Index locals[256];
  step.visitOld([&](int cell, int corner, int local)
    { locals[local] = cells[corners * slotOf(cell) + corner]; });
  locals[kNoLocal] = kNone;
  step.visitNew([&](int cell, int corner, int local)
    { cells[corners * slots[cell] + corner] = locals[local]; });
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells];
    std::uint64_t heirs = 0;
    for (int i = 0; i < step.oldCount; ++i)
    {
      old[i] = this->sources_[slotOf(i)];
    }
    for (int i = 0; i < step.newCount; ++i)
    {
      heirs |= std::uint64_t{ 1 } << step.source(i);
      this->sources_[slots[i]] = old[step.source(i)];
    }
    this->lostPosition_ -= step.oldCount - countBits(heirs);
  }
}

} // namespace undecimate
