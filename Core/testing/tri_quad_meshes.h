// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file tri_quad_meshes.h
/// @brief Meshes of triangles and quads that move, for tests, and what must hold for all of them.

#ifndef UNDECIMATE_CORE_TESTING_TRI_QUAD_MESHES_H
#define UNDECIMATE_CORE_TESTING_TRI_QUAD_MESHES_H

#include "meshes.h"
#include "time_rows.h"
#include "tri_quad_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace undecimate
{
namespace testing
{

using Cells = std::vector<std::array<Index, 4>>;

/// Nodes of a cell in order, without the empty corner.
inline std::vector<Index> cornersOf(const std::array<Index, 4>& cell)
{
  std::vector<Index> corners;
  std::copy_if(
    cell.begin(), cell.end(), std::back_inserter(corners), [](Index n) { return n != kNone; });
  return corners;
}

/// A mesh that owns its arrays: positions[step][3 * node + axis].
struct MixedMesh
{
  std::vector<std::vector<double>> positions{ 1 };
  Cells cells;
  std::vector<Index> parts;

  Index nodeCount() const { return static_cast<Index>(this->positions[0].size() / 3); }
  Index addNode(double x, double y, double z)
  {
    this->positions[0].insert(this->positions[0].end(), { x, y, z });
    return this->nodeCount() - 1;
  }
  /// More steps: the first one moved by a function of the step (1, 2, ...) and the place.
  void addSteps(
    int count, const std::function<std::array<double, 3>(int, std::array<double, 3>)>& place)
  {
    for (int step = 1; step <= count; ++step)
    {
      std::vector<double> moved;
      for (Index node = 0; node < this->nodeCount(); ++node)
      {
        const double* p = this->positions[0].data() + 3 * node;
        const auto q = place(step, { p[0], p[1], p[2] });
        moved.insert(moved.end(), q.begin(), q.end());
      }
      this->positions.push_back(moved);
    }
  }
  TriQuadMeshView view() const
  {
    TriQuadMeshView view;
    view.nodeCount = this->nodeCount();
    view.cells = this->cells.empty() ? nullptr : this->cells[0].data();
    view.cellCount = static_cast<std::int64_t>(this->cells.size());
    view.parts = this->parts.empty() ? nullptr : this->parts.data();
    return view;
  }
  PositionFrame frame() const
  {
    return positionFrame<double>(this->positions[0].data(), nullptr, this->nodeCount());
  }
  TimeRows rows() const
  {
    TimeRows rows(this->nodeCount(), 3, static_cast<int>(this->positions.size()));
    const PositionFrame frame = this->frame();
    for (std::size_t step = 0; step < this->positions.size(); ++step)
    {
      rows.set<double>(static_cast<int>(step), this->positions[step].data(), nullptr,
        frame.origin.data(), frame.scale);
    }
    return rows;
  }
};

/// A grid of nx by ny quads, closed in one, both or no direction; some quads are cut into
/// triangles.
/// @param triangles fraction of the quads that are cut
inline MixedMesh mixedGrid(
  int nx, int ny, bool roundX, bool roundY, double triangles, std::mt19937& random)
{
  MixedMesh mesh;
  const int columns = roundX ? nx : nx + 1;
  const int rows = roundY ? ny : ny + 1;
  const double turn = 2.0 * std::acos(-1.0);
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const double a = turn * i / nx;
      const double b = turn * j / ny;
      if (roundX && roundY)
      {
        const double r = 3.0 + std::cos(b);
        mesh.addNode(r * std::cos(a), r * std::sin(a), std::sin(b));
      }
      else if (roundX)
      {
        mesh.addNode(std::cos(a), std::sin(a), 6.0 * j / ny);
      }
      else
      {
        mesh.addNode(i, j, 0.3 * std::sin(0.7 * i) * std::cos(0.5 * j));
      }
    }
  }
  std::bernoulli_distribution cut(triangles);
  for (int j = 0; j < ny; ++j)
  {
    for (int i = 0; i < nx; ++i)
    {
      const auto at = [&](int x, int y)
      { return static_cast<Index>((y % rows) * columns + x % columns); };
      const Index q[4] = { at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1) };
      if (!cut(random))
      {
        const int r = static_cast<int>(random() % 4);
        mesh.cells.push_back({ q[r], q[(r + 1) % 4], q[(r + 2) % 4], q[(r + 3) % 4] });
      }
      else if (random() % 2 == 0)
      {
        mesh.cells.push_back({ q[0], q[1], q[2], kNone });
        mesh.cells.push_back({ q[2], q[3], q[0], kNone });
      }
      else
      {
        mesh.cells.push_back({ q[1], q[2], q[3], kNone });
        mesh.cells.push_back({ q[3], q[0], q[1], kNone });
      }
    }
  }
  return mesh;
}

/// The surface of a box of n quads each way.
inline MixedMesh mixedBox(int n, double triangles, std::mt19937& random)
{
  MixedMesh mesh;
  std::map<std::array<int, 3>, Index> nodes;
  std::bernoulli_distribution cut(triangles);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int side : { 0, n })
    {
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          std::array<Index, 4> q;
          const int at[4][2] = { { i, j }, { i + 1, j }, { i + 1, j + 1 }, { i, j + 1 } };
          for (int k = 0; k < 4; ++k)
          {
            std::array<int, 3> p;
            p[axis] = side;
            p[(axis + 1) % 3] = at[k][0];
            p[(axis + 2) % 3] = at[k][1];
            const auto found = nodes.find(p);
            q[k] = found != nodes.end() ? found->second : mesh.addNode(p[0], p[1], p[2]);
            nodes[p] = q[k];
          }
          if (side == 0)
          {
            std::swap(q[1], q[3]);
          }
          if (cut(random))
          {
            mesh.cells.push_back({ q[0], q[1], q[2], kNone });
            mesh.cells.push_back({ q[2], q[3], q[0], kNone });
          }
          else
          {
            mesh.cells.push_back(q);
          }
        }
      }
    }
  }
  return mesh;
}

/// A floor of n by n quads with a wall of n by n quads on its middle line.
inline MixedMesh mixedTJoint(int n)
{
  MixedMesh mesh;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      mesh.addNode(i, j, 0.0);
    }
  }
  const int middle = n / 2;
  const auto floor = [n](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
  std::vector<std::vector<Index>> wall(1);
  for (int i = 0; i <= n; ++i)
  {
    wall[0].push_back(floor(i, n / 2));
  }
  for (int k = 1; k <= n; ++k)
  {
    wall.emplace_back();
    for (int i = 0; i <= n; ++i)
    {
      wall[k].push_back(mesh.addNode(i, middle, k));
    }
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      mesh.cells.push_back({ floor(i, j), floor(i + 1, j), floor(i + 1, j + 1), floor(i, j + 1) });
      mesh.cells.push_back({ wall[j][i], wall[j][i + 1], wall[j + 1][i + 1], wall[j + 1][i] });
    }
  }
  return mesh;
}

/// Cells at each edge, (smaller, larger) node.
inline std::map<std::pair<Index, Index>, std::vector<Index>> edgesOf(const Cells& cells)
{
  std::map<std::pair<Index, Index>, std::vector<Index>> edges;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto corners = cornersOf(cells[c]);
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % corners.size()];
      edges[{ std::min(a, b), std::max(a, b) }].push_back(static_cast<Index>(c));
    }
  }
  return edges;
}

/// Each cell has three nodes or more (M3), none of them twice, and no other cell the same ones.
inline AssertionResult hasSoundCells(const Cells& cells)
{
  std::set<std::set<Index>> seen;
  for (const auto& cell : cells)
  {
    const auto corners = cornersOf(cell);
    const std::set<Index> nodes(corners.begin(), corners.end());
    if (corners.size() < 3)
    {
      return AssertionFailure() << "M3: a cell of " << corners.size() << " corners";
    }
    if (nodes.size() != corners.size())
    {
      return AssertionFailure() << "a cell has a node twice";
    }
    if (!seen.insert(nodes).second)
    {
      return AssertionFailure() << "two cells have the same nodes";
    }
  }
  return AssertionSuccess();
}

/// M1 to M3 of [W06]: by brute force, from the cells alone.
inline AssertionResult isValidMesh(const Cells& cells)
{
  if (AssertionResult sound = hasSoundCells(cells); !sound)
  {
    return sound;
  }
  const auto edges = edgesOf(cells);
  std::map<Index, std::map<Index, std::vector<Index>>> around; // node: neighbour: cells
  std::map<Index, std::set<Index>> cellsOf;
  for (const auto& [edge, at] : edges)
  {
    if (at.size() > 2)
    {
      return AssertionFailure() << "M1: edge " << edge.first << "-" << edge.second << " has "
                                << at.size() << " cells";
    }
    around[edge.first][edge.second] = at;
    around[edge.second][edge.first] = at;
    for (const Index cell : at)
    {
      cellsOf[edge.first].insert(cell);
      cellsOf[edge.second].insert(cell);
    }
  }
  for (const auto& [node, neighbours] : around)
  {
    bool boundary = false;
    std::set<Index> reached{ *cellsOf[node].begin() };
    for (std::size_t before = 0; before != reached.size();)
    {
      before = reached.size();
      for (const auto& [other, at] : neighbours)
      {
        boundary = boundary || at.size() == 1;
        if (at.size() == 2 && (reached.count(at[0]) || reached.count(at[1])))
        {
          reached.insert(at.begin(), at.end());
        }
      }
    }
    if (reached.size() != cellsOf[node].size())
    {
      return AssertionFailure() << "M1: the cells of node " << node << " form several fans";
    }
    if (!boundary && neighbours.size() < 3)
    {
      return AssertionFailure() << "M2: inner node " << node << " has " << neighbours.size()
                                << " neighbours";
    }
  }
  return AssertionSuccess();
}

/// Nodes - edges + cells.
inline int eulerCharacteristic(const Cells& cells)
{
  std::set<Index> nodes;
  for (const auto& cell : cells)
  {
    for (const Index node : cornersOf(cell))
    {
      nodes.insert(node);
    }
  }
  return static_cast<int>(nodes.size()) - static_cast<int>(edgesOf(cells).size()) +
    static_cast<int>(cells.size());
}

} // namespace testing
} // namespace undecimate

#endif
