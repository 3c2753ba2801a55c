#!/bin/bash
# The example that turns the teapot makes a picture a frame: the first is the scene's own, the second differs; and a
# film if ffmpeg is installed.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh"
export PSCN
"$PSCN_SOURCE_DIR/examples/turning_teapot.sh" 2 'the film' --size 48x36
"$PSCN" render "$PSCN_SOURCE_DIR/scenes/teapot.pscn" --size 48x36 --quiet -o still.png
"$PSCN" compare 'the film/0001.png' still.png --fail 0 --quiet
if "$PSCN" compare 'the film/0002.png' still.png --failpercent 50 --quiet 2>said; then echo "it does not turn"; exit 1; fi
grep -q . said
if command -v ffmpeg >/dev/null; then [ -s 'the film/teapot.mp4' ]; fi
[ "$(find 'the film' -name '*.png' | wc -l)" -eq 2 ]
