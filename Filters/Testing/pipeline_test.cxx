// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Both filters as parts of a pipeline: progress, abort, composites, time steps, what is said when.

#include "filterTesting.h"

#include "hash_queue_decimation.h"

#include "vtkHashQueueDecimation.h"
#include "vtkUndecimation.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPoints.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace filter_testing;

namespace
{

using Decimation = Watched<vtkHashQueueDecimation>;
using Undecimation = Watched<vtkUndecimation>;

vtkSmartPointer<vtkPolyData> grid(unsigned seed, int rows = 13)
{
  MeshOptions options;
  options.seed = seed;
  options.rows = rows;
  return makeGrid(options);
}

// A mesh whose record takes many steps.
vtkSmartPointer<vtkPolyData> largeCoarseMesh()
{
  static const vtkSmartPointer<vtkPolyData> mesh = []
  {
    MeshOptions options;
    options.rows = 250;
    options.pointData = false;
    vtkNew<vtkHashQueueDecimation> decimation;
    decimation->SetInputData(makeGrid(options));
    decimation->SetCriterionToAngleToXYPlane();
    decimation->SetTargetReduction(0.99);
    decimation->Update();
    return copy(decimation->GetOutput());
  }();
  return mesh;
}

// Notes the progress of an algorithm, and aborts it when asked to.
class Progress
{
public:
  explicit Progress(vtkAlgorithm* algorithm)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(this);
    command->SetCallback(
      [](vtkObject* caller, unsigned long, void* self, void* fraction)
      {
        auto* progress = static_cast<Progress*>(self);
        progress->seen.push_back(*static_cast<double*>(fraction));
        if (++progress->calls == progress->abortAtCall)
        {
          static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
        }
      });
    algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  }

  std::vector<double> seen;
  int calls = 0;
  int abortAtCall = 0; // none
};

// ---- progress and abort ----

TEST(Pipeline, UndecimationReportsProgressWhileItOpensMovesAndCopies)
{
  Undecimation filter;
  filter->SetInputData(largeCoarseMesh());
  Progress progress(filter.filter);
  for (const double level : { 0.0, 1.0, 0.0 })
  {
    filter->SetLevel(level);
    progress.seen.clear();
    filter.output();
    EXPECT_TRUE(std::is_sorted(progress.seen.begin(), progress.seen.end()));
    EXPECT_GE(progress.seen.size(), 8u) << level;
    EXPECT_EQ(progress.seen.back(), 1.0);
    const auto between = [&progress](double low, double high)
    {
      return std::any_of(progress.seen.begin(), progress.seen.end(),
        [=](double fraction) { return fraction > low && fraction < high; });
    };
    EXPECT_TRUE(between(0.05, 0.45) && between(0.55, 0.95)) << level;
  }
}

// After an abort, wherever it was, the next update gives what a new filter gives.
TEST(Pipeline, UndecimationIsRightAfterAnAbort)
{
  for (const double level : { 0.0, 0.6, 1.0 })
  {
    vtkSmartPointer<vtkPolyData> expected = undecimated(largeCoarseMesh(), level);
    Undecimation filter;
    filter->SetLevel(level);
    Progress progress(filter.filter);
    for (int at = 2; at < 40; at += 4)
    {
      // A new object each time, so that the record is opened again.
      vtkSmartPointer<vtkPolyData> input = copy(largeCoarseMesh());
      filter->SetInputData(input);
      progress.calls = 0;
      progress.abortAtCall = at;
      vtkSmartPointer<vtkPolyData> output = filter.output();
      if (progress.calls > at)
      {
        EXPECT_EQ(output->GetNumberOfPoints(), 0) << at;
        EXPECT_EQ(output->GetFieldData()->GetNumberOfArrays(), 0);
        EXPECT_EQ(filter->GetNumberOfNodes(), 0);
      }
      filter->AbortExecute = 0;
      progress.abortAtCall = 0;
      EXPECT_EQ(differences(filter.output(), expected), "") << at;
      EXPECT_EQ(filter->GetNumberOfNodes(), expected->GetNumberOfPoints());
    }
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  }
}

TEST(Pipeline, AMoveThatWasAbortedIsMadeGood)
{
  vtkSmartPointer<vtkPolyData> coarse = largeCoarseMesh();
  Undecimation filter;
  filter->SetInputData(coarse);
  filter.output();
  Progress progress(filter.filter);
  int aborts = 0;
  for (const double level : { 1.0, 0.2, 0.9, 0.0, 0.5 })
  {
    for (const int at : { 2, 4, 6 })
    {
      filter->SetLevel(1.0 - level);
      filter.output();
      filter->SetLevel(level);
      progress.calls = 0;
      progress.abortAtCall = at;
      aborts += filter.output()->GetNumberOfPoints() == 0;
      progress.abortAtCall = 0;
      filter->AbortExecute = 0;
      EXPECT_EQ(differences(filter.output(), undecimated(coarse, level)), "") << level << at;
    }
  }
  EXPECT_GT(aborts, 5);
  EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
}

// The blocks of a composite, in the order of the tree.
std::vector<vtkPolyData*> blocksOf(vtkDataObject* data)
{
  std::vector<vtkPolyData*> blocks;
  if (auto* multiBlock = vtkMultiBlockDataSet::SafeDownCast(data))
  {
    for (unsigned i = 0; i < multiBlock->GetNumberOfBlocks(); ++i)
    {
      blocks.push_back(vtkPolyData::SafeDownCast(multiBlock->GetBlock(i)));
    }
  }
  return blocks;
}

vtkSmartPointer<vtkMultiBlockDataSet> multiBlock(int count, int rows = 13)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (int i = 0; i < count; ++i)
  {
    blocks->SetBlock(i, grid(i + 1, rows));
  }
  return blocks;
}

TEST(Pipeline, AnAbortStopsAllBlocksAndTheNextUpdateMakesThemAll)
{
  constexpr int kBlocks = 4;
  vtkNew<vtkHashQueueDecimation> source;
  source->SetInputDataObject(multiBlock(kBlocks, 40));
  source->Update();

  Decimation decimation;
  decimation->SetInputDataObject(multiBlock(kBlocks, 40));
  Undecimation undecimation;
  undecimation->SetInputDataObject(source->GetOutputDataObject(0));
  undecimation->SetLevel(1.0);
  const auto countNodes = [](vtkAlgorithm* filter)
  {
    vtkIdType nodes = 0;
    for (vtkPolyData* block : blocksOf(filter->GetOutputDataObject(0)))
    {
      nodes += block ? block->GetNumberOfPoints() : 0;
    }
    return nodes;
  };
  const auto check = [&](auto& filter, vtkIdType nodes)
  {
    Progress progress(filter.filter);
    for (int at = 2; at < 30; at += 9)
    {
      filter->Modified();
      progress.calls = 0;
      progress.abortAtCall = at;
      filter->Update();
      if (progress.calls > at + 1)
      {
        EXPECT_LT(countNodes(filter.filter), nodes) << at;
        EXPECT_EQ(filter->GetNumberOfNodes(), 0) << at;
      }
      progress.abortAtCall = 0;
      filter->AbortExecute = 0;
      filter->Update();
      EXPECT_EQ(countNodes(filter.filter), nodes) << at;
      EXPECT_EQ(filter->GetNumberOfNodes(), nodes) << at;
    }
    EXPECT_TRUE(filter.messages->silent()) << filter.messages->all();
  };
  decimation->Update();
  check(decimation, decimation->GetNumberOfNodes());
  check(undecimation, kBlocks * 40 * 40);
}

// ---- composites ----

TEST(Pipeline, ResultsAreThoseOfTheLastExecutionWithoutAnyObserver)
{
  vtkSmartPointer<vtkMultiBlockDataSet> blocks = multiBlock(3);
  vtkSmartPointer<vtkPolyData> single = grid(9, 20);
  vtkNew<vtkMultiBlockDataSet> empty;
  vtkNew<vtkHashQueueDecimation> decimation;
  decimation->RemoveAllObservers();
  vtkNew<vtkUndecimation> undecimation;
  undecimation->RemoveAllObservers();
  undecimation->SetInputConnection(decimation->GetOutputPort());
  undecimation->SetLevel(1.0);
  const auto expectNodes = [&](vtkDataObject* input, vtkIdType nodes)
  {
    decimation->SetInputDataObject(input);
    for (const double reduction : { 0.5, 0.6, 0.7 })
    {
      decimation->SetTargetReduction(reduction);
      undecimation->Update();
      EXPECT_EQ(decimation->GetNumberOfInputNodes(), nodes);
      EXPECT_EQ(undecimation->GetNumberOfNodes(), nodes);
      EXPECT_STREQ(decimation->GetStopReason(), nodes > 0 ? "target reduction" : "");
    }
  };
  for (int round = 0; round < 2; ++round)
  {
    expectNodes(blocks, 3 * 169);
    expectNodes(single, 400);
    expectNodes(empty, 0);
    expectNodes(single, 400);
    expectNodes(blocks, 3 * 169);
    expectNodes(empty, 0);
  }
}

TEST(Pipeline, PartitionsAreDecimatedEachByItself)
{
  vtkNew<vtkPartitionedDataSetCollection> collection;
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  for (unsigned i = 0; i < 2; ++i)
  {
    vtkNew<vtkPartitionedDataSet> partitions;
    for (unsigned j = 0; j < 2; ++j)
    {
      meshes.push_back(grid(2 * i + j + 1, 13 + static_cast<int>(j)));
      partitions->SetPartition(j, meshes.back());
    }
    collection->SetPartitionedDataSet(i, partitions);
  }
  Decimation decimation;
  decimation->SetInputDataObject(collection);
  Undecimation undecimation;
  undecimation->SetInputConnection(decimation->GetOutputPort());
  for (const double level : { 0.3, 1.0 })
  {
    undecimation->SetLevel(level);
    undecimation->Update();
    auto* coarse =
      vtkPartitionedDataSetCollection::SafeDownCast(decimation->GetOutputDataObject(0));
    auto* fine =
      vtkPartitionedDataSetCollection::SafeDownCast(undecimation->GetOutputDataObject(0));
    ASSERT_TRUE(coarse && fine);
    vtkIdType nodes = 0;
    for (unsigned i = 0; i < 4; ++i)
    {
      auto* from = vtkPolyData::SafeDownCast(
        coarse->GetPartitionedDataSet(i / 2)->GetPartitionAsDataObject(i % 2));
      auto* to = vtkPolyData::SafeDownCast(
        fine->GetPartitionedDataSet(i / 2)->GetPartitionAsDataObject(i % 2));
      ASSERT_TRUE(from && to);
      EXPECT_EQ(differences(to, level < 1.0 ? undecimated(from, level) : meshes[i]), "");
      nodes += to->GetNumberOfPoints();
    }
    EXPECT_EQ(undecimation->GetNumberOfNodes(), nodes);
  }
  EXPECT_TRUE(decimation.messages->silent()) << decimation.messages->all();
  EXPECT_TRUE(undecimation.messages->silent()) << undecimation.messages->all();
}

TEST(Pipeline, ABlockWithoutARecordDoesNotSpoilTheOthers)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkSmartPointer<vtkPolyData> mesh = grid(1);
  blocks->SetBlock(0, grid(2)); // no record
  blocks->SetBlock(1, decimated(mesh));
  blocks->SetBlock(2, vtkSmartPointer<vtkPolyData>::New());
  Undecimation filter;
  filter->SetInputDataObject(blocks);
  filter->SetLevel(1.0);
  filter->Update();
  ASSERT_EQ(filter.messages->errors.size(), 1u);
  EXPECT_TRUE(has(filter.messages->errors, "has no undecimation record"));
  const std::vector<vtkPolyData*> output = blocksOf(filter->GetOutputDataObject(0));
  ASSERT_EQ(output.size(), 3u);
  EXPECT_TRUE(!output[0] || output[0]->GetNumberOfPoints() == 0);
  EXPECT_EQ(differences(output[1], mesh), "");
  EXPECT_EQ(filter->GetNumberOfNodes(), mesh->GetNumberOfPoints());
}

// ---- time steps ----

// A result with time steps 0, 1, ...: a plane of quads that waves and grows.
class Wave : public vtkPolyDataAlgorithm
{
public:
  static Wave* New();
  vtkTypeMacro(Wave, vtkPolyDataAlgorithm);

  static vtkSmartPointer<vtkPolyData> mesh(double time, bool quads)
  {
    const vtkIdType rows = 12 + static_cast<vtkIdType>(time);
    auto result = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> faces;
    for (vtkIdType i = 0; i < rows * rows; ++i)
    {
      const double x = static_cast<double>(i % rows);
      const double y = static_cast<double>(i / rows);
      points->InsertNextPoint(x, y, std::sin(x + time) + 0.1 * std::cos(3.0 * y));
      if (i % rows + 1 < rows && i / rows + 1 < rows)
      {
        const vtkIdType corners[] = { i, i + 1, i + rows + 1, i + rows };
        const vtkIdType rest[] = { i, i + rows + 1, i + rows };
        faces->InsertNextCell(quads ? 4 : 3, corners);
        if (!quads)
        {
          faces->InsertNextCell(3, rest);
        }
      }
    }
    result->SetPoints(points);
    result->SetPolys(faces);
    return result;
  }

  bool Quads = true;

protected:
  Wave() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    const double steps[] = { 0.0, 1.0, 2.0, 3.0 };
    const double range[] = { 0.0, 3.0 };
    vtkInformation* info = outputVector->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), steps, 4);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }

  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double time = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    vtkPolyData* output = vtkPolyData::GetData(outputVector);
    output->ShallowCopy(mesh(time, this->Quads));
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};
vtkStandardNewMacro(Wave);

TEST(Pipeline, EachTimeStepIsDecimatedAndKeepsItsTime)
{
  vtkNew<Wave> wave;
  wave->Quads = false;
  Decimation decimation;
  decimation->SetInputConnection(wave->GetOutputPort());
  Undecimation undecimation;
  undecimation->SetInputConnection(decimation->GetOutputPort());
  undecimation->SetLevel(1.0);
  for (const double time : { 0.0, 2.0, 1.0, 1.0, 3.0 })
  {
    undecimation->UpdateTimeStep(time);
    EXPECT_EQ(differences(undecimation->GetOutput(), Wave::mesh(time, false)), "") << time;
    for (vtkPolyData* output : { decimation->GetOutput(0), undecimation->GetOutput() })
    {
      ASSERT_TRUE(output->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()));
      EXPECT_EQ(output->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    }
  }
  EXPECT_TRUE(decimation.messages->silent()) << decimation.messages->all();
  EXPECT_TRUE(undecimation.messages->silent()) << undecimation.messages->all();
}

// ---- what is said when ----

TEST(Pipeline, ANoticeOnTheInputIsSaidOnceUntilTheInputOrItsPropertyChanges)
{
  vtkNew<Wave> wave;
  Decimation filter;
  filter->SetInputConnection(wave->GetOutputPort());
  filter->TriangulateOn();
  const auto said = [&filter](double time)
  {
    filter.messages->warnings.clear();
    filter->UpdateTimeStep(time);
    EXPECT_GT(filter->GetNumberOfNodes(), 0);
    return static_cast<int>(
      std::count_if(filter.messages->warnings.begin(), filter.messages->warnings.end(),
        [](const std::string& warning)
        { return warning.find("were cut into triangles") != std::string::npos; }));
  };
  EXPECT_EQ(said(0.0), 1);
  EXPECT_EQ(said(1.0), 0) << "the next time step";
  EXPECT_EQ(said(2.0), 0);
  EXPECT_EQ(said(0.0), 0);
  filter->SetTargetReduction(0.5);
  EXPECT_EQ(said(0.0), 0) << "another property";
  wave->Modified();
  EXPECT_EQ(said(0.0), 1) << "the input changed";
  EXPECT_EQ(said(1.0), 0);
  filter->TriangulateOff();
  filter->TriangulateOn();
  EXPECT_EQ(said(1.0), 1) << "the property changed";
  filter->SetInputData(Wave::mesh(0.0, true));
  EXPECT_EQ(said(0.0), 1) << "another input";
  EXPECT_TRUE(filter.messages->errors.empty());
}

TEST(Pipeline, ANoticeOnABlockIsSaidOnce)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned i = 0; i < 3; ++i)
  {
    MeshOptions options;
    options.vertsAndLines = true;
    blocks->SetBlock(i, makeGrid(options));
  }
  Decimation filter;
  filter->SetInputDataObject(blocks);
  filter->Update();
  filter->SetTargetReduction(0.5);
  filter->Update();
  EXPECT_EQ(filter.messages->warnings.size(), 1u) << filter.messages->all();
}

// ---- defaults ----

TEST(Pipeline, TheDefaultsAreThoseOfTheCore)
{
  const undecimate::HashQueueDecimationOptions options;
  vtkNew<vtkHashQueueDecimation> filter;
  EXPECT_EQ(filter->GetTargetReduction(), options.targetReduction);
  EXPECT_EQ(filter->GetTargetNodes(), options.targetNodes);
  EXPECT_EQ(filter->GetTargetTriangles(), options.targetTriangles);
  EXPECT_EQ(filter->GetCriterion(), static_cast<int>(options.criterion));
  EXPECT_EQ(filter->GetScalarWeight(), options.scalarWeight);
  EXPECT_EQ(filter->GetShapeWeight(), options.shapeWeight);
  EXPECT_EQ(filter->GetIntervalSpacing(), static_cast<int>(options.intervalSpacing));
  EXPECT_EQ(filter->GetIntervalNodes(), options.intervalNodes);
  EXPECT_EQ(filter->GetPreserveBoundary() != 0, options.preserveBoundary);
  EXPECT_EQ(filter->GetParallel() != 0, options.parallel);
  EXPECT_EQ(filter->GetNumberOfThreads(), options.threads);
  EXPECT_EQ(filter->GetMaximumError(), 1.0) << "which stands for no limit";
  EXPECT_GT(options.maximumError, 1.0);
}

} // namespace
