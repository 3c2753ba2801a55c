// Objects chosen by #switch, with #range and #else.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -8> look_at <0, 0, 0> angle 36 }
light_source { <3, 8, -5>, rgb 1 }
background { rgb 0.3 }
#macro Tile(Z0, Z1) bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #for (I, 0, 3) #for (J, 0, 3) <I/3 - 0.5, (I = 0 | I = 3 | J = 0 | J = 3 ? Z0 : Z1), J/3 - 0.5> #end #end } #end
#for (K, 0, 7)
  object {
    #switch (K)
      #case (0) Tile(0, 0) pigment { rgb <1, 0.3, 0.3> } #break
      #case (1)
      #case (2) Tile(0, 0.6) pigment { rgb <0.3, 1, 0.3> } #break
      #range (3, 5) Tile(0, -0.6) pigment { rgb <0.3, 0.4, 1> } #break
      #else Tile(0.3, 0) pigment { rgb <0.9, 0.9, 0.3> }
    #end
    translate <1.2*mod(K, 4) - 1.8, 0, 1.4*div(K, 4) - 0.7> }
#end
