// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file filterTesting.h
/// @brief What the filter tests share: meshes with arrays of all kinds, exact comparison, messages.

#ifndef filterTesting_h
#define filterTesting_h

#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkAbstractArray;
class vtkAlgorithm;
class vtkCellArray;
class vtkDataSetAttributes;
class vtkHashQueueDecimation;
class vtkUndecimation;

namespace filter_testing
{

/// What a test mesh is made of.
struct MeshOptions
{
  int rows = 13;      ///< points in each direction of the grid
  int pointType = 10; ///< VTK_FLOAT, VTK_DOUBLE, VTK_INT, ...
  bool wide = true;   ///< 64-bit cell storage
  bool pointData = true;
  bool cellData = true;
  bool vertsAndLines = false;
  unsigned seed = 1;
};

/// A bumpy grid of triangles; its arrays are of all types that VTK has, active ones among them.
vtkSmartPointer<vtkPolyData> makeGrid(const MeshOptions& options = {});

/// Points 0 0 0, ... given by coordinates, and triangles given by point numbers.
vtkSmartPointer<vtkPolyData> makeMesh(
  const std::vector<double>& coordinates, const std::vector<std::vector<vtkIdType>>& faces);

/// The plate with a hole of Data/.
vtkSmartPointer<vtkPolyData> readPlate();

/// A deep copy.
vtkSmartPointer<vtkPolyData> copy(vtkPolyData* mesh);

/// All differences between two arrays, bit by bit; empty if there are none.
/// @param fileTypes take types of the same size and kind as the same, as files do
std::string differences(vtkAbstractArray* a, vtkAbstractArray* b, bool fileTypes = false);

/// The same for two meshes: points, cells with their storage width, point and cell data with the
/// order of the arrays and the active ones. Field data is not compared.
std::string differences(vtkPolyData* a, vtkPolyData* b, bool fileTypes = false);

/// The errors and warnings of an algorithm while this object lives.
class Messages : public vtkCommand
{
public:
  vtkBaseTypeMacro(Messages, vtkCommand);
  static Messages* New() { return new Messages; }
  void watch(vtkAlgorithm* algorithm);
  void Execute(vtkObject* caller, unsigned long event, void* data) override;

  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  bool silent() const { return this->errors.empty() && this->warnings.empty(); }
  std::string all() const;
};

/// A filter with its messages.
template <class Filter>
struct Watched
{
  Watched() { this->messages->watch(this->filter); }
  Filter* operator->() { return this->filter; }
  vtkPolyData* output(int port = 0)
  {
    this->filter->Update();
    return this->filter->GetOutput(port);
  }

  vtkNew<Filter> filter;
  vtkNew<Messages> messages;
};

/// Whether some message has the text.
bool has(const std::vector<std::string>& messages, const std::string& text);

/// Decimate a mesh without a message; the output is independent of any filter.
vtkSmartPointer<vtkPolyData> decimated(vtkPolyData* mesh, double reduction = 0.9);

/// A level of a decimated mesh; fails the test on any message.
vtkSmartPointer<vtkPolyData> undecimated(vtkPolyData* coarse, double level);

/// The error message of an undecimation that must fail; its output must be empty.
std::string undecimationError(vtkPolyData* coarse);

} // namespace filter_testing

#endif
