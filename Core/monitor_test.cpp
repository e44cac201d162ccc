// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue_decimation.h"
#include "monitor.h"
#include "testing/meshes.h"
#include "testing/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

namespace undecimate
{
namespace
{

TEST(Monitor, StartsAtZero)
{
  Monitor monitor;
  EXPECT_EQ(monitor.progress(), 0.0);
  EXPECT_FALSE(monitor.cancelled());
}

TEST(Monitor, ReportsOnlyWhatIsNewAndNotTooOften)
{
  std::vector<double> seen;
  Monitor monitor = testing::recording(seen);
  for (int i = 0; i <= 100000; ++i)
  {
    EXPECT_TRUE(monitor.update(i / 100000.0));
  }
  EXPECT_LE(seen.size(), 250U); // each half per cent, and twenty times a second
  EXPECT_GE(seen.size(), 150U);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
  EXPECT_EQ(monitor.progress(), 1.0);
}

TEST(Monitor, FractionsDoNotGoBeyondOne)
{
  Monitor monitor;
  monitor.update(0.5);
  monitor.update(1.5);
  EXPECT_EQ(monitor.progress(), 1.0);
}

// Within a call fractions never decrease, so a smaller one belongs to the next call.
TEST(Monitor, SmallerFractionStartsTheNextCall)
{
  std::vector<double> seen;
  Monitor monitor = testing::recording(seen);
  for (const double fraction : { 0.5, 1.0, 0.0, 0.5, 1.0 })
  {
    EXPECT_TRUE(monitor.update(fraction));
    EXPECT_EQ(monitor.progress(), fraction);
  }
  EXPECT_EQ(seen.back(), 1.0);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 0.5), 2);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1.0), 2);
}

// A host that wants to cancel is asked although there is no progress.
TEST(Monitor, AsksEvenWithoutProgress)
{
  int calls = 0;
  Monitor monitor([&](double) { return ++calls < 2; });
  const auto start = std::chrono::steady_clock::now();
  while (
    monitor.update(0.001) && std::chrono::steady_clock::now() - start < std::chrono::seconds(20))
  {
    std::this_thread::yield();
  }
  EXPECT_TRUE(monitor.cancelled());
}

TEST(Monitor, CancelIsHeardAtTheNextUpdateAndUntilReset)
{
  Monitor monitor;
  monitor.cancel();
  monitor.cancel();
  EXPECT_TRUE(monitor.cancelled());
  EXPECT_FALSE(monitor.update(0.0));
  EXPECT_FALSE(monitor.update(0.5));
  monitor.reset();
  EXPECT_FALSE(monitor.cancelled());
  EXPECT_EQ(monitor.progress(), 0.0);
  EXPECT_TRUE(monitor.update(0.5));
}

TEST(Monitor, CallbackMayCancel)
{
  Monitor monitor([](double fraction) { return fraction < 0.5; });
  EXPECT_TRUE(monitor.update(0.4));
  EXPECT_FALSE(monitor.update(0.6));
  EXPECT_TRUE(monitor.cancelled());
}

TEST(MonitorShare, IsAPartOfTheWhole)
{
  Monitor monitor([](double fraction) { return fraction < 0.75; });
  const MonitorShare half = MonitorShare(&monitor).part(0.5, 1.0);
  EXPECT_TRUE(half.update(0.2));
  EXPECT_NEAR(monitor.progress(), 0.6, 1e-12);
  EXPECT_FALSE(half.part(0.5, 1.0).update(0.0));
  EXPECT_NEAR(monitor.progress(), 0.75, 1e-12);
}

TEST(MonitorShare, AsksOnceInAWhile)
{
  int calls = 0;
  Monitor monitor(
    [&calls](double)
    {
      ++calls;
      return false;
    });
  const MonitorShare share(&monitor, 0.1, 1.0);
  EXPECT_TRUE(share.updateAt(1, 100000));
  EXPECT_EQ(calls, 0);
  EXPECT_FALSE(share.updateAt(0, 100000));
  EXPECT_EQ(calls, 1);
}

TEST(MonitorShare, WithoutAMonitorNothingCancels)
{
  EXPECT_TRUE(MonitorShare(nullptr).update(0.5));
  EXPECT_TRUE(MonitorShare(nullptr).part(0.5, 1.0).updateAt(0, 1));
}

// ---------------------------------------------------------------------------------------------
// What a decimation does with it
// ---------------------------------------------------------------------------------------------

class MonitoredDecimation : public ::testing::TestWithParam<Criterion>
{
protected:
  MonitoredDecimation()
    : mesh(testing::hills(60, 60))
  {
    for (Index i = 0; i < mesh.nodeCount(); ++i)
    {
      values.push_back(static_cast<float>(mesh.point(i)[2]));
    }
    options.criterion = GetParam();
    options.maximumError = HUGE_VAL;
    options.arrays.resize(1);
    options.arrays[0].values = values.data();
    options.arrays[0].name = "Height";
  }

  static void expectEmpty(const HashQueueDecimationResult& result)
  {
    EXPECT_EQ(result.record.nodeCount, 0);
    EXPECT_EQ(result.record.cellCount, 0);
    EXPECT_TRUE(result.record.nodeOrder.empty());
    EXPECT_TRUE(result.record.stepErrors.empty());
    EXPECT_TRUE(result.baseTriangles.empty());
  }

  testing::Mesh mesh;
  std::vector<float> values;
  HashQueueDecimationOptions options;
  HashQueueDecimationResult result;
};

TEST_P(MonitoredDecimation, ProgressIncreasesToOneInSmallSteps)
{
  std::vector<double> seen;
  Monitor monitor = testing::recording(seen);
  ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
  EXPECT_GE(seen.size(), 10U);
  EXPECT_LE(seen.size(), 300U);
}

TEST_P(MonitoredDecimation, ProgressEndsAtOneWhenThereIsNothingToDo)
{
  options.targetReduction = 0.0;
  Monitor monitor;
  ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
  EXPECT_EQ(monitor.progress(), 1.0);
}

TEST_P(MonitoredDecimation, CancelledBeforeItStartsDoesNothing)
{
  int calls = 0;
  Monitor monitor(
    [&](double)
    {
      ++calls;
      return true;
    });
  monitor.cancel();
  const Outcome outcome = decimate(mesh.view(), options, monitor, result);
  EXPECT_EQ(outcome.status, Status::Cancelled);
  EXPECT_FALSE(outcome.message.empty());
  EXPECT_EQ(calls, 0);
  expectEmpty(result);
}

TEST_P(MonitoredDecimation, CancelledMidwayLeavesAnEmptyResult)
{
  for (const double stop : { 0.01, 0.2, 0.6, 0.95, 1.0 })
  {
    Monitor monitor([stop](double fraction) { return fraction < stop; });
    const Outcome outcome = decimate(mesh.view(), options, monitor, result);
    EXPECT_EQ(outcome.status, Status::Cancelled) << stop;
    EXPECT_GE(monitor.progress(), stop);
    expectEmpty(result);
  }
}

TEST_P(MonitoredDecimation, CancelledFromAnotherThreadStopsOrIsTooLate)
{
  Monitor monitor;
  std::thread other([&] { monitor.cancel(); });
  const Outcome outcome = decimate(mesh.view(), options, monitor, result);
  other.join();
  if (outcome.status == Status::Cancelled)
  {
    expectEmpty(result);
  }
  else
  {
    EXPECT_EQ(outcome.status, Status::Ok);
    EXPECT_EQ(result.record.nodeCount, mesh.nodeCount());
  }
}

TEST_P(MonitoredDecimation, ServesOneCallAfterTheOther)
{
  std::vector<double> seen;
  Monitor monitor = testing::recording(seen);
  for (int call = 0; call < 3; ++call)
  {
    seen.clear();
    ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
    ASSERT_GE(seen.size(), 10U);
    EXPECT_LT(seen.front(), 0.1);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1.0);
  }
}

TEST_P(MonitoredDecimation, WorksAgainAfterReset)
{
  Monitor monitor;
  monitor.cancel();
  EXPECT_EQ(decimate(mesh.view(), options, monitor, result).status, Status::Cancelled);
  monitor.reset();
  ASSERT_TRUE(decimate(mesh.view(), options, monitor, result));
  EXPECT_EQ(monitor.progress(), 1.0);
  EXPECT_GT(result.record.stepErrors.size(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Criteria, MonitoredDecimation,
  ::testing::Values(Criterion::Deviation, Criterion::ScalarDifference, Criterion::AngleToXYPlane,
    Criterion::Quadric));

} // namespace
} // namespace undecimate
