// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "test_meshes.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

using undecimate::Index;

namespace
{

constexpr double kPi = 3.14159265358979323846;

void setDiagonal(TestMesh& mesh)
{
  double low[3] = { mesh.points[0], mesh.points[1], mesh.points[2] };
  double high[3] = { low[0], low[1], low[2] };
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    low[i % 3] = std::min(low[i % 3], mesh.points[i]);
    high[i % 3] = std::max(high[i % 3], mesh.points[i]);
  }
  mesh.diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

} // namespace

undecimate::TriangleMeshView TestMesh::view() const
{
  undecimate::TriangleMeshView view;
  view.pointsDouble = this->points.data();
  view.nodeCount = this->nodeCount();
  view.triangles = this->triangles.data();
  view.triangleCount = this->triangleCount();
  return view;
}

TestMesh makeGrid(int n)
{
  TestMesh mesh;
  mesh.name = "grid";
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const double x = static_cast<double>(i) / (n - 1);
      const double y = static_cast<double>(j) / (n - 1);
      const double fromPeak = (x - 0.7) * (x - 0.7) + (y - 0.3) * (y - 0.3);
      mesh.points.insert(mesh.points.end(),
        { x, y,
          0.1 * std::sin(3 * kPi * x) * std::cos(2 * kPi * y) + 0.05 * std::exp(-fromPeak / 0.005) +
            0.02 * std::sin(11 * kPi * x * y) });
      mesh.values.push_back(static_cast<float>(std::exp(-fromPeak / 0.01) + 0.3 * x * y));
    }
  }
  for (Index j = 0; j + 1 < n; ++j)
  {
    for (Index i = 0; i + 1 < n; ++i)
    {
      const Index a = j * n + i;
      mesh.triangles.insert(mesh.triangles.end(), { a, a + 1, a + n + 1, a, a + n + 1, a + n });
    }
  }
  setDiagonal(mesh);
  return mesh;
}

TestMesh readMesh(const std::string& name, const std::string& file, const std::string& array)
{
  if (!std::ifstream(file).good())
  {
    throw std::runtime_error(file + ": no such file");
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  TestMesh mesh;
  mesh.name = name;
  if (data->GetNumberOfPolys() == 0)
  {
    throw std::runtime_error(file + ": no cells, or this VTK cannot read it");
  }
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double x[3];
    data->GetPoint(i, x);
    mesh.points.insert(mesh.points.end(), x, x + 3);
  }
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < data->GetNumberOfPolys(); ++i)
  {
    data->GetPolys()->GetCellAtId(i, cell);
    if (cell->GetNumberOfIds() != 3)
    {
      throw std::runtime_error(file + ": not triangles only");
    }
    for (int k = 0; k < 3; ++k)
    {
      mesh.triangles.push_back(static_cast<Index>(cell->GetId(k)));
    }
  }
  if (!array.empty())
  {
    vtkDataArray* values = data->GetPointData()->GetArray(array.c_str());
    if (values == nullptr || values->GetNumberOfComponents() != 1)
    {
      throw std::runtime_error(file + ": no nodal scalar '" + array + "'");
    }
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    {
      mesh.values.push_back(static_cast<float>(values->GetComponent(i, 0)));
    }
  }
  setDiagonal(mesh);
  return mesh;
}

std::string dataFile(const std::string& name)
{
  return std::string(UNDECIMATE_SOURCE_DIR) + "/Data/" + name;
}

std::string developmentFile(const std::string& name)
{
  const char* folder = std::getenv("UNDECIMATE_DATA");
  return (folder != nullptr ? std::string(folder)
                            : std::string(UNDECIMATE_SOURCE_DIR) + "/../shared/data") +
    "/" + name;
}
