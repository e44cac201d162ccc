// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// The two filters in a VTK program: vtk_example in.vtp array out.vtp

#include "vtkHashQueueDecimation.h"
#include "vtkUndecimation.h"

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::cerr << "usage: vtk_example in.vtp array out.vtp\n";
    return EXIT_FAILURE;
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[1]);

  vtkNew<vtkHashQueueDecimation> decimation; // runs once
  decimation->SetInputConnection(reader->GetOutputPort());
  decimation->SetTargetReduction(0.95);
  decimation->AddScalars(argv[2]);

  vtkNew<vtkUndecimation> undecimation; // any level, at once
  undecimation->SetInputConnection(decimation->GetOutputPort());
  for (const double level : { 0.0, 0.5, 1.0 })
  {
    undecimation->SetLevel(level);
    undecimation->Update();
    std::cout << "level " << level << ": " << undecimation->GetOutput()->GetNumberOfPoints()
              << " nodes, error " << undecimation->GetError() << " of the diagonal\n";
  }

  vtkNew<vtkXMLPolyDataWriter> writer; // the coarse mesh with its record: all levels in one file
  writer->SetInputConnection(decimation->GetOutputPort());
  writer->SetFileName(argv[3]);
  writer->SetDataModeToBinary(); // read by every version of VTK and expat
  return writer->Write() ? EXIT_SUCCESS : EXIT_FAILURE;
}
