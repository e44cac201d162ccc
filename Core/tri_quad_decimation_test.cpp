// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tri_quad_decimation.h"

#include "testing/same_record.h"
#include "testing/tri_quad_meshes.h"
#include "time_lanes.h"
#include "undecimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace undecimate
{
namespace
{

using testing::Cells;
using testing::MixedMesh;

/// A decimation that succeeded, and a cursor that stands at level 0.
struct Decimated
{
  TriQuadDecimationResult result;
  Undecimation cursor;

  Decimated(const MixedMesh& mesh, const TriQuadDecimationOptions& options)
    : Decimated(mesh.view(), mesh.rows(), options)
  {
  }
  Decimated(
    const TriQuadMeshView& view, const TimeRows& rows, const TriQuadDecimationOptions& options)
  {
    Monitor monitor;
    const Outcome outcome = decimateTriQuad(view, rows, options, monitor, this->result);
    EXPECT_TRUE(outcome) << outcome.message;
    const Outcome opened =
      this->cursor.open(this->result.record.view(), this->result.baseCells.data());
    EXPECT_TRUE(opened) << opened.message;
  }

  /// The cells of the cursor's level in original numbers, in record order.
  Cells cells() const
  {
    Cells cells;
    for (Index slot = 0; slot < this->cursor.cellCount(); ++slot)
    {
      const Index* cell = this->cursor.cells() + 4 * slot;
      cells.emplace_back();
      std::transform(cell, cell + 4, cells.back().begin(),
        [&](Index n) { return n == kNone ? kNone : this->result.record.nodeOrder[n]; });
    }
    return cells;
  }

  std::set<Index> baseNodes() const
  {
    const auto& order = this->result.record.nodeOrder;
    return { order.begin(), order.begin() + this->result.record.baseNodeCount };
  }

  /// At level 1 each slot has the cell that cellOrder names, corner by corner.
  void expectOriginal(const MixedMesh& mesh)
  {
    this->cursor.moveTo(this->cursor.stepCount());
    const Cells now = this->cells();
    ASSERT_EQ(now.size(), mesh.cells.size());
    for (std::size_t slot = 0; slot < now.size(); ++slot)
    {
      ASSERT_EQ(now[slot], mesh.cells[this->result.record.cellOrder[slot]]) << "slot " << slot;
    }
  }
};

TriQuadDecimationOptions all(TriQuadCriterion criterion = TriQuadCriterion::Deviation)
{
  TriQuadDecimationOptions options;
  options.criterion = criterion;
  options.targetReduction = 1.0;
  return options;
}

std::array<double, 3> wave(int step, std::array<double, 3> p)
{
  return { p[0], p[1], p[2] + 0.2 * step * std::sin(0.9 * p[0] + 0.3 * step) };
}

MixedMesh anyMesh(int kind, std::mt19937& random)
{
  const double triangles = std::array<double, 3>{ 0.0, 0.3, 1.0 }[random() % 3];
  switch (kind % 5)
  {
    case 0:
      return testing::mixedGrid(9, 8, false, false, triangles, random);
    case 1:
      return testing::mixedGrid(10, 7, true, false, triangles, random);
    case 2:
      return testing::mixedGrid(12, 8, true, true, triangles, random);
    case 3:
      return testing::mixedBox(4, triangles, random);
    default:
      return testing::mixedTJoint(6);
  }
}

TEST(TriQuadDecimation, KeepsItsPropertiesAtEveryLevel)
{
  for (int seed = 0; seed < 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    MixedMesh mesh = anyMesh(seed, random);
    if (seed % 3 != 0)
    {
      mesh.addSteps(1 + seed % 9, wave);
    }
    if (seed % 4 == 1)
    {
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      {
        mesh.parts.push_back(c < mesh.cells.size() / 2 ? 1 : 2);
      }
    }
    TriQuadDecimationOptions options =
      all(seed % 2 == 0 ? TriQuadCriterion::Deviation : TriQuadCriterion::Quadrics);
    options.timeError = seed % 5 == 0 ? TimeError::Sum : TimeError::Maximum;
    options.preserveBoundary = seed % 7 == 0;
    const bool manifold = static_cast<bool>(testing::isValidMesh(mesh.cells));
    Decimated decimated(mesh, options);
    ASSERT_GT(decimated.cursor.stepCount(), mesh.nodeCount() / 4);
    ASSERT_EQ(decimated.result.record.cornersPerCell, 4);

    std::size_t most = 0;
    for (const auto& [edge, cells] : testing::edgesOf(mesh.cells))
    {
      most = std::max(most, cells.size());
    }
    const int euler = testing::eulerCharacteristic(mesh.cells);
    double error = std::numeric_limits<double>::infinity();
    for (Index step = 0; step <= decimated.cursor.stepCount(); ++step)
    {
      decimated.cursor.moveTo(step);
      ASSERT_LE(decimated.cursor.error(), error);
      error = decimated.cursor.error();
      const Cells cells = decimated.cells();
      ASSERT_TRUE(testing::hasSoundCells(cells)) << "step " << step;
      ASSERT_EQ(testing::eulerCharacteristic(cells), euler) << "step " << step;
      if (manifold)
      {
        ASSERT_TRUE(testing::isValidMesh(cells)) << "step " << step;
      }
      for (const auto& [edge, at] : testing::edgesOf(cells))
      {
        ASSERT_LE(at.size(), most);
        ASSERT_LE(edge.second, mesh.nodeCount());
      }
    }
    EXPECT_EQ(decimated.cursor.error(), 0.0);
    decimated.expectOriginal(mesh);
  }
}

TEST(TriQuadDecimation, LevelsAreTheSameFromBothSides)
{
  std::mt19937 random(5);
  MixedMesh mesh = testing::mixedGrid(12, 9, false, false, 0.3, random);
  mesh.addSteps(4, wave);
  Decimated decimated(mesh, all());
  const Index steps = decimated.cursor.stepCount();
  std::map<Index, Cells> levels;
  for (Index step = 0; step <= steps; step += 3)
  {
    decimated.cursor.moveTo(step);
    levels[step] = decimated.cells();
  }
  for (int jump = 0; jump < 200; ++jump)
  {
    const Index step = 3 * static_cast<Index>(random() % (steps / 3 + 1));
    decimated.cursor.moveTo(step);
    ASSERT_EQ(decimated.cells(), levels[step]) << "step " << step;
  }
}

TEST(TriQuadDecimation, KeepsQuadsWhereNothingWasRemoved)
{
  std::mt19937 random(5);
  const MixedMesh mesh = testing::mixedGrid(20, 20, false, false, 0.0, random);
  TriQuadDecimationOptions options;
  options.targetReduction = 0.05;
  const Decimated decimated(mesh, options);
  const auto kept = decimated.baseNodes();
  Index untouched = 0;
  for (const auto& cell : decimated.cells())
  {
    const bool original = std::find(mesh.cells.begin(), mesh.cells.end(), cell) != mesh.cells.end();
    untouched += original && testing::cornersOf(cell).size() == 4;
  }
  EXPECT_GE(untouched, 400 - 4 * decimated.cursor.stepCount());
  EXPECT_EQ(decimated.cursor.stepCount(), 22); // of 441 nodes
}

// A plane that folds along a line at a later step: at the first step everything is flat.
TEST(TriQuadDecimation, LooksAtAllSteps)
{
  std::mt19937 random(3);
  MixedMesh still = testing::mixedGrid(16, 16, false, false, 0.2, random);
  for (std::size_t i = 2; i < still.positions[0].size(); i += 3)
  {
    still.positions[0][i] = 0.0;
  }
  MixedMesh folding = still;
  folding.addSteps(3,
    [](int step, std::array<double, 3> p) {
      return std::array<double, 3>{ p[0], p[1], 0.2 * step * std::abs(p[0] - 8.0) };
    });
  for (const auto criterion : { TriQuadCriterion::Deviation, TriQuadCriterion::Quadrics })
  {
    TriQuadDecimationOptions options = all(criterion);
    options.maximumError = 1e-4;
    // Flat: the four corners stay. Folded: the ends of the fold as well.
    EXPECT_EQ(Decimated(still, options).result.record.baseNodeCount, 4);
    const Decimated folded(folding, options);
    EXPECT_EQ(folded.baseNodes(), (std::set<Index>{ 0, 8, 16, 272, 280, 288 }));
    EXPECT_EQ(folded.result.stopReason, StopReason::MaximumError);
    EXPECT_LE(folded.result.error, 1e-4);
  }
}

TEST(TriQuadDecimation, ErrorsCoverTheRemovedNodes)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(24, 20, false, false, 0.3, random);
  mesh.addSteps(5, wave);
  TriQuadDecimationOptions options = all();
  options.targetReduction = 0.8;
  const Decimated decimated(mesh, options);
  const TimeRows rows = mesh.rows();
  const Cells cells = decimated.cells();
  std::vector<double> largest(mesh.positions.size(), 0.0);
  const auto kept = decimated.baseNodes();
  std::vector<float> triangle(kTriangleRows * rows.lanes());
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    std::vector<float> squares(rows.lanes(), std::numeric_limits<float>::infinity());
    for (const auto& cell : cells)
    {
      const auto corners = testing::cornersOf(cell);
      std::vector<float> middle(3 * rows.lanes());
      center(rows.lanes(), 3, rows.at(corners[0]), rows.at(corners[1]), rows.at(corners[2]),
        rows.at(corners.back()), middle.data());
      for (std::size_t k = 0; k < (corners.size() == 3 ? 1 : 4); ++k)
      {
        prepareTriangle(rows.lanes(), rows.at(corners[k]),
          rows.at(corners[(k + 1) % corners.size()]),
          corners.size() == 3 ? rows.at(corners[2]) : middle.data(), triangle.data());
        minimumDistances(rows.lanes(), triangle.data(), 1, rows.at(node), squares.data());
      }
    }
    for (std::size_t step = 0; step < largest.size(); ++step)
    {
      largest[step] = std::max<double>(largest[step], std::sqrt(squares[step]));
    }
  }
  double most = 0.0;
  ASSERT_EQ(decimated.result.stepErrors.size(), largest.size());
  for (std::size_t step = 0; step < largest.size(); ++step)
  {
    EXPECT_LE(largest[step], decimated.result.stepErrors[step] * 1.001 + 1e-6) << step;
    most = std::max(most, decimated.result.stepErrors[step]);
  }
  EXPECT_NEAR(most, decimated.result.error, 1e-6);
  EXPECT_GT(*std::max_element(largest.begin(), largest.end()), 0.2 * decimated.result.error);
}

// The largest squared distance at each step of places in the cells of a level (their middles, and
// half of the way from there to the corners and to the middles of the edges) to the input's cells.
std::vector<float> squaresOfTheWayBack(const MixedMesh& mesh, const Cells& level)
{
  const TimeRows rows = mesh.rows();
  const std::size_t lanes = rows.lanes();
  std::vector<float> middles(3 * lanes * mesh.cells.size());
  std::vector<float> triangles;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const auto corners = testing::cornersOf(mesh.cells[c]);
    const float* at[4];
    std::transform(corners.begin(), corners.end(), at, [&](Index node) { return rows.at(node); });
    float* middleOfCell = middles.data() + 3 * lanes * c;
    mean(rows.lanes(), at, static_cast<int>(corners.size()), middleOfCell);
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      triangles.resize(triangles.size() + kTriangleRows * lanes);
      prepareTriangle(rows.lanes(), at[k], at[(k + 1) % corners.size()], middleOfCell,
        triangles.data() + triangles.size() - kTriangleRows * lanes);
    }
  }
  std::vector<float> largestSquares(lanes, 0.0F);
  const auto measure = [&](const float* place)
  {
    std::vector<float> squares(lanes, std::numeric_limits<float>::infinity());
    for (std::size_t t = 0; t < triangles.size(); t += kTriangleRows * lanes)
    {
      minimumDistances(rows.lanes(), triangles.data() + t, 1, place, squares.data());
    }
    raise(rows.lanes(), squares.data(), largestSquares.data());
  };
  for (const auto& cell : level)
  {
    const auto corners = testing::cornersOf(cell);
    const float* at[4];
    std::transform(corners.begin(), corners.end(), at, [&](Index node) { return rows.at(node); });
    std::vector<float> center(3 * lanes);
    std::vector<float> edge(3 * lanes);
    std::vector<float> place(3 * lanes);
    mean(rows.lanes(), at, static_cast<int>(corners.size()), center.data());
    measure(center.data());
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      middle(rows.lanes(), at[k], at[(k + 1) % corners.size()], edge.data());
      measure(edge.data());
      for (const float* end : { at[k], static_cast<const float*>(edge.data()) })
      {
        middle(rows.lanes(), center.data(), end, place.data());
        measure(place.data());
      }
    }
  }
  return largestSquares;
}

// The way back from the new cells to the original ones counts, too.
TEST(TriQuadDecimation, ErrorsCoverTheNewCells)
{
  std::mt19937 random(9);
  for (int i = 0; i < 4; ++i)
  {
    MixedMesh mesh = testing::mixedGrid(36, 24, false, false, 0.3, random);
    mesh.addSteps(3, wave);
    TriQuadDecimationOptions options = all();
    options.targetReduction = 0.9;
    const Decimated decimated(mesh, options);
    const auto squares = squaresOfTheWayBack(mesh, decimated.cells());
    const double back = std::sqrt(*std::max_element(squares.begin(), squares.end()));
    EXPECT_LE(back, decimated.result.error) << i;
  }
}

// Triangles that are crumpled without any order at three more steps: soon each way of each node
// turns a cell over.
TEST(TriQuadDecimation, FoldsWhereThereIsNoOtherWay)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(14, 14, false, false, 1.0, random);
  std::uniform_real_distribution<double> place(0.0, 14.0);
  mesh.addSteps(3,
    [&](int, std::array<double, 3>) {
      return std::array<double, 3>{ place(random), place(random), place(random) };
    });
  for (const auto criterion : { TriQuadCriterion::Deviation, TriQuadCriterion::Quadrics })
  {
    TriQuadDecimationOptions options = all(criterion);
    options.targetNodes = 10;
    Decimated decimated(mesh, options);
    EXPECT_EQ(decimated.result.stopReason, StopReason::TargetNodes);
    EXPECT_TRUE(std::isfinite(decimated.result.error));
    decimated.expectOriginal(mesh);
    // What folds counts half of its longest edge, so a small error keeps most of the nodes.
    options.maximumError = 0.05;
    const Decimated unfolded(mesh, options);
    EXPECT_EQ(unfolded.result.stopReason, StopReason::MaximumError);
    EXPECT_LE(unfolded.result.error, 0.05);
    EXPECT_GT(unfolded.result.record.baseNodeCount, 100);
  }
}

TEST(TriQuadDecimation, SumAndMaximumDiffer)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(16, 16, false, false, 0.2, random);
  mesh.addSteps(6, wave);
  for (const auto criterion : { TriQuadCriterion::Deviation, TriQuadCriterion::Quadrics })
  {
    TriQuadDecimationOptions options = all(criterion);
    options.targetReduction = 0.8;
    const Decimated maximum(mesh, options);
    options.timeError = TimeError::Sum;
    const Decimated sum(mesh, options);
    EXPECT_NE(maximum.baseNodes(), sum.baseNodes());
    EXPECT_EQ(maximum.baseNodes().size(), sum.baseNodes().size());
  }
}

TEST(TriQuadDecimation, SeamsStayTogetherAndInPlace)
{
  const MixedMesh mesh = testing::mixedTJoint(8);
  TriQuadDecimationOptions options = all();
  options.maximumError = 1e-4;
  Decimated decimated(mesh, options);
  EXPECT_EQ(decimated.result.seamNodes, 9);
  // Floor and wall are flat: the corners and the ends of the joint are left.
  EXPECT_EQ(decimated.result.record.baseNodeCount, 8);
  // The joint is one edge of three sheets: the two sides of the floor and the wall.
  const auto edges = testing::edgesOf(decimated.cells());
  const auto joint = edges.find({ 36, 44 });
  ASSERT_NE(joint, edges.end());
  EXPECT_EQ(joint->second.size(), 3U);
  decimated.expectOriginal(mesh);
}

TEST(TriQuadDecimation, BordersOfPartsStay)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(12, 12, false, false, 0.0, random);
  for (std::size_t i = 2; i < mesh.positions[0].size(); i += 3)
  {
    mesh.positions[0][i] = 0.0;
  }
  for (Index c = 0; c < 144; ++c)
  {
    mesh.parts.push_back(c % 12 < 5 ? 0 : 1); // border: x = 5
  }
  TriQuadDecimationOptions options = all();
  options.maximumError = 1e-4;
  const Decimated parts(mesh, options);
  EXPECT_EQ(parts.baseNodes(), (std::set<Index>{ 0, 5, 12, 156, 161, 168 }));
  EXPECT_EQ(testing::edgesOf(parts.cells()).count({ 5, 161 }), 1U);
  // A border with a step in it keeps its corners.
  for (Index c = 72; c < 144; ++c)
  {
    mesh.parts[c] = c % 12 < 8 ? 0 : 1;
  }
  const auto kept = Decimated(mesh, options).baseNodes();
  for (const Index node : { 5, 6 * 13 + 5, 6 * 13 + 8, 12 * 13 + 8 })
  {
    EXPECT_EQ(kept.count(node), 1U) << node;
  }
}

TEST(TriQuadDecimation, KeepsWhatItIsTold)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(10, 10, false, false, 0.2, random);
  mesh.addSteps(2, wave);
  std::vector<unsigned char> keep(mesh.nodeCount(), 0);
  keep[60] = 1;
  mesh.positions[1][3 * 70 + 1] = std::nan("");
  mesh.addNode(3.0, 3.0, 3.0);
  mesh.positions[1].insert(mesh.positions[1].end(), 3, 0.0);
  mesh.positions[2].insert(mesh.positions[2].end(), 3, 0.0);
  keep.push_back(0);
  mesh.cells.push_back({ 0, 0, 1, kNone });
  TriQuadMeshView view = mesh.view();
  view.keep = keep.data();
  TriQuadDecimationOptions options = all();
  options.preserveBoundary = true;
  Decimated decimated(view, mesh.rows(), options);
  const auto& result = decimated.result;
  EXPECT_EQ(result.requestedNodes, 1);
  EXPECT_EQ(result.unusedNodes, 1);
  EXPECT_EQ(result.irregularNodes, 2);
  EXPECT_EQ(result.boundaryNodes, 38);
  EXPECT_GE(result.nonFiniteNodes, 7);
  const auto kept = decimated.baseNodes();
  for (const Index node : { 0, 1, 10, 60, 70, 121 })
  {
    EXPECT_EQ(kept.count(node), 1U) << node;
  }
  EXPECT_EQ(result.stopReason, StopReason::NoRemovableNode);
  decimated.expectOriginal(mesh);
}

TEST(TriQuadDecimation, StopsWhereItShall)
{
  std::mt19937 random(3);
  const MixedMesh mesh = testing::mixedGrid(19, 19, false, false, 0.2, random); // 400 nodes
  TriQuadDecimationOptions options;
  EXPECT_EQ(Decimated(mesh, options).result.record.baseNodeCount, 40);
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetReduction);
  options.targetNodes = 100;
  EXPECT_EQ(Decimated(mesh, options).result.record.baseNodeCount, 100);
  EXPECT_EQ(Decimated(mesh, options).result.stopReason, StopReason::TargetNodes);
  options.targetReduction = 0.0;
  EXPECT_EQ(Decimated(mesh, options).cursor.stepCount(), 0);
  options = all();
  options.maximumError = 0.003;
  const Decimated limited(mesh, options);
  EXPECT_EQ(limited.result.stopReason, StopReason::MaximumError);
  EXPECT_LE(limited.result.error, 0.003);
  EXPECT_GT(limited.cursor.stepCount(), 50);
}

TEST(TriQuadDecimation, TheWeightOfQuadsKeepsQuads)
{
  std::mt19937 random(3);
  const MixedMesh mesh = testing::mixedGrid(24, 24, false, false, 0.5, random);
  const auto quads = [&](double weight, TriQuadCriterion criterion)
  {
    TriQuadDecimationOptions options = all(criterion);
    options.targetReduction = 0.3;
    options.quadWeight = weight;
    const Cells cells = Decimated(mesh, options).cells();
    return std::count_if(cells.begin(), cells.end(),
      [](const auto& cell) { return testing::cornersOf(cell).size() == 4; });
  };
  for (const auto criterion : { TriQuadCriterion::Deviation, TriQuadCriterion::Quadrics })
  {
    EXPECT_GT(quads(0.1, criterion), quads(0.0, criterion) + 10);
  }
}

// A flat plate with a step in a result: with the array its front stays, without it all goes.
TEST(TriQuadDecimation, ArraysSteer)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(20, 20, false, false, 0.3, random);
  for (std::size_t i = 2; i < mesh.positions[0].size(); i += 3)
  {
    mesh.positions[0][i] = 0.0;
  }
  mesh.addSteps(1, [](int, std::array<double, 3> p) { return p; });
  TimeRows values(mesh.nodeCount(), 1, 2);
  std::vector<double> first(mesh.nodeCount(), 5.0);
  std::vector<double> second(mesh.nodeCount());
  for (Index node = 0; node < mesh.nodeCount(); ++node)
  {
    second[node] = 5.0 + std::tanh(mesh.positions[0][3 * node] - 10.0);
  }
  const double origin = 5.0;
  values.set<double>(0, first.data(), nullptr, &origin, 1.0);
  values.set<double>(1, second.data(), nullptr, &origin, 1.0);
  TriQuadDecimationOptions options = all();
  options.targetReduction = 0.9;
  const auto largestError = [&](const TriQuadDecimationOptions& o)
  {
    const Decimated decimated(mesh, o);
    double largest = 0.0;
    for (const auto& cell : decimated.cells())
    {
      // Along x the field is known: compare at the nodes in the box of the cell's corners.
      const auto corners = testing::cornersOf(cell);
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        const Index a = corners[k];
        const Index b = corners[(k + 1) % corners.size()];
        const double x = 0.5 * (mesh.positions[0][3 * a] + mesh.positions[0][3 * b]);
        largest =
          std::max(largest, std::abs(0.5 * (second[a] + second[b]) - 5.0 - std::tanh(x - 10.0)));
      }
    }
    return largest;
  };
  const double without = largestError(options);
  options.arrays = { { &values, "step" } };
  const double with = largestError(options);
  EXPECT_GT(without, 0.3);
  EXPECT_LT(with, 0.5 * without);
  options.scalarWeight = 0.0;
  EXPECT_EQ(largestError(options), without);
}

// A bump that comes and goes within three of 21 steps.
TEST(TriQuadDecimation, ChoosesTheStepsThatCount)
{
  std::mt19937 random(3);
  MixedMesh mesh = testing::mixedGrid(24, 24, false, false, 0.3, random);
  mesh.addSteps(20,
    [](int step, std::array<double, 3> p)
    {
      const double r = std::hypot(p[0] - 8.0, p[1] - 15.0);
      const double rise = std::max(0.0, 1.0 - 0.5 * std::abs(step - 13));
      return std::array<double, 3>{ p[0] + 0.3 * step, p[1],
        p[2] + rise * 2.0 * std::exp(-r * r / 4.0) };
    });
  TriQuadDecimationOptions options;
  options.targetReduction = 0.85;
  const TimeRows rows = mesh.rows();
  Monitor monitor;
  std::vector<int> steps;
  TriQuadDecimationResult result;
  const Outcome outcome =
    decimateTriQuadAutomatically(mesh.view(), rows, options, 1.2, monitor, result, steps);
  ASSERT_TRUE(outcome) << outcome.message;
  EXPECT_EQ(monitor.progress(), 1.0);
  EXPECT_LE(steps.size(), 6U);
  EXPECT_EQ(std::count(steps.begin(), steps.end(), 13), 1);
  // The promise, against what all steps give.
  const auto worst = [](const std::vector<double>& errors)
  { return *std::max_element(errors.begin(), errors.end()); };
  options.allPositions = &rows;
  const Decimated all(mesh, options);
  ASSERT_EQ(result.allStepErrors.size(), 21U);
  EXPECT_LE(worst(result.allStepErrors), 1.3 * worst(all.result.allStepErrors));
  EXPECT_LE(worst(all.result.allStepErrors), 1.001 * all.result.error + 1e-6);

  options.criterion = TriQuadCriterion::Quadrics;
  options.allPositions = nullptr;
  std::vector<int> again;
  ASSERT_TRUE(
    decimateTriQuadAutomatically(mesh.view(), rows, options, 1.2, monitor, result, again));
  EXPECT_EQ(again, steps);
  const Outcome refused =
    decimateTriQuadAutomatically(mesh.view(), rows, options, 0.9, monitor, result, again);
  EXPECT_EQ(refused.status, Status::InvalidArgument);
  EXPECT_NE(refused.message.find("StepFactor"), std::string::npos);
}

TEST(TriQuadDecimation, TakesEmptyAndTinyMeshes)
{
  MixedMesh mesh;
  EXPECT_EQ(Decimated(mesh, all()).cursor.stepCount(), 0);
  mesh.addNode(0.0, 0.0, 0.0);
  EXPECT_EQ(Decimated(mesh, all()).cursor.stepCount(), 0);
  mesh.addNode(1.0, 0.0, 0.0);
  mesh.addNode(1.0, 1.0, 0.0);
  mesh.addNode(0.0, 1.0, 0.0);
  mesh.cells = { { 0, 1, 2, 3 } };
  Decimated quad(mesh, all());
  EXPECT_EQ(quad.cursor.stepCount(), 1); // a triangle is left
  quad.expectOriginal(mesh);
}

TEST(TriQuadDecimation, RefusesWhatDoesNotFit)
{
  std::mt19937 random(3);
  const MixedMesh mesh = testing::mixedGrid(4, 4, false, false, 0.2, random);
  const TimeRows rows = mesh.rows();
  const auto refuse = [&](const TriQuadMeshView& view, const TimeRows& positions,
                        const TriQuadDecimationOptions& options, const std::string& word)
  {
    TriQuadDecimationResult result;
    Monitor monitor;
    const Outcome outcome = decimateTriQuad(view, positions, options, monitor, result);
    EXPECT_EQ(outcome.status, Status::InvalidArgument);
    EXPECT_NE(outcome.message.find(word), std::string::npos) << outcome.message;
    EXPECT_TRUE(result.baseCells.empty());
  };
  TriQuadDecimationOptions options;
  options.targetReduction = 1.5;
  refuse(mesh.view(), rows, options, "TargetReduction");
  options = {};
  options.maximumError = std::nan("");
  refuse(mesh.view(), rows, options, "MaximumError");
  options = {};
  options.quadWeight = -1.0;
  refuse(mesh.view(), rows, options, "QuadWeight");
  options = {};
  options.scalarWeight = -1.0;
  refuse(mesh.view(), rows, options, "ScalarWeight");
  options = {};
  options.targetNodes = -1;
  refuse(mesh.view(), rows, options, "TargetNodes");
  options = {};
  options.candidates = 0;
  refuse(mesh.view(), rows, options, "candidates");
  options = {};
  const TimeRows other(3, 1, 1);
  options.arrays = { { &other, "stress" } };
  refuse(mesh.view(), rows, options, "'stress'");
  options = {};
  refuse(mesh.view(), TimeRows(3, 3, 1), options, "positions");
  MixedMesh broken = mesh;
  broken.cells[2][1] = 99;
  refuse(broken.view(), rows, options, "Cell 2 refers to node 99");
  broken = mesh;
  broken.cells[2] = { 0, kNone, 1, 2 };
  refuse(broken.view(), rows, options, "Cell 2");
}

void expectSame(const Decimated& a, const Decimated& b)
{
  EXPECT_EQ(a.result.stopReason, b.result.stopReason);
  EXPECT_EQ(a.result.error, b.result.error);
  EXPECT_EQ(a.result.stepErrors, b.result.stepErrors);
  EXPECT_EQ(a.result.baseCells, b.result.baseCells);
  testing::expectSame(a.result.record, b.result.record);
}

TEST(TriQuadDecimation, ThreadsDoNotChangeTheResult)
{
  std::mt19937 random(8);
  // The large one is evaluated ahead for long, the others have parts, seams and few nodes.
  std::vector<MixedMesh> meshes{ testing::mixedGrid(60, 55, false, false, 0.3, random),
    testing::mixedBox(9, 0.2, random), testing::mixedTJoint(14),
    testing::mixedGrid(12, 8, true, true, 0.5, random) };
  for (std::size_t m = 0; m < meshes.size(); ++m)
  {
    MixedMesh& mesh = meshes[m];
    mesh.addSteps(3, wave);
    for (std::size_t c = 0; m == 0 && c < mesh.cells.size(); ++c)
    {
      mesh.parts.push_back(c < mesh.cells.size() / 2 ? 1 : 2);
    }
    for (const TriQuadCriterion criterion :
      { TriQuadCriterion::Deviation, TriQuadCriterion::Quadrics })
    {
      TriQuadDecimationOptions options = all(criterion);
      options.timeError = m == 1 ? TimeError::Sum : TimeError::Maximum;
      options.quadWeight = m == 2 ? 0.01 : 0.0;
      options.threads = 1;
      const Decimated alone(mesh, options);
      for (const int threads : { 2, 3 })
      {
        SCOPED_TRACE(std::to_string(m) + " " + std::to_string(threads) + " threads");
        options.threads = threads;
        expectSame(alone, Decimated(mesh, options));
      }
    }
  }
}

TEST(TriQuadDecimation, CanBeCancelled)
{
  std::mt19937 random(3);
  const MixedMesh mesh = testing::mixedGrid(40, 40, false, false, 0.2, random);
  double last = 0.0;
  for (const double until : { 0.05, 0.5 })
  {
    Monitor monitor(
      [&](double fraction)
      {
        last = fraction;
        return fraction < until;
      });
    TriQuadDecimationResult result;
    const Outcome outcome = decimateTriQuad(mesh.view(), mesh.rows(), all(), monitor, result);
    EXPECT_EQ(outcome.status, Status::Cancelled);
    EXPECT_TRUE(result.baseCells.empty());
    EXPECT_LT(last, until + 0.1);
  }
}

TEST(TimeRows, KeepsLanesAndOffsets)
{
  TimeRows rows(2, 3, 5);
  EXPECT_EQ(rows.lanes(), 8);
  const std::vector<double> points{ 1e9, 1e9 + 1, 1e9 + 2, 1e9 + 3, 1e9 + 4, 1e9 + 5 };
  const PositionFrame frame = positionFrame<double>(points.data(), nullptr, 2);
  EXPECT_DOUBLE_EQ(frame.scale, 1.0 / std::sqrt(27.0));
  for (int step = 0; step < 5; ++step)
  {
    const std::vector<double> added(6, step);
    rows.set<double>(step, points.data(), added.data(), frame.origin.data(), 1.0);
  }
  for (int step = 0; step < 5; ++step)
  {
    EXPECT_EQ(rows.at(0)[step], -1.5F + static_cast<float>(step));
    EXPECT_EQ(rows.at(1)[2 * 8 + step], 1.5F + static_cast<float>(step));
  }
  EXPECT_EQ(rows.at(0)[7], -1.5F) << "padding";
  EXPECT_TRUE(rows.isFinite(0));
  const std::vector<float> bad{ 0, 0, 0, 0, HUGE_VALF, 0 };
  const double none[3] = {};
  rows.set<float>(3, bad.data(), nullptr, none, 1.0);
  EXPECT_TRUE(rows.isFinite(0));
  EXPECT_FALSE(rows.isFinite(1));
}

} // namespace
} // namespace undecimate
