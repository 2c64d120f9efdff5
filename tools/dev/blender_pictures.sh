#!/usr/bin/env bash
# Makes the pictures of docs/blender.md again: runs the add-on in Blender, from pairs that `make` makes and Blender's own monkey.
# Usage: blender_pictures.sh [PROGRAM [NAME...]]; NAME is analogy, methods or panel, all by default.
# The panel needs a window: without a display Xvfb makes one, and without Xvfb that picture is left as it is.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/release/tools/vdb_synth/vdb_synth}")
shift || true
names=("$@")
[ ${#names[@]} -gt 0 ] || names=(analogy methods panel)
command -v blender >/dev/null || { echo "error: Blender is absent: tools/dev/packages.sh all" >&2; exit 1; }
folder=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server" 2>/dev/null; rm -rf "$folder"' EXIT
export HOME=$folder BLENDER_USER_SCRIPTS=$folder/scripts
mkdir "$folder/scripts"
"$root/tools/dev/blender_addon.sh" "$folder/addon.zip" >/dev/null
cd "$folder"

run() { "$program" "$@" --quiet; }
pair() { [ -e "$1_A.vdb" ] || run make "$1" "$1_A.vdb" "$1_A2.vdb" --seed 1; }
inside() { blender "$@" --factory-startup --python-exit-code 1 --python "$root/tools/dev/blender_pictures.py" -- "$folder" "$program" "$name" >log 2>&1 ||
  { cat log >&2; exit 1; }; }
# As few colours as look the same: a rendered picture's grain makes a .png large.
keep() { /usr/bin/python3 -c '
import sys
from PIL import Image
Image.open(sys.argv[1]).convert("RGB").quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG).save(sys.argv[2], optimize=True)
' "$folder/$name.png" "$root/docs/pictures/blender-$name.png"; echo "$name"; }

for name in "${names[@]}"; do
  case $name in
    analogy)
      pair scales
      pair holes
      inside -b
      keep ;;
    methods)
      run make foam foam.vdb --seed 1
      run make flowers flowers.vdb --seed 1
      "$root/tools/dev/make_sample.py" bricks bricks.png 128
      inside -b
      keep ;;
    panel)
      pair scales
      if [ -n "${DISPLAY:-}" ]; then
        inside --enable-event-simulate --window-geometry 0 0 900 640
      elif command -v Xvfb >/dev/null; then
        mkfifo display
        Xvfb -displayfd 3 -screen 0 900x640x24 3>display 2>xvfb.log &
        server=$!
        read -r number <display
        export DISPLAY=:$number LIBGL_ALWAYS_SOFTWARE=1
        inside --enable-event-simulate --window-geometry 0 0 900 640
        kill "$server"
      else
        echo "note: no display and no Xvfb (apt-get install xvfb): the picture of the panel is left as it is" >&2
        continue
      fi
      keep ;;
    *) echo "$0: no picture is called $name" >&2; exit 2 ;;
  esac
done
