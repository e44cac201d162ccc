// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file with_shapes.h
/// @brief Records of triangles as older files have them: with shapes instead of codes.

#ifndef UNDECIMATE_CORE_TESTING_WITH_SHAPES_H
#define UNDECIMATE_CORE_TESTING_WITH_SHAPES_H

#include "hole_code.h"
#include "record.h"
#include "undecimation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace undecimate
{
namespace testing
{

/// The steps of a record with codes, written by RecordBuilder as they are seen from outside: by the
/// cells before and after each of them.
/// @param[out] base the cells of the coarsest level for the new record
inline Record withShapes(
  const Record& record, const std::vector<Index>& recordBase, std::vector<Index>& base)
{
  Undecimation cursor;
  EXPECT_TRUE(cursor.open(record.view(), recordBase.data()));
  RecordBuilder builder(record.nodeCount, record.cellCount, record.hasSources);
  const auto originalCells = [&](const std::vector<Index>& slots)
  {
    std::vector<Index> nodes;
    for (const Index slot : slots)
    {
      for (int corner = 0; corner < 3; ++corner)
      {
        nodes.push_back(record.nodeOrder[cursor.cells()[std::size_t{ 3 } * slot + corner]]);
      }
    }
    return nodes;
  };
  cursor.moveTo(cursor.stepCount());
  const int bits = record.view().numberBits();
  std::size_t end = record.codes.size() - kPackedPadding;
  const std::vector<Index> cellOrder(cursor.shownCells(), cursor.shownCells() + record.cellCount);
  while (cursor.steps() > 0)
  {
    const Index place = cursor.steps() - 1;
    const HoleCounts& counts = kHoles[record.stepHoles[place]];
    end -= counts.codeSize(record.hasSources, bits);
    const HoleCode code(counts, record.codes.data() + end, record.hasSources, bits);
    std::vector<Index> slots;
    for (int i = 0; i < counts.newCount; ++i)
    {
      slots.push_back(code.number(i));
    }
    const Index gone = counts.oldCount - counts.newCount;
    for (Index i = 0; i < gone; ++i)
    {
      slots.push_back(cursor.cellCount() - gone + i);
    }
    const std::vector<Index> oldNodes = originalCells(slots);
    cursor.moveTo(place);
    const std::vector<Index> newNodes =
      originalCells({ slots.begin(), slots.begin() + counts.newCount });

    RecordBuilder::Step step;
    step.node = record.nodeOrder[record.baseNodeCount + place];
    std::vector<Index> ring;
    const auto positions = [&](const std::vector<Index>& nodes)
    {
      std::vector<unsigned char> found;
      for (const Index node : nodes)
      {
        auto at = std::find(ring.begin(), ring.end(), node);
        if (node != step.node && at == ring.end())
        {
          at = ring.insert(at, node);
        }
        found.push_back(static_cast<unsigned char>(node == step.node ? 0 : at - ring.begin() + 1));
      }
      return found;
    };
    const std::vector<unsigned char> oldCells = positions(oldNodes);
    const std::vector<unsigned char> newCells = positions(newNodes);
    std::array<unsigned char, kMaximumPatchCells> sources{};
    for (int i = 0; record.hasSources && i < counts.newCount; ++i)
    {
      sources[i] = static_cast<unsigned char>(code.source(i));
    }
    for (Index& slot : slots)
    {
      slot = cellOrder[slot];
    }
    step.ring = ring.data();
    step.ringSize = static_cast<int>(ring.size());
    step.oldCount = counts.oldCount;
    step.newCount = counts.newCount;
    step.slots = slots.data();
    step.oldCells = oldCells.data();
    step.newCells = newCells.data();
    step.sources = sources.data();
    step.error = record.stepErrors[place];
    builder.append(step);
  }
  std::vector<Index> slotOf(record.cellCount);
  for (Index slot = 0; slot < record.cellCount; ++slot)
  {
    slotOf[cellOrder[slot]] = slot;
  }
  return builder.finish(
    [&](Index cell, Index* corners)
    {
      const std::vector<Index> nodes = originalCells({ slotOf[cell] });
      std::copy(nodes.begin(), nodes.end(), corners);
    },
    base);
}

} // namespace testing
} // namespace undecimate

#endif
