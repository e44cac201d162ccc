#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the Debian packages that a job needs and that are missing; does nothing, and needs no
# network, when all are there.
#
#   Scripts/install.sh build|demo|test

set -euo pipefail

# Qt is for the icons only, libqt5svg5 is what draws them (and ParaView's own).
build="g++ cmake ninja-build paraview-dev python3-paraview libopenmpi-dev libxxhash-dev
  qtbase5-dev libqt5svg5"
demo="$build xvfb xauth python3-numpy"
# python3-pil reads the screenshots; the last line checks sources.
test="$demo libgtest-dev libcgal-dev python3-pytest python3-pil
  clang-format-14 clang-tidy-14 libxml2-utils"

case "${1:-}" in
  build | demo | test) packages=${!1} ;;
  *)
    echo "usage: Scripts/install.sh build|demo|test" >&2
    exit 2
    ;;
esac

missing=()
for package in $packages; do
  # shellcheck disable=SC2016
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install: please install as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600
  -o Acquire::Retries=3)
"${apt[@]}" update
"${apt[@]}" install -y --no-install-recommends "${missing[@]}"
