// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkHashQueueDecimation.h"

#include "undecimateArrays.h"
#include "undecimateInput.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"

#include "hash_queue_decimation.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
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

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace undecimate;
using namespace undecimate::filters;

vtkStandardNewMacro(vtkHashQueueDecimation);

namespace
{

constexpr double kCoreShare = 0.95; // of the progress; the rest is for the output

// A MaximumError that is no limit: a fraction of 1, which is less awkward to show than infinity.
constexpr double kNoErrorLimit = 1.0;

// The enumerations of the filter are those of the core.
template <class Filter, class Core>
constexpr bool same(Filter a, Core b)
{
  return static_cast<int>(a) == static_cast<int>(b);
}
static_assert(same(vtkHashQueueDecimation::DEVIATION, Criterion::Deviation) &&
    same(vtkHashQueueDecimation::SCALAR_DIFFERENCE, Criterion::ScalarDifference) &&
    same(vtkHashQueueDecimation::ANGLE_TO_XY_PLANE, Criterion::AngleToXYPlane) &&
    same(vtkHashQueueDecimation::LOGARITHMIC, IntervalSpacing::Logarithmic) &&
    same(vtkHashQueueDecimation::EXPONENTIAL, IntervalSpacing::Exponential),
  "");

// What is said about an input.
enum class Notice
{
  ArrayGivesWay,
  PassedAlong,
  Triangulated,
  LeftOut
};

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

bool isEmpty(vtkPolyData* mesh)
{
  return mesh->GetNumberOfPoints() == 0 && mesh->GetNumberOfCells() == 0;
}

// Place of each original node in the coarse mesh, for the nodes that are left.
std::vector<Index> basePlaces(const Record& record)
{
  std::vector<Index> places(record.nodeCount, kNone);
  for (Index i = 0; i < record.baseNodeCount; ++i)
  {
    places[record.nodeOrder[i]] = i;
  }
  return places;
}

ArrayPointer originalPointIds(const Record& record)
{
  auto numbers = vtkSmartPointer<vtkIdTypeArray>::New();
  numbers->SetName(kOriginalPointIds);
  numbers->SetNumberOfValues(record.baseNodeCount);
  std::copy_n(record.nodeOrder.begin(), record.baseNodeCount, numbers->GetPointer(0));
  return numbers;
}

void fillPoints(const Record& record, vtkPolyData* mesh, vtkPolyData* coarse)
{
  const Index* numbers = record.nodeOrder.data();
  if (mesh->GetPoints())
  {
    vtkDataArray* all = mesh->GetPoints()->GetData();
    vtkNew<vtkPoints> points;
    points->SetData(vtkDataArray::SafeDownCast(gather(all, all, 0, numbers, record.baseNodeCount)));
    coarse->SetPoints(points);
  }
  std::vector<ArrayPointer> arrays;
  for (int i = 0; i < mesh->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = mesh->GetPointData()->GetAbstractArray(i);
    arrays.push_back(gather(array, array, 0, numbers, record.baseNodeCount));
  }
  setArrays(coarse->GetPointData(), mesh->GetPointData(), arrays);
}

void fillCells(const HashQueueDecimationResult& result, vtkPolyData* mesh, vtkPolyData* coarse)
{
  const Record& record = result.record;
  vtkIdType quads = 0;
  coarse->SetPolys(makeFaces(result.baseTriangles.data(), record.cornersPerCell,
    record.baseCellCount, mesh->GetPolys()->IsStorage64Bit(), nullptr, quads));
  const vtkIdType leading = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  if (leading > 0)
  {
    const std::vector<Index> places = basePlaces(record);
    coarse->SetVerts(
      mapPoints(mesh->GetVerts(), places.data(), mesh->GetVerts()->IsStorage64Bit()));
    coarse->SetLines(
      mapPoints(mesh->GetLines(), places.data(), mesh->GetLines()->IsStorage64Bit()));
  }
  std::vector<ArrayPointer> arrays;
  for (int i = 0; i < mesh->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = mesh->GetCellData()->GetAbstractArray(i);
    arrays.push_back(
      gather(array, array, leading, record.baseSources.data(), record.baseCellCount));
  }
  setArrays(coarse->GetCellData(), mesh->GetCellData(), arrays);
}

// "12 non-manifold nodes, 3 unused nodes": what was never removed, for the warning.
std::string describeKept(const HashQueueDecimationResult& result)
{
  const std::pair<Index, const char*> reasons[] = {
    { result.requestedNodes, "of vertex cells, lines or ghosts" },
    { result.nonFiniteNodes, "with a coordinate that is not a finite number" },
    { result.unusedNodes, "without a triangle" },
    { result.degenerateNodes, "of degenerate or repeated triangles" },
    { result.nonManifoldNodes, "where the surface is not a manifold" },
    { result.boundaryNodes, "on the boundary" },
  };
  std::string text;
  for (const auto& [count, reason] : reasons)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    }
  }
  return text.empty() ? "" : " Nodes that are always kept: " + text + ".";
}

} // namespace

struct vtkHashQueueDecimation::Internals
{
  explicit Internals(vtkHashQueueDecimation* self)
    : pass(self)
  {
  }

  PipelinePass pass;
  std::vector<std::string> scalars;
  std::vector<std::string> reasons; // one of each kind
  std::string stopReason;
  std::set<Notice> said;
  vtkMTimeType upstreamTime = 0; // at which they were said

  // Whether something is to be said about the input. Upstream of a time step that is not the first
  // nothing was changed.
  bool isNew(Notice notice)
  {
    auto* upstream =
      vtkDemandDrivenPipeline::SafeDownCast(this->pass.algorithm()->GetInputExecutive(0, 0));
    const vtkMTimeType time = upstream ? upstream->GetPipelineMTime() : 0;
    if (time != this->upstreamTime)
    {
      this->said.clear();
      this->upstreamTime = time;
    }
    return this->said.insert(notice).second;
  }

  void addReason(const std::string& reason)
  {
    if (std::find(this->reasons.begin(), this->reasons.end(), reason) == this->reasons.end())
    {
      this->reasons.push_back(reason);
      this->stopReason += (this->stopReason.empty() ? "" : ", ") + reason;
    }
  }
};

vtkHashQueueDecimation::vtkHashQueueDecimation()
  : Private(std::make_unique<Internals>(this))
{
  const HashQueueDecimationOptions defaults;
  this->TargetReduction = defaults.targetReduction;
  this->TargetNodes = defaults.targetNodes;
  this->TargetTriangles = defaults.targetTriangles;
  this->MaximumError = std::min(defaults.maximumError, kNoErrorLimit);
  this->Criterion = static_cast<int>(defaults.criterion);
  this->ScalarWeight = defaults.scalarWeight;
  this->IntervalSpacing = static_cast<int>(defaults.intervalSpacing);
  this->IntervalNodes = defaults.intervalNodes;
  this->PreserveBoundary = defaults.preserveBoundary;
  this->SetNumberOfOutputPorts(2);
}

vtkHashQueueDecimation::~vtkHashQueueDecimation() = default;

void vtkHashQueueDecimation::AddScalars(const char* name)
{
  std::vector<std::string>& names = this->Private->scalars;
  if (name && *name && std::find(names.begin(), names.end(), name) == names.end())
  {
    names.emplace_back(name);
    this->Modified();
  }
}

void vtkHashQueueDecimation::ClearScalars()
{
  if (!this->Private->scalars.empty())
  {
    this->Private->scalars.clear();
    this->Modified();
  }
}

int vtkHashQueueDecimation::GetNumberOfScalars()
{
  return static_cast<int>(this->Private->scalars.size());
}

const char* vtkHashQueueDecimation::GetScalars(int index)
{
  return index >= 0 && index < this->GetNumberOfScalars() ? this->Private->scalars[index].c_str()
                                                          : nullptr;
}

const char* vtkHashQueueDecimation::GetStopReason()
{
  return this->Private->stopReason.c_str();
}

void vtkHashQueueDecimation::SetTriangulate(vtkTypeBool on)
{
  if (this->Triangulate != on)
  {
    this->Triangulate = on;
    this->Private->said.clear();
    this->Modified();
  }
}

void vtkHashQueueDecimation::SetOriginalPointIds(vtkTypeBool on)
{
  if (this->OriginalPointIds != on)
  {
    this->OriginalPointIds = on;
    this->Private->said.clear();
    this->Modified();
  }
}

int vtkHashQueueDecimation::ComputePipelineMTime(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector, int requestFromOutputPort,
  vtkMTimeType* mtime)
{
  this->Private->pass.beginUpdate();
  return this->Superclass::ComputePipelineMTime(
    request, inputVector, outputVector, requestFromOutputPort, mtime);
}

int vtkHashQueueDecimation::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->Private->pass.starts(request, inputVector[0]))
  {
    this->ClearResults();
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

void vtkHashQueueDecimation::ClearResults()
{
  this->NumberOfInputNodes = 0;
  this->NumberOfInputTriangles = 0;
  this->NumberOfNodes = 0;
  this->NumberOfTriangles = 0;
  this->Error = 0.0;
  this->Private->reasons.clear();
  this->Private->stopReason.clear();
}

int vtkHashQueueDecimation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, PROGRESSIVE_MESH);
  vtkPolyData* bare = vtkPolyData::GetData(outputVector, COARSE_MESH);
  // Whichever output is asked for: both must fit the neighbouring pieces.
  bool pieces = false;
  for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* outInfo = outputVector->GetInformationObject(port);
    pieces =
      pieces || outInfo->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  }
  try
  {
    if (isEmpty(input))
    {
      for (vtkPolyData* empty : { output, bare })
      {
        empty->ShallowCopy(input);
        empty->GetFieldData()->Initialize();
        passFieldData(input->GetFieldData(), empty->GetFieldData());
      }
      return 1;
    }
    vtkSmartPointer<vtkPolyData> mesh;
    if (!this->Private->pass.aborted())
    {
      mesh = this->PrepareMesh(input);
    }
    HashQueueDecimationResult result;
    if (mesh && this->Decimate(mesh, pieces, result))
    {
      this->FillOutput(mesh, result, bare);
      output->ShallowCopy(bare);
      writeRecord(result.record, mesh, output, this->OriginalPointIds != 0);
      return 1;
    }
    this->ClearResults();
    output->Initialize();
    bare->Initialize();
    return 1;
  }
  catch (const BrokenRequest& broken)
  {
    vtkErrorMacro(<< broken.message);
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Not enough memory to decimate " << input->GetNumberOfPoints() << " points and "
                                                   << input->GetNumberOfPolys() << " triangles.");
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("The decimation failed: " << problem.what());
  }
  output->Initialize();
  bare->Initialize();
  return 0;
}

// The mesh to decimate: triangles, and no array of the name that we will add. Null on abort.
vtkSmartPointer<vtkPolyData> vtkHashQueueDecimation::PrepareMesh(vtkPolyData* input)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->ShallowCopy(input);
  require(checkSizes(mesh));
  if (!mesh->GetPoints())
  {
    vtkNew<vtkPoints> none;
    mesh->SetPoints(none);
  }
  if (this->OriginalPointIds && mesh->GetPointData()->HasArray(kOriginalPointIds))
  {
    if (this->Private->isNew(Notice::ArrayGivesWay))
    {
      vtkWarningMacro("The input's point array '"
        << kOriginalPointIds
        << "' gives way to the one that OriginalPointIds adds. Rename it to keep it.");
    }
    mesh->GetPointData()->RemoveArray(kOriginalPointIds);
  }
  if ((mesh->GetNumberOfVerts() > 0 || mesh->GetNumberOfLines() > 0) &&
    this->Private->isNew(Notice::PassedAlong))
  {
    vtkWarningMacro(<< mesh->GetNumberOfVerts() << " vertex cells and " << mesh->GetNumberOfLines()
                    << " lines are passed along unchanged; their nodes are kept at all levels.");
  }
  const OtherFaces others = countOtherFaces(mesh);
  if (!others.any())
  {
    return mesh;
  }
  if (!this->Triangulate)
  {
    require("The input has " + others.describe() +
      "; the decimation needs triangles. Turn on the property Triangulate to cut them into "
      "triangles, or apply the filter Triangulate first.");
  }
  require(checkFaces(mesh));
  vtkIdType dropped = 0;
  mesh = triangulated(
    mesh, [this] { return this->Private->pass.aborted(); }, dropped);
  if (mesh && this->Private->isNew(Notice::Triangulated))
  {
    vtkWarningMacro(<< others.describe()
                    << " of the input were cut into triangles, as Triangulate asks: level 1 of the "
                       "undecimation is the triangulated mesh.");
  }
  if (mesh && dropped > 0 && this->Private->isNew(Notice::LeftOut))
  {
    vtkWarningMacro(<< dropped << " faces of the input gave no triangle and were left out.");
  }
  return mesh;
}

// Run the core. False if the user stopped it.
bool vtkHashQueueDecimation::Decimate(
  vtkPolyData* mesh, bool pieces, HashQueueDecimationResult& result)
{
  MeshInput view;
  require(view.read(mesh));
  std::vector<std::string> names = this->Private->scalars;
  // ParaView's Python names arrays of other filters as ['POINTS', name].
  if (!names.empty() && names.front() == "POINTS" && !mesh->GetPointData()->HasArray("POINTS"))
  {
    names.erase(names.begin());
  }
  if (this->Criterion == SCALAR_DIFFERENCE)
  {
    require(view.addArray(mesh, names.empty() ? std::string() : names.front()));
  }
  for (std::size_t i = 0; this->Criterion == DEVIATION && i < names.size(); ++i)
  {
    require(view.addArray(mesh, names[i]));
  }

  HashQueueDecimationOptions options;
  options.criterion = static_cast<undecimate::Criterion>(this->Criterion);
  options.targetReduction = this->TargetReduction;
  options.targetNodes = this->TargetNodes;
  options.targetTriangles = this->TargetTriangles;
  // The default is no limit for any criterion; for fractions, nor is what is more.
  const bool noLimit = this->Criterion == ANGLE_TO_XY_PLANE ? this->MaximumError == kNoErrorLimit
                                                            : this->MaximumError >= kNoErrorLimit;
  options.maximumError = noLimit ? std::numeric_limits<double>::infinity() : this->MaximumError;
  options.intervalSpacing = static_cast<undecimate::IntervalSpacing>(this->IntervalSpacing);
  options.intervalNodes = this->IntervalNodes;
  options.preserveBoundary = this->PreserveBoundary || pieces;
  options.arrays = view.arrays();
  options.scalarWeight = this->ScalarWeight;
  options.trackCellSources = mesh->GetCellData()->GetNumberOfArrays() > 0;

  PassMonitor monitor(this->Private->pass);
  const Outcome outcome = decimate(view.view(), options, monitor.part(kCoreShare), result);
  if (outcome.status == Status::Cancelled)
  {
    return false;
  }
  require(outcome.message);
  return true;
}

void vtkHashQueueDecimation::FillOutput(
  vtkPolyData* mesh, const HashQueueDecimationResult& result, vtkPolyData* output)
{
  const Record& record = result.record;
  const vtkIdType nodes = record.baseNodeCount;
  const vtkIdType triangles = record.baseCellCount;
  this->NumberOfInputNodes += record.nodeCount;
  this->NumberOfInputTriangles += record.cellCount;
  this->NumberOfNodes += nodes;
  this->NumberOfTriangles += triangles;
  this->Error = std::max(this->Error, result.error);
  this->Private->addReason(toString(result.stopReason));

  // The executive has put the input's field data there, with the record of an earlier decimation.
  output->GetFieldData()->Initialize();
  passFieldData(mesh->GetFieldData(), output->GetFieldData());
  fillPoints(record, mesh, output);
  fillCells(result, mesh, output);
  if (this->OriginalPointIds)
  {
    output->GetPointData()->AddArray(originalPointIds(record));
  }
  const bool asked =
    this->TargetReduction < 1.0 || this->TargetNodes > 0 || this->TargetTriangles > 0;
  if (asked && result.stopReason == StopReason::NoRemovableNode)
  {
    vtkWarningMacro(
      "Fewer nodes were removed than asked, for no further node can be removed without "
      "flipping a triangle or breaking the surface: "
      << nodes << " of " << record.nodeCount << " nodes and " << triangles << " of "
      << record.cellCount << " triangles are left." << describeKept(result));
  }
}

void vtkHashQueueDecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetReduction: " << this->TargetReduction << "\n";
  os << indent << "TargetNodes: " << this->TargetNodes << "\n";
  os << indent << "TargetTriangles: " << this->TargetTriangles << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "Scalars:";
  for (const std::string& name : this->Private->scalars)
  {
    os << " " << name;
  }
  os << "\n";
  os << indent << "ScalarWeight: " << this->ScalarWeight << "\n";
  os << indent << "IntervalSpacing: " << this->IntervalSpacing << "\n";
  os << indent << "IntervalNodes: " << this->IntervalNodes << "\n";
  os << indent << "PreserveBoundary: " << (this->PreserveBoundary ? "On\n" : "Off\n");
  os << indent << "Triangulate: " << (this->Triangulate ? "On\n" : "Off\n");
  os << indent << "OriginalPointIds: " << (this->OriginalPointIds ? "On\n" : "Off\n");
  os << indent << "NumberOfInputNodes: " << this->NumberOfInputNodes << "\n";
  os << indent << "NumberOfInputTriangles: " << this->NumberOfInputTriangles << "\n";
  os << indent << "NumberOfNodes: " << this->NumberOfNodes << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "Error: " << this->Error << "\n";
  os << indent << "StopReason: " << this->Private->stopReason << "\n";
}
