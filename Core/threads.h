// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file threads.h
/// @brief Some threads that share out a list of jobs.

#ifndef UNDECIMATE_CORE_THREADS_H
#define UNDECIMATE_CORE_THREADS_H

#include "types.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>

namespace undecimate
{

/// Threads that wait for work until they are destroyed. The caller's thread is one of them.
class Threads
{
public:
  /// More threads than this are never made.
  static constexpr int kMaximumThreads = 1024;

  /// @param count of threads, the caller's included; 0 or less = as many as the machine has cores.
  /// Fewer are made if the system refuses more.
  explicit Threads(int count);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  int count() const;

  /// A job: its number, and the number of the thread that does it in [0, count()). Thread 0 is the
  /// caller's.
  using Job = std::function<void(Index job, int thread)>;

  /// Do the jobs 0 .. jobCount - 1, each once, and wait for all of them. Jobs begin in the order of
  /// their numbers. What was written before is seen by all jobs, and what they write by the caller
  /// afterwards. Not to be called by a job.
  /// @throw the first exception of a job; jobs that had not begun by then are left out
  void run(Index jobCount, const Job& job);

private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

/// A part of the indices [0, count), or Whole: all that is asked for is known to be in it, which
/// costs no question.
struct Share
{
  Index begin;
  Index end;
  bool has(Index i) const { return i >= this->begin && i < this->end; }
};
struct Whole : Share
{
  static constexpr bool has(Index /*i*/) { return true; }
};

/// Shares of work for each thread: who shares a core with others gets fewer of them.
constexpr Index kSharesPerThread = 16;

/// Do job(share) for shares of [0, count), so many for each thread, or job(whole) if there is only
/// one thread (or null).
template <typename Job>
void doInShares(
  Threads* threads, Index count, const Job& job, Index sharesPerThread = kSharesPerThread)
{
  if (!threads || threads->count() == 1)
  {
    job(Whole{ { 0, count } });
    return;
  }
  const Index shares = threads->count() * sharesPerThread;
  const std::int64_t size = count / shares + 1;
  const auto begin = [&](Index i)
  { return static_cast<Index>(std::min<std::int64_t>(count, i * size)); };
  threads->run(shares, [&](Index i, int /*thread*/) { job(Share{ begin(i), begin(i + 1) }); });
}

} // namespace undecimate

#endif
