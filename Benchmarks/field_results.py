# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results of field.py: the table in results/, and ours compared with the field case by case.

Ratios are ours / theirs, with both sides floored: below 0.01 % of the diagonal (Hausdorff distance), 0.001 % (RMS), 0.01 % of
an array's range (largest error) and 0.001 % (mean error) the ratio of two nothings would decide.
"""
import csv
import json
import os

import numpy as np

from deviation import geometric_mean
from field_rivals import RIVALS

RESULTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "results")
OURS = "Undecimate"
FLOORS = {"hausdorff": 1e-4, "rms": 1e-5, "value_largest": 1e-4, "value_mean": 1e-5}
MISS = .02  # of the wanted count
FAULTS = ("flipped", "folded", "degenerate", "nonmanifold", "euler")
COLUMNS = {"mesh": str, "percent": float, "tool": str, "triangles": int, "hausdorff": float, "rms": float,
           "nonmanifold": int, "euler": int, "flipped": int, "folded": int, "degenerate": int, "aspect": float,
           "aspect_95": float, "value_largest": float, "value_mean": float, "claim": float, "failed": str}


def wanted_count(total, percent):
    return max(4, round(total * percent / 100))


def read():
    """What it was measured with, and {(mesh, percent): {tool: row}}."""
    with open(os.path.join(RESULTS, "field.json")) as f:
        about = json.load(f)
    table = {}
    with open(os.path.join(RESULTS, "field.csv"), newline="") as f:
        for line in csv.DictReader(f):
            row = {k: None if line[k] == "" else kind(line[k]) for k, kind in COLUMNS.items()}
            row["wanted"] = wanted_count(about["meshes"][row["mesh"]]["triangles"], row["percent"])
            table.setdefault((row["mesh"], row["percent"]), {})[row["tool"]] = row
    return about, table


def with_ours(table, file):
    """The table with the results of ours in a file of 'field.py ours' or 'deviation.py --json'."""
    table = {key: {n: r for n, r in rows.items() if n != OURS} for key, rows in table.items()}
    with open(file) as f:
        for case in json.load(f):
            key = case["mesh"], case["percent"]
            if key in table:
                row = {name: case["ours"].get(name) for name in COLUMNS}
                flipped = case["ours"].get("flipped", case["ours"].get("flipped_near"))
                table[key][OURS] = dict(row, mesh=key[0], percent=key[1], tool=OURS, flipped=flipped,
                                        wanted=case["ours"]["target"])
    return table


def missed(row):
    return row["failed"] is not None or abs(row["triangles"] - row["wanted"]) > MISS * row["wanted"]


def ratio(mine, theirs, side):
    return max(mine, FLOORS[side]) / max(theirs, FLOORS[side])


def keeps_nodes(tool):
    return RIVALS[tool]().keeps_nodes


def keeps_topology(row):
    """Whether a result has as many non-manifold edges as the original, and its Euler characteristic."""
    return row["nonmanifold"] == 0 and row["euler"] == 0


class Comparison:
    """`cases`: [(key, our row, {rival: row})]. A rival that misses the wanted count by over 2 % is `left_out` of
    the case; a case in which ours stops early, so that there are no equal counts, is `early`."""

    def __init__(self, table, arrays=False):
        self.cases, self.left_out, self.early = [], [], []
        for key, rows in table.items():
            if OURS not in rows or (":" in key[0]) != arrays:
                continue
            mine, others = rows[OURS], {n: r for n, r in rows.items() if n != OURS}
            if mine["triangles"] > (1 + MISS) * mine["wanted"]:
                self.early.append((key, mine))
                continue
            self.left_out += [(key, n, r) for n, r in others.items() if missed(r)]
            self.cases.append((key, mine, {n: r for n, r in others.items() if not missed(r)}))
        self.rivals = sorted({n for _, _, rows in self.cases for n in rows})

    def against(self, side, pick=lambda tool: True, fits=lambda row: True):
        """[(ratio, key, our row, rival's row)], against the best of the picked rivals, and of their fitting rows, in each case."""
        out = []
        for key, mine, rows in self.cases:
            some = [r for n, r in rows.items() if pick(n) and r[side] is not None and fits(r)]
            if some:
                best = min(some, key=lambda r: r[side])
                out.append((ratio(mine[side], best[side], side), key, mine, best))
        return out

    def groups(self):
        """(label, pick) of the rows of a comparison: the best of all, the best that keeps nodes, each rival."""
        out = [("best of all, case by case", lambda n: True), ("best that keeps nodes, case by case", keeps_nodes)]
        return out + [(rival, lambda n, rival=rival: n == rival) for rival in self.rivals]


def mean(some):
    return geometric_mean([s[0] for s in some])


def worst(some, count=1):
    return sorted(some, key=lambda s: -s[0])[:count]


def by_percent(some):
    """{percent: geometric mean}, from many triangles to few."""
    percents = sorted({s[1][1] for s in some}, reverse=True)
    return {p: mean([s for s in some if s[1][1] == p]) for p in percents}


def place(key):
    return f"{key[0]} {key[1]:g} %".replace(":", ", ")


def show(x):
    """A fraction in percent."""
    return f"{100 * x:.3g}"


def print_means(c):
    print(f"{len(c.cases)} cases, ours / theirs\n")
    print("| against | Hausdorff, mean | worst | where | RMS, mean | worst | where | cases | left out |")
    print("|---|--:|--:|---|--:|--:|---|--:|--:|")
    for name, pick in c.groups():
        cells = []
        for side in ("hausdorff", "rms"):
            some = c.against(side, pick)
            if some:
                (r, key, _, row), = worst(some)
                cells += [f"{mean(some):.3f}", f"{r:.2f}", f"{place(key)}, {row['tool']}"]
        out = sum(n == name for _, n, _ in c.left_out)
        if cells:
            print(f"| {name} | {' | '.join(cells)} | {len(some)} | {out or ''} |")


def print_shares(c):
    best, keeps = c.against("hausdorff"), c.against("hausdorff", keeps_nodes)
    kept = by_percent(keeps)
    print("\nHausdorff by percent, best of all / best that keeps nodes: "
          + "; ".join(f"{p:g} %: {m:.3f} / {kept.get(p, float('nan')):.3f}" for p, m in by_percent(best).items()))
    share = lambda some, limit: f"{sum(s[0] <= limit for s in some)} of {len(some)}"
    print(f"\nHausdorff at most 1.0 x the best of all: {share(best, 1)}; 2 x: {share(best, 2)}; "
          f"1.1 x the best that keeps nodes: {share(keeps, 1.1)}.")
    print(f"RMS at most 1.0 x the best that keeps nodes: {share(c.against('rms', keeps_nodes), 1.0005)}; "
          f"1.3 x the best of all: {share(c.against('rms'), 1.3)}.")
    for label, pick in (("any", lambda n: True), ("those that keep nodes", keeps_nodes)):
        same, rms = (c.against(side, pick, keeps_topology) for side in ("hausdorff", "rms"))
        if same:
            print(f"Of {label}, where the result has the topology of the original ({len(same)} cases): Hausdorff {mean(same):.3f}, "
                  f"worst {worst(same)[0][0]:.2f} ({place(worst(same)[0][1])}); RMS worst {worst(rms)[0][0]:.2f} "
                  f"({place(worst(rms)[0][1])}).")
    claims = [mine["claim"] for _, mine, _ in c.cases if mine["claim"]]
    if claims:
        print(f"Claimed / measured error: {min(claims):.2f} to {max(claims):.2f}, geometric mean "
              f"{geometric_mean(claims):.2f}; below 1/1.1: {sum(x < 1 / 1.1 for x in claims)}, "
              f"above 2: {sum(x > 2 for x in claims)} of {len(claims)}.")


def print_faults(c):
    own = [(key, mine) for key, mine, _ in c.cases] + c.early
    parts = []
    for what in FAULTS:
        found = [f"{mine[what]} ({place(key)})" for key, mine in own if mine[what]]
        if found:
            parts.append(f"{what} {', '.join(found)}")
    unknown = sum(mine["folded"] is None for _, mine in own)
    print(f"\nFaults of ours: {'; '.join(parts) or 'none'}."
          + (f" Not looked for in {unknown} cases." if unknown else ""))


def print_worst(c, count):
    for what, side, pick in (("best of all, Hausdorff", "hausdorff", lambda n: True),
                             ("best that keeps nodes, Hausdorff", "hausdorff", keeps_nodes),
                             ("best that keeps nodes, RMS", "rms", keeps_nodes)):
        print(f"\n| worst against {what} | ratio | ours % | theirs % | rival |\n|---|--:|--:|--:|---|")
        for r, key, mine, row in worst(c.against(side, pick), count):
            print(f"| {place(key)} | {r:.2f} | {show(mine[side])} | {show(row[side])} | {row['tool']} |")


def print_arrays(c):
    largest, average = c.against("value_largest"), {s[1]: s for s in c.against("value_mean")}
    if not largest:
        return
    print("\n| with an array | largest % | mean % | Hausdorff % | largest / best | mean / best | Hausdorff / that "
          "rival's | best in the largest |\n|---|--:|--:|--:|--:|--:|--:|---|")
    for r, key, mine, row in largest:
        print(f"| {place(key)} | {show(mine['value_largest'])} | {show(mine['value_mean'])} | {show(mine['hausdorff'])} | "
              f"{r:.2f} | {average[key][0]:.2f} | {ratio(mine['hausdorff'], row['hausdorff'], 'hausdorff'):.2f} | "
              f"{row['tool']} |")
    print(f"\nGeometric means: largest {mean(largest):.3f}, mean {mean(average.values()):.3f}.")


def print_changes(c, before):
    changed = sorted((ratio(mine["hausdorff"], before[key][OURS]["hausdorff"], "hausdorff"), key, mine)
                     for key, mine, _ in c.cases if OURS in before[key])
    if not changed:
        return
    print("\n| changed by over 5 % | before % | now % | ratio |\n|---|--:|--:|--:|")
    for r, key, mine in changed:
        if abs(np.log(r)) > .05:
            print(f"| {place(key)} | {show(before[key][OURS]['hausdorff'])} | {show(mine['hausdorff'])} | {r:.2f} |")
    print(f"\nNow / before, geometric mean of {len(changed)} cases: {mean(changed):.4f}")


def summary(args):
    _, table = read()
    table = {key: rows for key, rows in table.items()
             if key[1] in args.percent and (not args.meshes or key[0] in args.meshes)}
    before = with_ours(table, args.against) if args.against else None
    if args.ours:
        table = with_ours(table, args.ours)
    c, arrays = Comparison(table), Comparison(table, arrays=True)
    for key, mine in c.early:
        print(f"Apart: {place(key)}, ours stopped at {mine['triangles']} triangles of {mine['wanted']}.")
    if c.cases:
        print_means(c)
        print_shares(c)
        print_faults(c)
        print_worst(c, args.worst)
    print_arrays(arrays)
    if before:
        print_changes(c, before)
