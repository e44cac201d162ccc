// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateMemory.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <new>
#include <vector>

namespace undecimate
{
namespace filters
{

// The bookkeeping lies in front of the values, for all that VTK hands back is their address.
struct alignas(64) ArrayMemory::Block
{
  std::shared_ptr<Shared> owner; // null while idle
  std::size_t capacity;
  std::uint64_t pass; // in which it came back

  void* values() { return this + 1; }
};

struct ArrayMemory::Shared
{
  std::mutex mutex;
  std::vector<Block*> idle;
  std::uint64_t pass = 0;
  bool open = true;
};

namespace
{

// Small arrays gain nothing.
constexpr std::size_t kSmallest = 1 << 16;

} // namespace

ArrayMemory::ArrayMemory()
  : shared_(std::make_shared<Shared>())
{
}

ArrayMemory::~ArrayMemory()
{
  std::vector<Block*> idle;
  {
    const std::lock_guard<std::mutex> lock(this->shared_->mutex);
    this->shared_->open = false;
    idle.swap(this->shared_->idle);
  }
  for (Block* block : idle)
  {
    block->~Block();
    std::free(block);
  }
}

void ArrayMemory::allocate(vtkAbstractArray* array, vtkIdType tuples)
{
  const vtkIdType count = tuples * array->GetNumberOfComponents();
  const std::size_t bytes = static_cast<std::size_t>(count) * array->GetDataTypeSize();
  if (bytes < kSmallest)
  {
    array->SetNumberOfTuples(tuples);
    return;
  }
  Block* block = nullptr;
  {
    const std::lock_guard<std::mutex> lock(this->shared_->mutex);
    std::vector<Block*>& idle = this->shared_->idle;
    auto best = idle.end();
    for (auto it = idle.begin(); it != idle.end(); ++it)
    {
      const bool fits = (*it)->capacity >= bytes && (*it)->capacity / 2 <= bytes;
      if (fits && (best == idle.end() || (*it)->capacity < (*best)->capacity))
      {
        best = it;
      }
    }
    if (best != idle.end())
    {
      block = *best;
      idle.erase(best);
    }
  }
  if (!block)
  {
    // Room for levels a little finer; pages that are not touched are not there.
    const std::size_t capacity = bytes + bytes / 4;
    const std::size_t whole =
      (sizeof(Block) + capacity + alignof(Block) - 1) / alignof(Block) * alignof(Block);
    void* memory = std::aligned_alloc(alignof(Block), whole);
    if (!memory)
    {
      throw std::bad_alloc();
    }
    block = new (memory) Block;
    block->capacity = capacity;
  }
  block->owner = this->shared_;
  array->SetVoidArray(
    block->values(), count, /*save=*/0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction(&ArrayMemory::release);
}

void ArrayMemory::release(void* values)
{
  Block* block = static_cast<Block*>(values) - 1;
  const std::shared_ptr<Shared> owner = std::move(block->owner);
  {
    const std::lock_guard<std::mutex> lock(owner->mutex);
    if (owner->open)
    {
      block->pass = owner->pass;
      owner->idle.push_back(block);
      return;
    }
  }
  block->~Block();
  std::free(block);
}

void ArrayMemory::startPass()
{
  std::vector<Block*> old;
  {
    const std::lock_guard<std::mutex> lock(this->shared_->mutex);
    std::vector<Block*>& idle = this->shared_->idle;
    const std::uint64_t pass = this->shared_->pass++;
    const auto kept = std::partition(
      idle.begin(), idle.end(), [pass](const Block* block) { return block->pass >= pass; });
    old.assign(kept, idle.end());
    idle.erase(kept, idle.end());
  }
  for (Block* block : old)
  {
    block->~Block();
    std::free(block);
  }
}

std::size_t ArrayMemory::idleBytes() const
{
  const std::lock_guard<std::mutex> lock(this->shared_->mutex);
  std::size_t bytes = 0;
  for (const Block* block : this->shared_->idle)
  {
    bytes += block->capacity;
  }
  return bytes;
}

} // namespace filters
} // namespace undecimate
