#!/bin/bash
# Compares the answers of two builds bit for bit: `tests/same_answers.sh OLD NEW`, two programs `pscn`. For a change
# that should change no answer: every scene of scenes/, the solvers and forms below, every instruction set of the
# processor; camera-like and random rays from a fixed generator. Prints the differences; exits 1 if there are any.
# RAYS=N sets the number of rays a scene (2000).
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: $0 OLD NEW" >&2; exit 2; }
old=$(realpath "$1") new=$(realpath "$2") # not what PATH would find by such a name
for program in "$old" "$new"; do
  "$program" --version >/dev/null || { echo "$0: $program is no program 'pscn'" >&2; exit 2; }
done
folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

forms=('' 'bernstein { split 1 }' 'bernstein { split 3 }' 'newton' 'laguerre { start previous }' 'aberth'
  'aberth { split 1 start previous }' 'aberth { basis power }' 'aberth { basis power resultant sylvester
  back_substitution euclid polish off split 1 }' 'newton { polish off split 1 }')

# Half of the rays go from a sphere of radius 12 towards points near the middle, half start near it.
awk -v n="${RAYS:-2000}" 'BEGIN { srand(20240511); for (k = 0; k < n; k++) {
  far = k % 2 ? 12 : 2
  for (c = 0; c < 3; c++) { o[c] = far * (2 * rand() - 1); t[c] = 2.5 * (2 * rand() - 1) + (c == 1) }
  printf "%.17g %.17g %.17g %.17g %.17g %.17g\n", o[0], o[1], o[2], t[0] - o[0], t[1] - o[1], t[2] - o[2] } }' \
  >"$work/rays"

kernels=()
for kernel in baseline avx2 avx512; do
  if head -n 1 "$work/rays" | PSCN_KERNEL=$kernel "$new" trace --quiet "$folder/scenes/inside.pscn" >/dev/null 2>&1; then
    kernels+=("$kernel")
  fi
done

differ=0 compared=0
for scene in "$folder"/scenes/*.pscn; do
  for form in "${forms[@]}"; do
    for kernel in "${kernels[@]}"; do
      for side in old new; do
        PSCN_KERNEL=$kernel "${!side}" trace --quiet --certainty ${form:+--solver "$form"} "$scene" \
          <"$work/rays" >"$work/$side" 2>"$work/$side.err" || echo "exit $?" >>"$work/$side"
      done
      compared=$((compared + 1))
      if ! cmp -s "$work/old" "$work/new"; then
        differ=$((differ + 1))
        echo "$(basename "$scene"), $kernel, solver '$form': $(diff "$work/old" "$work/new" | grep -c '^<') rays"
      fi
    done
  done
done
echo "$compared comparisons, $differ differ"
[ "$differ" -eq 0 ]
