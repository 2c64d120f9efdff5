#!/usr/bin/env bash
# Builds, makes more of a fixed set of exemplars and measures the results: a table, and a contact sheet of pictures in
# build/release/quality. Defaults are chosen with it.
# Usage: tools/dev/quality.sh [--seeds N] [--size X,Y,Z] [--synth "OPTIONS"] [--name NAME] [EXEMPLAR...]
set -euo pipefail
cd "$(dirname "$0")/../.."
tools/dev/packages.sh test
cmake --preset release >/dev/null
cmake --build --preset release --target vdb_synth
exec /usr/bin/python3 tests/quality/quality.py build/release "$@"
