#!/usr/bin/env bash
# The pipeline of the patch example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-patch_result}"
cd "${1:-patch_result}"
"$tool" make weave exemplar.ply --resolution 48
"$tool" patch exemplar.ply -o sheet.vdb -o sheet.obj --size 2x,2x --draft
