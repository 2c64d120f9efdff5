#!/usr/bin/env bash
# The pipeline of the texture example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-texture_result}"
cd "${1:-texture_result}"
"$tool" make terrain heights.vdb -o image.png --resolution 48
"$tool" make three-tori model.obj --resolution 48
"$tool" texture model.obj image.png -o coloured.ply --as mesh --scale 0.5
