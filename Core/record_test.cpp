// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record.h"

#include "hole_code.h"
#include "testing/decimated.h"
#include "testing/with_shapes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace undecimate
{
namespace
{

using testing::Decimated;
using testing::Mesh;

// ---------------------------------------------------------------------------------------------
// A record by hand
// ---------------------------------------------------------------------------------------------

//   3-------2        3-------2
//   | \ 2 / |        |     / |      Node 4 goes: slots 0 and 1 get (0, 1, 2) and (0, 2, 3), slots 2
//   |3  4  1|   ->   |   /   |      and 3 are free.
//   | / 0 \ |        | /     |
//   0-------1        0-------1      Then node 1 goes with slot 0: what is left is (0, 2, 3).
class SquareRecord : public ::testing::TestWithParam<bool>
{
protected:
  SquareRecord()
  {
    RecordBuilder builder(5, 4, GetParam());
    const Index ring[] = { 0, 1, 2, 3 };
    const Index slots[] = { 0, 1, 2, 3 };
    const unsigned char oldCells[] = { 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1 };
    const unsigned char newCells[] = { 1, 2, 3, 1, 3, 4 };
    const unsigned char sources[] = { 1, 3 };
    RecordBuilder::Step step;
    step.node = 4;
    step.ring = ring;
    step.ringSize = 4;
    step.oldCount = 4;
    step.newCount = 2;
    step.slots = slots;
    step.oldCells = oldCells;
    step.newCells = newCells;
    step.sources = sources;
    step.error = 0.5;
    builder.append(step);
    EXPECT_EQ(builder.stepCount(), 1);
    EXPECT_EQ(builder.error(), 0.5);

    const Index pair[] = { 2, 0 };
    const Index slot[] = { 0 };
    const unsigned char corner[] = { 2, 0, 1 }; // (0, 1, 2) as it stands in its slot
    step.node = 1;
    step.ring = pair;
    step.ringSize = 2;
    step.oldCount = 1;
    step.newCount = 0;
    step.slots = slot;
    step.oldCells = corner;
    step.newCells = nullptr;
    step.sources = nullptr;
    step.error = 0.25; // less than before: the record keeps the largest
    builder.append(step);
    EXPECT_EQ(builder.error(), 0.5);

    // As the steps left the slots; those that are free may hold anything.
    const Index cells[] = { 0, 1, 2, 0, 2, 3, 7, 7, 7, 7, 7, 7 };
    record = builder.finish(testing::cornersOf(cells), baseCells);
  }

  Record record;
  std::vector<Index> baseCells;
};

TEST_P(SquareRecord, IsInRecordOrder)
{
  EXPECT_EQ(record.nodeCount, 5);
  EXPECT_EQ(record.cellCount, 4);
  EXPECT_EQ(record.baseNodeCount, 3);
  EXPECT_EQ(record.baseCellCount, 1);
  EXPECT_EQ(record.cornersPerCell, 3);
  EXPECT_EQ(record.hasSources, GetParam());
  // The survivors in their order, then the nodes as they come back: 1, then 4.
  EXPECT_EQ(record.nodeOrder, (std::vector<Index>{ 0, 2, 3, 1, 4 }));
  EXPECT_EQ(record.cellOrder, (std::vector<Index>{ 1, 0, 2, 3 }));
  EXPECT_EQ(baseCells, (std::vector<Index>{ 0, 1, 2 })); // (0, 2, 3) in record order
  EXPECT_EQ(record.stepErrors, (std::vector<float>{ 0.5F, 0.5F }));
  // Step 0 lists the nodes 0 and 2 of its old cell, in the order of its corners; step 1 its slots.
  EXPECT_EQ(record.patches, (std::vector<Index>{ 0, 1, /**/ 1, 0 }));
  EXPECT_EQ(record.shapeOffsets.size(), 3U);
  if (GetParam())
  {
    EXPECT_EQ(record.baseSources, (std::vector<Index>{ 3 }));
    EXPECT_EQ(record.lostSources, (std::vector<Index>{ 1, /**/ 0, 2 }));
  }
  const RecordView view = record.view();
  EXPECT_EQ(view.stepCount, 2);
  EXPECT_EQ(view.shapeCount, 2);
  EXPECT_EQ(view.patchSize, 4);
}

TEST_P(SquareRecord, BringsBothNodesBack)
{
  Undecimation cursor;
  ASSERT_TRUE(cursor.open(record.view(), baseCells.data()));
  EXPECT_EQ(testing::originalNumbers(cursor), (std::vector<Index>{ 0, 2, 3 }));
  cursor.moveTo(1);
  EXPECT_EQ(testing::originalNumbers(cursor), (std::vector<Index>{ 0, 2, 3, 0, 1, 2 }));
  cursor.moveTo(2);
  EXPECT_EQ(
    testing::originalNumbers(cursor), (std::vector<Index>{ 4, 1, 2, 4, 0, 1, 4, 2, 3, 4, 3, 0 }));
  if (GetParam())
  {
    EXPECT_EQ(std::vector<Index>(cursor.shownCells(), cursor.shownCells() + 4),
      (std::vector<Index>{ 1, 0, 2, 3 }));
    cursor.moveTo(1);
    EXPECT_EQ(std::vector<Index>(cursor.shownCells(), cursor.shownCells() + 2),
      (std::vector<Index>{ 3, 1 }));
  }
  else
  {
    EXPECT_EQ(cursor.shownCells(), record.cellOrder.data());
  }
}

INSTANTIATE_TEST_SUITE_P(Sources, SquareRecord, ::testing::Bool());

TEST(RecordBuilder, NoStepsLeaveTheMeshAsItIs)
{
  const Mesh mesh = testing::tetrahedron();
  RecordBuilder builder(4, 4, true);
  EXPECT_EQ(builder.stepCount(), 0);
  EXPECT_EQ(builder.error(), 0.0);
  std::vector<Index> baseCells;
  const Record record = builder.finish(testing::cornersOf(mesh.triangles.data()), baseCells);
  EXPECT_EQ(baseCells, mesh.triangles);
  Undecimation cursor;
  ASSERT_TRUE(cursor.open(record.view(), baseCells.data()));
  EXPECT_TRUE(testing::isOriginal(cursor, mesh));
  EXPECT_EQ(cursor.error(), 0.0);
}

TEST(RecordBuilder, NoMeshAtAll)
{
  RecordBuilder builder(0, 0, false);
  std::vector<Index> baseCells;
  const Record record = builder.finish(testing::cornersOf(nullptr), baseCells);
  EXPECT_TRUE(validateRecord(record.view(), baseCells.data()));
}

// Equal patches share a shape, whatever the numbers of their nodes.
TEST(RecordBuilder, EqualShapesAreStoredOnce)
{
  const Mesh mesh = testing::flatGrid(60, 60);
  HashQueueDecimationOptions options;
  options.criterion = Criterion::AngleToXYPlane;
  const Decimated decimated(mesh, options);
  ASSERT_GT(decimated.steps(), 2000);
  std::vector<Index> base;
  const Record record =
    testing::withShapes(decimated.result.record, decimated.result.baseTriangles, base);
  EXPECT_LT(record.view().shapeCount, decimated.steps() / 2);
}

// Both ways to keep the forms of steps show the same levels.
TEST(Record, ShapesSayWhatCodesSay)
{
  Mesh mesh = testing::hills(40, 30);
  mesh.append(testing::torus(20, 12));
  mesh.append(testing::strip(30));
  for (const Criterion criterion : { Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    for (const bool sources : { false, true })
    {
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      options.targetReduction = 1.0;
      options.trackCellSources = sources;
      const Decimated decimated(mesh, options);
      ASSERT_GT(decimated.steps(), 500);
      ASSERT_TRUE(decimated.result.record.hasCodes);
      std::vector<Index> base;
      const Record record =
        testing::withShapes(decimated.result.record, decimated.result.baseTriangles, base);
      EXPECT_FALSE(record.hasCodes);
      testing::expectSameLevels(
        decimated.result.record, decimated.result.baseTriangles, record, base, decimated.steps());
    }
  }
}

// The bound of the record's size in the documentation, and what byteSize() counts.
TEST(Record, SizeIsBounded)
{
  const Mesh grid = testing::hills(110, 110);
  const Mesh ring = testing::torus(120, 100);
  const std::vector<float> values =
    testing::valuesOn(grid, [](double x, double y, double) { return std::sin(0.1 * x) * y; });
  for (const Criterion criterion : { Criterion::Deviation, Criterion::ScalarDifference,
         Criterion::AngleToXYPlane, Criterion::Quadric })
  {
    for (const Mesh* mesh : { &grid, &ring })
    {
      if (mesh == &ring && criterion == Criterion::ScalarDifference)
      {
        continue; // the values are those of the grid
      }
      SCOPED_TRACE(static_cast<int>(criterion));
      HashQueueDecimationOptions options;
      options.criterion = criterion;
      if (criterion == Criterion::ScalarDifference)
      {
        options.arrays = { testing::arrayOf(values) };
      }
      options.targetReduction = 0.99;
      const Decimated decimated(*mesh, options);
      const Record& record = decimated.result.record;
      ASSERT_GT(decimated.steps(), 5000);
      const double bound = criterion == Criterion::AngleToXYPlane ? 45.0 : 31.0;
      EXPECT_LE(record.byteSize(), bound * decimated.steps());
      EXPECT_EQ(record.byteSize(),
        4 *
            (record.nodeOrder.size() + record.cellOrder.size() + record.stepErrors.size() +
              record.patches.size() + record.baseSources.size() + record.lostSources.size() +
              record.stepShapes.size() + record.shapeOffsets.size()) +
          record.stepHoles.size() + record.codes.size() + record.shapes.size() +
          record.lostSourceCodes.size());
    }
  }
}

// ---------------------------------------------------------------------------------------------
// Damaged records
// ---------------------------------------------------------------------------------------------

/// A valid record, the arrays of which may be spoilt.
struct Spoilable
{
  Record record;
  std::vector<Index> baseCells;

  /// The record may be refused. If not, walking it must be safe: the sanitizers watch the arrays,
  /// and every corner must be a node of its level.
  bool refusedOrSafe() const
  {
    Undecimation cursor;
    const Outcome outcome = cursor.open(this->record.view(), this->baseCells.data());
    if (!outcome)
    {
      EXPECT_EQ(outcome.status, Status::InvalidRecord);
      EXPECT_FALSE(outcome.message.empty());
      EXPECT_EQ(cursor.stepCount(), 0);
      return true;
    }
    for (const Index steps : { cursor.stepCount(), Index{ 0 }, cursor.stepCount() / 2,
           cursor.stepCount() / 3, cursor.stepCount() })
    {
      cursor.moveTo(steps);
      const Index* cells = cursor.cells();
      for (std::size_t i = 0; i < std::size_t{ 3 } * cursor.cellCount(); ++i)
      {
        if (cells[i] < 0 || cells[i] >= cursor.nodeCount())
        {
          return false;
        }
      }
      const Index* sources = cursor.shownCells();
      for (Index i = 0; sources && i < cursor.cellCount(); ++i)
      {
        if (sources[i] < 0 || sources[i] >= this->record.cellCount)
        {
          return false;
        }
      }
      if (cursor.cellCount() > this->record.cellCount)
      {
        return false;
      }
    }
    return true;
  }
};

enum class Form
{
  Codes,
  Shapes
};

/// How the steps are kept, and whether sources are.
struct Setting
{
  Form form;
  bool sources;
};

Spoilable spoilable(Setting setting)
{
  std::mt19937 random(11);
  Mesh mesh = testing::disc(4, 9);
  testing::flipEdges(mesh, random, false);
  mesh.append(testing::torus(7, 6));
  mesh.append(testing::strip(12)); // its corners have one triangle: steps with extra nodes only
  HashQueueDecimationOptions options;
  options.targetReduction = 1.0;
  options.trackCellSources = setting.sources;
  Decimated decimated(mesh, options);
  EXPECT_GT(decimated.steps(), 40);
  if (setting.form == Form::Shapes)
  {
    Spoilable shapes;
    shapes.record = testing::withShapes(
      decimated.result.record, decimated.result.baseTriangles, shapes.baseCells);
    return shapes;
  }
  return { std::move(decimated.result.record), std::move(decimated.result.baseTriangles) };
}

class DamagedRecord : public ::testing::TestWithParam<Setting>
{
protected:
  DamagedRecord()
    : valid(spoilable(GetParam()))
    , spoilt(valid)
  {
  }

  template <typename T>
  T anyValue(const std::vector<T>& array, T old)
  {
    static const Index kOdd[] = { -1, 0, 1, 2, 3, 63, 64, 65, 127, 128, 255, 256, 1 << 16,
      std::numeric_limits<Index>::max(), std::numeric_limits<Index>::min() };
    switch (random() % 5)
    {
      case 0:
        return static_cast<T>(kOdd[random() % (sizeof(kOdd) / sizeof(kOdd[0]))]);
      case 1:
        return static_cast<T>(old + 1);
      case 2:
        return static_cast<T>(old - 1);
      case 3:
        return array[random() % array.size()];
      default:
        return static_cast<T>(random());
    }
  }

  template <typename T>
  void fuzz(std::vector<T>& array, const std::vector<T>& good, const char* name, int rounds)
  {
    if (array.empty())
    {
      return;
    }
    for (int round = 0; round < rounds; ++round)
    {
      const std::size_t entry = random() % array.size();
      array[entry] = this->anyValue(good, good[entry]);
      ASSERT_TRUE(spoilt.refusedOrSafe()) << name << "[" << entry << "] = " << +array[entry];
      array[entry] = good[entry];
    }
  }

  std::mt19937 random{ 12 };
  Spoilable valid;
  Spoilable spoilt;
};

TEST_P(DamagedRecord, AnyEntryOfAnyArray)
{
  constexpr int kRounds = 600;
  fuzz(spoilt.record.nodeOrder, valid.record.nodeOrder, "nodeOrder", kRounds / 4);
  fuzz(spoilt.record.cellOrder, valid.record.cellOrder, "cellOrder", kRounds / 4);
  fuzz(spoilt.record.stepHoles, valid.record.stepHoles, "stepHoles", kRounds);
  fuzz(spoilt.record.codes, valid.record.codes, "codes", 4 * kRounds);
  fuzz(spoilt.record.stepShapes, valid.record.stepShapes, "stepShapes", kRounds);
  fuzz(spoilt.record.patches, valid.record.patches, "patches", 2 * kRounds);
  if (GetParam().form == Form::Shapes)
  {
    fuzz(spoilt.record.shapeOffsets, valid.record.shapeOffsets, "shapeOffsets", kRounds);
  }
  fuzz(spoilt.record.shapes, valid.record.shapes, "shapes", 4 * kRounds);
  fuzz(spoilt.record.baseSources, valid.record.baseSources, "baseSources", kRounds / 4);
  fuzz(spoilt.record.lostSources, valid.record.lostSources, "lostSources", kRounds / 4);
  fuzz(spoilt.record.lostSourceCodes, valid.record.lostSourceCodes, "lostSourceCodes", 4 * kRounds);
  fuzz(spoilt.baseCells, valid.baseCells, "baseCells", kRounds / 2);
  ASSERT_TRUE(spoilt.refusedOrSafe());
}

TEST_P(DamagedRecord, ManyEntriesAtOnce)
{
  for (int round = 0; round < 3000; ++round)
  {
    const int spoils = 2 + static_cast<int>(random() % 4);
    for (int i = 0; i < spoils; ++i)
    {
      Record& r = spoilt.record;
      const auto spoil = [&](auto& array)
      {
        if (!array.empty())
        {
          auto& entry = array[random() % array.size()];
          entry = this->anyValue(array, entry);
        }
      };
      switch (random() % 5)
      {
        case 0:
          spoil(r.stepShapes);
          spoil(r.stepHoles);
          break;
        case 1:
          spoil(r.patches);
          spoil(r.codes);
          break;
        case 2:
          spoil(r.shapes);
          spoil(r.codes);
          break;
        case 3:
          spoil(r.lostSources);
          spoil(r.lostSourceCodes);
          break;
        default:
          spoil(spoilt.baseCells);
          break;
      }
    }
    ASSERT_TRUE(spoilt.refusedOrSafe()) << "round " << round;
    spoilt = valid;
  }
}

// What must be refused, and with the name of the array.
TEST_P(DamagedRecord, NamesWhatIsWrong)
{
  const auto expectRefused = [&](const char* name)
  {
    const Outcome outcome = validateRecord(spoilt.record.view(), spoilt.baseCells.data());
    EXPECT_EQ(outcome.status, Status::InvalidRecord) << name;
    EXPECT_NE(outcome.message.find(name), std::string::npos) << outcome.message;
    spoilt = valid;
  };
  Record& r = spoilt.record;
  ASSERT_TRUE(validateRecord(r.view(), spoilt.baseCells.data()));
  r.nodeOrder[3] = r.nodeOrder[4];
  expectRefused("NodeOrder");
  r.nodeOrder[3] = -1;
  expectRefused("NodeOrder");
  if (r.cellOrder.empty())
  {
    EXPECT_TRUE(r.view().stepsOrderCells());
  }
  else
  {
    r.cellOrder[0] = r.cellCount;
    expectRefused("CellOrder");
    r.cellOrder[0] = r.cellOrder[1];
    expectRefused("CellOrder");
  }
  if (GetParam().form == Form::Shapes)
  {
    r.stepShapes[1] = static_cast<Index>(r.shapeOffsets.size()) - 1;
    expectRefused("StepShapes");
    r.stepShapes[1] = -1;
    expectRefused("StepShapes");
    r.shapeOffsets[0] = 1;
    expectRefused("ShapeOffsets");
    r.shapeOffsets[1] = r.shapeOffsets[2] + 1;
    expectRefused("Shape");
    r.shapes[0] = static_cast<unsigned char>(kMaximumPatchCells + 1);
    expectRefused("Shapes");
  }
  else
  {
    for (const int hole : { 0, 1, 2, kMaximumPatchCells + 1, kOpenHole + 0, 255 })
    {
      r.stepHoles[1] = static_cast<unsigned char>(hole);
      expectRefused("StepHoles");
    }
    r.codes[0] |= 3; // the corner of the first triangle
    expectRefused("HoleCodes");
    r.codes.pop_back();
    expectRefused("HoleCodes");
    r.codes.push_back(0);
    expectRefused("HoleCodes");
    const HoleCounts& last = kHoles[r.stepHoles.back()];
    ASSERT_GT(last.newCount, 1); // the first ear twice
    const bool sources = GetParam().sources;
    const int bits = r.view().numberBits();
    const int size = last.codeSize(sources, bits);
    const auto expectRefusedWith = [&](const std::vector<int>& ears, const std::vector<int>& slots)
    {
      std::vector<unsigned char> bytes(size);
      unsigned char* end = r.codes.data() + r.codes.size() - kPackedPadding;
      const HoleCode good(last, end - size, sources, bits);
      BitWriter writer(bytes.data());
      for (int i = 0; i < last.oldCount; ++i)
      {
        writer.add(good.corner(i), 2);
      }
      for (int i = 0; i < last.newCount; ++i)
      {
        writer.add(i < static_cast<int>(ears.size()) ? ears[i] : good.ear(i), last.placeBits);
      }
      for (int i = 0; sources && i < last.newCount; ++i)
      {
        writer.add(good.source(i), last.placeBits);
      }
      for (int i = 0; i < last.newCount; ++i)
      {
        writer.add(i < static_cast<int>(slots.size()) ? slots[i] : good.number(i), bits);
      }
      writer.finish();
      std::copy(bytes.begin(), bytes.end(), end - size);
      expectRefused("HoleCodes");
    };
    const unsigned char* end = r.codes.data() + r.codes.size() - kPackedPadding;
    const HoleCode good(last, end - size, sources, bits);
    expectRefusedWith({ good.ear(1) }, {});
    expectRefusedWith({}, { good.number(1) });
    // The last slots come with the last step.
    expectRefusedWith({}, { r.cellCount - 1 });
    expectRefusedWith({}, { (1 << bits) - 1 });
  }
  r.stepErrors[1] = r.stepErrors[0] * 2.0F + 1.0F;
  expectRefused("StepErrors");
  r.stepErrors[0] = std::numeric_limits<float>::quiet_NaN();
  expectRefused("StepErrors");
  r.stepErrors.back() = -1.0F;
  expectRefused("StepErrors");
  if (GetParam().form == Form::Shapes)
  {
    r.patches[0] = -1;
    expectRefused("Patches");
    r.patches[0] = r.cellCount;
    expectRefused("Patches");
    r.patches.pop_back();
    expectRefused("Patches");
    r.patches.push_back(0);
    expectRefused("Patches");
  }
  spoilt.baseCells[0] = r.baseNodeCount;
  expectRefused("coarse");
  if (GetParam().sources)
  {
    r.baseSources[0] = r.cellCount;
    expectRefused("BaseSources");
    if (GetParam().form == Form::Shapes)
    {
      r.lostSources[0] = -1;
      expectRefused("LostSources");
      r.lostSources.push_back(0);
      expectRefused("LostSources");
      return;
    }
    // The codes are told when they are walked.
    const auto expectRefusedByCursor = [&]
    {
      Undecimation cursor;
      const Outcome outcome = cursor.open(r.view(), spoilt.baseCells.data());
      EXPECT_EQ(outcome.status, Status::InvalidRecord);
      EXPECT_NE(outcome.message.find("LostSources"), std::string::npos) << outcome.message;
      spoilt = valid;
    };
    r.lostSourceCodes.pop_back();
    expectRefusedByCursor();
    r.lostSourceCodes.push_back(0);
    expectRefusedByCursor();
    r.lostSourceCodes.assign(kPackedPadding, 0);
    expectRefusedByCursor();
    // Another original cell, or the place of another old one.
    r.lostSourceCodes[0] ^= 2;
    expectRefusedByCursor();
  }
}

TEST_P(DamagedRecord, CountsThatContradictEachOther)
{
  const RecordView good = valid.record.view();
  const auto expectRefused = [&](const RecordView& view)
  { EXPECT_EQ(validateRecord(view, valid.baseCells.data()).status, Status::InvalidRecord); };
  RecordView view = good;
  view.nodeCount = -1;
  expectRefused(view);
  view = good;
  view.cellCount = good.baseCellCount - 1;
  expectRefused(view);
  view = good;
  view.stepCount -= 1;
  expectRefused(view);
  view = good;
  view.baseNodeCount += 1;
  expectRefused(view);
  view = good;
  view.baseCellCount = -1;
  expectRefused(view);
  view = good;
  view.cornersPerCell = 4;
  expectRefused(view);
  view = good;
  view.patchSize = -1;
  expectRefused(view);
  view = good;
  view.patchSize -= 1;
  if (GetParam().form == Form::Shapes)
  {
    expectRefused(view);
  }
  view = good;
  view.shapeCount = -1;
  expectRefused(view);
  view = good;
  view.shapeCount = 0;
  if (GetParam().form == Form::Shapes)
  {
    expectRefused(view);
  }
  for (const std::int64_t size : { std::int64_t{ -1 }, std::int64_t{ 0 }, good.codeSize - 1 })
  {
    view = good;
    view.codeSize = size;
    if (GetParam().form == Form::Codes)
    {
      expectRefused(view);
    }
  }
  for (const std::int64_t size : { std::numeric_limits<std::int64_t>::min(), std::int64_t{ -1 },
         std::int64_t{ 6 }, std::numeric_limits<std::int64_t>::max() })
  {
    view = good;
    view.lostCodeSize = size;
    if (view.stepsOrderCells())
    {
      expectRefused(view);
    }
  }
  view = good;
  view.lostSourceSize -= 1;
  if (GetParam().sources && GetParam().form == Form::Shapes)
  {
    expectRefused(view);
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, DamagedRecord,
  ::testing::Values(Setting{ Form::Codes, false }, Setting{ Form::Codes, true },
    Setting{ Form::Shapes, false }, Setting{ Form::Shapes, true }));

// Codes of lost sources that could be read but that nobody writes: going back would not find them.
TEST(LostSources, OnlyWhatIsWrittenIsTaken)
{
  HashQueueDecimationOptions options;
  options.targetReduction = 0.8;
  options.trackCellSources = true;
  const Decimated decimated(testing::hills(12, 12), options);
  const Record& good = decimated.result.record;
  const std::vector<Index>& base = decimated.result.baseTriangles;
  const int bits = good.view().numberBits();
  const HoleCounts& hole = kHoles[good.stepHoles[0]];
  const HoleCode code(hole, good.codes.data(), true, bits);
  ASSERT_GT(hole.newCount, 1);
  const KnownSources known(hole.newCount, hole.oldCount, [&code](int i) { return code.source(i); });
  int lost = 0;
  while (known.has(lost))
  {
    ++lost;
  }
  ASSERT_LT(lost, hole.oldCount);

  const auto refusal = [&base](const Record& record)
  {
    Undecimation cursor;
    const Outcome outcome = cursor.open(record.view(), base.data());
    EXPECT_EQ(outcome.status, outcome ? Status::Ok : Status::InvalidRecord);
    return outcome.message;
  };
  EXPECT_EQ(refusal(good), "");
  // The first code of all, in another way.
  const auto withFirst = [&](bool isPlace, Index value)
  {
    const unsigned char* bytes = good.lostSourceCodes.data();
    const std::int64_t end =
      8 * (static_cast<std::int64_t>(good.lostSourceCodes.size()) - kPackedPadding);
    const bool wasPlace = packedBits(bytes, 0, 1) != 0;
    Record record = good;
    record.lostSourceCodes.assign(packedSize(end + 64), 0);
    BitWriter writer(record.lostSourceCodes.data());
    writer.add(isPlace ? 1 : 0, 1);
    writer.add(value, isPlace ? hole.placeBits : bits);
    for (std::int64_t bit = 1 + (wasPlace ? hole.placeBits : bits); bit < end; ++bit)
    {
      writer.add(packedBits(bytes, bit, 1), 1);
    }
    writer.finish();
    return record;
  };
  const auto expectUnfit = [&](const Record& record)
  {
    EXPECT_NE(refusal(record).find("step 0 does not fit the values"), std::string::npos)
      << refusal(record);
  };
  expectUnfit(withFirst(false, good.baseSources[code.number(0)])); // there is a place for it
  expectUnfit(withFirst(false, good.cellCount));
  expectUnfit(withFirst(true, lost)); // not known yet
  expectUnfit(withFirst(true, (1 << hole.placeBits) - 1));

  // Two heirs of one source that show different cells.
  const auto shown = [&](int i) { return good.baseSources[code.number(i)]; };
  int other = 1;
  while (other + 1 < hole.newCount && shown(other) == shown(0))
  {
    ++other;
  }
  ASSERT_NE(shown(other), shown(0));
  Record record = good;
  BitWriter writer(record.codes.data());
  for (int i = 0; i < hole.oldCount; ++i)
  {
    writer.add(code.corner(i), 2);
  }
  for (int i = 0; i < hole.newCount; ++i)
  {
    writer.add(code.ear(i), hole.placeBits);
  }
  for (int i = 0; i < hole.newCount; ++i)
  {
    writer.add(code.source(0), hole.placeBits);
  }
  for (int i = 0; i < hole.newCount; ++i)
  {
    writer.add(code.number(i), bits);
  }
  writer.finish();
  expectUnfit(record);

  // Nothing is wrong but the length.
  record = good;
  record.lostSourceCodes.push_back(0);
  EXPECT_NE(refusal(record).find("too long"), std::string::npos) << refusal(record);
  record = good;
  const std::int64_t gone = static_cast<std::int64_t>(good.lostSourceCodes.size());
  ASSERT_GT(gone, 2 * kPackedPadding);
  record.lostSourceCodes.resize(gone / 2);
  EXPECT_NE(refusal(record).find("does not fit the values"), std::string::npos);
}

// Without steps nothing but the sources themselves says that they are wrong.
TEST(LostSources, AtLevelOneEachCellShowsItsOwn)
{
  HashQueueDecimationOptions options;
  options.targetReduction = 0.0;
  options.trackCellSources = true;
  const Decimated decimated(testing::hills(6, 6), options);
  ASSERT_EQ(decimated.steps(), 0);
  Record record = decimated.result.record;
  Undecimation cursor;
  ASSERT_TRUE(cursor.open(record.view(), decimated.result.baseTriangles.data()));
  record.baseSources[0] = record.baseSources[1];
  const Outcome outcome = cursor.open(record.view(), decimated.result.baseTriangles.data());
  EXPECT_EQ(outcome.status, Status::InvalidRecord);
  EXPECT_NE(outcome.message.find("at level 1"), std::string::npos) << outcome.message;
}

TEST(RecordView, MissingArraysAreRefused)
{
  EXPECT_EQ(validateRecord(RecordView(), nullptr).status, Status::InvalidRecord);
  for (const Form form : { Form::Codes, Form::Shapes })
  {
    const Spoilable valid = spoilable({ form, true });
    const RecordView good = valid.record.view();
    ASSERT_TRUE(validateRecord(good, valid.baseCells.data()));
    const auto expectMissing = [&](auto array, const char* name)
    {
      RecordView view = good;
      view.*array = nullptr;
      const Outcome outcome = validateRecord(view, valid.baseCells.data());
      EXPECT_EQ(outcome.status, Status::InvalidRecord);
      EXPECT_NE(outcome.message.find(name), std::string::npos) << outcome.message;
    };
    expectMissing(&RecordView::nodeOrder, "NodeOrder");
    expectMissing(&RecordView::stepErrors, "StepErrors");
    expectMissing(&RecordView::baseSources, "BaseSources");
    if (form == Form::Codes)
    {
      expectMissing(&RecordView::stepHoles, "StepHoles");
      expectMissing(&RecordView::codes, "HoleCodes");
      expectMissing(&RecordView::lostSourceCodes, "LostSources");
    }
    else
    {
      expectMissing(&RecordView::cellOrder, "CellOrder");
      expectMissing(&RecordView::lostSources, "LostSources");
      expectMissing(&RecordView::patches, "Patches");
      expectMissing(&RecordView::stepShapes, "StepShapes");
      expectMissing(&RecordView::shapeOffsets, "ShapeOffsets");
      expectMissing(&RecordView::shapes, "Shapes");
    }
    EXPECT_EQ(validateRecord(good, nullptr).status, Status::InvalidRecord);
  }
}

} // namespace
} // namespace undecimate
