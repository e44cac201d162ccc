// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Two sliders, time and level, in a VTK program: vtk_time_example array step0.vtp step1.vtp ...

#include "vtkTriQuadDecimation.h"
#include "vtkUndecimation.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkXMLPolyDataReader.h"

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

// One file for each of the times 0, 1, 2, ...: VTK itself has no reader for that.
class Series : public vtkPolyDataAlgorithm
{
public:
  static Series* New();
  vtkTypeMacro(Series, vtkPolyDataAlgorithm);
  std::vector<std::string> files;

protected:
  Series() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    std::vector<double> times;
    for (std::size_t i = 0; i < this->files.size(); ++i)
    {
      times.push_back(static_cast<double>(i));
    }
    const double range[] = { times.front(), times.back() };
    vtkInformation* info = outputs->GetInformationObject(0);
    info->Set(
      vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    const double time =
      outputs->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(this->files[static_cast<std::size_t>(time)].c_str());
    reader->Update();
    vtkPolyData::GetData(outputs)->ShallowCopy(reader->GetOutput());
    return 1;
  }
};
vtkStandardNewMacro(Series);

int main(int argc, char* argv[])
{
  if (argc < 4)
  {
    std::cerr << "usage: vtk_time_example array step0.vtp step1.vtp ...\n";
    return EXIT_FAILURE;
  }
  vtkNew<Series> series;
  series->files.assign(argv + 2, argv + argc);

  vtkNew<vtkTriQuadDecimation> decimation; // runs once, for all time steps
  decimation->SetInputConnection(series->GetOutputPort());
  decimation->SetTargetReduction(0.96);
  decimation->AddScalars(argv[1]);

  vtkNew<vtkUndecimation> undecimation; // any level at any time
  undecimation->SetInputConnection(decimation->GetOutputPort());
  for (std::size_t time = 0; time < series->files.size(); ++time)
  {
    for (const double level : { 0.0, 0.5, 1.0 })
    {
      undecimation->SetLevel(level);
      undecimation->UpdateTimeStep(static_cast<double>(time));
      std::cout << "time " << time << ", level " << level << ": "
                << undecimation->GetNumberOfNodes() << " nodes, "
                << undecimation->GetNumberOfQuads() << " quads, error " << undecimation->GetError()
                << " of the diagonal\n";
    }
  }
  return EXIT_SUCCESS;
}
