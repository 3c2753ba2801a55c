#!/bin/bash
# Whole-process CPU time of one 800x600 teapot, one thread: pscn beside POV-Ray on the same file.
#
# Both read the same scene, trace every pixel once with shadows, and write a PNG. POV-Ray's patches are at u_steps 5,
# v_steps 5, flatness 0, as the file says. The runs take turns; the medians and their ratio are printed.
#
#   examples/benchmark.sh [SCENE] [RUNS]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh

scene=${1:-scenes/teapot.pscn}
runs=${2:-5}
size=800x600
install_packages "${BUILD_PACKAGES[@]}" povray libembree-dev
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build >/dev/null
pscn=$PWD/build/src/command/pscn
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/home"

# CPU seconds (user and system) of a command whose words follow.
cpu_seconds() {
  local TIMEFORMAT='%U %S' times
  times=$( { time "$@" >"$folder/log" 2>&1; } 2>&1 ) || { cat "$folder/log" >&2; return 1; }
  LC_ALL=C awk '{ print $1 + $2 }' <<<"$times"
}

run_pscn() { cpu_seconds "$pscn" render "$scene" --size "$size" --threads 1 --quiet -o "$folder/pscn.png"; }

run_povray() {
  (cd "$(dirname "$scene")" && HOME=$folder/home cpu_seconds povray "+I$(basename "$scene")" "+O$folder/povray.png" \
    "+W${size%x*}" "+H${size#*x}" +WT1 -D -A)
}

median() { sort -n "$1" | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }

export LC_ALL=C
for ((run = 1; run <= runs; run++)); do
  run_pscn >>"$folder/pscn.times"
  run_povray >>"$folder/povray.times"
done
ours=$(median "$folder/pscn.times")
theirs=$(median "$folder/povray.times")
echo "$scene, $size, one thread, CPU seconds of the whole process, median of $runs runs taking turns:"
printf '  pscn    %6.3f   (%s)\n' "$ours" "$(sort -n "$folder/pscn.times" | paste -sd ' ')"
printf '  povray  %6.3f   (%s)\n' "$theirs" "$(sort -n "$folder/povray.times" | paste -sd ' ')"
awk -v a="$ours" -v b="$theirs" 'BEGIN { printf "  ratio   %6.3f\n", a / b }'

echo
if cmake --build build --target primary_rays >/dev/null 2>&1; then
  build/examples/benchmark/primary_rays "$scene" "$runs" 128 'aberth { start previous split 1 }' 'aberth { start cold split 1 }'
else
  echo "Embree is not installed (libembree-dev): its part is left out"
fi
