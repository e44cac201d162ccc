# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts/crash.py in pvpython: what it says, its picture, its film."""

import re

import numpy as np
import pytest
from PIL import Image

from running import run_script


@pytest.fixture(scope="module")
def crash(tmp_path_factory):
    folder = tmp_path_factory.mktemp("crash")
    return folder, run_script("crash.py", folder)


def test_words(crash):
    assert "9,016 nodes, 5 time steps" in crash[1]
    assert "At level 1 each time step is equal to the input bit for bit." in crash[1]
    rows = re.findall(r"ms +(\d+) % +([\d,]+) nodes, ([\d,]+) quads, ([\d,]+) triangles", crash[1])
    assert len(rows) == 9
    # One topology for all times: a level has the same counts in each row of the picture.
    assert len(set(rows)) == 3
    assert rows[0][:2] == ("4", "361") and rows[1][:2] == ("18", "1,623")
    assert rows[2] == ("100", "9,016", "7,882", "2,024")


def bands(column):
    """Rows of a column of the picture that a mesh stands in: one (top, bottom) for each time."""
    shown = (np.abs(column - column[2, 2]).max(axis=2) > 25).any(axis=1)
    ends = np.flatnonzero(np.diff(np.concatenate(([0], shown, [0]))))
    return [(a, b) for a, b in zip(ends[::2], ends[1::2]) if b - a > 60]  # words are lower


def test_picture(crash):
    pixels = np.asarray(Image.open(crash[0] / "crash.png").convert("RGB")).astype(int)
    assert pixels.shape[0] > 700 and pixels.shape[1] > 600
    left, right = 110, 110  # as Scripts/crash.py lays it out
    wide = (pixels.shape[1] - left - right) // 3
    dark = []
    for column in range(3):
        tile = pixels[:, left + column * wide:][:, :wide]
        found = bands(tile)
        assert len(found) == 3
        first, middle, last = (b - a for a, b in found)
        assert middle < 0.7 * first and last < 0.9 * middle, "the box is crushed"
        dark.append([(tile[a:b].sum(axis=2) < 450).mean() for a, b in found])
    for coarse, medium, fine in zip(*dark):
        assert coarse < medium < fine, "more edges at finer levels"


def test_film(crash):
    film = (crash[0] / "crash.ogv").read_bytes()
    assert film.startswith(b"OggS") and b"theora" in film[:100]
    assert len(film) > 200_000
