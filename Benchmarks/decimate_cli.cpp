// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file decimate_cli.cpp
/// @brief Runs the core on one mesh file for the benchmarks: one decimation, many levels.
///
/// The mesh is decimated once, to the smallest of the asked triangle counts; the other levels are
/// reached by walking the record, and each is written as a mesh file of its own.
///
///   decimate_cli MESH --targets 1000,500,100 [--out PREFIX] [--reps N] [--time-each]
///     [--criterion deviation|scalar|angle|quadric] [--scalar-weight W]
///     [--shape-weight W] [--spacing log|exp]
///     [--interval-nodes K] [--preserve-boundary] [--maximum-error E] [--threads N]
///
/// A mesh file is six int64 (nodes, triangles, bytes of a coordinate, components of the nodal array
/// or 0, two reserved), the coordinates, the triangles (int32) and the nodal array (float32).
/// With --threads the parallel algorithm (0 = as many threads as cores), else the serial one.
/// Prints one JSON object. CPU and wall times are of decimate() alone, medians over the
/// repetitions.

#include "hash_queue_decimation.h"
#include "undecimation.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
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

double wallSeconds()
{
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Mesh
{
  std::int64_t header[6] = {};
  std::vector<float> pointsFloat;
  std::vector<double> pointsDouble;
  std::vector<Index> triangles;
  std::vector<float> values;

  undecimate::TriangleMeshView view() const
  {
    undecimate::TriangleMeshView v;
    v.pointsFloat = this->pointsFloat.empty() ? nullptr : this->pointsFloat.data();
    v.pointsDouble = this->pointsDouble.empty() ? nullptr : this->pointsDouble.data();
    v.nodeCount = this->header[0];
    v.triangles = this->triangles.data();
    v.triangleCount = this->header[1];
    return v;
  }
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
  if (!in || (mesh.header[2] != 4 && mesh.header[2] != 8))
  {
    return false;
  }
  if (mesh.header[2] == 4)
  {
    readArray(in, mesh.pointsFloat, 3 * mesh.header[0]);
  }
  else
  {
    readArray(in, mesh.pointsDouble, 3 * mesh.header[0]);
  }
  readArray(in, mesh.triangles, 3 * mesh.header[1]);
  readArray(in, mesh.values, mesh.header[3] * mesh.header[0]);
  return static_cast<bool>(in);
}

/// The level where the cursor stands, with the original's node numbers packed to those in use.
void writeLevel(const std::string& name, const Mesh& mesh, const undecimate::Undecimation& cursor)
{
  std::ofstream out(name, std::ios::binary);
  const std::int64_t components = mesh.header[3];
  const std::int64_t header[6] = { cursor.nodeCount(), cursor.cellCount(), mesh.header[2],
    components, 0, 0 };
  out.write(reinterpret_cast<const char*>(header), sizeof(header));
  const Index* order = cursor.record().nodeOrder;
  for (Index i = 0; i < cursor.nodeCount(); ++i)
  {
    const std::size_t from = 3 * static_cast<std::size_t>(order[i]);
    if (mesh.header[2] == 4)
    {
      out.write(reinterpret_cast<const char*>(&mesh.pointsFloat[from]), 3 * sizeof(float));
    }
    else
    {
      out.write(reinterpret_cast<const char*>(&mesh.pointsDouble[from]), 3 * sizeof(double));
    }
  }
  out.write(reinterpret_cast<const char*>(cursor.cells()),
    static_cast<std::streamsize>(3 * sizeof(Index)) * cursor.cellCount());
  for (Index i = 0; components > 0 && i < cursor.nodeCount(); ++i)
  {
    const auto from = static_cast<std::size_t>(components * order[i]);
    out.write(reinterpret_cast<const char*>(&mesh.values[from]),
      static_cast<std::streamsize>(sizeof(float)) * components);
  }
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

int usage()
{
  std::cerr << "usage: decimate_cli MESH --targets T1,T2,... [options]; see the file comment\n";
  return 2;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    return usage();
  }
  std::vector<std::int64_t> targets;
  std::string prefix;
  int reps = 1;
  bool timeEach = false;
  undecimate::HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  for (int i = 2; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--preserve-boundary")
    {
      options.preserveBoundary = true;
      continue;
    }
    if (word == "--time-each")
    {
      timeEach = true;
      continue;
    }
    if (++i == argc)
    {
      return usage();
    }
    const std::string value = argv[i];
    if (word == "--targets")
    {
      std::istringstream list(value);
      for (std::string item; std::getline(list, item, ',');)
      {
        targets.push_back(std::atoll(item.c_str()));
      }
    }
    else if (word == "--out")
    {
      prefix = value;
    }
    else if (word == "--reps")
    {
      reps = std::atoi(value.c_str());
    }
    else if (word == "--criterion")
    {
      options.criterion = value == "scalar" ? undecimate::Criterion::ScalarDifference
        : value == "angle"                  ? undecimate::Criterion::AngleToXYPlane
        : value == "quadric"                ? undecimate::Criterion::Quadric
                                            : undecimate::Criterion::Deviation;
    }
    else if (word == "--scalar-weight")
    {
      options.scalarWeight = std::atof(value.c_str());
    }
    else if (word == "--shape-weight")
    {
      options.shapeWeight = std::atof(value.c_str());
    }
    else if (word == "--spacing")
    {
      options.intervalSpacing = value == "exp" ? undecimate::IntervalSpacing::Exponential
                                               : undecimate::IntervalSpacing::Logarithmic;
    }
    else if (word == "--interval-nodes")
    {
      options.intervalNodes = std::atof(value.c_str());
    }
    else if (word == "--threads")
    {
      options.parallel = true;
      options.threads = std::atoi(value.c_str());
    }
    else if (word == "--maximum-error")
    {
      options.maximumError = std::atof(value.c_str());
    }
    else
    {
      return usage();
    }
  }
  Mesh mesh;
  if (!readMesh(argv[1], mesh))
  {
    std::cerr << argv[1] << ": not a mesh file\n";
    return 1;
  }
  if (targets.empty())
  {
    return usage();
  }
  std::sort(targets.rbegin(), targets.rend());
  if (mesh.header[3] > 0)
  {
    undecimate::NodalArrayView array;
    array.values = mesh.values.data();
    array.components = static_cast<int>(mesh.header[3]);
    array.name = "values";
    options.arrays.push_back(array);
  }

  undecimate::HashQueueDecimationResult result;
  std::vector<double> seconds(targets.size(), 0.0);
  std::vector<double> walls(targets.size(), 0.0);
  for (std::size_t t = timeEach ? 0 : targets.size() - 1; t < targets.size(); ++t)
  {
    std::vector<double> times;
    std::vector<double> wallTimes;
    for (int r = 0; r < std::max(1, reps); ++r)
    {
      options.targetTriangles = targets[t];
      undecimate::Monitor monitor;
      const double start = cpuSeconds();
      const double wallStart = wallSeconds();
      const undecimate::Outcome outcome =
        undecimate::decimate(mesh.view(), options, monitor, result);
      times.push_back(cpuSeconds() - start);
      wallTimes.push_back(wallSeconds() - wallStart);
      if (!outcome)
      {
        std::cerr << outcome.message << "\n";
        return 1;
      }
    }
    seconds[t] = median(times);
    walls[t] = median(wallTimes);
  }

  undecimate::Undecimation cursor;
  const undecimate::Outcome outcome =
    cursor.open(result.record.view(), result.baseTriangles.data());
  if (!outcome)
  {
    std::cerr << outcome.message << "\n";
    return 1;
  }
  std::printf("{\"stop\": \"%s\", \"record_bytes\": %zu, \"steps\": %lld, \"levels\": [",
    undecimate::toString(result.stopReason), result.record.byteSize(),
    static_cast<long long>(cursor.stepCount()));
  // From the original downwards to the first level with at most the wanted number of triangles. The
  // count is monotone in the steps: binary search.
  for (std::size_t t = 0; t < targets.size(); ++t)
  {
    Index low = 0;
    Index high = cursor.stepCount();
    while (low < high)
    {
      const Index middle = low + (high - low + 1) / 2;
      cursor.moveTo(middle);
      if (cursor.cellCount() <= targets[t])
      {
        low = middle;
      }
      else
      {
        high = middle - 1;
      }
    }
    cursor.moveTo(low);
    const std::string name = prefix.empty() ? "" : prefix + std::to_string(targets[t]) + ".mesh";
    if (!name.empty())
    {
      writeLevel(name, mesh, cursor);
    }
    std::printf("%s{\"target\": %lld, \"triangles\": %lld, \"nodes\": %lld, \"error\": %.9g, "
                "\"cpu\": %.6f, \"wall\": %.6f, \"file\": \"%s\"}",
      t == 0 ? "" : ", ", static_cast<long long>(targets[t]),
      static_cast<long long>(cursor.cellCount()), static_cast<long long>(cursor.nodeCount()),
      cursor.error(), seconds[t], walls[t], name.c_str());
  }
  std::printf("]}\n");
  return 0;
}
