// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkUndecimation.h"

#include "undecimateMesh.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"

#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <exception>
#include <new>
#include <string>

using namespace undecimate;
using namespace undecimate::filters;

vtkStandardNewMacro(vtkUndecimation);

struct vtkUndecimation::Internals
{
  explicit Internals(vtkUndecimation* self)
    : pass(self)
  {
  }

  PipelinePass pass;
  ArrayMemory memory;
  UndecimatedMeshCache meshes;
};

vtkUndecimation::vtkUndecimation()
  : Private(std::make_unique<Internals>(this))
{
}

vtkUndecimation::~vtkUndecimation() = default;

int vtkUndecimation::ComputePipelineMTime(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector, int requestFromOutputPort,
  vtkMTimeType* mtime)
{
  this->Private->pass.beginUpdate();
  return this->Superclass::ComputePipelineMTime(
    request, inputVector, outputVector, requestFromOutputPort, mtime);
}

int vtkUndecimation::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->Private->pass.starts(request, inputVector[0]))
  {
    this->Private->memory.startPass();
    this->Private->meshes.startPass();
    this->ClearResults();
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkUndecimation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  PipelinePass& pass = this->Private->pass;
  std::string problem;
  try
  {
    if (passEmpty(input, output))
    {
      return 1;
    }
    PassMonitor monitor(pass);
    UndecimatedMesh* mesh =
      pass.aborted() ? nullptr : this->Private->meshes.find(input, monitor, problem);
    if (mesh)
    {
      const Undecimation& cursor = mesh->cursor();
      const Index steps = this->LevelBy == BY_NODES ? cursor.stepsForLevel(this->Level)
                                                    : cursor.stepsForError(this->MaximumError);
      if (mesh->show(input, steps, output, this->Private->memory, monitor))
      {
        passFieldData(input->GetFieldData(), output->GetFieldData());
        if (this->OriginalPointIds)
        {
          output->GetPointData()->AddArray(mesh->originalPointIds());
        }
        this->NumberOfNodes += cursor.nodeCount();
        this->NumberOfTriangles += cursor.cellCount() - mesh->numberOfQuads();
        this->NumberOfQuads += mesh->numberOfQuads();
        this->Error = std::max(this->Error, cursor.error());
        return 1;
      }
    }
  }
  catch (const std::bad_alloc&)
  {
    problem = "Not enough memory to undecimate a mesh of " +
      std::to_string(input->GetNumberOfPoints()) + " points at its coarsest level.";
  }
  catch (const std::exception& failure)
  {
    problem = std::string("The undecimation failed: ") + failure.what();
  }
  output->Initialize();
  if (problem.empty()) // aborted
  {
    this->ClearResults();
    return 1;
  }
  vtkErrorMacro(<< problem);
  return 0;
}

void vtkUndecimation::ClearResults()
{
  this->NumberOfNodes = 0;
  this->NumberOfTriangles = 0;
  this->NumberOfQuads = 0;
  this->Error = 0.0;
}

void vtkUndecimation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "LevelBy: " << (this->LevelBy == BY_NODES ? "Nodes\n" : "Error\n");
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "OriginalPointIds: " << (this->OriginalPointIds ? "On\n" : "Off\n");
  os << indent << "NumberOfNodes: " << this->NumberOfNodes << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "Error: " << this->Error << "\n";
}
