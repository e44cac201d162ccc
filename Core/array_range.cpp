// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "array_range.h"

#include <algorithm>
#include <cmath>

namespace undecimate
{

ArrayRange arrayRange(const NodalArrayView& array, Index nodeCount)
{
  ArrayRange range;
  double square = 0.0;
  for (int component = 0; component < array.components; ++component)
  {
    bool any = false;
    double lowest = 0.0;
    double highest = 0.0;
    for (Index i = 0; i < nodeCount; ++i)
    {
      const double value = array.values[std::size_t{ 1 } * array.components * i + component];
      if (std::isfinite(value))
      {
        lowest = any ? std::min(lowest, value) : value;
        highest = any ? std::max(highest, value) : value;
        any = true;
      }
    }
    range.lowest[component] = lowest;
    square += (highest - lowest) * (highest - lowest);
  }
  range.size = std::sqrt(square);
  return range;
}

bool isFinite(const NodalArrayView& array, Index node)
{
  const float* value = array.values + std::size_t{ 1 } * array.components * node;
  return std::all_of(
    value, value + array.components, [](float component) { return std::isfinite(component); });
}

} // namespace undecimate
