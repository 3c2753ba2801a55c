# A stdout that takes nothing is a file error.
scene=$SCENES/flat.pscn
for command in "help" "help render" "--version" "dump $scene" "render --help"; do
  pscn $command >/dev/full
  echo "exit $?"
done
pscn render "$scene" -o a.png --size 4x3 --quiet --stats - >/dev/full
echo "exit $?"
# A reader that goes away ends the program without a word.
pscn dump "$scene" | head -c 1
echo
