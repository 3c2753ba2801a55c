#!/bin/bash
# deb.sh BUILD: the package that cpack makes names its dependencies, and its contents work where they are unpacked: the
# program renders with its own module, from a folder that is not the build tree's, with an empty environment (except for
# what the sanitizers need).
set -euo pipefail
for program in dpkg-deb dpkg-shlibdeps cpack; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed" >&2; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cpack --config "$1/CPackConfig.cmake" -B "$folder" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >cpack.log 2>&1 || { cat cpack.log; exit 1; }
dpkg-deb -x pscn_*.deb root
depends=$(dpkg-deb -f pscn_*.deb Depends)
for package in libc6 libopenimageio libpng16-16 libjansson4 libstdc++6; do
  [[ $depends == *"$package"* ]] || { echo "Depends has no $package: $depends"; exit 1; }
done
[ "$(dpkg-deb -f pscn_*.deb Package)" = pscn ]
[ "$(env -i root/usr/bin/pscn --version)" = "pscn $(dpkg-deb -f pscn_*.deb Version)" ]

cp "$PSCN_SOURCE_DIR/scenes/bent.pscn" .
env -i ${LSAN_OPTIONS:+"LSAN_OPTIONS=$LSAN_OPTIONS"} ${ASAN_OPTIONS:+"ASAN_OPTIONS=$ASAN_OPTIONS"} \
  LD_DEBUG=libs LD_DEBUG_OUTPUT=libs root/usr/bin/pscn render bent.pscn --size 40x30 -q -o bent.exr
[ -s bent.exr ] || { echo "there is no picture"; exit 1; }
loaded=$(grep -ho 'calling init: .*pscn_openimageio.so' libs.*)
[[ $loaded == *"$folder"/root/usr/* ]] || { echo "the module is another one: $loaded"; exit 1; }
"$PSCN" render bent.pscn --size 40x30 -q -o built.exr
"$PSCN" compare bent.exr built.exr --fail 0 -q

# The Python module is a package of its own.
[[ $(dpkg-deb -f python3-pscn_*_all.deb Depends) == *"python3-numpy, pscn"* ]]
dpkg-deb -c python3-pscn_*_all.deb | grep -q ' ./usr/lib/python3/dist-packages/pscn.py$'
! dpkg-deb -c pscn_*.deb | grep -q 'pscn\.py$' || { echo "the module is in both packages"; exit 1; }

# Nothing is outside /usr, nothing is writable for others.
[ -z "$(find root -mindepth 1 -maxdepth 1 ! -name usr)" ]
[ -z "$(find root -perm /022 ! -type l)" ]
# The library's links lead to it.
[ -s root/usr/lib/libpscn.so ] || [ -s root/usr/lib/*/libpscn.so ]
