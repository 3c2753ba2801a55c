# Files, columns and exit codes of `pscn chart`; peers and gnuplot that are missing.
scene=$SCENES/bent.pscn
small="--quick --size 32x24 --rays 128 --rounds 1"
one="$small --solver bernstein"
# Gnuplot may be missing.
chart() {
  try pscn chart "$@" 2>said
  grep -v 'gnuplot is not installed' said >&2
}
chart "$scene" $small --no-peers --quiet -o out
ls out | sed 's/chart.svg//' | grep .
head -1 out/chart.csv
# Each line has as many fields as the first. Each family is there, and the default, with polish, is right everywhere.
LC_ALL=C awk -F, 'NR == 1 { n = NF; for (k = 1; k <= NF; k++) at[$k] = k; next }
  NF != n { print "fields:", NF, $0 }
  { count[$1]++ }
  $1 == "embree" || $1 == "povray" { print "a peer:", $0 }
  $at["polish"] == "on" && ($at["lost"] + $at["invented"] + $at["wrong"] > 0 || $at["t_max"] > 1e-12) {
    print "not exact:", $0
  }
  # Two of the rivals need LAPACK.
  $1 == "rival" && /dhseqr|dggev/ { count[$1]-- }
  $at["front"] == 1 { front = 1 }
  END {
    print count["bernstein"], count["newton"], count["laguerre"], count["aberth"], count["paper"],
      count["rival"], front
  }' out/chart.csv
grep -c '<table>' out/chart.html

# Each rival is judged on every scene: Newton from the middle may lose a hit or two, the others none; eigenvalues have
# half of the digits.
for name in teapot wild; do
  chart "$PSCN_SOURCE_DIR/scenes/$name.pscn" --quick --size 160x120 --rays 512 --rounds 1 --no-peers --quiet --solver bernstein -o "$name"
done
LC_ALL=C awk -F, 'FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
  $1 != "rival" { next }
  { bad = $at["lost"] + $at["invented"] + $at["wrong"]; judged++ }
  $at["hits"] < 50 || bad > (/Newton from/ ? 2 : 0) || !($at["t_99"] < (/dhseqr|dggev/ ? 1e-6 : 1e-12)) { print "a rival fails:", FILENAME, $0 }
  END { print (judged >= 12) }' out/chart.csv teapot/chart.csv wild/chart.csv
rm -r teapot wild

# The solvers that are asked for, and the default.
chart "$scene" $small --no-peers --quiet --solver 'durand_kerner { polish off }' --solver 'aberth { split 1 }' -o chosen
cut -d, -f1,2 chosen/chart.csv | grep -v -e dhseqr -e dggev
chart "$scene" $small --solver nothing -o chosen

# Missing peers are reported, and are no error.
try pscn chart "$scene" $one --povray nowhere/povray -I '' -o out2 2>&1 | grep -e '^POV-Ray' -e '^exit'

# Without gnuplot the numbers are there. The lack is reported, except with --quiet: nothing is wrong.
mkdir empty
pscn=$(command -v pscn)
(PATH=empty; "$pscn" chart "$scene" $one --no-peers -o out3 2>&1) | grep gnuplot
(PATH=empty; try "$pscn" chart "$scene" $one --no-peers --quiet -o out3)
ls out3

# Nothing to hit, in an empty scene and beside a patch, where the paper's form may see hits. This is reported; there is
# no front, no figure, no peer called a failure, and no error.
echo 'background { rgb 0 }' >nothing.pscn
sed "s/look_at <[^>]*>/look_at <0, 50, 0>/" "$scene" >aside.pscn
for name in nothing aside; do
  try pscn chart $name.pscn $one --solver "aberth { form paper }" --povray nowhere/povray -o out4 >said 2>&1
  grep -e warning -e '^No camera' -e '^exit' -e 'front)' -e fail -e 'Embree.*no patch' said
  grep -c 'bernstein$' said
  ls out4
done

# A standard output that cannot be written.
pscn chart nothing.pscn $one --no-peers -o out8 2>/dev/null >/dev/full
echo "exit $?"
ls out8/chart.html && rm -r out8

# The page quotes the command line for a shell.
cp nothing.pscn "it's \$x.pscn"
chart "it's \$x.pscn" $one --povray nowhere/povray --quiet -o out7 2>/dev/null >&2
eval "set -- $(sed -n "s/&#39;/'/g; s/.*<code>pscn \(.*\)<\/code>.*/\1/p" out7/chart.html)"
printf '%s\n' "$2"
rm -r "it's \$x.pscn" out7

# A patch with its own solver, which means nothing here.
{
  cat "$scene"
  echo 'bicubic_patch { type 0'
  for y in -2 -1 1 2; do echo "<-2, $y, -1> <-1, $y, -1> <1, $y, -1.5> <2, $y, -1>"; done
  echo 'solver aberth { tolerance 1e-9 } }'
} >two.pscn
chart two.pscn $one --no-peers --quiet -o out6

# The command line.
try pscn chart
try pscn chart "$scene" --rays 0
try pscn chart "$scene" --rounds 1000
try pscn chart "$scene" --size 3
try pscn chart missing.pscn -o out5
echo text >file
try pscn chart "$scene" $small -o file
try pscn chart "$scene" $small -o nowhere/out
ls -A
