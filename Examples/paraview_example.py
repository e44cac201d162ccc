# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The two filters in ParaView: pvpython paraview_example.py Undecimate.so in.vtp array out.vtp"""

import sys

from paraview.simple import *

plugin, source, array, target = sys.argv[1:]
LoadPlugin(plugin, remote=False, ns=globals())

decimation = HashQueueDecimation(
    Input=XMLPolyDataReader(FileName=[source]), TargetReduction=0.95, Scalars=[array])
# The coarse mesh with its record: all levels in one file
SaveData(target, proxy=decimation, DataMode="Binary", CompressorType="ZLib")

undecimation = Undecimation(Input=XMLPolyDataReader(FileName=[target]))
for level in (0.0, 0.5, 1.0):
    undecimation.Level = level
    undecimation.UpdatePipeline()
    undecimation.UpdatePropertyInformation()
    print(f"level {level}: {undecimation.NumberOfNodes} nodes, "
          f"error {undecimation.Error:.5f} of the diagonal")
