# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""How crash_box/ was made of the whole simulation:

    python3 reduce.py FOLDER_OF_THE_SIMULATION OUTPUT_FOLDER      (VTK's Python modules)

Five of its 31 time steps, one array, and values rounded to fewer bits, so that the files are small.
"""

import os
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

STEPS = 0, 8, 15, 22, 30
GRID = 2.0**-17  # 8 micrometres
ARRAY, BITS = "plastic_strain", 10


def rounded(values, grid):
    return numpy_to_vtk((np.round(values / grid) * grid).astype(np.float32), deep=1)


def main(source, target):
    steps = ElementTree.parse(os.path.join(source, "crash_box.pvd")).getroot().findall(".//DataSet")
    os.makedirs(target, exist_ok=True)
    lines = []
    for step in STEPS:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(source, steps[step].get("file")))
        reader.Update()
        whole = reader.GetOutput()
        mesh = vtkPolyData()
        points = vtkPoints()
        points.SetData(rounded(vtk_to_numpy(whole.GetPoints().GetData()).astype(float), GRID))
        mesh.SetPoints(points)
        mesh.SetPolys(whole.GetPolys())
        mesh.GetPolys().ConvertTo32BitStorage()
        values = rounded(vtk_to_numpy(whole.GetPointData().GetArray(ARRAY)).astype(float), 2.0**-BITS)
        values.SetName(ARRAY)
        mesh.GetPointData().SetScalars(values)
        name = f"crash_box_{step:02}.vtp"
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(mesh)
        writer.SetFileName(os.path.join(target, name))
        writer.SetDataModeToBinary()
        writer.SetCompressorTypeToLZMA()
        writer.SetCompressionLevel(9)
        if not writer.Write():
            sys.exit("cannot write " + name)
        lines.append(f'    <DataSet timestep="{float(steps[step].get("timestep")):.6f}" file="{name}"/>')
    with open(os.path.join(target, "crash_box.pvd"), "w") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
                   + "\n".join(lines) + "\n  </Collection>\n</VTKFile>\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
