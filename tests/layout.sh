#!/bin/sh
# layout.sh: checks that every C and C++ source has the layout of .clang-format. To lay one out: clang-format -i FILE.
# Versions of clang-format other than 14 differ a little: without that one nothing is checked.
cd "$(dirname "$0")/.." || exit 1
for program in clang-format-14 clang-format; do
  "$program" --version 2>/dev/null | grep -q 'version 14\.' || continue
  find src tests examples -name '*.[ch]' -o -name '*.cpp' | sort | xargs "$program" --dry-run --Werror
  exit
done
echo 'layout.sh: skipped: clang-format 14 is not installed'
exit 77
