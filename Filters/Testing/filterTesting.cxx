// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filterTesting.h"

#include "vtkHashQueueDecimation.h"
#include "vtkUndecimation.h"

#include "vtkBitArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkLongLongArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkShortArray.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkXMLPolyDataReader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace filter_testing
{

namespace
{

template <class Array>
vtkSmartPointer<Array> makeNumbers(
  const char* name, int components, vtkIdType tuples, std::mt19937& random)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  std::uniform_real_distribution<double> value(0.0, 200.0);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, value(random));
    }
  }
  return array;
}

vtkSmartPointer<vtkStringArray> makeStrings(const char* name, vtkIdType count)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName(name);
  for (vtkIdType i = 0; i < count; ++i)
  {
    array->InsertNextValue(i % 7 == 0 ? "" : "item " + std::to_string(i * i));
  }
  return array;
}

void addPointData(vtkPolyData* mesh, std::mt19937& random)
{
  const vtkIdType n = mesh->GetNumberOfPoints();
  vtkPointData* data = mesh->GetPointData();
  data->SetScalars(makeNumbers<vtkDoubleArray>("scalar", 1, n, random));
  auto vectors = makeNumbers<vtkFloatArray>("vector", 3, n, random);
  vectors->SetComponentName(0, "first");
  vectors->SetComponentName(2, "third");
  data->AddArray(makeNumbers<vtkShortArray>("short", 2, n, random));
  data->SetVectors(vectors);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < n; ++i)
  {
    ids->InsertNextValue(1000000007 * (i + 1));
  }
  data->SetGlobalIds(ids);
  vtkNew<vtkBitArray> bits;
  bits->SetName("bits");
  for (vtkIdType i = 0; i < n; ++i)
  {
    bits->InsertNextValue(static_cast<int>(random() % 2));
  }
  data->AddArray(bits);
  data->AddArray(makeStrings("names", n));
  data->AddArray(makeNumbers<vtkIntArray>(nullptr, 1, n, random)); // without a name
  data->AddArray(makeNumbers<vtkUnsignedCharArray>("colour", 4, n, random));
  data->AddArray(makeNumbers<vtkDoubleArray>("tensor", 9, n, random));
  data->AddArray(makeNumbers<vtkLongLongArray>("long long", 5, n, random));
  data->AddArray(makeNumbers<vtkSOADataArrayTemplate<double>>("soa", 3, n, random));
}

void addCellData(vtkPolyData* mesh, std::mt19937& random)
{
  const vtkIdType n = mesh->GetNumberOfCells();
  vtkCellData* data = mesh->GetCellData();
  auto numbers = vtkSmartPointer<vtkIntArray>::New();
  numbers->SetName("number");
  for (vtkIdType i = 0; i < n; ++i)
  {
    numbers->InsertNextValue(static_cast<int>(i));
  }
  data->AddArray(numbers);
  data->SetScalars(makeNumbers<vtkFloatArray>("pressure", 1, n, random));
  data->SetNormals(makeNumbers<vtkDoubleArray>("normal", 3, n, random));
  data->AddArray(makeStrings("part", n));
}

void addFaces(vtkCellArray* cells, int rows)
{
  for (vtkIdType j = 0; j + 1 < rows; ++j)
  {
    for (vtkIdType i = 0; i + 1 < rows; ++i)
    {
      const vtkIdType p = j * rows + i;
      const vtkIdType first[] = { p, p + 1, p + rows };
      const vtkIdType second[] = { p + rows + 1, p + rows, p + 1 };
      cells->InsertNextCell(3, first);
      cells->InsertNextCell(3, second);
    }
  }
}

std::string describe(const char* what, vtkAbstractArray* array, vtkAbstractArray* other)
{
  const auto type = [](vtkAbstractArray* a)
  {
    return std::string(a->GetClassName()) + "[" + std::to_string(a->GetNumberOfTuples()) + "][" +
      std::to_string(a->GetNumberOfComponents()) + "] " + (a->GetName() ? a->GetName() : "-");
  };
  return std::string(what) + ": " + type(array) + " against " + type(other) + "\n";
}

bool sameType(vtkAbstractArray* a, vtkAbstractArray* b, bool fileTypes)
{
  if (!fileTypes)
  {
    return a->GetDataType() == b->GetDataType() && a->GetArrayType() == b->GetArrayType();
  }
  const auto isFloat = [](vtkAbstractArray* x)
  { return x->GetDataType() == VTK_FLOAT || x->GetDataType() == VTK_DOUBLE; };
  return a->GetDataTypeSize() == b->GetDataTypeSize() && isFloat(a) == isFloat(b) &&
    a->IsNumeric() == b->IsNumeric() &&
    (a->GetDataType() == VTK_BIT) == (b->GetDataType() == VTK_BIT);
}

bool sameName(const char* a, const char* b)
{
  return (!a || !b) ? a == b : std::strcmp(a, b) == 0;
}

bool sameBits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof(a)) == 0 || (std::isnan(a) && std::isnan(b));
}

bool sameValues(vtkAbstractArray* a, vtkAbstractArray* b)
{
  vtkDataArray* numbers = vtkDataArray::SafeDownCast(a);
  vtkDataArray* others = vtkDataArray::SafeDownCast(b);
  const bool blocks = numbers && a->GetDataType() != VTK_BIT && a->HasStandardMemoryLayout() &&
    b->HasStandardMemoryLayout();
  if (blocks)
  {
    const std::size_t size =
      static_cast<std::size_t>(a->GetDataTypeSize()) * a->GetNumberOfValues();
    return size == 0 || std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), size) == 0;
  }
  for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i)
  {
    const int components = a->GetNumberOfComponents();
    if (numbers ? !sameBits(numbers->GetComponent(i / components, static_cast<int>(i % components)),
                    others->GetComponent(i / components, static_cast<int>(i % components)))
                : a->GetVariantValue(i).ToString() != b->GetVariantValue(i).ToString())
    {
      return false;
    }
  }
  return true;
}

std::string cellDifferences(const char* what, vtkCellArray* a, vtkCellArray* b, bool fileTypes)
{
  if (a->GetNumberOfCells() != b->GetNumberOfCells())
  {
    return std::string(what) + ": " + std::to_string(a->GetNumberOfCells()) + " against " +
      std::to_string(b->GetNumberOfCells()) + "\n";
  }
  std::string text;
  if (!fileTypes && a->GetNumberOfCells() > 0 && a->IsStorage64Bit() != b->IsStorage64Bit())
  {
    text += std::string(what) + ": other storage width\n";
  }
  if (a->GetNumberOfCells() == 0)
  {
    return text;
  }
  vtkNew<vtkCellArray> first;
  vtkNew<vtkCellArray> second;
  first->DeepCopy(a);
  second->DeepCopy(b);
  first->ConvertTo64BitStorage();
  second->ConvertTo64BitStorage();
  if (first->GetNumberOfConnectivityIds() != second->GetNumberOfConnectivityIds() ||
    !sameValues(first->GetOffsetsArray(), second->GetOffsetsArray()) ||
    !sameValues(first->GetConnectivityArray(), second->GetConnectivityArray()))
  {
    text += std::string(what) + ": other points\n";
  }
  return text;
}

std::string dataDifferences(
  const char* what, vtkDataSetAttributes* a, vtkDataSetAttributes* b, bool fileTypes)
{
  if (a->GetNumberOfArrays() != b->GetNumberOfArrays())
  {
    return std::string(what) + ": " + std::to_string(a->GetNumberOfArrays()) + " arrays against " +
      std::to_string(b->GetNumberOfArrays()) + "\n";
  }
  std::string text;
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    text += differences(a->GetAbstractArray(i), b->GetAbstractArray(i), fileTypes);
  }
  int first[vtkDataSetAttributes::NUM_ATTRIBUTES];
  int second[vtkDataSetAttributes::NUM_ATTRIBUTES];
  a->GetAttributeIndices(first);
  b->GetAttributeIndices(second);
  if (!std::equal(std::begin(first), std::end(first), std::begin(second)))
  {
    text += std::string(what) + ": other active attributes\n";
  }
  return text;
}

} // namespace

vtkSmartPointer<vtkPolyData> makeGrid(const MeshOptions& options)
{
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  const int rows = options.rows;
  vtkNew<vtkPoints> points;
  points->SetDataType(options.pointType);
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < rows; ++i)
    {
      points->InsertNextPoint(100 * (i + jitter(random)), 100 * (j + jitter(random)),
        150 * std::sin(0.5 * i) * std::cos(0.4 * j) + 10 * jitter(random));
    }
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  vtkNew<vtkCellArray> faces;
  options.wide ? faces->Use64BitStorage() : faces->Use32BitStorage();
  addFaces(faces, rows);
  mesh->SetPolys(faces);
  if (options.vertsAndLines)
  {
    const vtkIdType line[] = { rows + 1, rows + 2, 2 * rows + 3, 3 * rows + 3 };
    const vtkIdType verts[] = { 2 * rows + 5, 4 * rows + 5 };
    vtkNew<vtkCellArray> lines;
    vtkNew<vtkCellArray> vertices;
    options.wide ? lines->Use32BitStorage() : lines->Use64BitStorage(); // each its own width
    lines->InsertNextCell(4, line);
    lines->InsertNextCell(2, line + 1);
    vertices->InsertNextCell(2, verts);
    vertices->InsertNextCell(1, verts);
    mesh->SetLines(lines);
    mesh->SetVerts(vertices);
  }
  if (options.pointData)
  {
    addPointData(mesh, random);
  }
  if (options.cellData)
  {
    addCellData(mesh, random);
  }
  vtkNew<vtkStringArray> note;
  note->SetName("note");
  note->InsertNextValue("from the test");
  mesh->GetFieldData()->AddArray(note);
  return mesh;
}

vtkSmartPointer<vtkPolyData> makeMesh(
  const std::vector<double>& coordinates, const std::vector<std::vector<vtkIdType>>& faces)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
  {
    points->InsertNextPoint(coordinates.data() + i);
  }
  vtkNew<vtkCellArray> cells;
  for (const std::vector<vtkIdType>& face : faces)
  {
    cells->InsertNextCell(static_cast<vtkIdType>(face.size()), face.data());
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return mesh;
}

vtkSmartPointer<vtkPolyData> readPlate()
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(UNDECIMATE_DATA_DIR "/plate_hole.vtp");
  reader->Update();
  return reader->GetOutput();
}

vtkSmartPointer<vtkPolyData> copy(vtkPolyData* mesh)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->DeepCopy(mesh);
  return result;
}

std::string differences(vtkAbstractArray* a, vtkAbstractArray* b, bool fileTypes)
{
  if (a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() || !sameType(a, b, fileTypes))
  {
    return describe("other shape or type", a, b);
  }
  std::string text;
  // A file may invent a name where there was none.
  if (!sameName(a->GetName(), b->GetName()) && !(fileTypes && !b->GetName()))
  {
    text += describe("other name", a, b);
  }
  for (int c = 0; c < a->GetNumberOfComponents(); ++c)
  {
    if (!sameName(a->GetComponentName(c), b->GetComponentName(c)))
    {
      text += describe("other component name", a, b);
    }
  }
  return sameValues(a, b) ? text : text + describe("other values", a, b);
}

std::string differences(vtkPolyData* a, vtkPolyData* b, bool fileTypes)
{
  if (a->GetNumberOfPoints() != b->GetNumberOfPoints())
  {
    return "points: " + std::to_string(a->GetNumberOfPoints()) + " against " +
      std::to_string(b->GetNumberOfPoints()) + "\n";
  }
  std::string text;
  if (a->GetNumberOfPoints() > 0)
  {
    text += differences(a->GetPoints()->GetData(), b->GetPoints()->GetData(), fileTypes);
  }
  text += cellDifferences("verts", a->GetVerts(), b->GetVerts(), fileTypes);
  text += cellDifferences("lines", a->GetLines(), b->GetLines(), fileTypes);
  text += cellDifferences("polys", a->GetPolys(), b->GetPolys(), fileTypes);
  text += cellDifferences("strips", a->GetStrips(), b->GetStrips(), fileTypes);
  text += dataDifferences("point data", a->GetPointData(), b->GetPointData(), fileTypes);
  text += dataDifferences("cell data", a->GetCellData(), b->GetCellData(), fileTypes);
  return text;
}

void Messages::watch(vtkAlgorithm* algorithm)
{
  algorithm->AddObserver(vtkCommand::ErrorEvent, this);
  algorithm->AddObserver(vtkCommand::WarningEvent, this);
  // The executive tells an observer of its own that the algorithm failed.
  algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this);
}

void Messages::Execute(vtkObject* caller, unsigned long event, void* data)
{
  if (vtkExecutive::SafeDownCast(caller))
  {
    return;
  }
  (event == vtkCommand::ErrorEvent ? this->errors : this->warnings)
    .emplace_back(static_cast<const char*>(data));
}

std::string Messages::all() const
{
  std::string text;
  for (const auto* list : { &this->errors, &this->warnings })
  {
    for (const std::string& message : *list)
    {
      text += message;
    }
  }
  return text;
}

bool has(const std::vector<std::string>& messages, const std::string& text)
{
  for (const std::string& message : messages)
  {
    if (message.find(text) != std::string::npos)
    {
      return true;
    }
  }
  return false;
}

vtkSmartPointer<vtkPolyData> decimated(vtkPolyData* mesh, double reduction)
{
  Watched<vtkHashQueueDecimation> filter;
  filter->SetInputData(mesh);
  filter->SetTargetReduction(reduction);
  auto result = copy(filter.output());
  EXPECT_TRUE(filter.messages->errors.empty()) << filter.messages->all();
  return result;
}

vtkSmartPointer<vtkPolyData> undecimated(vtkPolyData* coarse, double level)
{
  Watched<vtkUndecimation> filter;
  filter->SetInputData(coarse);
  filter->SetLevel(level);
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(filter.output());
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  return result;
}

std::string undecimationError(vtkPolyData* coarse)
{
  Watched<vtkUndecimation> filter;
  filter->SetInputData(coarse);
  filter->SetLevel(0.5);
  vtkPolyData* output = filter.output();
  EXPECT_EQ(output->GetNumberOfPoints(), 0);
  EXPECT_EQ(output->GetNumberOfCells(), 0);
  EXPECT_EQ(filter.messages->errors.size(), 1u);
  return filter.messages->all();
}

} // namespace filter_testing
