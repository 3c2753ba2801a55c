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
  install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox libembree-dev liblapack-dev
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build build >/dev/null
  for scene in "${SCENES[@]}"; do
    build/src/command/pscn chart "scenes/$scene.pscn" "$@" -o "$charts/$scene" >/dev/null
  done
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
  }
  function row() {
    printf "| %s%s | %s (%s - %s) | %s | %s | %s | %s | %s | %s | %s |\n", f["name"], f["front"] == 1 ? " *" : "",
      number(f["ns_median"], 4), number(f["ns_lower"], 4), number(f["ns_upper"], 4), number(f["ratio"], 3),
      number(f["t_median"], 2), number(f["t_99"], 2), number(f["t_max"], 2), f["lost"], f["invented"], f["wrong"]
  }'

# rows FILE CONDITION: the points that fulfil awk's CONDITION.
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

# span SCENE CONDITION EXPRESSION [DIGITS]: the values of awk's EXPRESSION over the points that fulfil CONDITION: "A",
# or "A to B".
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

# faster SCENE POLISH: the time of each complex solver in Bernstein form over that in the power basis, warm, on the
# leaves of `split auto`: for each the median over the tolerances.
faster() {
  awk "$READ"'
    read() && f["start"] == "previous" && f["polish"] == "'"$2"'" && f["family"] != "paper" && f["split"] != 1 {
      ns[f["solver"], f["tolerance"], f["basis"]] = f["ns_median"]; tolerance[f["tolerance"]]
    }
    END {
      m = split("newton laguerre aberth", solver, " ")
      for (s = 1; s <= m; s++) {
        n = 0
        for (t in tolerance)
          if ((solver[s], t, "power") in ns) ratio[n++] = ns[solver[s], t, "bernstein"] / ns[solver[s], t, "power"]
        for (i = 1; i < n; i++)
          for (k = i; k > 0 && ratio[k - 1] > ratio[k]; k--) { x = ratio[k]; ratio[k] = ratio[k - 1]; ratio[k - 1] = x }
        printf "%s%s", s == 1 ? "" : s == m ? " and " : ", ", number(ratio[int(n / 2)], 2)
      }
    }' "$charts/$1/chart.csv"
}

# What basis, polish and tolerance gain: a line for each solver and tolerance, start previous, `split auto`; the paper's
# form last.
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
- Times are of the same few thousand rays asked again and again, so what these meet stays in the caches. That tells nothing
  apart among solvers, but favours large meshes: over the whole picture of the teapot (`beside_embree camera
  scenes/teapot.pscn 7 SIDE`, 480,000 rays) Embree takes, of the default's time, ray by ray, in packets of 8 and of 16:
  0.89, 0.33 and 0.24 (8 x 8 x 2), 1.09, 0.41 and 0.29 (16), 1.72, 0.93 and 0.81 (128), 2.11, 1.42 and 1.33 (256), with
  AVX-512; with AVX2, ray by ray and in packets of 8, 0.65 and 0.30 (8), 0.79 and 0.37 (16), 1.19 and 0.85 (128), 1.55 and
  1.28 (256).
END
  paper='f["family"] == "paper" && f["solver"] == ' small='f["tolerance"] + 0 <= 1e-4' tiny='f["tolerance"] + 0 <= 1e-6'
  registers='On a processor with AVX-512, 16 at once would be in the charts as well.'
  grep -q '16 coherent' "$charts/teapot/chart.csv" && registers='This processor has AVX-512, so that 16 at once are in the charts as well.'
  cat <<END

## What one sees

- **What is polished is exact.** Every point with polish, which is the default, whatever its solver, basis, tolerance,
  start and split, stands at one place on the axis of errors, the rounding of doubles, without a bad answer: 2-D Newton
  and its certificate decide, and what they do not accept goes to the last resort. The tolerance then changes hardly even
  the time. Certainty costs little: plain Newton, which proves nothing and forms no resultant, takes
  $(span wild 'f["name"] == "Newton from the middle"' 'f["ratio"]') times the default's time on the wild patches and
  $(span teapot 'f["name"] == "Newton from the middle"' 'f["ratio"]') on the teapot, and is wrong or has nothing for
  $(span wild 'f["name"] == "Newton from the middle"' 'bad()') of $(span wild 'f["name"] == "Newton from the middle"' 'f["hits"]' 4) and
  $(span teapot 'f["family"] == "rival"' 'bad()') of $(span teapot 'f["family"] == "rival"' 'f["hits"]' 4) hits.
- **Without polish the answer is the solver's.** On leaves, tolerances of 1e-1 to 1e-3 give bad answers, most of them in
  Bernstein form; below, next to none but \`bernstein\`'s, which keeps
  $(span wild 'f["family"] == "bernstein" && f["polish"] == "off" && '"$tiny" 'bad()') of
  $(span wild 'f["family"] == "bernstein" && f["polish"] == "off" && '"$tiny" 'f["hits"]' 4) on the wild patches at every
  tolerance, where roots lie close together, and
  $(span teapot 'f["family"] == "bernstein" && f["polish"] == "off" && '"$tiny" 'bad()') on the teapot. Nothing says which.
- **The paper's form** (power basis on whole patches, Sylvester, Euclid's algorithm for v, no polish) separates the
  solvers as the paper says. From 1e-4 down \`aberth\` has $(span teapot "$paper"'"aberth" && '"$small" 'bad()') bad answers of
  $(span teapot "$paper"'"aberth"' 'f["hits"]' 4) on the teapot and $(span wild "$paper"'"aberth" && '"$small" 'bad()') of
  $(span wild "$paper"'"aberth"' 'f["hits"]' 4) on the wild patches; from 1e-6 down \`newton\` has
  $(span teapot "$paper"'"newton" && '"$tiny" 'bad()') and $(span wild "$paper"'"newton" && '"$tiny" 'bad()'), \`laguerre\`
  $(span teapot "$paper"'"laguerre" && '"$tiny" 'bad()') and $(span wild "$paper"'"laguerre" && '"$tiny" 'bad()' 3). For the
  coefficients are no better, the error of T stops there: of 99 % of Aberth's rays at
  $(span teapot "$paper"'"aberth" && '"$tiny" 'f["t_99"]') (teapot) and $(span wild "$paper"'"aberth" && '"$tiny" 'f["t_99"]')
  (wild), and smaller tolerances only cost time, up to the iteration limit. It is also the slowest form, as every candidate
  costs all 18 roots.
- **Basis.** On the leaves of \`split auto\` and without polish \`newton\`, \`laguerre\` and \`aberth\` take in Bernstein form
  $(faster teapot off) (teapot), $(faster wild off) (wild) times as long as in the power basis of the leaf: there the
  many roots far from the leaf crowd together at x = -1. With polish it is
  $(faster teapot on) and $(faster wild on): Bernstein form, the default, has a way of its own on registers
  ([solvers.md](solvers.md#on-lanes)). \`bernstein\`, which looks for roots within the leaf alone, has no such trouble.
- **POV-Ray's error is that of its triangles**: a step more in \`u_steps\` divides it by four. Few steps lose hits and miss the
  nearest surface: $(span wild 'f["family"] == "povray" && f["name"] ~ /u_steps 1,/' 'bad()' 4) of the wild scene's
  $(span wild 'f["family"] == "povray"' 'f["hits"]' 4) hits at \`u_steps 1\`, and still a ray here and there at the usual 4
  or 5. Type 1 costs little more with each step, type 0 several times as much. Its median on the teapot is small only
  because half of the rays meet the flat floor.
- **Embree is wrong in the same way, and faster**: the same mesh gives the same bad answers as POV-Ray's (8 x 8 is
  \`u_steps 3\`). Of the default's time on the teapot's camera rays, which go in packets too, its rays one by one take
  $(span teapot 'f["name"] ~ /^Embree, 16x16.* one by one/' 'f["ratio"]') through meshes of 16 x 16 x 2 triangles a patch and
  $(span teapot 'f["name"] ~ /^Embree, 256x256.* one by one/' 'f["ratio"]') through 256 x 256 x 2; 8 coherent rays at once
  $(span teapot 'f["name"] ~ /^Embree, 8x8.* 8 coherent/' 'f["ratio"]') (8 x 8 x 2) to
  $(span teapot 'f["name"] ~ /^Embree, 256x256.* 8 coherent/' 'f["ratio"]'). $registers A million triangles bring 99 % of the rays within 1e-5 or so. The wild scene has few
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
    rows "$csv" 'f["family"] == "rival" || f["family"] == "embree" || f["family"] == "povray"'
    printf '\nWarm, microseconds a camera ray, bad answers, and the error of T of 99 %% of the rays:\n\n'
    ways "$csv"
    echo
  done
} | cat -s | sed '$ { /^$/d }' >"$page"
cp "$page" docs/accuracy.md
echo "docs/accuracy.md is written" >&2
