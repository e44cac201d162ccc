# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The installed Python package with plain VTK: decimate a mesh and bring it back.

python3 consumer.py MESH.vtp
"""

import sys

import numpy as np
from undecimate.vtkUndecimateFilters import vtkHashQueueDecimation, vtkUndecimation
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def arrays(mesh):
    """Points, corners of the triangles, and the point data by name."""
    found = {
        "points": vtk_to_numpy(mesh.GetPoints().GetData()),
        "corners": vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()),
    }
    data = mesh.GetPointData()
    for i in range(data.GetNumberOfArrays()):
        found["point data " + data.GetArrayName(i)] = vtk_to_numpy(data.GetArray(i))
    return found


reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
decimation = vtkHashQueueDecimation()
decimation.SetInputConnection(reader.GetOutputPort())
decimation.SetTargetReduction(0.9)
undecimation = vtkUndecimation()
undecimation.SetInputConnection(decimation.GetOutputPort())
undecimation.SetLevel(0.0)
undecimation.Update()
coarse = undecimation.GetOutput().GetNumberOfPolys()
undecimation.SetLevel(1.0)
undecimation.Update()

expected = arrays(reader.GetOutput())
result = arrays(undecimation.GetOutput())
if not 0 < 9 * coarse < reader.GetOutput().GetNumberOfPolys():
    sys.exit(f"{coarse} triangles at level 0")
if list(result) != list(expected):
    sys.exit(f"arrays at level 1: {list(result)} instead of {list(expected)}")
for name, values in expected.items():
    if values.dtype != result[name].dtype or not np.array_equal(values, result[name]):
        sys.exit(f"{name} at level 1 is not the input's")
print(f"{coarse} triangles at level 0; level 1 is the input")
