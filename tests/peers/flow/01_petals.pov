// A flower: petals by a macro in a loop, coloured by a choice.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -6> look_at 0 angle 34 }
light_source { <-5, 9, -6>, rgb 1 }
background { rgb <0.55, 0.7, 0.85> }
#macro Petal(Length, Width, Lift)
  bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
    <0, 0, 0>, <0, 0, 0>, <0, 0, 0>, <0, 0, 0>
    #for (I, 1, 3)
      <I*Length/3, Lift*I/3, -Width>, <I*Length/3, Lift*I/3 - 0.2, -Width/3>,
      <I*Length/3, Lift*I/3 - 0.2, Width/3>, <I*Length/3, Lift*I/3, Width>
    #end }
#end
#declare Count = 9;
#for (K, 0, Count - 1)
  object { Petal(2, 0.6, 0.5) rotate 360/Count*K*y
    pigment { rgb (mod(K, 2) = 0 ? <0.9, 0.4, 0.5> : <0.95, 0.7, 0.3>) } finish { ambient 0.2 diffuse 0.7 } }
#end
