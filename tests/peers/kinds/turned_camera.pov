#version 3.1;
#include "colors.inc"
camera { location <0, 1.5, -4> direction 1.5*z look_at <0, 0.2, 0> rotate <0, 30, 0> }
light_source { <-10, 20, -20> colour red 1.0 green 1.0 blue 0.9 rotate y*30 }
background { color MidnightBlue }
#default { finish { ambient 0.2 phong 0.3 } }
bicubic_patch { type 1 flatness 0.0100 u_steps 3 v_steps 3
  <-1.0, 0.0, -1.0> <-0.3, 0.8, -1.0> <0.3, 0.8, -1.0> <1.0, 0.0, -1.0>
  <-1.0, 0.8, -0.3> <-0.3, 1.2, -0.3> <0.3, 1.2, -0.3> <1.0, 0.8, -0.3>
  <-1.0, 0.8, 0.3> <-0.3, 1.2, 0.3> <0.3, 1.2, 0.3> <1.0, 0.8, 0.3>
  <-1.0, 0.0, 1.0> <-0.3, 0.8, 1.0> <0.3, 0.8, 1.0> <1.0, 0.0, 1.0>
  texture { pigment { color Coral } } }
