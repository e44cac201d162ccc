// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file meshoptimizer.cpp
/// @brief meshoptimizer as a rival. RIVAL_VARIANT: 0 simplify, 1 simplifySloppy, 2
/// simplifyWithAttributes, 3 simplifyWithUpdate (moves the nodes it keeps), 4 the same, steered by
/// the values.

#include "rival.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cfloat>
#include <vector>

namespace
{

/// Of the values, scaled to a range of 1: what meshoptimizer's documentation starts from.
constexpr float kAttributeWeight = 0.5F;
/// simplifyWithUpdate: 1e-3 carries the values along and hardly steers.
constexpr float kUpdateWeight = RIVAL_VARIANT == 4 ? kAttributeWeight : 1e-3F;

struct Handle
{
  std::vector<float> points;
  std::vector<unsigned> triangles;
  std::vector<float> scaled;
  std::vector<double> values;
  double low = 0.0;
  double range = 1.0;
  std::vector<int> nodes; // original node of each node of the result
};

/// Numbers the nodes in use by their first appearance.
void numberNodes(Handle& h)
{
  std::vector<int> newNumber(h.points.size() / 3, -1);
  h.nodes.clear();
  for (unsigned& node : h.triangles)
  {
    if (newNumber[node] < 0)
    {
      newNumber[node] = static_cast<int>(h.nodes.size());
      h.nodes.push_back(static_cast<int>(node));
    }
    node = static_cast<unsigned>(newNumber[node]);
  }
}

} // namespace

void* rivalCreate(const double* points, std::int64_t nodeCount, const std::int32_t* triangles,
  std::int64_t triangleCount, const double* values)
{
  auto* h = new Handle;
  h->points.assign(points, points + 3 * nodeCount);
  h->triangles.assign(triangles, triangles + 3 * triangleCount);
  if (values != nullptr)
  {
    h->values.assign(values, values + nodeCount);
    const auto ends = std::minmax_element(h->values.begin(), h->values.end());
    h->low = *ends.first;
    h->range = *ends.second > h->low ? *ends.second - h->low : 1.0;
    for (const double value : h->values)
    {
      h->scaled.push_back(static_cast<float>((value - h->low) / h->range));
    }
  }
  return h;
}

int rivalRun(void* handle, std::int64_t triangles)
{
  Handle& h = *static_cast<Handle*>(handle);
  const std::size_t nodeCount = h.points.size() / 3;
  const std::size_t stride = 3 * sizeof(float);
  const std::size_t wanted = 3 * static_cast<std::size_t>(triangles);
  float error = 0.0F;
  std::size_t size = 0;
#if RIVAL_VARIANT == 0
  std::vector<unsigned> out(h.triangles.size());
  size = meshopt_simplify(out.data(), h.triangles.data(), h.triangles.size(), h.points.data(),
    nodeCount, stride, wanted, FLT_MAX, 0, &error);
  h.triangles.swap(out);
#elif RIVAL_VARIANT == 1
  std::vector<unsigned> out(h.triangles.size());
  size = meshopt_simplifySloppy(out.data(), h.triangles.data(), h.triangles.size(), h.points.data(),
    nodeCount, stride, nullptr, wanted, FLT_MAX, &error);
  h.triangles.swap(out);
#elif RIVAL_VARIANT == 2
  std::vector<unsigned> out(h.triangles.size());
  size = meshopt_simplifyWithAttributes(out.data(), h.triangles.data(), h.triangles.size(),
    h.points.data(), nodeCount, stride, h.scaled.data(), sizeof(float), &kAttributeWeight,
    h.scaled.empty() ? 0 : 1, nullptr, wanted, FLT_MAX, 0, &error);
  h.triangles.swap(out);
#else
  size = meshopt_simplifyWithUpdate(h.triangles.data(), h.triangles.size(), h.points.data(),
    nodeCount, stride, h.scaled.data(), sizeof(float), &kUpdateWeight, h.scaled.empty() ? 0 : 1,
    nullptr, wanted, FLT_MAX, 0, &error);
#endif
  h.triangles.resize(size);
  numberNodes(h);
  return 0;
}

std::int64_t rivalNodeCount(const void* handle)
{
  return static_cast<std::int64_t>(static_cast<const Handle*>(handle)->nodes.size());
}

std::int64_t rivalTriangleCount(const void* handle)
{
  return static_cast<std::int64_t>(static_cast<const Handle*>(handle)->triangles.size() / 3);
}

int rivalHasValues(const void* handle)
{
  return static_cast<const Handle*>(handle)->values.empty() ? 0 : 1;
}

void rivalGet(const void* handle, double* points, std::int32_t* triangles, double* values)
{
  const Handle& h = *static_cast<const Handle*>(handle);
  for (std::size_t i = 0; i < h.nodes.size(); ++i)
  {
    const auto node = static_cast<std::size_t>(h.nodes[i]);
    std::copy_n(&h.points[3 * node], 3, points + 3 * i);
    if (values != nullptr)
    {
#if RIVAL_VARIANT >= 3
      values[i] = h.low + h.range * static_cast<double>(h.scaled[node]);
#else
      values[i] = h.values[node];
#endif
    }
  }
  std::copy(h.triangles.begin(), h.triangles.end(), triangles);
}

void rivalDestroy(void* handle)
{
  delete static_cast<Handle*>(handle);
}

const char* rivalVersion()
{
#define RIVAL_TEXT(x) #x
#define RIVAL_VALUE(x) RIVAL_TEXT(x)
  return RIVAL_VALUE(MESHOPTIMIZER_VERSION);
}
