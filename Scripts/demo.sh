#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job in one command, on Debian 12: installs what it needs, builds the plugin into build/,
# decimates and undecimates Data/plate_hole.vtp, and writes pictures, meshes and numbers into
# demo-output/. With the argument "crash": Data/crash_box/ at three levels and times, and a film
# that moves both sliders. May be run again at any time.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

job=${1:-plate}
case $job in
  plate) script=demo.py files="plate.json plate_hole.png $(echo plate_hole_{100,75,50,25,9.4}.png)" ;;
  crash) script=crash.py files="crash.png crash.ogv" ;;
  *)
    echo "demo: '$job' is not a job; choose plate (default) or crash" >&2
    exit 2
    ;;
esac

Scripts/install.sh demo

if [ ! -f build/CMakeCache.txt ]; then
  cmake -S . -B build -G Ninja -DBUILD_TESTING=OFF
fi
cmake --build build --target Undecimate

# Not the copies that the tests install below build/.
plugin=$(find build/lib* -name Undecimate.so -path '*plugins*' -print -quit)
if [ -z "$plugin" ]; then
  echo "demo: the build in build/ has made no plugin; is UNDECIMATE_PARAVIEW OFF there?" >&2
  exit 1
fi

mkdir -p demo-output
(cd demo-output && rm -f $files)
# Debian's ParaView draws through GLX only: Xvfb is its display.
xvfb-run -a -s "-screen 0 1600x1000x24" pvpython "Scripts/$script" "$PWD/$plugin" demo-output

for file in $files; do
  if [ ! -s "demo-output/$file" ]; then
    echo "demo: demo-output/$file is missing or empty" >&2
    exit 1
  fi
done
echo "In demo-output/: $(cd demo-output && ls | tr '\n' ' ')"
