#!/bin/bash
# POV-Ray's pictures of every scene and of its dump are the same, except for rounding at edges. A transform is applied
# to the points by pscn in the dump, by POV-Ray in the scene. So a point may differ in its last digit, and a ray through
# an edge may meet another triangle. Such pixels are at most PERCENT of all, in each scene.
PERCENT=0.1
LIMIT=1/255
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
cd "$PSCN_SOURCE_DIR/scenes"
failed=0
count=0
render() {
  povray "+I$1" "+O$2" +W160 +H120 -D -A +FN8 Work_Threads=1 >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
}
for scene in *.pscn; do
  count=$((count + 1))
  "$PSCN" dump "$scene" --size 160x120 >"$folder/dump.pov"
  render "$scene" "$folder/scene.png"
  render "$folder/dump.pov" "$folder/dump.png"
  "$PSCN" compare "$folder/scene.png" "$folder/dump.png" --fail $LIMIT --failpercent $PERCENT --quiet ||
    { echo "  $scene and its dump"; failed=1; }
done
[ "$count" -ge 9 ] || { echo "only $count scenes"; failed=1; }
[ "$failed" -eq 0 ] && echo "$count scenes and their dumps are the same to POV-Ray"
exit "$failed"
