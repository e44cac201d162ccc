// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkTriQuadDecimation.h"

#include "undecimateCoarseMesh.h"
#include "undecimateInput.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"
#include "undecimateTimeWalk.h"

#include "tri_quad_decimation.h"

#include "vtkCompositeDataSet.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVariant.h"

#include <algorithm>
#include <limits>
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

// What was never removed, for the warning.
std::string describeKept(const TriQuadDecimationResult& result)
{
  return listKept({
    { result.requestedNodes, "of vertex cells, lines or ghosts" },
    { result.nonFiniteNodes, "of cells with a coordinate or value that is not a finite number" },
    { result.unusedNodes, "without a cell" },
    { result.irregularNodes, "of degenerate or repeated cells" },
    { result.boundaryNodes, "on the boundary" },
    { result.seamNodes, "where several surfaces or parts meet, which go only along the joint" },
  });
}

// A decimation that was made: all that each time step's output needs.
struct Decimated
{
  RecordArrays record;
  MeshTopology topology;
  CoarseMesh mesh;
};

} // namespace

struct vtkTriQuadDecimation::Internals
{
  std::vector<int> steps;
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
  : Private(std::make_unique<Internals>())
{
  const TriQuadDecimationOptions defaults;
  this->SetDefaults(defaults);
  this->Criterion = static_cast<int>(defaults.criterion);
  this->TimeError = static_cast<int>(defaults.timeError);
  this->QuadWeight = defaults.quadWeight;
  this->vtkTriQuadDecimation::SetPartArray("part");
}

vtkTriQuadDecimation::~vtkTriQuadDecimation()
{
  this->vtkTriQuadDecimation::SetDisplacement(nullptr);
  this->vtkTriQuadDecimation::SetPartArray(nullptr);
}

void vtkTriQuadDecimation::AddSteps(int step)
{
  if (addOnce(this->Private->steps, step))
  {
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

const char* vtkTriQuadDecimation::GetUsedSteps()
{
  return this->Private->usedSteps.c_str();
}

namespace
{

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

// The time that is asked for; the first if none is.
double requestedTime(vtkInformationVector* outputs, const std::vector<double>& times)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      return info->Get(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return times.front();
}

} // namespace

void vtkTriQuadDecimation::StartPass()
{
  // The results stay while time steps are walked through, and for other times of what was
  // decimated.
  if (!this->Private->walking && !this->Private->decimated)
  {
    this->ClearResults();
  }
}

void vtkTriQuadDecimation::ClearResults()
{
  this->Superclass::ClearResults();
  this->NumberOfInputCells = 0;
  this->NumberOfQuads = 0;
  this->Private->usedSteps.clear();
}

int vtkTriQuadDecimation::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  const std::vector<double> times = timesOf(inInfo);
  const bool composite = vtkCompositeDataSet::GetData(inputVector[0]) != nullptr;
  if (times.size() < 2 || composite || this->GetPass().inBlocks())
  {
    in.stopWalking();
    in.decimated = nullptr;
    return 1;
  }
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(this->GetExecutive());
  const vtkMTimeType now = pipeline->GetPipelineMTime();
  const bool pieces = isInPieces(outputVector);
  if (now != in.key || pieces != in.keyPieces)
  {
    in.stopWalking();
    in.decimated = nullptr;
  }
  if (!in.decimated && !in.walking)
  {
    in.key = now;
    in.keyPieces = pieces;
    this->ClearResults();
    // Told by RequestData(), which the executive calls in any case.
    in.problem = in.walk.start(
      walkOptions(this, this->GetScalarNames(), in.steps), static_cast<int>(times.size()));
    in.walking = in.problem.empty();
  }
  const bool next = in.walking && !in.fetching;
  inInfo->Set(Pipeline::UPDATE_TIME_STEP(),
    next ? times[in.walk.steps()[in.walked]] : requestedTime(outputVector, times));
  return 1;
}

int vtkTriQuadDecimation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  const int done = this->Superclass::RequestData(request, inputVector, outputVector);
  if (!request->Has(Pipeline::CONTINUE_EXECUTING()))
  {
    this->Private->stopWalking();
  }
  return done;
}

// Called for each time step that is walked through, and at the end, or for another time, with the
// requested one.
bool vtkTriQuadDecimation::MakeOutputs(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, PROGRESSIVE_MESH);
  vtkPolyData* bare = vtkPolyData::GetData(outputVector, COARSE_MESH);
  const std::vector<double> times = timesOf(inputVector[0]->GetInformationObject(0));
  if (times.size() < 2)
  {
    if (passEmpty(input, output) && passEmpty(input, bare))
    {
      return true;
    }
    in.problem = in.walk.start(walkOptions(this, this->GetScalarNames(), in.steps), 1);
    in.walking = true;
  }
  else if (this->GetPass().inBlocks())
  {
    require("The input has several blocks and " + std::to_string(times.size()) +
      " time steps. Apply Merge Blocks and Extract Surface first, so that there is one mesh.");
  }
  require(in.problem);
  vtkSmartPointer<vtkPolyData> mesh = this->PrepareMesh(input);
  if (in.walking && !in.fetching)
  {
    if (!this->AddStep(mesh, times, outputVector))
    {
      return false;
    }
    const bool last = in.walked == in.walk.steps().size();
    if (last && !this->Decimate(mesh, isInPieces(outputVector), times.size() > 1))
    {
      return false;
    }
    in.fetching = last;
    if (!last || !in.requested)
    {
      request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
      return true;
    }
    mesh = in.requested;
  }
  this->HandOut(mesh, times, outputVector);
  return true;
}

// One step of the walk. False if the user stopped it.
bool vtkTriQuadDecimation::AddStep(
  vtkPolyData* mesh, const std::vector<double>& times, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  const int step = in.walk.steps()[in.walked];
  require(in.walk.add(mesh, describeStep(step, times)));
  if (times.size() < 2 || times[step] == requestedTime(outputVector, times))
  {
    in.requested = mesh;
  }
  ++in.walked;
  if (times.size() > 1)
  {
    const auto count = static_cast<double>(in.walk.steps().size());
    this->UpdateProgress(kWalkShare * static_cast<double>(in.walked) / count);
  }
  return !this->GetPass().aborted();
}

// Run the core on the steps that were walked through. False if the user stopped it.
bool vtkTriQuadDecimation::Decimate(vtkPolyData* mesh, bool pieces, bool withTime)
{
  Internals& in = *this->Private;
  TriQuadDecimationOptions options;
  this->GetOptions(pieces, options);
  options.criterion = static_cast<TriQuadCriterion>(this->Criterion);
  options.timeError = static_cast<undecimate::TimeError>(this->TimeError);
  options.maximumError = this->MaximumError >= NoErrorLimit
    ? std::numeric_limits<double>::infinity()
    : this->MaximumError;
  options.quadWeight = this->QuadWeight;
  options.arrays = in.walk.arrays();

  if (this->Criterion == QUADRICS && this->GetNumberOfScalars() > 0)
  {
    this->WarnOnce("scalars",
      "The arrays in Scalars do not count with the criterion Quadrics, which looks at the shape "
      "only. Choose Deviation, or clear Scalars.");
  }
  PassMonitor monitor(this->GetPass());
  if (withTime)
  {
    monitor.part(kWalkShare); // done
  }
  Monitor& core = monitor.part(kWalkShare + kCoreShare);
  TriQuadDecimationResult result;
  std::vector<int> used = in.walk.lanes();
  std::sort(used.begin(), used.end());
  const Outcome outcome = withTime && this->StepChoice == AUTOMATIC
    ? decimateTriQuadAutomatically(
        in.walk.mesh(), in.walk.positions(), options, this->StepFactor, core, result, used)
    : decimateTriQuad(in.walk.mesh(), in.walk.positions(), options, core, result);
  if (outcome.status == Status::Cancelled)
  {
    return false;
  }
  require(outcome.message);

  Record& record = result.record;
  auto decimated = std::make_unique<Decimated>();
  decimated->topology = in.walk.topology();
  decimated->mesh = CoarseMesh(record, result.baseCells, record.cellOrder, mesh);
  const vtkIdType quads = decimated->mesh.numberOfQuads();
  this->AddResults(record, record.baseCellCount - quads, result.error, toString(result.stopReason));
  this->NumberOfInputCells += record.cellCount;
  this->NumberOfQuads += quads;
  in.usedSteps = withTime ? joined(used) : "";
  const bool asked = this->TargetReduction < 1.0 || this->TargetNodes > 0;
  if (asked && result.stopReason == StopReason::NoRemovableNode)
  {
    vtkWarningMacro("Fewer nodes were removed than asked, for no further node can be removed "
                    "without breaking the surface: "
      << record.baseNodeCount << " of " << record.nodeCount << " nodes are left."
      << describeKept(result));
  }
  decimated->record = RecordArrays(record);
  in.decimated = std::move(decimated);
  in.walk = TimeWalk();
  return true;
}

// Fill the outputs at the time step of the mesh.
void vtkTriQuadDecimation::HandOut(
  vtkPolyData* mesh, const std::vector<double>& times, vtkInformationVector* outputVector)
{
  Internals& in = *this->Private;
  vtkPolyData* output = vtkPolyData::GetData(outputVector, PROGRESSIVE_MESH);
  vtkPolyData* bare = vtkPolyData::GetData(outputVector, COARSE_MESH);
  require(checkSizes(mesh));
  const std::string differences = in.decimated->topology.differences(mesh);
  if (!differences.empty())
  {
    require("The mesh is not the same at all time steps: at time " +
      vtkVariant(requestedTime(outputVector, times)).ToString() + " it has " + differences +
      ", as at the time steps that were decimated (" + in.usedSteps + "). Choose another time.");
  }
  in.decimated->mesh.fill(mesh, this->OriginalPointIds != 0, bare);
  output->ShallowCopy(bare);
  in.decimated->record.addTo(mesh, output, this->OriginalPointIds != 0);
  if (times.size() < 2)
  {
    in.decimated = nullptr; // another execution is another mesh
    return;
  }
  for (vtkPolyData* data : { output, bare })
  {
    data->GetInformation()->Set(
      vtkDataObject::DATA_TIME_STEP(), requestedTime(outputVector, times));
  }
}

void vtkTriQuadDecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "TimeError: " << this->TimeError << "\n";
  os << indent << "StepChoice: " << this->StepChoice << "\n";
  os << indent << "Steps: " << joined(this->Private->steps) << "\n";
  os << indent << "StepFactor: " << this->StepFactor << "\n";
  os << indent << "Displacement: " << (this->Displacement ? this->Displacement : "") << "\n";
  os << indent << "QuadWeight: " << this->QuadWeight << "\n";
  os << indent << "PartArray: " << (this->PartArray ? this->PartArray : "") << "\n";
  os << indent << "NumberOfInputCells: " << this->NumberOfInputCells << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "UsedSteps: " << this->Private->usedSteps << "\n";
}
