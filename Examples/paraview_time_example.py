# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two sliders, time and level: pvpython paraview_time_example.py Undecimate.so series.pvd array"""

import sys

from paraview.simple import *

plugin, series, array = sys.argv[1:]
LoadPlugin(plugin, remote=False, ns=globals())

crash = OpenDataFile(series)
decimation = TriQuadDecimation(Input=crash, TargetReduction=0.96, Scalars=[array])
undecimation = Undecimation(Input=decimation)
for time in crash.TimestepValues:  # the decimation runs at the first one only
    for level in (0.0, 0.5, 1.0):
        undecimation.Level = level
        undecimation.UpdatePipeline(time)
        undecimation.UpdatePropertyInformation()
        print(f"time {time:.4f}, level {level}: {undecimation.NumberOfNodes} nodes, "
              f"{undecimation.NumberOfQuads} quads, error {undecimation.Error:.5f} of the diagonal")
