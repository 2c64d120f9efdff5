#!/usr/bin/env bash
# Makes pictures of docs/pictures again with a built program, from models that `make` makes.
# Usage: make_pictures.sh [PROGRAM [NAME...]]; NAME is synth, synthesis, controls, analogies, shallow, field, patches, relief, texturing, render, fog,
# direction or poses, all by default. Maps and the cloud need python3-openvdb, joined pictures python3-pil.
# Those of Blender: blender_pictures.sh.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/release/tools/vdb_synth/vdb_synth}")
shift || true
names=("$@")
[ ${#names[@]} -gt 0 ] || names=(synth synthesis controls analogies shallow field patches relief texturing render fog direction poses)
pictures=$root/docs/pictures
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

run() { "$program" "$@" --quiet; }
# A model of `make`, made once.
model() { [ -e "$1" ] || run make "${@:2}" "$1"; }
tori() { [ -e tori.vdb ] || run make three-tori tori.vdb --resolution "$1"; }

draw_synth() {
  local kind all=()
  for kind in grid balls foam; do
    model "$kind.vdb" "$kind" --seed 1
    run synth "$kind.vdb" -o "$kind-more.vdb" --size 2x,2x,1x --seed 1
    all+=("$kind.vdb" "$kind-more.vdb")
  done
  run render "${all[@]}" -o "$pictures/synth.png" --size 400x300 --columns 2 --samples 8 --captions none
}

draw_synthesis() {
  local kind all=()
  for kind in balls foam sponge terrain grid weave; do
    model "$kind.vdb" "$kind" --seed 1
    run synth "$kind.vdb" -o "$kind-paper.vdb" --size 2x,2x,1x --seed 1 --method paper
    run synth "$kind.vdb" -o "$kind-more.vdb" --size 2x,2x,1x --seed 1
    all+=("$kind.vdb" "$kind-paper.vdb" "$kind-more.vdb")
  done
  run render "${all[@]}" -o "$pictures/synthesis.png" --size 290x225 --columns 3 --samples 8 --captions none
}

# A lattice inside a sponge, fibres from the middle outwards, a lattice that grows.
draw_controls() {
  local kind
  mkdir -p c && cd c
  for kind in sponge grid fibres; do run make "$kind" "$kind.vdb" --seed 1; done
  /usr/bin/python3 "$root/tools/dev/make_maps.py" maps.vdb
  run synth sponge.vdb grid.vdb -o inside.vdb --size 128,128,64 --exemplar-map maps.vdb:label
  run synth fibres.vdb -o outwards.vdb --size 128,128,64 --direction radial
  run synth grid.vdb -o grows.vdb --size 128,128,64 --scale-map maps.vdb:scale
  run render inside.vdb outwards.vdb grows.vdb -o "$pictures/controls.png" --size 420x320 --samples 8 --captions none
  cd ..
}

draw_analogies() {
  local kind all=()
  mkdir -p a && cd a
  tori 150
  for kind in grooves spikes pits holes thorns hollow; do
    run make "$kind" A.vdb A2.vdb
    run analogy A.vdb A2.vdb tori.vdb -o "$kind.vdb" --direction around:z
    all+=("$kind.vdb")
  done
  # The hollow one is cut open, so that its shells are seen.
  local box
  box=$("$program" info hollow.vdb --json | python3 -c '
import json, sys
box = json.load(sys.stdin)["model"]["domain"].split(",")
box[1] = str((int(box[1]) + int(box[4])) // 2)
print(",".join(box))')
  run crop hollow.vdb -o cut.vdb --box="$box"
  run render "${all[@]:0:5}" cut.vdb -o "$pictures/analogies.png" --size 400x320 --columns 3 --samples 8 --captions none
  cd ..
}

# A picture's bricks, and plates.
draw_shallow() {
  mkdir -p s && cd s
  "$root/tools/dev/make_sample.py" bricks bricks.png 128
  tori 150
  run convert bricks.png -o A.vdb --height 0.001 --base 12
  run convert bricks.png -o A2.vdb --height 6 --base 12
  run analogy A.vdb A2.vdb tori.vdb -o walls.vdb --direction around:z --scale 0.5
  run make scales S.vdb S2.vdb
  run analogy S.vdb S2.vdb tori.vdb -o scaly.vdb --direction around:z
  run render walls.vdb scaly.vdb -o "$pictures/analogies-shallow.png" --size 480x380 --samples 8 --captions none
  cd ..
}

# A direction field as streaks, and grooves along it.
draw_field() {
  mkdir -p f && cd f
  run make sponge sponge.vdb --resolution 128 --feature 72 --seed 6
  run make grooves A.vdb A2.vdb
  run analogy A.vdb A2.vdb sponge.vdb -o grooved.vdb --direction axis:z --write-directions
  run render sponge.vdb -o 1.png --directions grooved.vdb:direction --size 480x420 --samples 8 --view 1,-1.2,1
  run render grooved.vdb -o 2.png --size 480x420 --samples 8 --view 1,-1.2,1
  /usr/bin/python3 - "$pictures/analogy_directions.png" <<'JOIN'
import sys
from PIL import Image
left, right = (Image.open(name).convert("RGB") for name in ("1.png", "2.png"))
both = Image.new("RGB", (left.width + right.width, left.height))
both.paste(left, (0, 0))
both.paste(right, (left.width, 0))
both.save(sys.argv[1])
JOIN
  cd ..
}

draw_patches() {
  local kind all=()
  for kind in chainmail:4x,4x weave:3x,3x flowers:3x,3x; do
    model "${kind%:*}.ply" "${kind%:*}"
    run patch "${kind%:*}.ply" --size "${kind#*:}" -o "${kind%:*}-sheet.vdb"
    all+=("${kind%:*}-sheet.vdb")
  done
  run render "${all[@]}" -o "$pictures/patches.png" --size 520x340 --samples 8 --captions none
}

draw_relief() {
  mkdir -p r && cd r
  "$root/tools/dev/make_sample.py" bricks bricks.png 128
  tori 128
  run make scales plain.vdb scales.vdb
  run relief bricks.png tori.vdb -o walls.vdb --direction around:z --height 3 --tile yes
  run relief scales.vdb tori.vdb -o scaly.vdb
  run render walls.vdb scaly.vdb -o "$pictures/relief-tori.png" --size 600x480 --samples 8 --captions none
  cd ..
}

draw_texturing() {
  mkdir -p t && cd t
  "$root/tools/dev/make_sample.py" bricks bricks.png 128
  "$root/tools/dev/make_sample.py" pebbles pebbles.png 128
  tori 256
  run texture tori.vdb bricks.png -o left.vdb --direction around:z --scale 2
  run texture tori.vdb pebbles.png -o right.vdb --tile yes --scale 2
  run render left.vdb right.vdb -o "$pictures/texturing.png" --size 600x480 --samples 8 --captions none
  cd ..
}

draw_render() {
  model grid.vdb grid --seed 1
  model balls.vdb balls --seed 1
  run convert balls.vdb -o balls.obj
  run render grid.vdb balls.vdb -o "$pictures/render-row.png" --size 480x360 --samples 8
  run render balls.obj -o "$pictures/render-wireframe.png" --up z --wireframe --resolution 64 --size 480x360 --samples 8
  run render balls.vdb -o "$pictures/render-slice.png" --slice z=0.5 --size 480x360
}

draw_fog() {
  /usr/bin/python3 "$root/tools/dev/make_cloud.py" cloud.vdb
  run render cloud.vdb -o "$pictures/render-fog.png" --size 480x360
}

# A lattice and fibres along circles.
draw_direction() {
  local kind all=()
  mkdir -p d && cd d
  for kind in grid fibres; do
    run make "$kind" "$kind.vdb" --resolution 64 --seed 1
    run synth "$kind.vdb" -o "$kind-rings.vdb" --size 3x,3x,1x --direction around:z
    all+=("$kind.vdb" "$kind-rings.vdb")
  done
  run render "${all[@]}" -o "$pictures/synth-direction.png" --size 480x380 --columns 2 --samples 8 --captions none --view 0.3,-0.6,1
  cd ..
}

# One texture, made at rest and carried to twists.
draw_poses() {
  local degrees frame=0
  mkdir -p p && cd p
  run make three-tori body.vdb --resolution 100
  run convert body.vdb -o body.obj
  for degrees in 0 1.5 3 30 60 90; do
    frame=$((frame + 1))
    "$root/tools/dev/twist_mesh.py" body.obj "body.$frame.obj" "$degrees"
  done
  run make thorns A.vdb A2.vdb
  run analogy A.vdb A2.vdb "body.#.obj" --rest body.obj -o "pose.#.vdb" --frames 1-6 --resolution 150 --direction around:z
  run render pose.[1-6].vdb -o "$pictures/poses.png" --size 420x300 --columns 3 --samples 8 --captions none
  cd ..
}

for name in "${names[@]}"; do
  declare -F "draw_$name" >/dev/null || { echo "$0: no picture is called $name" >&2; exit 2; }
  "draw_$name"
  echo "$name"
done
