#!/bin/bash
# run.sh SECONDS [TARGET...]: lets libFuzzer run each target (all, where none is named) for so many seconds, one after the
# other, under address, undefined and leak sanitizers. Needs clang; builds into build-fuzz at first.
#
# Inputs begin with seeds/, the scenes of the project and of its tests; what covers more is kept in build-fuzz/corpus and
# taken up by the next run. What crashes, leaks or takes longer than PSCN_FUZZ_TIMEOUT seconds (10) is put into
# build-fuzz/artifacts and named at the end: exit 1. Once it is mended, or told, it moves to found/TARGET, where ctest
# replays it.
set -euo pipefail
seconds=${1:?seconds for each target}
shift
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$here/../..
build=$top/build-fuzz
[ $# -gt 0 ] || set -- scene render solver rays polynomials options

cd "$top"
cmake --preset fuzz >/dev/null
nice cmake --build --preset fuzz --parallel >/dev/null
mkdir -p "$build/artifacts" "$build/work"

# Words of the language: the names of the grammar's tokens and of the methods, and what else stands between words.
words=$build/words.dict
{
  grep -oh '"#\?[a-z][a-z_]*"' "$top/grammar/pscn.y" "$top"/src/algebra/solver*.c "$top"/src/scene/method.c
  printf '"%s"\n' '#ifdef (' '#ifndef (' '#else' '#end' '#include \"' 'pscn' '{' '}' '(' ')' '<' '>' ',' ';' '.x' '/*' \
    '*/' '//' '1e308' '1e-320' '-1' '0.5' '<1,2,3>' 'rgb 1' '#declare A = ' '#local B = ' '; '
} | sort -u >"$words"
options=$build/options.dict
for command in render trace roots dump compare check chart; do
  "$build/src/command/pscn" help $command
done | grep -o -- '--[a-z-]*' | sort -u | sed 's/.*/"&"\n"&="/' >"$options"

status=0
for target in "$@"; do
  corpus=$build/corpus/$target artifacts=$build/artifacts/$target- dictionary=$words
  mkdir -p "$corpus"
  seeds=("$here/seeds/$target")
  [ ! -d "$here/found/$target" ] || seeds+=("$here/found/$target")
  case $target in
    scene | render) seeds+=("$top/scenes" "$top/tests/language/ok" "$top/tests/language/bad") ;;
    options) dictionary=$options ;;
  esac
  (cd "$build/work" && nice "$build/tests/fuzz/fuzz-$target" -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 \
    -timeout="${PSCN_FUZZ_TIMEOUT:-10}" -rss_limit_mb=4000 -max_len=4096 -close_fd_mask=1 -max_total_time="$seconds" \
    -dict="$dictionary" -artifact_prefix="$artifacts" "$corpus" "${seeds[@]}") >"$build/$target.log" 2>&1 || true
  echo "$target: $(grep -c . <(ls "$corpus")) inputs kept; $(grep '^#' "$build/$target.log" | tail -n 1)"
  if compgen -G "$artifacts*" >/dev/null; then
    ls "$artifacts"*
    status=1
  fi
done
exit "$status"
