// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file polygon_triangulations.h
/// @brief All triangulations of small polygons.

#ifndef UNDECIMATE_CORE_POLYGON_TRIANGULATIONS_H
#define UNDECIMATE_CORE_POLYGON_TRIANGULATIONS_H

#include <array>
#include <cstdint>
#include <vector>

namespace undecimate
{

/// Largest polygon whose triangulations are listed: nine corners have 429, ten would have 1430.
constexpr int kMaximumListedPolygon = 9;

/// The triangles that the corners of a polygon can form, and the sets of them that fill it.
class PolygonTriangulations
{
public:
  /// For a polygon of 3 .. kMaximumListedPolygon corners; made once, shared by all threads.
  static const PolygonTriangulations& of(int size);

  using Triangle = std::array<unsigned char, 3>; ///< corners, ascending

  const std::vector<Triangle>& triangles() const { return this->triangles_; }

  /// Number of triangulations (a Catalan number).
  int count() const { return this->count_; }

  /// Triangles in each: size - 2.
  int trianglesEach() const { return this->each_; }

  /// Positions in triangles() of triangulation i.
  const unsigned char* triangulation(int i) const
  {
    return this->triangulations_.data() + static_cast<std::size_t>(i) * this->each_;
  }

private:
  explicit PolygonTriangulations(int size);

  std::vector<Triangle> triangles_;
  std::vector<unsigned char> triangulations_;
  int each_;
  int count_ = 0;
};

} // namespace undecimate

#endif
