#!/bin/bash
# Regenerates docs/paper.md with every table and figure of docs/paper/, the numbers in its text included: some minutes,
# on an otherwise idle machine. Counts are the same every time; times are not.
#
#   examples/paper.sh             everything
#   examples/paper.sh PART...     only these, with the programs as they are built: curves random claims patch pictures ways
#                                 field causes teapot page; the last makes the figures and the page of the CSV files as
#                                 they are
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

data=docs/paper
programs=build/examples/paper
pscn=build/src/command/pscn
paper='form paper start previous max_iterations 500'
kinds='hole_background,hole_farther,phantom_before,phantom_background'

# Writes standard input under a name of $data.
keep() { cat >"$data/$1.new" && mv "$data/$1.new" "$data/$1"; }

build() {
  install_packages "${BUILD_PACKAGES[@]}" gnuplot-nox
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build build --target pscn random_experiments patch_experiments picture_errors footing claims >/dev/null
}

# Fig 1: eq 3 of a ray with three hits, and the common roots on the patch. And the roots of r for a ray that Aberth's
# method loses: that of the hit, and the nearest other one.
curves() {
  ray='3.5 4 -8.5 -0.55341152527134552 -0.34365070520881941 0.75870934916232857'
  echo "$ray" | "$pscn" trace scenes/paper.pscn --explain --solver 'aberth { form paper tolerance 1e-12 max_iterations 500 }' |
    awk 'BEGIN { print "curve,i,j,value" }
      $1 == "a:" || $1 == "b:" { for (k = 0; k < 16; k++) printf "%s,%d,%d,%s\n", substr($1, 1, 1), k / 4, k % 4, $(k + 2) }
      /, T = / { sub(/,/, "", $3); v = $0; sub(/.*, v = /, "", v); sub(/,.*/, "", v); printf "root,%s,%s,\n", $3, v }' |
    keep fig01.csv
  echo '3.5 4 -8.5 -2.3 -3.488 7.5' | "$pscn" trace scenes/paper.pscn --explain --solver 'aberth { form paper tolerance 1e-12 max_iterations 500 }' |
    awk 'BEGIN { print "root,u,v" }
      / v = / { v = $0; sub(/.* v = /, "", v); sub(/[ ,].*/, "", v); u[++n] = $3; at[n] = v; if (/, T = /) hit = n }
      END { for (k = 1; k <= n; k++) { gap = u[k] - u[hit]; gap = gap < 0 ? -gap : gap; if (k != hit && (!other || gap < least)) { least = gap; other = k } }
        printf "hit,%s,%s\nother,%s,%s\n", u[hit], at[hit], u[other], at[other] }' | keep projected.csv
}

# Fig 2-12, the improvements, the cap of steps: random polynomials. Fig 2, 4, 5, 9 on an equal footing.
random() {
  { echo model; sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -1; } | keep machine.csv
  for experiment in degrees tolerances order improvements caps; do
    echo "$experiment"
    "$programs/random_experiments" "$experiment" | keep "$experiment.csv"
  done
  for experiment in degrees tolerances; do
    echo "$experiment on an equal footing"
    "$programs/footing" "$experiment" | keep "footing_$experiment.csv"
  done
}

# What the paper says without a figure.
claims() {
  for claim in lower nearest starts slopes; do "$programs/claims" "$claim" | keep "$claim.csv"; done
}

# Fig 13-15: the patch, 100 x 75 rays.
patch() {
  "$programs/patch_experiments" scenes/paper.pscn 100 75 | keep patch.csv
  "$programs/footing" patch scenes/paper.pscn 100 75 | keep footing_patch.csv
}

# How many pixels are wrong, and how: leading columns, scene, solver; also the picture and a map.
errors() {
  printf '%s,' "$1"
  "$programs/picture_errors" "$2" 320 240 "$3" "${4:-$data/unused}"
}

# Fig 16 and 17: the paper's own form, eps 1e-2, and 200 x magnified, eps 1e-10, line by line; and the default solver.
# Beside each picture a map of its wrong pixels, and the number of each kind.
pictures() {
  for figure in 'fig16 paper 1e-2' 'fig17 paper_magnified 1e-10'; do
    read -r name scene eps <<<"$figure"
    "$pscn" render "scenes/$scene.pscn" -o "$data/$name-default.png" --size 320x240 --quiet
    for method in newton laguerre aberth; do
      solver="$method { $paper tolerance $eps }"
      errors "$name,$method" "scenes/$scene.pscn" "$solver" "$data/$name-$method"
    done
  done | { echo "figure,method,$kinds"; cat; } | keep pictures.csv

  # The residual at which Euclid's v is an answer, and the cap of steps, Fig 16.
  for residual in 1e-2 5e-3 2.5e-3 1e-3 1; do
    for method in newton laguerre aberth; do
      errors "$residual,$method" scenes/paper.pscn "$method { $paper tolerance 1e-2 residual $residual }"
    done
  done | { echo "residual,method,$kinds"; cat; } | keep residual.csv
  for cap in 10 20 50 100 500; do
    for method in newton laguerre aberth; do
      errors "$cap,$method" scenes/paper.pscn "$method { $paper tolerance 1e-2 max_iterations $cap }"
    done
  done | { echo "cap,method,$kinds"; cat; } | keep picture_caps.csv
  rm "$data"/unused*.png
}

# A scene of one patch with u and v exchanged.
exchanged() {
  "$pscn" dump "$1" | awk '
    /^  </ { rest = $0; while (match(rest, /<[^>]*>/)) { point[count++] = substr(rest, RSTART, RLENGTH); rest = substr(rest, RSTART + RLENGTH) }
      if (count == 16) for (k = 0; k < 16; k++) print "  " point[4 * (k % 4) + int(k / 4)]
      next }
    { print }'
}

# Fig 16 and 17 with one thing changed: how far roots found first spoil those behind them.
ways() {
  for figure in 'fig16 paper 1e-2' 'fig17 paper_magnified 1e-10'; do
    read -r name scene eps <<<"$figure"
    exchanged "scenes/$scene.pscn" >"$data/unused.pscn"
    for method in newton laguerre aberth; do
      for way in 'deflation composite' 'radii polygon' 'refine on'; do
        errors "$name,$way,$method" "scenes/$scene.pscn" "$method { $paper tolerance $eps $way }"
      done
      errors "$name,exchanged,$method" "$data/unused.pscn" "$method { $paper tolerance $eps }"
    done
  done | { echo "figure,way,method,$kinds"; cat; } | keep ways.csv
  rm "$data"/unused*
}

# Rays within 7 degrees of the axis of a height field, where the true degree of r is lower: how many hits are found.
field() {
  awk 'function random() { state = (state * 16807) % 2147483647; return state / 2147483647 }
    BEGIN { state = 52
      for (n = 0; n < 500; n++) {
        turn = 6.283185307179586 * random(); tilt = 0.1228 * sqrt(random()); x = 7 * random() - 3.5; z = 7 * random() - 3.5
        printf "%.17g 8 %.17g %.17g -1 %.17g\n", x - 8 * tilt * cos(turn), z - 8 * tilt * sin(turn), tilt * cos(turn), tilt * sin(turn)
      } }' >"$data/unused.rays"
  "$pscn" trace scenes/waves.pscn <"$data/unused.rays" >"$data/unused.hits"
  for method in newton laguerre aberth; do
    for way in printed 'radii polygon' 'deflation composite'; do
      "$pscn" trace scenes/waves.pscn --quiet <"$data/unused.rays" \
        --solver "$method { form paper tolerance 1e-10 max_iterations 500 ${way#printed} }" | paste -d' ' "$data/unused.hits" - |
        awk -v name="$method,$way" '$1 == "hit" { all++; off = $10 - $2; found += $9 == "hit" && off * off <= (1e-2 * $2) ^ 2 }
          END { print name "," all "," found + 0 }'
    done
  done | { echo 'method,way,hits,found'; cat; } | keep field.csv
  rm "$data"/unused*
}

# Why hits are lost, class by class, and the condition of every root (tests/stability/causes.c).
causes() {
  cmake -S . -B build -DPSCN_TESTS=ON >/dev/null
  cmake --build build --target stability-causes >/dev/null
  PSCN_EFFORT=full build/tests/stability/stability-causes | keep causes.csv
  build/tests/stability/stability-causes projected | keep near.csv
  build/tests/stability/stability-causes conditions | keep conditions.csv
}

# The share of the teapot's roots that are found, counted as by its test (tests/stability/teapot_roots.c).
teapot() {
  install_packages libcmocka-dev
  cmake -S . -B build -DPSCN_TESTS=ON >/dev/null
  cmake --build build --target stability-teapot-roots >/dev/null
  { echo 'all,pairs,undecided,roots,unpolished,paper,right,hits'
    PSCN_EFFORT=full build/tests/stability/stability-teapot-roots |
      sed -n 's/^\([0-9]*\) pairs (\([0-9]*\) undecided), \([0-9]*\) roots; .* unpolished \([0-9.]*\) %, .* form \([0-9.]*\) %; polished: \([0-9]*\) of \([0-9]*\) .*/teapot,\1,\2,\3,\4,\5,\6,\7/p'
  } | keep teapot.csv
}

page() {
  gnuplot -e "data='$data'" examples/paper/figures.gp
  awk -v data="$data" -f examples/paper/fill.awk examples/paper/paper.md.in >docs/paper.md
}

mkdir -p "$data"
for part in "${@:-build curves random claims patch pictures ways field causes teapot page}"; do
  for name in $part; do
    case $name in
    build | curves | random | claims | patch | pictures | ways | field | causes | teapot | page) ;;
    *) echo "paper.sh: there is no part '$name'" >&2 && exit 2 ;;
    esac
    echo "$name"
    "$name"
  done
done
echo "docs/paper.md shows what is in $data"
