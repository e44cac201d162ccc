# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts/measure.py against distances that are known, and against a search of all triangles."""

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "Scripts"))
import measure


def grid(n, height, value):
    """An n x n grid on the unit square, z and the nodal value as functions of x, y."""
    x, y = (v.ravel() for v in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    return measure.Mesh(np.stack([x, y, height(x, y)], 1), triangles, value(x, y))


def flat(x, y):
    return 0 * x


def test_same_mesh_has_no_error():
    mesh = grid(9, lambda x, y: np.sin(5 * x) * y, lambda x, y: x * y)
    assert measure.Comparison(mesh).errors(mesh) == pytest.approx((0, 0, 0), abs=1e-12)


def test_parallel_planes():
    low, high = grid(9, flat, lambda x, y: x), grid(3, lambda x, y: flat(x, y) + 0.25, lambda x, y: x)
    errors = measure.Comparison(low).errors(high)
    assert errors.hausdorff == pytest.approx(0.25)
    assert errors.largest == pytest.approx(0, abs=1e-12)


def test_distance_only_from_original_to_simplified():
    # a spike that the coarse mesh has lost: its tip sees the plane at its height
    spike = grid(11, lambda x, y: np.where((abs(x - 0.5) < 1e-9) & (abs(y - 0.5) < 1e-9), 0.3, 0), flat)
    assert measure.Comparison(spike).errors(grid(2, flat, flat)).hausdorff == pytest.approx(0.3)


def test_distance_only_from_simplified_to_original():
    # the coarse mesh covers a notch: the middle of the new edge is 0.5 from the original
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 0.0, 0], [0, 1, 0]], float)
    notched = measure.Mesh(points, np.array([[0, 3, 4], [3, 1, 2]]), np.zeros(5))
    covered = measure.Mesh(points, np.array([[0, 3, 4], [3, 1, 2], [3, 2, 4]]), np.zeros(5))
    # the farthest point of the cover's top edge from both flanks is its middle
    expected = abs(np.cross([0.5, -1], [0.5, 0]) / np.hypot(0.5, 1))
    found = measure.Comparison(notched, density=20).errors(covered).hausdorff
    assert found == pytest.approx(expected, rel=0.01)


def test_error_of_values():
    # x^2 on n nodes against its chord: largest 1/4 in the middle, 1/6 on average
    fine = grid(65, flat, lambda x, y: x * x)
    errors = measure.Comparison(fine).errors(grid(2, flat, lambda x, y: x * x))
    assert errors.hausdorff == pytest.approx(0, abs=1e-12)
    assert errors.largest == pytest.approx(0.25, rel=1e-3)
    assert errors.mean == pytest.approx(1 / 6, rel=1e-2)


@pytest.mark.parametrize("buckets", [1, 20, 5000])
def test_closest_points_by_exhaustion(buckets):
    random = np.random.default_rng(3)
    points = random.normal(size=(60, 3))
    triangles = np.array([random.choice(60, 3, replace=False) for _ in range(50)])
    triangles[0] = [5, 5, 9]  # degenerate
    mesh = measure.Mesh(points, triangles, points @ [1.0, 2.0, 3.0])
    surface = measure.Surface(mesh, buckets)
    queries = 2 * random.normal(size=(300, 3))
    distance, triangle, v, w = surface.closest(queries)
    every = np.array([
        measure.closest_on_triangles(np.broadcast_to(q, (50, 3)), surface.rows)[0] for q in queries])
    assert distance == pytest.approx(np.sqrt(every.min(1)), rel=1e-12)
    corners = points[triangles[triangle]]
    place = corners[:, 0] + v[:, None] * (corners[:, 1] - corners[:, 0]) + \
        w[:, None] * (corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(queries - place, axis=1) == pytest.approx(distance)
    # the value is linear in space, so it tells whether the weights are those of the place
    assert surface.values(triangle, v, w) == pytest.approx(place @ [1.0, 2.0, 3.0])


def test_closest_on_triangle_by_regions():
    # around the triangle (0,0) (2,0) (0,1): corners, edges, inside
    surface = measure.Surface(
        measure.Mesh(np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], float), np.array([[0, 1, 2]]),
                     np.zeros(3)), 1)
    cases = {(-3, -4, 0): 5, (5, -4, 0): 5, (-3, 5, 0): 5, (1, -2, 0): 2, (-2, 0.5, 0): 2,
             (0.25, 0.25, 7): 7, (2, 1, 0): 2 / np.sqrt(5)}
    found = surface.closest(np.array(list(cases), float))[0]
    assert found == pytest.approx(list(cases.values()))


def test_area_weights():
    mesh = grid(7, lambda x, y: 2 * x, flat)
    for spacing in (0.05, 0.2, 10):
        assert measure.sample(mesh, spacing)[2].sum() == pytest.approx(np.sqrt(5))
