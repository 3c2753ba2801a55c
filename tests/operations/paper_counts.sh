#!/bin/bash
# paper_counts.sh PROGRAMS: the counts in the committed files of docs/paper are those of the code, unlike the times: all
# of the random polynomials, the patch at eps = 1e-6; nearly those of a changed picture, of what lies beside lost hits,
# and of a height field. The page agrees with its template. If this fails, examples/paper.sh makes the page again.
# PROGRAMS is the folder of examples/paper in the build tree; PSCN_SOURCE_DIR the source tree.
set -euo pipefail
export LC_ALL=C
programs=$1 pscn=$PSCN
cd "$PSCN_SOURCE_DIR"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0

# The columns of a file are those that a command prints; with a pattern, only the rows that match it.
same() { # FILE COLUMNS PATTERN COMMAND...
  local file=$1 columns=$2 pattern=$3
  shift 3
  "$@" | grep -E "$pattern" | cut -d, -f"$columns" >"$folder/here"
  grep -E "$pattern" "docs/paper/$file.csv" | cut -d, -f"$columns" >"$folder/there"
  [ -s "$folder/here" ] || { echo "$file: nothing to compare"; failed=1; }
  if ! diff "$folder/there" "$folder/here" >"$folder/diff"; then
    echo "docs/paper/$file.csv: its counts (<) are not those of the code (>)"
    head -8 "$folder/diff"
    failed=1
  fi
}

# The same for a picture's pixels, within 3 % and 5 of them: whether a root is just lost depends on its last bits, so on
# the instruction set and the compiler.
near() { # FILE PATTERN COMMAND...
  local file=$1 pattern=$2
  shift 2
  "$@" | grep -E "$pattern" >"$folder/here"
  grep -E "$pattern" "docs/paper/$file.csv" >"$folder/there"
  if ! paste -d, "$folder/there" "$folder/here" | awk -F, '
    function off(a, b) { a -= b; return a < 0 ? -a : a }
    { n = NF / 2; for (k = 3; k <= n; k++) bad += off($k, $(n + k)) > 5 + 0.03 * $k } END { exit NR == 0 || bad > 0 }'; then
    echo "docs/paper/$file.csv: its counts (<) are far from those of the code (>)"
    diff "$folder/there" "$folder/here" | head -8
    failed=1
  fi
}

# The page is made from the template and the files; changes by hand must be made in both.
awk -v data=docs/paper -f examples/paper/fill.awk examples/paper/paper.md.in >"$folder/page"
if ! diff docs/paper.md "$folder/page" >"$folder/diff"; then
  echo "docs/paper.md (<) is not what examples/paper.sh page makes (>)"
  head -8 "$folder/diff"
  failed=1
fi

same degrees 1-3,7 . "$programs/random_experiments" degrees once
same tolerances 1-3,5,7,8 . "$programs/random_experiments" tolerances once
same order 1-5 . "$programs/random_experiments" order
same improvements 1-4,6-8 . "$programs/random_experiments" improvements once
same caps 1-6 . "$programs/random_experiments" caps once
same footing_degrees 1-4,8-13 . "$programs/footing" degrees once
same starts 1-3 . "$programs/claims" starts
same slopes 1-3 . "$programs/claims" slopes
same patch 1-4,6,7 '^1e-6,' "$programs/patch_experiments" scenes/paper.pscn 100 75 6
# The cause of Fig 17: with u and v exchanged, with another division, or another start, the same methods give another
# picture.
eval "$(sed -n '/^exchanged() {/,/^}/p; /^field() {/,/^}/p; /^keep() /p' examples/paper.sh)"
exchanged scenes/paper_magnified.pscn >"$folder/exchanged.pscn"
way() { # WAY SCENE METHOD ITEMS
  printf 'fig17,%s,%s,' "$1" "$3"
  "$programs/picture_errors" "$2" 320 240 "$3 { form paper start previous max_iterations 500 tolerance 1e-10 $4 }" "$folder/picture"
}
near ways '^fig17,exchanged,laguerre' way exchanged "$folder/exchanged.pscn" laguerre ''
for items in 'deflation composite' 'radii polygon'; do
  near ways "^fig17,$items,laguerre" way "$items" scenes/paper_magnified.pscn laguerre "$items"
done
# Where the hits lie that the pictures lose, and how many are found along the axis of a height field.
near near '^Fig' "$programs/../../tests/stability/stability-causes" projected
data=$folder
field
near field '^[nla]' cat "$folder/field.csv"
exit $failed
