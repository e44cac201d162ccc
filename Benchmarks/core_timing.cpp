// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file core_timing.cpp
/// @brief CPU time of the core on grids: decimation, undecimation, a change of level.
///
///   core_timing linear MESH TARGET_NODES REPS [deviation|quadric]
///     decimation, by Scalar Difference without a word, and undecimation of all nodes
///   core_timing level MESH TARGET_NODES REPS
///     a change of level by 1 % against memcpy
///
/// A mesh file is that of decimate_cli.cpp. Prints one JSON object; times are CPU seconds
/// (medians).

#include "hash_queue_decimation.h"
#include "undecimation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace
{

using undecimate::Index;

double cpuSeconds()
{
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

struct Mesh
{
  std::int64_t header[6] = {};
  std::vector<double> points;
  std::vector<Index> triangles;
  std::vector<float> values;
};

template <typename T>
void readArray(std::ifstream& in, std::vector<T>& array, std::int64_t size)
{
  array.resize(static_cast<std::size_t>(size));
  in.read(
    reinterpret_cast<char*>(array.data()), static_cast<std::streamsize>(array.size() * sizeof(T)));
}

bool readMesh(const std::string& name, Mesh& mesh)
{
  std::ifstream in(name, std::ios::binary);
  in.read(reinterpret_cast<char*>(mesh.header), sizeof(mesh.header));
  if (!in || mesh.header[2] != 8 || mesh.header[3] != 1)
  {
    return false;
  }
  readArray(in, mesh.points, 3 * mesh.header[0]);
  readArray(in, mesh.triangles, 3 * mesh.header[1]);
  readArray(in, mesh.values, mesh.header[0]);
  return static_cast<bool>(in);
}

struct Run
{
  undecimate::HashQueueDecimationResult result;
  double decimation = 0.0;
};

// A virtual machine asks its host for memory that was not used for a while, in a time that has
// nothing to do with us: as much as we need is at hand before the clock starts.
void touchMemory(std::size_t bytes)
{
  std::vector<char> memory(bytes);
  volatile char* const pages = memory.data();
  for (std::size_t i = 0; i < bytes; i += 1024)
  {
    pages[i] = 1;
  }
}

bool decimate(const Mesh& mesh, std::int64_t nodes, undecimate::Criterion criterion, Run& run)
{
  undecimate::TriangleMeshView view;
  view.pointsDouble = mesh.points.data();
  view.nodeCount = mesh.header[0];
  view.triangles = mesh.triangles.data();
  view.triangleCount = mesh.header[1];
  undecimate::HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  options.targetNodes = nodes;
  options.criterion = criterion;
  if (criterion == undecimate::Criterion::ScalarDifference)
  {
    undecimate::NodalArrayView array;
    array.values = mesh.values.data();
    array.name = "scalar";
    options.arrays.push_back(array);
  }
  undecimate::Monitor monitor;
  const double start = cpuSeconds();
  const undecimate::Outcome outcome = undecimate::decimate(view, options, monitor, run.result);
  run.decimation = cpuSeconds() - start;
  if (!outcome)
  {
    std::cerr << outcome.message << "\n";
  }
  return static_cast<bool>(outcome);
}

bool sameMesh(const Mesh& mesh, const undecimate::Undecimation& cursor)
{
  if (cursor.nodeCount() != mesh.header[0] || cursor.cellCount() != mesh.header[1])
  {
    return false;
  }
  const undecimate::RecordView& record = cursor.record();
  for (Index slot = 0; slot < cursor.cellCount(); ++slot)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      if (record.nodeOrder[cursor.cells()[3 * slot + corner]] !=
        mesh.triangles[3 * static_cast<std::size_t>(cursor.shownCells()[slot]) + corner])
      {
        return false;
      }
    }
  }
  return true;
}

int linear(const Mesh& mesh, std::int64_t nodes, int reps, undecimate::Criterion criterion)
{
  std::vector<double> forth;
  std::vector<double> open;
  std::vector<double> back;
  Run run;
  bool exact = true;
  std::size_t bytes = 0;
  for (int r = 0; r < reps; ++r)
  {
    constexpr std::size_t kBytes = 256; // a node
    touchMemory(kBytes * mesh.header[0]);
    if (!decimate(mesh, nodes, criterion, run))
    {
      return 1;
    }
    forth.push_back(run.decimation);
    bytes = run.result.record.byteSize();
    undecimate::Undecimation cursor;
    double start = cpuSeconds();
    if (!cursor.open(run.result.record.view(), run.result.baseTriangles.data()))
    {
      return 1;
    }
    open.push_back(cpuSeconds() - start);
    start = cpuSeconds();
    cursor.moveTo(cursor.stepCount());
    back.push_back(cpuSeconds() - start);
    exact = exact && sameMesh(mesh, cursor);
  }
  std::printf("{\"nodes\": %lld, \"left\": %lld, \"decimation\": %.6f, \"open\": %.6f, "
              "\"undecimation\": %.6f, \"exact\": %s, \"record_bytes\": %zu, \"stop\": \"%s\", "
              "\"runs\": %d}\n",
    static_cast<long long>(mesh.header[0]), static_cast<long long>(run.result.record.baseNodeCount),
    median(forth), median(open), median(back), exact ? "true" : "false", bytes,
    undecimate::toString(run.result.stopReason), reps);
  return exact ? 0 : 1;
}

/// The arrays that a filter hands out at a level: points, triangles in 64-bit ids with their
/// offsets, the nodal array. Made once; a change of level writes their prefixes anew.
struct Output
{
  std::vector<double> points;
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets;
  std::vector<float> values;
};

/// Walk the levels 0, 1 %, ... 99 % and back, and time the change of the cursor, the plain copy
/// of arrays of the size of the output, and the change plus handing out (filling the same arrays).
int level(const Mesh& mesh, std::int64_t nodes, int reps)
{
  Run run;
  undecimate::Undecimation cursor;
  if (!decimate(mesh, nodes, undecimate::Criterion::ScalarDifference, run) ||
    !cursor.open(run.result.record.view(), run.result.baseTriangles.data()))
  {
    return 1;
  }
  const std::size_t n = static_cast<std::size_t>(mesh.header[0]);
  const std::size_t m = static_cast<std::size_t>(mesh.header[1]);
  // Points and values in record order: what the record's mesh carries.
  Output source;
  source.points.resize(3 * n);
  source.values.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t from = static_cast<std::size_t>(run.result.record.nodeOrder[i]);
    std::copy_n(&mesh.points[3 * from], 3, &source.points[3 * i]);
    source.values[i] = mesh.values[from];
  }
  source.connectivity.assign(3 * m, 0);
  source.offsets.resize(m + 1);
  for (std::size_t i = 0; i <= m; ++i)
  {
    source.offsets[i] = static_cast<std::int64_t>(3 * i);
  }
  Output out = source;
  Output copy = source;

  std::vector<double> moves;
  std::vector<double> hands;
  std::vector<double> copies;
  std::vector<double> ratios;
  std::vector<double> handRatios;
  for (int r = 0; r < reps; ++r)
  {
    for (int i = 1; i <= 200; ++i)
    {
      const int percent = i <= 100 ? i : 200 - i;
      double start = cpuSeconds();
      cursor.moveTo(cursor.stepsForLevel(percent / 100.0));
      const double moved = cpuSeconds() - start;
      const std::size_t points = static_cast<std::size_t>(cursor.nodeCount());
      const std::size_t cells = static_cast<std::size_t>(cursor.cellCount());
      std::memcpy(out.points.data(), source.points.data(), 3 * points * sizeof(double));
      std::memcpy(out.values.data(), source.values.data(), points * sizeof(float));
      std::memcpy(out.offsets.data(), source.offsets.data(), (cells + 1) * sizeof(std::int64_t));
      std::copy_n(cursor.cells(), 3 * cells, out.connectivity.data());
      const double handed = cpuSeconds() - start;
      start = cpuSeconds();
      std::memcpy(copy.points.data(), out.points.data(), 3 * points * sizeof(double));
      std::memcpy(copy.values.data(), out.values.data(), points * sizeof(float));
      std::memcpy(copy.offsets.data(), out.offsets.data(), (cells + 1) * sizeof(std::int64_t));
      std::memcpy(
        copy.connectivity.data(), out.connectivity.data(), 3 * cells * sizeof(std::int64_t));
      const double copied = cpuSeconds() - start;
      moves.push_back(moved);
      hands.push_back(handed);
      copies.push_back(copied);
      ratios.push_back(moved / copied);
      handRatios.push_back(handed / copied);
    }
  }
  std::printf("{\"nodes\": %zu, \"levels\": %zu, \"move\": %.6f, \"hand_out\": %.6f, "
              "\"memcpy\": %.6f, \"ratio_move\": %.4f, \"ratio_hand_out\": %.4f}\n",
    n, moves.size(), median(moves), median(hands), median(copies), median(ratios),
    median(handRatios));
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  Mesh mesh;
  if (argc < 5 || !readMesh(argv[2], mesh))
  {
    std::cerr << "usage: core_timing linear|level MESH TARGET_NODES REPS [deviation|quadric]\n";
    return 2;
  }
  const std::string mode = argv[1];
  const std::int64_t nodes = std::atoll(argv[3]);
  const int reps = std::max(1, std::atoi(argv[4]));
  if (mode == "linear")
  {
    const std::string criterion = argc > 5 ? argv[5] : "scalar";
    return linear(mesh, nodes, reps,
      criterion == "deviation"   ? undecimate::Criterion::Deviation
        : criterion == "quadric" ? undecimate::Criterion::Quadric
                                 : undecimate::Criterion::ScalarDifference);
  }
  return level(mesh, nodes, reps);
}
