// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkTriQuadDecimation.h"

#include "undecimateArrays.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"
#include "undecimateTimeWalk.h"

#include "monitor.h"
#include "tri_quad_decimation.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVariant.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <vector>

using namespace undecimate;
using namespace undecimate::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkTriQuadDecimation);

namespace
{

// Shares of the progress: reading the time steps, and the decimation; the rest is for the output.
constexpr double kWalkShare = 0.3;
constexpr double kCoreShare = 0.65;

// Thrown for a request that cannot be met; the text is the error message.
struct BrokenRequest
{
  std::string message;
};

void require(const std::string& problem)
{
  if (!problem.empty())
  {
    throw BrokenRequest{ problem };
  }
}

std::vector<double> timesOf(vtkInformation* info)
{
  const double* times = info->Get(Pipeline::TIME_STEPS());
  return times ? std::vector<double>(times, times + info->Length(Pipeline::TIME_STEPS()))
               : std::vector<double>();
}

std::string describeStep(int step, const std::vector<double>& times)
{
  return times.size() < 2
    ? ""
    : "time step " + std::to_string(step) + " (time " + vtkVariant(times[step]).ToString() + ")";
}

std::string joined(const std::vector<int>& numbers)
{
  std::string text;
  for (const int number : numbers)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(number);
  }
  return text;
}

// "12 nodes where ...": what was never removed, for the warning.
std::string describeKept(const TriQuadDecimationResult& result)
{
  const std::pair<Index, const char*> reasons[] = {
    { result.requestedNodes, "of vertex cells, lines or ghosts" },
    { result.nonFiniteNodes, "of cells with a coordinate or value that is not a finite number" },
    { result.unusedNodes, "without a cell" },
    { result.irregularNodes, "of degenerate or repeated cells" },
    { result.boundaryNodes, "on the boundary" },
    { result.seamNodes, "where several surfaces or parts meet, which go only along the joint" },
  };
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

/// A decimation that was made: all that each time step's output needs.
struct Decimated
{
  RecordArrays record;
  MeshTopology topology;
  std::vector<Index> nodes;  // of the coarse mesh: original numbers
  std::vector<Index> places; // of each original node in the coarse mesh; kNone
  std::vector<Index> cells;  // of the coarse mesh: original numbers
  vtkSmartPointer<vtkCellArray> polys;
};

} // namespace

struct vtkTriQuadDecimation::Internals
{
  explicit Internals(vtkTriQuadDecimation* self)
    : pass(self)
  {
  }

  PipelinePass pass;
  std::vector<std::string> scalars;
  std::vector<int> steps;
  std::string stopReason;
  std::string usedSteps;

  // The walk through the time steps.
  bool walking = false;
  bool fetching = false; // all steps are there; the requested one is asked for once more
  std::size_t walked = 0;
  TimeWalk walk;
  std::string problem;                    // why there is no walk
  vtkSmartPointer<vtkPolyData> requested; // the input at the requested time, if it was met

  // What was made of them, and for which state of the pipeline.
  std::unique_ptr<Decimated> decimated;
  vtkMTimeType key = 0;
  bool keyPieces = false;

  void stopWalking()
  {
    this->walking = false;
    this->fetching = false;
    this->walked = 0;
    this->walk = TimeWalk();
    this->requested = nullptr;
  }
};

vtkTriQuadDecimation::vtkTriQuadDecimation()
  : Private(std::make_unique<Internals>(this))
{
  this->SetNumberOfOutputPorts(2);
  this->vtkTriQuadDecimation::SetPartArray("part");
}

vtkTriQuadDecimation::~vtkTriQuadDecimation()
{
  this->vtkTriQuadDecimation::SetDisplacement(nullptr);
  this->vtkTriQuadDecimation::SetPartArray(nullptr);
}

void vtkTriQuadDecimation::AddScalars(const char* name)
{
  std::vector<std::string>& names = this->Private->scalars;
  if (name && *name && std::find(names.begin(), names.end(), name) == names.end())
  {
    names.emplace_back(name);
    this->Modified();
  }
}

void vtkTriQuadDecimation::ClearScalars()
{
  if (!this->Private->scalars.empty())
  {
    this->Private->scalars.clear();
    this->Modified();
  }
}

int vtkTriQuadDecimation::GetNumberOfScalars()
{
  return static_cast<int>(this->Private->scalars.size());
}

const char* vtkTriQuadDecimation::GetScalars(int index)
{
  return index >= 0 && index < this->GetNumberOfScalars() ? this->Private->scalars[index].c_str()
                                                          : nullptr;
}

void vtkTriQuadDecimation::AddSteps(int step)
{
  std::vector<int>& steps = this->Private->steps;
  if (std::find(steps.begin(), steps.end(), step) == steps.end())
  {
    steps.push_back(step);
    this->Modified();
  }
}

void vtkTriQuadDecimation::ClearSteps()
{
  if (!this->Private->steps.empty())
  {
    this->Private->steps.clear();
    this->Modified();
  }
}

int vtkTriQuadDecimation::GetNumberOfSteps()
{
  return static_cast<int>(this->Private->steps.size());
}

int vtkTriQuadDecimation::GetSteps(int index)
{
  return index >= 0 && index < this->GetNumberOfSteps() ? this->Private->steps[index] : -1;
}

const char* vtkTriQuadDecimation::GetStopReason()
{
  return this->Private->stopReason.c_str();
}

const char* vtkTriQuadDecimation::GetUsedSteps()
{
  return this->Private->usedSteps.c_str();
}

namespace
{

// Whichever output is asked for: both must fit the neighbouring pieces.
bool isInPieces(vtkInformationVector* outputs)
{
  bool pieces = false;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    pieces =
      pieces || outputs->GetInformationObject(port)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  }
  return pieces;
}

TimeWalk::Options walkOptions(vtkTriQuadDecimation* filter, const std::vector<std::string>& scalars,
  const std::vector<int>& steps)
{
  TimeWalk::Options options;
  options.choice = static_cast<undecimate::filters::StepChoice>(filter->GetStepChoice());
  options.list = steps;
  // What ParaView's list of arrays has for none.
  const std::string displacement = filter->GetDisplacement() ? filter->GetDisplacement() : "";
  options.displacement = displacement == "None" ? "" : displacement;
  options.partArray = filter->GetPartArray() ? filter->GetPartArray() : "";
  if (filter->GetCriterion() == vtkTriQuadDecimation::DEVIATION && filter->GetScalarWeight() > 0.0)
  {
    options.scalars = scalars;
  }
  return options;
}

bool hasRequestedTime(vtkInformationVector* outputs, double& time)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = info->Get(Pipeline::UPDATE_TIME_STEP());
      return true;
    }
  }
  return false;
}

} // namespace

int vtkTriQuadDecimation::ComputePipelineMTime(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector, int requestFromOutputPort,
  vtkMTimeType* mtime)
{
  this->Private->pass.beginUpdate();
  return this->Superclass::ComputePipelineMTime(
    request, inputVector, outputVector, requestFromOutputPort, mtime);
}

int vtkTriQuadDecimation::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // An execution that is continued for the next time step is not a new one.
  if (this->Private->pass.starts(request, inputVector[0]) && !this->Private->walking &&
    vtkCompositeDataSet::GetData(inputVector[0]))
  {
    this->Private->decimated = nullptr;
    this->Private->stopReason.clear();
    this->Private->usedSteps.clear();
    this->NumberOfInputNodes = 0;
    this->NumberOfInputCells = 0;
    this->NumberOfNodes = 0;
    this->NumberOfTriangles = 0;
    this->NumberOfQuads = 0;
    this->Error = 0.0;
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkTriQuadDecimation::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  const std::vector<double> times = timesOf(inInfo);
  if (times.size() < 2 || vtkCompositeDataSet::GetData(inputVector[0]))
  {
    in.stopWalking();
    return 1;
  }
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(this->GetExecutive());
  const vtkMTimeType now = pipeline->GetPipelineMTime();
  const bool pieces = isInPieces(outputVector);
  if ((in.walking || in.decimated) && (now != in.key || pieces != in.keyPieces))
  {
    in.stopWalking();
    in.decimated = nullptr;
  }
  if (!in.decimated && !in.walking)
  {
    in.stopWalking();
    in.key = now;
    in.keyPieces = pieces;
    // Told by RequestData(), which the executive calls in any case.
    in.problem =
      in.walk.start(walkOptions(this, in.scalars, in.steps), static_cast<int>(times.size()));
    if (!in.problem.empty())
    {
      in.walk = TimeWalk();
      return 1;
    }
    in.walking = true;
  }
  if (in.walking && !in.fetching)
  {
    inInfo->Set(Pipeline::UPDATE_TIME_STEP(), times[in.walk.steps()[in.walked]]);
  }
  else
  {
    double time = times.front();
    hasRequestedTime(outputVector, time);
    inInfo->Set(Pipeline::UPDATE_TIME_STEP(), time);
  }
  return 1;
}

namespace
{

ArrayPointer originalPointIds(const std::vector<Index>& nodes)
{
  auto numbers = vtkSmartPointer<vtkIdTypeArray>::New();
  numbers->SetName(kOriginalPointIds);
  numbers->SetNumberOfValues(static_cast<vtkIdType>(nodes.size()));
  std::copy(nodes.begin(), nodes.end(), numbers->GetPointer(0));
  return numbers;
}

void pass(vtkPolyData* from, vtkPolyData* to)
{
  to->ShallowCopy(from);
  to->GetFieldData()->Initialize();
  passFieldData(from->GetFieldData(), to->GetFieldData());
}

// The coarse mesh at the time step of `mesh`.
void fillOutput(const Decimated& decimated, vtkPolyData* mesh, vtkPolyData* output)
{
  const auto nodes = static_cast<vtkIdType>(decimated.nodes.size());
  output->GetFieldData()->Initialize();
  passFieldData(mesh->GetFieldData(), output->GetFieldData());
  vtkDataArray* all = mesh->GetPoints()->GetData();
  vtkNew<vtkPoints> points;
  points->SetData(vtkDataArray::SafeDownCast(gather(all, all, 0, decimated.nodes.data(), nodes)));
  output->SetPoints(points);
  std::vector<ArrayPointer> arrays;
  for (int i = 0; i < mesh->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = mesh->GetPointData()->GetAbstractArray(i);
    arrays.push_back(gather(array, array, 0, decimated.nodes.data(), nodes));
  }
  setArrays(output->GetPointData(), mesh->GetPointData(), arrays);

  output->SetPolys(decimated.polys);
  const vtkIdType leading = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  if (leading > 0)
  {
    const Index* places = decimated.places.data();
    output->SetVerts(mapPoints(mesh->GetVerts(), places, mesh->GetVerts()->IsStorage64Bit()));
    output->SetLines(mapPoints(mesh->GetLines(), places, mesh->GetLines()->IsStorage64Bit()));
  }
  arrays.clear();
  for (int i = 0; i < mesh->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = mesh->GetCellData()->GetAbstractArray(i);
    arrays.push_back(gather(array, array, leading, decimated.cells.data(),
      static_cast<vtkIdType>(decimated.cells.size())));
  }
  setArrays(output->GetCellData(), mesh->GetCellData(), arrays);
}

} // namespace

int vtkTriQuadDecimation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, PROGRESSIVE_MESH);
  vtkPolyData* bare = vtkPolyData::GetData(outputVector, COARSE_MESH);
  const std::vector<double> times = timesOf(inInfo);
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  std::string problem;
  try
  {
    const bool composite = vtkCompositeDataSet::GetData(inputVector[0]) != nullptr;
    if (composite && times.size() > 1)
    {
      require("The input has several blocks and " + std::to_string(times.size()) +
        " time steps. Apply Merge Blocks and Extract Surface first, so that there is one mesh.");
    }
    const bool withTime = times.size() > 1;
    if (withTime && !in.walking && !in.decimated)
    {
      require(in.problem.empty() ? "The time steps of the input were not asked for." : in.problem);
    }
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->ShallowCopy(input);
    if (!mesh->GetPoints())
    {
      vtkNew<vtkPoints> none;
      mesh->SetPoints(none);
    }
    if (this->OriginalPointIds && mesh->GetPointData()->HasArray(kOriginalPointIds))
    {
      vtkWarningMacro("The input's point array '"
        << kOriginalPointIds
        << "' gives way to the one that OriginalPointIds adds. Rename it to keep it.");
      mesh->GetPointData()->RemoveArray(kOriginalPointIds);
    }
    if (!withTime)
    {
      in.decimated = nullptr;
      if (mesh->GetNumberOfPoints() == 0 && mesh->GetNumberOfCells() == 0)
      {
        pass(input, output);
        pass(input, bare);
        return 1;
      }
      in.stopWalking();
      require(in.walk.start(walkOptions(this, in.scalars, in.steps), 1));
    }
    double wanted = 0.0;
    const bool hasWanted = hasRequestedTime(outputVector, wanted);
    if (!withTime || (in.walking && !in.fetching))
    {
      const int step = in.walk.steps()[in.walked];
      require(in.walk.add(mesh, describeStep(step, times)));
      if (withTime && hasWanted && times[step] == wanted)
      {
        in.requested = mesh;
      }
      ++in.walked;
      const auto count = static_cast<double>(in.walk.steps().size());
      this->UpdateProgress(kWalkShare * static_cast<double>(in.walked) / count);
      if (this->Private->pass.aborted())
      {
        in.stopWalking();
        output->Initialize();
        bare->Initialize();
        return 1;
      }
      if (in.walked < in.walk.steps().size())
      {
        request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
        return 1;
      }

      TriQuadDecimationOptions options;
      options.criterion = static_cast<TriQuadCriterion>(this->Criterion);
      options.timeError = static_cast<undecimate::TimeError>(this->TimeError);
      options.targetReduction = this->TargetReduction;
      options.targetNodes = this->TargetNodes;
      options.maximumError =
        this->MaximumError >= 1.0 ? std::numeric_limits<double>::infinity() : this->MaximumError;
      options.preserveBoundary = this->PreserveBoundary || isInPieces(outputVector);
      options.quadWeight = this->QuadWeight;
      options.arrays = in.walk.arrays();
      options.scalarWeight = this->ScalarWeight;
      const double before = withTime ? kWalkShare : 0.0;
      Monitor monitor(
        [this, before](double fraction)
        {
          this->UpdateProgress(before + (kWalkShare + kCoreShare - before) * fraction);
          return !this->Private->pass.aborted();
        });
      TriQuadDecimationResult result;
      std::vector<int> used = in.walk.lanes();
      std::sort(used.begin(), used.end());
      Outcome outcome;
      if (withTime && this->StepChoice == AUTOMATIC)
      {
        outcome = decimateTriQuadAutomatically(
          in.walk.mesh(), in.walk.positions(), options, this->StepFactor, monitor, result, used);
      }
      else
      {
        outcome = decimateTriQuad(in.walk.mesh(), in.walk.positions(), options, monitor, result);
      }
      if (outcome.status == Status::Cancelled)
      {
        in.stopWalking();
        output->Initialize();
        bare->Initialize();
        return 1;
      }
      require(outcome.message);

      auto decimated = std::make_unique<Decimated>();
      const Record& record = result.record;
      decimated->topology = in.walk.topology();
      decimated->nodes.assign(
        record.nodeOrder.begin(), record.nodeOrder.begin() + record.baseNodeCount);
      decimated->cells.assign(
        record.cellOrder.begin(), record.cellOrder.begin() + record.baseCellCount);
      decimated->places.assign(record.nodeCount, kNone);
      for (Index i = 0; i < record.baseNodeCount; ++i)
      {
        decimated->places[record.nodeOrder[i]] = i;
      }
      vtkIdType quads = 0;
      decimated->polys = makeFaces(result.baseCells.data(), record.cornersPerCell,
        record.baseCellCount, mesh->GetPolys()->IsStorage64Bit(), nullptr, quads);
      if (!composite)
      {
        this->NumberOfInputNodes = 0;
        this->NumberOfInputCells = 0;
        this->NumberOfNodes = 0;
        this->NumberOfTriangles = 0;
        this->NumberOfQuads = 0;
        this->Error = 0.0;
        in.stopReason.clear();
      }
      this->NumberOfInputNodes += record.nodeCount;
      this->NumberOfInputCells += record.cellCount;
      this->NumberOfNodes += record.baseNodeCount;
      this->NumberOfTriangles += record.baseCellCount - quads;
      this->NumberOfQuads += quads;
      this->Error = std::max(this->Error, result.error);
      const std::string reason = toString(result.stopReason);
      if (in.stopReason.find(reason) == std::string::npos)
      {
        in.stopReason += (in.stopReason.empty() ? "" : ", ") + reason;
      }
      in.usedSteps = withTime ? joined(used) : "";
      const bool asked = this->TargetReduction < 1.0 || this->TargetNodes > 0;
      if (asked && result.stopReason == StopReason::NoRemovableNode)
      {
        vtkWarningMacro("Fewer nodes were removed than asked, for no further node can be removed "
                        "without folding a cell or breaking the surface: "
          << record.baseNodeCount << " of " << record.nodeCount << " nodes are left."
          << describeKept(result));
      }
      decimated->record = RecordArrays(result.record);
      in.decimated = std::move(decimated);
      in.walk = TimeWalk();
      in.walked = 0;
      if (withTime && !in.requested && hasWanted)
      {
        // The requested time was not among the steps.
        in.fetching = true;
        request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
        return 1;
      }
      if (in.requested)
      {
        mesh = in.requested;
      }
    }
    in.stopWalking();
    const std::string differences = in.decimated->topology.differences(mesh);
    if (!differences.empty())
    {
      require("The mesh is not the same at all time steps: at time " +
        vtkVariant(wanted).ToString() + " it has " + differences +
        ", as at the time steps that were decimated (" + in.usedSteps + "). Choose another time.");
    }
    fillOutput(*in.decimated, mesh, bare);
    if (this->OriginalPointIds)
    {
      bare->GetPointData()->AddArray(originalPointIds(in.decimated->nodes));
    }
    output->ShallowCopy(bare);
    in.decimated->record.addTo(mesh, output, this->OriginalPointIds != 0);
    if (withTime)
    {
      const double time = hasWanted ? wanted : times.front();
      for (vtkPolyData* data : { output, bare })
      {
        data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
      }
    }
    else if (!composite)
    {
      in.decimated = nullptr; // another execution is another mesh
    }
    return 1;
  }
  catch (const BrokenRequest& broken)
  {
    problem = broken.message;
  }
  catch (const std::bad_alloc&)
  {
    problem = "Not enough memory to decimate " + std::to_string(input->GetNumberOfPoints()) +
      " points at " + std::to_string(std::max<std::size_t>(1, times.size())) +
      " time steps. Choose fewer steps.";
  }
  catch (const std::exception& failure)
  {
    problem = std::string("The decimation failed: ") + failure.what();
  }
  in.stopWalking();
  vtkErrorMacro(<< problem);
  output->Initialize();
  bare->Initialize();
  return 0;
}

void vtkTriQuadDecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetReduction: " << this->TargetReduction << "\n";
  os << indent << "TargetNodes: " << this->TargetNodes << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "TimeError: " << this->TimeError << "\n";
  os << indent << "StepChoice: " << this->StepChoice << "\n";
  os << indent << "Steps: " << joined(this->Private->steps) << "\n";
  os << indent << "StepFactor: " << this->StepFactor << "\n";
  os << indent << "Displacement: " << (this->Displacement ? this->Displacement : "") << "\n";
  os << indent << "Scalars:";
  for (const std::string& name : this->Private->scalars)
  {
    os << " " << name;
  }
  os << "\n";
  os << indent << "ScalarWeight: " << this->ScalarWeight << "\n";
  os << indent << "QuadWeight: " << this->QuadWeight << "\n";
  os << indent << "PreserveBoundary: " << (this->PreserveBoundary ? "On\n" : "Off\n");
  os << indent << "PartArray: " << (this->PartArray ? this->PartArray : "") << "\n";
  os << indent << "OriginalPointIds: " << (this->OriginalPointIds ? "On\n" : "Off\n");
  os << indent << "NumberOfInputNodes: " << this->NumberOfInputNodes << "\n";
  os << indent << "NumberOfInputCells: " << this->NumberOfInputCells << "\n";
  os << indent << "NumberOfNodes: " << this->NumberOfNodes << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "Error: " << this->Error << "\n";
  os << indent << "StopReason: " << this->Private->stopReason << "\n";
  os << indent << "UsedSteps: " << this->Private->usedSteps << "\n";
}
