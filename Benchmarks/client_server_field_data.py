# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a large field-data array costs when a small mesh is shown in client/server mode.

Run:  xvfb-run -a -s "-screen 0 800x600x24" pvpython Benchmarks/client_server_field_data.py [megabytes]

Starts a pvserver of its own, shows a sphere of about 2,000 points with and without a field-data
array of random numbers (50 MB by default), and prints a Markdown table with the bytes that crossed
the loopback interface, the seconds, and whether ParaView drew on the server. Other traffic on the
loopback interface is counted as well, so keep the machine quiet.
"""

import socket
import subprocess
import sys
import time

from paraview import servermanager, simple

SOURCE = """
import numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.util.numpy_support import numpy_to_vtk

sphere = vtkSphereSource()
sphere.SetThetaResolution(50)
sphere.SetPhiResolution(42)
sphere.Update()
output = self.GetPolyDataOutput(){port}
output.ShallowCopy(sphere.GetOutput())
count = int({megabytes} * 1e6 / 8)
if count:
    record = numpy_to_vtk(numpy.random.default_rng(1).random(count), deep=1)
    record.SetName("record")
    output.GetFieldData().AddArray(record)
"""


def loopback_bytes():
    """Bytes received so far on the loopback interface (each byte sent is received once)."""
    with open("/proc/net/dev", encoding="ascii") as table:
        for line in table:
            name, _, counts = line.partition(":")
            if name.strip() == "lo":
                return int(counts.split()[0])
    raise RuntimeError("no loopback interface in /proc/net/dev")


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def measure(label, megabytes, threshold):
    """Show the mesh, render twice, change the colour once; print one row of the table."""
    source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData")
    source.Script = SOURCE.format(megabytes=megabytes, port="")
    source.UpdatePipeline()
    view = simple.CreateRenderView(ViewSize=[400, 300])
    if threshold is not None:
        view.RemoteRenderThreshold = threshold
    simple.Render(view)
    before, start = loopback_bytes(), time.perf_counter()
    simple.Show(source, view)
    simple.ResetCamera(view)
    simple.Render(view)
    first, first_seconds = loopback_bytes() - before, time.perf_counter() - start
    before, start = loopback_bytes(), time.perf_counter()
    simple.GetActiveCamera().Azimuth(5)
    simple.Render(view)
    again, again_seconds = loopback_bytes() - before, time.perf_counter() - start
    before, start = loopback_bytes(), time.perf_counter()
    # a new output of the source, as a move of a Level slider gives
    source.Script = SOURCE.format(megabytes=megabytes, port="  # again")
    simple.Render(view)
    update, update_seconds = loopback_bytes() - before, time.perf_counter() - start
    # StillRender's choice, asked of the client's own view object
    remote = view.GetClientSideObject().GetUseDistributedRenderingForRender()
    print(
        f"| {label} | {megabytes:g} | {view.RemoteRenderThreshold:g} | {first / 1e6:.3f} | "
        f"{first_seconds:.2f} | {again / 1e6:.3f} | {again_seconds:.2f} | {update / 1e6:.3f} | "
        f"{update_seconds:.2f} | {'server' if remote else 'client'} |",
        flush=True,
    )
    simple.Delete(view)
    simple.Delete(source)


def main():
    megabytes = float(sys.argv[1]) if len(sys.argv) > 1 else 50.0
    port = free_port()
    server = subprocess.Popen(
        ["pvserver", f"--server-port={port}"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        for line in server.stdout:
            if line.startswith("Accepting"):
                break
        else:
            raise RuntimeError("pvserver did not start")
        simple.Connect("localhost", port)
        print(servermanager.vtkSMProxyManager.GetParaViewSourceVersion())
        print(
            "| case | field data MB | threshold MB | show MB | s | turn MB | s "
            "| new output MB | s | drawn on |"
        )
        print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
        measure("geometry to the client, no field data", 0, 1e6)
        measure("geometry to the client", megabytes, 1e6)
        measure("default threshold, no field data", 0, None)
        measure("default threshold", megabytes, None)
        measure("default threshold, field data below it", 10, None)
    finally:
        simple.Disconnect()  # ends the server, too
        try:
            server.wait(timeout=10)
        except subprocess.TimeoutExpired:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
