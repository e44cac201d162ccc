# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""A crash at three levels and three times, and a film that moves both sliders.

    xvfb-run -a pvpython Scripts/crash.py PLUGIN OUTPUT_FOLDER [SERIES.pvd ARRAY]

Without a series the short one of Data/ is taken. Writes crash.png, as figure 9 of Wundrak et al. 2006,
and crash.ogv.
"""

import math
import os
import sys
import time

import numpy as np
from paraview import simple as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOOggTheora import vtkOggTheoraWriter

import pictures
from demo import differences, stop

HERE = os.path.dirname(os.path.abspath(__file__))
SERIES = os.path.join(HERE, "..", "Data", "crash_box", "crash_box.pvd"), "plastic_strain"
PERCENT = 4, 18, 100
FRAMES, RATE = 60, 10  # of the film; frames a second

LOOK_FROM, UP = (0.80, -1.0, 0.45), (0, 0, 1)


class Sliders:
    """A series behind Tri Quad Decimation and Undecimation."""

    def __init__(self, file, array):
        self.reader = pv.OpenDataFile(file)
        self.times = list(self.reader.TimestepValues)
        self.decimation = pv.TriQuadDecimation(
            Input=self.reader, TargetReduction=1 - min(PERCENT) / 100, Scalars=[array])
        self.undecimation = pv.Undecimation(Input=self.decimation)
        self.coarsest, self.count = (
            self.fetch(proxy, self.times[0]).GetNumberOfPoints()
            for proxy in (self.decimation, self.reader))

    def fetch(self, proxy, at):
        """The output of a proxy at a time, independent of what comes later."""
        proxy.UpdatePipeline(at)
        output = proxy.GetClientSideObject().GetOutputDataObject(0)
        mesh = output.NewInstance()
        mesh.ShallowCopy(output)
        return mesh

    def at(self, at, percent):
        """The mesh at a time with a share of its nodes."""
        level = (self.count * percent / 100 - self.coarsest) / (self.count - self.coarsest)
        self.undecimation.Level = min(max(level, 0.0), 1.0)
        return self.fetch(self.undecimation, at)

    def counts(self):
        self.undecimation.UpdatePropertyInformation()
        return (f"{self.undecimation.NumberOfNodes:,} nodes, {self.undecimation.NumberOfQuads:,} quads, "
                f"{self.undecimation.NumberOfTriangles:,} triangles")


class View:
    """One direction, scale and colour map for all pictures."""

    def __init__(self, sliders, array):
        self.array = array
        self.forward = -np.array(LOOK_FROM) / np.linalg.norm(LOOK_FROM)
        self.right = np.cross(self.forward, UP)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.right, self.forward)
        highest = max(sliders.at(t, 100).GetPointData().GetArray(array).GetRange()[1]
                      for t in sliders.times)
        self.colours = pictures.colour_map(0.0, highest, pictures.HEAT)

    def frame(self, meshes):
        """Centre, width and height of what meshes take in the picture, in their own unit."""
        points = np.concatenate([vtk_to_numpy(m.GetPoints().GetData()).astype(float) for m in meshes])
        low, high = (np.array([limit(points @ axis) for axis in (self.right, self.up, self.forward)])
                     for limit in (np.min, np.max))
        middle = (low + high) / 2
        centre = middle[0] * self.right + middle[1] * self.up + middle[2] * self.forward
        return centre, high[0] - low[0], high[1] - low[1]

    def draw(self, sheet, mesh, centre, height, place):
        sheet.solid(mesh, LOOK_FROM, UP, height, centre, place, self.array, self.colours)


def draw_grid(path, sliders, view):
    """Levels side by side, times below one another, all at one scale."""
    times = [sliders.times[i * (len(sliders.times) - 1) // 2] for i in range(3)]
    frames = [view.frame([sliders.at(at, 100)]) for at in times]
    scale = 430 / frames[0][2]
    gap, left = 24, 110
    wide = round(scale * max(width for _, width, _ in frames)) + gap
    heights = [round(scale * height) + gap for _, _, height in frames]
    top = 10 + sum(heights)
    sheet = pictures.Sheet(left + len(PERCENT) * (wide + gap) + 110, top + 70)
    y = top
    for at, (centre, _, _), high in zip(times, frames, heights):
        y -= high
        sheet.words(f"{1000 * at:.3g} ms", 20, y + high / 2, 18, bold=True)
        for column, percent in enumerate(PERCENT):
            x = left + column * (wide + gap)
            start = time.process_time()
            mesh = sliders.at(at, percent)
            seconds = time.process_time() - start
            view.draw(sheet, mesh, centre, high / scale, (x, y, wide, high))
            print(f"{1000 * at:6.3g} ms  {percent:4} %  {sliders.counts():45}  {1000 * seconds:6.1f} ms")
            if at == times[0]:
                nodes, rest = sliders.counts().split(", ", 1)
                sheet.words(f"{percent} %: {nodes}", x, top + 32, 18, bold=True)
                sheet.words(rest, x, top + 10, 14, grey=True)
    sheet.scalar_bar(view.colours, view.array.replace("_", " "),
                     (left + len(PERCENT) * (wide + gap), 30, 100, 300), 14, digits=2)
    sheet.write(path)


def draw_film(path, sliders, view):
    """Time goes forth and back, the share of the nodes falls and rises, each at its own pace."""
    centre, width, height = view.frame([sliders.at(at, 100) for at in sliders.times])
    scale = 420 / height
    wide, high = 2 * round(scale * width / 2) + 280, 440
    writer = vtkOggTheoraWriter()
    writer.SetFileName(path)
    writer.SetRate(RATE)
    last = len(sliders.times) - 1
    for frame in range(FRAMES):
        turn = frame / (FRAMES - 1)
        step = round(last * (1 - abs(1 - 2 * turn)))
        share = 0.5 + 0.5 * math.cos(6 * math.pi * turn)  # 1: all nodes
        percent = min(PERCENT) * (100 / min(PERCENT)) ** share
        sheet = pictures.Sheet(wide, high + 120)
        view.draw(sheet, sliders.at(sliders.times[step], percent), centre, high / scale,
                  (0, 120, wide, high))
        half = wide // 2
        sheet.slider(f"{1000 * sliders.times[step]:.1f} ms", step / last, 24, 60, half - 48)
        sheet.slider(f"{percent:.0f} % of the nodes", share, half + 24, 60, half - 48)
        sheet.words(sliders.counts(), 24, 20, 14, grey=True)
        writer.SetInputData(sheet.image())
        if frame == 0:
            writer.Start()
        writer.Write()
    writer.End()
    if writer.GetError():
        raise OSError("cannot write " + path)


def main(plugin, folder, file=SERIES[0], array=SERIES[1]):
    pv.LoadPlugin(plugin, remote=False, ns=pv.__dict__)
    start = time.process_time()
    sliders = Sliders(file, array)
    print(f"{os.path.basename(file)}: {sliders.count:,} nodes, {len(sliders.times)} time steps; read and "
          f"decimated in {time.process_time() - start:.1f} s of CPU time\n")
    print("  time    level                                                  CPU time")
    view = View(sliders, array)
    draw_grid(os.path.join(folder, "crash.png"), sliders, view)
    draw_film(os.path.join(folder, "crash.ogv"), sliders, view)
    for at in sliders.times:
        different = differences(sliders.at(at, 100), sliders.fetch(sliders.reader, at))
        if different:
            stop(f"at time {at} level 1 differs from the input in " + ", ".join(different))
    print("\nAt level 1 each time step is equal to the input bit for bit.")


if __name__ == "__main__":
    main(*sys.argv[1:])
