# Rays and answers.
scene=$SCENES/flat.pscn
try pscn trace "$scene" </dev/null
printf '%s\n' '0 0 -4 0 0 1' '0.5 -0.25 3 0 0 -1' '0 0 -4 0 0 -1' '2 0 -4 0 0 1' '0.5 0.5 -4 0 0 1e-90' \
  '0.5 0.5 -4 0 0 1e90' '  +.5   5e-1 -4. 0 -0 2  ' '0.25 -0.5 -1 0 0 8' '1e-3 2e-3 -8 0 0 1' |
  try pscn trace "$scene"
# Lines may end with CR LF; the last one may have no end.
printf '0.5 0 -4 0 0 1\r\n0\t0.5 -4 0 0 1' | try pscn trace "$scene"
printf '\xef\xbb\xbf# two rays\n\n0.5, 0, -4, 0, 0, 1\n0,0.5,-4 0 0 1 # the second\n' >rays
try pscn trace "$scene" rays
try pscn trace - rays <"$scene"
# Text and binary give the same hits.
printf '0.5 0 -4 0 0 1\n9 0 -4 0 0 1\n' | pscn trace "$scene" --solver aberth
zero='\0\0\0\0\0\0\0\0' half='\0\0\0\0\0\0\340\077' one='\0\0\0\0\0\0\360\077'
nine='\0\0\0\0\0\0\042\100' minus_four='\0\0\0\0\0\0\020\300'
printf "$half$zero$minus_four$zero$zero$one" >one
printf "$nine$zero$minus_four$zero$zero$one" >two
cat one two | pscn trace "$scene" --binary | LC_ALL=C od -A n -v -t f8 -w56 | sed 's/  */ /g'
# With what is proven and what is not: the border of an open surface.
printf '0.5 0 -4 0 0 1\n9 0 -4 0 0 1\n1 0 -4 0 0 1\n' | pscn trace "$scene" --certainty
cat one two | pscn trace "$scene" --binary --certainty | LC_ALL=C od -A n -v -t f8 -w64 | sed 's/  */ /g'
# All hits: across two sheets and one that lies on the second; beside them; along an open border; from between them.
patch() { # Z
  echo "bicubic_patch { type 1 flatness 0 u_steps 1 v_steps 1"
  for u in 0 1 2 3; do for v in 0 1 2 3; do echo "<$u, $v, $1>$([ $u$v = 33 ] || echo ,)"; done; done
  echo "pigment { color rgb 1 } }"
}
(sed -n '/^camera/p;/^light/p' "$scene"; patch 2; patch 1; patch 2) >sheets.pscn
printf '%s\n' '1.5 0.75 0 0 0 2' '9 0 0 0 0 1' '3 1 0 0 0 1' '1.5 0.75 1.5 0 0 1' '1.5 0.75 1 0 0 1' |
  try pscn trace --all sheets.pscn
printf '3 1 1.5 0 0 1\n' | pscn trace --all --certainty sheets.pscn
printf "$half$zero$minus_four$zero$zero$one" | pscn trace "$scene" --binary --all | LC_ALL=C od -A n -v -t f8 -w72 |
  sed 's/  */ /g'
cat one two | pscn trace "$scene" --binary --all --certainty | LC_ALL=C od -A n -v -t f8 -w80 | sed 's/  */ /g'
# Each answer comes before more input is read.
mkfifo ask tell
dialogue() { # WHAT COMMAND...: writes `one` and `two` in turn, and waits in between for $1 to have read an answer
  local listen=$1
  shift
  pscn trace "$scene" "$@" <ask >tell &
  exec 3>ask 4<tell
  for ray in one two; do
    cat $ray >&3
    $listen <&4 || echo "no answer"
  done
  exec 3>&- 4<&-
  wait
}
line() { timeout 100 head -n 1; }
record() { timeout 100 head -c 56 | LC_ALL=C od -A n -v -t f8 -w56 | sed 's/  */ /g'; }
dialogue record --binary
echo '0 0 -4 0 0 1' >one
echo '9 0 -4 0 0 1' >two
dialogue line
# A grazing answer is the same in a packet and alone.
pscn trace "$SCENES/tangled.pscn" <"$SCENES/tangled.rays" | sed -n 5p >among
sed -n 5p "$SCENES/tangled.rays" | pscn trace "$SCENES/tangled.pscn" >alone
cmp among alone && cut -d ' ' -f 1,5 alone
# A corner met exactly is a given point. Among all hits it is one of an open surface.
for all in '' --all; do printf '1 1 -4 0 0 1\n1.0000000000000002 1 -4 0 0 1\n' | pscn trace "$scene" --certainty $all; done
printf "$one$one$minus_four$zero$zero$one" | pscn trace "$scene" --binary --all | LC_ALL=C od -A n -v -t f8 -w16 |
  sed 's/  */ /g;q'
# From end to end of what a ray's numbers may be.
(sed -n '/^camera/p;/^light/p' "$scene"; patch 1 | sed 's/pigment/scale 1e99 pigment/') >huge.pscn
printf '%s\n' '-9e99 -9e99 -9e99 0.915 0.9075 0.91' '0 0 -1e99 1.5 0.75 2' '-1e100 -1e100 -1e100 1 1 1' |
  pscn trace huge.pscn --certainty | cut -d ' ' -f 1,2,9
# A ray that was asked once more, alone, is counted by its final answer.
for all in '' --all; do
  printf '0 0.6 0 0 0.41954981558864002 0\n0 0.6 0 -0.0024937655860348684 0.41954981558864002 0\n' |
    pscn trace "${0%/*}/../../scenes/inside.pscn" $all --certainty --stats - | grep -o 'certain$\|"certain".*\|"grazing".*'
done
