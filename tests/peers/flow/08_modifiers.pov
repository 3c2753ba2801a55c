// Macros that stand for parts of objects: transforms, textures, colours.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "colors.inc"
camera { location <0, 4, -7> look_at 0 angle 40 }
light_source { <5, 8, -5>, White }
background { SkyBlue }
#macro Place(X, A) rotate A*y translate X*x #end
#macro Paint(C, Shine) texture { pigment { C } finish { ambient 0.15 diffuse 0.7 #if (Shine > 0) phong Shine phong_size 30 #end } } #end
#macro Level(V) rgb <V, V, V> #end
#declare Sheet = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  <-1,0,-1> <-.3,.5,-1> <.3,-.5,-1> <1,0,-1>   <-1,.5,-.3> <-.3,0,-.3> <.3,.4,-.3> <1,-.5,-.3>
  <-1,-.5,.3> <-.3,.4,.3> <.3,0,.3> <1,.5,.3>  <-1,0,1> <-.3,-.5,1> <.3,.5,1> <1,0,1> }
object { Sheet Paint(Red, 0.5) Place(-2.2, 10) }
object { Sheet Paint(Level(0.6), 0) Place(0, 40) }
object { Sheet Paint(rgb <0.2, 0.6, 0.3>, 0.2) Place(2.2, 70) }
