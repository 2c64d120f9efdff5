#!/usr/bin/env bash
# Fails if clang-format would change a source. Skips (77) where clang-format is absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
command -v clang-format >/dev/null || { echo "clang-format is absent: skipped"; exit 77; }
find libvdbsynth tools python tests -name '*.h' -o -name '*.cpp' | xargs clang-format --dry-run -Werror
echo "all sources are formatted"
