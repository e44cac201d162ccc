// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tri_quad_decimation.h"

#include "guarded.h"
#include "threads.h"
#include "tri_quad_cost.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace undecimate
{

namespace
{

// Nodes of a job when all are evaluated.
constexpr Index kNodesOfJob = 1 << 10;

// Share of the progress that the first evaluation gets.
constexpr double kEvaluationShare = 0.15;

/// Removes one node after the other. Several threads evaluate the next nodes of the queue ahead of
/// their turns; what has changed around a node since then is evaluated again in its turn. So the
/// order of the removals is that of one thread.
class TriQuadDecimation
{
public:
  TriQuadDecimation(TriQuadTopology& topology, TriQuadCost& cost,
    const std::vector<unsigned char>& kept, const TriQuadDecimationOptions& options,
    Monitor& monitor, Threads& threads)
    : topology_(topology)
    , cost_(cost)
    , kept_(kept)
    , options_(options)
    , monitor_(monitor)
    , threads_(threads)
    , nodesLeft_(topology.nodeCount())
    , folds_(topology.nodeCount(), 0)
  {
    for (int thread = 1; thread < threads.count(); ++thread)
    {
      this->otherCosts_.push_back(cost.forThread());
    }
    if (threads.count() > 1)
    {
      this->ahead_.resize(kAhead);
      this->changed_.assign(topology.nodeCount(), 0);
    }
    // The rounding of 1 - 0.9 must not ask for a node more or less.
    const double left = (1.0 - options.targetReduction) * topology.nodeCount();
    this->goal_ = static_cast<Index>(std::ceil(left * (1.0 - 1e-12)));
    if (options.targetNodes > this->goal_)
    {
      this->goal_ =
        static_cast<Index>(std::min<std::int64_t>(options.targetNodes, topology.nodeCount()));
      this->goalReason_ = StopReason::TargetNodes;
    }
  }

  Status run(TriQuadDecimationResult& result)
  {
    RecordBuilder builder(this->topology_.nodeCount(), this->topology_.cellCount(), false,
      this->nodesLeft_ - this->goal_, kTriQuadCorners);
    HashQueue queue(this->topology_.nodeCount(), kLogarithmicIntervals);
    if (!this->evaluateAll(queue))
    {
      return Status::Cancelled;
    }
    result.stopReason = StopReason::NoRemovableNode;
    bool tooCostly = false;
    const Index planned = std::max<Index>(1, this->nodesLeft_ - this->goal_);
    for (std::uint64_t turn = 0;; ++turn)
    {
      if (this->nodesLeft_ <= this->goal_)
      {
        result.stopReason = this->goalReason_;
        break;
      }
      const double done =
        1.0 - static_cast<double>(this->nodesLeft_ - this->goal_) / static_cast<double>(planned);
      if ((turn & 63) == 0 &&
        !this->monitor_.update(std::min(0.99, kEvaluationShare + (1.0 - kEvaluationShare) * done)))
      {
        return Status::Cancelled;
      }
      const Index interval = queue.lowestInterval();
      Evaluation* const ahead = this->ahead(queue);
      const Index node = queue.pop();
      if (node == kNone)
      {
        result.stopReason = tooCostly ? StopReason::MaximumError : StopReason::NoRemovableNode;
        break;
      }
      this->prefetch(queue);
      Evaluation& evaluation = ahead ? *ahead : this->alone_;
      if (!ahead)
      {
        estimate(this->cost_, node, evaluation);
      }
      evaluation.node = kNone;
      this->folds_[node] = evaluation.mayGo && evaluation.patch.folds;
      // A node that cannot go now waits outside the queue until a neighbour goes.
      if (!evaluation.mayGo || waits(queue, node, interval, evaluation.estimated))
      {
        continue;
      }
      if (evaluation.hasMore)
      {
        if (!evaluation.full)
        {
          finish(this->cost_, node, evaluation);
        }
        if (!evaluation.mayGo || waits(queue, node, interval, intervalOf(evaluation.patch)))
        {
          continue;
        }
      }
      if (evaluation.patch.error > this->options_.maximumError)
      {
        tooCostly = true;
        continue;
      }
      if (!evaluation.settled)
      {
        this->settle(this->cost_, evaluation);
      }
      this->remove(evaluation.patch, builder);
      this->reinsertRing(evaluation.patch, queue, interval);
    }
    result.error = builder.error();
    result.stepErrors = this->cost_.stepErrors();
    if (this->options_.allPositions)
    {
      result.allStepErrors = this->cost_.distances(*this->options_.allPositions);
    }
    const std::vector<Index> cells = this->topology_.takeCells();
    result.record = builder.finish(
      [&cells](Index cell, Index* corners) {
        std::copy_n(cells.data() + std::size_t{ kTriQuadCorners } * cell, kTriQuadCorners, corners);
      },
      result.baseCells);
    return this->monitor_.update(1.0) ? Status::Ok : Status::Cancelled;
  }

private:
  // Nodes that are evaluated ahead of their turns: enough to keep the threads busy, and few enough
  // that most removals are far from those to come: a share of the queue, up to kAhead. When half of
  // them have gone, new ones are fetched.
  static constexpr int kAhead = 128;
  static constexpr int kShareAhead = 64;

  // In a component with so many copies P3 holds for all nodes, and so it will for the next one.
  static constexpr Index kManyCopies = TriQuadPatch::kMaximumFans + 4;

  // Of a node.
  struct Evaluation
  {
    Index node = kNone;
    std::uint32_t removals = 0; // before it
    bool mayGo = false;
    bool hasMore = false; // the full effort is worth it,
    bool full = false;    // and has been made
    bool settled = false; // it is known where the removed nodes will lie
    Index estimated = 0;  // interval
    TriQuadPatch patch;
  };

  static Index intervalOf(const TriQuadPatch& patch)
  {
    return logarithmicInterval(static_cast<float>(patch.cost));
  }

  static void estimate(TriQuadCost& cost, Index node, Evaluation& evaluation)
  {
    evaluation.node = node;
    evaluation.full = false;
    evaluation.settled = false;
    evaluation.mayGo = cost.evaluate(node, TriQuadCost::Effort::Estimate, evaluation.patch);
    evaluation.hasMore = evaluation.mayGo && cost.hasMore(evaluation.patch);
    evaluation.estimated = evaluation.mayGo ? intervalOf(evaluation.patch) : kNone;
  }

  static void finish(TriQuadCost& cost, Index node, Evaluation& evaluation)
  {
    evaluation.mayGo = cost.evaluate(node, TriQuadCost::Effort::Full, evaluation.patch);
    evaluation.full = true;
  }

  void settle(TriQuadCost& cost, Evaluation& evaluation) const
  {
    if (this->options_.criterion == TriQuadCriterion::Deviation)
    {
      cost.findHomes(evaluation.patch);
    }
    evaluation.settled = true;
  }

  TriQuadCost& costOf(int thread)
  {
    return thread == 0 ? this->cost_ : this->otherCosts_[thread - 1];
  }

  bool evaluateAll(HashQueue& queue)
  {
    // In blocks, so that the user can cancel.
    const Index count = this->topology_.nodeCount();
    const Index block = kNodesOfJob * this->threads_.count();
    std::vector<Index> intervals(std::min(block, count));
    std::vector<TriQuadPatch> patches(this->threads_.count());
    for (Index begin = 0; begin < count; begin += std::min(block, count - begin))
    {
      if (!this->monitor_.update(kEvaluationShare * begin / count))
      {
        return false;
      }
      const Index size = std::min(block, count - begin);
      this->threads_.run((size + kNodesOfJob - 1) / kNodesOfJob,
        [&](Index job, int thread)
        {
          TriQuadPatch& patch = patches[thread];
          const Index end = std::min(size, (job + 1) * kNodesOfJob);
          for (Index i = job * kNodesOfJob; i < end; ++i)
          {
            const bool mayGo = !this->kept_[begin + i] &&
              this->costOf(thread).evaluate(begin + i, TriQuadCost::Effort::Estimate, patch);
            intervals[i] = mayGo ? intervalOf(patch) : kNone;
            this->folds_[begin + i] = mayGo && patch.folds;
          }
        });
      for (Index i = 0; i < size; ++i)
      {
        if (intervals[i] != kNone)
        {
          queue.insert(begin + i, intervals[i]);
        }
      }
    }
    return true;
  }

  // What is known of the node whose turn it is; null if nothing.
  Evaluation* ahead(const HashQueue& queue)
  {
    if (this->ahead_.empty() || queue.empty())
    {
      return nullptr;
    }
    Evaluation* found = this->find(queue.front());
    if (!found && ++this->missed_ + this->used_ > this->wanted_ / 2)
    {
      this->evaluateAhead(queue);
      found = this->find(queue.front());
    }
    this->used_ += found ? 1 : 0;
    return found;
  }

  // An evaluation that still holds. Most are found in the order in which they were made.
  Evaluation* find(Index node)
  {
    for (int i = 0; i < kAhead; ++i)
    {
      Evaluation& evaluation = this->ahead_[(this->next_ + i) % kAhead];
      if (evaluation.node == node)
      {
        if (!this->holds(evaluation))
        {
          evaluation.node = kNone;
          return nullptr;
        }
        this->next_ = (this->next_ + i + 1) % kAhead;
        return &evaluation;
      }
    }
    return nullptr;
  }

  // Whether nothing that it depends on has changed: what TriQuadCost::evaluate() reads.
  bool holds(const Evaluation& evaluation) const
  {
    const Index node = evaluation.node;
    if (this->changed_[node] > evaluation.removals)
    {
      return false;
    }
    // Only then the cells of the patch are those around the node.
    const TriQuadPatch& patch = evaluation.patch;
    for (Index copy = node; copy != kNone; copy = this->topology_.nextCopy(copy))
    {
      if (this->topology_.componentSize(copy) < kManyCopies)
      {
        return false;
      }
    }
    return std::all_of(patch.ring.begin(), patch.ring.begin() + patch.ringSize,
      [&](Index other) { return this->changed_[other] <= evaluation.removals; });
  }

  // Evaluate the next nodes of the queue.
  void evaluateAhead(const HashQueue& queue)
  {
    this->missed_ = 0;
    this->used_ = 0;
    this->next_ = 0;
    this->wanted_ = std::min<Index>(kAhead, queue.size() / kShareAhead);
    if (this->wanted_ < this->threads_.count())
    {
      return;
    }
    std::array<Index, kAhead> nodes;
    int count = 0;
    for (Index node = queue.front(); node != kNone && count < this->wanted_;
         node = queue.upcoming(node))
    {
      nodes[count++] = node;
    }
    // Those that are known and still hold stay as they are.
    std::array<Evaluation*, kAhead> unused;
    std::array<Index, kAhead> unknown;
    const auto end = nodes.begin() + count;
    auto last = unknown.begin();
    int unusedCount = 0;
    std::array<bool, kAhead> known{};
    for (Evaluation& evaluation : this->ahead_)
    {
      const auto found = std::find(nodes.begin(), end, evaluation.node);
      if (evaluation.node != kNone && found != end && this->holds(evaluation))
      {
        known[found - nodes.begin()] = true;
      }
      else
      {
        evaluation.node = kNone;
        unused[unusedCount++] = &evaluation;
      }
    }
    for (int i = 0; i < count; ++i)
    {
      if (!known[i])
      {
        *last++ = nodes[i];
      }
    }
    const Index highest = count > 0 ? queue.interval(nodes[count - 1]) : 0;
    this->threads_.run(static_cast<Index>(last - unknown.begin()),
      [&](Index job, int thread)
      {
        Evaluation& evaluation = *unused[job];
        TriQuadCost& cost = this->costOf(thread);
        evaluation.removals = this->removals_;
        estimate(cost, unknown[job], evaluation);
        if (!evaluation.mayGo || evaluation.estimated > highest)
        {
          return;
        }
        if (evaluation.hasMore)
        {
          finish(cost, unknown[job], evaluation);
        }
        if (evaluation.mayGo && intervalOf(evaluation.patch) <= highest)
        {
          this->settle(cost, evaluation);
        }
      });
  }

  // Whether others are to go before a node that was evaluated; it is in the queue again then.
  static bool waits(HashQueue& queue, Index node, Index interval, Index current)
  {
    if (current > interval && !queue.empty() && current > queue.lowestInterval())
    {
      queue.insert(node, current);
      return true;
    }
    return false;
  }

  void prefetch(const HashQueue& queue) const
  {
    const Index next = queue.front();
    if (next != kNone)
    {
      this->topology_.prefetch(next);
      this->cost_.prefetch(next);
    }
  }

  // Make the collapse that was found, and write it down. Cells that stay come first, each fan's in
  // the order around the node, so that equal patches are equal steps.
  void remove(const TriQuadPatch& patch, RecordBuilder& builder)
  {
    std::array<int, kMaximumPatchCells> order;
    orderCells(patch, order);
    std::array<Index, kMaximumPatchCells> slots;
    std::array<std::array<unsigned char, 4>, kMaximumPatchCells> oldCells;
    std::array<std::array<unsigned char, 4>, kMaximumPatchCells> newCells;
    int count = 0;
    int vanished = patch.cellCount;
    for (int i = 0; i < patch.cellCount; ++i)
    {
      std::array<unsigned char, 4> cell;
      const bool stays = patch.newCell(order[i], patch.target, cell) != 0;
      const int place = stays ? count++ : --vanished;
      slots[place] = patch.slots[order[i]];
      oldCells[place] = emptyCornerLast(patch.cells[order[i]]);
      newCells[place] = emptyCornerLast(cell);
    }
    RecordBuilder::Step step;
    step.node = patch.node;
    step.ring = patch.ring.data();
    step.ringSize = patch.ringSize;
    step.oldCount = patch.cellCount;
    step.newCount = count;
    step.slots = slots.data();
    step.oldCells = oldCells[0].data();
    step.newCells = newCells[0].data();
    step.error = patch.error;
    builder.append(step);
    this->cost_.collapsed(patch);
    for (int f = 0; f < patch.fanCount; ++f)
    {
      this->topology_.collapse(patch.fans[f], patch.targetCopies[f]);
    }
    --this->nodesLeft_;
    if (!this->changed_.empty())
    {
      ++this->removals_;
      for (int i = 0; i < patch.ringSize; ++i)
      {
        this->changed_[patch.ring[i]] = this->removals_;
      }
    }
  }

  static std::array<unsigned char, 4> emptyCornerLast(std::array<unsigned char, 4> cell)
  {
    std::fill(std::remove(cell.begin(), cell.end(), kNoLocal), cell.end(), kNoLocal);
    return cell;
  }

  // Around the node, from a cell with the target on.
  static void orderCells(const TriQuadPatch& patch, std::array<int, kMaximumPatchCells>& order)
  {
    std::array<bool, kMaximumPatchCells> taken{};
    int count = 0;
    unsigned char edge = patch.target;
    while (count < patch.cellCount)
    {
      int next = kNone;
      for (int i = 0; i < patch.cellCount && next == kNone; ++i)
      {
        next = !taken[i] && besideNode(patch.cells[i], 1) == edge ? i : kNone;
      }
      // Another orientation, another fan, or an end of an open one.
      for (int i = 0; i < patch.cellCount && next == kNone; ++i)
      {
        next = taken[i] ? kNone : i;
      }
      taken[next] = true;
      order[count++] = next;
      edge = besideNode(patch.cells[next], 3);
    }
  }

  // The corner behind (offset 1) or before (offset 3) the node, past the empty one of a triangle.
  static unsigned char besideNode(const std::array<unsigned char, 4>& cell, int offset)
  {
    const auto place = std::find(cell.begin(), cell.end(), 0) - cell.begin();
    const unsigned char beside = cell[(place + offset) & 3];
    return beside != kNoLocal ? beside : cell[(place + 2) & 3];
  }

  void reinsertRing(const TriQuadPatch& patch, HashQueue& queue, Index interval)
  {
    for (int i = 0; i < patch.ringSize; ++i)
    {
      // Evaluated when its turn comes; one that waits outside, or that would fold something, gets a
      // new chance.
      const Index node = patch.ring[i];
      if (!this->kept_[node])
      {
        const bool stays = queue.contains(node) && !this->folds_[node];
        queue.insert(node, stays ? queue.interval(node) : interval);
      }
    }
  }

  TriQuadTopology& topology_;
  TriQuadCost& cost_;
  const std::vector<unsigned char>& kept_;
  const TriQuadDecimationOptions& options_;
  Monitor& monitor_;
  Threads& threads_;
  std::vector<TriQuadCost> otherCosts_; // of the threads but the first
  Index nodesLeft_;
  std::vector<unsigned char> folds_; // of a node: it was in the queue to go by folding something
  Index goal_ = 0;
  StopReason goalReason_ = StopReason::TargetReduction;
  Evaluation alone_;              // of the node at hand if it was not evaluated before
  std::vector<Evaluation> ahead_; // empty with one thread
  std::uint32_t removals_ = 0;
  std::vector<std::uint32_t> changed_; // removals when the cells of a node or its ring changed last
  int next_ = 0;                       // where in ahead_ the next node should be
  int used_ = 0;                       // since the last ones were evaluated
  int missed_ = 0;
  int wanted_ = 0; // of them
};

Outcome checkOptions(const TriQuadDecimationOptions& options, const TimeRows& positions)
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
  if (options.targetNodes < 0)
  {
    return invalid("TargetNodes", static_cast<double>(options.targetNodes), "0 or more");
  }
  if (!(options.maximumError >= 0.0))
  {
    return invalid("MaximumError", options.maximumError, "0 or more");
  }
  if (!(options.quadWeight >= 0.0) || !std::isfinite(options.quadWeight))
  {
    return invalid("QuadWeight", options.quadWeight, "0 or more, and finite");
  }
  if (!(options.scalarWeight >= 0.0) || !std::isfinite(options.scalarWeight))
  {
    return invalid("ScalarWeight", options.scalarWeight, "0 or more, and finite");
  }
  if (options.candidates < 1)
  {
    return invalid("The number of candidates", options.candidates, "1 or more");
  }
  for (const TimeArray& array : options.arrays)
  {
    if (!array.rows || array.rows->nodeCount() != positions.nodeCount() ||
      array.rows->steps() != positions.steps())
    {
      return { Status::InvalidArgument,
        "Nodal array '" + array.name + "' has other nodes or steps than the positions." };
    }
  }
  return {};
}

Outcome checkMesh(const TriQuadMeshView& mesh, const TimeRows& positions)
{
  constexpr std::int64_t kLimit = std::numeric_limits<Index>::max();
  if (mesh.nodeCount > kLimit || mesh.cellCount > kLimit / 4)
  {
    return { Status::TooLarge,
      "The mesh has " + std::to_string(mesh.nodeCount) + " nodes and " +
        std::to_string(mesh.cellCount) + " cells; at most " + std::to_string(kLimit) + " and " +
        std::to_string(kLimit / 4) + " fit into one piece. Split it into blocks." };
  }
  if (mesh.nodeCount < 0 || mesh.cellCount < 0 || (mesh.cellCount > 0 && !mesh.cells))
  {
    return { Status::InvalidArgument, "The mesh needs its cells and their number." };
  }
  if (positions.nodeCount() != mesh.nodeCount || positions.components() != 3)
  {
    return { Status::InvalidArgument,
      "There are positions of " + std::to_string(positions.nodeCount()) + " nodes for " +
        std::to_string(mesh.nodeCount) + " nodes." };
  }
  for (std::int64_t i = 0; i < kTriQuadCorners * mesh.cellCount; ++i)
  {
    const Index node = mesh.cells[i];
    const bool empty = node == kNone && i % kTriQuadCorners == kTriQuadCorners - 1;
    if (!empty && (node < 0 || node >= mesh.nodeCount))
    {
      return { Status::InvalidArgument,
        "Cell " + std::to_string(i / kTriQuadCorners) + " refers to node " + std::to_string(node) +
          ", but there are " + std::to_string(mesh.nodeCount) + " nodes." };
    }
  }
  return {};
}

/// Flag the nodes that are never candidates, and count them by reason.
std::vector<unsigned char> findKeptNodes(const TriQuadMeshView& mesh,
  const TriQuadTopology& topology, bool preserveBoundary, TriQuadDecimationResult& result)
{
  std::vector<unsigned char> kept(mesh.nodeCount, 0);
  for (Index node = 0; node < mesh.nodeCount; ++node)
  {
    Index* counter = nullptr;
    if (mesh.keep && mesh.keep[node])
    {
      counter = &result.requestedNodes;
    }
    else if (topology.kind(node) == TriQuadNodeKind::Unused)
    {
      counter = &result.unusedNodes;
    }
    else if (topology.kind(node) == TriQuadNodeKind::Irregular)
    {
      counter = &result.irregularNodes;
    }
    else if (preserveBoundary && topology.hasFreeEdge(node))
    {
      counter = &result.boundaryNodes;
    }
    else if (topology.kind(node) == TriQuadNodeKind::Seam)
    {
      ++result.seamNodes;
    }
    if (counter)
    {
      ++*counter;
      kept[node] = 1;
    }
  }
  return kept;
}

Outcome checkInput(
  const TriQuadMeshView& mesh, const TimeRows& positions, const TriQuadDecimationOptions& options)
{
  const Outcome outcome = checkOptions(options, positions);
  return outcome ? checkMesh(mesh, positions) : outcome;
}

Outcome run(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, Monitor& monitor, TriQuadDecimationResult& result)
{
  Threads threads(options.threads);
  TriQuadTopology topology(mesh);
  std::vector<unsigned char> kept = findKeptNodes(mesh, topology, options.preserveBoundary, result);
  const auto before = std::count(kept.begin(), kept.end(), 0);
  TriQuadCost cost(mesh, topology, positions, options, kept);
  result.nonFiniteNodes = static_cast<Index>(before - std::count(kept.begin(), kept.end(), 0));
  const Status status =
    TriQuadDecimation(topology, cost, kept, options, monitor, threads).run(result);
  return { status, status == Status::Cancelled ? "Cancelled." : "" };
}

} // namespace

Outcome decimateTriQuad(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, Monitor& monitor, TriQuadDecimationResult& result)
{
  return guarded("Not enough memory to decimate " + std::to_string(mesh.nodeCount) + " nodes at " +
      std::to_string(positions.steps()) + " time steps. Choose fewer steps.",
    result,
    [&]
    {
      const Outcome outcome = checkInput(mesh, positions, options);
      return outcome ? run(mesh, positions, options, monitor, result) : outcome;
    });
}

namespace
{

// A part of a longer call: fractions from `begin` to `end`.
Monitor partOf(Monitor& monitor, double begin, double end)
{
  return Monitor([&monitor, begin, end](double fraction)
    { return monitor.update(begin + (end - begin) * fraction); });
}

// The first, the last, and the step that is farthest from both.
std::vector<int> firstSteps(const TimeRows& positions)
{
  const int last = positions.steps() - 1;
  std::vector<int> steps{ 0 };
  double farthest = 0.0;
  int between = 0;
  for (int step = 1; step < last; ++step)
  {
    const double move = std::min(
      largestMove(positions, step, positions, 0), largestMove(positions, step, positions, last));
    if (move > farthest)
    {
      farthest = move;
      between = step;
    }
  }
  if (between > 0)
  {
    steps.push_back(between);
  }
  if (last > 0 && largestMove(positions, 0, positions, last) > 0.0)
  {
    steps.push_back(last);
  }
  return steps;
}

Outcome runWithSteps(const TriQuadMeshView& mesh, const TimeRows& positions,
  TriQuadDecimationOptions options, const std::vector<int>& steps, Monitor& monitor,
  TriQuadDecimationResult& result)
{
  const TimeRows some = positions.select(steps);
  std::vector<TimeRows> arrays;
  arrays.reserve(options.arrays.size());
  for (TimeArray& array : options.arrays)
  {
    arrays.push_back(array.rows->select(steps));
    array.rows = &arrays.back();
  }
  return decimateTriQuad(mesh, some, options, monitor, result);
}

Outcome runAutomatically(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, double factor, Monitor& monitor,
  TriQuadDecimationResult& result, std::vector<int>& steps)
{
  if (!(factor >= 1.0))
  {
    return { Status::InvalidArgument,
      "StepFactor is " + std::to_string(factor) + "; it must be 1 or more." };
  }
  Outcome outcome = checkInput(mesh, positions, options);
  if (!outcome)
  {
    return outcome;
  }
  steps = firstSteps(positions);
  TriQuadDecimationOptions measured = options;
  measured.criterion = TriQuadCriterion::Deviation;
  measured.allPositions = &positions;
  // How many rounds there will be is not known: each gets half of what is left.
  double done = 0.0;
  for (bool enough = false; !enough;)
  {
    Monitor part = partOf(monitor, done, 0.5 * (1.0 + done));
    done = 0.5 * (1.0 + done);
    outcome = runWithSteps(mesh, positions, measured, steps, part, result);
    if (!outcome)
    {
      break;
    }
    double chosen = 0.0;
    for (const int step : steps)
    {
      chosen = std::max(chosen, result.allStepErrors[step]);
    }
    const auto& errors = result.allStepErrors;
    const auto worst = std::max_element(errors.begin(), errors.end());
    enough = *worst <= factor * chosen;
    if (!enough)
    {
      const int step = static_cast<int>(worst - errors.begin());
      steps.insert(std::upper_bound(steps.begin(), steps.end(), step), step);
    }
  }
  if (outcome && options.criterion != TriQuadCriterion::Deviation)
  {
    Monitor part = partOf(monitor, done, 1.0);
    outcome = runWithSteps(mesh, positions, options, steps, part, result);
  }
  if (outcome && !monitor.update(1.0))
  {
    outcome = { Status::Cancelled, "Cancelled." };
  }
  return outcome;
}

} // namespace

Outcome decimateTriQuadAutomatically(const TriQuadMeshView& mesh, const TimeRows& positions,
  const TriQuadDecimationOptions& options, double factor, Monitor& monitor,
  TriQuadDecimationResult& result, std::vector<int>& steps)
{
  steps.clear();
  Outcome outcome = guarded("Not enough memory to choose among " +
      std::to_string(positions.steps()) + " time steps. Choose fewer steps.",
    result,
    [&] { return runAutomatically(mesh, positions, options, factor, monitor, result, steps); });
  if (!outcome)
  {
    steps.clear();
  }
  return outcome;
}

} // namespace undecimate
