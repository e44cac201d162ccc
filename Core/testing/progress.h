// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file progress.h
/// @brief Progress that was reported, for tests.

#ifndef UNDECIMATE_CORE_TESTING_PROGRESS_H
#define UNDECIMATE_CORE_TESTING_PROGRESS_H

#include "monitor.h"

#include <vector>

namespace undecimate
{
namespace testing
{

/// A monitor that appends each fraction it is told, and does not cancel.
inline Monitor recording(std::vector<double>& seen)
{
  return Monitor(
    [&seen](double fraction)
    {
      seen.push_back(fraction);
      return true;
    });
}

} // namespace testing
} // namespace undecimate

#endif
