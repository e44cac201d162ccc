# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two sliders in the real ParaView, with its menus, panels and time controls, under Xvfb.

Opens a crash, applies Tri Quad Decimation and Undecimation, colours by plastic strain, goes to the
last time step, moves the Level slider from 0 to 1, goes back in time and in level. Checked at every
stop: points, cells, quads and triangles in the panels, against those of pvpython and of the input;
what the screenshots show: the box is crushed at the end, and all comes back.
"""

import sys

import numpy as np

import playback


def write_script(mesh, expected, output):
    script = playback.Script()

    def check(level):
        nodes, cells = expected[level]
        quads = expected[f"quads at {level}"]
        script.check_counts(nodes, cells)
        script.check_results(
            NumberOfNodes=nodes, NumberOfTriangles=cells - quads, NumberOfQuads=quads
        )

    script.open(mesh)
    script.check_counts(*expected["input"])
    script.filter("TriQuadDecimation")
    script.apply()
    check("0")
    steps = ", ".join(str(i) for i in range(len(expected["times"])))
    script.check(f"{playback.PROPERTIES}/UsedSteps/UsedSteps", steps)

    script.filter("Undecimation")
    script.apply()
    script.color("plastic_strain")
    script.look_along_x()
    check("0")
    script.screenshot(output / "first_0.png")
    script.go_to_frame("Last")
    check("0")
    script.screenshot(output / "last_0.png")
    for percent, level in (50, "0.5"), (100, "1"):
        script.slide(percent)
        script.apply()
        check(level)
    script.screenshot(output / "last_1.png")
    script.go_to_frame("First")
    check("1")
    script.screenshot(output / "first_1.png")
    script.go_to_frame("Next")
    check("1")
    script.go_to_frame("First")
    script.slide(0)
    script.apply()
    check("0")
    script.screenshot(output / "first_0_again.png")
    script.write(output / "time_job.xml")


def tall(image):
    """Pixels from the top to the bottom of what is not background."""
    rows = np.nonzero((np.abs(image - image[2, 2]).max(axis=2) > 25).any(axis=1))[0]
    return rows.max() - rows.min() if rows.size else 0


def check_pictures(output):
    names = "first_0", "last_0", "last_1", "first_1", "first_0_again"
    images = {name: playback.pixels(output / f"{name}.png") for name in names}
    height = {name: tall(image) for name, image in images.items()}
    print("heights in pixels:", height)
    faults = []
    for level in "0", "1":
        first, last = height[f"first_{level}"], height[f"last_{level}"]
        # 240 mm become 86.
        if not 0.25 * first < last < 0.6 * first:
            faults.append(f"level {level}: the box is {first} pixels high, and {last} in the end")
    for a, b in ("first_0", "first_1"), ("last_0", "last_1"):
        changed = playback.changed(images[a], images[b])
        print(f"changed from {a} to {b}: {changed:.1%} of the pixels")
        if changed < 0.02:
            faults.append(f"{a} and {b} differ in only {changed:.2%} of the pixels")
    returned = playback.changed(images["first_0"], images["first_0_again"])
    print(f"back at the first time and level 0: {returned:.2%} of the pixels differ")
    if returned > 0.001:
        faults.append(f"back at the first time and level 0 {returned:.2%} of the pixels differ")
    return faults


if __name__ == "__main__":
    sys.exit(
        playback.run_job("time_job", "TriQuadDecimation", "none", write_script, check_pictures)
    )
