// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file test_meshes.h
/// @brief The meshes of the Hausdorff tests: files of Data/, of the development data, and a grid.

#ifndef UNDECIMATE_TEST_MESHES_H
#define UNDECIMATE_TEST_MESHES_H

#include "types.h"

#include <string>
#include <vector>

struct TestMesh
{
  std::string name;
  std::vector<double> points; ///< 3 a node
  std::vector<undecimate::Index> triangles;
  std::vector<float> values; ///< one a node, or none
  double diagonal = 0.0;     ///< of the bounding box

  undecimate::Index nodeCount() const
  {
    return static_cast<undecimate::Index>(this->points.size() / 3);
  }
  undecimate::Index triangleCount() const
  {
    return static_cast<undecimate::Index>(this->triangles.size() / 3);
  }
  undecimate::TriangleMeshView view() const;
};

/// n x n nodes over the unit square: a smooth relief with a narrow peak.
TestMesh makeGrid(int n);

/// A .vtp of triangles; `array` is a nodal scalar or empty. Throws std::runtime_error.
TestMesh readMesh(const std::string& name, const std::string& file, const std::string& array = "");

/// Path of a file of the repository's Data/.
std::string dataFile(const std::string& name);

/// Path of a file of the development data ($UNDECIMATE_DATA, else ../shared/data beside the
/// repository); it need not be there.
std::string developmentFile(const std::string& name);

#endif
