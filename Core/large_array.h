// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file large_array.h
/// @brief Arrays that are read here and there: in huge pages where the system has them.
///
/// The nodes of a mesh are visited in an order that memory does not know. With pages of 4 KiB nearly
/// every visit then waits for the address translation as well. Linux gives pages of 2 MiB to those
/// who ask (madvise); other systems, and arrays that are not large, get ordinary memory.

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

/// An allocator for std::vector. Costs at most a huge page more than std::allocator.
template <typename T>
class LargeArrayAllocator
{
public:
  using value_type = T;

  LargeArrayAllocator() = default;
  template <typename Other>
  LargeArrayAllocator(const LargeArrayAllocator<Other>&)
  {
  }

  /// Elements without an initializer are left as they are: large arrays are filled by their owners.
  template <typename Element>
  void construct(Element* element)
  {
    ::new (static_cast<void*>(element)) Element;
  }

  T* allocate(std::size_t count)
  {
    if (count > (std::numeric_limits<std::size_t>::max() - kHugePage) / sizeof(T))
    {
      throw std::bad_alloc();
    }
#ifdef __linux__
    if (isLarge(count))
    {
      // Whole huge pages.
      const std::size_t bytes = (count * sizeof(T) + kHugePage - 1) / kHugePage * kHugePage;
      void* memory = std::aligned_alloc(kHugePage, bytes);
      if (!memory)
      {
        throw std::bad_alloc();
      }
      // Only advice: without huge pages the memory is as good as any.
      static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
      return static_cast<T*>(memory);
    }
#endif
    return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t{ alignof(T) }));
  }

  void deallocate(T* memory, std::size_t count)
  {
#ifdef __linux__
    if (isLarge(count))
    {
      std::free(memory);
      return;
    }
#endif
    static_cast<void>(count);
    ::operator delete(memory, std::align_val_t{ alignof(T) });
  }

  friend bool operator==(const LargeArrayAllocator&, const LargeArrayAllocator&) { return true; }
  friend bool operator!=(const LargeArrayAllocator&, const LargeArrayAllocator&) { return false; }

private:
  static constexpr std::size_t kHugePage = std::size_t{ 1 } << 21;
  static bool isLarge(std::size_t count) { return count * sizeof(T) >= 2 * kHugePage; }
};

template <typename T>
using LargeArray = std::vector<T, LargeArrayAllocator<T>>;

} // namespace undecimate

#endif
