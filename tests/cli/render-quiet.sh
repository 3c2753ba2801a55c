# --quiet is silent. The default name is the scene's. Formats follow the suffix in any case; suffixes of folders do not
# count.
mkdir a.b
cp "$SCENES/flat.pscn" a.b/scene
cp "$SCENES/flat.pscn" .
small="--size 16x12 --quiet"
try pscn render flat.pscn $small
try pscn a.b/scene $small
cp flat.pscn .scene
try pscn .scene $small
try pscn render flat.pscn $small -o 16.PNG --bits 16
try pscn render flat.pscn $small -o half.exr
try pscn render flat.pscn $small -o float.Exr --bits 32
try pscn render flat.pscn $small -o all.exr --channels rgb,coverage,depth,u,v,patch,normal,status
LC_ALL=C ls -A . a.b
# Standard output gets a PNG, or an EXR if only that holds what is asked for. The command may be left out there, too.
for asked in '' '--bits 16' '--bits 32' '--channels depth' '--tile 1/2'; do
  pscn render flat.pscn $small -o - $asked | head -c 4 | LC_ALL=C od -A n -c
done
pscn - $small <flat.pscn >dash.png
try pscn compare dash.png flat.png --quiet
try pscn compare flat.png 16.PNG --fail 0.51/255 --quiet
try pscn compare half.exr float.Exr --fail 0x1 2>/dev/null
try pscn compare half.exr float.Exr --fail 0.0005 --quiet
try pscn compare half.exr all.exr --channels R,G,B --quiet
try pscn compare half.exr all.exr --quiet
