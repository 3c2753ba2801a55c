#!/bin/bash
# Regenerates every table and figure of docs/paper.md in docs/paper/: about two minutes, on an otherwise idle machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

install_packages "${BUILD_PACKAGES[@]}" gnuplot-nox
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release
cmake --build build --target pscn random_experiments patch_experiments
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

# Fig 16 and 17: the paper's own form, eps 1e-2, and 200 x magnified, eps 1e-10; and the default solver.
paper='form paper basis power resultant sylvester back_substitution euclid polish off split 1'
paper="$paper start previous max_iterations 500"
for method in newton laguerre aberth; do
  build/src/command/pscn render scenes/paper.pscn -o "$data/fig16-$method.png" --size 320x240 --quiet \
    --solver "$method { $paper tolerance 1e-2 }"
  build/src/command/pscn render scenes/paper_magnified.pscn -o "$data/fig17-$method.png" --size 320x240 --quiet \
    --solver "$method { $paper tolerance 1e-10 }"
done
build/src/command/pscn render scenes/paper.pscn -o "$data/fig16-default.png" --size 320x240 --quiet
build/src/command/pscn render scenes/paper_magnified.pscn -o "$data/fig17-default.png" --size 320x240 --quiet

# How many pixels differ visibly (by more than 4/255) from the default solver's picture.
echo 'picture,method,different_percent' >"$data/pictures.csv"
for figure in 16 17; do
  for method in newton laguerre aberth; do
    { build/src/command/pscn compare "$data/fig$figure-default.png" "$data/fig$figure-$method.png" || true; } \
      2>/dev/null | sed -n "s|^over 4/255 .* pixels, \([^ ]*\) %|$figure,$method,\1|p"
  done
done >>"$data/pictures.csv"
echo "docs/paper.md shows what is in $data"
