# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the Python tests share: meshes, exact comparison, caught messages. Needs VTK only."""

import contextlib

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING, vtkIntArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

ASSOCIATIONS = ("GetPointData", "GetCellData")


def grid(rows=30, seed=1, time=0.0):
    """A bumpy grid of triangles with point and cell data of several types."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:rows, 0:rows].astype(float)
    z = 2 * np.sin(0.4 * x + time) * np.cos(0.3 * y)
    coordinates = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    coordinates += random.uniform(-0.2, 0.2, coordinates.shape)
    corner = (np.arange(rows - 1)[:, None] * rows + np.arange(rows - 1)).reshape(-1, 1)
    triangles = np.concatenate(
        [corner + [0, 1, rows], corner + [rows + 1, rows, 1]], axis=1
    ).reshape(-1, 3)

    mesh = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(coordinates, deep=True))
    mesh.SetPoints(points)
    offsets = np.arange(0, 3 * len(triangles) + 1, 3)
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtk(offsets.astype(np.int64), deep=True),
        numpy_to_vtk(triangles.astype(np.int64).ravel(), deep=True),
    )
    mesh.SetPolys(cells)

    stress = numpy_to_vtk(np.exp(-0.01 * (coordinates**2).sum(axis=1)), deep=True)
    stress.SetName("stress")
    mesh.GetPointData().SetScalars(stress)
    displacement = numpy_to_vtk(random.normal(size=(rows * rows, 3)).astype(np.float32), deep=True)
    displacement.SetName("displacement")
    mesh.GetPointData().SetVectors(displacement)
    names = vtkStringArray()
    names.SetName("name")
    for i in range(rows * rows):
        names.InsertNextValue(f"node {i}")
    mesh.GetPointData().AddArray(names)
    part = vtkIntArray()
    part.SetName("part")
    for i in range(len(triangles)):
        part.InsertNextValue(i)
    mesh.GetCellData().AddArray(part)
    return mesh


def values(array):
    """An array's values for comparison: numbers as bytes, so that NaN equals NaN."""
    if array.GetDataType() == VTK_STRING:
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    return vtk_to_numpy(array).tobytes()


def signature(array):
    return (
        array.GetName(),
        array.GetDataTypeSize(),
        array.GetNumberOfComponents(),
        array.GetNumberOfTuples(),
    )


def differences(a, b):
    """What differs between two meshes, bit by bit; field data is not compared."""
    found = []
    if signature(a.GetPoints().GetData())[1:] != signature(b.GetPoints().GetData())[1:]:
        return ["kind of points"]
    if values(a.GetPoints().GetData()) != values(b.GetPoints().GetData()):
        found.append("coordinates")
    for kind in ("Verts", "Lines", "Polys", "Strips"):
        first, second = (getattr(mesh, "Get" + kind)() for mesh in (a, b))
        if first.GetNumberOfCells() != second.GetNumberOfCells():
            found.append(f"number of {kind}")
        elif first.GetNumberOfCells() and not all(
            np.array_equal(vtk_to_numpy(getattr(first, get)()), vtk_to_numpy(getattr(second, get)()))
            for get in ("GetOffsetsArray", "GetConnectivityArray")
        ):
            found.append(kind)
    for association in ASSOCIATIONS:
        first, second = (getattr(mesh, association)() for mesh in (a, b))
        if first.GetNumberOfArrays() != second.GetNumberOfArrays():
            found.append(f"number of arrays in {association}")
            continue
        for i in range(first.GetNumberOfArrays()):
            x, y = first.GetAbstractArray(i), second.GetAbstractArray(i)
            if signature(x) != signature(y) or values(x) != values(y):
                found.append(f"{association} {x.GetName()} / {y.GetName()}")
        for active in ("GetScalars", "GetVectors"):
            names = [getattr(data, active)() for data in (first, second)]
            if len({name and name.GetName() for name in names}) > 1:
                found.append(f"active {active}")
    return found


def snapshot(mesh):
    """A copy that no later execution changes."""
    copy = vtkPolyData()
    copy.DeepCopy(mesh)
    return copy


@contextlib.contextmanager
def messages(algorithm):
    """The errors and warnings of an algorithm, as (kind, text)."""
    caught = []

    def keep(_, event, text):
        caught.append((event, text))

    keep.CallDataType = "string0"
    tags = [algorithm.AddObserver(event, keep) for event in ("ErrorEvent", "WarningEvent")]
    executive = algorithm.GetExecutive()
    quiet = executive.AddObserver("ErrorEvent", lambda *_: None)
    try:
        yield caught
    finally:
        for tag in tags:
            algorithm.RemoveObserver(tag)
        executive.RemoveObserver(quiet)
