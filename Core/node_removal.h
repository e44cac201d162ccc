// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file node_removal.h
/// @brief What the serial and the parallel hash queue decimation share: intervals, goal, steps.

#ifndef UNDECIMATE_CORE_NODE_REMOVAL_H
#define UNDECIMATE_CORE_NODE_REMOVAL_H

#include "hash_queue.h"
#include "hash_queue_decimation.h"
#include "removal_steps.h"
#include "triangle_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace undecimate
{

constexpr double kRightAngle = 90.0;

constexpr float kNoCost = -1.0F; ///< of a node that is kept or cannot be evaluated

/// The first costs of all nodes to be queued.
struct CostRange
{
  float smallest = std::numeric_limits<float>::max();
  float largest = 0.0F;
  std::int64_t count = 0;

  void add(float cost)
  {
    this->smallest = std::min(this->smallest, cost);
    this->largest = std::max(this->largest, cost);
    ++this->count;
  }
  void add(const CostRange& other)
  {
    this->smallest = std::min(this->smallest, other.smallest);
    this->largest = std::max(this->largest, other.largest);
    this->count += other.count;
  }
};

/// Intervals of either spacing.
class Intervals
{
public:
  Intervals(const HashQueueDecimationOptions& options, const CostRange& costs)
    : logarithmic_(options.intervalSpacing == IntervalSpacing::Logarithmic)
    , exponential_(0.0, 0.0, 1)
  {
    if (this->logarithmic_)
    {
      return;
    }
    // [K03] eq. 1: m = floor(n / k).
    const double count = std::floor(static_cast<double>(costs.count) / options.intervalNodes);
    this->exponential_ = ExponentialIntervals(std::min(costs.smallest, costs.largest),
      costs.largest, static_cast<Index>(std::clamp(count, 1.0, static_cast<double>(1 << 24))));
  }

  Index count() const
  {
    return this->logarithmic_ ? kLogarithmicIntervals : this->exponential_.count();
  }

  /// Where a node is looked for that costs more since a neighbour went: by so much that most nodes
  /// need not go back to the queue when their turn comes. A factor of 1.3; on a grid of 1M nodes it
  /// saves a fifth of the time.
  Index risen(Index interval) const
  {
    constexpr Index kRise = 48; // of 128 an octave
    return this->logarithmic_ ? std::min(interval + kRise, this->count() - 1) : interval;
  }

  /// Up to where a node may have risen and go all the same, where the order may be a rough one: a
  /// factor of 1.19.
  Index near(Index interval) const
  {
    constexpr Index kNear = 32; // of 128 an octave
    return this->logarithmic_ ? std::min(interval + kNear, this->count() - 1) : interval;
  }

  Index of(double cost) const
  {
    return this->logarithmic_ ? logarithmicInterval(static_cast<float>(cost))
                              : this->exponential_.interval(cost);
  }

private:
  bool logarithmic_;
  ExponentialIntervals exponential_;
};

/// Where to stop, in triangles and nodes that are left.
struct Goal
{
  Index triangles = 0;
  Index nodes = kNone; // no such goal
  StopReason triangleReason = StopReason::TargetReduction;
  double error = 0.0;
  bool isErrorOff = true;

  Goal(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options)
  {
    const double left = (1.0 - options.targetReduction) * static_cast<double>(mesh.triangleCount);
    // The rounding of 1 - 0.9 must not ask for a triangle more or less.
    this->triangles = static_cast<Index>(std::ceil(left * (1.0 - 1e-12)));
    if (options.targetTriangles > this->triangles)
    {
      this->triangles = static_cast<Index>(std::min(options.targetTriangles, mesh.triangleCount));
      this->triangleReason = StopReason::TargetTriangles;
    }
    if (options.targetNodes > 0)
    {
      this->nodes = static_cast<Index>(std::min(options.targetNodes, mesh.nodeCount));
    }
    this->error = options.criterion == Criterion::AngleToXYPlane
      ? options.maximumError / kRightAngle
      : options.maximumError;
    this->isErrorOff = std::isinf(options.maximumError);
  }

  bool isReached(Index nodesLeft, Index trianglesLeft, StopReason& reason) const
  {
    if (nodesLeft <= this->nodes)
    {
      reason = StopReason::TargetNodes;
      return true;
    }
    if (trianglesLeft <= this->triangles)
    {
      reason = this->triangleReason;
      return true;
    }
    return false;
  }

  /// Whether so many nodes are still to go that their order may be a rough one: it is exact again
  /// before the goal, and the result does not tell the difference. A maximum error can be reached
  /// any time.
  bool isFar(Index trianglesLeft) const
  {
    constexpr Index kMany = 100000;
    constexpr double kTimesTheGoal = 4.0;
    return this->isErrorOff && trianglesLeft > kMany &&
      trianglesLeft > kTimesTheGoal * this->triangles &&
      (this->nodes == kNone || trianglesLeft > 2.0 * kTimesTheGoal * this->nodes);
  }

  /// Removals up to the goal, about: one takes two triangles, or one at the boundary.
  Index plannedSteps(Index nodesLeft, Index trianglesLeft) const
  {
    constexpr Index kBoundarySteps = 1000;
    const Index planned = std::max<Index>(1, trianglesLeft - this->triangles);
    return std::min(nodesLeft - std::max<Index>(0, this->nodes), planned / 2 + kBoundarySteps);
  }
};

/// The error of a step in the unit of the criterion.
inline double errorInUnit(const HashQueueDecimationOptions& options, double error)
{
  return options.criterion == Criterion::AngleToXYPlane ? kRightAngle * error : error;
}

/// For a decimation by `options`. Deviation measures removed nodes.
inline StepWriter stepWriterFor(const HashQueueDecimationOptions& options)
{
  return StepWriter(options.trackCellSources, options.criterion == Criterion::Deviation);
}

/// A node that may go, and how.
struct Removal
{
  Hole hole;
  HoleTriangulation filling;
  double cost = 0.0;
  double error = 0.0;
};

/// The first cost of a node, as far as it can go at all, and its place in the range.
template <typename CriterionType>
void evaluateFirst(
  TriangleTopology& topology, CriterionType& criterion, Index node, CostRange& range)
{
  double cost = 0.0;
  float first = kNoCost;
  if (!topology.node(node).kept && criterion.evaluate(node, cost))
  {
    first = static_cast<float>(cost);
    range.add(first);
  }
  setFirstCost(topology.node(node), first);
}

/// What is to become of the node that a queue has handed out.
enum class Verdict
{
  Remove,
  Requeued,   ///< has grown costlier than the next ones
  AboveLimit, ///< has grown costlier than the limit
  Blocked,    ///< cannot go until a neighbour goes
  TooCostly,  ///< costs more than the maximum error
};

/// Steps 3 to 5 of [K03] 1: find the node's hole, the triangles that fill it, and their cost.
/// @param interval up to where the node may have risen since it was queued
/// @param limit the last interval that may go now
/// @param removal out: filled for Remove; its cost is known for AboveLimit, too
template <typename CriterionType, typename Queue>
Verdict tryRemoval(Index node, Index interval, Index limit, double maximumError,
  const Intervals& intervals, CriterionType& criterion, Queue& queue, Removal& removal)
{
  if (!criterion.retriangulate(node, removal.hole, removal.filling, removal.cost))
  {
    return Verdict::Blocked;
  }
  const auto compare = [&]
  {
    const Index current = intervals.of(removal.cost);
    if (current > limit)
    {
      return Verdict::AboveLimit;
    }
    if (current > interval && current > queue.lowestInterval() && !queue.empty())
    {
      queue.insert(node, current);
      return Verdict::Requeued;
    }
    return Verdict::Remove;
  };
  Verdict verdict = compare();
  removal.error = removal.cost;
  if constexpr (CriterionType::kLazy)
  {
    if (verdict == Verdict::Remove)
    {
      removal.error = criterion.confirm(removal.hole, removal.filling, removal.cost);
      verdict = removal.cost == HUGE_VAL ? Verdict::Blocked : compare();
    }
  }
  return verdict == Verdict::Remove && removal.error > maximumError ? Verdict::TooCostly : verdict;
}

} // namespace undecimate

#endif
