# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""How Parallel would scale, computed: the CPU times of the jobs of one run are dealt out to many cores (dealt_threads.cpp)."""
import argparse
import json
import subprocess

from deviation import prepare
from fast import PERCENT
from field_results import wanted_count

CASES = [("heat_gearbox:temperature", "deviation"), ("grid500:scalar", "deviation"), ("grid1000:scalar", "scalar"),
         ("grid1000:scalar", "quadric")]


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--cli", required=True, help="the built dealt_decimate_cli (run.sh passes it)")
    args = a.parse_args()
    print("| criterion | mesh, to 1 % | serial part | 2 | 4 | 8 | 16 | 64 cores |\n|---|---|--:|--:|--:|--:|--:|--:|")
    for name, criterion in CASES:
        _, triangles, _, _, mesh = prepare(*name.split(":"))
        done = subprocess.run([args.cli, mesh, "--targets", str(wanted_count(len(triangles), PERCENT)), "--criterion",
                               criterion, "--scalar-weight", "0", "--threads", "64"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, check=True)
        dealt = json.loads(done.stderr.strip().splitlines()[-1])
        print(f"| {criterion} | {name.split(':')[0]} | {100 * dealt['serial'] / dealt['whole']:.1f} % | "
              + " | ".join(f"{x:.2g}" for x in dealt["times"].values()) + " |", flush=True)


if __name__ == "__main__":
    main()
