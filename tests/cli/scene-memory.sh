# A hundred lines of text that ask for ten million patches, scenes from pipes, solver text that names a file.
{
  echo '#declare A0 = bicubic_patch { type 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 }'
  for n in 1 2 3 4 5 6 7; do
    echo "#declare A$n = union {"
    for k in 0 1 2 3 4 5 6 7 8 9; do echo "object { A$((n - 1)) translate $k*x }"; done
    echo '}'
  done
  echo 'object { A7 }'
} >many.pscn
for command in dump trace render; do
  try pscn $command many.pscn 2>&1 | sed -n 's/than [0-9]* patches/than N patches/; s/^many.pscn:[0-9:]*/many.pscn:/; /error\|exit/p'
done
try pscn dump many.pscn --max-memory 1M
# After errors of the text, too, the reason of the end is reported.
head -c 3M /dev/zero | tr '\0' ' ' >blank.inc
printf 'camera { loaction 1 }\n#include "blank.inc"\n' >word.pscn
try pscn dump word.pscn --max-memory 1M
sed '/A3 = /,$d' many.pscn >hundred.pscn
echo 'object { A2 }' >>hundred.pscn
try pscn dump hundred.pscn --max-memory 1M | grep -c bicubic_patch
for size in 0 M 5X 1.5G 99999999T ''; do try pscn dump hundred.pscn --max-memory "$size"; done
try pscn dump <(cat hundred.pscn) | grep -c bicubic_patch
cat hundred.pscn | try pscn dump /dev/stdin | grep -c bicubic_patch
try pscn dump /dev/zero
try pscn dump hundred.pscn --solver '#include "many.pscn"'
# A patch cut 64 times a side, ten thousand times in one place: --max-memory holds, and the answer is the same.
bomb() { # N
  echo '#declare A0 = bicubic_patch { type 0'
  for u in 0 1 2 3; do for v in 0 1 2 3; do echo "<$u,$v,0>"; done; done
  echo 'solver bernstein { split 64 } }'
  for n in 1 2 3 4; do echo "#declare A$n = union { $(for k in {1..10}; do echo "object { A$((n - 1)) }"; done) }"; done
  echo "object { A$1 }"
}
# asked MB SCENE OPTION...: prints the answer to a ray, and whether the process has taken no more than MB; it takes some
# more or less for the libraries, which depends on the machine.
asked() {
  local limit=$1 answer peak
  shift
  coproc pscn trace "$@" --certainty
  local process=$COPROC_PID out=${COPROC[1]}
  echo '1.5 0.75 -5 0 0 1' >&"$out"
  read -r -t 100 answer <&"${COPROC[0]}"
  peak=$(sed -n 's/^VmHWM:[[:space:]]*\([0-9]*\) kB/\1/p' /proc/$process/status)
  exec {out}>&-
  wait $process
  [ "$peak" -le $((limit * 1024)) ] && echo "$answer, $limit MB" || echo "$answer, $peak kB"
}
bomb 4 >bomb.pscn
bomb 0 >single.pscn
asked 12 single.pscn --max-memory 40M
asked 36 bomb.pscn --max-memory 40M
try pscn trace bomb.pscn --max-memory 1M </dev/null
