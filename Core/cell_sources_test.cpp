// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cell_sources.h"

#include "testing/meshes.h"

#include <gtest/gtest.h>

#include <random>

namespace undecimate
{
namespace
{

using testing::Mesh;

/// A fan of triangles around node 0; nodes 1 .. are the ring.
struct Fan
{
  Mesh mesh;
  Hole hole;

  Fan(const std::array<double, 3>& center, const std::vector<std::array<double, 3>>& ring,
    bool boundary)
  {
    mesh.addNode(center[0], center[1], center[2]);
    hole.node = 0;
    hole.boundary = boundary;
    hole.size = static_cast<int>(ring.size());
    hole.triangleCount = hole.size - (boundary ? 1 : 0);
    for (int i = 0; i < hole.size; ++i)
    {
      hole.ring[i] = mesh.addNode(ring[i][0], ring[i][1], ring[i][2]);
    }
  }

  std::vector<int> sources(const std::vector<std::array<unsigned char, 3>>& triangles) const
  {
    HoleTriangulation filling;
    filling.count = static_cast<int>(triangles.size());
    std::copy(triangles.begin(), triangles.end(), filling.triangles.begin());
    std::array<unsigned char, kMaximumPatchCells> found;
    found.fill(255);
    findCellSources(TriangleTopology(mesh.view()), hole, filling, found.data());
    return { found.begin(), found.begin() + filling.count };
  }
};

//   3-----------2
//   | .       . |     Old triangles 0 (below, area 2), 1 (right, 5), 2 (above, 6), 3 (left, 3)
//   around |   .   .   |     the node at (1.5, 1) of a 4 x 4 square. |    (n)    | 0-----------1
TEST(CellSources, SquareByHand)
{
  const Fan fan({ 1.5, 1, 0 }, { { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } }, false);
  // Diagonal 1-3: (0, 1, 3) shares 2, 1.36, 1.64 and 3; (1, 2, 3) shares 3.64 with 1, 4.36 with 2.
  EXPECT_EQ(fan.sources({ { 0, 1, 3 }, { 1, 2, 3 } }), (std::vector<int>{ 3, 2 }));
  // Diagonal 0-2: (0, 1, 2) shares all 5 with 1; (0, 2, 3) shares 5.33 with 2.
  EXPECT_EQ(fan.sources({ { 0, 1, 2 }, { 0, 2, 3 } }), (std::vector<int>{ 1, 2 }));
}

// A boundary node on a straight side: the last ring edge closes the hole.
//   2---------1
//   |  \   /  |
//   3---(0)---0
TEST(CellSources, BoundaryFan)
{
  const Fan fan({ 1, 0, 0 }, { { 4, 0, 0 }, { 4, 2, 0 }, { 0, 2, 0 }, { 0, 0, 0 } }, true);
  // Old: 0 = (node, 0, 1) area 3, 1 = (node, 1, 2) area 4, 2 = (node, 2, 3) area 1.
  // New (0, 1, 3) of area 4 shares 3 with old 0; (1, 2, 3) shares most with old 1.
  EXPECT_EQ(fan.sources({ { 3, 0, 1 }, { 1, 2, 3 } }), (std::vector<int>{ 0, 1 }));
}

// Convex fans in random planes against areas counted point by point.
TEST(CellSources, EqualsTheLargestSampledArea)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double turn = 8.0 * std::atan(1.0);
  int compared = 0;
  for (int round = 0; round < 60; ++round)
  {
    const int size = 4 + static_cast<int>(random() % 5);
    std::vector<std::array<double, 2>> flat;
    for (int i = 0; i < size; ++i)
    {
      const double angle = turn * (i + 0.6 * unit(random)) / size;
      flat.push_back({ std::cos(angle), std::sin(angle) });
    }
    const std::array<double, 2> center{ 0.4 * unit(random) - 0.2, 0.4 * unit(random) - 0.2 };
    // Into space by a rotation that is not aligned with any axis.
    const auto lift = [&](const std::array<double, 2>& p) -> std::array<double, 3>
    {
      const double tilt = 0.3 * round;
      return { p[0] * std::cos(tilt), p[1], p[0] * std::sin(tilt) };
    };
    std::vector<std::array<double, 3>> ring;
    for (const auto& p : flat)
    {
      ring.push_back(lift(p));
    }
    const Fan fan(lift(center), ring, false);
    std::vector<std::array<unsigned char, 3>> triangles;
    for (int k = 1; k + 1 < size; ++k)
    {
      triangles.push_back({ 0, static_cast<unsigned char>(k), static_cast<unsigned char>(k + 1) });
    }
    const std::vector<int> sources = fan.sources(triangles);

    const auto side = [](const std::array<double, 2>& a, const std::array<double, 2>& b,
                        const std::array<double, 2>& p)
    { return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]); };
    const auto inside = [&](const std::array<double, 2>& a, const std::array<double, 2>& b,
                          const std::array<double, 2>& c, const std::array<double, 2>& p)
    { return side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0; };
    constexpr int kGrid = 160;
    std::vector<std::vector<int>> shared(triangles.size(), std::vector<int>(size, 0));
    for (int i = 0; i < kGrid; ++i)
    {
      for (int j = 0; j < kGrid; ++j)
      {
        const std::array<double, 2> p{ 2.0 * (i + 0.5) / kGrid - 1.0,
          2.0 * (j + 0.5) / kGrid - 1.0 };
        int old = -1;
        for (int k = 0; k < size && old < 0; ++k)
        {
          old = inside(center, flat[k], flat[(k + 1) % size], p) ? k : -1;
        }
        for (std::size_t t = 0; old >= 0 && t < triangles.size(); ++t)
        {
          const auto& corners = triangles[t];
          if (inside(flat[corners[0]], flat[corners[1]], flat[corners[2]], p))
          {
            ++shared[t][old];
          }
        }
      }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      std::vector<int> sorted = shared[t];
      std::sort(sorted.rbegin(), sorted.rend());
      // Only where the samples tell the first from the second.
      if (sorted[0] > sorted[1] + 30)
      {
        ++compared;
        EXPECT_EQ(shared[t][sources[t]], sorted[0]) << "round " << round << " triangle " << t;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

// Seen in any direction, old triangles without area cover nothing, and there is always an answer.
TEST(CellSources, FlatFansStillNameATriangle)
{
  const Fan line({ 1, 0, 0 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 } }, false);
  for (const int source : line.sources({ { 0, 1, 2 }, { 0, 2, 3 } }))
  {
    EXPECT_GE(source, 0);
    EXPECT_LT(source, 4);
  }
}

} // namespace
} // namespace undecimate
