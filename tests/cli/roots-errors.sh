# A bad line ends the run, after the answers to the lines before it.
good='2 -1'
bad() { printf "$good\n$1\n$good\n" | try pscn roots; }
bad '7'
bad '# 1 2'"\n7"
bad '1 2 x'
bad '1 nan'
bad '1 1e999 2'
bad '1 2+3i 1'
bad '[1,-3,2]'
bad '1,,3'
bad ',1,3'
bad '1,3,'
bad '0 0 0'
bad "$(printf '1 %.0s' $(seq 66))"
printf "$good\n$good\n1 2y" | try pscn roots
(for k in $(seq 3000); do echo "$good"; done; echo "worse") | pscn roots | sort | uniq -c | sed 's/^ *//'
try pscn roots <&-
echo "$good" | pscn roots >/dev/full
echo "exit $?"
try pscn roots scene </dev/null
try pscn roots scene scene </dev/null
try pscn roots /dev/null
try pscn roots --iterates --solver nothing </dev/null
try pscn roots --tolerance 0 </dev/null
try pscn roots --tolerance 2 </dev/null # as trace
try pscn roots --stats nowhere/stats.json </dev/null
try pscn roots --format csv </dev/null
# A root beyond the range of doubles, in 25 lines.
printf '%s\n' '2 -1' '1e-320 1 -1' | try pscn roots
printf '%s\n' '2 -1' '1e-320 1 -1' '4 -1' | pscn roots 2>&1 # each error behind its line
(for k in $(seq 25); do echo '1e-320 1 -1'; done) | pscn roots | wc -l
# Values of which nothing is known, because iterations ended; the largest coefficients in the other basis.
echo '1 -3 3 -1 0 0 0 1 1' | pscn roots --solver 'laguerre { basis bernstein max_iterations 1 }' | wc -w
printf '%s\n' '1.5e308 -1.5e308' "$(printf -- '-1.7e308 1.7e308 %.0s' {1..32}) 1.7e308" | try pscn roots --solver bernstein
# A line is kept whole while it arrives, up to a limit.
(head -c 200000 /dev/zero | tr '\0' ' '; echo '2 -1') | try pscn roots
head -c 1100000 /dev/zero | tr '\0' '1' | try pscn roots
