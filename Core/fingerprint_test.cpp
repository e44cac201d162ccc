// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fingerprint.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace undecimate
{
namespace
{

std::uint64_t fingerprintOf(const std::vector<unsigned char>& bytes)
{
  Fingerprint fingerprint;
  fingerprint.add(bytes.data(), bytes.size());
  return fingerprint.value();
}

std::uint64_t fingerprintOfTexts(const std::vector<std::string>& texts)
{
  Fingerprint fingerprint;
  for (const std::string& text : texts)
  {
    fingerprint.add(text);
  }
  return fingerprint.value();
}

TEST(Fingerprint, SameBytesSameValue)
{
  const std::vector<unsigned char> bytes{ 1, 2, 3, 4, 5 };
  EXPECT_EQ(fingerprintOf(bytes), fingerprintOf(bytes));
}

TEST(Fingerprint, EveryBitOfALongBufferCounts)
{
  std::vector<unsigned char> bytes(3000);
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    bytes[i] = static_cast<unsigned char>(i * 37);
  }
  std::set<std::uint64_t> values{ fingerprintOf(bytes) };
  std::size_t expected = 1;
  for (std::size_t i = 0; i < bytes.size(); i += 7)
  {
    for (const int bit : { 0, 3, 7 })
    {
      bytes[i] ^= static_cast<unsigned char>(1 << bit);
      values.insert(fingerprintOf(bytes));
      bytes[i] ^= static_cast<unsigned char>(1 << bit);
      ++expected;
    }
  }
  EXPECT_EQ(values.size(), expected);
}

TEST(Fingerprint, OrderAndLengthCount)
{
  EXPECT_NE(fingerprintOf(std::vector<unsigned char>{ 1, 2 }),
    fingerprintOf(std::vector<unsigned char>{ 2, 1 }));
  EXPECT_NE(fingerprintOf(std::vector<unsigned char>{ 0 }),
    fingerprintOf(std::vector<unsigned char>{ 0, 0 }));
  EXPECT_NE(
    fingerprintOf(std::vector<unsigned char>{}), fingerprintOf(std::vector<unsigned char>{ 0 }));
}

// Bytes are a stream: it does not matter in which pieces they come.
TEST(Fingerprint, PiecesOfBytesDoNotMatter)
{
  std::vector<unsigned char> bytes(1000);
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    bytes[i] = static_cast<unsigned char>(i * i);
  }
  Fingerprint pieces;
  for (std::size_t i = 0; i < bytes.size(); i += 100)
  {
    pieces.add(bytes.data() + i, 100);
    pieces.add(nullptr, 0);
  }
  EXPECT_EQ(pieces.value(), fingerprintOf(bytes));
}

TEST(Fingerprint, TextsCarryTheirLength)
{
  EXPECT_NE(fingerprintOfTexts({ "ab", "c" }), fingerprintOfTexts({ "a", "bc" }));
  EXPECT_NE(fingerprintOfTexts({ "ab" }), fingerprintOfTexts({ "ab", "" }));
  EXPECT_EQ(fingerprintOfTexts({ "Stress", "Displacement" }),
    fingerprintOfTexts({ "Stress", "Displacement" }));
}

TEST(Fingerprint, NumbersCount)
{
  Fingerprint one;
  one.add(std::int64_t{ 1 });
  Fingerprint two;
  two.add(std::int64_t{ 2 });
  EXPECT_NE(one.value(), two.value());
}

TEST(Fingerprint, ValueMayBeReadAnyTime)
{
  Fingerprint read;
  Fingerprint unread;
  read.add(std::int64_t{ 5 });
  unread.add(std::int64_t{ 5 });
  const std::uint64_t before = read.value();
  EXPECT_EQ(read.value(), before);
  read.add(std::int64_t{ 6 });
  unread.add(std::int64_t{ 6 });
  EXPECT_EQ(read.value(), unread.value());
  EXPECT_NE(read.value(), before);
}

} // namespace
} // namespace undecimate
