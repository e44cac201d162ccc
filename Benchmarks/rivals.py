# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rivals, VTK's own decimators of a release build: rivals.py MESH RIVAL OUT.npz TRIANGLES REPS

Each run has a process of its own. Prints JSON: CPU seconds of Update() alone (median) and triangles.
"""
import json
import sys
import time

import numpy as np

SLOW = 2.0  # seconds; a longer run is not repeated
QUADRIC, PRO = "vtkQuadricDecimation", "vtkDecimatePro"


def poly_data(points, triangles, scalar=None):
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    out, nodes, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    nodes.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=1))
    out.SetPoints(nodes)
    out.SetPolys(cells)
    if scalar is not None:
        array = numpy_to_vtk(np.ascontiguousarray(scalar), deep=1)
        array.SetName("scalar")
        out.GetPointData().SetScalars(array)
    return out


def make(name, reduction):
    """The filter with its default settings; vtkDecimatePro keeps PreserveTopology off as it comes."""
    import vtkmodules.vtkFiltersCore as core
    f = getattr(core, name)()
    f.SetTargetReduction(reduction)
    return f


def run(data, name, triangles):
    f = make(name, 1.0 - triangles / data.GetNumberOfPolys())
    f.SetInputData(data)
    start = time.process_time()
    f.Update()
    return f.GetOutput(), time.process_time() - start


def main():
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion

    import meshes
    mesh, name, out, wanted, reps = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5])
    data = poly_data(*meshes.read(mesh))
    seconds = []
    while len(seconds) < reps and (not seconds or seconds[-1] < SLOW):
        result, cpu = run(data, name, wanted)
        seconds.append(cpu)
    triangles = vtk_to_numpy(result.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    np.savez(out, points=vtk_to_numpy(result.GetPoints().GetData()), triangles=triangles)
    print(json.dumps({"rival": name, "vtk": vtkVersion.GetVTKVersion(), "wanted": wanted,
                      "triangles": len(triangles), "cpu": float(np.median(seconds)), "runs": len(seconds)}))


if __name__ == "__main__":
    main()
