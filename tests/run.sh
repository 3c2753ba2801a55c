#!/bin/bash
# Installs what the tests need (Debian 12, as root), builds pscn and runs all its tests, twice:
#   1. under the address and undefined-behaviour sanitizers, in a locale that writes numbers with a decimal comma, but
#      for the longest comparisons with peers;
#   2. as it is built for development.
# Ends by ctest's summary of the second pass; the exit code is not 0 if either pass failed.
#
# CC and CXX are the compilers, gcc and g++ unless they are set; the third build, which is not run, is clang's.
# PSCN_EFFORT, the fraction of the heavy tests that is done (a number up to 1, or `full`: hours), is 0.002 unless it is
# set; PSCN_SEED=N takes other rays for every N.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh

TEST_PACKAGES=(chromium libcmocka-dev libflint-arb-dev locales openimageio-tools povray povray-examples povray-includes)
ASAN_EFFORT=0.0002 # sanitized code looks for faults of memory and arithmetic, which show on few rays
# Hundreds of pictures and their comparison with a peer's: the code they run is looked at by other tests already.
ASAN_WITHOUT='^peers-(parity|random|shading|compare-idiff)$'
JOBS=$(nproc)

# build PRESET [OPTION...]
build() {
  local preset=$1
  shift
  mkdir -p "build-$preset"
  cmake --preset "$preset" -G Ninja "$@" >"build-$preset/configure.log" 2>&1 || {
    cat "build-$preset/configure.log" >&2
    return 1
  }
  cmake --build "build-$preset" -- -j "$JOBS"
}

# A German locale of our own: nothing is changed outside the build folder.
comma_locale() {
  local folder=$1/locale
  if [ ! -d "$folder/de_DE.UTF-8" ] && command -v localedef >/dev/null; then
    mkdir -p "$folder"
    localedef --no-archive -i de_DE -f UTF-8 "$folder/de_DE.UTF-8"
  fi
  (cd "$folder" && pwd)
}

install_packages "${BUILD_PACKAGES[@]}" "${TEST_PACKAGES[@]}"

launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
export CC=${CC:-gcc} CXX=${CXX:-g++}
build dev "${launcher[@]}"
build asan "${launcher[@]}"
if command -v clang++ >/dev/null; then
  build clang "${launcher[@]}"
else
  echo "clang is not installed: its build is not checked"
fi

status=0
LOCPATH=$(comma_locale build-asan) LC_ALL=de_DE.UTF-8 PSCN_EFFORT=${PSCN_EFFORT:-$ASAN_EFFORT} \
  ctest --test-dir build-asan -E "$ASAN_WITHOUT" --output-on-failure -j "$JOBS" || status=$?
ctest --test-dir build-dev --output-on-failure -j "$JOBS" || status=$?
exit "$status"
