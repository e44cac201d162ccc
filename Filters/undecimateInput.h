// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateInput.h
/// @brief What a decimator of Core sees of a vtkPolyData.

#ifndef undecimateInput_h
#define undecimateInput_h

#include "undecimateArrays.h"

#include "types.h"

#include <functional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace undecimate
{
namespace filters
{

/// Numbers of faces that are not triangles.
struct OtherFaces
{
  vtkIdType quads = 0;
  vtkIdType polygons = 0; ///< five points and more
  vtkIdType slivers = 0;  ///< fewer than three points: no face at all
  vtkIdType strips = 0;

  bool any() const { return this->quads + this->polygons + this->slivers + this->strips > 0; }

  /// "3 quads and 1 triangle strip"
  std::string describe() const;
};

OtherFaces countOtherFaces(vtkPolyData* mesh);

/// The mesh with each quad, polygon and triangle strip cut into triangles, which inherit its cell
/// data; vertex cells and lines as they are. Faces of fewer than three points and polygons that
/// cannot be triangulated are dropped.
/// @param cancelled asked now and then; when true the result is null
/// @param[out] dropped number of faces that gave no triangle
vtkSmartPointer<vtkPolyData> triangulated(
  vtkPolyData* mesh, const std::function<bool()>& cancelled, vtkIdType& dropped);

/// What is wrong with the lengths of a mesh's arrays; empty if nothing.
std::string checkSizes(vtkPolyData* mesh);

/// What is wrong with the points of a mesh's polygons and strips; empty if nothing.
std::string checkFaces(vtkPolyData* mesh);

/// "1 point", "3 points"
std::string counted(vtkIdType number, const std::string& word);

/// What is wrong with cells that were read; empty if nothing.
std::string badFace(const FaceCells& cells, vtkIdType pointCount);

/// Nodes that must stay: those of vertex cells and lines, which no level changes, and ghosts, which
/// are another piece's.
/// @param mesh its faces were checked
/// @param[out] keep a flag for each point; empty if all may go
/// @return what is wrong, or an empty string
std::string readKept(vtkPolyData* mesh, std::vector<unsigned char>& keep);

/// Take the word POINTS from the front of a list of point arrays: ParaView's Python names arrays of
/// other filters as ['POINTS', name]. It stays if there is such an array.
void dropAssociation(vtkPolyData* mesh, std::vector<std::string>& names);

/// Find a point array that steers; an empty name stands for the active point scalars.
/// @param[out] array numbers of 1 to 9 components
/// @return what is wrong, or an empty string
std::string findSteeringArray(vtkPolyData* mesh, const std::string& name, vtkDataArray*& array);

/// The mesh as Core's decimators of triangles want it. Points and arrays that fit are used where
/// they lie.
class MeshInput
{
public:
  /// @param mesh faces are triangles
  /// @return what is wrong, or an empty string
  std::string read(vtkPolyData* mesh);

  /// Add a point array that steers, by name; an empty name stands for the active point scalars.
  /// @return what is wrong, or an empty string
  std::string addArray(vtkPolyData* mesh, const std::string& name);

  const TriangleMeshView& view() const { return this->view_; }
  const std::vector<NodalArrayView>& arrays() const { return this->arrays_; }

private:
  void readPoints(vtkPolyData* mesh);

  TriangleMeshView view_;
  std::vector<NodalArrayView> arrays_;
  std::vector<Index> triangles_;
  std::vector<unsigned char> keep_;
  std::vector<double> coordinates_;
  std::vector<std::vector<float>> values_;
};

} // namespace filters
} // namespace undecimate

#endif
