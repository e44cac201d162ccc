// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file array_range.h
/// @brief Range of a nodal array, the unit of its errors.

#ifndef UNDECIMATE_CORE_ARRAY_RANGE_H
#define UNDECIMATE_CORE_ARRAY_RANGE_H

#include "types.h"

namespace undecimate
{

constexpr int kMaximumComponents = 9;

struct ArrayRange
{
  double lowest[kMaximumComponents] = {}; ///< of each component, finite values only
  double size = 0.0; ///< highest - lowest; vectors: diagonal of the box of all values
};

ArrayRange arrayRange(const NodalArrayView& array, Index nodeCount);

/// Position of the first number outside [0, limit), or `count`. O(count).
template <typename Number>
std::int64_t findOutside(const Number* numbers, std::int64_t count, std::int64_t limit)
{
  // In blocks without a branch inside, for there is hardly ever one.
  constexpr std::int64_t kBlock = 1024;
  for (std::int64_t begin = 0; begin < count; begin += kBlock)
  {
    const std::int64_t end = begin + kBlock < count ? begin + kBlock : count;
    bool outside = false;
    for (std::int64_t i = begin; i < end; ++i)
    {
      outside |= numbers[i] < 0 || numbers[i] >= limit;
    }
    for (std::int64_t i = begin; outside && i < end; ++i)
    {
      if (numbers[i] < 0 || numbers[i] >= limit)
      {
        return i;
      }
    }
  }
  return count;
}

/// Whether all components of a node's value are finite.
bool isFinite(const NodalArrayView& array, Index node);

} // namespace undecimate

#endif
