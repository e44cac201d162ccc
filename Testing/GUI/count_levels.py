# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and cells of the plate's levels, without a GUI, as JSON: what the GUI has to show.

pvpython count_levels.py PLUGIN MESH LEVEL...
"""

import json
import sys

from paraview import simple

simple.LoadPlugin(sys.argv[1], remote=False, ns=vars(simple))
mesh = simple.XMLPolyDataReader(FileName=[sys.argv[2]])
decimation = simple.HashQueueDecimation(Input=mesh, Scalars=["von_mises"])
undecimation = simple.Undecimation(Input=decimation)


def counts(proxy):
    proxy.UpdatePipeline()
    information = proxy.GetDataInformation()
    return [information.GetNumberOfPoints(), information.GetNumberOfCells()]


found = {"input": counts(mesh), "coarse": counts(decimation)}
for level in sys.argv[3:]:
    undecimation.Level = float(level)
    found[level] = counts(undecimation)
print(json.dumps(found))
