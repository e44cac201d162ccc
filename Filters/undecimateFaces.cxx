// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateFaces.h"

#include "undecimateMemory.h"

#include "vtkCellArray.h"
#include "vtkNew.h"

#include <new>

namespace undecimate
{
namespace filters
{

namespace
{

constexpr int kCorners = 4;

template <class Offset>
FaceCells read(const Offset* offsets, const Offset* connectivity, vtkIdType size, vtkIdType count,
  vtkIdType pointCount)
{
  FaceCells result;
  result.corners.resize(static_cast<std::size_t>(kCorners) * count, kNone);
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const vtkIdType begin = offsets[cell];
    const vtkIdType end = offsets[cell + 1];
    if (begin < 0 || end < begin || end > size)
    {
      result.badCell = cell;
      result.badPoint = end;
      return result;
    }
    const bool fits = end - begin == 3 || end - begin == kCorners;
    result.otherCells += !fits;
    for (vtkIdType i = begin; i < end; ++i)
    {
      const vtkIdType point = connectivity[i];
      if (point < 0 || point >= pointCount)
      {
        result.badCell = cell;
        result.badPoint = point;
        return result;
      }
      if (fits)
      {
        result.corners[kCorners * cell + i - begin] = static_cast<Index>(point);
      }
    }
  }
  return result;
}

template <class ArrayType>
typename ArrayType::ValueType* allocate(ArrayType* array, vtkIdType values, ArrayMemory* memory)
{
  if (memory)
  {
    memory->allocate(array, values);
  }
  else
  {
    array->SetNumberOfTuples(values);
  }
  if (array->GetNumberOfTuples() != values)
  {
    throw std::bad_alloc();
  }
  return array->GetPointer(0);
}

template <class ArrayType>
void fill(
  vtkCellArray* cells, const Index* corners, vtkIdType count, vtkIdType quads, ArrayMemory* memory)
{
  using Value = typename ArrayType::ValueType;
  vtkNew<ArrayType> offsets;
  vtkNew<ArrayType> connectivity;
  Value* offset = allocate(offsets.Get(), count + 1, memory);
  Value* first = allocate(connectivity.Get(), 3 * count + quads, memory);
  Value* corner = first;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const Index* from = corners + kCorners * cell;
    offset[cell] = static_cast<Value>(corner - first);
    *corner++ = from[0];
    *corner++ = from[1];
    *corner++ = from[2];
    if (from[3] != kNone)
    {
      *corner++ = from[3];
    }
  }
  offset[count] = static_cast<Value>(corner - first);
  cells->SetData(offsets.Get(), connectivity.Get());
}

} // namespace

FaceCells readFaces(vtkCellArray* cells, vtkIdType pointCount)
{
  const vtkIdType count = cells->GetNumberOfCells();
  if (count == 0)
  {
    return {};
  }
  if (cells->IsStorage64Bit())
  {
    return read(cells->GetOffsetsArray64()->GetPointer(0),
      cells->GetConnectivityArray64()->GetPointer(0),
      cells->GetConnectivityArray64()->GetNumberOfValues(), count, pointCount);
  }
  return read(cells->GetOffsetsArray32()->GetPointer(0),
    cells->GetConnectivityArray32()->GetPointer(0),
    cells->GetConnectivityArray32()->GetNumberOfValues(), count, pointCount);
}

vtkSmartPointer<vtkCellArray> makeFaces(
  const Index* corners, vtkIdType count, bool wide, ArrayMemory* memory, vtkIdType& quads)
{
  quads = 0;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    quads += corners[kCorners * cell + kCorners - 1] != kNone;
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  if (wide)
  {
    fill<vtkCellArray::ArrayType64>(cells, corners, count, quads, memory);
  }
  else
  {
    fill<vtkCellArray::ArrayType32>(cells, corners, count, quads, memory);
  }
  return cells;
}

} // namespace filters
} // namespace undecimate
