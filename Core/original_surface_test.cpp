// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "original_surface.h"

#include "testing/closest_point.h"
#include "testing/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Mesh;

Vector pointOf(const Mesh& mesh, Index node)
{
  const std::array<double, 3> p = mesh.point(node);
  return { p[0], p[1], p[2] };
}

/// By all triangles.
double trueSquare(const Mesh& mesh, const Vector& p)
{
  double least = HUGE_VAL;
  for (Index t = 0; t < mesh.triangleCount(); ++t)
  {
    const Index* corners = mesh.triangles.data() + std::size_t{ 3 } * static_cast<std::size_t>(t);
    least = std::min(least,
      testing::closestPoint(
        p, pointOf(mesh, corners[0]), pointOf(mesh, corners[1]), pointOf(mesh, corners[2]))
        .square);
  }
  return least;
}

Index nearestNode(const Mesh& mesh, const Vector& p)
{
  Index nearest = 0;
  double least = HUGE_VAL;
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    const Vector d = p - pointOf(mesh, node);
    nearest = dot(d, d) < least ? node : nearest;
    least = std::min(least, dot(d, d));
  }
  return nearest;
}

TEST(OriginalSurface, NormalsAreUnitAndWeightedByArea)
{
  const Mesh mesh = testing::cube(2);
  const TriangleTopology topology(mesh.view());
  const OriginalSurface surface(topology);
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    const Vector normal = surface.normal(node);
    EXPECT_NEAR(dot(normal, normal), 1.0, 1e-12);
    const Vector p = pointOf(mesh, node);
    const double coordinates[] = { p.x, p.y, p.z };
    const double components[] = { normal.x, normal.y, normal.z };
    for (int axis = 0; axis < 3; ++axis)
    {
      // Towards the faces that the node is on, and along the others.
      const double side = coordinates[axis] - 1.0;
      EXPECT_GE(components[axis] * side, side == 0.0 ? 0.0 : 0.1) << node;
      EXPECT_NEAR(components[axis] * (1.0 - std::abs(side)), 0.0, 1e-12) << node;
    }
  }
}

TEST(OriginalSurface, ThreadsDoNotMatter)
{
  const Mesh mesh = testing::hills(400, 300);
  const TriangleTopology topology(mesh.view());
  const OriginalSurface surface(topology);
  for (const int count : { 2, 5 })
  {
    Threads threads(count);
    const TriangleTopology shared(mesh.view(), &threads);
    const OriginalSurface parallel(shared, &threads);
    for (Index node = 0; node < mesh.nodeCount(); ++node)
    {
      const auto entries = surface.ring(node);
      const auto others = parallel.ring(node);
      ASSERT_TRUE(std::equal(others.begin(), others.end(), entries.begin(), entries.end()));
    }
  }
}

TEST(OriginalSurface, NoNormalWithoutATriangle)
{
  Mesh mesh = testing::cube(1);
  const Index loose = mesh.addNode(5.0, 5.0, 5.0);
  const TriangleTopology topology(mesh.view());
  const Vector normal = OriginalSurface(topology).normal(loose);
  EXPECT_EQ(dot(normal, normal), 0.0);
}

// From the nearest node the walk finds the nearest triangle of surfaces without folds.
TEST(OriginalSurface, FindsTheNearestTriangleFromTheNearestNode)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (const Mesh& mesh : { testing::torus(24, 12), testing::cube(6), testing::flatGrid(9, 7) })
  {
    const TriangleTopology topology(mesh.view());
    const OriginalSurface surface(topology);
    for (int attempt = 0; attempt < 400; ++attempt)
    {
      const auto any = [&] { return static_cast<Index>(random() % unsigned(mesh.nodeCount())); };
      const Vector place = pointOf(mesh, any());
      const Vector p{ place.x + shift(random), place.y + shift(random), place.z + shift(random) };
      const double expected = trueSquare(mesh, p);
      EXPECT_NEAR(surface.squaredDistance(p, nearestNode(mesh, p), -1.0), expected, 1e-12);
      // From anywhere it is never too small.
      EXPECT_GE(surface.squaredDistance(p, any(), -1.0), expected - 1e-12);
    }
  }
}

// At an edge two triangles are nearest, and both are asked which way they face.
TEST(OriginalSurface, EdgesFaceBothWays)
{
  const Mesh mesh = testing::cube(2);
  const TriangleTopology topology(mesh.view());
  const OriginalSurface surface(topology);
  const Vector onEdge{ 2.0, 2.0, 0.5 };
  const auto facesAway = [&](const Vector& point, const Vector& direction)
  {
    const OriginalSurface::Nearest nearest = surface.nearest(point, nearestNode(mesh, point), -1.0);
    EXPECT_NEAR(nearest.square, trueSquare(mesh, point), 1e-12);
    return surface.facesAway(point, nearest, direction);
  };
  EXPECT_FALSE(facesAway(onEdge, { 1.0, 1.0, 0.0 }));
  EXPECT_TRUE(facesAway(onEdge, { 1.0, -0.1, 0.0 }));
  EXPECT_TRUE(facesAway(onEdge, { -0.1, 1.0, 0.0 }));
  const Vector onFace{ 2.1, 1.3, 0.6 };
  EXPECT_FALSE(facesAway(onFace, { 0.1, -1.0, 0.0 }));
  EXPECT_TRUE(facesAway(onFace, { -0.1, 1.0, 0.0 }));
}

TEST(OriginalSurface, StopsWhenItIsNearEnough)
{
  const Mesh mesh = testing::flatGrid(9, 7);
  const TriangleTopology topology(mesh.view());
  const OriginalSurface surface(topology);
  const Vector p = pointOf(mesh, mesh.nodeCount() - 1);
  EXPECT_GT(surface.squaredDistance(p, 0, HUGE_VAL), 0.0); // the first triangle will do
  EXPECT_EQ(surface.squaredDistance(p, mesh.nodeCount() - 1, -1.0), 0.0);
}

// What is near is so by the triangles around the node; over the middle of one of them nothing else
// is asked for.
TEST(OriginalSurface, KnowsWhatIsNearTheTrianglesAroundANode)
{
  std::mt19937 random(12);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int near = 0;
  int far = 0;
  for (const Mesh& mesh : { testing::torus(24, 12), testing::cube(6), testing::flatGrid(9, 7) })
  {
    const TriangleTopology topology(mesh.view());
    const OriginalSurface surface(topology);
    for (int attempt = 0; attempt < 400; ++attempt)
    {
      const Index t = static_cast<Index>(random() % unsigned(mesh.triangleCount()));
      const auto& nodes = topology.triangle(t).nodes;
      const Vector a = pointOf(mesh, nodes[0]);
      const Vector b = pointOf(mesh, nodes[1]);
      const Vector c = pointOf(mesh, nodes[2]);
      Vector normal = cross(b - a, c - a);
      normal = (1.0 / std::sqrt(dot(normal, normal))) * normal;
      const double height = 0.02 * part(random);
      const Vector p = (1.0 / 3.0) * (a + b + c) + height * normal;
      const double enough = 0.02 * 0.02 * part(random);
      const double found = surface.squaredDistance(p, nodes[0], enough);
      const bool isNear = surface.isNear(p, nodes[0], enough);
      ++(isNear ? near : far);
      EXPECT_TRUE(!isNear || found <= enough);
      EXPECT_TRUE(isNear || height * height > enough * (1.0 - 1e-6));
    }
    // Beside the surface there is nothing over it.
    const Vector outside{ 100.0, 100.0, 100.0 };
    EXPECT_FALSE(surface.isNear(outside, 0, 1e-3));
  }
  EXPECT_GT(near, 100);
  EXPECT_GT(far, 100);
}

// Interior nodes, boundaries, a bow tie, an edge of three triangles, and a node without any.
TEST(OriginalSurface, FansHaveEachTriangleOnce)
{
  Index touching = kNone;
  Mesh loose = testing::flatGrid(4, 3);
  loose.addNode(5.0, 5.0, 5.0);
  for (const Mesh& mesh : { testing::cube(2), testing::flatGrid(5, 4), testing::disc(3, 7),
         testing::bowTie(2, touching), testing::tJoint(3), loose })
  {
    using Corners = std::array<Index, 3>;
    std::multiset<std::pair<Index, Corners>> expected;
    for (Index t = 0; t < mesh.triangleCount(); ++t)
    {
      const Index* corners = mesh.triangles.data() + std::size_t{ 3 } * static_cast<std::size_t>(t);
      for (int c = 0; c < 3; ++c)
      {
        expected.insert({ corners[c],
          Corners{ corners[c], corners[nextCorner(c)], corners[previousCorner(c)] } });
      }
    }
    const TriangleTopology topology(mesh.view());
    const OriginalSurface surface(topology);
    std::multiset<std::pair<Index, Corners>> found;
    for (Index node = 0; node < mesh.nodeCount(); ++node)
    {
      Index before = kNone;
      for (const Index entry : surface.ring(node))
      {
        const Index other = OriginalSurface::nodeOf(entry);
        if (!OriginalSurface::isFanStart(entry))
        {
          found.insert({ node, Corners{ node, before, other } });
        }
        before = other;
      }
    }
    EXPECT_EQ(found, expected);
  }
}

} // namespace
} // namespace undecimate
