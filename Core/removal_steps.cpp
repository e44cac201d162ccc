// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "removal_steps.h"

#include "cell_sources.h"
#include "hole_code.h"
#include "large_array.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <numeric>
#include <type_traits>

namespace undecimate
{

namespace
{

// What is in a removed node, in bytes from its begin:
//   0        kind
//   4 or 32  up to kHeader: the step's parts, at the end of this room; or, at its end, where they
//            are, if they do not fit
//   kHeader  counts and what else all steps have
// The parts are the corners of the node in the old triangles, the ears of the filling, the sources
// of the new triangles if they are tracked, and the ring of a hole that is not filled.
static_assert(std::is_trivially_copyable_v<MeshNode>, "a node is bytes here");
static_assert(offsetof(MeshNode, kind) == 0 && sizeof(NodeKind) == 1, "see above");
constexpr std::size_t kBegin = offsetof(MeshNode, value);
constexpr std::size_t kBeginBehindPosition = offsetof(MeshNode, neighbours);
static_assert(kBegin >= sizeof(NodeKind) && offsetof(MeshNode, position) >= kBegin, "see above");
static_assert(
  offsetof(MeshNode, position) + sizeof(Vector) <= kBeginBehindPosition, "the position stays");

struct Header
{
  unsigned char oldCount;
  bool boundary;
  bool elsewhere; // the parts
  bool hasSources;
  float error;
  Index later; // see RemovalChain
};
constexpr std::size_t kHeader = sizeof(MeshNode) - sizeof(Header);

unsigned char* bytesOf(MeshNode& node)
{
  return reinterpret_cast<unsigned char*>(&node);
}
const unsigned char* bytesOf(const MeshNode& node)
{
  return reinterpret_cast<const unsigned char*>(&node);
}

Header headerOf(const MeshNode& node)
{
  Header header;
  std::memcpy(&header, bytesOf(node) + kHeader, sizeof(header));
  return header;
}

void setHeader(MeshNode& node, const Header& header)
{
  std::memcpy(bytesOf(node) + kHeader, &header, sizeof(header));
}

const HoleCounts& countsOf(const Header& header)
{
  return kHoles[holeOf(header.oldCount, header.boundary)];
}

std::size_t partsSize(int oldCount, int newCount, bool hasSources)
{
  return sizeof(Corner) * oldCount + (hasSources ? 2 : 1) * newCount +
    (newCount == 0 ? 2 * sizeof(Index) : 0);
}

// A step as it is read.
struct Step
{
  Header header;
  const HoleCounts& counts;
  const unsigned char* corners; // of the node in the old triangles
  const unsigned char* ears;
  const unsigned char* sources;
  std::array<Index, 2> ring{ kNone, kNone }; // of a hole that is not filled

  explicit Step(const MeshNode& node)
    : header(headerOf(node))
    , counts(countsOf(this->header))
  {
    const std::size_t size =
      partsSize(this->counts.oldCount, this->counts.newCount, this->header.hasSources);
    const unsigned char* parts = bytesOf(node) + kHeader - size;
    if (this->header.elsewhere)
    {
      std::memcpy(&parts, bytesOf(node) + kHeader - sizeof(parts), sizeof(parts));
    }
    this->corners = parts;
    this->ears = parts + sizeof(Corner) * this->counts.oldCount;
    this->sources = this->ears + this->counts.newCount; // if there are some
    if (this->counts.newCount == 0)
    {
      std::memcpy(this->ring.data(), this->ears, sizeof(this->ring));
    }
  }

  Corner corner(int i) const
  {
    Corner corner = kNoCorner;
    std::memcpy(&corner, this->corners + sizeof(corner) * i, sizeof(corner));
    return corner;
  }
  Index slot(int i) const { return triangleOf(this->corner(i)); }
};

// The parts of a step; its numbers follow.
void writeForm(const Step& step, BitWriter& writer)
{
  for (int i = 0; i < step.counts.oldCount; ++i)
  {
    writer.add(static_cast<unsigned>(cornerOf(step.corner(i))), 2);
  }
  const int bits = step.counts.placeBits;
  for (int i = 0; i < step.counts.newCount; ++i)
  {
    writer.add(step.ears[i], bits);
  }
  for (int i = 0; step.header.hasSources && i < step.counts.newCount; ++i)
  {
    writer.add(step.sources[i], bits);
  }
}

} // namespace

StepWriter::StepWriter(bool trackSources, bool keepPositions)
  : trackSources_(trackSources)
  , keepPositions_(keepPositions)
{
}

unsigned char* StepWriter::allocate(std::size_t size)
{
  constexpr std::size_t kBlock = std::size_t{ 1 } << 12;
  static_assert((sizeof(Corner) + 2) * kMaximumPatchCells < kBlock, "");
  if (this->blocks_.empty() || this->used_ + size > kBlock)
  {
    this->blocks_.emplace_back(new unsigned char[kBlock]);
    this->used_ = 0;
  }
  unsigned char* memory = this->blocks_.back().get() + this->used_;
  this->used_ += size;
  return memory;
}

void StepWriter::write(
  TriangleTopology& topology, const Hole& hole, const HoleTriangulation& filling, double error)
{
  if (this->trackSources_)
  {
    findCellSources(topology, hole, filling, this->sources_.data());
  }
  MeshNode& node = topology.node(hole.node);
  const std::size_t size = partsSize(hole.triangleCount, filling.count, this->trackSources_);
  const std::size_t room = kHeader - (this->keepPositions_ ? kBeginBehindPosition : kBegin);
  Header header{ static_cast<unsigned char>(hole.triangleCount), hole.boundary, size > room,
    this->trackSources_, static_cast<float>(error), kNone };
  unsigned char* parts = bytesOf(node) + kHeader - size;
  if (header.elsewhere)
  {
    parts = this->allocate(size);
    std::memcpy(bytesOf(node) + kHeader - sizeof(parts), &parts, sizeof(parts));
  }
  setHeader(node, header);
  std::memcpy(parts, hole.corners.data(), sizeof(Corner) * hole.triangleCount);
  parts += sizeof(Corner) * hole.triangleCount;
  for (int i = 0; i < filling.count; ++i)
  {
    *parts++ = filling.triangles[i][1];
  }
  if (this->trackSources_)
  {
    parts = std::copy_n(this->sources_.begin(), filling.count, parts);
  }
  if (filling.count == 0)
  {
    std::memcpy(parts, hole.ring.data(), 2 * sizeof(Index));
  }
}

void RemovalChain::append(Index node)
{
  const Index place = this->count_ % kAhead;
  if (this->count_ < kAhead)
  {
    this->first_[place] = node;
  }
  else
  {
    MeshNode& earlier = this->topology_.node(this->last_[place]);
    Header header = headerOf(earlier);
    header.later = node;
    setHeader(earlier, header);
  }
  this->last_[place] = node;
  ++this->count_;
}

std::vector<Index> RemovalChain::nodes() const
{
  std::vector<Index> nodes(this->count_);
  std::copy_n(this->first_.begin(), std::min(this->count_, kAhead), nodes.begin());
  for (Index i = 0; i + kAhead < this->count_; ++i)
  {
    nodes[i + kAhead] = headerOf(this->topology_.node(nodes[i])).later;
    this->topology_.prefetchNode(nodes[i + kAhead]);
  }
  return nodes;
}

int cellsGone(const MeshNode& removed)
{
  return headerOf(removed).boundary ? 1 : 2;
}

void undo(TriangleTopology& topology, Index removed)
{
  const Step step(topology.node(removed));
  std::array<Index, kMaximumPolygon> ring;
  std::copy(step.ring.begin(), step.ring.end(), ring.begin());
  EarCutPolygon polygon(step.counts.ringSize);
  for (int i = 0; i < step.counts.newCount; ++i)
  {
    const auto& nodes = topology.triangle(step.slot(i)).nodes;
    polygon.cut(step.ears[i],
      [&](unsigned char before, unsigned char ear, unsigned char behind)
      {
        ring[before] = nodes[0];
        ring[ear] = nodes[1];
        ring[behind] = nodes[2];
      });
  }
  for (int i = 0; i < step.counts.oldCount; ++i)
  {
    auto& nodes = topology.triangle(step.slot(i)).nodes;
    const int corner = cornerOf(step.corner(i));
    nodes[corner] = removed;
    nodes[nextCorner(corner)] = ring[i];
    nodes[previousCorner(corner)] = ring[i + 1 == step.counts.ringSize ? 0 : i + 1];
  }
}

namespace
{

/// Makes the record in blocks of steps, nodes and triangles, each of them a job.
class RecordMaker
{
public:
  RecordMaker(
    TriangleTopology& topology, std::vector<Index>& removed, bool hasSources, Threads* threads)
    : topology_(topology)
    , removed_(removed)
    , threads_(threads)
    , steps_(static_cast<Index>(removed.size()))
  {
    Record& record = this->record_;
    record.hasSources = hasSources;
    record.hasCodes = true;
    record.nodeCount = topology.nodeCount();
    record.cellCount = topology.triangleCount();
    record.baseNodeCount = record.nodeCount - this->steps_;
    this->numberBits_ = record.view().numberBits();
  }

  Record make(std::vector<Index>& baseTriangles)
  {
    Record& record = this->record_;
    this->count();
    this->numberSlots();
    baseTriangles.resize(std::size_t{ 3 } * record.baseCellCount);
    this->forBlocks(record.cellCount,
      [&](Index begin, Index end)
      {
        for (Index slot = begin; slot < end; ++slot)
        {
          const Index place = this->slots_[slot];
          if (place < record.baseCellCount)
          {
            const auto& nodes = this->topology_.triangle(slot).nodes;
            std::copy(
              nodes.begin(), nodes.end(), baseTriangles.begin() + std::ptrdiff_t{ 3 } * place);
          }
        }
      });
    this->topology_.freeTriangles();
    // Room for both orders at once: asking for its pages takes as long as writing them.
    const std::function<void()> rooms[] = {
      [&record] { record.cellOrder.resize(record.cellCount); },
      [&record] { record.nodeOrder.resize(record.nodeCount); },
    };
    this->run(2, [&rooms](Index i) { rooms[i](); });
    this->invert(this->slots_, record.cellOrder);
    this->numberNodes();
    this->forBlocks(record.baseCellCount,
      [&](Index begin, Index end)
      {
        for (std::size_t i = std::size_t{ 3 } * begin; i < std::size_t{ 3 } * end; ++i)
        {
          baseTriangles[i] = this->nodes_[baseTriangles[i]];
        }
      });
    if (record.hasSources)
    {
      this->findSources();
      release(record.cellOrder); // the steps say it
    }
    this->writeSteps();
    release(this->removed_);
    this->topology_.freeNodes();
    return std::move(record);
  }

private:
  using Range = std::function<void(Index begin, Index end)>;

  // Of the steps [begin, end).
  struct Block
  {
    Index begin = 0;
    Index end = 0;
    std::size_t slots = 0; // that they free; later those that the blocks up to this one do
    std::size_t codes = 0;
    float error = 0.0F; // the largest one
  };

  void run(Index count, const std::function<void(Index)>& job)
  {
    if (this->threads_)
    {
      this->threads_->run(count, [&job](Index i, int /*thread*/) { job(i); });
      return;
    }
    for (Index i = 0; i < count; ++i)
    {
      job(i);
    }
  }

  void forBlocks(Index count, const Range& job)
  {
    constexpr Index kBlock = 1 << 15;
    const Index size = this->threads_ ? kBlock : std::max(count, kBlock);
    this->run(
      count / size + 1, [&](Index i) { job(i * size, i < count / size ? (i + 1) * size : count); });
  }

  template <typename Visit>
  void visitSteps(const Block& block, Visit&& visit)
  {
    constexpr Index kAhead = 12;
    for (Index i = block.begin; i < block.end; ++i)
    {
      this->topology_.prefetchNode(this->removed_[std::min(i + kAhead, block.end - 1)]);
      visit(i, this->topology_.node(this->removed_[i]));
    }
  }

  // Cut the steps into blocks and count what they have.
  void count()
  {
    constexpr Index kSmallest = 1 << 12;
    constexpr Index kBlocksOfThread = 4;
    const Index wanted = this->threads_ ? kBlocksOfThread * this->threads_->count() : 1;
    const Index blocks = std::clamp<Index>(this->steps_ / kSmallest, 1, wanted);
    this->blocks_.resize(blocks);
    this->run(blocks,
      [&](Index i)
      {
        Block block; // not in the list of blocks, where other threads write beside it
        block.begin = static_cast<Index>(std::int64_t{ this->steps_ } * i / blocks);
        block.end = static_cast<Index>(std::int64_t{ this->steps_ } * (i + 1) / blocks);
        this->visitSteps(block,
          [&](Index /*step*/, const MeshNode& node)
          {
            const Header header = headerOf(node);
            const HoleCounts& counts = countsOf(header);
            block.slots += counts.oldCount - counts.newCount;
            block.codes += counts.codeSize(header.hasSources, this->numberBits_);
            block.error = std::max(block.error, header.error);
          });
        this->blocks_[i] = block;
      });
    for (Index i = 1; i < blocks; ++i)
    {
      Block& block = this->blocks_[i];
      const Block& before = this->blocks_[i - 1];
      block.slots += before.slots;
      block.codes += before.codes;
      block.error = std::max(block.error, before.error);
    }
    this->record_.baseCellCount =
      this->record_.cellCount - static_cast<Index>(this->blocks_.back().slots);
  }

  // Number the entries that have none yet, in their order.
  void numberRest(LargeArray<Index>& numbers)
  {
    const Index count = static_cast<Index>(numbers.size());
    constexpr Index kBlock = 1 << 15;
    std::vector<Index> firsts(count / kBlock + std::size_t{ 2 }, 0);
    const auto end = [&](Index block)
    { return block < count / kBlock ? (block + 1) * kBlock : count; };
    this->run(count / kBlock + 1,
      [&](Index block)
      {
        firsts[block + std::size_t{ 1 }] = static_cast<Index>(
          std::count(numbers.begin() + block * kBlock, numbers.begin() + end(block), kNone));
      });
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
    this->run(count / kBlock + 1,
      [&](Index block)
      {
        Index next = firsts[block];
        for (Index i = block * kBlock; i < end(block); ++i)
        {
          if (numbers[i] == kNone)
          {
            numbers[i] = next++;
          }
        }
      });
  }

  // The last step that is removed comes back first, and its slots in their order.
  void numberSlots()
  {
    this->slots_.assign(this->record_.cellCount, kNone);
    this->run(static_cast<Index>(this->blocks_.size()),
      [&](Index i)
      {
        const std::size_t before = i == 0 ? 0 : this->blocks_[i - std::size_t{ 1 }].slots;
        Index end = this->record_.cellCount - static_cast<Index>(before);
        this->visitSteps(this->blocks_[i],
          [&](Index /*step*/, const MeshNode& node)
          {
            const Step step(node);
            const HoleCounts& counts = step.counts;
            end -= counts.oldCount - counts.newCount;
            for (int k = counts.newCount; k < counts.oldCount; ++k)
            {
              this->slots_[step.slot(k)] = end + k - counts.newCount;
            }
          });
      });
    this->numberRest(this->slots_);
  }

  void numberNodes()
  {
    this->nodes_.assign(this->record_.nodeCount, kNone);
    this->forBlocks(this->steps_,
      [&](Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          this->nodes_[this->removed_[i]] = this->record_.nodeCount - 1 - i;
        }
      });
    this->numberRest(this->nodes_);
    this->invert(this->nodes_, this->record_.nodeOrder);
  }

  void invert(const LargeArray<Index>& numbers, std::vector<Index>& order)
  {
    this->forBlocks(static_cast<Index>(numbers.size()),
      [&](Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          order[numbers[i]] = i;
        }
      });
  }

  // Walk the removals and note which sources are lost. They come back in reverse.
  void findSources()
  {
    Record& record = this->record_;
    std::vector<Index> sources(record.cellCount);
    std::iota(sources.begin(), sources.end(), 0);
    struct Lost
    {
      unsigned char count = 0;
      unsigned char placeBits = 0;
    };
    std::vector<Lost> losses; // of the steps
    losses.reserve(this->steps_);
    std::vector<Index> lost; // original triangles, or -1 - place
    std::int64_t bits = 0;
    for (const Block& block : this->blocks_)
    {
      this->visitSteps(block,
        [&](Index /*step*/, const MeshNode& node)
        {
          const Step step(node);
          std::array<Index, kMaximumPatchCells> old;
          for (int i = 0; i < step.counts.oldCount; ++i)
          {
            old[i] = sources[step.slot(i)];
          }
          Lost loss;
          loss.placeBits = step.counts.placeBits;
          KnownSources known(
            step.counts.newCount, step.counts.oldCount, [&step](int i) { return step.sources[i]; });
          for (int i = 0; i < step.counts.oldCount; ++i)
          {
            if (known.has(i))
            {
              continue;
            }
            const int place = known.placeOf(old[i], old.data());
            known.add(i);
            lost.push_back(place < 0 ? old[i] : -1 - place);
            bits += 1 + (place < 0 ? this->numberBits_ : loss.placeBits);
            ++loss.count;
          }
          for (int i = 0; i < step.counts.newCount; ++i)
          {
            sources[step.slot(i)] = old[step.sources[i]];
          }
          losses.push_back(loss);
        });
    }
    record.baseSources.resize(record.baseCellCount);
    for (Index i = 0; i < record.baseCellCount; ++i)
    {
      record.baseSources[i] = sources[record.cellOrder[i]];
    }
    release(sources);
    record.lostSourceCodes.resize(static_cast<std::size_t>(packedSize(bits)), 0);
    BitWriter writer(record.lostSourceCodes.data());
    auto begin = lost.end();
    for (auto loss = losses.rbegin(); loss != losses.rend(); ++loss)
    {
      begin -= loss->count;
      for (auto source = begin; source != begin + loss->count; ++source)
      {
        writer.add(*source < 0 ? 1 : 0, 1);
        writer.add(
          *source < 0 ? -1 - *source : *source, *source < 0 ? loss->placeBits : this->numberBits_);
      }
    }
    writer.finish();
  }

  void writeSteps()
  {
    Record& record = this->record_;
    const std::function<void()> rooms[] = {
      [&] { record.codes.resize(this->blocks_.back().codes + kPackedPadding, 0); },
      [&] { record.stepErrors.resize(this->steps_); },
      [&] { record.stepHoles.resize(this->steps_); },
    };
    this->run(3, [&rooms](Index i) { rooms[i](); });
    this->run(static_cast<Index>(this->blocks_.size()), [this](Index i) { this->writeBlock(i); });
  }

  void writeBlock(Index number)
  {
    Record& record = this->record_;
    const Block before = number == 0 ? Block() : this->blocks_[number - std::size_t{ 1 }];
    float error = before.error;
    unsigned char* code = record.codes.data() + record.codes.size() - kPackedPadding - before.codes;
    this->visitSteps(this->blocks_[number],
      [&](Index i, const MeshNode& node)
      {
        const Step step(node);
        const HoleCounts& counts = step.counts;
        error = std::max(error, step.header.error);
        const Index place = this->steps_ - 1 - i;
        record.stepHoles[place] = holeOf(step.header.oldCount, step.header.boundary);
        record.stepErrors[place] = error;
        code -= counts.codeSize(step.header.hasSources, this->numberBits_);
        BitWriter writer(code);
        writeForm(step, writer);
        for (int k = 0; k < counts.newCount; ++k)
        {
          writer.add(this->slots_[step.slot(k)], this->numberBits_);
        }
        for (int k = 0; k < counts.extra; ++k)
        {
          writer.add(this->nodes_[step.ring[k]], this->numberBits_);
        }
        writer.finish();
      });
  }

  TriangleTopology& topology_;
  std::vector<Index>& removed_;
  Threads* threads_;
  Index steps_;
  int numberBits_ = 0;
  Record record_;
  std::vector<Block> blocks_;
  LargeArray<Index> slots_; // record numbers of the slots
  LargeArray<Index> nodes_; // and of the nodes
};

} // namespace

Record recordOf(TriangleTopology& topology, std::vector<Index>& removed, bool hasSources,
  std::vector<Index>& baseTriangles, Threads* threads)
{
  return RecordMaker(topology, removed, hasSources, threads).make(baseTriangles);
}

} // namespace undecimate
