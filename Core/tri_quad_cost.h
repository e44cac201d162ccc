// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file tri_quad_cost.h
/// @brief Where a node goes best in a mesh of triangles and quads, and what that costs.
///
/// See tri_quad_decimation.h for what the criteria measure. A collapse folds if a cell that changes
/// would turn too far, become a needle, or, as a quad, get a corner that points inwards, at any of
/// the time steps. A node that has no other way may go so, and half of the cell's longest edge
/// counts as an error at these steps.

#ifndef UNDECIMATE_CORE_TRI_QUAD_COST_H
#define UNDECIMATE_CORE_TRI_QUAD_COST_H

#include "time_lanes.h"
#include "tri_quad_decimation.h"
#include "tri_quad_topology.h"

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace undecimate
{

/// A node with all cells around it, in numbers local to the patch, and where it goes.
///
/// Local number 0 is the node, i + 1 the node ring[i], kNoLocal the empty corner of a triangle.
struct TriQuadPatch
{
  /// Copies of a node that may go together; others stay.
  static constexpr int kMaximumFans = 8;

  Index node = kNone;
  int fanCount = 0;
  std::array<Fan, kMaximumFans> fans;
  int cellCount = 0;
  int ringSize = 0;
  std::array<Index, kMaximumRing> ring;                               // nodes
  std::array<Index, kMaximumPatchCells> slots;                        // fan after fan
  std::array<unsigned char, kMaximumPatchCells> fanOf;                // of a cell
  std::array<std::array<unsigned char, 4>, kMaximumPatchCells> cells; // local corners

  /// The two nodes beside it on the boundary or seam; local numbers, 0 in the interior.
  unsigned char line[2] = { 0, 0 };

  unsigned char target = 0; ///< local number of the node that it goes to
  double error = 0.0;       ///< of the step, as a fraction of the diagonal
  bool folds = false;       ///< a cell, for no neighbour is there that it does not
  int removedCount = 0;     ///< copies that lie in its cells; Deviation only
  double cost = 0.0;        ///< with the weight of the quads: what the queue goes by

  /// The copies of the target, one for each fan.
  std::array<Index, kMaximumFans> targetCopies;

  /// The cell that a removed copy lies in.
  struct Home
  {
    Index copy;
    Index slot;
  };
  std::vector<Home> homes;    ///< once the node has gone: see TriQuadCost::findHomes()
  std::vector<float> squares; ///< of the errors, of each lane; Deviation only

  /// A cell after the node has gone to a target.
  /// @param[out] corners local numbers, kNoLocal where there is none
  /// @return number of corners; 0 if the cell vanishes
  int newCell(int cell, unsigned char to, std::array<unsigned char, 4>& corners) const;

  /// Quads that become triangles then.
  int quadsLost(unsigned char to) const;

  /// Whether cells of two sheets get the same nodes then.
  bool hasTwins(unsigned char to) const;
};

class TriQuadCost
{
public:
  /// @param mesh what the topology was made of
  /// @param kept nodes that are never removed; those whose cells have a node without a finite
  /// position or value are added
  TriQuadCost(const TriQuadMeshView& mesh, TriQuadTopology& topology, const TimeRows& positions,
    const TriQuadDecimationOptions& options, std::vector<unsigned char>& kept);

  /// For another thread: with the same mesh, quadrics and removed nodes, and scratch of its own.
  /// All may evaluate at the same time, but not while one takes note of a collapse.
  TriQuadCost forThread() const { return *this; }

  enum class Effort
  {
    Estimate, ///< Deviation of the neighbour that is best by the quadrics, without the way back;
              ///< of a node that folds what the folds count
    Full      ///< of several neighbours, with the distance from the new cells to the original ones
  };

  /// Find where a node goes best. Full effort right behind an estimate of the patch goes on there.
  /// @param effort Full is for Deviation only; the Quadrics know no other than Estimate
  /// @return false if it cannot go anywhere; the patch is then not to be used
  /// It reads cells, quadrics and removed nodes at the node and its ring only, and how many nodes
  /// are left in the components of its copies.
  bool evaluate(Index node, Effort effort, TriQuadPatch& patch);

  /// Whether the full effort is worth it for a patch that was estimated: not with Quadrics, and not
  /// as long as few nodes were removed from it and nothing folds.
  bool hasMore(const TriQuadPatch& patch) const;

  /// Find the cells that the removed copies of an evaluated patch will lie in. Deviation only.
  void findHomes(TriQuadPatch& patch);

  /// Take note that the collapse of a patch with homes is made. Call before the topology changes.
  void collapsed(const TriQuadPatch& patch);

  /// Distance of the removed nodes to the cells that they lie in now, the largest at each step of
  /// some positions; empty unless the criterion is Deviation.
  std::vector<double> distances(const TimeRows& positions) const;

  /// Largest error at each step so far; empty unless the criterion is Deviation.
  std::vector<double> stepErrors() const;

  void prefetch(Index node) const;

private:
  const float* position(int local) const
  {
    return this->relative_.data() + std::size_t{ 3 } * this->lanes_ * local;
  }
  float* quadric(Index node)
  {
    return this->shared_->quadrics.data() + std::size_t{ kQuadricRows } * this->lanes_ * node;
  }
  void buildQuadrics();
  bool gather(Index node, TriQuadPatch& patch);
  void gatherRows(const TriQuadPatch& patch);
  void gatherRemoved(const TriQuadPatch& patch);
  bool findLine(TriQuadPatch& patch) const;
  void rankTargets(const TriQuadPatch& patch);
  bool mayGo(TriQuadPatch& patch, unsigned char target);
  bool isAllowed(TriQuadPatch& patch, unsigned char target);
  bool findFirstTarget(Index node, TriQuadPatch& patch);
  template <typename Use>
  bool forChangedCells(const TriQuadPatch& patch, unsigned char target, Use&& use) const;
  bool keepsCells(const TriQuadPatch& patch, unsigned char target) const;
  void measureFolds(const TriQuadPatch& patch, unsigned char target);
  void rankFolds(TriQuadPatch& patch);
  void addQuadrics(const TriQuadPatch& patch, unsigned char target);
  double combine(const float* squares) const;
  double quadricError(const TriQuadPatch& patch, unsigned char target);
  void measure(const TriQuadPatch& patch, unsigned char target);
  void addOldCells(const TriQuadPatch& patch);
  void addNewCells(const TriQuadPatch& patch, unsigned char target);
  bool isTooFar() const;
  void measureLine(const TriQuadPatch& patch, unsigned char target);
  void measureNewEdges(const TriQuadPatch& patch, unsigned char target);
  template <typename Use>
  void forNewEdges(const TriQuadPatch& patch, unsigned char target, Use&& use) const;
  void findOriginals();
  void measureBack(const TriQuadPatch& patch, unsigned char target);
  void measureHalfwayBack(const float* corner);
  void measureSampleBack(const float* point);
  Index nodeOfPlace(int place) const;
  int originalNumber(Index cell);
  void addOriginals(Index node);
  void measureOriginal(int number, const float* point);

  // Cells of the patch, cut into triangles: quads around their centers.
  struct Triangles
  {
    std::vector<std::array<int, 3>> corners; // local numbers; kCenters + i is center i
    std::vector<int> firsts;                 // first triangle of each cell, and the end
    std::vector<bool> ready;                 // whether a cell is prepared
    std::vector<float> prepared;             // for distances
    std::vector<float> centers;
    std::vector<float> centerValues; // of all arrays
    int centerCount = 0;

    void clear();
  };
  static constexpr int kCenters = 256;
  void addCell(const unsigned char* cell, Triangles& triangles);
  const float* preparedCell(Triangles& triangles, int cell);
  const float* cornerPosition(const Triangles& triangles, int corner) const;
  const float* cornerValues(const Triangles& triangles, int corner, std::size_t array) const;
  void measurePoint(
    Triangles& triangles, int beginCell, int endCell, int firstCell, const float* point);
  void measureNode(int beginCell, int endCell, const float* point, Index node);
  int homeOf(int beginCell, int endCell, const float* point);
  // New cells of a fan: places in the patch.
  struct NewCells
  {
    int begin;
    int end;
    bool vanish; // all of them
  };
  NewCells newCellsOf(const TriQuadPatch& patch, int fan) const;
  void measureRemoved(const TriQuadPatch& patch, unsigned char target);
  Index cellBehind(const TriQuadPatch& patch, int fan, unsigned char target) const;
  Index firstOnLine(Index a, Index b) const;

  TriQuadTopology& topology_;
  const TimeRows& positions_;
  const TriQuadDecimationOptions& options_;
  const std::vector<unsigned char>& kept_;
  int lanes_;
  bool moves_; // more than one step
  const TriQuadMeshView& mesh_;
  std::vector<float> arrayScales_;
  std::vector<int> arrayOffsets_; // first row of each array among all, and the end

  // What the threads have in common.
  struct Shared
  {
    LargeArray<float, 3> quadrics; // of each node: kQuadricRows rows

    // Removed copies: a list for each cell, and one of nodes for each boundary edge (by its ends).
    std::vector<Index> firstRemoved; // of a slot
    std::vector<Index> nextRemoved;  // of a copy
    std::vector<Index> nextOnLine;   // of a node
    std::unordered_map<std::uint64_t, Index> lines;
    std::vector<float> worst; // square at each lane, largest of all collapses

    // The numbers of the input's cells around each node.
    LargeArray<Index, 0> firstOriginal; // of a node, in originalsOf; and the end
    LargeArray<Index, 1> originalsOf;
  };
  std::shared_ptr<Shared> shared_;

  // The patch at hand.
  const TriQuadPatch* patch_ = nullptr;
  std::vector<float> relative_; // positions less the node's, by local number; then removed_
  struct Removed
  {
    Index copy;
    int cell; // that it lies in: place in the patch
  };
  std::vector<Removed> removed_;
  struct Target
  {
    unsigned char local;
    double rank;
  };
  std::array<Target, kMaximumRing> targets_;
  int targetCount_ = 0;
  int firstTarget_ = 0;                     // that is allowed
  const TriQuadPatch* estimated_ = nullptr; // the patch at hand, if it can be measured further
  Triangles oldTriangles_;
  Triangles newTriangles_;
  std::vector<LaneValues> laneValues_;
  std::vector<float> point_;
  std::vector<float> middle_;
  std::vector<float> nearest_;
  std::vector<float> cellNearest_;
  std::vector<float> errors_;
  std::vector<float> squares_; // largest over all samples
  double limit_ = 0.0;         // of the error: a target beyond it is not measured to the end
  // For the way back to the original cells.
  std::vector<int> nearestPlaces_; // at each step
  struct Original
  {
    Index cell;
    std::uint32_t sample; // that it was near last
    bool ready;           // prepared
  };
  std::vector<Original> originals_;      // those that were near the patch
  std::array<int, 256> originalSlots_{}; // where one may be, by the lowest digits
  std::vector<int> nearestOriginals_;    // numbers in originals_
  std::vector<float> cellRows_;          // corners and center of one
  std::vector<float> preparedRows_;      // triangles of originals_
  std::uint32_t sample_ = 0;
};

} // namespace undecimate

#endif
