// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file meshes.h
/// @brief Small meshes for tests, and checks of what must hold for every level of every mesh.

#ifndef UNDECIMATE_CORE_TESTING_MESHES_H
#define UNDECIMATE_CORE_TESTING_MESHES_H

#include "types.h"
#include "undecimation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace undecimate
{
namespace testing
{

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

/// The corners of cells in an array, for RecordBuilder::finish().
inline RecordBuilder::CornersOf cornersOf(const Index* cells)
{
  return [cells](Index cell, Index* corners)
  { std::copy_n(cells + std::size_t{ 3 } * static_cast<std::size_t>(cell), 3, corners); };
}

/// A mesh that owns its arrays.
struct Mesh
{
  std::vector<double> points;
  std::vector<Index> triangles;

  Index nodeCount() const { return static_cast<Index>(this->points.size() / 3); }
  Index triangleCount() const { return static_cast<Index>(this->triangles.size() / 3); }

  Index addNode(double x, double y, double z)
  {
    for (const double coordinate : { x, y, z })
    {
      this->points.push_back(coordinate);
    }
    return this->nodeCount() - 1;
  }
  void addTriangle(Index a, Index b, Index c)
  {
    for (const Index node : { a, b, c })
    {
      this->triangles.push_back(node);
    }
  }
  std::array<double, 3> point(Index node) const
  {
    const std::size_t i = std::size_t{ 3 } * static_cast<std::size_t>(node);
    return { this->points[i], this->points[i + 1], this->points[i + 2] };
  }
  /// Put another mesh beside this one.
  void append(const Mesh& other)
  {
    const Index first = this->nodeCount();
    this->points.insert(this->points.end(), other.points.begin(), other.points.end());
    for (const Index node : other.triangles)
    {
      this->triangles.push_back(first + node);
    }
  }
  TriangleMeshView view() const
  {
    TriangleMeshView v;
    v.pointsDouble = this->points.data();
    v.nodeCount = this->nodeCount();
    v.triangles = this->triangles.data();
    v.triangleCount = this->triangleCount();
    return v;
  }
};

// ---------------------------------------------------------------------------------------------
// Generators
// ---------------------------------------------------------------------------------------------

/// Height field over [0, nx - 1] x [0, ny - 1], one unit between nodes, node number y * nx + x.
template <typename Height>
Mesh heightField(int nx, int ny, Height&& height)
{
  Mesh mesh;
  for (int y = 0; y < ny; ++y)
  {
    for (int x = 0; x < nx; ++x)
    {
      mesh.addNode(x, y, height(x, y));
    }
  }
  for (int y = 0; y + 1 < ny; ++y)
  {
    for (int x = 0; x + 1 < nx; ++x)
    {
      const Index i = y * nx + x;
      mesh.addTriangle(i, i + 1, i + nx + 1);
      mesh.addTriangle(i, i + nx + 1, i + nx);
    }
  }
  return mesh;
}

inline Mesh flatGrid(int nx, int ny)
{
  return heightField(nx, ny, [](int, int) { return 0.0; });
}

/// Gentle hills: slopes of at most 0.3.
inline Mesh hills(int nx, int ny)
{
  return heightField(nx, ny,
    [](int x, int y) { return 0.7 * std::sin(0.3 * x) + 0.4 * std::cos(0.25 * y + 0.1 * x); });
}

inline Mesh torus(int around, int across, double radius = 3.0, double thickness = 1.0)
{
  const double turn = 8.0 * std::atan(1.0);
  Mesh mesh;
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j < across; ++j)
    {
      const double u = turn * i / around;
      const double v = turn * j / across;
      const double r = radius + thickness * std::cos(v);
      mesh.addNode(r * std::cos(u), r * std::sin(u), thickness * std::sin(v));
    }
  }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j < across; ++j)
    {
      mesh.addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

/// Of the bounding box.
inline double diagonalOf(const Mesh& mesh)
{
  double square = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (Index i = 0; i < mesh.nodeCount(); ++i)
    {
      low = std::min(low, mesh.point(i)[c]);
      high = std::max(high, mesh.point(i)[c]);
    }
    square += (high - low) * (high - low);
  }
  return std::sqrt(square);
}

/// A torus on multiples of 1/64: moving and scaling it by powers of two is exact.
inline Mesh roundedTorus()
{
  Mesh mesh = torus(20, 14);
  for (double& x : mesh.points)
  {
    x = std::round(64.0 * x) / 64.0;
  }
  return mesh;
}

inline Mesh moved(Mesh mesh, double by)
{
  for (double& x : mesh.points)
  {
    x += by;
  }
  return mesh;
}

inline Mesh scaled(Mesh mesh, double factor)
{
  for (double& x : mesh.points)
  {
    x *= factor;
  }
  return mesh;
}

/// With about one of so many triangles missing: many boundary loops, which may touch.
inline Mesh sieve(const Mesh& mesh, std::mt19937& random, unsigned int oneOf)
{
  Mesh holed = mesh;
  holed.triangles.clear();
  for (Index t = 0; t < mesh.triangleCount(); ++t)
  {
    if (random() % oneOf != 0)
    {
      holed.addTriangle(
        mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]);
    }
  }
  return holed;
}

/// A pyramid without its base: the base is 2 wide, node 4 is 1 above its middle.
inline Mesh pyramid()
{
  Mesh mesh;
  mesh.addNode(0.0, 0.0, 0.0);
  mesh.addNode(2.0, 0.0, 0.0);
  mesh.addNode(2.0, 2.0, 0.0);
  mesh.addNode(0.0, 2.0, 0.0);
  mesh.addNode(1.0, 1.0, 1.0);
  for (int i = 0; i < 4; ++i)
  {
    mesh.addTriangle(4, i, (i + 1) % 4);
  }
  return mesh;
}

inline Mesh tetrahedron(double size = 1.0)
{
  Mesh mesh;
  mesh.addNode(0.0, 0.0, 0.0);
  mesh.addNode(size, 0.0, 0.0);
  mesh.addNode(0.0, size, 0.0);
  mesh.addNode(0.0, 0.0, size);
  mesh.addTriangle(0, 2, 1);
  mesh.addTriangle(0, 1, 3);
  mesh.addTriangle(1, 2, 3);
  mesh.addTriangle(2, 0, 3);
  return mesh;
}

/// A cube of n x n x n, each face n x n squares of two triangles, nodes shared between faces; the
/// eight corners have integer coordinates 0 or n.
inline Mesh cube(int n)
{
  Mesh mesh;
  std::map<std::array<int, 3>, Index> numbers;
  const auto at = [&](int x, int y, int z)
  {
    const auto found = numbers.try_emplace({ x, y, z }, mesh.nodeCount());
    if (found.second)
    {
      mesh.addNode(x, y, z);
    }
    return found.first->second;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int side : { 0, n })
    {
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          const auto node = [&](int a, int b)
          {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = a;
            p[(axis + 2) % 3] = b;
            return at(p[0], p[1], p[2]);
          };
          const Index a = node(i, j);
          const Index b = node(i + 1, j);
          const Index c = node(i + 1, j + 1);
          const Index d = node(i, j + 1);
          if (side == n)
          {
            mesh.addTriangle(a, b, c);
            mesh.addTriangle(a, c, d);
          }
          else
          {
            mesh.addTriangle(a, c, b);
            mesh.addTriangle(a, d, c);
          }
        }
      }
    }
  }
  return mesh;
}

/// A strip of triangles along x: nodes 0, 2, 4 ... below and 1, 3, 5 ... above.
inline Mesh strip(int triangles)
{
  Mesh mesh;
  for (int i = 0; i < triangles + 2; ++i)
  {
    mesh.addNode(0.5 * i, i % 2, 0.0);
  }
  for (int i = 0; i < triangles; ++i)
  {
    mesh.addTriangle(i, i % 2 == 0 ? i + 2 : i + 1, i % 2 == 0 ? i + 1 : i + 2);
  }
  return mesh;
}

/// Node 0 in the middle of rings of `around` nodes each, a shallow bowl.
inline Mesh disc(int rings, int around)
{
  const double turn = 8.0 * std::atan(1.0);
  Mesh mesh;
  mesh.addNode(0.0, 0.0, 0.0);
  for (int ring = 1; ring <= rings; ++ring)
  {
    for (int i = 0; i < around; ++i)
    {
      const double angle = turn * i / around;
      mesh.addNode(ring * std::cos(angle), ring * std::sin(angle), 0.02 * ring * ring);
    }
  }
  const auto at = [&](int ring, int i)
  { return ring == 0 ? 0 : 1 + (ring - 1) * around + i % around; };
  for (int i = 0; i < around; ++i)
  {
    mesh.addTriangle(0, at(1, i), at(1, i + 1));
    for (int ring = 1; ring < rings; ++ring)
    {
      mesh.addTriangle(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      mesh.addTriangle(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
  }
  return mesh;
}

/// Make one node of two (the second one is not used any more).
inline void mergeNodes(Mesh& mesh, Index kept, Index gone)
{
  std::replace(mesh.triangles.begin(), mesh.triangles.end(), gone, kept);
}

/// Two cubes that touch in one node, the returned one.
inline Mesh bowTie(int n, Index& touching)
{
  Mesh mesh = cube(n);
  const auto find = [](const Mesh& m, double x, double y, double z)
  {
    for (Index i = 0; i < m.nodeCount(); ++i)
    {
      if (m.point(i) == std::array<double, 3>{ x, y, z })
      {
        return i;
      }
    }
    return kNone;
  };
  touching = find(mesh, n, n, n);
  Mesh other = cube(n);
  for (double& x : other.points)
  {
    x += n;
  }
  const Index second = mesh.nodeCount() + find(other, n, n, n);
  mesh.append(other);
  mergeNodes(mesh, touching, second);
  return mesh;
}

/// Three n x n sheets that meet in a line of n + 1 nodes (numbers 0 .. n).
inline Mesh tJoint(int n)
{
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
  {
    mesh.addNode(0.0, i, 0.0);
  }
  for (int sheet = 0; sheet < 3; ++sheet)
  {
    const double angle = 2.0 * sheet;
    const Index first = mesh.nodeCount();
    for (int column = 1; column <= n; ++column)
    {
      for (int i = 0; i <= n; ++i)
      {
        mesh.addNode(column * std::cos(angle), i, column * std::sin(angle));
      }
    }
    const auto at = [&](int column, int i)
    { return column == 0 ? i : first + (column - 1) * (n + 1) + i; };
    for (int column = 0; column < n; ++column)
    {
      for (int i = 0; i < n; ++i)
      {
        mesh.addTriangle(at(column, i), at(column + 1, i), at(column + 1, i + 1));
        mesh.addTriangle(at(column, i), at(column + 1, i + 1), at(column, i + 1));
      }
    }
  }
  return mesh;
}

/// A band of `around` x 4 squares with half a twist: no consistent orientation exists.
inline Mesh moebius(int around)
{
  const double turn = 8.0 * std::atan(1.0);
  constexpr int kWidth = 4;
  Mesh mesh;
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j <= kWidth; ++j)
    {
      const double angle = turn * i / around;
      const double across = 0.5 * (j - 0.5 * kWidth);
      const double r = 5.0 + across * std::cos(0.5 * angle);
      mesh.addNode(r * std::cos(angle), r * std::sin(angle), across * std::sin(0.5 * angle));
    }
  }
  for (int i = 0; i < around; ++i)
  {
    const auto at = [&](int column, int j)
    { return column < around ? column * (kWidth + 1) + j : kWidth - j; };
    for (int j = 0; j < kWidth; ++j)
    {
      mesh.addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

/// Renumber nodes and triangles, and turn the corners of each triangle, all at random.
inline Mesh shuffled(const Mesh& mesh, std::mt19937& random)
{
  std::vector<Index> nodes(mesh.nodeCount());
  std::vector<Index> cells(mesh.triangleCount());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    nodes[i] = static_cast<Index>(i);
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    cells[i] = static_cast<Index>(i);
  }
  std::shuffle(nodes.begin(), nodes.end(), random);
  std::shuffle(cells.begin(), cells.end(), random);
  Mesh result;
  result.points.resize(mesh.points.size());
  for (Index i = 0; i < mesh.nodeCount(); ++i)
  {
    std::copy_n(mesh.points.begin() + 3 * i, 3, result.points.begin() + 3 * nodes[i]);
  }
  for (const Index cell : cells)
  {
    const Index* t = mesh.triangles.data() + 3 * cell;
    const unsigned turn = static_cast<unsigned>(random()) % 3;
    result.addTriangle(nodes[t[turn]], nodes[t[(turn + 1) % 3]], nodes[t[(turn + 2) % 3]]);
  }
  return result;
}

/// Swap diagonals at random: as many tries as there are edges. A swap is made where the edge that
/// it makes does not exist and, if `plane`, where both new triangles look up and are no slivers.
inline void flipEdges(Mesh& mesh, std::mt19937& random, bool plane)
{
  using Edge = std::pair<Index, Index>;
  std::map<Edge, Index> triangleAt; // of a directed edge
  for (Index t = 0; t < mesh.triangleCount(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      triangleAt[{ mesh.triangles[3 * t + c], mesh.triangles[3 * t + (c + 1) % 3] }] = t;
    }
  }
  const auto area = [&](Index a, Index b, Index c)
  {
    const auto p = mesh.point(a);
    const auto q = mesh.point(b);
    const auto r = mesh.point(c);
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  };
  for (Index attempt = 0; attempt < 3 * mesh.triangleCount() / 2; ++attempt)
  {
    const Index t = static_cast<Index>(random() % static_cast<unsigned>(mesh.triangleCount()));
    const int c = static_cast<int>(random() % 3);
    //      b                 b
    //    / | \             /   \         Edge a-b goes, edge d-e comes.
    //   d t|u e    ->     d --- e
    //    \ | /             \   /
    //      a                 a
    const Index a = mesh.triangles[3 * t + c];
    const Index b = mesh.triangles[3 * t + (c + 1) % 3];
    const Index d = mesh.triangles[3 * t + (c + 2) % 3];
    const auto other = triangleAt.find({ b, a });
    if (other == triangleAt.end())
    {
      continue;
    }
    const Index u = other->second;
    Index e = kNone;
    for (int k = 0; k < 3; ++k)
    {
      const Index node = mesh.triangles[3 * u + k];
      e = node != a && node != b ? node : e;
    }
    if (e == d || triangleAt.count({ d, e }) || triangleAt.count({ e, d }) ||
      (plane && !(area(a, e, d) > 0.3 && area(e, b, d) > 0.3)))
    {
      continue;
    }
    triangleAt.erase({ a, b });
    triangleAt.erase({ b, a });
    const Index corners[6] = { a, e, d, e, b, d };
    std::copy_n(corners, 3, mesh.triangles.begin() + 3 * t);
    std::copy_n(corners + 3, 3, mesh.triangles.begin() + 3 * u);
    for (int k = 0; k < 3; ++k)
    {
      triangleAt[{ corners[k], corners[(k + 1) % 3] }] = t;
      triangleAt[{ corners[3 + k], corners[3 + (k + 1) % 3] }] = u;
    }
  }
}

// ---------------------------------------------------------------------------------------------
// Checks; `triangles` has three node numbers for each
// ---------------------------------------------------------------------------------------------

using Triangles = std::vector<Index>;

/// Each edge has at most two triangles, and two that go through it in opposite directions.
inline AssertionResult isManifoldAndOriented(const Triangles& triangles)
{
  std::set<std::pair<Index, Index>> edges;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles[i + c];
      const Index b = triangles[i + (c + 1) % 3];
      if (!edges.insert({ a, b }).second)
      {
        return AssertionFailure() << "edge " << a << "->" << b << " has two triangles on one side";
      }
    }
  }
  return AssertionSuccess();
}

/// No edge has more triangles than the largest number that any edge of the original has.
inline int largestEdgeUse(const Triangles& triangles)
{
  std::map<std::pair<Index, Index>, int> uses;
  int largest = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles[i + c];
      const Index b = triangles[i + (c + 1) % 3];
      largest = std::max(largest, ++uses[{ std::min(a, b), std::max(a, b) }]);
    }
  }
  return largest;
}

/// The triangles of each node form one fan, closed or open: no two surfaces touch in a node.
inline AssertionResult hasOneFanAtEachNode(const Triangles& triangles)
{
  // In a fan all edges opposite to the node form one chain: edges = nodes, or one less.
  std::map<Index, std::map<Index, Index>> links; // of a node: start -> end of the opposite edges
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      links[triangles[i + c]][triangles[i + (c + 1) % 3]] = triangles[i + (c + 2) % 3];
    }
  }
  for (const auto& [node, link] : links)
  {
    std::set<Index> ends;
    for (const auto& [from, to] : link)
    {
      ends.insert(to);
    }
    Index start = link.begin()->first;
    for (const auto& [from, to] : link)
    {
      start = ends.count(from) ? start : from;
    }
    std::size_t length = 0;
    auto next = link.find(start);
    do
    {
      ++length;
      next = link.find(next->second);
    } while (next != link.end() && next->first != start && length <= link.size());
    if (length != link.size())
    {
      return AssertionFailure() << "node " << node << " has more than one fan";
    }
  }
  return AssertionSuccess();
}

/// No triangle has a node twice, no three nodes have two triangles.
inline AssertionResult hasNoDegenerateOrRepeated(const Triangles& triangles)
{
  std::set<std::array<Index, 3>> seen;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    std::array<Index, 3> t{ triangles[i], triangles[i + 1], triangles[i + 2] };
    std::sort(t.begin(), t.end());
    if (t[0] == t[1] || t[1] == t[2])
    {
      return AssertionFailure() << "triangle " << i / 3 << " has node " << t[1] << " twice";
    }
    if (!seen.insert(t).second)
    {
      return AssertionFailure() << "triangle " << t[0] << " " << t[1] << " " << t[2]
                                << " exists twice";
    }
  }
  return AssertionSuccess();
}

/// Nodes - edges + triangles, of the nodes that a triangle has.
inline int eulerCharacteristic(const Triangles& triangles)
{
  std::set<std::pair<Index, Index>> edges;
  const std::set<Index> nodes(triangles.begin(), triangles.end());
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles[i + c];
      const Index b = triangles[i + (c + 1) % 3];
      edges.insert({ std::min(a, b), std::max(a, b) });
    }
  }
  return static_cast<int>(nodes.size()) - static_cast<int>(edges.size()) +
    static_cast<int>(triangles.size() / 3);
}

/// Edges with one triangle, as (smaller, larger) node.
inline std::set<std::pair<Index, Index>> boundaryEdges(const Triangles& triangles)
{
  std::map<std::pair<Index, Index>, int> uses;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles[i + c];
      const Index b = triangles[i + (c + 1) % 3];
      ++uses[{ std::min(a, b), std::max(a, b) }];
    }
  }
  std::set<std::pair<Index, Index>> edges;
  for (const auto& [edge, count] : uses)
  {
    if (count == 1)
    {
      edges.insert(edge);
    }
  }
  return edges;
}

/// Twice the area of a triangle as seen from above.
inline double areaFromAbove(const Mesh& mesh, const Index* t)
{
  const auto a = mesh.point(t[0]);
  const auto b = mesh.point(t[1]);
  const auto c = mesh.point(t[2]);
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// All triangles of a height field look up.
inline AssertionResult looksUp(const Mesh& mesh, const Triangles& triangles)
{
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    if (!(areaFromAbove(mesh, triangles.data() + i) > 0.0))
    {
      return AssertionFailure() << "triangle " << triangles[i] << " " << triangles[i + 1] << " "
                                << triangles[i + 2] << " is flipped";
    }
  }
  return AssertionSuccess();
}

/// The cells of the cursor's level in the original node numbers, in record order.
inline Triangles originalNumbers(const Undecimation& cursor)
{
  Triangles triangles(cursor.cells(), cursor.cells() + std::size_t{ 3 } * cursor.cellCount());
  for (Index& node : triangles)
  {
    node = cursor.record().nodeOrder[node];
  }
  return triangles;
}

/// At level 1 each slot has the cell of which it shows the values, corner by corner.
inline AssertionResult isOriginal(const Undecimation& cursor, const Mesh& mesh)
{
  if (cursor.nodeCount() != mesh.nodeCount() || cursor.cellCount() != mesh.triangleCount())
  {
    return AssertionFailure() << cursor.nodeCount() << " nodes and " << cursor.cellCount()
                              << " triangles";
  }
  const Triangles triangles = originalNumbers(cursor);
  for (Index slot = 0; slot < cursor.cellCount(); ++slot)
  {
    const Index cell = cursor.shownCells()[slot];
    for (int c = 0; c < 3; ++c)
    {
      if (triangles[3 * slot + c] != mesh.triangles[3 * cell + c])
      {
        return AssertionFailure() << "triangle " << cell << " differs at corner " << c;
      }
    }
  }
  return AssertionSuccess();
}

} // namespace testing
} // namespace undecimate

#endif
