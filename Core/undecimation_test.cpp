// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimation.h"

#include "testing/decimated.h"
#include "testing/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::Mesh;

/// All that a cursor shows.
struct Level
{
  Index nodes;
  std::vector<Index> cells;
  std::vector<Index> sources;
  double error;

  explicit Level(const Undecimation& cursor)
    : nodes(cursor.nodeCount())
    , cells(cursor.cells(), cursor.cells() + std::size_t{ 3 } * cursor.cellCount())
    , error(cursor.error())
  {
    if (cursor.record().hasSources)
    {
      this->sources.assign(cursor.shownCells(), cursor.shownCells() + cursor.cellCount());
    }
  }
  bool operator==(const Level& other) const
  {
    return this->nodes == other.nodes && this->cells == other.cells &&
      this->sources == other.sources && this->error == other.error;
  }
};

struct Case
{
  const char* name;
  Mesh (*mesh)();
  Criterion criterion;
  bool sources;
};

Mesh mixture()
{
  Mesh mesh = testing::torus(10, 9);
  mesh.append(testing::disc(4, 11));
  mesh.append(testing::strip(20));
  mesh.append(testing::cube(3));
  std::mt19937 random(13);
  testing::flipEdges(mesh, random, false);
  return testing::shuffled(mesh, random);
}

Mesh field()
{
  std::mt19937 random(14);
  Mesh mesh = testing::hills(18, 15);
  testing::flipEdges(mesh, random, true);
  return testing::shuffled(mesh, random);
}

class UndecimationTest : public ::testing::TestWithParam<Case>
{
protected:
  UndecimationTest()
    : mesh(GetParam().mesh())
    , values(testing::valuesOn(mesh, [](double x, double y, double z) { return x + y * z; }))
    , decimated(mesh, options())
    , cursor(decimated.cursor)
  {
  }

  HashQueueDecimationOptions options() const
  {
    HashQueueDecimationOptions o;
    o.criterion = GetParam().criterion;
    o.targetReduction = 1.0;
    o.maximumError = HUGE_VAL;
    o.arrays = { testing::arrayOf(values) };
    o.trackCellSources = GetParam().sources;
    return o;
  }

  Mesh mesh;
  std::vector<float> values;
  Decimated decimated;
  Undecimation& cursor;
};

TEST_P(UndecimationTest, LevelZeroIsTheCoarsestAndLevelOneTheOriginal)
{
  ASSERT_GT(cursor.stepCount(), 30);
  EXPECT_EQ(cursor.steps(), 0);
  EXPECT_EQ(cursor.nodeCount(), decimated.result.record.baseNodeCount);
  EXPECT_EQ(Level(cursor).cells, decimated.result.baseTriangles);
  EXPECT_EQ(cursor.error(), static_cast<double>(decimated.result.record.stepErrors[0]));
  cursor.moveTo(cursor.stepCount());
  EXPECT_TRUE(testing::isOriginal(cursor, mesh));
  EXPECT_EQ(cursor.error(), 0.0);
}

TEST_P(UndecimationTest, ForthAndBackAndForth)
{
  const Level coarse(cursor);
  cursor.moveTo(cursor.stepCount());
  const Level fine(cursor);
  cursor.moveTo(0);
  EXPECT_TRUE(Level(cursor) == coarse);
  cursor.moveTo(cursor.stepCount());
  EXPECT_TRUE(Level(cursor) == fine);
  EXPECT_TRUE(testing::isOriginal(cursor, mesh));
}

// Every level is the same from wherever it is reached.
TEST_P(UndecimationTest, LevelsDoNotDependOnTheWay)
{
  std::vector<Level> levels;
  for (Index step = 0; step <= cursor.stepCount(); ++step)
  {
    cursor.moveTo(step);
    levels.emplace_back(cursor);
  }
  std::mt19937 random(15);
  for (int jump = 0; jump < 300; ++jump)
  {
    const Index step = static_cast<Index>(random() % static_cast<unsigned>(cursor.stepCount() + 1));
    cursor.moveTo(step);
    ASSERT_EQ(cursor.steps(), step);
    ASSERT_TRUE(Level(cursor) == levels[step]) << step;
  }
}

TEST_P(UndecimationTest, OneStepBringsOneNodeBack)
{
  Index cells = cursor.cellCount();
  for (Index step = 1; step <= cursor.stepCount(); ++step)
  {
    cursor.moveTo(step);
    ASSERT_EQ(cursor.nodeCount(), decimated.result.record.baseNodeCount + step);
    // An interior node comes with two triangles, a boundary node with one.
    ASSERT_GE(cursor.cellCount(), cells + 1);
    ASSERT_LE(cursor.cellCount(), cells + 2);
    cells = cursor.cellCount();
    // The level's nodes are the first ones, and each is used.
    const std::set<Index> nodes(cursor.cells(), cursor.cells() + std::size_t{ 3 } * cells);
    ASSERT_EQ(*nodes.rbegin(), cursor.nodeCount() - 1);
  }
}

TEST_P(UndecimationTest, MovesAreClamped)
{
  cursor.moveTo(-5);
  EXPECT_EQ(cursor.steps(), 0);
  cursor.moveTo(cursor.stepCount() + 5);
  EXPECT_EQ(cursor.steps(), cursor.stepCount());
  cursor.moveTo(std::numeric_limits<Index>::max());
  EXPECT_TRUE(testing::isOriginal(cursor, mesh));
  cursor.moveTo(std::numeric_limits<Index>::min());
  EXPECT_EQ(cursor.steps(), 0);
}

TEST_P(UndecimationTest, ErrorsNeverIncreaseWithTheLevel)
{
  double before = std::numeric_limits<double>::infinity();
  for (Index step = 0; step <= cursor.stepCount(); ++step)
  {
    cursor.moveTo(step);
    ASSERT_LE(cursor.error(), before);
    ASSERT_GE(cursor.error(), 0.0);
    before = cursor.error();
  }
}

TEST_P(UndecimationTest, StepsForLevel)
{
  const Index all = cursor.stepCount();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(cursor.stepsForLevel(0.0), 0);
  EXPECT_EQ(cursor.stepsForLevel(1.0), all);
  EXPECT_EQ(cursor.stepsForLevel(-0.0), 0);
  EXPECT_EQ(cursor.stepsForLevel(-3.0), 0);
  EXPECT_EQ(cursor.stepsForLevel(-infinity), 0);
  EXPECT_EQ(cursor.stepsForLevel(1.5), all);
  EXPECT_EQ(cursor.stepsForLevel(infinity), all);
  EXPECT_EQ(cursor.stepsForLevel(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(cursor.stepsForLevel(1e-300), 0);
  EXPECT_NEAR(cursor.stepsForLevel(0.5), 0.5 * all, 0.5);
  Index before = 0;
  for (int i = 0; i <= 1000; ++i)
  {
    const Index steps = cursor.stepsForLevel(i / 1000.0);
    ASSERT_GE(steps, before);
    ASSERT_LE(steps, all);
    before = steps;
  }
  for (Index step = 0; step <= all; ++step)
  {
    ASSERT_EQ(cursor.stepsForLevel(static_cast<double>(step) / all), step);
  }
}

// The fewest nodes that keep the error: one step less would exceed it.
TEST_P(UndecimationTest, StepsForError)
{
  const Index all = cursor.stepCount();
  EXPECT_EQ(cursor.stepsForError(1e30), 0);
  EXPECT_EQ(cursor.stepsForError(std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(cursor.stepsForError(-1.0), all);
  EXPECT_EQ(cursor.stepsForError(decimated.result.error), 0);
  std::vector<double> errors{ 0.0, 1e-12 };
  for (int i = 1; i < 50; ++i)
  {
    errors.push_back(decimated.result.error * i / 50.0);
  }
  for (const float error : decimated.result.record.stepErrors)
  {
    errors.push_back(error);
  }
  for (const double error : errors)
  {
    const Index steps = cursor.stepsForError(error);
    cursor.moveTo(steps);
    ASSERT_LE(cursor.error(), error);
    if (steps > 0)
    {
      cursor.moveTo(steps - 1);
      ASSERT_GT(cursor.error(), error);
    }
  }
  const Index nan = cursor.stepsForError(std::numeric_limits<double>::quiet_NaN());
  EXPECT_GE(nan, 0);
  EXPECT_LE(nan, all);
}

// At level 1 each cell shows its own values; below, those of a cell that exists.
TEST_P(UndecimationTest, SourcesReturnToThemselves)
{
  if (!GetParam().sources)
  {
    EXPECT_EQ(cursor.shownCells(), cursor.record().cellOrder);
    return;
  }
  cursor.moveTo(cursor.stepCount());
  for (int round = 0; round < 2; ++round)
  {
    ASSERT_TRUE(testing::isOriginal(cursor, mesh));
    cursor.moveTo(cursor.stepCount() / 3);
    for (Index slot = 0; slot < cursor.cellCount(); ++slot)
    {
      ASSERT_GE(cursor.shownCells()[slot], 0);
      ASSERT_LT(cursor.shownCells()[slot], mesh.triangleCount());
    }
    cursor.moveTo(0);
    cursor.moveTo(cursor.stepCount());
  }
}

TEST_P(UndecimationTest, OpenedAgainStartsAnew)
{
  cursor.moveTo(7);
  ASSERT_TRUE(cursor.open(decimated.result.record.view(), decimated.result.baseTriangles.data()));
  EXPECT_EQ(cursor.steps(), 0);
  EXPECT_EQ(Level(cursor).cells, decimated.result.baseTriangles);
}

INSTANTIATE_TEST_SUITE_P(Meshes, UndecimationTest,
  ::testing::Values(Case{ "MixtureDeviation", mixture, Criterion::Deviation, true },
    Case{ "MixtureWithoutSources", mixture, Criterion::Deviation, false },
    Case{ "FieldDeviation", field, Criterion::Deviation, true },
    Case{ "MixtureScalar", mixture, Criterion::ScalarDifference, true },
    Case{ "FieldScalar", field, Criterion::ScalarDifference, true },
    Case{ "FieldAngle", field, Criterion::AngleToXYPlane, false }),
  [](const ::testing::TestParamInfo<Case>& info) { return std::string(info.param.name); });

TEST(Undecimation, ClosedCursorShowsNothing)
{
  Undecimation cursor;
  EXPECT_EQ(cursor.stepCount(), 0);
  EXPECT_EQ(cursor.nodeCount(), 0);
  EXPECT_EQ(cursor.cellCount(), 0);
  EXPECT_EQ(cursor.error(), 0.0);
  cursor.moveTo(3);
  EXPECT_EQ(cursor.steps(), 0);
  EXPECT_EQ(cursor.stepsForLevel(0.5), 0);
  EXPECT_EQ(cursor.stepsForError(0.5), 0);
}

TEST(Undecimation, RefusedRecordClosesTheCursor)
{
  HashQueueDecimationOptions options;
  Decimated decimated(testing::torus(9, 9), options);
  Record damaged = decimated.result.record;
  damaged.stepHoles[0] = 0;
  decimated.cursor.moveTo(3);
  EXPECT_EQ(decimated.cursor.open(damaged.view(), decimated.result.baseTriangles.data()).status,
    Status::InvalidRecord);
  EXPECT_EQ(decimated.cursor.stepCount(), 0);
  EXPECT_EQ(decimated.cursor.cellCount(), 0);
}

// A strip is taken away triangle by triangle from its ends: each step is a corner with one triangle
// and lists its two nodes, which no new cell has.
TEST(Undecimation, CornersWithOneTriangle)
{
  //   1---3---5---7
  //  / \ / \ / \ /
  // 0---2---4---6
  const Mesh mesh = testing::strip(6);
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  Decimated decimated(mesh, options);
  ASSERT_GT(decimated.steps(), 0);
  decimated.cursor.moveTo(decimated.steps());
  EXPECT_TRUE(testing::isOriginal(decimated.cursor, mesh));
}

// ---------------------------------------------------------------------------------------------
// Progress and cancel
// ---------------------------------------------------------------------------------------------

class MonitoredUndecimation : public ::testing::Test
{
protected:
  MonitoredUndecimation()
    : mesh(testing::hills(250, 250))
    , coarse(mesh, options())
  {
  }

  static HashQueueDecimationOptions options()
  {
    HashQueueDecimationOptions options;
    options.criterion = Criterion::AngleToXYPlane;
    options.targetReduction = 0.99;
    options.trackCellSources = true;
    return options;
  }

  Outcome open(Undecimation& cursor, Monitor* monitor) const
  {
    return cursor.open(
      this->coarse.result.record.view(), this->coarse.result.baseTriangles.data(), monitor);
  }

  Level levelAt(Index steps)
  {
    this->coarse.cursor.moveTo(steps);
    return Level(this->coarse.cursor);
  }

  Mesh mesh;
  Decimated coarse;
};

TEST_F(MonitoredUndecimation, ProgressIncreasesToOne)
{
  std::vector<double> seen;
  Monitor monitor = testing::recording(seen);
  Undecimation cursor;
  const auto expectProgress = [&seen]
  {
    EXPECT_GE(seen.size(), 4U);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1.0);
    seen.clear();
  };
  ASSERT_TRUE(this->open(cursor, &monitor));
  expectProgress();
  for (const Index steps : { cursor.stepCount(), Index{ 0 } })
  {
    EXPECT_TRUE(cursor.moveTo(steps, &monitor));
    expectProgress();
    EXPECT_EQ(Level(cursor), this->levelAt(steps));
  }
}

TEST_F(MonitoredUndecimation, OpeningIsCancelledInEachOfItsParts)
{
  for (const double stop : { 0.01, 0.1, 0.2, 0.5, 0.9, 1.0 })
  {
    Monitor monitor([stop](double fraction) { return fraction < stop; });
    Undecimation cursor;
    EXPECT_EQ(this->open(cursor, &monitor).status, Status::Cancelled) << stop;
    EXPECT_EQ(cursor.stepCount(), 0) << "closed";
    EXPECT_TRUE(this->open(cursor, nullptr));
    EXPECT_EQ(Level(cursor), this->levelAt(0));
  }
}

TEST_F(MonitoredUndecimation, AMoveThatIsCancelledStandsAtAWholeLevel)
{
  Undecimation cursor;
  ASSERT_TRUE(this->open(cursor, nullptr));
  for (const double stop : { 0.0, 0.3, 0.6, 1.0 })
  {
    for (const Index goal : { cursor.stepCount(), Index{ 0 } })
    {
      Monitor monitor([stop](double fraction) { return fraction < stop; });
      EXPECT_FALSE(cursor.moveTo(goal, &monitor)) << stop;
      EXPECT_EQ(Level(cursor), this->levelAt(cursor.steps()));
      EXPECT_TRUE(cursor.moveTo(goal));
      EXPECT_EQ(Level(cursor), this->levelAt(goal));
    }
  }
}

TEST_F(MonitoredUndecimation, AThrowingCallbackCancels)
{
  Monitor monitor([](double) -> bool { throw std::runtime_error("no more"); });
  Undecimation cursor;
  const Outcome outcome = this->open(cursor, &monitor);
  EXPECT_EQ(outcome.status, Status::Cancelled);
  EXPECT_NE(outcome.message.find("no more"), std::string::npos);
  ASSERT_TRUE(this->open(cursor, nullptr));
  EXPECT_FALSE(cursor.moveTo(cursor.stepCount(), &monitor));
  EXPECT_EQ(Level(cursor), this->levelAt(cursor.steps()));
}

} // namespace
} // namespace undecimate
