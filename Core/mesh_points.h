// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file mesh_points.h
/// @brief Reads the caller's coordinates, float or double, without a copy.

#ifndef UNDECIMATE_CORE_MESH_POINTS_H
#define UNDECIMATE_CORE_MESH_POINTS_H

#include "types.h"
#include "vector.h"

#include <cstddef>

namespace undecimate
{

class MeshPoints
{
public:
  explicit MeshPoints(const TriangleMeshView& mesh)
    : floats_(mesh.pointsFloat)
    , doubles_(mesh.pointsDouble)
  {
  }

  Vector operator[](Index node) const
  {
    const std::size_t i = std::size_t{ 3 } * static_cast<std::size_t>(node);
    if (this->doubles_)
    {
      return { this->doubles_[i], this->doubles_[i + 1], this->doubles_[i + 2] };
    }
    return { this->floats_[i], this->floats_[i + 1], this->floats_[i + 2] };
  }

private:
  const float* floats_;
  const double* doubles_;
};

} // namespace undecimate

#endif
