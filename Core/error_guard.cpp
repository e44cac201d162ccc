// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file error_guard.cpp
/// @brief Guards the accuracy: errors of fixed cases against the values of a file.
///
///   error_guard check FILE   fails if an error is over 2 % above its value in the file
///   error_guard write FILE   writes the errors of today into the file: after a change that is
///   meant
///
/// A line of the file is a case, what the record claims and the largest distance of an original
/// node to the coarse mesh, found by going through all triangles; both as fractions of the
/// diagonal. All is deterministic: the meshes are made here, without files.

#include "testing/closest_point.h"
#include "testing/decimated.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::Mesh;

constexpr double kWorse = 1.02;    // an error may be larger by this factor
constexpr double kRounding = 1e-7; // and by this
constexpr double kReductions[] = { 0.5, 0.75, 0.9, 0.95 };

struct Errors
{
  double claimed = 0.0;
  double distance = 0.0;
};

struct NamedMesh
{
  const char* name;
  Mesh mesh;
};

std::vector<NamedMesh> makeMeshes()
{
  std::mt19937 random(1);
  std::vector<NamedMesh> meshes{ { "hills", testing::hills(40, 36) },
    { "torus", testing::torus(48, 24) }, { "disc", testing::disc(12, 40) },
    { "cube", testing::cube(12) } };
  Mesh rough = testing::torus(40, 30);
  for (double& x : rough.points)
  {
    x += 2e-2 * (static_cast<double>(random() % 1000) / 1000.0 - 0.5);
  }
  meshes.push_back({ "rough torus", rough });
  return meshes;
}

Vector at(const Mesh& mesh, Index node)
{
  const auto p = mesh.point(node);
  return { p[0], p[1], p[2] };
}

Errors errorsOf(const Mesh& mesh, Criterion criterion, double reduction)
{
  HashQueueDecimationOptions options;
  options.criterion = criterion;
  options.targetReduction = reduction;
  const Decimated decimated(mesh, options);
  const std::vector<Index> triangles = testing::originalNumbers(decimated.cursor);
  Errors errors;
  errors.claimed = decimated.result.error;
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    double nearest = HUGE_VAL;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
    {
      nearest = std::min(nearest,
        testing::closestPoint(at(mesh, node), at(mesh, triangles[t]), at(mesh, triangles[t + 1]),
          at(mesh, triangles[t + 2]))
          .square);
    }
    errors.distance = std::max(errors.distance, std::sqrt(nearest));
  }
  errors.distance /= testing::diagonalOf(mesh);
  return errors;
}

std::map<std::string, Errors> measure()
{
  std::map<std::string, Errors> all;
  for (const NamedMesh& one : makeMeshes())
  {
    for (const Criterion criterion : { Criterion::Deviation, Criterion::Quadric })
    {
      for (const double reduction : kReductions)
      {
        const std::string name = std::string(one.name) +
          (criterion == Criterion::Quadric ? ", Quadric, " : ", Deviation, ") +
          std::to_string(std::lround(100.0 * (1.0 - reduction))) + " %";
        all[name] = errorsOf(one.mesh, criterion, reduction);
      }
    }
  }
  return all;
}

int write(const char* file, const std::map<std::string, Errors>& errors)
{
  std::ofstream out(file);
  out << std::setprecision(6);
  for (const auto& [name, e] : errors)
  {
    out << e.claimed << " " << e.distance << " " << name << "\n";
  }
  out.flush();
  if (!out)
  {
    std::cerr << file << ": cannot be written\n";
    return 1;
  }
  return 0;
}

bool isWorse(const std::string& name, const char* what, double now, double before)
{
  if (now <= kWorse * before + kRounding)
  {
    return false;
  }
  std::cerr << name << ": " << what << " " << now << ", was " << before << "\n";
  return true;
}

int check(const char* file, const std::map<std::string, Errors>& errors)
{
  std::ifstream in(file);
  std::map<std::string, Errors> before;
  Errors e;
  std::string name;
  while (in >> e.claimed >> e.distance && std::getline(in >> std::ws, name))
  {
    before[name] = e;
  }
  int faults = 0;
  for (const auto& [key, now] : errors)
  {
    const auto known = before.find(key);
    if (known == before.end())
    {
      std::cerr << key << ": no value in " << file << "; write it anew\n";
      ++faults;
      continue;
    }
    faults += isWorse(key, "claimed error", now.claimed, known->second.claimed) ? 1 : 0;
    faults += isWorse(key, "distance", now.distance, known->second.distance) ? 1 : 0;
  }
  std::cout << errors.size() << " cases, " << faults << " faults\n";
  return faults == 0 ? 0 : 1;
}

} // namespace
} // namespace undecimate

int main(int argc, char** argv)
{
  const std::string mode = argc == 3 ? argv[1] : "";
  if (mode != "check" && mode != "write")
  {
    std::cerr << "usage: error_guard check|write FILE\n";
    return 2;
  }
  const auto errors = undecimate::measure();
  return mode == "write" ? undecimate::write(argv[2], errors) : undecimate::check(argv[2], errors);
}
