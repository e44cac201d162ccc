// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "packed_numbers.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

TEST(PackedNumbers, BitsThatNumbersNeed)
{
  EXPECT_EQ(bitsBelow(-1), 1);
  EXPECT_EQ(bitsBelow(0), 1);
  EXPECT_EQ(bitsBelow(1), 1);
  EXPECT_EQ(bitsBelow(2), 1);
  EXPECT_EQ(bitsBelow(3), 2);
  EXPECT_EQ(bitsBelow(4), 2);
  EXPECT_EQ(bitsBelow(5), 3);
  EXPECT_EQ(bitsBelow(1 << 21), 21);
  EXPECT_EQ(bitsBelow((1 << 21) + 1), 22);
  EXPECT_EQ(bitsBelow(std::numeric_limits<Index>::max()), 31);
}

// Bit by bit as the file comment says, and with nothing but 0 behind.
TEST(PackedNumbers, ComeBack)
{
  std::mt19937 random(3);
  for (int bits = 1; bits <= 31; ++bits)
  {
    for (int count = 0; count < 40; ++count)
    {
      std::vector<Index> numbers(count);
      for (Index& number : numbers)
      {
        number = static_cast<Index>(random() & ((std::uint32_t{ 1 } << bits) - 1));
      }
      std::vector<unsigned char> bytes(packedSize(std::int64_t{ count } * bits), 0);
      BitWriter writer(bytes.data());
      for (const Index number : numbers)
      {
        writer.add(number, bits);
      }
      writer.finish();
      for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
      {
        const std::size_t i = bit / bits;
        const int expected = i < numbers.size() ? numbers[i] >> (bit % bits) & 1 : 0;
        ASSERT_EQ(bytes[bit / 8] >> bit % 8 & 1, expected) << bits << " bits, bit " << bit;
      }
      for (int i = 0; i < count; ++i)
      {
        ASSERT_EQ(
          static_cast<Index>(packedBits(bytes.data(), std::int64_t{ i } * bits, bits)), numbers[i])
          << bits << " bits";
      }
    }
  }
}

} // namespace
} // namespace undecimate
