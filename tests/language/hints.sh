#!/bin/bash
# Every word that POV-Ray reserves and pscn lacks is reported as such, in a scene that contains nothing else.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
failed=0
words=$(wc -w <"$PSCN_SOURCE_DIR/grammar/povray.txt")
tr -s ' \n' '\n\n' <"$PSCN_SOURCE_DIR/grammar/povray.txt" | grep . | split -l 10 - words. # 20 errors end a run
cat words.* | wc -l
for list in words.*; do
  "$PSCN" dump "$list" >out 2>err && { echo "$list: exit 0"; failed=1; }
  while read -r word; do
    grep -Eq "error: $word is POV-Ray, but pscn (has no $word|renders bicubic_patch only)(; .*)?$" err ||
      { echo "not told: $word"; failed=1; }
  done <"$list"
done
[ "$words" -ge 439 ] || failed=1
exit "$failed"
