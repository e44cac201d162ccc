// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file packed_numbers.h
/// @brief Numbers of a few bits each in a row of bytes.
///
/// Bits are counted from the lowest bit of the first byte upwards, on any machine. Reading takes
/// eight bytes at once: behind the last byte that has a bit there must be kPackedPadding more.

#ifndef UNDECIMATE_CORE_PACKED_NUMBERS_H
#define UNDECIMATE_CORE_PACKED_NUMBERS_H

#include "types.h"

#include <cstddef>
#include <cstdint>

namespace undecimate
{

/// Bytes 0 behind packed numbers, so that the last one can be read like the others.
constexpr int kPackedPadding = 7;

/// Bits of the numbers 0 .. count - 1; at least 1.
constexpr int bitsBelow(Index count)
{
  int bits = 1;
  while (bits < 31 && (count - 1) >> bits > 0)
  {
    ++bits;
  }
  return bits;
}

/// Bytes of so many bits, with the padding.
constexpr std::int64_t packedSize(std::int64_t bits)
{
  return (bits + 7) / 8 + kPackedPadding;
}

/// The number of `width` bits (1 to 32) that begins at a bit.
inline std::uint32_t packedBits(const unsigned char* bytes, std::int64_t bit, int width)
{
  const unsigned char* b = bytes + (bit >> 3);
  // Compilers make one instruction of this where they may.
  const std::uint64_t word = std::uint64_t{ b[0] } | std::uint64_t{ b[1] } << 8 |
    std::uint64_t{ b[2] } << 16 | std::uint64_t{ b[3] } << 24 | std::uint64_t{ b[4] } << 32 |
    std::uint64_t{ b[5] } << 40 | std::uint64_t{ b[6] } << 48 | std::uint64_t{ b[7] } << 56;
  return static_cast<std::uint32_t>(word >> (bit & 7) & ((std::uint64_t{ 1 } << width) - 1));
}

/// Writes bits from a byte on; nothing behind the last one.
class BitWriter
{
public:
  explicit BitWriter(unsigned char* bytes)
    : bytes_(bytes)
  {
  }

  /// @param bits at most 32; the value has no others
  void add(std::uint32_t value, int bits)
  {
    this->word_ |= std::uint64_t{ value } << this->used_;
    for (this->used_ += bits; this->used_ >= 8; this->used_ -= 8)
    {
      *this->bytes_++ = static_cast<unsigned char>(this->word_);
      this->word_ >>= 8;
    }
  }

  /// The last byte, filled up with 0.
  void finish()
  {
    if (this->used_ > 0)
    {
      *this->bytes_ = static_cast<unsigned char>(this->word_);
    }
  }

private:
  unsigned char* bytes_;
  std::uint64_t word_ = 0;
  int used_ = 0;
};

} // namespace undecimate

#endif
