// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file record_shapes.h
/// @brief How steps become shapes of the record: for those who write records.

#ifndef UNDECIMATE_CORE_RECORD_SHAPES_H
#define UNDECIMATE_CORE_RECORD_SHAPES_H

#include "compiler.h"
#include "large_array.h"
#include "record.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

namespace undecimate
{

constexpr int kTriangleCorners = 3;
constexpr int kMostCorners = 4;

// Local numbers are bytes.
constexpr int kMaximumLocals = 256;
static_assert(kMaximumRing < kNoLocal, "");

/// Old cells of a shape whose values no new cell takes.
inline int lostSourceCount(const unsigned char* shape, int corners)
{
  const int oldCount = shape[0];
  const int newCount = shape[1];
  const unsigned char* sources = shape + 3 + corners * (oldCount + newCount);
  std::uint64_t heirs = 0;
  for (int i = 0; i < newCount; ++i)
  {
    heirs |= std::uint64_t{ 1 } << sources[i];
  }
  return oldCount - countBits(heirs);
}

/// Finds shapes by their content: open addressing with linear probing, at most half full.
class ShapeTable
{
public:
  // Room for the longest shape, in whole words.
  static constexpr int kCapacity = (3 + (2 * kMostCorners + 1) * kMaximumPatchCells + 7) / 8 * 8;
  using Shape = std::array<unsigned char, kCapacity>;

  /// Number of a shape, which is added to `shapes` and `shapeOffsets` of the record if it is new.
  /// @param size its bytes; those up to the next multiple of 8 must be 0
  template <typename Shapes>
  Index number(const Shape& shape, int size, Shapes& record)
  {
    const std::uint64_t hash = hashOf(shape, size);
    std::size_t i = hash & this->mask();
    for (; this->entries_[i].number != kNone; i = (i + 1) & this->mask())
    {
      const Entry& entry = this->entries_[i];
      // Equal counts are equal lengths, and the first bytes are the counts.
      if (entry.hash == hash &&
        record.shapes.size() - entry.begin >= static_cast<std::size_t>(size) &&
        std::memcmp(record.shapes.data() + entry.begin, shape.data(), size) == 0)
      {
        return entry.number;
      }
    }
    const Index number = static_cast<Index>(record.shapeOffsets.size()) - 1;
    if (record.shapes.size() + size > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    {
      throw std::length_error("The table of shapes is too large.");
    }
    this->entries_[i] = { hash, record.shapeOffsets.back(), number };
    record.shapes.insert(record.shapes.end(), shape.begin(), shape.begin() + size);
    record.shapeOffsets.push_back(static_cast<Index>(record.shapes.size()));
    if (2 * record.shapeOffsets.size() > this->entries_.size())
    {
      this->grow();
    }
    return number;
  }

  void clear() { release(this->entries_); }

private:
  struct Entry
  {
    std::uint64_t hash;
    Index begin; // in Record::shapes
    Index number = kNone;
  };

  static std::uint64_t hashOf(const Shape& shape, int size)
  {
    std::uint64_t hash = 0;
    for (int i = 0; i < size; i += 8)
    {
      std::uint64_t word = 0;
      std::memcpy(&word, shape.data() + i, sizeof(word));
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29;
    }
    return hash ^ hash >> 32;
  }

  std::size_t mask() const { return this->entries_.size() - 1; }

  void grow()
  {
    std::vector<Entry> old(2 * this->entries_.size());
    old.swap(this->entries_);
    for (const Entry& entry : old)
    {
      if (entry.number != kNone)
      {
        std::size_t i = entry.hash & this->mask();
        while (this->entries_[i].number != kNone)
        {
          i = (i + 1) & this->mask();
        }
        this->entries_[i] = entry;
      }
    }
  }

  std::vector<Entry> entries_ = std::vector<Entry>(1024);
};

inline void padWithZeros(ShapeTable::Shape& shape, int size)
{
  std::fill_n(shape.begin() + size, (8 - size % 8) % 8, static_cast<unsigned char>(0));
}

/// The new cells of a step take over the sources of old ones.
/// @param[in,out] current source of each slot
/// @param[out] lost gets the sources of the old cells that no new one takes over
inline void inheritSources(const unsigned char* sources, int oldCount, int newCount,
  const Index* slots, std::vector<Index>& current, std::vector<Index>& lost)
{
  std::uint64_t heirs = 0;
  std::array<Index, kMaximumPatchCells> inherited;
  for (int i = 0; i < newCount; ++i)
  {
    heirs |= std::uint64_t{ 1 } << sources[i];
    inherited[i] = current[slots[sources[i]]];
  }
  for (int i = 0; i < oldCount; ++i)
  {
    if (((heirs >> i) & 1) == 0)
    {
      lost.push_back(current[slots[i]]);
    }
  }
  for (int i = 0; i < newCount; ++i)
  {
    current[slots[i]] = inherited[i];
  }
}

inline void add(std::vector<Index>& to, const Index* values, int count)
{
  for (int i = 0; i < count; ++i)
  {
    to.push_back(values[i]);
  }
}

/// A step as the record has it: its shape, and the nodes that no new cell has.
struct EncodedStep
{
  ShapeTable::Shape shape;
  int size = 0; // of the shape
  std::array<Index, kMaximumRing + 1> extraNodes;
  int extra = 0;
};

// Numbering by first appearance in the new cells makes equal patches equal shapes, and leaves the
// nodes that no new cell has with the last numbers.
template <int Corners>
EncodedStep encode(const RecordBuilder::Step& step, bool hasSources)
{
  EncodedStep encoded;
  std::array<unsigned char, kMaximumLocals> local; // of a position in the ring; 0 = none yet
  std::fill_n(local.begin(), step.ringSize + 1, static_cast<unsigned char>(0));
  local[kNoLocal] = kNoLocal;
  unsigned char locals = 0;
  ShapeTable::Shape& shape = encoded.shape;
  int size = 3 + Corners * (step.oldCount + step.newCount);
  unsigned char* oldLocals = shape.data() + 3;
  unsigned char* newLocals = oldLocals + Corners * step.oldCount;
  for (int i = 0; i < Corners * step.newCount; ++i)
  {
    const int position = step.newCells[i];
    const bool known = local[position] != 0;
    locals = static_cast<unsigned char>(locals + (known ? 0 : 1));
    local[position] = known ? local[position] : locals;
    newLocals[i] = local[position];
  }
  // Most often all nodes of the ring are known by now.
  if (locals < step.ringSize)
  {
    for (int i = 0; i < Corners * step.oldCount; ++i)
    {
      const int position = step.oldCells[i];
      if (position != 0 && local[position] == 0)
      {
        local[position] = ++locals;
        encoded.extraNodes[encoded.extra++] = step.ring[position - 1];
      }
    }
  }
  for (int i = 0; i < Corners * step.oldCount; ++i)
  {
    oldLocals[i] = local[step.oldCells[i]]; // that of the removed node stays 0
  }
  shape[0] = static_cast<unsigned char>(step.oldCount);
  shape[1] = static_cast<unsigned char>(step.newCount);
  shape[2] = static_cast<unsigned char>(encoded.extra);
  if (hasSources)
  {
    std::copy_n(step.sources, step.newCount, shape.begin() + size);
    size += step.newCount;
  }
  padWithZeros(shape, size);
  encoded.size = size;
  return encoded;
}

} // namespace undecimate

#endif
