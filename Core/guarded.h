// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file guarded.h
/// @brief No exception leaves the core: it becomes an outcome.

#ifndef UNDECIMATE_CORE_GUARDED_H
#define UNDECIMATE_CORE_GUARDED_H

#include "types.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace undecimate
{

/// Run a call that fills a result, and leave the result empty unless all went well.
/// @param noMemory the message when an allocation fails
/// @param[out] result emptied before and, if the outcome is not Ok, after the work
/// @param work returns an Outcome
template <class Result, class Work>
Outcome guarded(const std::string& noMemory, Result& result, const Work& work)
{
  result = Result();
  Outcome outcome;
  try
  {
    outcome = work();
  }
  catch (const std::bad_alloc&)
  {
    outcome = { Status::OutOfMemory, noMemory };
  }
  catch (const std::length_error&)
  {
    outcome = { Status::TooLarge, "The record of the decimation would be too large." };
  }
  catch (const std::exception& failure)
  {
    // Only a callback of the monitor can come to this.
    outcome = { Status::Cancelled, std::string("Cancelled: ") + failure.what() };
  }
  catch (...)
  {
    outcome = { Status::Cancelled, "Cancelled by an unknown exception." };
  }
  if (!outcome)
  {
    result = Result();
  }
  return outcome;
}

} // namespace undecimate

#endif
