#!/bin/bash
# A picture in pieces by GNU parallel, on this machine or on others (parallel -S host1,host2 --workdir . --return {}).
#
#   examples/farm_parallel.sh PIECES FILE SCENE [OPTION...]      options of pscn render
#
# Can be run again: pieces that are there stay, one that was interrupted goes on. PSCN and JOBS (1 for each processor) choose.
set -euo pipefail
pieces=${1:?how many pieces?} file=${2:?which picture?}
shift 2
pscn=${PSCN:-pscn}
command -v parallel >/dev/null || { echo "GNU parallel is not installed" >&2; exit 4; }

folder=$file.pieces
mkdir -p "$folder"
render() { # K
  "$pscn" render "${@:2}" --tile "$1/$pieces" -o "$folder/$1.exr" --threads 1 --quiet --resume
}
missing() { # those without a file, a number a line
  for ((k = 1; k <= pieces; k++)); do [ -e "$folder/$k.exr" ] || echo "$k"; done
}
export pscn pieces folder
export -f render
missing | parallel --will-cite --jobs "${JOBS:-100%}" --halt now,fail=1 render {} "$(printf '%q ' "$@")"
"$pscn" merge "$folder"/*.exr -o "$file"
rm -r "$folder"
