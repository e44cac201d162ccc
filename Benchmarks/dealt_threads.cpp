// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file dealt_threads.cpp
/// @brief In place of Core/threads.cpp: how a run would scale, computed.
///
/// One thread does all jobs and takes the CPU time of each. They are dealt out, in their order, to
/// so many cores, each to the one that is free first. What no job does is added. Waiting of the
/// cores for the same memory is not in it. At the end one line of JSON goes to the error output.

#include "threads.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <iostream>
#include <vector>

namespace undecimate
{

namespace
{

double cpuSeconds()
{
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

constexpr std::array<int, 5> kCores{ 2, 4, 8, 16, 64 };

} // namespace

struct Threads::Internals
{
  int count = 1;
  double begun = cpuSeconds();
  double inJobs = 0.0;
  std::array<double, kCores.size()> dealt{}; // time of the jobs on so many cores
};

Threads::Threads(int count)
  : internals_(std::make_unique<Internals>())
{
  this->internals_->count = std::max(1, count);
}

Threads::~Threads()
{
  const Internals& in = *this->internals_;
  const double whole = cpuSeconds() - in.begun;
  std::cerr << "{\"whole\": " << whole << ", \"serial\": " << whole - in.inJobs << ", \"times\": {";
  for (std::size_t c = 0; c < kCores.size(); ++c)
  {
    std::cerr << (c > 0 ? ", " : "") << '"' << kCores[c]
              << "\": " << whole / (whole - in.inJobs + in.dealt[c]);
  }
  std::cerr << "}}" << std::endl;
}

int Threads::count() const
{
  return this->internals_->count;
}

void Threads::run(Index jobCount, const Job& job)
{
  Internals& in = *this->internals_;
  std::vector<double> seconds;
  for (Index i = 0; i < jobCount; ++i)
  {
    const double begin = cpuSeconds();
    job(i, 0);
    seconds.push_back(cpuSeconds() - begin);
    in.inJobs += seconds.back();
  }
  for (std::size_t c = 0; c < kCores.size(); ++c)
  {
    std::vector<double> cores(kCores[c], 0.0);
    for (const double one : seconds)
    {
      *std::min_element(cores.begin(), cores.end()) += one;
    }
    in.dealt[c] += *std::max_element(cores.begin(), cores.end());
  }
}

} // namespace undecimate
