# Differences, limits, exit codes.
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 17x13 --quiet
pscn render "$scene" -o b.png --size 17x13 --quiet --samples 2
pscn render "$scene" -o narrow.png --size 8x13 --quiet
pscn render "$scene" -o low.png --size 17x6 --quiet
pscn render "$scene" -o a.exr --size 17x13 --quiet --channels rgb,depth,normal
try pscn compare a.png a.png
try pscn compare a.png a.png --quiet
try pscn compare a.png b.png
try pscn compare a.png b.png --quiet
try pscn compare a.png b.png --fail 1 --quiet
try pscn compare a.png b.png --fail 1 --warn 4/255 --quiet
try pscn compare a.png b.png --fail 1 --warn 4/255 >/dev/null
try pscn compare a.png b.png --failpercent 100 --quiet
try pscn compare a.png b.png --failpercent 100 --hardfail 0.05 --quiet
try pscn compare a.png b.png --allowfailures 221 --quiet
try pscn compare a.png narrow.png
try pscn compare a.png low.png
try pscn compare a.png a.exr
try pscn compare a.exr a.exr --channels depth,normal.z -o depth.png
try pscn compare a.exr a.exr --channels nothing
try pscn compare a.exr a.exr --channels depth,normal.z -o some.exr --quiet
try pscn compare some.exr some.exr | head -n 1
try pscn compare a.exr a.exr --channels $(printf 'R,%.0s' {1..256})R
try pscn compare a.exr a.exr --channels R,G,B,depth,normal.x -o five.png --quiet
try pscn compare a.png nothing.png
try pscn compare a.png "$scene"
try pscn compare a.png
try pscn compare a.png b.png low.png
try pscn compare a.png b.png --fail -1
try pscn compare a.exr a.exr -o diff.exr --scale 0 # infinity times 0 would be no difference, but a NaN
try pscn compare a.png b.png -o diff.jpg
try pscn compare a.png b.png -o nowhere/diff.png
try pscn compare a.png b.png -o diff.exr --fail 1 --scale 2 --quiet
try pscn compare diff.exr diff.exr --quiet
# diff.exr has twice the difference: it differs from once.exr by it.
pscn compare a.png b.png -o once.exr --fail 1 | awk '/^max/ { print $1, $2 }' >most
pscn compare once.exr diff.exr --fail 2 | awk '/^max/ { print $1, $2 }' | cmp - most && echo "scaled"
# A difference of one code is not over 1/255, however both values are rounded. A picture of differences holds them
# unrounded: a hundred times one code is a hundred codes.
for level in 0.52100 0.52712; do echo "#version 3.7; background { rgb $level }" | pscn render - -o $level.png --size 1x1 --quiet; done
pscn compare 0.52100.png 0.52712.png --fail 1 --scale 100 -o by.png | grep 'max\|over 1/'
pscn compare by.png 0.52100.png --fail 1 | grep max
rm 0.*.png by.png
pscn compare a.png a.png >/dev/full
echo "exit $?"
ls -A
# No channel's name controls the terminal.
pscn render "$SCENES/flat.pscn" --size 4x3 --channels depth -o depth.exr --quiet
sed 's/depth/\x1b[31m/g' depth.exr >red.exr
try pscn compare red.exr red.exr | head -n 1
try pscn compare red.exr depth.exr
# Pictures are files, whatever their names.
try pscn compare - -
