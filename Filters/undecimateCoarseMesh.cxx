// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateCoarseMesh.h"

#include "undecimateRecordFields.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace undecimate
{
namespace filters
{

namespace
{

// The tuples `leading` + numbers[i] of each array, behind the first `leading`.
void gatherArrays(vtkDataSetAttributes* from, vtkIdType leading, const std::vector<Index>& numbers,
  vtkDataSetAttributes* to)
{
  std::vector<ArrayPointer> arrays;
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = from->GetAbstractArray(i);
    arrays.push_back(
      gather(array, array, leading, numbers.data(), static_cast<vtkIdType>(numbers.size())));
  }
  setArrays(to, from, arrays);
}

} // namespace

void require(const std::string& problem)
{
  if (!problem.empty())
  {
    throw BrokenRequest{ problem };
  }
}

std::string listKept(const std::vector<std::pair<Index, const char*>>& reasons)
{
  std::string text;
  for (const auto& [count, reason] : reasons)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    }
  }
  return text.empty() ? "" : " Nodes that are kept: " + text + ".";
}

CoarseMesh::CoarseMesh(const Record& record, const std::vector<Index>& baseCells,
  const std::vector<Index>& sources, vtkPolyData* mesh)
  : nodes_(record.nodeOrder.begin(), record.nodeOrder.begin() + record.baseNodeCount)
  , faces_(makeFaces(baseCells.data(), record.cornersPerCell, record.baseCellCount,
      mesh->GetPolys()->IsStorage64Bit(), nullptr, this->quads_))
{
  if (!sources.empty())
  {
    this->cells_.assign(sources.begin(), sources.begin() + record.baseCellCount);
  }
  if (mesh->GetNumberOfVerts() + mesh->GetNumberOfLines() > 0)
  {
    std::vector<Index> places(record.nodeCount, kNone);
    for (Index i = 0; i < record.baseNodeCount; ++i)
    {
      places[record.nodeOrder[i]] = i;
    }
    this->verts_ = mapPoints(mesh->GetVerts(), places.data(), mesh->GetVerts()->IsStorage64Bit());
    this->lines_ = mapPoints(mesh->GetLines(), places.data(), mesh->GetLines()->IsStorage64Bit());
  }
}

void CoarseMesh::fill(vtkPolyData* mesh, bool originalPointIds, vtkPolyData* output) const
{
  const auto nodes = static_cast<vtkIdType>(this->nodes_.size());
  passFieldData(mesh->GetFieldData(), output->GetFieldData());
  vtkDataArray* all = mesh->GetPoints()->GetData();
  vtkNew<vtkPoints> points;
  points->SetData(vtkDataArray::SafeDownCast(gather(all, all, 0, this->nodes_.data(), nodes)));
  output->SetPoints(points);
  gatherArrays(mesh->GetPointData(), 0, this->nodes_, output->GetPointData());

  output->SetPolys(this->faces_);
  if (this->verts_)
  {
    output->SetVerts(this->verts_);
    output->SetLines(this->lines_);
  }
  gatherArrays(mesh->GetCellData(), mesh->GetNumberOfVerts() + mesh->GetNumberOfLines(),
    this->cells_, output->GetCellData());

  if (originalPointIds)
  {
    vtkNew<vtkIdTypeArray> numbers;
    numbers->SetName(kOriginalPointIds);
    numbers->SetNumberOfValues(nodes);
    std::copy(this->nodes_.begin(), this->nodes_.end(), numbers->GetPointer(0));
    output->GetPointData()->AddArray(numbers);
  }
}

} // namespace filters
} // namespace undecimate
