# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Deviation against the whole field of decimators, at equal triangle counts.

    field.py rivals [--meshes ...] [--percent ...] [--rivals ...] [--jobs 2]
    field.py ours --cli DECIMATE_CLI --json OURS.json [--options "..."]
    field.py collect [--ours OURS.json]
    field.py times [--build FOLDER]
    field.py summary [--ours OURS.json] [--against OTHER.json]

`rivals` measures them, a process a run, and keeps every result in ~/.cache/undecimate/field, one small JSON
file a mesh and the decimated meshes beside it, so that it goes on where it was stopped. `ours` decimates
with the core's driver. `collect` writes both to results/field.csv and results/field.json, from which
field_page.py writes the page. `times` measures CPU time and memory, filter against filter. `summary`
compares the collected results, or others of ours with the collected rivals.

A mesh NAME:ARRAY is decimated with that nodal array, by those that steer by one.
"""
import argparse
import concurrent.futures
import csv
import json
import multiprocessing
import os
import sys
import time

import numpy as np

import field_results
import field_times
import meshes
from deviation import own_rows, prepare
from field_results import COLUMNS, OURS, RESULTS, wanted_count
from field_rivals import RIVALS, available, run_rival

STORE = os.path.join(meshes.CACHE, "field")
PERCENT = [25.0, 10.0, 5.0, 2.0, 1.0]
GRIDS = ["grid100", "grid300"]
ARRAYS = ["plate_hole:von_mises", "linkrod:von_mises", "fea_bracket:von_mises", "cortex_lh:thickness",
          "heat_gearbox:temperature"]


def load(name):
    """Points, triangles, values or None, key, file of NAME or NAME:ARRAY."""
    return prepare(*name.split(":"))


class Store:
    """Rivals' results of a mesh, {rival: {percent: row}}, with the decimated meshes in a folder beside."""

    def __init__(self, name, key):
        self.folder = os.path.join(STORE, f"{os.path.basename(name).replace(':', '-')}-{key}")
        self.file = self.folder + ".json"
        os.makedirs(self.folder, exist_ok=True)
        self.rows = {}
        if os.path.exists(self.file):
            with open(self.file) as f:
                self.rows = json.load(f)

    def row(self, rival, percent):
        return self.rows.get(rival, {}).get(f"{percent:g}")

    def keep(self, rival, percent, row):
        self.rows.setdefault(rival, {})[f"{percent:g}"] = row
        aside = f"{self.file}.{os.getpid()}"
        with open(aside, "w") as f:
            json.dump(self.rows, f, indent=0)
        os.replace(aside, self.file)

    def mesh(self, rival, percent):
        return os.path.join(self.folder, f"{rival.replace(', ', '-').replace(' ', '_')}-{percent:g}.npz")


def measure_rivals(name, rivals, args):
    """Measures what is not in the store yet, and returns those rows."""
    from metric import FAULTS_VERSION, VERSION, Reference
    points, triangles, values, key, file = load(name)
    store, reference, out = Store(name, key), None, []
    for percent in args.percent:
        for rival in rivals:
            mesh, wanted = store.mesh(rival, percent), wanted_count(len(triangles), percent)
            row = {} if args.fresh else store.row(rival, percent) or {}
            if row.get("metric") == VERSION and ("failed" in row or row.get("faults") == FAULTS_VERSION):
                continue
            if "triangles" not in row or not os.path.exists(mesh):
                row = run_rival(file, rival, mesh, wanted, args.limit, 1)
            if row.get("triangles") == 0:
                row = {"failed": "no triangle left"}
            if "failed" not in row:
                reference = reference or Reference(points, triangles, values)
                z = np.load(mesh)
                if row.get("metric") != VERSION:
                    carried = z["values"] if "values" in z else None
                    row.update(reference.measure(z["points"], z["triangles"], carried))
                row.update(reference.faults(z["points"], z["triangles"]), faults=FAULTS_VERSION)
            row["metric"] = VERSION
            store.keep(rival, percent, row)
            out.append(dict(row, rival=rival, percent=percent))
    return out


def file_size(name):
    return int(name[4:]) ** 2 * 30 if name in GRIDS else os.path.getsize(meshes.path(name.split(":")[0]))


def chosen_meshes(args):
    """Small ones first."""
    if not args.meshes and not os.path.isdir(meshes.DATA):
        raise SystemExit(f"{meshes.DATA}: no data set there. Set UNDECIMATE_DATA, or name meshes with --meshes.")
    arrays = [] if args.no_arrays else [name for name in ARRAYS if meshes.find(name.split(":")[0])]
    return sorted(args.meshes or meshes.data_set() + GRIDS + arrays, key=file_size)


def pool(jobs):
    return concurrent.futures.ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"))


def rivals(args):
    chosen = available(args.rivals)
    start, all_meshes = time.time(), chosen_meshes(args)
    with pool(args.jobs) as workers:
        jobs = {}
        for fast in (True, False):  # first what is done soon
            for name in all_meshes:
                some = [n for n, r in chosen.items() if r.fast == fast and r.steered == (":" in name)]
                if some:
                    jobs[workers.submit(measure_rivals, name, some, args)] = name
        for job in concurrent.futures.as_completed(jobs):
            rows = job.result()
            failed = [f"{r['rival']} {r['percent']:g} %: {r['failed']}" for r in rows if "failed" in r]
            print(f"{time.time() - start:.0f} s: {jobs[job]}, {len(rows)} runs", *failed, sep="\n  ",
                  file=sys.stderr, flush=True)


def ours_of(name, args):
    from metric import Reference
    points, triangles, values, _, file = load(name)
    args.time_each, args.reps = False, 1
    rows = own_rows(file, Reference(points, triangles, values), {}, len(triangles), args, faults=True)
    return [{"mesh": name, "input_triangles": len(triangles), "percent": p,
             "ours": rows[wanted_count(len(triangles), p)]} for p in args.percent]


def ours(args):
    cases, order = [], chosen_meshes(args)[::-1]  # longest first, so that the last job is short
    with pool(args.jobs) as workers:
        for some in workers.map(ours_of, order, [args] * len(order)):
            cases += some
    cases.sort(key=lambda c: (c["mesh"], -c["percent"]))
    with open(args.json, "w") as f:
        json.dump(cases, f, indent=1)
    print(f"{len(cases)} cases in {args.json}")


def table_row(mesh, percent, tool, row):
    """The columns of a row. On height fields `flipped` is known exactly."""
    row = dict(row, mesh=mesh, percent=percent, tool=tool, flipped=row.get("flipped", row.get("flipped_near")))
    cell = lambda x, kind: "" if x is None else f"{x:.5g}" if kind is float else x
    return [cell(row.get(name), kind) for name, kind in COLUMNS.items()]


def complete(stores, percents):
    """Rivals that were measured in all the cases that are theirs: means over other cases would not compare."""
    out = []
    for rival in RIVALS:
        own = [store for name, store in stores.items() if (":" in name) == RIVALS[rival]().steered]
        there = sum(store.row(rival, p) is not None for store in own for p in percents)
        if own and there == len(own) * len(percents):
            out.append(rival)
        elif there:
            print(f"Without {rival}: measured in {there} of {len(own) * len(percents)} cases.", file=sys.stderr)
    return out


def collect(args):
    """Everything that was measured, in one table, and what it was measured with."""
    from machine import line
    from metric import shape
    own = {}
    if args.ours:
        with open(args.ours) as f:
            own = {(c["mesh"], c["percent"]): c["ours"] for c in json.load(f)}
    versions, about, stores, rows = {}, {}, {}, []
    for name in sorted(chosen_meshes(args)):
        points, triangles, _, key, _ = load(name)
        _, aspect = shape(points, triangles)
        about[name] = {"nodes": len(points), "triangles": len(triangles), "aspect": round(np.median(aspect), 3),
                       "aspect_95": round(np.quantile(aspect, .95), 3)}
        stores[name] = Store(name, key)
    measured = complete(stores, args.percent)
    for name, store in stores.items():
        for percent in args.percent:
            if (name, percent) in own:
                rows.append(table_row(name, percent, OURS, own[name, percent]))
            for rival in measured:
                row = store.row(rival, percent)
                if row:
                    versions[rival] = row.get("version") or versions.get(rival)
                    rows.append(table_row(name, percent, rival, row))
    with open(os.path.join(RESULTS, "field.csv"), "w", newline="") as f:
        writer = csv.writer(f, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)
    with open(os.path.join(RESULTS, "field.json"), "w") as f:
        json.dump({"machine": line(), "versions": versions, "meshes": about}, f, indent=1)
        f.write("\n")
    print(f"{len(rows)} rows of {len(measured)} rivals and ours")


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = a.add_subparsers(dest="part", required=True)
    which = argparse.ArgumentParser(add_help=False)
    which.add_argument("--meshes", nargs="+", help="names of the data set, gridN, .vtp files, each with :ARRAY for an "
                       "array; default: all")
    cases = argparse.ArgumentParser(add_help=False)
    cases.add_argument("--percent", nargs="+", type=float, default=PERCENT, help="of the triangles to keep")
    cases.add_argument("--jobs", type=int, default=2, help="meshes at a time")
    cases.add_argument("--no-arrays", action="store_true", help="leave out the cases with a nodal array")
    runs = argparse.ArgumentParser(add_help=False)
    runs.add_argument("--rivals", nargs="+", choices=list(RIVALS), metavar="RIVAL", help="; ".join(RIVALS))
    runs.add_argument("--limit", type=int, default=300, help="CPU seconds a run")
    runs.add_argument("--fresh", action="store_true", help="measure again what is there")
    parts.add_parser("rivals", parents=[which, cases, runs], help="measure the rivals")
    p = parts.add_parser("ours", parents=[which, cases], help="measure ours")
    p.add_argument("--cli", required=True, help="the built decimate_cli (run.sh passes it)")
    p.add_argument("--options", default="", help="more options for decimate_cli, in one string")
    p.add_argument("--json", required=True)
    p = parts.add_parser("collect", parents=[which, cases], help="write all results to results/")
    p.add_argument("--ours", help="of 'ours'")
    p = parts.add_parser("times", parents=[which, runs], help="CPU time and memory, filter against filter")
    p.add_argument("--criteria", nargs="+", default=["Deviation", "ScalarDifference", "Quadric"], help="of ours")
    p.add_argument("--reps", type=int, default=3, help="runs of which the median counts; over 2 s: one run")
    p.add_argument("--fast-only", action="store_true", help="without the slow rivals")
    p.add_argument("--fresh-ours", action="store_true", help="measure ours again, keep the rivals")
    p.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project")
    p.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    p = parts.add_parser("summary", parents=[which, cases], help="compare")
    p.add_argument("--ours", help="of 'ours' here, or of deviation.py --json; default: the collected ones")
    p.add_argument("--worst", type=int, default=15, help="length of the lists of the worst cases")
    p.add_argument("--against", help="other results of ours: print what changed")
    args = a.parse_args()
    {"rivals": rivals, "ours": ours, "collect": collect, "times": field_times.measure,
     "summary": field_results.summary}[args.part](args)


if __name__ == "__main__":
    main()
