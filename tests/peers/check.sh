#!/bin/bash
# `pscn check` against the installed POV-Ray: the files it leaves, its exit codes, messages and limits; that POV-Ray
# comes nearer with every step; that no scene can do harm through it. check.sh answers|limits|names|harm: a part of
# that, since POV-Ray sleeps half a second in each run.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
export HOME=$folder/home TMPDIR=$folder/tmp
any=(--failpercent 100 --failpsnr 0 --failmask 100) # no limit
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

# Unguarded solver statements, in the scene and in an include file; words in comments and strings; a name to which
# POV-Ray adds .inc; a branch only for POV-Ray that includes a file of the scene's folder and one of POV-Ray's own.
cat >"$scene" <<'END'
#version 3.7; // solver newton
global_settings { assumed_gamma 1 ambient_light rgb 0.1 solver aberth { start previous } }
camera { location <0.2, 1, -5> look_at 0 angle 40 }
light_source { <-3, 6, -6>, rgb 1 }
background { rgb <0.7, 0.3, 0.5> }
/* solver { */
#include "parts.inc"
#include "parts"
#ifndef (pscn)
  #include "only povray.inc"
  #include "colors.inc"
  #declare Shade = Red;
#else
  #declare Shade = rgb <1, 0, 0>;
#end
#ifdef (Beside) #include "beside.inc" #end
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
echo '#error "parts.inc is found first"' >"scenes and more/parts"
mkdir "scenes and more/beside"
echo 'global_settings { solver newton } background { rgb Beside + clock }' >"scenes and more/beside/beside.inc"

answers() {
  expect 0 "$PSCN" check "$scene" --size 120x90 --steps 4 --failpercent 2 --failpsnr 25 --failmask 2
  [ "$(ls | tr '\n' ' ')" = "err one-check out scenes and more tmp " ] || { fail "left here:"; ls; }
  [ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }
  for name in check.html check.json pscn.png povray.png povray-4.png difference.png difference-4.png; do
    [ -s "one-check/$name" ] || fail "there is no $name"
  done
  grep -q '^pscn: ' err && fail "errors were told"
  # Each step is nearer than the one before, in the pictures and in the hits. u_steps 2 is the scene as written.
  awk '$1 == "u_steps" && NF == 12 { if (steps++ && ($4 >= over || $7 <= psnr)) bad = 1; over = $4; psnr = $7 }
       $1 == "u_steps" && NF == 9 { if (rays++ && $7 >= median) bad = 1; median = $7 }
       END { exit bad || steps != 4 || rays != 4 }' out || { fail "POV-Ray does not come nearer:"; cat out; }
  cmp -s one-check/povray.png one-check/povray-2.png || fail "the scene and the same steps give two pictures"
  # The dump gives the picture of the scene as written: without solver statements, with the includes of POV-Ray's branch.
  expect 0 "$PSCN" check "$scene" --size 120x90 --steps 0 --grid 0 -o dumped "${any[@]}" --dump
  cmp -s dumped/povray.png one-check/povray.png || fail "the dump gives another picture"
  grep -q 'that text for the first row, too: --dump' dumped/check.html || fail "the page does not say what POV-Ray read"
  # It finds declared names and included files as the scene does.
  given=(--declare Beside=0.125 --clock 0.25 -I "scenes and more/beside" --size 24x18 --steps 0 --grid 0 "${any[@]}")
  expect 0 "$PSCN" check "$scene" "${given[@]}" -o dumped --dump
  expect 0 "$PSCN" check "$scene" "${given[@]}" -o own
  cmp -s own/povray.png dumped/povray.png || fail "the scene's file is read with other numbers or files"
  "$PSCN" compare one-check/pscn.png one-check/povray-4.png --fail 1 --quiet || fail "the pictures cannot be compared"
  "$PSCN" render "$scene" -o own.png --size 120x90 --quiet
  "$PSCN" compare own.png one-check/pscn.png --fail 0 --quiet || fail "check's own picture is not render's"

  # Every pixel over the limit lies on one kind of edge, or on none.
  tr -d ' {}[]' <one-check/check.json | tr ',' '\n' | sed 's/"over://' | awk -F: '
    $1 ~ /^"(over_limit_off_edges|crease|shadow|silhouette)"$/ { parts += $2 }
    $1 == "\"limit\"" { all += $2; rows++ } END { exit !(rows == 5 && all > 0 && all == parts) }' ||
    fail "the pixels over the limit are not those on edges and off them"
}

limits() {
  # Limits, one at a time, on a coarse picture.
  coarse=(--size 60x45 --steps 0 --grid 0 -o limits "${any[@]}")
  expect 0 "$PSCN" check "$scene" "${coarse[@]}"
  for limit in '--failpercent 0.1' '--hardfail 0.1' '--failpsnr 60' '--failmask 0.01'; do
    expect 1 "$PSCN" check "$scene" "${coarse[@]}" $limit --quiet
    [ -s out ] && fail "--quiet says something"
    [ "$(wc -l <err)" -eq 1 ] || { fail "not one line is told of $limit:"; cat err; }
  done

  # If one file cannot be written, all results of an earlier check stay, and nothing else.
  local sum
  rm limits/check.html && mkdir limits/check.html
  sum=$(cksum limits/*.png)
  expect 4 "$PSCN" check "$scene" "${coarse[@]}"
  [ "$sum" = "$(cksum limits/*.png)" ] && [ "$(ls -A limits | wc -l)" -eq 5 ] || fail "an earlier check is lost"

  # POV-Ray's own message if it refuses, and options passed on.
  expect 3 "$PSCN" check "$scene" --size 8x6 -o refused --povray-option +Knonsense
  grep -q 'povray: .*command-line option' err || { fail "POV-Ray's message is not shown"; cat err; }
  sed 's/#declare Shade = Red;/#error "not with POV-Ray"/' "$scene" >"scenes and more/two.pscn"
  expect 3 "$PSCN" check "scenes and more/two.pscn" --size 8x6 -o refused
  grep -q 'povray: .*scene.pov.*line 12' err || { fail "the line of the scene is not told"; cat err; }
  [ ! -e refused ] || fail "a folder is left where nothing was found"
  expect 0 "$PSCN" check "$scene" --size 60x45 --steps 0 --grid 0 -o quality "${any[@]}" --povray-option +Q0 --quiet
  ! cmp -s quality/povray.png limits/povray.png || fail "--povray-option changes nothing"
}

names() {
  # Equal pictures are called equal, and where nothing is hit there is no distance. A name that needs quoting in a
  # shell, in HTML and in POV-Ray's paths.
  name="a 'name' & \"<more>\" ä"
  mkdir "$name"
  echo '#include "plain.inc"' >"$name/$name.pscn"
  echo 'background { rgb <0.1, 0.5, 0.9> } bicubic_patch { type 1
    <1, 1, -9>, <2, 1, -9>, <3, 1, -9>, <4, 1, -9>, <1, 2, -9>, <2, 2, -9>, <3, 2, -9>, <4, 2, -9>,
    <1, 3, -9>, <2, 3, -9>, <3, 3, -9>, <4, 3, -9>, <1, 4, -9>, <2, 4, -9>, <3, 4, -9>, <4, 4, -9> }' >"$name/plain.inc"
  for size in 1x1 700x2; do
    expect 0 "$PSCN" check "$name/$name.pscn" --size $size --steps 1
    awk '$1 == "u_steps" && NF == 12 { same = $7 == "inf" && $6 == "0/255" }
         $1 == "u_steps" && NF == 9 { none = $6 == 0 && $7 $8 $9 == "---" }
         END { exit !(same && none) }' out || { fail "not the same, or distances of nothing, at $size:"; cat out; }
    grep -q '<td>&infin;</td>' "$name-check/check.html" || fail "the page does not say that the pictures are the same"
  done
  [ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }

  # A pipe is read once. A name that is not UTF-8 is shown as UTF-8. Steps of an earlier check are removed.
  expect 0 "$PSCN" check <(cat "$name/plain.inc") --size 9x9 --steps 1 --grid 0 -o again
  grep -q 'not a file that can be read again' again/check.html || fail "the page does not say that POV-Ray read the dump"
  odd=$(printf 'odd\xff\x1b[31m<b>')
  cp "$name/plain.inc" "$odd.pscn"
  expect 0 "$PSCN" check "$odd.pscn" --size 9x9 --steps 0 --grid 0 -o again
  grep -q "$(printf '[\x1b]')" out && fail "a name sends escapes"
  grep -q 'odd\\xff\\x1b\[31m&lt;b&gt;' again/check.html && grep -q 'odd\\xff\\x1b' out ||
    fail "a name is not shown printable"
  [ "$(ls again | tr '\n' ' ')" = "check.html check.json difference.png povray.png pscn.png " ] ||
    { fail "an earlier check is left:"; ls again; }
}

harm() {
  # Text that only POV-Ray would read does no harm: if it could read or write files, it is not read; it puts no escapes
  # on the terminal, and takes no endless time or memory.
  sed -e '/#include "only/d; s/#include "colors.inc"/#include "evil.inc"/; s/Shade = Red/Shade = rgb <1, 0, 0>/' \
    "$scene" >"scenes and more/evil.pscn"
  evil() { printf '%s\n' "$@" >"scenes and more/evil.inc"; }
  quick=(--size 8x6 --steps 0 --grid 0 -o evil "${any[@]}")
  mkdir -p "$HOME"
  evil "#fopen F \"$folder/written\" write" '#write (F, "x")' '#error "title"'
  expect 0 "$PSCN" check "scenes and more/evil.pscn" "${quick[@]}"
  grep -q "#fopen in 'scenes and more/evil.inc' could read or write files" err || { fail "nothing is told of a file"; cat err; }
  grep -q '#fopen in .*evil.inc.* could read or write files' evil/check.html || fail "the page tells nothing of a file"
  [ ! -e "$folder/written" ] && ! grep -q title err || fail "POV-Ray reads what was not for it"
  evil '#include concat ("/etc/pass", "wd")'
  expect 0 "$PSCN" check "scenes and more/evil.pscn" "${quick[@]}"
  grep -q '#include concat in' err || { fail "nothing is told of an included file"; cat err; }
  evil '#error "\u001b]0;title"'
  expect 3 "$PSCN" check "scenes and more/evil.pscn" "${quick[@]}"
  grep -q title err || { fail "POV-Ray did not read the file"; cat err; }
  LC_ALL=C grep -q "$(printf '[\x1b\x07]')" err && fail "a scene sends escapes"
  evil '#while (1)' '#end'
  expect 5 "$PSCN" check "scenes and more/evil.pscn" "${quick[@]}" --timeout 1
  grep -q 'more than 1 seconds' err || { fail "the time limit is not told"; cat err; }
  evil '#declare A = array[1000000];' '#declare K = 0;' '#declare S = "x"' '#while (K < 1000000)' \
    '#declare S = concat(S, "0123456789abcdef")' '#declare A[K] = S;' '#declare K = K + 1;' '#end'
  expect 3 "$PSCN" check "scenes and more/evil.pscn" "${quick[@]}" --timeout 20 --max-memory 300M
  [ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }

  # If the reader of our messages goes away, the program ends, and leaves nothing either.
  { "$PSCN" check "$scene" --size 8x6 --steps 0 -o evil 2>&1 || echo "$?" >code; } | sed q >/dev/null
  [ "$(cat code)" = 141 ] || fail "exit code $(cat code) where nobody reads"
  [ -z "$(ls -A "$TMPDIR")" ] || { fail "left in the temporary folder:"; ls "$TMPDIR"; }

  # An interrupt also ends POV-Ray, and leaves nothing.
  evil '#while (1)' '#end'
  for signal in INT:130 TERM:143 KILL:137; do
    set -m # else the shell has the program ignore SIGINT
    "$PSCN" check "scenes and more/evil.pscn" --size 8x6 -o interrupted --quiet 2>err &
    check=$!
    set +m
    for ((k = 0; k < 100; k++)); do ls "$TMPDIR"/pscn-*/run/scene.pov >/dev/null 2>&1 && break; sleep 0.1; done
    sleep 0.2
    kill -"${signal%:*}" "$check"
    code=0
    wait "$check" 2>/dev/null || code=$?
    [ "$code" -eq "${signal#*:}" ] || fail "exit code $code after SIG${signal%:*}"
    sleep 0.1
    ! grep -lsa "$TMPDIR" /proc/[0-9]*/environ | sed 's/environ/comm/' | xargs -r cat 2>/dev/null | grep povray ||
      fail "POV-Ray is still there after SIG${signal%:*}"
    [ "$signal" = KILL:137 ] && continue
    [ -z "$(ls -A "$TMPDIR")" ] || fail "an interrupt leaves files"
    [ ! -e interrupted ] || fail "an interrupt leaves a folder"
  done
}

"$1"
exit "$failed"
