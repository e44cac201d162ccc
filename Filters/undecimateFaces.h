// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateFaces.h
/// @brief Cell arrays of triangles and quads, in core's width and back.

#ifndef undecimateFaces_h
#define undecimateFaces_h

#include "undecimateArrays.h"

namespace undecimate
{
namespace filters
{

/// Numbers of cells of three and four corners, the empty corner of a triangle last.
struct FaceCells
{
  std::vector<Index> corners; ///< 4 a cell, kNone at the last of triangles
  vtkIdType otherCells = 0;   ///< cells of other sizes; if any, corners is not complete
  vtkIdType badCell = -1;     ///< first cell with a point that does not exist, and that point
  vtkIdType badPoint = -1;
};

/// Read triangles and quads, checking that each point number is in [0, pointCount).
/// Complexity: O(cells).
FaceCells readFaces(vtkCellArray* cells, vtkIdType pointCount);

/// A cell array of triangles and quads.
/// @param corners 4 * count point numbers, kNone at the last of triangles
/// @param wide 64-bit storage, else 32-bit
/// @param memory as for newLike()
/// @param[out] quads number of quads
vtkSmartPointer<vtkCellArray> makeFaces(
  const Index* corners, vtkIdType count, bool wide, ArrayMemory* memory, vtkIdType& quads);

} // namespace filters
} // namespace undecimate

#endif
