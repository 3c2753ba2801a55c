#!/bin/sh
# layout.sh: whether every C and C++ source is laid out as .clang-format says. To lay one out: clang-format -i FILE.
# Other versions of clang-format than 14 lay out a little differently: without that one nothing is checked.
cd "$(dirname "$0")/.." || exit 1
for program in clang-format-14 clang-format; do
  "$program" --version 2>/dev/null | grep -q 'version 14\.' || continue
  find src tests examples -name '*.[ch]' -o -name '*.cpp' | sort | xargs "$program" --dry-run --Werror
  exit
done
echo 'layout.sh: skipped: clang-format 14 is not installed'
exit 77
