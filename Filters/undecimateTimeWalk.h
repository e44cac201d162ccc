// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file undecimateTimeWalk.h
/// @brief Collects a mesh of triangles and quads over its time steps, one at a time.

#ifndef undecimateTimeWalk_h
#define undecimateTimeWalk_h

#include "undecimateArrays.h"

#include "time_rows.h"
#include "tri_quad_decimation.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkPolyData;

namespace undecimate
{
namespace filters
{

/// What identifies the topology of a mesh, and says how another one differs.
class MeshTopology
{
public:
  void read(vtkPolyData* mesh);

  /// What is different; empty if nothing.
  std::string differences(vtkPolyData* mesh) const;

private:
  vtkIdType points_ = 0;
  vtkIdType verts_ = 0;
  vtkIdType lines_ = 0;
  vtkIdType polys_ = 0;
  vtkIdType strips_ = 0;
  std::uint64_t cells_ = 0;
  std::uint64_t others_ = 0;
  vtkMTimeType time_ = 0; // of the polygons that were hashed last
  const void* object_ = nullptr;
};

/// Which time steps a decimation looks at.
enum class StepChoice
{
  All,
  Three,
  List,
  Automatic
};

/// Takes the time steps that a choice needs, in the order of steps(), and gives the core's input.
///
/// Memory: 12 bytes a node and lane (lanesFor()) for positions, 4 for each component of an array;
/// of all steps, of the listed ones, or of three.
class TimeWalk
{
public:
  struct Options
  {
    StepChoice choice = StepChoice::All;
    std::vector<int> list;
    std::string displacement;
    std::vector<std::string> scalars;
    std::string partArray;
  };

  /// @param stepCount of the input; 1 if it has no time
  /// @return what is wrong, or an empty string
  std::string start(const Options& options, int stepCount);

  /// Numbers of the steps to be added, in this order.
  const std::vector<int>& steps() const { return this->steps_; }

  /// The next step.
  /// @param mesh at steps()[i], where this is call i
  /// @param name of the step for messages, such as "time step 3 (time 0.5)"; empty without time
  /// @return what is wrong, or an empty string
  std::string add(vtkPolyData* mesh, const std::string& name);

  /// Once all are added.
  const TriQuadMeshView& mesh() const { return this->view_; }
  const TimeRows& positions() const { return *this->positions_; }
  std::vector<TimeArray> arrays() const;
  const MeshTopology& topology() const { return this->topology_; }
  /// The step of each lane of the positions.
  std::vector<int> lanes() const;

private:
  std::string firstOther(vtkPolyData* mesh) const;
  std::string readMesh(vtkPolyData* mesh);
  std::string readParts(vtkPolyData* mesh);
  std::string set(vtkPolyData* mesh, int lane);
  std::string setPositions(vtkPolyData* mesh, int lane, TimeRows& rows);

  Options options_;
  std::vector<int> steps_;
  std::vector<int> laneSteps_;
  std::size_t added_ = 0;
  double farthest_ = 0.0;
  MeshTopology topology_;
  std::string firstName_;
  PositionFrame frame_;
  std::unique_ptr<TimeRows> positions_;
  std::unique_ptr<TimeRows> candidate_; // choice Three: the step at hand
  std::vector<TimeRows> arrays_;
  std::vector<std::vector<double>> origins_; // of the arrays
  TriQuadMeshView view_;
  std::vector<Index> corners_;
  std::vector<Index> parts_;
  std::vector<unsigned char> keep_;
};

} // namespace filters
} // namespace undecimate

#endif
