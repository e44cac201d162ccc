// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file hausdorff_test.cpp
/// @brief The error that the record claims against the error that CGAL measures; and what has to
/// hold at every level: manifold, oriented, no degenerate or repeated triangle, Euler's number, the
/// same mesh from wherever it is reached, the input at level 1.
///
/// CGAL measures twice. The bounded-error distance is right to within the bound that it is given,
/// which has to be coarse where two surfaces lie in one plane (its cost grows with the inverse
/// square of the bound). The sampled distance can only be too small, but is sharp everywhere.

#include "hash_queue_decimation.h"
#include "test_meshes.h"
#include "undecimation.h"

// First: distance.h finds the kernel's midpoint() only if it has been declared before.
#include <CGAL/Simple_cartesian.h>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using undecimate::Index;
namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// What the record claims may be larger than what is measured by this factor (measured: 1.15), and
/// smaller by this one (measured: 1.09).
constexpr double kClaimTooLarge = 1.2;
constexpr double kClaimTooSmall = 1.1;
/// Distances below this fraction of the diagonal are rounding.
constexpr double kRounding = 1e-6;

constexpr int kSamples = 100000;

constexpr std::array<int, 4> kPercent = { 50, 25, 10, 5 };

/// A mesh and its bounds: what was measured when they were set, and a tenth more. Distances are
/// two-sided Hausdorff distances as fractions of the diagonal.
struct Case
{
  const char* name;
  bool isDevelopmentData;          ///< absent from a copy of the repository alone
  double errorBound;               ///< smallest one that CGAL is asked for
  std::array<double, 4> distances; ///< at 50, 25, 10 and 5 % of the triangles
};

// clang-format off
constexpr Case kCases[] = {
  { "plate_hole",   false, 2e-3, { 1e-6, 1e-6, 1e-6, 1e-6 } },
  { "flange",       false, 2e-3, { 1e-6, 1e-6, 9.1e-4, 2.5e-3 } },
  { "scan",         false, 5e-4, { 1.3e-3, 2.3e-3, 4.9e-3, 9.5e-3 } },
  { "blade_tip",    false, 5e-4, { 1.7e-4, 4.2e-4, 1.1e-3, 1.8e-3 } },
  { "grid",         false, 5e-4, { 5.5e-4, 1.3e-3, 2.6e-3, 4.5e-3 } },
  { "anchor_dense", true,  1e-3, { 1e-6, 5.1e-4, 1.4e-3, 4.1e-3 } },
  { "rocker_arm",   true,  1e-3, { 5.6e-4, 9.7e-4, 2e-3, 4e-3 } },
};
// clang-format on

void PrintTo(const Case& c, std::ostream* out)
{
  *out << c.name;
}

/// The mesh of a case; throws std::runtime_error.
TestMesh meshOf(const std::string& name)
{
  if (name == "grid")
  {
    return makeGrid(70);
  }
  if (name == "anchor_dense" || name == "rocker_arm")
  {
    return readMesh(name, developmentFile("triangles/" + name + ".vtp"));
  }
  return readMesh(name, dataFile(name + ".vtp"));
}

std::vector<Case> findCases()
{
  std::vector<Case> cases;
  for (const Case& c : kCases)
  {
    try
    {
      meshOf(c.name);
      cases.push_back(c);
    }
    catch (const std::runtime_error& error)
    {
      if (c.isDevelopmentData)
      {
        std::cout << "Development data is absent: " << error.what()
                  << " (UNDECIMATE_DATA, else ../shared/data beside the repository). The meshes "
                     "of Data/ and the grid are tested."
                  << std::endl;
      }
      else
      {
        cases.push_back(c); // it has to be there: its tests fail when they read it
      }
    }
  }
  return cases;
}

const std::vector<Case>& casesThatAreThere()
{
  static const std::vector<Case> cases = findCases(); // googletest asks more than once
  return cases;
}

/// A mesh decimated by Deviation, and a cursor on its record.
struct Decimated
{
  TestMesh mesh;
  undecimate::HashQueueDecimationResult result;
  undecimate::Undecimation cursor;
};

void decimate(Decimated& d, undecimate::HashQueueDecimationOptions options)
{
  options.targetReduction = 0.96; // a little beyond the last level that is measured
  undecimate::Monitor monitor;
  const undecimate::Outcome done = undecimate::decimate(d.mesh.view(), options, monitor, d.result);
  ASSERT_TRUE(done) << done.message;
  const undecimate::Outcome opened =
    d.cursor.open(d.result.record.view(), d.result.baseTriangles.data());
  ASSERT_TRUE(opened) << opened.message;
}

/// Decimating is the expensive part: once a mesh.
Decimated& decimated(const std::string& name)
{
  static std::map<std::string, std::unique_ptr<Decimated>> all;
  std::unique_ptr<Decimated>& d = all[name];
  if (!d)
  {
    d = std::make_unique<Decimated>();
    d->mesh = meshOf(name);
    decimate(*d, undecimate::HashQueueDecimationOptions());
  }
  return *d;
}

/// The triangles of the current level in original node numbers.
std::vector<Index> currentTriangles(const undecimate::Undecimation& cursor)
{
  std::vector<Index> triangles(3 * static_cast<std::size_t>(cursor.cellCount()));
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    triangles[i] = cursor.record().nodeOrder[cursor.cells()[i]];
  }
  return triangles;
}

/// Most steps with at most `wanted` triangles.
Index stepsForTriangles(undecimate::Undecimation& cursor, Index wanted)
{
  Index low = 0;
  Index high = cursor.stepCount();
  while (low < high)
  {
    const Index middle = low + (high - low + 1) / 2;
    cursor.moveTo(middle);
    if (cursor.cellCount() <= wanted)
    {
      low = middle;
    }
    else
    {
      high = middle - 1;
    }
  }
  return low;
}

/// Scaled to a unit diagonal.
Kernel::Point_3 position(const TestMesh& mesh, Index node)
{
  const double* x = &mesh.points[3 * static_cast<std::size_t>(node)];
  return Kernel::Point_3(x[0] / mesh.diagonal, x[1] / mesh.diagonal, x[2] / mesh.diagonal);
}

constexpr const char* kNodeName = "v:node"; // node of the mesh that a vertex is

Surface surface(const TestMesh& mesh, const std::vector<Index>& triangles)
{
  Surface out;
  auto nodeOf = out.add_property_map<Surface::Vertex_index, Index>(kNodeName).first;
  std::vector<Surface::Vertex_index> vertex(
    static_cast<std::size_t>(mesh.nodeCount()), Surface::null_vertex());
  for (std::size_t c = 0; c < triangles.size(); c += 3)
  {
    std::array<Surface::Vertex_index, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index node = triangles[c + k];
      Surface::Vertex_index& v = vertex[static_cast<std::size_t>(node)];
      if (v == Surface::null_vertex())
      {
        v = out.add_vertex(position(mesh, node));
        nodeOf[v] = node;
      }
      corners[k] = v;
    }
    // add_face refuses what is not an oriented manifold.
    EXPECT_NE(out.add_face(corners[0], corners[1], corners[2]), Surface::null_face());
  }
  return out;
}

struct Topology
{
  Index nodes = 0;
  Index edges = 0;
  Index triangles = 0;
  Index degenerate = 0;
  Index repeated = 0;
  Index crowded = 0;     ///< edges with more than two triangles
  Index misoriented = 0; ///< directed edges that two triangles have

  Index euler() const { return this->nodes - this->edges + this->triangles; }
};

Topology topologyOf(const std::vector<Index>& triangles)
{
  Topology t;
  std::vector<std::array<Index, 2>> directed;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::array<Index, 3>> cells;
  std::vector<Index> nodes = triangles;
  for (std::size_t c = 0; c < triangles.size(); c += 3)
  {
    std::array<Index, 3> cell = { triangles[c], triangles[c + 1], triangles[c + 2] };
    if (cell[0] == cell[1] || cell[1] == cell[2] || cell[2] == cell[0])
    {
      ++t.degenerate;
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index a = cell[k];
      const Index b = cell[(k + 1) % 3];
      directed.push_back({ a, b });
      edges.push_back({ std::min(a, b), std::max(a, b) });
    }
    std::sort(cell.begin(), cell.end());
    cells.push_back(cell);
  }
  t.triangles = static_cast<Index>(cells.size());
  std::sort(nodes.begin(), nodes.end());
  t.nodes = static_cast<Index>(std::unique(nodes.begin(), nodes.end()) - nodes.begin());
  std::sort(cells.begin(), cells.end());
  t.repeated = static_cast<Index>(cells.end() - std::unique(cells.begin(), cells.end()));
  std::sort(directed.begin(), directed.end());
  t.misoriented =
    static_cast<Index>(directed.end() - std::unique(directed.begin(), directed.end()));
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i)
  {
    t.crowded += edges[i] == edges[i - 2] ? 1 : 0;
  }
  t.edges = static_cast<Index>(std::unique(edges.begin(), edges.end()) - edges.begin());
  return t;
}

void expectManifoldLike(const Topology& input, const Topology& level)
{
  EXPECT_EQ(level.crowded, 0);
  EXPECT_EQ(level.misoriented, 0);
  EXPECT_EQ(level.degenerate, 0);
  EXPECT_EQ(level.repeated, 0);
  EXPECT_EQ(level.euler(), input.euler());
}

/// Move to the first level from below with at most this percentage of the input's triangles.
void moveToPercent(Decimated& d, int percent)
{
  const Index wanted =
    static_cast<Index>(std::llround(0.01 * percent * static_cast<double>(d.mesh.triangleCount())));
  d.cursor.moveTo(stepsForTriangles(d.cursor, wanted));
  ASSERT_LE(d.cursor.cellCount(), wanted);
  ASSERT_GT(d.cursor.cellCount(), wanted - 3);
}

/// Two-sided distance of samples.
double sampledDistance(const Surface& a, const Surface& b)
{
  const auto sampling = CGAL::parameters::number_of_points_on_faces(kSamples).random_seed(1);
  return PMP::approximate_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
    a, b, sampling, sampling);
}

class HausdorffTest : public ::testing::TestWithParam<Case>
{
};

// The heart of it: the record's error can be trusted.
TEST_P(HausdorffTest, ClaimedErrorIsTheMeasuredOne)
{
  Decimated& d = decimated(GetParam().name);
  ASSERT_FALSE(HasFatalFailure());
  CGAL::get_default_random() = CGAL::Random(1); // some of the sampling ignores random_seed()
  const Surface original = surface(d.mesh, d.mesh.triangles);
  for (std::size_t i = 0; i < kPercent.size(); ++i)
  {
    moveToPercent(d, kPercent[i]);
    ASSERT_FALSE(HasFatalFailure());
    const double claim = d.cursor.error();
    const double slack = std::max(GetParam().errorBound, 0.5 * claim);
    const Surface level = surface(d.mesh, currentTriangles(d.cursor));
    const double bounded =
      PMP::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(original, level, slack);
    const double sampled = sampledDistance(original, level);
    std::cout << d.mesh.name << " " << kPercent[i] << " %: claimed " << claim << ", bounded "
              << bounded << " +- " << slack << ", sampled " << sampled << ", bound "
              << GetParam().distances[i] << std::endl;
    EXPECT_LE(sampled, bounded + slack + kRounding) << "CGAL contradicts itself";
    EXPECT_GE(kClaimTooSmall * claim + slack + kRounding, bounded) << "claims too little";
    EXPECT_GE(kClaimTooSmall * claim + kRounding, sampled) << "claims too little";
    EXPECT_LE(claim, kClaimTooLarge * bounded + slack + kRounding) << "claims too much";
    EXPECT_LE(claim, kClaimTooLarge * sampled + kRounding) << "claims too much";
    EXPECT_LE(std::max(sampled, bounded - slack), GetParam().distances[i])
      << "less accurate than it was";
  }
}

TEST_P(HausdorffTest, EveryLevelIsAManifoldOfTheInputsTopology)
{
  Decimated& d = decimated(GetParam().name);
  ASSERT_FALSE(HasFatalFailure());
  const Topology input = topologyOf(d.mesh.triangles);
  ASSERT_EQ(input.crowded, 0);
  ASSERT_EQ(input.misoriented, 0);
  for (int i = 0; i <= 40; ++i)
  {
    d.cursor.moveTo(d.cursor.stepsForLevel(i / 40.0));
    SCOPED_TRACE(std::to_string(i) + "/40");
    const Topology t = topologyOf(currentTriangles(d.cursor));
    expectManifoldLike(input, t);
    EXPECT_EQ(t.nodes, d.cursor.nodeCount()) << "a node without a triangle";
  }
}

TEST_P(HausdorffTest, LevelIsTheSameFromAnywhere)
{
  Decimated& d = decimated(GetParam().name);
  ASSERT_FALSE(HasFatalFailure());
  std::mt19937 random(7);
  for (int i = 0; i < 12; ++i)
  {
    const Index steps =
      static_cast<Index>(random() % static_cast<unsigned>(d.cursor.stepCount() + 1));
    d.cursor.moveTo(steps);
    undecimate::Undecimation fresh;
    ASSERT_TRUE(fresh.open(d.result.record.view(), d.result.baseTriangles.data()));
    fresh.moveTo(steps);
    ASSERT_EQ(fresh.cellCount(), d.cursor.cellCount());
    EXPECT_TRUE(std::equal(fresh.cells(), fresh.cells() + 3 * fresh.cellCount(), d.cursor.cells()))
      << steps << " steps";
  }
}

TEST_P(HausdorffTest, LevelOneIsTheInput)
{
  Decimated& d = decimated(GetParam().name);
  ASSERT_FALSE(HasFatalFailure());
  d.cursor.moveTo(0);
  d.cursor.moveTo(d.cursor.stepCount());
  ASSERT_EQ(d.cursor.cellCount(), d.mesh.triangleCount());
  ASSERT_EQ(d.cursor.nodeCount(), d.mesh.nodeCount());
  std::vector<Index> triangles(d.mesh.triangles.size(), undecimate::kNone);
  const std::vector<Index> current = currentTriangles(d.cursor);
  for (std::size_t slot = 0; slot < current.size() / 3; ++slot)
  {
    std::copy_n(
      &current[3 * slot], 3, &triangles[3 * static_cast<std::size_t>(d.cursor.shownCells()[slot])]);
  }
  EXPECT_EQ(triangles, d.mesh.triangles);
  EXPECT_EQ(d.cursor.error(), 0.0);
}

TEST_P(HausdorffTest, ErrorsNeverIncreaseTowardsTheInput)
{
  Decimated& d = decimated(GetParam().name);
  ASSERT_FALSE(HasFatalFailure());
  d.cursor.moveTo(0);
  double before = d.cursor.error();
  EXPECT_FLOAT_EQ(static_cast<float>(before), static_cast<float>(d.result.error));
  for (Index steps = 1; steps <= d.cursor.stepCount(); ++steps)
  {
    d.cursor.moveTo(steps);
    ASSERT_LE(d.cursor.error(), before) << steps << " steps";
    before = d.cursor.error();
  }
}

/// Largest error of the values at the input's nodes, as a fraction of their range: value of the
/// closest point of the current level against the node's.
double valueError(const Decimated& d)
{
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Surface>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  const TestMesh& mesh = d.mesh;
  const Surface coarse = surface(mesh, currentTriangles(d.cursor));
  const auto nodeOf = coarse.property_map<Surface::Vertex_index, Index>(kNodeName).first;
  const Tree tree(faces(coarse).begin(), faces(coarse).end(), coarse);
  const auto range = std::minmax_element(mesh.values.begin(), mesh.values.end());
  double worst = 0.0;
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    const auto closest = tree.closest_point_and_primitive(position(mesh, node));
    std::array<Kernel::Point_3, 3> p;
    std::array<double, 3> value{};
    std::size_t k = 0;
    for (const Surface::Vertex_index v :
      vertices_around_face(coarse.halfedge(closest.second), coarse))
    {
      p[k] = coarse.point(v);
      value[k++] = mesh.values[static_cast<std::size_t>(nodeOf[v])];
    }
    const Kernel::Vector_3 normal = CGAL::cross_product(p[1] - p[0], p[2] - p[0]);
    double interpolated = 0.0;
    for (k = 0; k < 3; ++k)
    {
      const Kernel::Vector_3 part =
        CGAL::cross_product(p[(k + 1) % 3] - closest.first, p[(k + 2) % 3] - closest.first);
      interpolated += value[k] * (part * normal) / normal.squared_length();
    }
    worst = std::max(worst,
      std::abs(interpolated - mesh.values[static_cast<std::size_t>(node)]) /
        (*range.second - *range.first));
  }
  return worst;
}

// A nodal array steers: its error at the nodes is claimed as well, times the weight.
TEST(PlateWithStressTest, ClaimedErrorIsTheStressErrorToo)
{
  constexpr std::array<double, 4> kBounds = { 5.7e-4, 1.9e-3, 5.8e-3, 7.8e-3 }; // of the range
  Decimated d;
  d.mesh = readMesh("plate_hole", dataFile("plate_hole.vtp"), "von_mises");
  undecimate::HashQueueDecimationOptions options;
  undecimate::NodalArrayView stress;
  stress.values = d.mesh.values.data();
  stress.name = "von_mises";
  options.arrays.push_back(stress);
  decimate(d, options);
  ASSERT_FALSE(HasFatalFailure());
  for (std::size_t i = 0; i < kPercent.size(); ++i)
  {
    d.cursor.moveTo(stepsForTriangles(
      d.cursor, static_cast<Index>(std::llround(0.01 * kPercent[i] * d.mesh.triangleCount()))));
    const double claim = d.cursor.error() / options.scalarWeight;
    const double measured = valueError(d);
    std::cout << "plate_hole, von_mises " << kPercent[i] << " %: claimed " << claim << ", measured "
              << measured << ", bound " << kBounds[i] << std::endl;
    EXPECT_GE(claim * kClaimTooSmall, measured);
    EXPECT_LE(claim, kClaimTooLarge * measured);
    EXPECT_LE(measured, kBounds[i]);
  }
}

/// Triangles of a height field that do not face upwards.
int flippedTriangles(const TestMesh& mesh, const std::vector<Index>& triangles)
{
  int flipped = 0;
  for (std::size_t c = 0; c < triangles.size(); c += 3)
  {
    const double* p = &mesh.points[3 * static_cast<std::size_t>(triangles[c])];
    const double* q = &mesh.points[3 * static_cast<std::size_t>(triangles[c + 1])];
    const double* r = &mesh.points[3 * static_cast<std::size_t>(triangles[c + 2])];
    const double z = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    flipped += z <= 0.0 ? 1 : 0;
  }
  return flipped;
}

// A height field must not fold, whatever the criterion.
TEST(GridTest, NoTriangleIsFlippedAtAnyLevel)
{
  for (const undecimate::Criterion criterion :
    { undecimate::Criterion::Deviation, undecimate::Criterion::ScalarDifference,
      undecimate::Criterion::AngleToXYPlane, undecimate::Criterion::Quadric })
  {
    Decimated d;
    d.mesh = makeGrid(70);
    undecimate::HashQueueDecimationOptions options;
    options.criterion = criterion;
    undecimate::NodalArrayView scalar;
    scalar.values = d.mesh.values.data();
    scalar.name = "scalar";
    options.arrays.push_back(scalar);
    decimate(d, options);
    ASSERT_FALSE(HasFatalFailure());
    int levels = 0;
    int flipped = 0;
    for (int i = 0; i <= 100; ++i)
    {
      d.cursor.moveTo(d.cursor.stepsForLevel(i / 100.0));
      const int here = flippedTriangles(d.mesh, currentTriangles(d.cursor));
      levels += here > 0 ? 1 : 0;
      flipped = std::max(flipped, here);
    }
    EXPECT_EQ(flipped, 0) << "at most, on " << levels << " of 101 levels; criterion "
                          << static_cast<int>(criterion);
  }
}

// Quadric claims the root of a mean square, which is no bound: the distance was 1.6 to 6.9 times
// the claim when this was set.
TEST(QuadricTest, DistancesAreWithinTheirBounds)
{
  struct Bounds
  {
    const char* name;
    std::array<double, 4> distances; // at kPercent
  };
  // Measured, and a tenth more.
  for (const Bounds& bounds : { Bounds{ "flange", { 1e-6, 1e-6, 4.3e-3, 6.7e-3 } },
         Bounds{ "scan", { 2.4e-3, 5.2e-3, 9.8e-3, 1.8e-2 } },
         Bounds{ "blade_tip", { 4.1e-4, 1.2e-3, 3.8e-3, 3.8e-3 } },
         Bounds{ "grid", { 1.2e-3, 2.5e-3, 7.7e-3, 9.9e-3 } } })
  {
    Decimated d;
    d.mesh = meshOf(bounds.name);
    undecimate::HashQueueDecimationOptions options;
    options.criterion = undecimate::Criterion::Quadric;
    decimate(d, options);
    ASSERT_FALSE(HasFatalFailure());
    CGAL::get_default_random() = CGAL::Random(1);
    const Surface original = surface(d.mesh, d.mesh.triangles);
    const Topology input = topologyOf(d.mesh.triangles);
    for (std::size_t i = 0; i < kPercent.size(); ++i)
    {
      SCOPED_TRACE(std::string(bounds.name) + " " + std::to_string(kPercent[i]) + " %");
      moveToPercent(d, kPercent[i]);
      ASSERT_FALSE(HasFatalFailure());
      const std::vector<Index> triangles = currentTriangles(d.cursor);
      const double sampled = sampledDistance(original, surface(d.mesh, triangles));
      std::cout << bounds.name << " " << kPercent[i] << " %: claimed " << d.cursor.error()
                << ", sampled " << sampled << ", bound " << bounds.distances[i] << std::endl;
      EXPECT_LE(sampled, bounds.distances[i]) << "less accurate than it was";
      EXPECT_GE(sampled, 0.5 * d.cursor.error()) << "claims more than there is";
      EXPECT_LE(sampled, 8.0 * d.cursor.error() + kRounding) << "claims far too little";
      expectManifoldLike(input, topologyOf(triangles));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, HausdorffTest, ::testing::ValuesIn(casesThatAreThere()),
  [](const ::testing::TestParamInfo<Case>& info) { return std::string(info.param.name); });

} // namespace

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
