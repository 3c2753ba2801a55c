#!/bin/bash
# The same scene with coordinates times powers of ten, up to the ends of the range of a scene: the same picture, within
# one code of 8 bits, and every answer certain. A coordinate beyond the range is an error of the scene.
set -euo pipefail
ONE_CODE=1.000001/255 # as read back in floats
SIZE=80x60
FACTORS=(1e-98 1e-60 1e-20 1e20 1e60 1e98)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# The scene of bent.pscn with every point times $1.
write_scene() {
  sed -E "s/^( *location)(.*)/\1 $1 *\2/; s/^( *look_at)(.*)/\1 $1 *\2/
    s/light_source \{ *(<[^>]*>)/light_source { $1 * \1/
    s/^( +)(<-?[0-9].*)/\1\2/; /^  <-?[0-9]/s/</$1 * </g" "$PSCN_SOURCE_DIR/scenes/bent.pscn"
}

certain_share() { awk -F'[:,]' '/"certain"/ { print $2 + 0 }' "$1"; }

write_scene 1 >"$folder/one.pscn"
"$PSCN" render "$folder/one.pscn" --size $SIZE --quiet -o "$folder/one.png"
"$PSCN" render "$PSCN_SOURCE_DIR/scenes/bent.pscn" --size $SIZE --quiet -o "$folder/bent.png"
"$PSCN" compare "$folder/bent.png" "$folder/one.png" --fail 1e-9 --quiet
for factor in "${FACTORS[@]}"; do
  echo "times $factor"
  write_scene "$factor" >"$folder/other.pscn"
  "$PSCN" render "$folder/other.pscn" --size $SIZE --quiet -o "$folder/other.png" --stats "$folder/stats"
  "$PSCN" compare "$folder/one.png" "$folder/other.png" --fail $ONE_CODE --quiet
  [ "$(certain_share "$folder/stats")" = $((${SIZE%x*} * ${SIZE#*x})) ]
done

echo "times 1e100"
write_scene 1e100 >"$folder/other.pscn"
status=0
"$PSCN" render "$folder/other.pscn" --size $SIZE --quiet -o "$folder/none.png" 2>"$folder/errors" || status=$?
[ "$status" = 3 ] && grep -q 'larger than 1e100' "$folder/errors"
[ ! -e "$folder/none.png" ]
