// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "hole_candidates.h"

#include "testing/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace undecimate
{
namespace
{

constexpr Vector kOrigin{ 0.0, 0.0, 0.0 };

/// A hole around the origin, more or less flat, and what is known of it.
struct TestHole
{
  std::vector<Vector> ring;
  std::vector<Vector> ringNormals;
  std::vector<Vector> oldNormals;
  Vector normal = kOrigin;
  bool boundary = false;

  TestHole(int size, bool boundary_, double height, std::mt19937& random)
    : boundary(boundary_)
  {
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const double angle = (boundary_ ? 3.0 : 2.0 * std::acos(-1.0)) / (boundary_ ? size - 1 : size);
    for (int i = 0; i < size; ++i)
    {
      const double a = angle * (i + 0.3 * part(random));
      const double r = 1.0 + 0.5 * part(random);
      this->ring.push_back({ r * std::cos(a), r * std::sin(a), height * part(random) });
      this->ringNormals.push_back({ part(random), part(random), 0.3 + part(random) });
    }
    for (int i = 0; i < size - (boundary_ ? 1 : 0); ++i)
    {
      this->oldNormals.push_back(cross(this->ring[i], this->ring[(i + 1) % size]));
      this->normal = this->normal + this->oldNormals.back();
    }
    this->normal = (1.0 / std::sqrt(dot(this->normal, this->normal))) * this->normal;
  }

  int size() const { return static_cast<int>(this->ring.size()); }
  bool isRingEdge(int i, int j) const
  {
    return j == i + 1 || (!this->boundary && i == 0 && j == this->size() - 1);
  }

  void begin(HoleCandidates& candidates, const HeightFieldDirection& heightField,
    Turn turn = Turn::Small) const
  {
    candidates.place(this->ring.data(), this->size(), this->boundary);
    candidates.judge(this->ringNormals.data(), this->normal, heightField, turn);
    candidates.findCrossings(this->normal);
  }

  /// One triangle by itself.
  bool isAllowed(const Triple& t, const HeightFieldDirection& heightField, Turn turn) const
  {
    const FilledTriangle triangle(this->ring[t[0]], this->ring[t[1]], this->ring[t[2]]);
    bool allowed = !triangle.degenerate() && heightField.allows(triangle) &&
      std::any_of(t.begin(), t.end(),
        [&](unsigned char i) { return !triangle.opposes(this->ringNormals[i]); });
    bool onRing = false;
    for (const auto& [i, j, edge] :
      { std::array<int, 3>{ t[0], t[1], t[0] }, { t[1], t[2], t[1] }, { t[0], t[2], t[2] } })
    {
      if (this->isRingEdge(i, j))
      {
        onRing = true;
        allowed = allowed && triangle.follows(this->oldNormals[edge], turn);
      }
    }
    return allowed && (onRing || triangle.follows(this->normal, turn));
  }

  /// Of one edge by itself: the lines of it and of each old edge that it crosses.
  double crossing(int i, int j) const
  {
    const Vector along = this->ring[j] - this->ring[i];
    const bool left = dot(cross(along, kOrigin - this->ring[i]), this->normal) >= 0.0;
    double largest = 0.0;
    for (int k = 0; k < this->size() && !this->isRingEdge(i, j); ++k)
    {
      const bool between = i < k && k < j;
      const bool beyond = (k < i || k > j) && !this->boundary;
      if (left ? between : beyond)
      {
        const Vector m = cross(along, this->ring[k]);
        largest = std::max(largest, std::pow(dot(this->ring[i], m), 2) / dot(m, m));
      }
    }
    return largest;
  }
};

/// Visit(t) for all triangles i < j < k.
template <typename Visit>
void forTriples(int size, Visit&& visit)
{
  for (int k = 2; k < size; ++k)
  {
    for (int j = 1; j < k; ++j)
    {
      for (int i = 0; i < j; ++i)
      {
        visit(Triple{ static_cast<unsigned char>(i), static_cast<unsigned char>(j),
          static_cast<unsigned char>(k) });
      }
    }
  }
}

class HoleCandidatesTest : public ::testing::Test
{
protected:
  /// Of every size, inside and at the boundary, flat and rough.
  template <typename Check>
  void forHoles(int largest, Check&& check)
  {
    for (int size = 3; size <= largest; ++size)
    {
      for (int round = 0; round < 24; ++round)
      {
        check(TestHole(size, round % 2 == 1, round < 8 ? 0.0 : 0.1 * round, this->random));
      }
    }
  }

  /// Points over the hole.
  PointRows addPoints(int count)
  {
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    for (auto& row : this->rows)
    {
      row.resize(paddedSize(count));
    }
    for (int i = 0; i < paddedSize(count); ++i)
    {
      for (auto& row : this->rows)
      {
        row[i] = i < count ? static_cast<float>(part(this->random)) : row[0];
      }
    }
    return { this->rows[0].data(), this->rows[1].data(), this->rows[2].data(), paddedSize(count) };
  }

  std::mt19937 random{ 5 };
  std::vector<float> rows[3];
  std::unique_ptr<HoleCandidates> candidates = std::make_unique<HoleCandidates>();
  const TriangleTopology torus{ testing::torus(6, 5).view() };
  const HeightFieldDirection noField{ torus };
};

TEST_F(HoleCandidatesTest, JudgesTrianglesAsOneByOne)
{
  const TriangleTopology plane(testing::flatGrid(3, 3).view());
  const HeightFieldDirection field(plane);
  ASSERT_TRUE(field.known());
  ASSERT_FALSE(noField.known());
  int allowed = 0;
  int refused = 0;
  using Case = std::pair<const HeightFieldDirection*, Turn>;
  for (const auto& [direction, turn] : { Case{ &noField, Turn::Small }, { &field, Turn::Small },
         { &noField, Turn::Wide }, { &field, Turn::Wide } })
  {
    const HeightFieldDirection& known = *direction;
    const Turn widest = turn;
    forHoles(kMaximumCompared,
      [&](const TestHole& hole)
      {
        hole.begin(*candidates, known, widest);
        forTriples(hole.size(),
          [&](const Triple& t)
          {
            const bool expected = hole.isAllowed(t, known, widest);
            ++(expected ? allowed : refused);
            ASSERT_EQ(candidates->isAllowed(t), expected) << +t[0] << " " << +t[1] << " " << +t[2];
            const FilledTriangle one(hole.ring[t[0]], hole.ring[t[1]], hole.ring[t[2]]);
            if (expected)
            {
              // Rounding turns needles most.
              const double rounding = 1e-6 / one.shape();
              EXPECT_NEAR(candidates->shape(t), one.shape(), 1e-6);
              const Vector difference = candidates->normal(t) - one.normal();
              EXPECT_LE(dot(difference, difference), rounding * rounding);
              EXPECT_NEAR(candidates->offset(t), dot(one.normal(), hole.ring[t[0]]), rounding);
            }
          });
      });
  }
  EXPECT_GT(allowed, 1000);
  EXPECT_GT(refused, 1000);
}

TEST_F(HoleCandidatesTest, FindsCrossingsAsOneByOne)
{
  forHoles(kMaximumCompared,
    [&](const TestHole& hole)
    {
      hole.begin(*candidates, noField);
      for (int j = 1; j < hole.size(); ++j)
      {
        for (int i = 0; i < j; ++i)
        {
          const double expected = hole.crossing(i, j);
          EXPECT_NEAR(candidates->crossing(i, j), expected, 2e-6 * std::sqrt(expected))
            << i << " " << j;
        }
      }
    });
}

// Few points, many, and more than a chunk: each counts for the triangles that it lies over.
TEST_F(HoleCandidatesTest, MeasuresTheHighestPointOverEachTriangle)
{
  const Vector axisX{ 1.0, 0.0, 0.0 };
  const Vector axisY{ 0.0, 1.0, 0.0 };
  forHoles(10,
    [&](const TestHole& hole)
    {
      for (const int count : { 1, 3, 4, 20, 300 })
      {
        const PointRows points = addPoints(count);
        hole.begin(*candidates, noField);
        candidates->measure(points, count, axisX, axisY);
        const auto side = [&](const Vector& from, const Vector& to, int s) {
          return (to.x - from.x) * (points.y[s] - from.y) -
            (to.y - from.y) * (points.x[s] - from.x);
        };
        forTriples(hole.size(),
          [&](const Triple& t)
          {
            if (!candidates->isAllowed(t))
            {
              return;
            }
            // Inside and near an edge are two things: the largest lies between what surely counts
            // and what may.
            double sure = 0.0;
            double possible = 0.0;
            for (int s = 0; s < count; ++s)
            {
              double least = HUGE_VAL;
              for (int c = 0; c < 3; ++c)
              {
                const int from = t[c];
                const int to = t[nextCorner(c)];
                const bool outline = to == from + 1 || (to == 0 && from == hole.size() - 1);
                least = outline ? least : std::min(least, side(hole.ring[from], hole.ring[to], s));
              }
              const Vector p{ points.x[s], points.y[s], points.z[s] };
              const FilledTriangle one(hole.ring[t[0]], hole.ring[t[1]], hole.ring[t[2]]);
              const double square = std::pow(dot(one.normal(), p - hole.ring[t[0]]), 2);
              sure = least > 1e-5 ? std::max(sure, square) : sure;
              possible = least > -1e-5 ? std::max(possible, square) : possible;
            }
            EXPECT_GE(candidates->square(t), sure - 1e-5) << count;
            EXPECT_LE(candidates->square(t), possible + 1e-5) << count;
          });
      }
    });
}

// All triangulations of the part behind the edge i, k.
double leastSum(int i, int k, const std::function<double(int, int, int)>& cost)
{
  if (k == i + 1)
  {
    return 0.0;
  }
  double least = HUGE_VAL;
  for (int j = i + 1; j < k; ++j)
  {
    least = std::min(least, leastSum(i, j, cost) + leastSum(j, k, cost) + cost(i, j, k));
  }
  return least;
}

TEST_F(HoleCandidatesTest, ChoosesTheBestTriangulation)
{
  constexpr double kScale = 0.7;
  constexpr double kShape = 0.05;
  int found = 0;
  int none = 0;
  forHoles(8,
    [&](const TestHole& hole)
    {
      const PointRows points = addPoints(5);
      hole.begin(*candidates, noField);
      candidates->measure(points, 5, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 });
      const auto cost = [&](int i, int j, int k)
      {
        const Triple t{ static_cast<unsigned char>(i), static_cast<unsigned char>(j),
          static_cast<unsigned char>(k) };
        if (!candidates->isAllowed(t))
        {
          return HUGE_VAL;
        }
        const double largest = std::max({ candidates->square(t), candidates->crossing(i, j),
          candidates->crossing(j, k), candidates->crossing(i, k) });
        const double square =
          kScale * (largest + std::pow(kShape * (1.0 - candidates->shape(t)), 2));
        return square * square;
      };
      const double expected = leastSum(0, hole.size() - 1, cost);
      HoleTriangulation filling;
      const bool any = candidates->choose(kScale, kShape, filling);
      ++(any ? found : none);
      ASSERT_EQ(any, expected < HUGE_VAL);
      if (!any)
      {
        return;
      }
      ASSERT_EQ(filling.count, hole.size() - 2);
      double sum = 0.0;
      for (int t = 0; t < filling.count; ++t)
      {
        const auto& corners = filling.triangles[t];
        ASSERT_TRUE(corners[0] < corners[1] && corners[1] < corners[2]);
        sum += cost(corners[0], corners[1], corners[2]);
      }
      EXPECT_NEAR(sum, expected, 1e-9 * expected);
    });
  EXPECT_GT(found, 20);
  EXPECT_GT(none, 0);
}

TEST_F(HoleCandidatesTest, TakesNoRefusedTriangleAndNoForbiddenEdge)
{
  TestHole hole(8, false, 0.0, random);
  for (auto& normal : hole.ringNormals)
  {
    normal = hole.normal;
  }
  const PointRows points = addPoints(1);
  const auto choose = [&](HoleTriangulation& filling)
  {
    candidates->measure(points, 1, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 });
    return candidates->choose(1.0, 0.01, filling);
  };
  hole.begin(*candidates, noField);
  HoleTriangulation filling;
  int rounds = 0;
  for (; choose(filling) && rounds < 200; ++rounds)
  {
    // Rule the first triangle out, or an edge of it that would be new.
    const Triple t = filling.triangles[0];
    if (rounds % 2 == 0)
    {
      candidates->refuse(t);
    }
    else
    {
      const bool first = !hole.isRingEdge(t[0], t[1]);
      const bool second = !hole.isRingEdge(t[1], t[2]);
      candidates->forbidEdge(first ? t[0] : second ? t[1] : t[0], first ? t[1] : t[2]);
    }
    EXPECT_FALSE(candidates->isAllowed(t));
  }
  EXPECT_GT(rounds, 3);
  EXPECT_LT(rounds, 200);
}

} // namespace
} // namespace undecimate
