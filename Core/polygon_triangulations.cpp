// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "polygon_triangulations.h"

namespace undecimate
{

namespace
{

using Sets = std::vector<std::vector<unsigned char>>;

// All triangulations of the part of the polygon from corner `first` to corner `last`: the edge
// between them has a triangle with some corner in between, and two smaller parts are left.
Sets triangulate(int first, int last, const std::array<std::array<std::array<int, 9>, 9>, 9>& number)
{
  if (last - first < 2)
  {
    return { {} };
  }
  Sets all;
  for (int apex = first + 1; apex < last; ++apex)
  {
    const Sets lower = triangulate(first, apex, number);
    const Sets upper = triangulate(apex, last, number);
    for (const auto& a : lower)
    {
      for (const auto& b : upper)
      {
        all.push_back({ static_cast<unsigned char>(number[first][apex][last]) });
        all.back().insert(all.back().end(), a.begin(), a.end());
        all.back().insert(all.back().end(), b.begin(), b.end());
      }
    }
  }
  return all;
}

} // namespace

PolygonTriangulations::PolygonTriangulations(int size)
  : each_(size - 2)
{
  std::array<std::array<std::array<int, 9>, 9>, 9> number{};
  for (int i = 0; i < size; ++i)
  {
    for (int j = i + 1; j < size; ++j)
    {
      for (int k = j + 1; k < size; ++k)
      {
        number[i][j][k] = static_cast<int>(this->triangles_.size());
        this->triangles_.push_back({ static_cast<unsigned char>(i),
          static_cast<unsigned char>(j), static_cast<unsigned char>(k) });
      }
    }
  }
  for (const auto& set : triangulate(0, size - 1, number))
  {
    this->triangulations_.insert(this->triangulations_.end(), set.begin(), set.end());
    ++this->count_;
  }
}

const PolygonTriangulations& PolygonTriangulations::of(int size)
{
  static const std::array<PolygonTriangulations, kMaximumListedPolygon - 2> all{
    PolygonTriangulations(3), PolygonTriangulations(4), PolygonTriangulations(5),
    PolygonTriangulations(6), PolygonTriangulations(7), PolygonTriangulations(8),
    PolygonTriangulations(9)
  };
  return all[size - 3];
}

} // namespace undecimate
