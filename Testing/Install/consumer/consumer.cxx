// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// Decimates a mesh, brings it back to level 1, and checks that it is the input: what a program does
// that has the installed package and plain VTK only.

#include <vtkCellArray.h>
#include <vtkHashQueueDecimation.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUndecimation.h>
#include <vtkXMLPolyDataReader.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "usage: consumer MESH.vtp\n";
    return EXIT_FAILURE;
  }

  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[1]);
  vtkNew<vtkHashQueueDecimation> decimation;
  decimation->SetInputConnection(reader->GetOutputPort());
  decimation->SetTargetReduction(0.9);
  vtkNew<vtkUndecimation> undecimation;
  undecimation->SetInputConnection(decimation->GetOutputPort());
  undecimation->SetLevel(0.0);
  undecimation->Update();
  const vtkIdType coarse = undecimation->GetOutput()->GetNumberOfPolys();
  undecimation->SetLevel(1.0);
  undecimation->Update();

  vtkPolyData* in = reader->GetOutput();
  vtkPolyData* out = undecimation->GetOutput();
  bool same = in->GetNumberOfPoints() == out->GetNumberOfPoints() &&
    in->GetNumberOfPolys() == out->GetNumberOfPolys();
  for (vtkIdType i = 0; same && i < in->GetNumberOfPoints(); ++i)
  {
    double a[3];
    double b[3];
    in->GetPoint(i, a);
    out->GetPoint(i, b);
    same = a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }
  for (vtkIdType i = 0; same && i < in->GetNumberOfPolys(); ++i)
  {
    vtkNew<vtkIdList> a;
    vtkNew<vtkIdList> b;
    in->GetPolys()->GetCellAtId(i, a);
    out->GetPolys()->GetCellAtId(i, b);
    same = a->GetNumberOfIds() == 3 && b->GetNumberOfIds() == 3 && a->GetId(0) == b->GetId(0) &&
      a->GetId(1) == b->GetId(1) && a->GetId(2) == b->GetId(2);
  }

  std::cout << in->GetNumberOfPolys() << " triangles, " << coarse << " at level 0, level 1 is "
            << (same ? "the input" : "NOT the input") << '\n';
  const bool decimated = coarse > 0 && coarse * 9 < in->GetNumberOfPolys();
  return same && decimated ? EXIT_SUCCESS : EXIT_FAILURE;
}
