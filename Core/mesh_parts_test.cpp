// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_parts.h"

#include "testing/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Mesh;

std::vector<std::vector<Index>> listsOf(MeshParts& parts)
{
  std::vector<std::vector<Index>> lists;
  for (Index part = 0; part < parts.count(); ++part)
  {
    lists.emplace_back(parts.begin(part), parts.end(part));
  }
  return lists;
}

std::vector<Index> sorted(const std::vector<std::vector<Index>>& lists)
{
  std::vector<Index> all;
  for (const auto& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Index> upTo(Index count)
{
  std::vector<Index> all(count);
  for (Index i = 0; i < count; ++i)
  {
    all[i] = i;
  }
  return all;
}

TEST(MeshParts, EachNodeIsInOnePart)
{
  const Mesh mesh = testing::hills(150, 130);
  const TriangleTopology topology(mesh.view());
  Threads threads(2);
  MeshParts parts(topology, threads);
  for (int round = 0; round < 5; ++round)
  {
    parts.cut(round, 1000);
    EXPECT_GT(parts.count(), 10);
    EXPECT_LE(parts.count(), mesh.nodeCount() / 1000);
    const auto lists = listsOf(parts);
    EXPECT_EQ(sorted(lists), upTo(mesh.nodeCount()));
    for (Index part = 0; part < parts.count(); ++part)
    {
      EXPECT_GT(lists[part].size(), 300U);
      EXPECT_LT(lists[part].size(), 3000U);
      for (const Index node : lists[part])
      {
        ASSERT_TRUE(parts.has(part, node));
        ASSERT_FALSE(parts.has(part == 0 ? 1 : part - 1, node));
      }
    }
  }
}

TEST(MeshParts, TheNumberOfThreadsDoesNotMatter)
{
  const Mesh mesh = testing::torus(200, 100);
  const TriangleTopology topology(mesh.view());
  Threads one(1);
  Threads five(5);
  MeshParts a(topology, one);
  MeshParts b(topology, five);
  for (int round = 0; round < 4; ++round)
  {
    a.cut(round, 700);
    b.cut(round, 700);
    EXPECT_EQ(listsOf(a), listsOf(b));
  }
}

TEST(MeshParts, NoEdgeStaysAcrossASeam)
{
  const Mesh mesh = testing::hills(100, 100);
  const TriangleTopology topology(mesh.view());
  Threads threads(1);
  MeshParts parts(topology, threads);
  std::vector<int> seams(mesh.nodeCount(), 0);
  constexpr int kRounds = 16;
  std::int64_t all = 0;
  for (int round = 0; round < kRounds; ++round)
  {
    parts.cut(round, 1000);
    for (Index part = 0; part < parts.count(); ++part)
    {
      for (const Index* node = parts.begin(part); node != parts.end(part); ++node)
      {
        const bool free =
          topology.allAround(*node, [&](Index other) { return parts.has(part, other); });
        seams[*node] += free ? 0 : 1;
        all += free ? 0 : 1;
      }
    }
  }
  EXPECT_GT(all, 0);
  EXPECT_LT(static_cast<double>(all), 0.25 * kRounds * mesh.nodeCount());
  EXPECT_LT(*std::max_element(seams.begin(), seams.end()), kRounds * 3 / 4);
}

TEST(MeshParts, NodesThatWentAreForgotten)
{
  const Mesh mesh = testing::hills(60, 60);
  const TriangleTopology topology(mesh.view());
  Threads threads(2);
  MeshParts parts(topology, threads);
  std::vector<Index> left;
  parts.cut(0, 500);
  for (Index part = 0; part < parts.count(); ++part)
  {
    const Index* const end =
      std::remove_if(parts.begin(part), parts.end(part), [](Index node) { return node % 3 == 0; });
    parts.shorten(part, end);
  }
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    if (node % 3 != 0)
    {
      left.push_back(node);
    }
  }
  parts.cut(1, 500);
  EXPECT_EQ(sorted(listsOf(parts)), left);
  parts.join();
  EXPECT_EQ(parts.count(), 1);
  EXPECT_EQ(listsOf(parts).front(), left); // in their order
  EXPECT_TRUE(parts.has(0, 1));
}

TEST(MeshParts, AnyPlacesWillDo)
{
  Threads threads(2);
  for (const double size : { 0.0, 1e-300, 1.0, 1e300, 1e308, HUGE_VAL, std::nan("") })
  {
    Mesh mesh = testing::hills(40, 40);
    for (double& x : mesh.points)
    {
      x = (x - 20.0) * size;
    }
    const TriangleTopology topology(mesh.view());
    MeshParts parts(topology, threads);
    parts.cut(3, 100);
    EXPECT_EQ(sorted(listsOf(parts)), upTo(mesh.nodeCount())) << size;
  }
}

} // namespace
} // namespace undecimate
