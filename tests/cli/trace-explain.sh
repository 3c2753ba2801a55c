# The explanation of a ray. Its last lines are the answers. Its r can be given to pscn roots, and the root taken is among the
# answers.
printf '%s\n' '0.3 0.2 -4 0 0.1 1' '0.3 0.2 4 0.1 0 -1' '9 0 -4 0 0 1' '-0.4 0.1 -9 0.02 0 2' >rays
for scene in "$SCENES"/flat.pscn "$SCENES"/bent.pscn; do
  for solver in bernstein newton laguerre aberth durand_kerner 'newton { form paper }' 'aberth { form paper }'; do
    pscn trace "$scene" --solver "$solver" --explain <rays >explained
    pscn trace "$scene" --solver "$solver" --certainty <rays >answers
    sed -n 's/^answer: //p' explained | cmp - answers
    sed -n 's/^  r: //p ' explained >polynomials
    pscn roots --format table --solver 'aberth { form paper }' <polynomials >roots
    LC_ALL=C awk '
      function abs(x) { return x < 0 ? -x : x }
      FNR == 1 && FNR != NR { next }
      FILENAME == "explained" {
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
            if (!power && re[n] == -1) continue # at infinity
            u = power ? re[n] : re[n] / (1 + re[n])
            if (line[n] == of[k] && abs(u - real[k]) < near) near = abs(u - real[k])
          }
          lost += near > 1e-6
        }
        print (reals > 0 ? "points" : "no points") ", " lost + 0 " of them no root of r; " \
          (certificates > 0 ? "certificates" : "no certificate")
      }' explained roots
  done
done
# Each of the explanation's phrases occurs for some ray: beside poles, along borders, past patches that wave.
printf '%s\n' '0 9 0 0 -1 0' '1.48 -2.51 2.58 -0.72 0.55 -0.09' '0 1 -8 0 0 1' '0 0 -9 0 0 1' '0.01 9 0.02 0 -1 0' \
  '-2.83 -0.21 2.66 0.3 0.8 -0.77' '0 -0.97 -2.47 -0.46 0.56 0.73' >rays
for k in $(seq 40); do echo "$((k % 7 - 3)).1 $((k % 5 - 2)).2 -3 0.0$((k % 9)) -0.$((k % 8)) 1"; done >>rays
for scene in teapot dome wild; do
  for solver in bernstein 'aberth { split 1 }' 'newton { form paper }' 'laguerre { polish off }'; do
    pscn trace "$PSCN_SOURCE_DIR/scenes/$scene.pscn" --solver "$solver" --explain <rays
  done
done >explained
pscn trace "$SCENES/tangled.pscn" --solver 'aberth { split 1 }' --explain <"$SCENES/tangled.rays" >>explained
while read -r words; do
  grep -q -e "$words" explained || echo "never printed: $words"
done <<'END'
degree . in v and . in u
refused: not real
refused: outside
refused: no [uv] follows
refused: [uv] = .* is outside
does not solve eq 3
missed, proven: a, b or
missed, proven: the coefficients of r
last stage: its bilinear part
nothing accepted: not nearer
nothing accepted: no root
left to the last resort: double
last resort: [1-9]
certificate: none
certificate: a and b
answer: hit .* grazing
answer: miss certain
ray 47: from
roots by laguerre$
roots by aberth, found for this explanation
the nearest so far; a part is left to the last resort
= [^ ]* [+-][0-9.e-]* i, [0-9]* iterations, .* refused: not real
END
# Candidates left to the last resort are counted ray by ray.
awk '
  /^ray/ { left = candidates = 0 }
  /^candidate/ { candidates++ }
  /left to the last resort/ { left++ }
  /^last resort:/ { several += left > 1; wrong += $3 != left || $5 != candidates }
  END { print (several > 0 ? "several" : "never several") ", " wrong + 0 " wrong" }' explained
grep ' [+-]0 i' explained # no real root is printed as a complex one
# One whole explanation, on a plane patch, where all numbers are exact.
printf '0 0 -4 0 0 1\n' | pscn trace "$SCENES/flat.pscn" --explain --solver 'aberth { split 1 }' | grep -v ' root\|= '
# From so far away that double precision tells nothing.
printf '%s\n' '-1e31 -1e31 -1e31 1 1 1' | pscn trace "$SCENES/flat.pscn" --explain
try pscn trace "$SCENES/flat.pscn" --explain --binary </dev/null
try pscn trace "$SCENES/flat.pscn" --explain --all </dev/null
# Sheets in one another's boxes are cut finer, so that few are tried, even beside something large. But not if the scene
# says how they are cut, nor because of patches that lie on others.
sheet() { # BEND MOVED...
  echo "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3"
  for y in -1 -0.3 0.3 1; do echo "<-1, $y, 0>, <-0.3, $y, $1>, <0.3, $y, $1>, <1, $y, 0>$([ $y = 1 ] || echo ,)"; done
  shift
  echo "$* }"
}
for k in $(seq 0 63); do sheet 1 translate $k/1000*z; done >sheets.pscn
(cat sheets.pscn; sheet 1 scale 1e6 translate 2e6*z) >beside.pscn
for k in $(seq 0 63); do sheet 1 translate $((k % 2))/1000*z; done >twins.pscn
echo '0.1 0.2 -4 0 0.01 1' >ray
for scene in sheets beside; do
  pscn trace $scene.pscn --explain <ray | awk '/^candidate/ { n++ } END { print (n > 0 && n < 8 ? "few" : n + 0) }'
done
cuts() { sed -n 's|^candidate.*\(/[0-9]*\) x .*\(/[0-9]*\), .*|\1 \2|p' | sort | uniq -c; }
pscn trace sheets.pscn --explain --solver 'bernstein { split 2 }' <ray | cuts
pscn trace twins.pscn --explain <ray | cuts
# No finer than there is room for what cannot be decided.
for k in $(seq 0 79); do sheet 16 translate $k/100000*z; done >rolled.pscn
pscn trace rolled.pscn --explain <ray | cuts | sed -n 's/.*\///p' | sort -nr | head -n 1
