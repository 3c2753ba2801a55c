#!/bin/bash
# Cameras, one small scene for each way to write one, and textures and declarations that depend on what stands before
# them, by both programs. All patches are flat, so that POV-Ray's triangles are the exact surface. No pixel may differ by
# more than 1/255, except for rounding at edges, MOST pixels of a picture.
JOBS=16 # POV-Ray mostly waits for itself
MOST=2
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray

KEY='light_source { <-3, 5, -4>, rgb <1, 0.95, 0.9> }'
CAMERA='camera { location <0.4, 2.2, -5> look_at <0.1, 0.2, 0> angle 42 }'
count=0
# scene NAME: writes the scene of the current settings, then resets them. A floor, and above it a leaning square with a
# shadow.
begin() {
  camera=$CAMERA lights=$KEY sky='background { rgb <0.2, 0.3, 0.5> }' settings='' before='' size=64x48
  finish='' pigment='rgb <0.8, 0.5, 0.3>' object='object { Square rotate <50, 20, 0> translate <0, 0.9, 0> }'
}
scene() {
  count=$((count + 1))
  local file
  file=$(printf '%03d %s' $count "$1" | tr ' /' '__')
  echo "$size" >"$file.size"
  cat >"$file.pscn" <<END
#version 3.7;
global_settings { assumed_gamma 1 $settings }
$camera
$sky
$lights
$before
#declare Square = bicubic_patch { type 1 flatness 0 u_steps 2 v_steps 2
  <-0.9, -0.9, 0>, <-0.3, -0.9, 0>, <0.3, -0.9, 0>, <0.9, -0.9, 0>,
  <-0.9, -0.3, 0>, <-0.3, -0.3, 0>, <0.3, -0.3, 0>, <0.9, -0.3, 0>,
  <-0.9, 0.3, 0>, <-0.3, 0.3, 0>, <0.3, 0.3, 0>, <0.9, 0.3, 0>,
  <-0.9, 0.9, 0>, <-0.3, 0.9, 0>, <0.3, 0.9, 0>, <0.9, 0.9, 0>
  texture { pigment { $pigment } finish { $finish } } }
$object
bicubic_patch { type 1 flatness 0 u_steps 2 v_steps 2
  <-3, 0, -3>, <-1, 0, -3>, <1, 0, -3>, <3, 0, -3>, <-3, 0, -1>, <-1, 0, -1>, <1, 0, -1>, <3, 0, -1>,
  <-3, 0, 1>, <-1, 0, 1>, <1, 0, 1>, <3, 0, 1>, <-3, 0, 3>, <-1, 0, 3>, <1, 0, 3>, <3, 0, 3>
  texture { pigment { color rgb <0.5, 0.6, 0.7> } finish { $finish } } }
END
  begin
}
begin

while read -r items; do
  camera="camera { $items }"
  object='object { Square rotate <50, 20, 0> translate <0, 0.9, 0> } object { Square translate <0.3, 0.2, 3> }'
  scene "camera $items"
done <<'END'
location <0, 0.5, -4>
perspective location <0, 0.5, -4> direction 2*z
location <0, 0.5, -4> angle 60
angle 60 location <0, 0.5, -4> direction 3*z
location <0, 0.5, -4> angle 110 right 1*x
right 2*x angle 50 location <0, 0.5, -4>
location <0, 0.5, -4> direction <0.2, 0.1, 1> right <1.2, 0.2, 0> up <0.1, 0.9, 0.1>
location <0, 0.5, -4> direction <0.2, 0.1, 1> right <1.2, 0.2, 0> up <0.1, 0.9, 0.1> look_at <0, 0.4, 0>
location <0, 0.5, -4> direction <0.2, 0.1, 1> right <1.2, 0.2, 0> up <0.1, 0.9, 0.1> angle 50
location <3, 2, -3> look_at 0
look_at <0, 0.5, 0> location <3, 2, -3>
location <3, 2, -3> look_at 0 angle 35 right x up y
location <3, 2, -3> look_at 0 right -1.33*x
location <3, 2, -3> look_at 0 up -y
location <3, 2, -3> look_at 0 up 2*y right 0.7*x direction 1.6*z
location <3, 2, -3> sky <1, 1, 0.5> look_at 0
sky z location <3, 2, -3> look_at 0 angle 50
location <3, 2, -3> look_at 0 sky z angle 50
location <3, 2, -3> up z sky z right 1.33*x direction y look_at 0
location <0, 5, 0> look_at 0
location <0, 5, 0> look_at 0 angle 70 right x
location <0, 5, 0> look_at 0 right <1.2, 0.5, 0>
location <-4, 0.7, 0.4> look_at <0, 0.5, 0> angle 40 angle 60
location <3, 2, -3> right x*image_width/image_height look_at 0
location <0, 0.5, -4> translate <0.5, 0.2, 0.3>
rotate <10, 20, 5> location <0, 0.5, -4>
location <0, 0.5, -4> rotate <10, 20, 5> translate y/2 look_at <0, 0.4, 0> angle 50
location <3, 2, -3> translate -x look_at 0 rotate 20*y sky <1, 1, 0.5>
location <3, 2, -3> look_at 0 scale <1, 0.5, 0.8>
location <3, 2, -3> look_at 0 angle 50 scale <-1, 1, 1> rotate 40*z
location <3, 2, -3> look_at 0 matrix <1, 0.2, 0.1, 0, 0.8, 0.6, 0.3, 0, 1, 0.1, 0.4, 0>
END
for size in 48x64 70x35 33x47; do
  for items in '' 'right x*image_width/image_height' 'right x*image_width/image_height angle 50' \
    'up y*image_height/image_width right x'; do
    keep=$size camera="camera { location <3, 2, -3> look_at 0 $items }"; scene "camera $items at $size"; size=$keep
  done
done

object='#declare Matt = texture { pigment { rgb <0.9, 0.1, 0.1> } finish { phong 0.6 ambient 0.2 } }
#declare Shiny = texture { Matt finish { phong_size 5 } }
#declare Polish = finish { diffuse 0.3 specular 0.9 roughness 0.02 }
#declare Two = union { object { Square texture { Shiny } rotate 60*y }
  union { object { Square scale 0.3 texture { pigment { rgb y } } } translate <0, 1, -1> texture { Matt } } };
object { Two texture { Shiny } scale <-0.5, 0.5, 0.5> rotate <10, 200, 0> translate <0.3, 0.8, 0> }
object { Two scale <0.4, -0.4, 0.4> translate <-1.2, 0.8, 0.4>
  texture { pigment { rgb <0, 0.3, 1> } finish { Polish } } }'
scene 'declared textures, mirrored'

object='object { Square rotate <50, 20, 0> translate <0, 0.9, 0> texture { pigment { rgb x } } }
#default { texture { pigment { rgb <0.1, 0.6, 0.9> } finish { phong 0.8 ambient 0.3 } } }
#declare Plain = bicubic_patch { type 1 flatness 0 u_steps 2 v_steps 2,
  <-0.4, 0, 0>, <-0.1, 0, 0>, <0.1, 0, 0>, <0.4, 0, 0>, <-0.4, 0.1, 0>, <-0.1, 0.1, 0>, <0.1, 0.1, 0>, <0.4, 0.1, 0>
  <-0.4, 0.3, 0>, <-0.1, 0.3, 0>, <0.1, 0.3, 0>, <0.4, 0.3, 0>, <-0.4, 0.4, 0>, <-0.1, 0.4, 0>, <0.1, 0.4, 0>, <0.4, 0.4, 0> }
#default { finish { phong 0 } }
object { Plain translate <-1.2, 0.2, -1> } object { Plain translate <1, 0.2, -1> pigment { rgb y } }
#default { pigment { rgb <0.9, 0.6, 0.1> } }
object { Plain translate <0, 0.2, -1> }
union { object { Plain } object { Plain translate y/2 } translate <1, 0.2, 0.5> finish { ambient 0.5 } }'
scene 'default textures'

before='#declare Paint = pigment { rgb x }
#declare Paint = pigment { #declare Level = 0.8; rgb <0, 0, Level> }
#macro Never(A) #local B = A; #if (B) sphere { 0, 1 } #end #end
#declare Old = version; #version 3.5; #version Old;'
object='object { Square rotate <50, 20, 0> translate <0, 0.9, 0> pigment { Paint #declare Paint = pigment { rgb y } }
  #declare Up = 0.2; translate Up*y }
#declare First = union { #ifdef (First) #declare Known = 1; #else #declare Known = 0; #end
  object { Square scale 0.3 translate <-1, 0.5, -1> } object { Square scale 0.2 translate <1, 0.5, -1> pigment { Paint } } }
object { First translate y*Known/3 }'
scene 'declarations within each other'

# judge FILE: prints what is wrong with a scene.
cat >judge.sh <<'END'
file=${1%.pscn}
"$PSCN" check "$1" --size "$(cat "$file.size")" --steps 0 --grid 0 --fail 1/255 --failpercent 0 \
  --allowfailures $MOST --failpsnr 0 -o "$file" --quiet >"$file.log" 2>&1 || {
  echo "$file: exit code $?"
  cat "$file.log"
  sed '/^#version/d; /^bicubic_patch/,$d' "$1"
}
END
export MOST
printf '%s\0' ./*.pscn | xargs -0 -P "$JOBS" -n 1 bash judge.sh >complaints
cat complaints
echo "$count scenes"
[ ! -s complaints ] && [ "$(ls -d ./*/ | wc -l)" -eq "$count" ]
