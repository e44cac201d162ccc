# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The installed filter as a peer of another bench of decimators: one whose peers.py has classes with prepare(V, F, S),
run(mesh, triangles) and arrays(result) in a table PEERS, and whose bench.py runs them.

    peer.py BENCH_FOLDER [--build FOLDER] [--python PYTHON] ARGUMENTS OF bench.py

adds undecimate (Deviation), undecimate-array (Deviation, steered by the nodal scalar), undecimate-scalar (Scalar
Difference) and undecimate-quadric (Quadric) to its peers, in a copy, and runs it. PYTHON is that of the VTK that the
build was made against; ours runs in a process of its own, as the bench does with all.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

import meshes
from filters import environment

PEERS = '''


class Undecimate(Vtk):
    python = {python!r}
    criterion, steered = "Deviation", False

    def filter(self, target, n):
        from undecimate.vtkUndecimateFilters import vtkHashQueueDecimation
        f = vtkHashQueueDecimation()
        getattr(f, "SetCriterionTo" + self.criterion)()
        f.SetTargetReduction(1 - target / n)
        if self.steered:
            f.AddScalars("s")
        return f


class UndecimateArray(Undecimate):
    steered = True


class UndecimateScalar(UndecimateArray):
    criterion = "ScalarDifference"


class UndecimateQuadric(Undecimate):
    criterion = "Quadric"


PEERS.update({{"undecimate": Undecimate, "undecimate-array": UndecimateArray,
              "undecimate-scalar": UndecimateScalar, "undecimate-quadric": UndecimateQuadric}})
'''


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("bench", help="folder of the other bench")
    a.add_argument("--build", default=os.path.join(meshes.ROOT, "build"), help="build folder of the project")
    a.add_argument("--python", default="/usr/bin/python3", help="the Python of the VTK that ours was built against")
    args, rest = a.parse_known_args()
    if not os.path.isfile(os.path.join(args.bench, "peers.py")):
        raise SystemExit(f"{args.bench}: no peers.py there; name the folder of a bench that has one")
    with tempfile.TemporaryDirectory() as folder:
        copy, python = os.path.join(folder, "bench"), os.path.join(folder, "python")
        shutil.copytree(args.bench, copy, copy_function=shutil.copyfile)
        with open(python, "w") as f:
            f.write(f'#!/bin/sh\nPYTHONPATH="$PYTHONPATH:{environment(args.build)["PYTHONPATH"]}" exec {args.python} "$@"\n')
        os.chmod(python, 0o755)
        peers = os.path.join(copy, "peers.py")
        os.chmod(peers, 0o644)
        with open(peers, "a") as f:
            f.write(PEERS.format(python=python))
        sys.exit(subprocess.run([sys.executable, os.path.join(copy, "bench.py"), *rest], check=False).returncode)


if __name__ == "__main__":
    main()
