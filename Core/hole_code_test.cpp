// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hole_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

TEST(HoleCounts, OfEachByte)
{
  int holes = 0;
  for (int byte = 0; byte < 256; ++byte)
  {
    const HoleCounts& counts = kHoles[static_cast<unsigned char>(byte)];
    const int n = byte % 128;
    const bool boundary = byte >= 128;
    SCOPED_TRACE(byte);
    // Around an interior node there are three triangles or more.
    if (n > 64 || n < (boundary ? 1 : 3))
    {
      EXPECT_EQ(counts.oldCount, 0);
      EXPECT_EQ(counts.newCount, 0);
      EXPECT_EQ(counts.codeSize(true, 20), 0);
      continue;
    }
    ++holes;
    EXPECT_EQ(holeOf(n, boundary), byte);
    EXPECT_EQ(counts.oldCount, n);
    EXPECT_EQ(counts.newCount, boundary ? n - 1 : n - 2);
    EXPECT_EQ(counts.ringSize, counts.newCount + 2);
    EXPECT_EQ(counts.extra, counts.newCount == 0 ? 2 : 0);
    EXPECT_GE(1 << counts.placeBits, counts.ringSize);
    EXPECT_LT(1 << (counts.placeBits - 1), counts.ringSize);
  }
  EXPECT_EQ(holes, 62 + 64);
}

TEST(HoleCounts, SizesOfCodes)
{
  EXPECT_EQ(kHoles[5].codeSize(false, 1), 3); // 10 + 3 * (3 + 1) bits
  EXPECT_EQ(kHoles[5].codeSize(true, 1), 4);
  EXPECT_EQ(kHoles[5].codeSize(false, 21), 11);
  EXPECT_EQ(kHoles[6].codeSize(false, 4), 5); // 12 + 4 * (3 + 4)
  EXPECT_EQ(kHoles[6].codeSize(false, 21), 14);
  EXPECT_EQ(kHoles[10].codeSize(false, 21), 28);
  EXPECT_EQ(kHoles[64].codeSize(true, 31), 350);
  EXPECT_EQ(kHoles[holeOf(64, true)].codeSize(true, 31), 371); // a ring of 65 nodes: 7 bits
  EXPECT_EQ(kHoles[holeOf(1, true)].codeSize(true, 21), 6);    // two nodes
}

// What was written is read, by the bits that the file comment promises, and nothing beside the code
// is written or decides what is read.
TEST(HoleCode, RandomCodesComeBack)
{
  std::mt19937 random(5);
  for (int round = 0; round < 3000; ++round)
  {
    const bool sources = random() % 2 == 0;
    const bool boundary = random() % 3 == 0;
    const int n = static_cast<int>(boundary ? 1 + random() % 64 : 3 + random() % 62);
    const HoleCounts& counts = kHoles[holeOf(n, boundary)];
    std::vector<int> corners(counts.oldCount);
    std::vector<int> ears(counts.newCount);
    std::vector<int> from(sources ? counts.newCount : 0);
    std::generate(corners.begin(), corners.end(), [&] { return random() % 3; });
    std::generate(ears.begin(), ears.end(), [&] { return random() % counts.ringSize; });
    std::generate(from.begin(), from.end(), [&] { return random() % counts.oldCount; });
    const int numberBits = 1 + static_cast<int>(random() % 31);
    std::vector<int> numbers(counts.newCount + counts.extra);
    std::generate(numbers.begin(), numbers.end(),
      [&] { return static_cast<int>(random() & ((std::uint32_t{ 1 } << numberBits) - 1)); });

    const int size = counts.codeSize(sources, numberBits);
    constexpr unsigned char kUntouched = 0xA5;
    std::vector<unsigned char> bytes(size + 1 + kPackedPadding, kUntouched);
    BitWriter writer(bytes.data() + 1);
    std::vector<bool> bits;
    const auto add = [&](const std::vector<int>& values, int width)
    {
      for (const int value : values)
      {
        writer.add(static_cast<unsigned>(value), width);
        for (int bit = 0; bit < width; ++bit)
        {
          bits.push_back((value >> bit & 1) != 0);
        }
      }
    };
    add(corners, 2);
    add(ears, counts.placeBits);
    add(from, counts.placeBits);
    add(numbers, numberBits);
    writer.finish();
    ASSERT_EQ(bytes.front(), kUntouched);
    ASSERT_EQ(std::count(bytes.begin() + 1 + size, bytes.end(), kUntouched), kPackedPadding);
    ASSERT_LE(bits.size(), std::size_t{ 8 } * size);
    ASSERT_GT(bits.size() + 8, std::size_t{ 8 } * size);
    for (std::size_t i = 0; i < std::size_t{ 8 } * size; ++i)
    {
      ASSERT_EQ((bytes[1 + i / 8] >> i % 8 & 1) != 0, i < bits.size() && bits[i]) << i;
    }

    const HoleCode code(counts, bytes.data() + 1, sources, numberBits);
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      ASSERT_EQ(code.corner(static_cast<int>(i)), corners[i]);
    }
    for (std::size_t i = 0; i < ears.size(); ++i)
    {
      ASSERT_EQ(code.ear(static_cast<int>(i)), ears[i]);
    }
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      ASSERT_EQ(code.source(static_cast<int>(i)), from[i]);
    }
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      ASSERT_EQ(code.number(static_cast<int>(i)), numbers[i]);
    }
  }
}

// Against a list from which the ears are erased.
TEST(EarCutPolygon, NeighboursOfEars)
{
  std::mt19937 random(6);
  for (int size = 3; size <= kMaximumPolygon; ++size)
  {
    std::vector<int> left(size);
    std::iota(left.begin(), left.end(), 0);
    EarCutPolygon polygon(size);
    while (left.size() > 2)
    {
      const std::size_t place = random() % left.size();
      polygon.cut(left[place],
        [&](int before, int ear, int behind)
        {
          EXPECT_EQ(before, left[(place + left.size() - 1) % left.size()]);
          EXPECT_EQ(ear, left[place]);
          EXPECT_EQ(behind, left[(place + 1) % left.size()]);
        });
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
    }
  }
}

} // namespace
} // namespace undecimate
