# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the GUI tests share: events for ParaView's own test playback, running it, its screenshots."""

import argparse
import json
import os
import pathlib
import signal
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

SECONDS = 360  # of a playback: a busy machine needs minutes


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

    def open(self, file):
        self.menu("menu_File", "actionFileOpen")
        self.event(f"{WINDOW}/FileOpenDialog", "filesSelected", file)
        self.apply()

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

    def look_along_x(self):
        self.event(f"{WINDOW}/cameraToolbar/actionPositiveX", "activate")

    def go_to_frame(self, which):
        """First, Previous, Next or Last."""
        self.event(f"{WINDOW}/VCRToolbar/actionVCR{which}Frame", "activate")

    def check_results(self, **results):
        """The information-only properties in the panel."""
        for name, value in results.items():
            self.check(f"{PROPERTIES}/{name}/LineEdit0", str(value))

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


def read_options():
    """The options of a job, with a new folder for its output."""
    parser = argparse.ArgumentParser()
    for option in "paraview", "pvpython", "xvfb-run", "plugin", "mesh", "output":
        parser.add_argument(f"--{option}", required=True)
    options = parser.parse_args()
    options.output = pathlib.Path(options.output)
    options.output.mkdir(parents=True, exist_ok=True)
    for old in options.output.glob("*.*"):
        old.unlink()
    return options


def count(options, *arguments):
    """What count_levels.py says of the mesh."""
    command = [options.pvpython, str(pathlib.Path(__file__).with_name("count_levels.py"))]
    command += [options.plugin, options.mesh, *arguments]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def play(options, job):
    """Play a script that was written into the output folder; what went wrong."""
    # --dr and a home of its own: nobody's settings have a say. Xvfb is the display.
    home = options.output / "home"
    home.mkdir(mode=0o700, exist_ok=True)
    plugin = pathlib.Path(options.plugin)
    paraview = [options.xvfb_run, "-a", "-s", "-screen 0 1600x1000x24"]
    paraview += [options.paraview, "--dr", "--plugin-search-paths", str(plugin.parent)]
    paraview += ["--plugins", plugin.stem, f"--test-directory={options.output}"]
    paraview += [f"--test-script={options.output / job}", "--exit"]
    environment = dict(os.environ, HOME=str(home), XDG_CONFIG_HOME=str(home), LC_ALL="C.UTF-8")
    environment["XDG_RUNTIME_DIR"] = str(home)
    # When an event of an open dialog fails, ParaView waits for ever: hence the time limit, after which
    # the display goes too.
    with subprocess.Popen(
        paraview, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        errors="replace", start_new_session=True,
    ) as played:
        try:
            messages, _ = played.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(played.pid, signal.SIGKILL)
            return [f"the playback was not done after {SECONDS} s"]
    faults = []
    if played.returncode != 0:
        faults.append(f"ParaView's playback returned {played.returncode}")
    if "ERR|" in messages:
        faults.append("ParaView reported an error")
    if faults:
        print(messages[-4000:])
    return faults


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


def changed(a, b):
    """Share of the pixels that differ."""
    return (np.abs(a - b).max(axis=2) > 25).mean()


def run_job(job, decimation, array, write_script, check):
    """A whole job; the exit code.

    write_script(mesh, expected, output) writes `job`.xml, check(output) says what is wrong with what
    it left behind.
    """
    options = read_options()
    expected = count(options, decimation, array, "0", "0.5", "1")
    print("expected points and cells:", expected)
    if expected["1"] != expected["input"] or expected["0"] != expected["coarse"]:
        sys.exit("levels 0 and 1 are not the coarse mesh and the input")
    if not expected["0"][0] < expected["0.5"][0] < expected["1"][0]:
        sys.exit("the numbers of points do not grow with the level")
    write_script(options.mesh, expected, options.output)
    faults = play(options, f"{job}.xml") or check(options.output)
    print("\n".join(faults) if faults else f"{job} was done")
    return 1 if faults else 0
