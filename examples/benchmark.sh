#!/bin/bash
# The numbers required of pscn, each a ratio or a difference within this run, with the contestants taking turns. Prints
# a table of name, number and requirement; then every scene beside Embree, with camera, shadow and scattered rays.
#
#   examples/benchmark.sh [--page] [RUNS]     RUNS of each, default 5; --page: the table goes into docs/performance.md
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

# every_scene KIND: a table of all scenes, the worst last.
every_scene() {
  printf '| scene | pscn, ns a ray | to Embree one by one | to its fastest packets | pscn one by one, to Embree one by one |\n'
  printf '|---|---|---|---|---|\n'
  scenes | while read -r name side file; do
    say "$1 rays of $name"
    contest "$1" "$file" "$side" 2>/dev/null || continue # a scene may have no shadow rays
    if [ "$1" = camera ]; then
      echo "$name $(cell 'preparing, pscn' 2) $(cell 'preparing, Embree' 2) $(cell 'preparing, Embree' 3) $(cell pscn 2) $(cell pscn 6)" >>"$folder/preparing"
    fi
    printf '%s %.0f %.2f %.2f %.2f\n' "$name" "$(cell pscn 2)" "$(cell pscn 5)" "$(cell pscn 6)" "$(cell 'pscn, one by one' 5)"
  done | awk '{ print "| " $1 " | " $2 " | " $3 " | " $4 " | " $5 " |" }
    { for (k = 3; k <= 5; k++) if ($k > worst[k]) worst[k] = $k }
    END { printf "| **worst** | | **%.2f** | **%.2f** | **%.2f** |\n", worst[3], worst[4], worst[5] }'
}

# preparing: a table of the work before the first ray, from the runs of camera rays.
preparing() {
  printf '| scene | pscn, s | Embree, s | of its best quality, s | pictures until Embree is done first |\n|---|---|---|---|---|\n'
  awk -v rays=$((${SIZE%x*} * ${SIZE#*x})) '{
    slower = $5 * (1 - 1 / $6) * rays / 1e9 # seconds a picture
    pictures = slower <= 0 ? "never" : $3 <= $2 ? 0 : sprintf("%.0f", 0.5 + ($3 - $2) / slower)
    printf "| %s | %.4f | %.4f | %.4f | %s |\n", $1, $2, $3, $4, pictures }' "$folder/preparing"
}

# every_scene_avx2: a table of all scenes and kinds of rays, with both programs limited to AVX2.
every_scene_avx2() {
  printf '| scene | camera rays, to Embree one by one | to its packets | shadow rays, one by one | to its packets | scattered rays, one by one | to its packets |\n'
  printf '|---|---|---|---|---|---|---|\n'
  scenes | while read -r name side file; do
    say "rays of $name with AVX2"
    line=$name
    for kind in camera shadow scattered; do
      if PSCN_KERNEL=avx2 contest "$kind" "$file" "$side" 2>/dev/null; then
        line+=$(printf ' %.2f %.2f' "$(cell pscn 5)" "$(cell pscn 6)")
      else
        line+=' - -'
      fi
    done
    echo "$line"
  done | awk '{ for (k = 1; k <= 7; k++) { printf "| %s ", $k; if (k > 1 && $k > worst[k]) worst[k] = $k } print "|" }
    END { printf "| **worst** "; for (k = 2; k <= 7; k++) printf "| **%.2f** ", worst[k]; print "|" }'
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
  for kind in camera shadow scattered; do
    printf '\n### %s rays\n\n' "${kind^}"
    every_scene "$kind"
  done >"$folder/every"
  {
    printf '\n### Preparing\n\nBefore the first ray, CPU seconds of one thread. pscn makes leaves and their hierarchy; Embree makes triangles and\n'
    printf 'theirs, of the default quality and of the best one, which is what its rays are measured with. Last: how many pictures\n'
    printf 'of %s, of camera rays only, it takes until Embree, prepared with the default quality and asked in its fastest\n' "$SIZE"
    printf 'packets, has taken less in all.\n\n'
    preparing
  } >>"$folder/every"
  if [ -n "$(cell rtcIntersect16 2)" ]; then
    printf '\n### With AVX2\n\nOn the same processor, whose wider registers neither pscn (`PSCN_KERNEL=avx2`) nor Embree uses here.\n\n' >>"$folder/every"
    every_scene_avx2 >>"$folder/every"
  fi
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
[ ! -e "$folder/every" ] || cat "$folder/every"
if [ -n "$page" ] && [ -e "$folder/every" ]; then
  {
    echo "Written by \`examples/benchmark.sh --page\`, by \`beside_embree KIND SCENE\` for each: CPU time of one thread at 800x600,"
    echo "default solver, medians of $runs turns. Embree has 64 x 64 x 2 triangles a patch, 16 x 16 x 2 in floor, hills, book, roll, marks"
    echo "and pipes, and 8 x 8 x 2 in the last seven scenes, of which it would otherwise have millions. Its packets are of 8 rays and, where the"
    echo "processor has the instructions, 16, said to be coherent but for scattered rays; its shadow rays are \`rtcOccluded\`."
    echo "Scattered rays have random places and directions. Up to four rays are answered in registers of AVX2."
    echo "Both get a list of rays one behind the other; bringing them into columns is in their times: of Embree's packets of 8 on"
    echo "Zen 3 3 ns a ray, of 25 on bent and 68 on the teapot."
    echo
    echo "Eight scenes are those of [scenes/](../scenes/): \`inside\` is made of rays exactly along shared edges, \`nested\` of parts"
    echo "that ask for other solvers. The others are made by \`examples/generate.sh\`:"
    echo
    echo "| scene | what it is |"
    echo "|---|---|"
    echo "| knots, knot | 200 patches of sixteen random points each, through one another; one of them |"
    echo "| shells | 40 balls of eight patches through one another |"
    echo "| floor | 150 balls of 0.003 to 0.4 on a floor 2,000 wide |"
    echo "| hills | a landscape of 1,600 patches seen along it, under a low sun |"
    echo "| book, roll | 1,000 curved pages from one spine; 800 turns of a carpet, of eight patches |"
    echo "| marks | 100 squares on a floor, in its plane |"
    echo "| pipes | 100 pipes every way, 1 : 80 |"
    echo "| crown | 100 copies of a twig of 100 leaves, turned about its end |"
    echo "| hair, ribbons | 10,000 patches of 1 : 200; 1,000 of 1 : 1000 |"
    echo "| creature, animal | closed skins of 3,570 and of 11,532 patches |"
    echo "| confetti | 20,000 small patches, each bent another way |"
    echo "| pearls | 500 small balls apart |"
    cat "$folder/every"
  } >"$folder/section"
  replace_section "$page" 'Every scene' "$folder/section"
fi
if [ -n "$page" ]; then
  {
    echo "Written by \`examples/benchmark.sh --page\`; medians of $runs turns of its last run, in brackets the smallest"
    echo "and the largest. The teapot at $SIZE, one thread, the default solver where nothing else is said."
    echo
    cat "$folder/table"
  } >"$folder/section"
  replace_section "$page" Numbers "$folder/section"
fi
