// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Two-sided Hausdorff distance, step by step, between a series and the same nodes with other cells
// (or other points), by CGAL's AABB trees: for tri_quad.py.
//
//   tri_quad_distance SERIES STEPS CELLS [--points FILE] [--tolerance 0.0001]
//
// SERIES and CELLS: see tri_quad_cli.cpp; STEPS: 0,15,30 or "all". --points: float32 points of the
// cells for each of the steps, step after step (for rivals that move nodes). Cells are cut into
// triangles around their center. Each distance is at most the tolerance (a fraction of the
// diagonal) too small. Prints "step forth back diagonal" for each step; forth: from the series to
// the cells.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <queue>
#include <sstream>
#include <string>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

namespace
{

[[noreturn]] void fail(const std::string& message)
{
  std::cerr << message << "\n";
  std::exit(1);
}

template <typename Value>
void read(std::ifstream& file, std::vector<Value>& values, const char* what)
{
  if (!file.read(reinterpret_cast<char*>(values.data()),
        static_cast<std::streamsize>(values.size() * sizeof(Value))))
  {
    fail(std::string(what) + " is too short.");
  }
}

Triangles triangulate(const std::vector<float>& points, const std::vector<std::int32_t>& cells)
{
  const auto at = [&points](std::int32_t node)
  { return Point(points[3 * node], points[3 * node + 1], points[3 * node + 2]); };
  Triangles triangles;
  for (std::size_t c = 0; c < cells.size(); c += 4)
  {
    const int count = cells[c + 3] < 0 ? 3 : 4;
    Point corner[4];
    double sum[3] = { 0.0, 0.0, 0.0 };
    for (int k = 0; k < count; ++k)
    {
      corner[k] = at(cells[c + k]);
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += corner[k][axis] / count;
      }
    }
    const Point center(sum[0], sum[1], sum[2]);
    for (int k = 0; k < count; ++k)
    {
      const Triangle t(corner[k], corner[(k + 1) % count], center);
      if (t.squared_area() > 0.0)
      {
        triangles.push_back(t);
      }
    }
  }
  return triangles;
}

/// A piece of a surface, with what is known of its distances to the other one.
struct Piece
{
  Point corners[3];
  double most; // no point of it is farther
};

Piece measured(const Point& a, const Point& b, const Point& c, const Tree& to, double& square)
{
  const Point middle = CGAL::centroid(a, b, c);
  const auto [nearest, triangle] = to.closest_point_and_primitive(middle);
  const double distance = (nearest - middle).squared_length();
  square = std::max(square, distance);
  // The distance to one triangle is convex, so none is larger than the largest at the corners.
  double radius = 0.0;
  double most = 0.0;
  for (const Point& corner : { a, b, c })
  {
    radius = std::max(radius, (corner - middle).squared_length());
    most = std::max(most, CGAL::squared_distance(corner, *triangle));
  }
  return { { a, b, c }, std::min(std::sqrt(distance) + std::sqrt(radius), std::sqrt(most)) };
}

// The largest distance of a surface's points to the other one, at most `tolerance` too small: a
// piece is cut into four as long as a point of it could be farther than the farthest one so far.
double farthest(const Triangles& from, const Tree& to, double tolerance)
{
  double square = 0.0;
  const auto isNearer = [](const Piece& a, const Piece& b) { return a.most < b.most; };
  std::priority_queue<Piece, std::vector<Piece>, decltype(isNearer)> pieces(isNearer);
  for (const Triangle& t : from)
  {
    for (int k = 0; k < 3; ++k)
    {
      square = std::max(square, to.squared_distance(t[k]));
    }
    pieces.push(measured(t[0], t[1], t[2], to, square));
  }
  while (!pieces.empty() && pieces.top().most > std::sqrt(square) + tolerance)
  {
    const Piece piece = pieces.top();
    pieces.pop();
    const auto& [a, b, c] = piece.corners;
    const Point ab = CGAL::midpoint(a, b);
    const Point bc = CGAL::midpoint(b, c);
    const Point ca = CGAL::midpoint(c, a);
    pieces.push(measured(a, ab, ca, to, square));
    pieces.push(measured(ab, b, bc, to, square));
    pieces.push(measured(ca, bc, c, to, square));
    pieces.push(measured(ab, bc, ca, to, square));
  }
  return std::sqrt(square);
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 4)
  {
    fail("usage: see the head of the source");
  }
  std::string moved;
  double tolerance = 1e-4;
  for (int i = 4; i + 1 < argc; i += 2)
  {
    if (std::string(argv[i]) == "--points")
      moved = argv[i + 1];
    else if (std::string(argv[i]) == "--tolerance")
      tolerance = std::atof(argv[i + 1]);
    else
      fail(std::string("unknown option ") + argv[i]);
  }
  std::ifstream series(argv[1], std::ios::binary);
  std::vector<std::int64_t> header(4);
  read(series, header, "The series");
  std::vector<std::int32_t> cells(4 * header[1]);
  std::vector<float> points(3 * header[0]);
  const auto stepBytes = static_cast<std::streamoff>(points.size() * sizeof(float));
  const auto first = static_cast<std::streamoff>(header.size() * sizeof(header[0]));
  series.seekg(first + header[2] * stepBytes);
  read(series, cells, "The series");
  std::ifstream levelFile(argv[3], std::ios::binary | std::ios::ate);
  if (!levelFile)
  {
    fail(std::string("cannot read ") + argv[3]);
  }
  std::vector<std::int32_t> level(static_cast<std::size_t>(levelFile.tellg()) / 4);
  levelFile.seekg(0);
  read(levelFile, level, "The file of cells");

  std::vector<int> steps;
  if (std::string(argv[2]) == "all")
  {
    for (int i = 0; i < header[2]; ++i)
    {
      steps.push_back(i);
    }
  }
  else
  {
    std::stringstream stream(argv[2]);
    for (std::string item; std::getline(stream, item, ',');)
    {
      steps.push_back(std::atoi(item.c_str()));
    }
  }
  std::ifstream movedFile;
  std::vector<float> movedPoints;
  if (!moved.empty())
  {
    movedFile.open(moved, std::ios::binary | std::ios::ate);
    movedPoints.resize(static_cast<std::size_t>(movedFile.tellg()) / 4 / steps.size());
    movedFile.seekg(0);
  }
  for (const int step : steps)
  {
    series.seekg(first + step * stepBytes);
    read(series, points, "The series");
    double low[3] = { HUGE_VAL, HUGE_VAL, HUGE_VAL };
    double high[3] = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      low[i % 3] = std::min<double>(low[i % 3], points[i]);
      high[i % 3] = std::max<double>(high[i % 3], points[i]);
    }
    const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    if (!moved.empty())
    {
      read(movedFile, movedPoints, "The file of points");
    }
    Triangles original = triangulate(points, cells);
    Triangles coarse = triangulate(moved.empty() ? points : movedPoints, level);
    Tree originalTree(original.begin(), original.end());
    Tree coarseTree(coarse.begin(), coarse.end());
    originalTree.accelerate_distance_queries();
    coarseTree.accelerate_distance_queries();
    std::printf("%d %.9g %.9g %.9g\n", step, farthest(original, coarseTree, tolerance * diagonal),
      farthest(coarse, originalTree, tolerance * diagonal), diagonal);
    std::fflush(stdout);
  }
  return 0;
}
