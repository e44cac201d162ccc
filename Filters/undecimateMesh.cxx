// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <numeric>
#include <utility>

namespace undecimate
{
namespace filters
{

namespace
{

// Shares of the time of the first output of an input: until the record is found to be whole and to
// belong to the mesh, and until the cursor stands.
constexpr double kRead = 0.2;
constexpr double kOpened = 0.7;

// Counts the arrays of an output as they are filled.
class ArrayProgress
{
public:
  ArrayProgress(Monitor& monitor, const RecordFields& record)
    : monitor_(monitor)
    , count_(static_cast<double>(1 + record.pointArrays.size() + record.cellArrays.size()))
  {
  }

  /// False if it was cancelled.
  bool arrayDone() { return this->monitor_.update(++this->done_ / this->count_); }

private:
  Monitor& monitor_;
  double count_; // points and cells count as one
  double done_ = 0.0;
};

vtkSmartPointer<vtkPoints> makePoints(const ArrayPointer& coordinates)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(vtkDataArray::SafeDownCast(coordinates));
  return points;
}

// Lines and vertex cells are the same at all levels, and their nodes are all in the coarse mesh.
bool fits(vtkCellArray* cells, vtkIdType pointCount)
{
  std::vector<unsigned char> flags(cells->GetNumberOfCells() > 0 ? pointCount : 0);
  return flagPoints(cells, flags);
}

/// Give a mesh the point and cell data of a level; false if it was cancelled.
/// @param pointArray makes one of a coarse array and the values of the removed nodes
/// @param cellArray makes one of the original's values and an array that describes them
template <typename PointArray, typename CellArray>
bool setData(vtkPolyData* coarse, vtkPolyData* mesh, const RecordFields& record, Monitor& monitor,
  const PointArray& pointArray, const CellArray& cellArray)
{
  ArrayProgress progress(monitor, record);
  if (!progress.arrayDone()) // points and cells
  {
    return false;
  }
  vtkPointData* pointData = coarse->GetPointData();
  std::vector<ArrayPointer> arrays(pointData->GetNumberOfArrays());
  for (std::size_t i = 0; i < record.pointArrays.size(); ++i)
  {
    const int place = record.pointArrays[i];
    arrays[place] = pointArray(pointData->GetAbstractArray(place), record.pointData[i]);
    if (!progress.arrayDone())
    {
      return false;
    }
  }
  setArrays(mesh->GetPointData(), pointData, arrays);

  vtkCellData* cellData = coarse->GetCellData();
  arrays.assign(cellData->GetNumberOfArrays(), nullptr);
  for (std::size_t i = 0; i < record.cellArrays.size(); ++i)
  {
    const int place = record.cellArrays[i];
    vtkAbstractArray* described = cellData->GetAbstractArray(place);
    arrays[place] =
      record.cellData[i] ? cellArray(record.cellData[i], described) : ArrayPointer(described);
    if (!progress.arrayDone())
    {
      return false;
    }
  }
  setArrays(mesh->GetCellData(), cellData, arrays);
  return true;
}

} // namespace

std::string UndecimatedMesh::open(vtkPolyData* coarse, PassMonitor& monitor)
{
  RecordFields record;
  if (std::string problem = readRecord(coarse, record, monitor.part(kRead), &this->known_);
      !problem.empty() || monitor.cancelled())
  {
    *this = UndecimatedMesh();
    return problem;
  }
  if (this->isOpen_ && shareRecordArrays(record, this->record_))
  {
    this->record_ = std::move(record);
    this->shown_ = nullptr;
    this->original_ = nullptr;
  }
  else
  {
    *this = UndecimatedMesh();
    this->record_ = std::move(record);
    const Outcome outcome = this->cursor_.open(
      this->record_.view, this->record_.baseCells.data(), &monitor.part(kOpened));
    if (outcome.status == Status::Cancelled)
    {
      return {};
    }
    if (!outcome)
    {
      return outcome.message +
        (outcome.status == Status::InvalidRecord
            ? " Run the decimation again, or load an undamaged file."
            : "");
    }
    if (this->record_.view.cornersPerCell == 3)
    {
      // Their time steps share no record.
      std::vector<Index>().swap(this->record_.baseCells);
    }
    else
    {
      this->known_ = knownFingerprints(this->record_);
    }
  }
  const vtkIdType points = coarse->GetNumberOfPoints();
  if (!fits(coarse->GetVerts(), points) || !fits(coarse->GetLines(), points))
  {
    *this = UndecimatedMesh();
    return "A vertex cell or a line of the coarse mesh refers to a point that does not exist.";
  }
  this->isOpen_ = true;
  return {};
}

bool UndecimatedMesh::show(
  vtkPolyData* coarse, Index steps, vtkPolyData* output, ArrayMemory& memory, PassMonitor& monitor)
{
  if (steps != this->cursor_.steps())
  {
    this->shown_ = nullptr;
    this->shownFaces_ = Faces();
    // About half of what is left, whether the record was opened just now or not.
    if (!this->cursor_.moveTo(steps, &monitor.part(0.5 + 0.5 * monitor.reached())))
    {
      return false;
    }
  }
  vtkSmartPointer<vtkPolyData>& mesh = this->atLevelOne() ? this->original_ : this->shown_;
  Monitor& rest = monitor.part(1.0);
  if (!mesh)
  {
    mesh = this->atLevelOne() ? this->original(coarse, rest) : this->prefix(coarse, memory, rest);
  }
  if (!mesh || !rest.update(1.0))
  {
    return false;
  }
  output->ShallowCopy(mesh);
  return true;
}

vtkIdType UndecimatedMesh::numberOfQuads() const
{
  return this->atLevelOne() ? this->originalFaces_.quads : this->shownFaces_.quads;
}

vtkSmartPointer<vtkCellArray> UndecimatedMesh::makeCells(
  const Index* corners, ArrayMemory* memory, vtkIdType& quads) const
{
  const bool wide = this->record_.header[kWidePolys] != 0;
  return makeFaces(
    corners, this->record_.view.cornersPerCell, this->cursor_.cellCount(), wide, memory, quads);
}

ArrayPointer UndecimatedMesh::originalPointIds() const
{
  auto numbers = vtkSmartPointer<vtkIdTypeArray>::New();
  numbers->SetName(kOriginalPointIds);
  const Index count = this->cursor_.nodeCount();
  numbers->SetNumberOfValues(count);
  if (numbers->GetNumberOfValues() != count)
  {
    throw std::bad_alloc();
  }
  vtkIdType* number = numbers->GetPointer(0);
  if (this->atLevelOne())
  {
    std::iota(number, number + count, vtkIdType{ 0 });
  }
  else
  {
    std::copy_n(this->record_.view.nodeOrder, count, number);
  }
  return numbers;
}

// A level below 1: prefixes of the arrays in record order. Null if it was cancelled.
vtkSmartPointer<vtkPolyData> UndecimatedMesh::prefix(
  vtkPolyData* coarse, ArrayMemory& memory, Monitor& monitor)
{
  const RecordFields& record = this->record_;
  const Index base = record.view.baseNodeCount;
  const Index back = this->cursor_.steps();
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(
    makePoints(join(coarse->GetPoints()->GetData(), base, record.points, back, &memory)));
  mesh->SetVerts(coarse->GetVerts());
  mesh->SetLines(coarse->GetLines());
  Faces& faces = this->shownFaces_;
  if (!faces.cells)
  {
    faces.cells = this->makeCells(this->cursor_.cells(), &memory, faces.quads);
  }
  mesh->SetPolys(faces.cells);

  const vtkIdType leading = record.header[kVertCount] + record.header[kLineCount];
  const bool done = setData(
    coarse, mesh, record, monitor,
    [&](vtkAbstractArray* coarseArray, vtkAbstractArray* removed)
    { return join(coarseArray, base, removed, back, &memory); },
    [&](vtkAbstractArray* original, vtkAbstractArray* described)
    {
      return gather(original, described, leading, this->cursor_.shownCells(),
        this->cursor_.cellCount(), &memory);
    });
  return done ? mesh : nullptr;
}

// Level 1: the input of the decimation, in its own order. Null if it was cancelled.
vtkSmartPointer<vtkPolyData> UndecimatedMesh::original(vtkPolyData* coarse, Monitor& monitor)
{
  const RecordFields& record = this->record_;
  const RecordView& view = record.view;
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(makePoints(scatter(coarse->GetPoints()->GetData(), view.baseNodeCount,
    record.points, view.stepCount, view.nodeOrder)));
  mesh->SetVerts(mapPoints(coarse->GetVerts(), view.nodeOrder, record.header[kWideVerts] != 0));
  mesh->SetLines(mapPoints(coarse->GetLines(), view.nodeOrder, record.header[kWideLines] != 0));
  Faces& faces = this->originalFaces_;
  if (!faces.cells)
  {
    const std::size_t size = view.cornersPerCell;
    std::vector<Index> corners(size * view.cellCount);
    const Index* cells = this->cursor_.cells();
    const Index* order = this->cursor_.shownCells();
    for (Index slot = 0; slot < view.cellCount; ++slot)
    {
      std::transform(cells + size * slot, cells + size * (slot + 1),
        corners.data() + size * order[slot],
        [&view](Index node) { return node == kNone ? kNone : view.nodeOrder[node]; });
    }
    faces.cells = this->makeCells(corners.data(), nullptr, faces.quads);
  }
  mesh->SetPolys(faces.cells);

  const bool done = setData(
    coarse, mesh, record, monitor,
    [&](vtkAbstractArray* coarseArray, vtkAbstractArray* removed)
    { return scatter(coarseArray, view.baseNodeCount, removed, view.stepCount, view.nodeOrder); },
    [](vtkAbstractArray* original, vtkAbstractArray* described)
    { return share(original, described); });
  return done ? mesh : nullptr;
}

void UndecimatedMeshCache::startPass()
{
  ++this->pass_;
  this->entries_.remove_if([](const Entry& entry) { return !entry.input; });
}

UndecimatedMesh* UndecimatedMeshCache::find(
  vtkPolyData* input, PassMonitor& monitor, std::string& problem)
{
  const auto found = std::find_if(this->entries_.begin(), this->entries_.end(),
    [input](const Entry& entry) { return entry.input == input; });
  if (found != this->entries_.end() && found->time == input->GetMTime())
  {
    found->pass = this->pass_;
    this->entries_.splice(this->entries_.begin(), this->entries_, found);
    return found->mesh.get();
  }
  if (found != this->entries_.end())
  {
    // Perhaps the same record at another time.
    problem = found->mesh->open(input, monitor);
    if (!problem.empty() || monitor.cancelled())
    {
      this->entries_.erase(found);
      return nullptr;
    }
    found->time = input->GetMTime();
    found->pass = this->pass_;
    this->entries_.splice(this->entries_.begin(), this->entries_, found);
    return found->mesh.get();
  }
  this->forget();
  auto mesh = std::make_unique<UndecimatedMesh>();
  problem = mesh->open(input, monitor);
  if (!problem.empty() || monitor.cancelled())
  {
    return nullptr;
  }
  this->entries_.push_front({ input, input->GetMTime(), this->pass_, std::move(mesh) });
  return this->entries_.front().mesh.get();
}

void UndecimatedMeshCache::forget()
{
  while (this->entries_.size() >= kMaximumIdle && this->entries_.back().pass + 1 < this->pass_)
  {
    this->entries_.pop_back();
  }
}

} // namespace filters
} // namespace undecimate
