# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a script of Scripts/ as the demonstration does."""

import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).parents[2]


def run_script(name, folder):
    """What it prints."""
    result = subprocess.run(
        [os.environ["DEMO_XVFB_RUN"], "-a", "-s", "-screen 0 1600x1000x24", os.environ["DEMO_PVPYTHON"],
         ROOT / "Scripts" / name, os.environ["DEMO_PLUGIN"], folder],
        capture_output=True, text=True, timeout=280)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "ERR|" not in result.stderr, result.stderr
    return result.stdout
