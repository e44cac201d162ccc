// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hash_queue_decimation.h"

#include "array_range.h"
#include "deviation.h"
#include "guarded.h"
#include "mean_edge_criterion.h"
#include "node_removal.h"
#include "parallel_decimation.h"
#include "quadric_criterion.h"
#include "triangle_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>

namespace undecimate
{

namespace
{

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
    , writer_(stepWriterFor(options))
    , removed_(topology)
  {
  }

  Status run(HashQueueDecimationResult& result)
  {
    const Index planned = std::max<Index>(1, this->trianglesLeft_ - this->goal_.triangles);
    // Step 1: evaluate all nodes and arrange them in the hash table.
    CostRange range;
    if (!this->evaluateAll(range))
    {
      return Status::Cancelled;
    }
    const Intervals intervals(this->options_, range);
    Queue queue({ &this->topology_ }, intervals.count());
    for (Index node = 0; node < this->nodeCount_; ++node)
    {
      const float cost = firstCost(this->topology_.node(node));
      if (cost >= 0.0F)
      {
        queue.insert(node, intervals.of(cost));
      }
    }

    result.stopReason = StopReason::NoRemovableNode;
    bool tooCostly = false;
    for (std::uint64_t turn = 0;
         !this->goal_.isReached(this->nodesLeft_, this->trianglesLeft_, result.stopReason); ++turn)
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
      const bool isFar = this->goal_.isFar(this->trianglesLeft_);
      const Verdict verdict = tryRemoval(node, isFar ? intervals.near(interval) : interval,
        intervals.count(), this->goal_.error, intervals, this->criterion_, queue, this->removal_);
      tooCostly = tooCostly || verdict == Verdict::TooCostly;
      if (verdict != Verdict::Remove)
      {
        continue;
      }
      this->prefetchPlaces(queue);
      this->remove();
      // Step 6: re-evaluate the neighbours; they go to the end of their interval's queue.
      this->reevaluate(queue, intervals, interval, isFar);
      // Step 7: back to step 2.
    }
    if constexpr (kIsQuadric)
    {
      this->criterion_.release();
    }
    std::vector<Index> removed = this->removed_.nodes();
    result.record =
      recordOf(this->topology_, removed, this->options_.trackCellSources, result.baseTriangles);
    result.error = result.record.stepErrors.empty() ? 0.0 : result.record.stepErrors.front();
    return this->monitor_.update(1.0) ? Status::Ok : Status::Cancelled;
  }

private:
  struct NodeLinks
  {
    TriangleTopology* topology;
    QueueLinks& operator()(Index node) const { return this->topology->node(node).links; }
  };
  using Queue = HashQueueOn<NodeLinks>;

  static constexpr bool kIsQuadric = std::is_same_v<CriterionType, QuadricCriterion>;

  // Share of the progress that the first evaluation gets.
  static constexpr double kEvaluationShare = CriterionType::kLazy ? 0.2 : 0.05;

  bool evaluateAll(CostRange& range)
  {
    for (Index node = 0; node < this->nodeCount_; ++node)
    {
      if ((node & 1023) == 0 && !this->monitor_.update(kEvaluationShare * node / this->nodeCount_))
      {
        return false;
      }
      evaluateFirst(this->topology_, this->criterion_, node, range);
    }
    return true;
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
    std::array<Index, 6> next;
    Index node = queue.front();
    for (Index& n : next)
    {
      n = node;
      node = node == kNone ? kNone : queue.upcoming(node);
    }
    if (next[5] != kNone)
    {
      this->topology_.prefetchNode(next[5]);
      if constexpr (kIsQuadric)
      {
        this->criterion_.prefetch(next[5]);
      }
    }
    if (next[4] != kNone)
    {
      this->topology_.prefetchTriangle(next[4]);
    }
    if (next[3] != kNone)
    {
      this->topology_.prefetchNeighbours(next[3]);
    }
    if (next[2] != kNone)
    {
      this->topology_.prefetchSecondNeighbours(next[2]);
    }
    if (next[1] != kNone)
    {
      this->topology_.prefetchRing(next[1]);
    }
  }

  // Ring nodes whose place in the queue is about to change.
  void prefetchPlaces(const Queue& queue) const
  {
    const Hole& hole = this->removal_.hole;
    for (int i = 0; i < hole.size; ++i)
    {
      const Index node = hole.ring[i];
      if constexpr (kIsQuadric)
      {
        if (!this->criterion_.isNext(node, hole))
        {
          continue;
        }
      }
      queue.prefetchRemove(node);
    }
  }

  void remove()
  {
    const Hole& hole = this->removal_.hole;
    const HoleTriangulation& filling = this->removal_.filling;
    this->topology_.replace(hole, filling);
    this->criterion_.removed(hole, filling);
    const double error = errorInUnit(this->options_, this->removal_.error);
    this->writer_.write(this->topology_, hole, filling, error);
    this->removed_.append(hole.node);
    this->trianglesLeft_ -= hole.triangleCount - filling.count;
    --this->nodesLeft_;
  }

  void reevaluate(Queue& queue, const Intervals& intervals, Index interval, bool isFar)
  {
    if constexpr (!CriterionType::kLazy)
    {
      this->evaluateRing(queue, intervals);
      return;
    }
    const Hole& hole = this->removal_.hole;
    for (int i = 0; i < hole.size; ++i)
    {
      const Index node = hole.ring[i];
      if (this->topology_.node(node).kept)
      {
        continue;
      }
      if constexpr (kIsQuadric)
      {
        double expected = 0.0;
        if (this->criterion_.expect(node, hole, isFar, expected))
        {
          queue.insert(node, intervals.of(expected));
          continue;
        }
        if (queue.contains(node))
        {
          continue;
        }
      }
      double cost = 0.0;
      if (this->criterion_.isLazy())
      {
        // Evaluated when its turn comes; one that waits outside gets a new chance.
        const bool queued = queue.contains(node);
        const Index place = queued ? queue.interval(node) : interval;
        queue.insert(node, queued && isFar ? std::max(place, intervals.risen(interval)) : place);
      }
      else if (this->criterion_.evaluate(node, cost))
      {
        queue.insert(node, intervals.of(cost));
      }
    }
  }

  // All costs first: the ends of their intervals come into the cache meanwhile.
  void evaluateRing(Queue& queue, const Intervals& intervals) const
  {
    const Hole& hole = this->removal_.hole;
    std::array<Index, kMaximumPatchCells + 1> places;
    for (int i = 0; i < hole.size; ++i)
    {
      double cost = 0.0;
      places[i] = kNone;
      if (!this->topology_.node(hole.ring[i]).kept && this->criterion_.evaluate(hole.ring[i], cost))
      {
        places[i] = intervals.of(cost);
        queue.prefetchInsert(places[i]);
      }
    }
    for (int i = 0; i < hole.size; ++i)
    {
      if (places[i] != kNone)
      {
        queue.insert(hole.ring[i], places[i]);
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
  Removal removal_;
  StepWriter writer_;
  RemovalChain removed_;
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
  if (!(options.shapeWeight >= 0.0) || !std::isfinite(options.shapeWeight))
  {
    return invalid("ShapeWeight", options.shapeWeight, "0 or more, and finite");
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

Outcome checkMesh(const TriangleMeshView& mesh, Threads* threads)
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
  std::int64_t bad = corners;
  std::mutex mutex;
  const auto check = [&](const auto* triangles)
  {
    doInShares(threads, static_cast<Index>(mesh.triangleCount),
      [&](const Share& share)
      {
        const std::int64_t begin = std::int64_t{ 3 } * share.begin;
        const std::int64_t count = std::int64_t{ 3 } * share.end - begin;
        const std::int64_t place = findOutside(triangles + begin, count, mesh.nodeCount);
        const std::lock_guard<std::mutex> lock(mutex);
        bad = place < count ? std::min(bad, begin + place) : bad;
      });
  };
  mesh.wideTriangles ? check(mesh.wideTriangles) : check(mesh.triangles);
  if (bad < corners)
  {
    return { Status::InvalidArgument,
      "Triangle " + std::to_string(bad / 3) + " refers to node " +
        std::to_string(mesh.wideTriangles ? mesh.wideTriangles[bad] : mesh.triangles[bad]) +
        ", but there are " + std::to_string(mesh.nodeCount) +
        " nodes. Repair the cells of the input." };
  }
  return {};
}

/// Flag and count the nodes that are never candidates.
void flagKeptNodes(const TriangleMeshView& mesh, bool preserveBoundary, TriangleTopology& topology,
  Threads* threads, HashQueueDecimationResult& result)
{
  using Counter = Index HashQueueDecimationResult::*;
  static constexpr std::array<Counter, 6> kCounters{ &HashQueueDecimationResult::requestedNodes,
    &HashQueueDecimationResult::nonFiniteNodes, &HashQueueDecimationResult::unusedNodes,
    &HashQueueDecimationResult::degenerateNodes, &HashQueueDecimationResult::nonManifoldNodes,
    &HashQueueDecimationResult::boundaryNodes };
  const auto counterOf = [&](Index i) -> std::size_t
  {
    const MeshNode& node = topology.node(i);
    return mesh.keep && mesh.keep[i]                        ? 0
      : !isFinite(node.position)                            ? 1
      : node.kind == NodeKind::Unused                       ? 2
      : node.kind == NodeKind::Degenerate                   ? 3
      : node.kind == NodeKind::NonManifold                  ? 4
      : preserveBoundary && node.kind == NodeKind::Boundary ? 5
                                                            : kCounters.size();
  };
  std::mutex mutex;
  doInShares(threads, topology.nodeCount(),
    [&](const Share& share)
    {
      std::array<Index, kCounters.size()> counts{};
      for (Index i = share.begin; i < share.end; ++i)
      {
        const std::size_t counter = counterOf(i);
        if (counter < counts.size())
        {
          ++counts[counter];
          topology.node(i).kept = true;
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t c = 0; c < counts.size(); ++c)
      {
        result.*kCounters[c] += counts[c];
      }
    });
}

/// @param threads null: not parallel
Outcome run(const TriangleMeshView& mesh, const HashQueueDecimationOptions& options,
  Threads* threads, Monitor& monitor, HashQueueDecimationResult& result)
{
  TriangleTopology topology(mesh, threads);
  flagKeptNodes(mesh, options.preserveBoundary, topology, threads, result);
  const Goal goal(mesh, options);
  const auto decimateBy = [&](auto&& criterion)
  {
    using CriterionType = std::decay_t<decltype(criterion)>;
    if (threads)
    {
      return ParallelDecimation<CriterionType>(
        topology, criterion, options, goal, monitor, *threads)
        .run(result);
    }
    return Decimation<CriterionType>(topology, criterion, options, goal, monitor).run(result);
  };
  const NodalArrayView* array =
    options.criterion == Criterion::ScalarDifference ? &options.arrays.front() : nullptr;
  const Status status = options.criterion == Criterion::Deviation
    ? decimateBy(DeviationCriterion(
        topology, options.arrays, { options.scalarWeight, options.shapeWeight }, threads))
    : options.criterion == Criterion::Quadric
    ? decimateBy(QuadricCriterion(topology, threads))
    : decimateBy(MeanEdgeCriterion(topology, array, threads));
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
      std::unique_ptr<Threads> threads;
      if (outcome && options.parallel)
      {
        threads = std::make_unique<Threads>(options.threads);
      }
      if (outcome)
      {
        outcome = checkMesh(mesh, threads.get());
      }
      return outcome ? run(mesh, options, threads.get(), monitor, result) : outcome;
    });
}

} // namespace undecimate
