# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of the benchmarks: the grid, the data set, and the driver's file format."""
import os

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DATA = os.environ.get("UNDECIMATE_DATA", os.path.join(ROOT, "..", "shared", "data"))
STATIC = ("fea_bracket", "linkrod", "notch", "plate_hole")
CACHE = os.path.join(os.environ.get("XDG_CACHE_HOME", os.path.expanduser("~/.cache")), "undecimate")


def grid(n):
    """n x n height field over [0,1]^2: points, triangles, scalar with peaks off the relief's."""
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="xy")
    x, y = x.ravel(), y.ravel()
    z = (0.10 * np.sin(3 * np.pi * x) * np.cos(2 * np.pi * y)
         + 0.05 * np.exp(-((x - .7) ** 2 + (y - .3) ** 2) / .005)
         + 0.02 * np.sin(11 * np.pi * x * y))
    s = (np.exp(-((x - .25) ** 2 + (y - .25) ** 2) / .01)
         + .7 * np.exp(-((x - .6) ** 2 + (y - .75) ** 2) / .003) + .3 * x * y)
    i = np.arange((n - 1) * (n - 1))
    a = (i // (n - 1)) * n + i % (n - 1)
    f = np.empty((2 * len(a), 3), np.int32)
    f[0::2] = np.c_[a, a + 1, a + n + 1]
    f[1::2] = np.c_[a, a + n + 1, a + n]
    return np.c_[x, y, z], f, s


def data_set():
    """Names of all triangle meshes of the data set that are there."""
    names = []
    folder = os.path.join(DATA, "triangles")
    if os.path.isdir(folder):
        names += sorted(f[:-4] for f in os.listdir(folder) if f.endswith(".vtp"))
    return names + [s for s in STATIC if os.path.exists(os.path.join(DATA, "static", s + ".vtp"))]


def find(name):
    """File of a mesh of the data set, or None; the plate is also in Data/."""
    folders = [os.path.join(DATA, kind) for kind in ("triangles", "static", "large")] + [os.path.join(ROOT, "Data")]
    candidates = [os.path.join(folder, name + ".vtp") for folder in folders] + [name]
    return next((c for c in candidates if os.path.exists(c)), None)


def path(name):
    file = find(name)
    if file is None:
        raise SystemExit(f"no mesh '{name}': not in {DATA}, not in Data/, not a file")
    return file


def load(name, array=None):
    """Points (as stored) and triangles (int32) of a mesh: gridN, a name of the data set, or a file. With
    the name of a nodal array of one component (grid: any name) also its values."""
    if name.startswith("grid") and name[4:].isdigit():
        points, triangles, values = grid(int(name[4:]))
        return (points, triangles) if array is None else (points, triangles, values)
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path(name))
    reader.Update()
    out = reader.GetOutput()
    polys = out.GetPolys()
    if polys.GetMaxCellSize() != 3:
        raise SystemExit(f"{name}: not triangles only")
    triangles = vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3).astype(np.int32)
    mesh = np.array(vtk_to_numpy(out.GetPoints().GetData())), triangles
    if array is None:
        return mesh
    values = out.GetPointData().GetArray(array)
    if values is None or values.GetNumberOfComponents() != 1:
        raise SystemExit(f"{name}: no nodal array '{array}' of one component")
    return (*mesh, np.array(vtk_to_numpy(values)))


def write(name, points, triangles, values=None):
    """The driver's format (decimate_cli.cpp). Written aside and renamed: jobs may race for it."""
    points = np.ascontiguousarray(points)
    values = np.empty(0, np.float32) if values is None else np.ascontiguousarray(values, np.float32)
    head = np.array([len(points), len(triangles), points.itemsize, len(values) // len(points), 0, 0],
                    np.int64)
    aside = f"{name}.{os.getpid()}"
    with open(aside, "wb") as out:
        for a in (head, points, np.ascontiguousarray(triangles, np.int32), values):
            a.tofile(out)
    os.replace(aside, name)


def read(name):
    with open(name, "rb") as f:
        n, m, size = np.fromfile(f, np.int64, 6)[:3]
        points = np.fromfile(f, np.float32 if size == 4 else np.float64, 3 * n).reshape(-1, 3)
        return points, np.fromfile(f, np.int32, 3 * m).reshape(-1, 3)


def read_values(name):
    """The nodal array of a mesh file, one value per node; None if it has none."""
    with open(name, "rb") as f:
        n, m, size, components = np.fromfile(f, np.int64, 6)[:4]
        f.seek(3 * n * size + 12 * m, os.SEEK_CUR)
        values = np.fromfile(f, np.float32, components * n)
    return values if components == 1 else None
