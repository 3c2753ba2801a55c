#!/bin/bash
# The teapot turns: a shell loop over one number that is declared to the scene makes an animation.
#
#   examples/turning_teapot.sh [FRAMES] [FOLDER] [OPTION...]     options of pscn render, such as --size 400x300
#
# Writes FOLDER/0001.png and so on (24 frames into ./turning), and FOLDER/teapot.mp4 where ffmpeg is installed.
set -euo pipefail
frames=${1:-24} folder=${2:-turning}
shift $(($# < 2 ? $# : 2))
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../scenes" && pwd)
pscn=${PSCN:-$scenes/../build/src/command/pscn}

mkdir -p "$folder"
# The scene's own camera, on a turntable.
{
  echo '#ifndef (Turn) #declare Turn = 0; #end'
  sed '/^camera {/,/^}/ s/^}/  rotate Turn*y\n}/' "$scenes/teapot.pscn"
} >"$folder/turning.pscn"
for ((frame = 0; frame < frames; frame++)); do
  turn=$(LC_ALL=C awk "BEGIN { print 360 * $frame / $frames }")
  "$pscn" render "$folder/turning.pscn" --declare "Turn=$turn" --quiet "$@" -o "$folder/$(printf %04d $((frame + 1))).png"
done
if command -v ffmpeg >/dev/null; then
  ffmpeg -loglevel error -y -framerate 24 -i "$folder/%04d.png" -pix_fmt yuv420p "$folder/teapot.mp4"
fi
