# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts/demo.py in pvpython: its numbers, its files, its pictures."""

import json
import struct

import numpy as np
import pytest
from PIL import Image

from running import run_script

PERCENT = [100, 75, 50, 25, 9.4]


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    return folder, run_script("demo.py", folder)


def test_numbers(demo):
    plate = json.loads((demo[0] / "plate.json").read_text())
    assert plate["exact"] is True
    levels = plate["levels"]
    assert [level["percent"] for level in levels] == PERCENT
    assert [level["nodes"] for level in levels] == [15559, 11669, 7780, 3890, 1463]
    assert levels[0]["triangles"] == 30458
    assert set(levels[0]) == {"percent", "nodes", "triangles", "bytes", "hausdorff", "stress_max",
                              "stress_mean", "seconds"}
    for finer, coarser in zip(levels, levels[1:]):
        assert finer["triangles"] > coarser["triangles"]
        assert finer["bytes"] > coarser["bytes"]
        assert finer["stress_max"] < coarser["stress_max"]
        assert finer["stress_mean"] < coarser["stress_mean"]
    # what is measured with the original mesh is nothing but rounding
    assert levels[0]["hausdorff"] < 1e-9 and levels[0]["stress_max"] < 1e-9
    # bounds, with room above 2.2e-4, 3.6e-3 and 6.7e-4
    assert levels[-1]["hausdorff"] < 1e-3
    assert levels[-1]["stress_max"] < 1e-2
    assert levels[-1]["stress_mean"] < 2e-3
    assert all(level["seconds"] > 0 for level in levels)


def test_files_have_the_reported_sizes(demo):
    for level in json.loads((demo[0] / "plate.json").read_text())["levels"]:
        assert (demo[0] / f"plate_hole_{level['percent']:g}.vtp").stat().st_size == level["bytes"]


def test_words(demo):
    assert "equal to the input bit for bit" in demo[1]
    for percent in PERCENT:
        assert f"{percent:5g} %" in demo[1]


def tile(path):
    """Left and right half of a level's picture: the mesh and the stress."""
    pixels = np.asarray(Image.open(path).convert("RGB")).astype(int)
    height, width = pixels.shape[:2]
    return pixels[:, :width * 46 // 100], pixels[:, width * 48 // 100:width * 93 // 100]


def dark(pixels):
    return (pixels.sum(2) < 500).mean()


def test_pictures_show_mesh_and_stress(demo):
    edges = []
    reference = None
    for percent in PERCENT:
        mesh, stress = tile(demo[0] / f"plate_hole_{percent:g}.png")
        edges.append(dark(mesh))
        colours = len(np.unique(stress.reshape(-1, 3), axis=0))
        assert colours > 20, f"{percent} %: the stress has {colours} colours"
        if reference is None:
            reference = stress
        # one colour map and one range: the bands stay where they are
        changed = (np.abs(stress - reference).sum(2) > 60)[120:].mean()
        assert changed < 0.05, f"{percent} %: {changed:.1%} of the stress picture differs"
    assert edges == sorted(edges, reverse=True), f"fewer edges at each level: {edges}"
    assert edges[-1] > 0.01


def test_overview(demo):
    data = (demo[0] / "plate_hole.png").read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    assert width > 2 * height
    assert len(data) < 400_000
