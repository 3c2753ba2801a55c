#!/bin/bash
# The numbers of `pscn compare` and of OpenImageIO's idiff on the same files. idiff prints six digits, so they agree when they
# differ by less than RELATIVE of themselves; pixels and counts agree exactly.
set -euo pipefail
RELATIVE=0.00001

command -v idiff >/dev/null || { echo "skipped: idiff is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export LC_ALL=C
scene=$PSCN_SOURCE_DIR/tests/cli/scenes/bent.pscn
render() { "$PSCN" render "$scene" --size 90x60 --quiet "$@"; }
render -o a.png
render -o b.png --samples 2
render -o c.png --bits 16 --samples 3
render -o a.exr
render -o b.exr --samples 2
render -o c.exr --bits 32 --channels rgb,u,normal
render -o d.exr --bits 32 --channels normal,u,rgb --samples 3

failed=0
# field NAME: what stands after "NAME error =" or the like in idiff's answer.
field() { sed -n "s/^ *$1  *= *\([0-9.e+-]*\).*/\1/p" idiff.out; }
ours() { sed -n "s/^$1  *\([0-9.e+-]*\).*/\1/p" ours.out; }
agree() {
  awk -v a="$2" -v b="$3" -v r=$RELATIVE 'BEGIN { d = a - b; m = a < 0 ? -a : a; exit !((d < 0 ? -d : d) <= r * m) }' ||
    { echo "$1: idiff $2, pscn $3"; failed=1; }
}
# check A B LIMIT
check() {
  local theirs=0 mine=0
  idiff -v -fail "$3" "$1" "$2" >idiff.out || theirs=1
  "$PSCN" compare "$1" "$2" --fail "$3" >ours.out 2>/dev/null || mine=1
  echo "$1 $2 $3: $(field 'Mean error') $(field 'RMS error') $(field 'Peak SNR') $(field 'Max error')"
  [ $theirs = $mine ] || { echo "one of them fails: idiff $theirs, pscn $mine"; failed=1; }
  agree mean "$(field 'Mean error')" "$(ours mean)"
  agree rms "$(field 'RMS error')" "$(ours rms)"
  agree psnr "$(field 'Peak SNR')" "$(ours psnr)"
  agree max "$(field 'Max error')" "$(ours max)"
  local place="$(sed -n 's/^ *Max error .*@ (\([0-9]*\), \([0-9]*\), \([^)]*\)).*/\1,\2 channel \3/p' idiff.out)"
  grep -q "at pixel $place:" ours.out || { echo "idiff's worst: $place"; failed=1; }
  local over="$(sed -n 's/^ *\([0-9]*\) pixels .* over .*/\1/p' idiff.out | tail -1)"
  [ "$over" = "$(sed -n 's/^over [0-9.e-]* *\([0-9]*\) pixels.*/\1/p' ours.out | tail -1)" ] ||
    { echo "idiff: $over pixels over $3"; failed=1; }
}

check a.png b.png 1e-6
check a.png b.png 0.02
check a.png c.png 0.1
check a.png b.png 1
check a.exr b.exr 1e-6
check b.exr a.exr 0.01
check c.exr d.exr 1e-6
for file in a.png b.exr c.exr; do
  idiff -fail 0 "$file" "$file" >/dev/null && "$PSCN" compare --fail 0 "$file" "$file" >/dev/null || failed=1
done
exit "$failed"
