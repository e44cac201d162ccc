# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of somebody else: VTK and the filters' module, no ParaView.

    python3 undecimate_file.py coarse.vtp original.vtp

Loads a decimated mesh, brings all nodes back and compares with the original. Exit code 0 if they are
equal, 1 and the differences if not.
"""

import sys

from undecimate.vtkUndecimateFilters import vtkUndecimation
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from meshes import differences, messages


def load(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def main(coarse, original):
    undecimation = vtkUndecimation()
    undecimation.SetInputData(load(coarse))
    undecimation.SetLevel(1.0)
    with messages(undecimation) as said:
        undecimation.Update()
    if "paraview" in sys.modules:
        said.append("ParaView was loaded")
    problems = said or differences(undecimation.GetOutput(), load(original))
    print("\n".join(map(str, problems)))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
