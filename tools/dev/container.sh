#!/usr/bin/env bash
# Builds the Containerfile with buildah and runs what comes of it. Needs root, and packages' hosts as apt-get does; no registry of images.
# Usage: container.sh [--packages FOLDER] [WORK]
#   --packages FOLDER  take the .deb files of FOLDER (tools/dev/make_packages.sh) instead of compiling in the first stage
#   WORK               keeps the base image and the layers for the next time; default a folder for the time being
# debian:bookworm is made by debootstrap from the machine's own package sources. Skips with a message where that is not possible.
set -euo pipefail
cd "$(dirname "$0")/../.."
packages=
if [ "${1:-}" = --packages ]; then
  packages=$(realpath "${2:?--packages needs a folder}")
  ls "$packages"/vdb-synth_*.deb >/dev/null || { echo "error: $packages has no vdb-synth_*.deb: tools/dev/make_packages.sh" >&2; exit 1; }
  shift 2
fi
skip() { echo "skipped: $1"; exit 0; }
[ "$(id -u)" -eq 0 ] || skip "only root can make a base image"
for tool in buildah debootstrap unshare chroot; do
  command -v "$tool" >/dev/null || skip "$tool is absent: apt-get install --no-install-recommends buildah debootstrap"
done
folder=$(mktemp -d)
work=$(realpath -m "${1:-$folder/work}")
mkdir -p "$work"
export BUILDAH_ISOLATION=chroot
images() { buildah --root "$work/storage" --runroot "$work/run" "$@"; }
container=
finish() {
  [ -z "$container" ] || images rm "$container" >/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT

if ! images inspect --type image debian:bookworm >/dev/null 2>&1; then
  site=$(apt-get indextargets --format '$(SITE) $(CODENAME) $(COMPONENT)' "Created-By: Packages" | awk '$2 == "bookworm" && $3 == "main" { print $1; exit }')
  [ -n "$site" ] || skip "the machine's package sources are not those of Debian 12"
  debootstrap --variant=minbase bookworm "$work/root" "$site" >"$work/debootstrap.log" 2>&1 || skip "debootstrap failed: $(tail -1 "$work/debootstrap.log")"
  base=$(images from scratch)
  images add --quiet "$base" "$work/root" / >/dev/null
  images config --cmd bash "$base"
  images commit --quiet "$base" docker.io/library/debian:bookworm >/dev/null
  images tag docker.io/library/debian:bookworm docker.io/library/debian:bookworm-slim
  images rm "$base" >/dev/null
  rm -rf "$work/root"
fi

file=Containerfile
context=.
if [ -n "$packages" ]; then
  # The same file, with the one step that compiles replaced.
  file=$folder/Containerfile
  context=$folder/context
  mkdir "$context"
  cp "$packages"/vdb-synth_*.deb "$context"
  awk '/^RUN tools/ { print "RUN mkdir /packages && cp *.deb /packages"; skip = /\\$/; next } skip { skip = /\\$/; next } { print }' Containerfile >"$file"
fi
images build --network host --pull=never --tag vdb_synth --file "$file" "$context"

container=$(images from --pull=never vdb_synth)
root=$(images mount "$container")
entry=$(images inspect --type image --format '{{index .OCIv1.Config.Entrypoint 0}}' vdb_synth)
[ "$entry" = vdb_synth ] || { echo "error: the entry point is '$entry', not vdb_synth" >&2; exit 1; }
# As a runtime starts it: process 1 of its own namespace of processes, with the image's files as /.
inside() { exec unshare --mount --pid --fork --kill-child=KILL -- sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" "$@"; }
(inside "$entry" --version)
(inside "$entry" make grid work/grid.vdb --resolution 24 --quiet)
[ -s "$root/work/grid.vdb" ] || { echo "error: the container wrote no grid.vdb" >&2; exit 1; }
(inside "$entry" synth work/grid.vdb -o work/never.vdb --size 400,400,400 --quiet) &
outer=$!
sleep 3
# The run is process 1 inside; from here it is the child of unshare.
kill -TERM "$(pgrep -P "$outer")"
code=0
wait "$outer" || code=$?
[ "$code" -eq 143 ] || { echo "error: SIGTERM to process 1 gave $code, not 143" >&2; exit 1; }
[ ! -e "$root/work/never.vdb" ] || { echo "error: a stopped run left its output" >&2; exit 1; }
echo "built, run as process 1, stopped by SIGTERM with 143"
