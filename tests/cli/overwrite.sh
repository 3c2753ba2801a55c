# No command writes over what it reads, or twice to one file, by whatever name.
cp "$SCENES/flat.pscn" scene.pscn
touch empty.inc
printf '#include "scene.pscn"\n#include "empty.inc"\n#include "empty.inc"\n' >main.pscn
ln scene.pscn hard.png
ln -s scene.pscn soft.png
mkdir folder
small="--size 8x6 --quiet"
sums() { cat scene.pscn main.pscn | cksum; }
before=$(sums)
for name in hard.png soft.png ./folder/../hard.png; do
  try pscn render scene.pscn -o $name $small
  try pscn render main.pscn -o $name $small
  try pscn render main.pscn -o a.png --stats $name $small
  try pscn render - -o $name $small <scene.pscn
  try pscn trace main.pscn --stats $name </dev/null
  try pscn trace main.pscn --stats $name <scene.pscn
done
try pscn render scene.pscn -o a.png --stats ./folder/../a.png $small
try pscn render scene.pscn -o - --stats - $small
# The kept part of a picture, and the picture, each through a link to the other.
pscn render scene.pscn -o kept.exr.part.exr --tile 1/1 --size 8x6 --quiet
ln -s kept.exr.part.exr kept.exr
ln -s kept.exr.part.exr linked.exr
ln -s linked.exr linked.exr.part.exr
cksum kept.exr.part.exr >sum
for name in kept.exr linked.exr; do
  try pscn render scene.pscn -o $name $small
  try pscn render scene.pscn -o $name $small --resume
done
cksum kept.exr.part.exr | cmp - sum && rm kept.exr* linked.exr*
# Nor does a link of that name lead anywhere.
echo victim >victim
mkdir up
ln -s ../victim up/a.png.part.exr
ln -s ../nothing up/b.png.part.exr
try pscn render scene.pscn -o up/a.png $small
try pscn render scene.pscn -o up/a.png $small --resume
try pscn render scene.pscn -o up/b.png $small
cat victim
ls up
rm -r up victim
echo '1 0 -1' >polynomials
try pscn roots --stats polynomials <polynomials
cat polynomials
pscn render scene.pscn -o a.png $small
pscn render scene.pscn -o b.png $small
ln a.png c.png
cksum a.png >sum
try pscn compare a.png b.png -o a.png
try pscn compare b.png a.png -o c.png
cksum a.png | cmp - sum && echo "the picture is the same"
[ "$(sums)" = "$before" ] && echo "the scene is the same"
# A folder of results, whose files have fixed names.
cp scene.pscn folder/chart.html
ln folder/chart.html folder/povray-8.png
echo '#include "folder/chart.html"' >includes.pscn
chart="--no-peers --quick --size 2x2 --rays 1 --rounds 1 --quiet"
for scene in folder/chart.html includes.pscn -; do
  try pscn chart $scene -o folder $chart <folder/chart.html
  try pscn check $scene -o ./folder --steps 0 --size 8x6 --quiet <folder/chart.html
done
cmp scene.pscn folder/chart.html && ls folder
rm -r folder/* includes.pscn
# Standard output, too: a command would read its own answers. There `try` reports its exit code.
into() {
  local file=$1 code=0
  shift
  "$@" 1<>"$file" || code=$?
  echo "exit $code"
}
for arguments in "dump scene.pscn" "dump main.pscn" "render scene.pscn -o - $small" "render main.pscn -o b.png --stats - $small" \
  "trace main.pscn"; do
  into scene.pscn pscn $arguments </dev/null
done
into scene.pscn pscn dump - <scene.pscn
echo '0 0 -5 0 0 1' >rays
into rays pscn trace main.pscn <rays
into polynomials pscn roots <polynomials
into b.png pscn compare a.png b.png
into b.png pscn render scene.pscn -o b.png --stats - $small
pscn render scene.pscn --tile 1/2 -o piece.exr --size 64x48 --quiet
cksum piece.exr >piece.sum
into piece.exr pscn merge piece.exr -o c.png
cksum piece.exr | cmp - piece.sum && rm piece.exr piece.sum
cat rays polynomials
cksum a.png | cmp - sum && pscn compare --quiet a.png b.png && [ "$(sums)" = "$before" ] && echo "all is as it was"
rm rays
# What is not a file cannot be overwritten.
try pscn render scene.pscn -o a.png $small --stats /dev/null </dev/null
ls -A
