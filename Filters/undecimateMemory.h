// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateMemory.h
/// @brief Memory of arrays that is used again by the arrays of the next level.
///
/// The system gives fresh memory page by page, at each first touch, and that costs more than
/// copying a level into it. A level change frees arrays of nearly the size that it needs, so their
/// memory is kept for them.

#ifndef undecimateMemory_h
#define undecimateMemory_h

#include "vtkAbstractArray.h"
#include "vtkType.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

namespace undecimate
{
namespace filters
{

/// Gives plain arrays their memory and gets it back when the last user of an array's values goes,
/// also after the object itself is gone. Threads may let go of arrays at any time.
class ArrayMemory
{
public:
  ArrayMemory();
  ~ArrayMemory();
  ArrayMemory(const ArrayMemory&) = delete;
  ArrayMemory& operator=(const ArrayMemory&) = delete;

  /// Give an array of numbers in one block room for its tuples; the values are not set.
  void allocate(vtkAbstractArray* array, vtkIdType tuples);

  /// A new pass of the pipeline starts: free what came back before the last one and was not needed.
  void startPass();

  /// Bytes that wait to be used again.
  std::size_t idleBytes() const;

private:
  struct Shared;
  struct Block;
  static void release(void* values);

  std::shared_ptr<Shared> shared_;
};

} // namespace filters
} // namespace undecimate

#endif
