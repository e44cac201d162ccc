// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateArrays.h
/// @brief VTK arrays and cell arrays in bulk: reordering, joining, fingerprints.
///
/// All loops run on raw pointers in our own, optimised code. Arrays whose values do not lie in one
/// block as VTK's plain arrays do (structure of arrays, variants, ...) go through InsertTuples().

#ifndef undecimateArrays_h
#define undecimateArrays_h

#include "threads.h"
#include "types.h"

#include "vtkAbstractArray.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkCellArray;
class vtkDataSetAttributes;
class vtkFieldData;

namespace undecimate
{
namespace filters
{

using ArrayPointer = vtkSmartPointer<vtkAbstractArray>;

class ArrayMemory;

/// An array that is described as `like` (type, name, component names, information and look-up
/// table), with `tuples` tuples whose values are not set.
/// @param memory where plain arrays get their memory from; null: from the system
ArrayPointer newLike(vtkAbstractArray* like, vtkIdType tuples, ArrayMemory* memory);

/// The values of an array (in the same memory where VTK can), described by `like`.
ArrayPointer share(vtkAbstractArray* values, vtkAbstractArray* like);

/// The first `leading` tuples of `from`, then tuple leading + numbers[i] for each i < count;
/// described by `like`. `memory` as for newLike().
/// @param threads to share the work out among, or null
ArrayPointer gather(vtkAbstractArray* from, vtkAbstractArray* like, vtkIdType leading,
  const Index* numbers, vtkIdType count, ArrayMemory* memory = nullptr, Threads* threads = nullptr);

/// The first `baseCount` tuples of `base`, then the first `restCount` tuples of `rest`.
/// `rest` may be null if restCount is 0. Described by `base`. `memory` as for newLike().
ArrayPointer join(vtkAbstractArray* base, vtkIdType baseCount, vtkAbstractArray* rest,
  vtkIdType restCount, ArrayMemory* memory = nullptr);

/// The tuples of join(base, baseCount, rest, restCount), tuple i at place order[i].
ArrayPointer scatter(vtkAbstractArray* base, vtkIdType baseCount, vtkAbstractArray* rest,
  vtkIdType restCount, const Index* order);

/// Add arrays[i] to `to` in place of array i of `from` (null entries are left out) and make the
/// same ones active. `to` must be empty.
void setArrays(
  vtkDataSetAttributes* to, vtkDataSetAttributes* from, const std::vector<ArrayPointer>& arrays);

/// Hash of type, components and values; not of the name. Types of the same size and kind are one
/// type, since files do not tell them apart (long and long long).
std::uint64_t fingerprint(vtkAbstractArray* array);

/// "double", "vtkStringArray", ...: for messages.
std::string typeName(vtkAbstractArray* array);

/// The names of all arrays, quoted and separated by commas, or "none".
std::string listNames(vtkFieldData* arrays);

/// Numbers of triangles, or of triangles and quads, in core's width.
struct FaceCells
{
  std::vector<Index> corners; ///< 3 or 4 a cell; of 4, kNone at the last of triangles
  vtkIdType otherCells = 0;   ///< cells of other sizes; if any, corners is not complete
  vtkIdType badCell = -1;     ///< first cell with a point that does not exist, and that point
  vtkIdType badPoint = -1;
};

/// Read cells, checking that each point number is in [0, pointCount).
/// @param cornersPerCell 3: triangles; 4: triangles and quads
/// Complexity: O(cells).
FaceCells readFaces(vtkCellArray* cells, vtkIdType pointCount, int cornersPerCell);

/// The corners of triangles where they lie, in the width of the cell array.
struct TriangleCorners
{
  const std::int32_t* narrow = nullptr;
  const std::int64_t* wide = nullptr;
};

/// The corners of the cells, unchecked, or nothing if there are none, or if other cells than
/// triangles are among them: readFaces() says more then.
TriangleCorners trianglesInPlace(vtkCellArray* cells);

/// A cell array of triangles, or of triangles and quads.
/// @param corners cornersPerCell * count point numbers; of four, kNone at the last of triangles
/// @param cornersPerCell 3 or 4
/// @param wide 64-bit storage, else 32-bit
/// @param memory as for newLike()
/// @param[out] quads number of quads
vtkSmartPointer<vtkCellArray> makeFaces(const Index* corners, int cornersPerCell, vtkIdType count,
  bool wide, ArrayMemory* memory, vtkIdType& quads);

/// The same cells with each point number p replaced by map[p]; storage width as asked.
vtkSmartPointer<vtkCellArray> mapPoints(vtkCellArray* cells, const Index* map, bool wide);

/// Add a flag to flags[p] for each point p of the cells: 1, or cellFlags[c] for each cell c that
/// has it. False if a cell has a point outside [0, flags.size()).
bool flagPoints(
  vtkCellArray* cells, std::vector<unsigned char>& flags, const unsigned char* cellFlags = nullptr);

/// Hash of the cells: sizes and point numbers, whatever the storage width.
std::uint64_t fingerprint(vtkCellArray* cells);

} // namespace filters
} // namespace undecimate

#endif
