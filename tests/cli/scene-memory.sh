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
printf 'foo\n#include "blank.inc"\n' >word.pscn
try pscn dump word.pscn --max-memory 1M
sed '/A3 = /,$d' many.pscn >hundred.pscn
echo 'object { A2 }' >>hundred.pscn
try pscn dump hundred.pscn --max-memory 1M | grep -c bicubic_patch
for size in 0 M 5X 1.5G 99999999T ''; do try pscn dump hundred.pscn --max-memory "$size"; done
try pscn dump <(cat hundred.pscn) | grep -c bicubic_patch
cat hundred.pscn | try pscn dump /dev/stdin | grep -c bicubic_patch
try pscn dump /dev/zero
try pscn dump hundred.pscn --solver '#include "many.pscn"'
