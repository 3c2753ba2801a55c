# The pictures say how they were made. Both formats hold the texts unchanged.
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 20x10 --tolerance 1e-9 --quiet
pscn render "$scene" -o a.exr --size 20x10 --tolerance 1e-9 --quiet
for name in Software pscn:version pscn:scene pscn:solver pscn:tolerance pscn:size pscn:crop pscn:samples \
            pscn:render_seconds; do
  for file in a.png a.exr; do
    grep -a -q "$name" $file || echo "$file has no $name"
  done
done
grep -a -o 'flat\.pscn' a.png
grep -a -o sRGB a.png
# The texts say what was asked for, and describe the picture.
pscn render "$scene" -o b.png --size 20x10 --crop 3,2,9,7 --samples 2 --quiet --solver 'newton { polish off }' \
  --tolerance 1e-9 --declare A=0.25 --declare B=-3e19
for text in 'solver=newton { tolerance 1e-9 polish off }' tolerance=1e-9 size=20x10 crop=3,2,9,7 samples=2 channels=rgb \
            "options= --solver 'newton { polish off }' --tolerance 1e-9 --declare A=0.25 --declare B=-3e19"; do
  LC_ALL=C tr '\0' '=' <b.png | grep -a -o -F "pscn:$text"
done
