#!/bin/bash
# Cost against the number of patches, the size of the picture and the number of threads, pscn beside POV-Ray on the same
# files: writes the section "Scale" of docs/performance.md and docs/performance/scale.svg.
#
#   examples/scale.sh [TEAPOTS...]       default 1 10 100 1000 10000
#
# A scene is a field of teapots that are all `object { Teapot }` of one #declare. The light stands at the camera, so that every hit
# sends exactly one shadow ray, and counting those counts hits. POV-Ray gets MEMORY_LIMIT and TIME_LIMIT a run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

MEMORY_LIMIT=8000000 # KiB of address space
TIME_LIMIT=100       # seconds
SIZE=800x600
SIZES=(800x600 1600x1200 3840x2160 7680x4320)
THREADS=(1 2 4 8)
teapots=("$@")
[ $# -gt 0 ] || teapots=(1 10 100 1000 10000)

install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox time
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build --target pscn pscn_openimageio >/dev/null
pscn=$PWD/build/src/command/pscn
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/home"

# field N: the scene's text.
field() {
  local side
  side=$(awk -v n="$1" 'BEGIN { s = int(sqrt(n)); while (s * s < n) s++; print s }')
  awk -v s="$side" 'BEGIN {
    y = 5 * s + 2; z = -6 * s - 3
    printf "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
    printf "camera { location <0, %g, %g> look_at <0, 1, 0> angle 42 }\n", y, z
    printf "light_source { <0, %g, %g>, rgb 1 }\nbackground { rgb <0.74, 0.80, 0.88> }\n", y, z
  }'
  # Everything of the teapot's scene from its first #declare to the union of all parts.
  awk '/^#declare/ { on = 1 } on && /^object/ { exit } on' scenes/teapot.pscn
  awk -v n="$1" -v s="$side" 'BEGIN {
    for (k = 0; k < n; k++)
      printf "object { Teapot translate <%g, 0, %g> }\n", 7 * (k % s - (s - 1) / 2), 5 * (int(k / s) - (s - 1) / 2)
  }'
}

# member NAME FILE.json
member() { awk -F'[:,]' -v name="\"$1\"" '{ for (k = 1; k < NF; k++) if (index($k, name)) { print $(k + 1) + 0; exit } }' "$2"; }

# ours FILE SIZE THREADS [OPTION...]: "parse build render rays hits MB" of pscn.
ours() {
  local file=$1 size=$2 threads=$3
  shift 3
  /usr/bin/time -f %M -o "$folder/memory" "$pscn" render "$file" --size "$size" --threads "$threads" --quiet "$@" \
    --stats "$folder/stats.json" -o "$folder/pscn.png"
  local primary shadow
  primary=$(member primary "$folder/stats.json") shadow=$(member shadow "$folder/stats.json")
  echo "$(member parse "$folder/stats.json") $(member build "$folder/stats.json") $(member render "$folder/stats.json")" \
    "$((primary + shadow)) $shadow $(awk '{ printf "%.0f", $1 / 1024 }' "$folder/memory")"
}

# theirs FILE SIZE THREADS: "parse trace MB" of POV-Ray, CPU seconds, or "- - MB" where it did not come to an end.
theirs() {
  local file=$1 size=$2 threads=$3 status=0
  (cd "$folder" && ulimit -v "$MEMORY_LIMIT" && HOME=$folder/home exec timeout "$TIME_LIMIT" /usr/bin/time -f %M -o "$folder/memory" \
    povray "+I$file" "+O$folder/povray.png" "+W${size%x*}" "+H${size#*x}" "+WT$threads" -D -A >"$folder/log" 2>&1) || status=$?
  local memory
  memory=$(awk 'END { if ($1 > 0) printf "%.0f", $1 / 1024; else print "?" }' "$folder/memory")
  if [ "$status" -ne 0 ]; then
    echo "- - $memory"
    return
  fi
  awk -v memory="$memory" '
    /Parser? Time|Parse Time/ { part = 1 } /Trace Time/ { part = 2 }
    /CPU-seconds total/ && part { sub(/.* with /, ""); s[part] += $1; part = 0 }
    END { print s[1] + 0, s[2] + 0, memory }' <(tr '\r' '\n' <"$folder/log")
}

echo 'background { rgb 0 }' >"$folder/empty.pscn"
ours "$folder/empty.pscn" 16x16 1 >"$folder/line"
empty=$(awk '{ print $6 }' "$folder/line")

{
  echo "## Scale"
  echo
  echo "Written by \`examples/scale.sh\`, whose numbers are those of its last run, on $(nproc) processors. A field of teapots that are all"
  echo "\`object { Teapot }\` of one \`#declare\`, $SIZE, one thread, with the light at the camera: every hit sends one shadow ray. POV-Ray reads"
  echo "the same file (type 1, \`u_steps 5 v_steps 5 flatness 0\`); its times are CPU seconds of its parser and its tracer. Memory is the peak"
  echo "of the process; pscn's for an empty scene is $empty MB. POV-Ray was given $((MEMORY_LIMIT / 1000000)) GB and $TIME_LIMIT s a run; a dash means that"
  echo "this was not enough."
  echo
  echo "| teapots | patches | parse s | build s | render s | ns a ray | us a hit | MB | POV-Ray: parse s | trace s | MB |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|"
} >"$folder/section"
for n in "${teapots[@]}"; do
  echo "$n teapots" >&2
  field "$n" >"$folder/field.pscn"
  ours "$folder/field.pscn" "$SIZE" 1 >"$folder/line"
  theirs field.pscn "$SIZE" 1 >"$folder/line2"
  paste -d ' ' "$folder/line" "$folder/line2" | awk -v n="$n" '{
    printf "| %d | %d | %.3f | %.3f | %.2f | %.0f | %.2f | %d | %s | %s | %s |\n", n, 32 * n, $1, $2, $3, 1e9 * $3 / $4,
      1e6 * $3 / ($5 ? $5 : 1), $6, $7, $8, $9 }' | tee -a "$folder/section" >&2
  echo "$((32 * n)) $(cat "$folder/line") $(cat "$folder/line2")" >>"$folder/patches"
done

# A text without names, for the speed of the parser.
big=1000
field "$big" >"$folder/field.pscn"
"$pscn" dump "$folder/field.pscn" --quiet >"$folder/dump.pscn" 2>/dev/null || "$pscn" dump "$folder/field.pscn" >"$folder/dump.pscn"
ours "$folder/dump.pscn" 16x16 1 >"$folder/line"
bytes=$(stat -c %s "$folder/dump.pscn")
awk -v b="$bytes" -v n="$big" '{ printf "\nThe canonical text of %d teapots (`pscn dump`, every patch written out, %.0f MB) is read in %.2f s: %.0f MB/s.\n", n, b / 1e6, $1, b / 1e6 / $1 }' \
  "$folder/line" | tee -a "$folder/section" >&2

{
  echo
  echo "One teapot against the size of the picture, one thread:"
  echo
  echo "| size | render s | ns a ray | MB | POV-Ray: trace s | MB |"
  echo "|---|---|---|---|---|---|"
} >>"$folder/section"
field 1 >"$folder/field.pscn"
for size in "${SIZES[@]}"; do
  ours "$folder/field.pscn" "$size" 1 >"$folder/line"
  theirs field.pscn "$size" 1 >"$folder/line2"
  paste -d ' ' "$folder/line" "$folder/line2" | awk -v size="$size" '{
    printf "| %s | %.2f | %.0f | %d | %s | %s |\n", size, $3, 1e9 * $3 / $4, $6, $8, $9 }' | tee -a "$folder/section" >&2
done

{
  echo
  echo "100 teapots at 1600x1200 against threads, wall seconds of the rendering:"
  echo
  echo "| threads | render s | times as fast |"
  echo "|---|---|---|"
} >>"$folder/section"
field 100 >"$folder/field.pscn"
for threads in "${THREADS[@]}"; do
  [ "$threads" -le "$(nproc)" ] || continue
  ours "$folder/field.pscn" 1600x1200 "$threads" >"$folder/line"
  [ "$threads" -ne 1 ] || one=$(awk '{ print $3 }' "$folder/line")
  awk -v t="$threads" -v one="$one" '{ printf "| %d | %.2f | %.2f |\n", t, $3, one / $3 }' "$folder/line" | tee -a "$folder/section" >&2
done

mkdir -p docs/performance
{
  echo "set terminal svg size 760,420 font 'sans-serif,13' background '#ffffff'"
  echo "set output 'docs/performance/scale.svg'"
  echo "set datafile missing '-'"
  echo "set logscale xy; set xlabel 'patches'; set ylabel 'seconds'; set grid lc rgb '#dddddd'; set key outside right top"
  echo "plot '$folder/patches' using 1:4 with linespoints pt 7 lc rgb '#c02020' title 'pscn render', \\"
  echo "  '' using 1:(\$2+\$3) with linespoints pt 6 dt 2 lc rgb '#c02020' title 'pscn parse and build', \\"
  echo "  '' using 1:9 with linespoints pt 5 lc rgb '#2b6cb0' title 'POV-Ray trace', \\"
  echo "  '' using 1:8 with linespoints pt 4 dt 2 lc rgb '#2b6cb0' title 'POV-Ray parse'"
} | gnuplot
printf '\n![Seconds over patches](performance/scale.svg)\n' >>"$folder/section"

# The section replaces the old one, up to the next heading of its kind.
page=docs/performance.md
[ -e "$page" ] || printf '# Performance\n\n' >"$page"
awk -v section="$folder/section" '
  function put() { while ((getline line < section) > 0) print line; print ""; done = 1 }
  /^## Scale$/ { put(); skipping = 1; next }
  /^## / { skipping = 0 }
  !skipping
  END { if (!done) { print ""; put() } }' "$page" | cat -s >"$folder/page"
cp "$folder/page" "$page"
echo "$page is written" >&2
