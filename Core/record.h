// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file record.h
/// @brief The record of a decimation: what each step replaced, in the order in which it is undone.
///
/// A step removes one node: the cells around it (a patch) are replaced by fewer cells, which take
/// the slots of the old ones. The record is topology only; positions and nodal values are never
/// changed. It does not say who wrote it: node removal, half-edge collapse and mixed meshes all
/// write steps of this form.
///
/// **Triangles and quads.** Records of triangle meshes have three corners a cell; those of mixed
/// meshes have four, of which a triangle leaves the last one empty: kNone, in shapes kNoLocal. A
/// quad may become a triangle in its slot, so there a step may keep the number of cells.
///
/// **Record order.** Nodes and cell slots are renumbered so that *every level is a prefix*: first
/// the nodes (slots) of the coarsest level in their original order, then those that the steps bring
/// back, in the order in which they come. Step j (0 <= j < stepCount) brings back node
/// baseNodeCount + j. So the points of a level are the first baseNodeCount + k of all points, its
/// cells the first of all slots, and a level is handed out by copying prefixes. `nodeOrder` and
/// `cellOrder` lead back to the original numbers. (With codes and sources the latter is what the
/// steps lead to: at the finest level each cell shows its own values.)
///
/// **A step** is a form and a patch. The *form* says which corners of the patch's old and new cells
/// are the same node. The *patch* is the slots of the new cells, then the nodes that no new cell
/// has (only when the form says so). The remaining old cells have the slots just behind the end of
/// the coarser level. All other nodes are found by reading the cells themselves, in either
/// direction.
///
/// **Steps** are kept in one of two ways, the same for all steps of a record:
///   *codes*   form and patch in a few bits, see hole_code.h: node removal from triangles
///   *shapes*  corners in numbers local to the patch (0 = the removed node), equal shapes once: all
///             kinds of steps, and the triangles of older files
///
/// Source: [K03] S. Krivograd, G. Hren, B. Zalik, A. Jezernik: A Fast Triangular-Mesh
/// Decimation-and-Undecimation Algorithm for Transferring FEM Results via the Web, Journal of
/// Mechanical Engineering 49 (2003), section 2 and fig. 6 (two lists at each removed node: removed
/// cells and new cells). Kept here as forms, which needs a third of the memory of the lists.
///
/// Memory: 16 bytes a removed node (error 4, original numbers 12), and the codes: with two million
/// triangles 12 to 15 bytes, or 38 with an order that ignores the mesh such as Angle to XY Plane on
/// a fine grid, where a step has eleven new cells. Sources take 6 bytes, or 13 there, and save the
/// 8 of the cells' original numbers. A record with shapes takes 4 bytes for each new cell, 4 for
/// the shape, and the table of shapes.

#ifndef UNDECIMATE_CORE_RECORD_H
#define UNDECIMATE_CORE_RECORD_H

#include "monitor.h"
#include "packed_numbers.h"
#include "threads.h"
#include "types.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace undecimate
{

/// Largest number of old cells in a step; nodes with more cells are kept until they have fewer.
constexpr int kMaximumPatchCells = 64;

/// Largest number of other nodes in a step: quads have two of their own each.
constexpr int kMaximumRing = 3 * kMaximumPatchCells;

/// In shapes, the empty corner of a triangle among cells of four corners.
constexpr unsigned char kNoLocal = 255;

/// A record as flat arrays in somebody's memory (see the file comment for their meaning).
///
/// Codes: the code of each step from hole_code.h, step after step, and kPackedPadding bytes 0
/// behind them. With b = numberBits(), the codes of lost sources are, step after step and for each
/// old cell that no new cell takes its values from:
///   1 bit, 0, and b bits    the original cell whose values it shows, or
///   1 bit, 1, and w bits    the place of an old cell that shows the same: one with heirs, or one
///                           before this one. Where there is one, this form is used. (w:
///                           hole_code.h)
/// and kPackedPadding bytes 0.
///
/// The table of shapes: shape s is the bytes [shapeOffsets[s], shapeOffsets[s + 1]) of `shapes`:
///   old, new, extra                  numbers of old cells, new cells, nodes listed in the patch
///   old * cornersPerCell bytes       local corners of the old cells; the first `new` of them have
///                                    the slots that the patch lists
///   new * cornersPerCell bytes       local corners of the new cells
///   new bytes, if hasSources         which old cell (0..old-1) each new cell takes its values from
/// Local number 0 is the removed node, 1.. the other nodes of the patch. The last `extra` local
/// numbers are those that no new cell has.
struct RecordView
{
  Index nodeCount = 0;     ///< of the finest level
  Index cellCount = 0;     ///< of the finest level
  Index baseNodeCount = 0; ///< of the coarsest level
  Index baseCellCount = 0; ///< of the coarsest level
  Index stepCount = 0;     ///< nodeCount - baseNodeCount
  Index shapeCount = 0;
  int cornersPerCell = 3;  ///< 3, or 4 in meshes that have quads
  bool hasCodes = false;   ///< the steps have codes, else shapes; codes have 3 corners a cell
  bool hasSources = false; ///< the source of each cell's values is recorded

  const Index* nodeOrder = nullptr;  ///< nodeCount: original number of a node
  const Index* cellOrder = nullptr;  ///< cellCount unless the steps say it (stepsOrderCells()):
                                     ///< original number of a slot's cell
  const float* stepErrors = nullptr; ///< stepCount, never increasing: error before step j is undone
  const unsigned char* stepHoles = nullptr; ///< stepCount if hasCodes, see hole_code.h
  const unsigned char* codes = nullptr;     ///< codeSize bytes if hasCodes
  const Index* patches = nullptr;           ///< patchSize unless hasCodes, as the next three:
                                            ///< slots and listed nodes, step after step
  const Index* stepShapes = nullptr;        ///< stepCount
  const Index* shapeOffsets = nullptr;      ///< shapeCount + 1
  const unsigned char* shapes = nullptr;    ///< shapeOffsets[shapeCount] bytes
  const Index* baseSources = nullptr;       ///< baseCellCount if hasSources: original cell number
  const Index* lostSources = nullptr;       ///< lostSourceSize if hasSources unless hasCodes:
                                            ///< original cells, of old cells without heir
  const unsigned char* lostSourceCodes = nullptr; ///< lostCodeSize bytes if both: the same
  std::int64_t codeSize = 0;
  std::int64_t patchSize = 0;
  std::int64_t lostSourceSize = 0;
  std::int64_t lostCodeSize = 0;

  /// Whether there is no `cellOrder`: with codes and sources it is the sources at the finest level.
  bool stepsOrderCells() const { return this->hasCodes && this->hasSources; }

  /// Bits of a number of a node or a cell, where numbers are packed.
  int numberBits() const { return bitsBelow(std::max(this->nodeCount, this->cellCount)); }
};

/// A record that owns its arrays.
struct Record
{
  Index nodeCount = 0;
  Index cellCount = 0;
  Index baseNodeCount = 0;
  Index baseCellCount = 0;
  int cornersPerCell = 3;
  bool hasCodes = false;
  bool hasSources = false;

  std::vector<Index> nodeOrder;
  std::vector<Index> cellOrder; ///< empty if the steps say it
  std::vector<float> stepErrors;
  std::vector<unsigned char> stepHoles;
  std::vector<unsigned char> codes;
  std::vector<Index> patches;
  std::vector<Index> stepShapes;
  std::vector<Index> shapeOffsets{ 0 };
  std::vector<unsigned char> shapes;
  std::vector<Index> baseSources;
  std::vector<Index> lostSources;
  std::vector<unsigned char> lostSourceCodes;

  RecordView view() const;

  /// Bytes of all arrays.
  std::size_t byteSize() const;
};

/// Check that a record can be walked without ever leaving its arrays or those of the mesh, whatever
/// its bytes are: counts, ranges, forms, order of the errors, permutations. Not the codes of lost
/// sources, nor whether the steps fit together: these show on the way (Undecimation::open()).
/// @param baseCells cornersPerCell * baseCellCount node numbers in record order
/// @param progress of this call, and cancel
/// @return InvalidRecord with the array and the entry that is wrong, Cancelled or Ok
/// Complexity: O(record).
Outcome validateRecord(const RecordView& record, const Index* baseCells,
  const MonitorShare& progress = MonitorShare(nullptr));

/// Written by a decimator, step by step, in original numbers; finish() turns it into record order.
/// The steps get shapes.
class RecordBuilder
{
public:
  /// @param trackSources also record from which original cell each new cell takes its values;
  /// without, a cell has those of the cell whose slot it has
  /// @param plannedSteps room for so many is set aside; more or fewer are right, too
  /// @param cornersPerCell 3 or 4
  RecordBuilder(Index nodeCount, Index cellCount, bool trackSources, Index plannedSteps = 0,
    int cornersPerCell = 3);
  ~RecordBuilder();

  /// One step. Cells are given by the positions of their corners in the ring of the node: 0 is the
  /// node itself, i + 1 the node ring[i].
  struct Step
  {
    Index node = kNone;                      ///< the removed node
    const Index* ring = nullptr;             ///< ringSize nodes of the patch, original numbers
    int ringSize = 0;                        ///< at most kMaximumRing
    int oldCount = 0;                        ///< 1 .. kMaximumPatchCells
    int newCount = 0;                        ///< < oldCount; with four corners <= oldCount
    const Index* slots = nullptr;            ///< oldCount; the new cells take the first newCount
    const unsigned char* oldCells = nullptr; ///< cornersPerCell * oldCount, as the corners stand in
                                             ///< the slots; kNoLocal last in a triangle
    const unsigned char* newCells = nullptr; ///< cornersPerCell * newCount
    const unsigned char* sources =
      nullptr;          ///< newCount, if tracked: old cell whose values it takes
    double error = 0.0; ///< of this step; the record keeps the largest so far
  };
  /// @throw std::length_error if the table of shapes would pass 2^31 - 1 bytes
  void append(const Step& step);

  /// Steps so far.
  Index stepCount() const;

  /// Largest error so far.
  double error() const;

  /// Renumber everything to record order. The builder is empty afterwards.
  /// @param[in] cornersOf void(cell, corners): the cornersPerCell corners of a cell as the last
  /// step left them (original numbers); it is asked for the cells that are left
  /// @param[out] baseCells the cells of the coarsest level, in record order
  /// @param threads to share the work out among, or null; the result is the same
  /// Complexity: O(nodes + cells + record), in place but for the two orders.
  using CornersOf = std::function<void(Index cell, Index* corners)>;
  Record finish(
    const CornersOf& cornersOf, std::vector<Index>& baseCells, Threads* threads = nullptr);

private:
  template <int Corners>
  void appendCells(const Step& step);

  struct Internals;
  std::unique_ptr<Internals> internals_;
};

} // namespace undecimate

#endif
