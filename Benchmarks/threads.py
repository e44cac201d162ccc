# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parallel: the whole filter with one thread and with several, on a million nodes to 1 % of the triangles.

Wall time of Update(), in turns, a process a run, and the error of the record beside that of the serial algorithm. Only
worth something on a machine that does nothing else: what others take of it only ever makes a run slower, and hits one with
two threads twice as often, so the fastest run of each kind is shown beside the median, and how many of the threads were
busy on average (CPU / wall, with several), which others do not change much. What the machine allows is shown,
too: as many runs with one thread at once, that have nothing to do with each other, against one alone. A virtual machine
may have to ask its host for memory that was not used for a while, which took up to 0.7 s of a run of 1.7 s: each process
touches more memory than it needs before it measures, and keeps it for all of its threads (GLIBC_TUNABLES; one arena), so
that all runs find their memory at hand.
"""
import argparse
import json
import os
import subprocess
import sys
import time

import numpy as np

import meshes
from deviation import prepare
from fast import MESHES, PERCENT
from field_results import wanted_count
from filters import environment, own_filters
from rivals import poly_data

CRITERIA = ["Deviation", "ScalarDifference", "Quadric"]
GOAL, NEAR = 1.7, 1.03
TOUCHED = 2**30  # bytes
KEEP_MEMORY = "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=17179869184:glibc.malloc.arena_max=1"


def worker(file, criterion, triangles, threads):
    """One run; 0 threads: not parallel."""
    points, cells = meshes.read(file)
    f = own_filters().vtkHashQueueDecimation()
    getattr(f, "SetCriterionTo" + criterion)()
    f.SetTargetReduction(1 - triangles / len(cells))
    f.SetParallel(threads > 0)
    f.SetNumberOfThreads(max(1, threads))
    f.SetInputData(poly_data(points, cells, meshes.read_values(file)))
    touched = np.ones(TOUCHED // 8)
    del touched
    wall, cpu = time.perf_counter(), time.process_time()
    f.Update()
    return {"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu, "error": f.GetError(),
            "triangles": f.GetOutput().GetNumberOfPolys()}


def start(args, *words):
    env = {k: v for k, v in environment(args.build).items() if k != "VTK_SMP_BACKEND_IN_USE"}
    env["GLIBC_TUNABLES"] = KEEP_MEMORY
    return subprocess.Popen([args.python, os.path.abspath(__file__), "worker", *map(str, words)], env=env,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def result(process):
    out, errors = process.communicate()
    if process.returncode:
        raise SystemExit(f"{process.args}: {errors.strip()[-500:]}")
    return json.loads(out.strip().splitlines()[-1])


def main():
    if sys.argv[1:2] == ["worker"]:
        print(json.dumps(worker(sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5]))))
        return
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--meshes", nargs="+", default=MESHES)
    a.add_argument("--criteria", nargs="+", choices=CRITERIA, default=CRITERIA)
    a.add_argument("--threads", type=int, default=2)
    a.add_argument("--rounds", type=int, default=3)
    a.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project")
    a.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    a.add_argument("--json", help="write the results to this file")
    args = a.parse_args()
    out = []
    print(f"| mesh | criterion | serial, s | 1 thread, s | {args.threads} threads, s | 1 / {args.threads}, median | least .. "
          f"largest | fastest / fastest | {args.threads} runs at once | CPU / wall | target | error / serial | target |\n"
          "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|---|--:|---|")
    for name in args.meshes:
        _, triangles, _, _, mesh = prepare(*name.split(":"))
        wanted = wanted_count(len(triangles), PERCENT)
        for criterion in args.criteria:
            rows, together = {n: [] for n in (0, 1, args.threads)}, []
            for _ in range(args.rounds):
                for n, some in rows.items():
                    some.append(result(start(args, mesh, criterion, wanted, n)))
                at_once = [start(args, mesh, criterion, wanted, 1) for _ in range(args.threads)]
                together.append(float(np.mean([result(one)["wall"] for one in at_once])))
            wall = {n: np.array([r["wall"] for r in some]) for n, some in rows.items()}
            errors = {r["error"] for n in (1, args.threads) for r in rows[n]}
            if len(errors) > 1:
                raise SystemExit(f"{name}, {criterion}: the result depends on the threads: {errors}")
            ratio, near = wall[1] / wall[args.threads], errors.pop() / rows[0][0]["error"]
            middle = float(np.median(ratio))
            allowed = float(np.median(args.threads * wall[1] / np.array(together)))
            busy = float(np.median([r["cpu"] / r["wall"] for r in rows[args.threads]]))
            out.append({"mesh": name, "criterion": criterion, "threads": args.threads, "ratio": middle, "near": near,
                        "allowed": allowed, "busy": busy, "rows": rows})
            print(f"| {name} | {criterion} | " + " | ".join(f"{np.median(w):.2f}" for w in wall.values()) +
                  f" | {middle:.2f} | {ratio.min():.2f} .. {ratio.max():.2f} | "
                  f"{wall[1].min() / wall[args.threads].min():.2f} | {allowed:.2f} | {busy:.2f} | >= {GOAL:g} "
                  f"{'met' if middle >= GOAL else '**missed**'} | {near:.3f} | <= {NEAR:g} "
                  f"{'met' if near <= NEAR else '**missed**'} |", flush=True)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(out, f, indent=1)


if __name__ == "__main__":
    main()
