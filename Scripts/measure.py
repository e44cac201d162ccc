# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""How far a simplified mesh is from its original: distance both ways, and the error of a nodal array.

Independent of the filters: it knows two triangle meshes and nothing of records. Only NumPy.

    errors = Comparison(original).errors(simplified)          # both are a Mesh
    errors.hausdorff, errors.largest, errors.mean

Both surfaces are sampled: at all nodes, on all edges and inside all triangles, about as densely as
the original's elements and their edges lie. Each sample's closest point on the other surface is exact
(a grid of buckets, searched outwards until nothing nearer can come). Sampling sees the largest
error from below; a higher density shows by how much.
"""

from collections import namedtuple

import numpy as np

Mesh = namedtuple("Mesh", "points triangles values")
Mesh.__doc__ = "points (n, 3), triangles (m, 3), values (n,): one nodal scalar"

Errors = namedtuple("Errors", "hausdorff largest mean")
Errors.__doc__ = """hausdorff: two-sided, in the unit of the points. largest, mean: of the difference of the
nodal array between the original's samples and their closest points, in the array's unit; the mean is
weighted by area."""

PAIRS_AT_ONCE = 400_000  # bounds the memory of the search


def dot(u, v):
    return np.einsum("ij,ij->i", u, v)


def closest_on_triangles(p, triangles):
    """Squared distance of each point to its triangle, and the weights of the triangle's second and
    third corner at the closest point. `triangles`: rows of Surface.rows."""
    ap, ab, ac = p - triangles[:, :3], triangles[:, 3:6], triangles[:, 6:9]
    d00, d01, d11 = triangles[:, 9], triangles[:, 10], triangles[:, 11]
    d20, d21 = dot(ap, ab), dot(ap, ac)
    with np.errstate(divide="ignore", invalid="ignore"):
        area = d00 * d11 - d01 * d01
        v = (d11 * d20 - d01 * d21) / area
        w = (d00 * d21 - d01 * d20) / area
    outside = np.flatnonzero(~((v >= 0) & (w >= 0) & (v + w <= 1)))
    if len(outside):
        # the closest point is on an edge: the best of three
        d00, d01, d11, d20, d21 = (x[outside] for x in (d00, d01, d11, d20, d21))
        tiny = np.finfo(float).tiny
        s = np.clip(d20 / np.maximum(d00, tiny), 0, 1)
        t = np.clip(d21 / np.maximum(d11, tiny), 0, 1)
        u = np.clip((d21 - d20 + d00 - d01) / np.maximum(d00 - 2 * d01 + d11, tiny), 0, 1)
        zero = np.zeros_like(s)
        choices_v = np.stack([s, zero, 1 - u])
        choices_w = np.stack([zero, t, u])
        # less the square of ap, which is the same for all three
        distance = (choices_v * (choices_v * d00 + 2 * (choices_w * d01 - d20)) +
                    choices_w * (choices_w * d11 - 2 * d21))
        best = distance.argmin(0), np.arange(len(outside))
        v[outside], w[outside] = choices_v[best], choices_w[best]
    away = ap - v[:, None] * ab - w[:, None] * ac
    return dot(away, away), v, w


class Surface:
    """Closest points on a triangle mesh. Triangles are listed in the buckets of a uniform grid."""

    def __init__(self, mesh, buckets):
        """buckets: about how many of them the surface should touch."""
        self.mesh = mesh
        corners = mesh.points[mesh.triangles]
        ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        #: per triangle: first corner, two edges, their products
        self.rows = np.column_stack(
            [corners[:, 0], ab, ac, dot(ab, ab), dot(ab, ac), dot(ac, ac)])
        low, high = mesh.points.min(0), mesh.points.max(0)
        area = np.linalg.norm(np.cross(ab, ac), axis=1).sum() / 2
        self.size = max(np.sqrt(area / buckets), np.linalg.norm(high - low) / 1000)
        self.low = low - 0.5 * self.size
        self.shape = np.floor((high - self.low) / self.size).astype(int) + 1
        first = np.floor((corners.min(1) - self.low) / self.size).astype(int)
        last = np.floor((corners.max(1) - self.low) / self.size).astype(int)
        keys, triangles = self.blocks(first, last)
        # leave out buckets of the bounding box that the triangle itself does not reach
        centre = (self.unpack(keys) + 0.5) * self.size + self.low
        near = closest_on_triangles(centre, self.rows[triangles])[0]
        keep = near <= 0.75 * self.size**2 * (1 + 1e-9)  # half the diagonal of a bucket
        keys, triangles = keys[keep], triangles[keep]
        order = np.argsort(keys, kind="stable")
        self.triangles = triangles[order]
        self.starts = np.searchsorted(keys[order], np.arange(self.shape.prod() + 1))

    def pack(self, i):
        return (i[..., 0] * self.shape[1] + i[..., 1]) * self.shape[2] + i[..., 2]

    def unpack(self, key):
        i, z = np.divmod(key, self.shape[2])
        x, y = np.divmod(i, self.shape[1])
        return np.stack([x, y, z], -1)

    def blocks(self, first, last):
        """All buckets of the blocks [first, last] that are in the grid: keys, owner of each."""
        first, last = np.maximum(first, 0), np.minimum(last, self.shape - 1)
        extent = np.maximum(last - first + 1, 0)
        count = extent.prod(1)
        owner, local = expand(count)
        extent = extent[owner]
        local, z = np.divmod(local, extent[:, 2])
        x, y = np.divmod(local, extent[:, 1])
        return self.pack(first[owner] + np.stack([x, y, z], -1)), owner

    def closest(self, p):
        """Of each point: distance, closest triangle, weights of its second and third corner."""
        best = np.full(len(p), np.inf)
        triangle = np.zeros(len(p), int)
        v, w = np.zeros(len(p)), np.zeros(len(p))
        todo = np.arange(len(p))
        where = np.floor((p - self.low) / self.size).astype(int)
        ring = 0
        while len(todo):
            for part in np.array_split(todo, max(1, len(todo) * (2 * ring + 1)**2 // 60_000)):
                keys, owner = self.blocks(where[part] - ring, where[part] + ring)
                if ring:  # the inner buckets have been searched
                    inner = np.abs(self.unpack(keys) - where[part[owner]]).max(1) < ring
                    keys, owner = keys[~inner], owner[~inner]
                bucket, local = expand(self.starts[keys + 1] - self.starts[keys])
                candidate = self.triangles[self.starts[keys[bucket]] + local]
                owner = part[owner[bucket]]
                for i in range(0, len(owner), PAIRS_AT_ONCE):
                    o, t = owner[i:i + PAIRS_AT_ONCE], candidate[i:i + PAIRS_AT_ONCE]
                    d, dv, dw = closest_on_triangles(p[o], self.rows[t])
                    # the candidates of a point stand together: the nearest of each group
                    group = np.flatnonzero(np.r_[True, o[1:] != o[:-1]])
                    least = np.minimum.reduceat(d, group)
                    size = np.diff(np.r_[group, len(d)])
                    hits = np.flatnonzero(d == np.repeat(least, size))
                    firsts = hits[np.r_[True, o[hits][1:] != o[hits][:-1]]]
                    firsts = firsts[d[firsts] < best[o[firsts]]]
                    points = o[firsts]
                    best[points], triangle[points] = d[firsts], t[firsts]
                    v[points], w[points] = dv[firsts], dw[firsts]
            # what lies outside the searched block is at least this far
            offset = p[todo] - self.low - where[todo] * self.size
            reach = np.minimum(offset, self.size - offset).min(1) + ring * self.size
            todo = todo[best[todo] > reach**2]
            ring += 1
            if ring > self.shape.max() + np.abs(where).max():
                break
        return np.sqrt(best), triangle, v, w

    def values(self, triangle, v, w):
        corner = self.mesh.values[self.mesh.triangles[triangle]]
        return corner[:, 0] * (1 - v - w) + corner[:, 1] * v + corner[:, 2] * w


def expand(count):
    """For counts (2, 0, 3): owners 0 0 2 2 2 and local numbers 0 1 0 1 2."""
    owner = np.repeat(np.arange(len(count)), count)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)


def sample(mesh, spacing):
    """Points on a surface, their values, and their share of its area (0 on nodes and edges).

    All nodes; on each edge evenly spaced points, at least its midpoint; in each triangle the centroids
    of n * n equal parts. `spacing`: longest distance between neighbours on an edge, longest edge of a
    part."""
    x, t, f = mesh.points, mesh.triangles, mesh.values
    points, values, weights = [x], [f], [np.zeros(len(x))]

    edges = np.unique(np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), 1), axis=0)
    length = np.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1)
    parts = np.maximum(2, np.ceil(length / spacing).astype(int))
    owner, local = expand(parts - 1)
    i, j = edges[owner].T
    s = (local + 1) / parts[owner]
    points.append(x[i] * (1 - s)[:, None] + x[j] * s[:, None])
    values.append(f[i] * (1 - s) + f[j] * s)
    weights.append(np.zeros(len(s)))

    corners = x[t]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    longest = np.sqrt(((corners - np.roll(corners, 1, axis=1))**2).sum(2).max(1))
    parts = np.maximum(1, np.ceil(longest / spacing).astype(int))
    for n in np.unique(parts):
        which = np.flatnonzero(parts == n)
        i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
        i, j = i.ravel(), j.ravel()
        up, down = i + j < n, i + j < n - 1
        v = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / n
        w = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / n
        bary = np.stack([1 - v - w, v, w])
        points.append(np.einsum("kp,tkx->tpx", bary, corners[which]).reshape(-1, 3))
        values.append((f[t[which]] @ bary).ravel())
        weights.append(np.repeat(area[which] / n**2, n * n))
    return np.concatenate(points), np.concatenate(values), np.concatenate(weights)


class Comparison:
    """Errors of simplified meshes against one original, by dense samples of both."""

    def __init__(self, original, density=1.0):
        """density: samples per length, in units of the original's elements."""
        corners = original.points[original.triangles]
        edge = np.sqrt(((corners - np.roll(corners, 1, axis=1))**2).sum(2)).mean()
        self.spacing = 1.5 * edge / density
        self.buckets = len(original.triangles)
        self.samples = sample(original, self.spacing)
        self.surface = Surface(original, self.buckets)

    def errors(self, simplified):
        points, values, weights = self.samples
        surface = Surface(simplified, self.buckets)
        forth, triangle, v, w = surface.closest(points)
        error = np.abs(surface.values(triangle, v, w) - values)
        back = self.surface.closest(sample(simplified, self.spacing)[0])[0]
        return Errors(max(forth.max(), back.max()), error.max(), np.average(error, weights=weights))
