# Pieces of a picture, rendered separately, make the picture of a single run to the bit, in every format and with all
# channels.
scene="$SCENES/bent.pscn --size 150x100 --quiet"
channels=rgb,depth,coverage,patch
same() { # A B: no value differs
  pscn compare $1 $2 --fail 0 --quiet && echo "$1 is $2"
}
pscn render $scene --channels $channels --bits 32 -o one.exr
pscn render $scene --samples 2 -o one.png
pscn render $scene --samples 2 --bits 16 -o one16.png
for k in 1 2; do pscn render $scene --channels $channels --tile $k/2 -o all$k.exr; done
for k in 1 2 3 4; do pscn render $scene --samples 2 --tile $k/4 -o p$k.exr; done
try pscn merge all2.exr all1.exr -o all.exr --bits 32 --quiet
try pscn merge p?.exr -o p.png --quiet
try pscn merge p?.exr -o p16.png --bits 16
same one.exr all.exr
# Its texts are those of that picture, but for an empty one. Texts of a single piece are not the picture's.
texts() { grep -ao 'pscn:[a-z_]*\|Software\|DateTime' $1 | grep -v options | sort; }
cmp <(texts one.exr) <(texts all.exr) && echo "$(texts all.exr | wc -l) texts"
# Its time is the sum of theirs; each is made to claim some seconds.
for k in 1 2; do LC_ALL=C sed "s|\(pscn:render_seconds.string.....\)[0-9]|\1$k|" all$k.exr >took$k.exr; done
pscn merge took?.exr -o took.exr --quiet
seconds() { LC_ALL=C tr '\0-\37' ' ' <$1 | grep -ao 'pscn:render_seconds string *[0-9.]*' | sed 's/.* //'; }
sum=$(for k in 1 2; do seconds took$k.exr; done | LC_ALL=C awk '{ sum += $1 } END { printf "%.3f", sum }')
[ "$(seconds took.exr)" = $sum ] && echo "took as long as its pieces"
same one.png p.png
same one16.png p16.png
pscn render $scene --crop 37,5,66,80 -o crop.exr
for k in 1 2; do pscn render $scene --crop 37,5,66,80 --tile $k/2 -o crop$k.exr; done
pscn merge crop?.exr -o cropped.exr --quiet
same crop.exr cropped.exr
window() { # NAME FILE: the attribute with its type, its size and four numbers
  local at=$(LC_ALL=C grep -abo $1 $2 | head -n 1 | cut -d: -f1)
  tail -c +$((at + 1)) $2 | head -c $((${#1} + 27)) | od -An -tx1
}
for name in displayWindow dataWindow; do
  [ "$(window $name crop.exr)" = "$(window $name cropped.exr)" ] || echo "another $name"
done
# More pieces than tiles.
for k in 1 2; do pscn render $scene --crop 0,0,20,20 --tile $k/2 -o tiny$k.exr; done
try pscn merge tiny?.exr -o tiny.exr --quiet
# A damaged piece of one tile counts as missing.
sed 's/\(pscn:sum.string.....\)./\1x/' tiny1.exr >hurt.exr
try pscn merge hurt.exr tiny2.exr -o no.png
# Texts of several lines are compared to their end.
for k in 1 2; do pscn render $scene --solver $'aberth {\n polish on }' --tile $k/2 -o line$k.exr; done
try pscn merge line?.exr -o line.exr --quiet
pscn render $scene --solver $'aberth {\n polish off }' --tile 2/2 -o line2.exr
try pscn merge line?.exr -o no.png
# Missing, strange and repeated pieces are reported, and no picture is made.
try pscn merge p2.exr -o no.png
pscn merge p2.exr -o no.png >/dev/full; echo "exit $?"
try pscn merge p?.exr p2.exr -o no.png
try pscn merge all2.exr p?.exr -o no.png # most are of another picture than the first
for k in 3 4; do pscn render $scene --samples 2 --tile $k/4 --declare Unused=1 -o other$k.exr; done
try pscn merge p1.exr other3.exr other4.exr p2.exr -o no.png
# All that is wrong is reported. Neither a piece's texts nor names control the terminal. A piece from another processor,
# by a program built for it, may differ in last bits. One that lies outside its own picture is none.
pscn render $scene --samples 2 --tile 3/5 -o five3.exr
sed 's/angle 4/angle 5/' $SCENES/bent.pscn >other.pscn
pscn render other.pscn --size 150x100 --quiet --samples 2 --tile 3/4 -o scene3.exr
processor=$(uname -m)
sed "s/, $processor,/, ${processor//[a-z0-9]/z},/" p3.exr >processor3.exr
sed 's/Unused=1/\x1b[31m=1 /' other3.exr >named3.exr
LC_ALL=C sed 's|\(pscn:channels.string.....\)rgb|\1rgc|' p3.exr >unknown3.exr
head -c 3000 p3.exr >cut3.exr
cp p3.exr outside3.exr
at=$(grep -abo displayWindow outside3.exr | head -n 1 | cut -d: -f1)
printf '\5' | dd of=outside3.exr bs=1 seek=$((at + 24)) conv=notrunc status=none
pscn merge p[124].exr p2.exr {other,five,scene,processor,named,unknown,cut,outside}3.exr gone.exr one.exr crop.exr \
  $'\x1b[31m\xc2\x9bé\xff.exr' -o no.png 2>err; echo "exit $?"
sed "s/'[0-9a-f]\{32\}'/HASH/g; s/\('cut3.exr'\|arithmetic\):.*/\1.../" err
same outside3.exr p3.exr
try pscn merge unknown3.exr p3.exr -o no.png # in this order, too
try pscn merge gone.exr one.png -o no.png
# A piece that asks for more memory than is allowed, here for 60000 x 60000 pixels, is named.
printf '\x89PNG\r\n\x1a\n\0\0\0\15IHDR\0\0\xea\x60\0\0\xea\x60\10\0\0\0\0\xa5\xb9\x2a\x9e\0\0\0\0IDAT' >large.png
try pscn merge p1.exr large.png -o no.png
# A damaged file does not shut out a good copy of it, whichever comes first.
for files in "p1.exr p2.exr p3.exr cut3.exr" "cut3.exr p1.exr p2.exr p3.exr"; do
  pscn merge $files p4.exr -o no.png 2>/dev/null; echo "$files: exit $?"
done
# A byte that was changed later. The last one of a file belongs to the tile in the lower right corner, which one piece
# has. In the others it belongs to nobody's pixels.
for k in 1 2 3 4; do
  last=$(tail -c 1 p$k.exr | od -An -tu1)
  (head -c -1 p$k.exr && printf "\\x$(printf %x $(((last + 1) % 256)))") >changed$k.exr
done
try pscn merge changed?.exr -o no.png
# A picture's name does not control the terminal either.
red=$'\x1b[31m.exr'
try pscn merge all?.exr -o $red
cp all1.exr $red.part.exr
try pscn render ${scene% --quiet} -o $red 2>&1 | cat -v | grep '31m'
rm $red
# A PNG cannot hold numbers.
try pscn merge all?.exr -o no.png
[ ! -e no.png ] || echo "there is a picture"
# The command line.
try pscn merge -o no.png
try pscn merge p1.exr
try pscn merge p1.exr p2.exr -o p1.exr
try pscn merge p1.exr -o no.jpg
try pscn merge p1.exr -o no.png --bits 32
try pscn merge p1.exr -o no.png --bits 7
try pscn render $scene --tile 1/4 -o no.png
try pscn render $scene --tile 5/4 -o no.exr
try pscn render $scene --tile 0/4 -o no.exr
try pscn render $scene --tile 1/4 --bits 16 -o no.exr
try pscn render $scene --resume -o -
