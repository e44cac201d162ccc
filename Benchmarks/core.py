# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The core alone on grids: core.py linear (table 1 of the 2003 paper), core.py level, core.py limit."""
import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile

import meshes

SIZES = [100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 2828]
LIMIT = 300  # nodes along an edge of the grid whose cache lines are counted
CACHE = "1048576,16,64"  # bytes, ways, line: much less than that grid needs, as real ones are for real meshes


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
    more = [] if args.criterion == "scalar" else [args.criterion]
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
    if 1000000 in per_node and max(per_node) > 1000000:
        most = max(per_node)
        figures.insert(0, (f"time a node at {most:,} / at 1M", per_node[most] / per_node[1000000], 1.25))
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


def lines_a_removal(args, criterion):
    """Cache lines that decimate() reads and writes from memory for each removed node, counted by simulation."""
    with tempfile.NamedTemporaryFile() as out:
        more = [] if criterion == "scalar" else [criterion]
        command = ["valgrind", "--tool=callgrind", "--cache-sim=yes", f"--LL={CACHE}", "--collect-atstart=no",
                   "--toggle-collect=undecimate::decimate*", f"--callgrind-out-file={out.name}", args.timing, "linear",
                   grid_file(LIMIT), str(LIMIT * LIMIT // 100), "1", *more]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        with open(out.name) as f:
            text = f.read()
    events = re.search(r"^events: (.*)$", text, re.M)
    totals = re.search(r"^(?:totals|summary): (.*)$", text, re.M)
    if done.returncode or not events or not totals:
        raise SystemExit(f"valgrind: {done.stderr.strip()[-500:]}")
    count = dict(zip(events[1].split(), map(int, totals[1].split())))
    r = json.loads(done.stdout.strip().splitlines()[-1])
    gone = r["nodes"] - r["left"]
    return (count["DLmr"] + count["DLmw"]) / gone, count["Ir"] / gone


def limit(args):
    """Time a removal at 1M nodes against the time that its cache lines take by bandwidth and by latency."""
    if not shutil.which("valgrind"):
        raise SystemExit("'limit' counts cache lines with valgrind: install it.")
    done = subprocess.run([args.memory], stdout=subprocess.PIPE, text=True, check=True)
    memory = json.loads(done.stdout)
    wait = memory["nanoseconds_a_line"]
    print("| memory of this machine | value |\n|---|--:|")
    print(f"| reading in order, GB/s | {memory['bytes_a_second'] / 1e9:.1f} |")
    for walkers, ns in wait.items():
        print(f"| a cache line at random, {walkers} at once, ns | {ns:.1f} |")
    best = min(wait.values())
    print("\n| criterion | instructions a removal | cache lines a removal | bytes a removal | ns at full bandwidth | "
          "ns at random, all overlapped | ns at random, one by one | measured at 1M nodes, ns | measured / overlapped |\n"
          "|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    rows = []
    for criterion in ("scalar", "quadric"):
        lines, instructions = lines_a_removal(args, criterion)
        more = [] if criterion == "scalar" else [criterion]
        r = run(args, "linear", grid_file(1000), 10000, args.reps, *more)
        measured = 1e9 * r["decimation"] / (r["nodes"] - r["left"])
        rows.append({"criterion": criterion, "lines": lines, "instructions": instructions, "measured": measured,
                     "memory": memory})
        print(f"| {criterion} | {instructions:.0f} | {lines:.1f} | {64 * lines:.0f} | "
              f"{64e9 * lines / memory['bytes_a_second']:.0f} | {best * lines:.0f} | {wait['1'] * lines:.0f} | "
              f"{measured:.0f} | {measured / (best * lines):.1f} |")
    return rows


def main():
    a = argparse.ArgumentParser(description=__doc__)
    a.add_argument("part", choices=["linear", "level", "limit"])
    a.add_argument("--timing", required=True, help="the built core_timing (run.sh passes it)")
    a.add_argument("--reps", type=int, default=3)
    a.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="nodes along an edge")
    a.add_argument("--criterion", choices=["scalar", "quadric", "deviation"], default="scalar")
    a.add_argument("--memory", help="the built memory_limits (run.sh passes it)")
    a.add_argument("--json", help="write the results to this file")
    args = a.parse_args()
    result = {"linear": linear, "level": level, "limit": limit}[args.part](args)
    if args.json:
        with open(args.json, "w") as f:
            json.dump(result, f, indent=1)


if __name__ == "__main__":
    main()
