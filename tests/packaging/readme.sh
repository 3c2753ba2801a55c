#!/bin/bash
# readme.sh: the scene at the top of README.md has the eight lines that it claims, is read without a message, and is
# visible; POV-Ray, if installed, shows the same. The files and headings that README.md and docs/ link to exist.
set -uo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failed=0
say() { echo "$*"; failed=1; }

sed -n '/ eight lines /,/^`/s/^    //p' "$PSCN_SOURCE_DIR/README.md" >bowl.pscn
[ "$(wc -l <bowl.pscn)" -eq 8 ] || say "the scene has $(wc -l <bowl.pscn) lines"
"$PSCN" bowl.pscn --size 40x30 -q --stats stats.json 2>said || say "it is not rendered"
[ ! -s said ] && [ -s bowl.png ] || say "pscn says of it: $(cat said)"
accepted=$(sed -n 's/.*"accepted": \([0-9]*\).*/\1/p' stats.json)
[ "${accepted:-0}" -gt 250 ] || say "little of it is seen: ${accepted:-0} rays of 1200 hit"
"$PSCN" bowl.pscn --size 40x30 -q -o same.png && "$PSCN" dump bowl.pscn >bowl.pov && "$PSCN" bowl.pov --size 40x30 -q -o dumped.png &&
  "$PSCN" compare same.png dumped.png --fail 0 -q || say "its dump is another picture"
if command -v povray >/dev/null; then
  "$PSCN" check bowl.pscn --size 400x300 --steps 0 --grid 0 --failpsnr 45 -q >log 2>&1 || { tail -5 log; say "POV-Ray shows something else"; }
fi

# headings FILE: the names that a link may have after "#", one a line.
headings() { sed -n 's/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g'; }

for page in README.md $(cd "$PSCN_SOURCE_DIR" && echo docs/*.md); do
  (cd "$PSCN_SOURCE_DIR" && cd "$(dirname "$page")" && name=$(basename "$page") &&
    grep -o ']([^):]*)' "$name" | sed 's/^](\(.*\))$/\1/' | sort -u | while IFS='#' read -r file heading; do
    [ -e "${file:-$name}" ] || { echo "$page leads to $file, which is not there"; continue; }
    [ -z "$heading" ] || headings "${file:-$name}" | grep -Fx -- "$heading" >/dev/null || echo "$page leads to $file#$heading, a heading that is not there"
  done) >links
  [ ! -s links ] || say "$(cat links)"
done
exit "$failed"
