// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * @class   vtkUndecimation
 * @brief   bring removed nodes back: any level between a decimated mesh and the original
 *
 * vtkUndecimation takes the output of vtkHashQueueDecimation or vtkTriQuadDecimation (directly, or
 * saved and loaded in one of VTK's XML formats) and gives the mesh at a level: 0 is the coarse
 * mesh, 1 the original mesh. At each level the points are some of the original ones with their
 * exact coordinates and point data.
 *
 * The field data of the input holds a record of all removals. A node comes back by putting the
 * cells that were around it in the place of those that filled the hole, and goes again by the
 * reverse, as in section 2 of
 * S. Krivograd, G. Hren, B. Zalik, A. Jezernik: A Fast Triangular-Mesh Decimation-and-Undecimation
 * Algorithm for Transferring FEM Results via the Web, Journal of Mechanical Engineering 49 (2003).
 *
 * Level 1 is the input of the decimation bit for bit: the same points, cells, point and cell data,
 * in the same order, with the same types, names, active attributes and width of the cell storage.
 * At all other levels the points are in the order in which they come back, so that a point has the
 * same number at all levels below 1; each level's points are the first of the next finer level's.
 *
 * Output arrays: the point and cell arrays of the input of the decimation, of the same types. Below
 * level 1 each triangle has the cell data of one original triangle in whose place it is. On request
 * the point array `vtkOriginalPointIds` (vtkIdTypeArray, 1 component): the number of each point in
 * the original mesh; an array of that name gives way to it. Field data is passed on, but for the
 * record. Vertex cells and lines are the same at all levels.
 *
 * @section Execution Model
 * The record is decoded once for each input object and its modification time, and the filter stands
 * at the level that it gave last. A change of the level then costs time proportional to the change,
 * and the copying of the output's arrays; nothing upstream runs again. A change of the time step of
 * a mesh from vtkTriQuadDecimation costs the new places and values: the steps share their record.
 * Several inputs stay decoded: all blocks of a composite, and inputs that take turns (at least 8).
 * When the level stays the same, the output's arrays stay the same objects. With a composite input
 * the getters tell sums over the blocks and the largest error.
 *
 * Progress is reported, and an abort is heard, while a record is decoded, while the level changes
 * and after each array. An aborted execution gives empty output (of a composite with VTK 9.1 and
 * 9.2: at the blocks that were not done), and the next update executes again; before that, VTK 9.3
 * and later want AbortExecuteOff().
 *
 * @warning
 * An input whose points, cells or arrays were changed since the decimation is refused, and the
 * error message says what was changed. Field data may be added freely.
 *
 * @warning
 * The decoded record and the last output stay in memory as long as the filter and its input: about
 * 12 bytes a triangle of the original mesh and the size of the output; once level 1 was shown, also
 * that mesh. Memory that an earlier output gave back is kept for the next execution, and freed if
 * that does not need it.
 *
 * @sa
 * vtkHashQueueDecimation vtkTriQuadDecimation
 */

#ifndef vtkUndecimation_h
#define vtkUndecimation_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkUndecimateFiltersModule.h" // for the export macro

#include <memory> // for std::unique_ptr

class VTKUNDECIMATEFILTERS_EXPORT vtkUndecimation : public vtkPolyDataAlgorithm
{
public:
  static vtkUndecimation* New();
  vtkTypeMacro(vtkUndecimation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Fraction of the removed nodes that are back, in [0, 1]: 0 is the coarse mesh, 1 the original.
   * Used when LevelBy is BY_NODES. Default is 0.
   */
  vtkSetClampMacro(Level, double, 0.0, 1.0);
  vtkGetMacro(Level, double);
  ///@}

  enum LevelByType
  {
    BY_NODES = 0,
    BY_ERROR = 1
  };

  ///@{
  /**
   * What chooses the level: Level (BY_NODES) or MaximumError (BY_ERROR). Default is BY_NODES.
   */
  vtkSetClampMacro(LevelBy, int, BY_NODES, BY_ERROR);
  vtkGetMacro(LevelBy, int);
  void SetLevelByToNodes() { this->SetLevelBy(BY_NODES); }
  void SetLevelByToError() { this->SetLevelBy(BY_ERROR); }
  ///@}

  ///@{
  /**
   * With BY_ERROR: the coarsest level whose error is at most this. In the unit of the criterion of
   * the decimation (a fraction of the diagonal of the bounding box for Deviation). At least 0; 0 is
   * the coarsest level without error. Default is 0.
   */
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
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
   * Results of the last execution: nodes, triangles and quads of the output and its error as the
   * record has it, in the unit of the criterion of the decimation. Of this process only when there
   * are several.
   */
  vtkGetMacro(NumberOfNodes, vtkIdType);
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfQuads, vtkIdType);
  vtkGetMacro(Error, double);
  ///@}

  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector, int requestFromOutputPort, vtkMTimeType* mtime) override;
  int ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkUndecimation();
  ~vtkUndecimation() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  double Level = 0.0;
  int LevelBy = BY_NODES;
  double MaximumError = 0.0;
  vtkTypeBool OriginalPointIds = 0;

  vtkIdType NumberOfNodes = 0;
  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfQuads = 0;
  double Error = 0.0;

private:
  vtkUndecimation(const vtkUndecimation&) = delete;
  void operator=(const vtkUndecimation&) = delete;

  void ClearResults();

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
