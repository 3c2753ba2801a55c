#!/bin/bash
# The numbers of `pscn compare` and of OpenImageIO's idiff on the same files. idiff prints six digits, so numbers agree
# if they differ by less than RELATIVE of themselves; pixels and counts agree exactly.
RELATIVE=0.00001
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" idiff oiiotool
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
# field NAME: the value after "NAME error =" and the like in idiff's answer.
field() { sed -n "s/^ *$1  *= *\([0-9.e+-]*\).*/\1/p" idiff.out; }
ours() { sed -n "s/^$1  *\([0-9.e+-]*\).*/\1/p" ours.out; }
agree() {
  awk -v a="$2" -v b="$3" -v r=$RELATIVE 'BEGIN {
    d = a - b; m = a < 0 ? -a : a
    exit !(a != "" && b != "" && (d < 0 ? -d : d) <= r * m) }' ||
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
  local place over
  place=$(sed -n 's/^ *Max error .*@ (\([0-9]*\), \([0-9]*\), \([^)]*\)).*/\1,\2 channel \3/p' idiff.out)
  grep -q "at pixel $place:" ours.out || { echo "idiff's worst: $place"; failed=1; }
  over=$(sed -n 's/^ *\([0-9]*\) pixels .* over .*/\1/p' idiff.out | tail -1)
  [ -n "$over" ] && [ "$over" = "$(sed -n 's/^over [0-9.e-]* *\([0-9]*\) pixels.*/\1/p' ours.out | tail -1)" ] ||
    { echo "idiff: $over pixels over $3"; failed=1; }
}

check a.png b.png 1e-6
check a.png b.png 0.02
check a.png c.png 0.1
check a.png b.png 1
check a.exr b.exr 1e-6
check b.exr a.exr 0.01
check c.exr d.exr 1e-6
# Other depths, a single channel, negative and large values; channels in another order.
oiiotool a.png --ch R -o gray_a.png
oiiotool b.png --ch R -o gray_b.png
render -o b16.png --bits 16 --samples 2
render -o plain.exr --bits 32
oiiotool plain.exr --mulc -1 -o negative.exr
oiiotool plain.exr --mulc 7 -o large.exr
oiiotool b.exr --ch B,G,R -o turned.exr
check gray_a.png gray_b.png 0.02
check a.png c.png 0.001
check b16.png c.png 0.01
check b.png b16.png 0.001
check negative.exr plain.exr 0.5
check large.exr plain.exr 0.5
check plain.exr b.exr 0.01
# Formats that pscn reads and never writes; others are refused.
oiiotool a.png -o a.tif
oiiotool a.png -o a.jpg
oiiotool a.png -o a.ppm
check a.tif b.png 0.02
check a.jpg b.png 0.02
"$PSCN" compare a.ppm a.ppm 2>ours.err && { echo "a.ppm was read"; failed=1; }
grep -q "'a.ppm': it is not a PNG, EXR, TIFF or JPEG" ours.err || { echo "a.ppm: $(cat ours.err)"; failed=1; }
# verdict CODE A B: pscn's answer. idiff's is named where it differs.
verdict() {
  local code=0
  "$PSCN" compare "$2" "$3" >ours.out 2>ours.err || code=$?
  [ "$code" -eq "$1" ] || { echo "$2 and $3: exit code $code instead of $1"; cat ours.err; failed=1; }
}
for value in nan inf 0.1; do
  oiiotool --pattern constant:color=$value,0.5,0.5 9x7 3 -d float -o $value.exr
done
verdict 0 turned.exr b.exr
verdict 0 nan.exr nan.exr
verdict 0 inf.exr inf.exr
verdict 1 nan.exr 0.1.exr # the same to idiff
verdict 1 inf.exr 0.1.exr
grep -q '63 pixels by more than 1e-06, the most by inf' ours.err ||
  { echo "infinities are not counted:"; cat ours.err; failed=1; }
verdict 1 gray_a.png a.png # idiff takes what is missing for 0
grep -q "has no channel" ours.err || failed=1
verdict 1 a.png 0.1.exr
grep -q "has 90x60 pixels, '0.1.exr' has 9x7" ours.err || failed=1
head -c 700 a.png >cut.png
verdict 4 cut.png a.png # idiff reads on
verdict 4 nothing.png a.png
# What is not read is not compared: further pictures in a file, which idiff only mentions, and channels whose names
# would be cut to one.
oiiotool 0.1.exr nan.exr --siappend -o two.exr
oiiotool a.png b.png --siappend -o two.tif
long=$(printf 'n%.0s' {1..63})
for value in nan 0.1; do oiiotool $value.exr --chnames ${long}1,${long}2,${long}3 -o long-$value.exr; done
for file in two.exr two.tif long-nan.exr; do verdict 4 $file $file; cat ours.err; done >refused
[ "$(grep -c 'it has several pictures\|name of more than 63 bytes' refused)" = 3 ] || { cat refused; failed=1; }
oiiotool 0.1.exr --chnames "${long%n}1,${long%n}2,${long%n}3" -o named.exr
verdict 0 named.exr named.exr
oiiotool 0.1.exr --ch 0 --chnames "$long" -o lone.exr
"$PSCN" compare lone.exr lone.exr --channels "$long" --quiet || { echo "a name of 63 bytes"; failed=1; }
"$PSCN" compare lone.exr lone.exr --channels "${long}n" --quiet 2>/dev/null && { echo "a name of 64 bytes"; failed=1; }
# Stored colours differ, whatever opacity (to idiff they are the same) or black ink says.
for k in 0 1; do
  for format in png tif; do
    oiiotool --pattern constant:color=$k,0,0,0 9x7 4 --attrib oiio:UnassociatedAlpha 1 -d uint8 -o clear$k.$format
  done
  oiiotool --pattern constant:color=$k,$k,$k,1 9x7 4 --chnames C,M,Y,K --attrib oiio:ColorSpace CMYK -d uint8 -o ink$k.tif
done
verdict 1 clear0.png clear1.png
verdict 1 clear0.tif clear1.tif
verdict 1 ink0.tif ink1.tif
for file in a.png b.exr c.exr; do
  idiff -fail 0 "$file" "$file" >/dev/null && "$PSCN" compare --fail 0 "$file" "$file" >/dev/null || failed=1
done
exit "$failed"
