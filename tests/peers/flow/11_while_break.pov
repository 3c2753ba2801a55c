// A loop that is broken off, one that counts down, and one that never runs.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 6, -8> look_at 0 angle 36 }
light_source { <4, 9, -5>, rgb 1 }
background { rgb <0.1, 0.15, 0.2> }
#declare Step = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #for (I, 3, 0, -1) #for (J, 0, 3) <I/3, -I*I/30, J/3 - 0.5> #end #end }
#declare K = 0;
#while (true)
  #if (K*0.3 > 2) #break #end
  object { Step rotate 45*K*y translate (0.3*K - 1)*y pigment { rgb <0.9, 0.8 - 0.08*K, 0.3 + 0.08*K> } }
  #declare K = K + 1;
#end
#while (K < 0) nonsense #end
#for (I, 2, 1) nonsense #end
