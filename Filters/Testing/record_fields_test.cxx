// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// The record as field data: it survives files, and damage of any kind is refused and never a crash.

#include "filterTesting.h"

#include "undecimateRecordFields.h"
#include "vtkUndecimation.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <random>
#include <string>
#include <vector>

using namespace filter_testing;
using namespace undecimate::filters;

namespace
{

vtkSmartPointer<vtkPolyData> smallRecord()
{
  MeshOptions options;
  options.rows = 7;
  options.vertsAndLines = true;
  return decimated(makeGrid(options), 0.8);
}

// Written by Undecimate before there were codes: a grid of 81 nodes with one nodal array and one of
// its cells, decimated by Angle to XY Plane; "original", "coarse", and "half" at level 0.5.
vtkSmartPointer<vtkPolyData> storedVersion1(const char* name)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(
    (std::string(UNDECIMATE_FILTER_TEST_DIR "/version1/") + name + ".vtp").c_str());
  reader->Update();
  EXPECT_GT(reader->GetOutput()->GetNumberOfPoints(), 0) << name;
  return reader->GetOutput();
}

std::int64_t* header(vtkPolyData* mesh)
{
  return static_cast<std::int64_t*>(
    mesh->GetFieldData()->GetAbstractArray("Undecimation.Header")->GetVoidPointer(0));
}

void sign(vtkPolyData* mesh)
{
  header(mesh)[kChecksum] = recordChecksum(header(mesh), mesh->GetFieldData());
}

vtkSmartPointer<vtkPolyData> throughFile(vtkPolyData* mesh, int mode, int compressor, int idType)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  writer->WriteToOutputStringOn();
  writer->SetDataMode(mode);
  writer->SetCompressorType(compressor);
  writer->SetIdType(idType);
  EXPECT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  return reader->GetOutput();
}

// VTK 9.2 cannot read back its own appended data with an expat that delays its callbacks (from 2.6,
// and Debian 12's since 2.5.0-1+deb12u5). Then no file of that mode can be tested, ours or another.
std::vector<int> readableModes()
{
  std::vector<int> modes = { vtkXMLWriter::Ascii, vtkXMLWriter::Binary };
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  vtkSmartPointer<vtkPolyData> loaded =
    throughFile(mesh, vtkXMLWriter::Appended, vtkXMLWriter::ZLIB, vtkXMLWriter::Int64);
  if (loaded->GetNumberOfPoints() == mesh->GetNumberOfPoints())
  {
    modes.push_back(vtkXMLWriter::Appended);
  }
  else
  {
    std::cout << "This VTK does not read appended data: that mode is left out.\n";
  }
  return modes;
}

TEST(RecordFields, SurviveFilesOfAllModes)
{
  const std::vector<int> modes = readableModes();
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    MeshOptions options;
    options.vertsAndLines = true;
    options.pointType = type;
    vtkSmartPointer<vtkPolyData> mesh = makeGrid(options);
    vtkSmartPointer<vtkPolyData> coarse = decimated(mesh);
    vtkSmartPointer<vtkPolyData> middle = undecimated(coarse, 0.4);
    for (const int mode : modes)
    {
      for (const int compressor : { vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4 })
      {
        vtkSmartPointer<vtkPolyData> loaded =
          throughFile(coarse, mode, compressor, vtkXMLWriter::Int64);
        EXPECT_EQ(differences(undecimated(loaded, 1.0), mesh, /*fileTypes=*/true), "")
          << "mode " << mode << " compressor " << compressor;
        EXPECT_EQ(differences(undecimated(loaded, 0.4), middle, /*fileTypes=*/true), "")
          << "mode " << mode << " compressor " << compressor;
      }
    }
  }
}

// Such a file stores arrays of vtkIdType in 32 bits, and they come back with another type.
TEST(RecordFields, SurviveFilesWithShortIdsUnlessAnArrayIsCut)
{
  vtkSmartPointer<vtkPolyData> mesh = makeGrid();
  const std::string error = undecimationError(
    throughFile(decimated(mesh), vtkXMLWriter::Binary, vtkXMLWriter::ZLIB, vtkXMLWriter::Int32));
  EXPECT_NE(error.find("is damaged"), std::string::npos) << error;

  mesh->GetPointData()->RemoveArray("ids");
  vtkSmartPointer<vtkPolyData> loaded =
    throughFile(decimated(mesh), vtkXMLWriter::Binary, vtkXMLWriter::ZLIB, vtkXMLWriter::Int32);
  EXPECT_EQ(differences(undecimated(loaded, 1.0), mesh, /*fileTypes=*/true), "");
}

TEST(RecordFields, AMeshThatWasChangedInAFileIsRefused)
{
  vtkSmartPointer<vtkPolyData> coarse = smallRecord();
  coarse->GetPointData()->GetArray("scalar")->SetComponent(0, 0, 17.0);
  const std::string error = undecimationError(
    throughFile(coarse, vtkXMLWriter::Binary, vtkXMLWriter::ZLIB, vtkXMLWriter::Int64));
  EXPECT_NE(error.find("point array 'scalar'"), std::string::npos) << error;
}

TEST(RecordFields, FilesOfVersion1AreRead)
{
  vtkSmartPointer<vtkPolyData> coarse = storedVersion1("coarse");
  ASSERT_EQ(header(coarse)[kVersion], 1);
  ASSERT_EQ(header(coarse)[kHasSources], 1);
  EXPECT_EQ(
    differences(undecimated(coarse, 1.0), storedVersion1("original"), /*fileTypes=*/true), "");
  EXPECT_EQ(differences(undecimated(coarse, 0.5), storedVersion1("half"), /*fileTypes=*/true), "");
}

TEST(RecordFields, TrianglesAreWrittenInVersion3)
{
  EXPECT_EQ(header(smallRecord())[kVersion], 3);
}

TEST(RecordFields, ANewerVersionIsRefused)
{
  vtkSmartPointer<vtkPolyData> coarse = smallRecord();
  header(coarse)[kVersion] = 4;
  const std::string error = undecimationError(coarse);
  EXPECT_NE(error.find("format version 4"), std::string::npos) << error;
  EXPECT_NE(error.find("Update Undecimate"), std::string::npos) << error;
}

TEST(RecordFields, AVersionThatNeverWasIsRefused)
{
  for (const std::int64_t version : { 0, -3 })
  {
    vtkSmartPointer<vtkPolyData> coarse = smallRecord();
    header(coarse)[kVersion] = version;
    sign(coarse);
    const std::string error = undecimationError(coarse);
    EXPECT_NE(error.find("is damaged"), std::string::npos) << error;
  }
}

TEST(RecordFields, AHeaderOfAnotherTypeOrLengthIsRefused)
{
  vtkSmartPointer<vtkPolyData> coarse = smallRecord();
  vtkFieldData* fields = coarse->GetFieldData();
  vtkSmartPointer<vtkAbstractArray> original = fields->GetAbstractArray("Undecimation.Header");
  for (const int type : { VTK_DOUBLE, VTK_INT, VTK_STRING, VTK_BIT, VTK_LONG_LONG })
  {
    for (const int size : { 0, 1, kHeaderSize - 1, kHeaderSize + 1 })
    {
      auto other = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
      other->SetName("Undecimation.Header");
      other->SetNumberOfTuples(size);
      for (int i = 0; i < size; ++i)
      {
        other->SetVariantValue(i, 1);
      }
      fields->AddArray(other);
      const std::string error = undecimationError(coarse);
      EXPECT_NE(error.find("is damaged"), std::string::npos) << error;
    }
  }
  fields->AddArray(original);
  undecimated(coarse, 0.5);
}

// A byte that flips is found by the checksum, wherever it is.
TEST(RecordFields, AnyFlippedByteIsFound)
{
  vtkSmartPointer<vtkPolyData> original = smallRecord();
  std::mt19937 random(3);
  int arrays = 0;
  for (int i = 0; i < original->GetFieldData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* found = original->GetFieldData()->GetArray(i);
    if (!found || !isRecordArray(found->GetName()) || !found->HasStandardMemoryLayout() ||
      found->GetDataType() == VTK_BIT)
    {
      continue;
    }
    ++arrays;
    const std::size_t size =
      static_cast<std::size_t>(found->GetDataTypeSize()) * found->GetNumberOfValues();
    for (int flip = 0; flip < 8; ++flip)
    {
      vtkSmartPointer<vtkPolyData> coarse = copy(original);
      auto* bytes =
        static_cast<unsigned char*>(coarse->GetFieldData()->GetArray(i)->GetVoidPointer(0));
      bytes[random() % size] ^= static_cast<unsigned char>(1u << (random() % 8));
      const std::string error = undecimationError(coarse);
      EXPECT_TRUE(error.find("is damaged") != std::string::npos ||
        error.find("Update Undecimate") != std::string::npos)
        << found->GetName() << ": " << error;
    }
  }
  EXPECT_GE(arrays, 20);
}

// A record that was opened stands for another one only if their counts are the same, too.
TEST(RecordFields, ShareArraysOnlyWithTheSameCounts)
{
  vtkSmartPointer<vtkPolyData> coarse = smallRecord();
  RecordFields one;
  RecordFields other;
  undecimate::Monitor monitor;
  ASSERT_EQ(readRecord(coarse, one, monitor), "");
  ASSERT_EQ(readRecord(coarse, other, monitor), "");
  EXPECT_TRUE(shareRecordArrays(one, other));
  other.header[kCellCount] += 1;
  EXPECT_FALSE(shareRecordArrays(one, other));
}

// Run a record whose checksum was put right after the damage. It may only be refused or shown: a
// crash or, under the sanitizers, a read outside the arrays fails the test.
bool survives(vtkPolyData* coarse)
{
  Watched<vtkUndecimation> filter;
  filter->SetInputData(coarse);
  filter->OriginalPointIdsOn();
  for (const double level : { 0.3, 1.0, 0.6, 0.0, 1.0 })
  {
    filter->SetLevel(level);
    vtkPolyData* output = filter.output();
    if (!filter.messages->errors.empty())
    {
      EXPECT_EQ(output->GetNumberOfPoints(), 0);
      return false;
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType i = 0; i < output->GetNumberOfPolys(); ++i)
    {
      output->GetPolys()->GetCellAtId(i, ids);
      for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      {
        EXPECT_GE(ids->GetId(k), 0);
        EXPECT_LT(ids->GetId(k), output->GetNumberOfPoints());
      }
    }
  }
  return true;
}

class RecordsOfAllForms : public ::testing::TestWithParam<int>
{
protected:
  vtkSmartPointer<vtkPolyData> original =
    GetParam() == 1 ? storedVersion1("coarse") : smallRecord();
};

TEST_P(RecordsOfAllForms, EveryHeaderEntryMayBeWrong)
{
  EXPECT_TRUE(survives(original));
  int refused = 0;
  for (int field = 1; field < kHeaderSize; ++field)
  {
    const std::int64_t right = header(original)[field];
    for (const std::int64_t wrong : { right + 1, right - 1, std::int64_t{ 0 }, std::int64_t{ -1 },
           std::int64_t{ 1 } << 31, (std::int64_t{ 1 } << 31) - 1, INT64_MAX, INT64_MIN })
    {
      vtkSmartPointer<vtkPolyData> coarse = copy(original);
      header(coarse)[field] = wrong;
      if (field < kChecksum)
      {
        sign(coarse);
      }
      refused += !survives(coarse);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_P(RecordsOfAllForms, SignedDamageNeverCrashes)
{
  std::mt19937 random(11);
  std::vector<std::string> names = { "NodeOrder", "StepErrors", "BaseSources", "LostSources",
    "ArrayFingerprints" };
  for (const char* name : GetParam() == 1
      ? std::vector<const char*>{ "CellOrder", "Patches", "StepShapes", "ShapeOffsets", "Shapes" }
      : std::vector<const char*>{ "StepHoles", "HoleCodes" })
  {
    names.emplace_back(name);
  }
  int refused = 0;
  for (const std::string& name : names)
  {
    vtkDataArray* found = original->GetFieldData()->GetArray(("Undecimation." + name).c_str());
    ASSERT_NE(found, nullptr) << name;
    const std::size_t size =
      static_cast<std::size_t>(found->GetDataTypeSize()) * found->GetNumberOfValues();
    for (int round = 0; round < 60; ++round)
    {
      vtkSmartPointer<vtkPolyData> coarse = copy(original);
      auto* bytes = static_cast<unsigned char*>(
        coarse->GetFieldData()->GetArray(("Undecimation." + name).c_str())->GetVoidPointer(0));
      for (unsigned flips = 1 + random() % 3; flips > 0; --flips)
      {
        bytes[random() % size] = static_cast<unsigned char>(random());
      }
      sign(coarse);
      refused += !survives(coarse);
    }
  }
  EXPECT_GT(refused, 200);
}

TEST_P(RecordsOfAllForms, ArraysMayBeMissingOrOfAnotherKind)
{
  for (int i = 0; i < original->GetFieldData()->GetNumberOfArrays(); ++i)
  {
    const std::string name = original->GetFieldData()->GetAbstractArray(i)->GetName();
    if (!isRecordArray(name.c_str()) || name == "Undecimation.Header")
    {
      continue;
    }
    const vtkIdType tuples = original->GetFieldData()->GetAbstractArray(i)->GetNumberOfTuples();
    const int type = original->GetFieldData()->GetAbstractArray(i)->GetDataType();
    vtkSmartPointer<vtkPolyData> missing = copy(original);
    missing->GetFieldData()->RemoveArray(name.c_str());
    sign(missing);
    EXPECT_FALSE(survives(missing)) << name;

    vtkSmartPointer<vtkPolyData> shorter = copy(original);
    shorter->GetFieldData()->GetAbstractArray(i)->Resize(tuples - 1);
    sign(shorter);
    EXPECT_FALSE(survives(shorter)) << name;

    for (const int other : { VTK_DOUBLE, VTK_STRING, VTK_BIT, VTK_INT, VTK_FLOAT })
    {
      if (other == type)
      {
        continue;
      }
      auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(other));
      array->SetName(name.c_str());
      array->SetNumberOfTuples(tuples);
      for (vtkIdType k = 0; k < tuples; ++k)
      {
        array->SetVariantValue(k, 0);
      }
      vtkSmartPointer<vtkPolyData> changed = copy(original);
      changed->GetFieldData()->AddArray(array);
      sign(changed);
      EXPECT_FALSE(survives(changed)) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(RecordFields, RecordsOfAllForms, ::testing::Values(1, 3),
  [](const ::testing::TestParamInfo<int>& info) { return "Version" + std::to_string(info.param); });

} // namespace
