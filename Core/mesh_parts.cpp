// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_parts.h"

#include "compiler.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace undecimate
{

namespace
{

constexpr Index kBlock = 1 << 14;        // nodes of a job before there are parts
constexpr Index kMaximumParts = 1 << 12; // a table has an entry for each pair of old and new ones
constexpr Index kAhead = 16;             // nodes, of a prefetch

// Along each axis: bits of a node's place in the cube, and of the cube's place in the cells, which
// span two cubes.
constexpr int kPlaceBits = 10;
constexpr std::uint32_t kPlaces = 1 << kPlaceBits;

// Bits of a row of cells: a part has several cells. More of them cost more time than shorter seams
// save.
int rowBits(Index nodes)
{
  return nodes > 4000000 ? 7 : nodes > 60000 ? 6 : 5;
}

// Three bits apart.
std::uint32_t spread(std::uint32_t x)
{
  x = (x | x << 16) & 0x030000FFU;
  x = (x | x << 8) & 0x0300F00FU;
  x = (x | x << 4) & 0x030C30C3U;
  return (x | x << 2) & 0x09249249U;
}

// A place in a row by an irrational number: evenly spread over the rounds.
std::uint32_t placeOf(int round, double number)
{
  const double x = 0.5 + round * number;
  return static_cast<std::uint32_t>((x - std::floor(x)) * kPlaces);
}

} // namespace

MeshParts::MeshParts(const TriangleTopology& topology, Threads& threads)
  : threads_(threads)
  , nodes_(topology.nodeCount())
  , spare_(topology.nodeCount())
  , places_(topology.nodeCount())
  , cells_(topology.nodeCount())
  , partOf_(topology.nodeCount())
{
  const Index nodeCount = topology.nodeCount();
  const Index block = std::max(kBlock, nodeCount / kMaximumParts + 1);
  for (Index begin = 0; begin < nodeCount; begin += std::min(block, nodeCount - begin))
  {
    this->parts_.push_back({ begin, begin + std::min(block, nodeCount - begin) });
  }
  std::vector<Box> boxes(this->parts_.size());
  threads.run(this->count(),
    [&](Index part, int /*thread*/)
    {
      Box box;
      for (Index node = this->parts_[part].begin; node < this->parts_[part].end; ++node)
      {
        this->nodes_[node] = node;
        const Vector& p = topology.node(node).position;
        if (isFinite(p))
        {
          box.add(p);
        }
      }
      boxes[part] = box;
    });
  Box all;
  for (const Box& box : boxes)
  {
    all.add(box);
  }
  const double size =
    std::max({ all.high.x - all.low.x, all.high.y - all.low.y, all.high.z - all.low.z });
  const double scale = size > 0.0 && std::isfinite(size) ? kPlaces / size : 0.0;
  const auto along = [scale](double x, double low)
  {
    const double place = (x - low) * scale;
    constexpr double kLast = kPlaces - 1;
    return place >= 0.0 ? static_cast<std::uint32_t>(std::min(place, kLast)) : 0U; // NaN: 0
  };
  threads.run(this->count(),
    [&](Index part, int /*thread*/)
    {
      for (Index node = this->parts_[part].begin; node < this->parts_[part].end; ++node)
      {
        const Vector& p = topology.node(node).position;
        this->places_[node] = along(p.x, all.low.x) | along(p.y, all.low.y) << kPlaceBits |
          along(p.z, all.low.z) << 2 * kPlaceBits;
      }
    });
}

Index MeshParts::nodesLeft() const
{
  Index nodes = 0;
  for (const Range& part : this->parts_)
  {
    nodes += part.end - part.begin;
  }
  return nodes;
}

void MeshParts::cut(int round, Index partNodes)
{
  const Index left = this->nodesLeft();
  const int bits = rowBits(left);
  const std::uint32_t shift[] = { placeOf(round, 0.8191725133961645),
    placeOf(round, 0.6710436067037893), placeOf(round, 0.5497004779019702) };
  const auto cellOf = [&](Index node)
  {
    const std::uint32_t place = this->places_[node];
    const auto along = [&](int axis)
    {
      const std::uint32_t x = place >> axis * kPlaceBits & (kPlaces - 1);
      return spread((x + shift[axis]) >> (kPlaceBits + 1 - bits)) << axis;
    };
    return along(0) | along(1) | along(2);
  };

  // Nodes of each cell; the cell of each node stays for the next two passes.
  std::vector<std::atomic<Index>> counts(std::size_t{ 1 } << 3 * bits);
  for (std::atomic<Index>& count : counts)
  {
    count.store(0, std::memory_order_relaxed);
  }
  this->threads_.run(this->count(),
    [&](Index part, int /*thread*/)
    {
      // Many nodes have the cell of the one before; other threads may count the same cell.
      const Range here = this->parts_[part];
      std::uint32_t cell = 0;
      Index count = 0;
      const auto add = [&] { counts[cell].fetch_add(count, std::memory_order_relaxed); };
      for (Index i = here.begin; i < here.end; ++i)
      {
        prefetch(&this->places_[this->nodes_[std::min(i + kAhead, here.end - 1)]]);
        this->cells_[i] = cellOf(this->nodes_[i]);
        if (this->cells_[i] != cell)
        {
          add();
          cell = this->cells_[i];
          count = 0;
        }
        ++count;
      }
      add();
    });

  // From here on the part of each cell.
  const Index wanted = std::clamp<Index>(left / std::max<Index>(1, partNodes), 1, kMaximumParts);
  std::int64_t before = 0;
  Index last = -1;
  Index lastWanted = -1;
  for (std::atomic<Index>& count : counts)
  {
    const Index nodes = count.load(std::memory_order_relaxed);
    if (nodes > 0)
    {
      const Index part = static_cast<Index>(before * wanted / left);
      last += part > lastWanted ? 1 : 0;
      lastWanted = part;
      before += nodes;
    }
    count.store(last, std::memory_order_relaxed);
  }
  const Index newCount = last + 1;

  // Where the nodes of each old part go in each new one: rows of whole cache lines.
  constexpr std::size_t kLine = kCacheLine / sizeof(Index);
  const std::size_t row = (newCount + kLine - 1) / kLine * kLine;
  LargeArray<Index> places(row * this->count(), 0);
  this->threads_.run(this->count(),
    [&](Index old, int /*thread*/)
    {
      Index* sizes = places.data() + row * old;
      for (Index i = this->parts_[old].begin; i < this->parts_[old].end; ++i)
      {
        this->cells_[i] = counts[this->cells_[i]].load(std::memory_order_relaxed);
        ++sizes[this->cells_[i]];
      }
    });
  std::vector<Range> parts;
  Index end = 0;
  for (Index part = 0; part < newCount; ++part)
  {
    const Index begin = end;
    for (Index old = 0; old < this->count(); ++old)
    {
      Index& size = places[row * old + part];
      end += size;
      size = end - size;
    }
    parts.push_back({ begin, end });
  }
  this->threads_.run(this->count(),
    [&](Index old, int /*thread*/)
    {
      Index* to = places.data() + row * old;
      for (Index i = this->parts_[old].begin; i < this->parts_[old].end; ++i)
      {
        const Index node = this->nodes_[i];
        const Index part = static_cast<Index>(this->cells_[i]);
        this->spare_[to[part]++] = node;
        this->partOf_[node] = static_cast<std::uint16_t>(part);
      }
    });
  this->nodes_.swap(this->spare_);
  this->parts_.swap(parts);
}

void MeshParts::release()
{
  undecimate::release(this->nodes_);
  undecimate::release(this->spare_);
  undecimate::release(this->places_);
  undecimate::release(this->cells_);
  undecimate::release(this->partOf_);
}

void MeshParts::join()
{
  Index end = 0;
  for (const Range& part : this->parts_)
  {
    std::copy(this->nodes_.begin() + part.begin, this->nodes_.begin() + part.end,
      this->nodes_.begin() + end);
    end += part.end - part.begin;
  }
  std::sort(this->nodes_.begin(), this->nodes_.begin() + end);
  this->parts_.assign(1, { 0, end });
  std::fill(this->partOf_.begin(), this->partOf_.end(), static_cast<std::uint16_t>(0));
}

} // namespace undecimate
