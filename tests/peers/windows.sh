#!/bin/bash
# EXR crops are at their places: OpenImageIO's own tool combines two of them into the whole picture, and each has the
# picture as its display window.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" oiiotool
scene="$PSCN_SOURCE_DIR/scenes/teapot.pscn --size 64x48 --quiet"
"$PSCN" render $scene -o whole.exr
"$PSCN" render $scene --crop 0,0,30,48 -o left.exr
"$PSCN" render $scene --crop 30,0,34,48 -o right.exr
oiiotool --info -v right.exr | grep -q 'pixel data origin: x=30, y=0'
oiiotool --info -v right.exr | grep -q 'full/display size: 64 x 48'
oiiotool right.exr left.exr --croptofull --paste +0+0 -o pasted.exr
"$PSCN" compare whole.exr pasted.exr --fail 0 --quiet
oiiotool left.exr --croptofull right.exr --croptofull --add -o added.exr
"$PSCN" compare whole.exr added.exr --fail 0 --quiet
# The whole picture has no window that would be written twice, and a PNG none at all.
oiiotool --info -v whole.exr | grep -q 'full/display' && exit 1
"$PSCN" render $scene --crop 30,0,34,48 -o right.png
oiiotool --info -v right.png | grep -q '34 x   48' && ! oiiotool --info -v right.png | grep -q 'full/display'
