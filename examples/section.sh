# Sourced by the scripts that write a part of a page:
#
#   replace_section PAGE HEADING FILE     the part of PAGE below the line "## HEADING", up to the next such line, becomes FILE's text
#
# A PAGE without that heading gets it at its end. The page is replaced as a whole or not at all.
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
