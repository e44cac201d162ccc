# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Both filters in ParaView's pipeline: the main job, files, time, blocks."""

import os
import pathlib
import subprocess

import pytest
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from meshes import differences, grid, snapshot

HERE = pathlib.Path(__file__).resolve().parent
PLATE = str(HERE.parents[1] / "Data" / "plate_hole.vtp")
PYTHON3 = os.environ.get("UNDECIMATE_PYTHON3", "/usr/bin/python3")


@pytest.fixture(autouse=True)
def empty_session():
    yield
    simple.ResetSession()


def source(mesh):
    producer = simple.TrivialProducer()
    producer.GetClientSideObject().SetOutput(mesh)
    return producer


def fetch(proxy, port=0):
    proxy.UpdatePipeline()
    return proxy.GetClientSideObject().GetOutputDataObject(port)


def update_information(proxy):
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()


def test_the_main_job():
    plate = simple.OpenDataFile(PLATE)
    decimation = simple.HashQueueDecimation(Input=plate, Scalars=["von_mises"], TargetReduction=0.9)
    undecimation = simple.Undecimation(Input=decimation)
    before = 0
    for level in (0.0, 0.3, 0.6, 1.0):
        undecimation.Level = level
        update_information(undecimation)
        assert undecimation.NumberOfNodes > before
        before = undecimation.NumberOfNodes
    assert before == 15559
    assert undecimation.Error == 0.0
    update_information(decimation)
    assert decimation.NumberOfInputNodes == 15559
    assert decimation.StopReason == "target reduction"
    assert differences(fetch(undecimation), fetch(plate)) == []


def test_saved_by_paraview_and_undecimated_without_it(tmp_path):
    mesh = grid()
    original = str(tmp_path / "original.vtp")
    coarse = str(tmp_path / "coarse.vtp")
    mesh_source = source(mesh)
    simple.SaveData(original, proxy=mesh_source, DataMode="Binary")
    decimation = simple.HashQueueDecimation(Input=mesh_source)
    simple.SaveData(coarse, proxy=decimation, DataMode="Binary")
    done = subprocess.run(
        [PYTHON3, str(HERE / "undecimate_file.py"), coarse, original],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_level_change_does_not_run_the_decimation():
    decimation = simple.HashQueueDecimation(Input=source(grid()))
    undecimation = simple.Undecimation(Input=decimation)
    fetch(undecimation)
    runs = []
    decimation.GetClientSideObject().AddObserver("StartEvent", lambda *_: runs.append(1))
    for level in (0.2, 0.9, 1.0, 0.1):
        undecimation.Level = level
        fetch(undecimation)
    assert not runs


def test_each_time_step_comes_back(tmp_path):
    times = (0.0, 0.5, 1.0)
    meshes = [grid(time=time) for time in times]
    entries = []
    for i, (time, mesh) in enumerate(zip(times, meshes)):
        simple.SaveData(str(tmp_path / f"step{i}.vtp"), proxy=source(mesh), DataMode="Binary")
        entries.append(f'<DataSet timestep="{time}" file="step{i}.vtp"/>')
    (tmp_path / "steps.pvd").write_text(
        '<VTKFile type="Collection" version="0.1"><Collection>'
        + "".join(entries)
        + "</Collection></VTKFile>"
    )
    reader = simple.PVDReader(FileName=str(tmp_path / "steps.pvd"))
    undecimation = simple.Undecimation(Input=simple.HashQueueDecimation(Input=reader), Level=1.0)
    for i in (0, 1, 2, 1, 0):
        undecimation.UpdatePipeline(times[i])
        output = undecimation.GetClientSideObject().GetOutputDataObject(0)
        assert differences(output, meshes[i]) == []
    information = undecimation.GetClientSideObject().GetOutputInformation(0)
    key = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    assert [information.Get(key, i) for i in range(information.Length(key))] == list(times)


def test_grouped_blocks_come_back():
    meshes = [grid(seed=i) for i in range(3)]
    group = simple.GroupDatasets(Input=[source(mesh) for mesh in meshes])
    decimation = simple.HashQueueDecimation(Input=group)
    undecimation = simple.Undecimation(Input=decimation, Level=1.0)
    output = fetch(undecimation)
    found = []
    iterator = output.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        found.append(snapshot(iterator.GetCurrentDataObject()))
        iterator.GoToNextItem()
    assert len(found) == 3
    for block, mesh in zip(found, meshes):
        assert differences(block, mesh) == []
    update_information(undecimation)
    assert undecimation.NumberOfNodes == 3 * 900


def test_a_filter_in_between_is_refused_with_what_to_do(capfd):
    decimation = simple.HashQueueDecimation(Input=source(grid()))
    moved = simple.Transform(Input=decimation)
    moved.Transform.Translate = [1.0, 0.0, 0.0]
    undecimation = simple.Undecimation(Input=moved, Level=1.0)
    assert fetch(undecimation).GetNumberOfPoints() == 0
    assert "Apply Undecimation to the output of Hash Queue Decimation" in capfd.readouterr().err


def test_the_coarse_mesh_has_no_record():
    decimation = simple.HashQueueDecimation(Input=source(grid()))
    record = fetch(decimation).GetFieldData().GetNumberOfArrays()
    assert record > 10
    assert fetch(decimation, 1).GetFieldData().GetNumberOfArrays() == 0
    assert differences(fetch(decimation, 1), fetch(decimation)) == []
    kept = simple.Undecimation(Input=decimation, Level=0.4)
    assert fetch(kept).GetFieldData().GetNumberOfArrays() == 0


def test_quads_are_triangulated_on_request(capfd):
    plane = simple.Plane(XResolution=20, YResolution=20)
    decimation = simple.HashQueueDecimation(Input=plane)
    assert fetch(decimation).GetNumberOfPoints() == 0
    assert "400 quads" in capfd.readouterr().err
    decimation.Triangulate = 1
    fine = fetch(simple.Undecimation(Input=decimation, Level=1.0))
    assert fine.GetNumberOfPolys() == 800
    assert fine.GetNumberOfPoints() == 441


def test_pieces_fit_together():
    """As each of two processes would ask for its piece: the nodes of the seam stay in both."""
    sphere = simple.Sphere(ThetaResolution=40, PhiResolution=40)
    decimation = simple.HashQueueDecimation(Input=sphere, TargetReduction=1.0)
    fine, coarse = [], []
    for algorithm, found in ((sphere, fine), (decimation, coarse)):
        algorithm = algorithm.GetClientSideObject()
        for piece in (0, 1):
            algorithm.UpdatePiece(piece, 2, 0)
            points = vtk_to_numpy(algorithm.GetOutputDataObject(0).GetPoints().GetData())
            found.append({tuple(point) for point in points.tolist()})
    seam = fine[0] & fine[1]
    assert len(seam) > 20
    assert seam <= coarse[0] and seam <= coarse[1]
    assert len(coarse[0]) < len(fine[0])
