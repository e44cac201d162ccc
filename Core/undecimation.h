// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimation.h
/// @brief Walks a record to any level, in either direction.
///
/// Source: [K03] section 2. A node comes back by putting the old cells of its step in the place of
/// the new ones; it goes again by the reverse. Reads any record, whoever wrote it.

#ifndef UNDECIMATE_CORE_UNDECIMATION_H
#define UNDECIMATE_CORE_UNDECIMATION_H

#include "monitor.h"
#include "record.h"

#include <vector>

namespace undecimate
{

/// A cursor on a record. Step count k in [0, stepCount]: 0 is the coarsest level (level 0),
/// stepCount the original mesh (level 1). All numbers that it hands out are in record order.
///
/// Memory: 4 bytes a corner of the original cells (12 bytes a triangle, in mixed meshes 16 bytes a
/// cell), 4 bytes a cell more if sources are recorded.
class Undecimation
{
public:
  /// Check the record and stand at level 0. The record's arrays must outlive the cursor's use. What
  /// passes can be walked to any level and back, and no level refers to nodes that it does not
  /// have. Complexity: O(record); walks it once.
  /// @param record the record
  /// @param baseCells the cells of the coarsest level, in record order; copied
  /// @param monitor progress and cancel; null: neither
  /// @return InvalidRecord, OutOfMemory, Cancelled or Ok; unless Ok the cursor is closed
  /// Throws nothing: exceptions of the monitor's callback end the call as Cancelled.
  Outcome open(const RecordView& record, const Index* baseCells, Monitor* monitor = nullptr);

  /// Go to the level at which `steps` removed nodes are back (clamped to [0, stepCount]).
  /// Complexity: O(|steps - current|).
  /// @param monitor progress and cancel; null: neither
  /// @return false if it was cancelled: the cursor then stands, whole, at a level on the way
  /// Throws nothing: exceptions of the monitor's callback end the call as cancelled.
  bool moveTo(Index steps, Monitor* monitor = nullptr);

  /// Steps at a level: a fraction of the removed nodes, in [0, 1] (clamped; NaN counts as 0).
  Index stepsForLevel(double level) const;

  /// The fewest steps whose error is at most `error`. Complexity: O(log stepCount).
  Index stepsForError(double error) const;

  Index steps() const { return this->steps_; }
  Index stepCount() const { return this->record_.stepCount; }
  Index nodeCount() const { return this->record_.baseNodeCount + this->steps_; }
  Index cellCount() const { return this->cellCount_; }

  /// Error of the current level as the record has it; 0 at level 1.
  double error() const;

  /// cornersPerCell * cellCount() node numbers of the current level, kNone at the empty corner of a
  /// triangle among quads; valid until the next move.
  const Index* cells() const { return this->cells_.data(); }

  /// Original number of the cell whose values each cell of the current level shows; at level 1 its
  /// own. Valid until the next move.
  const Index* shownCells() const
  {
    return this->record_.hasSources ? this->sources_.data() : this->record_.cellOrder;
  }

  const RecordView& record() const { return this->record_; }

private:
  bool showsAllCells() const;
  Outcome check(const RecordView& record, const Index* baseCells, const MonitorShare& progress);
  void walkTo(Index goal);
  void standAtBase(const Index* baseCells);
  template <typename Step>
  bool isNextStepSound() const;
  template <typename Step>
  bool areNextSourcesSound() const;
  template <typename Step>
  class Scout;
  template <typename Step>
  void findSlots(const Step& step, Index* slots) const;
  template <typename Step>
  void refine();
  template <typename Step>
  void coarsen();
  template <typename Step>
  void walk(Index goal);
  template <typename Step>
  Outcome walkAll(const MonitorShare& walk);

  RecordView record_;
  std::vector<Index> cells_;
  std::vector<Index> sources_;
  Index steps_ = 0;
  Index cellCount_ = 0;
  int numberBits_ = 0;            // of record_
  std::int64_t position_ = 0;     // of step steps_ in record_.codes, or in record_.patches
  std::int64_t lostPosition_ = 0; // in record_.lostSources, or bit of record_.lostSourceCodes
};

} // namespace undecimate

#endif
