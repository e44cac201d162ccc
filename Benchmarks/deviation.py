# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Criterion Deviation against VTK's decimators: Hausdorff distance at equal triangle counts.

    run.sh deviation [--meshes bunny grid100 ...] [--percent 25 10 5 2 1] [--jobs 2]

The rivals' results are kept (~/.cache/undecimate/rivals) and reused, so a second run only measures
ours; --fresh-rivals measures them again. Ours is decimated once to the smallest count, and the other
levels are reached by walking the record; --time-each also times a decimation to each count. Where a
rival's count is not the wanted one, ours is measured at that count too. Ratios are ours / theirs
with both distances floored at 0.01 % of the diagonal.
"""
import argparse
import concurrent.futures
import hashlib
import json
import multiprocessing
import os
import subprocess
import sys
import tempfile

import numpy as np

import meshes
from rivals import PRO, QUADRIC

HERE = os.path.dirname(os.path.abspath(__file__))
FLOOR = 1e-4
TARGETS = {"Hausdorff, geometric mean against " + QUADRIC: .85,
           "Hausdorff, geometric mean against " + PRO: .4,
           "Hausdorff, worst case against " + QUADRIC: 2.0,
           "CPU time, worst case against " + QUADRIC: 1.5,
           "CPU time, total against " + QUADRIC: 1.5}


def child_environment():
    """One thread for everybody."""
    return dict(os.environ, VTK_SMP_BACKEND_IN_USE="Sequential", OMP_NUM_THREADS="1",
                TBB_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")


def run_json(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=child_environment())
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command[:2])}: {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout)


def prepare(name, array=None):
    """The mesh (with the name of a nodal array also its values, else None), a key of its content, and its
    file in the driver's format."""
    points, triangles, *more = meshes.load(name, array)
    values = more[0] if more else None
    content = [a.tobytes() for a in (points, triangles, *more)]
    key = hashlib.sha256(b"".join(content)).hexdigest()[:16]
    folder = os.path.join(meshes.CACHE, "meshes")
    os.makedirs(folder, exist_ok=True)
    file = os.path.join(folder, key + ".mesh")
    if not os.path.exists(file):
        meshes.write(file, points, triangles, values)
    return points, triangles, values, key, file


def rival_rows(name, key, file, reference, total, args):
    """{(percent, rival): row}, measured now or before."""
    from vtkmodules.vtkCommonCore import vtkVersion

    import metric
    store = os.path.join(meshes.CACHE, "rivals", f"{name}-{key}.json")
    os.makedirs(os.path.dirname(store), exist_ok=True)
    known = {}
    if os.path.exists(store):
        with open(store) as f:
            known = json.load(f)
    out = {}
    for percent in args.percent:
        for rival in (QUADRIC, PRO):
            slot = f"{rival} {vtkVersion.GetVTKVersion()} {percent:g} % metric {metric.VERSION}"
            if slot not in known or args.fresh_rivals:
                with tempfile.TemporaryDirectory() as tmp:
                    wanted = max(4, round(total * percent / 100))
                    row = run_json([sys.executable, os.path.join(HERE, "rivals.py"), file, rival,
                                    tmp + "/out.npz", str(wanted), str(args.reps)])
                    z = np.load(tmp + "/out.npz")
                    row.update(reference.measure(z["points"], z["triangles"]))
                known[slot] = row
                with open(store + ".new", "w") as f:
                    json.dump(known, f, indent=1)
                os.replace(store + ".new", store)
            out[percent, rival] = known[slot]
    return out


def own_rows(file, reference, rivals, total, args, faults=False):
    """{triangle count: row} of ours at all counts that the comparison needs."""
    wanted = {max(4, round(total * p / 100)) for p in args.percent}
    wanted |= {r["triangles"] for r in rivals.values()
               if abs(r["triangles"] - r["wanted"]) > max(2, .001 * r["wanted"])}
    with tempfile.TemporaryDirectory() as tmp:
        command = [args.cli, file, "--targets", ",".join(map(str, sorted(wanted))), "--out",
                   tmp + "/", "--reps", str(args.reps)]
        result = run_json(command + (["--time-each"] if args.time_each else []) + args.options.split())
        rows = {}
        for level in result["levels"]:
            row = dict(level, stop=result["stop"])
            points, triangles = meshes.read(row.pop("file"))
            values = None if reference.values is None else meshes.read_values(level["file"])
            row.update(reference.measure(points, triangles, values))
            if faults:
                row.update(reference.faults(points, triangles))
            row["claim"] = row.pop("error") / row["hausdorff"] if row["hausdorff"] > 1e-6 else None
            rows[level["target"]] = row
    return rows


def measure(name, args):
    from metric import Reference
    points, triangles, _, key, file = prepare(name)
    reference = Reference(points, triangles)
    rivals = rival_rows(name, key, file, reference, len(triangles), args)
    own = {} if args.rivals_only else own_rows(file, reference, rivals, len(triangles), args)
    out = []
    for percent in args.percent:
        case = {"mesh": name, "input_triangles": len(triangles), "percent": percent}
        wanted = max(4, round(len(triangles) * percent / 100))
        if own:
            case["ours"] = own[wanted]
        for rival in (QUADRIC, PRO):
            case[rival] = r = rivals[percent, rival]
            if own:
                ours = own.get(r["triangles"], own[wanted])
                case["ratio " + rival] = (max(ours["hausdorff"], FLOOR) / max(r["hausdorff"], FLOOR))
                if ours["cpu"] > 0:
                    case["cpu ratio " + rival] = ours["cpu"] / r["cpu"]
        out.append(case)
    return out


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values))))


def notes(case):
    ours, out = case["ours"], []
    if stopped_early(case):
        out.append(f"stopped at {ours['triangles']} of {ours['target']}: {ours['stop']}")
    for who, row in (("", ours), ("quadric ", case[QUADRIC]), ("pro ", case[PRO])):
        for what in ("nonmanifold", "euler", "flipped"):
            if row.get(what):
                out.append(f"{who}{what} {row[what]:+d}")
        if who and abs(row["triangles"] - row["wanted"]) > max(2, .001 * row["wanted"]):
            out.append(f"{who}at {row['triangles']} of {row['wanted']}")
    return "; ".join(out)


def table(cases):
    show = lambda x: f"{100 * x:.3g}"
    cpu = lambda x: f"{x:.3f}" if x else ""
    print("| mesh | kept % | ours | quadric | pro | ours/quadric | ours/pro | RMS ours | RMS quadric "
          "| claimed/measured | CPU s ours | quadric | pro | notes |")
    print("|---|" + "--:|" * 12 + "---|")
    for c in cases:
        o, q, p = c["ours"], c[QUADRIC], c[PRO]
        print(f"| {c['mesh']} | {c['percent']:g} | {show(o['hausdorff'])} | {show(q['hausdorff'])} | "
              f"{show(p['hausdorff'])} | {c['ratio ' + QUADRIC]:.2f} | {c['ratio ' + PRO]:.2f} | "
              f"{show(o['rms'])} | {show(q['rms'])} | {'' if o['claim'] is None else format(o['claim'], '.2f')} | "
              f"{cpu(o['cpu'])} | {cpu(q['cpu'])} | {cpu(p['cpu'])} | {notes(c)} |")


def label(case):
    return f"{case['mesh']} {case['percent']:g} %"


def stopped_early(case):
    """Ours had no node left to remove: there are no equal counts to compare at."""
    return case["ours"]["triangles"] > max(case["ours"]["target"], 1)


def summary(cases):
    """Rows of (what, value, target, case)."""
    name = label
    timed = [c for c in cases if "cpu ratio " + QUADRIC in c]
    worst = max(cases, key=lambda c: c["ratio " + QUADRIC])
    slow = max(timed, key=lambda c: c["cpu ratio " + QUADRIC])
    total = sum(c["ours"]["cpu"] for c in timed) / sum(c[QUADRIC]["cpu"] for c in timed)
    rows = [(geometric_mean([c["ratio " + QUADRIC] for c in cases]), ""),
            (geometric_mean([c["ratio " + PRO] for c in cases]), ""),
            (worst["ratio " + QUADRIC], name(worst)), (slow["cpu ratio " + QUADRIC], name(slow)),
            (total, "")]
    out = [(what, value, target, where) for (what, target), (value, where) in zip(TARGETS.items(), rows)]
    for p in sorted({c["percent"] for c in cases}, reverse=True):
        some = [c for c in cases if c["percent"] == p]
        out.append((f"Hausdorff at {p:g} %, geometric mean against {QUADRIC}",
                    geometric_mean([c["ratio " + QUADRIC] for c in some]), None, ""))
    claims = [c["ours"]["claim"] for c in cases if c["ours"]["claim"]]
    if claims:
        out.append(("claimed / measured error, smallest", min(claims), None, ""))
        out.append(("claimed / measured error, geometric mean", geometric_mean(claims), None, ""))
        out.append(("claimed / measured error, largest", max(claims), None, ""))
    return out


def print_summary(cases):
    apart = [c for c in cases if stopped_early(c)]
    cases = [c for c in cases if not stopped_early(c)]
    for c in apart:
        print(f"Apart, since ours keeps the nodes of non-manifold edges and stops at {c['ours']['triangles']} "
              f"triangles where {c['ours']['target']} are wanted: {label(c)}, ours / {QUADRIC} {c['ratio ' + QUADRIC]:.1f}, "
              f"ours / {PRO} {c['ratio ' + PRO]:.2f}.\n")
    print("| figure | value | target | where |\n|---|--:|--:|---|")
    for what, value, target, where in summary(cases):
        mark = "" if target is None else f"{target:g} " + ("met" if value <= target else "**missed**")
        print(f"| {what} | {value:.3f} | {mark} | {where} |")


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--cli", required=True, help="the built decimate_cli (run.sh passes it)")
    a.add_argument("--meshes", nargs="+", help="names of the data set, gridN, or .vtp files; default: all")
    a.add_argument("--percent", nargs="+", type=float, default=[25, 10, 5, 2, 1], help="of the triangles to keep")
    a.add_argument("--jobs", type=int, default=2, help="meshes at a time")
    a.add_argument("--reps", type=int, default=1, help="runs of which the median CPU time counts")
    a.add_argument("--time-each", action="store_true", help="time a decimation of ours to each count")
    a.add_argument("--options", default="", help="more options for decimate_cli, in one string")
    a.add_argument("--fresh-rivals", action="store_true", help="measure the rivals again")
    a.add_argument("--rivals-only", action="store_true", help="only fill the rivals' results")
    a.add_argument("--json", help="write all cases to this file")
    a.add_argument("--compare", help="an earlier --json: print the cases that changed by over 2 %%")
    args = a.parse_args()
    names = args.meshes or meshes.data_set()
    if not args.meshes and not os.path.isdir(meshes.DATA):
        print(f"The data set is absent (UNDECIMATE_DATA, else ../shared/data beside the repository): "
              f"only Data/plate_hole and a grid are measured.\n")
        names = ["plate_hole", "grid100"]
    cases = []
    # Longest first, so that the last job is short.
    names.sort(key=lambda n: -os.path.getsize(meshes.path(n)) if not n.startswith("grid") else 0)
    spawn = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(args.jobs, mp_context=spawn) as pool:
        jobs = {pool.submit(measure, n, args): n for n in names}
        for job in concurrent.futures.as_completed(jobs):
            try:
                cases += job.result()
            except Exception as error:
                pool.shutdown(wait=False, cancel_futures=True)
                raise SystemExit(f"{jobs[job]}: {error}")
            print(f"{jobs[job]} done", file=sys.stderr, flush=True)
    if args.rivals_only:
        return
    cases.sort(key=lambda c: (c["mesh"], -c["percent"]))
    table(cases)
    print()
    print_summary(cases)
    if args.compare:
        with open(args.compare) as f:
            before = {(c["mesh"], c["percent"]): c for c in json.load(f)}
        print("\n| changed | before | now |\n|---|--:|--:|")
        for c in cases:
            b = before.get((c["mesh"], c["percent"]))
            if b and abs(np.log(c["ratio " + QUADRIC] / b["ratio " + QUADRIC])) > .02:
                print(f"| {c['mesh']} {c['percent']:g} % | {b['ratio ' + QUADRIC]:.2f} | {c['ratio ' + QUADRIC]:.2f} |")
    if args.json:
        with open(args.json, "w") as f:
            json.dump(cases, f, indent=1)


if __name__ == "__main__":
    main()
