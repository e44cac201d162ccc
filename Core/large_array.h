// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file large_array.h
/// @brief Arrays that are read here and there: in huge pages where the system has them.
///
/// The nodes of a mesh are visited in an order that memory does not know. With pages of 4 KiB
/// nearly every visit then waits for the address translation as well. Linux gives pages of 2 MiB to
/// those who ask (madvise); other systems, and arrays that are not large, get ordinary memory.
///
/// Large blocks of memory all begin at the same place in a page. A processor that compares only
/// this place lets a read of an array wait for a write to the same index of another one. So arrays
/// that are used together get different shifts.

#ifndef UNDECIMATE_CORE_LARGE_ARRAY_H
#define UNDECIMATE_CORE_LARGE_ARRAY_H

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace undecimate
{

/// Bytes. What different threads write all the time is to be in different lines.
constexpr std::size_t kCacheLine = 64;

/// Whether the elements of a new array are left as the memory is: the owner begins their lives, in
/// shares of several threads. Elements without an initializer always are.
template <typename T>
inline constexpr bool kMadeByOwner = false;

/// An allocator for std::vector. Costs no memory beside the array, but up to a huge page of address
/// space.
/// @tparam Shift 0 to 3: arrays of different shifts begin at different places in a page
template <typename T, int Shift>
class LargeArrayAllocator
{
public:
  using value_type = T;

  template <typename Other>
  struct rebind // NOLINT(readability-identifier-naming): the standard library asks for it
  {
    using other = LargeArrayAllocator<Other, Shift>;
  };

  LargeArrayAllocator() = default;
  template <typename Other>
  LargeArrayAllocator(const LargeArrayAllocator<Other, Shift>&)
  {
  }

  /// Elements without an initializer are left as they are: large arrays are filled by their owners.
  template <typename Element>
  void construct(Element* element)
  {
    if constexpr (!kMadeByOwner<Element>)
    {
      ::new (static_cast<void*>(element)) Element;
    }
  }

  T* allocate(std::size_t count)
  {
    if (count > (std::numeric_limits<std::size_t>::max() - kOffset - kHugePage) / sizeof(T))
    {
      throw std::bad_alloc();
    }
    return reinterpret_cast<T*>(allocateBytes(byteSize(count)) + kOffset);
  }

  void deallocate(T* array, std::size_t count)
  {
    char* memory = reinterpret_cast<char*>(array) - kOffset;
#ifdef __linux__
    if (isLarge(byteSize(count)))
    {
      std::free(memory);
      return;
    }
#endif
    static_cast<void>(count);
    ::operator delete (memory, std::align_val_t{ kCacheLine });
  }

  friend bool operator==(const LargeArrayAllocator&, const LargeArrayAllocator&)
  {
    return true;
  }
  friend bool operator!=(const LargeArrayAllocator&, const LargeArrayAllocator&)
  {
    return false;
  }

private:
  static constexpr std::size_t kHugePage = std::size_t{ 1 } << 21;
  static constexpr std::size_t kOffset = Shift * 16 * kCacheLine; // quarters of the smallest page
  static_assert(alignof(T) <= kCacheLine && Shift >= 0 && Shift < 4, "");

  // In whole cache lines: what other threads write is not beside it.
  static std::size_t byteSize(std::size_t count)
  {
    return (count * sizeof(T) + kOffset + kCacheLine - 1) / kCacheLine * kCacheLine;
  }
  static bool isLarge(std::size_t bytes)
  {
    return bytes >= 2 * kHugePage;
  }

  static char* allocateBytes(std::size_t bytes)
  {
#ifdef __linux__
    if (isLarge(bytes))
    {
      // Not in whole huge pages: of the last one, only what is needed is to be there.
      void* memory = nullptr;
      if (posix_memalign(&memory, kHugePage, bytes) != 0)
      {
        throw std::bad_alloc();
      }
      // Only advice: without huge pages the memory is as good as any.
      static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
      return static_cast<char*>(memory);
    }
#endif
    return static_cast<char*>(::operator new (bytes, std::align_val_t{ kCacheLine }));
  }
};

/// Give the memory of a vector back; an assignment of {} would only empty it.
template <typename Vector>
void release(Vector& vector)
{
  Vector().swap(vector);
}

template <typename T, int Shift = 0>
using LargeArray = std::vector<T, LargeArrayAllocator<T, Shift>>;

} // namespace undecimate

#endif
