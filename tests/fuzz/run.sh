#!/bin/bash
# run.sh SECONDS [TARGET...]: lets libFuzzer run each target (by default all) for this many seconds of CPU time, one
# after the other, under address, undefined and leak sanitizers. Needs clang; first builds into build-fuzz.
#
# Inputs begin with seeds/, found/, the scenes of the project and of its tests. Those that increase coverage are kept in
# build-fuzz/corpus, where the next run continues. An input that crashes, leaks or takes longer than PSCN_FUZZ_TIMEOUT
# seconds by the clock (100) ends the target: it is put into build-fuzz/artifacts and named, and the exit code is 1.
# Once it is mended, or reported, it moves to found/TARGET, where ctest replays it. Prints a line for each target: CPU
# seconds, executions, coverage (edges, and libFuzzer's features), inputs kept, the slowest input.
set -euo pipefail
seconds=${1:?seconds of CPU for each target}
shift
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
build=$top/build-fuzz
[ $# -gt 0 ] || set -- scene render solver rays polynomials options pictures

export ASAN_OPTIONS=${ASAN_OPTIONS-intercept_tls_get_addr=0} # ../CMakeLists.txt says why
cd "$top"
cmake --preset fuzz >/dev/null
nice cmake --build --preset fuzz --parallel 1 >/dev/null
mkdir -p "$build/artifacts" "$build/work"

# The language's words: the names of the grammar's tokens and of the methods, and what stands between words.
words=$build/words.dict
{
  grep -oh '"#\?[a-z][a-z_]*"' "$top/grammar/pscn.y" "$top"/src/algebra/solver*.c "$top"/src/scene/method.c
  printf '"%s"\n' '#ifdef (' '#ifndef (' '#else' '#end' '#include \"' 'pscn' '{' '}' '(' ')' '<' '>' ',' ';' '.x' '/*' \
    '*/' '//' '//: ' '1e308' '1e-320' '-1' '0.5' '<1,2,3>' 'rgb 1' '#declare A = ' '#local B = ' '; ' 'Given' 'nested.inc' \
    'sphere { 0, 1 }' 'granite ' 'A ' '#undef A' '<1,2>' '#if (' '#elseif (' '#while (' '#for (I, 0, 3) ' '#switch (' \
    '#case (1)' '#range (1, 2)' '#break' '#macro M(A) ' 'M(1)' '#end ' 'array[2]' '[0]' '[' ']' '?' ':' '&' '|' '<=' '!=' \
    '#debug ' '#error ' 'concat(' 'str(1, 0, 2)' 'rand(S)' 'seed(1)' 'defined(A)' 'sin(' 'max(' 'vrotate(' 'hollow ' \
    'transform { A scale 2 }' 'concat(\"a\", A)' '.transmit' '<1,2,3,4,5>'
} | sort -u >"$words"
options=$build/options.dict
{
  for command in render trace roots dump compare check chart; do
    "$build/src/command/pscn" help $command
  done | grep -o -- '--[a-z-]*' | sort -u | sed 's/.*/"&"\n"&="/'
  printf '"%s"\n' s.pscn a.png b.exr '\x0a' '-o' '-I.' 'rgb,depth' 'Low=1' '4/255' 5M
} >"$options"
numbers=$build/numbers.dict
printf '"%s"\n' '0 ' '-1 ' '1e-11 ' '1.999 ' '1e308 ' '1e-320 ' '1e-17 ' '.5 ' '\x0a' '\x00\x00\x00\x00\x00\x00\xf0\x3f' \
  '\x00\x00\x00\x00\x00\x00\xf0\x7f' '\x00\x00\x00\x00\x00\x00\xf8\x7f' '\x01\x00\x00\x00\x00\x00\x00\x00' >"$numbers"

# The number after the last NAME in libFuzzer's log.
last() { grep -ao "$1 *[0-9]*" "$2" | tail -n 1 | grep -o '[0-9]*$' || echo 0; }

# fuzz TARGET: runs it until its CPU time is spent, checked every two seconds.
fuzz() {
  local target=$1 corpus=$build/corpus/$1 log=$build/$1.log dictionary=$words length=4096 spent=0 now code=0 process
  local artifacts=$build/artifacts/$1- seeds=("$here/seeds/$1")
  mkdir -p "$corpus"
  [ ! -d "$here/found/$target" ] || seeds+=("$here/found/$target")
  case $target in
    scene | render)
      seeds+=("$top/scenes" "$top/tests/language/ok" "$top/tests/language/bad" "$top/tests/accuracy/cases")
      length=16384
      ;;
    options) dictionary=$options ;;
    rays | polynomials | pictures)
      dictionary=$numbers
      length=1024
      ;;
  esac
  (cd "$build/work" && exec nice "$build/tests/fuzz/fuzz-$target" -print_final_stats=1 -max_len=$length -len_control=20 \
    -timeout="${PSCN_FUZZ_TIMEOUT:-100}" -rss_limit_mb=4000 -close_fd_mask=3 -report_slow_units=20 -dict="$dictionary" \
    -artifact_prefix="$artifacts" "$corpus" "${seeds[@]}") >"$log" 2>&1 &
  process=$!
  while now=$(ps -o cputimes= -p "$process"); do
    spent=$((now))
    [ "$spent" -lt "$seconds" ] || kill -USR1 "$process" 2>/dev/null # which it ends at, and tells what it did
    sleep 2
  done
  wait "$process" || code=$?
  echo "$target: $spent CPU s, $(last 'stat::number_of_executed_units:' "$log") executions, $(last 'cov:' "$log") edges," \
    "$(last 'ft:' "$log") features, $(find "$corpus" -type f | wc -l) inputs kept," \
    "the slowest $(last 'stat::slowest_unit_time_sec:' "$log") s"
  return "$code"
}

status=0
for target in "$@"; do
  if ! fuzz "$target"; then
    echo "$target has ended; $build/$target.log says why"
    ls "$build/artifacts/$target-"* 2>/dev/null || true
    status=1
  fi
done
rm -rf "$build/work"
exit "$status"
