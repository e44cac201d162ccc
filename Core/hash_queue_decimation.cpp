// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue_decimation.h"

#include "array_range.h"
#include "cell_sources.h"
#include "deviation.h"
#include "guarded.h"
#include "mean_edge_criterion.h"
#include "quadric_criterion.h"
#include "triangle_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace undecimate
{

namespace
{

constexpr double kRightAngle = 90.0;

/// Intervals of either spacing.
class Intervals
{
public:
  Intervals(const HashQueueDecimationOptions& options, const std::vector<float>& costs)
    : logarithmic_(options.intervalSpacing == IntervalSpacing::Logarithmic)
    , exponential_(0.0, 0.0, 1)
  {
    if (this->logarithmic_)
    {
      return;
    }
    float smallest = std::numeric_limits<float>::max();
    float largest = 0.0F;
    std::int64_t queued = 0;
    for (const float cost : costs)
    {
      if (cost >= 0.0F)
      {
        smallest = std::min(smallest, cost);
        largest = std::max(largest, cost);
        ++queued;
      }
    }
    // [K03] eq. 1: m = floor(n / k).
    const double count = std::floor(static_cast<double>(queued) / options.intervalNodes);
    this->exponential_ = ExponentialIntervals(std::min(smallest, largest), largest,
      static_cast<Index>(std::clamp(count, 1.0, static_cast<double>(1 << 24))));
  }

  Index count() const
  {
    return this->logarithmic_ ? kLogarithmicIntervals : this->exponential_.count();
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
  }
};

/// The algorithm of [K03] section 1, for any criterion.
template <typename CriterionType>
class Decimation
{
public:
  Decimation(TriangleTopology& topology, CriterionType& criterion,
    const HashQueueDecimationOptions& options, const Goal& goal, Monitor& monitor)
    : topology_(topology)
    , criterion_(criterion)
    , options_(options)
    , goal_(goal)
    , monitor_(monitor)
    , nodeCount_(topology.nodeCount())
    , trianglesLeft_(topology.triangleCount())
    , nodesLeft_(this->nodeCount_)
  {
  }

  Status run(HashQueueDecimationResult& result)
  {
    // A removal takes two triangles, or one at the boundary.
    const Index planned = std::max<Index>(1, this->trianglesLeft_ - this->goal_.triangles);
    RecordBuilder builder(this->nodeCount_, this->trianglesLeft_, this->options_.trackCellSources,
      std::min(
        this->nodesLeft_ - std::max<Index>(0, this->goal_.nodes), planned / 2 + kBoundarySteps));
    // Step 1: evaluate all nodes and arrange them in the hash table.
    std::vector<float> costs;
    if (!this->evaluateAll(costs))
    {
      return Status::Cancelled;
    }
    const Intervals intervals(this->options_, costs);
    Queue queue({ &this->topology_ }, intervals.count());
    for (Index node = 0; node < this->nodeCount_; ++node)
    {
      if (costs[node] >= 0.0F)
      {
        queue.insert(node, intervals.of(costs[node]));
      }
    }
    release(costs);

    result.stopReason = StopReason::NoRemovableNode;
    bool tooCostly = false;
    for (std::uint64_t turn = 0; !this->atGoal(result.stopReason); ++turn)
    {
      if ((turn & 255) == 0 && !this->reportProgress(planned))
      {
        return Status::Cancelled;
      }
      // Step 2: the most suitable node.
      const Index interval = queue.lowestInterval();
      const Index node = queue.pop();
      if (node == kNone)
      {
        if (tooCostly)
        {
          result.stopReason = StopReason::MaximumError;
        }
        break;
      }
      this->prefetch(queue);
      // Steps 3 to 5: remove it with its triangles and triangulate the hole. A node that cannot go
      // now waits outside the queue until a neighbour goes.
      double cost = 0.0;
      if (!this->criterion_.retriangulate(node, this->hole_, this->filling_, cost))
      {
        continue;
      }
      const auto mustWait = [&]
      {
        const Index current = intervals.of(cost);
        if (current > interval && current > queue.lowestInterval() && !queue.empty())
        {
          queue.insert(node, current);
          return true;
        }
        return false;
      };
      if (mustWait())
      {
        continue;
      }
      double error = cost;
      if constexpr (CriterionType::kLazy)
      {
        error = this->criterion_.confirm(this->hole_, this->filling_, cost);
        if (cost == HUGE_VAL || mustWait()) // infinite: cannot go now
        {
          continue;
        }
      }
      if (error > this->goal_.error)
      {
        tooCostly = true;
        continue;
      }
      this->remove(builder, error);
      // Step 6: re-evaluate the neighbours; they go to the end of their interval's queue.
      this->reevaluate(queue, intervals, interval);
      // Step 7: back to step 2.
    }
    result.error = builder.error();
    this->topology_.freeNodes();
    result.record = builder.finish(
      [this](Index triangle, Index* corners)
      {
        const auto& nodes = this->topology_.triangle(triangle).nodes;
        std::copy(nodes.begin(), nodes.end(), corners);
      },
      result.baseTriangles);
    return this->monitor_.update(1.0) ? Status::Ok : Status::Cancelled;
  }

private:
  struct NodeLinks
  {
    TriangleTopology* topology;
    QueueLinks& operator()(Index node) const { return this->topology->node(node).links; }
  };
  using Queue = HashQueueOn<NodeLinks>;

  // Steps at the boundary for which the record sets room aside; it grows if there are more.
  static constexpr Index kBoundarySteps = 1000;

  static constexpr bool kIsQuadric = std::is_same_v<CriterionType, QuadricCriterion>;

  // Share of the progress that the first evaluation gets.
  static constexpr double kEvaluationShare = CriterionType::kLazy ? 0.2 : 0.05;

  bool evaluateAll(std::vector<float>& costs)
  {
    costs.assign(this->nodeCount_, -1.0F);
    for (Index node = 0; node < this->nodeCount_; ++node)
    {
      if ((node & 1023) == 0 && !this->monitor_.update(kEvaluationShare * node / this->nodeCount_))
      {
        return false;
      }
      double cost = 0.0;
      if (!this->topology_.node(node).kept && this->criterion_.evaluate(node, cost))
      {
        costs[node] = static_cast<float>(cost);
      }
    }
    return true;
  }

  bool atGoal(StopReason& reason) const
  {
    if (this->nodesLeft_ <= this->goal_.nodes)
    {
      reason = StopReason::TargetNodes;
      return true;
    }
    if (this->trianglesLeft_ <= this->goal_.triangles)
    {
      reason = this->goal_.triangleReason;
      return true;
    }
    return false;
  }

  bool reportProgress(Index planned)
  {
    const double gone = this->topology_.triangleCount() - this->trianglesLeft_;
    return this->monitor_.update(
      std::min(0.99, kEvaluationShare + (1.0 - kEvaluationShare) * gone / planned));
  }

  // The next nodes are known, and waiting for their memory would take most of the time. Each stage
  // uses what the ones before have brought.
  void prefetch(const Queue& queue) const
  {
    std::array<Index, 5> next;
    Index node = queue.front();
    for (Index& n : next)
    {
      n = node;
      node = node == kNone ? kNone : queue.upcoming(node);
    }
    if (next[4] != kNone)
    {
      this->topology_.prefetchNode(next[4]);
      if constexpr (kIsQuadric)
      {
        this->criterion_.prefetch(next[4]);
      }
    }
    if (next[3] != kNone)
    {
      this->topology_.prefetchTriangle(next[3]);
    }
    if (next[2] != kNone)
    {
      this->topology_.prefetchNeighbours(next[2]);
    }
    if (next[1] != kNone)
    {
      this->topology_.prefetchRing(next[1]);
    }
  }

  void remove(RecordBuilder& builder, double error)
  {
    const Hole& hole = this->hole_;
    const HoleTriangulation& filling = this->filling_;
    for (int i = 0; i < hole.triangleCount; ++i)
    {
      this->slots_[i] = triangleOf(hole.corners[i]);
      const int corner = cornerOf(hole.corners[i]);
      unsigned char* cell = this->oldCells_.data() + 3 * i;
      cell[corner] = 0;
      cell[nextCorner(corner)] = static_cast<unsigned char>(i + 1);
      cell[previousCorner(corner)] = static_cast<unsigned char>(i + 1 == hole.size ? 1 : i + 2);
    }
    const unsigned char* filled = filling.triangles.front().data();
    for (int i = 0; i < 3 * filling.count; ++i)
    {
      this->newCells_[i] = static_cast<unsigned char>(filled[i] + 1);
    }
    if (this->options_.trackCellSources)
    {
      findCellSources(this->topology_, hole, filling, this->sources_.data());
    }
    RecordBuilder::Step step;
    step.node = hole.node;
    step.ring = hole.ring.data();
    step.ringSize = hole.size;
    step.oldCount = hole.triangleCount;
    step.newCount = filling.count;
    step.slots = this->slots_.data();
    step.oldCells = this->oldCells_.data();
    step.newCells = this->newCells_.data();
    step.sources = this->sources_.data();
    step.error =
      this->options_.criterion == Criterion::AngleToXYPlane ? kRightAngle * error : error;
    builder.append(step);
    this->topology_.replace(hole, filling);
    this->criterion_.removed(hole, filling);
    this->trianglesLeft_ -= hole.triangleCount - filling.count;
    --this->nodesLeft_;
  }

  void reevaluate(Queue& queue, const Intervals& intervals, Index interval)
  {
    for (int i = 0; i < this->hole_.size; ++i)
    {
      const Index node = this->hole_.ring[i];
      if (this->topology_.node(node).kept)
      {
        continue;
      }
      if constexpr (kIsQuadric)
      {
        double expected = 0.0;
        if (this->criterion_.expect(node, this->hole_, expected))
        {
          queue.insert(node, intervals.of(expected));
          continue;
        }
        if (queue.contains(node))
        {
          continue;
        }
      }
      if (CriterionType::kLazy)
      {
        // Evaluated when its turn comes; one that waits outside gets a new chance.
        queue.insert(node, queue.contains(node) ? queue.interval(node) : interval);
        continue;
      }
      double cost = 0.0;
      if (this->criterion_.evaluate(node, cost))
      {
        queue.insert(node, intervals.of(cost));
      }
    }
  }

  TriangleTopology& topology_;
  CriterionType& criterion_;
  const HashQueueDecimationOptions& options_;
  const Goal& goal_;
  Monitor& monitor_;
  Index nodeCount_;
  Index trianglesLeft_;
  Index nodesLeft_;
  Hole hole_;
  HoleTriangulation filling_;
  std::array<unsigned char, kMaximumPatchCells> sources_;
  std::array<Index, kMaximumPatchCells> slots_;
  std::array<unsigned char, std::size_t{ 3 } * kMaximumPatchCells> oldCells_;
  std::array<unsigned char, std::size_t{ 3 } * kMaximumPatchCells> newCells_;
};

Outcome checkArrays(const HashQueueDecimationOptions& options)
{
  for (const NodalArrayView& array : options.arrays)
  {
    if (!array.values || array.components < 1 || array.components > kMaximumComponents)
    {
      return { Status::InvalidArgument,
        "Nodal array '" + array.name + "' has " + std::to_string(array.components) +
          " components; 1 to " + std::to_string(kMaximumComponents) + " can steer." };
    }
  }
  if (options.criterion == Criterion::ScalarDifference && options.arrays.empty())
  {
    return { Status::InvalidArgument, "The criterion Scalar Difference needs a nodal array." };
  }
  return {};
}

Outcome checkOptions(const HashQueueDecimationOptions& options)
{
  const auto invalid = [](const char* name, double value, const char* range) -> Outcome
  {
    return { Status::InvalidArgument,
      std::string(name) + " is " + std::to_string(value) + "; it must be " + range + "." };
  };
  if (!(options.targetReduction >= 0.0 && options.targetReduction <= 1.0))
  {
    return invalid("TargetReduction", options.targetReduction, "from 0 to 1");
  }
  if (!(options.maximumError >= 0.0))
  {
    return invalid("MaximumError", options.maximumError, "0 or more");
  }
  if (!(options.intervalNodes > 0.0))
  {
    return invalid("IntervalNodes", options.intervalNodes, "more than 0");
  }
  if (!(options.scalarWeight >= 0.0) || !std::isfinite(options.scalarWeight))
  {
    return invalid("ScalarWeight", options.scalarWeight, "0 or more, and finite");
  }
  if (options.targetNodes < 0)
  {
    return invalid("TargetNodes", static_cast<double>(options.targetNodes), "0 or more");
  }
  if (options.targetTriangles < 0)
  {
    return invalid("TargetTriangles", static_cast<double>(options.targetTriangles), "0 or more");
  }
  return checkArrays(options);
}

Outcome checkMesh(const TriangleMeshView& mesh)
{
  constexpr std::int64_t kLimit = std::numeric_limits<Index>::max();
  if (mesh.nodeCount > kLimit || mesh.triangleCount > kLimit / 4)
  {
    return { Status::TooLarge,
      "The mesh has " + std::to_string(mesh.nodeCount) + " nodes and " +
        std::to_string(mesh.triangleCount) + " triangles; at most " + std::to_string(kLimit) +
        " and " + std::to_string(kLimit / 4) + " fit into one piece. Split it into blocks." };
  }
  if (mesh.nodeCount < 0 || mesh.triangleCount < 0)
  {
    return { Status::InvalidArgument, "The mesh has a negative number of nodes or triangles." };
  }
  if ((mesh.nodeCount > 0 && (mesh.pointsFloat != nullptr) == (mesh.pointsDouble != nullptr)) ||
    (mesh.triangleCount > 0 && (mesh.triangles != nullptr) == (mesh.wideTriangles != nullptr)))
  {
    return { Status::InvalidArgument,
      "The mesh needs exactly one of its two triangle arrays and one of its two point arrays." };
  }
  const std::int64_t corners = 3 * mesh.triangleCount;
  const std::int64_t bad = mesh.wideTriangles
    ? findOutside(mesh.wideTriangles, corners, mesh.nodeCount)
    : findOutside(mesh.triangles, corners, mesh.nodeCount);
  if (bad < corners)
  {
    return { Status::InvalidArgument,
      "Triangle " + std::to_string(bad / 3) + " refers to node " +
        std::to_string(mesh.wideTriangles ? mesh.wideTriangles[bad] : mesh.triangles[bad]) +
        ", but there are " + std::to_string(mesh.nodeCount) + " nodes." };
  }
  return {};
}

/// Flag and count the nodes that are never candidates.
void flagKeptNodes(const TriangleMeshView& mesh, bool preserveBoundary, TriangleTopology& topology,
  HashQueueDecimationResult& result)
{
  for (Index i = 0; i < topology.nodeCount(); ++i)
  {
    MeshNode& node = topology.node(i);
    Index* counter = nullptr;
    if (mesh.keep && mesh.keep[i])
    {
      counter = &result.requestedNodes;
    }
    else if (!isFinite(node.position))
    {
      counter = &result.nonFiniteNodes;
    }
    else if (node.kind == NodeKind::Unused)
    {
      counter = &result.unusedNodes;
    }
    else if (node.kind == NodeKind::Degenerate)
    {
      counter = &result.degenerateNodes;
    }
    else if (node.kind == NodeKind::NonManifold)
    {
      counter = &result.nonManifoldNodes;
    }
    else if (preserveBoundary && node.kind == NodeKind::Boundary)
    {
      counter = &result.boundaryNodes;
    }
    if (counter)
    {
      ++*counter;
      node.kept = true;
    }
  }
}

Outcome run(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options,
  Monitor& monitor, HashQueueDecimationResult& result)
{
  TriangleTopology topology(mesh);
  flagKeptNodes(mesh, options.preserveBoundary, topology, result);
  const Goal goal(mesh, options);
  const auto decimateBy = [&](auto&& criterion)
  {
    using CriterionType = std::decay_t<decltype(criterion)>;
    return Decimation<CriterionType>(topology, criterion, options, goal, monitor).run(result);
  };
  const NodalArrayView* array =
    options.criterion == Criterion::ScalarDifference ? &options.arrays.front() : nullptr;
  const Status status = options.criterion == Criterion::Deviation
    ? decimateBy(DeviationCriterion(mesh, topology, options.arrays, options.scalarWeight))
    : options.criterion == Criterion::Quadric ? decimateBy(QuadricCriterion(topology))
                                              : decimateBy(MeanEdgeCriterion(topology, array));
  return { status, status == Status::Cancelled ? "Cancelled." : "" };
}

} // namespace

const char* toString(StopReason reason)
{
  switch (reason)
  {
    case StopReason::TargetReduction:
      return "target reduction";
    case StopReason::TargetNodes:
      return "target number of nodes";
    case StopReason::TargetTriangles:
      return "target number of triangles";
    case StopReason::MaximumError:
      return "maximum error";
    case StopReason::NoRemovableNode:
      break;
  }
  return "no removable node left";
}

Outcome decimate(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options,
  Monitor& monitor, HashQueueDecimationResult& result)
{
  return guarded("Not enough memory to decimate " + std::to_string(mesh.nodeCount) + " nodes.",
    result,
    [&]
    {
      Outcome outcome = checkOptions(options);
      if (outcome)
      {
        outcome = checkMesh(mesh);
      }
      return outcome ? run(mesh, options, monitor, result) : outcome;
    });
}

} // namespace undecimate
