# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The core alone on grids: core.py linear (table 1 of the 2003 paper) or core.py level."""
import argparse
import json
import os
import subprocess

import meshes

SIZES = [100, 200, 300, 400, 500, 600, 700, 800, 900, 1000]


def grid_file(n):
    folder = os.path.join(meshes.CACHE, "meshes")
    os.makedirs(folder, exist_ok=True)
    name = os.path.join(folder, f"grid{n}-scalar.mesh")
    if not os.path.exists(name):
        meshes.write(name, *meshes.grid(n))
    return name


def run(args, *words):
    done = subprocess.run([args.timing, *map(str, words)], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{words}: exit {done.returncode}\n{done.stdout}")
    return json.loads(done.stdout)


def linear(args):
    more = ["deviation"] if args.deviation else []
    # The sizes are run in turns, so that a busy minute of the machine does not hit one size alone.
    runs = {n: [] for n in args.sizes}
    for _ in range(args.reps):
        for n in args.sizes:
            runs[n].append(run(args, "linear", grid_file(n), n * n // 100, 1, *more))
    middle = lambda rs, key: sorted(r[key] for r in rs)[len(rs) // 2]
    print("| nodes | left | decimation CPU s | us a node | undecimation CPU s | us a node | undecimation / "
          "decimation | record, bytes a node |\n|--:|--:|--:|--:|--:|--:|--:|--:|")
    rows = []
    for n, rs in runs.items():
        r = dict(rs[0], decimation=middle(rs, "decimation"), undecimation=middle(rs, "undecimation"),
                 open=middle(rs, "open"), runs=len(rs))
        rows.append(r)
        gone = r["nodes"] - r["left"]
        print(f"| {r['nodes']:,} | {r['left']:,} | {r['decimation']:.4f} | {1e6 * r['decimation'] / gone:.3f} | "
              f"{r['undecimation']:.4f} | {1e6 * r['undecimation'] / gone:.4f} | "
              f"{r['undecimation'] / r['decimation']:.3f} | {r['record_bytes'] / r['nodes']:.1f} |")
    per_node = {r["nodes"]: r["decimation"] / (r["nodes"] - r["left"]) for r in rows}
    figures = [("undecimation / decimation, largest", max(r["undecimation"] / r["decimation"] for r in rows), .1)]
    if 1000000 in per_node and 40000 in per_node:
        figures.insert(0, ("time a node at 1M / at 40k", per_node[1000000] / per_node[40000], 1.6))
    print("\n| figure | value | target |\n|---|--:|---|")
    for what, value, goal in figures:
        print(f"| {what} | {value:.3f} | <= {goal:g} {'met' if value <= goal else '**missed**'} |")
    print("\nAt every size the last level is the input again, triangle by triangle.")
    return rows


def level(args):
    r = run(args, "level", grid_file(1000), 10000, args.reps)
    print("| change of level by 1 % at 1M nodes, core | value | target |\n|---|--:|---|")
    print(f"| cursor alone, CPU s, median of {r['levels']} | {r['move']:.5f} | |")
    print(f"| cursor and writing the output's arrays, CPU s | {r['hand_out']:.5f} | |")
    print(f"| memcpy of the output's arrays, CPU s | {r['memcpy']:.5f} | |")
    print(f"| (cursor and writing) / memcpy, median | {r['ratio_hand_out']:.2f} | <= 1.5 "
          f"{'met' if r['ratio_hand_out'] <= 1.5 else '**missed**'} |")
    return r


def main():
    a = argparse.ArgumentParser(description=__doc__)
    a.add_argument("part", choices=["linear", "level"])
    a.add_argument("--timing", required=True, help="the built core_timing (run.sh passes it)")
    a.add_argument("--reps", type=int, default=3)
    a.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="nodes along an edge")
    a.add_argument("--deviation", action="store_true", help="criterion Deviation, not Scalar Difference")
    a.add_argument("--json", help="write the results to this file")
    args = a.parse_args()
    result = linear(args) if args.part == "linear" else level(args)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(result, f, indent=1)


if __name__ == "__main__":
    main()
