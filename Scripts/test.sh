#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# All tests in one command, on Debian 12: installs what it needs, builds into build/, runs ctest.
# The sanitizer build (build/sanitize) and the plain VTK build (build/vtk) are tests, too.
# Arguments go to ctest, such as:  Scripts/test.sh -R Core

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

Scripts/install.sh test

cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DUNDECIMATE_PARAVIEW=ON -DUNDECIMATE_PYTHON=ON -DUNDECIMATE_SANITIZE=OFF \
  -DUNDECIMATE_WERROR=ON -DBUILD_TESTING=ON
cmake --build build
exec ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
