#!/bin/bash
# Scenes at random: finishes, lights, backgrounds, cameras, transforms, textures and colours, by both programs. All
# patches are flat, so that POV-Ray's triangles are the exact surface. No pixel may differ by more than 1/255, except
# for rounding at edges, MOST pixels of a picture. PSCN_SEED makes other scenes.
JOBS=16 # POV-Ray mostly waits for itself
MOST=3
SCENES=24
SEED=$((${PSCN_SEED:-0} * SCENES))
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
export MOST

cat >parts.inc <<'END'
#declare Square = bicubic_patch { type 1 flatness 0 u_steps 2 v_steps 2
  <-0.9, -0.9, 0>, <-0.3, -0.9, 0>, <0.3, -0.9, 0>, <0.9, -0.9, 0>,
  <-0.9, -0.3, 0>, <-0.3, -0.3, 0>, <0.3, -0.3, 0>, <0.9, -0.3, 0>,
  <-0.9, 0.3, 0>, <-0.3, 0.3, 0>, <0.3, 0.3, 0>, <0.9, 0.3, 0>,
  <-0.9, 0.9, 0>, <-0.3, 0.9, 0>, <0.3, 0.9, 0>, <0.9, 0.9, 0> }
#declare Floor = object { Square rotate 90*x scale 3 }
#declare Paint = rgb <0.9, 0.6, 0.2>;
#declare Matt = texture { pigment { color Paint } finish { phong 0.4 ambient 0.2 } }
#declare Leaf = pigment { rgb <0.2, 0.9, 0.4> }
#declare Two = union { object { Square } object { Square rotate 90*y scale 0.5 pigment { rgb <0.1, 0.2, 0.8> } } }
END
cat >scene.awk <<'END'
function number(low, high) { return sprintf("%.4g", low + (high - low) * rand()) }
function vector(low, high) { return "<" number(low, high) ", " number(low, high) ", " number(low, high) ">" }
function chance(share) { return rand() < share }
function colour(  k) {
  k = rand()
  if (k < 0.5) return "rgb " vector(0, 1)
  if (k < 0.7) return "rgb " vector(-0.5, 2)
  if (k < 0.8) return "color rgb " number(0, 1.2)
  if (k < 0.9) return "colour Paint*" number(0.2, 1.5)
  return "color rgb " vector(0, 1) "*" number(0.5, 1) " + x/" number(2, 9)
}
function finish(  at, n, k, item, text) {
  n = split("ambient " (chance(0.5) ? number(-0.2, 0.5) : "rgb " vector(0, 0.5)) ";diffuse " number(-0.2, 1.6) \
            ";brilliance " number(0, 5) ";phong " number(-0.2, 1.5) ";phong_size " number(0, 200) \
            ";specular " number(-0.2, 1.5) ";roughness " \
            (chance(0.5) ? number(0.0005, 0.1) : number(0.1, 2)), item, ";")
  at = int(rand() * n)
  for (k = 0; k < n; k++) if (chance(0.55)) text = text " " item[(at + k) % n + 1]
  return "finish {" text " }"
}
function texture(  k) {
  k = rand()
  if (k < 0.3) return "texture { pigment { " colour() " } " finish() " }"
  if (k < 0.5) return "pigment { " colour() " } " finish()
  if (k < 0.6) return "texture { Matt " finish() " }"
  if (k < 0.7) return "texture { Matt pigment { " colour() " } }"
  if (k < 0.8) return finish()
  return k < 0.9 ? "pigment { Leaf }" : ""
}
function stretch() { return (chance(0.5) ? "-" : "") number(0.4, 1.4) }
function transforms(most,  text, k) {
  for (most = int(rand() * (most + 1)); most > 0; most--) {
    k = rand()
    if (k < 0.3) text = text " translate " vector(-0.6, 0.6)
    else if (k < 0.5) text = text " rotate " vector(-180, 180)
    else if (k < 0.6) text = text " rotate " number(-90, 90) "*y"
    else if (k < 0.8) text = text " scale <" stretch() ", " stretch() ", " stretch() ">"
    else text = text " matrix <1.2, " number(-0.4, 0.4) ", " number(-0.4, 0.4) ", " number(-0.4, 0.4) ", 0.8, " \
                number(-0.4, 0.4) ", " number(-0.4, 0.4) ", " number(-0.4, 0.4) ", -1, " \
                number(-0.5, 0.5) ", " number(-0.5, 0.5) ", 0>"
  }
  return text
}
# Each object's own rotation and translation keep it out of the others' planes, where rounding would decide which is
# seen.
function object(depth,  text, k) {
  if (depth == 2 || chance(0.7))
    return "object { " (chance(0.7) ? "Square" : "Two") transforms(2) " rotate " vector(-90, 90) " translate " \
           vector(-0.3, 0.3) " " texture() transforms(1) " }"
  for (k = 1 + int(rand() * 3); k > 0; k--) text = text " " object(depth + 1)
  return "union {" text transforms(2) " " texture() " }"
}
function camera(  text, aimed) {
  aimed = chance(0.8)
  text = "location <" number(-4, 4) ", " number(0.5, 4) ", " number(-6, -2) ">"
  if (chance(0.5)) text = "right " (chance(0.5) ? number(-2, 2) "*x" : "x*image_width/image_height") " " text
  if (aimed) text = chance(0.5) ? text " look_at " vector(-0.5, 0.8) : "look_at " vector(-0.5, 0.8) " " text
  if (chance(0.5)) text = text " direction " vector(-0.5, 0.5) " + " (aimed && chance(0.4) ? "-1.5" : "1.5") "*z"
  if (chance(0.4)) text = text " up " vector(-0.2, 0.2) " + " (chance(0.5) ? "" : "-") "y"
  if (chance(0.3)) text = text " sky " vector(-1, 1)
  if (chance(0.5)) text = chance(0.5) ? text " angle " number(10, 120) : "angle " number(10, 120) " " text
  return "camera { " (chance(0.3) ? "perspective " : "") text " }"
}
function light(  k) {
  k = rand()
  return "light_source { " vector(-6, 6) (chance(0.5) ? " + 4*y" : "") ", rgb " (k < 0.4 ? number(0, 1.2) : \
         k < 0.8 ? vector(0, 1.2) : vector(-0.3, 1.5)) (chance(0.2) ? " shadowless" : "") \
         (chance(0.3) ? transforms(2) : "") " }"
}
BEGIN {
  srand(seed)
  print "#version 3.7;\nglobal_settings { assumed_gamma 1" (chance(0.4) ? " ambient_light rgb " vector(0, 2) : "") " }"
  print "#include \"parts.inc\"\n" camera()
  if (chance(0.8)) print "background { " colour() " }"
  for (k = int(rand() * 4); k >= 0; k--) print light()
  for (k = int(rand() * 5); k >= 0; k--) print object(0)
  print "object { Floor " texture() " }"
}
END
cat >judge.sh <<'END'
file=${1%.pscn}
sizes=(64x48 80x40 48x64 63x49)
"$PSCN" check "$1" --size "${sizes[$((10#$file % 4))]}" --steps 0 --grid 0 --fail 1/255 --failpercent 0 \
  --allowfailures $MOST --failpsnr 0 -o "$file" --quiet >"$file.log" 2>&1 || {
  echo "$file: exit code $?"
  cat "$file.log" "$1"
}
END
for ((k = 1; k <= SCENES; k++)); do awk -v seed=$((SEED + k)) -f scene.awk >"$(printf '%02d' $k).pscn"; done
printf '%s\0' ??.pscn | xargs -0 -P "$JOBS" -n 1 bash judge.sh >complaints
cat complaints
echo "$SCENES scenes from seed $SEED on"
[ ! -s complaints ] && [ "$(ls -d ./*/ | wc -l)" -eq "$SCENES" ]
