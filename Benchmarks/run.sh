#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The benchmarks in one command; prints Markdown. Usage: Benchmarks/run.sh [PART [OPTIONS]]
#   all          everything below (default); with --results FOLDER also as files
#   linear       table 1 of the paper: CPU time of the core against the number of nodes
#   level        a change of level by 1 % at 1M nodes against memcpy: core, then the whole filter
#   decimation   filter against filter at 1M nodes: vtkDecimatePro, vtkQuadricDecimation
#   deviation    Hausdorff distance at equal triangle counts over the data set
#   build        only build the drivers and the Python environment
# Options go to the part: see Benchmarks/README.md. Needs g++, cmake and Python 3 with venv; 'level' and
# 'decimation' need the project built in build/ (or --build FOLDER).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cache="${XDG_CACHE_HOME:-$HOME/.cache}/undecimate"
part=${1:-all}
[ $# -gt 0 ] && shift

# The drivers.
build="$cache/benchmarks-build"
cmake -S "$here" -B "$build" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$build" -j 2 > "$cache/benchmarks-build.log" 2>&1 || {
  cat "$cache/benchmarks-build.log" >&2
  exit 1
}

# The Python environment; made anew when the pins change.
venv="$cache/venv"
if ! cmp -s "$here/requirements.txt" "$venv/requirements.txt"; then
  python3 -m venv --clear "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"
  cp "$here/requirements.txt" "$venv/requirements.txt"
fi
python="$venv/bin/python"

run() {
  part=$1
  shift
  case $part in
    linear) "$python" "$here/core.py" linear --timing "$build/core_timing" "$@" ;;
    level-core) "$python" "$here/core.py" level --timing "$build/core_timing" "$@" ;;
    level-filter) "$python" "$here/filters.py" level "$@" ;;
    decimation) "$python" "$here/filters.py" decimation "$@" ;;
    deviation) "$python" "$here/deviation.py" --cli "$build/decimate_cli" "$@" ;;
  esac
}

case $part in
  build) ;;
  linear | decimation | deviation) run "$part" "$@" ;;
  level)
    run level-core
    echo
    run level-filter "$@"
    ;;
  all)
    results=
    if [ "${1:-}" = --results ]; then
      results=$(mkdir -p "$2" && cd "$2" && pwd)
    fi
    save() { # name, command...
      name=$1
      shift
      printf '\n## %s\n\n' "$name"
      if [ -n "$results" ]; then
        "$@" --json "$results/$name.json" > "$results/$name.md"
        cat "$results/$name.md"
      else
        "$@"
      fi
    }
    "$python" "$here/machine.py"
    [ -z "$results" ] || "$python" "$here/machine.py" > "$results/machine.md"
    save linear run linear
    save level-core run level-core
    save level-filter run level-filter
    save decimation run decimation
    save deviation run deviation --reps 3 --time-each --fresh-rivals --jobs 1
    ;;
  *)
    sed -n '5,14p' "$0" >&2
    exit 2
    ;;
esac
