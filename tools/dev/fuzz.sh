#!/usr/bin/env bash
# Builds the fuzz targets and runs each for some seconds. Usage: fuzz.sh SECONDS [TARGET...]
# What is found stays in build/fuzz/found; the corpus of earlier runs in build/fuzz/corpus is gone on with.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:?usage: fuzz.sh SECONDS [TARGET...]}
shift
command -v clang++ >/dev/null && [ -e "$(clang++ -print-file-name=libclang_rt.fuzzer-x86_64.a)" ] ||
  { echo "skipped: clang++ with libFuzzer is absent (packages clang, libclang-rt-14-dev)"; exit 77; }
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target fuzz_all | tail -n 1
folder=build/fuzz
mkdir -p "$folder/found"
"$folder/tests/fuzz/fuzz_seeds" "$folder/seeds"
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=($(cd "$folder/tests/fuzz" && ls | sed -n 's/^fuzz_//p' | grep -v '^seeds$'))
bad=0
run() {
  local corpus="$folder/corpus/$1" seeds="$folder/seeds/$1" log="$folder/$1.log"
  mkdir -p "$corpus" "$seeds"
  # Leaks are not looked for: libraries keep their tables to the end.
  if ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 "$folder/tests/fuzz/fuzz_$1" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 \
      -malloc_limit_mb=2000 -max_len=20000 -artifact_prefix="$folder/found/$1-" -print_final_stats=1 "$corpus" "$seeds" >"$log" 2>&1; then
    echo "$1: nothing found in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") runs"
  else
    echo "$1: FOUND, see $log"
    return 1
  fi
}
for target in "${targets[@]}"; do run "$target" || bad=1; done
exit $bad
