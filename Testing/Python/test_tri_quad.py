# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Triangles and quads over time in ParaView's pipeline: two sliders, files, Warp By Vector."""

import numpy as np
import pytest
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from meshes import differences

ROWS, STEPS = 25, 7


@pytest.fixture(autouse=True)
def empty_session():
    yield
    simple.ResetSession()


def tube(step):
    """A tube of quads with some triangles that is crushed over time."""
    j, i = np.mgrid[0:ROWS, 0:ROWS]
    angle = 2 * np.pi * i / ROWS
    crush = step / (STEPS - 1)
    radius = 5 + 0.6 * crush * np.sin(6 * np.pi * j / ROWS) * np.cos(2 * angle)
    still = np.stack([5 * np.cos(angle), 5 * np.sin(angle), 1.0 * j], axis=-1).reshape(-1, 3)
    moved = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), j * (1 - 0.4 * crush)], axis=-1
    ).reshape(-1, 3)
    cells = vtkCellArray()
    for row in range(ROWS - 1):
        for column in range(ROWS):
            a, b = row * ROWS + column, row * ROWS + (column + 1) % ROWS
            if (row + 2 * column) % 9 == 0:
                cells.InsertNextCell(3, (a, b, b + ROWS))
                cells.InsertNextCell(3, (b + ROWS, a + ROWS, a))
            else:
                cells.InsertNextCell(4, (a, b, b + ROWS, a + ROWS))
    mesh = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(moved.astype(np.float32), deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    for name, values in (
        ("displacement", (moved - still).astype(np.float32)),
        ("strain", crush * np.exp(-0.01 * (j.ravel() - 12.0) ** 2)),
    ):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        mesh.GetPointData().AddArray(array)
    return mesh


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tube")
    lines = []
    for step in range(STEPS):
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(tube(step))
        writer.SetFileName(str(folder / f"tube_{step}.vtp"))
        writer.SetDataModeToBinary()
        assert writer.Write()
        lines.append(f'<DataSet timestep="{0.1 * step}" part="0" file="tube_{step}.vtp"/>')
    pvd = folder / "tube.pvd"
    pvd.write_text(
        '<VTKFile type="Collection" version="0.1"><Collection>'
        + "".join(lines)
        + "</Collection></VTKFile>"
    )
    return str(pvd)


def fetch(proxy, time):
    proxy.UpdatePipeline(time)
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def coordinates(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())


def test_two_sliders(series):
    reader = simple.OpenDataFile(series)
    decimation = simple.TriQuadDecimation(Input=reader)
    undecimation = simple.Undecimation(Input=decimation)
    sizes = {}
    for level in (0.0, 0.4, 1.0):
        undecimation.Level = level
        for step in (0, 6, 3, 5):
            mesh = fetch(undecimation, 0.1 * step)
            size = (mesh.GetNumberOfPoints(), mesh.GetNumberOfCells())
            assert sizes.setdefault(level, size) == size
            original = coordinates(tube(step))
            kept = {tuple(p) for p in original}
            assert all(tuple(p) in kept for p in coordinates(mesh))
            if level == 1.0:
                assert differences(mesh, fetch(reader, 0.1 * step)) == []
    assert sizes[0.0][0] == 63  # a tenth of 625
    undecimation.UpdatePropertyInformation()
    assert undecimation.NumberOfQuads + undecimation.NumberOfTriangles == sizes[1.0][1]
    decimation.UpdatePropertyInformation()
    assert decimation.UsedSteps == "0, 1, 2, 3, 4, 5, 6"


def test_the_reader_is_asked_once(series):
    reader = simple.OpenDataFile(series)
    decimation = simple.TriQuadDecimation(Input=reader)
    undecimation = simple.Undecimation(Input=decimation, Level=0.5)
    progress = []
    decimation.GetClientSideObject().AddObserver("ProgressEvent", lambda o, e: progress.append(1))
    fetch(undecimation, 0.0)
    walked = len(progress)
    assert walked > STEPS
    for step in (3, 1, 6):
        fetch(undecimation, 0.1 * step)
    assert len(progress) - walked < STEPS


def test_choice_of_steps(series):
    reader = simple.OpenDataFile(series)
    decimation = simple.TriQuadDecimation(Input=reader, StepChoice="Three")
    decimation.UpdatePipeline(0.0)
    decimation.UpdatePropertyInformation()
    assert decimation.UsedSteps == "0, 3, 6"
    decimation.StepChoice = "List"
    decimation.Steps = [5, 2]
    decimation.UpdatePipeline(0.0)
    decimation.UpdatePropertyInformation()
    assert decimation.UsedSteps == "2, 5"


def test_warp_by_vector(series):
    """Points that stay and are warped downstream give the picture of points that move."""
    reader = simple.OpenDataFile(series)
    upstream = simple.Undecimation(Input=simple.TriQuadDecimation(Input=reader), Level=0.3)
    back = simple.WarpByVector(Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=-1.0)
    still = simple.TriQuadDecimation(Input=back, Displacement="displacement")
    level = simple.Undecimation(Input=still, Level=0.3)
    forth = simple.WarpByVector(Input=level, Vectors=["POINTS", "displacement"])
    for step in (0, 4, 6):
        moved, warped = fetch(upstream, 0.1 * step), fetch(forth, 0.1 * step)
        # The same positions but for rounding; where two removals cost the same another node may go.
        assert moved.GetNumberOfPoints() == warped.GetNumberOfPoints()
        original = coordinates(tube(step))
        for p in coordinates(warped):
            assert np.abs(original - p).sum(axis=1).min() < 1e-4


def test_saved_mesh_holds_all_levels_of_its_step(series, tmp_path):
    reader = simple.OpenDataFile(series)
    decimation = simple.TriQuadDecimation(Input=reader)
    decimation.UpdatePipeline(0.4)
    file = str(tmp_path / "coarse.vtp")
    simple.SaveData(file, proxy=decimation, DataMode="Binary")
    loaded = simple.XMLPolyDataReader(FileName=[file])
    mesh = fetch(simple.Undecimation(Input=loaded, Level=1.0), 0.0)
    original = tube(4)
    assert (coordinates(mesh) == coordinates(original)).all()
    assert mesh.GetNumberOfCells() == original.GetNumberOfCells()
