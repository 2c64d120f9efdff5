#!/usr/bin/env bash
# Installs what is needed, builds the benchmarks and runs them beside their rivals: prints budget, measured, rival
# and ratio, and writes build/release/bench.json.
# Usage: tools/dev/bench.sh [--quick] [ROW...]   a row is run if its name contains one of the words; --quick asks
# fewer queries and leaves out the longest runs
set -euo pipefail
cd "$(dirname "$0")/../.."
tools/dev/packages.sh bench
cmake --preset release -DVDBSYNTH_BUILD_BENCHMARKS=ON >/dev/null
cmake --build --preset release --target vdb_synth block_match_bench analogy_bench
exec /usr/bin/python3 tests/bench/bench.py build/release "$@"
