# A bad line ends the run, after the answers to the lines before it.
scene=$SCENES/flat.pscn
good='0 0 -4 0 0 1'
bad() { printf "$good\n$1\n$good\n" | try pscn trace "$scene"; }
bad '1 2 3'
bad '1 2 3 4 5 6 7'
bad '0 0 0 0 inf 1'
bad '0 0 0 0x10 1 1'
bad '0 0 -4   0 0 -0'
bad '0 0 0 0 0 1.2.3'
bad '0 0 0 \0 0 1'
printf "$good\n$good\n1 2" | try pscn trace "$scene"
# A line's number is right far down, and every answer before it is there.
(for k in $(seq 3000); do echo "$good"; done; echo "worse") | pscn trace "$scene" | sort | uniq -c | sed 's/^ *//'
printf '0123456789' | try pscn trace "$scene" --binary
head -c 48 /dev/zero | try pscn trace "$scene" --binary
printf '\377\377\377\377\377\377\377\377%40s' '' | try pscn trace "$scene" --binary
try pscn trace "$scene" <&-
try pscn trace "$scene" < .
echo "$good" | pscn trace "$scene" >/dev/full
echo "exit $?"
# An output that cannot be written is reported before any answer.
echo "$good" | try pscn trace "$scene" --stats nowhere/a.json
try pscn trace
try pscn trace "$scene" "$scene"
try pscn trace "$scene" nothing
try pscn trace - - <"$scene"
try pscn trace "$scene" a b
try pscn trace "$scene" --tolerance 0
try pscn trace "$scene" --size 1x1
