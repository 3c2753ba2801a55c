# The statistics: their keys, and numbers that are known. Times and the work of the intersector are only there.
work() {
  sed -E '/"(parse|build|render|write|version)":/d; s/("(patches_tested|subdivided|found|accepted)": )[0-9]+/\1.../'
}
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 20x10 --samples 2 --threads 1 --tolerance 1e-9 --stats - --quiet | work
pscn render "$scene" -o a.png --size 20x10 --crop 2,1,8,4 --stats a.json --solver aberth --quiet
grep -c -E '"(parse|build|render|write)": *[0-9]' a.json
grep -E '"(solver|tolerance|primary|samples)"' a.json
echo '0 0 -4 0 0 1' | pscn trace "$scene" --stats - | work
# Names that are no UTF-8.
cp "$scene" $'fl\xe4t.pscn'
try pscn render $'fl\xe4t.pscn' -o $'\xc3\xa4\xff.png' --size 4x3 --quiet --stats name.json
grep -E '"(scene|picture)"' name.json
# A thread for each processor that may be used.
first=$(sed -n 's/^Cpus_allowed_list:[[:blank:]]*\([0-9]*\).*/\1/p' /proc/self/status)
if command -v taskset >/dev/null; then
  taskset -c "$first" "$PWD/../pscn" render "$scene" -o a.png --size 64x64 --stats - --quiet | grep '"threads"'
else echo '  "threads": 1,'; fi
