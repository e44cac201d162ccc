// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimatePass.h
/// @brief One execution of a filter, over one input or all blocks of a composite: where it starts,
/// its progress, and whether it was aborted.

#ifndef undecimatePass_h
#define undecimatePass_h

#include "undecimateCompatibility.h"

#include "monitor.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataSet.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <utility>

namespace undecimate
{
namespace filters
{

/// Tells the first request of an execution from those of a composite's blocks, and keeps an abort
/// until the last block.
///
/// The executive asks a filter for the data of a composite, and within that for those of each
/// block. It computes the pipeline's modification time once, at the beginning of each update, and
/// not for the blocks: so a mesh that is asked for after a composite is one of its blocks unless an
/// update has begun in between.
class PipelinePass
{
public:
  explicit PipelinePass(vtkAlgorithm* algorithm)
    : algorithm_(algorithm)
  {
  }

  /// For ComputePipelineMTime(). To the executive, what an aborted execution left is up to date: so
  /// the filter counts as modified then, and the update that begins executes it again.
  void beginUpdate()
  {
    this->inBlocks_ = false;
    if (std::exchange(this->aborted_, false))
    {
      this->algorithm_->Modified();
    }
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
    const bool composite = vtkCompositeDataSet::GetData(inputs) != nullptr;
    if (this->inBlocks_ && !composite)
    {
      return false;
    }
    this->inBlocks_ = composite;
    this->aborted_ = false;
    return true;
  }

  /// Whether this execution was aborted. VTK 9.1 forgets an abort at the next block.
  bool aborted()
  {
    this->aborted_ = this->aborted_ || checkAbort(this->algorithm_, 0);
    return this->aborted_;
  }

  /// Whether the mesh at hand is a block of a composite.
  bool inBlocks() const { return this->inBlocks_; }

  vtkAlgorithm* algorithm() const { return this->algorithm_; }

private:
  vtkAlgorithm* algorithm_;
  bool inBlocks_ = false;
  bool aborted_ = false;
};

/// Whether an output is asked for in several pieces. Whichever one it is: all must fit the
/// neighbouring pieces.
inline bool isInPieces(vtkInformationVector* outputs)
{
  bool pieces = false;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    pieces = pieces ||
      outputs->GetInformationObject(port)->Get(
        vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  }
  return pieces;
}

/// Passes progress from the core to an algorithm, and its abort to the core, for one part of the
/// work after the other.
class PassMonitor
{
public:
  explicit PassMonitor(PipelinePass& pass)
    : monitor_(
        [this, &pass](double fraction)
        {
          pass.algorithm()->UpdateProgress(this->begin_ + (this->end_ - this->begin_) * fraction);
          return !pass.aborted();
        })
  {
  }
  PassMonitor(const PassMonitor&) = delete;
  PassMonitor& operator=(const PassMonitor&) = delete;

  /// The monitor of the next part, from where the last one ended to the fraction `end` of the
  /// whole.
  Monitor& part(double end)
  {
    this->begin_ = this->end_;
    this->end_ = end;
    return this->monitor_;
  }

  /// Where the last part ended.
  double reached() const { return this->end_; }

  bool cancelled() const { return this->monitor_.cancelled(); }

private:
  double begin_ = 0.0;
  double end_ = 0.0;
  Monitor monitor_;
};

} // namespace filters
} // namespace undecimate

#endif
