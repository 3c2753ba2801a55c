# The values on the way to the roots. Steps are numbered from 0 without a gap, and each way ends at a root.
printf '%s\n' '1 -1.7 0.9 -0.125' '1 0 0 -8 1' '16 0 -20 0 5 0' >polynomials
for solver in bernstein newton laguerre aberth durand_kerner 'newton { form paper }' 'laguerre { form paper }' \
  'aberth { form paper }' 'aberth { basis bernstein }' 'durand_kerner { form paper }'; do
  pscn roots --solver "$solver" --format table <polynomials >roots
  pscn roots --solver "$solver" --iterates <polynomials >ways
  LC_ALL=C awk '
    function abs(x) { return x < 0 ? -x : x }
    FNR == 1 { next }
    FNR == NR { root[++roots] = $0; next }
    {
      way = $1 " " $3
      if ($2 == 0 ? way in step : !(way in step) || $2 != step[way] + 1) { print "a gap: " $0; exit }
      step[way] = $2; re[way] = $4; im[way] = $5
    }
    END {
      for (way in step) {
        split(way, at, " ")
        near = 1
        for (k = 1; k <= roots; k++) {
          split(root[k], r, " ")
          distance = abs(r[2] - re[way]) + abs(r[3] - im[way])
          if (r[1] == at[1] && distance < near) near = distance
        }
        ways++
        lost += near > 1e-6
      }
      print (ways > 0 ? "ways" : "no way") ", " lost + 0 " of them end at no root"
    }' roots ways
done
# If nothing is iterated, nothing is printed. The formats cannot be combined.
printf '4 -1\n1 0 0\n' | try pscn roots --iterates
try pscn roots --iterates --format json </dev/null
