# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The main job in the real ParaView, with its menus, panels and slider, under Xvfb.

Opens the plate, colours it by stress, applies Hash Queue Decimation and Undecimation, moves the
Level slider from 0 to 1 and back. Checked at every stop: the numbers of points and cells in the
Information panel, against those of pvpython and of the input; at the ends: what a screenshot shows.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from xml.sax.saxutils import quoteattr

import numpy as np
from PIL import Image

WINDOW = "pqClientMainWindow"
PANEL = f"{WINDOW}/propertiesDock/propertiesPanel"
PROPERTIES = (
    f"{PANEL}/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel"
)
INFORMATION = (
    f"{WINDOW}/informationDock/informationWidgetFrame/informationScrollArea"
    "/qt_scrollarea_viewport/informationWidget"
)


class Script:
    """Events for ParaView's own test playback."""

    def __init__(self):
        self.lines = []

    def event(self, target, command, arguments=""):
        self.lines.append(
            f"<pqevent object={quoteattr(target)} command={quoteattr(command)} "
            f"arguments={quoteattr(str(arguments))}/>"
        )

    def check(self, target, value):
        self.lines.append(
            f'<pqcheck object={quoteattr(target)} property="text" arguments={quoteattr(value)}/>'
        )

    def menu(self, menu, action):
        self.event(f"{WINDOW}/menubar/{menu}", "activate", action)

    def apply(self):
        self.event(f"{PANEL}/Accept", "activate")

    def filter(self, name):
        self.event(f"{WINDOW}/menubar", "activate", "menuFilters")
        self.menu("menuFilters/Progressive Mesh", name)

    def color(self, array):
        self.event(f"{WINDOW}/variableToolbar/displayColor/Variables", "set_string", array)
        self.event(
            f"{WINDOW}/representationToolbar/displayRepresentation/comboBox",
            "set_string",
            "Surface With Edges",
        )

    def tab(self, name):
        self.event(f"{WINDOW}/1QTabBar0", "set_tab_with_text", name)

    def check_counts(self, points, cells):
        self.tab("Information")
        self.check(f"{INFORMATION}/pointCount", f"{points:,} (float)")
        self.check(f"{INFORMATION}/cellCount", f"{cells:,}")
        self.tab("Properties")

    def check_results(self, points, cells):
        """The information-only properties in the panel."""
        self.check(f"{PROPERTIES}/NumberOfNodes/LineEdit0", str(points))
        self.check(f"{PROPERTIES}/NumberOfTriangles/LineEdit0", str(cells))

    def slide(self, percent):
        self.event(f"{PROPERTIES}/Level/DoubleRangeWidget/Slider", "set_int", percent)

    def screenshot(self, path):
        self.menu("menu_File", "actionFileSaveScreenshot")
        self.event(f"{WINDOW}/SaveScreenshotFileDialog", "filesSelected", path)
        self.event(f"{WINDOW}/SaveScreenshotDialog/widget/OKButton", "activate")

    def save_state(self, path):
        self.menu("menu_File", "actionFileSaveServerState")
        self.event(f"{WINDOW}/FileSaveServerStateDialog", "filesSelected", path)

    def write(self, path):
        body = "\n".join(self.lines)
        path.write_text(f'<?xml version="1.0" ?>\n<pqevents>\n{body}\n</pqevents>\n')


def write_script(mesh, expected, output):
    script = Script()
    script.menu("menu_File", "actionFileOpen")
    script.event(f"{WINDOW}/FileOpenDialog", "filesSelected", mesh)
    script.apply()
    script.check_counts(*expected["input"])

    script.filter("HashQueueDecimation")
    # The fourth array in the list, by alphabet, is von_mises.
    script.event(f"{PROPERTIES}/Scalars/ArraySelectionWidget", "setCheckState", "3.0,2")
    script.apply()
    script.check_counts(*expected["coarse"])
    script.check_results(*expected["coarse"])

    script.filter("Undecimation")
    script.apply()
    script.color("von_mises")
    script.check_counts(*expected["coarse"])
    script.screenshot(output / "level_0.png")
    for percent in 50, 100:
        script.slide(percent)
        script.apply()
        script.check_counts(*expected[f"{percent / 100:g}"])
        script.check_results(*expected[f"{percent / 100:g}"])
    script.screenshot(output / "level_1.png")
    script.slide(0)
    script.apply()
    script.check_counts(*expected["0"])
    script.screenshot(output / "level_0_again.png")
    script.save_state(output / "state.pvsm")
    script.write(output / "main_job.xml")


def shown(state):
    """Names of the pipeline items, with their ports, whose representations are visible."""
    root = ElementTree.parse(state).getroot()
    names = {
        item.get("id"): item.get("name")
        for collection in root.iter("ProxyCollection")
        if collection.get("name") == "sources"
        for item in collection.iter("Item")
    }
    visible = set()
    for proxy in root.iter("Proxy"):
        if proxy.get("group") != "representations":
            continue
        properties = {p.get("name"): p for p in proxy.iter("Property")}
        if not {"Input", "Visibility"} <= properties.keys():
            continue  # such as the scalar bar
        if properties["Visibility"].find("Element").get("value") != "1":
            continue
        source = properties["Input"].find("Proxy")
        if source is not None and source.get("value") in names:
            visible.add((names[source.get("value")], int(source.get("output_port"))))
    return visible


def pixels(path):
    """The middle of the picture, without axes and scalar bar."""
    image = np.asarray(Image.open(path).convert("RGB")).astype(int)
    width = image.shape[1]
    return image[:, width // 6 : width * 4 // 5]


def describe(image):
    """Shares of pixels: not background; blue (low stress, edges); reddish (the peak at the hole)."""
    red, green, blue = np.moveaxis(image, 2, 0)
    mesh = np.abs(image - image[2, 2]).max(axis=2) > 25
    return mesh.mean(), (mesh & (blue > red + 60)).mean(), (mesh & (red > green + 20)).mean()


def check_pictures(output):
    coarse, fine, again = (
        pixels(output / f"{name}.png") for name in ("level_0", "level_1", "level_0_again")
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
    changed = (np.abs(coarse - fine).max(axis=2) > 25).mean()
    returned = (np.abs(coarse - again).max(axis=2) > 25).mean()
    print(f"changed from level 0 to 1: {changed:.1%} of the pixels, and back at 0: {returned:.2%}")
    if changed < 0.02:
        faults.append(f"levels 0 and 1 differ in only {changed:.2%} of the pixels")
    if returned > 0.001:
        faults.append(f"back at level 0 {returned:.2%} of the pixels differ")
    return faults


def main():
    parser = argparse.ArgumentParser()
    for option in "paraview", "pvpython", "xvfb-run", "plugin", "mesh", "output":
        parser.add_argument(f"--{option}", required=True)
    options = parser.parse_args()
    output = pathlib.Path(options.output)
    output.mkdir(parents=True, exist_ok=True)
    for old in output.glob("*.*"):
        old.unlink()

    counting = [options.pvpython, str(pathlib.Path(__file__).with_name("count_levels.py"))]
    counting += [options.plugin, options.mesh, "0", "0.5", "1"]
    expected = json.loads(
        subprocess.run(counting, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1]
    )
    print("expected points and cells:", expected)
    if expected["1"] != expected["input"] or expected["0"] != expected["coarse"]:
        sys.exit("levels 0 and 1 are not the coarse mesh and the input")
    if not expected["0"][0] < expected["0.5"][0] < expected["1"][0]:
        sys.exit("the numbers of points do not grow with the level")

    write_script(options.mesh, expected, output)
    # --dr and a home of its own: nobody's settings have a say. Xvfb is the display.
    home = output / "home"
    home.mkdir(mode=0o700, exist_ok=True)
    plugin = pathlib.Path(options.plugin)
    paraview = [options.xvfb_run, "-a", "-s", "-screen 0 1600x1000x24"]
    paraview += [options.paraview, "--dr", "--plugin-search-paths", str(plugin.parent)]
    paraview += ["--plugins", plugin.stem, f"--test-directory={output}"]
    paraview += [f"--test-script={output / 'main_job.xml'}", "--exit"]
    environment = dict(os.environ, HOME=str(home), XDG_CONFIG_HOME=str(home), LC_ALL="C.UTF-8")
    environment["XDG_RUNTIME_DIR"] = str(home)
    # When an event of an open dialog fails, ParaView waits for ever: hence the time limit.
    played = subprocess.run(
        paraview, env=environment, timeout=240, capture_output=True, text=True, errors="replace"
    )
    messages = played.stdout + played.stderr
    faults = []
    if played.returncode != 0:
        faults.append(f"ParaView's playback returned {played.returncode}")
    if "ERR|" in messages:
        faults.append("ParaView reported an error")
    if faults:
        print(messages[-4000:])
    else:
        faults += check_pictures(output)
        visible = shown(output / "state.pvsm")
        print("shown in the end:", sorted(visible))
        if visible != {("Undecimation1", 0)}:
            faults.append("something else than the output of Undecimation is shown in the end")
    print("\n".join(faults) if faults else "the main job was done")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
