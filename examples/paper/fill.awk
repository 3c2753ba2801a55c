# Fills the numbers into a page: {{file column=value ... column format}} is the value of that column in the row of
# file.csv that has those values, in printf's format; a format that ends with %% has it times 100; with + the sum of
# columns joined by +.   awk -v data=FOLDER -f fill.awk page.md.in
function table_read(file,   path, line, count, k, head) {
  if (file in rows) return
  path = data "/" file ".csv"
  if ((getline line < path) <= 0) fail("no " path)
  columns[file] = split(line, head, ",")
  for (k = 1; k <= columns[file]; k++) column[file, head[k]] = k
  while ((getline line < path) > 0) row[file, ++count] = line
  close(path)
  rows[file] = count
}
function fail(text) { print FILENAME ":" FNR ": " text > "/dev/stderr"; failed = 1; exit 1 }
# {{ratio file column=value ... key a b column format}}: that column in the row where key=a over that where key=b.
function ratio(spec,   word, words, common, k, above, below) {
  words = split(spec, word, " ")
  for (k = 1; k <= words - 5; k++) common = common word[k] " "
  above = value(common word[words - 4] "=" word[words - 3] " " word[words - 1] " %.17g")
  below = value(common word[words - 4] "=" word[words - 2] " " word[words - 1] " %.17g")
  return sprintf(word[words], above / below)
}
# {{text file}}: its first row.
# {{share class parameters method cause}}: of 100 hits lost, in causes.csv.
function share(spec,   word, row) {
  split(spec, word, " ")
  row = "causes class=" word[1] " parameters=" word[2] " method=" word[3] " "
  return sprintf("%.0f", 100 * value(row word[4] " %.17g") / value(row "lost %.17g"))
}
function text(spec,   word) {
  split(spec, word, " ")
  table_read(word[1])
  return row[word[1], 1]
}
function fill(spec) {
  if (sub(/^text /, "", spec)) return text(spec)
  if (sub(/^share /, "", spec)) return share(spec)
  return sub(/^ratio /, "", spec) ? ratio(spec) : value(spec)
}
function value(spec,   word, words, r, k, cell, pair, fits, part, parts, sum, format) {
  words = split(spec, word, " ")
  table_read(word[1])
  for (r = 1; r <= rows[word[1]]; r++) {
    split(row[word[1], r], cell, ",")
    fits = 1
    for (k = 2; k <= words - 2; k++) {
      split(word[k], pair, "=")
      gsub(/_/, " ", pair[2])
      part = cell[column[word[1], pair[1]]]
      gsub(/_/, " ", part)
      if (part != pair[2]) fits = 0
    }
    if (!fits) continue
    parts = split(word[words - 1], part_name, "+")
    sum = 0
    for (k = 1; k <= parts; k++) {
      if (!((word[1], part_name[k]) in column)) fail("no column " part_name[k] " in " word[1])
      sum += cell[column[word[1], part_name[k]]]
    }
    format = word[words]
    return sprintf(format, format ~ /%%$/ ? 100 * sum : sum)
  }
  fail("no row for " spec)
}
{
  while (match($0, /\{\{[^}]*\}\}/))
    $0 = substr($0, 1, RSTART - 1) fill(substr($0, RSTART + 2, RLENGTH - 4)) substr($0, RSTART + RLENGTH)
  print
}
END { exit failed }
