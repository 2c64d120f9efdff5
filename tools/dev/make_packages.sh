#!/usr/bin/env bash
# Builds the Debian packages: vdb-synth, libvdbsynth-dev and, where it is built, python3-vdbsynth.
# Usage: tools/dev/make_packages.sh [--of BUILD] [FOLDER]
#   FOLDER      where the .deb files go, default build/packages/debian
#   --of BUILD  pack a build folder as it is, instead of building in build/packages
# VDBSYNTH_PYTHON=ON or OFF in the environment decides on the Python module; default ON where pybind11-dev and libboost-python-dev are.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=
if [ "${1:-}" = --of ]; then
  build=${2:?--of needs a build folder}
  shift 2
fi
out=$(realpath -m "${1:-build/packages/debian}")
for tool in cpack dpkg-shlibdeps dpkg-deb; do
  command -v "$tool" >/dev/null || { echo "error: $tool is missing; install cmake, dpkg and dpkg-dev" >&2; exit 1; }
done
if [ -z "$build" ]; then
  build=build/packages
  options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DVDBSYNTH_BUILD_TESTS=OFF)
  command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  python=${VDBSYNTH_PYTHON:-}
  if [ -z "$python" ]; then
    python=ON
    if ! dpkg-query -W pybind11-dev libboost-python-dev >/dev/null 2>&1; then
      python=OFF
      echo "note: pybind11-dev or libboost-python-dev is not installed: python3-vdbsynth is left out" >&2
    fi
  fi
  options+=(-DVDBSYNTH_PYTHON="$python")
  cmake -G Ninja -S . -B "$build" "${options[@]}"
  cmake --build "$build"
fi
mkdir -p "$out"
# What cpack leaves beside the packages goes with the folder.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$build" && cpack --config CPackConfig.cmake -G DEB -B "$work" >"$work/log" 2>&1) || { cat "$work/log" >&2; exit 1; }
rm -f "$out"/*.deb
mv "$work"/*.deb "$out"
for package in "$out"/*.deb; do echo "$package"; done
