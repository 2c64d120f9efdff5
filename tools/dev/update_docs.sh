#!/usr/bin/env bash
# Writes docs/cli/*.txt from the built program's help. Usage: update_docs.sh [vdb_synth]
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${1:-build/release/tools/vdb_synth/vdb_synth}
for command in $("$program" --help | sed -n 's/^  \([a-z-]*\)  .*/\1/p'); do
  "$program" "$command" --help >"docs/cli/$command.txt"
done
