#!/bin/bash
# Speed against accuracy, measured: writes docs/accuracy.md and its pictures in docs/accuracy/ by `pscn chart`.
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
if [ -z "${PSCN_CHARTS:-}" ]; then
  install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox libembree-dev
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build build >/dev/null
  for scene in "${SCENES[@]}"; do
    build/src/command/pscn chart "scenes/$scene.pscn" "$@" -o "$charts/$scene" >/dev/null
  done
fi

# For awk: read() makes of a line of chart.csv the array f, by the names of the columns. The name is the only field in
# quotes, and has commas.
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
  }
  function row() {
    printf "| %s%s | %s (%s - %s) | %s | %s | %s | %s | %s | %s | %s |\n", f["name"], f["front"] == 1 ? " *" : "",
      number(f["ns_median"], 4), number(f["ns_lower"], 4), number(f["ns_upper"], 4), number(f["ratio"], 3),
      number(f["t_median"], 2), number(f["t_99"], 2), number(f["t_max"], 2), f["lost"], f["invented"], f["wrong"]
  }'

# rows FILE CONDITION: the points that awk's CONDITION chooses.
rows() { awk "$READ"'read() && ('"$2"') { row() }' "$1"; }

# best FILE FAMILY: its fastest point without a wrong answer.
best() {
  awk -v family="$2" "$READ"'
    read() && f["family"] == family && bad() == 0 && (best == "" || f["ns_median"] + 0 < best + 0) {
      best = f["ns_median"]; at = NR
    }
    END { print at + 0 }' "$1" >"$folder/at"
  rows "$1" "NR == $(cat "$folder/at")"
}

# What basis, polish and tolerance buy: a line a solver and tolerance, start previous, `split auto`; the paper's form
# last.
ways() {
  awk "$READ"'
    function cell() {
      return number(f["ns_median"] / 1000, 2) " us, " (bad() > 0 ? "**" bad() " bad**, " : "") number(f["t_99"], 2)
    }
    read() && f["start"] != "cold" || f["solver"] == "bernstein" {
      if (f["split"] == 1 && f["family"] != "paper") next
      way = f["family"] == "paper" ? "paper" : f["basis"] == "power" ? "power " f["polish"] : "bernstein " f["polish"]
      table[f["solver"], f["tolerance"] + 0, way] = cell()
    }
    END {
      print "| solver | tolerance | as in the paper | power basis, no polish | Bernstein, no polish | power, polish |" \
        " Bernstein, polish |"
      print "|---|---|---|---|---|---|---|"
      n = split("newton laguerre aberth bernstein", solver, " ")
      m = split("1e-1 1e-2 1e-4 1e-8 1e-12 1e-15", tolerance, " ")
      for (s = 1; s <= n; s++)
        for (t = 1; t <= m; t++) {
          if (!((solver[s], tolerance[t] + 0, "bernstein on") in table)) continue
          e = solver[s] SUBSEP tolerance[t] + 0 SUBSEP
          printf "| %s | %s | %s | %s | %s | %s | %s |\n", solver[s], tolerance[t], table[e "paper"],
            table[e "power off"], table[e "bernstein off"], table[e "power on"], table[e "bernstein on"]
        }
    }' "$1"
}

mkdir -p docs/accuracy
page=$folder/page
{
  cat <<'END'
# Speed against accuracy

Written by `examples/accuracy.sh`; the numbers are those of its last run. For any scene:

    pscn chart scenes/teapot.pscn            # teapot-chart/chart.html, chart.svg, chart.csv; --quick: under a minute

Camera rays of the scene, chosen evenly, and their shadow rays are answered by

- every solver but `durand_kerner`, basis and tolerance (1e-1 to 1e-15), with polish and without, cold and warm, on leaves
  and on whole patches, and in the paper's own form;
- plain 2-D Newton from the middle of each of 8 x 8 parts of a patch, one ray a lane, which guards nothing;
- Embree on triangles, and POV-Ray.

All take turns on one thread. The ratio is the median of the ratios to the default solver within a round, and the time that
ratio times the default's own median, in brackets with its quartiles. Every answer is judged by the reference
([src/reference/reference.h](../src/reference/reference.h)): subdivision and Krawczyk's test in quadruple precision, which
shares nothing with the renderer.

- **error of T**: relative, of the rays that both hit.
- **lost**, **invented**: a hit answered by a miss, a miss answered by a hit. **wrong**: both hit, more than 1 % apart.
  **bad**: the sum.
- In the figures the error is that of 99 % of the rays, and a lost, invented or wrong answer counts as 1. Symbols of
  points with some of those are hollow. Bars are quartiles of the time. The front joins what nothing else beats in both;
  its points bear a star in the tables.
- Embree's rays are single precision; its own program measures it, with pscn's default beside it in every round.
  POV-Ray's errors are those of its `trace()`, its time the CPU time of its trace phase for every pixel of the scene in
  white without lights.

## What one sees

- **What is polished is exact.** Every point with polish, which is the default, whatever its solver, basis, tolerance,
  start and split, stands at one place on the axis of errors, the rounding of doubles, without a bad answer: 2-D Newton
  and its certificate decide, and what they do not accept goes to the last resort. The tolerance then changes hardly even
  the time. Certainty costs little: plain Newton, which proves nothing and forms no resultant, takes 1.6
  times the default's time on the wild patches and 1.4 on the teapot, and answers up to one hit in twenty with a farther
  one or none.
- **Without polish the answer is the solver's.** Tolerances of 1e-1 and 1e-2 give bad answers with any solver. From 1e-4
  on most are right, to 1e-14; but nothing says which: `bernstein` keeps a few per cent of bad ones on the wild patches
  at every tolerance, where roots lie close together, and one on the teapot.
- **The paper's form** (power basis on whole patches, Sylvester, Euclid's algorithm for v, no polish) separates the
  solvers as the paper says: `aberth` from 1e-4 on has hardly a bad answer, `newton` and `laguerre` have some at every
  tolerance, 3 % of the teapot's rays and up to most hits of the wild patches. But the error of T stops at 1e-11
  (teapot) and 1e-6 (wild), for the coefficients are no better, and tolerances below that only cost time, up to the
  iteration limit. It is also the slowest, as every candidate costs all 18 roots.
- **Basis.** On the leaves that `split auto` makes, the complex solvers without polish are mostly two to six times as
  fast in the power basis of the leaf: in Bernstein form the many roots far from the leaf crowd together at x = -1. With
  polish, where roots are only starts, less is left of that. `bernstein`, which looks for roots within the leaf alone,
  has no such trouble.
- **POV-Ray's error is that of its triangles**: a step more in `u_steps` divides it by four. Few steps lose hits, invent
  others, and miss the nearest surface: the larger part of the wild scene's hits at `u_steps 1`, and still a ray here
  and there at the usual 4 or 5. Type 1 costs little more with each step, type 0 several times as much. Its median on
  the teapot is small only because half of the rays meet the flat floor.
- **Embree is wrong in the same way, and faster in packets**: the same mesh gives the same bad answers as POV-Ray's
  (8 x 8 is `u_steps 3`). Rays one by one through the teapot's meshes of 16 x 16 x 2 triangles a patch take as long as
  the exact answer, finer ones longer; 16 coherent rays at once, where the processor can, a sixth of it (8 x 8 x 2) to
  three fifths (256 x 256 x 2). A million triangles bring 99 % of the rays within 1e-5 or so. The wild scene has few
  patches, and its meshes are faster. Single precision ends at 6e-8, even on a flat floor.

END
  for scene in "${SCENES[@]}"; do
    csv=$charts/$scene/chart.csv
    cp "$charts/$scene/chart.svg" "docs/accuracy/$scene.svg"
    cp "$csv" "docs/accuracy/$scene.csv"
    case $scene in
    teapot) echo "## The teapot" ;;
    wild) echo "## Wild patches" ;;
    esac
    count=$(awk "$READ"'read() && NR == 2 {
      print f["rays"] " camera rays, " f["hits"] " hits, " f["undecided"] " undecided by the reference; " \
        f["shadow_rays"] " shadow rays, of the default " f["shadow_lost"] " lost, " f["shadow_invented"] " invented"
    }' "$csv")
    cat <<END

[scenes/$scene.pscn](../scenes/$scene.pscn), $count. All points: [accuracy/$scene.csv](accuracy/$scene.csv).

![Time over error of T](accuracy/$scene.svg)

| | ns a camera ray | ratio | T median | T 99 % | T largest | lost | invented | wrong |
|---|---|---|---|---|---|---|---|---|
END
    rows "$csv" 'f["front"] == 1 || NR == 2'
    echo "| *the fastest of each without a wrong answer:* | | | | | | | | |"
    for family in newton laguerre aberth paper; do best "$csv" "$family"; done
    echo "| *whole patches:* | | | | | | | | |"
    rows "$csv" 'f["split"] == 1 && f["family"] != "paper"'
    echo "| *peers:* | | | | | | | | |"
    rows "$csv" 'f["family"] == "plain-newton" || f["family"] == "embree" || f["family"] == "povray"'
    printf '\nWarm, microseconds a camera ray, bad answers, and the error of T of 99 %% of the rays:\n\n'
    ways "$csv"
    echo
  done
} | cat -s | sed '$ { /^$/d }' >"$page"
cp "$page" docs/accuracy.md
echo "docs/accuracy.md is written" >&2
