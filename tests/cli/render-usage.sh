# Wrong command lines of render: a clear error and exit code 2 before anything is read or written.
scene=$SCENES/flat.pscn
try pscn render
try pscn render "$scene" more
try pscn render "$scene" --unknown
try pscn render "$scene" --stats
try pscn render "$scene" --quiet=yes
for value in 0x5 5x0 5 x 5x5x5 -5x5 5.0x5 1000001x1 99999999999999999999x1 "" " 5x5" 20000x20000; do
  try pscn render "$scene" --size "$value"
done
for value in 0 -1 1.5 257 x ""; do
  try pscn render "$scene" --samples "$value"
done
for value in 0 1025 two; do
  try pscn render "$scene" --threads "$value"
done
for value in 1,2,3 1,2,3,4,5 1,2,0,4 1,2,3,0 -1,2,3,4 800,0,1,1 799,0,2,1 0,0,801,1 0,599,1,2 \
  9223372036854775807,0,9223372036854775807,1 18446744073709551615,0,2,1; do
  try pscn render "$scene" --crop "$value"
done
for value in "" rgb, rgb,rgb z RGB; do
  try pscn render "$scene" -o a.exr --channels "$value"
done
for value in 0 -1 nan inf 1e999 1/0 1e308/0.1 1x ""; do
  try pscn render "$scene" --tolerance "$value"
done
try pscn render "$scene" -o a.png --channels rgb,depth
try pscn render "$scene" -o a.png --channels depth
try pscn render "$scene" -o a.png --bits 32
try pscn render "$scene" -o a.exr --bits 8
try pscn render "$scene" -o a.png --bits 12
try pscn render "$scene" -o a.png --bits x
try pscn render "$scene" -o a.jpg
try pscn render "$scene" -o a
try pscn render "$scene" -o .png
try pscn render "$scene" -o abcdefghij.pngs
try pscn render "$scene" -o a.png --stats a.png
try pscn render "$scene" -o a.png --stats "$scene"
cp "$scene" scene.png
try pscn render scene.png
try pscn render "$scene" --solver 'nothing'
try pscn render "$scene" --solver 'aberth { nothing 1 }'
ls -A
