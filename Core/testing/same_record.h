// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file same_record.h
/// @brief Comparison of two records, part by part.

#ifndef UNDECIMATE_CORE_TESTING_SAME_RECORD_H
#define UNDECIMATE_CORE_TESTING_SAME_RECORD_H

#include "record.h"

#include <gtest/gtest.h>

namespace undecimate
{
namespace testing
{

inline void expectSame(const Record& a, const Record& b)
{
  EXPECT_EQ(a.nodeOrder, b.nodeOrder);
  EXPECT_EQ(a.cellOrder, b.cellOrder);
  EXPECT_EQ(a.stepShapes, b.stepShapes);
  EXPECT_EQ(a.stepErrors, b.stepErrors);
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.shapeOffsets, b.shapeOffsets);
  EXPECT_EQ(a.shapes, b.shapes);
  EXPECT_EQ(a.baseSources, b.baseSources);
  EXPECT_EQ(a.lostSources, b.lostSources);
}

} // namespace testing
} // namespace undecimate

#endif
