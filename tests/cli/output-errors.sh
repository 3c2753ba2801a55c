# A stdout that cannot be written is a file error.
scene=$SCENES/flat.pscn
for command in "help" "help render" "--version" "dump $scene" "render --help"; do
  pscn $command >/dev/full
  echo "exit $?"
done
# What was rendered is kept then.
pscn render "$scene" -o a.png --size 4x3 --stats - >/dev/full
echo "exit $?"
ls
pscn render "$scene" -o a.png --size 4x3 --quiet --resume --stats - | grep primary
rm a.png
# If the reader goes away, the program ends silently.
pscn dump "$scene" | head -c 1
echo
# A dangling link is reported differently from a missing folder.
ln -s nothing.png link.png
ln -s nothing.exr b.png.part.exr
mkdir nowhere && ln -s "$PWD/nowhere" gone && rmdir nowhere
for picture in link.png nowhere/a.png gone/a.png; do
  pscn render "$scene" -o $picture --size 4x3 --quiet
  echo "exit $?"
done
pscn render "$scene" -o b.png --size 4x3 2>&1 | grep kept
ls -A
