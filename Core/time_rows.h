// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file time_rows.h
/// @brief Nodal values at several time steps, all steps of a node side by side.
///
/// Criteria ask for a node at all steps at once, and vector instructions do several steps with one.
/// So a node has one row for each component, with a lane for each step. Lanes are padded with
/// copies of the first step, which changes no maximum.

#ifndef UNDECIMATE_CORE_TIME_ROWS_H
#define UNDECIMATE_CORE_TIME_ROWS_H

#include "large_array.h"
#include "types.h"

#include <array>
#include <string>
#include <vector>

namespace undecimate
{

/// Lanes for so many steps: 4, or a multiple of 8.
inline int lanesFor(int steps)
{
  return steps <= 4 ? 4 : (steps + 7) / 8 * 8;
}

/// Filled step by step, in any order; a step may be set again.
class TimeRows
{
public:
  /// Memory: 4 * components * lanesFor(steps) bytes a node.
  /// @param components 1 to kMaximumComponents (array_range.h)
  /// @param steps 1 or more
  /// @throw std::bad_alloc
  TimeRows(Index nodeCount, int components, int steps);

  Index nodeCount() const { return this->nodeCount_; }
  int components() const { return this->components_; }
  int steps() const { return this->steps_; }
  int lanes() const { return this->lanes_; }

  /// components() rows of lanes() values each.
  const float* at(Index node) const { return this->values_.data() + this->size_ * node; }

  /// Set the values of a step: (value - origin) * scale, in single precision.
  /// @param values components * nodeCount, tuple after tuple
  /// @param added as many values that are added, or null
  /// @param origin of each component; small differences of large values are kept with a good one
  template <typename Real>
  void set(int step, const Real* values, const Real* added, const double* origin, double scale);

  /// Whether a value of the node was NaN or infinite at a step that was set. Such values are 0.
  bool isFinite(Index node) const { return this->nonFinite_.empty() || !this->nonFinite_[node]; }

  /// The same values at some of the steps.
  TimeRows select(const std::vector<int>& steps) const;

private:
  Index nodeCount_;
  int components_;
  int steps_;
  int lanes_;
  std::size_t size_; // of a node
  LargeArray<float, 1> values_;
  std::vector<bool> nonFinite_; // empty if there is none
};

extern template void TimeRows::set(int, const float*, const float*, const double*, double);
extern template void TimeRows::set(int, const double*, const double*, const double*, double);

/// The largest distance of a node between two steps of positions, in the unit of the rows.
double largestMove(const TimeRows& a, int stepOfA, const TimeRows& b, int stepOfB);

/// The frame of positions: what TimeRows::set() takes away and multiplies with.
struct PositionFrame
{
  std::array<double, 3> origin{ 0.0, 0.0, 0.0 };
  double scale = 1.0; ///< 1 / diagonal of the bounding box: distances are fractions of it
};

/// The frame of the bounding box of a step's points that are finite.
template <typename Real>
PositionFrame positionFrame(const Real* points, const Real* added, Index nodeCount);

extern template PositionFrame positionFrame(const float*, const float*, Index);
extern template PositionFrame positionFrame(const double*, const double*, Index);

} // namespace undecimate

#endif
