#!/bin/bash
# Installs what the tests need (Debian 12, as root), builds pscn and runs its tests:
#
#   tests/run.sh            minutes: the development build; every feature is tested, the heavy tests do a small part of
#                           their work, and those labelled `slow`, which look again at what others test, are left out
#   tests/run.sh --all      everything: the address and undefined-behaviour sanitizers, in a locale that writes numbers
#                           with a decimal comma, then the development build with more of the heavy tests; clang's
#                           build too where clang is installed. This is what .ci/run calls
#   tests/run.sh NAME...    the tests of these names (as `ctest -N` lists them), with all they say
#
# Ends with ctest's summary. The exit code is not 0 if any test failed.
#
# CC and CXX are the compilers, by default gcc and g++; the build of --all that is only compiled is clang's.
# PSCN_EFFORT, if set, is the fraction of the heavy tests in all passes (a number up to 1, or `full`: hours).
# PSCN_SEED=N takes other rays for every N.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh

case ${1:-} in
  --all | [!-]* | '') ;;
  *)
    echo "usage: tests/run.sh [--all | NAME...]" >&2
    exit 2
    ;;
esac

TEST_PACKAGES=(chromium clang-format dpkg-dev libcmocka-dev libflint-arb-dev locales openimageio-tools povray
  povray-examples povray-includes parallel python3-numpy)
# Fractions of 1. Sanitizers look for faults of memory and arithmetic, which show on few rays.
QUICK_EFFORT=0.0002 ASAN_EFFORT=0.0002 ALL_EFFORT=0.001
# Hundreds of pictures compared with a peer's, programs started again and again, and arithmetic: other tests already run
# their code.
ASAN_WITHOUT='^(peers-(parity|random|shading|compare-idiff|gamma|kinds|examples|farm-slurm)|paper-counts'
ASAN_WITHOUT+='|unit-(certificate|split)|accuracy-(cycles|kernels)|corpus'
ASAN_WITHOUT+='|library-arm64|property-(copies|flats|refine|rooms|sizes|solvers|team|twins|unkept)|cli-(merge|resume|povray-fails|scene-memory))$'
# Then these are left out of the development build's pass: the sanitizers' pass has done the same, and seen more.
ALL_WITHOUT='^(fault-(commands|files)|peers-(check-.*|chart|dump|windows)|cli-(chart|compare|habits))$'
JOBS=$(nproc)

# build PRESET [OPTION...]
build() {
  local preset=$1
  shift
  mkdir -p "build-$preset"
  cmake --preset "$preset" "$@" >"build-$preset/configure.log" 2>&1 || {
    cat "build-$preset/configure.log" >&2
    return 1
  }
  cmake --build "build-$preset" -- -j "$JOBS"
}

# run PRESET EFFORT [OPTION...]: runs ctest, with EFFORT unless PSCN_EFFORT is set. One test more at once than there are
# processors, because some wait for other programs.
run() {
  local preset=$1 effort=${PSCN_EFFORT:-$2}
  shift 2
  PSCN_EFFORT=$effort ctest --test-dir "build-$preset" --output-on-failure --no-tests=error -j $((JOBS + 1)) "$@"
}

# A German locale of our own: nothing outside the build folder is changed.
comma_locale() {
  local folder=$1/locale
  if [ ! -d "$folder/de_DE.UTF-8" ] && command -v localedef >/dev/null; then
    mkdir -p "$folder"
    localedef --no-archive -i de_DE -f UTF-8 "$folder/de_DE.UTF-8"
  fi
  (cd "$folder" && pwd)
}

[ "${1:-}" != --all ] || TEST_PACKAGES+=(gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user)
install_packages "${BUILD_PACKAGES[@]}" "${TEST_PACKAGES[@]}"

launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
export CC=${CC:-gcc} CXX=${CXX:-g++}
build dev "${launcher[@]}"

case ${1:-} in
  '') run dev "$QUICK_EFFORT" --label-exclude slow ;;
  --all)
    build asan "${launcher[@]}"
    if command -v clang++ >/dev/null; then
      build clang "${launcher[@]}"
    else
      echo "clang is not installed: its build is not checked"
    fi
    status=0
    LOCPATH=$(comma_locale build-asan) LC_ALL=de_DE.UTF-8 run asan "$ASAN_EFFORT" -E "$ASAN_WITHOUT" || status=$?
    run dev "$ALL_EFFORT" -E "$ALL_WITHOUT" || status=$?
    exit "$status"
    ;;
  *) run dev "$ALL_EFFORT" --verbose --tests-regex "^($(IFS='|' && echo "$*"))\$" ;;
esac
