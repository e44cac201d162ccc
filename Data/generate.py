#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the two generated meshes of this folder: flange.vtp and scan.vtp.

    pvpython Data/generate.py [FOLDER]

The same numbers come out every time (the noise has a fixed seed). VTK and NumPy are needed.
"""

import os
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def write(path, points, triangles, name, values):
    """A .vtp file: float coordinates, one float nodal array, zlib."""
    mesh = vtkPolyData()
    nodes = vtkPoints()
    nodes.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float32), deep=1))
    mesh.SetPoints(nodes)
    cells = vtkCellArray()
    corners = np.ascontiguousarray(triangles, np.int64)
    cells.SetData(3, numpy_to_vtkIdTypeArray(corners.ravel(), deep=1))
    mesh.SetPolys(cells)
    array = numpy_to_vtk(np.ascontiguousarray(values, np.float32), deep=1)
    array.SetName(name)
    mesh.GetPointData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(mesh)
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(9)
    writer.SetDataModeToBinary()  # see README.md
    if not writer.Write():
        sys.exit("cannot write " + path)
    print(f"{path}: {len(points)} nodes, {len(triangles)} triangles, {os.path.getsize(path)} bytes")


def flange():
    """A turned part (mm): bore, groove, hub with a fillet, six scallops in its rim.

    The profile is closed and runs around the axis: genus 1, sharp edges of 90 and 45 degrees.
    """
    fillet = [(22 + 8 * (1 - np.sin(t)), 12 + 8 * (1 - np.cos(t)))
              for t in np.linspace(0, np.pi / 2, 8)]
    corners = [(12, 0), (48, 0), (50, 2), (50, 10), (48, 12)] + fillet + [
        (22, 40), (20, 42), (14, 42), (12, 40), (12, 28), (15, 28), (15, 22), (12, 22)]
    profile = []
    for (r0, z0), (r1, z1) in zip(corners, corners[1:] + corners[:1]):
        pieces = max(1, round(np.hypot(r1 - r0, z1 - z0) / 1.6))
        profile += [(r0 + (r1 - r0) * i / pieces, z0 + (z1 - z0) * i / pieces)
                    for i in range(pieces)]
    profile = np.array(profile)
    turns, count = 96, len(profile)
    angle = 2 * np.pi * np.arange(turns) / turns
    radius = np.repeat(profile[None, :, 0], turns, 0)
    height = np.repeat(profile[None, :, 1], turns, 0)
    scallop = np.clip(np.cos(6 * angle), 0, None)[:, None] ** 2
    rim = np.clip((radius - 34) / 16, 0, 1)
    radius = radius - 4 * scallop * rim
    points = np.stack([radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None], height], -1)
    i, j = np.meshgrid(np.arange(turns), np.arange(count), indexing="ij")
    a, b = i * count + j, (i + 1) % turns * count + j
    c, d = (i + 1) % turns * count + (j + 1) % count, i * count + (j + 1) % count
    odd = ((i + j) % 2 == 1)[..., None]
    first = np.where(odd, np.stack([a, b, d], -1), np.stack([a, b, c], -1))
    second = np.where(odd, np.stack([b, c, d], -1), np.stack([a, c, d], -1))
    triangles = np.concatenate([first, second], -1).reshape(-1, 3)
    points = points.reshape(-1, 3)
    # steady conduction through a long hollow cylinder, warmer towards the top
    temperature = 80 - 45 * np.log(np.hypot(points[:, 0], points[:, 1]) / 11) + 0.4 * points[:, 2]
    return points, triangles, "temperature", temperature


def scan():
    """A bumpy closed surface with measurement noise along its normals, as a range scanner has it."""
    size, edge = 52, 2.6
    axis = np.linspace(-edge / 2, edge / 2, size)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    blobs = [(0, 0, 0, 0.62), (0.45, 0.25, 0.3, 0.42), (-0.5, 0.2, 0.15, 0.38),
             (0.05, -0.5, 0.35, 0.40), (0.1, 0.1, -0.6, 0.36), (-0.2, 0.55, -0.3, 0.30)]
    field = sum(np.exp(-((x - p) ** 2 + (y - q) ** 2 + (z - r) ** 2) / (0.5 * s * s))
                for p, q, r, s in blobs)
    field += 0.03 * np.sin(11 * x) * np.sin(9 * y) * np.sin(13 * z)
    image = vtkImageData()
    image.SetDimensions(size, size, size)
    image.SetSpacing((edge / (size - 1),) * 3)
    image.SetOrigin((-edge / 2,) * 3)
    values = numpy_to_vtk(field.ravel(), deep=1)
    values.SetName("field")
    image.GetPointData().SetScalars(values)
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.35)
    contour.Update()
    mesh = contour.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    normals = vtk_to_numpy(mesh.GetPointData().GetNormals())
    noise = np.random.default_rng(7).normal(0, 0.002, len(points))
    distance = np.linalg.norm(points, axis=1)
    return points + normals * noise[:, None], triangles, "distance", distance


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    write(os.path.join(folder, "flange.vtp"), *flange())
    write(os.path.join(folder, "scan.vtp"), *scan())
