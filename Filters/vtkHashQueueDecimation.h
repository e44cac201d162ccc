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
 * record.
 *
 * A node is removed by replacing the triangles around it by a triangulation of the hole. The next
 * node is the one whose removal costs least; a queue of intervals finds it in constant time, and
 * within an interval the node that waits longest goes first, which spreads the removals. The cost
 * is the Criterion: the distance between the surfaces and the change of nodal results (Deviation),
 * the distance to planes of the original triangles (Quadric), or one of the two criteria of the
 * paper. A removal that would flip a triangle, or make an edge or
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
 * Output arrays: all point and cell arrays of the input, of the same types; on request the point
 * array `vtkOriginalPointIds`; at port 0 the field data arrays of the record, whose names start
 * with "Undecimation.". vtkProgressiveMeshDecimation says more.
 *
 * Unusual input: quads, polygons and triangle strips are an error unless Triangulate is on.
 * Degenerate and repeated triangles, non-manifold edges, nodes where surfaces touch, unused points
 * and points with a coordinate that is not a number are kept at all levels. Vertex cells and lines
 * are passed along, and their nodes are kept.
 *
 * @section Execution Model
 * Each execution decimates anew; nothing is kept between executions but the results that the
 * getters tell. A composite input is decimated block by block.
 *
 * @warning
 * A piece has at most 2^31 - 1 points and triangle corners.
 *
 * @warning
 * A filter that changes the output's points, cells or arrays makes the record useless:
 * vtkUndecimation refuses it. Apply such filters to the output of vtkUndecimation.
 *
 * @sa
 * vtkUndecimation vtkTriQuadDecimation vtkTriangleFilter vtkQuadricDecimation vtkDecimatePro
 */

#ifndef vtkHashQueueDecimation_h
#define vtkHashQueueDecimation_h

#include "vtkProgressiveMeshDecimation.h"
#include "vtkUndecimateFiltersModule.h" // for the export macro

namespace undecimate
{
struct HashQueueDecimationResult;
}

class VTKUNDECIMATEFILTERS_EXPORT vtkHashQueueDecimation : public vtkProgressiveMeshDecimation
{
public:
  static vtkHashQueueDecimation* New();
  vtkTypeMacro(vtkHashQueueDecimation, vtkProgressiveMeshDecimation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Stop when this many triangles are left; 0 is no limit. Default is 0.
   */
  vtkSetClampMacro(TargetTriangles, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(TargetTriangles, vtkIdType);
  ///@}

  enum CriterionType
  {
    DEVIATION = 0,
    SCALAR_DIFFERENCE = 1,
    ANGLE_TO_XY_PLANE = 2,
    QUADRIC = 3
  };

  ///@{
  /**
   * What the removal of a node costs. DEVIATION: the distance between the original surface and the
   * new one as a fraction of the diagonal of the bounding box, or the error of the arrays in
   * Scalars times ScalarWeight, whichever is larger. SCALAR_DIFFERENCE: the mean difference of the
   * node's value of the first array in Scalars, or of the active point scalars when none is named,
   * to its neighbours' as a fraction of the array's range. ANGLE_TO_XY_PLANE: the mean
   * angle of the node's edges to the plane z = 0, in degrees. QUADRIC: the root of the mean squared
   * distance of the node's best neighbour to the planes of the original triangles that the node
   * stands for, as a fraction of the diagonal; fast, but a mean: it does not bound the distance.
   * Default is DEVIATION.
   */
  vtkSetClampMacro(Criterion, int, DEVIATION, QUADRIC);
  vtkGetMacro(Criterion, int);
  void SetCriterionToDeviation() { this->SetCriterion(DEVIATION); }
  void SetCriterionToScalarDifference() { this->SetCriterion(SCALAR_DIFFERENCE); }
  void SetCriterionToAngleToXYPlane() { this->SetCriterion(ANGLE_TO_XY_PLANE); }
  void SetCriterionToQuadric() { this->SetCriterion(QUADRIC); }
  ///@}

  ///@{
  /**
   * How much well-shaped triangles are worth, with DEVIATION: a node whose hole would leave a
   * degenerate triangle costs this fraction of the radius of its hole more than one whose hole is
   * filled by equilateral ones, and among the triangulations of a hole the cheapest one by that sum
   * is taken. Errors are larger then at the same number of triangles. 0 or more; about 0.01 to 0.1
   * is useful. Default is 0: shapes count among nearly equal errors only.
   */
  vtkSetClampMacro(ShapeWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ShapeWeight, double);
  ///@}

  enum IntervalSpacingType
  {
    LOGARITHMIC = 0,
    EXPONENTIAL = 1
  };

  ///@{
  /**
   * Bounds of the queue's intervals. LOGARITHMIC: each is 0.8 % wider than the one before, for
   * errors from 2^-48 to 2^16. EXPONENTIAL: equations 2 and 3 of the paper. Default is LOGARITHMIC.
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
   * Decimate by several threads (NumberOfThreads). The mesh is decimated in parts whose seams move,
   * so the result is another one than that of one thread, but about as good; it does not depend on
   * the number of threads. Meshes of a few thousand points are left to one thread. Default is off.
   */
  vtkSetMacro(Parallel, vtkTypeBool);
  vtkGetMacro(Parallel, vtkTypeBool);
  vtkBooleanMacro(Parallel, vtkTypeBool);
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

  /**
   * Result of the last execution: triangles of the input.
   */
  vtkGetMacro(NumberOfInputTriangles, vtkIdType);

protected:
  vtkHashQueueDecimation();
  ~vtkHashQueueDecimation() override;

  bool MakeOutputs(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void ClearResults() override;

  // The constructor gives these the defaults of the core's options.
  vtkIdType TargetTriangles;
  int Criterion;
  double ShapeWeight;
  int IntervalSpacing;
  double IntervalNodes;
  vtkTypeBool Parallel;
  vtkTypeBool Triangulate = 0;

  vtkIdType NumberOfInputTriangles = 0;

private:
  vtkHashQueueDecimation(const vtkHashQueueDecimation&) = delete;
  void operator=(const vtkHashQueueDecimation&) = delete;

  vtkSmartPointer<vtkPolyData> PrepareTriangles(vtkPolyData* input);
  bool Decimate(vtkPolyData* mesh, bool pieces, undecimate::HashQueueDecimationResult& result);
};

#endif
