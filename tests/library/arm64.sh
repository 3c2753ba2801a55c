#!/bin/bash
# arm64.sh ANSWERS: libpscn without the program, built for arm64 by a cross compiler, without any library for arm64 but
# libc, gives the same answers as ANSWERS, the program answers.c of this processor: other roundings of T, u and v by two units in
# the last place of 1 at most, for processors fuse multiplications and additions otherwise, and of the normal by 2^-44, as
# far as the last step of Newton's method may turn it (lanes/finish.c).
set -euo pipefail
for program in aarch64-linux-gnu-gcc qemu-aarch64; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed" >&2; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
launcher=()
! command -v ccache >/dev/null || launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache)
PKG_CONFIG=false cmake -S "$PSCN_SOURCE_DIR" -B "$folder/build" "${launcher[@]}" -DPSCN_PROGRAM=OFF -DPSCN_WERROR=ON \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc >"$folder/log" 2>&1 && cmake --build "$folder/build" >>"$folder/log" 2>&1 || {
  cat "$folder/log"
  exit 1
}
cmake --install "$folder/build" --prefix "$folder/installed" >/dev/null
library=$(find "$folder/installed" -name libpscn.a)
aarch64-linux-gnu-gcc -std=c17 -static -I"$PSCN_SOURCE_DIR/src" "$PSCN_SOURCE_DIR/tests/library/answers.c" "$library" -lm \
  -o "$folder/answers"
scenes=("$PSCN_SOURCE_DIR"/scenes/{teapot,wild,bent,degrees}.pscn)
"$1" "${scenes[@]}" >"$folder/here"
[ "$(grep -c '^[0-9] 1 [0-9]' "$folder/here")" -gt 100 ] || { echo "few rays hit anything"; exit 1; }
qemu-aarch64 "$folder/answers" "${scenes[@]}" >"$folder/there"
paste -d ' ' "$folder/here" "$folder/there" | awk '{
  wrong = NF % 2
  for (k = 1; k <= NF / 2; k++) {
    difference = $k - $(k + NF / 2)
    size = k == 3 && $k > 1 ? $k : 1
    if (difference < 0) difference = -difference
    if (difference > (k < 3 || k == 6 ? 0 : k > 6 ? 2 ^ -44 : size / 2 ^ 51)) wrong = 1
  }
  if (wrong) { print; failed = 1 }
} END { exit failed || NR != 1200 }'
