# Inputs are files or pipes. Whatever has no end is refused at once, by every command.
scene=$SCENES/flat.pscn
within() { try timeout 100 "$@"; }
for device in /dev/zero /dev/null; do
  within pscn compare $device $device
  within pscn dump $device
  within pscn render $device -o a.png
done
mkfifo pipe # without a writer
printf '#include "%s"\n' /dev/zero pipe . >device.pscn
within pscn dump device.pscn
# A pipe is read once, whatever its name.
cat "$scene" >pipe &
pscn dump pipe | cmp - <(pscn dump "$scene") && echo same
pscn dump <(cat "$scene") | cmp - <(pscn dump "$scene") && echo same
within pscn compare pipe pipe
within pscn compare <(cat "$scene") pipe 2>&1 | sed 's|/dev/fd/[0-9]*|PIPE|'
within pscn compare . .
ls -A
# Names that lead nowhere.
ln -s loop loop
for name in loop device.pscn/x "$(printf 'x%.0s' {1..300})"; do within pscn dump "$name" 2>&1 | sed 's/xxx*/x.../'; done
# Texts of NULs take no longer than others, nor does a file that holds nothing for 4 GB.
nuls() { head -c 4000000 /dev/zero; }
nuls >nuls
within pscn dump nuls | tail -n 1
(printf '//' && nuls) | timeout 100 pscn dump - | cmp - <(pscn dump - </dev/null) && echo a comment
(printf '/*' && nuls && printf '*/') | timeout 100 pscn dump - | cmp - <(pscn dump - </dev/null) && echo a comment
(printf '#include "' && nuls) | within pscn dump - 2>&1 | cut -c 1-60
truncate -s 4G empty.exr
within pscn compare empty.exr empty.exr
within pscn merge empty.exr -o merged.png
mv empty.exr long.pscn
within pscn dump long.pscn
echo '#include "long.pscn"' | within pscn dump -
# Warnings are limited as errors are: the place of each of many would be sought from the beginning of the text.
yes 'global_settings { assumed_gamma 1 }' | head -n 300000 | within pscn dump - 2>&1 | grep -n 'warnings\|exit'
# An object that is mostly empty is not searched again for each of its copies.
empty_unions() {
  echo '#declare Hollow = union { bicubic_patch { type 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 }'
  yes 'union {}' | head -n 400000
  echo '}'
  yes 'object { Hollow }' | head -n 20000
}
empty_unions | within pscn dump - 2>&1 | grep -c 'bicubic_patch\|exit'
# The names that a macro or a loop declares again and again take no more memory.
calls() {
  echo '#macro Add(A, B) #local Sum = A + B; #local Half = Sum/2; #declare A = Sum; #end #declare S = 0;'
  echo '#for (I, 1, 50000) Add(S, I) #end background { rgb S/1250025000 }'
}
calls | within pscn dump - --max-memory 1M | grep background
# A loop without end is stopped.
echo '#while (1) bicubic_patch { type 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 } #end' | within pscn dump - 2>&1 | grep 'rror\|exit'
# The memory of a long file is released while it is read; a part that a message shows is read again.
long_scene() {
  local blanks k
  printf -v blanks '%60000s' ''
  for k in {1..300}; do
    [ $((k % 100)) != 50 ] || echo "#declare M$k = sphere { 0, 1 }"
    echo "bicubic_patch { type 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 }$blanks"
  done
  echo 'light_source { <M50, M150, M250>, rgb 1 }'
}
long_scene >long.pscn
within pscn dump long.pscn
long_scene | pscn dump - 2>&1 | sed 's/stdin/long.pscn/g' | cmp - <(pscn dump long.pscn 2>&1) && echo same
# The limits of the depth and the number of included files; each file is held once.
for k in {1..33}; do echo "#include \"deep$((k + 1)).inc\"" >deep$k.inc; done
touch deep34.inc
for k in 2 1; do within pscn dump deep$k.inc 2>&1 | grep 'rror\|exit\|background'; done
printf '%4000s' '' >blank.inc
for count in 9999 10000; do
  yes $'#include "blank.inc"\n#include "./blank.inc"' | head -n $count >often.pscn
  within pscn dump often.pscn --max-memory 20M 2>&1 | grep 'rror\|exit\|background'
done
