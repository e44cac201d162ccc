# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""CPU time and memory of ours, as the installed filter, and of the rivals: 'field.py times'. Results are in
results/field_times.csv; what is there is not measured again."""
import csv
import json
import os
import subprocess
import sys

import meshes
from deviation import prepare
from field_results import OURS, RESULTS, wanted_count
from field_rivals import available, run_rival

FILE = os.path.join(RESULTS, "field_times.csv")
COLUMNS = ["mesh", "nodes", "tool", "cpu", "cpu_whole", "peak", "runs", "triangles", "failed"]
PERCENT = 1.0
SIZES = [100, 178, 316, 562, 1000]  # 10k to 1M nodes
MESHES = [f"grid{n}:scalar" for n in SIZES] + ["heat_gearbox:temperature"]


def read():
    """[row]; numbers as numbers, None where there is none."""
    if not os.path.exists(FILE):
        return []
    words = ("mesh", "tool", "failed")
    with open(FILE, newline="") as f:
        return [{k: v if k in words else float(v) if v else None for k, v in row.items()} for row in csv.DictReader(f)]


def run_ours(mesh, criterion, triangles, args):
    from filters import environment
    command = [args.python, os.path.join(os.path.dirname(os.path.abspath(__file__)), "filters.py"), "worker", "file",
               mesh, criterion, str(triangles), str(args.reps)]
    done = subprocess.run(command, env=environment(args.build), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        raise SystemExit(f"{OURS}, {criterion}: {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def measure(args):
    known = {}
    if not args.fresh:
        known = {(r["mesh"], r["tool"]): r for r in read()}
    own = [f"{OURS}, {c}" for c in args.criteria]
    rivals = {n: r for n, r in available(args.rivals).items() if not r.steered and (r.fast or not args.fast_only)}
    result = os.path.join(meshes.CACHE, "field", "times.npz")
    os.makedirs(os.path.dirname(result), exist_ok=True)
    for name in args.meshes or MESHES:
        points, triangles, _, _, mesh = prepare(*name.split(":"))
        wanted = wanted_count(len(triangles), PERCENT)
        for tool in [*own, *rivals]:
            if (name, tool) in known and not (tool in own and args.fresh_ours):
                continue
            if tool in own:
                row = run_ours(mesh, tool.split(", ")[1], wanted, args)
            else:
                row = run_rival(mesh, tool, result, wanted, args.limit, args.reps)
            row.update({c: float(f"{row[c]:.4g}") for c in ("cpu", "cpu_whole") if c in row})
            known[name, tool] = dict({c: row.get(c) for c in COLUMNS}, mesh=name, nodes=len(points), tool=tool)
            print(name, tool, row.get("failed") or f"{row['cpu_whole']:.3g} s", file=sys.stderr, flush=True)
            with open(FILE + ".new", "w", newline="") as f:
                writer = csv.DictWriter(f, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(known.values())
            os.replace(FILE + ".new", FILE)
