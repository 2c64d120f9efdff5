#!/usr/bin/env bash
# Every header compiles alone, and outside vdb/, render/ and pipeline/ without a third party's header. One that is the
# first include of a .cpp is compiled alone by every build, so only what it drags in is looked at.
set -euo pipefail
cd "$(dirname "$0")/../.."
export compiler=${1:-c++}
check() {
  # `-MD` writes what was included while the same run checks the syntax.
  local dependencies source=${1%.h}.cpp how="-fsyntax-only -Wall -Wextra -MD"
  if [ -e "$source" ] && grep -m1 '#include' "$source" | grep -qF "\"$1\""; then
    case "$1" in libvdbsynth/vdb/*|libvdbsynth/render/*|libvdbsynth/pipeline/*) return 0 ;; esac
    how=-M
  fi
  dependencies=$(mktemp)
  echo "#include \"$1\"" | "$compiler" -std=c++17 -I. $how -MF "$dependencies" -x c++ - ||
    { echo "$1 does not compile alone"; return 1; }
  case "$1" in
    libvdbsynth/vdb/*|libvdbsynth/render/*|libvdbsynth/pipeline/*) ;;
    *) if grep -qE '/(openvdb|tbb|boost|nlohmann)/|png\.h' "$dependencies"; then echo "$1 drags in a third party"; return 1; fi ;;
  esac
  rm -f "$dependencies"
}
export -f check
# Those left out are openly OpenVDB's, helpers inside vdb/, TBB's, and the JSON of one reader.
find libvdbsynth -name '*.h' | sort | grep -vE 'vdb/(coord|grid_kinds|wall|convert/trilinear)\.h|base/parallel_sort\.h|io/readers/mesh_readers_gltf_steps\.h' | xargs -P "$(nproc)" -I{} bash -c 'check {}'
echo "every header compiles alone"
