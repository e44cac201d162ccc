// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkTriQuadDecimation with and without time steps, and vtkUndecimation behind it.

#include "filterTesting.h"

#include "vtkTriQuadDecimation.h"
#include "vtkUndecimation.h"

#include "testing/tri_quad_meshes.h"
#include "tri_quad_decimation.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

using filter_testing::differences;

namespace
{

constexpr int kRows = 21;
constexpr int kSteps = 6;

/// A plate of quads and some triangles that bends over time, with arrays that change.
vtkSmartPointer<vtkPolyData> plateAt(int step)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> stress;
  stress->SetName("stress");
  vtkNew<vtkFloatArray> displacement;
  displacement->SetName("displacement");
  displacement->SetNumberOfComponents(3);
  for (int j = 0; j < kRows; ++j)
  {
    for (int i = 0; i < kRows; ++i)
    {
      const double bend = 0.3 * step * std::sin(0.4 * i) * std::cos(0.2 * j);
      points->InsertNextPoint(i, j, bend);
      stress->InsertNextValue(step * std::exp(-0.05 * ((i - 9) * (i - 9) + j)));
      displacement->InsertNextTuple3(0.0, 0.0, bend);
    }
  }
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIntArray> part;
  part->SetName("part");
  vtkNew<vtkIdTypeArray> number;
  number->SetName("number");
  for (vtkIdType j = 0; j + 1 < kRows; ++j)
  {
    for (vtkIdType i = 0; i + 1 < kRows; ++i)
    {
      const vtkIdType a = j * kRows + i;
      const auto add = [&](std::initializer_list<vtkIdType> corners)
      {
        number->InsertNextValue(cells->InsertNextCell(corners));
        part->InsertNextValue(i < 8 ? 1 : 2);
      };
      if ((i + 3 * j) % 7 == 0)
      {
        add({ a, a + 1, a + kRows + 1 });
        add({ a + kRows + 1, a + kRows, a });
      }
      else
      {
        add({ a, a + 1, a + kRows + 1, a + kRows });
      }
    }
  }
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  mesh->GetPointData()->SetScalars(stress);
  mesh->GetPointData()->AddArray(displacement);
  mesh->GetCellData()->AddArray(part);
  mesh->GetCellData()->AddArray(number);
  return mesh;
}

/// Time steps 0, 0.5, 1, ...
void setTimes(vtkInformationVector* outputs, int steps)
{
  std::vector<double> times;
  for (int i = 0; i < steps; ++i)
  {
    times.push_back(0.5 * i);
  }
  vtkInformation* info = outputs->GetInformationObject(0);
  const double range[] = { times.front(), times.back() };
  info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), steps);
  info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
}

/// These steps of a mesh; remembers which were asked for.
class Series : public vtkPolyDataAlgorithm
{
public:
  static Series* New();
  vtkTypeMacro(Series, vtkPolyDataAlgorithm);

  std::function<vtkSmartPointer<vtkPolyData>(int)> make = plateAt;
  int steps = kSteps;
  std::vector<int> asked;

protected:
  Series() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    setTimes(outputs, this->steps);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    const double time = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    const int step = static_cast<int>(std::floor(2.0 * time + 1e-9));
    this->asked.push_back(step);
    vtkPolyData* output = vtkPolyData::GetData(outputs);
    output->ShallowCopy(this->make(step));
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), 0.5 * step);
    return 1;
  }
};

vtkStandardNewMacro(Series);

/// A block at each of these time steps.
class BlockSeries : public vtkMultiBlockDataSetAlgorithm
{
public:
  static BlockSeries* New();
  vtkTypeMacro(BlockSeries, vtkMultiBlockDataSetAlgorithm);

protected:
  BlockSeries() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    setTimes(outputs, kSteps);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkMultiBlockDataSet::GetData(outputs)->SetBlock(0, plateAt(0));
    return 1;
  }
};

vtkStandardNewMacro(BlockSeries);

struct Pipe
{
  vtkNew<Series> series;
  vtkNew<vtkTriQuadDecimation> decimation;
  vtkNew<vtkUndecimation> undecimation;

  Pipe()
  {
    this->decimation->SetInputConnection(this->series->GetOutputPort());
    this->undecimation->SetInputConnection(this->decimation->GetOutputPort());
  }
  vtkPolyData* at(double time, double level)
  {
    this->undecimation->SetLevel(level);
    this->undecimation->UpdateTimeStep(time);
    return this->undecimation->GetOutput();
  }
};

TEST(TriQuadDecimation, GivesEachStepBack)
{
  Pipe pipe;
  for (const int step : { 3, 0, 5, 2, 2, 4, 1 })
  {
    EXPECT_EQ(differences(pipe.at(0.5 * step, 1.0), plateAt(step)), "") << "step " << step;
  }
  EXPECT_EQ(pipe.decimation->GetNumberOfInputNodes(), kRows * kRows);
  EXPECT_EQ(pipe.undecimation->GetNumberOfNodes(), kRows * kRows);
  EXPECT_EQ(pipe.undecimation->GetNumberOfTriangles() + pipe.undecimation->GetNumberOfQuads(),
    plateAt(0)->GetNumberOfPolys());
  EXPECT_GT(pipe.undecimation->GetNumberOfQuads(), 300);
}

TEST(TriQuadDecimation, WalksTheStepsOnce)
{
  Pipe pipe;
  pipe.at(1.0, 0.5);
  EXPECT_EQ(pipe.series->asked, (std::vector<int>{ 0, 1, 2, 3, 4, 5 }));
  EXPECT_STREQ(pipe.decimation->GetUsedSteps(), "0, 1, 2, 3, 4, 5");
  // Another time: that time only. Another level: nothing.
  pipe.at(2.0, 0.5);
  pipe.at(2.0, 0.7);
  EXPECT_EQ(pipe.series->asked, (std::vector<int>{ 0, 1, 2, 3, 4, 5, 4 }));
  // A time between two steps.
  pipe.at(1.3, 0.7);
  EXPECT_EQ(pipe.series->asked.back(), 2);
  EXPECT_EQ(pipe.series->asked.size(), 8U);
  // Another property: all again.
  pipe.decimation->SetTargetReduction(0.5);
  pipe.at(1.0, 0.7);
  EXPECT_EQ(pipe.series->asked.size(), 14U);
  // Something upstream: all again.
  pipe.series->Modified();
  pipe.at(1.0, 0.7);
  EXPECT_EQ(pipe.series->asked.size(), 20U);
  // A first request for a time that is no step's: once more.
  Pipe other;
  other.at(1.2, 1.0);
  EXPECT_EQ(other.series->asked, (std::vector<int>{ 0, 1, 2, 3, 4, 5, 2 }));
  EXPECT_EQ(differences(other.undecimation->GetOutput(), plateAt(2)), "");
}

TEST(TriQuadDecimation, TheTopologyOfALevelIsTheSameAtAllSteps)
{
  Pipe pipe;
  for (const double level : { 0.0, 0.37, 0.8 })
  {
    vtkNew<vtkPolyData> first;
    first->ShallowCopy(pipe.at(0.0, level));
    for (int step = 1; step < kSteps; ++step)
    {
      vtkPolyData* now = pipe.at(0.5 * step, level);
      // Not even another object: the cells are handed out again.
      EXPECT_EQ(now->GetPolys(), first->GetPolys());
      EXPECT_EQ(now->GetNumberOfPoints(), first->GetNumberOfPoints());
    }
  }
}

TEST(TriQuadDecimation, GivesTheFirstStepUnlessAskedForAnother)
{
  Pipe pipe;
  pipe.undecimation->SetLevel(1.0);
  pipe.undecimation->Update();
  EXPECT_EQ(differences(pipe.undecimation->GetOutput(), plateAt(0)), "");
  pipe.decimation->SetStepChoiceToList();
  pipe.decimation->AddSteps(4);
  pipe.undecimation->Update();
  EXPECT_EQ(differences(pipe.undecimation->GetOutput(), plateAt(0)), "");
}

// Nodal values and cell data are those of the original at each step and level.
TEST(TriQuadDecimation, KeepsValuesAtEachStepAndLevel)
{
  Pipe pipe;
  pipe.undecimation->OriginalPointIdsOn();
  for (int step = 0; step < kSteps; ++step)
  {
    const auto original = plateAt(step);
    for (const double level : { 0.0, 0.5, 0.9 })
    {
      vtkPolyData* mesh = pipe.at(0.5 * step, level);
      auto* ids =
        vtkIdTypeArray::SafeDownCast(mesh->GetPointData()->GetArray("vtkOriginalPointIds"));
      ASSERT_NE(ids, nullptr);
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        const vtkIdType id = ids->GetValue(i);
        double a[3];
        double b[3];
        mesh->GetPoint(i, a);
        original->GetPoint(id, b);
        ASSERT_TRUE(std::equal(a, a + 3, b));
        ASSERT_EQ(mesh->GetPointData()->GetArray("stress")->GetTuple1(i),
          original->GetPointData()->GetArray("stress")->GetTuple1(id));
        ASSERT_EQ(mesh->GetPointData()->GetArray("displacement")->GetComponent(i, 2),
          original->GetPointData()->GetArray("displacement")->GetComponent(id, 2));
      }
      std::set<double> numbers;
      for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
      {
        const double number = mesh->GetCellData()->GetArray("number")->GetTuple1(c);
        ASSERT_TRUE(numbers.insert(number).second);
        ASSERT_EQ(mesh->GetCellData()->GetArray("part")->GetTuple1(c),
          original->GetCellData()->GetArray("part")->GetTuple1(static_cast<vtkIdType>(number)));
      }
    }
  }
}

TEST(TriQuadDecimation, ChoosesSteps)
{
  Pipe pipe;
  pipe.decimation->SetStepChoiceToThree();
  pipe.at(0.0, 0.5);
  // The farthest from both ends of a motion that goes on evenly is in the middle.
  EXPECT_EQ(pipe.series->asked.size(), 6U);
  const std::string three = pipe.decimation->GetUsedSteps();
  EXPECT_TRUE(three == "0, 2, 5" || three == "0, 3, 5") << three;

  pipe.decimation->SetStepChoiceToList();
  pipe.decimation->AddSteps(4);
  pipe.decimation->AddSteps(1);
  pipe.decimation->AddSteps(4);
  pipe.series->asked.clear();
  pipe.at(1.5, 0.5);
  EXPECT_EQ(pipe.series->asked, (std::vector<int>{ 1, 4, 3 }));
  EXPECT_STREQ(pipe.decimation->GetUsedSteps(), "1, 4");
  EXPECT_EQ(differences(pipe.at(1.5, 1.0), plateAt(3)), "");

  pipe.decimation->SetStepChoiceToAutomatic();
  pipe.decimation->SetStepFactor(1.5);
  pipe.at(0.0, 0.5);
  EXPECT_EQ(std::string(pipe.decimation->GetUsedSteps()).substr(0, 2), "0,");
  EXPECT_LT(std::string(pipe.decimation->GetUsedSteps()).size(), 16U);
}

TEST(TriQuadDecimation, OneStepMissesWhatHappensAtOthers)
{
  Pipe all;
  all.decimation->SetMaximumError(1e-4);
  all.at(0.0, 0.0);
  Pipe first;
  first.decimation->SetMaximumError(1e-4);
  first.decimation->SetStepChoiceToList();
  first.decimation->AddSteps(0); // flat
  first.at(0.0, 0.0);
  EXPECT_GT(all.decimation->GetNumberOfNodes(), 4 * first.decimation->GetNumberOfNodes());
  EXPECT_STREQ(all.decimation->GetStopReason(), "maximum error");
}

// Points that stay and a displacement give the same as points that move.
TEST(TriQuadDecimation, MeasuresDisplacedPoints)
{
  Pipe moving;
  moving.undecimation->OriginalPointIdsOn();
  Pipe still;
  still.undecimation->OriginalPointIdsOn();
  still.series->make = [](int step)
  {
    auto mesh = plateAt(step);
    mesh->SetPoints(plateAt(0)->GetPoints());
    return mesh;
  };
  still.decimation->SetDisplacement("displacement");
  auto* a = moving.at(0.0, 0.0)->GetPointData()->GetArray("vtkOriginalPointIds");
  auto* b = still.at(0.0, 0.0)->GetPointData()->GetArray("vtkOriginalPointIds");
  EXPECT_EQ(differences(a, b), "");
  still.decimation->SetDisplacement("speed");
  vtkNew<filter_testing::Messages> messages;
  messages->watch(still.decimation);
  still.undecimation->UpdateTimeStep(0.0);
  EXPECT_NE(messages->all().find("no point array 'speed'"), std::string::npos) << messages->all();
}

TEST(TriQuadDecimation, WorksWithoutTime)
{
  for (const bool triangles : { false, true })
  {
    const auto mesh = triangles ? filter_testing::makeGrid() : plateAt(4);
    vtkNew<vtkTriQuadDecimation> decimation;
    decimation->SetInputData(mesh);
    vtkNew<vtkUndecimation> undecimation;
    undecimation->SetInputConnection(decimation->GetOutputPort());
    undecimation->SetLevel(1.0);
    undecimation->Update();
    EXPECT_EQ(differences(undecimation->GetOutput(), mesh), "") << "with the parts of the mesh";
    decimation->SetPartArray("");
    undecimation->Update();
    EXPECT_EQ(differences(undecimation->GetOutput(), mesh), "");
    EXPECT_LE(decimation->GetNumberOfNodes(), 0.11 * mesh->GetNumberOfPoints());
    EXPECT_STREQ(decimation->GetUsedSteps(), "");
    EXPECT_EQ(differences(decimation->GetOutput(0), decimation->GetOutput(1)), "");
    EXPECT_EQ(decimation->GetOutput(1)->GetFieldData()->GetNumberOfArrays(),
      mesh->GetFieldData()->GetNumberOfArrays());
  }
}

TEST(TriQuadDecimation, DecimatesEachBlock)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, plateAt(2));
  blocks->SetBlock(2, plateAt(5));
  vtkNew<vtkTriQuadDecimation> decimation;
  decimation->SetInputDataObject(blocks);
  vtkNew<vtkUndecimation> undecimation;
  undecimation->SetInputConnection(decimation->GetOutputPort());
  undecimation->SetLevel(1.0);
  undecimation->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(undecimation->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  EXPECT_EQ(differences(vtkPolyData::SafeDownCast(output->GetBlock(0)), plateAt(2)), "");
  EXPECT_EQ(output->GetBlock(1), nullptr);
  EXPECT_EQ(differences(vtkPolyData::SafeDownCast(output->GetBlock(2)), plateAt(5)), "");
  // Sums over the blocks, and the same again.
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_EQ(decimation->GetNumberOfInputNodes(), 2 * kRows * kRows);
    EXPECT_EQ(decimation->GetNumberOfInputCells(), 2 * plateAt(0)->GetNumberOfPolys());
    EXPECT_EQ(undecimation->GetNumberOfNodes(), 2 * kRows * kRows);
    EXPECT_LT(decimation->GetNumberOfNodes(), 2 * kRows * kRows / 5);
    EXPECT_STREQ(decimation->GetStopReason(), "target reduction");
    decimation->Modified();
    undecimation->Update();
  }
}

TEST(TriQuadDecimation, RefusesBlocksWithTimeSteps)
{
  vtkNew<BlockSeries> series;
  vtkNew<vtkTriQuadDecimation> decimation;
  decimation->SetInputConnection(series->GetOutputPort());
  vtkNew<filter_testing::Messages> messages;
  messages->watch(decimation);
  decimation->UpdateTimeStep(0.5);
  EXPECT_NE(
    messages->all().find("several blocks and 6 time steps. Apply Merge Blocks"), std::string::npos)
    << messages->all();
}

// At each time step the input has what is to be told, and it is told once.
TEST(TriQuadDecimation, WarnsOnce)
{
  Pipe pipe;
  pipe.series->make = [](int step)
  {
    auto mesh = plateAt(step);
    vtkNew<vtkCellArray> verts;
    verts->InsertNextCell({ 3 });
    mesh->SetVerts(verts);
    mesh->GetCellData()->Initialize();
    vtkNew<vtkIdTypeArray> ids;
    ids->SetName("vtkOriginalPointIds");
    ids->SetNumberOfValues(mesh->GetNumberOfPoints());
    mesh->GetPointData()->AddArray(ids);
    return mesh;
  };
  pipe.decimation->OriginalPointIdsOn();
  vtkNew<filter_testing::Messages> messages;
  messages->watch(pipe.decimation);
  pipe.at(0.0, 0.5);
  pipe.at(1.0, 0.5);
  pipe.at(2.5, 0.7);
  EXPECT_EQ(messages->errors.size(), 0U) << messages->all();
  EXPECT_EQ(messages->warnings.size(), 2U) << messages->all();
  EXPECT_TRUE(filter_testing::has(messages->warnings, "gives way"));
  EXPECT_TRUE(filter_testing::has(messages->warnings, "1 vertex cells and 0 lines"));
  pipe.series->Modified();
  pipe.at(2.5, 0.7);
  EXPECT_EQ(messages->warnings.size(), 4U) << messages->all();
}

// Neighbouring pieces must fit together at all levels: the nodes between them stay.
TEST(TriQuadDecimation, KeepsTheBoundaryOfAPiece)
{
  Pipe pipe;
  pipe.decimation->OriginalPointIdsOn();
  const auto boundaryLeft = [&pipe]
  {
    int left = 0;
    auto* ids = vtkIdTypeArray::SafeDownCast(
      pipe.decimation->GetOutput()->GetPointData()->GetArray("vtkOriginalPointIds"));
    for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
    {
      const vtkIdType column = ids->GetValue(i) % kRows;
      const vtkIdType row = ids->GetValue(i) / kRows;
      left += column == 0 || column == kRows - 1 || row == 0 || row == kRows - 1;
    }
    return left;
  };
  constexpr int kBoundary = 4 * (kRows - 1);
  pipe.decimation->UpdateTimeStep(1.0);
  EXPECT_LT(boundaryLeft(), kBoundary / 2);
  pipe.decimation->UpdateTimeStep(1.0, 0, 4, 0);
  EXPECT_EQ(boundaryLeft(), kBoundary);
  pipe.decimation->UpdateTimeStep(2.0, 0, 4, 0);
  EXPECT_EQ(boundaryLeft(), kBoundary);
  // The same mesh in one piece is decimated anew.
  pipe.decimation->UpdateTimeStep(2.0, 0, 1, 0);
  EXPECT_LT(boundaryLeft(), kBoundary / 2);
}

/// Length of the edges of more than two cells.
double lengthOfJoints(vtkPolyData* mesh, int mostCells)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> edges;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    mesh->GetCellPoints(c, corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
    {
      const vtkIdType a = corners->GetId(k);
      const vtkIdType b = corners->GetId((k + 1) % corners->GetNumberOfIds());
      ++edges[std::minmax(a, b)];
    }
  }
  double length = 0.0;
  for (const auto& [edge, cells] : edges)
  {
    EXPECT_LE(cells, mostCells);
    double a[3];
    double b[3];
    mesh->GetPoint(edge.first, a);
    mesh->GetPoint(edge.second, b);
    length += cells > 2 ? std::sqrt(vtkMath::Distance2BetweenPoints(a, b)) : 0.0;
  }
  return length;
}

// A wall that stands on a floor and bends over time: at each level they meet along the whole line.
TEST(TriQuadDecimation, HoldsTJointsTogether)
{
  constexpr int kQuads = 12;
  const undecimate::testing::MixedMesh joint = undecimate::testing::mixedTJoint(kQuads);
  const auto at = [&joint](int step)
  {
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    for (undecimate::Index i = 0; i < joint.nodeCount(); ++i)
    {
      const double* p = joint.positions[0].data() + std::size_t{ 3 } * i;
      points->InsertNextPoint(p[0], p[1] + 0.02 * step * p[2] * p[2], p[2]);
    }
    vtkNew<vtkCellArray> cells;
    for (const auto& cell : joint.cells)
    {
      const std::vector<vtkIdType> corners = { cell[0], cell[1], cell[2], cell[3] };
      cells->InsertNextCell(cell[3] < 0 ? 3 : 4, corners.data());
    }
    mesh->SetPoints(points);
    mesh->SetPolys(cells);
    return mesh;
  };
  Pipe pipe;
  pipe.series->make = at;
  for (const double level : { 0.0, 0.3, 0.7, 1.0 })
  {
    for (const int step : { 0, kSteps - 1 })
    {
      vtkPolyData* mesh = pipe.at(0.5 * step, level);
      EXPECT_NEAR(lengthOfJoints(mesh, 3), kQuads, 1e-5) << "level " << level << ", step " << step;
    }
  }
  EXPECT_LT(pipe.decimation->GetNumberOfNodes(), joint.nodeCount() / 5);
  EXPECT_EQ(differences(pipe.at(1.5, 1.0), at(3)), "");
}

/// Files of the development data, which a copy of the repository alone has not.
std::vector<std::string> developmentFiles(const std::vector<std::string>& names)
{
  const char* folder = std::getenv("UNDECIMATE_DATA");
  std::vector<std::string> files;
  for (const std::string& name : names)
  {
    const std::string file =
      (folder ? std::string(folder) : UNDECIMATE_DATA_DIR "/../../shared/data") + "/" + name;
    if (std::ifstream(file))
    {
      files.push_back(file);
    }
    else
    {
      // Not to the standard output, where the list of tests goes.
      std::cerr << "Development data is absent: " << file
                << " (UNDECIMATE_DATA, else ../shared/data beside the repository)." << std::endl;
    }
  }
  return files;
}

class TriQuadDevelopmentData : public ::testing::TestWithParam<std::string>
{
};

// A wing box: ribs and spars that meet the skins in T joints.
TEST_P(TriQuadDevelopmentData, ComesBackWithItsJoints)
{
  const std::string file = GetParam();
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* box = reader->GetOutput();
  vtkNew<vtkTriQuadDecimation> decimation;
  decimation->SetInputConnection(reader->GetOutputPort());
  decimation->SetTargetReduction(1.0);
  decimation->SetMaximumError(1e-4);
  vtkNew<vtkUndecimation> undecimation;
  undecimation->SetInputConnection(decimation->GetOutputPort());
  const double length = lengthOfJoints(box, 4);
  EXPECT_GT(length, box->GetLength()) << "there are joints";
  for (const double level : { 0.0, 0.4, 0.8, 1.0 })
  {
    undecimation->SetLevel(level);
    undecimation->Update();
    EXPECT_NEAR(lengthOfJoints(undecimation->GetOutput(), 4), length, 1e-3 * length) << level;
  }
  EXPECT_LT(decimation->GetNumberOfNodes(), box->GetNumberOfPoints() / 5);
  EXPECT_EQ(differences(undecimation->GetOutput(), box), "");
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TriQuadDevelopmentData);
INSTANTIATE_TEST_SUITE_P(
  Files, TriQuadDevelopmentData, ::testing::ValuesIn(developmentFiles({ "static/wingbox.vtp" })));

TEST(TriQuadDecimation, SaysThatScalarsDoNotCountWithQuadrics)
{
  Pipe pipe;
  pipe.decimation->SetCriterionToQuadrics();
  pipe.decimation->AddScalars("stress");
  vtkNew<filter_testing::Messages> messages;
  messages->watch(pipe.decimation);
  pipe.at(0.0, 0.5);
  pipe.at(1.0, 0.5);
  EXPECT_EQ(messages->errors.size(), 0U) << messages->all();
  EXPECT_EQ(messages->warnings.size(), 1U) << messages->all();
  EXPECT_TRUE(filter_testing::has(messages->warnings, "do not count with the criterion Quadrics"));
}

TEST(TriQuadDecimation, SurvivesFiles)
{
  Pipe pipe;
  pipe.decimation->UpdateTimeStep(1.0);
  const std::string file = ::testing::TempDir() + "tri_quad_test.vtp";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(pipe.decimation->GetOutput());
  writer->SetFileName(file.c_str());
  writer->SetDataModeToBinary();
  ASSERT_TRUE(writer->Write());
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  vtkNew<vtkUndecimation> undecimation;
  undecimation->SetInputConnection(reader->GetOutputPort());
  undecimation->SetLevel(1.0);
  undecimation->Update();
  EXPECT_EQ(differences(undecimation->GetOutput(), plateAt(2), true), "");
  std::remove(file.c_str());
}

TEST(TriQuadDecimation, TellsWhatChangesOverTime)
{
  const auto message = [](std::function<vtkSmartPointer<vtkPolyData>(int)> make)
  {
    Pipe pipe;
    pipe.series->make = make;
    vtkNew<filter_testing::Messages> messages;
    messages->watch(pipe.decimation);
    pipe.decimation->UpdateTimeStep(0.0);
    EXPECT_EQ(pipe.decimation->GetOutput()->GetNumberOfPoints(), 0);
    return messages->all();
  };
  const auto fewer = message(
    [](int step)
    {
      auto mesh = plateAt(step);
      if (step == 3)
      {
        mesh->GetPoints()->InsertNextPoint(0, 0, 0);
        mesh->GetPointData()->Initialize();
      }
      return mesh;
    });
  EXPECT_NE(
    fewer.find("time step 3 (time 1.5) it has 442 points instead of 441"), std::string::npos)
    << fewer;
  EXPECT_NE(fewer.find("Choose a List"), std::string::npos) << fewer;
  const auto turned = message(
    [](int step)
    {
      auto mesh = plateAt(step);
      if (step == 4)
      {
        vtkNew<vtkIdList> corners;
        mesh->GetPolys()->GetCellAtId(7, corners);
        corners->SetId(0, corners->GetId(0) + 3);
        mesh->GetPolys()->ReplaceCellAtId(7, corners);
      }
      return mesh;
    });
  EXPECT_NE(
    turned.find("time step 4 (time 2) it has polygons of other points (the first is polygon 7)"),
    std::string::npos)
    << turned;
}

TEST(TriQuadDecimation, RefusesWhatItCannotDo)
{
  const auto message = [](vtkPolyData* mesh, const std::function<void(vtkTriQuadDecimation*)>& set)
  {
    vtkNew<vtkTriQuadDecimation> decimation;
    decimation->SetInputData(mesh);
    set(decimation);
    vtkNew<filter_testing::Messages> messages;
    messages->watch(decimation);
    decimation->Update();
    EXPECT_EQ(decimation->GetOutput()->GetNumberOfPoints(), 0);
    return messages->all();
  };
  const auto pentagon = filter_testing::makeMesh(
    { 0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 2, 0, 0, 1, 0 }, { { 0, 1, 2, 3, 4 } });
  EXPECT_NE(message(pentagon, [](auto*) {}).find("1 polygon"), std::string::npos);
  EXPECT_NE(
    message(plateAt(0), [](auto* d) { d->AddScalars("heat"); }).find("no point array 'heat'"),
    std::string::npos);
  EXPECT_NE(message(plateAt(0), [](auto* d) { d->SetDisplacement("stress"); })
              .find("'stress' of three numbers"),
    std::string::npos);
  const auto listed = [&](int step)
  {
    Pipe pipe;
    pipe.decimation->SetStepChoiceToList();
    if (step >= 0)
    {
      pipe.decimation->AddSteps(step);
    }
    vtkNew<filter_testing::Messages> messages;
    messages->watch(pipe.decimation);
    pipe.decimation->UpdateTimeStep(0.0);
    return messages->all();
  };
  EXPECT_NE(listed(-1).find("no step is listed"), std::string::npos);
  EXPECT_NE(listed(6).find("time step 6, but the input has the steps 0 to 5"), std::string::npos);
}

TEST(TriQuadDecimation, ScalarsAndPartsSteer)
{
  Pipe plain;
  plain.decimation->SetPartArray("");
  plain.decimation->SetMaximumError(0.01);
  plain.at(0.0, 0.0);
  Pipe parts;
  parts.decimation->SetMaximumError(0.01);
  parts.at(0.0, 0.0);
  // At all steps the border is at x = 8: no cell reaches across it.
  const auto crossing = [](vtkPolyData* mesh)
  {
    int cells = 0;
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
    {
      mesh->GetCellPoints(c, corners);
      double low = 1e9;
      double high = -1e9;
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        low = std::min(low, mesh->GetPoint(corners->GetId(k))[0]);
        high = std::max(high, mesh->GetPoint(corners->GetId(k))[0]);
      }
      cells += low < 8.0 && high > 8.0;
    }
    return cells;
  };
  EXPECT_EQ(crossing(parts.undecimation->GetOutput()), 0);
  EXPECT_GT(crossing(plain.undecimation->GetOutput()), 0);
  Pipe scalars;
  scalars.decimation->SetPartArray("");
  scalars.decimation->SetMaximumError(0.01);
  scalars.decimation->AddScalars("POINTS");
  scalars.decimation->AddScalars("stress");
  scalars.decimation->SetScalarWeight(1.0);
  scalars.at(0.0, 0.0);
  EXPECT_GT(scalars.decimation->GetNumberOfNodes(), plain.decimation->GetNumberOfNodes());
}

TEST(TriQuadDecimation, ThreadsDoNotChangeTheResult)
{
  Pipe pipe;
  EXPECT_EQ(pipe.decimation->GetNumberOfThreads(), 0);
  pipe.decimation->OriginalPointIdsOn();
  std::vector<vtkSmartPointer<vtkPolyData>> results;
  for (const int threads : { 1, 3, 0 })
  {
    pipe.decimation->SetNumberOfThreads(threads);
    pipe.decimation->UpdateTimeStep(1.0);
    results.push_back(vtkSmartPointer<vtkPolyData>::New());
    results.back()->DeepCopy(pipe.decimation->GetOutput());
    EXPECT_LT(results.back()->GetNumberOfPoints(), kRows * kRows / 5);
    EXPECT_EQ(differences(results.back(), results.front()), "") << threads << " threads";
    EXPECT_EQ(differences(pipe.at(1.0, 1.0), plateAt(2)), "") << threads << " threads";
  }
}

TEST(TriQuadDecimation, TheDefaultsAreThoseOfTheCore)
{
  const undecimate::TriQuadDecimationOptions options;
  vtkNew<vtkTriQuadDecimation> filter;
  EXPECT_EQ(filter->GetTargetReduction(), options.targetReduction);
  EXPECT_EQ(filter->GetTargetNodes(), options.targetNodes);
  EXPECT_EQ(filter->GetCriterion(), static_cast<int>(options.criterion));
  EXPECT_EQ(filter->GetTimeError(), static_cast<int>(options.timeError));
  EXPECT_EQ(filter->GetQuadWeight(), options.quadWeight);
  EXPECT_EQ(filter->GetScalarWeight(), options.scalarWeight);
  EXPECT_EQ(filter->GetPreserveBoundary() != 0, options.preserveBoundary);
  EXPECT_EQ(filter->GetNumberOfThreads(), options.threads);
  EXPECT_EQ(filter->GetMaximumError(), 1.0) << "which stands for no limit";
  EXPECT_GT(options.maximumError, 1.0);
}

TEST(TriQuadDecimation, CanBeStopped)
{
  for (const double until : { 0.1, 0.4 })
  {
    Pipe pipe;
    vtkNew<vtkCallbackCommand> stop;
    double limit = until;
    stop->SetClientData(&limit);
    stop->SetCallback(
      [](vtkObject* caller, unsigned long, void* data, void* progress)
      {
        if (*static_cast<double*>(progress) >= *static_cast<double*>(data))
        {
          vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
        }
      });
    pipe.decimation->AddObserver(vtkCommand::ProgressEvent, stop);
    pipe.decimation->UpdateTimeStep(1.0);
    EXPECT_EQ(pipe.decimation->GetOutput()->GetNumberOfPoints(), 0);
    // And starts anew.
    limit = 2.0;
    pipe.decimation->SetAbortExecute(0);
    pipe.decimation->Modified();
    EXPECT_EQ(differences(pipe.at(1.0, 1.0), plateAt(2)), "");
  }
}

} // namespace
