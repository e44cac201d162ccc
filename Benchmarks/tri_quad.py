# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables 1 to 3 of Wundrak et al. (2006), re-made on our series, and the scale of a million nodes.

    run.sh tri_quad [static] [steps] [dynamic] [scale] [filter] [page] [--tolerance T] [--every N]

Without parts all of them. Each writes its raw results into results/tri_quad.json, and results/tri_quad.md is made of
that file alone (page: does nothing else), with the targets judged.

Distances: two-sided Hausdorff by CGAL (tri_quad_distance), too small by at most the tolerance or 1 % of themselves, cells
cut around their centers, in % of the diagonal of the bounding box at the first step ("t0") and at the step itself ("own").
Rivals: vtkQuadricDecimation on the triangulated mesh of one step (it moves nodes); fast-simplification, decimating the first
step and replaying the collapses on the others; quadrics of the last step alone.
"""
import argparse
import glob
import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import filters
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
        self.args, self.folder, self.files = args, folder, 0
        self.pool = ThreadPoolExecutor(args.jobs)

    def steps_of(self, count):
        """The steps that are measured."""
        return sorted(set(range(0, count, self.args.every)) | {count - 1})

    def file(self, name):
        self.files += 1
        return os.path.join(self.folder, f"{self.files}.{name}")

    def distances(self, series, steps, cells, points=None):
        """A future of the largest distance in % of the diagonals: at t0, of the own one, the step of the first, the
        mean over the steps, and the distances of the first, the middle and the last one."""
        level = self.file("cells")
        np.ascontiguousarray(cells, np.int32).tofile(level)
        command = [self.args.distance, series, ",".join(map(str, steps)), level, "--tolerance",
                   str(self.args.tolerance)]
        if points is not None:
            moved = self.file("points")
            np.ascontiguousarray(points, np.float32).tofile(moved)
            command += ["--points", moved]
        header = np.fromfile(series, np.int64, 4)
        first = np.fromfile(series, np.float32, 3 * header[0], offset=32).reshape(-1, 3)
        diagonal = float(np.linalg.norm(np.ptp(first.astype(float), axis=0)))

        def measure():
            rows = [[float(v) for v in line.split()] for line in run(command).splitlines()]
            largest = [max(forth, back) for _, forth, back, _ in rows]
            worst = int(np.argmax(largest))
            shares = [100 * d / diagonal for d in largest]
            return {"t0": shares[worst], "step": int(rows[worst][0]), "mean": float(np.mean(shares)),
                    "some": {str(steps[i]): shares[i] for i in sorted({0, len(steps) // 2, len(steps) - 1})},
                    "own": max(100 * d / r[3] for d, r in zip(largest, rows))}
        return self.pool.submit(measure)

    def ours(self, series, targets, *options):
        """The CLI's report and the cells of each level."""
        prefix = self.file("ours_")
        report = json.loads(run([self.args.cli, series, "--targets", ",".join(map(str, targets)), "--out", prefix,
                                 *options]))
        cells = {t: np.fromfile(f"{prefix}{t}.cells", np.int32).reshape(-1, 4) for t in targets}
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


def nodes_at(report, target):
    return next(v["nodes"] for v in report["levels"] if v["target"] == target)


# The parts: each returns what goes into the file of results.

def static(bench, all_series):
    rows = []
    for name, (points, cells, _) in all_series.items():
        for step in sorted({0, len(points) - 1}):
            file = bench.file("series")
            write_series(file, points[step:step + 1], cells)
            nodes = round(.05 * points.shape[1])
            row = {"mesh": f"{name}, step {step}", "nodes": nodes, "triangles": int((cells[:, 3] < 0).sum()),
                   "quads": int((cells[:, 3] >= 0).sum())}
            for criterion in ("deviation", "quadrics"):
                report, level = bench.ours(file, [nodes], "--criterion", criterion, "--threads", "1")
                row[criterion] = {**bench.distances(file, [0], level[nodes]).result(), "cpu": report["cpu"],
                                  "nodes": nodes_at(report, nodes)}
            p, t = quadric_decimation(points[step].astype(float), triangulated(cells), nodes)
            row["vtkQuadricDecimation"] = {**bench.distances(file, [0], as_cells(t), p[None]).result(),
                                           "nodes": len(p)}
            rows.append(row)
    return rows


def moving(all_series):
    return {name: series for name, series in all_series.items() if len(series[0]) > 1}


def dynamic(bench, all_series):
    rows = []
    for name, (points, cells, parts) in moving(all_series).items():
        file = bench.file("series")
        write_series(file, points, cells, parts)
        steps = bench.steps_of(len(points))
        last = ["--steps", str(len(points) - 1)]
        quadrics = ["--criterion", "quadrics"]
        variants = {"Deviation": [], "Quadrics, maximum": quadrics, "Quadrics, sum": [*quadrics, "--error", "sum"],
                    "Quadrics, last step": [*quadrics, *last]}
        targets = [round(points.shape[1] * p / 100) for p in PERCENT]
        levels = {key: bench.ours(file, targets, *options) for key, options in variants.items()}
        waiting = []
        for percent, target in zip(PERCENT, targets):
            row = {"series": name, "percent": percent, "target": target, "steps": len(steps)}
            for key, (report, cells_of) in levels.items():
                row[key] = {"nodes": nodes_at(report, target)}
                waiting.append((row[key], bench.distances(file, steps, cells_of[target])))
            p, t = replay(points[steps], triangulated(cells), target)
            row["replay"] = {"nodes": p.shape[1]}
            waiting.append((row["replay"], bench.distances(file, steps, as_cells(t), p)))
            rows.append(row)
        for cell, distance in waiting:
            cell.update(distance.result())
    return rows


def middle_steps(points):
    """The step that is farthest from the nearer of the first and the last, and the one farthest from a straight move."""
    def farthest(of):
        return 1 + int(np.argmax([of(step) for step in range(1, len(points) - 1)]))

    def move(a, b):
        return np.linalg.norm(a - b, axis=1).max()
    first, last = points[0].astype(float), points[-1].astype(float)

    def bend(step):
        share = step / (len(points) - 1)
        return move(points[step], (1 - share) * first + share * last)
    return farthest(lambda step: min(move(points[step], first), move(points[step], last))), farthest(bend)


def spread_steps(points, count):
    """First and last, then again and again the step that is farthest from those chosen (root mean square)."""
    def move(k):
        return np.sqrt(((points - points[k]).astype(float) ** 2).sum(axis=2).mean(axis=1))
    chosen = [0, len(points) - 1]
    far = np.minimum(move(0), move(len(points) - 1))
    while len(chosen) < min(count, len(points)):
        chosen.append(int(np.argmax(far)))
        far = np.minimum(far, move(chosen[-1]))
    return sorted(chosen)


STEP_PERCENT = (1, 4, 6)


def steps(bench, all_series):
    rows = []
    for name, (points, cells, parts) in moving(all_series).items():
        file = bench.file("series")
        write_series(file, points, cells, parts)
        last = len(points) - 1
        displaced, bent = middle_steps(points)
        choices = {"all": [], "three": ["--steps", f"0,{displaced},{last}"],
                   "first, last, farthest from a straight move": ["--steps", f"0,{bent},{last}"],
                   "eight": ["--steps", ",".join(map(str, spread_steps(points, 8)))],
                   "automatic (1.1)": ["--automatic", "1.1"], "first": ["--steps", "0"], "last": ["--steps", str(last)]}
        targets = [round(points.shape[1] * p / 100) for p in STEP_PERCENT]
        waiting = []
        for label, options in choices.items():
            report, level = bench.ours(file, targets, *options, "--threads", "1")
            waiting.append(({"series": name, "choice": label, "used": report["used"], "cpu": report["cpu"],
                             "nodes": [nodes_at(report, t) for t in targets], "targets": targets},
                            [bench.distances(file, bench.steps_of(len(points)), level[t]) for t in targets]))
        for row, futures in waiting:
            row["t0"] = [f.result()["t0"] for f in futures]
            row["mean"] = [f.result()["mean"] for f in futures]
            rows.append(row)
    return rows


SCALE_STEPS = 25


def write_million(bench, all_series):
    """The crash box 110 times side by side, each copy bent by its own angle over time."""
    points, cells, _ = all_series["crash_box"]
    n = points.shape[1]
    file = os.path.join(bench.folder, "million.series")
    if os.path.exists(file):
        return file, 110 * n
    chosen = np.round(np.linspace(0, len(points) - 1, SCALE_STEPS)).astype(int)
    size = np.ptp(points[0], axis=0)
    with open(file, "wb") as f:
        np.array([110 * n, 110 * len(cells), SCALE_STEPS, 0], np.int64).tofile(f)
        for k, step in enumerate(chosen):
            for x in range(11):
                for y in range(10):
                    angle = .02 * k / (SCALE_STEPS - 1) * np.sin(1.3 * x + .7 * y)
                    p = points[step].astype(float)
                    turned = np.c_[p[:, 0] * np.cos(angle) - p[:, 2] * np.sin(angle) + 2.5 * size[0] * x,
                                   p[:, 1] + 2.5 * size[1] * y,
                                   p[:, 0] * np.sin(angle) + p[:, 2] * np.cos(angle)]
                    turned.astype(np.float32).tofile(f)
        for tile in range(110):
            np.where(cells < 0, -1, cells + n * tile).astype(np.int32).tofile(f)
    return file, 110 * n


def scale(bench, all_series):
    file, nodes = write_million(bench, all_series)
    rows = []
    for options in ([], ["--steps", "0,12,24"]):
        report, _ = bench.ours(file, [round(.04 * nodes), round(.05 * nodes)], *options, "--threads", "2")
        rows.append({"steps": report["steps"], "nodes": report["nodes"], "cpu": report["cpu"], "wall": report["wall"],
                     "peak": 1024 * report["peak_kib"], "record": report["record"],
                     "level": report["levels"][1]["move"]})
    return rows


def whole_filter(bench, all_series):
    file, _ = write_million(bench, all_series)
    env = filters.environment(bench.args.build)
    done = subprocess.run([bench.args.python, os.path.abspath(__file__), "worker", file], env=env,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        raise SystemExit("filter: " + done.stderr.strip()[-800:])
    return json.loads(done.stdout.strip().splitlines()[-1])


def worker(file):
    """Changes of level and time with vtkUndecimation behind vtkTriQuadDecimation; the steps are in memory."""
    from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    import undecimate.vtkUndecimateFilters as module
    header = np.fromfile(file, np.int64, 4)
    count, cell_count, step_count = (int(v) for v in header[:3])
    cells = np.fromfile(file, np.int32, 4 * cell_count, offset=32 + 12 * count * step_count).reshape(-1, 4)
    offsets = np.r_[0, np.cumsum(np.where(cells[:, 3] < 0, 3, 4))]
    polys = vtkCellArray()
    polys.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=1),
                  numpy_to_vtkIdTypeArray(cells[cells >= 0].astype(np.int64), deep=1))
    series = []
    for step in (0, step_count // 2, step_count - 1):
        points = vtkPoints()
        points.SetData(numpyTovtkDataArray(
            np.fromfile(file, np.float32, 3 * count, offset=32 + 12 * count * step).reshape(-1, 3)))
        series.append(vtkPolyData())
        series[-1].SetPoints(points)
        series[-1].SetPolys(polys)
        height = numpyTovtkDataArray(np.arange(count, dtype=np.float32), "value")
        series[-1].GetPointData().AddArray(height)

    class Source(VTKPythonAlgorithmBase):
        def __init__(self):
            super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")

        def RequestInformation(self, request, inputs, outputs):
            times = list(range(len(series)))
            info = outputs.GetInformationObject(0)
            info.Set(Pipeline.TIME_STEPS(), times, len(times))
            info.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
            return 1

        def RequestData(self, request, inputs, outputs):
            info = outputs.GetInformationObject(0)
            step = int(info.Get(Pipeline.UPDATE_TIME_STEP()))
            out = vtkPolyData.GetData(outputs)
            out.ShallowCopy(series[step])
            out.GetInformation().Set(out.DATA_TIME_STEP(), float(step))
            return 1
    source = Source()
    decimation = module.vtkTriQuadDecimation()
    decimation.SetInputConnection(source.GetOutputPort())
    decimation.SetTargetReduction(.96)
    undecimation = module.vtkUndecimation()
    undecimation.SetInputConnection(decimation.GetOutputPort())

    def update(level, step):
        undecimation.SetLevel(level)
        start = time.process_time(), time.perf_counter()
        undecimation.UpdateTimeStep(step)
        return time.process_time() - start[0], time.perf_counter() - start[1]
    update(0, 0)
    levels = [update(i / 100, 0) for i in [*range(1, 101), *range(99, -1, -1)]]
    times = {}
    for level in (.04, .2, .5, 1):
        update(level, 0)
        times[str(level)] = float(np.median([update(level, step)[0] for step in (1, 2, 0, 2, 1, 0, 1, 2, 0)]))
    return {"nodes": count, "steps": len(series), "level": float(np.median([v[0] for v in levels])),
            "level_largest": max(v[0] for v in levels), "level_wall": float(np.median([v[1] for v in levels])),
            "times": times}


# The page, of the file of results.

def table(head, rows):
    aligned = ["---" if i == 0 else "--:" for i in range(len(head))]
    return ["| " + " | ".join(head) + " |", "|" + "|".join(aligned) + "|",
            *("| " + " | ".join(row) + " |" for row in rows), ""]


def shown(cell, target, own=False):
    text = f"{cell['t0']:.2f}" + (f" ({cell['own']:.2f})" if own else "")
    return text + ("" if cell["nodes"] <= 1.02 * target + 2 else f" at {cell['nodes']} nodes")


def static_page(rows):
    head = ["mesh", "triangles", "quads", "Deviation", "Quadrics", "vtkQuadricDecimation", "Deviation, s", "Quadrics, s"]
    return ["## Static: one step at 5 % of the nodes", "", "Hausdorff distance in % of the diagonal; CPU seconds of ours.",
            "", *table(head, [[r["mesh"], str(r["triangles"]), str(r["quads"]),
                               *(shown(r[k], r["nodes"]) for k in ("deviation", "quadrics", "vtkQuadricDecimation")),
                               f"{r['deviation']['cpu']:.2f}", f"{r['quadrics']['cpu']:.2f}"] for r in rows])]


RIVALS = ("Quadrics, last step", "replay")
TOOLS = ("Deviation", "Quadrics, maximum", "Quadrics, sum", *RIVALS)


def best_rival(row):
    return min((row[k]["t0"] for k in RIVALS if row[k]["nodes"] <= 1.02 * row["target"] + 2), default=float("inf"))


def dynamic_page(rows):
    counts = ", ".join(f"{name} {n}" for name, n in {r["series"]: r["steps"] for r in rows}.items())
    return ["## Dynamic: all steps count, at 1, 2, 4 and 11 % of the nodes", "",
            f"Largest distance over the measured steps ({counts}), in % of the diagonal at t0 (own diagonal in brackets).",
            "The last two have one topology for all steps and look at one step.", "",
            *table(["series", "nodes %", *TOOLS], [[r["series"], str(r["percent"]),
                                                    *(shown(r[k], r["target"], True) for k in TOOLS)] for r in rows]),
            "Deviation step by step: at the first, the middle and the last step, the mean of all and the largest, and where "
            "that is.", "",
            *table(["series", "nodes %", "first", "middle", "last", "mean", "largest", "at step"],
                   [[r["series"], str(r["percent"]), *(f"{v:.2f}" for v in d["some"].values()), f"{d['mean']:.2f}",
                     f"{d['t0']:.2f}", str(d["step"])] for r in rows for d in [r["Deviation"]]])]


def steps_page(rows):
    return ["## Which steps count", "",
            "Deviation; largest distance over all measured steps, and in brackets the mean of the steps, as table 3 of the "
            "paper has it, in % of the diagonal at t0; CPU seconds of one thread.", "",
            *table(["series", "steps", "numbers", *(f"{p} %" for p in STEP_PERCENT), "CPU s"],
                   [[r["series"], r["choice"], "" if r["choice"] == "all" else r["used"],
                     *(shown({"t0": v, "nodes": n}, t) + f" ({m:.2f})"
                       for v, m, n, t in zip(r["t0"], r["mean"], r["nodes"], r["targets"])),
                     f"{r['cpu']:.2f}"] for r in rows])]


def scale_page(rows):
    return ["## A million nodes", "",
            "The crash box 110 times side by side, each copy bent by its own angle over time. To 4 % of the nodes, two "
            "threads; reading "
            "excluded. One level to the next: the cursor alone.", "",
            *table(["steps", "nodes", "CPU s", "wall s", "peak GiB", "record MB", "one level to the next by 1 %, ms"],
                   [[str(r["steps"]), str(r["nodes"]), f"{r['cpu']:.1f}", f"{r['wall']:.1f}", f"{r['peak'] / 2**30:.2f}",
                     f"{r['record'] / 1e6:.0f}", f"{1e3 * r['level']:.1f}"] for r in rows])]


def filter_page(r):
    return ["## Level and time with the whole filter", "",
            f"`vtkUndecimation` behind `vtkTriQuadDecimation`, {r['nodes']} nodes as above, {r['steps']} steps in memory, one "
            "array; CPU ms of an update.", "",
            *table(["change", "ms"], [["level by 1 %, median of 200", f"{1e3 * r['level']:.1f}"],
                                      ["level by 1 %, largest", f"{1e3 * r['level_largest']:.1f}"],
                                      *([f"time, at level {level}", f"{1e3 * v:.1f}"]
                                        for level, v in r["times"].items())])]


def targets_page(results):
    """What the project set out to reach, judged by the figures above."""
    rows = []

    def judge(what, value, met):
        rows.append([what, value, "met" if met else "**missed**"])
    for r in results.get("dynamic", []):
        if r["series"] == "crash_box" and r["percent"] == 4:
            judge("crash box at 4 % of the nodes, all measured steps: below 0.9 %", f"{r['Deviation']['t0']:.2f} %",
                  r["Deviation"]["t0"] < .9)
    for r in results.get("dynamic", []):
        rival = best_rival(r)
        judge(f"{r['series']} at {r['percent']} %: at most the best rival of one topology",
              f"{shown(r['Deviation'], r['target'])} against {rival:.2f}",
              r["Deviation"]["t0"] <= rival and r["Deviation"]["nodes"] <= 1.02 * r["target"] + 2)
    by_choice = {(r["series"], r["choice"]): r for r in results.get("steps", [])}
    for (name, choice), r in by_choice.items():
        if choice == "three":
            whole = by_choice[name, "all"]
            judge(f"{name}, three steps: at most a quarter of the time of all", f"{r['cpu'] / whole['cpu']:.2f}",
                  r["cpu"] <= .25 * whole["cpu"])
            for key, what in (("t0", "largest error"), ("mean", "mean error")):
                for percent, some, every in zip(STEP_PERCENT, r[key], whole[key]):
                    judge(f"{name}, three steps at {percent} %: {what} at most 1.1 of that of all", f"{some / every:.2f}",
                          some <= 1.1 * every)
    for r in results.get("scale", []):
        seconds, gib = (240, 8) if r["steps"] > 3 else (40, 3)
        what = f"a million nodes, {r['steps']} steps, two threads: below {seconds} s"
        if r["wall"] > r["cpu"]:
            rows.append([what, f"{r['wall']:.0f} s", "not judged: others had the cores"])
        else:
            judge(what, f"{r['wall']:.0f} s", r["wall"] < seconds)
        judge(f"a million nodes, {r['steps']} steps: below {gib} GiB", f"{r['peak'] / 2**30:.2f} GiB", r["peak"] < gib * 2**30)
    if "filter" in results:
        r = results["filter"]
        judge("a change of level by 1 %, whole filter: below 100 ms", f"{1e3 * r['level']:.0f} ms", r["level"] < .1)
        slowest = max(r["times"].values())
        judge("a change of time, whole filter: below 100 ms", f"{1e3 * slowest:.0f} ms", slowest < .1)
    return ["## Targets", "", *table(["target", "measured", ""], rows)]


PARTS = {"static": (static, static_page), "steps": (steps, steps_page), "dynamic": (dynamic, dynamic_page),
         "scale": (scale, scale_page), "filter": (whole_filter, filter_page)}


def page(results):
    lines = ["# Triangles and quads over time", "", "Written by `Benchmarks/run.sh tri_quad`.", ""]
    settings = results.get("settings", {})
    for part, (_, lines_of) in PARTS.items():
        if part in results:
            lines += lines_of(results[part])
            if part in ("static", "steps", "dynamic"):
                lines += [f"Distances are too small by at most {100 * settings[part]['tolerance']:g} % of the diagonal or "
                          "1 % of themselves.", ""]
                if settings[part]["every"] > 1:
                    lines += [f"Measured at one of {settings[part]['every']} steps and at the last one.", ""]
        else:
            lines += [f"Not measured: {part}.", ""]
    return "\n".join(lines + targets_page(results))


def main():
    if sys.argv[1:2] == ["worker"]:
        print(json.dumps(worker(sys.argv[2])))
        return
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)}, page; default: all")
    a.add_argument("--cli", required=True, help="the built tri_quad_cli (run.sh passes it)")
    a.add_argument("--distance", required=True, help="the built tri_quad_distance (needs CGAL)")
    a.add_argument("--tolerance", type=float, help="of the distances, in diagonals; default: 0.0005 in the part static, where "
                   "flat places that are exact take long, else 0.0002")
    a.add_argument("--every", type=int, help="measure every so many steps, the last one always; default: 3 in the part steps, "
                   "else 1")
    a.add_argument("--jobs", type=int, default=2, help="distances measured at the same time")
    a.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project, for filter")
    a.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    a.add_argument("--json", default=os.path.join(meshes.ROOT, "Benchmarks", "results", "tri_quad.json"),
                   help="raw results; the page goes beside it")
    args = a.parse_args()
    if not os.path.exists(args.distance):
        raise SystemExit("tri_quad_distance was not built: install libcgal-dev and run again")
    parts = args.parts or list(PARTS)
    if not set(parts) <= {*PARTS, "page"}:
        a.error(f"no such part: {', '.join(set(parts) - {*PARTS, 'page'})}")
    results = {}
    if args.parts and os.path.exists(args.json):
        with open(args.json) as f:
            results = json.load(f)
    if parts != ["page"]:
        files = {os.path.basename(os.path.dirname(folder)): sorted(glob.glob(folder + "*.vtp"))
                 for folder in sorted(glob.glob(os.path.join(meshes.DATA, "dynamic", "*", "")))}
        files["wingbox"] = glob.glob(os.path.join(meshes.DATA, "static", "wingbox.vtp"))
        if not files.get("crash_box"):
            raise SystemExit("The data set is absent (UNDECIMATE_DATA, else ../shared/data beside the repository).")
        loaded = {name: read_series(list_of) for name, list_of in files.items() if list_of}
    with tempfile.TemporaryDirectory() as folder:
        for part in parts:
            if part == "page":
                continue
            start = time.perf_counter()
            settings = argparse.Namespace(**vars(args))
            settings.tolerance = args.tolerance or (.0005 if part == "static" else .0002)
            settings.every = args.every or (3 if part == "steps" else 1)
            results[part] = PARTS[part][0](Bench(settings, folder), loaded)
            results.setdefault("settings", {})[part] = {
                "tolerance": settings.tolerance, "every": settings.every, "seconds": round(time.perf_counter() - start)}
            print(f"{part}: {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
            with open(args.json, "w") as f:
                json.dump(results, f, indent=1)
                f.write("\n")
    text = page(results)
    with open(os.path.splitext(args.json)[0] + ".md", "w") as f:
        f.write(text)
    print(text)


if __name__ == "__main__":
    sys.exit(main())
