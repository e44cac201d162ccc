// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file parallel_decimation.h
/// @brief Hash queue decimation by several threads, with a result that does not depend on them.
///
/// In rounds. The mesh is cut into parts (mesh_parts.h). A node whose neighbours all are in its
/// part is free: its removal changes nothing that another part reads. The other nodes, at the
/// seams, stay for this round. Each part removes its free nodes as the serial algorithm would, with
/// a queue of its own, up to a cost that is the same for all parts and rises from round to round.
/// The parts' steps are then merged by their costs. The steps behind the goal are undone. A few
/// nodes, or those that the rounds cannot get any further, are left to the serial algorithm.
///
/// Parts, limits and the order of the steps are computed from the mesh and from counts alone, so
/// the number of threads and their luck do not matter.

#ifndef UNDECIMATE_CORE_PARALLEL_DECIMATION_H
#define UNDECIMATE_CORE_PARALLEL_DECIMATION_H

#include "large_array.h"
#include "mesh_parts.h"
#include "monitor.h"
#include "node_removal.h"
#include "quadric_criterion.h"
#include "threads.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

namespace undecimate
{

/// @tparam CriterionType see deviation.h, mean_edge_criterion.h and quadric_criterion.h
template <typename CriterionType>
class ParallelDecimation
{
public:
  ParallelDecimation(TriangleTopology& topology, CriterionType& criterion,
    const HashQueueDecimationOptions& options, const Goal& goal, Monitor& monitor, Threads& threads)
    : topology_(topology)
    , criterion_(criterion)
    , options_(options)
    , goal_(goal)
    , monitor_(monitor)
    , threads_(threads)
    , trianglesLeft_(topology.triangleCount())
    , nodesLeft_(topology.nodeCount())
    , planned_(std::max<Index>(1, this->trianglesLeft_ - goal.triangles))
  {
    for (int thread = 0; thread < this->threads_.count(); ++thread)
    {
      this->workers_.push_back(std::make_unique<Worker>(criterion.forThread(), options));
    }
  }

  Status run(HashQueueDecimationResult& result)
  {
    this->removed_.reserve(
      static_cast<std::size_t>(this->goal_.plannedSteps(this->nodesLeft_, this->trianglesLeft_)));
    MeshParts parts(this->topology_, this->threads_);
    if (!this->evaluateAll(parts))
    {
      return Status::Cancelled;
    }
    result.stopReason = StopReason::NoRemovableNode;
    Index limit = 0;
    double yield = 0.5; // removals a candidate below the limit, at first a guess
    bool stuck = false;
    std::vector<Part> done; // in the last round; not in the record yet
    for (int round = 0; !this->isAtGoal(result.stopReason); ++round)
    {
      const Index candidates = this->countCandidates();
      bool alone = stuck || candidates < kFewNodes;
      if (!alone)
      {
        parts.cut(round, partSize(this->nodesLeft_));
        alone = parts.count() == 1;
      }
      if (alone)
      {
        this->merge(done);
        parts.join();
        if (!this->removeAlone(parts, result.stopReason))
        {
          return Status::Cancelled;
        }
        done.clear();
        break;
      }
      const double needed = this->goal_.plannedSteps(this->nodesLeft_, this->trianglesLeft_);
      const double below =
        std::min(kRoundShare * candidates, std::max(kOvershoot * needed / yield, 1.0));
      limit = std::max(limit, this->costOf(below));
      if (!this->removeInParts(parts, limit, done))
      {
        return Status::Cancelled;
      }
      Index removed = 0;
      Index cellsGone = 0;
      Index moved = 0;
      for (const Part& part : done)
      {
        removed += part.left();
        cellsGone += part.cellsGone;
        moved += part.left() + part.raised;
      }
      yield = std::clamp(removed / below, 0.1, 1.0);
      stuck = moved < candidates / kFewMoved;
      if (this->goal_.isReached(
            this->nodesLeft_ - removed, this->trianglesLeft_ - cellsGone, result.stopReason))
      {
        break;
      }
      this->nodesLeft_ -= removed;
      this->trianglesLeft_ -= cellsGone;
    }
    this->merge(done,
      [&](Index node)
      {
        const bool more = !this->isAtGoal(result.stopReason);
        this->nodesLeft_ -= more ? 1 : 0;
        this->trianglesLeft_ -= more ? cellsGone(this->topology_.node(node)) : 0;
        return more;
      });
    this->undoRest(done);
    if (result.stopReason == StopReason::NoRemovableNode && this->tooCostly_)
    {
      result.stopReason = StopReason::MaximumError;
    }
    release(done);
    if constexpr (kIsQuadric)
    {
      this->criterion_.release();
    }
    release(this->places_);
    parts.release();
    result.record = recordOf(this->topology_, this->removed_, this->options_.trackCellSources,
      result.baseTriangles, &this->threads_);
    result.error = result.record.stepErrors.empty() ? 0.0 : result.record.stepErrors.front();
    return this->monitor_.update(1.0) ? Status::Ok : Status::Cancelled;
  }

private:
  static constexpr bool kIsQuadric = std::is_same_v<CriterionType, QuadricCriterion>;

  // Places of nodes that are in no queue: the interval of their cost, kNone if they wait for a
  // neighbour to go or are kept for good, or
  static constexpr Index kGone = kNone - 1;

  // Nodes of a part: so many that the seams are short and so few that a part stays in a core's
  // cache; but parts for many cores, and some for few cores even if they are small.
  static constexpr Index kLargestPart = 1 << 14;
  static constexpr Index kSmallPart = 3 << 10;
  static constexpr Index kSmallestPart = 1 << 10;
  static constexpr Index kWantedParts = 64;
  static constexpr Index kFewParts = 3;

  // So few candidates are left to the serial algorithm.
  static constexpr Index kFewNodes = 1 << 11;

  // Share of the candidates that a round takes on: the cheapest. The less, the nearer the order is
  // to the serial one, and the more often the mesh is cut. A part removes at most kPartShare of its
  // own, since the seams stay behind.
  static constexpr double kRoundShare = kIsQuadric ? 0.35 : CriterionType::kLazy ? 0.25 : 0.5;
  static constexpr double kPartShare = 0.7;

  // The last round aims at so many times the removals that are needed.
  static constexpr double kOvershoot = 1.1;

  // A round that does less than this fraction of its candidates any good is the last one.
  static constexpr Index kFewMoved = 64;

  static constexpr std::ptrdiff_t kAhead = 16; // nodes, of a prefetch

  // Share of the progress that the first evaluation gets.
  static constexpr double kEvaluationShare = CriterionType::kLazy ? 0.2 : 0.05;

  struct NodeLinks
  {
    TriangleTopology* topology;
    QueueLinks& operator()(Index node) const { return this->topology->node(node).links; }
  };
  using Queue = HashQueueOn<NodeLinks>;

  // What a thread has of its own, in cache lines of its own.
  struct alignas(kCacheLine) Worker
  {
    CriterionType criterion;
    std::optional<Queue> queue;
    LargeArray<Index> counts; // of candidates by interval, over the parts it has done
    std::vector<Index> nodes; // to be queued
    Removal removal;
    StepWriter writer;

    Worker(CriterionType criterion_, const HashQueueDecimationOptions& options)
      : criterion(std::move(criterion_))
      , writer(stepWriterFor(options))
    {
    }
  };

  // What a part has done in a round.
  struct Part
  {
    struct Step
    {
      Index node;
      Index cost; // interval of the largest cost up to this step
    };
    std::vector<Step> steps;
    std::size_t taken = 0; // steps that are in the record
    Index raised = 0;      // nodes that were found to cost more, or that cannot go
    Index cellsGone = 0;

    Index left() const { return static_cast<Index>(this->steps.size() - this->taken); }
  };

  static Index partSize(Index nodes)
  {
    const Index least = std::clamp(nodes / kFewParts, kSmallestPart, kSmallPart);
    return std::clamp(nodes / kWantedParts, least, kLargestPart);
  }

  bool isAtGoal(StopReason& reason) const
  {
    return this->goal_.isReached(this->nodesLeft_, this->trianglesLeft_, reason);
  }

  // Ask the monitor, in the caller's thread, or whether it was asked to stop.
  bool mayGoOn(int thread, double fraction)
  {
    if (thread != 0)
    {
      return !this->monitor_.cancelled();
    }
    // Steps that are undone, and those at the boundary, were counted as more than they are.
    this->progress_ = std::max(this->progress_, fraction);
    return this->monitor_.update(this->progress_);
  }

  bool evaluateAll(MeshParts& parts)
  {
    this->places_.assign(this->topology_.nodeCount(), kNone);
    std::vector<CostRange> ranges(this->workers_.size());
    std::atomic<Index> done{ 0 };
    this->threads_.run(parts.count(),
      [&](Index part, int thread)
      {
        Index count = 0;
        CostRange range; // not in the list of ranges, where other threads write beside it
        for (const Index* node = parts.begin(part); node != parts.end(part); ++node, ++count)
        {
          if ((count & 1023) == 0 &&
            !this->mayGoOn(thread, kEvaluationShare * (done + count) / this->topology_.nodeCount()))
          {
            return;
          }
          evaluateFirst(this->topology_, this->workers_[thread]->criterion, *node, range);
        }
        ranges[thread].add(range);
        done += count;
      });
    if (this->monitor_.cancelled())
    {
      return false;
    }
    for (std::size_t i = 1; i < ranges.size(); ++i)
    {
      ranges.front().add(ranges[i]);
    }
    this->intervals_ = std::make_unique<Intervals>(this->options_, ranges.front());
    for (auto& worker : this->workers_)
    {
      worker->queue.emplace(NodeLinks{ &this->topology_ }, this->intervals_->count());
      worker->counts.assign(this->intervals_->count(), 0);
    }
    this->threads_.run(parts.count(),
      [&](Index part, int thread)
      {
        for (const Index* node = parts.begin(part); node != parts.end(part); ++node)
        {
          const float cost = firstCost(this->topology_.node(*node));
          if (cost >= 0.0F)
          {
            const Index interval = this->intervals_->of(cost);
            this->places_[*node] = interval;
            ++this->workers_[thread]->counts[interval];
          }
        }
      });
    return true;
  }

  // All candidates, by interval in the first worker's counts.
  Index countCandidates()
  {
    LargeArray<Index>& counts = this->workers_.front()->counts;
    for (std::size_t i = 1; i < this->workers_.size(); ++i)
    {
      std::transform(counts.begin(), counts.end(), this->workers_[i]->counts.begin(),
        counts.begin(), std::plus<Index>());
      std::fill(this->workers_[i]->counts.begin(), this->workers_[i]->counts.end(), 0);
    }
    Index sum = 0;
    for (const Index count : counts)
    {
      sum += count;
    }
    return sum;
  }

  // The interval up to which there are so many candidates. They are to be counted anew afterwards.
  Index costOf(double candidates)
  {
    LargeArray<Index>& counts = this->workers_.front()->counts;
    Index interval = 0;
    double sum = 0.0;
    while (interval + 1 < this->intervals_->count() && (sum += counts[interval]) < candidates)
    {
      ++interval;
    }
    return interval;
  }

  // A round. The steps of the round before are taken over into the record meanwhile, and `done` has
  // those of this one afterwards.
  bool removeInParts(MeshParts& parts, Index limit, std::vector<Part>& done)
  {
    LargeArray<Index>& counts = this->workers_.front()->counts;
    std::fill(counts.begin(), counts.end(), 0);
    std::vector<Part> now(parts.count());
    std::atomic<Index> gone{ 0 };
    this->threads_.run(parts.count() + 1,
      [&](Index job, int thread)
      {
        if (job == 0)
        {
          this->merge(done);
          release(done);
          return;
        }
        const Index part = job - 1;
        Part here; // not in the list of parts, where other threads write beside it
        Worker& worker = *this->workers_[thread];
        worker.criterion.setTrianglesLeft(this->trianglesLeft_);
        const Index queued = this->fill(parts, part, worker, limit);
        const Index most = std::max<Index>(1, static_cast<Index>(kPartShare * queued));
        here.raised = this->empty(
          parts, part, worker, limit,
          [&](std::uint64_t turn)
          {
            return here.left() < most &&
              ((turn & 255) != 0 ||
                this->mayGoOn(thread, this->fractionDone(gone + here.cellsGone)));
          },
          [&](const Hole& hole, const HoleTriangulation& filling, Index interval)
          {
            here.steps.push_back({ hole.node,
              here.steps.empty() ? interval : std::max(here.steps.back().cost, interval) });
            here.cellsGone += hole.triangleCount - filling.count;
          });
        gone += here.cellsGone;
        now[part] = std::move(here);
        this->count(parts, part, worker);
      });
    done.swap(now);
    return !this->monitor_.cancelled();
  }

  // As the serial algorithm: all nodes, whatever they cost, to the goal.
  bool removeAlone(MeshParts& parts, StopReason& reason)
  {
    Worker& worker = *this->workers_.front();
    worker.criterion.setTrianglesLeft(this->trianglesLeft_);
    const Index limit = this->intervals_->count();
    this->fill(parts, 0, worker, limit);
    this->empty(
      parts, 0, worker, limit,
      [&](std::uint64_t turn)
      {
        return !this->isAtGoal(reason) &&
          ((turn & 255) != 0 || this->mayGoOn(0, this->fractionDone(0)));
      },
      [&](const Hole& hole, const HoleTriangulation& filling, Index /*interval*/)
      {
        this->removed_.push_back(hole.node);
        --this->nodesLeft_;
        this->trianglesLeft_ -= hole.triangleCount - filling.count;
      });
    return !this->monitor_.cancelled();
  }

  double fractionDone(Index trianglesGone) const
  {
    const double gone = this->topology_.triangleCount() - this->trianglesLeft_ + trianglesGone;
    return std::min(0.99, kEvaluationShare + (1.0 - kEvaluationShare) * gone / this->planned_);
  }

  // Queue the nodes of a part that are cheap enough and may go in this round. Returns their number.
  Index fill(MeshParts& parts, Index part, Worker& worker, Index limit)
  {
    std::vector<Index>& nodes = worker.nodes;
    nodes.clear();
    const Index* const end = parts.end(part);
    for (const Index* node = parts.begin(part); node != end; ++node)
    {
      prefetch(&this->places_[node[std::min(kAhead, end - node - 1)]]);
      const Index place = this->places_[*node];
      if (place >= 0 && place <= limit)
      {
        nodes.push_back(*node);
      }
    }
    const std::size_t count = nodes.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      constexpr std::size_t kStage = 4; // of the prefetch
      this->topology_.prefetchNode(nodes[std::min(i + 3 * kStage, count - 1)]);
      this->topology_.prefetchTriangle(nodes[std::min(i + 2 * kStage, count - 1)]);
      this->topology_.prefetchNeighbours(nodes[std::min(i + kStage, count - 1)]);
      if (this->isFree(parts, part, nodes[i]))
      {
        worker.queue->insert(nodes[i], this->places_[nodes[i]]);
      }
    }
    return worker.queue->size();
  }

  // Whether a node may go in this round: all its neighbours are in the part. Removals do not change
  // that: a free node's new neighbours were neighbours of its old ones in the part, and a node at a
  // seam keeps its neighbour behind the seam, which may not go either.
  bool isFree(const MeshParts& parts, Index part, Index node) const
  {
    return this->topology_.allAround(
      node, [&](Index neighbour) { return parts.has(part, neighbour); });
  }

  // Remove nodes until the queue is empty or `goOn` says no; what is left in the queue waits for
  // the next round. Returns the number of nodes that turned out not to be below the limit.
  template <typename GoOn, typename Append>
  Index empty(const MeshParts& parts, Index part, Worker& worker, Index limit, const GoOn& goOn,
    const Append& append)
  {
    Queue& queue = *worker.queue;
    Index raised = 0;
    for (std::uint64_t turn = 0; goOn(turn); ++turn)
    {
      // The order as the serial algorithm's.
      const bool isFar = this->goal_.isFar(this->trianglesLeft_);
      const Index highest = isFar ? this->intervals_->near(limit) : limit;
      const Index interval = queue.lowestInterval();
      const Index node = queue.pop();
      if (node == kNone)
      {
        return raised;
      }
      Index& place = this->places_[node];
      place = kNone;
      const Verdict verdict = tryRemoval(node, isFar ? this->intervals_->near(interval) : interval,
        highest, this->goal_.error, *this->intervals_, worker.criterion, queue, worker.removal);
      if (verdict != Verdict::Remove)
      {
        if (verdict == Verdict::AboveLimit)
        {
          place = this->intervals_->of(worker.removal.cost);
        }
        if (verdict == Verdict::TooCostly && !this->tooCostly_)
        {
          this->tooCostly_ = true;
        }
        raised += verdict == Verdict::Requeued ? 0 : 1;
        continue;
      }
      const Hole& hole = worker.removal.hole;
      const HoleTriangulation& filling = worker.removal.filling;
      append(hole, filling, this->intervals_->of(worker.removal.cost));
      this->topology_.replace(hole, filling);
      worker.criterion.removed(hole, filling);
      worker.writer.write(
        this->topology_, hole, filling, errorInUnit(this->options_, worker.removal.error));
      place = kGone;
      this->reevaluate(parts, part, worker, interval, limit, isFar);
    }
    for (;;)
    {
      const Index interval = queue.lowestInterval();
      const Index node = queue.pop();
      if (node == kNone)
      {
        return raised;
      }
      this->places_[node] = interval;
    }
  }

  void reevaluate(
    const MeshParts& parts, Index part, Worker& worker, Index interval, Index limit, bool isFar)
  {
    Queue& queue = *worker.queue;
    const Hole& hole = worker.removal.hole;
    for (int i = 0; i < hole.size; ++i)
    {
      const Index node = hole.ring[i];
      if (this->topology_.node(node).kept)
      {
        continue;
      }
      const bool queued = queue.contains(node);
      Index place = this->places_[node];
      const bool waits = !queued && place == kNone;
      double expected = 0.0;
      bool isExpected = false;
      if constexpr (kIsQuadric)
      {
        isExpected = worker.criterion.expect(node, hole, isFar, expected);
        if (!isExpected && !waits)
        {
          continue;
        }
      }
      if (isExpected)
      {
        place = this->intervals_->of(expected);
      }
      else if (worker.criterion.isLazy())
      {
        // Evaluated when its turn comes; one that waits outside gets a new chance.
        place = queued ? queue.interval(node) : waits ? interval : place;
        if (isFar && !waits)
        {
          place = std::max(place, this->intervals_->risen(interval));
        }
      }
      else
      {
        double cost = 0.0;
        if (!worker.criterion.evaluate(node, cost))
        {
          continue;
        }
        place = this->intervals_->of(cost);
      }
      if (place <= limit && (queued || this->isFree(parts, part, node)))
      {
        queue.insert(node, place);
      }
      else
      {
        queue.remove(node);
        this->places_[node] = place;
      }
    }
  }

  // Forget the nodes of a part that went, and count the candidates for the next round.
  void count(MeshParts& parts, Index part, Worker& worker)
  {
    Index* left = parts.begin(part);
    const Index* const end = parts.end(part);
    for (const Index* node = parts.begin(part); node != end; ++node)
    {
      prefetch(&this->places_[node[std::min(kAhead, end - node - 1)]]);
      const Index place = this->places_[*node];
      if (place != kGone)
      {
        *left++ = *node;
        if (place != kNone)
        {
          ++worker.counts[place];
        }
      }
    }
    parts.shorten(part, left);
  }

  // Take the steps of all parts over into the record by their costs, as long as `mayTake` the next
  // one. Costs that are equal, to the width of an interval, take turns, so that they spread over
  // the mesh.
  template <typename MayTake>
  void merge(std::vector<Part>& parts, const MayTake& mayTake)
  {
    constexpr int kTurn = 8;                    // steps
    using Turn = std::pair<Index, std::size_t>; // interval of the next cost, part
    std::priority_queue<Turn, std::vector<Turn>, std::greater<Turn>> turns;
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
      if (parts[part].left() > 0)
      {
        turns.push({ parts[part].steps[parts[part].taken].cost, part });
      }
    }
    std::vector<std::size_t> equals;
    while (!turns.empty())
    {
      const Index interval = turns.top().first;
      for (; !turns.empty() && turns.top().first == interval; turns.pop())
      {
        equals.push_back(turns.top().second);
      }
      while (!equals.empty())
      {
        std::size_t stay = 0;
        for (const std::size_t part : equals)
        {
          Part& here = parts[part];
          Index next = interval;
          for (int i = 0; i < kTurn && next == interval; ++i)
          {
            const Index node = here.steps[here.taken].node;
            if (!mayTake(node))
            {
              return;
            }
            this->removed_.push_back(node);
            ++here.taken;
            next = here.left() > 0 ? here.steps[here.taken].cost : kNone;
          }
          if (next == interval)
          {
            equals[stay++] = part;
          }
          else if (next != kNone)
          {
            turns.push({ next, part });
          }
        }
        equals.resize(stay);
      }
    }
  }

  void merge(std::vector<Part>& parts)
  {
    this->merge(parts, [](Index /*node*/) { return true; });
  }

  void undoRest(std::vector<Part>& parts)
  {
    this->threads_.run(static_cast<Index>(parts.size()),
      [&](Index part, int /*thread*/)
      {
        const Part& here = parts[part];
        for (std::size_t i = here.steps.size(); i > here.taken; --i)
        {
          undo(this->topology_, here.steps[i - 1].node);
        }
      });
  }

  TriangleTopology& topology_;
  CriterionType& criterion_;
  const HashQueueDecimationOptions& options_;
  const Goal& goal_;
  Monitor& monitor_;
  Threads& threads_;
  Index trianglesLeft_;
  Index nodesLeft_;
  Index planned_; // triangles to go in all
  std::unique_ptr<Intervals> intervals_;
  std::vector<Index> places_;
  std::vector<std::unique_ptr<Worker>> workers_;

  // Written in a round, in a cache line behind what all threads read.
  alignas(kCacheLine) std::vector<Index> removed_; // in the order of the record's steps
  double progress_ = 0.0;
  std::atomic<bool> tooCostly_{ false };
};

} // namespace undecimate

#endif
