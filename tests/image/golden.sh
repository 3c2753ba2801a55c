#!/bin/bash
# golden.sh SCENE: renders scenes/SCENE.pscn and compares it with golden/SCENE.png. With PSCN_UPDATE=1 the golden
# picture is made instead; look at it before committing it.
#
# A pixel is the mean of 2 x 2 samples. On another machine, or with another intersector, rounding may change a sample
# that grazes a silhouette or a shadow's edge. So a few pixels may differ; no other difference exceeds one code.
set -euo pipefail
EDGE_PERCENT=0.05 # of 19200 pixels: 9
ONE_CODE=1.5/255

scene=$1
golden=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/golden/$scene.png
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$PSCN_SOURCE_DIR/scenes" # the picture tells the scene's name, which is not to hold a folder of this machine
"$PSCN" render "$scene.pscn" -o "$folder/$scene.png" --size 160x120 --samples 2 --quiet
if [ "${PSCN_UPDATE:-}" = 1 ]; then
  cp "$folder/$scene.png" "$golden"
else
  "$PSCN" compare "$folder/$scene.png" "$golden" --fail $ONE_CODE --failpercent $EDGE_PERCENT
fi
