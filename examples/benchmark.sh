#!/bin/bash
# What pscn costs, each number a ratio or a difference within this run, with the contestants taking turns. Prints a table
# of names and numbers; then every scene beside Embree, with camera, shadow and scattered rays, as CSV.
#
#   examples/benchmark.sh [--page] [RUNS]     RUNS of each, default 5; --page: into docs/performance.md and docs/performance/
#
# The teapot at 800x600, one thread, default solver, unless stated otherwise; some fifteen minutes on an idle machine.
# Times are CPU times, since others may use the machine too; still, an idle one gives steadier numbers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
. examples/report.sh
export LC_ALL=C

page=
if [ "${1:-}" = --page ]; then page=docs/performance.md; shift; fi
runs=${1:-5}
SCENE=scenes/teapot.pscn
SIZE=800x600
TEAPOTS=10000

install_packages "${BUILD_PACKAGES[@]}" povray libembree-dev time
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build --target pscn resultant_time >/dev/null
pscn=$PWD/build/src/command/pscn
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/home"

say() { echo "$*" >&2; }

# numbers FILE COLUMN: its median, smallest and largest number.
numbers() {
  awk -v c="$2" '{ print $c }' "$1" | sort -g | awk '{ v[NR] = $1 }
    END { printf "%.17g %.17g %.17g\n", NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2, v[1], v[NR] }'
}
median() { numbers "$1" "$2" | cut -d ' ' -f 1; }

# row NAME NUMBER [REMARK]
row() { printf '| %s | %s | %s |\n' "$1" "$2" "${3:-}" >>"$folder/table"; }
fixed() { awk -v x="$1" -v n="$2" 'BEGIN { printf "%.*f", n, x }'; }

printf '| | measured | |\n|---|---|---|\n' >"$folder/table"

# ---- rays in one process ----

# contest KIND SCENE SIDE SOLVER...: writes the file "rays"
contest() { build/examples/benchmark/beside_embree "$1" "$2" "$runs" "${@:3}" >"$folder/rays"; }
# cell NAME COLUMN
cell() { awk -F '\t' -v name="$1" -v c="$2" '$1 == name { print $c }' "$folder/rays"; }
ns() { echo "$(fixed "$(cell "$1" 2)" 0) ns ($(fixed "$(cell "$1" 3)" 0) - $(fixed "$(cell "$1" 4)" 0))"; }

# For each scene, the squares of triangles that a patch has on a side for Embree, and the file.
scenes() {
  for name in teapot wild bent dome waves degrees inside nested; do echo "$name 64 scenes/$name.pscn"; done
  examples/generate.sh hair 10000 >"$folder/hair.pscn"
  examples/generate.sh ribbons 1000 >"$folder/ribbons.pscn"
  examples/generate.sh creature 3570 >"$folder/creature.pscn"
  examples/generate.sh creature 11532 >"$folder/animal.pscn"
  examples/generate.sh confetti 20000 >"$folder/confetti.pscn"
  examples/generate.sh knots 200 >"$folder/knots.pscn"
  examples/generate.sh shells 320 >"$folder/shells.pscn"
  examples/generate.sh knots 1 >"$folder/knot.pscn"
  examples/generate.sh pearls 4000 >"$folder/pearls.pscn"
  examples/generate.sh floor 1200 >"$folder/floor.pscn"
  examples/generate.sh hills 1600 >"$folder/hills.pscn"
  examples/generate.sh book 1000 >"$folder/book.pscn"
  examples/generate.sh roll 6400 >"$folder/roll.pscn"
  examples/generate.sh marks 100 >"$folder/marks.pscn"
  examples/generate.sh pipes 400 >"$folder/pipes.pscn"
  examples/generate.sh crown 10000 >"$folder/crown.pscn"
  for name in knots shells knot; do echo "$name 64 $folder/$name.pscn"; done
  for name in floor hills book roll marks pipes; do echo "$name 16 $folder/$name.pscn"; done
  for name in crown hair ribbons creature animal confetti pearls; do echo "$name 8 $folder/$name.pscn"; done
}

# every_scene SET: a line of numbers for each scene and each kind of rays, answered on that instruction set.
every_scene() {
  [ "$1" = "$best" ] || local -x PSCN_KERNEL=$1
  scenes | while read -r name side file; do
    for kind in camera shadow scattered; do
      say "$kind rays of $name, $1"
      contest "$kind" "$file" "$side" 2>/dev/null || continue # a scene may have no shadow rays
      printf '%s,%s,%s,%.0f,%.2f,%.2f,%.2f\n' "$1" "$kind" "$name" "$(cell pscn 2)" "$(cell pscn 5)" "$(cell pscn 6)" \
        "$(cell 'pscn, one by one' 5)"
      [ "$kind$1" != "camera$best" ] ||
        echo "$name,$(cell 'preparing, pscn' 2),$(cell 'preparing, Embree' 2),$(cell 'preparing, Embree' 3)" >>"$folder/preparing.csv"
    done
  done
}

# beside_embree: the table of docs/performance/embree.csv, and what docs/performance/preparing.csv comes to.
beside_embree() {
  awk -F, '
    function add(list, x) { n[list]++; for (k = n[list]; k > 1 && v[list, k - 1] > x; k--) v[list, k] = v[list, k - 1]; v[list, k] = x }
    function cells(name, begin, what,    r, c, x, line) {
      for (r = 1; r <= 3; r++) for (c = 5; c <= 6; c++) {
        x = what == "" ? at[begin, ray[r], c] : what == "worst" ? v[begin, ray[r], c, n[begin, ray[r], c]] : middle(begin SUBSEP ray[r] SUBSEP c)
        line = line (x == "" ? " - |" : sprintf(what == "worst" ? " **%.2f** |" : " %.2f |", x))
      }
      print "| " name " |" line
    }
    function middle(list,    m) { m = n[list]; return m % 2 ? v[list, (m + 1) / 2] : (v[list, m / 2] + v[list, m / 2 + 1]) / 2 }
    BEGIN { split("camera shadow scattered", ray, " ") }
    NR == 1 { next }
    NR == 2 { best = $1 }
    $1 == best && !($3 in known) { known[$3]; name[++names] = $3 }
    { other = $1 == best ? other : $1
      for (c = 5; c <= 6; c++) { at[$1, $3, $2, c] = $c; add($1 SUBSEP $2 SUBSEP c, $c) } }
    END {
      print "| scene | camera rays, to Embree one by one | to its packets | shadow rays, one by one | to its packets | scattered rays, one by one | to its packets |"
      print "|---|---|---|---|---|---|---|"
      for (s = 1; s <= names; s++) cells(name[s], best SUBSEP name[s], "")
      cells("**median**", best, "median")
      cells("**worst**", best, "worst")
      if (other != "") { cells("**median**, " other, other, "median"); cells("**worst**, " other, other, "worst") }
    }' docs/performance/embree.csv
  awk -F, 'NR > 1 { r = $2 / $3; for (k = ++n; k > 1 && v[k - 1] > r; k--) v[k] = v[k - 1]; v[k] = r }
    END { printf "\nPreparing takes %.2f to %.2f of the time in which Embree builds its hierarchy of default quality, in the median\n", v[1], v[n]
          printf "%.2f ([preparing.csv](performance/preparing.csv)).\n", v[int((n + 1) / 2)] }' docs/performance/preparing.csv
}

if cmake --build build --target beside_embree >/dev/null 2>&1; then
  say "camera rays, beside Embree"
  contest camera "$SCENE" 128 'aberth { start previous split 1 }' 'aberth { start cold split 1 }'
  row 'camera rays / Embree rtcIntersect1, 1,081,344 triangles' "$(fixed "$(cell pscn 5)" 2)" \
    "$(ns pscn) / $(ns rtcIntersect1)"
  row "camera rays / Embree's fastest coherent packets" "$(fixed "$(cell pscn 6)" 2)" \
    "rtcIntersect8 $(ns rtcIntersect8)$(cell rtcIntersect16 2 | awk '{ printf ", rtcIntersect16 %.0f ns", $1 }')"
  row '`aberth`, warm, without split / default' \
    "$(fixed "$(cell 'aberth { start previous split 1 }' 7)" 1)" "$(ns 'aberth { start previous split 1 }')"
  row '`aberth`, cold, without split / default' \
    "$(fixed "$(cell 'aberth { start cold split 1 }' 7)" 1)" "$(ns 'aberth { start cold split 1 }')"
  best=avx2
  [ -z "$(cell rtcIntersect16 2)" ] || best=avx512
  echo 'instruction_set,rays,scene,pscn_ns,to_embree_one_by_one,to_embree_packets,both_one_by_one' >"$folder/embree.csv"
  echo 'scene,pscn_s,embree_s,embree_best_quality_s' >"$folder/preparing.csv"
  every_scene "$best" >>"$folder/embree.csv"
  [ "$best" = avx2 ] || every_scene avx2 >>"$folder/embree.csv"
else
  say "Embree is not installed (libembree-dev): what is measured beside it is left out"
fi

say "r(u)"
build/examples/benchmark/resultant_time 9 >"$folder/resultant"
tail -1 "$folder/resultant" | while IFS=$'\t' read -r set lanes middle least most; do
  row 'r(u) of degree 18, ns a candidate' "$(fixed "$middle" 0)" \
    "$set, $lanes lanes ($least - $most)"
done

# ---- whole processes ----

# took WHAT COMMAND...: its seconds; WHAT is "cpu", user and system, or "clock".
took() {
  /usr/bin/time -f '%U %S %e' -o "$folder/time" "${@:2}" >"$folder/log" 2>&1 || { cat "$folder/log" >&2; return 1; }
  awk -v what="$1" '{ print what == "cpu" ? $1 + $2 : $3 }' "$folder/time"
}
# pscn_took WHAT THREADS, povray_took WHAT THREADS: the time for the teapot, from the shell to the file.
pscn_took() { took "$1" "$pscn" render "$SCENE" --size "$SIZE" --threads "$2" --quiet -o "$folder/pscn.png"; }
povray_took() {
  (cd "$(dirname "$SCENE")" && HOME=$folder/home took "$1" povray "+I$(basename "$SCENE")" "+O$folder/povray.png" \
    "+W${SIZE%x*}" "+H${SIZE#*x}" "+WT$2" -D -A)
}
# processes WHAT THREADS NAME
processes() {
  for ((run = 0; run < runs; run++)); do
    awk -v a="$(pscn_took "$1" "$2")" -v b="$(povray_took "$1" "$2")" 'BEGIN { print a, b, a / b }'
  done >"$folder/processes"
  row "$3" "$(fixed "$(median "$folder/processes" 3)" 2)" \
    "$(fixed "$(median "$folder/processes" 1)" 2) s / $(fixed "$(median "$folder/processes" 2)" 2) s"
}

if command -v povray >/dev/null; then
  say "whole processes, beside POV-Ray"
  processes cpu 1 'CPU time of the whole process / povray, u_steps 5, flatness 0'
  processes clock 2 'the same by the clock, two threads / povray +WT2'
else
  say "POV-Ray is not installed: what is measured beside it is left out"
fi

# megabytes SCENE: the process's peak memory.
megabytes() {
  /usr/bin/time -f %M -o "$folder/time" "$pscn" render "$1" --size "$SIZE" --threads 1 --quiet \
    --stats "$folder/stats.json" -o "$folder/pscn.png"
  awk '{ print $1 / 1024 }' "$folder/time"
}
# of GROUP NAME...: numbers from its statistics.
of() { members "$folder/stats.json" "$@"; }

say "memory, and $TEAPOTS teapots"
echo 'background { rgb 0 }' >"$folder/empty.pscn"
examples/field.sh 1 >"$folder/one.pscn"
examples/field.sh "$TEAPOTS" >"$folder/many.pscn"
turns=$(((runs + 1) / 2))
for ((run = 0; run < turns; run++)); do
  empty=$(megabytes "$folder/empty.pscn")
  teapot=$(megabytes "$SCENE")
  awk -v a="$teapot" -v b="$empty" 'BEGIN { print a - b, b }' >>"$folder/memory"
  megabytes "$folder/one.pscn" >/dev/null
  one=$(awk -v t="$(of cpu render)" -v hits="$(of rays shadow)" 'BEGIN { print 1e6 * t / hits }')
  many=$(megabytes "$folder/many.pscn")
  awk -v one="$one" -v mb="$many" -v empty="$empty" -v parse="$(of cpu parse)" -v build="$(of cpu build)" \
    -v t="$(of cpu render)" -v hits="$(of rays shadow)" \
    'BEGIN { m = 1e6 * t / hits; print parse + build, mb - empty, m / one, m, one, parse, build }' >>"$folder/field"
done
row "memory of the process above an empty scene's" "$(fixed "$(median "$folder/memory" 1)" 1) MB" \
  "empty scene: $(fixed "$(median "$folder/memory" 2)" 0) MB"
row "$TEAPOTS teapots: load, CPU time" "$(fixed "$(median "$folder/field" 1)" 1) s" \
  "parse $(fixed "$(median "$folder/field" 6)" 2) s, build $(fixed "$(median "$folder/field" 7)" 2) s"
row "$TEAPOTS teapots: memory above an empty scene's" "$(fixed "$(median "$folder/field" 2)" 0) MB"
row "$TEAPOTS teapots: time per hit / one teapot's" "$(fixed "$(median "$folder/field" 3)" 2)" \
  "$(fixed "$(median "$folder/field" 4)" 2) us / $(fixed "$(median "$folder/field" 5)" 2) us, shadow rays and misses \
included"

cat "$folder/table"
[ ! -e "$folder/embree.csv" ] || cat "$folder/embree.csv" "$folder/preparing.csv"
if [ -n "$page" ] && [ -e "$folder/embree.csv" ]; then
  mkdir -p docs/performance
  cp "$folder/embree.csv" "$folder/preparing.csv" docs/performance/
  {
    cat <<END
Written by \`examples/benchmark.sh --page\` from [embree.csv](performance/embree.csv): CPU time of pscn over that of Embree, one
thread, 800x600, default solver, medians of $runs turns. Below 1 pscn is faster. Embree answers the same rays through
triangles: 64 x 64 x 2 a patch, 16 x 16 x 2 in floor, hills, book, roll, marks and pipes, 8 x 8 x 2 in the last seven scenes. Its
packets have 8 or 16 rays, whichever is faster; its shadow rays are \`rtcOccluded\`. Scattered rays have random places and
directions. Sorting rays into packets is part of both times.

END
    beside_embree
    cat <<END

Eight scenes are those of [scenes/](../scenes); \`examples/generate.sh\` makes the others. Several were added because pscn is slow on
them.

| scene | content |
|---|---|
| knots, knot | 200 patches of sixteen random points each, through one another; one of them |
| shells | 40 balls of eight patches through one another |
| floor | 150 balls of 0.003 to 0.4 on a floor 2,000 wide |
| hills | a landscape of 1,600 patches seen along the ground, under a low sun |
| book, roll | 1,000 curved pages from one spine; 800 turns of a carpet, of eight patches each |
| marks | 100 squares in the plane of a floor |
| pipes | 100 pipes in all directions, 1 : 80 |
| crown | 100 copies of a twig of 100 leaves, turned about its end |
| hair, ribbons | 10,000 patches of 1 : 200; 1,000 of 1 : 1000 |
| creature, animal | closed skins of 3,570 and of 11,532 patches |
| confetti | 20,000 small patches, each bent differently |
| pearls | 500 small balls apart |
END
  } >"$folder/section"
  replace_section "$page" 'Beside Embree' "$folder/section"
fi
if [ -n "$page" ]; then
  {
    echo "Written by \`examples/benchmark.sh --page\`; medians of $runs turns of its last run, in brackets the smallest"
    echo "and the largest. The teapot at $SIZE, one thread, the default solver unless stated otherwise."
    echo
    cat "$folder/table"
  } >"$folder/section"
  replace_section "$page" Numbers "$folder/section"
fi
