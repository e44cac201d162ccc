// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Decimates a series of steps and writes the cells of some levels: for tri_quad.py.
//
//   tri_quad_cli SERIES [--steps 0,15,30] [--criterion deviation|quadrics] [--error max|sum]
//                [--targets NODES,...] [--out PREFIX] [--quad-weight W] [--candidates K] [--parts]
//                [--automatic FACTOR] [--threads N]
//
// SERIES: int64 nodes, cells, steps, 1 if there are parts; float32 x, y, z of each node, step after
// step; int32 cells of four corners, -1 at the last of triangles; int32 part of each cell.
// PREFIX<nodes>.cells: int32 cells of the level in original numbers. Prints JSON.

#include "tri_quad_decimation.h"
#include "undecimation.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using namespace undecimate;

namespace
{

[[noreturn]] void fail(const std::string& message)
{
  std::cerr << message << "\n";
  std::exit(1);
}

std::vector<int> numbers(const std::string& text)
{
  std::vector<int> list;
  std::stringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');)
  {
    list.push_back(std::atoi(item.c_str()));
  }
  return list;
}

template <typename Value>
void read(std::ifstream& file, Value* values, std::size_t count)
{
  if (!file.read(
        reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(Value))))
  {
    fail("The series is too short.");
  }
}

double cpuSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    fail("usage: see the head of the source");
  }
  TriQuadDecimationOptions options;
  options.targetReduction = 1.0;
  std::vector<int> steps;
  std::vector<int> targets;
  std::string prefix;
  bool useParts = false;
  double factor = 0.0;
  for (int i = 2; i < argc; ++i)
  {
    const std::string option = argv[i];
    if (option == "--parts")
    {
      useParts = true;
      continue;
    }
    if (i + 1 == argc)
    {
      fail("no value for " + option);
    }
    const std::string value = argv[++i];
    if (option == "--steps")
      steps = numbers(value);
    else if (option == "--criterion")
      options.criterion =
        value == "quadrics" ? TriQuadCriterion::Quadrics : TriQuadCriterion::Deviation;
    else if (option == "--error")
      options.timeError = value == "sum" ? TimeError::Sum : TimeError::Maximum;
    else if (option == "--targets")
      targets = numbers(value);
    else if (option == "--out")
      prefix = value;
    else if (option == "--quad-weight")
      options.quadWeight = std::atof(value.c_str());
    else if (option == "--automatic")
      factor = std::atof(value.c_str());
    else if (option == "--threads")
      options.threads = std::atoi(value.c_str());
    else if (option == "--candidates")
      options.candidates = std::atoi(value.c_str());
    else
      fail("unknown option " + option);
  }
  std::ifstream file(argv[1], std::ios::binary);
  std::int64_t header[4];
  read(file, header, 4);
  const std::size_t pointSize = 3 * header[0];
  const std::streamoff stepBytes = static_cast<std::streamoff>(pointSize * sizeof(float));
  if (steps.empty())
  {
    steps.resize(header[2]);
    std::iota(steps.begin(), steps.end(), 0);
  }
  const auto stepCount = static_cast<int>(steps.size());
  TimeRows rows(static_cast<Index>(header[0]), 3, stepCount);
  std::vector<float> points(pointSize);
  PositionFrame frame;
  double readSeconds = cpuSeconds();
  for (int i = 0; i < stepCount; ++i)
  {
    file.seekg(static_cast<std::streamoff>(sizeof(header)) + steps[i] * stepBytes);
    read(file, points.data(), pointSize);
    if (i == 0)
    {
      frame = positionFrame<float>(points.data(), nullptr, rows.nodeCount());
    }
    rows.set<float>(i, points.data(), nullptr, frame.origin.data(), frame.scale);
  }
  std::vector<float>().swap(points);
  std::vector<Index> cells(4 * header[1]);
  file.seekg(static_cast<std::streamoff>(sizeof(header)) + header[2] * stepBytes);
  read(file, cells.data(), cells.size());
  std::vector<Index> parts;
  if (useParts && header[3])
  {
    parts.resize(header[1]);
    read(file, parts.data(), parts.size());
  }
  readSeconds = cpuSeconds() - readSeconds;

  TriQuadMeshView mesh;
  mesh.nodeCount = header[0];
  mesh.cells = cells.data();
  mesh.cellCount = header[1];
  mesh.parts = parts.empty() ? nullptr : parts.data();
  options.targetNodes = targets.empty() ? 0 : *std::min_element(targets.begin(), targets.end());
  TriQuadDecimationResult result;
  Monitor monitor;
  const double start = cpuSeconds();
  const auto wallStart = std::chrono::steady_clock::now();
  std::vector<int> used(stepCount);
  std::iota(used.begin(), used.end(), 0);
  const Outcome outcome = factor > 0.0
    ? decimateTriQuadAutomatically(mesh, rows, options, factor, monitor, result, used)
    : decimateTriQuad(mesh, rows, options, monitor, result);
  const double seconds = cpuSeconds() - start;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wallStart;
  if (!outcome)
  {
    fail(outcome.message);
  }
  Undecimation cursor;
  if (const Outcome opened = cursor.open(result.record.view(), result.baseCells.data()); !opened)
  {
    fail(opened.message);
  }
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::string usedSteps;
  for (const int step : used)
  {
    usedSteps += (usedSteps.empty() ? "" : ", ") + std::to_string(steps[step]);
  }
  std::printf(
    "{\"used\": \"%s\", \"nodes\": %lld, \"cells\": %lld, \"steps\": %d, \"cpu\": %.4f, \"wall\": "
    "%.4f, \"read\": "
    "%.4f, "
    "\"peak_kib\": %ld, \"record\": %zu, \"shapes\": %zu, \"stop\": \"%s\", \"levels\": [",
    usedSteps.c_str(), static_cast<long long>(header[0]), static_cast<long long>(header[1]),
    stepCount, seconds, wall.count(), readSeconds, usage.ru_maxrss, result.record.byteSize(),
    result.record.shapes.size(), toString(result.stopReason));
  std::sort(targets.begin(), targets.end());
  for (std::size_t i = 0; i < targets.size(); ++i)
  {
    const Index base = result.record.baseNodeCount;
    const auto before = std::chrono::steady_clock::now();
    cursor.moveTo(std::max<Index>(0, targets[i] - base));
    const std::chrono::duration<double> moved = std::chrono::steady_clock::now() - before;
    std::vector<Index> level(
      cursor.cells(), cursor.cells() + std::size_t{ 4 } * cursor.cellCount());
    Index quads = 0;
    for (std::size_t c = 0; c < level.size(); c += 4)
    {
      quads += level[c + 3] != kNone;
    }
    for (Index& node : level)
    {
      node = node == kNone ? kNone : result.record.nodeOrder[node];
    }
    if (!prefix.empty())
    {
      std::ofstream out(prefix + std::to_string(targets[i]) + ".cells", std::ios::binary);
      out.write(reinterpret_cast<const char*>(level.data()),
        static_cast<std::streamsize>(level.size() * sizeof(Index)));
    }
    std::printf("%s{\"target\": %d, \"nodes\": %d, \"triangles\": %d, \"quads\": %d, \"error\": "
                "%.6g, \"move\": %.6f}",
      i == 0 ? "" : ", ", targets[i], cursor.nodeCount(), cursor.cellCount() - quads, quads,
      cursor.error(), moved.count());
  }
  std::printf("]}\n");
  return 0;
}
