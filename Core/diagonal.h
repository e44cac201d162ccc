// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file diagonal.h
/// @brief The length in which distances are told.

#ifndef UNDECIMATE_CORE_DIAGONAL_H
#define UNDECIMATE_CORE_DIAGONAL_H

#include "threads.h"
#include "triangle_topology.h"

#include <cmath>
#include <mutex>

namespace undecimate
{

/// Length of the diagonal of the box around all finite points that a triangle uses; 0 if there is
/// none or it is infinite. O(triangles).
/// @param threads to share the work out among, or null; the result is the same
inline double diagonalOf(const TriangleTopology& topology, Threads* threads = nullptr)
{
  Box all;
  std::mutex mutex;
  doInShares(threads, topology.triangleCount(),
    [&](const Share& share)
    {
      Box box;
      for (Index t = share.begin; t < share.end; ++t)
      {
        for (const Index node : topology.triangle(t).nodes)
        {
          const Vector& p = topology.node(node).position;
          if (isFinite(p))
          {
            box.add(p);
          }
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      all.add(box);
    });
  const Vector size = all.high - all.low;
  const double diagonal = std::sqrt(dot(size, size));
  return std::isfinite(diagonal) ? diagonal : 0.0;
}

} // namespace undecimate

#endif
