# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The main job in the real ParaView, with its menus, panels and slider, under Xvfb.

Opens the plate, colours it by stress, applies Hash Queue Decimation and Undecimation, moves the
Level slider from 0 to 1 and back. Checked at every stop: the numbers of points and cells in the
Information panel, against those of pvpython and of the input; at the ends: what a screenshot shows.
"""

import sys

import numpy as np

import playback


def write_script(mesh, expected, output):
    script = playback.Script()
    script.open(mesh)
    script.check_counts(*expected["input"])

    script.filter("HashQueueDecimation")
    # The fourth array in the list, by alphabet, is von_mises.
    script.event(f"{playback.PROPERTIES}/Scalars/ArraySelectionWidget", "setCheckState", "3.0,2")
    script.apply()
    script.check_counts(*expected["coarse"])
    nodes, triangles = expected["coarse"]
    script.check_results(NumberOfNodes=nodes, NumberOfTriangles=triangles)

    script.filter("Undecimation")
    script.apply()
    script.color("von_mises")
    script.check_counts(*expected["coarse"])
    script.screenshot(output / "level_0.png")
    for percent in 50, 100:
        script.slide(percent)
        script.apply()
        nodes, triangles = expected[f"{percent / 100:g}"]
        script.check_counts(nodes, triangles)
        script.check_results(NumberOfNodes=nodes, NumberOfTriangles=triangles)
    script.screenshot(output / "level_1.png")
    script.slide(0)
    script.apply()
    script.check_counts(*expected["0"])
    script.screenshot(output / "level_0_again.png")
    script.save_state(output / "state.pvsm")
    script.write(output / "main_job.xml")


def describe(image):
    """Shares of pixels: not background; blue (low stress, edges); reddish (the peak at the hole)."""
    red, green, blue = np.moveaxis(image, 2, 0)
    mesh = np.abs(image - image[2, 2]).max(axis=2) > 25
    return mesh.mean(), (mesh & (blue > red + 60)).mean(), (mesh & (red > green + 20)).mean()


def check_pictures(output):
    coarse, fine, again = (
        playback.pixels(output / f"{name}.png") for name in ("level_0", "level_1", "level_0_again")
    )
    faults = []
    for name, image in ("level 0", coarse), ("level 1", fine):
        mesh, blue, reddish = describe(image)
        print(f"{name}: {mesh:.1%} is not background, {blue:.1%} blue, {reddish:.2%} reddish")
        if mesh < 0.1:
            faults.append(f"{name}: the mesh fills {mesh:.1%} of the picture")
        if blue < 0.05:
            faults.append(f"{name}: only {blue:.1%} of the picture is blue")
        if reddish < 0.0005:
            faults.append(f"{name}: only {reddish:.3%} is reddish, so the stress is not shown")
    if coarse.shape != fine.shape:
        return faults + [f"sizes differ: {coarse.shape} and {fine.shape}"]
    changed = playback.changed(coarse, fine)
    returned = playback.changed(coarse, again)
    print(f"changed from level 0 to 1: {changed:.1%} of the pixels, and back at 0: {returned:.2%}")
    if changed < 0.02:
        faults.append(f"levels 0 and 1 differ in only {changed:.2%} of the pixels")
    if returned > 0.001:
        faults.append(f"back at level 0 {returned:.2%} of the pixels differ")
    return faults


def check(output):
    faults = check_pictures(output)
    visible = playback.shown(output / "state.pvsm")
    print("shown in the end:", sorted(visible))
    if visible != {("Undecimation1", 0)}:
        faults.append("something else than the output of Undecimation is shown in the end")
    return faults


if __name__ == "__main__":
    sys.exit(
        playback.run_job("main_job", "HashQueueDecimation", "von_mises", write_script, check)
    )
