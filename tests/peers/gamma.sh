#!/bin/bash
# Versions of the language and assumed_gamma: the table of docs/povray.md, and pictures in which light is added up.
#
#   gamma.sh            compares pscn with POV-Ray, and both with docs/povray.md
#   gamma.sh --print    prints the table
. "${PSCN_SOURCE_DIR:=$(realpath "$(dirname "$0")/../..")}/tests/peers/begin.sh" povray oiiotool
LIMIT=0.1/255 # of 16 bits; POV-Ray's colours are floats
failed=0

# render BEGINNING SIZE OPTION...: the same scene by both
render() {
  { echo "$1"; cat rest; } >scene.pscn
  povray +Iscene.pscn +Opeer.png +W"${2%x*}" +H"${2#*x}" -D -A "${@:3}" >povray.log 2>&1 || { cat povray.log; exit 1; }
}

# A colour that fills the picture.
cat >rest <<'END'
camera { location <0, 0, -4> look_at 0 angle 20 }
background { rgb <0.5, 0.25, 0.1> }
END
commands=() names=()
while read -r version gamma; do
  start=''
  [ "$version" = none ] || start="#version $version;"
  [ "$gamma" = none ] || start="$start global_settings { assumed_gamma $gamma }"
  render "$start" 4x4
  mv peer.png "peer$version$gamma.png"
  "$PSCN" render scene.pscn -o "ours$version$gamma.png" --size 4x4 2>said
  for picture in peer ours; do commands+=("$picture$version$gamma.png" --ch R,G,B --printstats); done
  names+=("| $version | $gamma")
  if grep -q 'no #version' said; then echo "$version $gamma" >>warned; fi
done <<'END'
none none
3.6 none
3.7 none
none 1
3.6 1.8
3.7 2.2
3.7 srgb
none srgb
END
# The codes of each picture, by one program, which takes long to start.
oiiotool "${commands[@]}" | sed -n 's/.*Min: \(.*\) (.*/\1/p' | paste -d '|' - - | sed 's/|/ | /; s/$/ |/' >codes
paste -d '|' <(printf '%s \n' "${names[@]}") <(sed 's/^/ /' codes) >rows
if [ "${1:-}" = --print ]; then
  cat rows
  exit
fi
while IFS='|' read -r _ version gamma theirs ours; do
  [ "$theirs" = "$ours" ] || { echo "version$version, gamma$gamma:$theirs by POV-Ray,$ours by pscn"; failed=1; }
  awk -F'|' -v v="$version" -v g="$gamma" -v c="$theirs" \
    '$4 == c && index($2, v) && index($3, g) { found = 1 } END { exit !found }' "$PSCN_SOURCE_DIR/docs/povray.md" ||
    { echo "not in docs/povray.md: $version|$gamma|$theirs"; failed=1; }
done <rows
[ "$(cat warned)" = 'none none' ] || { echo "warned: $(cat warned)"; failed=1; }

# Two lights, highlights and all kinds of colours.
cat >rest <<'END'
camera { location <0.4, 0.3, -5> look_at 0 angle 40 }
light_source { <2, 3, -4>, COLOUR }
light_source { <-1, 2, -3>, rgb <0.2, 0.3, 0.9> }
bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3
  <-4, -3, 0>, <-4/3, -3, 0>, <4/3, -3, 0>, <4, -3, 0>, <-4, -1, 0>, <-4/3, -1, 0>, <4/3, -1, 0>, <4, -1, 0>,
  <-4, 1, 0>, <-4/3, 1, 0>, <4/3, 1, 0>, <4, 1, 0>, <-4, 3, 0>, <-4/3, 3, 0>, <4/3, 3, 0>, <4, 3, 0>
  pigment { PAINT } finish { ambient 0.2 diffuse 0.5 phong 0.3 specular 0.2 } }
END
# same COLOUR PAINT BEGINNING
same() { beside judge "$@"; }
judge() {
  sed "s/COLOUR/$1/; s/PAINT/$2/" ../rest >rest
  render "$3" 48x36 +FN16
  "$PSCN" render scene.pscn -o ours.png --size 48x36 --bits 16 --quiet
  "$PSCN" compare ours.png peer.png --fail $LIMIT --quiet || { echo "$3 $1 $2"; exit 1; }
}
for start in '' '#version 3.6;' '#version 3.6; global_settings { assumed_gamma 1.8 }' \
  '#version 3.7; global_settings { assumed_gamma 2.2 ambient_light rgb <0.5, 1, 2> }' \
  '#version 3.7; global_settings { assumed_gamma srgb } #version 3.5;' '#version 3.6; #version 3.7;' '#version version;'; do
  same 'rgb <1, 0.9, 0.8>' 'rgb <0.8, 0.5, 0.3>' "$start"
done
for gamma in 1 1.8; do
  start="#version 3.7; global_settings { assumed_gamma $gamma } #declare C = srgb <0.5, 0.25, 0.1>;"
  same 'srgb <1, 0.9, 0.8>*0.9' 'color srgb <0.8, 0.5, 0.3>' "$start"
  same 'srgbt <-0.2, 1.2, 0.5, 0> red 0.2' 'C*1.5' "$start"
  same 'srgbf <0.6, 0.5, 0.4, 0>' 'srgb C' "$start"
  same 'rgb C' 'color srgbft <0.6, 0.5, 0.4, 0, 0>' "$start"
done
all_right || failed=1
exit $failed
