// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file memory_limits.cpp
/// @brief What the memory of this machine gives: bandwidth in order, and time a cache line at
/// random.
///
///   memory_limits [MEBIBYTES]
///
/// Prints one JSON object: bytes a second of reading an array from end to end (the bandwidth), and
/// nanoseconds a cache line in a random cycle through all lines of the array, of one walker
/// (the latency) and of each of 2 to 16 at once (what the processor overlaps). The array lies in
/// huge pages, as those of the core do. Medians of five runs.

#include "large_array.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace
{

struct Line
{
  std::uint64_t next;
  std::array<std::uint64_t, 7> rest;
};
static_assert(sizeof(Line) == 64, "a cache line");

using Lines = undecimate::LargeArray<Line>;

constexpr int kRuns = 5;
constexpr std::size_t kSteps = 2000000; // of all walkers

double cpuSeconds()
{
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <typename Run>
double medianOf(Run&& run)
{
  std::vector<double> values;
  for (int i = 0; i < kRuns; ++i)
  {
    values.push_back(run());
  }
  std::sort(values.begin(), values.end());
  return values[kRuns / 2];
}

/// The results of the loops, so that they are not left out.
volatile std::uint64_t sink = 0;

double bytesASecond(const Lines& lines)
{
  const double start = cpuSeconds();
  std::uint64_t sum = 0;
  for (const Line& line : lines)
  {
    sum += std::accumulate(line.rest.begin(), line.rest.end(), line.next);
  }
  const double seconds = cpuSeconds() - start;
  sink = sum;
  return static_cast<double>(lines.size() * sizeof(Line)) / seconds;
}

double nanosecondsALine(const Lines& lines, std::size_t walkers)
{
  std::vector<std::uint64_t> place(walkers);
  for (std::size_t i = 0; i < walkers; ++i)
  {
    place[i] = i * (lines.size() / walkers);
  }
  const std::size_t rounds = kSteps / walkers;
  const double start = cpuSeconds();
  for (std::size_t round = 0; round < rounds; ++round)
  {
    for (std::uint64_t& at : place)
    {
      at = lines[at].next;
    }
  }
  const double seconds = cpuSeconds() - start;
  sink = std::accumulate(place.begin(), place.end(), std::uint64_t{ 0 });
  return 1e9 * seconds / static_cast<double>(rounds * walkers);
}

} // namespace

int main(int argc, char** argv)
{
  const long size = argc > 1 ? std::atol(argv[1]) : 512;
  if (size < 1 || size > 1 << 20)
  {
    std::fprintf(stderr, "usage: memory_limits [MEBIBYTES from 1 to 2^20]\n");
    return 2;
  }
  Lines lines((static_cast<std::size_t>(size) << 20) / sizeof(Line), Line{});
  // One cycle through all lines in random order (S. Sattolo, 1986).
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    lines[i].next = i;
  }
  std::mt19937_64 random(1);
  for (std::size_t i = lines.size() - 1; i > 0; --i)
  {
    std::swap(lines[i].next, lines[random() % i].next);
  }
  std::printf("{\"mebibytes\": %ld, \"bytes_a_second\": %.4g, \"nanoseconds_a_line\": {", size,
    medianOf([&] { return bytesASecond(lines); }));
  for (std::size_t walkers = 1; walkers <= 16; walkers *= 2)
  {
    std::printf("%s\"%zu\": %.4g", walkers == 1 ? "" : ", ", walkers,
      medianOf([&] { return nanosecondsALine(lines, walkers); }));
  }
  std::printf("}}\n");
  return 0;
}
