#!/usr/bin/env bash
# Makes the Blender add-on, one zip to install from Blender's preferences.
# Usage: tools/dev/blender_addon.sh [OUT.zip]   default build/vdb_synth_blender.zip
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$(realpath -m "${1:-build/vdb_synth_blender.zip}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/vdb_synth" "$(dirname "$out")"
cp blender/vdb_synth/*.py python/vdbsynth_tool.py python/vdbsynth_ply.py LICENSE "$folder/vdb_synth/"
rm -f "$out"
(cd "$folder" && python3 -m zipfile -c "$out" vdb_synth)
echo "$out"
