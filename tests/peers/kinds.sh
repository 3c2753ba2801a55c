#!/bin/bash
# The kinds of POV-Ray files that hold patches, and how each is treated: the table of docs/povray.md. tests/peers/kinds
# has small files of the forms that exporters write; POV-Ray's own files are read if installed. A file that is read
# gives POV-Ray's picture, as nearly as its triangles can.
#
#   kinds.sh            compares with docs/povray.md
#   kinds.sh --print    prints the first two columns of the table
. "${PSCN_SOURCE_DIR:=$(realpath "$(dirname "$0")/../..")}/tests/peers/begin.sh" zcat
here=$PSCN_SOURCE_DIR/tests/peers/kinds
debian=/usr/share/doc/povray/examples
failed=0

# outcome FILE: "read, N patches", or "refused: " and the first words of the reason.
outcome() {
  if "$PSCN" render "$1" -o x.png --size 1x1 --quiet --stats x.json 2>said; then
    sed -n 's/.*"patches": \([0-9]*\).*/read, \1/p' x.json
    return
  fi
  printf 'refused: '
  sed -n "s/.*error: POV-Ray's \(#*[a-z_0-9]*\)[^;]* is not supported.*/\`\1\`/p; s/.*error: expected a number.*/other/p
    s/.*error: '\([A-Za-z_0-9]*\)' is not declared.*/\`\1\`/p;
    s/.*\(transpar[a-z]*\).*/transparency/p" said | awk '!seen[$0]++' |
    head -4 | paste -sd, | sed 's/,/, /g'
}

row() { # NAME FILE
  printf '| %s | %s |\n' "$1" "$(outcome "$2")"
}
rows() {
  for file in "$here"/*; do row "$(basename "$file")" "$file"; done
  [ -d $debian ] || return 0
  for file in templates/Non_CSG_shapes/08_bicubic_patch.txt advanced/teapot/teapot.inc advanced/teapot/teapot.pov \
    objects/bezier.pov objects/primitiv.pov advanced/cliche/cliche.pov portfolio/allobjects.pov; do
    if [ -e "$debian/$file.gz" ]; then zcat "$debian/$file.gz" >"$folder/$(basename $file)"
    else cp "$debian/$file" "$folder/"; fi
  done
  for name in 08_bicubic_patch.txt teapot.inc teapot.pov bezier.pov primitiv.pov cliche.pov allobjects.pov; do
    row "$name" "$folder/$name"
  done
}

rows >rows
if [ "${1:-}" = --print ]; then
  cat rows
  exit
fi
while read -r line; do
  grep -Fq "$line" "$PSCN_SOURCE_DIR/docs/povray.md" || { echo "not in docs/povray.md: $line"; failed=1; }
done <rows

command -v povray >/dev/null || { echo "skipped: povray is not installed" >&2; [ $failed = 0 ] && exit 77 || exit 1; }
same() {
  local name=$1
  cp "$here/$name" .
  {
    echo '#version 3.7; global_settings { assumed_gamma 1 }'
    grep -q '^camera' "$name" || echo 'camera { location <1.5, 2.6, -3.4> look_at 0 angle 50 }
      light_source { <-3, 5, -4>, rgb 1 } background { rgb <0.1, 0.2, 0.3> }
      #default { texture { pigment { rgb <0.6, 0.7, 0.8> } } }'
    echo "#include \"$name\""
  } >scene.pscn
  "$PSCN" check scene.pscn --size 80x60 --steps 0 --grid 0 --failpercent 8 --failpsnr 25 --failmask 3 -o page \
    >checked 2>&1 || { echo "$name:"; cat checked; exit 1; }
  "$PSCN" render scene.pscn -o x.png --size 80x60 --quiet --stats x.json
  [ "$(sed -n 's/.*"accepted": \([0-9]*\).*/\1/p' x.json)" -gt 100 ] || { echo "$name: nothing is seen"; exit 1; }
}
for name in $(sed -n 's/^| \([^ ]*\) | read.*/\1/p' rows); do [ ! -e "$here/$name" ] || beside same "$name"; done
all_right || failed=1
exit $failed
