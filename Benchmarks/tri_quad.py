# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables 1 to 3 of Wundrak et al. (2006), re-made on our series, and the scale of a million nodes.

    run.sh tri_quad [--parts static dynamic steps scale] [--tolerance 0.0002] [--every 5]

Distances: two-sided Hausdorff by CGAL (tri_quad_distance), to the tolerance, cells cut around their centers, in % of
the diagonal of the bounding box at the first step ("t0") and at the step itself ("own"). Rivals:
vtkQuadricDecimation on the triangulated mesh of one step (it moves nodes); fast-simplification,
decimating the first step and replaying the collapses on the others; quadrics of the last step alone.
"""
import argparse
import glob
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

import meshes
from rivals import poly_data

PERCENT = (1, 2, 4, 11)


def read_series(files):
    """Points of all steps, cells of four corners (-1 last in triangles), parts or None."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    points, cells, parts = [], None, None
    for file in files:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(file)
        reader.Update()
        data = reader.GetOutput()
        points.append(vtk_to_numpy(data.GetPoints().GetData()).astype(np.float32))
        if cells is None:
            offsets = vtk_to_numpy(data.GetPolys().GetOffsetsArray())
            corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
            sizes = np.diff(offsets)
            cells = np.full((len(sizes), 4), -1, np.int32)
            for size in (3, 4):
                rows = sizes == size
                cells[rows, :size] = corners[offsets[:-1][rows][:, None] + np.arange(size)]
            array = data.GetCellData().GetArray("part")
            parts = None if array is None else vtk_to_numpy(array).astype(np.int32)
    return np.array(points), cells, parts


def write_series(file, points, cells, parts=None):
    with open(file, "wb") as f:
        np.array([points.shape[1], len(cells), len(points), parts is not None], np.int64).tofile(f)
        points.astype(np.float32).tofile(f)
        cells.tofile(f)
        if parts is not None:
            parts.tofile(f)


def triangulated(cells):
    quads = cells[cells[:, 3] >= 0]
    return np.r_[cells[cells[:, 3] < 0][:, :3], quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]


def as_cells(triangles):
    return np.c_[triangles, np.full(len(triangles), -1)].astype(np.int32)


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command[:3])}: {done.stderr.strip()[-500:]}")
    return done.stdout


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder

    def steps_of(self, count):
        """The steps that are measured."""
        return sorted(set(range(0, count, self.args.every)) | {count - 1})

    def distances(self, series, steps, cells, points=None):
        """Largest distance in % of the diagonals: per step {step: (t0, own)}, and the largest of each."""
        level = os.path.join(self.folder, "level.cells")
        np.ascontiguousarray(cells, np.int32).tofile(level)
        command = [self.args.distance, series, ",".join(map(str, steps)), level, "--tolerance",
                   str(self.args.tolerance)]
        if points is not None:
            moved = os.path.join(self.folder, "moved.points")
            np.ascontiguousarray(points, np.float32).tofile(moved)
            command += ["--points", moved]
        rows = [[float(v) for v in line.split()] for line in run(command).splitlines()]
        header = np.fromfile(series, np.int64, 4)
        first = np.fromfile(series, np.float32, 3 * header[0], offset=32).reshape(-1, 3)
        diagonal = float(np.linalg.norm(np.ptp(first.astype(float), axis=0)))
        out = {int(s): (100 * max(a, b) / diagonal, 100 * max(a, b) / own) for s, a, b, own in rows}
        return out, max(v[0] for v in out.values()), max(v[1] for v in out.values())

    def ours(self, series, targets, *options):
        """The CLI's report and the cells of each level."""
        report = json.loads(run([self.args.cli, series, "--targets", ",".join(map(str, targets)), "--out",
                                 self.folder + "/ours_", *options]))
        cells = {t: np.fromfile(f"{self.folder}/ours_{t}.cells", np.int32).reshape(-1, 4) for t in targets}
        return report, cells


def quadric_decimation(points, triangles, nodes):
    """vtkQuadricDecimation to about so many nodes: points and triangles."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkQuadricDecimation
    data = poly_data(points, triangles)
    low, high, best = 0.0, 1.0, None
    for _ in range(12):
        f = vtkQuadricDecimation()
        f.SetTargetReduction(.5 * (low + high))
        f.SetInputData(data)
        f.Update()
        out = f.GetOutput()
        if out.GetNumberOfPoints() >= nodes:
            low, best = .5 * (low + high), out
        else:
            high = .5 * (low + high)
    best = best or out
    return (vtk_to_numpy(best.GetPoints().GetData()),
            vtk_to_numpy(best.GetPolys().GetConnectivityArray()).reshape(-1, 3))


def replay(points, triangles, nodes):
    """fast-simplification of the first step to about so many nodes, replayed on all: points, triangles."""
    import fast_simplification
    low, high, best = 0.0, .9999, None
    for _ in range(12):
        reduction = .5 * (low + high)
        p, t, collapses = fast_simplification.simplify(
            np.ascontiguousarray(points[0]), np.ascontiguousarray(triangles, np.int32), reduction,
            return_collapses=True)
        if len(p) >= nodes:
            low, best = reduction, collapses
        else:
            high = reduction
    moved = [fast_simplification.replay_simplification(
        np.ascontiguousarray(p), np.ascontiguousarray(triangles, np.int32), best)[:2] for p in points]
    if any(not np.array_equal(t, moved[0][1]) for _, t in moved):
        raise RuntimeError("the replay has several topologies")
    return np.array([p for p, _ in moved]), moved[0][1]


def static_table(bench, all_series):
    print("## Static: one step at 5 % of the nodes\n\nHausdorff distance in % of the diagonal; CPU seconds of ours.\n")
    print("| mesh | triangles | quads | Deviation | Quadrics | vtkQuadricDecimation | s | s |\n|---|--:|--:|--:|--:|--:|--:|--:|")
    out = []
    for name, (points, cells, _) in all_series.items():
        for step in sorted({0, len(points) - 1}):
            file = os.path.join(bench.folder, "static.series")
            write_series(file, points[step:step + 1], cells)
            nodes = round(.05 * points.shape[1])
            row = {"mesh": f"{name}.t{step}", "nodes": nodes}
            for criterion in ("deviation", "quadrics"):
                report, level = bench.ours(file, [nodes], "--criterion", criterion)
                row[criterion] = bench.distances(file, [0], level[nodes])[2]
                row[criterion + " cpu"] = report["cpu"]
                row[criterion + " nodes"] = report["levels"][0]["nodes"]
            p, t = quadric_decimation(points[step].astype(float), triangulated(cells), nodes)
            row["vtk"] = bench.distances(file, [0], as_cells(t), p[None])[2]
            note = "" if row["deviation nodes"] == nodes else f" ({row['deviation nodes']} nodes left)"
            print(f"| {row['mesh']}{note} | {(cells[:, 3] < 0).sum()} | {(cells[:, 3] >= 0).sum()} | "
                  f"{row['deviation']:.2f} | {row['quadrics']:.2f} | {row['vtk']:.2f} | "
                  f"{row['deviation cpu']:.2f} | {row['quadrics cpu']:.2f} |", flush=True)
            out.append(row)
    return out


def dynamic_table(bench, all_series):
    print("\n## Dynamic: all steps at 1, 2, 4 and 11 % of the nodes\n\nLargest distance over the measured steps, in % of the "
          "diagonal at t0 (own diagonal in brackets).\n")
    print("| series | nodes % | Deviation | Quadrics, maximum | Quadrics, sum | Quadrics, last step | replay |\n|---|--:|--:|--:|--:|--:|--:|")
    out = []
    for name, (points, cells, parts) in all_series.items():
        if len(points) < 2:
            continue
        file = os.path.join(bench.folder, name + ".series")
        write_series(file, points, cells, parts)
        steps = bench.steps_of(len(points))
        targets = [round(points.shape[1] * p / 100) for p in PERCENT]
        variants = {"Deviation": [], "maximum": ["--criterion", "quadrics"],
                    "sum": ["--criterion", "quadrics", "--error", "sum"],
                    "last": ["--criterion", "quadrics", "--steps", str(len(points) - 1)]}
        levels = {k: bench.ours(file, targets, *v) for k, v in variants.items()}
        for percent, target in zip(PERCENT, targets):
            row = {"series": name, "percent": percent}
            for key, (report, cells_of) in levels.items():
                per_step, t0, own = bench.distances(file, steps, cells_of[target])
                level = next(v for v in report["levels"] if v["target"] == target)
                row[key] = {"t0": t0, "own": own, "steps": per_step, "nodes": level["nodes"]}
            p, t = replay(points[steps], triangulated(cells), target)
            _, t0, own = bench.distances(file, steps, as_cells(t), p)
            row["replay"] = {"t0": t0, "own": own, "nodes": p.shape[1]}
            show = lambda r: (f"{r['t0']:.2f} ({r['own']:.2f})"
                              + ("" if r["nodes"] <= 1.02 * target + 2 else f" at {r['nodes']} nodes"))
            print(f"| {name} | {percent} | " + " | ".join(
                show(row[k]) for k in ("Deviation", "maximum", "sum", "last", "replay")) + " |", flush=True)
            out.append(row)
    return out


def steps_table(bench, all_series):
    print("\n## Which steps count\n\nDeviation on the first series; largest distance over the measured steps, in % of the diagonal at t0.\n")
    name, (points, cells, parts) = next((n, s) for n, s in all_series.items() if len(s[0]) > 2)
    file = os.path.join(bench.folder, name + ".series")
    write_series(file, points, cells, parts)
    last = len(points) - 1
    targets = [round(points.shape[1] * p / 100) for p in (1, 4, 6)]
    choices = {"all": [], f"t0, t{last // 2}, t{last}": ["--steps", f"0,{last // 2},{last}"],
               "automatic (1.1)": ["--automatic", "1.1"], "t0": ["--steps", "0"], f"t{last}": ["--steps", str(last)]}
    print("| steps | 1 % | 4 % | 6 % | CPU s |\n|---|--:|--:|--:|--:|")
    out = []
    for label, options in choices.items():
        report, level = bench.ours(file, targets, *options)
        values = [bench.distances(file, bench.steps_of(len(points)), level[t])[1] for t in targets]
        print(f"| {label}{': ' + report['used'] if 'automatic' in label else ''} | "
              + " | ".join(f"{v:.2f}" for v in values) + f" | {report['cpu']:.2f} |", flush=True)
        out.append({"steps": label, "t0": values, "cpu": report["cpu"], "used": report["used"]})
    return out


def scale_table(bench, all_series):
    print("\n## A million nodes\n\nThe crash box 110 times side by side, each copy bent by its own angle over time: "
          "25 of its steps. To 4 % of the nodes; reading excluded.\n")
    points, cells, _ = all_series["crash_box"]
    n = points.shape[1]
    file = os.path.join(bench.folder, "million.series")
    chosen = np.round(np.linspace(0, len(points) - 1, 25)).astype(int)
    size = np.ptp(points[0], axis=0)
    with open(file, "wb") as f:
        np.array([110 * n, 110 * len(cells), 25, 0], np.int64).tofile(f)
        for k, step in enumerate(chosen):
            for x in range(11):
                for y in range(10):
                    angle = .02 * k / 24 * np.sin(1.3 * x + .7 * y)
                    p = points[step].astype(float)
                    turned = np.c_[p[:, 0] * np.cos(angle) - p[:, 2] * np.sin(angle) + 2.5 * size[0] * x,
                                   p[:, 1] + 2.5 * size[1] * y,
                                   p[:, 0] * np.sin(angle) + p[:, 2] * np.cos(angle)]
                    turned.astype(np.float32).tofile(f)
        for tile in range(110):
            np.where(cells < 0, -1, cells + n * tile).astype(np.int32).tofile(f)
    target = round(.04 * 110 * n)
    print("| steps | nodes | CPU s | wall s | peak GiB | record MB | one level to the next by 1 %, ms |\n"
          "|---|--:|--:|--:|--:|--:|--:|")
    out = []
    for label, options in (("25", []), ("3", ["--steps", "0,12,24"])):
        report, _ = bench.ours(file, [target, target + round(.01 * 110 * n)], *options)
        print(f"| {label} | {report['nodes']} | {report['cpu']:.1f} | {report['wall']:.1f} | "
              f"{report['peak_kib'] / 2**20:.2f} | "
              f"{report['record'] / 1e6:.0f} | {1e3 * report['levels'][1]['move']:.1f} |", flush=True)
        out.append(report)
    return out


PARTS = {"static": static_table, "dynamic": dynamic_table, "steps": steps_table, "scale": scale_table}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--cli", required=True, help="the built tri_quad_cli (run.sh passes it)")
    a.add_argument("--distance", required=True, help="the built tri_quad_distance (needs CGAL)")
    a.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    a.add_argument("--tolerance", type=float, default=.0002, help="of the distances, in diagonals")
    a.add_argument("--every", type=int, default=5, help="measure every so many steps, the last one always")
    a.add_argument("--json", help="write all numbers to this file")
    args = a.parse_args()
    if not os.path.exists(args.distance):
        raise SystemExit("tri_quad_distance was not built: install libcgal-dev and run again")
    series = {name: sorted(glob.glob(os.path.join(meshes.DATA, pattern))) for name, pattern in
              (("crash_box", "dynamic/crash_box/*.vtp"), ("projectile", "dynamic/projectile_lsdyna/*.vtp"),
               ("wingbox", "static/wingbox.vtp"))}
    if not series["crash_box"]:
        raise SystemExit("The data set is absent (UNDECIMATE_DATA, else ../shared/data beside the repository).")
    loaded = {name: read_series(files) for name, files in series.items()}
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for part in args.parts:
            results[part] = PARTS[part](Bench(args, folder), loaded)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(results, f, indent=1)


if __name__ == "__main__":
    sys.exit(main())
