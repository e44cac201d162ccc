// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkHashQueueDecimation.h"

#include "undecimateCoarseMesh.h"
#include "undecimateInput.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"

#include "hash_queue_decimation.h"

#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace undecimate;
using namespace undecimate::filters;

vtkStandardNewMacro(vtkHashQueueDecimation);

namespace
{

constexpr double kCoreShare = 0.95; // of the progress; the rest is for the output

// The enumerations of the filter are those of the core.
template <class Filter, class Core>
constexpr bool same(Filter a, Core b)
{
  return static_cast<int>(a) == static_cast<int>(b);
}
static_assert(same(vtkHashQueueDecimation::DEVIATION, Criterion::Deviation) &&
    same(vtkHashQueueDecimation::SCALAR_DIFFERENCE, Criterion::ScalarDifference) &&
    same(vtkHashQueueDecimation::ANGLE_TO_XY_PLANE, Criterion::AngleToXYPlane) &&
    same(vtkHashQueueDecimation::QUADRIC, Criterion::Quadric) &&
    same(vtkHashQueueDecimation::LOGARITHMIC, IntervalSpacing::Logarithmic) &&
    same(vtkHashQueueDecimation::EXPONENTIAL, IntervalSpacing::Exponential),
  "");

// What was never removed, for the warning.
std::string describeKept(const HashQueueDecimationResult& result)
{
  return listKept({
    { result.requestedNodes, "of vertex cells, lines or ghosts" },
    { result.nonFiniteNodes, "with a coordinate that is not a finite number" },
    { result.unusedNodes, "without a triangle" },
    { result.degenerateNodes, "of degenerate or repeated triangles" },
    { result.nonManifoldNodes, "where the surface is not a manifold" },
    { result.boundaryNodes, "on the boundary" },
  });
}

} // namespace

vtkHashQueueDecimation::vtkHashQueueDecimation()
{
  const HashQueueDecimationOptions defaults;
  this->SetDefaults(defaults);
  this->TargetTriangles = defaults.targetTriangles;
  this->Criterion = static_cast<int>(defaults.criterion);
  this->ShapeWeight = defaults.shapeWeight;
  this->IntervalSpacing = static_cast<int>(defaults.intervalSpacing);
  this->IntervalNodes = defaults.intervalNodes;
  this->Parallel = defaults.parallel;
}

vtkHashQueueDecimation::~vtkHashQueueDecimation() = default;

void vtkHashQueueDecimation::SetTriangulate(vtkTypeBool on)
{
  if (this->Triangulate != on)
  {
    this->Triangulate = on;
    this->ForgetWarnings();
    this->Modified();
  }
}

void vtkHashQueueDecimation::ClearResults()
{
  this->Superclass::ClearResults();
  this->NumberOfInputTriangles = 0;
}

bool vtkHashQueueDecimation::MakeOutputs(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, PROGRESSIVE_MESH);
  vtkPolyData* bare = vtkPolyData::GetData(outputVector, COARSE_MESH);
  if (passEmpty(input, output) && passEmpty(input, bare))
  {
    return true;
  }
  vtkSmartPointer<vtkPolyData> mesh;
  if (!this->GetPass().aborted())
  {
    mesh = this->PrepareTriangles(input);
  }
  HashQueueDecimationResult result;
  if (!mesh || !this->Decimate(mesh, isInPieces(outputVector), result))
  {
    return false;
  }
  Record& record = result.record;
  this->AddResults(record, record.baseCellCount, result.error, toString(result.stopReason));
  this->NumberOfInputTriangles += record.cellCount;
  CoarseMesh(record, result.baseTriangles, record.baseSources, mesh)
    .fill(mesh, this->OriginalPointIds != 0, bare);
  output->ShallowCopy(bare);
  const bool asked =
    this->TargetReduction < 1.0 || this->TargetNodes > 0 || this->TargetTriangles > 0;
  if (asked && result.stopReason == StopReason::NoRemovableNode)
  {
    vtkWarningMacro(
      "Fewer nodes were removed than asked, for no further node can be removed without "
      "flipping a triangle or breaking the surface: "
      << record.baseNodeCount << " of " << record.nodeCount << " nodes and " << record.baseCellCount
      << " of " << record.cellCount << " triangles are left." << describeKept(result));
  }
  const auto threads =
    this->Parallel ? std::make_unique<Threads>(this->GetThreadsToUse()) : nullptr;
  writeRecord(record, mesh, output, this->OriginalPointIds != 0, threads.get());
  return true;
}

// The mesh to decimate: triangles, and no array of the name that we will add. Null on abort.
vtkSmartPointer<vtkPolyData> vtkHashQueueDecimation::PrepareTriangles(vtkPolyData* input)
{
  require(checkSizes(input));
  vtkSmartPointer<vtkPolyData> mesh = this->PrepareMesh(input);
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
    mesh, [this] { return this->GetPass().aborted(); }, dropped);
  if (mesh)
  {
    this->WarnOnce("triangulated",
      others.describe() +
        " of the input were cut into triangles, as Triangulate asks: level 1 of the "
        "undecimation is the triangulated mesh.");
  }
  if (mesh && dropped > 0)
  {
    this->WarnOnce("dropped",
      std::to_string(dropped) + " faces of the input gave no triangle and were left out.");
  }
  return mesh;
}

// Run the core. False if the user stopped it.
bool vtkHashQueueDecimation::Decimate(
  vtkPolyData* mesh, bool pieces, HashQueueDecimationResult& result)
{
  MeshInput view;
  require(view.read(mesh));
  std::vector<std::string> names = this->GetScalarNames();
  dropAssociation(mesh, names);
  if (this->Criterion == SCALAR_DIFFERENCE)
  {
    require(view.addArray(mesh, names.empty() ? std::string() : names.front()));
  }
  for (std::size_t i = 0; this->Criterion == DEVIATION && i < names.size(); ++i)
  {
    require(view.addArray(mesh, names[i]));
  }

  if (!names.empty() && (this->Criterion == ANGLE_TO_XY_PLANE || this->Criterion == QUADRIC))
  {
    this->WarnOnce("scalars",
      "The arrays in Scalars do not count with this criterion, which looks at the shape only. "
      "Choose Deviation, or clear Scalars.");
  }

  HashQueueDecimationOptions options;
  options.criterion = static_cast<undecimate::Criterion>(this->Criterion);
  this->GetOptions(pieces, options);
  options.targetTriangles = this->TargetTriangles;
  // The default is no limit for any criterion; for fractions, nor is what is more.
  const bool noLimit = this->Criterion == ANGLE_TO_XY_PLANE ? this->MaximumError == NoErrorLimit
                                                            : this->MaximumError >= NoErrorLimit;
  options.maximumError = noLimit ? std::numeric_limits<double>::infinity() : this->MaximumError;
  options.shapeWeight = this->ShapeWeight;
  options.intervalSpacing = static_cast<undecimate::IntervalSpacing>(this->IntervalSpacing);
  options.intervalNodes = this->IntervalNodes;
  options.parallel = this->Parallel;
  options.arrays = view.arrays();
  options.trackCellSources = mesh->GetCellData()->GetNumberOfArrays() > 0;

  PassMonitor monitor(this->GetPass());
  const Outcome outcome = decimate(view.view(), options, monitor.part(kCoreShare), result);
  if (outcome.status == Status::Cancelled)
  {
    return false;
  }
  require(outcome.message);
  return true;
}

void vtkHashQueueDecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetTriangles: " << this->TargetTriangles << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "ShapeWeight: " << this->ShapeWeight << "\n";
  os << indent << "IntervalSpacing: " << this->IntervalSpacing << "\n";
  os << indent << "IntervalNodes: " << this->IntervalNodes << "\n";
  os << indent << "Parallel: " << (this->Parallel ? "On\n" : "Off\n");
  os << indent << "Triangulate: " << (this->Triangulate ? "On\n" : "Off\n");
  os << indent << "NumberOfInputTriangles: " << this->NumberOfInputTriangles << "\n";
}
