# The pictures say what made them. Both formats hold the texts as they are.
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 20x10 --tolerance 1e-9 --quiet
pscn render "$scene" -o a.exr --size 20x10 --tolerance 1e-9 --quiet
for name in Software pscn:version pscn:scene pscn:solver pscn:tolerance pscn:size pscn:crop pscn:samples \
            pscn:render_seconds; do
  for file in a.png a.exr; do
    grep -a -q "$name" $file && echo "$file has $name"
  done
done
grep -a -o 'flat\.pscn' a.png
grep -a -o sRGB a.png
