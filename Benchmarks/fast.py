# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The fast criteria against meshoptimizer, and Deviation against vtkQuadricDecimation, on a million nodes to
1 % of the triangles.

All from vtkPolyData to vtkPolyData, conversions included, in CPU seconds of the process, one thread, a process a run.
The tools take turns, and each round gives a ratio of its own, so that a slow minute of the machine hits both sides.
Ours is the installed filter in the Python of the VTK that it was built against (--python).
"""
import argparse
import json
import os
import sys

import numpy as np

import meshes
from deviation import prepare
from field_results import wanted_count
from field_rivals import run_rival
from field_times import run_ours

MESHES = ["grid1000:scalar", "heat_gearbox:temperature"]
PERCENT = 1.0
MESHOPTIMIZER, QUADRIC = "meshoptimizer", "vtkQuadricDecimation 9.2"
#        ours, rival, at most this much of its time
FAST = [("ScalarDifference", MESHOPTIMIZER, 1.0), ("Quadric", MESHOPTIMIZER, 1.0)]
ACCURATE = [("Deviation", QUADRIC, 0.5)]


def rounds(mesh, wanted, pairs, count, args):
    """{tool: [row]} of tools in turns."""
    tools = dict.fromkeys([p[0] for p in pairs] + [p[1] for p in pairs])
    rows = {tool: [] for tool in tools}
    own = {p[0] for p in pairs}
    args.reps = 1  # in a process
    for _ in range(count):
        for tool in tools:
            if tool in own:
                row = run_ours(mesh, tool, wanted, args)
            else:
                row = run_rival(mesh, tool, args.result, wanted, args.limit, 1)
            if "failed" in row:
                raise SystemExit(f"{tool}: {row['failed']}")
            rows[tool].append(row)
            print(f"{tool} {row['cpu_whole']:.2f} s", file=sys.stderr, flush=True)
    return rows


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--meshes", nargs="+", default=MESHES)
    a.add_argument("--rounds", type=int, default=5, help="of the fast criteria")
    a.add_argument("--accurate-rounds", type=int, default=1, help="of Deviation; 0 leaves it out")
    a.add_argument("--limit", type=int, default=600, help="CPU seconds a run")
    a.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project")
    a.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    a.add_argument("--json", help="write the results to this file")
    args = a.parse_args()
    args.result = os.path.join(meshes.CACHE, "field", "fast.npz")
    os.makedirs(os.path.dirname(args.result), exist_ok=True)
    out = []
    print("| mesh | nodes | criterion | CPU s | rival | CPU s | ours / rival, median (of rounds) | least .. largest | "
          "target |\n|---|--:|---|--:|---|--:|--:|--:|---|")
    for name in args.meshes:
        points, triangles, _, _, mesh = prepare(*name.split(":"))
        wanted = wanted_count(len(triangles), PERCENT)
        for pairs, count in ((FAST, args.rounds), (ACCURATE, args.accurate_rounds)):
            rows = rounds(mesh, wanted, pairs, count, args)
            for ours, rival, goal in pairs if count else ():
                mine, theirs = (np.array([r["cpu_whole"] for r in rows[t]]) for t in (ours, rival))
                ratio = mine / theirs
                middle = float(np.median(ratio))
                out.append({"mesh": name, "nodes": len(points), "triangles": rows[ours][0]["triangles"], "ours": ours,
                            "rival": rival, "cpu": list(mine), "rival_cpu": list(theirs), "ratio": middle})
                print(f"| {name} | {len(points):,} | {ours} | {np.median(mine):.2f} | {rival} | {np.median(theirs):.2f} | "
                      f"{middle:.2f} ({count}) | {ratio.min():.2f} .. {ratio.max():.2f} | "
                      f"<= {goal:g} {'met' if middle <= goal else '**missed**'} |", flush=True)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(out, f, indent=1)


if __name__ == "__main__":
    main()
