# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""The field: every free decimator that we know of, behind one interface.

    field_rivals.py MESH RIVAL OUT.npz TRIANGLES REPETITIONS

runs one rival on one mesh file (decimate_cli.cpp's format), in a process of its own, and prints JSON:
CPU seconds of the rival's own call, and from vtkPolyData to vtkPolyData with the conversions (medians),
the growth of the peak resident set in the first run, version, triangles. OUT.npz gets the result: points,
triangles and, where the mesh has nodal values and the rival carries them itself, values. Settings are the
rivals' defaults unless a class says otherwise.
"""
import ctypes
import json
import os
import resource
import signal
import subprocess
import sys
import time

import numpy as np

import meshes

SLOW = 2.0  # seconds; a longer run is not repeated
LIBRARIES = os.path.join(meshes.CACHE, "rivals-build")
RIVALS_PYTHON = os.path.join(meshes.CACHE, "rivals-venv", "bin", "python")
BLENDER_PYTHON = os.path.join(meshes.CACHE, "blender-venv", "bin", "python")


class Rival:
    """create() builds the rival's own structure, run() decimates it and alone is timed, arrays() is its
    result as points, triangles and values (None: it drops them)."""
    python = RIVALS_PYTHON
    package = None  # of which the version is reported
    keeps_nodes = False  # every node of the result is a node of the input, in its place
    fast = True
    steered = False  # by the nodal values
    knows_vtk = True  # vtk is installed beside it

    def missing(self):
        """What has to be there to run it and is not; None if it can run."""
        return None if os.path.exists(self.python) else self.python

    def version(self):
        from importlib.metadata import version
        return version(self.package)

    def convert(self, data, values):
        """create() from vtkPolyData, or from the arrays where there is no VTK."""
        if not self.knows_vtk:
            return self.create(*data, values)
        from vtkmodules.util.numpy_support import vtk_to_numpy
        triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        return self.create(vtk_to_numpy(data.GetPoints().GetData()), triangles.astype(np.int32), values)

    tunes = False

    def tune(self, mesh, triangles):
        """If it tunes: finds the settings for the wanted count before the timed run."""


class Vtk(Rival):
    package = "vtk"
    old = False

    def __init__(self):
        if self.old:  # of ParaView 5.11's series: the release VTK that the other benchmarks use
            self.python = sys.executable

    def version(self):
        from vtkmodules.vtkCommonCore import vtkVersion
        return vtkVersion.GetVTKVersion()

    def create(self, points, triangles, values):
        from rivals import poly_data
        return poly_data(points, triangles, values)

    def convert(self, data, values):
        return data

    def filter(self, triangles, total):
        import vtkmodules.vtkFiltersCore as core
        f = getattr(core, self.name)()
        f.SetTargetReduction(1 - triangles / total)
        return f

    def run(self, data, triangles):
        f = self.filter(triangles, data.GetNumberOfPolys())
        f.SetInputData(data)
        f.Update()
        return f.GetOutput()

    def arrays(self, out):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        points = vtk_to_numpy(out.GetPoints().GetData())
        cells = out.GetPolys()
        if cells.GetNumberOfCells() and cells.GetMaxCellSize() != 3:
            raise RuntimeError("cells that are not triangles")
        triangles = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)
        array = out.GetPointData().GetArray("scalar")
        carried = array is not None and array.GetNumberOfTuples() == len(points)
        return points, triangles, vtk_to_numpy(array) if carried else None


class VtkDecimatePro(Vtk):
    name = "vtkDecimatePro"
    keeps_nodes = True
    fast = False
    preserve_topology = False

    def filter(self, triangles, total):
        f = super().filter(triangles, total)
        f.SetPreserveTopology(self.preserve_topology)
        return f


class VtkDecimateProTopology(VtkDecimatePro):
    preserve_topology = True


class VtkQuadric(Vtk):
    name = "vtkQuadricDecimation"
    fast = False


class VtkQuadricOld(VtkQuadric):
    old = True


class VtkQuadricAttributes(VtkQuadric):
    """ScalarsWeight is the filter's default, 0.1."""
    steered = True

    def filter(self, triangles, total):
        f = super().filter(triangles, total)
        f.AttributeErrorMetricOn()
        f.SetMapPointData(True)
        return f


class VtkClustering(Vtk):
    """No target in the filter: the number of divisions that comes nearest from below is found beforehand."""
    name = "vtkQuadricClustering"
    tunes = True
    most = 4096

    def make(self, data, divisions):
        import vtkmodules.vtkFiltersCore as core
        f = getattr(core, self.name)()
        b = data.GetBounds()
        edges = np.array([b[1] - b[0], b[3] - b[2], b[5] - b[4]])
        f.SetAutoAdjustNumberOfDivisions(False)
        f.SetNumberOfDivisions(*(max(1, round(divisions * e / edges.max())) for e in edges))
        f.SetInputData(data)
        return f

    def tune(self, data, triangles):
        def count(divisions):
            f = self.make(data, divisions)
            f.Update()
            return f.GetOutput().GetNumberOfPolys()

        low = 2
        while low < self.most and count(2 * low) <= triangles:
            low *= 2
        high = 2 * low
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if count(middle) <= triangles else (low, middle)
        self.divisions = low

    def run(self, data, triangles):
        f = self.make(data, self.divisions)
        f.Update()
        return f.GetOutput()


class VtkBinned(VtkClustering):
    name = "vtkBinnedDecimation"
    keeps_nodes = True


class FastSimplification(Rival):
    package = "fast-simplification"

    def create(self, points, triangles, values):
        return points, triangles

    def run(self, mesh, triangles):
        import fast_simplification
        return fast_simplification.simplify(*mesh, target_count=triangles)

    def arrays(self, out):
        return out[0], out[1], None


class Pyfqmr(Rival):
    package = "pyfqmr"

    def create(self, points, triangles, values):
        import pyfqmr
        mesh = pyfqmr.Simplify()
        mesh.setMesh(points.astype(float), triangles)
        return mesh

    def run(self, mesh, triangles):
        mesh.simplify_mesh(target_count=triangles, verbose=False)
        return mesh

    def arrays(self, mesh):
        return (*mesh.getMesh()[:2], None)


class PyMeshLab(Rival):
    package = "pymeshlab"
    fast = False
    options = {}

    def create(self, points, triangles, values):
        import pymeshlab
        mesh = pymeshlab.MeshSet(verbose=False)
        more = {} if values is None else {"v_scalar_array": values.astype(float)}
        mesh.add_mesh(pymeshlab.Mesh(points.astype(float), triangles, **more))
        self.has_values = values is not None
        return mesh

    def run(self, mesh, triangles):
        mesh.meshing_decimation_quadric_edge_collapse(targetfacenum=triangles, **self.options)
        return mesh

    def arrays(self, mesh):
        m = mesh.current_mesh()
        return m.vertex_matrix(), m.face_matrix(), m.vertex_scalar_array() if self.has_values else None


class PyMeshLabPreserve(PyMeshLab):
    options = {"preserveboundary": True, "preservenormal": True, "preservetopology": True}


class Open3D(Rival):
    package = "open3d-cpu"
    fast = False

    def create(self, points, triangles, values):
        import open3d
        return open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(points.astype(float)), open3d.utility.Vector3iVector(triangles)
        )

    def run(self, mesh, triangles):
        return mesh.simplify_quadric_decimation(triangles)

    def arrays(self, mesh):
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles), None


class LibiglQslim(Rival):
    package = "libigl"
    fast = False
    function = "qslim"

    def create(self, points, triangles, values):
        return np.asfortranarray(points, float), np.asfortranarray(triangles)

    def run(self, mesh, triangles):
        import igl
        return getattr(igl, self.function)(*mesh, max_m=triangles)

    def arrays(self, out):
        return np.asarray(out[0]), np.asarray(out[1]), None


class LibiglDecimate(LibiglQslim):
    function = "decimate"


class MeshLib(Rival):
    package = "meshlib"

    def create(self, points, triangles, values):
        import meshlib.mrmeshnumpy
        return meshlib.mrmeshnumpy.meshFromFacesVerts(triangles, points)

    def run(self, mesh, triangles):
        import meshlib.mrmeshpy as mr
        settings = mr.DecimateSettings()
        settings.strategy = mr.DecimateStrategy.MinimizeError
        settings.maxDeletedFaces = mesh.topology.numValidFaces() - triangles
        settings.maxError = 1e30  # only the count stops it
        settings.packMesh = True
        mr.decimateMesh(mesh, settings)
        return mesh

    def arrays(self, mesh):
        import meshlib.mrmeshnumpy as mn
        return mn.getNumpyVerts(mesh), mn.getNumpyFaces(mesh.topology), None


class Blender(Rival):
    """The modifier Decimate (collapse)."""
    python = BLENDER_PYTHON
    package = "bpy"
    fast = False
    knows_vtk = False

    def create(self, points, triangles, values):
        import bpy
        mesh = bpy.data.meshes.new("mesh")
        mesh.vertices.add(len(points))
        mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
        mesh.loops.add(3 * len(triangles))
        mesh.loops.foreach_set("vertex_index", triangles.ravel())
        mesh.polygons.add(len(triangles))
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
        mesh.update(calc_edges=True)
        if values is not None:
            mesh.attributes.new("values", "FLOAT", "POINT").data.foreach_set(
                "value", values.astype(np.float32)
            )
        self.total = len(triangles)
        thing = bpy.data.objects.new("object", mesh)
        bpy.context.collection.objects.link(thing)
        return thing

    def run(self, thing, triangles):
        import bpy
        thing.modifiers.new("decimate", "DECIMATE").ratio = triangles / self.total
        # The result lives as long as the object.
        return thing, thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()

    def arrays(self, out):
        mesh = out[1]
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        mesh.calc_loop_triangles()
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        values = None
        if "values" in mesh.attributes:
            values = np.empty(len(mesh.vertices), np.float32)
            mesh.attributes["values"].data.foreach_get("value", values)
        return points.reshape(-1, 3), triangles.reshape(-1, 3), values


class Compiled(Rival):
    """A library with the interface of field_drivers/rival.h."""

    def __init__(self, library, keeps_nodes=False, fast=True, steered=False):
        self.library, self.keeps_nodes, self.fast, self.steered = library, keeps_nodes, fast, steered

    def file(self):
        return os.path.join(LIBRARIES, f"lib{self.library}.so")

    def missing(self):
        return super().missing() or (None if os.path.exists(self.file()) else self.file())

    def load(self):
        if not hasattr(self, "functions"):
            self.functions = f = ctypes.CDLL(self.file())
            pointer, count = ctypes.c_void_p, ctypes.c_int64
            f.rivalCreate.restype, f.rivalCreate.argtypes = pointer, [pointer, count, pointer, count, pointer]
            f.rivalRun.argtypes = [pointer, count]
            f.rivalNodeCount.restype = f.rivalTriangleCount.restype = count
            for one in (f.rivalNodeCount, f.rivalTriangleCount, f.rivalHasValues, f.rivalDestroy):
                one.argtypes = [pointer]
            f.rivalGet.argtypes = [pointer] * 4
            f.rivalVersion.restype = ctypes.c_char_p
        return self.functions

    def version(self):
        version = self.load().rivalVersion().decode()
        if self.library.startswith("meshoptimizer"):  # major * 1000 + minor * 10 + patch
            version = f"{int(version) // 1000}.{int(version) % 1000 / 10:g}"
        return version

    def create(self, points, triangles, values):
        points, triangles = np.ascontiguousarray(points, float), np.ascontiguousarray(triangles, np.int32)
        values = None if values is None else np.ascontiguousarray(values, float)
        handle = self.load().rivalCreate(
            points.ctypes.data,
            len(points),
            triangles.ctypes.data,
            len(triangles),
            None if values is None else values.ctypes.data,
        )
        if not handle:
            raise RuntimeError("refused the mesh")
        return handle

    def run(self, handle, triangles):
        if self.functions.rivalRun(handle, triangles):
            raise RuntimeError("refused to decimate")
        return handle

    def arrays(self, handle):
        f = self.functions
        points = np.empty((f.rivalNodeCount(handle), 3))
        triangles = np.empty((f.rivalTriangleCount(handle), 3), np.int32)
        values = np.empty(len(points)) if f.rivalHasValues(handle) else None
        f.rivalGet(
            handle, points.ctypes.data, triangles.ctypes.data, None if values is None else values.ctypes.data
        )
        f.rivalDestroy(handle)
        return points, triangles, values


RIVALS = {
    "vtkDecimatePro": VtkDecimatePro,
    "vtkDecimatePro, topology": VtkDecimateProTopology,
    "vtkQuadricDecimation": VtkQuadric,
    "vtkQuadricDecimation 9.2": VtkQuadricOld,
    "vtkQuadricDecimation, attributes": VtkQuadricAttributes,
    "vtkQuadricClustering": VtkClustering,
    "vtkBinnedDecimation": VtkBinned,
    "meshoptimizer": lambda: Compiled("meshoptimizer", keeps_nodes=True),
    "meshoptimizer, update": lambda: Compiled("meshoptimizer_update"),
    "meshoptimizer, sloppy": lambda: Compiled("meshoptimizer_sloppy", keeps_nodes=True),
    "meshoptimizer, attributes": lambda: Compiled("meshoptimizer_attributes", keeps_nodes=True, steered=True),
    "meshoptimizer, update with attributes": lambda: Compiled(
        "meshoptimizer_update_attributes", steered=True
    ),
    "fast-simplification": FastSimplification,
    "pyfqmr": Pyfqmr,
    "CGAL Lindstrom-Turk": lambda: Compiled("cgal_lindstrom_turk", fast=False),
    "CGAL Garland-Heckbert": lambda: Compiled("cgal_garland_heckbert", fast=False),
    "OpenMesh": lambda: Compiled("openmesh", keeps_nodes=True, fast=False),
    "OpenMesh, normal flipping": lambda: Compiled("openmesh_flip", keeps_nodes=True, fast=False),
    "pymeshlab": PyMeshLab,
    "pymeshlab, preserve": PyMeshLabPreserve,
    "Open3D": Open3D,
    "MeshLib": MeshLib,
    "Blender": Blender,
    "libigl qslim": LibiglQslim,
    "libigl decimate": LibiglDecimate,
}


def available(names=None):
    """{name: rival} of those named, or of all, that can run here; says what is missing for the others."""
    chosen = {name: RIVALS[name]() for name in names or RIVALS}
    for name, rival in list(chosen.items()):
        if rival.missing():
            print(f"Without {name}: {rival.missing()} is absent ('run.sh field' builds and installs the rivals).",
                  file=sys.stderr)
            del chosen[name]
    return chosen


def run_rival(file, name, out, triangles, limit, repetitions):
    """Runs this file on a mesh file with at most `limit` CPU seconds: its JSON, or {"failed": reason}."""
    from deviation import child_environment
    command = [RIVALS[name]().python, os.path.abspath(__file__), file, name, out, str(triangles), str(repetitions)]
    limits = lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=child_environment(), preexec_fn=limits, timeout=6 * limit)
    except subprocess.TimeoutExpired:
        return {"failed": f"over {6 * limit} s"}
    if -done.returncode in (signal.SIGXCPU, signal.SIGKILL):
        return {"failed": f"over {limit} s of CPU time"}
    if done.returncode != 0:
        reason = (done.stderr.strip().splitlines() or [f"exit {done.returncode}"])[-1]
        return {"failed": reason.replace(meshes.CACHE, "...")[-120:]}
    return json.loads(done.stdout.strip().splitlines()[-1])


def warm_up(rival):
    """A first run on a small mesh, so that loading libraries and first calls are not timed."""
    points, triangles, values = meshes.grid(6)
    mesh = rival.create(points, triangles, values)
    if rival.tunes:
        rival.tune(mesh, 20)
    rival.arrays(rival.run(mesh, 20))


def resident():
    """Bytes of memory that the process holds now, and at most so far."""
    with open("/proc/self/statm") as f:
        now = int(f.read().split()[1]) * resource.getpagesize()
    return now, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main():
    file, name, out, wanted, repetitions = (
        sys.argv[1],
        sys.argv[2],
        sys.argv[3],
        int(sys.argv[4]),
        int(sys.argv[5]),
    )
    rival = RIVALS[name]()
    points, triangles = meshes.read(file)
    values = meshes.read_values(file)
    warm_up(rival)
    if rival.knows_vtk:
        from rivals import poly_data
    else:
        poly_data = lambda points, triangles, values: (points, triangles)
    if rival.tunes:
        rival.tune(rival.create(points, triangles, values), wanted)
    seconds, whole, peak = [], [], 0
    while len(seconds) < repetitions and (not seconds or seconds[-1] < SLOW):
        data = poly_data(points, triangles, values)
        before = resident()[0]
        start = time.process_time()
        mesh = rival.convert(data, values)
        run = time.process_time()
        result = rival.run(mesh, wanted)
        seconds.append(time.process_time() - run)
        arrays = [None if a is None else np.asarray(a) for a in rival.arrays(result)]
        if not isinstance(rival, Vtk):
            poly_data(*arrays)
        whole.append(time.process_time() - start)
        peak = peak or resident()[1] - before
    carried = {} if arrays[2] is None or values is None else {"values": arrays[2]}
    np.savez(out, points=arrays[0], triangles=arrays[1].astype(np.int32), **carried)
    print()  # some rivals leave a line open
    print(
        json.dumps(
            {
                "version": rival.version(),
                "triangles": len(arrays[1]),
                "cpu": float(np.median(seconds)),
                "cpu_whole": float(np.median(whole)),
                "peak": peak,
                "runs": len(seconds),
            }
        )
    )


if __name__ == "__main__":
    main()
