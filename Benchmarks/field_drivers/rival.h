// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file rival.h
/// @brief What a compiled rival exports, and field_rivals.py calls through ctypes.
///
/// A mesh is points (x, y, z of each node, double), triangles (three node numbers each) and, where
/// wanted, one value per node. A handle holds a mesh in the rival's own structure.

#pragma once

#include <cstdint>

extern "C"
{
  /// Builds the rival's structure.
  /// @param values one value per node in any unit, or null for geometry alone
  /// @return the handle, or null if the rival cannot hold the mesh (e.g. non-manifold edges)
  void* rivalCreate(const double* points, std::int64_t nodeCount, const std::int32_t* triangles,
    std::int64_t triangleCount, const double* values);

  /// Decimates to `triangles` or as near as the rival comes; this call alone is timed. @return 0,
  /// or 1 if the rival refused.
  int rivalRun(void* handle, std::int64_t triangles);

  std::int64_t rivalNodeCount(const void* handle);
  std::int64_t rivalTriangleCount(const void* handle);

  /// @return 1 if rivalGet() fills the values
  int rivalHasValues(const void* handle);

  /// Copies the result into arrays of rivalNodeCount() and rivalTriangleCount() entries; `values`
  /// may be null.
  void rivalGet(const void* handle, double* points, std::int32_t* triangles, double* values);

  void rivalDestroy(void* handle);

  /// @return version of the library, a constant string
  const char* rivalVersion();
}
