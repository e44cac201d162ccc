// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkHashQueueDecimation: what comes out, what is said, and what is refused.

#include "filterTesting.h"

#include "vtkHashQueueDecimation.h"
#include "vtkUndecimation.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <set>
#include <sstream>

using namespace filter_testing;

namespace
{

using Decimation = Watched<vtkHashQueueDecimation>;

const double kNaN = std::numeric_limits<double>::quiet_NaN();

// A grid of triangles without arrays.
vtkSmartPointer<vtkPolyData> plainGrid(int rows = 13)
{
  MeshOptions options;
  options.rows = rows;
  options.pointData = false;
  options.cellData = false;
  return makeGrid(options);
}

std::set<vtkIdType> originalIds(vtkPolyData* mesh)
{
  vtkDataArray* ids = mesh->GetPointData()->GetArray("vtkOriginalPointIds");
  EXPECT_NE(ids, nullptr);
  std::set<vtkIdType> numbers;
  for (vtkIdType i = 0; ids && i < ids->GetNumberOfTuples(); ++i)
  {
    numbers.insert(static_cast<vtkIdType>(ids->GetComponent(i, 0)));
  }
  return numbers;
}

using Triangle = std::array<vtkIdType, 3>;

std::vector<Triangle> triangles(vtkPolyData* mesh)
{
  std::vector<Triangle> result;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPolys(); ++i)
  {
    mesh->GetPolys()->GetCellAtId(i, ids);
    EXPECT_EQ(ids->GetNumberOfIds(), 3);
    result.push_back({ ids->GetId(0), ids->GetId(1), ids->GetId(2) });
  }
  return result;
}

// Number of triangles at each edge.
std::map<std::pair<vtkIdType, vtkIdType>, int> edgeUse(vtkPolyData* mesh)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> use;
  for (const Triangle& t : triangles(mesh))
  {
    for (int c = 0; c < 3; ++c)
    {
      ++use[std::minmax(t[c], t[(c + 1) % 3])];
    }
  }
  return use;
}

std::set<vtkIdType> boundaryNodes(vtkPolyData* mesh)
{
  std::set<vtkIdType> nodes;
  for (const auto& [edge, count] : edgeUse(mesh))
  {
    if (count == 1)
    {
      nodes.insert({ edge.first, edge.second });
    }
  }
  return nodes;
}

// Level 1 of what the filter gave equals the mesh.
void expectRoundTrip(vtkPolyData* coarse, vtkPolyData* mesh)
{
  EXPECT_EQ(differences(undecimated(coarse, 1.0), mesh), "");
}

// The filter refuses the mesh with one error that has the text, and gives nothing.
void expectError(Decimation& filter, vtkPolyData* mesh, const std::vector<std::string>& texts)
{
  filter->SetInputData(mesh);
  for (int port : { 0, 1 })
  {
    vtkPolyData* output = filter.output(port);
    EXPECT_EQ(output->GetNumberOfPoints(), 0);
    EXPECT_EQ(output->GetNumberOfCells(), 0);
    EXPECT_EQ(output->GetFieldData()->GetAbstractArray("Undecimation.Header"), nullptr);
  }
  ASSERT_FALSE(filter.messages->errors.empty());
  for (const std::string& text : texts)
  {
    EXPECT_TRUE(has(filter.messages->errors, text)) << filter.messages->all() << "\nlacks " << text;
  }
}

TEST(Decimation, KeepsSomeNodesWithTheirExactData)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE, VTK_INT })
  {
    MeshOptions options;
    options.pointType = type;
    vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
    Decimation filter;
    filter->SetInputData(mesh);
    filter->SetTargetReduction(0.8);
    filter->OriginalPointIdsOn();
    vtkPolyData* coarse = filter.output();
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();

    EXPECT_LE(coarse->GetNumberOfPolys(), 0.2 * mesh->GetNumberOfPolys() + 1);
    EXPECT_GT(coarse->GetNumberOfPolys(), 0);
    auto* ids =
      vtkIdTypeArray::SafeDownCast(coarse->GetPointData()->GetAbstractArray("vtkOriginalPointIds"));
    ASSERT_NE(ids, nullptr);
    ASSERT_EQ(ids->GetNumberOfTuples(), coarse->GetNumberOfPoints());
    EXPECT_EQ(coarse->GetPoints()->GetDataType(), type);
    EXPECT_EQ(
      coarse->GetPointData()->GetNumberOfArrays(), mesh->GetPointData()->GetNumberOfArrays() + 1);
    for (vtkIdType i = 0; i < coarse->GetNumberOfPoints(); ++i)
    {
      const vtkIdType original = ids->GetValue(i);
      EXPECT_TRUE(i == 0 || original > ids->GetValue(i - 1)) << "not in the order of the input";
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_EQ(coarse->GetPoint(i)[c], mesh->GetPoint(original)[c]);
      }
      for (int a = 0; a < mesh->GetPointData()->GetNumberOfArrays(); ++a)
      {
        vtkAbstractArray* from = mesh->GetPointData()->GetAbstractArray(a);
        vtkAbstractArray* to = coarse->GetPointData()->GetAbstractArray(a);
        ASSERT_STREQ(from->GetClassName(), to->GetClassName());
        for (int c = 0; c < from->GetNumberOfComponents(); ++c)
        {
          EXPECT_EQ(to->GetVariantValue(i * to->GetNumberOfComponents() + c).ToString(),
            from->GetVariantValue(original * from->GetNumberOfComponents() + c).ToString());
        }
      }
    }
  }
}

TEST(Decimation, LeavesTheInputAlone)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> before = copy(mesh);
  const vtkMTimeType time = mesh->GetMTime();
  decimated(mesh);
  EXPECT_EQ(mesh->GetMTime(), time);
  EXPECT_EQ(differences(mesh, before), "");
}

TEST(Decimation, TellsResultsAndWhatStoppedIt)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  Decimation filter;
  filter->SetInputData(mesh);
  filter->SetTargetReduction(0.5);
  filter.output();
  EXPECT_EQ(filter->GetNumberOfInputNodes(), mesh->GetNumberOfPoints());
  EXPECT_EQ(filter->GetNumberOfInputTriangles(), mesh->GetNumberOfPolys());
  EXPECT_EQ(filter->GetNumberOfNodes(), filter->GetOutput()->GetNumberOfPoints());
  EXPECT_EQ(filter->GetNumberOfTriangles(), filter->GetOutput()->GetNumberOfPolys());
  EXPECT_STREQ(filter->GetStopReason(), "target reduction");
  EXPECT_GT(filter->GetError(), 0.0);
  const double halfError = filter->GetError();

  filter->SetTargetNodes(120);
  filter.output();
  EXPECT_STREQ(filter->GetStopReason(), "target number of nodes");
  EXPECT_EQ(filter->GetNumberOfNodes(), 120);

  filter->SetTargetNodes(0);
  filter->SetTargetTriangles(200);
  filter.output();
  EXPECT_STREQ(filter->GetStopReason(), "target number of triangles");
  EXPECT_LE(filter->GetNumberOfTriangles(), 200);
  EXPECT_GE(filter->GetNumberOfTriangles(), 198);

  filter->SetTargetTriangles(0);
  filter->SetMaximumError(0.5 * halfError);
  filter.output();
  EXPECT_STREQ(filter->GetStopReason(), "maximum error");
  EXPECT_LE(filter->GetError(), 0.5 * halfError);
  EXPECT_GT(filter->GetNumberOfTriangles(), mesh->GetNumberOfPolys() / 2);
  EXPECT_TRUE(filter.messages->silent())
    << "a limit that was asked for is no reason to warn: " << filter.messages->all();
}

TEST(Decimation, ReductionZeroRemovesNothing)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> coarse = decimated(mesh, 0.0);
  EXPECT_EQ(differences(coarse, mesh), "");
  expectRoundTrip(coarse, mesh);
}

TEST(Decimation, WarnsWhenFewerNodesGoThanAsked)
{
  vtkSmartPointer<vtkPolyData> tetrahedron =
    makeMesh({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9 },
      { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } });
  Decimation filter;
  filter->SetInputData(tetrahedron);
  EXPECT_EQ(filter.output()->GetNumberOfPolys(), 4);
  EXPECT_TRUE(filter.messages->errors.empty());
  ASSERT_EQ(filter.messages->warnings.size(), 1u);
  EXPECT_TRUE(has(filter.messages->warnings, "5 of 5 nodes and 4 of 4 triangles are left"))
    << filter.messages->all();
  EXPECT_TRUE(has(filter.messages->warnings, "1 without a triangle")) << filter.messages->all();
  EXPECT_STREQ(filter->GetStopReason(), "no removable node left");
  expectRoundTrip(filter->GetOutput(), tetrahedron);

  filter.messages->warnings.clear();
  filter->SetTargetReduction(1.0); // as many as the mesh allows
  filter.output();
  EXPECT_TRUE(filter.messages->silent());
}

TEST(Decimation, AllCriteriaAndSpacingsGiveManifoldsAndRoundTrips)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  for (int criterion : { 0, 1, 2, 3 })
  {
    for (int spacing : { 0, 1 })
    {
      Decimation filter;
      filter->SetInputData(mesh);
      filter->SetCriterion(criterion);
      filter->SetIntervalSpacing(spacing);
      if (criterion == vtkHashQueueDecimation::DEVIATION ||
        criterion == vtkHashQueueDecimation::SCALAR_DIFFERENCE)
      {
        filter->AddScalars("scalar");
        filter->AddScalars("vector");
      }
      vtkPolyData* coarse = filter.output();
      EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
      EXPECT_LE(coarse->GetNumberOfPolys(), 0.1 * mesh->GetNumberOfPolys() + 1);
      for (const auto& [edge, count] : edgeUse(coarse))
      {
        EXPECT_LE(count, 2);
      }
      expectRoundTrip(coarse, mesh);
    }
  }
}

TEST(Decimation, TheDefaultMaximumErrorDoesNotLimitAngles)
{
  Decimation filter;
  filter->SetInputData(plainGrid());
  filter->SetCriterionToAngleToXYPlane();
  filter.output();
  EXPECT_STREQ(filter->GetStopReason(), "target reduction");
  EXPECT_GT(filter->GetError(), 1.0) << "degrees";
  filter->SetMaximumError(2.0);
  filter.output();
  EXPECT_LE(filter->GetError(), 2.0);
  EXPECT_STREQ(filter->GetStopReason(), "maximum error");
}

TEST(Decimation, ScalarsSteer)
{
  // A plane with a step in the scalar: with the scalar the step is kept sharp.
  vtkSmartPointer<vtkPolyData> mesh = plainGrid(21);
  vtkNew<vtkDoubleArray> step;
  step->SetName("step");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    mesh->GetPoints()->SetPoint(i, i % 21, static_cast<double>(i / 21), 0.0);
    step->InsertNextValue(i % 21 < 10 ? 0.0 : 1.0);
  }
  mesh->GetPointData()->AddArray(step);
  const auto nodesAtStep = [&](bool steer)
  {
    Decimation filter;
    filter->SetInputData(mesh);
    filter->OriginalPointIdsOn();
    if (steer)
    {
      filter->AddScalars("step");
    }
    int count = 0;
    for (vtkIdType id : originalIds(filter.output()))
    {
      count += id % 21 == 9 || id % 21 == 10;
    }
    return static_cast<double>(count) / filter->GetNumberOfNodes();
  };
  EXPECT_GT(nodesAtStep(true), nodesAtStep(false));

  Decimation filter;
  filter->SetInputData(mesh);
  filter->AddScalars("step");
  filter->SetScalarWeight(0.0);
  filter.output();
  EXPECT_LT(filter->GetError(), 1e-6) << "a plane, and the scalar has no weight";
}

TEST(Decimation, ScalarsAreAListOfNames)
{
  vtkNew<vtkHashQueueDecimation> filter;
  EXPECT_EQ(filter->GetNumberOfScalars(), 0);
  EXPECT_EQ(filter->GetScalars(0), nullptr);
  filter->AddScalars("a");
  filter->AddScalars("b");
  const vtkMTimeType time = filter->GetMTime();
  filter->AddScalars("a");
  filter->AddScalars("");
  filter->AddScalars(nullptr);
  EXPECT_EQ(filter->GetMTime(), time);
  ASSERT_EQ(filter->GetNumberOfScalars(), 2);
  EXPECT_STREQ(filter->GetScalars(1), "b");
  EXPECT_EQ(filter->GetScalars(-1), nullptr);
  EXPECT_EQ(filter->GetScalars(2), nullptr);
  filter->ClearScalars();
  EXPECT_EQ(filter->GetNumberOfScalars(), 0);
  EXPECT_GT(filter->GetMTime(), time);
}

TEST(Decimation, ScalarDifferenceFallsBackToTheActiveScalars)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  Decimation active;
  active->SetInputData(mesh);
  active->SetCriterionToScalarDifference();
  Decimation named;
  named->SetInputData(mesh);
  named->SetCriterionToScalarDifference();
  named->AddScalars("scalar");
  EXPECT_EQ(differences(active.output(), named.output()), "");
  EXPECT_TRUE(active.messages->silent()) << active.messages->all();

  Decimation none;
  none->SetCriterionToScalarDifference();
  vtkSmartPointer<vtkPolyData> bare = makeGrid();
  bare->GetPointData()->SetActiveScalars(nullptr);
  expectError(none, bare, { "no active point scalars", "'scalar', 'short', 'vector'" });
}

TEST(Decimation, RefusesScalarsThatAreNotThereOrNotNumbers)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  Decimation missing;
  missing->AddScalars("stress");
  expectError(missing, mesh, { "'stress'", "'scalar', 'short', 'vector'", "'soa'" });
  Decimation text;
  text->AddScalars("names");
  expectError(text, mesh, { "'names'", "vtkStringArray" });
  Decimation wide;
  vtkNew<vtkFloatArray> ten;
  ten->SetName("ten");
  ten->SetNumberOfComponents(10);
  ten->SetNumberOfTuples(mesh->GetNumberOfPoints());
  ten->Fill(0.0);
  mesh->GetPointData()->AddArray(ten);
  wide->AddScalars("ten");
  expectError(wide, mesh, { "'ten'", "10 components" });
  Decimation bare;
  bare->AddScalars("stress");
  expectError(bare, plainGrid(), { "'stress'", "none" });
}

TEST(Decimation, UsesScalarsOfAnyNumericType)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  for (const char* name : { "scalar", "vector", "ids", "bits", "colour", "tensor", "soa", "short" })
  {
    Decimation filter;
    filter->SetInputData(mesh);
    filter->AddScalars(name);
    EXPECT_LT(filter.output()->GetNumberOfPolys(), mesh->GetNumberOfPolys()) << name;
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  }
}

TEST(Decimation, NamesCellsThatAreNotTriangles)
{
  vtkSmartPointer<vtkPolyData> mesh =
    makeMesh({ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 3, 0.5, 0 },
      { { 0, 1, 2, 3 }, { 1, 4, 6, 5, 2 }, { 0, 1 }, { 0, 1, 2 } });
  const vtkIdType strip[] = { 0, 1, 3, 2 };
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell(4, strip);
  mesh->SetStrips(strips);
  Decimation filter;
  expectError(filter, mesh,
    { "1 quad, 1 polygon, 1 triangle strip and 1 face of fewer than three points", "Triangulate" });
}

TEST(Decimation, TriangulatesOnRequest)
{
  vtkSmartPointer<vtkPolyData> mesh = makeMesh(
    { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 1.5, 0.4, 0, 0, 2, 0, 1, 2, 0 },
    { { 0, 1, 2, 3 }, { 1, 4, 5, 2, 6 }, { 0, 1 }, { 3, 2, 7 } });
  const vtkIdType strip[] = { 7, 2, 8 };
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell(3, strip);
  mesh->SetStrips(strips);
  const vtkIdType line[] = { 0, 3 };
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(2, line);
  mesh->SetLines(lines);
  vtkNew<vtkIntArray> part;
  part->SetName("part");
  for (int value : { 100, 1, 2, 3, 4, 5 }) // the line, the faces, the strip
  {
    part->InsertNextValue(value);
  }
  mesh->GetCellData()->AddArray(part);

  Decimation filter;
  filter->SetInputData(mesh);
  filter->TriangulateOn();
  filter->SetTargetReduction(1.0);
  vtkPolyData* coarse = filter.output();
  EXPECT_TRUE(filter.messages->errors.empty()) << filter.messages->all();
  EXPECT_TRUE(has(filter.messages->warnings, "1 quad, 1 polygon, 1 triangle strip"))
    << filter.messages->all();
  EXPECT_TRUE(has(filter.messages->warnings, "1 faces of the input gave no triangle"));

  // Level 1 is the triangulated mesh: 2 + 3 + 1 + 1 triangles that inherit their cell data.
  vtkSmartPointer<vtkPolyData> fine = undecimated(coarse, 1.0);
  EXPECT_EQ(fine->GetNumberOfPolys(), 7);
  EXPECT_EQ(fine->GetNumberOfStrips(), 0);
  EXPECT_EQ(differences(fine->GetPoints()->GetData(), mesh->GetPoints()->GetData()), "");
  std::vector<int> parts;
  for (vtkIdType i = 0; i < fine->GetNumberOfCells(); ++i)
  {
    parts.push_back(static_cast<int>(fine->GetCellData()->GetArray("part")->GetComponent(i, 0)));
  }
  EXPECT_EQ(parts, (std::vector<int>{ 100, 1, 1, 2, 2, 2, 4, 5 }));
  double area = 0.0;
  for (const Triangle& t : triangles(fine))
  {
    double a[3], b[3], c[3];
    fine->GetPoint(t[0], a);
    fine->GetPoint(t[1], b);
    fine->GetPoint(t[2], c);
    area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  }
  EXPECT_NEAR(area, 1.0 + (1.0 - 0.5 * 0.5) + 0.5 + 0.5, 1e-12) << "a concave polygon among them";

  // Said once.
  filter.messages->warnings.clear();
  filter->SetTargetReduction(0.9);
  filter.output();
  EXPECT_FALSE(has(filter.messages->warnings, "1 quad"));
}

TEST(Decimation, PassesVertexCellsAndLinesAlong)
{
  for (bool wide : { true, false })
  {
    MeshOptions options;
    options.vertsAndLines = true;
    options.wide = wide;
    vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
    Decimation filter;
    filter->SetInputData(mesh);
    filter->OriginalPointIdsOn();
    vtkPolyData* coarse = filter.output();
    EXPECT_EQ(filter.messages->warnings.size(), 1u);
    EXPECT_TRUE(has(filter.messages->warnings, "2 vertex cells and 2 lines"));
    EXPECT_EQ(coarse->GetNumberOfVerts(), 2);
    EXPECT_EQ(coarse->GetNumberOfLines(), 2);
    vtkDataArray* ids = coarse->GetPointData()->GetArray("vtkOriginalPointIds");
    vtkNew<vtkIdList> now;
    vtkNew<vtkIdList> before;
    for (int i : { 0, 1 })
    {
      coarse->GetLines()->GetCellAtId(i, now);
      mesh->GetLines()->GetCellAtId(i, before);
      ASSERT_EQ(now->GetNumberOfIds(), before->GetNumberOfIds());
      for (vtkIdType k = 0; k < now->GetNumberOfIds(); ++k)
      {
        EXPECT_EQ(ids->GetComponent(now->GetId(k), 0), before->GetId(k));
      }
    }
    for (int cell = 0; cell < 4; ++cell)
    {
      EXPECT_EQ(coarse->GetCellData()->GetArray("number")->GetComponent(cell, 0), cell);
    }
    expectRoundTrip(coarse, mesh);
    EXPECT_EQ(undecimated(coarse, 0.4)->GetNumberOfLines(), 2);
  }
}

TEST(Decimation, EmptyInputGivesEmptyOutputSilently)
{
  for (const auto& mesh : { vtkSmartPointer<vtkPolyData>::New(), makeMesh({}, {}) })
  {
    Decimation filter;
    filter->SetInputData(mesh);
    EXPECT_EQ(filter.output()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter.output(1)->GetNumberOfPoints(), 0);
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
    EXPECT_EQ(filter->GetNumberOfInputNodes(), 0);
    EXPECT_EQ(undecimated(filter->GetOutput(), 0.5)->GetNumberOfPoints(), 0);
  }
}

TEST(Decimation, AnEmptyMeshDoesNotCarryAnOldRecordOn)
{
  vtkSmartPointer<vtkPolyData> emptied = decimated(makeGrid(), 0.5);
  vtkNew<vtkPolyData> mesh;
  mesh->GetFieldData()->ShallowCopy(emptied->GetFieldData());
  Decimation filter;
  filter->SetInputData(mesh);
  vtkNew<vtkUndecimation> undecimation;
  undecimation->SetInputData(mesh);
  undecimation->Update();
  for (vtkPolyData* output : { filter.output(), filter.output(1), undecimation->GetOutput() })
  {
    EXPECT_NE(output->GetFieldData()->GetAbstractArray("note"), nullptr);
    EXPECT_EQ(output->GetFieldData()->GetNumberOfArrays(), 1);
  }
}

TEST(Decimation, RefusesArraysThatAreTooShort)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid();
  vtkNew<vtkDoubleArray> values;
  values->SetName("half");
  values->SetNumberOfTuples(mesh->GetNumberOfPoints() / 2);
  values->Fill(1.0);
  mesh->GetPointData()->AddArray(values);
  Decimation point;
  expectError(point, mesh, { "Point array 'half'", std::to_string(mesh->GetNumberOfPoints()) });
  mesh->GetPointData()->RemoveArray("half");
  mesh->GetCellData()->AddArray(values);
  Decimation cell;
  expectError(cell, mesh, { "Cell array 'half'", std::to_string(mesh->GetNumberOfCells()) });
}

TEST(Decimation, RefusesFacesToCutWithPointsThatDoNotExist)
{
  Decimation filter;
  filter->TriangulateOn();
  expectError(filter, makeMesh({ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 }, { { 0, 1, 2, 2000000 } }),
    { "outside the 4 points" });
}

TEST(Decimation, AVertexCellWithoutPointsPassesThrough)
{
  vtkNew<vtkPolyData> mesh;
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell(0);
  mesh->SetVerts(verts);
  Decimation filter;
  filter->SetInputData(mesh);
  EXPECT_EQ(filter.output()->GetNumberOfVerts(), 1);
}

// Pressure in Pa: the range is far below the values' own single precision.
TEST(Decimation, ScalarsWithALargeOffsetSteerAsWell)
{
  const auto errorWith = [](double offset, double size)
  {
    vtkSmartPointer<vtkPolyData> mesh = plainGrid(21);
    vtkNew<vtkDoubleArray> bump;
    bump->SetName("bump");
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      const double x = static_cast<double>(i % 21);
      const double y = static_cast<double>(i / 21);
      mesh->GetPoints()->SetPoint(i, x, y, 0.0);
      const double square = (x - 10.0) * (x - 10.0) + (y - 10.0) * (y - 10.0);
      bump->InsertNextValue(offset + size * std::exp(-0.05 * square));
    }
    mesh->GetPointData()->AddArray(bump);
    Decimation filter;
    filter->SetInputData(mesh);
    filter->AddScalars("bump");
    filter.output();
    return filter->GetError();
  };
  const double plain = errorWith(0.0, 1.0);
  EXPECT_GT(plain, 1e-4);
  // Rounding may decide otherwise between neighbours that cost the same; powers of two do not
  // round.
  EXPECT_NEAR(errorWith(101325.0, 0.01), plain, 0.2 * plain);
  EXPECT_NEAR(errorWith(0.0, std::ldexp(1.0, 100)), plain, 1e-6 * plain);
  EXPECT_NEAR(errorWith(0.0, std::ldexp(1.0, -100)), plain, 1e-6 * plain);
}

TEST(Decimation, ADefaultMaximumErrorIsNoLimitWhateverTheWeight)
{
  Decimation filter;
  filter->SetInputData(makeGrid());
  vtkPolyData* mesh = vtkPolyData::SafeDownCast(filter->GetInputDataObject(0, 0));
  for (int i = 0; i < mesh->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = mesh->GetPointData()->GetArray(i);
    if (array && array->GetName() && array->GetNumberOfComponents() == 1)
    {
      filter->AddScalars(array->GetName());
    }
  }
  ASSERT_GT(filter->GetNumberOfScalars(), 0);
  filter->SetScalarWeight(1000.0);
  filter->SetTargetReduction(0.95);
  filter.output();
  EXPECT_GT(filter->GetError(), 1.0);
  EXPECT_STREQ(filter->GetStopReason(), "target reduction");
}

TEST(Decimation, PointsWithoutTrianglesPassThrough)
{
  vtkSmartPointer<vtkPolyData> mesh = makeMesh({ 0, 0, 0, 1, 2, 3 }, {});
  Decimation filter;
  filter->SetInputData(mesh);
  filter->SetTargetReduction(1.0);
  vtkPolyData* coarse = filter.output();
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  EXPECT_EQ(coarse->GetNumberOfPoints(), 2);
  expectRoundTrip(coarse, mesh);
}

TEST(Decimation, RefusesCellsWithPointsThatDoNotExist)
{
  Decimation filter;
  expectError(filter, makeMesh({ 0, 0, 0, 1, 0, 0, 0, 1, 0 }, { { 0, 1, 2 }, { 0, 1, 7 } }),
    { "Triangle 1", "node 7", "3 nodes" });
  Decimation negative;
  expectError(negative, makeMesh({ 0, 0, 0, 1, 0, 0, 0, 1, 0 }, { { 0, -1, 2 } }),
    { "Triangle 0", "node -1" });
  Decimation pointless;
  expectError(pointless, makeMesh({}, { { 0, 1, 2 } }), { "Triangle 0", "0 nodes" });
  Decimation line;
  vtkSmartPointer<vtkPolyData> mesh = makeMesh({ 0, 0, 0, 1, 0, 0, 0, 1, 0 }, { { 0, 1, 2 } });
  const vtkIdType ids[] = { 0, 3 };
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(2, ids);
  mesh->SetLines(lines);
  expectError(line, mesh, { "line", "outside the 3 points" });
}

// Triangles and nodes that the core keeps: they are there at level 0 too, and come back exactly.
TEST(Decimation, KeepsWhatIsNotAManifold)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid(9);
  const vtkIdType n = mesh->GetNumberOfPoints();
  vtkPoints* points = mesh->GetPoints();
  points->InsertNextPoint(400, 400, 500); // n: a fin on edge 40-41, so that it has three triangles
  points->InsertNextPoint(0, 0, -900);    // n + 1, n + 2: touch the grid in node 20 only
  points->InsertNextPoint(50, 0, -900);
  points->InsertNextPoint(7, 7, 7); // n + 3: unused
  vtkCellArray* faces = mesh->GetPolys();
  const vtkIdType fin[] = { 40, 41, n };
  const vtkIdType bowTie[] = { 20, n + 1, n + 2 };
  const vtkIdType degenerate[] = { 60, 60, 61 };
  faces->InsertNextCell(3, fin);
  faces->InsertNextCell(3, bowTie);
  faces->InsertNextCell(3, degenerate);
  vtkNew<vtkIdList> first;
  faces->GetCellAtId(12, first);
  const vtkIdType repeated[] = { first->GetId(1), first->GetId(2), first->GetId(0) };
  faces->InsertNextCell(3, repeated);

  Decimation filter;
  filter->SetInputData(mesh);
  filter->OriginalPointIdsOn();
  filter->SetTargetReduction(1.0);
  vtkPolyData* coarse = filter.output();
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  EXPECT_LT(coarse->GetNumberOfPoints(), mesh->GetNumberOfPoints());
  const std::set<vtkIdType> left = originalIds(coarse);
  for (vtkIdType node : { vtkIdType{ 40 }, vtkIdType{ 41 }, vtkIdType{ 20 }, n + 3, vtkIdType{ 60 },
         vtkIdType{ 61 }, repeated[0], repeated[1], repeated[2] })
  {
    EXPECT_EQ(left.count(node), 1u) << node;
  }
  expectRoundTrip(coarse, mesh);
}

TEST(Decimation, KeepsNodesThatAreNotNumbers)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid();
  mesh->GetPoints()->SetPoint(30, kNaN, 1.0, 2.0);
  mesh->GetPoints()->SetPoint(70, 1.0, std::numeric_limits<double>::infinity(), 2.0);
  vtkNew<vtkFloatArray> scalar;
  scalar->SetName("scalar");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    scalar->InsertNextValue(i == 99 ? static_cast<float>(kNaN) : static_cast<float>(i % 5));
  }
  mesh->GetPointData()->SetScalars(scalar);
  for (int criterion : { 0, 1, 2, 3 })
  {
    for (int spacing : { 0, 1 })
    {
      Decimation filter;
      filter->SetInputData(mesh);
      filter->SetCriterion(criterion);
      filter->SetIntervalSpacing(spacing);
      filter->AddScalars("scalar");
      filter->OriginalPointIdsOn();
      vtkPolyData* coarse = filter.output();
      EXPECT_TRUE(filter.messages->errors.empty());
      EXPECT_LT(coarse->GetNumberOfPoints(), mesh->GetNumberOfPoints() / 2);
      const std::set<vtkIdType> left = originalIds(coarse);
      EXPECT_EQ(left.count(30), 1u);
      EXPECT_EQ(left.count(70), 1u);
      if (criterion < vtkHashQueueDecimation::ANGLE_TO_XY_PLANE)
      {
        EXPECT_EQ(left.count(99), 1u) << "its scalar is not a number";
      }
      EXPECT_FALSE(std::isnan(filter->GetError()));
      expectRoundTrip(coarse, mesh);
    }
  }
}

TEST(Decimation, PreservesTheBoundaryOnRequestAndInPieces)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid();
  const std::set<vtkIdType> boundary = boundaryNodes(mesh);
  const auto keepsAll = [&](vtkPolyData* coarse)
  {
    const std::set<vtkIdType> left = originalIds(coarse);
    return std::includes(left.begin(), left.end(), boundary.begin(), boundary.end());
  };
  Decimation filter;
  filter->SetInputData(mesh);
  filter->OriginalPointIdsOn();
  filter->SetTargetReduction(0.7);
  EXPECT_FALSE(keepsAll(filter.output()));
  filter->PreserveBoundaryOn();
  EXPECT_TRUE(keepsAll(filter.output()));
  filter->PreserveBoundaryOff();
  filter->UpdatePiece(0, 4, 0);
  EXPECT_TRUE(keepsAll(filter->GetOutput()));
  expectRoundTrip(filter->GetOutput(), mesh);
  // Whoever shows the bare mesh only must not get cracks.
  Decimation bare;
  bare->SetInputData(mesh);
  bare->OriginalPointIdsOn();
  bare->SetTargetReduction(0.7);
  bare->UpdateInformation();
  vtkInformation* request = bare->GetOutputInformation(vtkHashQueueDecimation::COARSE_MESH);
  request->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), 4);
  request->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), 0);
  bare->Update(vtkHashQueueDecimation::COARSE_MESH);
  EXPECT_TRUE(keepsAll(bare->GetOutput(vtkHashQueueDecimation::COARSE_MESH)));
}

TEST(Decimation, KeepsNodesOfGhosts)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid();
  vtkNew<vtkUnsignedCharArray> cellGhosts;
  cellGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
  std::set<vtkIdType> expected;
  const std::vector<Triangle> all = triangles(mesh);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPolys(); ++i)
  {
    const bool ghost = i >= 100 && i < 120;
    cellGhosts->InsertNextValue(ghost ? vtkDataSetAttributes::DUPLICATECELL : 0);
    if (ghost)
    {
      expected.insert(all[i].begin(), all[i].end());
    }
  }
  mesh->GetCellData()->AddArray(cellGhosts);
  vtkNew<vtkUnsignedCharArray> pointGhosts;
  pointGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    pointGhosts->InsertNextValue(i == 15 || i == 16 ? vtkDataSetAttributes::DUPLICATEPOINT : 0);
  }
  mesh->GetPointData()->AddArray(pointGhosts);
  expected.insert({ 15, 16 });

  Decimation filter;
  filter->SetInputData(mesh);
  filter->OriginalPointIdsOn();
  filter->SetTargetReduction(1.0);
  const std::set<vtkIdType> left = originalIds(filter.output());
  EXPECT_TRUE(std::includes(left.begin(), left.end(), expected.begin(), expected.end()));
  EXPECT_LT(left.size(), expected.size() + 30);
  expectRoundTrip(filter->GetOutput(), mesh);
}

TEST(Decimation, PassesFieldDataButNoOldRecord)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> once = decimated(mesh, 0.5);
  EXPECT_NE(once->GetFieldData()->GetAbstractArray("note"), nullptr);
  vtkSmartPointer<vtkPolyData> twice = decimated(once, 0.5);
  EXPECT_NE(twice->GetFieldData()->GetAbstractArray("note"), nullptr);
  vtkSmartPointer<vtkPolyData> back = undecimated(twice, 1.0);
  EXPECT_EQ(differences(back, once), "");
  EXPECT_NE(back->GetFieldData()->GetAbstractArray("note"), nullptr);
  EXPECT_EQ(back->GetFieldData()->GetNumberOfArrays(), 1);
}

TEST(Decimation, TheSecondPortHasTheMeshWithoutTheRecord)
{
  Decimation filter;
  filter->SetInputData(makeGrid());
  vtkPolyData* progressive = filter.output(vtkHashQueueDecimation::PROGRESSIVE_MESH);
  vtkPolyData* coarse = filter.output(vtkHashQueueDecimation::COARSE_MESH);
  EXPECT_EQ(differences(progressive, coarse), "");
  EXPECT_NE(progressive->GetFieldData()->GetAbstractArray("Undecimation.Header"), nullptr);
  ASSERT_EQ(coarse->GetFieldData()->GetNumberOfArrays(), 1);
  EXPECT_STREQ(coarse->GetFieldData()->GetAbstractArray(0)->GetName(), "note");
  EXPECT_EQ(progressive->GetPoints(), coarse->GetPoints()) << "shared";
  const std::string error = undecimationError(coarse);
  EXPECT_NE(error.find("Progressive Mesh"), std::string::npos) << error;
}

TEST(Decimation, OriginalPointIdsReplaceAnArrayOfThatName)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("vtkOriginalPointIds");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    ids->InsertNextValue(-i);
  }
  mesh->GetPointData()->AddArray(ids);
  expectRoundTrip(decimated(mesh), mesh);

  Decimation filter;
  filter->SetInputData(mesh);
  filter->OriginalPointIdsOn();
  vtkPolyData* coarse = filter.output();
  EXPECT_TRUE(has(filter.messages->warnings, "'vtkOriginalPointIds' gives way"));
  EXPECT_GE(*originalIds(coarse).begin(), 0);
  mesh->GetPointData()->RemoveArray("vtkOriginalPointIds");
  expectRoundTrip(coarse, mesh);
}

TEST(Decimation, ProgressIsMonotoneAndEndsAtOne)
{
  std::vector<double> progress;
  Decimation filter;
  filter->SetInputData(plainGrid(60));
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&progress);
  command->SetCallback([](vtkObject*, unsigned long, void* list, void* fraction)
    { static_cast<std::vector<double>*>(list)->push_back(*static_cast<double*>(fraction)); });
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter.output();
  EXPECT_GE(progress.size(), 20u);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_GE(progress.front(), 0.0);
  EXPECT_EQ(progress.back(), 1.0);
}

TEST(Decimation, AnAbortGivesNothingWithoutAnError)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid(60);
  for (double when : { 0.0, 0.1, 0.5, 0.9 })
  {
    Decimation filter;
    filter->SetInputData(mesh);
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(&when);
    command->SetCallback(
      [](vtkObject* caller, unsigned long, void* client, void* fraction)
      {
        if (*static_cast<double*>(fraction) >= *static_cast<double*>(client))
        {
          static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
        }
      });
    filter->AddObserver(vtkCommand::ProgressEvent, command);
    vtkPolyData* output = filter.output();
    EXPECT_EQ(output->GetNumberOfPoints(), 0) << when;
    EXPECT_EQ(output->GetFieldData()->GetAbstractArray("Undecimation.Header"), nullptr);
    EXPECT_EQ(filter->GetOutput(1)->GetNumberOfPoints(), 0);
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();

    // The filter works afterwards.
    filter->RemoveObservers(vtkCommand::ProgressEvent);
    filter->SetAbortExecute(0);
    filter->Modified();
    EXPECT_GT(filter.output()->GetNumberOfPoints(), 0);
  }
}

TEST(Decimation, AsksForAnAbortAtLeastTenTimesASecond)
{
  // In CPU time: what other programs take is not ours.
  struct Times
  {
    std::clock_t last = std::clock();
    double longest = 0.0;
  } times;
  Decimation filter;
  filter->SetInputData(plainGrid(120));
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&times);
  command->SetCallback(
    [](vtkObject*, unsigned long, void* client, void*)
    {
      auto* t = static_cast<Times*>(client);
      const std::clock_t now = std::clock();
      t->longest = std::max(t->longest, static_cast<double>(now - t->last) / CLOCKS_PER_SEC);
      t->last = now;
    });
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter.output();
  // 0.1 s is the aim; the sanitizers get some room.
  EXPECT_LT(times.longest, 0.5);
}

TEST(Decimation, SumsItsResultsOverTheBlocksOfAComposite)
{
  vtkSmartPointer<vtkPolyData> first = makeGrid();
  MeshOptions options;
  options.seed = 2;
  options.rows = 20;
  vtkSmartPointer<vtkPolyData> second = makeGrid(options);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, first);
  blocks->SetBlock(2, second); // block 1 is empty
  Decimation filter;
  filter->SetInputDataObject(blocks);
  filter->Update();
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  for (int port : { 0, 1 })
  {
    auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(port));
    ASSERT_NE(output, nullptr);
    auto* a = vtkPolyData::SafeDownCast(output->GetBlock(0));
    auto* b = vtkPolyData::SafeDownCast(output->GetBlock(2));
    ASSERT_NE(a, nullptr);
    ASSERT_NE(b, nullptr);
    EXPECT_EQ(filter->GetNumberOfNodes(), a->GetNumberOfPoints() + b->GetNumberOfPoints());
    EXPECT_EQ(filter->GetNumberOfTriangles(), a->GetNumberOfPolys() + b->GetNumberOfPolys());
    if (port == 0)
    {
      expectRoundTrip(a, first);
      expectRoundTrip(b, second);
    }
  }
  EXPECT_EQ(
    filter->GetNumberOfInputNodes(), first->GetNumberOfPoints() + second->GetNumberOfPoints());
  EXPECT_STREQ(filter->GetStopReason(), "target reduction");
}

TEST(Decimation, FollowsAChangingInput)
{
  vtkSmartPointer<vtkPolyData> mesh = plainGrid();
  Decimation filter;
  filter->SetInputData(mesh);
  filter.output();
  mesh->GetPoints()->SetPoint(50, 1.0, 2.0, 3000.0);
  mesh->GetPoints()->Modified();
  expectRoundTrip(filter.output(), mesh);
}

TEST(Decimation, SaysThatScalarsDoNotCount)
{
  for (const int criterion :
    { vtkHashQueueDecimation::ANGLE_TO_XY_PLANE, vtkHashQueueDecimation::QUADRIC })
  {
    Decimation filter;
    filter->SetInputData(plainGrid());
    filter->SetCriterion(criterion);
    filter.output();
    EXPECT_TRUE(filter.messages->warnings.empty()) << filter.messages->all();
    filter->AddScalars("stress");
    filter.output();
    filter->SetTargetReduction(0.5);
    filter.output();
    ASSERT_EQ(filter.messages->warnings.size(), 1u) << filter.messages->all();
    EXPECT_TRUE(has(filter.messages->warnings, "The arrays in Scalars do not count"));
  }
}

TEST(Decimation, ParallelDoesNotDependOnTheThreads)
{
  MeshOptions options;
  options.rows = 71;
  vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
  Decimation filter;
  filter->SetInputData(mesh);
  filter->OriginalPointIdsOn();
  filter->ParallelOn();
  filter->SetNumberOfThreads(1);
  vtkNew<vtkPolyData> one;
  one->DeepCopy(filter.output());
  EXPECT_LT(one->GetNumberOfPoints(), mesh->GetNumberOfPoints() / 5);
  for (const int threads : { 3, 0 })
  {
    filter->SetNumberOfThreads(threads);
    vtkPolyData* other = filter.output();
    EXPECT_EQ(originalIds(other), originalIds(one));
    EXPECT_EQ(triangles(other), triangles(one));
    expectRoundTrip(other, mesh);
  }
}

TEST(Decimation, PrintsAllProperties)
{
  vtkNew<vtkHashQueueDecimation> filter;
  filter->AddScalars("stress");
  std::ostringstream text;
  filter->Print(text);
  for (const char* word : { "TargetReduction: 0.9", "TargetNodes: 0", "TargetTriangles: 0",
         "MaximumError: 1", "Criterion: 0", "Scalars: stress", "ScalarWeight: 0.055",
         "ShapeWeight: 0", "IntervalSpacing: 0", "IntervalNodes: 4", "PreserveBoundary: Off",
         "Parallel: Off", "NumberOfThreads: 0", "Triangulate: Off", "OriginalPointIds: Off",
         "NumberOfInputNodes: 0", "StopReason:" })
  {
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
  }
}

TEST(Decimation, ClampsItsProperties)
{
  vtkNew<vtkHashQueueDecimation> filter;
  filter->SetTargetReduction(7.0);
  EXPECT_EQ(filter->GetTargetReduction(), 1.0);
  filter->SetTargetReduction(-1.0);
  EXPECT_EQ(filter->GetTargetReduction(), 0.0);
  filter->SetTargetNodes(-5);
  EXPECT_EQ(filter->GetTargetNodes(), 0);
  filter->SetTargetTriangles(-5);
  EXPECT_EQ(filter->GetTargetTriangles(), 0);
  filter->SetMaximumError(-1.0);
  EXPECT_EQ(filter->GetMaximumError(), 0.0);
  filter->SetCriterion(99);
  EXPECT_EQ(filter->GetCriterion(), vtkHashQueueDecimation::QUADRIC);
  filter->SetIntervalNodes(0.0);
  EXPECT_GT(filter->GetIntervalNodes(), 0.0);
  filter->SetScalarWeight(-1.0);
  EXPECT_EQ(filter->GetScalarWeight(), 0.0);
  filter->SetShapeWeight(-1.0);
  EXPECT_EQ(filter->GetShapeWeight(), 0.0);
}

} // namespace
