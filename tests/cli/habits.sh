# What people type out of habit is understood, or answered with what they meant.
cp "$SCENES/flat.pscn" .
small="--size 8X6"
try pscn flat.pscn $small -q
ls
try pscn flat.pscn -qo short.png $small
try pscn flat.pscn -q -oshort.png $small
try pscn flat.pscn -q -o=short.png --size=8x6
try pscn render -q $small -- flat.pscn
(export POSIXLY_CORRECT=1; try pscn render flat.pscn -qo posix.png $small)
pscn render -qhz | head -n 1
try pscn nothing.pscn
try pscn folder/nosuch
# POV-Ray's options are recognized as such.
for option in +W320 -D; do try pscn $option flat.pscn; done
try pscn flat.pscn +W320 +H240
try pscn roots 1 -3 2
try pscn compare a b -A
try pscn -V
try pscn -v
try pscn -h | head -n 1
try pscn rendr flat.pscn
try pscn compair a b
try pscn frobnicate
try pscn help rendr
try pscn render flat.pscn --chanels rgb
try pscn render flat.pscn --siez=8x8
try pscn render flat.pscn --chan rgb
try pscn render flat.pscn --s
try pscn render flat.pscn --quie=1
try pscn render flat.pscn --stat
try pscn compare a b --failp 1
try pscn render flat.pscn --=1
try pscn render flat.pscn -qz
try pscn render flat.pscn -: -q
try pscn render flat.pscn -- -q
try pscn -q --size 4x3 -o behind.png flat.pscn
try pscn -o behind.png no.pscn
try pscn -q render flat.pscn
try pscn -o behind.png
try pscn render flat.pscn --stats -q
try pscn render flat.pscn -o --quiet
try pscn render flat.pscn -o
try pscn render flat.pscn -o a.exr --channels rgb,foo
try pscn render flat.pscn -o folder/.EXR
try pscn render flat.pscn -o .png.foo
try pscn compare a.png b.png -o .exr
echo "camera { }" >empty.pscn
# Nothing to be seen is worth a warning, one.
sed 's/look_at *<[^>]*>/look_at <0,90,0>/' $SCENES/bent.pscn >away.pscn
grep -v light_source $SCENES/bent.pscn |
  sed 's/pigment { color rgb <0.6, 0.6, 0.65> }/& finish { ambient 0 }/; s/finish { specular/finish { ambient 0 specular/' >dark.pscn
echo 'light_source { <0,0,-9>, rgb 0 }' | cat dark.pscn - >night.pscn
for scene in empty away dark night $SCENES/bent; do
  pscn render $scene.pscn -o seen.png --size 8x6 2>&1 | grep warning
  pscn render $scene.pscn -o seen.png --size 8x6 -q
done
rm -f away.pscn dark.pscn night.pscn seen.png
# "1 patch" is singular.
pscn render flat.pscn $small 2>&1 | grep -c ' 1 patch,'
# The progress line is no longer than the terminal is wide.
if command -v script >/dev/null; then
  for columns in 10 40; do
    script -qec "stty cols $columns; pscn render $SCENES/bent.pscn --size 600x600 --samples 2 -o progress.png" /dev/null |
      tr '\r' '\n' | sed 's/\x1b\[K//g' | grep 'rays/s\|%' |
      awk -v columns=$columns 'length($0) >= columns && !/answers|patches|rays  |x/ { long++ } END { print columns, long + 0 }'
  done
  script -qec "pscn render flat.pscn -o -" /dev/null | tr -d '\r'
  # The results are shown on a terminal.
  printf '%s\n' '2 -1' '1 0 0' '1e300 -6.680801335744067e148 0.0011158276623035757' >polynomials
  script -qec "pscn roots --solver 'aberth { basis bernstein }' <polynomials >/dev/null" /dev/null | tr -d '\r' |
    sed 's/; [0-9.]* s$//'
  script -qec "pscn roots -q <polynomials >/dev/null" /dev/null
  echo 7 >polynomials # of what ends with an error nothing
  script -qec "pscn roots <polynomials >/dev/null" /dev/null | tr -d '\r'
  echo '0 0 -9 0 0 1' >rays
  script -qec "pscn trace $SCENES/bent.pscn <rays >/dev/null" /dev/null | tr -d '\r' | grep -v '^time'
  script -qec "pscn trace -q $SCENES/bent.pscn <rays >/dev/null" /dev/null
  rm polynomials rays
fi
ls
