# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and cells of a mesh's levels, without a GUI, as JSON: what the GUI has to show.

pvpython count_levels.py PLUGIN MESH FILTER ARRAY LEVEL...     (ARRAY none: no Scalars)

Of a series at its first time; also the times, and the cells that are quads at each level.
"""

import json
import sys

from paraview import simple

plugin, file, decimator, array = sys.argv[1:5]
simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
mesh = simple.OpenDataFile(file)
decimation = getattr(simple, decimator)(Input=mesh, Scalars=[] if array == "none" else [array])
undecimation = simple.Undecimation(Input=decimation)
times = list(getattr(mesh, "TimestepValues", None) or [])


def counts(proxy):
    proxy.UpdatePipeline(*times[:1])
    information = proxy.GetDataInformation()
    return [information.GetNumberOfPoints(), information.GetNumberOfCells()]


found = {"input": counts(mesh), "coarse": counts(decimation), "times": times}
for level in sys.argv[5:]:
    undecimation.Level = float(level)
    found[level] = counts(undecimation)
    undecimation.UpdatePropertyInformation()
    found["quads at " + level] = int(undecimation.NumberOfQuads)
print(json.dumps(found))
