# Files that cannot be read or written: exit code 4, and nothing is left behind but what was rendered, as a part.
scene=$SCENES/flat.pscn
small="--size 16x12 --quiet"
mkdir folder.png
try pscn render nothing.pscn -o a.png $small
try pscn render folder.png -o a.png $small
try pscn render "$scene" -o nowhere/a.png $small
try pscn render "$scene" -o folder.png $small
try pscn render "$scene" -o a.png --stats nowhere/a.json $small
try pscn render "$scene" -o a.png --stats folder.png $small
# This is reported before the scene is read.
try pscn render nothing.pscn -o nowhere/a.png $small
try pscn render nothing.pscn -o a.png --stats nowhere/a.json $small
echo "kept" >old.png
ln -s /dev/full full.png
try pscn render "$scene" -o full.png $small
ln -s /dev/full full.json
try pscn render "$scene" -o b.png --stats full.json $small
# A full file system: the old picture stays as it was.
(ulimit -f 0; exec pscn render "$scene" -o old.png $small) 2>&1 | cat
echo "exit ${PIPESTATUS[0]}"
cat old.png
ls -A
# A picture whose part, which keeps the finished tiles, would have too long a name.
long=$(printf 'x%.0s' {1..245}).png
try pscn render "$scene" -o $long --size 16x12 2>&1 | grep 'warning\|exit' | sed 's/xx*/x/g'
try pscn render "$scene" -o $long $small --resume 2>&1 | sed 's/xx*/x/g'
pscn compare $long $long --quiet && echo whole
