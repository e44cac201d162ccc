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
 * One that would flip or fold a cell at a time step that counts is not done with QUADRICS; with
 * DEVIATION a node that has no other way may go so, and half of the cell's longest edge counts as
 * an error. The next node is the one whose removal costs least over these time steps.
 *
 * Where three or more surfaces meet (T joints), and between parts, nodes go only along the joint or
 * border, in all surfaces at once, so that nothing comes apart.
 *
 * Output arrays: all point and cell arrays of the input, of the same types, with the values of the
 * time step that is asked for; on request the point array `vtkOriginalPointIds`; at port 0 the
 * field data arrays of the record, whose names start with "Undecimation.".
 * vtkProgressiveMeshDecimation says more.
 *
 * Unusual input: polygons of five points and more, faces of fewer than three, and triangle strips
 * are an error. Degenerate and repeated cells, unused points and cells with a coordinate that is
 * not a number at any of the time steps stay with their nodes. Vertex cells and lines are passed
 * along, and their nodes are kept.
 *
 * @section Execution Model
 * If the input has time steps, the first execution asks for those that the choice of steps needs,
 * one after the other, and keeps nothing of them but positions in single precision (and the arrays
 * in Scalars): of all steps, or of three. Later executions, for other times, only ask for that time
 * and hand out its places and values; the decimation runs again when the filter or something
 * upstream is modified. An input whose points or cells are not the same at all times is an error
 * that tells the first difference. A composite input is decimated block by block if it has no more
 * than one time step.
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

#include "vtkProgressiveMeshDecimation.h"
#include "vtkUndecimateFiltersModule.h" // for the export macro

#include <memory> // for std::unique_ptr
#include <vector> // for lists of times

class VTKUNDECIMATEFILTERS_EXPORT vtkTriQuadDecimation : public vtkProgressiveMeshDecimation
{
public:
  static vtkTriQuadDecimation* New();
  vtkTypeMacro(vtkTriQuadDecimation, vtkProgressiveMeshDecimation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

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
   * What a quad that becomes a triangle counts, as a fraction of the diagonal: with a larger weight
   * quads stay longer. At least 0. Default is 0.
   */
  vtkSetClampMacro(QuadWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(QuadWeight, double);
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
   * More results of the last decimation: cells of the input, quads of the output, and the numbers
   * of the time steps that counted ("0, 15, 30"; empty without time).
   */
  vtkGetMacro(NumberOfInputCells, vtkIdType);
  vtkGetMacro(NumberOfQuads, vtkIdType);
  const char* GetUsedSteps();
  ///@}

protected:
  vtkTriQuadDecimation();
  ~vtkTriQuadDecimation() override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  bool MakeOutputs(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void StartPass() override;
  void ClearResults() override;

  // The constructor gives these the defaults of the core's options.
  int Criterion;
  int TimeError;
  double QuadWeight;
  int StepChoice = ALL;
  double StepFactor = 1.1;
  char* Displacement = nullptr;
  char* PartArray = nullptr;

  vtkIdType NumberOfInputCells = 0;
  vtkIdType NumberOfQuads = 0;

private:
  vtkTriQuadDecimation(const vtkTriQuadDecimation&) = delete;
  void operator=(const vtkTriQuadDecimation&) = delete;

  bool AddStep(
    vtkPolyData* mesh, const std::vector<double>& times, vtkInformationVector* outputVector);
  bool Decimate(vtkPolyData* mesh, bool pieces, bool withTime);
  void HandOut(
    vtkPolyData* mesh, const std::vector<double>& times, vtkInformationVector* outputVector);

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
