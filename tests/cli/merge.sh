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
for k in 1 2 3 4; do
  pscn render $scene --channels $channels --tile $k/4 -o all$k.exr
  pscn render $scene --samples 2 --tile $k/4 -o p$k.exr
done
try pscn merge all3.exr all1.exr all4.exr all2.exr -o all.exr --bits 32 --quiet
try pscn merge p?.exr -o p.png --quiet
try pscn merge p?.exr -o p16.png --bits 16
same one.exr all.exr
# Its texts are those of that picture, but for an empty one. Texts of a single piece are not the picture's.
texts() { grep -ao 'pscn:[a-z_]*\|Software\|DateTime' $1 | grep -v options | sort; }
cmp <(texts one.exr) <(texts all.exr) && echo "$(texts all.exr | wc -l) texts"
# Its time is the sum of theirs; each is made to claim some seconds.
for k in 1 2 3 4; do LC_ALL=C sed "s|\(pscn:render_seconds.string.....\)[0-9]|\1$k|" all$k.exr >took$k.exr; done
pscn merge took?.exr -o took.exr --quiet
seconds() { LC_ALL=C tr '\0-\37' ' ' <$1 | grep -ao 'pscn:render_seconds string *[0-9.]*' | sed 's/.* //'; }
sum=$(for k in 1 2 3 4; do seconds took$k.exr; done | LC_ALL=C awk '{ sum += $1 } END { printf "%.3f", sum }')
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
for k in 1 2 3; do pscn render $scene --crop 0,0,40,20 --tile $k/3 -o tiny$k.exr; done
try pscn merge tiny?.exr -o tiny.exr --quiet
# A damaged piece of one tile counts as missing.
sed 's/\(pscn:sum.string.....\)./\1x/' tiny1.exr >hurt.exr
try pscn merge hurt.exr tiny2.exr tiny3.exr -o no.png
# Texts of several lines are compared to their end.
for k in 1 2; do pscn render $scene --solver $'aberth {\n polish on }' --tile $k/2 -o line$k.exr; done
try pscn merge line?.exr -o line.exr --quiet
pscn render $scene --solver $'aberth {\n polish off }' --tile 2/2 -o line2.exr
try pscn merge line?.exr -o no.png
# Missing, strange and repeated pieces are reported, and no picture is made.
try pscn merge p2.exr -o no.png
pscn merge p2.exr -o no.png >/dev/full; echo "exit $?"
try pscn merge p1.exr p3.exr p4.exr p3.exr -o no.png
try pscn merge p?.exr p2.exr -o no.png
try pscn merge all2.exr p?.exr -o no.png # most are of another picture than the first
pscn render $scene --samples 2 --tile 3/4 --declare Unused=1 -o p3.exr
try pscn merge p?.exr -o no.png
cp p3.exr other3.exr
pscn render $scene --samples 2 --tile 4/4 --declare Unused=1 -o other4.exr
try pscn merge p1.exr other3.exr other4.exr p2.exr -o no.png
pscn render $scene --samples 2 --tile 3/5 -o p3.exr
try pscn merge p?.exr -o no.png
sed 's/angle 4/angle 5/' $SCENES/bent.pscn >other.pscn
pscn render other.pscn --size 150x100 --quiet --samples 2 --tile 3/4 -o p3.exr
pscn merge p?.exr -o no.png 2>err; echo "exit $?"
sed "s/'[0-9a-f]\{32\}'/HASH/g" err
# A piece from another processor, by a program built for it, may differ in last bits.
pscn render $scene --samples 2 --tile 3/4 -o whole3.exr
processor=$(uname -m)
sed "s/, $processor,/, ${processor//[a-z0-9]/z},/" whole3.exr >p3.exr
pscn merge p?.exr -o no.png 2>err; echo "exit $?"
grep -o "'p3.exr': .* arithmetic" err
head -c 3000 whole3.exr >p3.exr
pscn merge p?.exr -o no.png 2>/dev/null; echo "exit $?"
try pscn merge p1.exr gone.exr one.exr crop.exr -o no.png
try pscn merge gone.exr one.png -o no.png
# A piece that asks for more memory than is allowed, here for 60000 x 60000 pixels, is named.
printf '\x89PNG\r\n\x1a\n\0\0\0\15IHDR\0\0\xea\x60\0\0\xea\x60\10\0\0\0\0\xa5\xb9\x2a\x9e\0\0\0\0IDAT' >large.png
try pscn merge p1.exr large.png -o no.png
# A damaged file does not shut out a good copy of it, whichever comes first.
cp p3.exr cut3.exr
cp whole3.exr p3.exr
for files in "cut3.exr p1.exr p2.exr" "p1.exr p2.exr p3.exr cut3.exr" "cut3.exr p1.exr p2.exr p3.exr"; do
  pscn merge $files p4.exr -o no.png 2>/dev/null; echo "$files: exit $?"
done
[ ! -e no.png ] || echo "there is a picture"
# Neither a piece's texts nor names control the terminal.
cp whole3.exr p3.exr
pscn render $scene --samples 2 --tile 2/4 --declare Unused=1 -o named.exr
sed 's/Unused=1/\x1b[31m=1 /' named.exr >p2.exr
try pscn merge p?.exr $'\x1b[31m\xc2\x9bé\xff.exr' -o no.png
# Impossible claims of a piece, of the same length; and a piece that lies outside its own picture.
said=()
for text in 88888:88889 88888:8888- 88888:x8888 3/4:5/4 3/4:0/4 3/4:3/0 '3/4:3;4' 3/4:x/4 3/4:3/x; do
  said+=("said ${text//\//:}.exr")
  sed "s|${text%:*}|${text#*:}|" whole3.exr >"${said[-1]}"
done
try pscn merge "${said[@]}" -o no.png 2>&1
# In any order.
LC_ALL=C sed 's|\(pscn:channels.string.....\)rgb|\1rgc|' p1.exr >unknown.exr
cmp -s p1.exr unknown.exr && echo "nothing is changed"
try pscn merge unknown.exr p1.exr -o no.png
try pscn merge p1.exr unknown.exr -o no.png
# A byte that was changed later. The last one of a file belongs to the tile in the lower right corner, which one piece
# has. In the others it belongs to nobody's pixels.
pscn render $scene --samples 2 --tile 3/4 -o p3.exr
pscn render $scene --samples 2 --tile 2/4 -o p2.exr
for k in 1 2 3 4; do
  last=$(tail -c 1 p$k.exr | od -An -tu1)
  (head -c -1 p$k.exr && printf "\\x$(printf %x $(((last + 1) % 256)))") >changed$k.exr
done
try pscn merge changed?.exr -o no.png
for k in 1 2 3 4; do cmp -s changed$k.exr p$k.exr && echo "nothing is changed"; done
cp whole3.exr outside.exr
at=$(grep -abo displayWindow outside.exr | head -n 1 | cut -d: -f1)
printf '\5' | dd of=outside.exr bs=1 seek=$((at + 24)) conv=notrunc status=none
try pscn merge outside.exr -o no.png
same outside.exr whole3.exr
# A picture's name does not control the terminal either.
red=$'\x1b[31m.exr'
try pscn merge all?.exr -o $red
cp all1.exr $red.part.exr
try pscn render ${scene% --quiet} -o $red 2>&1 | cat -v | grep '31m'
rm $red
# A PNG cannot hold numbers.
for channels in normal rgb,depth; do
  pscn render $scene --tile 1/1 --channels $channels --quiet -o $channels.exr
  try pscn merge $channels.exr -o no.png
  [ ! -e no.png ] || echo "there is a picture of $channels"
done
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
