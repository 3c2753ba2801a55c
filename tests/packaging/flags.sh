#!/bin/bash
# flags.sh: library calls check the sizes of arrays; if the user's flags ask for that, too, it is not asked for twice.
# The user's flags for contracting products and sums apply only to sources that may (src/intersect). An unoptimized
# build has no warnings about optimization.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for flags in -D_FORTIFY_SOURCE=3 '-O2 -ffp-contract=fast'; do
  cmake -S "$PSCN_SOURCE_DIR" -B "$folder/build" --fresh -DCMAKE_BUILD_TYPE=Release "-DCMAKE_C_FLAGS=$flags" "-DCMAKE_CXX_FLAGS=$flags" \
    >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
  commands=$folder/build/compile_commands.json
  found=$(grep -o -- '-D_FORTIFY_SOURCE' "$commands" | wc -l) files=$(grep -c '"command"' "$commands")
  [ "$found" = "$files" ] || { echo "with $flags: $files files, _FORTIFY_SOURCE is defined $found times"; exit 1; }
  contracting=$(sed -n '/"command"/{s/.*-ffp-contract=\([a-z]*\).* -c \(.*\)",$/\1 \2/; /^off /!p}' "$commands" |
    grep -vE '/(lanes/[a-z_]+|resultant_time)\.c$') || true
  [ -z "$contracting" ] || { echo "these may contract: $contracting"; exit 1; }
done

cmake -S "$PSCN_SOURCE_DIR" -B "$folder/build" --fresh -DCMAKE_BUILD_TYPE=Debug -DPSCN_WERROR=ON >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
command=$(sed -n 's/.*"command": "\(.*intersect\/method\.c\)",$/\1/p' "$folder/build/compile_commands.json")
command=${command//\\\"/\"}
(cd "$folder/build" && mkdir -p CMakeFiles/pscn_lib.dir/src/intersect && eval "$command")
