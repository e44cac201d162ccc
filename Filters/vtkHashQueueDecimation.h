// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * @class   vtkHashQueueDecimation
 * @brief   remove nodes of a triangle mesh one by one, reversibly
 *
 * vtkHashQueueDecimation takes a vtkPolyData of triangles with any point and cell data, and gives
 * the coarsest level of a progressive mesh: a triangle mesh whose points are some of the input's,
 * with their exact coordinates and point data. The field data of output port 0, the progressive
 * mesh, has a record of all removals, from which vtkUndecimation makes any level in between, and
 * the input itself, bit for bit. Output port 1, the coarse mesh, is the same mesh without the
 * record: for showing the mesh where field data costs, as when a ParaView server sends it to the
 * client.
 *
 * A node is removed by replacing the triangles around it by a triangulation of the hole. The next
 * node is the one whose removal costs least; a queue of intervals finds it in constant time, and
 * within an interval the node that waits longest goes first, which spreads the removals. The cost
 * is the Criterion: the distance between the surfaces and the change of nodal results (Deviation),
 * or one of the two criteria of the paper. A removal that would flip a triangle, or make an edge or
 * a triangle that exists, is not done. So at every level each edge has at most two triangles if the
 * input's has.
 *
 * The hash queue and the record are those of
 * S. Krivograd, G. Hren, B. Zalik, A. Jezernik: A Fast Triangular-Mesh Decimation-and-Undecimation
 * Algorithm for Transferring FEM Results via the Web, Journal of Mechanical Engineering 49 (2003).
 * Differences: the default criterion Deviation, which measures both surfaces; several
 * triangulations of the hole are tried with it; the default spacing of the intervals is
 * logarithmic.
 *
 * Output arrays: all point arrays of the input, of the same types, at the points that are left, and
 * all cell arrays, each triangle with the values of the input triangle whose place it took. On
 * request the point array `vtkOriginalPointIds` (vtkIdTypeArray, 1 component): the number of each
 * point in the input; an array of the input of that name gives way to it. Field data is passed on,
 * but for the record of an earlier decimation. Added (port 0) are the field data arrays of the
 * record, whose names all start with "Undecimation."; they survive saving in VTK's XML formats. The
 * points are in the order of the input.
 *
 * Other cells and unusual input: vertex cells and lines are passed along at all levels and their
 * nodes are kept; a warning counts them. Quads, polygons and triangle strips are an error unless
 * Triangulate is on. Degenerate and repeated triangles, non-manifold edges, nodes where surfaces
 * touch, unused points and points with a coordinate that is not a number are kept at all levels.
 * Nodes of ghost cells and ghost points are kept. Empty input gives empty output.
 *
 * @section Execution Model
 * Each execution decimates anew; nothing is kept between executions but the results that the
 * getters tell. A composite input is decimated block by block, and the getters then tell sums over
 * the blocks, the largest error and all reasons. When the input comes in several pieces, the
 * boundary nodes of each are kept, so that the pieces fit together.
 *
 * An aborted execution gives empty output (of a composite with VTK 9.1 and 9.2: at the blocks that
 * were not done), and the next update executes again; before that, VTK 9.3 and later want
 * AbortExecuteOff().
 *
 * What a warning tells about the input (cells that are passed along, cut or left out) is said once,
 * and again when something upstream, OriginalPointIds or Triangulate was changed; not at each time
 * step.
 *
 * @warning
 * A piece has at most 2^31 - 1 points and triangle corners.
 *
 * @warning
 * A filter that changes the output's points, cells or arrays makes the record useless:
 * vtkUndecimation refuses it. Apply such filters to the output of vtkUndecimation.
 *
 * @sa
 * vtkUndecimation vtkTriangleFilter vtkQuadricDecimation vtkDecimatePro
 */

#ifndef vtkHashQueueDecimation_h
#define vtkHashQueueDecimation_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"            // for the return value of PrepareMesh
#include "vtkUndecimateFiltersModule.h" // for the export macro

#include <memory> // for std::unique_ptr

namespace undecimate
{
struct HashQueueDecimationResult;
}

class VTKUNDECIMATEFILTERS_EXPORT vtkHashQueueDecimation : public vtkPolyDataAlgorithm
{
public:
  static vtkHashQueueDecimation* New();
  vtkTypeMacro(vtkHashQueueDecimation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Fraction of the input's triangles to remove, in [0, 1]. 1 removes as many nodes as the mesh
   * allows. Of this and the other limits the one that is reached first counts. Default is 0.9.
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
   * Stop when this many triangles are left; 0 is no limit. Default is 0.
   */
  vtkSetClampMacro(TargetTriangles, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(TargetTriangles, vtkIdType);
  ///@}

  ///@{
  /**
   * No removal with a larger error is made. In the unit of the criterion: a fraction of the
   * diagonal of the bounding box (Deviation) or of the array's range (Scalar Difference), where 1
   * or more is no limit, or degrees (Angle to XY Plane), where 90 is no limit, and so is exactly 1,
   * being the default. At least 0. Default is 1.
   */
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
  ///@}

  enum OutputPort
  {
    PROGRESSIVE_MESH = 0, ///< with the record in its field data
    COARSE_MESH = 1       ///< without
  };

  enum CriterionType
  {
    DEVIATION = 0,
    SCALAR_DIFFERENCE = 1,
    ANGLE_TO_XY_PLANE = 2
  };

  ///@{
  /**
   * What the removal of a node costs. DEVIATION: the distance between the original surface and the
   * new one as a fraction of the diagonal of the bounding box, or the error of the arrays in
   * Scalars times ScalarWeight, whichever is larger. SCALAR_DIFFERENCE: the mean difference of the
   * node's value to its neighbours' as a fraction of the array's range. ANGLE_TO_XY_PLANE: the mean
   * angle of the node's edges to the plane z = 0, in degrees. Default is DEVIATION.
   */
  vtkSetClampMacro(Criterion, int, DEVIATION, ANGLE_TO_XY_PLANE);
  vtkGetMacro(Criterion, int);
  void SetCriterionToDeviation() { this->SetCriterion(DEVIATION); }
  void SetCriterionToScalarDifference() { this->SetCriterion(SCALAR_DIFFERENCE); }
  void SetCriterionToAngleToXYPlane() { this->SetCriterion(ANGLE_TO_XY_PLANE); }
  ///@}

  ///@{
  /**
   * Names of the point arrays that steer the decimation, of numbers with 1 to 9 components (vectors
   * are compared by the length of their difference). SCALAR_DIFFERENCE uses the first one, or the
   * active point scalars when none is named; DEVIATION uses all. A name is added once. A first name
   * POINTS, as in ParaView's ['POINTS', 'stress'], is passed over unless there is such an array.
   * Default is none.
   */
  void AddScalars(const char* name);
  void ClearScalars();
  int GetNumberOfScalars();
  const char* GetScalars(int index);
  ///@}

  ///@{
  /**
   * With DEVIATION an error of an array in Scalars, as a fraction of the array's range, counts as
   * the deviation of this weight times the fraction. 0 is geometry only; at least 0. Default is
   * 0.1.
   */
  vtkSetClampMacro(ScalarWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ScalarWeight, double);
  ///@}

  enum IntervalSpacingType
  {
    LOGARITHMIC = 0,
    EXPONENTIAL = 1
  };

  ///@{
  /**
   * Bounds of the queue's intervals. LOGARITHMIC: each is 0.8 % wider than the one before, for
   * errors of all magnitudes. EXPONENTIAL: equations 2 and 3 of the paper. Default is LOGARITHMIC.
   */
  vtkSetClampMacro(IntervalSpacing, int, LOGARITHMIC, EXPONENTIAL);
  vtkGetMacro(IntervalSpacing, int);
  void SetIntervalSpacingToLogarithmic() { this->SetIntervalSpacing(LOGARITHMIC); }
  void SetIntervalSpacingToExponential() { this->SetIntervalSpacing(EXPONENTIAL); }
  ///@}

  ///@{
  /**
   * Mean number of nodes in an interval, for EXPONENTIAL only: k of equation 1 of the paper. More
   * than 0. Default is 4.
   */
  vtkSetClampMacro(IntervalNodes, double, 1e-3, VTK_DOUBLE_MAX);
  vtkGetMacro(IntervalNodes, double);
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
   * Cut quads, polygons and triangle strips of the input into triangles, which inherit their cell
   * data. Level 1 is then the triangulated input. Default is off: such cells are an error.
   */
  virtual void SetTriangulate(vtkTypeBool on);
  vtkGetMacro(Triangulate, vtkTypeBool);
  vtkBooleanMacro(Triangulate, vtkTypeBool);
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
   * Results of the last execution: nodes and triangles of the input and of the output, the error
   * of the output in the unit of the criterion, and what stopped the decimation ("target
   * reduction", ...). Of this process only when there are several.
   */
  vtkGetMacro(NumberOfInputNodes, vtkIdType);
  vtkGetMacro(NumberOfInputTriangles, vtkIdType);
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
  vtkHashQueueDecimation();
  ~vtkHashQueueDecimation() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  // The constructor gives these the defaults of the core's options.
  double TargetReduction;
  vtkIdType TargetNodes;
  vtkIdType TargetTriangles;
  double MaximumError;
  int Criterion;
  double ScalarWeight;
  int IntervalSpacing;
  double IntervalNodes;
  vtkTypeBool PreserveBoundary;
  vtkTypeBool Triangulate = 0;
  vtkTypeBool OriginalPointIds = 0;

  vtkIdType NumberOfInputNodes = 0;
  vtkIdType NumberOfInputTriangles = 0;
  vtkIdType NumberOfNodes = 0;
  vtkIdType NumberOfTriangles = 0;
  double Error = 0.0;

private:
  vtkHashQueueDecimation(const vtkHashQueueDecimation&) = delete;
  void operator=(const vtkHashQueueDecimation&) = delete;

  void ClearResults();
  vtkSmartPointer<vtkPolyData> PrepareMesh(vtkPolyData* input);
  bool Decimate(vtkPolyData* mesh, bool pieces, undecimate::HashQueueDecimationResult& result);
  void FillOutput(
    vtkPolyData* mesh, const undecimate::HashQueueDecimationResult& result, vtkPolyData* output);

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
