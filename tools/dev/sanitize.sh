#!/usr/bin/env bash
# Builds and runs the tests under a sanitizer. Usage: sanitize.sh address|undefined|thread [ctest options]
set -euo pipefail
cd "$(dirname "$0")/../.."
case "${1:-}" in
  address) preset=asan ;;
  undefined) preset=ubsan ;;
  thread) preset=tsan ;;
  *) echo "usage: $0 address|undefined|thread" >&2; exit 2 ;;
esac
shift
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
export ASAN_OPTIONS=detect_leaks=0 TSAN_OPTIONS="suppressions=$PWD/tools/dev/tsan.supp" UBSAN_OPTIONS=print_stacktrace=1
# The stock TBB is not built for the thread sanitizer, so it sees only the rooms whose tests use our own loops.
[ "$preset" = tsan ] && set -- -L 'base|grid|distance|measure|search|synth|analogy|procedural' "$@"
ctest --test-dir "build/$preset" --output-on-failure -LE 'lint|consumer' "$@"
