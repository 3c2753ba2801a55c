#!/bin/bash
# The colours of a flat patch that fills the picture, by pscn and by POV-Ray: for each keyword of a finish alone and all
# together, and for lights in front, behind, and without shadow. Both write 16 bits. They may differ by LIMIT, which
# leaves room for each program's rounding to 1/65535 and for POV-Ray's single-precision colours.
LIMIT=0.05/255
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray

# scene FINISH LIGHTS [GLOBAL_SETTINGS]
scene() {
  cat <<EOF
#version 3.7;
global_settings { assumed_gamma 1.0 $3 }
camera { location <0.4, 0.3, -5> look_at <0, 0, 0> right x*4/3 up y angle 40 }
background { rgb <0.2, 0.3, 0.4> }
$2
bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3
  <-4, -3, 0>, <-4/3, -3, 0>, <4/3, -3, 0>, <4, -3, 0>,
  <-4, -1, 0>, <-4/3, -1, 0>, <4/3, -1, 0>, <4, -1, 0>,
  <-4, 1, 0>, <-4/3, 1, 0>, <4/3, 1, 0>, <4, 1, 0>,
  <-4, 3, 0>, <-4/3, 3, 0>, <4/3, 3, 0>, <4, 3, 0>
  texture { pigment { color rgb <0.8, 0.5, 0.3> } finish { $1 } }
}
EOF
}

# check FINISH LIGHTS [GLOBAL_SETTINGS]
check() { beside same "$@"; }
same() {
  scene "$1" "$2" "${3:-}" >scene.pscn
  povray +Iscene.pscn +Opeer.png +W48 +H36 -D +FN16 -A >povray.log 2>&1 || { cat povray.log; exit 1; }
  "$PSCN" render scene.pscn -o ours.png --size 48x36 --bits 16 --quiet
  "$PSCN" compare ours.png peer.png --fail $LIMIT --quiet || { echo "  finish { $1 }  $2  ${3:-}"; exit 1; }
}

before='light_source { <2, 3, -4>, rgb <1, 0.9, 0.8> }'
near='light_source { <0.5, -0.4, -0.7>, rgb <0.9, 1, 0.7> }'
grazing='light_source { <9, 2, -0.3>, rgb 1 }'
behind='light_source { <2, 3, 4>, rgb 1 }'
fill='light_source { <2, 3, -4>, rgb <1, 0.9, 0.8> shadowless }'

check '' "$before"
check 'ambient 0' "$before"
check 'ambient rgb <0.2, 0.3, 0.4> diffuse 0' "$before"
check 'ambient rgb <0.2, 0.3, 0.4> diffuse 0' '' 'ambient_light rgb <2, 0.5, 1>'
check 'diffuse 0.9' "$before"
check 'brilliance 3' "$before"
check 'brilliance 0.5' "$grazing"
check 'phong 0.8' "$before"
check 'phong 0.8 phong_size 5' "$near"
check 'phong 0.8 phong_size 100' "$near"
check 'specular 0.8' "$before"
check 'specular 0.8 roughness 0.2' "$near"
check 'specular 0.8 roughness 0.005' "$near"
check 'specular 0.8 phong 0.5' "$grazing"
check 'specular 0.5 phong 0.5 ambient 0.3' "$behind"
check 'specular 0.5 phong 0.5 diffuse 0.4 brilliance 2' "$fill"
check 'specular 0.5' "$behind $fill"
check 'ambient 0.2 diffuse 0.5 brilliance 1.5 phong 0.2 phong_size 30 specular 0.3 roughness 0.08' \
  "$before $near $fill $grazing" 'ambient_light 0.5'
check 'diffuse 2 specular 3' "$before" # clipped
all_right && echo "${#children[@]} finishes agree with POV-Ray to $LIMIT"
