// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateInput.h"

#include "array_range.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTriangleFilter.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace undecimate
{
namespace filters
{

namespace
{

template <class From, class To>
void convert(const void* from, std::vector<To>& to)
{
  const From* values = static_cast<const From*>(from);
  std::transform(
    values, values + to.size(), to.begin(), [](From value) { return static_cast<To>(value); });
}

// All values of an array of any numeric type.
template <class To>
void readValues(vtkDataArray* array, std::vector<To>& to)
{
  to.resize(array->GetNumberOfValues());
  if (!array->HasStandardMemoryLayout() || array->GetDataType() == VTK_BIT)
  {
    const int components = array->GetNumberOfComponents();
    for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
    {
      for (int c = 0; c < components; ++c)
      {
        to[tuple * components + c] = static_cast<To>(array->GetComponent(tuple, c));
      }
    }
    return;
  }
  switch (array->GetDataType())
  {
    vtkTemplateMacro(convert<VTK_TT>(array->GetVoidPointer(0), to));
    default:
      break;
  }
}

// The same as single-precision differences to the lowest value of each component: a range that is
// small beside the values themselves is kept.
void readDifferences(vtkDataArray* array, std::vector<float>& to)
{
  std::vector<double> values;
  readValues(array, values);
  const std::size_t components = array->GetNumberOfComponents();
  to.resize(values.size());
  for (std::size_t c = 0; c < components; ++c)
  {
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = c; i < values.size(); i += components)
    {
      lowest = std::isfinite(values[i]) ? std::min(lowest, values[i]) : lowest;
    }
    for (std::size_t i = c; i < values.size(); i += components)
    {
      to[i] = static_cast<float>(values[i] - lowest);
    }
  }
}

void passCancel(vtkObject* caller, unsigned long, void* clientData, void*)
{
  const auto* cancelled = static_cast<const std::function<bool()>*>(clientData);
  if ((*cancelled)())
  {
    vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
  }
}

// Triangles of the polygons and strips, and from which of them (polygons first) each one is.
vtkSmartPointer<vtkCellArray> cutFaces(
  vtkPolyData* mesh, const std::function<bool()>& cancelled, std::vector<Index>& sources)
{
  const vtkIdType faceCount = mesh->GetNumberOfPolys() + mesh->GetNumberOfStrips();
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName("source");
  numbers->SetNumberOfValues(faceCount);
  std::iota(numbers->GetPointer(0), numbers->GetPointer(0) + faceCount, vtkIdType{ 0 });
  vtkNew<vtkPolyData> faces;
  faces->SetPoints(mesh->GetPoints());
  faces->SetPolys(mesh->GetPolys());
  faces->SetStrips(mesh->GetStrips());
  faces->GetCellData()->AddArray(numbers);

  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(passCancel);
  command->SetClientData(const_cast<std::function<bool()>*>(&cancelled));
  vtkNew<vtkTriangleFilter> filter;
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->SetInputData(faces);
  filter->Update();
  if (filter->GetAbortExecute() || cancelled())
  {
    return nullptr;
  }
  vtkIdTypeArray* result =
    vtkIdTypeArray::SafeDownCast(filter->GetOutput()->GetCellData()->GetAbstractArray("source"));
  if (result)
  {
    sources.assign(result->GetPointer(0), result->GetPointer(0) + result->GetNumberOfValues());
  }
  return filter->GetOutput()->GetPolys();
}

} // namespace

std::string counted(vtkIdType number, const std::string& word)
{
  return std::to_string(number) + " " + word + (number == 1 ? "" : "s");
}

std::string OtherFaces::describe() const
{
  std::vector<std::string> parts;
  const auto add = [&parts](vtkIdType number, const char* word, const char* rest)
  {
    if (number > 0)
    {
      parts.push_back(counted(number, word) + rest);
    }
  };
  add(this->quads, "quad", "");
  add(this->polygons, "polygon", "");
  add(this->strips, "triangle strip", "");
  add(this->slivers, "face", " of fewer than three points");
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return text;
}

OtherFaces countOtherFaces(vtkPolyData* mesh)
{
  OtherFaces faces;
  faces.strips = mesh->GetNumberOfStrips();
  vtkCellArray* polys = mesh->GetPolys();
  const vtkIdType count = polys->GetNumberOfCells();
  const auto sort = [&faces, count](const auto* offsets)
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      const auto size = offsets[i + 1] - offsets[i];
      faces.quads += size == 4;
      faces.polygons += size > 4;
      faces.slivers += size < 3;
    }
  };
  if (count > 0 && polys->IsStorage64Bit())
  {
    sort(polys->GetOffsetsArray64()->GetPointer(0));
  }
  else if (count > 0)
  {
    sort(polys->GetOffsetsArray32()->GetPointer(0));
  }
  return faces;
}

vtkSmartPointer<vtkPolyData> triangulated(
  vtkPolyData* mesh, const std::function<bool()>& cancelled, vtkIdType& dropped)
{
  std::vector<Index> sources;
  vtkSmartPointer<vtkCellArray> triangles = cutFaces(mesh, cancelled, sources);
  if (!triangles)
  {
    return nullptr;
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(mesh->GetPoints());
  result->SetVerts(mesh->GetVerts());
  result->SetLines(mesh->GetLines());
  result->SetPolys(triangles);
  result->GetPointData()->ShallowCopy(mesh->GetPointData());
  result->GetFieldData()->ShallowCopy(mesh->GetFieldData());

  const vtkIdType leading = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  std::vector<ArrayPointer> data;
  for (int i = 0; i < mesh->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = mesh->GetCellData()->GetAbstractArray(i);
    data.push_back(
      gather(array, array, leading, sources.data(), static_cast<vtkIdType>(sources.size())));
  }
  setArrays(result->GetCellData(), mesh->GetCellData(), data);

  std::vector<bool> found(mesh->GetNumberOfPolys() + mesh->GetNumberOfStrips(), false);
  for (const Index source : sources)
  {
    found[source] = true;
  }
  dropped = std::count(found.begin(), found.end(), false);
  return result;
}

std::string MeshInput::read(vtkPolyData* mesh)
{
  const vtkIdType points = mesh->GetNumberOfPoints();
  const vtkIdType faces = mesh->GetNumberOfPolys();
  constexpr vtkIdType most = std::numeric_limits<Index>::max();
  if (points > most || faces > most / 3)
  {
    return "The input has " + counted(points, "point") + " and " + counted(faces, "triangle") +
      "; at most " + std::to_string(most) +
      " points and corners fit in one piece. Divide the mesh.";
  }
  this->readPoints(mesh);
  const TriangleCorners corners = trianglesInPlace(mesh->GetPolys());
  this->view_.triangles = corners.narrow;
  this->view_.wideTriangles = corners.wide;
  if (!corners.narrow && !corners.wide)
  {
    FaceCells cells = readFaces(mesh->GetPolys(), points, 3);
    if (std::string problem = badFace(cells, points); !problem.empty())
    {
      return problem;
    }
    this->triangles_ = std::move(cells.corners);
    this->view_.triangles = this->triangles_.data();
  }
  this->view_.nodeCount = points;
  this->view_.triangleCount = faces;
  std::string problem = readKept(mesh, this->keep_);
  this->view_.keep = this->keep_.empty() ? nullptr : this->keep_.data();
  return problem;
}

void MeshInput::readPoints(vtkPolyData* mesh)
{
  if (!mesh->GetPoints())
  {
    return;
  }
  vtkDataArray* points = mesh->GetPoints()->GetData();
  const bool plain = points->HasStandardMemoryLayout();
  if (plain && points->GetDataType() == VTK_FLOAT)
  {
    this->view_.pointsFloat = static_cast<const float*>(points->GetVoidPointer(0));
  }
  else if (plain && points->GetDataType() == VTK_DOUBLE)
  {
    this->view_.pointsDouble = static_cast<const double*>(points->GetVoidPointer(0));
  }
  else
  {
    readValues(points, this->coordinates_);
    this->view_.pointsDouble = this->coordinates_.data();
  }
}

std::string checkSizes(vtkPolyData* mesh)
{
  const auto shortOne = [](vtkDataSetAttributes* data, vtkIdType count, const char* kind,
                          const char* of) -> std::string
  {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = data->GetAbstractArray(i);
      if (array->GetNumberOfTuples() < count)
      {
        return std::string(kind) + " array '" + (array->GetName() ? array->GetName() : "") +
          "' has " + counted(array->GetNumberOfTuples(), "value") + " for " + counted(count, of) +
          ". Remove the array or repair the input.";
      }
    }
    return {};
  };
  std::string problem = shortOne(mesh->GetPointData(), mesh->GetNumberOfPoints(), "Point", "point");
  if (problem.empty())
  {
    problem = shortOne(mesh->GetCellData(), mesh->GetNumberOfCells(), "Cell", "cell");
  }
  return problem;
}

std::string checkFaces(vtkPolyData* mesh)
{
  std::vector<unsigned char> flags(mesh->GetNumberOfPoints(), 0);
  for (vtkCellArray* cells : { mesh->GetPolys(), mesh->GetStrips() })
  {
    if (!flagPoints(cells, flags))
    {
      return "A face of the input refers to a point outside the " +
        counted(mesh->GetNumberOfPoints(), "point") + ". Repair the cells of the input.";
    }
  }
  return {};
}

std::string badFace(const FaceCells& cells, vtkIdType pointCount)
{
  return cells.badCell < 0 ? ""
                           : "Face " + std::to_string(cells.badCell) +
      " of the input refers to point " + std::to_string(cells.badPoint) + ", but there are " +
      counted(pointCount, "point") + ". Repair the cells of the input.";
}

std::string readKept(vtkPolyData* mesh, std::vector<unsigned char>& keep)
{
  keep.clear();
  vtkUnsignedCharArray* pointGhosts = mesh->GetPointGhostArray();
  vtkUnsignedCharArray* cellGhosts = mesh->GetCellGhostArray();
  const vtkIdType before = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  if (before == 0 && !pointGhosts && !cellGhosts)
  {
    return {};
  }
  keep.assign(mesh->GetNumberOfPoints(), 0);
  if (pointGhosts)
  {
    std::copy_n(pointGhosts->GetPointer(0), keep.size(), keep.begin());
  }
  if (!flagPoints(mesh->GetVerts(), keep) || !flagPoints(mesh->GetLines(), keep))
  {
    return "A vertex cell or a line of the input refers to a point outside the " +
      counted(mesh->GetNumberOfPoints(), "point") + ". Repair the cells of the input.";
  }
  if (cellGhosts)
  {
    flagPoints(mesh->GetPolys(), keep, cellGhosts->GetPointer(0) + before);
  }
  return {};
}

void dropAssociation(vtkPolyData* mesh, std::vector<std::string>& names)
{
  if (!names.empty() && names.front() == "POINTS" && !mesh->GetPointData()->HasArray("POINTS"))
  {
    names.erase(names.begin());
  }
}

std::string findSteeringArray(vtkPolyData* mesh, const std::string& name, vtkDataArray*& array)
{
  vtkPointData* data = mesh->GetPointData();
  vtkAbstractArray* found =
    name.empty() ? data->GetScalars() : data->GetAbstractArray(name.c_str());
  if (!found)
  {
    return (name.empty() ? "No Scalars are named, and the input has no active point scalars"
                         : "The input has no point array '" + name + "' to use as Scalars") +
      ". Its point arrays are: " + listNames(data) + ".";
  }
  array = vtkDataArray::SafeDownCast(found);
  const int components = found->GetNumberOfComponents();
  if (!array || components < 1 || components > kMaximumComponents)
  {
    return "Point array '" + name + "' (" + typeName(found) + ", " +
      counted(components, "component") + ") cannot be used as Scalars: numbers with 1 to " +
      std::to_string(kMaximumComponents) + " components are needed.";
  }
  return {};
}

std::string MeshInput::addArray(vtkPolyData* mesh, const std::string& name)
{
  vtkDataArray* array = nullptr;
  if (std::string problem = findSteeringArray(mesh, name, array); !problem.empty())
  {
    return problem;
  }
  NodalArrayView view;
  view.components = array->GetNumberOfComponents();
  view.name = name;
  if (auto* floats = vtkFloatArray::SafeDownCast(array))
  {
    view.values = floats->GetPointer(0);
  }
  else
  {
    this->values_.emplace_back();
    readDifferences(array, this->values_.back());
    view.values = this->values_.back().data();
  }
  this->arrays_.push_back(view);
  return {};
}

} // namespace filters
} // namespace undecimate
