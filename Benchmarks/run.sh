#!/bin/sh
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The benchmarks in one command; prints Markdown. Usage: Benchmarks/run.sh [PART [OPTIONS]]
#   all          linear, level, decimation, limit and deviation (default); with --results FOLDER also as files
#   linear       table 1 of the paper: CPU time of the core against the number of nodes
#   level        a change of level by 1 % at 1M nodes against memcpy: core, then the whole filter
#   decimation   filter against filter at 1M nodes: vtkDecimatePro, vtkQuadricDecimation
#   fast         Scalar Difference and Quadric against meshoptimizer, Deviation against vtkQuadricDecimation, 1M nodes
#   threads      Parallel with one thread and with two, whole filter, 1M nodes
#   scaling      how Parallel would scale to 64 cores, computed from the times of the jobs of one run
#   limit        bytes a removal against the memory's bandwidth and latency
#   deviation    Hausdorff distance at equal triangle counts over the data set
#   field        the same against the whole field of decimators, into Benchmarks/results (the first time: hours)
#   field-ours   ours alone against the rivals' results that are there (minutes); --against OTHER.json
#   field-times  CPU time and memory of the field on grids and the gearbox, into Benchmarks/results
#   peer         our filter in another bench of decimators: peer FOLDER ARGUMENTS OF ITS bench.py
#   page         Documentation/benchmark.md, its plots and the table of the README from Benchmarks/results
#   test         tests of the error tool and of the comparison
#   tri_quad     triangles and quads over time: the paper's three tables, a million nodes, level and time with the
#                whole filter, into Benchmarks/results (needs CGAL); static, dynamic, ... behind it: only these
#   build        only build the drivers and the Python environment
# Options go to the part: see Benchmarks/README.md. Needs g++, cmake and Python 3 with venv; 'level', 'fast',
# 'decimation', 'field-times', 'threads' and 'tri_quad' need the project built in build/ (or --build FOLDER).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cache="${XDG_CACHE_HOME:-$HOME/.cache}/undecimate"
part=${1:-all}
[ $# -gt 0 ] && shift

# Configure and build; anew if the folder was another copy's.
compile() { # sources, build folder, options
  sources=$1
  folder=$2
  shift 2
  if ! grep -qsFx "CMAKE_HOME_DIRECTORY:INTERNAL=$sources" "$folder/CMakeCache.txt"; then
    rm -rf "$folder"
  fi
  cmake -S "$sources" -B "$folder" "$@" > "$folder.log" 2>&1 && cmake --build "$folder" -j 2 >> "$folder.log" 2>&1 || {
    cat "$folder.log" >&2
    exit 1
  }
}

# The drivers that measure the core; the page and the tests need none.
build="$cache/benchmarks-build"
if [ "$part" != page ] && [ "$part" != peer ] && [ "$part" != test ]; then
  mkdir -p "$cache"
  compile "$here" "$build" -DCMAKE_BUILD_TYPE=Release
fi

# A Python environment; made anew when the pins change.
environment() { # name, requirements
  if ! cmp -s "$here/$2" "$cache/$1/requirements.txt"; then
    python3 -m venv --clear "$cache/$1"
    "$cache/$1/bin/pip" install --quiet --disable-pip-version-check -r "$here/$2"
    cp "$here/$2" "$cache/$1/requirements.txt"
  fi
}
[ "$part" = peer ] || environment venv requirements.txt
python="$cache/venv/bin/python"

# The rivals: two environments and the drivers of the C++ libraries. meshoptimizer comes as the sources in
# its Rust package, since no Debian or Python package has this version; MESHOPTIMIZER_SOURCE names other ones.
rivals() {
  environment rivals-venv requirements-rivals.txt
  environment blender-venv requirements-blender.txt
  source=${MESHOPTIMIZER_SOURCE:-}
  if [ -z "$source" ] && command -v cargo > /dev/null; then
    source="$cache/meshoptimizer/vendor/meshopt/vendor/src"
    if [ ! -d "$source" ]; then
      rm -rf "$cache/meshoptimizer"
      mkdir -p "$cache/meshoptimizer"
      (cd "$cache/meshoptimizer" && cargo init --quiet --vcs none --name sources . &&
        cargo add --quiet meshopt@=0.7.0 && cargo vendor --quiet vendor > /dev/null)
    fi
  fi
  compile "$here/field_drivers" "$cache/rivals-build" -DMESHOPTIMIZER_SOURCE="$source"
  grep Without "$cache/rivals-build.log" >&2 || true
}

run() {
  part=$1
  shift
  case $part in
    linear) "$python" "$here/core.py" linear --timing "$build/core_timing" "$@" ;;
    level-core) "$python" "$here/core.py" level --timing "$build/core_timing" "$@" ;;
    level-filter) "$python" "$here/filters.py" level "$@" ;;
    decimation) "$python" "$here/filters.py" decimation "$@" ;;
    fast)
      rivals
      "$python" "$here/fast.py" "$@"
      ;;
    threads) "$python" "$here/threads.py" "$@" ;;
    scaling) "$python" "$here/scaling.py" --cli "$build/dealt_decimate_cli" "$@" ;;
    limit) "$python" "$here/core.py" limit --timing "$build/core_timing" --memory "$build/memory_limits" "$@" ;;
    deviation) "$python" "$here/deviation.py" --cli "$build/decimate_cli" "$@" ;;
    field)
      rivals
      "$python" "$here/field.py" rivals "$@"
      "$python" "$here/field.py" ours --cli "$build/decimate_cli" --json "$cache/field/ours.json"
      "$python" "$here/field.py" collect --ours "$cache/field/ours.json"
      ;;
    field-ours)
      "$python" "$here/field.py" ours --cli "$build/decimate_cli" --json "$cache/field/ours-now.json"
      "$python" "$here/field.py" summary --ours "$cache/field/ours-now.json" "$@"
      ;;
    field-times)
      rivals
      "$python" "$here/field.py" times "$@"
      ;;
    page) "$python" "$here/field_page.py" "$@" ;;
    peer) python3 "$here/peer.py" "$@" ;; # of the environment that is active: the other bench's
    test) "$python" "$here/metric_test.py" "$@" ;;
    tri_quad) "$python" "$here/tri_quad.py" --cli "$build/tri_quad_cli" --distance "$build/tri_quad_distance" "$@" ;;
  esac
}

case $part in
  build) ;;
  linear | fast | threads | scaling | limit | decimation | deviation | tri_quad | field | field-ours | field-times | page | peer | test) run "$part" "$@" ;;
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
    save limit run limit
    save deviation run deviation --reps 3 --time-each --fresh-rivals --jobs 1
    printf '\n## tri_quad\n\n'
    run tri_quad --json "${results:-$cache}/tri_quad.json"
    ;;
  *)
    sed -n '5,24p' "$0" >&2
    exit 2
    ;;
esac
