// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file decimated.h
/// @brief A decimated mesh with its cursor, for tests.

#ifndef UNDECIMATE_CORE_TESTING_DECIMATED_H
#define UNDECIMATE_CORE_TESTING_DECIMATED_H

#include "hash_queue_decimation.h"
#include "meshes.h"
#include "same_record.h"
#include "undecimation.h"

#include <functional>
#include <set>
#include <vector>

namespace undecimate
{
namespace testing
{

/// Nodal values by a function of the position.
inline std::vector<float> valuesOn(
  const Mesh& mesh, const std::function<double(double, double, double)>& value)
{
  std::vector<float> values;
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    const auto p = mesh.point(i);
    values.push_back(static_cast<float>(value(p[0], p[1], p[2])));
  }
  return values;
}

inline NodalArrayView arrayOf(const std::vector<float>& values, int components = 1)
{
  NodalArrayView view;
  view.values = values.data();
  view.components = components;
  view.name = "Result";
  return view;
}

/// A decimation that succeeded, and a cursor that stands at level 0.
struct Decimated
{
  HashQueueDecimationResult result;
  Undecimation cursor;

  Decimated(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options)
  {
    Monitor monitor;
    const Outcome outcome = decimate(mesh, options, monitor, this->result);
    EXPECT_TRUE(outcome) << outcome.message;
    const Outcome opened =
      this->cursor.open(this->result.record.view(), this->result.baseTriangles.data());
    EXPECT_TRUE(opened) << opened.message;
  }
  Decimated(const Mesh& mesh, const HashQueueDecimationOptions& options)
    : Decimated(mesh.view(), options)
  {
  }

  Index steps() const { return this->cursor.stepCount(); }

  /// Original numbers of the nodes of level 0.
  std::set<Index> baseNodes() const
  {
    const auto& order = this->result.record.nodeOrder;
    return { order.begin(), order.begin() + this->result.record.baseNodeCount };
  }

  /// Original numbers of the removed nodes, in the order of their removal.
  std::vector<Index> removed() const
  {
    const auto& order = this->result.record.nodeOrder;
    return { order.rbegin(), order.rend() - this->result.record.baseNodeCount };
  }
};

inline void expectSame(const HashQueueDecimationResult& a, const HashQueueDecimationResult& b)
{
  expectSame(a.record, b.record);
  EXPECT_EQ(a.baseTriangles, b.baseTriangles);
  EXPECT_EQ(a.stopReason, b.stopReason);
  EXPECT_EQ(a.error, b.error);
}

} // namespace testing
} // namespace undecimate

#endif
