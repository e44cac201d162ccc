# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plate of Krivograd et al. 2003, table 2: decimated once, undecimated to each of its levels.

    pvpython Scripts/demo.py PLUGIN OUTPUT_FOLDER        (Scripts/demo.sh does all of it)
"""

import json
import os
import sys
import time

from paraview import simple as pv
from vtkmodules.util.numpy_support import vtk_to_numpy

import measure
import pictures

HERE = os.path.dirname(os.path.abspath(__file__))
INPUT = os.path.join(HERE, "..", "Data", "plate_hole.vtp")
STRESS = "von_mises"
PERCENT = [100, 75, 50, 25, 9.4]


def stop(message):
    sys.exit("demo: " + message)


def output(proxy):
    """The proxy's output and the CPU seconds that its update took."""
    start = time.process_time()
    proxy.UpdatePipeline()
    seconds = time.process_time() - start
    mesh = proxy.GetClientSideObject().GetOutputDataObject(0).NewInstance()
    mesh.ShallowCopy(proxy.GetClientSideObject().GetOutputDataObject(0))
    return mesh, seconds


def save(proxy, path):
    """Write a compressed .vtp file; its size."""
    # Not DataMode Appended: see Data/README.md.
    pv.SaveData(path, proxy=proxy, DataMode="Binary", CompressorType="ZLib", CompressionLevel="5")
    return os.path.getsize(path)


def arrays(mesh):
    """All that a mesh consists of, as (name, type, shape, bytes)."""
    found = [("points", mesh.GetPoints().GetData())]
    for kind, cells in (("verts", mesh.GetVerts()), ("lines", mesh.GetLines()),
                        ("polys", mesh.GetPolys()), ("strips", mesh.GetStrips())):
        if cells.GetNumberOfCells():
            found += [(kind, cells.GetOffsetsArray()), (kind, cells.GetConnectivityArray())]
    for kind, data in (("point data", mesh.GetPointData()), ("cell data", mesh.GetCellData()),
                       ("field data", mesh.GetFieldData())):
        found += [(kind + " " + data.GetArrayName(i), data.GetArray(i))
                  for i in range(data.GetNumberOfArrays())]
    result = []
    for name, array in found:
        values = vtk_to_numpy(array)
        result.append((name, array.GetDataTypeAsString(), values.shape, values.tobytes()))
    return result


def differences(a, b):
    """Names of what is not the same in two meshes, bit for bit."""
    a, b = arrays(a), arrays(b)
    if [x[0] for x in a] != [x[0] for x in b]:
        return ["names of the arrays: %s and %s" % ([x[0] for x in a], [x[0] for x in b])]
    return [x[0] for x, y in zip(a, b) if x != y]


def for_measuring(mesh):
    return measure.Mesh(
        vtk_to_numpy(mesh.GetPoints().GetData()).astype(float),
        vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3),
        vtk_to_numpy(mesh.GetPointData().GetArray(STRESS)).astype(float))


def main(plugin, folder):
    pv.LoadPlugin(plugin, remote=False, ns=pv.__dict__)
    reader = pv.XMLPolyDataReader(FileName=[INPUT])
    original, _ = output(reader)
    count = original.GetNumberOfPoints()
    low, high = original.GetPointData().GetArray(STRESS).GetRange()
    diagonal = original.GetLength()
    print(f"Data/plate_hole.vtp: {count:,} nodes, {original.GetNumberOfPolys():,} triangles, "
          f"{STRESS} {low:.0f} to {high:.0f} MPa\n")

    # Decimate once, as far as asked (the plate is flat, so the stress decides), and send the result through a file, as to a colleague.
    coarsest = round(count * min(PERCENT) / 100)
    decimation = pv.HashQueueDecimation(
        Input=reader, TargetReduction=1.0, TargetNodes=coarsest,
        Criterion="Deviation", Scalars=[STRESS])
    decimated, decimation_seconds = output(decimation)
    if decimated.GetNumberOfPoints() != coarsest:
        stop(f"asked for {coarsest} nodes, got {decimated.GetNumberOfPoints()}")
    progressive = os.path.join(folder, "plate_hole_decimated.vtp")
    progressive_bytes = save(decimation, progressive)

    # Every level comes out of that one file.
    undecimation = pv.Undecimation(Input=pv.XMLPolyDataReader(FileName=[progressive]), Level=0.0)
    output(undecimation)
    levels = []
    for percent in reversed(PERCENT):
        nodes = round(count * percent / 100)
        undecimation.Level = (nodes - coarsest) / (count - coarsest)
        mesh, seconds = output(undecimation)
        if mesh.GetNumberOfPoints() != nodes:
            stop(f"asked for {nodes} nodes at level {undecimation.Level}, "
                 f"got {mesh.GetNumberOfPoints()}")
        size = save(undecimation, os.path.join(folder, f"plate_hole_{percent:g}.vtp"))
        if percent == min(PERCENT):
            seconds = decimation_seconds
        levels.insert(0, (mesh, {
            "percent": percent, "nodes": nodes, "triangles": mesh.GetNumberOfPolys(),
            "bytes": size, "seconds": seconds}))
    different = differences(levels[0][0], original)
    undecimation.Level = 0.0
    back = differences(output(undecimation)[0], levels[-1][0])

    comparison = measure.Comparison(for_measuring(original))
    print("  level     nodes  triangles  .vtp bytes   Hausdorff     stress error        CPU time\n"
          "                                           distance   largest     mean")
    for mesh, row in levels:
        errors = comparison.errors(for_measuring(mesh))
        row.update(hausdorff=errors.hausdorff / diagonal, stress_max=errors.largest / (high - low),
                   stress_mean=errors.mean / (high - low))
        how = "decimation" if row["percent"] == min(PERCENT) else "undecimation"
        print(f"{row['percent']:5g} %  {row['nodes']:8,}  {row['triangles']:9,}  {row['bytes']:10,}  "
              f"{100 * row['hausdorff']:8.4f} %  {100 * row['stress_max']:6.2f} %  "
              f"{100 * row['stress_mean']:6.3f} %  {row['seconds']:6.3f} s {how}")
    print(f"""
Hausdorff distance: two-sided, measured by samples, % of the bounding box's diagonal ({diagonal:.1f} mm).
Stress error: against the original, at and between all its nodes, % of the range; at kept nodes it is zero.
Time: {min(PERCENT):g} % is the decimation of the original; each other level is the undecimation from the one
below it in the table. All come from one file of {progressive_bytes:,} bytes: the {min(PERCENT):g} % mesh with its record.
""")

    names = ["percent", "nodes", "triangles", "bytes", "hausdorff", "stress_max", "stress_mean",
             "seconds"]
    with open(os.path.join(folder, "plate.json"), "w") as file:
        json.dump({"levels": [{name: row[name] for name in names} for _, row in levels],
                   "exact": not different}, file, indent=2)
        file.write("\n")

    box = original.GetBounds()
    captions = []
    for mesh, row in levels:
        title = f"{row['percent']:g} % of the nodes"
        counts = f"{row['nodes']:,} nodes, {row['triangles']:,} triangles"
        captions.append((mesh, title, counts))
        loss = "the original" if row["percent"] == 100 else (
            f"error at most {100 * row['stress_max']:.2f} %, "
            f"on average {100 * row['stress_mean']:.3f} % of the range")
        pictures.draw_level(os.path.join(folder, f"plate_hole_{row['percent']:g}.png"), mesh, title,
                            (counts, "von Mises stress: " + loss), STRESS, "MPa", (low, high), box)
    pictures.draw_overview(os.path.join(folder, "plate_hole.png"), captions, STRESS, "MPa",
                           (low, high), box)

    if back:
        stop("after the way up and down, level 0 differs in " + ", ".join(back))
    if different:
        stop("level 1 differs from the input in " + ", ".join(different))
    print("Undecimated to level 1: equal to the input bit for bit (points, cells, all arrays).")


if __name__ == "__main__":
    main(*sys.argv[1:])
