// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// The lanes against the same geometry in double precision, one step at a time.

#include "time_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

using Point = std::array<double, 3>;

struct Rows
{
  int lanes;
  std::vector<float> values;
  explicit Rows(int lanes_, int rows = 3)
    : lanes(lanes_)
    , values(rows * lanes_)
  {
  }
  void randomize(std::mt19937& random)
  {
    std::uniform_real_distribution<float> place(-1.0F, 1.0F);
    for (float& value : this->values)
    {
      value = place(random);
    }
  }
  Point at(int lane) const
  {
    return { this->values[lane], this->values[this->lanes + lane],
      this->values[2 * this->lanes + lane] };
  }
  const float* data() const { return this->values.data(); }
};

// The same point in all lanes.
Rows constant(int lanes, float x, float y, float z)
{
  Rows rows(lanes);
  for (int i = 0; i < lanes; ++i)
  {
    rows.values[i] = x;
    rows.values[lanes + i] = y;
    rows.values[2 * lanes + i] = z;
  }
  return rows;
}

Point minus(const Point& a, const Point& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}
double dot(const Point& a, const Point& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
Point unit(const Point& a)
{
  const double length = std::sqrt(dot(a, a));
  return { a[0] / length, a[1] / length, a[2] / length };
}

// Distance to a triangle by looking at all of it, to its edges and its plane.
double distanceTo(const Point& p, const std::array<Point, 3>& t)
{
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    const Point along = minus(t[(k + 1) % 3], t[k]);
    const double f = std::min(1.0, std::max(0.0, dot(minus(p, t[k]), along) / dot(along, along)));
    const Point foot{ t[k][0] + f * along[0], t[k][1] + f * along[1], t[k][2] + f * along[2] };
    best = std::min(best, std::sqrt(dot(minus(p, foot), minus(p, foot))));
  }
  const Point n = unit(cross(minus(t[1], t[0]), minus(t[2], t[0])));
  bool inside = true;
  for (int k = 0; k < 3; ++k)
  {
    inside = inside && dot(cross(n, minus(t[(k + 1) % 3], t[k])), minus(p, t[k])) >= 0.0;
  }
  return inside ? std::abs(dot(n, minus(p, t[0]))) : best;
}

class TimeLanes : public ::testing::TestWithParam<int>
{
};

TEST_P(TimeLanes, MeasureDistancesToTriangles)
{
  const int lanes = GetParam();
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round)
  {
    Rows a(lanes);
    Rows b(lanes);
    Rows c(lanes);
    Rows p(lanes);
    for (Rows* rows : { &a, &b, &c, &p })
    {
      rows->randomize(random);
    }
    std::vector<float> triangle(kTriangleRows * lanes);
    std::vector<float> squares(lanes, std::numeric_limits<float>::infinity());
    prepareTriangle(lanes, a.data(), b.data(), c.data(), triangle.data());
    minimumDistances(lanes, triangle.data(), 1, p.data(), squares.data());
    std::vector<float> edge(lanes, 0.0F);
    maximumDistanceToEdge(lanes, a.data(), b.data(), p.data(), edge.data());
    for (int i = 0; i < lanes; ++i)
    {
      EXPECT_NEAR(std::sqrt(squares[i]), distanceTo(p.at(i), { a.at(i), b.at(i), c.at(i) }), 2e-4);
      const Point along = minus(b.at(i), a.at(i));
      const double f =
        std::min(1.0, std::max(0.0, dot(minus(p.at(i), a.at(i)), along) / dot(along, along)));
      const Point rest = minus(p.at(i),
        { a.at(i)[0] + f * along[0], a.at(i)[1] + f * along[1], a.at(i)[2] + f * along[2] });
      EXPECT_NEAR(std::sqrt(edge[i]), std::sqrt(dot(rest, rest)), 1e-5);
    }
  }
}

TEST_P(TimeLanes, TakeTheNearestOfSeveralTriangles)
{
  const int lanes = GetParam();
  std::mt19937 random(8);
  for (int round = 0; round < 50; ++round)
  {
    constexpr int kCount = 3;
    std::vector<float> triangles(kCount * kTriangleRows * lanes);
    Rows p(lanes);
    p.randomize(random);
    std::vector<float> expected(lanes, std::numeric_limits<float>::infinity());
    for (int k = 0; k < kCount; ++k)
    {
      Rows corners[3] = { Rows(lanes), Rows(lanes), Rows(lanes) };
      for (Rows& corner : corners)
      {
        corner.randomize(random);
      }
      float* triangle = triangles.data() + k * kTriangleRows * lanes;
      prepareTriangle(lanes, corners[0].data(), corners[1].data(), corners[2].data(), triangle);
      std::vector<float> alone(lanes, std::numeric_limits<float>::infinity());
      minimumDistances(lanes, triangle, 1, p.data(), alone.data());
      lower(lanes, alone.data(), expected.data());
    }
    std::vector<float> squares(lanes, std::numeric_limits<float>::infinity());
    minimumDistances(lanes, triangles.data(), kCount, p.data(), squares.data());
    EXPECT_EQ(squares, expected);
  }
}

TEST_P(TimeLanes, AreComparedInAllLanes)
{
  const int lanes = GetParam();
  const std::vector<float> a(lanes, 1.0F);
  for (int i = 0; i < lanes; ++i)
  {
    std::vector<float> b(lanes, 2.0F);
    b[i] = 1.0F;
    EXPECT_TRUE(isAtMost(lanes, a.data(), b.data()));
    b[i] = 0.5F;
    EXPECT_FALSE(isAtMost(lanes, a.data(), b.data()));
    b[i] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(isAtMost(lanes, a.data(), b.data()));
  }
}

TEST_P(TimeLanes, KeepTheNearestAndItsValues)
{
  const int lanes = GetParam();
  const Rows a(lanes);
  const Rows b = constant(lanes, 1.0F, 0.0F, 0.0F);
  const Rows c = constant(lanes, 0.0F, 1.0F, 0.0F);
  const Rows p = constant(lanes, 0.25F, 0.5F, 0.5F);
  const std::vector<float> va(lanes, 10.0F);
  const std::vector<float> vb(lanes, 14.0F);
  const std::vector<float> vc(lanes, 12.0F);
  const std::vector<float> vp(lanes, 10.0F);
  const LaneValues values{ { va.data(), vb.data(), vc.data() }, vp.data(), 1, 0.5F };
  std::vector<float> triangle(kTriangleRows * lanes);
  prepareTriangle(lanes, a.data(), b.data(), c.data(), triangle.data());
  std::vector<float> squares(lanes, std::numeric_limits<float>::infinity());
  std::vector<float> errors(lanes, 0.0F);
  squares[lanes - 1] = 0.1F; // something else was nearer
  minimumDistances(lanes, triangle.data(), p.data(), &values, 1, squares.data(), errors.data());
  for (int i = 0; i + 1 < lanes; ++i)
  {
    EXPECT_FLOAT_EQ(squares[i], 0.25F);
    EXPECT_NEAR(errors[i], 0.25F * 4.0F, 1e-5); // 10 + 1 + 1 - 10, times 0.5, squared
  }
  EXPECT_EQ(squares[lanes - 1], 0.1F);
  EXPECT_EQ(errors[lanes - 1], 0.0F);
}

TEST_P(TimeLanes, TrianglesWithoutAreaAreFarAway)
{
  const int lanes = GetParam();
  Rows a(lanes);
  std::vector<float> triangle(kTriangleRows * lanes);
  prepareTriangle(lanes, a.data(), a.data(), a.data(), triangle.data());
  std::vector<float> squares(lanes, 3.0F);
  minimumDistances(lanes, triangle.data(), 1, a.data(), squares.data());
  EXPECT_EQ(squares, std::vector<float>(lanes, 3.0F));
}

// [W06] 2: the plane of a quad is as far from all its corners.
TEST_P(TimeLanes, PlanesOfQuadsAreAsFarFromAllCorners)
{
  const int lanes = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<float> off(-0.2F, 0.2F);
  const float square[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  std::vector<Rows> corners(4, Rows(lanes));
  for (int i = 0; i < lanes; ++i)
  {
    const float height = off(random);
    for (int k = 0; k < 4; ++k)
    {
      corners[k].values[i] = square[k][0];
      corners[k].values[lanes + i] = square[k][1];
      corners[k].values[2 * lanes + i] = k % 2 == 0 ? height : -height;
    }
  }
  std::vector<std::vector<float>> quadrics(4, std::vector<float>(kQuadricRows * lanes, 0.0F));
  const float* cornerRows[4];
  float* quadricRows[4];
  for (int k = 0; k < 4; ++k)
  {
    cornerRows[k] = corners[k].data();
    quadricRows[k] = quadrics[k].data();
  }
  addCellQuadrics(lanes, cornerRows, 4, quadricRows);
  const std::vector<float> here(3 * lanes, 0.0F);
  for (int k = 0; k < 4; ++k)
  {
    std::vector<float> squares(lanes);
    quadricValues(lanes, quadrics[k].data(), here.data(), squares.data());
    for (int i = 0; i < lanes; ++i)
    {
      const float height = corners[0].values[2 * lanes + i];
      const float weight = quadrics[k][kQuadricWeight * lanes + i];
      EXPECT_NEAR(weight, 1.0F, 1e-5);
      EXPECT_NEAR(squares[i], weight * height * height, 1e-6);
    }
  }
}

TEST_P(TimeLanes, QuadricsAddUp)
{
  const int lanes = GetParam();
  std::mt19937 random(11);
  std::vector<Rows> corners(6, Rows(lanes));
  for (Rows& rows : corners)
  {
    rows.randomize(random);
  }
  // The sum of the quadrics of two triangles at a third point, against the planes themselves.
  std::vector<std::vector<float>> quadrics(6, std::vector<float>(kQuadricRows * lanes, 0.0F));
  for (int t = 0; t < 2; ++t)
  {
    const float* cornerRows[3];
    float* quadricRows[3];
    for (int k = 0; k < 3; ++k)
    {
      cornerRows[k] = corners[3 * t + k].data();
      quadricRows[k] = quadrics[3 * t + k].data();
    }
    addCellQuadrics(lanes, cornerRows, 3, quadricRows);
  }
  std::vector<float> d(3 * lanes);
  subtract(lanes, 3, corners[3].data(), corners[0].data(), d.data());
  mergeQuadric(lanes, quadrics[0].data(), d.data(), quadrics[3].data()); // 0 goes to 3
  Rows x(lanes);
  x.randomize(random);
  subtract(lanes, 3, x.data(), corners[3].data(), d.data());
  std::vector<float> squares(lanes);
  quadricValues(lanes, quadrics[3].data(), d.data(), squares.data());
  for (int i = 0; i < lanes; ++i)
  {
    double expected = 0.0;
    double weight = 0.0;
    for (int t = 0; t < 2; ++t)
    {
      const Point a = corners[3 * t].at(i);
      const Point n = cross(minus(corners[3 * t + 1].at(i), a), minus(corners[3 * t + 2].at(i), a));
      const double area = 0.5 * std::sqrt(dot(n, n));
      const double height = dot(unit(n), minus(x.at(i), a));
      expected += area * height * height;
      weight += area;
    }
    EXPECT_NEAR(squares[i], expected, 1e-4 * (1.0 + expected));
    EXPECT_NEAR(quadrics[3][kQuadricWeight * lanes + i], weight, 1e-4);
  }
}

TEST_P(TimeLanes, BoundaryPlanesStandOnTheirCell)
{
  const int lanes = GetParam();
  const Rows a(lanes);
  const Rows b = constant(lanes, 2.0F, 0.0F, 0.0F);
  const Rows c = constant(lanes, 0.0F, 1.0F, 0.0F);
  const float* corners[3] = { a.data(), b.data(), c.data() };
  std::vector<std::vector<float>> quadrics(3, std::vector<float>(kQuadricRows * lanes, 0.0F));
  float* rows[3] = { quadrics[0].data(), quadrics[1].data(), quadrics[2].data() };
  addBoundaryQuadrics(lanes, corners, 3, 0, 1.0F, rows);
  // Along and up the cell's plane it is free; off the line it is not.
  const Rows d = constant(lanes, 5.0F, 0.5F, 3.0F);
  std::vector<float> squares(lanes);
  quadricValues(lanes, quadrics[0].data(), d.data(), squares.data());
  for (int i = 0; i < lanes; ++i)
  {
    EXPECT_NEAR(squares[i], 4.0F * 0.25F, 1e-5); // weight: the edge's squared length
    EXPECT_EQ(quadrics[2][i], 0.0F);
  }
}

TEST_P(TimeLanes, RefuseCellsThatTurnOrFold)
{
  const int lanes = GetParam();
  const auto at = [lanes](float x, float y, float z) { return constant(lanes, x, y, z); };
  const Rows a = at(0, 0, 0);
  const Rows b = at(1, 0, 0);
  const Rows c = at(1, 1, 0);
  const Rows d = at(0, 1, 0);
  std::vector<float> folds(lanes);
  const auto may = [lanes, &folds](
                     const std::vector<const Rows*>& before, const std::vector<const Rows*>& now)
  {
    std::vector<const float*> old;
    std::vector<const float*> fresh;
    old.reserve(before.size());
    fresh.reserve(now.size());
    for (const Rows* rows : before)
    {
      old.push_back(rows->data());
    }
    for (const Rows* rows : now)
    {
      fresh.push_back(rows->data());
    }
    const auto oldCount = static_cast<int>(old.size());
    const auto count = static_cast<int>(fresh.size());
    std::fill(folds.begin(), folds.end(), 0.0F);
    raiseByFolds(lanes, old.data(), oldCount, fresh.data(), count, folds.data());
    const bool allowed = mayReplaceCell(lanes, old.data(), oldCount, fresh.data(), count);
    EXPECT_EQ(allowed, largest(lanes, folds.data()) == 0.0F);
    return allowed;
  };
  EXPECT_TRUE(may({ &a, &b, &c, &d }, { &a, &b, &c }));
  EXPECT_TRUE(may({ &a, &b, &c }, { &a, &b, &d }));
  EXPECT_FALSE(may({ &a, &b, &c }, { &a, &c, &b })) << "flipped";
  const Rows inside = at(0.2F, 0.4F, 0);
  EXPECT_FALSE(may({ &a, &b, &c, &d }, { &a, &b, &inside, &d })) << "a corner inwards";
  const Rows needle = at(0.5F, 1e-5F, 0);
  EXPECT_FALSE(may({ &a, &b, &c }, { &a, &b, &needle })) << "a needle";
  const Rows up = at(0, 0.1F, 1);
  EXPECT_FALSE(may({ &a, &b, &c }, { &a, &b, &up })) << "turned by 84 degrees";
  Rows once = at(1, 1, 0);
  once.values[lanes + lanes - 1] = -1.0F;
  EXPECT_FALSE(may({ &a, &b, &c }, { &a, &b, &once })) << "flipped at one step";
  for (int i = 0; i < lanes; ++i)
  {
    // Half the longest edge, which is the diagonal of a square.
    EXPECT_FLOAT_EQ(folds[i], i + 1 < lanes ? 0.0F : 0.25F * 2.0F);
  }
  EXPECT_TRUE(may({ &a, &b, &b }, { &a, &c, &b })) << "the old one has no area";
  EXPECT_TRUE(may({ &a, &b, &needle }, { &a, &needle, &b })) << "the old one is a needle";
  EXPECT_TRUE(may({ &a, &b, &inside, &d }, { &a, &d, &c })) << "the old one has a corner inwards";
}

TEST_P(TimeLanes, FindsTheNearestPointAtEachStep)
{
  const int lanes = GetParam();
  constexpr int kCount = 9;
  std::mt19937 random(7);
  Rows points(lanes, 3 * kCount);
  points.randomize(random);
  Rows place(lanes);
  place.randomize(random);
  std::vector<int> nearest(lanes, -1);
  nearestPoints(lanes, points.data(), kCount, place.data(), nearest.data());
  for (int lane = 0; lane < lanes; ++lane)
  {
    std::array<double, kCount> squares{};
    for (int k = 0; k < kCount; ++k)
    {
      const float* rows = points.data() + 3 * lanes * k;
      const Point offset =
        minus({ rows[lane], rows[lanes + lane], rows[2 * lanes + lane] }, place.at(lane));
      squares[k] = dot(offset, offset);
    }
    EXPECT_EQ(nearest[lane], std::min_element(squares.begin(), squares.end()) - squares.begin());
  }
}

TEST_P(TimeLanes, TakesTheMeanOfPoints)
{
  const int lanes = GetParam();
  std::mt19937 random(8);
  Rows a(lanes);
  Rows b(lanes);
  Rows c(lanes);
  for (Rows* rows : { &a, &b, &c })
  {
    rows->randomize(random);
  }
  const float* rows[] = { a.data(), b.data(), c.data() };
  Rows middle(lanes);
  mean(lanes, rows, 3, middle.values.data());
  for (int i = 0; i < 3 * lanes; ++i)
  {
    EXPECT_NEAR(middle.values[i], (a.values[i] + b.values[i] + c.values[i]) / 3, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, TimeLanes, ::testing::Values(4, 8, 16, 32));

} // namespace
} // namespace undecimate
