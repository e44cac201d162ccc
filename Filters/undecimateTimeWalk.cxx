// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateTimeWalk.h"

#include "undecimateInput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <numeric>

namespace undecimate
{
namespace filters
{

namespace
{

std::vector<double> valuesOf(vtkDataArray* array)
{
  const int components = array->GetNumberOfComponents();
  std::vector<double> values(array->GetNumberOfValues());
  for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
  {
    array->GetTuple(tuple, values.data() + components * tuple);
  }
  return values;
}

const float* floatsOf(vtkDataArray* array)
{
  return array->HasStandardMemoryLayout() && array->GetDataType() == VTK_FLOAT
    ? static_cast<const float*>(array->GetVoidPointer(0))
    : nullptr;
}

} // namespace

void MeshTopology::read(vtkPolyData* mesh)
{
  this->points_ = mesh->GetNumberOfPoints();
  this->verts_ = mesh->GetNumberOfVerts();
  this->lines_ = mesh->GetNumberOfLines();
  this->polys_ = mesh->GetNumberOfPolys();
  this->strips_ = mesh->GetNumberOfStrips();
  this->cells_ = fingerprint(mesh->GetPolys());
  this->others_ = fingerprint(mesh->GetVerts()) ^ 3 * fingerprint(mesh->GetLines());
  this->object_ = mesh->GetPolys();
  this->time_ = mesh->GetPolys()->GetMTime();
}

std::string MeshTopology::differences(vtkPolyData* mesh) const
{
  const std::pair<const char*, std::pair<vtkIdType, vtkIdType>> counts[] = {
    { "point", { mesh->GetNumberOfPoints(), this->points_ } },
    { "vertex cell", { mesh->GetNumberOfVerts(), this->verts_ } },
    { "line", { mesh->GetNumberOfLines(), this->lines_ } },
    { "polygon", { mesh->GetNumberOfPolys(), this->polys_ } },
    { "triangle strip", { mesh->GetNumberOfStrips(), this->strips_ } },
  };
  for (const auto& [word, numbers] : counts)
  {
    if (numbers.first != numbers.second)
    {
      return counted(numbers.first, word) + " instead of " + std::to_string(numbers.second);
    }
  }
  const bool same =
    (mesh->GetPolys() == this->object_ && mesh->GetPolys()->GetMTime() == this->time_) ||
    fingerprint(mesh->GetPolys()) == this->cells_;
  if (this->verts_ + this->lines_ > 0 &&
    (fingerprint(mesh->GetVerts()) ^ 3 * fingerprint(mesh->GetLines())) != this->others_)
  {
    return "vertex cells or lines of other points";
  }
  return same ? "" : "polygons of other points";
}

std::string TimeWalk::start(const Options& options, int stepCount)
{
  *this = TimeWalk();
  this->options_ = options;
  if (options.choice == StepChoice::List && options.list.empty() && stepCount > 1)
  {
    return "The choice of time steps is List, and no step is listed. Add numbers from 0 to " +
      std::to_string(stepCount - 1) + " to Steps, or choose All.";
  }
  if (options.choice == StepChoice::List && stepCount > 1)
  {
    for (const int step : options.list)
    {
      if (step < 0 || step >= stepCount)
      {
        return "Steps lists time step " + std::to_string(step) +
          ", but the input has the steps 0 to " + std::to_string(stepCount - 1) + ".";
      }
    }
    this->steps_ = options.list;
    std::sort(this->steps_.begin(), this->steps_.end());
  }
  else
  {
    this->steps_.resize(stepCount);
    std::iota(this->steps_.begin(), this->steps_.end(), 0);
    if (options.choice == StepChoice::Three && stepCount > 2)
    {
      // The steps between are compared to both ends.
      std::rotate(this->steps_.begin() + 1, this->steps_.end() - 1, this->steps_.end());
      this->laneSteps_ = { 0, stepCount - 1, kNone };
      return {};
    }
  }
  this->laneSteps_ = this->steps_;
  return {};
}

std::string TimeWalk::add(vtkPolyData* mesh, const std::string& name)
{
  std::string problem = checkSizes(mesh);
  if (problem.empty() && this->added_ == 0)
  {
    this->firstName_ = name;
    problem = this->readMesh(mesh);
  }
  else if (problem.empty())
  {
    const std::string differences = this->topology_.differences(mesh);
    if (!differences.empty())
    {
      return "The mesh is not the same at all time steps: at " + name + " it has " + differences +
        this->firstOther(mesh) + ", compared with " + this->firstName_ +
        ". Only time steps with the same points and cells can be decimated together. Choose a List "
        "of such steps, or keep removed elements in the mesh upstream.";
    }
  }
  if (problem.empty())
  {
    // Choice Three: lanes 0 and 1 are the ends, lane 2 is the best so far.
    const bool between = this->candidate_ && this->added_ >= 2;
    if (!between)
    {
      problem = this->set(mesh, static_cast<int>(this->added_));
    }
    else
    {
      problem = this->setPositions(mesh, 0, *this->candidate_);
      const double move = std::min(largestMove(*this->candidate_, 0, *this->positions_, 0),
        largestMove(*this->candidate_, 0, *this->positions_, 1));
      if (problem.empty() && (move > this->farthest_ || this->laneSteps_[2] == kNone))
      {
        this->farthest_ = move;
        this->laneSteps_[2] = this->steps_[this->added_];
        problem = this->set(mesh, 2);
      }
    }
  }
  ++this->added_;
  return problem.empty() || name.empty() ? problem : "At " + name + ": " + problem;
}

// Where the polygons of a mesh with as many begin to differ from the first one's.
std::string TimeWalk::firstOther(vtkPolyData* mesh) const
{
  const FaceCells cells = readFaces(mesh->GetPolys(), mesh->GetNumberOfPoints(), kTriQuadCorners);
  const auto size = static_cast<std::ptrdiff_t>(this->corners_.size());
  if (static_cast<std::ptrdiff_t>(cells.corners.size()) != size)
  {
    return "";
  }
  const auto place =
    std::mismatch(this->corners_.begin(), this->corners_.end(), cells.corners.begin()).first -
    this->corners_.begin();
  return place == size ? ""
                       : " (the first is polygon " + std::to_string(place / kTriQuadCorners) + ")";
}

std::string TimeWalk::readMesh(vtkPolyData* mesh)
{
  const vtkIdType points = mesh->GetNumberOfPoints();
  const vtkIdType faces = mesh->GetNumberOfPolys();
  constexpr vtkIdType most = std::numeric_limits<Index>::max();
  if (points > most || faces > most / 4)
  {
    return "The input has " + counted(points, "point") + " and " + counted(faces, "cell") +
      "; at most " + std::to_string(most) + " points and " + std::to_string(most / 4) +
      " cells fit in one piece. Divide the mesh.";
  }
  OtherFaces others = countOtherFaces(mesh);
  others.quads = 0;
  if (others.any())
  {
    return "The input has " + others.describe() +
      "; the decimation takes triangles and quads. Apply the filter Triangulate first.";
  }
  FaceCells cells = readFaces(mesh->GetPolys(), points, kTriQuadCorners);
  if (std::string problem = badFace(cells, points); !problem.empty())
  {
    return problem;
  }
  this->topology_.read(mesh);
  this->corners_ = std::move(cells.corners);
  this->view_.nodeCount = points;
  this->view_.cells = this->corners_.data();
  this->view_.cellCount = faces;
  if (std::string problem = readKept(mesh, this->keep_); !problem.empty())
  {
    return problem;
  }
  this->view_.keep = this->keep_.empty() ? nullptr : this->keep_.data();
  if (std::string problem = this->readParts(mesh); !problem.empty())
  {
    return problem;
  }
  dropAssociation(mesh, this->options_.scalars);
  std::vector<int> components; // of the arrays
  for (const std::string& name : this->options_.scalars)
  {
    vtkDataArray* array = nullptr;
    if (std::string problem = findSteeringArray(mesh, name, array); !problem.empty())
    {
      return problem;
    }
    components.push_back(array->GetNumberOfComponents());
  }
  const auto nodes = static_cast<Index>(points);
  const int lanes = static_cast<int>(this->laneSteps_.size());
  try
  {
    this->positions_ = std::make_unique<TimeRows>(nodes, 3, lanes);
    if (this->options_.choice == StepChoice::Three && this->steps_.size() > 2)
    {
      this->candidate_ = std::make_unique<TimeRows>(nodes, 3, 1);
    }
    for (const int count : components)
    {
      this->arrays_.emplace_back(nodes, count, lanes);
    }
  }
  catch (const std::bad_alloc&)
  {
    return "Not enough memory for the positions and arrays of " + counted(points, "point") +
      " at " + counted(lanes, "time step") + ". Choose fewer steps.";
  }
  this->origins_.resize(components.size());
  return {};
}

std::string TimeWalk::readParts(vtkPolyData* mesh)
{
  const std::string& name = this->options_.partArray;
  vtkAbstractArray* found =
    name.empty() ? nullptr : mesh->GetCellData()->GetAbstractArray(name.c_str());
  if (!found || mesh->GetNumberOfPolys() == 0)
  {
    return {};
  }
  if (found->GetNumberOfComponents() != 1)
  {
    return "Cell array '" + name + "' (" + typeName(found) + ", " +
      counted(found->GetNumberOfComponents(), "component") +
      ") cannot be used as PartArray: 1 component is needed.";
  }
  vtkDataArray* array = vtkDataArray::SafeDownCast(found);
  const vtkIdType before = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  std::map<double, Index> numbers;
  std::map<std::string, Index> names; // of arrays of something else than numbers
  this->parts_.resize(mesh->GetNumberOfPolys());
  for (std::size_t cell = 0; cell < this->parts_.size(); ++cell)
  {
    const vtkIdType tuple = before + static_cast<vtkIdType>(cell);
    const auto next = static_cast<Index>(numbers.size() + names.size());
    if (array)
    {
      const double part = array->GetComponent(tuple, 0);
      this->parts_[cell] = numbers.emplace(std::isnan(part) ? HUGE_VAL : part, next).first->second;
    }
    else
    {
      this->parts_[cell] =
        names.emplace(found->GetVariantValue(tuple).ToString(), next).first->second;
    }
  }
  this->view_.parts = this->parts_.data();
  return {};
}

std::string TimeWalk::setPositions(vtkPolyData* mesh, int lane, TimeRows& rows)
{
  if (rows.nodeCount() == 0)
  {
    return {};
  }
  vtkDataArray* points = mesh->GetPoints()->GetData();
  vtkDataArray* moved = nullptr;
  const std::string& name = this->options_.displacement;
  if (!name.empty())
  {
    vtkAbstractArray* found = mesh->GetPointData()->GetAbstractArray(name.c_str());
    moved = vtkDataArray::SafeDownCast(found);
    if (!moved || moved->GetNumberOfComponents() != 3)
    {
      return "The input has no point array '" + name +
        "' of three numbers to use as Displacement. Its point arrays are: " +
        listNames(mesh->GetPointData()) + ".";
    }
  }
  const bool first = lane == 0 && &rows == this->positions_.get();
  const auto setRows = [&](const auto* from, const auto* added)
  {
    if (first)
    {
      this->frame_ = positionFrame(from, added, rows.nodeCount());
    }
    rows.set(lane, from, added, this->frame_.origin.data(), this->frame_.scale);
  };
  if (floatsOf(points) && (!moved || floatsOf(moved)))
  {
    setRows(floatsOf(points), moved ? floatsOf(moved) : nullptr);
    return {};
  }
  const std::vector<double> from = valuesOf(points);
  const std::vector<double> added = moved ? valuesOf(moved) : std::vector<double>();
  setRows(from.data(), moved ? added.data() : static_cast<const double*>(nullptr));
  return {};
}

std::string TimeWalk::set(vtkPolyData* mesh, int lane)
{
  if (std::string problem = this->setPositions(mesh, lane, *this->positions_); !problem.empty())
  {
    return problem;
  }
  for (std::size_t n = 0; n < this->arrays_.size(); ++n)
  {
    const std::string& name = this->options_.scalars[n];
    vtkDataArray* array =
      vtkDataArray::SafeDownCast(mesh->GetPointData()->GetAbstractArray(name.c_str()));
    TimeRows& rows = this->arrays_[n];
    if (!array || array->GetNumberOfComponents() != rows.components())
    {
      return "Point array '" + name + "' is missing or has other components than at " +
        this->firstName_ + ". Choose an array that all time steps have.";
    }
    const std::vector<double> values = valuesOf(array);
    std::vector<double>& origin = this->origins_[n];
    if (origin.empty())
    {
      // Small differences of large values are kept.
      origin.assign(rows.components(), 0.0);
      for (int c = 0; c < rows.components() && !values.empty(); ++c)
      {
        origin[c] = std::isfinite(values[c]) ? values[c] : 0.0;
      }
    }
    rows.set(lane, values.data(), static_cast<const double*>(nullptr), origin.data(), 1.0);
  }
  return {};
}

std::vector<TimeArray> TimeWalk::arrays() const
{
  std::vector<TimeArray> arrays;
  for (std::size_t n = 0; n < this->arrays_.size(); ++n)
  {
    arrays.push_back({ &this->arrays_[n], this->options_.scalars[n] });
  }
  return arrays;
}

std::vector<int> TimeWalk::lanes() const
{
  return this->laneSteps_;
}

} // namespace filters
} // namespace undecimate
