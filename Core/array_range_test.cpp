// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "array_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace undecimate
{
namespace
{

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

NodalArrayView viewOf(const std::vector<float>& values, int components)
{
  NodalArrayView view;
  view.values = values.data();
  view.components = components;
  return view;
}

TEST(ArrayRange, Scalars)
{
  const std::vector<float> values{ 3.0F, -1.5F, 2.0F };
  const ArrayRange range = arrayRange(viewOf(values, 1), 3);
  EXPECT_EQ(range.lowest[0], -1.5);
  EXPECT_EQ(range.size, 4.5);
}

TEST(ArrayRange, VectorsHaveTheDiagonalOfTheirBox)
{
  const std::vector<float> values{ 0.0F, 10.0F, 5.0F, /**/ 3.0F, 14.0F, 5.0F };
  const ArrayRange range = arrayRange(viewOf(values, 3), 2);
  EXPECT_EQ(range.lowest[0], 0.0);
  EXPECT_EQ(range.lowest[1], 10.0);
  EXPECT_EQ(range.lowest[2], 5.0);
  EXPECT_DOUBLE_EQ(range.size, 5.0);
}

TEST(ArrayRange, NonFiniteValuesDoNotCount)
{
  const std::vector<float> values{ kNaN, 2.0F, kInfinity, 6.0F, -kInfinity };
  const ArrayRange range = arrayRange(viewOf(values, 1), 5);
  EXPECT_EQ(range.lowest[0], 2.0);
  EXPECT_EQ(range.size, 4.0);
}

TEST(ArrayRange, NothingFiniteHasNoRange)
{
  const std::vector<float> values{ kNaN, kInfinity };
  const ArrayRange range = arrayRange(viewOf(values, 1), 2);
  EXPECT_EQ(range.lowest[0], 0.0);
  EXPECT_EQ(range.size, 0.0);
  EXPECT_EQ(arrayRange(viewOf(values, 1), 0).size, 0.0);
}

TEST(ArrayRange, TheLargestFloatsDoNotOverflow)
{
  const float largest = std::numeric_limits<float>::max();
  const std::vector<float> values{ -largest, largest };
  EXPECT_DOUBLE_EQ(arrayRange(viewOf(values, 1), 2).size, 2.0 * static_cast<double>(largest));
}

TEST(ArrayRange, NineComponents)
{
  std::vector<float> values(18, 0.0F);
  for (int i = 0; i < 9; ++i)
  {
    values[9 + i] = 1.0F;
  }
  EXPECT_DOUBLE_EQ(arrayRange(viewOf(values, 9), 2).size, 3.0);
}

TEST(IsFinite, NeedsAllComponents)
{
  const std::vector<float> values{ 0.0F, 1.0F, /**/ kNaN, 1.0F, /**/ 2.0F, -kInfinity, /**/ 0.0F,
    0.0F };
  const bool expected[] = { true, false, false, true };
  for (Index node = 0; node < 4; ++node)
  {
    EXPECT_EQ(isFinite(viewOf(values, 2), node), expected[node]) << node;
  }
}

} // namespace
} // namespace undecimate
