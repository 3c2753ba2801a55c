# Polynomials and roots. The printed answers are exact in double, whatever the order of roundings.
try pscn roots </dev/null
printf '%s\n' '2 -1' '1 0 1' '1 0 0' '0 0 5' '0 0 1 -1' '+.5   1e0 0.' '1 0 -1 0' | try pscn roots
# Lines may end with CR LF; the last one may have no end. A byte order mark, comments, empty lines and commas are fine, and
# the line's number counts them.
printf '4 -1\r\n1\t-1' | try pscn roots
printf '\xef\xbb\xbf# four halves\n\n2,-1\n 2 , -1 # one\r\n \t\r\n2 -1\n2,\t-1' >file
try pscn roots file
try pscn roots - <file
try pscn roots --format table <file
printf '\xef\xbb' | try pscn roots 2>&1
printf '1 -0.25 0\n4 -1\n8 -1 0 0\n' >file
try pscn roots --solver bernstein <file | tee same
for solver in newton laguerre aberth 'aberth { basis bernstein }' 'newton { form paper }'; do
  try pscn roots --solver "$solver" <file | cmp - same
done
# Roots of equal real part are sorted by the imaginary part.
echo '1 0 5 0 4' | try pscn roots --solver laguerre
# Only real roots in [0,1]; the line of a complex pair is empty.
printf '1 1 1\n1 -3 0\n' | try pscn roots --solver bernstein
printf '2 -1\n1 0 0\n' | pscn roots --stats stats.json --tolerance 1e-3 | wc -l
grep -v '"solve"' stats.json
grep -c '"solve": 0\.0$' stats.json
grep -A1 '"cpu"' stats.json | grep -c '"solve": [0-9]'
printf '2 -1\n' | pscn roots --stats - --solver 'laguerre { form paper max_iterations 5 }' | grep -v '"solve"'
# Answers come before the input ends.
coproc pscn roots
echo '2 -1' >&"${COPROC[1]}"
read -r -t 60 answer <&"${COPROC[0]}"
echo "$answer"
# What is known of each root, and of missing ones.
for format in table json; do
  printf '%s\n' '4 -1' '1 0 0 0' '1e-320 1 -1' | try pscn roots --format "$format"
done
# A radius is rounded up: the root of the second row is at 3.3404e-152.
echo '1e300 -6.680801335744067e148 0.0011158276623035757' |
  try pscn roots --solver 'aberth { basis bernstein }' --format table
# What scaling coefficients down loses is in the radius: the first one has roots at +-1e-300, which are given as 0.
printf '%s\n' '1e300 0 -1e-300' '1 0 0' |
  pscn roots --solver 'aberth { basis bernstein }' --format json | grep -c '"radius":0.0,.*"radius":0.0,'
# Zeros at the beginning of a polynomial are not missing in the other basis either, where a root at 1 is known, too.
# They do not count as degrees in eq 11.
printf '%s\n' '1 -1' '0 4 -4' '0 0 5' '0 0 2 -1' '1 -2 1' | try pscn roots --solver 'aberth { basis bernstein }'
printf '%s\n' '3 -0.1' '0 0 3 -0.1' | pscn roots --format json | sed 's/.*"eq11":\([^}]*\)}.*/\1/' | uniq | wc -l
# An item sets the basis, not a word in a comment.
for text in 'aberth' 'aberth /* no basis */' 'aberth { basis bernstein }' 'aberth { form paper }' 'aberth { form paper basis bernstein }'; do
  echo '2 -1' | pscn roots --solver "$text" --stats - | grep '"solver"'
done
# An unknown radius is null in JSON. The share of accurate roots is of those listed, without the missing ones.
echo '1 -3 3 -1 0 0 0 1 1' | pscn roots --solver 'laguerre { basis bernstein max_iterations 1 }' --format json |
  grep -o '"radius":null,"status":"unknown"' | uniq
for iterations in 2 100; do
  echo '1 -3 3 -1 0 0 0 1 1' | pscn roots --solver "laguerre { max_iterations $iterations }" --stats - 2>/dev/null |
    grep '"accurate"'
done
echo '1e-320 1 -1' | pscn roots --format json --stats - | grep '"roots": \|"missing": '
# No polynomials have statistics, too.
pscn roots --stats - </dev/null | grep -v '"solve"'
