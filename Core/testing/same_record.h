// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file same_record.h
/// @brief Comparison of two records, part by part or by what they show.

#ifndef UNDECIMATE_CORE_TESTING_SAME_RECORD_H
#define UNDECIMATE_CORE_TESTING_SAME_RECORD_H

#include "record.h"
#include "undecimation.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace undecimate
{
namespace testing
{

inline void expectSame(const Record& a, const Record& b)
{
  EXPECT_EQ(a.nodeOrder, b.nodeOrder);
  EXPECT_EQ(a.cellOrder, b.cellOrder);
  EXPECT_EQ(a.stepErrors, b.stepErrors);
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.stepHoles, b.stepHoles);
  EXPECT_EQ(a.codes, b.codes);
  EXPECT_EQ(a.stepShapes, b.stepShapes);
  EXPECT_EQ(a.shapeOffsets, b.shapeOffsets);
  EXPECT_EQ(a.shapes, b.shapes);
  EXPECT_EQ(a.baseSources, b.baseSources);
  EXPECT_EQ(a.lostSources, b.lostSources);
  EXPECT_EQ(a.lostSourceCodes, b.lostSourceCodes);
}

/// Records of the same steps, with codes or with shapes: what is not in the forms is the same, and
/// so are the cells and their sources at `levels` levels and on the way back.
inline void expectSameLevels(const Record& a, const std::vector<Index>& baseA, const Record& b,
  const std::vector<Index>& baseB, int levels)
{
  EXPECT_EQ(baseA, baseB);
  EXPECT_EQ(a.nodeOrder, b.nodeOrder);
  EXPECT_TRUE(a.hasSources || a.cellOrder == b.cellOrder); // with codes and sources there is none
  EXPECT_EQ(a.stepErrors, b.stepErrors);
  EXPECT_EQ(a.baseSources, b.baseSources);
  Undecimation one;
  Undecimation other;
  const Outcome opened = one.open(a.view(), baseA.data());
  ASSERT_TRUE(opened) << opened.message;
  ASSERT_TRUE(other.open(b.view(), baseB.data()));
  ASSERT_EQ(one.stepCount(), other.stepCount());
  const auto sourcesOf = [](const Undecimation& cursor)
  {
    return cursor.record().hasSources
      ? std::vector<Index>(cursor.shownCells(), cursor.shownCells() + cursor.cellCount())
      : std::vector<Index>();
  };
  for (int i = -levels; i <= levels; ++i)
  {
    const Index steps =
      static_cast<Index>(std::int64_t{ one.stepCount() } * (levels - (i < 0 ? -i : i)) / levels);
    one.moveTo(steps);
    other.moveTo(steps);
    ASSERT_EQ(one.cellCount(), other.cellCount());
    const std::size_t corners = static_cast<std::size_t>(a.cornersPerCell) * one.cellCount();
    ASSERT_EQ(std::vector<Index>(one.cells(), one.cells() + corners),
      std::vector<Index>(other.cells(), other.cells() + corners));
    ASSERT_EQ(sourcesOf(one), sourcesOf(other));
  }
}

} // namespace testing
} // namespace undecimate

#endif
