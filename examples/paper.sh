#!/bin/bash
# Regenerates docs/paper.md with every table and figure of docs/paper/, the numbers in its text included: some minutes, on an
# otherwise idle machine. Counts are the same every time; times are not.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

install_packages "${BUILD_PACKAGES[@]}" gnuplot-nox
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release
cmake --build build --target pscn random_experiments patch_experiments picture_errors
data=docs/paper
mkdir -p "$data"

# Fig 2-12 and the table of improvements: random polynomials.
for experiment in degrees tolerances order improvements; do
  echo "$experiment"
  build/examples/paper/random_experiments "$experiment" >"$data/$experiment.csv"
done

# Fig 13-15: the patch, 100 x 75 rays.
echo patch
build/examples/paper/patch_experiments scenes/paper.pscn 100 75 >"$data/patch.csv"

gnuplot -e "data='$data'" examples/paper/figures.gp

# Fig 16 and 17: the paper's own form, eps 1e-2, and 200 x magnified, eps 1e-10; and the default solver. Beside each picture
# a map of what is wrong in it, and how many pixels of each kind.
echo pictures
paper='form paper start previous max_iterations 500'
for figure in 'fig16 paper 1e-2' 'fig17 paper_magnified 1e-10'; do
  read -r name scene eps <<<"$figure"
  build/src/command/pscn render "scenes/$scene.pscn" -o "$data/$name-default.png" --size 320x240 --quiet
  for method in newton laguerre aberth durand_kerner; do
    solver="$method { $paper tolerance $eps }"
    build/src/command/pscn render "scenes/$scene.pscn" -o "$data/$name-$method.png" --size 320x240 --quiet --solver "$solver"
    printf '%s,%s,' "$name" "$method"
    build/examples/paper/picture_errors "scenes/$scene.pscn" 320 240 "$solver" "$data/$name-$method-map.png"
  done
done >"$data/rows"
{ echo 'figure,method,hole_background,hole_farther,phantom_before,phantom_background'; cat "$data/rows"; } >"$data/pictures.csv"

# The residual at which Euclid's v is an answer, Fig 16.
for residual in 1e-2 5e-3 2.5e-3 1e-3 1; do
  for method in newton laguerre aberth; do
    printf '%s,%s,' "$residual" "$method"
    build/examples/paper/picture_errors scenes/paper.pscn 320 240 "$method { $paper tolerance 1e-2 residual $residual }" \
      "$data/map.png"
  done
done >"$data/rows"
{ echo 'residual,method,hole_background,hole_farther,phantom_before,phantom_background'; cat "$data/rows"; } >"$data/residual.csv"
rm "$data/rows" "$data/map.png"

awk -v data="$data" -f examples/paper/fill.awk examples/paper/paper.md.in >docs/paper.md
echo "docs/paper.md shows what is in $data"
