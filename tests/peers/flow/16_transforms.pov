// Declared transforms, alone, within others and as a macro's argument; and points with two parts.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -7> look_at 0 angle 38 }
light_source { <0, 8, -5>, rgb 1 transform { translate 3*x } }
#declare Tilt = transform { rotate <20, 30, 0> scale <1, 1.5, 1> }
#declare Aside = transform { Tilt translate <1.8, 0.3> }
#declare Leaf = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  uv_vectors <0, 0>, <1, 0>, <1, 1>, <0, 1>
  <-1, -1>, <-0.3, -1, 0.5>, <0.3, -1, -0.5>, <1, -1>, <-1, -0.3, 0.5>, <-0.3, -0.3, 1>, <0.3, -0.3, 1>, <1, -0.3>,
  <-1, 0.3>, <-0.3, 0.3, 1>, <0.3, 0.3, 1>, <1, 0.3, 0.5>, <-1, 1>, <-0.3, 1, -0.5>, <0.3, 1, 0.5>, <1, 1> }
#macro Put(Where, Colour)
  object { Leaf scale 0.8 transform { Where } pigment { Colour } finish { phong 0.4 } }
#end
Put(Tilt, rgb <0.9, 0.5, 0.3>)
Put(Aside, rgb <0.3, 0.8, 0.4> + 0.1*x)
union { object { Leaf scale 0.8 transform Tilt pigment { rgbt <0.3, 0.4, 0.9, 0> } } transform { Tilt translate -2*x } }
