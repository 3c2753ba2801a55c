# The statistics: their keys, and numbers that are known.
scene=$SCENES/flat.pscn
pscn render "$scene" -o a.png --size 20x10 --samples 2 --threads 1 --tolerance 1e-9 --stats - --quiet |
  grep -v -E '"(parse|build|render|write|version)":'
pscn render "$scene" -o a.png --size 20x10 --crop 2,1,8,4 --stats a.json --solver aberth --quiet
grep -c -E '"(parse|build|render|write)": *[0-9]' a.json
grep -E '"(solver|tolerance|primary|samples)"' a.json
echo '0 0 -4 0 0 1' | pscn trace "$scene" --stats - | grep -v -E '"(parse|build|render|write|version)":'
