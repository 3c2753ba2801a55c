#!/bin/bash
# One small scene for each keyword of finishes, lights, cameras, transforms and colours, by both programs. All patches
# are flat, so that POV-Ray's triangles are the exact surface. No pixel may differ by more than 1/255, except for
# rounding at edges, MOST pixels of a picture.
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

for finish in '' 'ambient 0' 'ambient 0.4' 'ambient rgb <0.1, 0.3, 0.5>' 'ambient -0.2' 'diffuse 0' 'diffuse 1.3' \
  'brilliance 4' 'brilliance 0.3' 'brilliance 0' 'phong 0.7' 'phong 0.7 phong_size 3' 'phong 0.7 phong_size 200' \
  'phong_size 10' 'specular 0.7' 'specular 0.7 roughness 0.3' 'specular 0.7 roughness 0.001' 'roughness 0.3' \
  'specular 0.7 phong 0.4 diffuse 0.2' \
  'ambient 0.15 diffuse 0.5 brilliance 1.7 phong 0.3 phong_size 25 specular 0.3 roughness 0.05' \
  'phong 0.2 phong 0.8' 'specular -0.3' 'diffuse -0.3' 'phong -0.3'; do
  scene "finish { $finish }"
done

GLOSS='specular 0.4 phong 0.3'
while read -r light; do
  lights=$light finish=$GLOSS; scene "light $light"
done <<'END'

light_source { <-3, 5, -4> rgb 1 }
light_source { <-3, 5, -4>, rgb 1 shadowless }
light_source { <3, 4, 5>, rgb <0.2, 1, 0.4> }
light_source { <3, -4, -5>, rgb 1 }
light_source { <20, 0.3, -2>, rgb 3 }
light_source { <0.4, 2.2, -5>, rgb 1 }
light_source { <0, 0.4, 0.6>, rgb 0.7 }
light_source { 5, color rgb 1 }
light_source { <1, 3, -2> } light_source { <-3, 5, -4> color 1 }
light_source { <0.7, 0, -1.3>, rgb <1, 0.8, 0.5> }
light_source { y*5, color rgb <0.5, 0.5, -0.2> }
light_source { <-3, 5, -4>, rgb <1, 0, 0> } light_source { <3, 5, -4>, rgb <0, 1, 0> } light_source { <0, 6, 3>, rgb <0, 0, 1> }
light_source { <-3, 5, -4>, rgb 0.6 } light_source { <3, 5, -4>, rgb 0.5 shadowless }
light_source { <0, 0, 0>, rgb 1 translate <2, 6, -3> }
light_source { <1, 5, 0>, rgb 1 rotate 70*y translate x }
light_source { <1, 2, -1>, rgb 1 scale <2, 3, 2> rotate <0, 30, 10> }
light_source { <1, 2, -1>, rgb 1 matrix <1, 0.2, 0, 0, 2, 0, 0.3, 0, 1, 1, 1, -2> }
END
for sky in '' 'background { rgb 0.3 }' 'background { color rgb <1.5, 0.2, -0.1> }' \
  'background { rgb 0.9 } background { rgb 0.1 }'; do
  scene "sky $sky"
done
for settings in 'ambient_light 0' 'ambient_light 2' 'ambient_light rgb <2, 0.5, 1>' 'max_trace_level 1'; do
  finish='ambient rgb <0.3, 0.4, 0.2>'; scene "settings $settings"
done

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

while read -r transforms; do
  object="object { Square $transforms }"; scene "transforms $transforms"
done <<'END'
rotate <60, 30, 20> translate <0.2, 0.8, 0>
translate <0.2, 0.8, 0> rotate <20, 30, 10>
rotate 40*x rotate 30*y translate y
rotate 30*y rotate 40*x translate y
scale <1.2, 0.6, 1> rotate <50, 0, 30> translate y
rotate <50, 0, 30> scale <1.2, 0.6, 1> translate y
rotate <50, 0, 30> scale <-1, 1, 1> translate y
rotate 40*x scale 0.7 translate <0.2, 0.7, 0>
matrix <1, 0.2, 0.1, 0, 0.8, 0.6, 0.3, 0, 1, 0.1, 0.9, 0>
rotate (<40, 20, 0>.y) translate y*0.9
rotate 10 + <40, 20, 0>.x translate y*0.9
rotate 20*x matrix <0.8, 0, 0.1, 0.3, 0.9, 0, 0, 0.2, 1, 0, 1, 0> rotate 10*z
END
object='union { object { Square rotate 30*x } object { Square scale 0.4 translate <0, 0.5, -0.6> }
  rotate 25*y translate <0, 0.9, 0> }'
scene 'union'
object='union { union { object { Square translate x } rotate 40*y texture { pigment { rgb <0.9, 0.1, 0.2> } } }
  scale 0.7 translate <-0.5, 0.8, 0> }'
scene 'union in union, textured'
object='#declare Two = union { object { Square } object { Square rotate 90*y } scale 0.6 }
object { Two translate <-0.8, 0.6, 0> } object { Two rotate 20*y translate <0.7, 0.6, 0> }'
scene 'declared union'

object='#declare Matt = texture { pigment { rgb <0.9, 0.1, 0.1> } finish { phong 0.6 ambient 0.2 } }
#declare Shiny = texture { Matt finish { phong_size 5 } }
#declare Polish = finish { diffuse 0.3 specular 0.9 roughness 0.02 }
#declare Two = union { object { Square texture { Shiny } rotate 60*y }
  union { object { Square scale 0.3 texture { pigment { rgb y } } } translate <0, 1, -1> texture { Matt } } };
object { Two texture { Shiny } scale <-0.5, 0.5, 0.5> rotate <10, 200, 0> translate <0.3, 0.8, 0> }
object { Two scale <0.4, -0.4, 0.4> translate <-1.2, 0.8, 0.4>
  texture { pigment { rgb <0, 0.3, 1> } finish { Polish } } }'
scene 'declared textures, mirrored'

while read -r colour; do
  pigment=$colour before='#declare Paint = rgb <0.2, 0.7, 0.4>; #declare Half = 0.5; #declare V = <0.6, 0.2, 0.1>;'
  scene "colour $colour"
done <<'END'
rgb <0.1, 0.9, 0.4>
color rgb <0.1, 0.9, 0.4>
colour rgb <0.1, 0.9, 0.4>
rgb 0.6
color rgb Half
color Paint
Paint
color rgb Paint*0.5 + <0.2, 0.2, 0.2>
rgb 0.5*Paint - x/10
Paint/2
Paint*Paint
Paint + Paint
rgb V
rgb <Half, Half/2, Paint.green>
rgb V.x*<1, 0.5, 2> + y*0.2
rgb <2, 1.2, -0.5>
color V
color 0
color rgb Half*V + Paint.red
color red 0.2 green 0.7 blue 0.1
green 0.7 red 0.3
color Paint green 0.3 red Half
rgbf <0.2, 0.7, 0.1, 0>
colour rgbt <0.2, 0.7, 0.1, 0>
rgbft <0.2, 0.7, 0.1, 0, 0>
rgb V transmit 0 filter 0
END

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

before='#declare Title = "a \"; background { rgb <1, 0, 0> } // \" b";
#macro Report(N) #debug concat("a line
#end \" \\", str(N, 0, 0)) #end
#ifdef (Nothing) "abc\"#end" #declare Title = 1; #end'
scene 'strings'

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
