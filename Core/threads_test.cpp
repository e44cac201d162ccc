// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace undecimate
{
namespace
{

class SomeThreads : public ::testing::TestWithParam<int>
{
};

TEST_P(SomeThreads, EachJobIsDoneOnce)
{
  Threads threads(GetParam());
  for (const Index count : { 0, 1, 2, 5, 1000 })
  {
    std::vector<int> done(count, 0);
    threads.run(count,
      [&](Index job, int thread)
      {
        ASSERT_GE(thread, 0);
        ASSERT_LT(thread, threads.count());
        done[job] += job;
      });
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(done, all);
  }
}

TEST_P(SomeThreads, SharesCoverAllOnce)
{
  Threads threads(GetParam());
  for (const Index count : { 0, 1, 2, 5, 1000 })
  {
    std::vector<std::atomic<int>> done(count);
    std::atomic<Index> shares{ 0 };
    doInShares(&threads, count,
      [&](const auto& ours)
      {
        ++shares;
        for (Index i = 0; i < count; ++i)
        {
          EXPECT_EQ(ours.has(i), i >= ours.begin && i < ours.end);
          done[i] += ours.has(i) ? 1 : 0;
        }
      });
    EXPECT_EQ(shares, threads.count() == 1 ? 1 : kSharesPerThread * threads.count());
    EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](int times) { return times == 1; }));
  }
  doInShares(nullptr, 7,
    [](const auto& ours)
    {
      EXPECT_EQ(ours.begin, 0);
      EXPECT_EQ(ours.end, 7);
    });
}

TEST_P(SomeThreads, SharesOfTheLargestCount)
{
  Threads threads(GetParam());
  constexpr Index kMost = std::numeric_limits<Index>::max();
  std::mutex mutex;
  std::vector<Share> shares;
  doInShares(&threads, kMost,
    [&](const Share& share)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      shares.push_back(share);
    });
  std::sort(
    shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.begin < b.begin; });
  Index end = 0;
  for (const Share& share : shares)
  {
    EXPECT_EQ(share.begin, end);
    EXPECT_GT(share.end, share.begin);
    end = share.end;
  }
  EXPECT_EQ(end, kMost);
}

TEST_P(SomeThreads, WhatWasWrittenBeforeIsSeen)
{
  Threads threads(GetParam());
  std::vector<int> values(64, 0);
  for (int turn = 1; turn <= 200; ++turn)
  {
    threads.run(64, [&](Index job, int /*thread*/) { values[(job + 1) % 64] += turn; });
  }
  EXPECT_EQ(values, std::vector<int>(64, 200 * 201 / 2));
}

TEST_P(SomeThreads, ExceptionsReachTheCaller)
{
  Threads threads(GetParam());
  std::atomic<int> done{ 0 };
  std::string message;
  try
  {
    threads.run(100000,
      [&](Index job, int /*thread*/)
      {
        ++done;
        if (job == 10)
        {
          throw std::runtime_error("job 10");
        }
        if (job > 10)
        {
          // So that the others can't be through with all before it is thrown.
          std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
      });
  }
  catch (const std::runtime_error& failure)
  {
    message = failure.what();
  }
  EXPECT_EQ(message, "job 10");
  EXPECT_LT(done, 100000);
  // And they go on working.
  done = 0;
  threads.run(10, [&](Index /*job*/, int /*thread*/) { ++done; });
  EXPECT_EQ(done, 10);
}

INSTANTIATE_TEST_SUITE_P(Counts, SomeThreads, ::testing::Values(1, 2, 3, 7, 0, -1));

TEST(Threads, CountIsTheWantedOne)
{
  EXPECT_EQ(Threads(1).count(), 1);
  EXPECT_EQ(Threads(3).count(), 3);
  EXPECT_GE(Threads(0).count(), 1);
  EXPECT_LE(Threads(1 << 30).count(), Threads::kMaximumThreads);
}

} // namespace
} // namespace undecimate
