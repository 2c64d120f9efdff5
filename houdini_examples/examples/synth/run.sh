#!/usr/bin/env bash
# The pipeline of the synth example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-synth_result}"
cd "${1:-synth_result}"
"$tool" make sponge exemplar.vdb --resolution 32 --seed 1
"$tool" synth exemplar.vdb -o more.vdb -o more.ply --size 2x,2x,1x --seed 7
