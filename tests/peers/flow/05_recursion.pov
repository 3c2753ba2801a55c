// A recursive macro: each square leaf carries three smaller ones.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.2, -6> look_at <0, 1.3, 0> angle 40 }
light_source { <-4, 6, -8>, rgb 1 }
background { rgb <0.8, 0.85, 0.9> }
#declare Leaf = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #for (I, 0, 3) #for (J, 0, 3) <(J - 1.5)/3*(1 - I/6), I/3, select(mod(J, 3), 0, 0, -0.15)> #end #end }
#macro Branch(Level, Size)
  object { Leaf scale Size pigment { rgb <0.2, 0.9 - 0.15*Level, 0.3> } }
  #if (Level > 0)
    #local K = -1;
    #while (K <= 1)
      union { Branch(Level - 1, Size*0.6) rotate <0, 0, 40*K> translate Size*(y - 0.05*z) }
      #local K = K + 1;
    #end
  #end
#end
union { Branch(2, 1.2) }
