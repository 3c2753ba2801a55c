#!/bin/bash
# folders.sh: installs libraries and headers in folders with absolute paths, outside the prefix. pscn.pc names them
# unchanged, and the program looks for its modules there. A module of another build is no crash, and no library of the
# system is taken from the modules' folder. If one tree holds several builds, each has its module where its program looks for it.
set -euo pipefail
command -v pkg-config >/dev/null || { echo "skipped: pkg-config is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake -S "$PSCN_SOURCE_DIR" -B "$folder/build" -DCMAKE_INSTALL_PREFIX="$folder/prefix" -DCMAKE_INSTALL_LIBDIR="$folder/lib64" \
  -DCMAKE_INSTALL_INCLUDEDIR="$folder/headers" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
said=$(PKG_CONFIG_PATH=$folder/build/src/packaging pkg-config --cflags --libs pscn | sed 's/ *$//')
[ "$said" = "-I$folder/headers -L$folder/lib64 -lpscn" ] || { echo "pscn.pc says: $said"; exit 1; }
grep -F PSCN_MODULE_FOLDERS "$folder/build/compile_commands.json" | grep -F "../lib/pscn" | grep -qF "$folder/lib64/pscn" || { echo "the program does not look in $folder/lib64"; exit 1; }

mkdir -p "$folder/moved/bin" "$folder/moved/lib/pscn"
cp "$PSCN" "$folder/moved/bin/pscn"
echo 'char image_module[64] = {1};' | cc -shared -fPIC -x c - -o "$folder/moved/lib/pscn/pscn_openimageio.so"
for library in libc.so.6 libm.so.6; do echo "no library" >"$folder/moved/lib/pscn/$library"; done
status=0
"$folder/moved/bin/pscn" render "$PSCN_SOURCE_DIR/scenes/dome.pscn" --size 4x3 -o "$folder/a.exr" 2>"$folder/said" || status=$?
[ "$status" = 4 ] && grep -q "is of another build" "$folder/said" || { echo "another module: exit $status, $(cat "$folder/said")"; exit 1; }

command -v ninja >/dev/null || exit 0
cmake -S "$PSCN_SOURCE_DIR" -B "$folder/many" -G "Ninja Multi-Config" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
for file in command/pscn lib/pscn/pscn_openimageio.so; do
  grep -q "^build src/Release/$file" "$folder/many/CMakeFiles/impl-Release.ninja" || { echo "several builds: no src/Release/$file"; exit 1; }
done
