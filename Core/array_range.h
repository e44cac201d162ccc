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

/// Whether all components of a node's value are finite.
bool isFinite(const NodalArrayView& array, Index node);

} // namespace undecimate

#endif
