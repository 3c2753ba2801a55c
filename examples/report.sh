# shellcheck shell=bash
# Sourced by the scripts that measure and write a part of a page:
#
#   members STATISTICS GROUP NAME...      numbers out of what `pscn render --stats` wrote, such as: cpu parse build
#   replace_section PAGE HEADING FILE     the part of PAGE below the line "## HEADING", up to the next such line,
#                                         becomes FILE's text
#
# A PAGE without that heading gets it at its end. The page is replaced as a whole or not at all.
members() {
  local file=$1
  shift
  awk -v names="$*" 'BEGIN { n = split(names, want, " ") }
    match($0, /"[^"]*"/) { key = substr($0, RSTART + 1, RLENGTH - 2); rest = substr($0, RSTART + RLENGTH) }
    /\{$/ { group = key; next } /\}/ { group = "" }
    group == want[1] { sub(/^[: ]+/, "", rest); value[key] = rest + 0 }
    END { for (k = 2; k <= n; k++) printf "%.17g%s", value[want[k]], k < n ? " " : "\n" }' "$file"
}

replace_section() {
  local page=$1 heading=$2 file=$3
  awk -v heading="## $heading" -v file="$file" '
    function put() { print heading; print ""; while ((getline line < file) > 0) print line; print ""; done = 1 }
    $0 == heading { put(); skipping = 1; next }
    /^## / { skipping = 0 }
    !skipping
    END { if (!done) { print ""; put() } }' "$page" | cat -s | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}' >"$page.new"
  mv "$page.new" "$page"
}
