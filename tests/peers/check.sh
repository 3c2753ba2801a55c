#!/bin/bash
# `pscn check` against the installed POV-Ray: what it leaves behind, its exit codes, messages and limits, and that
# POV-Ray comes nearer with every step.
set -euo pipefail

command -v povray >/dev/null || { echo "skipped: povray is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export LC_ALL=C HOME=$folder/home TMPDIR=$folder/tmp
mkdir "$TMPDIR" "scenes and more"
scene="scenes and more/one.pscn"
failed=0
fail() { echo "$*"; failed=1; }
# expect CODE COMMAND...
expect() {
  local code=0 wanted=$1
  shift
  "$@" >out 2>err || code=$?
  [ "$code" -eq "$wanted" ] || { fail "exit code $code instead of $wanted: $*"; cat err; }
}

# Unguarded solver statements, in the scene and in what it includes; words in comments and strings; a branch for POV-Ray
# alone that includes a file of the scene's folder and one of POV-Ray's own.
cat >"$scene" <<'END'
#version 3.7; // solver newton
global_settings { assumed_gamma 1 solver aberth { start previous } }
camera { location <0.2, 1, -5> look_at 0 angle 40 }
light_source { <-3, 6, -6>, rgb 1 }
background { rgb <0.2, 0.3, 0.5> }
/* solver { */
#include "parts.inc"
#include "parts.inc"
#ifndef (pscn)
  #include "only povray.inc"
  #include "colors.inc"
  #declare Shade = Red;
#else
  #declare Shade = rgb <1, 0, 0>;
#end
object { Part translate 0.1*x }
object { Part rotate 90*z translate <-0.3, 0.2, 1> texture { pigment { color Shade } } }
END
cat >"scenes and more/parts.inc" <<'END'
#declare Part = bicubic_patch { type 1 flatness 0 u_steps 2 v_steps 2
  <-1, -1, 0>, <-0.3, -1, 0.5>, <0.3, -1, 0>, <1, -1, 0>, <-1, -0.3, 0>, <-0.3, -0.3, -2>, <0.3, -0.3, 0>, <1, -0.3, 0>,
  <-1, 0.3, 0>, <-0.3, 0.3, 0>, <0.3, 0.3, 1>, <1, 0.3, 0>, <-1, 1, 0>, <-0.3, 1, 0>, <0.3, 1, 0>, <1, 1, 0.6>
  texture { pigment { color rgb <0.9, 0.7, 0.2> } finish { phong 0.5 } } solver
  laguerre /* two
  lines */ { tolerance 1e-9 } translate 0 }
END
echo '#declare Nothing = 0;' >"scenes and more/only povray.inc"

expect 0 "$PSCN" check "$scene" --size 120x90 --steps 5 --failpercent 1 --failpsnr 30 --failmask 1
[ "$(ls | tr '\n' ' ')" = "err one-check out scenes and more tmp " ] || { fail "left here:"; ls; }
[ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }
for name in check.html check.json pscn.png povray.png povray-5.png difference.png difference-5.png; do
  [ -s "one-check/$name" ] || fail "there is no $name"
done
grep -q '^pscn: ' err && fail "errors were told"
# Each step is nearer than the one before, in the pictures and in the hits; u_steps 2 is the scene as it is written.
awk '$1 == "u_steps" && NF == 12 { if (steps++ && ($4 >= over || $7 <= psnr)) bad = 1; over = $4; psnr = $7 }
     $1 == "u_steps" && NF == 9 { if (rays++ && $7 >= median) bad = 1; median = $7 }
     END { exit bad || steps != 5 || rays != 5 }' out || { fail "POV-Ray does not come nearer:"; cat out; }
cmp -s one-check/povray.png one-check/povray-2.png || fail "the scene and its canonical text give POV-Ray two pictures"
"$PSCN" compare one-check/pscn.png one-check/povray-5.png --fail 1 --quiet || fail "the pictures cannot be compared"
"$PSCN" render "$scene" -o own.png --size 120x90 --quiet
"$PSCN" compare own.png one-check/pscn.png --fail 0 --quiet || fail "check's own picture is not render's"

# Every pixel over the limit lies on one kind of edge, or on none.
tr -d ' {}[]' <one-check/check.json | tr ',' '\n' | sed 's/"over://' | awk -F: '
  $1 == "\"over_limit_off_edges\"" || $1 == "\"crease\"" || $1 == "\"shadow\"" || $1 == "\"silhouette\"" { parts += $2 }
  $1 == "\"limit\"" { all += $2; rows++ } END { exit !(rows == 6 && all > 0 && all == parts) }' ||
  fail "the pixels over the limit are not those on edges and off them"

# Limits, one at a time, on a coarse picture.
coarse=(--size 60x45 --steps 0 --grid 0 -o limits --failpercent 100 --failpsnr 0 --failmask 100)
expect 0 "$PSCN" check "$scene" "${coarse[@]}"
for limit in '--failpercent 0.1' '--hardfail 0.1' '--failpsnr 60' '--failmask 0.01'; do
  expect 1 "$PSCN" check "$scene" "${coarse[@]}" $limit --quiet
  [ -s out ] && fail "--quiet says something"
  [ "$(wc -l <err)" -eq 1 ] || { fail "not one line is told of $limit:"; cat err; }
done

# POV-Ray's own word where it refuses, and options passed on.
expect 3 "$PSCN" check "$scene" --size 8x6 -o refused --povray-option +Knonsense
grep -q 'povray: .*command-line option' err || { fail "POV-Ray's message is not shown"; cat err; }
sed 's/#declare Shade = Red;/#error "not with POV-Ray"/' "$scene" >"scenes and more/two.pscn"
expect 3 "$PSCN" check "scenes and more/two.pscn" --size 8x6 -o refused
grep -q 'povray: .*scene.pov.*line 12' err || { fail "the line of the scene is not told"; cat err; }
[ ! -e refused ] || fail "a folder is left where nothing was found"
expect 0 "$PSCN" check "$scene" --size 60x45 --steps 0 --grid 0 -o quality --failpercent 100 --failpsnr 0 \
  --failmask 100 --povray-option +Q0 --quiet
cmp -s quality/povray.png limits/povray.png && fail "--povray-option changes nothing"

# What is the same is told to be the same, and what nobody hits has no distance; a name that needs care in a shell, in
# HTML and in a path of POV-Ray's; a scene that POV-Ray reads as one of an older version, with other colours, is told.
name="a 'name' & \"<more>\" ä"
mkdir "$name"
echo '#include "plain.inc"' >"$name/$name.pscn"
echo 'background { rgb <0.1, 0.5, 0.9> } bicubic_patch { type 1
  <1, 1, -9>, <2, 1, -9>, <3, 1, -9>, <4, 1, -9>, <1, 2, -9>, <2, 2, -9>, <3, 2, -9>, <4, 2, -9>,
  <1, 3, -9>, <2, 3, -9>, <3, 3, -9>, <4, 3, -9>, <1, 4, -9>, <2, 4, -9>, <3, 4, -9>, <4, 4, -9> }' >"$name/plain.inc"
for size in 1x1 700x2; do
  expect 0 "$PSCN" check "$name/$name.pscn" --size $size --steps 1
  awk '$1 == "u_steps" && NF == 12 { same = $7 == "inf" && $6 == "0/255" }
       $1 == "u_steps" && NF == 9 { none = $7 $8 $9 == "---" }
       END { exit !(same && none) }' out || { fail "not the same, or distances of nothing, at $size:"; cat out; }
  grep -q 'gamma_correction is turned off' err || { fail "POV-Ray's warning is not told"; cat err; }
  grep -q 'The pictures are the same' "$name-check/check.html" ||
    fail "the page does not say that the pictures are the same"
done
[ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }

# An interrupt ends POV-Ray too, and leaves nothing.
for signal in INT:130 TERM:143; do
  set -m # else the shell has the program ignore SIGINT
  "$PSCN" check "$scene" --size 2000x1500 -o interrupted --quiet 2>err &
  check=$!
  set +m
  for ((k = 0; k < 100; k++)); do ls "$TMPDIR"/pscn-*/scene.pov >/dev/null 2>&1 && break; sleep 0.1; done
  sleep 0.3
  kill -"${signal%:*}" "$check"
  code=0
  wait "$check" || code=$?
  [ "$code" -eq "${signal#*:}" ] || fail "exit code $code after SIG${signal%:*}"
  [ -z "$(ls -A "$TMPDIR")" ] || fail "an interrupt leaves files"
  [ ! -e interrupted ] || fail "an interrupt leaves a folder"
done
exit "$failed"
