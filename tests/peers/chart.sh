#!/bin/bash
# The peers of `pscn chart`: each point of a peer has a time, and finer meshes are nearer the surface. A mesh's error
# falls with the square of its number of sides, so from one of the quick chart's meshes to the next, 4 or 8 times as
# fine, at least by a factor of 16; LEAST_GAIN leaves room for the few rays of a small chart. Prints which peers are
# there.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh"
LEAST_GAIN=5
"$PSCN" chart "$PSCN_SOURCE_DIR/scenes/bent.pscn" --quick --size 160x120 --rays 512 --rounds 1 -o chart \
  >/dev/null 2>said
peers=()
grep -q 'Embree is left out: there is no' said || peers+=(embree)
! command -v povray >/dev/null || peers+=(povray)
[ ${#peers[@]} -gt 0 ] || { echo "skipped: neither Embree's module nor povray is there" >&2; exit 77; }

failed=0
# The figure, if gnuplot drew one: the default is labelled, and pointing at a symbol shows its name.
if [ -e chart/chart.svg ]; then
  for text in '>default<' '<title>bernstein: [0-9.]* ns, error [0-9.e-]*</title>' '<text>7</text>' '</svg>'; do
    grep -q "$text" chart/chart.svg || { echo "the figure has no $text"; failed=1; }
  done
fi
for peer in "${peers[@]}"; do
  # Embree's points one by one: the coherent ones have the same answers.
  awk -v peer="$peer" -v gain="$LEAST_GAIN" '
    NR == 1 { n = split($0, column, ","); for (k = 1; k <= n; k++) at[column[k]] = k; next }
    {
      match($0, /"[^"]*"/); name = substr($0, RSTART + 1, RLENGTH - 2)
      split(substr($0, 1, RSTART - 1) "name" substr($0, RSTART + RLENGTH), f, ",")
      if (f[1] != peer || name ~ /coherent/) next
      count++
      if (!(f[at["ns_median"]] > 0)) { print name ": no time"; bad = 1 }
      error = f[at["t_99"]] + 0
      if (!(error > 0) || (count > 1 && !(error * gain < last))) { print name ": error " error " after " last; bad = 1 }
      last = error
    }
    END { print peer ": " count + 0 " meshes, the finest within " last; exit bad || count != 3 }' \
    chart/chart.csv || failed=1
done
exit "$failed"
