# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two-sided Hausdorff and RMS distance of any mesh to a reference, by the same samples for all.

Closest points (Open3D's RaycastingScene, Embree, float32, the reference moved to its centre and
scaled to a unit diagonal of its bounding box) from the vertices, at most half the samples, and
area-weighted random points of each surface to the other one. A sampled maximum is a lower bound of
the Hausdorff distance; all tools get the same samples of the reference and the same number of their own.

Embree's float32 closest points can be wrong by 0.01 % of the diagonal and more beside sliver triangles,
always towards too large a distance. So the largest distances are measured again in double precision
(vtkStaticCellLocator), from the top down until no sample left can be larger.
"""
import numpy as np
import open3d as o3d
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from rivals import poly_data

VERSION = 2  # of the measure: results in the cache are of one version
REFERENCE_SAMPLES = 300_000
SAMPLES = 200_000
NEGLIGIBLE = 1e-6  # of the diagonal: rounding of the float32 coordinates


class Reference:
    def __init__(self, points, triangles):
        points = np.asarray(points, float)
        low, high = points.min(0), points.max(0)
        self.center, self.diagonal = .5 * (low + high), float(np.linalg.norm(high - low))
        v = self._unit(points)
        self.surface = Surface(v, triangles)
        self.samples = _samples(v, triangles, REFERENCE_SAMPLES, 1)
        self.topology = topology(triangles)
        self.height_field = _facing(v, triangles, -1) == 0

    def _unit(self, points):
        return ((np.asarray(points, float) - self.center) / self.diagonal).astype(np.float32)

    def measure(self, points, triangles):
        """hausdorff, rms, ... as fractions of the diagonal, and what happened to the topology."""
        if len(triangles) == 0:
            return {"triangles": 0, "hausdorff": float("inf"), "rms": float("inf")}
        v = self._unit(points)
        forth = Surface(v, triangles).distance(self.samples)
        back = self.surface.distance(_samples(v, triangles, SAMPLES, 2))
        t = topology(triangles)
        out = {"triangles": len(triangles), "hausdorff": float(max(forth.max(), back.max())),
               "forth": float(forth.max()), "back": float(back.max()),
               "rms": float(max(np.sqrt((forth ** 2).mean()), np.sqrt((back ** 2).mean()))),
               "nonmanifold": t["nonmanifold"] - self.topology["nonmanifold"],
               "euler": t["euler"] - self.topology["euler"]}
        if self.height_field:
            out["flipped"] = _facing(v, triangles, -1)
        return out


def _samples(v, triangles, count, seed):
    rng = np.random.default_rng(seed)
    used = np.unique(triangles)
    nodes = used if len(used) <= count // 2 else rng.choice(used, count // 2, replace=False)
    t = v[triangles].astype(float)
    area = np.cumsum(np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1))
    inner = min(count // 2, 4 * len(triangles) + 20000)
    cell = np.minimum(np.searchsorted(area, rng.random(inner) * area[-1]), len(triangles) - 1)
    a, b = rng.random((2, inner))
    outside = a + b > 1
    a[outside], b[outside] = 1 - a[outside], 1 - b[outside]
    w = np.c_[1 - a - b, a, b]
    return np.r_[v[nodes], (t[cell] * w[:, :, None]).sum(1).astype(np.float32)].astype(np.float32)


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
