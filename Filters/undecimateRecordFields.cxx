// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateRecordFields.h"

#include "fingerprint.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

namespace undecimate
{
namespace filters
{

namespace
{

const std::string kPrefix = "Undecimation.";

std::string indexed(const char* word, std::size_t i)
{
  return word + std::to_string(i);
}

vtkDataArray* pointsOf(vtkPolyData* mesh)
{
  return mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr;
}

std::int64_t signedBits(std::uint64_t hash)
{
  std::int64_t number;
  std::memcpy(&number, &hash, sizeof(number));
  return number;
}

std::int64_t cellsFingerprint(vtkPolyData* mesh)
{
  Fingerprint print;
  for (vtkCellArray* cells : { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys() })
  {
    print.add(signedBits(fingerprint(cells)));
  }
  return signedBits(print.value());
}

// Work on arrays, each of them for itself.
using Jobs = std::vector<std::function<void()>>;

void run(const Jobs& jobs, Threads* threads)
{
  if (threads)
  {
    threads->run(static_cast<Index>(jobs.size()), [&jobs](Index i, int /*thread*/) { jobs[i](); });
    return;
  }
  for (const auto& job : jobs)
  {
    job();
  }
}

// A new field data array that is to have the values of a vector: the job moves them there.
template <class ArrayType, class Value>
void planToWrite(vtkFieldData* fields, const char* name, std::vector<Value>& values, Jobs& jobs)
{
  static_assert(sizeof(Value) == sizeof(typename ArrayType::ValueType), "same layout");
  if (values.empty())
  {
    return;
  }
  const vtkIdType size = static_cast<vtkIdType>(values.size());
  vtkNew<ArrayType> array;
  array->SetName((kPrefix + name).c_str());
  array->SetNumberOfValues(size);
  if (array->GetNumberOfValues() != size)
  {
    throw std::bad_alloc();
  }
  array->GetInformation(); // see describe() in undecimateArrays.cxx
  fields->AddArray(array);
  jobs.emplace_back(
    [&values, to = array->GetPointer(0)]
    {
      std::copy(values.begin(), values.end(), to);
      std::vector<Value>().swap(values);
    });
}

// The vector becomes a field data array; its memory is freed.
template <class ArrayType, class Value>
void write(vtkFieldData* fields, const char* name, std::vector<Value>& values)
{
  Jobs jobs;
  planToWrite<ArrayType>(fields, name, values, jobs);
  run(jobs, nullptr);
}

void write(vtkFieldData* fields, const std::string& name, const ArrayPointer& array)
{
  array->SetName((kPrefix + name).c_str());
  fields->AddArray(array);
}

void writeArrayFingerprints(vtkPolyData* coarse, int pointArrays, int cellArrays)
{
  vtkNew<vtkStringArray> names;
  names->SetName((kPrefix + "ArrayNames").c_str());
  std::vector<std::int64_t> prints;
  const auto add = [&](const char* association, vtkFieldData* arrays, int count)
  {
    for (int i = 0; i < count; ++i)
    {
      vtkAbstractArray* array = arrays->GetAbstractArray(i);
      names->InsertNextValue(association + std::string(array->GetName() ? array->GetName() : ""));
      prints.push_back(signedBits(fingerprint(array)));
    }
  };
  add("point:", coarse->GetPointData(), pointArrays);
  add("cell:", coarse->GetCellData(), cellArrays);
  if (names->GetNumberOfValues() > 0)
  {
    coarse->GetFieldData()->AddArray(names);
    write<vtkTypeInt64Array>(coarse->GetFieldData(), "ArrayFingerprints", prints);
  }
}

// @param numbers original numbers of the removed nodes
void writeNodalValues(const Index* numbers, vtkIdType removed, vtkPolyData* mesh,
  vtkFieldData* fields, Threads* threads)
{
  if (removed == 0)
  {
    return;
  }
  write(fields, "Points",
    gather(pointsOf(mesh), pointsOf(mesh), 0, numbers, removed, nullptr, threads));
  vtkPointData* data = mesh->GetPointData();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    write(fields, indexed("PointData.", i),
      gather(array, array, 0, numbers, removed, nullptr, threads));
  }
}

// Add the fingerprints of a record's arrays that are not known yet and lie in memory as they are.
void findFingerprints(vtkFieldData* fields, KnownFingerprints& known, Threads* threads)
{
  std::vector<vtkAbstractArray*> arrays;
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = fields->GetArray(i);
    if (array && isRecordArray(array->GetName()) && array->HasStandardMemoryLayout() &&
      known.find(array) == known.end())
    {
      arrays.push_back(array);
    }
  }
  std::vector<std::int64_t> prints(arrays.size());
  Jobs jobs;
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    jobs.emplace_back([&, i] { prints[i] = signedBits(fingerprint(arrays[i])); });
  }
  run(jobs, threads);
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    known[arrays[i]] = { arrays[i]->GetMTime(), prints[i] };
  }
}

// The checksum of a record; none if it was cancelled.
std::optional<std::int64_t> checksum(const std::int64_t* header, vtkFieldData* fields,
  const MonitorShare& progress, const KnownFingerprints* known)
{
  Fingerprint print;
  print.add(header, kChecksum * sizeof(header[0]));
  std::set<std::string> names;
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    const char* name = fields->GetAbstractArray(i)->GetName();
    if (isRecordArray(name) && fields->GetAbstractArray(i)->GetNumberOfValues() > 0)
    {
      names.insert(name);
    }
  }
  names.erase(kPrefix + "Header");
  double done = 0.0;
  for (const std::string& name : names)
  {
    print.add(name);
    vtkAbstractArray* array = fields->GetAbstractArray(name.c_str());
    const auto found = known ? known->find(array) : KnownFingerprints::const_iterator();
    const bool isKnown = known && found != known->end() && found->second.first == array->GetMTime();
    print.add(isKnown ? found->second.second : signedBits(fingerprint(array)));
    done += 1.0;
    if (!progress.update(done / static_cast<double>(names.size())))
    {
      return std::nullopt;
    }
  }
  return signedBits(print.value());
}

// ---- reading ----

std::string damaged(const std::string& what)
{
  return "The undecimation record is damaged: " + what +
    ". Run the decimation again, or load an undamaged file.";
}

// Whether an array is a plain list of numbers of the size and kind of Value.
template <class Value>
bool isFlat(vtkAbstractArray* array)
{
  const int type = array->GetDataType();
  return vtkDataArray::SafeDownCast(array) && array->HasStandardMemoryLayout() &&
    array->GetNumberOfComponents() == 1 && type != VTK_BIT &&
    array->GetDataTypeSize() == static_cast<int>(sizeof(Value)) &&
    (type == VTK_FLOAT || type == VTK_DOUBLE) == std::is_floating_point<Value>::value;
}

// Reads the record's arrays one after the other and remembers the first thing that is wrong.
class FieldReader
{
public:
  FieldReader(vtkFieldData* fields, RecordFields& record)
    : fields_(fields)
    , record_(record)
  {
  }

  const std::string& problem() const { return this->problem_; }

  /// A flat array of numbers of the size and kind of Value; null if size is 0 or on a problem.
  template <class Value>
  const Value* read(const char* name, std::int64_t size)
  {
    ArrayPointer array = this->find(name, size);
    if (!array)
    {
      return nullptr;
    }
    if (!isFlat<Value>(array))
    {
      this->fail(std::string("array '") + kPrefix + name + "' has the type " + typeName(array) +
        " with " + std::to_string(array->GetNumberOfComponents()) + " components");
      return nullptr;
    }
    this->record_.kept.push_back(array);
    return static_cast<const Value*>(array->GetVoidPointer(0));
  }

  ArrayPointer readStrings(const char* name, std::int64_t size)
  {
    ArrayPointer array = this->find(name, size);
    if (array && (!vtkStringArray::SafeDownCast(array) || array->GetNumberOfComponents() != 1))
    {
      this->fail(std::string("array '") + kPrefix + name + "' has the type " + typeName(array));
      return nullptr;
    }
    return array;
  }

  /// Values of an array of the mesh, with the type and the components of `like`.
  ArrayPointer readLike(const std::string& name, vtkAbstractArray* like, std::int64_t tuples)
  {
    ArrayPointer array = this->find(name, tuples);
    if (array &&
      (array->GetDataType() != like->GetDataType() ||
        array->GetNumberOfComponents() != like->GetNumberOfComponents()))
    {
      this->fail("array '" + kPrefix + name + "' has the type " + typeName(array) + " with " +
        std::to_string(array->GetNumberOfComponents()) + " components, the mesh's array has " +
        typeName(like) + " with " + std::to_string(like->GetNumberOfComponents()));
      return nullptr;
    }
    return array;
  }

private:
  ArrayPointer find(const std::string& name, std::int64_t tuples)
  {
    if (tuples == 0 || !this->problem_.empty())
    {
      return nullptr;
    }
    vtkAbstractArray* array = this->fields_->GetAbstractArray((kPrefix + name).c_str());
    if (!array)
    {
      this->fail("field data array '" + kPrefix + name + "' is missing");
    }
    else if (array->GetNumberOfTuples() != tuples)
    {
      this->fail("field data array '" + kPrefix + name + "' has " +
        std::to_string(array->GetNumberOfTuples()) + " tuples instead of " +
        std::to_string(tuples));
      array = nullptr;
    }
    return array;
  }

  void fail(const std::string& what)
  {
    if (this->problem_.empty())
    {
      this->problem_ = damaged(what);
    }
  }

  vtkFieldData* fields_;
  RecordFields& record_;
  std::string problem_;
};

std::string readHeader(vtkPolyData* mesh, std::int64_t* header, const MonitorShare& progress,
  const KnownFingerprints* known)
{
  vtkFieldData* fields = mesh->GetFieldData();
  vtkAbstractArray* found = fields->GetAbstractArray((kPrefix + "Header").c_str());
  if (!found)
  {
    return "The input has no undecimation record (field data array 'Undecimation.Header'). Connect "
           "the output Progressive Mesh (port 0) of Hash Queue Decimation or Tri Quad Decimation "
           "directly; their other output has no record, and filters in between may drop it.";
  }
  if (!isFlat<std::int64_t>(found) || found->GetNumberOfValues() < 1)
  {
    return damaged("the header has the type " + typeName(found) + " and " +
      std::to_string(found->GetNumberOfValues()) + " values");
  }
  const auto* values = static_cast<const std::int64_t*>(found->GetVoidPointer(0));
  if (values[kVersion] > kRecordVersion)
  {
    return "The undecimation record has format version " + std::to_string(values[kVersion]) +
      "; this version of Undecimate reads versions up to " + std::to_string(kRecordVersion) +
      ". Update Undecimate.";
  }
  if (values[kVersion] < 1 || found->GetNumberOfValues() != kHeaderSize)
  {
    return damaged("the header has version " + std::to_string(values[kVersion]) + " and " +
      std::to_string(found->GetNumberOfValues()) + " values");
  }
  std::copy_n(values, static_cast<int>(kHeaderSize), header);
  const std::optional<std::int64_t> sum = checksum(header, fields, progress, known);
  if (!sum)
  {
    return {};
  }
  if (*sum != header[kChecksum])
  {
    return damaged("the checksum of its arrays is wrong");
  }
  if (header[kCornersPerCell] > 3 && header[kVersion] != 2)
  {
    return damaged("version " + std::to_string(header[kVersion]) + " has " +
      std::to_string(header[kCornersPerCell]) + " corners a cell");
  }
  for (int field = kNodeCount; field < kPointsFingerprint; ++field)
  {
    const bool wide = field == kPatchSize || field == kLostSourceSize ||
      (field == kFormCount && header[kVersion] > 2);
    if (header[field] < 0 || (!wide && header[field] > std::numeric_limits<Index>::max()))
    {
      return damaged(
        "header entry " + std::to_string(field) + " is " + std::to_string(header[field]));
    }
  }
  return {};
}

// What was done to the arrays of a mesh since the record was written, and where they are now.
class ArrayComparison
{
public:
  ArrayComparison(vtkFieldData* arrays, std::string kind)
    : arrays_(arrays)
    , kind_(std::move(kind))
    , known_(arrays->GetNumberOfArrays(), false)
  {
  }

  void expect(const std::string& name, std::int64_t print, std::vector<int>& places)
  {
    int place = static_cast<int>(places.size());
    if (!name.empty())
    {
      this->arrays_->GetAbstractArray(name.c_str(), place);
    }
    if (place < 0 || place >= this->arrays_->GetNumberOfArrays() || this->known_[place])
    {
      this->note(this->kind_ + " array '" + name + "' was removed or renamed");
      place = -1;
    }
    else
    {
      this->known_[place] = true;
      if (signedBits(fingerprint(this->arrays_->GetAbstractArray(place))) != print)
      {
        this->note("the values or the type of " + this->kind_ + " array '" + name + "' changed");
      }
    }
    places.push_back(place);
  }

  /// Call last. @param ignored name of an array that may be there
  std::string differences(const char* ignored)
  {
    for (std::size_t i = 0; i < this->known_.size(); ++i)
    {
      const char* found = this->arrays_->GetAbstractArray(static_cast<int>(i))->GetName();
      const std::string name = found ? found : "";
      if (!this->known_[i] && !(ignored && name == ignored))
      {
        this->note(this->kind_ + " array '" + name + "' was added or renamed");
      }
    }
    return this->text_;
  }

private:
  void note(const std::string& what) { this->text_ += (this->text_.empty() ? "" : "; ") + what; }

  vtkFieldData* arrays_;
  std::string kind_;
  std::vector<bool> known_;
  std::string text_;
};

std::string compareArrays(
  vtkPolyData* mesh, FieldReader& reader, RecordFields& record, const MonitorShare& progress)
{
  const std::int64_t pointArrays = record.header[kPointArrayCount];
  const std::int64_t count = pointArrays + record.header[kCellArrayCount];
  const std::int64_t* prints = reader.read<std::int64_t>("ArrayFingerprints", count);
  ArrayPointer names = reader.readStrings("ArrayNames", count);
  if (!reader.problem().empty())
  {
    return {};
  }
  ArrayComparison points(mesh->GetPointData(), "point");
  ArrayComparison cells(mesh->GetCellData(), "cell");
  for (std::int64_t i = 0; i < count; ++i)
  {
    const std::string name = names->GetVariantValue(i).ToString();
    const std::string bare = name.substr(std::min(name.size(), name.find(':') + 1));
    if (i < pointArrays)
    {
      points.expect(bare, prints[i], record.pointArrays);
    }
    else
    {
      cells.expect(bare, prints[i], record.cellArrays);
    }
    if (!progress.update(static_cast<double>(i + 1) / static_cast<double>(count)))
    {
      return {};
    }
  }
  const std::string first =
    points.differences(record.header[kHasOriginalPointIds] ? kOriginalPointIds : nullptr);
  const std::string second = cells.differences(nullptr);
  return first + (first.empty() || second.empty() ? "" : "; ") + second;
}

std::string compareCells(vtkPolyData* mesh, const std::int64_t* header)
{
  const std::pair<const char*, std::pair<std::int64_t, std::int64_t>> counts[] = {
    { " vertex cells", { mesh->GetNumberOfVerts(), header[kVertCount] } },
    { " lines", { mesh->GetNumberOfLines(), header[kLineCount] } },
    { " polygons", { mesh->GetNumberOfPolys(), header[kBaseCellCount] } },
    { " triangle strips", { mesh->GetNumberOfStrips(), 0 } },
  };
  for (const auto& [word, numbers] : counts)
  {
    if (numbers.first != numbers.second)
    {
      return "it has " + std::to_string(numbers.first) + word + " instead of " +
        std::to_string(numbers.second);
    }
  }
  return cellsFingerprint(mesh) == header[kCellsFingerprint] ? ""
                                                             : "the points of its cells changed";
}

// What was done to the mesh since the record was written; empty if nothing.
std::string compareMesh(
  vtkPolyData* mesh, FieldReader& reader, RecordFields& record, const MonitorShare& progress)
{
  const std::int64_t* header = record.header;
  if (mesh->GetNumberOfPoints() != header[kBaseNodeCount])
  {
    return "it has " + std::to_string(mesh->GetNumberOfPoints()) + " points instead of " +
      std::to_string(header[kBaseNodeCount]);
  }
  std::string text = compareCells(mesh, header);
  const std::string arrays = compareArrays(mesh, reader, record, progress);
  text += (text.empty() || arrays.empty() ? "" : "; ") + arrays;
  if (!pointsOf(mesh) || signedBits(fingerprint(pointsOf(mesh))) != header[kPointsFingerprint])
  {
    text += (text.empty() ? "" : "; ") +
      std::string("the coordinates of its points or their type changed");
  }
  return text;
}

void readArrays(FieldReader& reader, RecordFields& record)
{
  const std::int64_t* header = record.header;
  RecordView& view = record.view;
  view.nodeCount = static_cast<Index>(header[kNodeCount]);
  view.cellCount = static_cast<Index>(header[kCellCount]);
  view.baseNodeCount = static_cast<Index>(header[kBaseNodeCount]);
  view.baseCellCount = static_cast<Index>(header[kBaseCellCount]);
  view.stepCount = view.nodeCount - view.baseNodeCount;
  view.hasCodes = header[kVersion] > 2;
  view.patchSize = header[kPatchSize];
  view.cornersPerCell = static_cast<int>(header[kCornersPerCell]);
  view.hasSources = header[kHasSources] != 0;

  view.nodeOrder = reader.read<Index>("NodeOrder", view.nodeCount);
  view.cellOrder =
    reader.read<Index>("CellOrder", view.stepsOrderCells() ? Index{ 0 } : view.cellCount);
  view.stepErrors = reader.read<float>("StepErrors", view.stepCount);
  if (view.hasCodes)
  {
    view.codeSize = header[kFormCount];
    view.stepHoles = reader.read<unsigned char>("StepHoles", view.stepCount);
    view.codes = reader.read<unsigned char>("HoleCodes", view.codeSize);
  }
  else
  {
    view.patches = reader.read<Index>("Patches", view.patchSize);
    view.shapeCount = static_cast<Index>(header[kFormCount]);
    view.stepShapes = reader.read<Index>("StepShapes", view.stepCount);
    view.shapeOffsets = reader.read<Index>("ShapeOffsets", view.shapeCount + std::int64_t{ 1 });
    if (view.shapeOffsets)
    {
      view.shapes = reader.read<unsigned char>(
        "Shapes", std::max<Index>(0, view.shapeOffsets[view.shapeCount]));
    }
  }
  view.baseSources =
    reader.read<Index>("BaseSources", view.hasSources ? view.baseCellCount : Index{ 0 });
  const std::int64_t lost = view.hasSources ? header[kLostSourceSize] : 0;
  if (view.hasCodes)
  {
    view.lostCodeSize = lost;
    view.lostSourceCodes = reader.read<unsigned char>("LostSources", lost);
  }
  else
  {
    view.lostSourceSize = lost;
    view.lostSources = reader.read<Index>("LostSources", lost);
  }
}

void readValues(vtkPolyData* mesh, FieldReader& reader, RecordFields& record)
{
  const Index removed = record.view.stepCount;
  record.points = reader.readLike("Points", pointsOf(mesh), removed);
  for (std::size_t i = 0; i < record.pointArrays.size(); ++i)
  {
    record.pointData.push_back(reader.readLike(indexed("PointData.", i),
      mesh->GetPointData()->GetAbstractArray(record.pointArrays[i]), removed));
  }
  const std::int64_t cells =
    record.header[kVertCount] + record.header[kLineCount] + record.view.cellCount;
  for (std::size_t i = 0; i < record.cellArrays.size(); ++i)
  {
    record.cellData.push_back(reader.readLike(
      indexed("CellData.", i), mesh->GetCellData()->GetAbstractArray(record.cellArrays[i]), cells));
  }
}

} // namespace

bool isRecordArray(const char* name)
{
  return name && std::string(name).compare(0, kPrefix.size(), kPrefix) == 0;
}

void passFieldData(vtkFieldData* from, vtkFieldData* to)
{
  // The executive has put the input's field data there, with the record of an earlier decimation.
  to->Initialize();
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    if (!isRecordArray(from->GetAbstractArray(i)->GetName()))
    {
      to->AddArray(from->GetAbstractArray(i));
    }
  }
}

bool passEmpty(vtkPolyData* from, vtkPolyData* to)
{
  if (from->GetNumberOfPoints() > 0 || from->GetNumberOfCells() > 0)
  {
    return false;
  }
  to->ShallowCopy(from);
  passFieldData(from->GetFieldData(), to->GetFieldData());
  return true;
}

std::int64_t recordChecksum(
  const std::int64_t* header, vtkFieldData* fields, const KnownFingerprints* known)
{
  return *checksum(header, fields, MonitorShare(nullptr), known);
}

RecordArrays::RecordArrays(Record& record, Threads* threads)
  : fields_(vtkSmartPointer<vtkFieldData>::New())
{
  std::int64_t* header = this->header_;
  header[kVersion] = record.hasCodes ? 3 : record.cornersPerCell == 3 ? 1 : 2;
  header[kNodeCount] = record.nodeCount;
  header[kCellCount] = record.cellCount;
  header[kBaseNodeCount] = record.baseNodeCount;
  header[kBaseCellCount] = record.baseCellCount;
  header[kFormCount] = record.hasCodes ? static_cast<std::int64_t>(record.codes.size())
                                       : static_cast<std::int64_t>(record.shapeOffsets.size()) - 1;
  header[kPatchSize] = static_cast<std::int64_t>(record.patches.size());
  header[kLostSourceSize] = static_cast<std::int64_t>(
    record.hasCodes ? record.lostSourceCodes.size() : record.lostSources.size());
  header[kCornersPerCell] = record.cornersPerCell;
  header[kHasSources] = record.hasSources;
  vtkFieldData* fields = this->fields_;
  Jobs jobs;
  planToWrite<vtkTypeInt32Array>(fields, "NodeOrder", record.nodeOrder, jobs);
  planToWrite<vtkTypeInt32Array>(fields, "CellOrder", record.cellOrder, jobs);
  planToWrite<vtkFloatArray>(fields, "StepErrors", record.stepErrors, jobs);
  if (record.hasCodes)
  {
    planToWrite<vtkUnsignedCharArray>(fields, "StepHoles", record.stepHoles, jobs);
    planToWrite<vtkUnsignedCharArray>(fields, "HoleCodes", record.codes, jobs);
  }
  else
  {
    planToWrite<vtkTypeInt32Array>(fields, "Patches", record.patches, jobs);
    planToWrite<vtkTypeInt32Array>(fields, "StepShapes", record.stepShapes, jobs);
    planToWrite<vtkTypeInt32Array>(fields, "ShapeOffsets", record.shapeOffsets, jobs);
    planToWrite<vtkUnsignedCharArray>(fields, "Shapes", record.shapes, jobs);
  }
  planToWrite<vtkTypeInt32Array>(fields, "BaseSources", record.baseSources, jobs);
  if (record.hasCodes)
  {
    planToWrite<vtkUnsignedCharArray>(fields, "LostSources", record.lostSourceCodes, jobs);
  }
  else
  {
    planToWrite<vtkTypeInt32Array>(fields, "LostSources", record.lostSources, jobs);
  }
  run(jobs, threads);
  findFingerprints(fields, this->known_, threads);
}

void RecordArrays::addTo(
  vtkPolyData* mesh, vtkPolyData* coarse, bool hasOriginalPointIds, Threads* threads) const
{
  vtkFieldData* fields = coarse->GetFieldData();
  const int pointArrays = mesh->GetPointData()->GetNumberOfArrays();
  const int cellArrays = mesh->GetCellData()->GetNumberOfArrays();

  std::vector<std::int64_t> header(this->header_, this->header_ + kHeaderSize);
  header[kVertCount] = mesh->GetNumberOfVerts();
  header[kLineCount] = mesh->GetNumberOfLines();
  header[kWideVerts] = mesh->GetVerts()->IsStorage64Bit();
  header[kWideLines] = mesh->GetLines()->IsStorage64Bit();
  header[kWidePolys] = mesh->GetPolys()->IsStorage64Bit();
  header[kPointArrayCount] = pointArrays;
  header[kCellArrayCount] = cellArrays;
  header[kHasOriginalPointIds] = hasOriginalPointIds;
  header[kPointsFingerprint] = signedBits(fingerprint(pointsOf(coarse)));
  header[kCellsFingerprint] = cellsFingerprint(coarse);

  const vtkIdType removed = header[kNodeCount] - header[kBaseNodeCount];
  if (auto* order =
        vtkTypeInt32Array::SafeDownCast(this->fields_->GetAbstractArray("Undecimation.NodeOrder")))
  {
    writeNodalValues(order->GetPointer(header[kBaseNodeCount]), removed, mesh, fields, threads);
  }
  for (int i = 0; i < cellArrays; ++i)
  {
    vtkAbstractArray* array = mesh->GetCellData()->GetAbstractArray(i);
    write(fields, indexed("CellData.", i), share(array, array));
  }
  writeArrayFingerprints(coarse, pointArrays, cellArrays);
  for (int i = 0; i < this->fields_->GetNumberOfArrays(); ++i)
  {
    fields->AddArray(this->fields_->GetAbstractArray(i));
  }
  KnownFingerprints known = this->known_;
  findFingerprints(fields, known, threads);
  header[kChecksum] = recordChecksum(header.data(), fields, &known);
  write<vtkTypeInt64Array>(fields, "Header", header);
}

void writeRecord(Record& record, vtkPolyData* mesh, vtkPolyData* coarse, bool hasOriginalPointIds,
  Threads* threads)
{
  RecordArrays(record, threads).addTo(mesh, coarse, hasOriginalPointIds, threads);
}

bool shareRecordArrays(const RecordFields& a, const RecordFields& b)
{
  const RecordView& v = a.view;
  const RecordView& w = b.view;
  // The same counts and arrays; whoever writes into one makes it newer.
  return v.stepCount > 0 &&
    std::equal(a.header + kVersion, a.header + kVertCount, b.header + kVersion) &&
    v.nodeOrder == w.nodeOrder && v.cellOrder == w.cellOrder && v.stepErrors == w.stepErrors &&
    v.patches == w.patches && v.stepHoles == w.stepHoles && v.codes == w.codes &&
    v.stepShapes == w.stepShapes && v.shapeOffsets == w.shapeOffsets && v.shapes == w.shapes &&
    v.baseSources == w.baseSources && v.lostSources == w.lostSources &&
    v.lostSourceCodes == w.lostSourceCodes && a.keptTimes == b.keptTimes &&
    a.baseCells == b.baseCells;
}

KnownFingerprints knownFingerprints(const RecordFields& fields)
{
  KnownFingerprints known;
  for (const ArrayPointer& array : fields.kept)
  {
    known[array] = { array->GetMTime(), signedBits(fingerprint(array)) };
  }
  return known;
}

std::string readRecord(
  vtkPolyData* mesh, RecordFields& record, Monitor& monitor, const KnownFingerprints* known)
{
  const MonitorShare progress(&monitor);
  if (std::string problem = readHeader(mesh, record.header, progress.part(0.0, 0.7), known);
      !problem.empty() || monitor.cancelled())
  {
    return problem;
  }
  FieldReader reader(mesh->GetFieldData(), record);
  const std::string changes = compareMesh(mesh, reader, record, progress.part(0.7, 1.0));
  if (monitor.cancelled())
  {
    return {};
  }
  if (!changes.empty())
  {
    return "The mesh was changed after the decimation: " + changes +
      ". Apply Undecimation to the output of " +
      (record.header[kCornersPerCell] == 3 ? "Hash Queue Decimation" : "Tri Quad Decimation") +
      ", and the other filters to the output of Undecimation.";
  }
  const std::size_t before = record.kept.size();
  readArrays(reader, record);
  if (reader.problem().empty())
  {
    readValues(mesh, reader, record);
  }
  // Other numbers are refused when the record is opened.
  const int cornersPerCell = record.view.cornersPerCell == 3 ? 3 : 4;
  record.baseCells = readFaces(mesh->GetPolys(), mesh->GetNumberOfPoints(), cornersPerCell).corners;
  for (std::size_t i = before; i < record.kept.size(); ++i)
  {
    record.keptTimes.push_back(record.kept[i]->GetMTime());
  }
  return reader.problem();
}

} // namespace filters
} // namespace undecimate
