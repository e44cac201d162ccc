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

// Steps (see RecordView), as the cursor reads them. Each visits the corners of its new and of its
// old cells: visit(cell, corner, local number). Number 0 is the removed node, and those from
// firstListed on are the nodes that the patch lists. patch(i) are the slots of the new cells and
// then these nodes.

// A step that has a shape.
template <int Corners>
class ShapeStep
{
public:
  static constexpr int kCorners = Corners;

  // How far it is to the next step.
  static int size(const RecordView& record, Index step, int /*numberBits*/)
  {
    const unsigned char* bytes = shapeOf(record, step);
    return bytes[1] + bytes[2];
  }

  ShapeStep(const RecordView& record, Index step, std::int64_t position, int /*numberBits*/)
    : patch_(record.patches + position)
  {
    const unsigned char* bytes = shapeOf(record, step);
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
  Index patch(int i) const { return this->patch_[i]; }

  // The sources of old cells that have no heirs, in `old`, where the others are. How far it is to
  // those of the next step.
  int readLost(
    const RecordView& record, std::int64_t position, int /*numberBits*/, Index* old) const
  {
    const KnownSources known = this->heirs();
    int lost = 0;
    for (int i = 0; i < this->oldCount; ++i)
    {
      if (!known.has(i))
      {
        old[i] = record.lostSources[position + lost++];
      }
    }
    return lost;
  }
  int lostSize(const Index* /*old*/, int /*numberBits*/) const
  {
    return this->oldCount - this->heirs().count();
  }
  // Checked by validateRecord().
  static bool isLostSound(
    const RecordView& /*record*/, std::int64_t /*position*/, int /*numberBits*/, Index* /*old*/)
  {
    return true;
  }
  static bool isLostEnd(const RecordView& /*record*/, std::int64_t /*position*/) { return true; }

private:
  KnownSources heirs() const
  {
    return KnownSources(
      this->newCount, this->oldCount, [this](int i) { return this->sources_[i]; });
  }
  static const unsigned char* shapeOf(const RecordView& record, Index step)
  {
    return record.shapes + record.shapeOffsets[record.stepShapes[step]];
  }
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

  const Index* patch_;
  const unsigned char* oldCells_;
  const unsigned char* newCells_;
  const unsigned char* sources_;
};

// A step that has a code: the nodes of the ring are 1, 2, ...
class CodeStep
{
public:
  static constexpr int kCorners = kTriangleCorners;

  static int size(const RecordView& record, Index step, int numberBits)
  {
    return kHoles[record.stepHoles[step]].codeSize(record.hasSources, numberBits);
  }

  CodeStep(const RecordView& record, Index step, std::int64_t position, int numberBits)
    : CodeStep(kHoles[record.stepHoles[step]],
        HoleCode(
          kHoles[record.stepHoles[step]], record.codes + position, record.hasSources, numberBits))
  {
  }

  int oldCount;
  int newCount;
  int extra;

  // Whether nothing but the padding is behind a position.
  static bool isLostEnd(const RecordView& record, std::int64_t position)
  {
    return !record.hasSources || packedSize(position) == record.lostCodeSize;
  }

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
  Index patch(int i) const { return this->code_.number(i); }

  int readLost(const RecordView& record, std::int64_t position, int numberBits, Index* old) const
  {
    const std::int64_t begin = position;
    KnownSources known = this->heirs();
    for (int i = 0; i < this->oldCount; ++i)
    {
      if (!known.has(i))
      {
        const LostSource lost(record, position, this->placeBits_, numberBits);
        old[i] = lost.place < 0 ? lost.cell : old[lost.place];
        known.add(i);
        position += lost.size;
      }
    }
    return static_cast<int>(position - begin);
  }
  int lostSize(const Index* old, int numberBits) const
  {
    int size = 0;
    KnownSources known = this->heirs();
    for (int i = 0; i < this->oldCount; ++i)
    {
      if (!known.has(i))
      {
        size += 1 + (known.placeOf(old[i], old) < 0 ? numberBits : this->placeBits_);
        known.add(i);
      }
    }
    return size;
  }

  // Whether what readLost() would read is what a writer would have written: then lostSize() is
  // what readLost() returns.
  bool isLostSound(
    const RecordView& record, std::int64_t position, int numberBits, Index* old) const
  {
    KnownSources known = this->heirs();
    for (int i = 0; i < this->oldCount; ++i)
    {
      if (known.has(i))
      {
        continue;
      }
      const std::int64_t end = (record.lostCodeSize - kPackedPadding) * 8;
      if (position + 1 >= end)
      {
        return false;
      }
      const LostSource lost(record, position, this->placeBits_, numberBits);
      position += lost.size;
      if (position > end ||
        (lost.place < 0 ? lost.cell >= record.cellCount || known.placeOf(lost.cell, old) >= 0
                        : lost.place >= this->oldCount || !known.has(lost.place)))
      {
        return false;
      }
      old[i] = lost.place < 0 ? lost.cell : old[lost.place];
      known.add(i);
    }
    return true;
  }

private:
  struct LostSource
  {
    int place = -1; // of an old cell that shows the same, if there is one
    Index cell = kNone;
    int size = 0; // in bits

    LostSource(const RecordView& record, std::int64_t position, int placeBits, int numberBits)
    {
      const bool isPlace = packedBits(record.lostSourceCodes, position, 1) != 0;
      const int bits = isPlace ? placeBits : numberBits;
      const auto number =
        static_cast<Index>(packedBits(record.lostSourceCodes, position + 1, bits));
      (isPlace ? this->place : this->cell) = number;
      this->size = 1 + bits;
    }
  };

  KnownSources heirs() const
  {
    return KnownSources(
      this->newCount, this->oldCount, [this](int i) { return this->code_.source(i); });
  }

  CodeStep(const HoleCounts& counts, const HoleCode& code)
    : oldCount(counts.oldCount)
    , newCount(counts.newCount)
    , extra(counts.extra)
    , code_(code)
    , ringSize_(counts.ringSize)
    , placeBits_(counts.placeBits)
  {
  }

  HoleCode code_;
  int ringSize_;
  int placeBits_;
};

} // namespace

// Steps read and write cells here and there: a scout that goes some steps ahead fetches them.
template <typename Step>
class Undecimation::Scout
{
public:
  Scout(const Undecimation& cursor, Index goal)
    : cursor_(cursor)
    , goal_(goal)
    , step_(cursor.steps_)
    , position_(cursor.position_)
  {
    for (int i = 0; i < kAhead; ++i)
    {
      this->advance();
    }
  }

  // One step, unless it is there.
  void advance()
  {
    const RecordView& record = this->cursor_.record_;
    const int bits = this->cursor_.numberBits_;
    if (this->step_ < this->goal_)
    {
      this->fetch();
      this->position_ += Step::size(record, this->step_++, bits);
    }
    else if (this->step_ > this->goal_)
    {
      this->position_ -= Step::size(record, --this->step_, bits);
      this->fetch();
    }
  }

private:
  static constexpr int kAhead = 12;

  void fetch() const
  {
    const Step step(this->cursor_.record_, this->step_, this->position_, this->cursor_.numberBits_);
    for (int i = 0; i < step.newCount; ++i)
    {
      prefetch(this->cursor_.cells_.data() + std::ptrdiff_t{ Step::kCorners } * step.patch(i));
    }
  }

  const Undecimation& cursor_;
  Index goal_;
  Index step_;
  std::int64_t position_;
};

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
  this->numberBits_ = record.numberBits();
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
  Scout<Step> scout(*this, this->record_.stepCount);
  while (this->steps_ < this->record_.stepCount)
  {
    if (!walk.updateAt(this->steps_, this->record_.stepCount))
    {
      return { Status::Cancelled, "Cancelled." };
    }
    if (!this->isNextStepSound<Step>())
    {
      return { Status::InvalidRecord,
        std::string("Record array '") + (this->record_.hasCodes ? "HoleCodes" : "Patches") +
          "' is damaged: step " + std::to_string(this->steps_) +
          " does not fit the cells of its level." };
    }
    if (this->record_.hasSources && !this->areNextSourcesSound<Step>())
    {
      return { Status::InvalidRecord,
        "Record array 'LostSources' is damaged, or 'BaseSources' or 'HoleCodes': step " +
          std::to_string(this->steps_) + " does not fit the values that its level shows." };
    }
    scout.advance();
    this->refine<Step>();
  }
  if (!Step::isLostEnd(this->record_, this->lostPosition_))
  {
    return { Status::InvalidRecord, "Record array 'LostSources' is damaged: too long." };
  }
  if (!this->showsAllCells())
  {
    return { Status::InvalidRecord,
      "Record array 'LostSources' is damaged, or 'BaseSources' or 'CellOrder': "
      "at level 1 not every cell shows its own values." };
  }
  return {};
}

// At level 1 each cell has its own source.
bool Undecimation::showsAllCells() const
{
  const bool hasOrder = !this->record_.stepsOrderCells();
  std::vector<bool> seen(this->sources_.size(), false);
  for (std::size_t slot = 0; slot < this->sources_.size(); ++slot)
  {
    const Index cell = this->sources_[slot];
    if (seen[cell] || (hasOrder && this->record_.cellOrder[slot] != cell))
    {
      return false;
    }
    seen[cell] = true;
  }
  return true;
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
  this->position_ = 0;
  this->lostPosition_ = 0;
}

// Whether all new cells of the next step agree on what node a local number is. If they do not,
// coarsen() would not undo refine(), and nodes could stay in levels that do not have them.
template <typename Step>
bool Undecimation::isNextStepSound() const
{
  const Step step(this->record_, this->steps_, this->position_, this->numberBits_);
  const Index* cells = this->cells_.data();
  const auto nodeAt = [&step, cells](int cell, int corner)
  { return cells[std::size_t{ Step::kCorners } * step.patch(cell) + corner]; };
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

// Whether the sources of the next step are such that coarsen() undoes refine(): new cells with the
// same source show the same, and those that are lost take the room that coarsen() will give back.
template <typename Step>
bool Undecimation::areNextSourcesSound() const
{
  const Step step(this->record_, this->steps_, this->position_, this->numberBits_);
  Index old[kMaximumPatchCells];
  std::fill_n(old, step.oldCount, kNone);
  for (int i = 0; i < step.newCount; ++i)
  {
    Index& source = old[step.source(i)];
    const Index shown = this->sources_[step.patch(i)];
    if (source != kNone && source != shown)
    {
      return false;
    }
    source = shown;
  }
  return step.isLostSound(this->record_, this->lostPosition_, this->numberBits_, old);
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
  Scout<Step> scout(*this, goal);
  while (this->steps_ < goal)
  {
    scout.advance();
    this->refine<Step>();
  }
  while (this->steps_ > goal)
  {
    scout.advance();
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

// Slots of a step's old cells; cellCount_ is that of the coarser level.
template <typename Step>
void Undecimation::findSlots(const Step& step, Index* slots) const
{
  for (int i = 0; i < step.newCount; ++i)
  {
    slots[i] = step.patch(i);
  }
  for (int i = step.newCount; i < step.oldCount; ++i)
  {
    slots[i] = this->cellCount_ + i - step.newCount;
  }
}

// Bring node baseNodeCount + steps_ back: old cells take the place of the new ones.
template <typename Step>
void Undecimation::refine()
{
  constexpr std::size_t corners = Step::kCorners;
  const Step step(this->record_, this->steps_, this->position_, this->numberBits_);
  Index slots[kMaximumPatchCells] = {};
  this->findSlots(step, slots);
  Index* cells = this->cells_.data();
  Index locals[256];
  step.visitNew([&](int cell, int corner, int local)
    { locals[local] = cells[corners * slots[cell] + corner]; });
  locals[kNoLocal] = kNone;
  locals[0] = this->record_.baseNodeCount + this->steps_;
  const int firstListed = step.firstListed();
  for (int i = 0; i < step.extra; ++i)
  {
    locals[firstListed + i] = step.patch(step.newCount + i);
  }
  step.visitOld(
    [&](int cell, int corner, int local)
    {
      // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): each is new, listed, or the node
      cells[corners * slots[cell] + corner] = locals[local];
    });
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells] = {};
    for (int i = 0; i < step.newCount; ++i)
    {
      old[step.source(i)] = this->sources_[slots[i]];
    }
    this->lostPosition_ +=
      step.readLost(this->record_, this->lostPosition_, this->numberBits_, old);
    for (int i = 0; i < step.oldCount; ++i)
    {
      this->sources_[slots[i]] = old[i];
    }
  }
  this->position_ += Step::size(this->record_, this->steps_, this->numberBits_);
  this->cellCount_ += step.oldCount - step.newCount;
  ++this->steps_;
}

// The reverse of refine().
template <typename Step>
void Undecimation::coarsen()
{
  constexpr std::size_t corners = Step::kCorners;
  --this->steps_;
  this->position_ -= Step::size(this->record_, this->steps_, this->numberBits_);
  const Step step(this->record_, this->steps_, this->position_, this->numberBits_);
  this->cellCount_ -= step.oldCount - step.newCount;
  Index slots[kMaximumPatchCells] = {};
  this->findSlots(step, slots);
  Index* cells = this->cells_.data();
  Index locals[256];
  step.visitOld([&](int cell, int corner, int local)
    { locals[local] = cells[corners * slots[cell] + corner]; });
  locals[kNoLocal] = kNone;
  step.visitNew([&](int cell, int corner, int local)
    { cells[corners * slots[cell] + corner] = locals[local]; });
  if (this->record_.hasSources)
  {
    Index old[kMaximumPatchCells] = {};
    for (int i = 0; i < step.oldCount; ++i)
    {
      old[i] = this->sources_[slots[i]];
    }
    this->lostPosition_ -= step.lostSize(old, this->numberBits_);
    for (int i = 0; i < step.newCount; ++i)
    {
      this->sources_[slots[i]] = old[step.source(i)];
    }
  }
}

} // namespace undecimate
