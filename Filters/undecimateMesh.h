// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateMesh.h
/// @brief The levels of one coarse mesh with its record, and a cache of several of them.

#ifndef undecimateMesh_h
#define undecimateMesh_h

#include "undecimateMemory.h"
#include "undecimatePass.h"
#include "undecimateRecordFields.h"

#include "undecimation.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <list>
#include <memory>
#include <string>

class vtkCellArray;
class vtkPolyData;

namespace undecimate
{
namespace filters
{

/// A coarse mesh whose record is decoded: hands out the mesh at any level.
///
/// Between calls it stands at the last level, so a change costs the steps between and the copy of
/// the output. Below level 1 points and triangles are in record order: a node has the same number
/// at all these levels. At level 1 they are in the order of the original mesh.
///
/// Between time steps that share a record only places and values change: the cursor stays where it
/// is, and so do the cells.
///
/// Memory: the cursor (12 bytes a triangle; 16 bytes a cell in meshes with quads), the mesh handed
/// out last, and once level 1 was asked for, the original mesh.
class UndecimatedMesh
{
public:
  /// Decode the record in the field data of `coarse`. If it shares its arrays with the record that
  /// is open, as another time step does, only its places and values are read.
  /// @param monitor its next parts; if it cancels, the mesh must not be used
  /// @return what is wrong and what to do, or an empty string
  std::string open(vtkPolyData* coarse, PassMonitor& monitor);

  /// The cursor; show() moves it.
  const Undecimation& cursor() const { return this->cursor_; }

  /// Put the mesh at a level into `output`: points, cells, point and cell data; no field data.
  /// Arrays are shared between calls that ask for the same level.
  /// @param coarse the mesh that was opened, unchanged
  /// @param steps removed nodes that are back, 0 to cursor().stepCount()
  /// @param memory of the arrays
  /// @param monitor its next parts, to the end
  /// @return false if it was cancelled: nothing was put into `output`, and any level may be next
  bool show(vtkPolyData* coarse, Index steps, vtkPolyData* output, ArrayMemory& memory,
    PassMonitor& monitor);

  /// Quads of the level shown last.
  vtkIdType numberOfQuads() const;

  /// Original number of each point of the level shown last: array kOriginalPointIds.
  ArrayPointer originalPointIds() const;

private:
  bool atLevelOne() const { return this->cursor_.steps() == this->cursor_.stepCount(); }
  vtkSmartPointer<vtkPolyData> prefix(vtkPolyData* coarse, ArrayMemory& memory, Monitor& monitor);
  vtkSmartPointer<vtkPolyData> original(vtkPolyData* coarse, Monitor& monitor);
  vtkSmartPointer<vtkCellArray> makeCells(
    const Index* corners, ArrayMemory* memory, vtkIdType& quads) const;

  /// Cells that stay when only the time changes.
  struct Faces
  {
    vtkSmartPointer<vtkCellArray> cells;
    vtkIdType quads = 0;
  };

  RecordFields record_;
  KnownFingerprints known_;
  Undecimation cursor_;
  bool isOpen_ = false;
  Faces shownFaces_;                      // of the cursor's level, below level 1
  Faces originalFaces_;                   // of level 1
  vtkSmartPointer<vtkPolyData> shown_;    // null at level 1
  vtkSmartPointer<vtkPolyData> original_; // made on first use
};

/// The decoded meshes of the last inputs of a filter.
///
/// The key is the input object itself and its modification time, so that neither an older object in
/// the place of a newer one nor the blocks of a composite get each other's levels. Meshes that are
/// used neither in this pass of the pipeline nor in the one before are forgotten, the least
/// recently used first, when there are more than kMaximumIdle meshes; those of deleted inputs when
/// the next pass starts.
class UndecimatedMeshCache
{
public:
  static constexpr std::size_t kMaximumIdle = 8;

  /// The filter starts a pass (over one input, or over all blocks of a composite).
  void startPass();

  /// The decoded mesh of an input; opened if need be.
  /// @param monitor its next parts, if the mesh is opened
  /// @param[out] problem why the result is null; empty if it was cancelled
  UndecimatedMesh* find(vtkPolyData* input, PassMonitor& monitor, std::string& problem);

  /// Meshes in the cache.
  std::size_t size() const { return this->entries_.size(); }

private:
  struct Entry
  {
    vtkWeakPointer<vtkPolyData> input;
    vtkMTimeType time = 0;
    vtkTypeUInt64 pass = 0;
    std::unique_ptr<UndecimatedMesh> mesh;
  };
  void forget();

  std::list<Entry> entries_; // most recently used first
  vtkTypeUInt64 pass_ = 0;
};

} // namespace filters
} // namespace undecimate

#endif
