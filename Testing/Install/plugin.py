# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The installed plugin, loaded by ParaView from its new place: level 1 has all nodes again.

pvpython plugin.py PLUGIN MESH.vtp
"""

import sys

from paraview import simple

simple.LoadPlugin(sys.argv[1], remote=False, ns=vars(simple))
mesh = simple.XMLPolyDataReader(FileName=[sys.argv[2]])
decimation = simple.HashQueueDecimation(Input=mesh)
undecimation = simple.Undecimation(Input=decimation, Level=1.0)
undecimation.UpdatePipeline()

expected = mesh.GetDataInformation().GetNumberOfPoints()
if not 0 < decimation.NumberOfNodes < expected == undecimation.NumberOfNodes:
    sys.exit(f"{decimation.NumberOfNodes} nodes, {undecimation.NumberOfNodes} at level 1")
print(f"{decimation.NumberOfNodes} nodes, {undecimation.NumberOfNodes} at level 1")
