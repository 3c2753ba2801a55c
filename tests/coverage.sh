#!/bin/bash
# coverage.sh: how much of the sources the tests run, and how much the inputs of the fuzz targets run alone: lines and
# branches by folder, as a table. Builds into build-coverage (gcc, -O1) and runs ctest, heavy tests
# with PSCN_EFFORT (0.0001): half an hour on two cores.
#
#   coverage.sh           the table
#   coverage.sh missing   the lines and branches that the tests of the last table did not run, as HTML
#
# Branches are gcov's: each way out of each conditional jump. A source compiled for several instruction sets counts
# once, as run if one of them was. src/packaging is left out: its programs run while pscn is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
build=build-coverage
report() { gcovr --root . --filter src/ --filter grammar/ --exclude src/packaging/ --exclude-throw-branches "$@"; }

if [ "${1:-}" = missing ]; then
  mkdir -p "$build/missing"
  report --add-tracefile "$build/tests.json" --html-details "$build/missing/index.html"
  echo "$build/missing/index.html shows it"
  exit
fi

install_packages "${BUILD_PACKAGES[@]}" gcovr libcmocka-dev
cmake --preset coverage >"$build.log"
cmake --build "$build" >>"$build.log"

# count NAME: takes the present counters, and prints "FOLDER NAME lines run branches taken" for each folder.
count() {
  report --object-directory "$build" --json "$build/$1.json" "$build" 2>/dev/null
  report --add-tracefile "$build/$1.json" --csv | awk -F, -v name="$1" '
    NR == 1 { for (k = 1; k <= NF; k++) column[$k] = k; next }
    { split($1, part, "/"); folder = part[1] == "grammar" ? part[1] : part[1] "/" part[2]
      for (k = 0; k < 2; k++) { f = k ? folder : "~all"
        lines[f] += $column["line_total"]; run[f] += $column["line_covered"]
        branches[f] += $column["branch_total"]; taken[f] += $column["branch_covered"] } }
    END { for (f in lines) print f, name, lines[f], run[f], branches[f], taken[f] }'
  find "$build" -name '*.gcda' -delete
}

find "$build" -name '*.gcda' -delete
# A test that exceeds its time limit leaves no counts, so the limits are ten times as long.
find "$build" -name CTestTestfile.cmake -exec sed -i 's/ TIMEOUT "[0-9]*/&0/' {} +
# With counters in it the library needs more symbols than it may; library-install would complain.
PSCN_EFFORT=${PSCN_EFFORT:-0.0001} ctest --test-dir "$build" -E '^library-install$' --output-on-failure -j "$(nproc)" \
  >"$build/tests.log" ||
  sed -n '/tests passed/,$p' "$build/tests.log" >&2
count tests >"$build/counts"

for target in scene render solver rays polynomials options pictures; do
  inputs=("tests/fuzz/seeds/$target" "tests/fuzz/found/$target" "build-fuzz/corpus/$target")
  case $target in scene | render) inputs+=(scenes tests/language/ok tests/language/bad) ;; esac
  for folder in "${inputs[@]}"; do
    [ ! -d "$folder" ] || (folder=$PWD/$folder && cd "$build" && "tests/fuzz/fuzz-$target" "$folder" 2>fuzz.log) ||
      echo "fuzz-$target failed on $(tail -n 1 "$build/fuzz.log")" >&2
  done
done
count fuzzing >>"$build/counts"

echo '| folder | lines | run by tests | branches taken | run by fuzzing | branches taken |'
echo '|---|---|---|---|---|---|'
LC_ALL=C sort "$build/counts" | awk '
  function share(part, all) { return all ? sprintf("%.1f %%", 100 * part / all) : "-" }
  function row() { if (folder != "") printf "| %s | %d | %s | %s |\n", folder, lines, cell["tests"], cell["fuzzing"] }
  $1 != folder { row(); folder = $1; lines = $3; cell["tests"] = cell["fuzzing"] = "- | -" }
  { cell[$2] = share($4, $3) " | " share($6, $5) }
  END { sub(/~/, "", folder); row() }'
