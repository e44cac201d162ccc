// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Bytes a node of the core's calls, counted in the C library's allocation functions.
//
//   memory_test [grid size]
//
// Prints what Documentation/memory.md states and fails when a bound there is broken.

#include "hash_queue_decimation.h"
#include "tri_quad_decimation.h"
#include "undecimation.h"

#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <malloc.h>

namespace
{
std::size_t liveBytes = 0;
std::size_t peakBytes = 0;

// Around a block of posix_memalign() there is address space that nobody touches: what was asked for
// counts. Only large arrays come from there, of which there are few at a time.
struct AlignedBlock
{
  void* memory = nullptr;
  std::size_t size = 0;
};
AlignedBlock alignedBlocks[64];

AlignedBlock* alignedBlock(void* memory)
{
  for (AlignedBlock& block : alignedBlocks)
  {
    if (block.memory == memory)
    {
      return &block;
    }
  }
  return nullptr;
}

std::size_t sizeOf(void* memory)
{
  const AlignedBlock* block = memory ? alignedBlock(memory) : nullptr;
  return block ? block->size : malloc_usable_size(memory); // 0 for null
}

void forget(void* memory)
{
  liveBytes -= sizeOf(memory);
  if (AlignedBlock* block = memory ? alignedBlock(memory) : nullptr)
  {
    block->memory = nullptr;
  }
}

void* counted(void* memory)
{
  liveBytes += sizeOf(memory);
  peakBytes = liveBytes > peakBytes ? liveBytes : peakBytes;
  return memory;
}
}

// The GNU C library's own functions, behind ours of the usual names.
extern "C"
{
  void* __libc_malloc(std::size_t);
  void* __libc_calloc(std::size_t, std::size_t);
  void* __libc_realloc(void*, std::size_t);
  void* __libc_memalign(std::size_t, std::size_t);
  void __libc_free(void*);

  void* malloc(std::size_t size)
  {
    return counted(__libc_malloc(size));
  }
  void* calloc(std::size_t count, std::size_t size)
  {
    return counted(__libc_calloc(count, size));
  }
  void* realloc(void* memory, std::size_t size)
  {
    forget(memory);
    return counted(__libc_realloc(memory, size));
  }
  void* aligned_alloc(std::size_t alignment, std::size_t size)
  {
    return counted(__libc_memalign(alignment, size));
  }
  int posix_memalign(void** memory, std::size_t alignment, std::size_t size)
  {
    *memory = __libc_memalign(alignment, size);
    AlignedBlock* block = alignedBlock(nullptr);
    if (!*memory || !block)
    {
      return ENOMEM;
    }
    *block = { *memory, size };
    counted(*memory);
    return 0;
  }
  void free(void* memory)
  {
    forget(memory);
    __libc_free(memory);
  }
}

namespace
{
using namespace undecimate;

struct Grid
{
  std::vector<float> points;
  std::vector<float> values;
  std::vector<Index> triangles;
  TriangleMeshView view;

  explicit Grid(Index n)
  {
    for (Index i = 0; i < n * n; ++i)
    {
      const float x = static_cast<float>(i % n) / static_cast<float>(n - 1);
      const float y = static_cast<float>(i / n) / static_cast<float>(n - 1);
      const float z = std::sin(6 * x) * std::cos(4 * y) + 0.3F * std::sin(15 * x * y);
      this->points.insert(this->points.end(), { x, y, 0.1F * z });
      this->values.push_back(std::exp(-8 * ((x - 0.4F) * (x - 0.4F) + (y - 0.6F) * (y - 0.6F))));
      if (i % n < n - 1 && i / n < n - 1)
      {
        this->triangles.insert(this->triangles.end(), { i, i + 1, i + n + 1, i, i + n + 1, i + n });
      }
    }
    this->view.pointsFloat = this->points.data();
    this->view.nodeCount = n * n;
    this->view.triangles = this->triangles.data();
    this->view.triangleCount = static_cast<std::int64_t>(this->triangles.size()) / 3;
  }
};

int faults = 0;

void check(const char* what, double bytes, double bound)
{
  const bool good = bytes <= bound;
  std::printf("  %-44s %7.1f, at most %5.0f%s\n", what, bytes, bound, good ? "" : "  TOO MUCH");
  faults += !good;
}

void checkRecord(
  const Record& record, const std::vector<Index>& baseCells, double recordBound, double cursorBound)
{
  const double nodes = record.nodeCount;
  const double removed = nodes - record.baseNodeCount;
  check("record, a removed node", static_cast<double>(record.byteSize()) / removed, recordBound);
  const std::size_t before = liveBytes;
  peakBytes = liveBytes;
  Undecimation cursor;
  if (!cursor.open(record.view(), baseCells.data()))
  {
    ++faults;
  }
  cursor.moveTo(cursor.stepCount());
  check("cursor, a node", static_cast<double>(liveBytes - before) / nodes, cursorBound);
  check("opening it, largest, a node", static_cast<double>(peakBytes - before) / nodes,
    cursorBound + 1);
}

enum class Way
{
  Plain,
  WithSources, // of cell data
  Parallel     // by one thread: the counters know no others, which need little of their own
};

// Most bytes of a removed node in the record. An order that ignores the mesh has large holes.
double recordBound(Criterion criterion, Way way)
{
  const bool sources = way == Way::WithSources;
  return criterion == Criterion::AngleToXYPlane ? (sources ? 60 : 56) : (sources ? 32 : 33);
}

void measure(const Grid& grid, const char* name, Criterion criterion, Way way, double peakBound)
{
  const bool sources = way == Way::WithSources;
  HashQueueDecimationOptions options;
  options.criterion = criterion;
  options.targetReduction = 0.99;
  options.trackCellSources = sources;
  options.parallel = way == Way::Parallel;
  options.threads = 1;
  NodalArrayView array;
  array.values = grid.values.data();
  options.arrays = { array };

  const double nodes = static_cast<double>(grid.view.nodeCount);
  const std::size_t before = liveBytes;
  peakBytes = liveBytes;
  Monitor monitor;
  HashQueueDecimationResult result;
  if (const Outcome outcome = decimate(grid.view, options, monitor, result); !outcome)
  {
    std::printf("%s\n", outcome.message.c_str());
    ++faults;
    return;
  }
  const char* const ways[] = { "", ", with sources of cell data", ", parallel" };
  std::printf("%s%s, %.0f nodes to %d\n", name, ways[static_cast<int>(way)], nodes,
    result.record.baseNodeCount);
  check("decimation, largest, a node", static_cast<double>(peakBytes - before) / nodes, peakBound);
  checkRecord(result.record, result.baseTriangles, recordBound(criterion, way), sources ? 33 : 25);
}

// Quads that move over time, without the positions, which are the caller's.
void measureOverTime(
  const Grid& grid, const char* name, TriQuadCriterion criterion, int steps, double peakBound)
{
  const auto nodes = static_cast<Index>(grid.view.nodeCount);
  std::vector<Index> cells; // two triangles a quad: 0 1 2, 0 2 3
  for (std::size_t i = 0; i < grid.triangles.size(); i += 6)
  {
    const Index* corner = grid.triangles.data() + i;
    cells.insert(cells.end(), { corner[0], corner[1], corner[2], corner[5] });
  }
  TriQuadMeshView view;
  view.nodeCount = nodes;
  view.cells = cells.data();
  view.cellCount = static_cast<std::int64_t>(cells.size()) / 4;
  const PositionFrame frame =
    positionFrame(grid.points.data(), static_cast<const float*>(nullptr), nodes);
  TimeRows positions(nodes, 3, steps);
  std::vector<float> points = grid.points;
  for (int step = 0; step < steps; ++step)
  {
    positions.set(
      step, points.data(), static_cast<const float*>(nullptr), frame.origin.data(), frame.scale);
    for (Index i = 0; i < nodes; ++i)
    {
      points[3 * i + 2] += 0.002F * std::sin(9.0F * points[3 * i]);
    }
  }

  TriQuadDecimationOptions options;
  options.threads = 1; // what several hold at the same time is up to them
  options.criterion = criterion;
  options.targetReduction = 0.99;
  const std::size_t before = liveBytes;
  peakBytes = liveBytes;
  Monitor monitor;
  TriQuadDecimationResult result;
  if (const Outcome outcome = decimateTriQuad(view, positions, options, monitor, result); !outcome)
  {
    std::printf("%s\n", outcome.message.c_str());
    ++faults;
    return;
  }
  std::printf(
    "Quads, %s, %d time steps, %d nodes to %d\n", name, steps, nodes, result.record.baseNodeCount);
  check("decimation, largest, a node", static_cast<double>(peakBytes - before) / nodes, peakBound);
  checkRecord(result.record, result.baseCells, 34, 17);
}
}

int main(int argc, char* argv[])
{
  if (argc == 1)
  {
    // So large that its arrays lie in huge pages.
    measure(Grid(500), "Quadric", Criterion::Quadric, Way::Plain, 162);
  }
  const Grid grid(argc > 1 ? std::atoi(argv[1]) : 200);
  measure(grid, "Scalar Difference", Criterion::ScalarDifference, Way::Plain, 155);
  measure(grid, "Quadric", Criterion::Quadric, Way::Plain, 170);
  measure(grid, "Deviation", Criterion::Deviation, Way::Plain, 230);
  measure(grid, "Scalar Difference", Criterion::ScalarDifference, Way::WithSources, 155);
  measure(grid, "Angle to XY Plane", Criterion::AngleToXYPlane, Way::Plain, 190);
  measure(grid, "Angle to XY Plane", Criterion::AngleToXYPlane, Way::WithSources, 210);
  measure(grid, "Scalar Difference", Criterion::ScalarDifference, Way::Parallel, 172);
  measure(grid, "Quadric", Criterion::Quadric, Way::Parallel, 205);
  measure(grid, "Deviation", Criterion::Deviation, Way::Parallel, 250);
  measureOverTime(grid, "Deviation", TriQuadCriterion::Deviation, 3, 420);
  measureOverTime(grid, "Deviation", TriQuadCriterion::Deviation, 25, 1850);
  measureOverTime(grid, "Quadrics", TriQuadCriterion::Quadrics, 25, 1700);
  return faults == 0 ? 0 : 1;
}
