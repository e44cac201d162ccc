// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file compiler.h
/// @brief The few things for which compilers have words of their own.

#ifndef UNDECIMATE_CORE_COMPILER_H
#define UNDECIMATE_CORE_COMPILER_H

#include <cstdint>

#ifdef _MSC_VER
#include <intrin.h>
#endif

/// A function whose code is to stand in its caller's, whatever that is compiled for.
#if defined(__GNUC__) || defined(__clang__)
#define UNDECIMATE_INLINE inline __attribute__((always_inline))
#else
#define UNDECIMATE_INLINE inline
#endif

/// A function with loops that profit from wide vectors: one binary runs everywhere, and uses wider
/// ones where there are some. Fused multiply-add stays off, so that results do not depend on the
/// machine. (What chooses between them runs before the thread sanitizer is ready.)
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
  !defined(__SANITIZE_THREAD__)
#define UNDECIMATE_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define UNDECIMATE_VECTOR_CLONES
#endif

/// Before a loop over the lanes of a vector, which is to become vector instructions: no iteration
/// reads what another one writes. Unrolled too early it would become many scalar instructions.
#if defined(__GNUC__) && !defined(__clang__)
#define UNDECIMATE_LANES _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define UNDECIMATE_LANES
#endif

namespace undecimate
{

/// Ask for the cache line of an address that will be used soon. Any address will do.
inline void prefetch(const void* address)
{
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
  // The compiler drops the call of a function that does nothing but prefetch, unless it does this.
  __asm__ volatile("" : : "r"(address));
#elif defined(_M_X64)
  _mm_prefetch(static_cast<const char*>(address), _MM_HINT_T0);
#else
  static_cast<void>(address);
#endif
}

/// Number of the lowest bit that is set. The word must not be 0.
inline int lowestBit(std::uint64_t word)
{
#if defined(__GNUC__) || defined(__clang__)
  return __builtin_ctzll(word);
#elif defined(_MSC_VER) && defined(_WIN64)
  unsigned long bit = 0;
  _BitScanForward64(&bit, word);
  return static_cast<int>(bit);
#else
  int bit = 0;
  while ((word >> bit & 1) == 0)
  {
    ++bit;
  }
  return bit;
#endif
}

/// Number of bits that are set.
inline int countBits(std::uint64_t word)
{
#if defined(__GNUC__) || defined(__clang__)
  return __builtin_popcountll(word);
#else
  int count = 0;
  for (; word != 0; word &= word - 1)
  {
    ++count;
  }
  return count;
#endif
}

} // namespace undecimate

#endif
