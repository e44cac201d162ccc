# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes Documentation/benchmark.md, its plots and the table in README.md from results/field* alone.

    field_page.py [--check]

--check writes nothing and fails if the page or the table is not what the results give.
"""
import argparse
import os
import sys

import numpy as np

import field_times
import meshes
from deviation import geometric_mean
from field_results import (FAULTS, FLOORS, MISS, OURS, Comparison, by_percent, keeps_nodes, keeps_topology, mean, missed, place, ratio,
                           read, show, worst)
from field_rivals import RIVALS
from metric import FACING, FLAT

PAGE = os.path.join(meshes.ROOT, "Documentation", "benchmark.md")
IMAGES = os.path.join(meshes.ROOT, "Documentation", "images")
README = os.path.join(meshes.ROOT, "README.md")
MARKS = "<!-- written by Benchmarks/run.sh page -->", "<!-- end -->"
PLOTTED = ["bunny", "fandisk", "linkrod", "grid300"]
SHOWN = ["meshoptimizer", "meshoptimizer, update", "vtkQuadricDecimation", "vtkDecimatePro", "Blender",
         "CGAL Garland-Heckbert", "CGAL Lindstrom-Turk", "OpenMesh, normal flipping"]
FAULT_NAMES = dict(zip(FAULTS, ("flipped triangles", "folded edges", "degenerate triangles", "new non-manifold edges",
                                "Euler characteristic changed")))
MARKERS = "osv^D<>Pp*"

LICENCE = """<!-- SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors -->
<!-- SPDX-License-Identifier: BSD-3-Clause -->"""

def table(head, rows, numbers=True):
    """Markdown; columns after the first that hold numbers alone are set right."""
    number = lambda cell: not cell or cell[0].isdigit()
    right = [numbers and i > 0 and all(number(r[i]) for r in rows) for i in range(len(head))]
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join("--:" if r else "---" for r in right) + "|"]
    return "\n".join(lines + ["| " + " | ".join(r) + " |" for r in rows]) + "\n"


def share(some, limit):
    return f"{100 * sum(s[0] <= limit for s in some) / len(some):.0f} %"


def headline(c, only=None):
    """The best of all and the best that keeps nodes, then the rivals from the nearest to ours to the farthest."""
    groups = c.groups()
    single = [(mean(c.against("hausdorff", pick)), name, pick) for name, pick in groups[2:] if only is None or name in only]
    rows = []
    for name, pick in groups[:2] + [g[1:] for g in sorted(single, key=lambda g: -g[0])]:
        h, r = c.against("hausdorff", pick), c.against("rms", pick)
        if h:
            (most, key, _, _), = worst(h)
            keeps = "yes" if name == groups[1][0] or name in RIVALS and keeps_nodes(name) else ""
            rows.append([name if name in RIVALS else f"**{name}**", keeps, f"{mean(h):.2f}", f"{most:.2f}", place(key),
                         share(h, 1), f"{mean(r):.2f}", f"{worst(r)[0][0]:.2f}", str(len(h))])
    return table(["against", "keeps nodes", "Hausdorff, mean", "worst", "where", "cases <= 1", "RMS, mean", "worst", "cases"],
                 rows)


def worst_cases(c, side, pick, count):
    return table(["case", "ours / theirs", "ours, %", "theirs, %", "rival"],
                 [[place(key), f"{r:.2f}", show(mine[side]), show(row[side]), row["tool"]]
                  for r, key, mine, row in worst(c.against(side, pick), count)])


def every_case(c):
    best, keeps = ({s[1]: s for s in c.against("hausdorff", pick)} for _, pick in c.groups()[:2])
    percents = list(by_percent(best.values()))
    cell = lambda key: " / ".join([show(best[key][2]["hausdorff"])] + [f"{s[key][0]:.2f}" if key in s else "none"
                                                                      for s in (best, keeps)])
    return table(["mesh"] + [f"{p:g} %" for p in percents],
                 [[mesh] + [cell((mesh, p)) if (mesh, p) in best else "" for p in percents]
                  for mesh in sorted({key[0] for key in best})])


def left_out(c):
    lines = []
    for name in sorted({n for _, n, _ in c.left_out}):
        rows = [(key, r) for key, n, r in c.left_out if n == name]
        off, parts = [(key, r) for key, r in rows if not r["failed"]], []
        if off:
            some = [f"{place(key)}: {r['triangles']} of {r['wanted']}" for key, r in off]
            parts.append(f"{len(off)} case{'s' * (len(off) > 1)}" + (f" ({', '.join(some)})" if len(some) <= 5 else ""))
        for reason in dict.fromkeys(r["failed"] for _, r in rows if r["failed"]):
            parts.append(f"{reason}: " + ", ".join(place(key) for key, r in rows if r["failed"] == reason))
        lines.append(f"* {name}: {'; '.join(parts)}\n")
    return "".join(lines)


def claims(c):
    x = np.array([mine["claim"] for _, mine, _ in c.cases if mine["claim"]])
    bounds = {"below 0.5": 0, "0.5 to 0.67": .5, "0.67 to 0.91": 1 / 1.5, "0.91 to 1.1": 1 / 1.1, "1.1 to 1.5": 1.1,
              "1.5 to 2": 1.5, "above 2": 2}
    count, _ = np.histogram(x, [*bounds.values(), np.inf])
    return (f"Over {len(x)} cases: {x.min():.2f} to {x.max():.2f}, median {np.median(x):.2f}, geometric mean "
            f"{geometric_mean(x):.2f}.\n\n" + table(["claimed / measured", *bounds], [["cases", *map(str, count)]]))


def faults(cases, tools):
    """How many over all results and in how many results. Ours counts also where it stops early."""
    rows = []
    for tool in tools:
        some = [r[tool] for r in cases.values() if tool in r and r[tool]["aspect"] and (tool == OURS or not missed(r[tool]))]
        if not some:
            continue
        cells = []
        for what in FAULTS:
            found = [abs(r[what]) if what == "euler" else max(0, r[what]) for r in some]
            hit = sum(f > 0 for f in found)
            cells.append(f"{hit}" if what == "euler" or not hit else f"{sum(found)} in {hit}")
        rows.append([tool, str(len(some)), *cells, *(f"{np.median([r[a] for r in some]):.2f}" for a in ("aspect", "aspect_95"))])
    return table(["tool", "results", *FAULT_NAMES.values(), "aspect ratio, median", "95 %"], rows)


def arrays(c):
    best, average = ({s[1]: s for s in c.against(side)} for side in ("value_largest", "value_mean"))
    cell = lambda r: " / ".join(show(r[side]) for side in ("value_largest", "value_mean", "hausdorff")) if r else ""
    rows = []
    for key, mine, others in c.cases:
        ratios = ["", "", ""]
        if key in best:
            rival = best[key][3]
            ratios = [f"{best[key][0]:.2f}", f"{average[key][0]:.2f}",
                      f"{ratio(mine['hausdorff'], rival['hausdorff'], 'hausdorff'):.2f}"]
        rows.append([place(key), cell(mine), *(cell(others.get(n)) for n in c.rivals), *ratios])
    return table(["case", OURS, *c.rivals, "largest: ours / best", "mean: ours / best", "Hausdorff: ours / that rival's"], rows)


def array_means(c):
    sides = ("value_largest", "value_mean", "hausdorff")
    rows = [[name, *(f"{mean(c.against(side, pick)):.2f}" for side in sides)] for name, pick in c.groups()]
    return table(["against", "largest error", "mean error", "Hausdorff"], rows)


def times(rows):
    out = []
    for mesh in dict.fromkeys(r["mesh"] for r in rows):
        some = [r for r in rows if r["mesh"] == mesh]
        done = sorted((r for r in some if r["cpu"] is not None), key=lambda r: r["cpu_whole"])
        out.append(f"{mesh.split(':')[0]}, {some[0]['nodes']:,.0f} nodes:\n\n" + table(
            ["tool", "CPU s", "with conversion", "peak, bytes a node", "triangles left"],
            [[r["tool"], f"{r['cpu']:.3g}", f"{r['cpu_whole']:.3g}", f"{max(0, r['peak']) / r['nodes']:.0f}",
              f"{r['triangles']:,.0f}"] for r in done]))
        failed = [f"{r['tool']} ({r['failed']})" for r in some if r["cpu"] is None]
        if failed:
            out.append(f"No result: {'; '.join(failed)}.\n")
    return "\n".join(out)


def figure(width, height, rows=1, columns=1):
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plot
    # Text as text and fixed ids: small files that do not change from run to run.
    plot.rcParams.update({"svg.hashsalt": "undecimate", "svg.fonttype": "none", "font.size": 9, "axes.grid": True,
                          "grid.alpha": .3})
    _, axes = plot.subplots(rows, columns, figsize=(width, height), squeeze=False)
    return plot, axes.ravel()


def save(plot, name):
    path = os.path.join(IMAGES, name)
    plot.savefig(path, metadata={"Date": None}, bbox_inches="tight")
    with open(path, encoding="utf-8") as file:
        first, rest = file.read().split("\n", 1)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{first}\n{LICENCE}\n{rest}")
    plot.close()


def plot_error(cases):
    meshes_there = [m for m in PLOTTED if any(key[0] == m for key in cases)]
    if not meshes_there:
        return False
    height = (len(meshes_there) + 1) // 2
    plot, axes = figure(9, 3.1 * height, height, 2)
    lines = {}
    for axis, mesh in zip(axes, meshes_there):
        for i, tool in enumerate([OURS] + SHOWN):
            some = sorted((key[1], 100 * r[tool]["hausdorff"]) for key, r in cases.items()
                          if key[0] == mesh and tool in r and not missed(r[tool]))
            if some:
                lines[tool], = axis.plot(*zip(*some), MARKERS[i] + "-", markersize=4, linewidth=.9 if i else 2,
                                         color=f"C{i - 1}" if i else "black", zorder=2 if i else 3)
        percents = sorted({key[1] for key in cases if key[0] == mesh})
        axis.set(xscale="log", yscale="log", title=mesh, xlabel="triangles kept, %", ylabel="Hausdorff distance, %")
        axis.set_xticks(percents, [f"{p:g}" for p in percents])
        axis.set_xticks([], minor=True)
    for axis in axes[len(meshes_there):]:
        axis.remove()
    plot.gcf().legend(lines.values(), lines, fontsize=8, ncol=5, loc="upper center", bbox_to_anchor=(.5, 0))
    plot.tight_layout()
    save(plot, "benchmark_error.svg")
    return True


def plot_time(rows):
    rows = [r for r in rows if r["mesh"].startswith("grid") and r["cpu_whole"]]
    if len({r["nodes"] for r in rows}) < 2:
        return False
    plot, (axis,) = figure(7, 5)
    for i, tool in enumerate(dict.fromkeys(r["tool"] for r in rows)):
        some = sorted((r["nodes"], r["cpu_whole"]) for r in rows if r["tool"] == tool)
        own = tool.startswith(OURS)
        axis.plot(*zip(*some), MARKERS[i % len(MARKERS)] + ("-" if own else "--"), label=tool, markersize=4,
                  linewidth=2 if own else .8, color=("black", "dimgray", "silver")[i % 3] if own else None)
    axis.set(xscale="log", yscale="log", xlabel="nodes of the grid", ylabel="CPU s, to 1 % of the triangles")
    axis.legend(fontsize=7, loc="center left", bbox_to_anchor=(1, .5))
    save(plot, "benchmark_time.svg")
    return True


def page(about, cases, timed, pictures):
    c, with_array = Comparison(cases), Comparison(cases, arrays=True)
    geometry = {key: rows for key, rows in cases.items() if ":" not in key[0]}
    percents = sorted({key[1] for key in geometry}, reverse=True)
    best, keeps = c.against("hausdorff"), c.against("hausdorff", keeps_nodes)
    rms = c.against("rms", keeps_nodes)
    same = c.against("hausdorff", fits=keeps_topology)
    kept, kept_rms = (c.against(side, keeps_nodes, keeps_topology) for side in ("hausdorff", "rms"))
    (most, where, _, _), = worst(same)
    whole = [about["meshes"][name] for name in {key[0] for key in geometry}]
    text = [f"""# Benchmark: the field

The criterion *Deviation* against {len(c.rivals)} free decimators and variants of them, on {len(whole)} triangle meshes (FEM
surfaces, machined parts, scans, grids) at {", ".join(f"{p:g}" for p in percents)} % of the triangles. This page is written from
`Benchmarks/results/field*` by one command; measuring is another:

    Benchmarks/run.sh field          # rivals (hours; goes on where it was stopped) and ours (minutes)
    Benchmarks/run.sh field-times    # CPU time and memory, on a quiet machine
    Benchmarks/run.sh page           # this page, its plots, the table of the README

Machine: {about["machine"]}

## Distance to the original at equal triangle counts

Ours / theirs, two-sided Hausdorff distance and RMS distance: below 1 ours is nearer to the original. *Mean*: geometric mean
over the cases. *Cases <= 1*: the share in which ours is as near or nearer. *Best of all*: whichever rival is best in the single
case, of several variants of a rival each counts. *Keeps nodes*: the nodes left are nodes of the original, in their place, as ours
are.

""", headline(c), f"""
Of {len(best)} cases ours is at most as far as the best of all in {share(best, 1)}, and at most twice as far in {share(best, 2)}; at
most 1.1 times as far as the best that keeps nodes in {share(keeps, 1.1)}. RMS: at most that of the best that keeps nodes in
{share(rms, 1.0005)}. Counting only results with as many non-manifold edges as the original and its Euler characteristic, as ours
have: {mean(same):.2f} times the best of all in the mean, at most {most:.2f} times ({place(where)}; {len(same)} cases); against those
that keep nodes at most {worst(kept)[0][0]:.2f} times, and {worst(kept_rms)[0][0]:.2f} times by RMS ({len(kept)} cases).

""", table(["triangles kept", "Hausdorff / best of all", "Hausdorff / best that keeps nodes", "RMS / best that keeps nodes"],
           [[f"{p:g} %", *(f"{by_percent(some)[p]:.2f}" for some in (best, keeps, rms))] for p in by_percent(rms)])]
    if "error" in pictures:
        text.append("\n![Hausdorff distance against triangles](images/benchmark_error.svg)\n")
    text.append(f"""
### The worst cases

Hausdorff distance against the best of all:

{worst_cases(c, "hausdorff", lambda n: True, 10)}
Hausdorff distance against the best that keeps nodes:

{worst_cases(c, "hausdorff", keeps_nodes, 6)}
RMS against the best that keeps nodes:

{worst_cases(c, "rms", keeps_nodes, 6)}
### Every case

Hausdorff distance of ours in % of the diagonal / ratio to the best of all / ratio to the best that keeps nodes.

{every_case(c)}
### Left out

A rival that misses the wanted count by over {100 * MISS:g} % is left out of that case:

{left_out(c)}""")
    if c.early:
        text.append("\nOurs stops early for lack of removable nodes, so there are no equal counts to compare at: "
                    + ", ".join(f"{place(key)} ({mine['triangles']} triangles of {mine['wanted']})" for key, mine in c.early) + ".\n")
    text.append(f"""
## Can the reported error be trusted?

The error that the record claims for a level over the measured Hausdorff distance. The measured one is sampled, so it is a
lower bound; `Testing/Hausdorff` compares with bounds by CGAL.

{claims(c)}
## Triangles

Over all results. *Flipped*: the normal points against the original's at the closest points of seven points of the triangle, at
all of them; on grids it is seen from above. *Folded*: an edge whose two triangles lie on each other within {np.degrees(np.arccos(FACING)):.0f} degrees where the
original's do not. Triangles and folded edges of the original itself do not count. *Degenerate*: twice the area below {FLAT:g} of the longest edge squared. "12 in 3": 12 of them in three results.
*Aspect ratio*: longest edge / (2 sqrt(3) radius of the inscribed circle), 1 for the equilateral triangle: median of the
results' medians and of their 95 % quantiles. The originals have {np.median([m["aspect"] for m in whole]):.2f} and {np.median([m["aspect_95"] for m in whole]):.2f}.

{faults(geometry, [OURS] + c.rivals)}""")
    if with_array.rivals:
        text.append(f"""
## Nodal arrays

Decimation steered by an array, each at its default or documented weight: ours `ScalarWeight` 0.055, vtkQuadricDecimation
`ScalarsWeight` 0.1, meshoptimizer 0.5 of the range. Largest error / mean error of the array in % of its range, interpolated at the
closest point / Hausdorff distance in % of the diagonal. Ratios are to the rival that is best in that error.

{arrays(with_array)}
Geometric means of ours / theirs:

{array_means(with_array)}
Ours and meshoptimizer without update keep the values of the nodes that are left. So where a field is curved, an interpolation
errs to one side; the others move nodes or values to the middle, which lowers the mean.
""")
    if timed:
        text.append(f"""
## CPU time and memory

To {field_times.PERCENT:g} % of the triangles, one thread, a process a run, median of three runs (one, where it takes over 2 s). *CPU s*: the
decimation alone. *With conversion*: from `vtkPolyData` to `vtkPolyData` (Blender: from arrays to arrays). Ours is the whole
filter, with the record. *Peak*: growth of the peak resident set over what is there with the input. All were measured in
one run, on 22 November 2026; ours has changed since (on a million nodes see [speed.md](speed.md)).

{times(timed)}""")
        if "time" in pictures:
            text.append("\n![CPU time against nodes](images/benchmark_time.svg)\n")
    text.append(f"""
## How it is measured

* Distances: `Benchmarks/metric.py`, the same for all. Closest points from the nodes of each surface and from random points on it
  (fixed seed) to the other; the largest ones again in double precision. In % of the diagonal of the original's bounding box.
* Ratios: both sides floored at {100 * FLOORS["hausdorff"]:g} % of the diagonal (Hausdorff distance), {100 * FLOORS["rms"]:g} % (RMS), and of the range at
  {100 * FLOORS["value_largest"]:g} % (largest error) and {100 * FLOORS["value_mean"]:g} % (mean error). Below that, as on flat plates, the ratio of two nothings would decide.
* Ours takes at most the wanted number of triangles. vtkQuadricClustering and vtkBinnedDecimation have no such target: they get the
  finest division that stays below it.
* Settings are the rivals' defaults, except as the name of a variant says. CGAL Garland-Heckbert: plane quadrics with bounded
  change of the normals. *Preserve*: boundary, normals and topology. *Topology*: PreserveTopology. *Update*: simplifyWithUpdate,
  which moves the nodes it keeps.
* Every run is a process of its own with at most 300 s of CPU time. Ours is the core's (`decimate_cli`); the times are the filter's.
* Raw results: `Benchmarks/results/field.csv`, `field.json`, `field_times.csv`. How to measure more: `Benchmarks/README.md`.

## Versions

{table(["rival", "version"], [[n, v or "no result"] for n, v in sorted(about["versions"].items())], numbers=False)}""")
    return "".join(text)


def with_table(readme, c):
    """The README with its table between the marks written anew."""
    if MARKS[0] not in readme:
        raise SystemExit(f"README.md: the line '{MARKS[0]}' is absent")
    before, rest = readme.split(MARKS[0], 1)
    return before + f"{MARKS[0]}\n\n{headline(c, only=SHOWN)}\n{MARKS[1]}" + rest.split(MARKS[1], 1)[1]


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--check", action="store_true", help="only compare")
    args = a.parse_args()
    about, cases = read()
    c, timed = Comparison(cases), field_times.read()
    if not c.cases:
        raise SystemExit("results/field.csv holds no results of ours: run 'run.sh field' first")
    drawn = {"error": "benchmark_error.svg", "time": "benchmark_time.svg"}
    if args.check:
        pictures = {name for name, file in drawn.items() if os.path.exists(os.path.join(IMAGES, file))}
    else:
        pictures = {name for name, there in (("error", plot_error(cases)), ("time", plot_time(timed))) if there}
    with open(README) as f:
        readme = f.read()
    stale = []
    for file, text in {PAGE: page(about, cases, timed, pictures), README: with_table(readme, c)}.items():
        old = None
        if os.path.exists(file):
            with open(file) as f:
                old = f.read()
        if old != text:
            stale.append(os.path.basename(file))
            if not args.check:
                with open(file, "w") as f:
                    f.write(text)
    if args.check and stale:
        sys.exit(f"not what the results give: {', '.join(stale)}. Run 'Benchmarks/run.sh page'.")
    print("written: " + ", ".join(stale) if stale else "unchanged")


if __name__ == "__main__":
    main()
