# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two-sided Hausdorff and RMS distance of any mesh to a reference, by the same samples for all.

Closest points (Open3D's RaycastingScene, Embree, float32, the reference moved to its centre and
scaled to a unit diagonal of its bounding box) from the vertices, at most half the samples, and
area-weighted random points of each surface to the other one. A sampled maximum is a lower bound of
the Hausdorff distance; all tools get the same samples of the reference and the same number of their own.
The random points are drawn from a fixed seed: a result is measured the same each time.

Embree's float32 closest points can be wrong by 0.01 % of the diagonal and more beside sliver triangles,
always towards too large a distance. So the largest distances are measured again in double precision
(vtkStaticCellLocator), from the top down until no sample left can be larger.

With a nodal array: |value interpolated at the closest point - value of the reference| at the samples of
the reference, as fractions of its range. faults() looks for flipped, folded and degenerate triangles.
"""
import numpy as np
import open3d as o3d
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from rivals import poly_data

VERSION = 2  # of the measure: results in the cache are of one version
FAULTS_VERSION = 2  # of faults()
REFERENCE_SAMPLES = 300_000
SAMPLES = 200_000
NEGLIGIBLE = 1e-6  # of the diagonal: rounding of the float32 coordinates


FACING = .996  # minus the cosine of two normals: the triangles lie on each other within 5 degrees
LONGEST = 1e6  # aspect ratio of a triangle without area
FLAT = 1e-6  # 2 area / longest edge^2 of a triangle that counts as degenerate


class Reference:
    def __init__(self, points, triangles, values=None):
        points = np.asarray(points, float)
        low, high = points.min(0), points.max(0)
        self.center, self.diagonal = .5 * (low + high), float(np.linalg.norm(high - low))
        v = self._unit(points)
        self.surface = Surface(v, triangles)
        self.samples = Samples(v, triangles, REFERENCE_SAMPLES, 1)
        self.topology = topology(triangles)
        self.height_field = _facing(v, triangles, -1) == 0
        self.normals = _unit_normals(points, triangles)
        pairs = _folded_pairs(np.asarray(triangles, np.int64), self.normals)
        self.has_folds = len(pairs[0]) > 0
        if self.has_folds:
            self.places = {place.tobytes(): i for i, place in enumerate(v)}
            numbers = self._nodes_at(v)[np.asarray(triangles)].tolist()
            self.own_triangles = {tuple(sorted(t)) for t in numbers}
            self.folded_edges = {tuple(sorted(set(numbers[a]) & set(numbers[b]))) for a, b in zip(*pairs)}
        self.values = None
        if values is not None:
            self.values = self.samples.interpolate(values)
            self.range = float(np.ptp(values))
            if self.range == 0:
                raise SystemExit("the nodal array is constant: there is no error to measure")

    def _unit(self, points):
        return ((np.asarray(points, float) - self.center) / self.diagonal).astype(np.float32)

    def _nodes_at(self, v):
        """Nodes of the reference at the same places, or -1 and less."""
        return np.array([self.places.get(place.tobytes(), -1 - i) for i, place in enumerate(np.ascontiguousarray(v))])

    def measure(self, points, triangles, values=None):
        """hausdorff, rms, ... as fractions of the diagonal, and what happened to the topology; with values
        of the nodes, the largest and mean error of the array as fractions of its range."""
        if len(triangles) == 0:
            return {"triangles": 0, "hausdorff": float("inf"), "rms": float("inf")}
        v = self._unit(points)
        surface = Surface(v, triangles)
        forth = surface.distance(self.samples.points)
        back = self.surface.distance(Samples(v, triangles, SAMPLES, 2).points)
        t = topology(triangles)
        out = {"triangles": len(triangles), "hausdorff": float(max(forth.max(), back.max())),
               "forth": float(forth.max()), "back": float(back.max()),
               "rms": float(max(np.sqrt((forth ** 2).mean()), np.sqrt((back ** 2).mean()))),
               "nonmanifold": t["nonmanifold"] - self.topology["nonmanifold"],
               "euler": t["euler"] - self.topology["euler"]}
        if self.height_field:
            out["flipped"] = _facing(v, triangles, -1)
        if values is not None:
            cell, weights = surface.closest(self.samples.points)
            error = np.abs((np.asarray(values, float)[triangles[cell]] * weights).sum(1) - self.values) / self.range
            out["value_largest"], out["value_mean"] = float(error.max()), float(error.mean())
        return out

    def faults(self, points, triangles):
        """Triangles that no decimator should make, and the shape of all. `flipped` face against the
        reference wherever they are compared: at seven points of the triangle, each with the normal of the closest
        triangle of the reference. `folded` counts edges whose two triangles lie on each other where the
        reference's do not. What is a fold of the reference itself, triangle or edge, does not count: at a fold
        of no width the closest triangle may be the other one."""
        v, triangles = self._unit(points), np.asarray(triangles, np.int64)
        corners = v[triangles].astype(float)
        normals = _unit_normals(points, triangles)
        center = corners.mean(1)
        facing = np.full(len(triangles), -np.inf)
        for at in np.r_[np.eye(3), .5 * (1 - np.eye(3)), np.full((1, 3), 1 / 3)]:
            # A little inside, so that the corner of a sharp edge is compared with its own side.
            at = .95 * at + .05 / 3
            cell, _ = self.surface.closest((corners * at[:, None]).sum(1))
            below = self.normals[cell]
            facing = np.maximum(facing, (normals * below).sum(1))
        first, second = _folded_pairs(triangles, normals)
        if self.has_folds:
            ids = self._nodes_at(v)
            facing[[tuple(sorted(t)) in self.own_triangles for t in ids[triangles].tolist()]] = 1
            own = [tuple(sorted(set(a) & set(b))) in self.folded_edges
                   for a, b in zip(ids[triangles[first]].tolist(), ids[triangles[second]].tolist())]
            first, second = first[~np.array(own, bool)], second[~np.array(own, bool)]
        below = [self.normals[self.surface.closest(center[some])[0]] for some in (first, second)]
        thin, aspect = shape(points, triangles)
        return {"flipped_near": int((facing < 0).sum()), "folded": int(((below[0] * below[1]).sum(1) > -.5).sum()),
                "degenerate": int((thin < FLAT).sum()), "aspect": float(np.median(aspect)),
                "aspect_95": float(np.quantile(aspect, .95))}


class Samples:
    """Vertices (at most half) and random points of a surface, with their place in it."""

    def __init__(self, v, triangles, count, seed):
        rng = np.random.default_rng(seed)
        used = np.unique(triangles)
        self.nodes = used if len(used) <= count // 2 else rng.choice(used, count // 2, replace=False)
        t = v[triangles].astype(float)
        area = np.cumsum(np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1))
        inner = min(count // 2, 4 * len(triangles) + 20000)
        cell = np.minimum(np.searchsorted(area, rng.random(inner) * area[-1]), len(triangles) - 1)
        a, b = rng.random((2, inner))
        outside = a + b > 1
        a[outside], b[outside] = 1 - a[outside], 1 - b[outside]
        self.corners, self.weights = triangles[cell], np.c_[1 - a - b, a, b]
        self.points = self.interpolate(v).astype(np.float32)

    def interpolate(self, values):
        """Of nodal values (one or more components) at the samples."""
        values = np.asarray(values)
        inner = values[self.corners].astype(float)
        weights = self.weights.reshape(self.weights.shape + (1,) * (values.ndim - 1))
        return np.concatenate([values[self.nodes].astype(float), (inner * weights).sum(1)])


class Surface:
    def __init__(self, v, triangles):
        self.v, self.triangles, self.locator = v, triangles, None
        self.scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        self.scene.add_triangles(o3d.core.Tensor(np.ascontiguousarray(v, np.float32)),
                                 o3d.core.Tensor(np.ascontiguousarray(triangles, np.uint32)))

    def distance(self, samples):
        """Distances of the samples; the largest one, and those it took to find it, in double precision."""
        q = self.scene.compute_closest_points(o3d.core.Tensor(np.ascontiguousarray(samples)))
        d = np.linalg.norm(q["points"].numpy().astype(float) - samples, axis=1)
        largest = 0.0
        for i in np.argsort(-d):
            if d[i] <= max(largest, NEGLIGIBLE):
                break
            d[i] = min(d[i], self._exact(samples[i]))
            largest = max(largest, d[i])
        return d

    def closest(self, samples):
        """Triangles closest to the samples and the weights of their corners there."""
        q = self.scene.compute_closest_points(o3d.core.Tensor(np.ascontiguousarray(samples, np.float32)))
        uv = q["primitive_uvs"].numpy().astype(float)
        return q["primitive_ids"].numpy().astype(np.int64), np.c_[1 - uv.sum(1), uv]

    def _exact(self, x):
        if self.locator is None:
            self.cell, self.sub, self.square = reference(0), reference(0), reference(0.0)
            data = poly_data(self.v.astype(float), self.triangles)
            self.locator = vtkStaticCellLocator()
            self.locator.SetDataSet(data)
            self.locator.BuildLocator()
        self.locator.FindClosestPoint([float(c) for c in x], [0.0] * 3, self.cell, self.sub, self.square)
        return float(self.square.get()) ** .5


def _facing(v, triangles, sign):
    """Triangles whose normal has a z of the sign."""
    t = v[triangles].astype(float)
    z = ((t[:, 1, 0] - t[:, 0, 0]) * (t[:, 2, 1] - t[:, 0, 1])
         - (t[:, 1, 1] - t[:, 0, 1]) * (t[:, 2, 0] - t[:, 0, 0]))
    return int((sign * z > 1e-12).sum())


def topology(triangles):
    f = np.asarray(triangles, np.int64)
    n = int(f.max()) + 1
    e = np.sort(np.r_[f[:, :2], f[:, 1:], f[:, ::2]], axis=1)
    keys, counts = np.unique(e[:, 0] * n + e[:, 1], return_counts=True)
    return {"nonmanifold": int((counts > 2).sum()), "border": int((counts == 1).sum()),
            "euler": int(len(np.unique(f)) - len(keys) + len(f))}


def _unit_normals(points, triangles):
    t = np.asarray(points, float)[triangles]
    n = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    return n / np.maximum(np.linalg.norm(n, axis=1), 1e-300)[:, None]


def _folded_pairs(triangles, normals):
    """Triangles with a common edge that lie on each other."""
    first, second = _pairs(triangles)
    onto = (normals[first] * normals[second]).sum(1) < -FACING
    return first[onto], second[onto]


def shape(points, triangles):
    """2 area / longest edge^2, and the aspect ratio longest edge / (2 sqrt(3) radius of the inscribed
    circle), which is 1 for the equilateral triangle and at most LONGEST."""
    t = np.asarray(points, float)[triangles]
    edges = np.stack([np.linalg.norm(t[:, i] - t[:, i - 1], axis=1) for i in range(3)], axis=1)
    area = .5 * np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1)
    longest = np.maximum(edges.max(1), 1e-300)
    radius = 2 * area / np.maximum(edges.sum(1), 1e-300)
    return 2 * area / longest ** 2, np.minimum(longest / np.maximum(2 * np.sqrt(3) * radius, 1e-300), LONGEST)


def _pairs(triangles):
    """The two triangles of each edge that has two."""
    n = int(triangles.max()) + 1
    e = np.sort(np.r_[triangles[:, :2], triangles[:, 1:], triangles[:, ::2]], axis=1)
    keys = e[:, 0] * n + e[:, 1]
    order = np.argsort(keys, kind="stable")
    _, start, counts = np.unique(keys[order], return_index=True, return_counts=True)
    first = start[counts == 2]
    return order[first] % len(triangles), order[first + 1] % len(triangles)
