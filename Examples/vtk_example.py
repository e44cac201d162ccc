# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The two filters in plain VTK Python: PYTHONPATH=... python3 vtk_example.py in.vtp array"""

import sys

from undecimate.vtkUndecimateFilters import vtkHashQueueDecimation, vtkUndecimation
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])

decimation = vtkHashQueueDecimation()  # runs once
decimation.SetInputConnection(reader.GetOutputPort())
decimation.SetTargetReduction(0.95)
decimation.AddScalars(sys.argv[2])

undecimation = vtkUndecimation()  # any level, at once
undecimation.SetInputConnection(decimation.GetOutputPort())
for level in (0.0, 0.5, 1.0):
    undecimation.SetLevel(level)
    undecimation.Update()
    print(f"level {level}: {undecimation.GetOutput().GetNumberOfPoints()} nodes, "
          f"error {undecimation.GetError():.5f} of the diagonal")
