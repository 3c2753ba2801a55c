# The statistics: their keys, and known numbers. Times and the intersector's work are only checked to be there.
work() {
  sed -E '/"(parse|build|render|write|load|version)":/d; s/("(patches_tested|subdivided|found|accepted)": )[0-9]+/\1.../'
}
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 20x10 --samples 2 --threads 1 --tolerance 1e-9 --stats - --quiet | work
pscn render "$scene" -o a.exr --size 20x10 --crop 2,1,8,4 --threads 5 --stats a.json --solver aberth --quiet
grep -c -E '"(parse|build|render|write|load)": *[0-9]' a.json
grep -E '"(solver|tolerance|threads|primary|samples)"' a.json
grep -A 4 '"crop"' a.json
grep -E '"(render|write|load)": 0\.0,?$' a.json # all takes some time
# No CPU second counts twice, although libraries are loaded at the same time.
TIMEFORMAT='%U %S'
time (pscn render "$PSCN_SOURCE_DIR/scenes/waves.pscn" -o a.exr --size 800x600 --threads 1 --stats a.json --quiet 2>&3) \
  3>&2 2>taken
LC_ALL=C awk -F '[ :,]+' 'NR == FNR { gsub(",", "."); split($0, t, " "); process = t[1] + t[2]; next }
  /"cpu"/ { on = 1; next } /}/ { on = 0 } on { sum += $3 }
  END { print (sum > 0 && sum < process + 0.01 ? "as much as the process" : sum " of " process) }' taken a.json
# Standard error reports the same numbers: for a scene that uses all stages, and one where nothing is proven.
for solver in 'aberth { split 1 }' 'laguerre { form paper }'; do
  pscn render "$PSCN_SOURCE_DIR/scenes/wild.pscn" -o a.png --size 40x30 --solver "$solver" --stats a.json 2>said
  LC_ALL=C awk -F '[ :,"]+' '
    function grouped(n,    s) {
      for (s = n ""; match(s, /[0-9][0-9][0-9][0-9](,|$)/);) s = substr(s, 1, RSTART) "," substr(s, RSTART + 1)
      return s
    }
    /{$/ { part = $2 == "" ? "" : $2 "."; next }
    /^  }/ { part = ""; next }
    { is[part $2] = $3 }
    END {
      print "rays     " grouped(is["rays.primary"]) " primary, " grouped(is["rays.shadow"]) " shadow"
      print "answers  " grouped(is["answers.certain"]) " certain, " grouped(is["answers.grazing"]) " grazing (of primary rays)"
      print "leaves   " grouped(is["patches_tested"]) " ray-leaf pairs, " grouped(is["stages.resultant"]) \
        " of them solved by a resultant of full degree, " grouped(is["subdivided"]) " in exact arithmetic"
      print "roots    " grouped(is["roots.found"]) " found, " grouped(is["roots.accepted"]) " accepted as hits"
      printf "time     %.3f s parse, %.3f s build, %.3f s render, %.3f s write\n", is["time.parse"], is["time.build"],
        is["time.render"], is["time.write"]
    }' a.json | diff said - | grep '^>'
  grep -c '"\(planes\|resultant\|subdivided\|grazing\)": [1-9]' a.json
done
echo '0 0 -4 0 0 1' | pscn trace "$scene" --stats - | work
echo '0 0 -4 0 0 1' | pscn trace "$scene" --stats a.json >/dev/null
grep -E '"(parse|build|render)": 0\.0,?$' a.json
# Names that are not UTF-8.
cp "$scene" $'fl\xe4t.pscn'
try pscn render $'fl\xe4t.pscn' -o $'\xc3\xa4\xff.png' --size 4x3 --quiet --stats name.json
grep -E '"(scene|picture)"' name.json
# One thread for each processor that may be used.
first=$(sed -n 's/^Cpus_allowed_list:[[:blank:]]*\([0-9]*\).*/\1/p' /proc/self/status)
if command -v taskset >/dev/null; then
  taskset -c "$first" "$PWD/../pscn" render "$scene" -o a.png --size 64x64 --stats - --quiet | grep '"threads"'
else echo '  "threads": 1,'; fi
