// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkProgressiveMeshDecimation.h"

#include "undecimateCoarseMesh.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <exception>
#include <new>
#include <set>
#include <string>

using namespace undecimate;
using namespace undecimate::filters;

struct vtkProgressiveMeshDecimation::Internals
{
  explicit Internals(vtkProgressiveMeshDecimation* self)
    : pass(self)
  {
  }

  PipelinePass pass;
  std::vector<std::string> scalars;
  std::vector<std::string> reasons; // one of each kind
  std::string stopReason;
  std::set<std::string> said;
  vtkMTimeType upstreamTime = 0; // at which they were said
};

vtkProgressiveMeshDecimation::vtkProgressiveMeshDecimation()
  : Private(std::make_unique<Internals>(this))
{
  this->SetNumberOfOutputPorts(2);
}

vtkProgressiveMeshDecimation::~vtkProgressiveMeshDecimation() = default;

void vtkProgressiveMeshDecimation::AddScalars(const char* name)
{
  if (name && *name && addOnce(this->Private->scalars, name))
  {
    this->Modified();
  }
}

void vtkProgressiveMeshDecimation::ClearScalars()
{
  if (!this->Private->scalars.empty())
  {
    this->Private->scalars.clear();
    this->Modified();
  }
}

int vtkProgressiveMeshDecimation::GetNumberOfScalars()
{
  return static_cast<int>(this->Private->scalars.size());
}

const char* vtkProgressiveMeshDecimation::GetScalars(int index)
{
  return index >= 0 && index < this->GetNumberOfScalars() ? this->Private->scalars[index].c_str()
                                                          : nullptr;
}

const std::vector<std::string>& vtkProgressiveMeshDecimation::GetScalarNames() const
{
  return this->Private->scalars;
}

const char* vtkProgressiveMeshDecimation::GetStopReason()
{
  return this->Private->stopReason.c_str();
}

void vtkProgressiveMeshDecimation::SetOriginalPointIds(vtkTypeBool on)
{
  if (this->OriginalPointIds != on)
  {
    this->OriginalPointIds = on;
    this->ForgetWarnings();
    this->Modified();
  }
}

PipelinePass& vtkProgressiveMeshDecimation::GetPass()
{
  return this->Private->pass;
}

int vtkProgressiveMeshDecimation::ComputePipelineMTime(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector, int requestFromOutputPort,
  vtkMTimeType* mtime)
{
  this->Private->pass.beginUpdate();
  return this->Superclass::ComputePipelineMTime(
    request, inputVector, outputVector, requestFromOutputPort, mtime);
}

int vtkProgressiveMeshDecimation::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->Private->pass.starts(request, inputVector[0]))
  {
    this->StartPass();
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkProgressiveMeshDecimation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  std::string problem;
  bool made = false;
  try
  {
    made = this->MakeOutputs(request, inputVector, outputVector);
  }
  catch (const BrokenRequest& broken)
  {
    problem = broken.message;
  }
  catch (const std::bad_alloc&)
  {
    vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
    problem = "Not enough memory to decimate " + std::to_string(input->GetNumberOfPoints()) +
      " points and " + std::to_string(input->GetNumberOfPolys()) +
      " faces. Decimate the mesh in parts.";
  }
  catch (const std::exception& failure)
  {
    problem = std::string("The decimation failed: ") + failure.what();
  }
  if (made)
  {
    return 1;
  }
  for (const int port : { PROGRESSIVE_MESH, COARSE_MESH })
  {
    vtkPolyData::GetData(outputVector, port)->Initialize();
  }
  if (problem.empty()) // aborted
  {
    this->ClearResults();
    return 1;
  }
  vtkErrorMacro(<< problem);
  return 0;
}

void vtkProgressiveMeshDecimation::ClearResults()
{
  this->NumberOfInputNodes = 0;
  this->NumberOfNodes = 0;
  this->NumberOfTriangles = 0;
  this->Error = 0.0;
  this->Private->reasons.clear();
  this->Private->stopReason.clear();
}

void vtkProgressiveMeshDecimation::AddResults(
  const Record& record, vtkIdType triangles, double error, const char* stopReason)
{
  this->NumberOfInputNodes += record.nodeCount;
  this->NumberOfNodes += record.baseNodeCount;
  this->NumberOfTriangles += triangles;
  this->Error = std::max(this->Error, error);
  if (addOnce(this->Private->reasons, stopReason))
  {
    std::string& all = this->Private->stopReason;
    all += (all.empty() ? "" : ", ") + std::string(stopReason);
  }
}

vtkSmartPointer<vtkPolyData> vtkProgressiveMeshDecimation::PrepareMesh(vtkPolyData* input)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->ShallowCopy(input);
  if (!mesh->GetPoints())
  {
    vtkNew<vtkPoints> none;
    mesh->SetPoints(none);
  }
  if (this->OriginalPointIds && mesh->GetPointData()->HasArray(kOriginalPointIds))
  {
    this->WarnOnce("original point ids",
      std::string("The input's point array '") + kOriginalPointIds +
        "' gives way to the one that OriginalPointIds adds. Rename it to keep it.");
    mesh->GetPointData()->RemoveArray(kOriginalPointIds);
  }
  if (mesh->GetNumberOfVerts() > 0 || mesh->GetNumberOfLines() > 0)
  {
    this->WarnOnce("vertex cells and lines",
      std::to_string(mesh->GetNumberOfVerts()) + " vertex cells and " +
        std::to_string(mesh->GetNumberOfLines()) +
        " lines are passed along unchanged; their nodes are kept at all levels.");
  }
  return mesh;
}

void vtkProgressiveMeshDecimation::WarnOnce(const char* about, const std::string& text)
{
  // Upstream of a time step that is not the first nothing was changed.
  auto* upstream = vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(0, 0));
  const vtkMTimeType time = upstream ? upstream->GetPipelineMTime() : 0;
  if (time != this->Private->upstreamTime)
  {
    this->ForgetWarnings();
    this->Private->upstreamTime = time;
  }
  if (this->Private->said.insert(about).second)
  {
    vtkWarningMacro(<< text);
  }
}

void vtkProgressiveMeshDecimation::ForgetWarnings()
{
  this->Private->said.clear();
}

// As many threads as VTK's own filters use; 0, the core's word for all cores, if they use none.
int vtkProgressiveMeshDecimation::GetThreadsToUse() const
{
  if (this->NumberOfThreads > 0)
  {
    return this->NumberOfThreads;
  }
  return std::string(vtkSMPTools::GetBackend()) == "Sequential"
    ? 0
    : vtkSMPTools::GetEstimatedNumberOfThreads();
}

void vtkProgressiveMeshDecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetReduction: " << this->TargetReduction << "\n";
  os << indent << "TargetNodes: " << this->TargetNodes << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "Scalars:";
  for (const std::string& name : this->Private->scalars)
  {
    os << " " << name;
  }
  os << "\n";
  os << indent << "ScalarWeight: " << this->ScalarWeight << "\n";
  os << indent << "PreserveBoundary: " << (this->PreserveBoundary ? "On\n" : "Off\n");
  os << indent << "OriginalPointIds: " << (this->OriginalPointIds ? "On\n" : "Off\n");
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfInputNodes: " << this->NumberOfInputNodes << "\n";
  os << indent << "NumberOfNodes: " << this->NumberOfNodes << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "Error: " << this->Error << "\n";
  os << indent << "StopReason: " << this->Private->stopReason << "\n";
}
