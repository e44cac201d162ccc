// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * @class   vtkProgressiveMeshDecimation
 * @brief   superclass of the filters that remove nodes of a mesh reversibly
 *
 * vtkProgressiveMeshDecimation has what the decimations share: limits, arrays that steer, both
 * outputs and the results. A decimation gives the coarsest level of a progressive mesh: a mesh
 * whose points are some of the input's, with their exact coordinates and point data, in the order
 * of the input. The field data of output port 0, the progressive mesh, has a record of all
 * removals, from which vtkUndecimation makes any level in between, and the input itself, bit for
 * bit. Output port 1, the coarse mesh, is the same mesh without the record: for showing the mesh
 * where field data costs, as when a ParaView server sends it to the client.
 *
 * Output arrays: all point arrays of the input, of the same types, at the points that are left, and
 * all cell arrays, each cell with the values of the input cell in whose place it is. On request the
 * point array `vtkOriginalPointIds` (vtkIdTypeArray, 1 component): the number of each point in the
 * input; an array of the input of that name gives way to it. Field data is passed on, but for the
 * record of an earlier decimation. Added (port 0) are the field data arrays of the record, whose
 * names all start with "Undecimation."; they survive saving in VTK's XML formats.
 *
 * Vertex cells and lines are passed along at all levels and their nodes are kept; a warning counts
 * them. Nodes of ghost cells and ghost points are kept. When the input comes in several pieces, the
 * boundary nodes of each are kept, so that the pieces fit together. Empty input gives empty output.
 *
 * What a warning tells about the input is said once, and again when something upstream or a
 * property that it has to do with was changed; not at each time step.
 *
 * An aborted execution gives empty output (of a composite with VTK 9.1 and 9.2: at the blocks that
 * were not done), and the next update executes again; before that, VTK 9.3 and later want
 * AbortExecuteOff().
 *
 * @sa
 * vtkHashQueueDecimation vtkTriQuadDecimation vtkUndecimation
 */

#ifndef vtkProgressiveMeshDecimation_h
#define vtkProgressiveMeshDecimation_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"            // for the return value of PrepareMesh
#include "vtkUndecimateFiltersModule.h" // for the export macro

#include <memory> // for std::unique_ptr
#include <string> // for names and messages
#include <vector> // for lists of them

namespace undecimate
{
struct Record;
namespace filters
{
class PipelinePass;
}
}

class VTKUNDECIMATEFILTERS_EXPORT vtkProgressiveMeshDecimation : public vtkPolyDataAlgorithm
{
public:
  vtkAbstractTypeMacro(vtkProgressiveMeshDecimation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputPort
  {
    PROGRESSIVE_MESH = 0, ///< with the record in its field data
    COARSE_MESH = 1       ///< without
  };

  ///@{
  /**
   * Fraction to remove, in [0, 1]: of the input's triangles (vtkHashQueueDecimation) or nodes
   * (vtkTriQuadDecimation). 1 removes as many nodes as the mesh allows. Of this and the other
   * limits the one that is reached first counts. Default is 0.9.
   */
  vtkSetClampMacro(TargetReduction, double, 0.0, 1.0);
  vtkGetMacro(TargetReduction, double);
  ///@}

  ///@{
  /**
   * Stop when this many nodes are left; 0 is no limit. Default is 0.
   */
  vtkSetClampMacro(TargetNodes, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(TargetNodes, vtkIdType);
  ///@}

  ///@{
  /**
   * No removal with a larger error is made. In the unit of the criterion: a fraction of the
   * diagonal of the bounding box (at the first time step that counts) or of an array's range, where
   * 1 or more is no limit, or degrees (Angle to XY Plane), where 90 is no limit, and so is exactly
   * 1, being the default. At least 0. Default is 1.
   */
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
  ///@}

  ///@{
  /**
   * Names of the point arrays that steer the decimation, of numbers with 1 to 9 components (vectors
   * are compared by the length of their difference). The criterion tells which of them it uses. A
   * name is added once. A first name POINTS, as in ParaView's ['POINTS', 'stress'], is passed over
   * unless there is such an array. Default is none.
   */
  void AddScalars(const char* name);
  void ClearScalars();
  int GetNumberOfScalars();
  const char* GetScalars(int index);
  ///@}

  ///@{
  /**
   * With the criterion Deviation an error of an array in Scalars, as a fraction of the array's
   * range (over all time steps that count), counts as the deviation of this weight times the
   * fraction. 0 is geometry only; at least 0. Default is 0.055 (vtkHashQueueDecimation) or 0.1
   * (vtkTriQuadDecimation).
   */
  vtkSetClampMacro(ScalarWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ScalarWeight, double);
  ///@}

  ///@{
  /**
   * Keep all nodes of boundary edges. Default is off: their removal costs the distance to the new
   * boundary.
   */
  vtkSetMacro(PreserveBoundary, vtkTypeBool);
  vtkGetMacro(PreserveBoundary, vtkTypeBool);
  vtkBooleanMacro(PreserveBoundary, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Add the point array `vtkOriginalPointIds` to the output. Default is off.
   */
  virtual void SetOriginalPointIds(vtkTypeBool on);
  vtkGetMacro(OriginalPointIds, vtkTypeBool);
  vtkBooleanMacro(OriginalPointIds, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Number of threads of the decimation, where it uses several: vtkTriQuadDecimation always,
   * vtkHashQueueDecimation with Parallel. The result does not depend on it. 0 is as many as
   * vtkSMPTools uses, or as many as the machine has cores where vtkSMPTools was built without
   * threads. Default is 0.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Results of the last decimation: nodes of the input, nodes and triangles of the output, its
   * error in the unit of the criterion, and what stopped the decimation ("target reduction", ...).
   * Of a composite sums over the blocks, the largest error and all reasons; of this process only
   * when there are several.
   */
  vtkGetMacro(NumberOfInputNodes, vtkIdType);
  vtkGetMacro(NumberOfNodes, vtkIdType);
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(Error, double);
  const char* GetStopReason();
  ///@}

  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector, int requestFromOutputPort, vtkMTimeType* mtime) override;
  int ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkProgressiveMeshDecimation();
  ~vtkProgressiveMeshDecimation() override;

  /// Calls MakeOutputs(), and turns what it throws into error messages and empty outputs.
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  /// Fill both outputs for one mesh. False if aborted; throws undecimate::filters::BrokenRequest
  /// for a request that cannot be met.
  virtual bool MakeOutputs(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) = 0;

  /// An execution begins, of one mesh or of all blocks of a composite.
  virtual void StartPass() { this->ClearResults(); }

  virtual void ClearResults();

  /// Count a block's results.
  void AddResults(
    const undecimate::Record& record, vtkIdType triangles, double error, const char* stopReason);

  /// The input with points, without an array of the name that OriginalPointIds adds.
  vtkSmartPointer<vtkPolyData> PrepareMesh(vtkPolyData* input);

  /// A warning about the input that is said once.
  /// @param about what tells it from other warnings
  void WarnOnce(const char* about, const std::string& text);
  void ForgetWarnings();

  undecimate::filters::PipelinePass& GetPass();
  const std::vector<std::string>& GetScalarNames() const;

  /// A MaximumError that is no limit: a fraction of 1, which is less awkward to show than infinity.
  static constexpr double NoErrorLimit = 1.0;

  /// Take the defaults from the options of the core.
  template <class Options>
  void SetDefaults(const Options& defaults)
  {
    this->TargetReduction = defaults.targetReduction;
    this->TargetNodes = defaults.targetNodes;
    this->MaximumError =
      defaults.maximumError < NoErrorLimit ? defaults.maximumError : NoErrorLimit;
    this->ScalarWeight = defaults.scalarWeight;
    this->PreserveBoundary = defaults.preserveBoundary;
    this->NumberOfThreads = defaults.threads;
  }

  /// Give the core what the properties say; MaximumError is the subclass's.
  /// @param pieces the input is one of several pieces
  template <class Options>
  void GetOptions(bool pieces, Options& options)
  {
    options.targetReduction = this->TargetReduction;
    options.targetNodes = this->TargetNodes;
    options.scalarWeight = this->ScalarWeight;
    options.preserveBoundary = this->PreserveBoundary || pieces;
    options.threads = this->GetThreadsToUse();
  }

  /// NumberOfThreads, or what 0 stands for.
  int GetThreadsToUse() const;

  // The subclass calls SetDefaults().
  double TargetReduction;
  vtkIdType TargetNodes;
  double MaximumError;
  double ScalarWeight;
  vtkTypeBool PreserveBoundary;
  vtkTypeBool OriginalPointIds = 0;
  int NumberOfThreads;

  vtkIdType NumberOfInputNodes = 0;
  vtkIdType NumberOfNodes = 0;
  vtkIdType NumberOfTriangles = 0;
  double Error = 0.0;

private:
  vtkProgressiveMeshDecimation(const vtkProgressiveMeshDecimation&) = delete;
  void operator=(const vtkProgressiveMeshDecimation&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
