#!/usr/bin/env bash
# Makes the Houdini package, one zip to unpack anywhere.
# Usage: tools/dev/houdini_package.sh [OUT.zip]   default build/vdb_synth_houdini.zip
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$(realpath -m "${1:-build/vdb_synth_houdini.zip}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$(dirname "$out")"
cp -r houdini_examples "$folder/vdb_synth_houdini"
find "$folder" -name __pycache__ -prune -exec rm -rf {} +
cp python/vdbsynth_tool.py python/vdbsynth_ply.py "$folder/vdb_synth_houdini/scripts/python/"
cp LICENSE "$folder/vdb_synth_houdini/"
rm -f "$out"
(cd "$folder" && python3 -m zipfile -c "$out" vdb_synth_houdini)
echo "$out"
