#!/bin/bash
# solvers.sh SCENE: every other solver gives the default one's picture, to one code of 8 bits in every pixel.
set -euo pipefail
ONE_CODE=1.000001/255 # as read back in floats

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
render() { "$PSCN" render "$PSCN_SOURCE_DIR/scenes/$1.pscn" --size 200x150 --quiet "${@:2}"; }
render "$1" -o "$folder/default.png"
for solver in aberth newton laguerre \
  'aberth { start previous }' 'aberth { basis power }' 'aberth { split 1 }'; do
  render "$1" -o "$folder/other.png" --solver "$solver"
  echo "$solver"
  "$PSCN" compare "$folder/default.png" "$folder/other.png" --fail $ONE_CODE --quiet
done
