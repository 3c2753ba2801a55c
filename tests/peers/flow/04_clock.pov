// A scene that depends on the clock.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -6> look_at 0 angle 34 }
light_source { <4, 8, -6>, rgb 1 }
#if (clock > .5) #declare Shade = rgb <1, 0.5, 0.2>; #else #declare Shade = rgb <0.2, 0.5, 1>; #end
bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #for (I, 0, 3) #for (J, 0, 3) <I - 1.5, 0.6*sin(2*pi*clock + I), J - 1.5> #end #end
  pigment { Shade } rotate 60*clock*y }
