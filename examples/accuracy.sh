#!/bin/bash
# Which method, when: writes docs/accuracy.md and the files of docs/accuracy/ by `pscn chart`, and by what
# examples/paper.sh has left in docs/paper/ (causes.csv, conditions.csv).
#
#   examples/accuracy.sh [OPTION...]     options of `pscn chart`, such as --quick
#
# Takes some fifteen minutes, one with --quick. $PSCN_CHARTS, if set, is a folder with the charts teapot/ and wild/ of
# an earlier run, from which the page is written without measuring.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

SCENES=(teapot wild)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
charts=${PSCN_CHARTS:-$folder}
pscn=${PSCN:-build/src/command/pscn}

# The points of the figures: on leaves and whole patches with polish, in the power basis without, and the paper's form.
solvers=(--solver 'bernstein { split 1 }')
for solver in newton laguerre aberth; do
  for items in '' 'start previous split 1' 'start previous basis power polish off tolerance 1e-8' \
    'form paper start previous tolerance 1e-2' 'form paper start previous tolerance 1e-6' 'form paper start previous tolerance 1e-10'; do
    solvers+=(--solver "$solver { $items }")
  done
done
mkdir -p docs/accuracy
if [ -z "${PSCN_CHARTS:-}" ]; then
  install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox libembree-dev liblapack-dev libflint-arb-dev libcmocka-dev
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DPSCN_TESTS=ON >/dev/null
  cmake --build build --target pscn pscn_embree pscn_lapack corpus_table rival_operations >/dev/null
  build/tests/corpus/corpus_table >docs/accuracy/corpus.csv
  build/tests/operations/rival_operations $(printf 'scenes/%s.pscn ' "${SCENES[@]}") |
    sed 's/scenes\/\([a-z]*\)\.pscn/\1/' >docs/accuracy/operations.csv
  for scene in "${SCENES[@]}"; do
    "$pscn" chart "scenes/$scene.pscn" "${solvers[@]}" "$@" -o "$charts/$scene" >/dev/null
  done
fi

# For awk: read() puts a line of chart.csv into the array f, by the names of the columns. Only the name is in quotes,
# and may contain commas.
READ='
  function number(x, digits) { return x == "" ? "" : sprintf("%." digits "g", x) }
  function bad() { return f["lost"] + f["invented"] + f["wrong"] }
  function read(  n, k, part) {
    if (FNR == 1) { columns = split($0, column, ","); return 0 }
    match($0, /"[^"]*"/)
    n = split(substr($0, 1, RSTART - 1) "name" substr($0, RSTART + RLENGTH), part, ",")
    for (k = 1; k <= n; k++) f[column[k]] = part[k]
    f["name"] = substr($0, RSTART + 1, RLENGTH - 2)
    return 1
  }'

# rows CONDITION: the points that fulfil the condition, as rows of a table: of both scenes, side by side.
rows() {
  awk "$READ"'
    function cells() { return sprintf(" | %s | %s | %s | %d", number(f["ns_median"], 3), number(f["ratio"], 3), number(f["t_99"], 2), bad()) }
    !read() { scene++; next }
    scene == 1 { wild[f["name"]] = cells(); next }
    function short(name) {
      gsub(/ start previous| form paper| basis power polish off|Embree, | a patch, 8 coherent|POV-Ray, type 1, |, flatness 0/, "", name)
      return name
    }
    '"$1"' { print "| " short(f["name"]) cells() wild[f["name"]] " |" }' "$charts/wild/chart.csv" "$charts/teapot/chart.csv"
}
TABLE=$'| | teapot: ns a ray | of the default\'s | error of T, 99 % | wrong | wild: ns a ray | of the default\'s | error of T, 99 % | wrong |\n|---|---|---|---|---|---|---|---|---|'

# rivals SCENE: time, operations, accuracy.
rivals() {
  awk "$READ"'
    NR == FNR { split($0, part, ","); if (part[1] == scene) operations[part[2]] = part[3] " | " number(part[4], 3); next }
    read() && f["family"] == "rival" {
      printf "| %s: %s | %s | %s | %s | %s | %s | %d |\n", scene, f["name"], number(f["ns_median"], 3), number(f["ratio"], 3), operations[f["name"]],
        number(f["t_99"], 2), number(f["t_max"], 2), bad() }' scene="$1" docs/accuracy/operations.csv "$charts/$1/chart.csv"
}

# span SCENE CONDITION EXPRESSION [DIGITS]: the values of the expression over the points that fulfil the condition.
span() {
  awk "$READ"'
    function value() { return '"$3"' }
    read() && ('"$2"') { x = value() + 0; low = n++ && low < x ? low : x; high = n > 1 && high > x ? high : x }
    END {
      if (n == 0) exit 1
      a = number(low, '"${4:-2}"'); b = number(high, '"${4:-2}"')
      print a == b ? a : a " to " b
    }' "$charts/$1/chart.csv"
}

# What the solvers above are, and the peers.
ours='f["solver"] != ""'
paper='f["name"] ~ /form paper/'
fine=$paper' && f["tolerance"] + 0 < 1e-2'
leaves=$ours' && f["polish"] == "on" && f["split"] != 1 && FNR > 2'
whole=$ours' && f["polish"] == "on" && f["split"] == 1'
power=$ours' && f["polish"] == "off" && !('$paper')'
name='f["name"] '
embree='f["family"] == "embree" && f["name"] ~ /8 coherent/'

# causes: rows of the matrix, a line for each class, order of the parameters, and method.
causes() {
  awk -F, 'NR > 1 && $7 > 0 {
    line = sprintf("| %s | %s | %s | %d | %d (%.2g ± %.1g %%)", $1, $2, $3, $5, $7, 100 * $7 / $5, 50 * ($9 - $8))
    for (k = 10; k <= 17; k++) line = line " | " ($k == 0 ? "" : $k)
    print line " |"
  }' docs/paper/causes.csv
}

# quantiles COLUMN CONDITION-COLUMN: of conditions.csv, the condition's median and 99 %, then those of error / (condition x 2^-53).
quantiles() {
  awk -F, -v e="$1" -v c="$2" 'NR > 1 { print $c, $e / ($c * 2^-53) }' docs/paper/conditions.csv >"$folder/pairs"
  for column in 1 2; do
    sort -g -k$column,$column "$folder/pairs" | awk -v k=$column '{ x[NR] = $k } END { printf "%.2g | %.2g | ", x[int((NR + 1) / 2)], x[int(0.99 * NR)] }'
  done
}

# digits CONDITION-COLUMN: the decimal digits that the median condition and that of the worst hundredth cost.
digits() {
  quantiles 4 "$1" | awk -F' [|] ' 'function lost(x) { return x > 1 ? sprintf("%.1f", log(x) / log(10)) : "0" } { print lost($1) " and " lost($2) }'
}

# stages SCENE SOLVER: of 100 rays tried on a leaf, how many come to which stage.
stages() {
  "$pscn" render "scenes/$1.pscn" --size 320x240 --quiet --solver "$2" -o "$folder/stages.png" --stats "$folder/stages.json"
  awk '/"bilinear"|"planes"|"resultant"|"roots": [0-9]/ { gsub(/[^0-9]/, "", $2); n[++k] = $2 }
    /"patches_tested"/ { gsub(/[^0-9]/, "", $2); all = $2 }
    END { for (k = 1; k <= 4; k++) printf " %.3g |", 100 * n[k] / all }' "$folder/stages.json"
}

gnuplot -e "conditions='docs/paper/conditions.csv'; out='docs/accuracy/conditions.svg'" examples/accuracy.gp
for scene in "${SCENES[@]}"; do
  for kind in csv svg; do cp "$charts/$scene/chart.$kind" "docs/accuracy/$scene.$kind"; done
done
{
  cat <<END
# Which method, when?

\`examples/accuracy.sh\` writes this page; the numbers are those of its last run. \`pscn chart SCENE\` charts any scene.

Several ways to find the hits of camera rays take turns on one thread. Every answer is judged by a reference in quadruple precision
([src/reference](../src/reference/reference.h), subdivision and Krawczyk's test), which shares nothing with the renderer. An answer is *wrong* if it misses a hit,
hits where there is none, or is more than 1 % away. The error of T is relative; 99 % of the right answers have at most the error shown.

## In short

- **The default, for pictures that must be right.** With polish no answer is wrong, whatever the solver, basis, tolerance, start and split, and all have the
  rounding error of doubles: a certificate proves every root, and the last resort decides the rest ([method.md](method.md)). On leaves few rays
  come to a root finder at all; \`newton\`, \`laguerre\` and \`aberth\` take
  $(span teapot "$leaves" 'f["ratio"]') (teapot) and $(span wild "$leaves" 'f["ratio"]') (wild) of the default's time. On whole patches, \`split 1\`, the solver matters:
  $(span teapot "$whole" 'f["ratio"]') and $(span wild "$whole" 'f["ratio"]').
- **Aberth's method, if it must be the paper's form.** At eps 1e-6 and 1e-10 it has $(span teapot "$fine"' && f["solver"] == "aberth"' 'bad()') wrong answers among
  $(span teapot "$paper" 'f["hits"]' 4) hits of the teapot and $(span wild "$fine"' && f["solver"] == "aberth"' 'bad()') among $(span wild "$paper" 'f["hits"]' 4) of the wild
  patches. Newton's and Laguerre's have $(span teapot "$fine"' && f["solver"] != "aberth"' 'bad()') and
  $(span wild "$fine"' && f["solver"] != "aberth"' 'bad()' 3). All take $(span teapot "$paper" 'f["ratio"]' 3) and $(span wild "$paper" 'f["ratio"]' 3) times the default's time. [paper.md](paper.md) says why.
- **Triangles, if a few wrong pixels do not matter.** Embree's packets of 8 rays take $(span teapot "$embree" 'f["ratio"]') and $(span wild "$embree" 'f["ratio"]') of the
  default's time, from 8 x 8 x 2 to 256 x 256 x 2 triangles a patch. The error is that of the triangles, and never below single precision.
- **Newton and interval Newton, among the rivals.** They take $(span teapot "$name"'~ /^Newton|Krawczyk/' 'f["ratio"]') and $(span wild "$name"'~ /^Newton|Krawczyk/' 'f["ratio"]') times the default's time, in scalar code. Bezier clipping takes
  $(span teapot "$name"'~ /clipping/' 'f["ratio"]') and $(span wild "$name"'~ /clipping/' 'f["ratio"]'), subdivision $(span teapot "$name"'~ /subdivision/' 'f["ratio"]' 3) and $(span wild "$name"'~ /subdivision/' 'f["ratio"]' 3). Eigenvalues take
  $(span teapot "$name"'~ /dhseqr|dggev/' 'f["ratio"]' 3) and $(span wild "$name"'~ /dhseqr|dggev/' 'f["ratio"]' 3), with errors of T of $(span teapot "$name"'~ /dhseqr|dggev/' 'f["t_99"]' 1) and $(span wild "$name"'~ /dhseqr|dggev/' 'f["t_99"]' 1).

## Two scenes

[scenes/teapot.pscn](../scenes/teapot.pscn): $(span teapot 'FNR == 2' 'f["rays"]' 5) camera rays, $(span teapot 'FNR == 2' 'f["hits"]' 5) hits ([all points](accuracy/teapot.csv)).

![The teapot: time against the error of right answers, and against the share of wrong answers](accuracy/teapot.svg)

[scenes/wild.pscn](../scenes/wild.pscn): $(span wild 'FNR == 2' 'f["rays"]' 5) camera rays, $(span wild 'FNR == 2' 'f["hits"]' 5) hits ([all points](accuracy/wild.csv)).

![Wild patches: time against the error of right answers, and against the share of wrong answers](accuracy/wild.svg)

$TABLE
| **default** | | | | | | | | |
$(rows 'FNR == 2')
| **leaves, polish** | | | | | | | | |
$(rows "$leaves")
| **whole patches, polish, \`start previous\`** | | | | | | | | |
$(rows "$whole")
| **leaves, \`basis power polish off start previous\`** | | | | | | | | |
$(rows "$power")
| **whole patches, \`form paper start previous\`** | | | | | | | | |
$(rows "$paper")
| **Embree, packets of 8 rays** | | | | | | | | |
$(rows "$embree")
| **POV-Ray, type 1** | | | | | | | | |
$(rows 'f["family"] == "povray" && f["name"] ~ /type 1, u_steps [357]/')

The default works on 4 rays at once with AVX2 and on 8 with AVX-512. Times are of a few thousand rays repeated many times, which favours large meshes: over a whole picture Embree's advantage is smaller
([performance.md](performance.md)).

## Rivals

Other published ways to intersect a ray with a patch, in scalar code under [src/chart](../src/chart): Newton's method from the middle of each part of a patch (Abert, Geimer, Müller 2006),
Bezier clipping (Nishita, Sederberg, Kakimoto 1990), interval Newton with Krawczyk's test (Toth 1985), plain subdivision (Whitted 1980), eigenvalues of the companion matrix of r, and of
the pencil of Bezout's matrix without its determinant (Manocha and Krishnan 1997), the last two by LAPACK. All get the same 8 x 8 parts of a patch, boxes and hierarchy, one ray
at a time, and the tolerance below which T gains no digit. None uses the nearest hit so far. Operations are counted by compiling them with a number type that counts
([rivals.cpp](../tests/operations/rivals.cpp)); for eigenvalues of an n x n matrix alone, 10 n^3 (dhseqr) and 30 n^3 (dggev) are added.

| | ns a ray | of the default's | operations a ray | parts tried a ray | error of T, 99 % | largest | wrong |
|---|---|---|---|---|---|---|---|
$(for scene in "${SCENES[@]}"; do rivals "$scene"; done)

## Why hits are lost

Every hit that the paper's form loses gets one cause ([causes.c](../tests/stability/causes.c)). eps is 1e-2 for Fig 16 and 1e-10 for all other rows. Each class is
taken as it is and with u and v exchanged. The value after ± is half of the interval of 95 %. A method that loses nothing has no row. The first cause that holds counts:

- *lower*: r's leading coefficients are roundings, because its true degree is lower;
- *far*: the same method finds the hit with \`deflation composite\` or \`radii polygon\`, so the cause is far roots found first;
- *tangent*, *projected*: another root of r is within 0.03 in u. If its point is near in v, too, the ray is nearly tangent; if not, only the projection onto u makes a double root;
- *rounding*: the method finds it if r is in Bernstein form; *euclid*: if v comes from the null vector; *loose*: if eps is 1e-12.

| class | parameters | method | hits | lost | lower | far | tangent | projected | rounding | euclid | loose | other |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
$(causes)

Laguerre's and Newton's methods fail by the order of their roots, and Aberth's where the projection or the ray itself makes roots coincide. The truth is the default's answer, which is certain for all of these rays.
The table of [paper.md](paper.md#the-order-in-which-roots-are-found) shows the same by changing one thing at a time.

## Condition

The condition number says how far a change of 2^-53 in the data moves the u of a hit. There are three: as a root of r in powers of u (sum of |c_k u^k| over |r'|), as a root of r in Bernstein form, and as a common root of a and b. For $(awk 'END { print NR - 1 }' docs/paper/conditions.csv) hits of random whole patches:

![Error over condition](accuracy/conditions.svg)

| | condition: median | 99 % | error over condition x 2^-53: median | 99 % |
|---|---|---|---|---|
| powers, form paper | $(quantiles 4 1)
| Bernstein form, no polish | $(quantiles 5 2)
| a and b, polish | $(quantiles 6 3)

The problem itself is well conditioned. Powers of u cost $(digits 1) digits (median and worst hundredth) before any solver starts; Bernstein form costs $(digits 2). Points above the line show the error of
forming the 19 coefficients, which no root finder can take back; polish on a and b does.

## Shares of the stages

Among 100 times that a ray is tried on a leaf, the number that come to each stage ([method.md](method.md#a-candidate-stage-by-stage)):

| | bilinear | planes | resultant | roots of r |
|---|---|---|---|---|
END
  for scene in "${SCENES[@]}"; do
    for solver in bernstein aberth 'aberth { split 1 }' 'aberth { form paper }'; do
      echo "| $scene, \`$solver\` |$(stages "$scene" "$solver")"
    done
  done
  cat <<'END'

A solver runs only in the last column. So a chart of `aberth` on leaves mostly measures the same bilinear start as the default.

## What the tests prove

Two judges examine the default's answers. They share nothing with it or with each other: the reference above, and exact integers with ball arithmetic
([exact.h](../tests/accuracy/exact.h)), which takes hits and misses, certain and grazing. `PSCN_EFFORT=full tests/run.sh TEST` runs a test whole.

| test | examines |
|---|---|
| `accuracy-leaks` | rays from inside closed bodies at shared edges, corners and poles: none may get out |
| `accuracy-classes`, `accuracy-certificate` | the classes in which such methods are known to fail, those that an adversary would aim at, and pictures of models |
| `corpus`, `corpus-families` | named hard polynomials and families of them: every root within the radius of its value, or reported as unknown |

Every solver's errors on the named polynomials are in [accuracy/corpus.csv](accuracy/corpus.csv). In doubles no solver finds many digits of multiple and clustered roots; a renderer that needs more goes
back to the patch, not to r.
END
} | cat -s >"$folder/page"
cp "$folder/page" docs/accuracy.md
echo "docs/accuracy.md is written" >&2
