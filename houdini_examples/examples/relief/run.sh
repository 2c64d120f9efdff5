#!/usr/bin/env bash
# The pipeline of the relief example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-relief_result}"
cd "${1:-relief_result}"
"$tool" make bumps sample.vdb --resolution 48
"$tool" make three-tori model.vdb --resolution 48
"$tool" relief sample.vdb model.vdb -o carved.vdb --draft
