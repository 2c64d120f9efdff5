#!/usr/bin/env bash
# Installs what is needed, builds, and runs the main job: an exemplar, more of it, a picture.
# Usage: tools/run_demo.sh [FOLDER]   results go to FOLDER, default build/demo
set -euo pipefail
cd "$(dirname "$0")/.."
tools/dev/packages.sh build
# A new folder gets the commands that are used here, without tests; one that is there already is built as it is set.
if [ -f build/release/CMakeCache.txt ]; then cmake build/release >/dev/null; else cmake --preset demo >/dev/null; fi
cmake --build build/release --target vdb_synth
demo=${1:-build/demo}
mkdir -p "$demo"
vdb_synth=build/release/tools/vdb_synth/vdb_synth
"$vdb_synth" make grid "$demo/grid.vdb"
"$vdb_synth" render "$demo/grid.vdb" -o "$demo/grid.png"
"$vdb_synth" synth "$demo/grid.vdb" -o "$demo/more.vdb" -o "$demo/more.obj" -o "$demo/more.ply" --size 2x,2x,1x
"$vdb_synth" render "$demo/more.vdb" -o "$demo/more.png"
echo
echo "The exemplar:   $demo/grid.vdb    $demo/grid.png"
echo "More of it:"
for file in more.vdb more.obj more.ply more.png; do echo "$(realpath "$demo/$file")"; done
if ! "$vdb_synth" help analogy >/dev/null 2>&1; then
  echo "Built for this: $("$vdb_synth" --help | sed -n 's/^  \([a-z-]*\)  .*/\1/p' | paste -sd' '). All commands: cmake --preset release && cmake --build --preset release"
fi
