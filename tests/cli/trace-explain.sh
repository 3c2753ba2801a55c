# The story of a ray: its last lines are the answers, its r goes back into pscn roots, and the root taken is among them.
printf '%s\n' '0.3 0.2 -4 0 0.1 1' '0.3 0.2 4 0.1 0 -1' '9 0 -4 0 0 1' '-0.4 0.1 -9 0.02 0 2' >rays
for scene in "$SCENES"/flat.pscn "$SCENES"/bent.pscn; do
  for solver in bernstein newton laguerre aberth durand_kerner 'newton { form paper }' 'aberth { form paper }'; do
    pscn trace "$scene" --solver "$solver" --explain <rays >story
    pscn trace "$scene" --solver "$solver" --certainty <rays >answers
    sed -n 's/^answer: //p' story | cmp - answers && echo "the answers are the same"
    sed -n 's/^  r: //p' story >polynomials
    pscn roots --format table --solver 'aberth { form paper }' <polynomials >roots
    LC_ALL=C awk -v scene="${scene##*/}" -v solver="$solver" '
      function abs(x) { return x < 0 ? -x : x }
      FNR == 1 && FNR != NR { next }
      FILENAME == "story" {
        power = /^  r\([uv]\)/ ? 1 : /^  r, / ? 0 : power
        if ($1 == "r:") polynomials++
        if (/, T = /) { sub(/,/, "", $3); real[++reals] = $3; of[reals] = polynomials }
        certificates += /certificate:/
        next
      }
      { re[++roots] = $2; line[roots] = $1 }
      END {
        for (k = 1; k <= reals; k++) {
          near = 1
          for (n = 1; n <= roots; n++) {
            u = power ? re[n] : re[n] / (1 + re[n])
            if (line[n] == of[k] && abs(u - real[k]) < near) near = abs(u - real[k])
          }
          lost += near > 1e-6
        }
        print scene ", " solver ": " (reals > 0 ? "points" : "no points") ", " lost + 0 " of them no root of r; " \
          (certificates > 0 ? "certificates" : "no certificate")
      }' story roots
  done
done
# One whole, on a plane patch, where all numbers are exact.
printf '0 0 -4 0 0 1\n' | pscn trace "$SCENES/flat.pscn" --explain --solver 'aberth { split 1 }' | grep -v ' root\|= '
try pscn trace "$SCENES/flat.pscn" --explain --binary </dev/null
try pscn trace "$SCENES/flat.pscn" --explain --all </dev/null
