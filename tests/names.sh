#!/bin/sh
# names.sh: checks that every constant and macro defined in a header of src is used somewhere; comments do not count.
# One that is no longer used states what no longer holds.
cd "$(dirname "$0")/.." || exit 1
find src grammar tests examples -name '*.[chly]' -o -name '*.cpp' | sort | xargs awk '
  {
    code = ""
    for (line = $0; line != "";) {
      at = index(line, comment ? "*/" : "/*")
      if (!comment) code = code " " (at ? substr(line, 1, at - 1) : line)
      line = at ? substr(line, at + 2) : ""
      if (at) comment = !comment
    }
    sub(/\/\/.*/, "", code)
    words = split(code, word, /[^A-Za-z_0-9]+/)
    for (k = 1; k <= words; k++) used[word[k]]++
    if (FILENAME ~ /^src\/.*\.h$/ && code ~ /^ #define [A-Z]/) place[word[3]] = FILENAME ":" FNR
  }
  END {
    for (name in place) {
      if (used[name] > 1) continue
      print place[name] ": " name " is defined, and never used"
      bad = 1
    }
    exit bad
  }'
