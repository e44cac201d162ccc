# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters' classes from Python: levels, numpy, files, other processes, refused inputs."""

import os
import pathlib
import subprocess
import tempfile

import numpy as np
import pytest
from undecimate.vtkUndecimateFilters import (
    vtkHashQueueDecimation,
    vtkProgressiveMeshDecimation,
    vtkTriQuadDecimation,
    vtkUndecimation,
)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

from meshes import differences, grid, messages, snapshot

HERE = pathlib.Path(__file__).resolve().parent
PLATE = str(HERE.parents[1] / "Data" / "plate_hole.vtp")
PYTHON3 = os.environ.get("UNDECIMATE_PYTHON3", "/usr/bin/python3")


def load(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def save(mesh, path, mode="Binary", compressor="ZLib"):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(mesh)
    writer.SetFileName(str(path))
    getattr(writer, f"SetDataModeTo{mode}")()
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    assert writer.Write() == 1


def readable_modes():
    """VTK 9.2 cannot read back its own appended data with an expat that delays its callbacks (from 2.6,
    and Debian 12's since 2.5.0-1+deb12u5). Then no file of that mode can be tested, ours or another."""
    mesh = grid()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "appended.vtp")
        save(mesh, path, "Appended")
        if load(path).GetNumberOfPoints() == mesh.GetNumberOfPoints():
            return ["Ascii", "Binary", "Appended"]
    print("This VTK does not read appended data: that mode is left out.")
    return ["Ascii", "Binary"]


MODES = readable_modes()


def decimate(mesh, reduction=0.9):
    decimation = vtkHashQueueDecimation()
    decimation.SetInputData(mesh)
    decimation.SetTargetReduction(reduction)
    with messages(decimation) as said:
        decimation.Update()
    assert not said
    return decimation.GetOutput()


def undecimate(mesh, level):
    undecimation = vtkUndecimation()
    undecimation.SetInputData(mesh)
    undecimation.SetLevel(level)
    with messages(undecimation) as said:
        undecimation.Update()
    return undecimation.GetOutput(), said


def test_the_plate_comes_back_bit_for_bit():
    plate = load(PLATE)
    decimation = vtkHashQueueDecimation()
    decimation.SetInputData(plate)
    decimation.SetCriterionToScalarDifference()
    decimation.AddScalars("von_mises")
    undecimation = vtkUndecimation()
    undecimation.SetInputConnection(decimation.GetOutputPort())
    nodes = []
    for level in (0.0, 0.25, 0.5, 0.75, 1.0):
        undecimation.SetLevel(level)
        undecimation.Update()
        nodes.append(undecimation.GetNumberOfNodes())
        triangles = vtk_to_numpy(undecimation.GetOutput().GetPolys().GetConnectivityArray())
        assert triangles.max() < nodes[-1] and triangles.min() >= 0
    assert nodes == sorted(nodes) and nodes[-1] == 15559
    assert differences(undecimation.GetOutput(), plate) == []
    undecimation.SetLevel(0.0)
    undecimation.Update()
    assert differences(undecimation.GetOutput(), decimation.GetOutput()) == []


def test_a_level_is_the_same_from_anywhere():
    coarse = decimate(grid())
    undecimation = vtkUndecimation()
    undecimation.SetInputData(coarse)
    seen = {}
    random = np.random.default_rng(4)
    for level in [0.0, 1.0, *random.choice([0.0, 0.2, 0.4, 0.6, 0.8, 1.0], 30)]:
        undecimation.SetLevel(level)
        undecimation.Update()
        now = snapshot(undecimation.GetOutput())
        assert differences(seen.setdefault(float(level), now), now) == []


def test_numpy_arrays_of_a_level_stay_as_they_are():
    undecimation = vtkUndecimation()
    undecimation.SetInputData(decimate(grid()))
    undecimation.SetLevel(0.5)
    undecimation.Update()
    points = vtk_to_numpy(undecimation.GetOutput().GetPoints().GetData())
    before = points.copy()
    for level in (0.6, 1.0, 0.0, 0.4):
        undecimation.SetLevel(level)
        undecimation.Update()
    assert np.array_equal(points, before)


@pytest.mark.parametrize("compressor", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("mode", MODES)
def test_a_saved_mesh_undecimates_after_loading(tmp_path, mode, compressor):
    mesh = grid()
    save(decimate(mesh), tmp_path / "coarse.vtp", mode, compressor)
    fine, said = undecimate(load(tmp_path / "coarse.vtp"), 1.0)
    assert not said
    assert differences(fine, mesh) == []


@pytest.mark.parametrize("mode", MODES)
def test_another_program_undecimates_a_saved_mesh(tmp_path, mode):
    mesh = grid()
    save(mesh, tmp_path / "original.vtp")
    save(decimate(mesh), tmp_path / "coarse.vtp", mode)
    program = [PYTHON3, str(HERE / "undecimate_file.py")]
    files = [str(tmp_path / name) for name in ("coarse.vtp", "original.vtp")]
    done = subprocess.run(program + files, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr

    # The program can tell a difference.
    save(grid(seed=2), tmp_path / "original.vtp")
    done = subprocess.run(program + files, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and "coordinates" in done.stdout


def test_a_file_with_a_wrong_number_is_refused(tmp_path):
    path = tmp_path / "coarse.vtp"
    save(decimate(grid()), path, "Ascii", "None")
    text = path.read_text()
    name = text.index('Name="Undecimation.HoleCodes"')
    start = text.index(">", name) + 1
    end = text.index("<", start)
    numbers = text[start:end].split()
    numbers[len(numbers) // 2] = str((int(numbers[len(numbers) // 2]) + 1) % 256)
    path.write_text(text[:start] + " ".join(numbers) + text[end:])
    fine, said = undecimate(load(path), 1.0)
    assert [event for event, _ in said] == ["ErrorEvent"]
    assert "is damaged" in said[0][1]
    assert fine.GetNumberOfPoints() == 0


@pytest.mark.parametrize("mode", MODES)
def test_a_truncated_file_is_refused(tmp_path, mode, capfd):
    """By VTK's reader, which then gives an empty mesh, or by the filter: never half a mesh."""
    path = tmp_path / "coarse.vtp"
    save(decimate(grid()), path, mode)
    whole = path.read_bytes()
    for share in (0.1, 0.5, 0.9, 0.99):
        path.write_bytes(whole[: int(share * len(whole))])
        capfd.readouterr()
        fine, said = undecimate(load(path), 1.0)
        assert said or "ERR|" in capfd.readouterr().err, share
        assert fine.GetNumberOfPoints() == 0 and fine.GetNumberOfCells() == 0, share


def test_a_changed_mesh_is_refused_with_the_reason():
    coarse = snapshot(decimate(grid()))
    vtk_to_numpy(coarse.GetPointData().GetArray("stress"))[5] += 1.0
    fine, said = undecimate(coarse, 0.5)
    assert fine.GetNumberOfPoints() == 0 and fine.GetNumberOfCells() == 0
    assert len(said) == 1 and "point array 'stress' changed" in said[0][1]


def test_a_mesh_without_a_record_is_refused():
    fine, said = undecimate(grid(), 0.5)
    assert fine.GetNumberOfPoints() == 0
    assert len(said) == 1 and "Hash Queue Decimation" in said[0][1]


def test_a_missing_array_is_named_with_those_that_are_there():
    decimation = vtkHashQueueDecimation()
    decimation.SetInputData(grid())
    decimation.AddScalars("temperature")
    with messages(decimation) as said:
        decimation.Update()
    assert decimation.GetOutput().GetNumberOfPoints() == 0
    assert len(said) == 1
    assert "'temperature'" in said[0][1] and "'stress', 'displacement', 'name'" in said[0][1]


def test_progress_is_monotone_and_an_abort_gives_nothing():
    mesh = grid(rows=100)
    decimation = vtkHashQueueDecimation()
    decimation.SetInputData(mesh)
    progress = []
    decimation.AddObserver("ProgressEvent", lambda d, _: progress.append(d.GetProgress()))
    decimation.Update()
    assert len(progress) > 10
    assert progress == sorted(progress)

    aborted = vtkHashQueueDecimation()
    aborted.SetInputData(mesh)
    aborted.AddObserver("ProgressEvent", lambda d, _: d.SetAbortExecute(1))
    with messages(aborted) as said:
        aborted.Update()
    assert not said
    assert aborted.GetOutput().GetNumberOfPoints() == 0
    assert aborted.GetOutput(1).GetNumberOfPoints() == 0


def test_blocks_of_a_composite_come_back_each():
    blocks = vtkMultiBlockDataSet()
    meshes = [grid(seed=i) for i in range(3)]
    for i, mesh in enumerate(meshes):
        blocks.SetBlock(i, mesh)
    decimation = vtkHashQueueDecimation()
    decimation.SetInputDataObject(blocks)
    undecimation = vtkUndecimation()
    undecimation.SetInputConnection(decimation.GetOutputPort())
    for level in (0.3, 1.0):
        undecimation.SetLevel(level)
        undecimation.Update()
    output = undecimation.GetOutputDataObject(0)
    for i, mesh in enumerate(meshes):
        assert differences(output.GetBlock(i), mesh) == []
    assert undecimation.GetNumberOfNodes() == sum(mesh.GetNumberOfPoints() for mesh in meshes)
    assert decimation.GetNumberOfInputNodes() == undecimation.GetNumberOfNodes()


def test_the_decimations_share_a_superclass():
    for cls in vtkHashQueueDecimation, vtkTriQuadDecimation:
        assert issubclass(cls, vtkProgressiveMeshDecimation)
        decimation = cls()
        decimation.AddScalars("stress")
        decimation.SetTargetReduction(0.5)
        assert decimation.GetScalars(0) == "stress" and decimation.GetTargetReduction() == 0.5
    with pytest.raises(TypeError):
        vtkProgressiveMeshDecimation()


def test_the_wrapped_classes_are_documented():
    for cls, words in (
        (vtkHashQueueDecimation, ["Krivograd", "Undecimation.", "vtkOriginalPointIds"]),
        (vtkTriQuadDecimation, ["Wundrak", "Undecimation.", "vtkOriginalPointIds"]),
        (vtkProgressiveMeshDecimation, ["superclass", "Undecimation.", "vtkOriginalPointIds"]),
        (vtkUndecimation, ["bit for bit", "Level"]),
    ):
        for word in words:
            assert word in cls.__doc__
