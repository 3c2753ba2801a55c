#!/bin/bash
# A picture in pieces by GNU parallel.
#
#   examples/farm_parallel.sh PIECES FILE SCENE [OPTION...]      options of pscn render
#
# It can be run again: finished pieces stay, an interrupted one is continued. PSCN and JOBS (one for each processor) may
# be set.
set -euo pipefail
pieces=${1:?how many pieces?} file=${2:?which picture?}
shift 2
pscn=${PSCN:-pscn}
command -v parallel >/dev/null || { echo "GNU parallel is not installed" >&2; exit 4; }

folder=$file.pieces
mkdir -p "$folder"
for ((k = 1; k <= pieces; k++)); do [ -e "$folder/$k.exr" ] || echo "$k"; done |
  parallel --will-cite --jobs "${JOBS:-100%}" --halt now,fail=1 "$(printf '%q ' "$pscn" render "$@")" \
    --tile "{}/$pieces" -o "$(printf %q "$folder")/{}.exr" --threads 1 --quiet --resume
"$pscn" merge "$folder"/*.exr -o "$file"
rm -r "$folder"
