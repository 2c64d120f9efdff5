#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing. Usage: packages.sh build|test|bench|all
set -euo pipefail
build=(g++ cmake ninja-build ccache libopenvdb-dev libboost-iostreams-dev libtbb-dev libflann-dev liblz4-dev libboost-program-options-dev
       nlohmann-json3-dev libeigen3-dev libnanoflann-dev libjpeg62-turbo-dev libkissfft-dev libopenexr-dev libpng-dev libpugixml-dev
       libtiff-dev libtinygltf-dev libxxhash-dev libyaml-cpp-dev zlib1g-dev)
test=(catch2 python3 procps)
# Rivals to compare with, programs that must read what we write, fuzzers, linters, a cluster's daemons, what the Python
# module is built with, what builds a container, a screen without a screen.
all=(libopenvdb-tools python3-openvdb python3-numpy python3-scipy python3-skimage buildah chromium blender clang clang-format libclang-rt-14-dev
     debootstrap dpkg-dev file fish groff libboost-python-dev lintian man-db mandoc munge pybind11-dev python3-dev slurm-client slurmctld
     slurmd xvfb zsh)

# Rivals of the benchmarks.
bench=(libbenchmark-dev libfaiss-dev libfftw3-dev libopenblas-dev libopenvdb-tools python3)

case "${1:-build}" in
  build) wanted=("${build[@]}") ;;
  test) wanted=("${build[@]}" "${test[@]}") ;;
  bench) wanted=("${build[@]}" "${bench[@]}") ;;
  all) wanted=("${build[@]}" "${test[@]}" "${all[@]}") ;;
  *) echo "usage: $0 build|test|bench|all" >&2; exit 2 ;;
esac

missing=()
for package in "${wanted[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "error: these packages are missing and neither root nor sudo is there to install them: ${missing[*]}" >&2; exit 1; }
  root=(sudo)
fi
echo "installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${root[@]}" apt-get update -qq
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
