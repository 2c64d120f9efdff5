#!/usr/bin/env bash
# The pipeline of the compare example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-compare_result}"
cd "${1:-compare_result}"
"$tool" make balls reference.vdb --resolution 32 --seed 1
"$tool" make balls other.vdb --resolution 32 --seed 2
"$tool" compare reference.vdb other.vdb -o numbers.json --page page.html
