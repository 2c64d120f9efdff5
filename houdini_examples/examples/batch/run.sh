#!/usr/bin/env bash
# The batch of the TOP example without Houdini.
# Usage: run.sh [FOLDER]   default: a new folder in the current one
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tool=$(realpath "$(command -v "${VDB_SYNTH:-vdb_synth}")")
mkdir -p "${1:-batch_result}"
cd "${1:-batch_result}"
cp "$here/jobs.json" .
"$tool" batch jobs.json --jobs 2 --page status.html
