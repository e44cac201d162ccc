// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <map>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---------------------------------------------------------------------------------------------
// [K03] eq. 1-3
// ---------------------------------------------------------------------------------------------

struct Range
{
  double smallest;
  double largest;
  Index count;
};

class ExponentialIntervalsTest : public ::testing::TestWithParam<Range>
{
};

// Equation 2 written down from the paper for values whose largest is 1 (so that the unit does not
// matter); bound() must agree to rounding.
TEST_P(ExponentialIntervalsTest, BoundsAreEquation2)
{
  const Range range = GetParam();
  const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
  ASSERT_EQ(intervals.count(), range.count);
  const double evMin = range.smallest / range.largest;
  const double evMax = 1.0;
  const double evSum = evMin + evMax;
  const double deltaEv = evMax - evMin;
  const double evLn = evMax / std::log(1.0 + deltaEv);
  const double evDeltaM = deltaEv / range.count;
  const Index stride = std::max<Index>(1, range.count / 1000);
  for (Index j = 0; j <= range.count; j += stride)
  {
    const double d = evSum - evLn * std::log(1.0 + deltaEv - j * evDeltaM);
    EXPECT_NEAR(intervals.bound(j) / range.largest, d, 1e-10) << "interval " << j;
  }
  EXPECT_NEAR(intervals.bound(0), range.smallest, 1e-12 * range.largest);
  EXPECT_NEAR(intervals.bound(range.count), range.smallest + range.largest, 1e-12 * range.largest);
}

TEST_P(ExponentialIntervalsTest, BoundsIncrease)
{
  const Range range = GetParam();
  const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
  for (Index j = 0; j < range.count; ++j)
  {
    ASSERT_LT(intervals.bound(j), intervals.bound(j + 1)) << "interval " << j;
  }
}

// Equation 3 is the inverse of equation 2: just above the bound of an interval lies the interval,
// just below it the one before. At and above the largest value there is only the last interval.
TEST_P(ExponentialIntervalsTest, IntervalIsTheInverseOfBound)
{
  const Range range = GetParam();
  const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
  for (Index j = 0; j < range.count; ++j)
  {
    const double width = intervals.bound(j + 1) - intervals.bound(j);
    const double above = intervals.bound(j) + 1e-3 * width;
    if (above >= range.largest)
    {
      EXPECT_EQ(intervals.interval(above), range.count - 1);
      continue;
    }
    ASSERT_EQ(intervals.interval(above), j);
    if (j > 0)
    {
      ASSERT_EQ(intervals.interval(intervals.bound(j) - 1e-3 * width), j - 1);
    }
  }
}

TEST_P(ExponentialIntervalsTest, IntervalNeverDecreasesWithTheValue)
{
  const Range range = GetParam();
  const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
  Index before = 0;
  for (int i = -100; i <= 1100; ++i)
  {
    const double value = range.smallest + (range.largest - range.smallest) * i / 1000.0;
    const Index interval = intervals.interval(value);
    ASSERT_GE(interval, before) << "value " << value;
    ASSERT_LT(interval, range.count);
    before = interval;
  }
}

TEST_P(ExponentialIntervalsTest, ValuesOutsideFallIntoTheEnds)
{
  const Range range = GetParam();
  const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
  EXPECT_EQ(intervals.interval(range.smallest - range.largest), 0);
  EXPECT_EQ(intervals.interval(-kInfinity), 0);
  EXPECT_EQ(intervals.interval(range.largest), range.count - 1);
  EXPECT_EQ(intervals.interval(2.0 * range.largest), range.count - 1);
  EXPECT_EQ(intervals.interval(1e300 * range.largest), range.count - 1);
  EXPECT_EQ(intervals.interval(kInfinity), range.count - 1);
  EXPECT_EQ(intervals.interval(kNaN), range.count - 1);
}

// The formula itself is not invariant to units: without normalisation Pa and MPa would give
// different queues.
TEST_P(ExponentialIntervalsTest, UnitsDoNotMatter)
{
  const Range range = GetParam();
  const ExponentialIntervals megapascal(range.smallest, range.largest, range.count);
  const ExponentialIntervals pascal(1e6 * range.smallest, 1e6 * range.largest, range.count);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(range.smallest, range.largest);
  for (int i = 0; i < 2000; ++i)
  {
    const double e = value(random);
    const Index interval = megapascal.interval(e);
    // A value that rounding could carry over a bound says nothing.
    if (megapascal.interval(e * (1.0 - 1e-9)) == megapascal.interval(e * (1.0 + 1e-9)))
    {
      ASSERT_EQ(pascal.interval(1e6 * e), interval) << e;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ranges, ExponentialIntervalsTest,
  ::testing::Values(Range{ 0.0, 1.0, 10 }, Range{ 0.0, 1.0, 1 }, Range{ 0.25, 4.0, 7 },
    Range{ 3.0, 3.5, 100 }, Range{ 0.0, 2.5e8, 1000 }, Range{ 1e-9, 1e-6, 64 },
    Range{ 0.0, 1.0, 100000 }));

// Drawn by hand from eq. 2 with e_min = 0, e_max = 1, m = 2: L = 1 / ln 2,
// d_0 = 1 - L ln 2 = 0, d_1 = 1 - L ln 1.5 = 0.4150, d_2 = 1.
TEST(ExponentialIntervals, TwoIntervalsByHand)
{
  const ExponentialIntervals intervals(0.0, 1.0, 2);
  EXPECT_NEAR(intervals.bound(1), 0.41503749927884376, 1e-12);
  EXPECT_EQ(intervals.interval(0.0), 0);
  EXPECT_EQ(intervals.interval(0.415), 0);
  EXPECT_EQ(intervals.interval(0.4151), 1);
  EXPECT_EQ(intervals.interval(0.999), 1);
}

TEST(ExponentialIntervals, AllValuesEqualNeedOneInterval)
{
  for (const double value : { 1.0, 7.5e9, 3e-20 })
  {
    const ExponentialIntervals intervals(value, value, 50);
    ASSERT_EQ(intervals.count(), 1);
    EXPECT_NEAR(intervals.bound(0), value, 1e-12 * value);
    EXPECT_NEAR(intervals.bound(1), 2.0 * value, 1e-12 * value);
    for (const double e : { 0.0, value, 2.0 * value, -value, kNaN, kInfinity })
    {
      EXPECT_EQ(intervals.interval(e), 0);
    }
  }
}

TEST(ExponentialIntervals, AllValuesZero)
{
  const ExponentialIntervals intervals(0.0, 0.0, 50);
  ASSERT_EQ(intervals.count(), 1);
  EXPECT_EQ(intervals.bound(0), 0.0);
  EXPECT_EQ(intervals.bound(1), 0.0);
  EXPECT_EQ(intervals.interval(0.0), 0);
  EXPECT_EQ(intervals.interval(1.0), 0);
  EXPECT_EQ(intervals.interval(kNaN), 0);
}

// A range of one unit in the last place, and one of denormal numbers: any interval will do, but
// there must be one.
TEST(ExponentialIntervals, HardlyAnyRangeIsSafe)
{
  const double one = std::nextafter(1.0, 2.0);
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Range& range :
    { Range{ 1.0, one, 1000 }, Range{ 0.0, tiny, 1000 }, Range{ tiny, 100.0 * tiny, 1000 },
      Range{ 0.0, std::numeric_limits<double>::max(), 1000 } })
  {
    const ExponentialIntervals intervals(range.smallest, range.largest, range.count);
    ASSERT_GE(intervals.count(), 1);
    for (const double e : { 0.0, range.smallest, range.largest, 1.0, kNaN, kInfinity, -1.0 })
    {
      EXPECT_GE(intervals.interval(e), 0);
      EXPECT_LT(intervals.interval(e), intervals.count());
    }
  }
}

TEST(ExponentialIntervals, CountsBelowOneBecomeOne)
{
  EXPECT_EQ(ExponentialIntervals(0.0, 1.0, 0).count(), 1);
  EXPECT_EQ(ExponentialIntervals(0.0, 1.0, -3).count(), 1);
}

// ---------------------------------------------------------------------------------------------
// Logarithmic spacing
// ---------------------------------------------------------------------------------------------

TEST(LogarithmicInterval, NeverDecreasesWithTheValue)
{
  Index before = 0;
  for (float value = std::numeric_limits<float>::denorm_min();
       value < std::numeric_limits<float>::max() / 2.0F;
       value = std::nextafter(value * 1.003F, std::numeric_limits<float>::max()))
  {
    const Index interval = logarithmicInterval(value);
    ASSERT_GE(interval, before) << value;
    ASSERT_LT(interval, kLogarithmicIntervals);
    before = interval;
  }
}

TEST(LogarithmicInterval, RelativePrecisionIsBetterThanOneIn128)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<float> exponent(-47.0F, 15.0F);
  for (int i = 0; i < 20000; ++i)
  {
    const float value = std::exp2(exponent(random));
    const Index interval = logarithmicInterval(value);
    // All values of an interval lie within a factor of 1 + 2^-7 = 1.0078.
    EXPECT_NE(logarithmicInterval(value * 1.00785F), interval) << value;
    EXPECT_NE(logarithmicInterval(value / 1.00785F), interval) << value;
    EXPECT_LE(logarithmicInterval(value * 1.0078F), interval + 2) << value;
  }
}

TEST(LogarithmicInterval, SpecialValues)
{
  EXPECT_EQ(logarithmicInterval(0.0F), 0);
  EXPECT_EQ(logarithmicInterval(-0.0F), 0);
  EXPECT_EQ(logarithmicInterval(-5.0F), 0);
  EXPECT_EQ(logarithmicInterval(-std::numeric_limits<float>::infinity()), 0);
  EXPECT_EQ(
    logarithmicInterval(std::numeric_limits<float>::quiet_NaN()), kLogarithmicIntervals - 1);
  EXPECT_EQ(
    logarithmicInterval(-std::numeric_limits<float>::quiet_NaN()), kLogarithmicIntervals - 1);
  const Index infinity = logarithmicInterval(std::numeric_limits<float>::infinity());
  EXPECT_EQ(infinity, kLogarithmicIntervals - 1);
  EXPECT_EQ(logarithmicInterval(std::numeric_limits<float>::max()), infinity);
  EXPECT_EQ(logarithmicInterval(std::exp2(16.0F)), infinity);
  EXPECT_EQ(logarithmicInterval(std::exp2(16.0F) * 0.999F), infinity);
  EXPECT_EQ(logarithmicInterval(std::exp2(16.0F) * 0.995F), infinity - 1);
  EXPECT_EQ(logarithmicInterval(std::numeric_limits<float>::denorm_min()), 0);
  EXPECT_EQ(logarithmicInterval(std::exp2(-49.0F)), 0);
  EXPECT_EQ(logarithmicInterval(std::exp2(-48.0F)), 0);
  EXPECT_EQ(logarithmicInterval(std::exp2(-48.0F) * 1.01F), 1);
}

// ---------------------------------------------------------------------------------------------
// The queue
// ---------------------------------------------------------------------------------------------

TEST(HashQueue, StartsEmpty)
{
  HashQueue queue(3, 4);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.size(), 0);
  EXPECT_EQ(queue.front(), kNone);
  EXPECT_EQ(queue.pop(), kNone);
  EXPECT_EQ(queue.lowestInterval(), kNone);
  for (Index node = 0; node < 3; ++node)
  {
    EXPECT_FALSE(queue.contains(node));
    EXPECT_EQ(queue.interval(node), kNone);
    queue.remove(node); // nothing happens
  }
  EXPECT_EQ(queue.size(), 0);
}

TEST(HashQueue, NoNodesAtAll)
{
  HashQueue queue(0, 1);
  EXPECT_EQ(queue.pop(), kNone);
}

TEST(HashQueue, FirstInFirstOutWithinAnInterval)
{
  HashQueue queue(6, 8);
  for (const Index node : { 4, 0, 5, 2 })
  {
    queue.insert(node, 3);
  }
  EXPECT_EQ(queue.after(4), 0);
  EXPECT_EQ(queue.after(2), kNone);
  for (const Index node : { 4, 0, 5, 2 })
  {
    EXPECT_EQ(queue.front(), node);
    EXPECT_EQ(queue.pop(), node);
  }
  EXPECT_TRUE(queue.empty());
}

TEST(HashQueue, LowestIntervalFirst)
{
  HashQueue queue(5, 300);
  queue.insert(0, 299);
  queue.insert(1, 64);
  queue.insert(2, 63);
  queue.insert(3, 128);
  queue.insert(4, 0);
  for (const Index node : { 4, 2, 1, 3, 0 })
  {
    EXPECT_EQ(queue.lowestInterval(), queue.interval(node));
    EXPECT_EQ(queue.pop(), node);
  }
}

// Following upcoming() shows the order in which all nodes would leave.
TEST(HashQueue, UpcomingNodesLeaveInThatOrder)
{
  std::mt19937 random(3);
  for (const Index intervals : { 1, 5, 64, 70, 5000, kLogarithmicIntervals, 1 << 24 })
  {
    HashQueue queue(200, intervals);
    for (Index node = 0; node < 200; node += 1 + node % 3)
    {
      queue.insert(node, static_cast<Index>(random() % static_cast<unsigned>(intervals)));
    }
    std::vector<Index> order;
    for (Index node = queue.front(); node != kNone; node = queue.upcoming(node))
    {
      order.push_back(node);
      ASSERT_LE(order.size(), 200U);
    }
    ASSERT_EQ(static_cast<Index>(order.size()), queue.size());
    for (const Index node : order)
    {
      ASSERT_EQ(queue.pop(), node);
    }
  }
}

// A re-evaluated node goes to the end, even if its interval is the same ([K03] 1.2).
TEST(HashQueue, InsertingAgainMovesToTheEnd)
{
  HashQueue queue(3, 2);
  queue.insert(0, 1);
  queue.insert(1, 1);
  queue.insert(2, 1);
  queue.insert(0, 1);
  EXPECT_EQ(queue.size(), 3);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), 0);
}

TEST(HashQueue, TakesNodesFromTheStartMiddleAndEnd)
{
  HashQueue queue(5, 1);
  for (Index node = 0; node < 5; ++node)
  {
    queue.insert(node, 0);
  }
  queue.remove(0);
  queue.remove(2);
  queue.remove(4);
  EXPECT_FALSE(queue.contains(2));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.pop(), kNone);
  queue.insert(2, 0);
  EXPECT_EQ(queue.pop(), 2);
}

/// The same queue written with the standard library: what HashQueue must equal.
class ReferenceQueue
{
public:
  void insert(Index node, Index interval)
  {
    this->remove(node);
    this->lists_[interval].push_back(node);
    this->intervals_[node] = interval;
  }
  void remove(Index node)
  {
    const auto found = this->intervals_.find(node);
    if (found == this->intervals_.end())
    {
      return;
    }
    const auto list = this->lists_.find(found->second);
    list->second.remove(node);
    if (list->second.empty())
    {
      this->lists_.erase(list);
    }
    this->intervals_.erase(found);
  }
  Index front() const
  {
    return this->lists_.empty() ? kNone : this->lists_.begin()->second.front();
  }
  Index lowestInterval() const
  {
    return this->lists_.empty() ? kNone : this->lists_.begin()->first;
  }
  Index interval(Index node) const
  {
    const auto found = this->intervals_.find(node);
    return found == this->intervals_.end() ? kNone : found->second;
  }
  Index size() const { return static_cast<Index>(this->intervals_.size()); }

private:
  std::map<Index, std::list<Index>> lists_;
  std::map<Index, Index> intervals_;
};

class HashQueueModelTest : public ::testing::TestWithParam<Index>
{
};

TEST_P(HashQueueModelTest, LongRandomSequences)
{
  constexpr Index kNodes = 60;
  const Index intervals = GetParam();
  HashQueue queue(kNodes, intervals);
  ReferenceQueue model;
  EXPECT_EQ(queue.intervalCount(), intervals);
  std::mt19937 random(static_cast<unsigned>(intervals));
  std::uniform_int_distribution<Index> anyNode(0, kNodes - 1);
  std::uniform_int_distribution<Index> anyInterval(0, intervals - 1);
  // Few intervals in use make long lists, many make sparse bits: change between them.
  std::uniform_int_distribution<Index> fewIntervals(0, std::min<Index>(intervals - 1, 3));
  for (int i = 0; i < 60000; ++i)
  {
    const Index node = anyNode(random);
    switch (random() % 8)
    {
      case 0:
      case 1:
      case 2:
      {
        const Index interval = anyInterval(random);
        queue.insert(node, interval);
        model.insert(node, interval);
        break;
      }
      case 3:
      {
        const Index interval = intervals - 1 - fewIntervals(random);
        queue.insert(node, interval);
        model.insert(node, interval);
        break;
      }
      case 4:
        queue.remove(node);
        model.remove(node);
        break;
      default:
        if (i / 4000 % 2 == 1 || random() % 4 == 0)
        {
          const Index expected = model.front();
          ASSERT_EQ(queue.pop(), expected);
          model.remove(expected);
        }
        break;
    }
    ASSERT_EQ(queue.size(), model.size());
    ASSERT_EQ(queue.front(), model.front());
    ASSERT_EQ(queue.lowestInterval(), model.lowestInterval());
    ASSERT_EQ(queue.interval(node), model.interval(node));
    ASSERT_EQ(queue.contains(node), model.interval(node) != kNone);
  }
  while (!queue.empty())
  {
    const Index expected = model.front();
    ASSERT_EQ(queue.pop(), expected);
    model.remove(expected);
  }
  EXPECT_EQ(model.size(), 0);
}

INSTANTIATE_TEST_SUITE_P(IntervalCounts, HashQueueModelTest,
  ::testing::Values<Index>(1, 2, 63, 64, 65, 4096, 4097, kLogarithmicIntervals, 1 << 24));

TEST(HashQueue, BothEndsOfTheLargestQueue)
{
  constexpr Index kCount = 1 << 24;
  HashQueue queue(2, kCount);
  queue.insert(0, kCount - 1);
  EXPECT_EQ(queue.lowestInterval(), kCount - 1);
  queue.insert(1, 0);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 0);
  EXPECT_TRUE(queue.empty());
}

} // namespace
} // namespace undecimate
