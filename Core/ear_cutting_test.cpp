// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ear_cutting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace undecimate
{
namespace
{

using Polygon = std::vector<Vector>;

constexpr Vector kUp{ 0.0, 0.0, 1.0 };

bool anyEdge(int, int)
{
  return true;
}

double area(const Vector& a, const Vector& b, const Vector& c, const Vector& normal)
{
  return 0.5 * dot(cross(b - a, c - a), normal) / std::sqrt(dot(normal, normal));
}

double polygonArea(const Polygon& p, const Vector& normal)
{
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i)
  {
    sum += area(p[0], p[i], p[i + 1], normal);
  }
  return sum;
}

/// Each triangle counterclockwise, areas add up, polygon edges once, diagonals twice.
void expectFills(const Polygon& p, const HoleTriangulation& filling, const Vector& normal = kUp)
{
  const int size = static_cast<int>(p.size());
  ASSERT_EQ(filling.count, size - 2);
  double sum = 0.0;
  std::map<std::pair<int, int>, int> uses;
  for (int t = 0; t < filling.count; ++t)
  {
    const auto& corners = filling.triangles[t];
    const double one = area(p[corners[0]], p[corners[1]], p[corners[2]], normal);
    EXPECT_GT(one, 0.0);
    sum += one;
    for (int c = 0; c < 3; ++c)
    {
      ++uses[{ corners[c], corners[(c + 1) % 3] }];
    }
  }
  EXPECT_NEAR(sum, polygonArea(p, normal), 1e-9 * std::abs(sum));
  for (const auto& [edge, count] : uses)
  {
    EXPECT_EQ(count, 1);
    const bool side = edge.second == (edge.first + 1) % size;
    EXPECT_EQ(uses.count({ edge.second, edge.first }), side ? 0U : 1U);
  }
}

Polygon star(const std::vector<double>& radii)
{
  const double turn = 8.0 * std::atan(1.0);
  Polygon p;
  for (std::size_t i = 0; i < radii.size(); ++i)
  {
    const double angle = turn * static_cast<double>(i) / static_cast<double>(radii.size());
    p.push_back({ radii[i] * std::cos(angle), radii[i] * std::sin(angle), 0.0 });
  }
  return p;
}

bool cut(const Polygon& p, HoleTriangulation& filling, const Vector& normal = kUp)
{
  return EarCutting(p.data(), static_cast<int>(p.size()), normal).cut(anyEdge, filling);
}

std::set<std::set<int>> trianglesOf(const HoleTriangulation& filling)
{
  std::set<std::set<int>> all;
  for (int t = 0; t < filling.count; ++t)
  {
    all.insert({ filling.triangles[t].begin(), filling.triangles[t].end() });
  }
  return all;
}

TEST(EarCutting, Triangle)
{
  HoleTriangulation filling;
  const Polygon p{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  ASSERT_TRUE(cut(p, filling));
  expectFills(p, filling);
}

TEST(EarCutting, ConvexPolygonsOfEverySize)
{
  for (int size = 3; size <= kMaximumPatchCells + 1; ++size)
  {
    const Polygon p = star(std::vector<double>(size, 2.0));
    HoleTriangulation filling;
    ASSERT_TRUE(cut(p, filling)) << size;
    expectFills(p, filling);
  }
}

// 0 (0, 0), 1 (4, 0), 2 (4, 4), 3 (0, 4), 4 (1, 2).
//   3 . . . . 2
//   . .       .
//   .   4     .       The corner at 4 dents the left side. Ears: 0 and 3 (with 4), 1 and 2.
//   . .       .       Best is the ear with the largest height over its base.
//   0 . . . . 1
TEST(EarCutting, DentedSquareByHand)
{
  const Polygon p{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 1, 2, 0 } };
  HoleTriangulation filling;
  ASSERT_TRUE(cut(p, filling));
  expectFills(p, filling);
  // Heights over bases: ear 0 = (4, 0, 1): area 2 * 4 = 8 over base^2 13 = 0.62; ear 3 likewise;
  // ears 1 and 2: 16 / 32 = 0.5. Ear 0 comes before ear 3; then (4, 1, 2, 3) is left, with ear 3 at
  // 8 / 13 against ear 1 = (4, 1, 2) at 12 / 13: 1 is cut.
  EXPECT_EQ(
    trianglesOf(filling), (std::set<std::set<int>>{ { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 } }));
}

//  5-----4
//  |     |          3 is reflex. Cutting off a corner across the notch is no ear.
//  |     3-----2
//  |           |
//  0-----------1
TEST(EarCutting, LShape)
{
  const Polygon p{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 2, 0 }, { 2, 2, 0 }, { 2, 4, 0 }, { 0, 4, 0 } };
  HoleTriangulation filling;
  ASSERT_TRUE(cut(p, filling));
  expectFills(p, filling);
}

TEST(EarCutting, StarShapedPolygons)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(0.3, 3.0);
  for (int round = 0; round < 2000; ++round)
  {
    std::vector<double> radii(4 + random() % 20);
    for (double& r : radii)
    {
      r = radius(random);
    }
    const Polygon p = star(radii);
    HoleTriangulation filling;
    ASSERT_TRUE(cut(p, filling)) << round;
    expectFills(p, filling);
  }
}

//   A comb is not star-shaped: hardly any corner is an ear.
TEST(EarCutting, Comb)
{
  Polygon p{ { 0, 0, 0 }, { 7, 0, 0 } };
  for (int tooth = 3; tooth >= 0; --tooth)
  {
    p.push_back({ 2.0 * tooth + 1.0, 5.0, 0.0 });
    p.push_back({ 2.0 * tooth, 5.0, 0.0 });
    if (tooth > 0)
    {
      p.push_back({ 2.0 * tooth - 0.2, 1.0, 0.0 });
      p.push_back({ 2.0 * tooth - 0.8, 1.0, 0.0 });
    }
  }
  HoleTriangulation filling;
  ASSERT_TRUE(cut(p, filling));
  expectFills(p, filling);
}

// The plane may lie anywhere in space, and the points need not lie in it.
TEST(EarCutting, AnyPlane)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::uniform_real_distribution<double> radius(0.5, 2.0);
  for (int round = 0; round < 500; ++round)
  {
    Vector normal{ any(random), any(random), any(random) };
    if (round < 6)
    {
      normal = { round % 3 == 0 ? 1.0 : 0.0, round % 3 == 1 ? 1.0 : 0.0,
        round % 3 == 2 ? 1.0 : 0.0 };
      normal = (round < 3 ? 1e-8 : -1e8) * normal;
    }
    const Vector helper =
      std::abs(normal.x) > std::abs(normal.y) ? Vector{ 0.0, 1.0, 0.0 } : Vector{ 1.0, 0.0, 0.0 };
    Vector u = cross(helper, normal);
    u = (1.0 / std::sqrt(dot(u, u))) * u;
    Vector v = cross(normal, u);
    v = (1.0 / std::sqrt(dot(v, v))) * v;
    std::vector<double> radii(4 + random() % 6);
    for (double& r : radii)
    {
      r = radius(random);
    }
    const Vector unit = (1.0 / std::sqrt(dot(normal, normal))) * normal;
    Polygon p;
    for (const Vector& q : star(radii))
    {
      p.push_back(q.x * u + q.y * v + 0.2 * any(random) * unit);
    }
    HoleTriangulation filling;
    ASSERT_TRUE(cut(p, filling, normal)) << round;
    expectFills(p, filling, normal);
  }
}

//  3-------2
//  |       |      1 lies on the line from 0 to 2': no triangle of 0, 1, 2' may come out.
//  0---1---2'
TEST(EarCutting, CollinearPointsMakeNoFlatTriangles)
{
  const Polygon p{ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 } };
  HoleTriangulation filling;
  ASSERT_TRUE(cut(p, filling));
  expectFills(p, filling);
  EXPECT_EQ(trianglesOf(filling).count({ 0, 1, 2 }), 0U);
}

TEST(EarCutting, AllPointsOnALineCannotBeFilled)
{
  const Polygon p{ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 } };
  HoleTriangulation filling;
  EXPECT_FALSE(cut(p, filling));
  EXPECT_FALSE(cut({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }, filling));
}

TEST(EarCutting, ClockwisePolygonsCannotBeFilled)
{
  Polygon p = star(std::vector<double>(6, 1.0));
  std::reverse(p.begin(), p.end());
  HoleTriangulation filling;
  EXPECT_FALSE(cut(p, filling));
}

TEST(EarCutting, CoincidentPoints)
{
  HoleTriangulation filling;
  EXPECT_FALSE(cut(Polygon(5, Vector{ 1.0, 1.0, 1.0 }), filling));
}

//   3---2     Without the edge 0-2 there is 1-3, and the other way round; without both nothing.
//   |   |
//   0---1
TEST(EarCutting, ForbiddenDiagonals)
{
  const Polygon p{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  const auto without = [&](std::set<std::set<int>> forbidden, HoleTriangulation& filling)
  {
    return EarCutting(p.data(), 4, kUp)
      .cut(
        [&](int i, int j) {
          return forbidden.count({ i, j }) == 0;
        },
        filling);
  };
  HoleTriangulation filling;
  ASSERT_TRUE(without({ { 0, 2 } }, filling));
  EXPECT_EQ(trianglesOf(filling), (std::set<std::set<int>>{ { 0, 1, 3 }, { 1, 2, 3 } }));
  ASSERT_TRUE(without({ { 1, 3 } }, filling));
  EXPECT_EQ(trianglesOf(filling), (std::set<std::set<int>>{ { 0, 1, 2 }, { 0, 2, 3 } }));
  EXPECT_FALSE(without({ { 0, 2 }, { 1, 3 } }, filling));
}

// With a random set of forbidden diagonals: a filling, if there is one, uses none of them.
TEST(EarCutting, FillingsNeverUseForbiddenDiagonals)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.8, 1.2);
  int filled = 0;
  for (int round = 0; round < 2000; ++round)
  {
    std::vector<double> radii(5 + random() % 6);
    for (double& r : radii)
    {
      r = radius(random);
    }
    const Polygon p = star(radii);
    const int size = static_cast<int>(p.size());
    std::set<std::pair<int, int>> forbidden;
    for (int k = 0; k < size / 2; ++k)
    {
      const int i = static_cast<int>(random() % radii.size());
      const int j = static_cast<int>(random() % radii.size());
      forbidden.insert({ std::min(i, j), std::max(i, j) });
    }
    HoleTriangulation filling;
    const bool done = EarCutting(p.data(), size, kUp)
                        .cut(
                          [&](int i, int j) {
                            return forbidden.count({ std::min(i, j), std::max(i, j) }) == 0;
                          },
                          filling);
    if (!done)
    {
      continue;
    }
    ++filled;
    expectFills(p, filling);
    for (int t = 0; t < filling.count; ++t)
    {
      for (int c = 0; c < 3; ++c)
      {
        const int i = std::min(filling.triangles[t][c], filling.triangles[t][(c + 1) % 3]);
        const int j = std::max(filling.triangles[t][c], filling.triangles[t][(c + 1) % 3]);
        const bool side = j == i + 1 || (i == 0 && j == size - 1);
        EXPECT_TRUE(side || forbidden.count({ i, j }) == 0);
      }
    }
  }
  EXPECT_GT(filled, 500);
}

} // namespace
} // namespace undecimate
