// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * @class   vtkTriQuadDecimation
 * @brief   remove nodes of a mesh of triangles and quads that moves over time, reversibly
 *
 * vtkTriQuadDecimation takes a vtkPolyData of triangles and quads with any point and cell data,
 * with or without time steps, and gives the coarsest level of a progressive mesh: a mesh whose
 * points are some of the input's, with their exact coordinates and point data at each time step.
 * The topology is the same at all time steps. The field data of output port 0, the progressive
 * mesh, has a record of all removals, from which vtkUndecimation makes any level in between, and
 * the input itself, bit for bit. Output port 1, the coarse mesh, is the same mesh without the
 * record.
 *
 * A node is removed by moving all cells around it to a neighbour: triangles that have both vanish,
 * quads that have both become triangles, and all other quads stay quads. A removal that would make
 * the mesh invalid is not done: P1*, P2 and P3 of
 * S. Wundrak, T. Henn, A. Stork: Dynamic Progressive Triangle-Quadrilateral Meshes, WSCG 2006.
 * Nor is one that would flip or fold a cell at a time step that counts. The next node is the one
 * whose removal costs least over these time steps.
 *
 * Where three or more surfaces meet (T joints), and between parts, nodes go only along the joint or
 * border, in all surfaces at once, so that nothing comes apart.
 *
 * Output arrays: all point arrays of the input at the points that are left and all cell arrays,
 * each cell with the values of the input cell in whose place it is; of the same types, and of the
 * time step that is asked for. On request the point array `vtkOriginalPointIds` (vtkIdTypeArray, 1
 * component): the number of each point in the input; an array of the input of that name gives way
 * to it. Field data is passed on, but for the record of an earlier decimation. Added (port 0) are
 * the field data arrays of the record, whose names all start with "Undecimation.". The points are
 * in the order of the input.
 *
 * Other cells and unusual input: vertex cells and lines are passed along and their nodes are kept.
 * Polygons of five points and more, faces of fewer than three, and triangle strips are an error.
 * Degenerate and repeated cells, unused points and cells with a coordinate that is not a number at
 * any of the time steps stay with their nodes. Nodes of ghost cells and ghost points are kept.
 * Empty input gives empty output.
 *
 * @section Execution Model
 * If the input has time steps, the first execution asks for those that the choice of steps needs,
 * one after the other, and keeps nothing of them but positions in single precision (and the arrays
 * in Scalars): of all steps, or of three. Later executions, for other times, only ask for that time
 * and hand out its places and values; the decimation runs again when the filter or something
 * upstream is modified. An input whose points or cells are not the same at all times is an error
 * that tells the first difference. An aborted execution gives empty output. A composite input is
 * decimated block by block if it has no more than one time step. When the input comes in several
 * pieces, the boundary nodes of each are kept.
 *
 * @warning
 * A filter that changes the output's points, cells or arrays makes the record useless:
 * vtkUndecimation refuses it. Apply such filters, vtkWarpVector among them, to the output of
 * vtkUndecimation.
 *
 * @sa
 * vtkUndecimation vtkHashQueueDecimation
 */

#ifndef vtkTriQuadDecimation_h
#define vtkTriQuadDecimation_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkUndecimateFiltersModule.h" // for the export macro

#include <memory> // for std::unique_ptr

class VTKUNDECIMATEFILTERS_EXPORT vtkTriQuadDecimation : public vtkPolyDataAlgorithm
{
public:
  static vtkTriQuadDecimation* New();
  vtkTypeMacro(vtkTriQuadDecimation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputPort
  {
    PROGRESSIVE_MESH = 0, ///< with the record in its field data
    COARSE_MESH = 1       ///< without
  };

  ///@{
  /**
   * Fraction of the input's nodes to remove, in [0, 1]. 1 removes as many nodes as the mesh allows.
   * Of this and the other limits the one that is reached first counts. Default is 0.9.
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
   * No removal with a larger error is made. A fraction of the diagonal of the bounding box at the
   * first time step that counts; 1 or more is no limit. At least 0. Default is 1.
   */
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
  ///@}

  enum CriterionType
  {
    DEVIATION = 0,
    QUADRICS = 1
  };

  ///@{
  /**
   * What the removal of a node costs. DEVIATION: the distance of all nodes removed so far to the
   * new cells, or the error of the arrays in Scalars times ScalarWeight, whichever is larger.
   * QUADRICS: the quadric error of the paper; faster and less accurate. Default is DEVIATION.
   */
  vtkSetClampMacro(Criterion, int, DEVIATION, QUADRICS);
  vtkGetMacro(Criterion, int);
  void SetCriterionToDeviation() { this->SetCriterion(DEVIATION); }
  void SetCriterionToQuadrics() { this->SetCriterion(QUADRICS); }
  ///@}

  enum TimeErrorType
  {
    MAXIMUM = 0,
    SUM = 1
  };

  ///@{
  /**
   * How the errors at the time steps become one: the largest (MAXIMUM, method 1* of the paper) or
   * the root of their mean square (SUM, method 1). Default is MAXIMUM.
   */
  vtkSetClampMacro(TimeError, int, MAXIMUM, SUM);
  vtkGetMacro(TimeError, int);
  void SetTimeErrorToMaximum() { this->SetTimeError(MAXIMUM); }
  void SetTimeErrorToSum() { this->SetTimeError(SUM); }
  ///@}

  enum StepChoiceType
  {
    ALL = 0,
    THREE = 1,
    LIST = 2,
    AUTOMATIC = 3
  };

  ///@{
  /**
   * The time steps that count. ALL; THREE: the first, the last, and the one between with the
   * largest displacement from the nearer of them; LIST: those of AddSteps(); AUTOMATIC: the fewest
   * for which the error over all steps is about StepFactor times, at most, what it is with all.
   * Default is ALL.
   */
  vtkSetClampMacro(StepChoice, int, ALL, AUTOMATIC);
  vtkGetMacro(StepChoice, int);
  void SetStepChoiceToAll() { this->SetStepChoice(ALL); }
  void SetStepChoiceToThree() { this->SetStepChoice(THREE); }
  void SetStepChoiceToList() { this->SetStepChoice(LIST); }
  void SetStepChoiceToAutomatic() { this->SetStepChoice(AUTOMATIC); }
  ///@}

  ///@{
  /**
   * Numbers of time steps for LIST, from 0. A step is added once. Default is none, which is an
   * error with LIST.
   */
  void AddSteps(int step);
  void ClearSteps();
  int GetNumberOfSteps();
  int GetSteps(int index);
  ///@}

  ///@{
  /**
   * For AUTOMATIC: how much larger the error may be than with all steps. At least 1. Default
   * is 1.1.
   */
  vtkSetClampMacro(StepFactor, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(StepFactor, double);
  ///@}

  ///@{
  /**
   * Name of a point array of three components that is added to the points for measuring: for meshes
   * whose points stay in place and that Warp By Vector deforms afterwards. Null, empty and "None"
   * are none. Default is none.
   */
  vtkSetStringMacro(Displacement);
  vtkGetStringMacro(Displacement);
  ///@}

  ///@{
  /**
   * Names of the point arrays that steer the decimation with DEVIATION, of numbers with 1 to 9
   * components (vectors are compared by the length of their difference). A name is added once. A
   * first name POINTS is passed over unless there is such an array. Default is none.
   */
  void AddScalars(const char* name);
  void ClearScalars();
  int GetNumberOfScalars();
  const char* GetScalars(int index);
  ///@}

  ///@{
  /**
   * With DEVIATION an error of an array in Scalars, as a fraction of the array's range over all
   * steps that count, counts as the deviation of this weight times the fraction. 0 is geometry
   * only; at least 0. Default is 0.1.
   */
  vtkSetClampMacro(ScalarWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ScalarWeight, double);
  ///@}

  ///@{
  /**
   * What a quad that becomes a triangle counts, as a fraction of the diagonal: with a larger weight
   * quads stay longer. At least 0. Default is 0.
   */
  vtkSetClampMacro(QuadWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(QuadWeight, double);
  ///@}

  ///@{
  /**
   * Keep all nodes of boundary edges. Default is off: they go along the boundary, and their removal
   * costs the distance to the new boundary.
   */
  vtkSetMacro(PreserveBoundary, vtkTypeBool);
  vtkGetMacro(PreserveBoundary, vtkTypeBool);
  vtkBooleanMacro(PreserveBoundary, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Name of a cell array of one component, numbers or strings: borders between cells of different
   * values stay lines, and nodes on them go only along them. Passed over if the input has no such
   * array. Empty or null is none. Default is "part".
   */
  vtkSetStringMacro(PartArray);
  vtkGetStringMacro(PartArray);
  ///@}

  ///@{
  /**
   * Add the point array `vtkOriginalPointIds` to the output. Default is off.
   */
  vtkSetMacro(OriginalPointIds, vtkTypeBool);
  vtkGetMacro(OriginalPointIds, vtkTypeBool);
  vtkBooleanMacro(OriginalPointIds, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Results of the last decimation: nodes and cells of the input, nodes, triangles and quads of the
   * output, its error as a fraction of the diagonal, what stopped the decimation ("target
   * reduction", ...), and the numbers of the time steps that counted ("0, 15, 30"; empty without
   * time). Of this process only when there are several; sums over the blocks of a composite.
   */
  vtkGetMacro(NumberOfInputNodes, vtkIdType);
  vtkGetMacro(NumberOfInputCells, vtkIdType);
  vtkGetMacro(NumberOfNodes, vtkIdType);
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfQuads, vtkIdType);
  vtkGetMacro(Error, double);
  const char* GetStopReason();
  const char* GetUsedSteps();
  ///@}

  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector, int requestFromOutputPort, vtkMTimeType* mtime) override;
  int ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkTriQuadDecimation();
  ~vtkTriQuadDecimation() override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  double TargetReduction = 0.9;
  vtkIdType TargetNodes = 0;
  double MaximumError = 1.0;
  int Criterion = DEVIATION;
  int TimeError = MAXIMUM;
  int StepChoice = ALL;
  double StepFactor = 1.1;
  char* Displacement = nullptr;
  double ScalarWeight = 0.1;
  double QuadWeight = 0.0;
  vtkTypeBool PreserveBoundary = 0;
  char* PartArray = nullptr;
  vtkTypeBool OriginalPointIds = 0;

  vtkIdType NumberOfInputNodes = 0;
  vtkIdType NumberOfInputCells = 0;
  vtkIdType NumberOfNodes = 0;
  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfQuads = 0;
  double Error = 0.0;

private:
  vtkTriQuadDecimation(const vtkTriQuadDecimation&) = delete;
  void operator=(const vtkTriQuadDecimation&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
