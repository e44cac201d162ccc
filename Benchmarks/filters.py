# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Filter against filter on the 1000 x 1000 grid to 1 %, and the update of a level.

    filters.py decimation   vtkHashQueueDecimation (Scalar Difference) against vtkDecimatePro and
                            vtkQuadricDecimation of a release VTK, in turns, a process a run
    filters.py level        vtkUndecimation: the whole update for a change of level by 1 %, against a
                            plain copy of the output's arrays

Ours runs in the Python of the VTK that it was built against (--python), the rivals in this one. Only
Update() is timed, in CPU seconds of the process, one thread.
"""
import argparse
import glob
import json
import os
import subprocess
import sys
import time

import numpy as np

import meshes
from rivals import PRO, QUADRIC, make, poly_data

OURS = "vtkHashQueueDecimation"
GOALS = {PRO: 8.0, QUADRIC: 12.0}


def own_filters():
    import undecimate.vtkUndecimateFilters as module
    return module


def worker_decimation(name, n):
    points, triangles, scalar = meshes.grid(n)
    data = poly_data(points, triangles, scalar)
    del points, triangles, scalar
    if name == OURS:
        f = own_filters().vtkHashQueueDecimation()
        f.SetCriterionToScalarDifference()
        f.SetTargetReduction(.99)
    else:
        f = make(name, .99)
    f.SetInputData(data)
    start = time.process_time()
    f.Update()
    seconds = time.process_time() - start
    out = f.GetOutput()
    return {"filter": name, "cpu": seconds, "nodes": out.GetNumberOfPoints(),
            "triangles": out.GetNumberOfPolys()}


def worker_file(file, criterion, triangles, reps):
    """Ours on a mesh file, from vtkPolyData to vtkPolyData."""
    from field_rivals import SLOW, resident
    points, cells = meshes.read(file)
    seconds, peak = [], 0
    while len(seconds) < reps and (not seconds or seconds[-1] < SLOW):
        f = own_filters().vtkHashQueueDecimation()
        getattr(f, "SetCriterionTo" + criterion)()
        f.SetTargetReduction(1 - triangles / len(cells))
        f.SetInputData(poly_data(points, cells, meshes.read_values(file)))
        before = resident()[0]
        start = time.process_time()
        f.Update()
        seconds.append(time.process_time() - start)
        peak = peak or resident()[1] - before
    middle = float(np.median(seconds))
    return {"cpu": middle, "cpu_whole": middle, "peak": peak, "runs": len(seconds),
            "triangles": f.GetOutput().GetNumberOfPolys()}


def output_arrays(out):
    """All arrays that the output holds, field data apart."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    polys, arrays = out.GetPolys(), []
    for a in [out.GetPoints().GetData(), polys.GetConnectivityArray(), polys.GetOffsetsArray()]:
        arrays.append(vtk_to_numpy(a))
    for attributes in (out.GetPointData(), out.GetCellData()):
        for i in range(attributes.GetNumberOfArrays()):
            if attributes.GetArray(i) is not None:
                arrays.append(vtk_to_numpy(attributes.GetArray(i)))
    return arrays


def worker_level(n):
    points, triangles, scalar = meshes.grid(n)
    data = poly_data(points, triangles, scalar)
    module = own_filters()
    f = module.vtkHashQueueDecimation()
    f.SetCriterionToScalarDifference()
    f.SetTargetReduction(.99)
    f.SetInputData(data)
    f.Update()
    u = module.vtkUndecimation()
    u.SetInputConnection(f.GetOutputPort())
    u.SetLevel(0)
    start = time.process_time()
    u.Update()
    first = time.process_time() - start
    updates, ratios, fresh = [], [], []
    del points, scalar
    for i in list(range(1, 101)) + list(range(99, -1, -1)):
        u.SetLevel(i / 100)
        start = time.process_time()
        u.Update()
        updates.append(time.process_time() - start)
        arrays = output_arrays(u.GetOutput())
        # A deep copy as an application makes it (new memory), and into memory that is there.
        start = time.process_time()
        copies = [a.copy() for a in arrays]
        made = time.process_time() - start
        start = time.process_time()
        for a, b in zip(arrays, copies):
            np.copyto(b, a)
        ratios.append(updates[-1] / (time.process_time() - start))
        fresh.append(updates[-1] / made)
        del arrays, copies
    same = u.GetOutput().GetNumberOfPoints() == f.GetOutput().GetNumberOfPoints()
    return {"first": first, "update": float(np.median(updates)), "same": same,
            "ratio": float(np.median(ratios)), "ratio_new_memory": float(np.median(fresh))}


def environment(build):
    env = dict(os.environ, VTK_SMP_BACKEND_IN_USE="Sequential", OMP_NUM_THREADS="1",
               OPENBLAS_NUM_THREADS="1")
    # Its own one: the tests install older copies in folders below.
    packages = glob.glob(os.path.join(build, "lib*", "python3*", "*-packages", "undecimate", "__init__.py"))
    if not packages:
        raise SystemExit(f"{build}: no Python package 'undecimate' there; build the project first")
    env["PYTHONPATH"] = os.path.dirname(os.path.dirname(packages[0]))
    return env


def child(python, env, *words):
    done = subprocess.run([python, os.path.abspath(__file__), "worker", *map(str, words)], env=env,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{words}: {done.stderr.strip()[-800:]}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def decimation(args):
    own = environment(args.build)
    other = {k: v for k, v in own.items() if k != "PYTHONPATH"}
    rows = {OURS: [], PRO: [], QUADRIC: []}
    for _ in range(args.reps):
        for name in rows:
            python, env = (args.python, own) if name == OURS else (sys.executable, other)
            rows[name].append(child(python, env, "decimation", name, args.n))
            print(f"{name} {rows[name][-1]['cpu']:.2f} s", file=sys.stderr, flush=True)
    cpu = {name: float(np.median([r["cpu"] for r in rs])) for name, rs in rows.items()}
    print("| filter | CPU s | nodes left | triangles left | times ours | target |\n|---|--:|--:|--:|--:|---|")
    for name, rs in rows.items():
        times, goal = cpu[name] / cpu[OURS], GOALS.get(name)
        mark = "" if goal is None else f">= {goal:g} " + ("met" if times >= goal else "**missed**")
        print(f"| {name} | {cpu[name]:.3f} | {rs[-1]['nodes']:,} | {rs[-1]['triangles']:,} | {times:.1f} | {mark} |")
    return rows


def level(args):
    r = child(args.python, environment(args.build), "level", args.n)
    print("| vtkUndecimation, change of level by 1 %, whole update | value |\n|---|--:|")
    print(f"| first update (decodes the record), CPU s | {r['first']:.4f} |")
    print(f"| update, median of 200, CPU s | {r['update']:.4f} |")
    print(f"| times a plain copy of its output's arrays, into memory that is there | {r['ratio']:.2f} |")
    print(f"| times a plain copy of its output's arrays, into new memory | {r['ratio_new_memory']:.2f} |")
    return r


def main():
    if sys.argv[1:2] == ["worker"]:
        kind, words = sys.argv[2], sys.argv[3:]
        work = {"level": lambda: worker_level(int(words[0])),
                "decimation": lambda: worker_decimation(words[0], int(words[1])),
                "file": lambda: worker_file(words[0], words[1], int(words[2]), int(words[3]))}
        print(json.dumps(work[kind]()))
        return
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("part", choices=["decimation", "level"])
    a.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project")
    a.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    a.add_argument("--n", type=int, default=1000, help="nodes along an edge of the grid")
    a.add_argument("--reps", type=int, default=3)
    a.add_argument("--json", help="write the results to this file")
    args = a.parse_args()
    result = decimation(args) if args.part == "decimation" else level(args)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(result, f, indent=1)


if __name__ == "__main__":
    main()
