#!/usr/bin/env bash
# Installs the build into a scratch folder and builds and runs the consumer against it.
set -euo pipefail
cmake=$1 build=$2
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/prefix" >/dev/null
for core in OFF ON; do
  "$cmake" -G Ninja -S "$here" -B "$scratch/$core" -DCORE_ONLY=$core -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release
  "$cmake" --build "$scratch/$core"
  "$scratch/$core/consumer"
done
"$scratch/prefix/bin/vdb_synth" --version
