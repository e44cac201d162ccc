// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimatePass.h
/// @brief Where an execution of a filter starts, over one input or all blocks of a composite.

#ifndef undecimatePass_h
#define undecimatePass_h

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkCompositeDataSet.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"

namespace undecimate
{
namespace filters
{

/// Tells the first request of an execution from those of a composite's blocks.
///
/// The executive wraps each execution, and within that of a composite the one of each block,
/// between the request REQUEST_DATA_NOT_GENERATED and the event EndEvent: this counts the open
/// brackets.
class PipelinePass
{
public:
  /// Hear the algorithm's EndEvent. Once, in its constructor.
  void watch(vtkAlgorithm* algorithm)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(this);
    command->SetCallback(
      [](vtkObject*, unsigned long, void* self, void*)
      {
        PipelinePass* pass = static_cast<PipelinePass*>(self);
        pass->depth_ -= pass->depth_ > 0;
      });
    algorithm->AddObserver(vtkCommand::EndEvent, command);
  }

  /// For ProcessRequest(): whether the request starts an execution.
  /// @param inputs of the first port
  bool starts(vtkInformation* request, vtkInformationVector* inputs)
  {
    if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_NOT_GENERATED()))
    {
      return false;
    }
    // A composite is never a block of another.
    if (vtkCompositeDataSet::GetData(inputs))
    {
      this->depth_ = 0;
    }
    return this->depth_++ == 0;
  }

private:
  int depth_ = 0;
};

} // namespace filters
} // namespace undecimate

#endif
