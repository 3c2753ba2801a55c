#!/bin/bash
# Cost against the number of patches, the size of the picture and the number of threads, pscn beside POV-Ray on the same
# files: writes the section "Scale" of docs/performance.md, docs/performance/scale.svg and reading.csv there.
#
#   examples/scale.sh [TEAPOTS...]       default 1 10 100 1000 10000; takes some six minutes
#
# The scenes are fields of teapots (examples/field.sh) and a single patch (scenes/bent.pscn). The two programs take
# turns, TURNS times, or once if one of them is slow. Times are medians of CPU seconds. Both are limited to
# MEMORY_LIMIT, POV-Ray also to TIME_LIMIT a run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
. examples/report.sh
export LC_ALL=C

MEMORY_LIMIT=8000000 # KiB of address space
TIME_LIMIT=200       # seconds
TURNS=3
SLOW=8               # seconds: a run that takes longer is not repeated
SIZE=800x600
SIZES=(400x300 800x600 1600x1200 3840x2160 7680x4320)
THREADS=(1 2 4 8 16)
TEXT_TEAPOTS=1000    # of the text that is written out for the speed of reading,
TEXT_TURNS=9         # in which each text is read so often
teapots=("$@")
[ $# -gt 0 ] || teapots=(1 10 100 1000 10000)

install_packages "${BUILD_PACKAGES[@]}" povray gnuplot-nox time
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build --target pscn >/dev/null
pscn=$PWD/build/src/command/pscn
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/home"

# ours FILE SIZE THREADS: "parse build render rays hits MB wall" of pscn, in CPU seconds except for the last, the clock
# time of rendering. It has POV-Ray's memory limit.
ours() {
  (ulimit -v "$MEMORY_LIMIT" && exec /usr/bin/time -f %M -o "$folder/memory" "$pscn" render "$1" --size "$2" \
    --threads "$3" --quiet --stats "$folder/stats.json" -o "$folder/pscn.png")
  # shellcheck disable=SC2046
  set -- $(members "$folder/stats.json" rays primary shadow)
  echo "$(members "$folder/stats.json" cpu parse build render) $(($1 + $2)) $2" \
    "$(awk '{ print $1 / 1024 }' "$folder/memory") $(members "$folder/stats.json" time render)"
}

# theirs FILE SIZE THREADS: "parse trace MB wall" of POV-Ray in the same way, or dashes if it did not finish.
theirs() {
  local status=0
  (cd "$(dirname "$1")" && ulimit -v "$MEMORY_LIMIT" && HOME=$folder/home exec timeout "$TIME_LIMIT" \
    /usr/bin/time -f %M -o "$folder/memory" povray "+I$(basename "$1")" "+O$folder/povray.png" \
    "+W${2%x*}" "+H${2#*x}" "+WT$3" -D -A >"$folder/log" 2>&1) || status=$?
  if [ "$status" -ne 0 ]; then
    echo "- - - -"
    return
  fi
  tr '\r' '\n' <"$folder/log" | awk -v memory="$(awk 'END { print $1 / 1024 }' "$folder/memory")" '
    /Parser? Time/ { part = 1 } /Trace Time/ { part = 2 }
    /Trace Time/ { match($0, /\([0-9.]+ seconds\)/); wall = substr($0, RSTART + 1) + 0 }
    /CPU-seconds total/ && part { sub(/.* with /, ""); s[part] += $1; part = 0 }
    END { print s[1] + 0, s[2] + 0, memory, wall + 0 }'
}

# both PART FILE SIZE THREADS: ours and theirs, 11 numbers: the median over the turns (PART 0.5) or the least (0).
both() {
  local turn took part=$1
  shift
  rm -f "$folder/turns"
  for ((turn = 0; turn < TURNS; turn++)); do
    SECONDS=0
    echo "$(ours "$@") $(theirs "$@")" >>"$folder/turns"
    took=$SECONDS
    [ "$took" -le "$SLOW" ] || break
  done
  awk -v part="$part" '{ for (k = 1; k <= NF; k++) v[k, NR] = $k }
    END {
      for (k = 1; k <= NF; k++) {
        for (a = 2; a <= NR; a++)
          for (b = a; b > 1 && v[k, b] < v[k, b - 1]; b--) { t = v[k, b]; v[k, b] = v[k, b - 1]; v[k, b - 1] = t }
        printf "%s%s", v[k, 1 + int((NR - 1) * part)], k < NF ? " " : "\n"
      }
    }' "$folder/turns"
}

# For tables: a number with this many digits, or a dash.
FORMAT='function f(x, digits) { return x == "-" ? "-" : sprintf("%." digits "f", x) }
  function above(mb) { return sprintf("%.0f", mb > empty ? mb - empty : 0) }'

echo 'background { rgb 0 }' >"$folder/empty.pscn"
empty=$(ours "$folder/empty.pscn" "$SIZE" 1 | awk '{ printf "%.0f", $6 }')
version=$(povray --version 2>&1 | awk '/POV-Ray [0-9]/ { print $2; exit }')

# ---- patches ----

{
  echo "Written by \`examples/scale.sh\`; the numbers are those of its last run. POV-Ray $version reads the same files"
  echo "(type 1, \`u_steps 5 v_steps 5 flatness 0\`, as they say). Times are CPU seconds of each phase, medians of"
  echo "$TURNS turns (one where a turn takes more than $SLOW s). Memory is the peak of the process above that of pscn"
  echo "for an empty scene, $empty MB; POV-Ray's is the peak of the process. Both were given"
  echo "$((MEMORY_LIMIT / 1000000)) GB of address space, POV-Ray $TIME_LIMIT s a run; a dash says that this was not enough."
  echo
  echo "### Patches"
  echo
  echo "\`scenes/bent.pscn\`, and fields of teapots that are all \`object { Teapot }\` of one \`#declare\`"
  echo "(\`examples/field.sh\`); $SIZE, one thread, the light at the camera: every hit sends one shadow ray."
  echo
  echo "| patches | parse s | build s | render s | ns a ray | us a hit | MB | POV-Ray: parse s | trace s | MB |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
} >"$folder/section"
for n in 0 "${teapots[@]}"; do
  if [ "$n" -eq 0 ]; then
    patches=1
    cp scenes/bent.pscn "$folder/field.pscn"
  else
    patches=$((32 * n))
    examples/field.sh "$n" >"$folder/field.pscn"
  fi
  both 0.5 "$folder/field.pscn" "$SIZE" 1 >"$folder/line"
  awk -v n="$patches" -v empty="$empty" "$FORMAT"'{
    printf "| %d | %.3f | %.3f | %.2f | %.0f | %.2f | %s | %s | %s | %s |\n",
      n, $1, $2, $3, 1e9 * $3 / $4, 1e6 * $3 / ($5 ? $5 : 1),
      above($6), f($8, 2), f($9, 2), f($10, 0) }' "$folder/line" | tee -a "$folder/section" >&2
  echo "$patches $(cat "$folder/line")" >>"$folder/patches"
done

mkdir -p docs/performance
gnuplot <<END
set terminal svg size 900,420 font 'sans-serif,13' background '#ffffff'
set output '$folder/scale.svg'
set datafile missing '-'
set logscale xy; set format xy '10^{%T}'; set xlabel 'patches'; set grid lc rgb '#dddddd'; set tics scale 0.7
set key outside top center horizontal Left reverse samplen 2
set multiplot layout 1,2
set ylabel 'CPU seconds'
plot '$folder/patches' using 1:4 with linespoints pt 7 ps 0.8 lw 1.5 lc rgb '#c02020' title 'pscn: render', \
  '' using 1:(\$2+\$3) with linespoints pt 6 ps 0.8 dt 2 lc rgb '#c02020' title 'parse and build', \
  '' using 1:10 with linespoints pt 5 ps 0.8 lw 1.5 lc rgb '#0891b2' title 'POV-Ray: trace', \
  '' using 1:9 with linespoints pt 4 ps 0.8 dt 2 lc rgb '#0891b2' title 'parse'
set ylabel 'MB, peak of the process'
plot '$folder/patches' using 1:7 with linespoints pt 7 ps 0.8 lw 1.5 lc rgb '#c02020' title 'pscn', \
  '' using 1:11 with linespoints pt 5 ps 0.8 lw 1.5 lc rgb '#0891b2' title 'POV-Ray'
END
printf '\n![CPU seconds and memory over patches](performance/scale.svg)\n' >>"$folder/section"

# ---- reading ----

# text KIND: about 8 MB of it, repeating all but a number, @.
text() {
  awk -v kind="$1" 'BEGIN {
    patch = "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3"
    for (k = 0; k < 16; k++) patch = patch sprintf(", <%d, %.7f, %.15g>", k, k / 7, k / 3e5)
    for (k = 0; k < 100; k++) { opened = opened "union { "; closed = closed "} " }
    apart = patch
    gsub(/, /, ",\n", apart)
    text["patches, one line"] = patch " } "
    text["patches, a number a line"] = apart " }\n"
    text["declared numbers"] = "#declare Number@ = @;\n"
    text["declared textures"] = "#declare Texture@ = texture { pigment { color rgb <0.3, 0.5, 0.@> } }\n"
    for (k = 0; k < 16; k++) long = long sprintf(" <%.16e, %.16e, %.16e>", k / 7, 1e9 * k, 1e-9 / (k + 1))
    text["patches, 17 digits and exponents"] = "bicubic_patch { type 1" long " }\r\n"
    for (k = 0; k < 16; k++) made = made " Corner*2+x"
    text["patches of sums"] = "bicubic_patch { type 1" made " }\n"
    text["unions, 100 deep"] = opened patch " } " closed "\n"
    text["copies"] = "object{Patch}"
    text["copies of a union"] = "object{Pair}"
    text["copies with a texture"] = "object{Patch pigment{rgb @}}"
    text["copies, moved"] = "object { Patch translate <@, 2, 3> }\n"
    text["copies, turned"] = "object { Patch rotate <@, 2, 3> }\n"
    for (k = 0; k < 30; k++) moved = moved " rotate <@, 2, 3> scale <1, 2, 3> translate <1, 2, 3>"
    text["copies, 90 transforms each"] = "object { Patch" moved " }\n"
    for (k = 0; k < 90; k++) turned = turned " rotate 1"
    text["copies, nothing but rotate 1"] = "object { Patch" turned " }\n"
    text["copies, a matrix each"] = "object { Patch matrix <1,0,@,0,1,0,0,0,1,1,2,3> }\n"
    text["lights"] = "light_source{<@,2,3>,rgb 1}\n"
    for (k = 0; k < 40; k++) { sum = sum "+1*2-3/4"; names = names "+A*A" }
    text["expressions, a token a byte"] = "#declare Sum = " sum ";\n"
    text["expressions of names"] = "#declare Sum = A" names ";\n"
    text["expressions of lower-case names"] = "#declare Sum = a" tolower(names) ";\n"
    for (k = 0; k < 16; k++) corners = corners " a"
    text["patches of names"] = "bicubic_patch { type 1" corners " }\n"
    for (k = 0; k < 90; k++) shapes = shapes "sphere{0 1}"
    text["declared shapes"] = "#declare Shape@ = union{" shapes "}\n"
    text["declared shapes of unknown names"] = "#declare Shape = union{sphere{0 1}object{Name@}}\n"
    for (k = 0; k < 100; k++) { left = left "("; right = right ")" }
    text["expressions in parentheses"] = "#declare Sum = " left "1" right ";\n"
    for (k = 0; k < 100; k++) { asked = asked "#ifdef (Patch) "; ended = ended "#end " }
    text["conditions, 100 deep"] = asked ended "\n"
    text["comments"] = "// what this is about, in a line or two\n"
    text["blanks"] = "                                       \n"
    printf "#version 3.7;\n#declare Patch = %s }\n#declare Pair = union { object { Patch } object { Patch } }\n", patch
    printf "#declare Corner = <1, 2, 3>;\n#declare A = 2;\n#declare a = 2;\n"
    count = split(text[kind], part, "@")
    for (n = 0; bytes < 8e6; n++) {
      piece = part[1]
      for (k = 2; k <= count; k++) piece = piece n part[k]
      printf "%s", piece
      bytes += length(piece)
    }
  }'
}

# reading NAME FILE: a line, by the fastest turn, since other work only adds time; by trace, which does not load
# libraries for pictures meanwhile.
reading() {
  for ((turn = 0; turn < TEXT_TURNS; turn++)); do
    "$pscn" trace --quiet --stats "$folder/stats.json" "$2" </dev/null
    members "$folder/stats.json" cpu parse
  done | sort -g | awk -v name="$1" -v bytes="$(stat -c %s "$2")" '
    NR == 1 { printf "\"%s\",%.1f,%.2f,%.0f\n", name, bytes / 1e6, $1, bytes / 1e6 / $1 }'
}

# reading_summary CSV: sentences on all rows.
reading_summary() {
  awk -F '"?,' -v turns="$TEXT_TURNS" -v patches=$((32 * TEXT_TEAPOTS)) '
    NR == 1 { next }
    { name = $0; sub(/^"/, "", name); sub(/",.*/, "", name); rate = $NF + 0
      if (name == "canonical") canonical = rate
      if (least == "" || rate < least) { least = rate; slow = name }
      if (rate > most) { most = rate; fast = name }
      all[++n] = rate; for (k = n; k > 1 && all[k - 1] > all[k]; k--) { t = all[k]; all[k] = all[k - 1]; all[k - 1] = t } }
    END {
      printf "CPU time from text to scene, the least of %d turns: `pscn dump`\047s text of %d patches is read at %d MB/s. Twenty-six\n", turns, patches, canonical
      printf "other kinds of text take from %d MB/s (%s) to %d MB/s (%s), in the median %d\n", least, slow, most, fast, all[int((n + 1) / 2)]
      print "([reading.csv](performance/reading.csv))." }' "$1"
}
{
  echo 'text,MB,s,MB_per_s'
  examples/field.sh "$TEXT_TEAPOTS" >"$folder/field.pscn"
  "$pscn" dump "$folder/field.pscn" >"$folder/text.pscn"
  reading canonical "$folder/text.pscn"
  for kind in 'patches, one line' 'patches, a number a line' 'patches, 17 digits and exponents' 'patches of sums' \
    'patches of names' 'declared numbers' 'declared textures' 'declared shapes' 'declared shapes of unknown names' \
    'unions, 100 deep' copies 'copies of a union' 'copies with a texture' \
    'copies, moved' 'copies, turned' 'copies, a matrix each' 'copies, 90 transforms each' 'copies, nothing but rotate 1' \
    lights 'expressions, a token a byte' 'expressions of names' 'expressions of lower-case names' \
    'expressions in parentheses' 'conditions, 100 deep' comments blanks; do
    text "$kind" >"$folder/text.pscn"
    reading "$kind" "$folder/text.pscn"
  done
} | tee "$folder/reading.csv" >&2
{
  echo
  echo "### Reading"
  echo
  reading_summary "$folder/reading.csv"
} >>"$folder/section"

# ---- size ----

{
  echo
  echo "### Size"
  echo
  echo "One teapot of the field, one thread:"
  echo
  echo "| size | render s | ns a ray | MB | POV-Ray: trace s | MB |"
  echo "|---|---|---|---|---|---|"
} >>"$folder/section"
examples/field.sh 1 >"$folder/field.pscn"
for size in "${SIZES[@]}"; do
  both 0.5 "$folder/field.pscn" "$size" 1 >"$folder/line"
  awk -v size="$size" -v empty="$empty" "$FORMAT"'{
    printf "| %s | %.2f | %.0f | %s | %s | %s |\n", size, $3, 1e9 * $3 / $4, above($6), f($9, 2), f($10, 0)
  }' "$folder/line" |
    tee -a "$folder/section" >&2
done

# ---- threads ----

{
  echo
  echo "### Threads"
  echo
  echo "100 teapots at 1600x1200 on a machine of $(nproc) processors, seconds by the clock, the least of $TURNS turns:"
  echo
  echo "| threads | render s | times as fast | POV-Ray: trace s | times as fast |"
  echo "|---|---|---|---|---|"
} >>"$folder/section"
examples/field.sh 100 >"$folder/field.pscn"
one=
for threads in "${THREADS[@]}"; do
  [ "$threads" -le "$(nproc)" ] || break
  both 0 "$folder/field.pscn" 1600x1200 "$threads" >"$folder/line"
  [ -n "$one" ] || one=$(cat "$folder/line")
  echo "$one $(cat "$folder/line")" | awk -v t="$threads" "$FORMAT"'{
    printf "| %d | %.2f | %.2f | %s | %s |\n", t, $18, $7 / $18, f($22, 2), ($22 + 0 ? f($11 / $22, 2) : "-")
  }' | tee -a "$folder/section" >&2
done

cp "$folder/scale.svg" "$folder/reading.csv" docs/performance/
replace_section docs/performance.md Scale "$folder/section"
echo "docs/performance.md is written" >&2
