#!/usr/bin/env bash
# How long a build from nothing takes, without ccache, in a folder of its own that is removed afterwards: its wall time, its
# processor time and the ten files that took longest. Other work on the machine lengthens the wall times, the files' too.
# Usage: tools/dev/build_time.sh [PRESET [TARGET...]]   default: demo vdb_synth, what tools/run_demo.sh builds
set -euo pipefail
cd "$(dirname "$0")/../.."
preset=${1:-demo}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(vdb_synth)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export CCACHE_DISABLE=1
cmake --preset "$preset" -B "$folder" >"$folder.log" 2>&1 || { cat "$folder.log" >&2; rm -f "$folder.log"; exit 1; }
rm -f "$folder.log"
echo "load of the machine before: $(cut -d' ' -f1 /proc/loadavg); cores: $(nproc); $("${CXX:-c++}" --version | head -1)"
TIMEFORMAT="wall %R s, processor %U s (user) + %S s (system)"
time cmake --build "$folder" --target "${targets[@]}" >/dev/null
echo "compiled: $(find "$folder" -name '*.o' | wc -l) files; wall seconds of the ten that took longest:"
awk -F'\t' '!/^#/ && $4 ~ /\.o$/ {printf "%7.1f  %s\n", ($2 - $1) / 1000, $4}' "$folder/.ninja_log" | sort -rn | sed 's#CMakeFiles/[^/]*/##' | head -10
