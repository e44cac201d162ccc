#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job in one command, on Debian 12: installs what it needs, builds the plugin into build/,
# decimates and undecimates Data/plate_hole.vtp and Data/crash_box/, and writes pictures, a film,
# meshes and numbers into demo-output/. May be run again at any time.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

Scripts/install.sh demo

if [ ! -f build/CMakeCache.txt ]; then
  cmake -S . -B build -G Ninja -DBUILD_TESTING=OFF
fi
cmake --build build --target Undecimate

plugin=$(find build -name Undecimate.so -path '*plugins*' -print -quit)
if [ -z "$plugin" ]; then
  echo "demo: the build in build/ has made no plugin; is UNDECIMATE_PARAVIEW OFF there?" >&2
  exit 1
fi

rm -rf demo-output
mkdir demo-output
# Debian's ParaView draws through GLX only: Xvfb is its display.
xvfb-run -a -s "-screen 0 1600x1000x24" pvpython Scripts/demo.py "$PWD/$plugin" demo-output
echo
xvfb-run -a -s "-screen 0 1600x1000x24" pvpython Scripts/crash.py "$PWD/$plugin" demo-output

for file in plate.json plate_hole.png plate_hole_{100,75,50,25,9.4}.png crash.{png,ogv}; do
  if [ ! -s "demo-output/$file" ]; then
    echo "demo: demo-output/$file is missing or empty" >&2
    exit 1
  fi
done
echo "In demo-output/: $(cd demo-output && ls | tr '\n' ' ')"
