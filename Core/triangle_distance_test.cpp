// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "triangle_distance.h"

#include "testing/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Closest;
using testing::closestPoint;

class Points
{
public:
  void add(const Vector& p)
  {
    this->points_.push_back(p);
    this->x_.push_back(static_cast<float>(p.x));
    this->y_.push_back(static_cast<float>(p.y));
    this->z_.push_back(static_cast<float>(p.z));
  }
  PointRows rows()
  {
    const int size = paddedSize(static_cast<int>(this->points_.size()));
    this->x_.resize(size, 0.0F);
    this->y_.resize(size, 0.0F);
    this->z_.resize(size, 0.0F);
    return { this->x_.data(), this->y_.data(), this->z_.data(), size };
  }
  const std::vector<Vector>& points() const { return this->points_; }

private:
  std::vector<Vector> points_;
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> z_;
};

class TriangleDistance : public ::testing::Test
{
protected:
  Vector any(double size)
  {
    std::uniform_real_distribution<double> coordinate(-size, size);
    const double x = coordinate(this->random);
    const double y = coordinate(this->random);
    return { x, y, coordinate(this->random) };
  }

  std::mt19937 random{ 8 };
};

TEST(PaddedSize, IsTheNextWholeBlock)
{
  EXPECT_EQ(paddedSize(0), 0);
  EXPECT_EQ(paddedSize(1), kRowBlock);
  EXPECT_EQ(paddedSize(kRowBlock), kRowBlock);
  EXPECT_EQ(paddedSize(kRowBlock + 1), 2 * kRowBlock);
}

// A right triangle with legs of 1 in the plane z = 0, and a point in each region.
//   c
//   | \                        .
//   a---b
TEST_F(TriangleDistance, EachRegionByHand)
{
  DistanceTriangle triangle;
  ASSERT_TRUE(triangle.set({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }));
  Points points;
  const std::vector<std::pair<Vector, double>> expected{ { { 0.25, 0.25, 0.5 }, 0.25 },
    { { 0, 0, 0 }, 0.0 }, { { -1, -1, 0 }, 2.0 }, { { 0.5, -2, 0 }, 4.0 }, { { 3, 0, 0 }, 4.0 },
    { { 1, 1, 0 }, 0.5 }, { { 0, 2, 1 }, 2.0 }, { { -3, 0.5, 0 }, 9.0 } };
  for (const auto& [point, square] : expected)
  {
    points.add(point);
  }
  std::vector<float> squares(kRowBlock);
  triangle.squaredDistances(points.rows(), squares.data());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    EXPECT_NEAR(squares[i], expected[i].second, 1e-6) << i;
  }
}

TEST_F(TriangleDistance, EqualsAnotherAlgorithmInDoublePrecision)
{
  for (int round = 0; round < 400; ++round)
  {
    const Vector a = any(1.0);
    const Vector b = any(1.0);
    const Vector c = any(1.0);
    const Vector n = cross(b - a, c - a);
    if (dot(n, n) < 1e-3)
    {
      continue;
    }
    DistanceTriangle triangle;
    ASSERT_TRUE(triangle.set(a, b, c));
    Points points;
    for (int i = 0; i < 37; ++i)
    {
      points.add(any(round % 2 == 0 ? 1.5 : 5.0));
    }
    for (const Vector& corner : { a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (a + c) })
    {
      points.add(corner);
    }
    const PointRows rows = points.rows();
    std::vector<float> squares(rows.size);
    std::vector<float> closest(rows.size);
    std::vector<float> weightB(rows.size);
    std::vector<float> weightC(rows.size);
    triangle.squaredDistances(rows, squares.data());
    triangle.closestPoints(rows, closest.data(), weightB.data(), weightC.data());
    for (std::size_t i = 0; i < points.points().size(); ++i)
    {
      const Vector& p = points.points()[i];
      const Closest exact = closestPoint(p, a, b, c);
      ASSERT_NEAR(squares[i], exact.square, 2e-5 * (1.0 + exact.square)) << round << " " << i;
      ASSERT_NEAR(closest[i], squares[i], 1e-6 * (1.0 + squares[i]));
      // The closest point, put together by the weights.
      const Vector q = a + weightB[i] * (b - a) + weightC[i] * (c - a);
      const Vector r = a + exact.weightB * (b - a) + exact.weightC * (c - a);
      const Vector d = q - r;
      ASSERT_NEAR(std::sqrt(dot(d, d)), 0.0, 5e-3) << round << " " << i;
      const double weightA = 1.0 - weightB[i] - weightC[i];
      EXPECT_GE(std::min<double>({ weightA, weightB[i], weightC[i] }), -1e-4);
      EXPECT_LE(std::max<double>({ weightA, weightB[i], weightC[i] }), 1.0 + 1e-4);
    }
  }
}

// No sampled point of the triangle is nearer, and one is nearly as near.
TEST_F(TriangleDistance, BoundsDenseSamples)
{
  for (int round = 0; round < 20; ++round)
  {
    const Vector a = any(1.0);
    const Vector b = any(1.0);
    const Vector c = any(1.0);
    DistanceTriangle triangle;
    ASSERT_TRUE(triangle.set(a, b, c));
    Points points;
    for (int i = 0; i < 8; ++i)
    {
      points.add(any(2.0));
    }
    std::vector<float> squares(8);
    triangle.squaredDistances(points.rows(), squares.data());
    for (int i = 0; i < 8; ++i)
    {
      double sampled = 1e9;
      for (int v = 0; v <= 100; ++v)
      {
        for (int w = 0; v + w <= 100; ++w)
        {
          const Vector d = points.points()[i] - (a + 0.01 * v * (b - a) + 0.01 * w * (c - a));
          sampled = std::min(sampled, std::sqrt(dot(d, d)));
        }
      }
      EXPECT_LE(std::sqrt(squares[i]), sampled + 1e-3);
      EXPECT_GE(std::sqrt(squares[i]), sampled - 0.04);
    }
  }
}

TEST_F(TriangleDistance, ProjectGivesCoordinatesAlongAxes)
{
  Points points;
  for (int i = 0; i < 19; ++i)
  {
    points.add(any(2.0));
  }
  const PointRows rows = points.rows();
  const Vector u{ 0.5, -1.0, 2.0 };
  const Vector v{ -3.0, 0.25, 1.0 };
  std::vector<float> x(rows.size);
  std::vector<float> y(rows.size);
  project(rows, u, v, x.data(), y.data());
  for (std::size_t i = 0; i < points.points().size(); ++i)
  {
    EXPECT_NEAR(x[i], dot(u, points.points()[i]), 1e-5);
    EXPECT_NEAR(y[i], dot(v, points.points()[i]), 1e-5);
  }
}

TEST_F(TriangleDistance, SidesArePositiveOnTheLeft)
{
  // The line through (1, 0) upwards: dx = 0, dy = 2, offset = dx * 0 - dy * 1 = -2.
  const std::vector<float> x{ 0.0F, 1.0F, 3.0F, -1.0F, 1.0F, 1.0F, 2.0F, 0.5F };
  const std::vector<float> y{ 0.0F, 5.0F, 1.0F, 2.0F, -9.0F, 0.0F, 0.0F, 7.0F };
  std::vector<float> sides(8);
  sidesOfLine(x.data(), y.data(), 8, 0.0F, 2.0F, -2.0F, sides.data());
  EXPECT_EQ(sides, (std::vector<float>{ 2.0F, 0.0F, -4.0F, 4.0F, 0.0F, 0.0F, -2.0F, 1.0F }));
}

// Heights over a tilted triangle of the points that lie over it, against the same in plain words.
TEST_F(TriangleDistance, LargestSquaredHeightIsOfThePointsInside)
{
  int inside = 0;
  for (int round = 0; round < 300; ++round)
  {
    const Vector a = any(1.0);
    Vector b = any(1.0);
    Vector c = any(1.0);
    const Vector u{ 1.0, 0.0, 0.0 };
    const Vector v{ 0.0, 1.0, 0.0 };
    const auto side = [](const Vector& p, const Vector& q, const Vector& r)
    { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
    if (side(a, b, c) < 0.0)
    {
      std::swap(b, c);
    }
    Vector normal = cross(b - a, c - a);
    normal = (1.0 / std::sqrt(dot(normal, normal))) * normal;
    Points points;
    for (int i = 0; i < 1 + round % 21; ++i)
    {
      points.add(any(1.0));
    }
    const PointRows rows = points.rows();
    std::vector<float> x(rows.size);
    std::vector<float> y(rows.size);
    project(rows, u, v, x.data(), y.data());
    const auto sidesOf = [&](const Vector& from, const Vector& to)
    {
      std::vector<float> sides(rows.size, -1.0F);
      const double dx = to.x - from.x;
      const double dy = to.y - from.y;
      sidesOfLine(x.data(), y.data(), rows.size, static_cast<float>(dx), static_cast<float>(dy),
        static_cast<float>(dx * from.y - dy * from.x), sides.data());
      return sides;
    };
    const std::vector<float> ab = sidesOf(a, b);
    const std::vector<float> bc = sidesOf(b, c);
    const std::vector<float> ac = sidesOf(a, c);
    std::vector<float> extra(rows.size);
    double expected = 0.0;
    double expectedExtra = 0.0;
    bool clear = true; // no point so near an edge that rounding decides
    for (int i = 0; i < rows.size; ++i)
    {
      extra[i] = static_cast<float>(i % 7);
      const Vector p{ rows.x[i], rows.y[i], rows.z[i] };
      const double least = std::min({ side(a, b, p), side(b, c, p), side(c, a, p) });
      clear = clear && std::abs(least) > 1e-4;
      if (least >= 0.0)
      {
        ++inside;
        const double height = dot(normal, p - a);
        expected = std::max(expected, height * height);
        expectedExtra = std::max<double>({ expectedExtra, height * height, extra[i] });
      }
    }
    if (!clear)
    {
      continue;
    }
    const SideRows sides{ ab.data(), bc.data(), ac.data() };
    const double offset = dot(normal, a);
    EXPECT_NEAR(largestSquaredHeight(rows, normal, offset, sides, nullptr), expected, 1e-4);
    EXPECT_NEAR(
      largestSquaredHeight(rows, normal, offset, sides, extra.data()), expectedExtra, 1e-4);
  }
  EXPECT_GT(inside, 50);
}

TEST_F(TriangleDistance, TrianglesWithoutAreaAreRefused)
{
  DistanceTriangle triangle;
  EXPECT_FALSE(triangle.set({ 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }));
  EXPECT_FALSE(triangle.set({ 1, 2, 3 }, { 1, 2, 3 }, { 4, 5, 6 }));
  EXPECT_FALSE(triangle.set({ 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 }));
  EXPECT_FALSE(triangle.set({ std::nan(""), 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }));
}

// Long thin triangles are where the weights of a naive formula explode.
TEST_F(TriangleDistance, Needles)
{
  for (const double width : { 1e-2, 1e-3, 1e-4 })
  {
    const Vector a{ 0, 0, 0 };
    const Vector b{ 1, 0, 0 };
    const Vector c{ 0.5, width, 0 };
    DistanceTriangle triangle;
    ASSERT_TRUE(triangle.set(a, b, c));
    Points points;
    for (int i = 0; i < 40; ++i)
    {
      points.add(any(1.0));
    }
    const PointRows rows = points.rows();
    std::vector<float> squares(rows.size);
    std::vector<float> weightB(rows.size);
    std::vector<float> weightC(rows.size);
    triangle.closestPoints(rows, squares.data(), weightB.data(), weightC.data());
    for (std::size_t i = 0; i < points.points().size(); ++i)
    {
      const Closest exact = closestPoint(points.points()[i], a, b, c);
      EXPECT_NEAR(squares[i], exact.square, 1e-5 * (1.0 + exact.square));
      EXPECT_GE(std::min(weightB[i], weightC[i]), -1e-3F);
      EXPECT_LE(weightB[i] + weightC[i], 1.0F + 1e-3F);
    }
  }
}

// Several triangles at a time: the same numbers as one by one, and the first of equally near ones.
TEST_F(TriangleDistance, OfSeveralTrianglesIsThatOfTheNearest)
{
  DistanceTriangles several;
  int marked = 0;
  for (int round = 0; round < 60; ++round)
  {
    const int size = 3 + round % 14;
    std::vector<Vector> ring;
    HoleTriangulation filling;
    for (int i = 0; i < size; ++i)
    {
      ring.push_back(any(1.0));
      ring.back().x += 5.0 * i; // no triangle without an area
    }
    for (int i = 1; i + 1 < size; ++i)
    {
      filling.triangles[filling.count++] = { 0, static_cast<unsigned char>(i),
        static_cast<unsigned char>(i + 1) };
    }
    Points points;
    points.add(ring.front()); // of all triangles
    for (int i = 0; i < 1 + round; ++i)
    {
      points.add(any(8.0));
    }
    const PointRows rows = points.rows();
    std::vector<float> expected(rows.size, std::numeric_limits<float>::infinity());
    std::vector<int> expectedTriangles(rows.size, 0);
    std::vector<float> squares(rows.size);
    for (int t = 0; t < filling.count; ++t)
    {
      DistanceTriangle one;
      const auto& corners = filling.triangles[t];
      ASSERT_TRUE(one.set(ring[corners[0]], ring[corners[1]], ring[corners[2]]));
      one.squaredDistances(rows, squares.data());
      for (int i = 0; i < rows.size; ++i)
      {
        expectedTriangles[i] = squares[i] < expected[i] ? t : expectedTriangles[i];
        expected[i] = std::min(expected[i], squares[i]);
      }
    }
    std::vector<int> triangles(rows.size, -1);
    several.set(ring.data(), filling);
    several.findNearest(rows, squares.data(), triangles.data());
    EXPECT_EQ(squares, expected) << size;
    EXPECT_EQ(triangles, expectedTriangles) << size;
    // What is marked is near; what is not is not over any triangle, or too high.
    const float enough = 0.5F;
    several.markNear(rows, enough, triangles.data());
    for (int i = 0; i < rows.size; ++i)
    {
      bool over = false;
      for (int t = 0; t < filling.count; ++t)
      {
        const auto& corners = filling.triangles[t];
        const Vector& a = ring[corners[0]];
        const Vector normal = cross(ring[corners[1]] - a, ring[corners[2]] - a);
        const Vector p{ rows.x[i], rows.y[i], rows.z[i] };
        const double height = dot(normal, p - a) / std::sqrt(dot(normal, normal));
        double least = HUGE_VAL;
        for (int c = 0; c < 3; ++c)
        {
          const Vector& from = ring[corners[c]];
          const Vector inwards = cross(normal, ring[corners[nextCorner(c)]] - from);
          least = std::min(least, dot(inwards, p - from) / std::sqrt(dot(inwards, inwards)));
        }
        over = over || (least > 1e-4 && height * height < enough - 1e-4);
      }
      marked += triangles[i];
      EXPECT_LE(triangles[i] * expected[i], enough + 1e-4F);
      EXPECT_GE(triangles[i], over ? 1 : 0);
    }
  }
  EXPECT_GT(marked, 50);
}

TEST_F(TriangleDistance, NearestPointIsTheFirstOfEquals)
{
  for (int count = 1; count < 40; ++count)
  {
    Points points;
    for (int i = 0; i < count; ++i)
    {
      points.add(any(1.0));
    }
    const PointRows rows = points.rows();
    for (int i = 0; i < count; ++i)
    {
      EXPECT_EQ(nearestPoint(rows, rows.x[i], rows.y[i], rows.z[i]), i);
    }
    Points twice;
    for (int i = 0; i < 2 * count; ++i)
    {
      twice.add(points.points()[i % count]);
    }
    const PointRows all = twice.rows();
    EXPECT_EQ(nearestPoint(all, all.x[count], all.y[count], all.z[count]), 0);
  }
}

} // namespace
} // namespace undecimate
