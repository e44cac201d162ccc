# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""One line on what the figures were measured with."""
import os
import platform
import subprocess
from importlib.metadata import version


def cpu():
    with open("/proc/cpuinfo") as f:
        return next((x.split(":")[1].strip() for x in f if x.startswith("model name")), platform.machine())


def first_line(*command):
    try:
        return subprocess.run(command, stdout=subprocess.PIPE, text=True).stdout.splitlines()[0]
    except (OSError, IndexError):
        return "unknown " + command[0]


def line():
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    pins = ", ".join(f"{p} {version(p)}" for p in ("vtk", "numpy", "open3d-cpu"))
    return (f"{cpu()}, {os.cpu_count()} cores, {memory:.0f} GiB; {first_line('c++', '--version')}; "
            f"Python {platform.python_version()}, {pins} (PyPI). One thread, CPU seconds of the process.")


if __name__ == "__main__":
    print(line())
