// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Two-sided Hausdorff distance, step by step, between a series and the same nodes with other cells
// (or other points), by CGAL's AABB trees: for tri_quad.py.
//
//   tri_quad_distance SERIES STEPS CELLS [--points FILE] [--tolerance 0.0001]
//                     [--relative 0.01]
//
// SERIES and CELLS: see tri_quad_cli.cpp; STEPS: 0,15,30 or "all". --points: float32 points of the
// cells for each of the steps, step after step (for rivals that move nodes). Cells are cut into
// triangles around their center. Each distance is too small by at most the tolerance (a fraction of
// the diagonal) or that fraction of the distance itself, whichever is larger. Prints "step forth
// back diagonal" for each step; forth: from the series to the cells.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
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

/// A surface: triangles of numbered points.
struct Surface
{
  std::vector<Point> points;
  std::vector<std::array<int, 3>> corners;
  Triangles triangles;
};

Surface triangulate(const std::vector<float>& points, const std::vector<std::int32_t>& cells)
{
  Surface surface;
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    surface.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  }
  const auto add = [&surface](int a, int b, int c)
  {
    const Triangle t(surface.points[a], surface.points[b], surface.points[c]);
    if (t.squared_area() > 0.0)
    {
      surface.corners.push_back({ a, b, c });
      surface.triangles.push_back(t);
    }
  };
  for (std::size_t c = 0; c < cells.size(); c += 4)
  {
    const std::int32_t* nodes = cells.data() + c;
    if (nodes[3] < 0)
    {
      add(nodes[0], nodes[1], nodes[2]);
      continue;
    }
    double sum[3] = { 0.0, 0.0, 0.0 };
    for (int k = 0; k < 4; ++k)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += 0.25 * surface.points[nodes[k]][axis];
      }
    }
    const int center = static_cast<int>(surface.points.size());
    surface.points.emplace_back(sum[0], sum[1], sum[2]);
    for (int k = 0; k < 4; ++k)
    {
      add(nodes[k], nodes[(k + 1) % 4], center);
    }
  }
  return surface;
}

/// A point of one surface, and where the other one is nearest to it.
struct Place
{
  Point point;
  Tree::Point_and_primitive_id nearest;
  double distance;
};

Place measured(const Point& point, const Tree& to, const Tree::Point_and_primitive_id& hint)
{
  const auto nearest = to.closest_point_and_primitive(point, hint);
  return { point, nearest, std::sqrt((nearest.first - point).squared_length()) };
}

/// A piece of a surface, with what is known of its distance to the other one.
struct Piece
{
  std::array<Place, 3> corners;
  double most; // no point of it is farther
};

Piece bounded(const Place& a, const Place& b, const Place& c)
{
  Piece piece{ { a, b, c }, HUGE_VAL };
  for (const Place& place : piece.corners)
  {
    // The distance to one triangle is convex, so none is larger than the largest at the corners;
    // and a point is not farther than a corner and the way to it.
    double square = 0.0;
    double reach = 0.0;
    for (const Place& corner : piece.corners)
    {
      square = std::max(square, CGAL::squared_distance(corner.point, *place.nearest.second));
      reach = std::max(reach, (corner.point - place.point).squared_length());
    }
    piece.most = std::min({ piece.most, std::sqrt(square), place.distance + std::sqrt(reach) });
  }
  return piece;
}

// The largest distance of a surface's points to the other one, too small by at most `tolerance` or
// the fraction `relative` of it: a piece is cut into four as long as a point of it could be that
// much farther than the farthest one so far.
double farthest(const Surface& from, const Tree& to, double tolerance, double relative)
{
  double most = 0.0;
  const auto enough = [&] { return most + std::max(tolerance, relative * most); };
  const auto isNearer = [](const Piece& a, const Piece& b) { return a.most < b.most; };
  std::priority_queue<Piece, std::vector<Piece>, decltype(isNearer)> pieces(isNearer);
  std::vector<Place> places(from.points.size());
  std::vector<bool> known(from.points.size(), false);
  auto hint = to.any_reference_point_and_id();
  for (const auto& corners : from.corners)
  {
    for (const int point : corners)
    {
      if (!known[point])
      {
        known[point] = true;
        places[point] = measured(from.points[point], to, { hint.first, hint.second });
        most = std::max(most, places[point].distance);
      }
      hint = { places[point].nearest.first, places[point].nearest.second };
    }
  }
  const auto keep = [&](const Place& a, const Place& b, const Place& c)
  {
    Piece piece = bounded(a, b, c);
    if (piece.most > enough())
    {
      pieces.push(std::move(piece));
    }
  };
  for (const auto& [a, b, c] : from.corners)
  {
    keep(places[a], places[b], places[c]);
  }
  while (!pieces.empty() && pieces.top().most > enough())
  {
    const auto [a, b, c] = pieces.top().corners;
    pieces.pop();
    const auto between = [&](const Place& p, const Place& q)
    {
      const Place place = measured(CGAL::midpoint(p.point, q.point), to, p.nearest);
      most = std::max(most, place.distance);
      return place;
    };
    const Place ab = between(a, b);
    const Place bc = between(b, c);
    const Place ca = between(c, a);
    keep(a, ab, ca);
    keep(ab, b, bc);
    keep(ca, bc, c);
    keep(ab, bc, ca);
  }
  return most;
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
  double relative = 0.01;
  for (int i = 4; i + 1 < argc; i += 2)
  {
    if (std::string(argv[i]) == "--points")
      moved = argv[i + 1];
    else if (std::string(argv[i]) == "--tolerance")
      tolerance = std::atof(argv[i + 1]);
    else if (std::string(argv[i]) == "--relative")
      relative = std::atof(argv[i + 1]);
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
    Surface original = triangulate(points, cells);
    Surface coarse = triangulate(moved.empty() ? points : movedPoints, level);
    const Tree originalTree(original.triangles.begin(), original.triangles.end());
    const Tree coarseTree(coarse.triangles.begin(), coarse.triangles.end());
    std::printf("%d %.9g %.9g %.9g\n", step,
      farthest(original, coarseTree, tolerance * diagonal, relative),
      farthest(coarse, originalTree, tolerance * diagonal, relative), diagonal);
    std::fflush(stdout);
  }
  return 0;
}
