#!/usr/bin/env bash
# The pipeline of the analogy example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-analogy_result}"
cd "${1:-analogy_result}"
"$tool" make spikes plain.vdb textured.vdb --resolution 64
"$tool" make three-tori model.vdb --resolution 48
"$tool" analogy plain.vdb textured.vdb model.vdb -o spiky.vdb --direction axis:y
