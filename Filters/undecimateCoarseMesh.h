// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateCoarseMesh.h
/// @brief What both decimations make of a core's result: the output at the coarsest level.

#ifndef undecimateCoarseMesh_h
#define undecimateCoarseMesh_h

#include "undecimateArrays.h"

#include "record.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

class vtkCellArray;
class vtkPolyData;

namespace undecimate
{
namespace filters
{

/// Thrown for a request that cannot be met; the text is the error message.
struct BrokenRequest
{
  std::string message;
};

/// Throw a BrokenRequest unless the text is empty.
void require(const std::string& problem);

/// Add a value to a list. False if it is there already.
template <class Value, class New>
bool addOnce(std::vector<Value>& list, const New& value)
{
  const bool isNew = std::find(list.begin(), list.end(), value) == list.end();
  if (isNew)
  {
    list.emplace_back(value);
  }
  return isNew;
}

/// " Nodes that are kept: 12 on the boundary, 3 without a cell.", for a warning; empty if all
/// numbers are 0.
std::string listKept(const std::vector<std::pair<Index, const char*>>& reasons);

/// The nodes and cells of the coarsest level, which are the same at all time steps.
class CoarseMesh
{
public:
  CoarseMesh() = default;

  /// @param record of the decimation
  /// @param baseCells of the coarsest level, in record order
  /// @param sources input cell whose values each of them takes; may be longer, and empty if there
  /// is no cell data
  /// @param mesh the input
  CoarseMesh(const Record& record, const std::vector<Index>& baseCells,
    const std::vector<Index>& sources, vtkPolyData* mesh);

  /// Fill the output: points, cells, all arrays and the field data, but no record.
  /// @param mesh the input, at any time step
  /// @param originalPointIds add the point array vtkOriginalPointIds
  void fill(vtkPolyData* mesh, bool originalPointIds, vtkPolyData* output) const;

  vtkIdType numberOfQuads() const { return this->quads_; }

private:
  std::vector<Index> nodes_; // original numbers
  std::vector<Index> cells_; // original numbers
  vtkIdType quads_ = 0;
  vtkSmartPointer<vtkCellArray> faces_;
  vtkSmartPointer<vtkCellArray> verts_; // null if there are neither vertex cells nor lines
  vtkSmartPointer<vtkCellArray> lines_;
};

} // namespace filters
} // namespace undecimate

#endif
