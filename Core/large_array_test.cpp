// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "large_array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace undecimate
{
namespace
{

// Two arrays must not share a cache line, whatever their sizes: different threads write them.
template <int Shift>
void expectLinesOfTheirOwn(std::size_t count)
{
  const LargeArray<std::int32_t, Shift> a(count, 1);
  const LargeArray<std::int32_t, Shift> b(count, 2);
  const auto first = [](const auto& array)
  { return reinterpret_cast<std::uintptr_t>(array.data()) / kCacheLine; };
  const auto last = [](const auto& array)
  { return (reinterpret_cast<std::uintptr_t>(array.data() + array.size()) - 1) / kCacheLine; };
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.data()) % kCacheLine, 0U);
  EXPECT_TRUE(last(a) < first(b) || last(b) < first(a)) << count;
  EXPECT_EQ(a, std::vector(a.size(), 1, a.get_allocator()));
  EXPECT_EQ(b, std::vector(b.size(), 2, b.get_allocator()));
}

TEST(LargeArray, HasCacheLinesOfItsOwn)
{
  for (const std::size_t count : { 1, 2, 15, 16, 17, 1000, 1 << 20, (1 << 20) + 1 })
  {
    expectLinesOfTheirOwn<0>(count);
    expectLinesOfTheirOwn<3>(count);
  }
}

TEST(LargeArray, IsAVector)
{
  LargeArray<std::int32_t> array;
  for (std::int32_t i = 0; i < 3000000; ++i) // from ordinary pages into huge ones
  {
    array.push_back(i);
  }
  LargeArray<std::int32_t> moved = std::move(array);
  for (std::int32_t i = 0; i < 3000000; ++i)
  {
    ASSERT_EQ(moved[i], i);
  }
  release(moved);
  EXPECT_EQ(moved.capacity(), 0U);
}

TEST(LargeArray, MoreThanThereIsIsRefused)
{
  LargeArrayAllocator<std::int64_t, 1> allocator;
  EXPECT_THROW(allocator.allocate(std::numeric_limits<std::size_t>::max()), std::bad_alloc);
  EXPECT_THROW(allocator.allocate(std::numeric_limits<std::size_t>::max() / 8), std::bad_alloc);
}

} // namespace
} // namespace undecimate
