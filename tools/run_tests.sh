#!/usr/bin/env bash
# Installs what is needed, builds and runs the tests.
# Usage: tools/run_tests.sh [--all] [ctest options]   --all also installs the rivals and linters that some tests
# compare with, builds and tests the Python module, makes and installs Debian packages, and treats warnings as errors
set -euo pipefail
cd "$(dirname "$0")/.."
packages=test preset=release options=(-DVDBSYNTH_BUILD_TESTS=ON) labels=(-LE "^all\$")
if [ "${1:-}" = --all ]; then
  packages=all preset=ci options+=(-DVDBSYNTH_PYTHON=ON) labels=()
  shift
fi
tools/dev/packages.sh "$packages"
cmake --preset "$preset" "${options[@]}"
cmake --build --preset "$preset"
ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" "${labels[@]}" "$@"
