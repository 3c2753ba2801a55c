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
if [ -z "${PSCN_CHARTS:-}" ]; then
  install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox libembree-dev liblapack-dev libflint-arb-dev libcmocka-dev
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DPSCN_TESTS=ON >/dev/null
  cmake --build build --target pscn pscn_embree pscn_lapack corpus_table >/dev/null
  for scene in "${SCENES[@]}"; do
    "$pscn" chart "scenes/$scene.pscn" "${solvers[@]}" "$@" -o "$charts/$scene" >/dev/null
  done
  build/tests/corpus/corpus_table >docs/accuracy/corpus.csv
fi

# For awk: read() puts a line of chart.csv into the array f, by the names of the columns. Only the name is in quotes,
# and may contain commas.
READ='
  function number(x, digits) { return x == "" ? "" : sprintf("%." digits "g", x) }
  function bad() { return f["lost"] + f["invented"] + f["wrong"] }
  function read(  n, k, part) {
    if (NR == 1) { columns = split($0, column, ","); return 0 }
    match($0, /"[^"]*"/)
    n = split(substr($0, 1, RSTART - 1) "name" substr($0, RSTART + RLENGTH), part, ",")
    for (k = 1; k <= n; k++) f[column[k]] = part[k]
    f["name"] = substr($0, RSTART + 1, RLENGTH - 2)
    return 1
  }'

# rows SCENE CONDITION [LIMIT]: the points that fulfil the condition, as rows of a table.
rows() {
  awk "$READ"'read() && ('"$2"') {
    printf "| %s | %s | %s | %s | %s | %d |\n", f["name"], number(f["ns_median"], 3), number(f["ratio"], 3),
      number(f["t_99"], 2), number(f["t_max"], 2), bad() }' "$charts/$1/chart.csv"
}
TABLE=$'| | ns a ray | of the default\'s | error of T, 99 % | largest | wrong |\n|---|---|---|---|---|---|'

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
leaves=$ours' && f["polish"] == "on" && f["split"] != 1 && NR > 2'
whole=$ours' && f["polish"] == "on" && f["split"] == 1'
power=$ours' && f["polish"] == "off" && !('$paper')'
name='f["name"] '
embree='f["family"] == "embree" && f["name"] ~ /8 coherent/'

# points SCENE: those of the figure.
points() {
  awk "$READ"'
    function point(solver, form, label) {
      print solver "," form "," (f["t_99"] + 0 > 1e-17 ? f["t_99"] : 1e-17) "," (bad() > 0 ? bad() / f["rays"] : 1e-4) "," \
        f["ns_median"] "," label
    }
    !read() { next }
    NR == 2 || '"$leaves"' { point(f["solver"], "leaves", "") }
    '"$whole"' { point(f["solver"], "whole", "") }
    '"$power"' { point(f["solver"], "power", "") }
    '"$paper"' { point(f["solver"], "paper", f["tolerance"]) }
    f["family"] == "rival" { point("rival", "rival", f["name"] ~ /by/ ? "eigenvalues" : f["name"] ~ /Krawczyk/ ? "Krawczyk" : f["name"] ~ /middle/ ? "Newton" : f["name"]) }
    '"$embree"' { split(f["name"], part, /[ x]/); point("Embree", "mesh", part[2]) }' "$charts/$1/chart.csv"
}

# causes CLASS: rows of the matrix, a line for each order of the parameters and method.
causes() {
  awk -F, 'NR > 1 && $7 > 0 {
    line = "| " $1 " | " $2 " | " $3 " | " $5 " | " $7
    line = line ($5 > 0 ? sprintf(" (%.1f %%, %.1f to %.1f)", 100 * $7 / $5, 100 * $8, 100 * $9) : "")
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

# stages SCENE SOLVER: of 100 rays tried on a leaf, how many come to which stage.
stages() {
  "$pscn" render "scenes/$1.pscn" --size 320x240 --quiet --solver "$2" -o "$folder/stages.png" --stats "$folder/stages.json"
  awk '/"bilinear"|"planes"|"resultant"|"roots": [0-9]/ { gsub(/[^0-9]/, "", $2); n[++k] = $2 }
    /"patches_tested"/ { gsub(/[^0-9]/, "", $2); all = $2 }
    END { for (k = 1; k <= 4; k++) printf " %.3g |", 100 * n[k] / all }' "$folder/stages.json"
}

mkdir -p docs/accuracy
gnuplot -e "conditions='docs/paper/conditions.csv'; out='docs/accuracy/conditions.svg'" examples/accuracy.gp
for scene in "${SCENES[@]}"; do
  points "$scene" >"$folder/points.csv"
  gnuplot -e "chart='$folder/points.csv'; out='docs/accuracy/$scene.svg'; name='scenes/$scene.pscn'" examples/accuracy.gp
  cp "$charts/$scene/chart.csv" "docs/accuracy/$scene.csv"
done
{
  cat <<END
# Which method, when?

Written by \`examples/accuracy.sh\`; the numbers are those of its last run. \`pscn chart SCENE\` charts any scene, with every
basis, tolerance, start and split (\`--quick\`: in seconds).

Ways to answer the camera rays of two scenes take turns on one thread. Every answer is judged by a reference in quadruple precision that shares
nothing with the renderer ([src/reference](../src/reference/reference.h)): subdivision and Krawczyk's test. *Wrong* is a hit answered by a miss,
a miss by a hit, or a hit more than 1 % away; the error of T is relative, of the right answers.

## In short

- **For pictures that must be right, the default.** Whatever the solver, basis, tolerance, start and split, every answer with polish has the
  rounding error of doubles, and none is wrong: Newton's method on the patch and its certificate decide, and what they leave open goes to the
  last resort. On leaves few candidates come to a root finder at all (see the shares below); \`newton\`, \`laguerre\` and \`aberth\` take
  $(span teapot "$leaves" 'f["ratio"]') (teapot) and $(span wild "$leaves" 'f["ratio"]') (wild) of the default's time. The choice matters on whole patches, \`split 1\`:
  $(span teapot "$whole" 'f["ratio"]') and $(span wild "$whole" 'f["ratio"]').
- **Of the paper's form, Aberth's method** at eps 1e-6 and 1e-10: $(span teapot "$paper"' && f["solver"] == "aberth" && f["tolerance"] + 0 < 1e-2' 'bad()') wrong answers of
  $(span teapot "$paper" 'f["hits"]' 4) on the teapot, $(span wild "$paper"' && f["solver"] == "aberth" && f["tolerance"] + 0 < 1e-2' 'bad()') of $(span wild "$paper" 'f["hits"]' 4) on the wild
  patches; Newton's and Laguerre's keep $(span teapot "$paper"' && f["solver"] != "aberth" && f["tolerance"] + 0 < 1e-2' 'bad()') and
  $(span wild "$paper"' && f["solver"] != "aberth" && f["tolerance"] + 0 < 1e-2' 'bad()' 3). They take $(span teapot "$paper" 'f["ratio"]' 3) and $(span wild "$paper" 'f["ratio"]' 3) times the default's time. [paper.md](paper.md) says why.
- **Where a missing pixel does not matter, triangles.** Embree's packets of 8 rays take $(span teapot "$embree" 'f["ratio"]') and $(span wild "$embree" 'f["ratio"]') of the
  default's time, from 8 x 8 x 2 to 256 x 256 x 2 triangles a patch; the error is that of the triangles, and never below single precision.
- **Among the rivals, Newton and interval Newton.** They take $(span teapot "$name"'~ /^Newton|Krawczyk/' 'f["ratio"]') and $(span wild "$name"'~ /^Newton|Krawczyk/' 'f["ratio"]') times the default's time, in scalar code; Bezier clipping
  $(span teapot "$name"'~ /clipping/' 'f["ratio"]') and $(span wild "$name"'~ /clipping/' 'f["ratio"]'), subdivision $(span teapot "$name"'~ /subdivision/' 'f["ratio"]' 3) and $(span wild "$name"'~ /subdivision/' 'f["ratio"]' 3). Eigenvalues take
  $(span teapot "$name"'~ /dhseqr|dggev/' 'f["ratio"]' 3) and $(span wild "$name"'~ /dhseqr|dggev/' 'f["ratio"]' 3); those of the companion matrix lose half of the digits, those of the pencil a quarter.

END
  for scene in "${SCENES[@]}"; do
    case $scene in
    teapot) echo "## The teapot" ;;
    wild) echo "## Wild patches" ;;
    esac
    cat <<END

[scenes/$scene.pscn](../scenes/$scene.pscn), $(span "$scene" 'NR == 2' 'f["rays"]' 5) camera rays, $(span "$scene" 'NR == 2' 'f["hits"]' 5) hits. All points: [accuracy/$scene.csv](accuracy/$scene.csv).

![Time against error, and against the share of wrong answers](accuracy/$scene.svg)

$TABLE
| **default** | | | | | |
$(rows "$scene" 'NR == 2')
| **leaves, polish** | | | | | |
$(rows "$scene" "$leaves")
| **whole patches, polish** | | | | | |
$(rows "$scene" "$whole")
| **power basis on leaves, no polish, eps 1e-8** | | | | | |
$(rows "$scene" "$power")
| **the paper's form, warm** | | | | | |
$(rows "$scene" "$paper")
| **rivals, 8 x 8 parts a patch, scalar** | | | | | |
$(rows "$scene" 'f["family"] == "rival"')
| **Embree, 8 coherent rays** | | | | | |
$(rows "$scene" "$embree")
| **POV-Ray, type 1** | | | | | |
$(rows "$scene" 'f["family"] == "povray" && f["name"] ~ /type 1, u_steps [357]/')

END
  done
  cat <<END
The rivals, each from its publication, are in [src/chart](../src/chart): Newton's method from the middle of each part (Abert, Geimer, Müller 2006),
Bezier clipping (Nishita, Sederberg, Kakimoto 1990), interval Newton with Krawczyk's test (Toth 1985), plain subdivision (Whitted 1980), eigenvalues of the companion matrix of r, and of
the pencil of Bezout's matrix without its determinant (Manocha and Krishnan 1997), both by LAPACK. All get the same parts of patches, boxes and hierarchy, one ray
at a time, and the tolerance below which T gains no digit. None is told the nearest hit so far. The default works on 4 rays at once with AVX2, 8 with
AVX-512. Times are of a few thousand rays asked again and again, which favours large meshes: over a whole picture Embree's advantage is smaller ([performance.md](performance.md)).

## Why hits are lost

Every hit that the paper's form loses, by [tests/stability/causes.c](../tests/stability/causes.c): eps 1e-2 (Fig 16), 1e-10 (all others), in brackets the share with its interval of 95 %. Each class is
taken as it is and with u and v exchanged; a method that loses nothing has no row. A lost hit counts for the first cause that holds:

- *lower*: r's leading coefficients are roundings, because its true degree is lower;
- *far*: the same method finds the hit with \`deflation composite\` or \`radii polygon\`, so far roots found first have spoilt it;
- *tangent*, *projected*: another root of r is within 0.03 in u, and its point near in v, too; or not, so that only the projection onto u makes a double root;
- *rounding*: the method finds it if r is written in Bernstein form; *euclid*: if v is the null vector's; *loose*: if eps is 1e-12.

| class | parameters | method | hits | lost | lower | far | tangent | projected | rounding | euclid | loose | other |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
$(causes)

So Laguerre's and Newton's methods fail by the order of their roots, and Aberth's where the projection or the ray itself makes roots meet. With polish all of these rays are answered right and certain. The table of
[paper.md](paper.md#the-order-in-which-roots-are-found) shows the same by changing one thing at a time.

## Condition

How far a change of 2^-53 in its data moves the u of a hit: as a root of r in powers of u (sum of |c_k u^k| over |r'|), as a root of r in Bernstein form, and as a common root of a and b. $(awk 'END { print NR - 1 }' docs/paper/conditions.csv) hits of random patches, whole:

![Error over condition](accuracy/conditions.svg)

| | condition: median | 99 % | error over condition x 2^-53: median | 99 % |
|---|---|---|---|---|
| powers, form paper | $(quantiles 4 1)
| Bernstein form, no polish | $(quantiles 5 2)
| a and b, polish | $(quantiles 6 3)

The problem itself is well conditioned. Powers of u lose five digits in the median, and nine at the worst hundredth, before any solver starts; Bernstein form loses none in the median. What lies above the line is the error of
forming the 19 coefficients, which no root finder can take back; polish on a and b does.

## Shares of the stages

Of 100 times that a ray is tried on a leaf, how many need which stage ([method.md](method.md)):

| | bilinear | planes | resultant | roots of r |
|---|---|---|---|---|
END
  for scene in "${SCENES[@]}"; do
    for solver in bernstein aberth 'aberth { split 1 }' 'aberth { form paper }'; do
      echo "| $scene, \`$solver\` |$(stages "$scene" "$solver")"
    done
  done
  cat <<'END'

Only in the rows with roots of r does a solver run. A chart of `aberth` on leaves measures, in nearly all of its rays, the same bilinear start as the default.

## What the tests prove

The default's answers are put to two judges, which share nothing with it or with each other: the reference above, and exact integers with ball arithmetic ([tests/accuracy/exact.h](../tests/accuracy/exact.h)), which takes
hits and misses, certain and grazing. The commands print the counts of their run:

| | what |
|---|---|
| `PSCN_EFFORT=full tests/run.sh accuracy-camera` | all pixels of seven scenes: nothing lost, nothing invented, errors of T below 3e-16 |
| `accuracy-random-patches` | a million random rays |
| `accuracy-leaks` | ten million rays from inside closed bodies at shared edges, corners and poles: none may get out |
| `accuracy-classes`, `accuracy-certificate` | the classes in which such methods are known to fail, and those that an adversary would aim |
| `corpus`, `corpus-families` | named hard polynomials and ten families of 1,000: every root within the radius of its value, or said to be unknown |

Every solver's errors on the named polynomials stand in [accuracy/corpus.csv](accuracy/corpus.csv). Multiple and clustered roots are known to few digits in doubles, by any solver; a renderer that needs more goes
back to the patch, not to r.
END
} | cat -s >"$folder/page"
cp "$folder/page" docs/accuracy.md
echo "docs/accuracy.md is written" >&2
