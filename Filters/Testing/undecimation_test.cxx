// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkUndecimation: every level, exactly; what is cached; which inputs are refused, and how.

#include "filterTesting.h"

#include "vtkHashQueueDecimation.h"
#include "vtkUndecimation.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkLookupTable.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTrivialProducer.h"
#include "vtkVariant.h"
#include "vtkVariantArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

using namespace filter_testing;

namespace
{

using Undecimation = Watched<vtkUndecimation>;

vtkSmartPointer<vtkPolyData> shallow(vtkPolyData* mesh)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(mesh);
  return result;
}

// ---- levels ----

TEST(Undecimation, LevelOneIsTheInputBitForBit)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE, VTK_SHORT })
  {
    for (const bool wide : { true, false })
    {
      for (const bool arrays : { true, false })
      {
        MeshOptions options;
        options.pointType = type;
        options.wide = wide;
        options.pointData = arrays;
        options.cellData = arrays;
        options.seed = 5;
        vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
        vtkSmartPointer<vtkPolyData> back = undecimated(decimated(mesh), 1.0);
        EXPECT_EQ(differences(back, mesh), "") << type << wide << arrays;
        EXPECT_NE(back->GetFieldData()->GetAbstractArray("note"), nullptr);
        EXPECT_EQ(back->GetFieldData()->GetNumberOfArrays(), 1) << "no record";
      }
    }
  }
}

TEST(Undecimation, LevelOneOfThePlateIsTheInputBitForBit)
{
  vtkSmartPointer<vtkPolyData> plate = readPlate();
  ASSERT_EQ(plate->GetNumberOfPoints(), 15559);
  vtkNew<vtkHashQueueDecimation> filter;
  filter->SetInputData(plate);
  filter->SetCriterionToScalarDifference();
  filter->AddScalars("von_mises");
  filter->Update();
  EXPECT_EQ(differences(undecimated(filter->GetOutput(), 1.0), plate), "");
}

// Arrays of several megabytes are written and kept in other ways than small ones.
TEST(Undecimation, LevelsOfALargeMeshAreExact)
{
  for (const bool wide : { true, false })
  {
    MeshOptions options;
    options.rows = 420;
    options.wide = wide;
    options.pointData = false;
    options.cellData = false;
    vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
    vtkNew<vtkHashQueueDecimation> decimation;
    decimation->SetInputData(mesh);
    decimation->SetCriterionToAngleToXYPlane();
    decimation->SetTargetReduction(0.99);
    decimation->Update();
    Undecimation filter;
    filter->SetInputConnection(decimation->GetOutputPort());
    for (const double level : { 0.9, 0.91, 1.0 })
    {
      filter->SetLevel(level);
      vtkPolyData* now = filter.output();
      if (level < 1.0)
      {
        EXPECT_EQ(differences(now, undecimated(decimation->GetOutput(), level)), "");
      }
      else
      {
        EXPECT_EQ(differences(now, mesh), "");
      }
    }
  }
}

TEST(Undecimation, LevelZeroIsTheCoarseMesh)
{
  vtkSmartPointer<vtkPolyData> coarse = decimated(makeGrid());
  EXPECT_EQ(differences(undecimated(coarse, 0.0), coarse), "");
}

TEST(Undecimation, ALevelIsTheSameFromAnywhere)
{
  vtkSmartPointer<vtkPolyData> coarse = decimated(makeGrid());
  Undecimation filter;
  filter->SetInputData(coarse);
  for (const double level : { 0.5, 0.1, 1.0, 0.3, 0.31, 0.0, 0.99, 0.3, 1.0, 0.0, 0.77 })
  {
    filter->SetLevel(level);
    EXPECT_EQ(differences(filter.output(), undecimated(coarse, level)), "") << level;
  }
  EXPECT_TRUE(filter.messages->silent());
}

TEST(Undecimation, LevelsArePrefixesOfEachOther)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> coarse = decimated(mesh);
  vtkSmartPointer<vtkPolyData> before = coarse;
  Undecimation filter;
  filter->SetInputData(coarse);
  filter->OriginalPointIdsOn();
  for (const double level : { 0.0, 0.2, 0.4, 0.9, 1.0 })
  {
    filter->SetLevel(level);
    vtkPolyData* now = filter.output();
    const vtkIdType removed = mesh->GetNumberOfPoints() - coarse->GetNumberOfPoints();
    EXPECT_EQ(
      now->GetNumberOfPoints(), coarse->GetNumberOfPoints() + std::llround(level * removed));
    EXPECT_EQ(filter->GetNumberOfNodes(), now->GetNumberOfPoints());
    EXPECT_EQ(filter->GetNumberOfTriangles(), now->GetNumberOfPolys());
    auto* ids =
      vtkIdTypeArray::SafeDownCast(now->GetPointData()->GetAbstractArray("vtkOriginalPointIds"));
    ASSERT_NE(ids, nullptr);
    for (vtkIdType i = 0; i < now->GetNumberOfPoints(); ++i)
    {
      const vtkIdType original = level < 1.0 ? ids->GetValue(i) : i;
      EXPECT_EQ(ids->GetValue(i), original);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_EQ(now->GetPoint(i)[c], mesh->GetPoint(original)[c]);
      }
      EXPECT_EQ(now->GetPointData()->GetArray("scalar")->GetComponent(i, 0),
        mesh->GetPointData()->GetArray("scalar")->GetComponent(original, 0));
      EXPECT_EQ(now->GetPointData()->GetAbstractArray("names")->GetVariantValue(i).ToString(),
        mesh->GetPointData()->GetAbstractArray("names")->GetVariantValue(original).ToString());
      if (level < 1.0 && i < before->GetNumberOfPoints())
      {
        EXPECT_EQ(now->GetPoint(i)[0], before->GetPoint(i)[0]) << "the number of a point changed";
      }
    }
    before = shallow(now);
  }
}

// Each triangle shows the data of one input triangle, all arrays of the same one.
TEST(Undecimation, CellDataIsThatOfOneInputTriangle)
{
  MeshOptions options;
  options.vertsAndLines = true;
  vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
  Watched<vtkHashQueueDecimation> decimation;
  decimation->SetInputData(mesh);
  decimation.output();
  for (const double level : { 0.0, 0.3, 0.7, 1.0 })
  {
    vtkSmartPointer<vtkPolyData> now = undecimated(decimation->GetOutput(), level);
    ASSERT_EQ(now->GetCellData()->GetNumberOfArrays(), mesh->GetCellData()->GetNumberOfArrays());
    EXPECT_STREQ(now->GetCellData()->GetScalars()->GetName(), "pressure");
    std::vector<int> shown;
    for (vtkIdType i = 0; i < now->GetNumberOfCells(); ++i)
    {
      const int number =
        static_cast<int>(now->GetCellData()->GetArray("number")->GetComponent(i, 0));
      ASSERT_GE(number, 0);
      ASSERT_LT(number, mesh->GetNumberOfCells());
      EXPECT_EQ(i < 4, number < 4) << "vertex cells and lines come first and keep their data";
      shown.push_back(number);
      EXPECT_EQ(now->GetCellData()->GetArray("pressure")->GetComponent(i, 0),
        mesh->GetCellData()->GetArray("pressure")->GetComponent(number, 0));
      EXPECT_EQ(now->GetCellData()->GetArray("normal")->GetComponent(i, 2),
        mesh->GetCellData()->GetArray("normal")->GetComponent(number, 2));
      EXPECT_EQ(now->GetCellData()->GetAbstractArray("part")->GetVariantValue(i).ToString(),
        mesh->GetCellData()->GetAbstractArray("part")->GetVariantValue(number).ToString());
    }
    if (level == 1.0)
    {
      EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
    }
  }
}

TEST(Undecimation, CanGoByError)
{
  vtkSmartPointer<vtkPolyData> coarse = decimated(makeGrid());
  Undecimation filter;
  filter->SetInputData(coarse);
  filter->SetLevel(0.0);
  filter.output();
  const double largest = filter->GetError();
  ASSERT_GT(largest, 0.0);
  filter->SetLevelByToError();
  vtkIdType before = 0;
  for (const double bound : { 2.0 * largest, largest, 0.5 * largest, 0.1 * largest, 0.0 })
  {
    filter->SetMaximumError(bound);
    vtkPolyData* now = filter.output();
    EXPECT_LE(filter->GetError(), bound);
    EXPECT_GE(now->GetNumberOfPoints(), before);
    before = now->GetNumberOfPoints();
    if (bound >= largest)
    {
      EXPECT_EQ(now->GetNumberOfPoints(), coarse->GetNumberOfPoints())
        << "the coarsest that will do";
    }
  }
}

TEST(Undecimation, PassesFieldDataAtAllLevels)
{
  vtkSmartPointer<vtkPolyData> coarse = decimated(makeGrid());
  vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(4.5);
  coarse->GetFieldData()->AddArray(time);
  for (const double level : { 0.0, 0.5, 1.0 })
  {
    vtkSmartPointer<vtkPolyData> mesh = undecimated(coarse, level);
    vtkFieldData* data = mesh->GetFieldData();
    EXPECT_EQ(data->GetNumberOfArrays(), 2);
    EXPECT_EQ(data->GetAbstractArray("TimeValue"), time);
    EXPECT_NE(data->GetAbstractArray("note"), nullptr);
  }
}

TEST(Undecimation, KeepsLookupTablesAndForgetsRanges)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkNew<vtkLookupTable> table;
  mesh->GetPointData()->GetScalars()->SetLookupTable(table);
  Watched<vtkHashQueueDecimation> decimation;
  decimation->SetInputData(mesh);
  vtkPolyData* coarse = decimation.output();
  coarse->GetPointData()->GetScalars()->GetRange();
  coarse->GetPointData()->GetVectors()->GetRange(-1);
  for (const double level : { 0.5, 1.0 })
  {
    vtkSmartPointer<vtkPolyData> now = undecimated(coarse, level);
    vtkDataArray* scalars = now->GetPointData()->GetScalars();
    EXPECT_EQ(scalars->GetLookupTable(), table);
    double least = 1e300;
    double most = -1e300;
    for (vtkIdType i = 0; i < scalars->GetNumberOfTuples(); ++i)
    {
      least = std::min(least, scalars->GetComponent(i, 0));
      most = std::max(most, scalars->GetComponent(i, 0));
    }
    EXPECT_EQ(scalars->GetRange()[0], least);
    EXPECT_EQ(scalars->GetRange()[1], most);
  }
}

// ---- cache and pipeline ----

TEST(Undecimation, ALevelChangeRunsNothingUpstream)
{
  vtkNew<vtkHashQueueDecimation> decimation;
  decimation->SetInputData(makeGrid());
  int runs = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&runs);
  count->SetCallback(
    [](vtkObject*, unsigned long, void* runs, void*) { ++*static_cast<int*>(runs); });
  decimation->AddObserver(vtkCommand::StartEvent, count);
  vtkNew<vtkUndecimation> filter;
  filter->SetInputConnection(decimation->GetOutputPort());
  for (const double level : { 0.1, 0.9, 1.0, 0.0 })
  {
    filter->SetLevel(level);
    filter->Update();
  }
  EXPECT_EQ(runs, 1);
}

// What ParaView does with all arrays of what it shows must not make the record be decoded again.
TEST(Undecimation, AskingForRangesDoesNotModifyTheMeshes)
{
  Watched<vtkHashQueueDecimation> decimation;
  decimation->SetInputData(makeGrid());
  Undecimation filter;
  filter->SetInputConnection(decimation->GetOutputPort());
  filter->SetLevel(0.5);
  filter.output();
  for (vtkPolyData* mesh : { decimation->GetOutput(), filter->GetOutput() })
  {
    const vtkMTimeType time = mesh->GetMTime();
    for (vtkFieldData* data : { static_cast<vtkFieldData*>(mesh->GetPointData()),
           static_cast<vtkFieldData*>(mesh->GetCellData()), mesh->GetFieldData() })
    {
      for (int i = 0; i < data->GetNumberOfArrays(); ++i)
      {
        if (vtkDataArray* array = data->GetArray(i))
        {
          array->GetRange();
          array->GetRange(-1);
          array->GetFiniteRange();
        }
      }
    }
    mesh->GetBounds();
    mesh->GetPoints()->GetData()->GetRange();
    EXPECT_EQ(mesh->GetMTime(), time);
  }
}

TEST(Undecimation, SharesTheArraysOfAnUnchangedLevel)
{
  Undecimation filter;
  filter->SetInputData(decimated(makeGrid()));
  for (const double level : { 0.5, 1.0 })
  {
    filter->SetLevel(level);
    filter->OriginalPointIdsOff();
    vtkSmartPointer<vtkPolyData> before = shallow(filter.output());
    filter->OriginalPointIdsOn();
    vtkPolyData* now = filter.output();
    EXPECT_EQ(now->GetPoints(), before->GetPoints());
    EXPECT_EQ(now->GetPolys(), before->GetPolys());
    EXPECT_EQ(now->GetPointData()->GetArray("scalar"), before->GetPointData()->GetArray("scalar"));
    EXPECT_NE(now->GetPointData()->GetArray("vtkOriginalPointIds"), nullptr);
    filter->OriginalPointIdsOff();
    EXPECT_EQ(filter.output()->GetPointData()->GetArray("vtkOriginalPointIds"), nullptr);
  }
}

TEST(Undecimation, AnOutputThatIsKeptIsNotChangedLater)
{
  Undecimation filter;
  filter->SetInputData(decimated(makeGrid()));
  filter->SetLevel(0.5);
  vtkSmartPointer<vtkPolyData> kept = shallow(filter.output());
  vtkSmartPointer<vtkPolyData> before = copy(kept);
  for (const double level : { 0.7, 1.0, 0.2, 0.5 })
  {
    filter->SetLevel(level);
    filter.output();
  }
  EXPECT_EQ(differences(kept, before), "");
}

// The trap of caches that look at modification times only: the older input comes after the newer.
TEST(Undecimation, InputsMayTakeTurns)
{
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  std::vector<vtkSmartPointer<vtkPolyData>> coarse;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    MeshOptions options;
    options.seed = seed;
    options.rows = 6 + static_cast<int>(seed);
    meshes.push_back(makeGrid(options));
    coarse.push_back(decimated(meshes.back()));
  }
  Undecimation filter;
  filter->SetLevel(1.0);
  for (const int i : { 1, 0, 1, 11, 2, 3, 4, 5, 6, 7, 8, 9, 10, 0, 11, 5 })
  {
    filter->SetInputData(coarse[i]);
    EXPECT_EQ(differences(filter.output(), meshes[i]), "") << i;
  }
  filter->SetLevel(0.5);
  for (const int i : { 3, 2, 0 })
  {
    filter->SetInputData(coarse[i]);
    EXPECT_EQ(differences(filter.output(), undecimated(coarse[i], 0.5)), "") << i;
  }
  EXPECT_TRUE(filter.messages->silent());
}

TEST(Undecimation, TheSameObjectMayGetOtherContents)
{
  vtkSmartPointer<vtkPolyData> first = makeGrid();
  MeshOptions options;
  options.seed = 9;
  vtkSmartPointer<vtkPolyData> second = makeGrid(options);
  vtkSmartPointer<vtkPolyData> input = decimated(first);
  Undecimation filter;
  filter->SetInputData(input);
  filter->SetLevel(1.0);
  EXPECT_EQ(differences(filter.output(), first), "");
  input->DeepCopy(decimated(second));
  EXPECT_EQ(differences(filter.output(), second), "");
}

TEST(Undecimation, FollowsTheDecimation)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkNew<vtkHashQueueDecimation> decimation;
  decimation->SetInputData(mesh);
  vtkNew<vtkUndecimation> filter;
  filter->SetInputConnection(decimation->GetOutputPort());
  filter->SetLevel(0.0);
  filter->Update();
  const vtkIdType coarse = filter->GetNumberOfNodes();
  decimation->SetTargetReduction(0.5);
  filter->Update();
  EXPECT_GT(filter->GetNumberOfNodes(), coarse);
  EXPECT_EQ(filter->GetNumberOfNodes(), decimation->GetNumberOfNodes());
}

TEST(Undecimation, TheBlocksOfACompositeKeepTheirLevels)
{
  constexpr unsigned kBlocks = 11; // more than idle meshes are kept
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkIdType nodes = 0;
  for (unsigned i = 0; i < kBlocks; ++i)
  {
    MeshOptions options;
    options.seed = i + 1;
    meshes.push_back(makeGrid(options));
    blocks->SetBlock(i, meshes.back());
    nodes += meshes.back()->GetNumberOfPoints();
  }
  vtkNew<vtkHashQueueDecimation> decimation;
  decimation->SetInputDataObject(blocks);
  Undecimation filter;
  filter->SetInputConnection(decimation->GetOutputPort());
  for (const double level : { 0.5, 0.2, 1.0 })
  {
    filter->SetLevel(level);
    filter->Update();
    auto* coarse = vtkMultiBlockDataSet::SafeDownCast(decimation->GetOutputDataObject(0));
    auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    ASSERT_NE(output, nullptr);
    vtkIdType sum = 0;
    for (unsigned i = 0; i < kBlocks; ++i)
    {
      auto* block = vtkPolyData::SafeDownCast(output->GetBlock(i));
      ASSERT_NE(block, nullptr);
      sum += block->GetNumberOfPoints();
      EXPECT_EQ(
        differences(block, undecimated(vtkPolyData::SafeDownCast(coarse->GetBlock(i)), level)), "");
      if (level == 1.0)
      {
        EXPECT_EQ(differences(block, meshes[i]), "") << i;
      }
    }
    EXPECT_EQ(filter->GetNumberOfNodes(), sum);
  }
  EXPECT_EQ(filter->GetNumberOfNodes(), nodes);
  EXPECT_EQ(filter->GetError(), 0.0);
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
}

TEST(Undecimation, PrintsAndClampsItsProperties)
{
  vtkNew<vtkUndecimation> filter;
  filter->SetLevel(99.0);
  EXPECT_EQ(filter->GetLevel(), 1.0);
  filter->SetLevel(-5.0);
  EXPECT_EQ(filter->GetLevel(), 0.0);
  filter->SetLevelBy(7);
  EXPECT_EQ(filter->GetLevelBy(), vtkUndecimation::BY_ERROR);
  filter->SetMaximumError(-1.0);
  EXPECT_EQ(filter->GetMaximumError(), 0.0);
  std::ostringstream text;
  filter->Print(text);
  for (const char* word : { "Level: 0", "LevelBy: Error", "MaximumError: 0",
         "OriginalPointIds: Off", "NumberOfNodes: 0" })
  {
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
  }
}

// ---- inputs that are refused ----

TEST(Undecimation, RefusesAMeshWithoutARecord)
{
  const std::string error = undecimationError(makeGrid());
  EXPECT_NE(error.find("has no undecimation record"), std::string::npos) << error;
  EXPECT_NE(error.find("Hash Queue Decimation"), std::string::npos) << error;
}

// Each change of the mesh is found, and named.
TEST(Undecimation, NamesWhatWasChangedInTheMesh)
{
  struct Change
  {
    std::function<void(vtkPolyData*)> apply;
    std::vector<std::string> texts;
  };
  const auto addArray = [](vtkDataSetAttributes* data, const char* name, vtkIdType tuples)
  {
    vtkNew<vtkFloatArray> array;
    array->SetName(name);
    array->SetNumberOfTuples(tuples);
    array->Fill(1.0);
    data->AddArray(array);
  };
  const std::vector<Change> changes = {
    { [](vtkPolyData* m) { m->GetPoints()->SetPoint(3, 1.0, 2.0, 3.0); },
      { "the coordinates of its points or their type changed" } },
    { [](vtkPolyData* m)
      {
        vtkNew<vtkPoints> doubles;
        doubles->SetDataTypeToDouble();
        for (vtkIdType i = 0; i < m->GetNumberOfPoints(); ++i)
        {
          doubles->InsertNextPoint(m->GetPoint(i));
        }
        m->SetPoints(doubles);
      },
      { "the coordinates of its points or their type changed" } },
    { [](vtkPolyData* m) { m->GetPoints()->SetNumberOfPoints(m->GetNumberOfPoints() - 1); },
      { "points instead of" } },
    { [](vtkPolyData* m)
      {
        const vtkIdType ids[] = { 0, 1, 2 };
        m->GetPolys()->InsertNextCell(3, ids);
      },
      { "polygons instead of" } },
    { [](vtkPolyData* m)
      {
        vtkNew<vtkCellArray> lines;
        const vtkIdType ids[] = { 0, 1 };
        lines->InsertNextCell(2, ids);
        m->SetLines(lines);
      },
      { "1 lines instead of 0" } },
    { [](vtkPolyData* m)
      {
        vtkNew<vtkCellArray> verts;
        const vtkIdType ids[] = { 0 };
        verts->InsertNextCell(1, ids);
        m->SetVerts(verts);
      },
      { "1 vertex cells instead of 0" } },
    { [](vtkPolyData* m)
      {
        vtkNew<vtkCellArray> strips;
        const vtkIdType ids[] = { 0, 1, 2, 3 };
        strips->InsertNextCell(4, ids);
        m->SetStrips(strips);
      },
      { "1 triangle strips instead of 0" } },
    { [](vtkPolyData* m) { m->GetPolys()->ReverseCellAtId(4); }, { "the points of its cells" } },
    { [&](vtkPolyData* m) { addArray(m->GetPointData(), "extra", m->GetNumberOfPoints()); },
      { "point array 'extra' was added or renamed" } },
    { [&](vtkPolyData* m) { addArray(m->GetCellData(), "extra", m->GetNumberOfCells()); },
      { "cell array 'extra' was added or renamed" } },
    { [](vtkPolyData* m) { m->GetPointData()->RemoveArray("tensor"); },
      { "point array 'tensor' was removed or renamed" } },
    { [](vtkPolyData* m) { m->GetCellData()->RemoveArray("part"); },
      { "cell array 'part' was removed or renamed" } },
    { [](vtkPolyData* m) { m->GetPointData()->GetArray("scalar")->SetName("stress"); },
      { "point array 'scalar' was removed or renamed",
        "point array 'stress' was added or renamed" } },
    { [](vtkPolyData* m)
      {
        m->GetPointData()->GetArray("bits")->SetComponent(
          2, 0, 1 - m->GetPointData()->GetArray("bits")->GetComponent(2, 0));
      },
      { "the values or the type of point array 'bits' changed" } },
    { [](vtkPolyData* m) { m->GetPointData()->GetAbstractArray("names")->SetVariantValue(0, "x"); },
      { "the values or the type of point array 'names' changed" } },
    { [](vtkPolyData* m) { m->GetPointData()->GetArray("soa")->SetComponent(1, 1, -1.0); },
      { "the values or the type of point array 'soa' changed" } },
    { [](vtkPolyData* m) { m->GetCellData()->GetArray("pressure")->SetComponent(0, 0, -1.0); },
      { "the values or the type of cell array 'pressure' changed" } },
    { [](vtkPolyData* m)
      {
        vtkNew<vtkFloatArray> other;
        other->DeepCopy(m->GetPointData()->GetArray("scalar"));
        other->SetName("scalar");
        m->GetPointData()->AddArray(other);
      },
      { "the values or the type of point array 'scalar' changed" } },
  };
  vtkSmartPointer<vtkPolyData> original = decimated(makeGrid());
  for (const Change& change : changes)
  {
    vtkSmartPointer<vtkPolyData> coarse = copy(original);
    change.apply(coarse);
    const std::string error = undecimationError(coarse);
    EXPECT_NE(error.find("The mesh was changed after the decimation"), std::string::npos) << error;
    EXPECT_NE(error.find("Apply Undecimation to the output of"), std::string::npos) << error;
    for (const std::string& text : change.texts)
    {
      EXPECT_NE(error.find(text), std::string::npos) << error << "\nlacks " << text;
    }
  }
}

TEST(Undecimation, KeepsVariantsAndNoticesTheirSmallestChange)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkNew<vtkVariantArray> variants;
  variants->SetName("variants");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    variants->InsertNextValue(
      i % 2 == 0 ? vtkVariant(1000.0 + static_cast<double>(i) / 7.0) : vtkVariant("text"));
  }
  mesh->GetPointData()->AddArray(variants);
  vtkSmartPointer<vtkPolyData> coarse = decimated(mesh);
  EXPECT_EQ(differences(undecimated(coarse, 1.0), mesh), "");
  auto* left = vtkVariantArray::SafeDownCast(coarse->GetPointData()->GetAbstractArray("variants"));
  ASSERT_NE(left, nullptr);
  vtkIdType number = 0;
  while (!left->GetValue(number).IsDouble())
  {
    ++number;
  }
  left->SetValue(number, vtkVariant(std::nextafter(left->GetValue(number).ToDouble(), 0.0)));
  const std::string error = undecimationError(coarse);
  EXPECT_NE(error.find("point array 'variants' changed"), std::string::npos) << error;
}

TEST(Undecimation, AcceptsArraysInAnotherOrderAndOtherActiveOnes)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> coarse = decimated(mesh);
  vtkSmartPointer<vtkDataArray> tensor = coarse->GetPointData()->GetArray("tensor");
  coarse->GetPointData()->RemoveArray("tensor");
  coarse->GetPointData()->AddArray(tensor);
  coarse->GetPointData()->SetActiveScalars("soa");
  vtkSmartPointer<vtkPolyData> back = undecimated(coarse, 1.0);
  EXPECT_STREQ(back->GetPointData()->GetScalars()->GetName(), "soa");
  for (const char* name : { "tensor", "soa", "scalar", "long long" })
  {
    EXPECT_EQ(
      differences(back->GetPointData()->GetArray(name), mesh->GetPointData()->GetArray(name)), "");
  }
}

} // namespace
