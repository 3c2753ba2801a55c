#!/bin/bash
# Speed against accuracy, measured: writes docs/accuracy.md and its pictures in docs/accuracy/ by `pscn chart`.
#
#   examples/accuracy.sh [OPTION...]     options of `pscn chart`, such as --quick
#
# Takes some ten minutes, a minute with --quick. $PSCN_CHARTS, if set, is a folder with the charts teapot/ and wild/ of an earlier
# run, from which the page is written without measuring.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

SCENES=(teapot wild)
if [ -z "${PSCN_CHARTS:-}" ]; then
  install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox libembree-dev
  cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build build >/dev/null
  charts=$(mktemp -d)
  trap 'rm -rf "$charts"' EXIT
  for scene in "${SCENES[@]}"; do
    build/src/command/pscn chart "scenes/$scene.pscn" "$@" -o "$charts/$scene" >/dev/null
  done
else
  charts=$PSCN_CHARTS
fi

# The rows of a chart.csv that awk's condition $2 chooses, as a table; columns by their names. The name is the only field in
# quotes, and has commas.
rows() {
  awk -v want="$2" '
    function field(name) { return f[at[name]] }
    function number(x, digits) { return x == "" ? "" : sprintf("%." digits "g", x) }
    NR == 1 { n = split($0, f, ","); for (k = 1; k <= n; k++) at[f[k]] = k; next }
    {
      match($0, /"[^"]*"/); name = substr($0, RSTART + 1, RLENGTH - 2)
      line = substr($0, 1, RSTART - 1) "name" substr($0, RSTART + RLENGTH); split(line, f, ",")
      if (want == "front" ? field("front") != 1 && NR != 2 : !(field("family") == want)) next
      printf "| %s%s | %s (%s, %s) | %s | %s | %s | %s | %s | %s | %s |\n", name, field("front") == 1 ? " *" : "",
        number(field("ns_median"), 4), number(field("ns_lower"), 4), number(field("ns_upper"), 4), number(field("ratio"), 3),
        number(field("t_median"), 2), number(field("t_99"), 2), number(field("t_max"), 2), field("lost"), field("invented"), field("wrong")
    }' "$1"
}

# The fastest row of each solver with polish and start, of one family, by the median time.
best() {
  for family in newton laguerre aberth paper; do
    awk -v want="$family" 'NR == 1 { n = split($0, h, ","); for (k = 1; k <= n; k++) at[h[k]] = k; print; next }
      { match($0, /"[^"]*"/); line = substr($0, 1, RSTART - 1) "name" substr($0, RSTART + RLENGTH); split(line, f, ",")
        if (f[1] != want || f[at["lost"]] + f[at["invented"]] + f[at["wrong"]] > 0) next
        if (best == "" || f[at["ns_median"]] + 0 < best + 0) { best = f[at["ns_median"]]; row = $0 } }
      END { if (row != "") print row }' "$1" >"$1.best"
    rows "$1.best" "$family"
    rm "$1.best"
  done
}

mkdir -p docs/accuracy
page=$(mktemp)
{
  cat <<'END'
# Speed against accuracy

Written by `examples/accuracy.sh`; the numbers are those of its last run. For any scene:

    pscn chart scenes/teapot.pscn            # teapot-chart/chart.html, chart.svg, chart.csv; --quick: under a minute

Camera rays of the scene, chosen evenly, and their shadow rays are answered by every solver, basis, tolerance (1e-1 to 1e-15), with polish
and without, cold and warm, as in the paper, and by the peers: plain 2-D Newton from the middle of each part of a patch, which guards
nothing; Embree on triangles; POV-Ray. All take turns on one thread; a time is the median over the rounds, in
brackets its quartiles, and the ratio is the median of the ratios to the default solver within a round. Every answer is judged by the
reference ([src/reference/reference.h](../src/reference/reference.h)): subdivision and Krawczyk's test in quadruple precision, which
shares nothing with the renderer.

- **error of T**: relative, of the rays that both hit.
- **lost**, **invented**: a hit answered by a miss, a miss answered by a hit. **wrong**: both hit, more than 1 % apart.
- In the figures the error is that of 99 % of the rays, and a lost, invented or wrong answer counts as 1. Symbols of points with some
  of those are hollow. Bars are quartiles of the time. The front joins what nothing else beats in both; its points bear a star in
  the tables.
- Embree's rays are single precision; its own program measures it, with pscn's default beside it in every round. POV-Ray's errors
  are those of its `trace()`, its time the CPU time of its trace phase for every pixel of the scene in white without lights.

END
  for scene in "${SCENES[@]}"; do
    csv=$charts/$scene/chart.csv
    cp "$charts/$scene/chart.svg" "docs/accuracy/$scene.svg"
    cp "$csv" "docs/accuracy/$scene.csv"
    case $scene in
    teapot) echo "## The teapot" ;;
    wild) echo "## Wild patches" ;;
    esac
    count=$(awk -F'"' 'NR == 1 { n = split($0, h, ","); for (k = 1; k <= n; k++) if (h[k] == "rays") at = k }
                       NR == 2 { split($1 "name" $3, f, ","); print f[at] " camera rays, " f[at + 1] " hits, " f[at + 2] " undecided by the reference; " f[at + 7] " shadow rays, of the default " f[at + 10] " lost, " f[at + 11] " invented" }' "$csv")
    cat <<END

[scenes/$scene.pscn](../scenes/$scene.pscn), $count. All points: [accuracy/$scene.csv](accuracy/$scene.csv).

![Time over error of T](accuracy/$scene.svg)

| | ns a camera ray | ratio | T median | T 99 % | T largest | lost | invented | wrong |
|---|---|---|---|---|---|---|---|---|
END
    rows "$csv" front
    echo "| *the fastest of each solver without a wrong answer:* | | | | | | | | |"
    best "$csv"
    echo "| *peers:* | | | | | | | | |"
    for family in plain-newton embree povray; do rows "$csv" "$family"; done
    echo
  done
} >"$page"
cp "$page" docs/accuracy.md
rm "$page"
echo "docs/accuracy.md is written" >&2
