// Arrays of colours, textures and objects.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -7> look_at 0 angle 36 }
light_source { <-4, 8, -5>, rgb 1 }
#declare Shades = array[3] { rgb <1, 0.4, 0.3>, rgb <0.4, 0.9, 0.4>, rgb <0.3, 0.5, 1> }
#declare Coats = array[2] { texture { finish { ambient 0.3 } }, texture { finish { diffuse 0.9 phong 0.4 } } }
#declare Forms = array[3];
#for (K, 0, 2)
  #declare Forms[K] = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
    #for (I, 0, 3) #for (J, 0, 3) <I/2 - 0.75, 0.4*cos(K*I + J), J/2 - 0.75> #end #end }
#end
#for (I, 0, 2) #for (J, 0, 1)
  object { Forms[I] texture { Coats[J] pigment { Shades[mod(I + J, 3)] } } translate <1.8*(I - 1), 0, 1.8*J - 0.9> }
#end #end
