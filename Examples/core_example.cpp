// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// The algorithms alone: C++17, no VTK. Decimates a wavy grid and brings half of it back.

#include "hash_queue_decimation.h"
#include "undecimation.h"

#include <cmath>
#include <cstdio>

int main()
{
  using namespace undecimate;
  const Index n = 100;
  std::vector<float> points;
  std::vector<Index> triangles;
  for (Index i = 0; i < n * n; ++i)
  {
    const float x = static_cast<float>(i % n) / n;
    const float y = static_cast<float>(i / n) / n;
    points.insert(points.end(), { x, y, 0.1F * std::sin(6.0F * x) * std::cos(4.0F * y) });
    if (i % n < n - 1 && i / n < n - 1)
    {
      triangles.insert(triangles.end(), { i, i + 1, i + n + 1, i, i + n + 1, i + n });
    }
  }

  TriangleMeshView mesh;
  mesh.pointsFloat = points.data();
  mesh.nodeCount = n * n;
  mesh.triangles = triangles.data();
  mesh.triangleCount = static_cast<std::int64_t>(triangles.size()) / 3;
  HashQueueDecimationOptions options;
  options.targetReduction = 0.95;
  Monitor monitor;
  HashQueueDecimationResult result;
  if (const Outcome outcome = decimate(mesh, options, monitor, result); !outcome)
  {
    std::fprintf(stderr, "%s\n", outcome.message.c_str());
    return 1;
  }

  Undecimation cursor;
  if (const Outcome outcome = cursor.open(result.record.view(), result.baseTriangles.data());
      !outcome)
  {
    std::fprintf(stderr, "%s\n", outcome.message.c_str());
    return 1;
  }
  for (const double level : { 0.0, 0.5, 1.0 })
  {
    cursor.moveTo(cursor.stepsForLevel(level)); // cursor.cells(): corners, in record order
    std::printf("level %.1f: %d nodes, %d triangles, error %.5f of the diagonal\n", level,
      cursor.nodeCount(), cursor.cellCount(), cursor.error());
  }
  return 0;
}
