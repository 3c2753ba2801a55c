#!/bin/bash
# POV-Ray's pictures of every scene and of its dump are the same, except for rounding at edges. A transform is applied
# to the points by pscn in the dump, by POV-Ray in the scene. So a point may differ in its last digit, and a ray through
# an edge may meet another triangle. Such pixels are at most PERCENT of all, in each scene.
PERCENT=0.1
LIMIT=1/255
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
failed=0
render() {
  povray "+I$1" "+O$2" +W160 +H120 -D -A +FN8 Work_Threads=1 >"$2.log" 2>&1 || { cat "$2.log"; exit 1; }
}
same() {
  local own=$PWD
  cd "$PSCN_SOURCE_DIR/scenes"
  "$PSCN" dump "$1" --size 160x120 >"$own/dump.pov"
  render "$1" "$own/scene.png"
  render "$own/dump.pov" "$own/dump.png"
  "$PSCN" compare "$own/scene.png" "$own/dump.png" --fail $LIMIT --failpercent $PERCENT --quiet ||
    { echo "  $1 and its dump"; exit 1; }
}
for scene in "$PSCN_SOURCE_DIR"/scenes/*.pscn; do beside same "${scene##*/}"; done
all_right || failed=1
count=${#children[@]}
[ "$count" -ge 9 ] || { echo "only $count scenes"; failed=1; }
[ "$failed" -eq 0 ] && echo "$count scenes and their dumps are the same to POV-Ray"
exit "$failed"
