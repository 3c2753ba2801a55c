// Macros that open and close blocks, conditions around items, names that are undeclared.
#version 3.7;
global_settings { assumed_gamma 1 }
#macro Group() union { #end
#macro EndGroup(Turn) rotate Turn } #end
#declare Quality = 1;
camera { location <0, 5, -6> look_at 0 angle 36 #if (Quality > 5) right 2*x #end }
#ifdef (Quality) light_source { <-3, 8, -6>, rgb 1 #ifndef (Quality) shadowless #end } #end
#undef Quality
background { rgb #ifdef (Quality) 1 #else <0.5, 0.6, 0.7> #end }
Group()
  #for (K, -1, 1, 2)
    Group()
      bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
        #for (I, 0, 3) #for (J, 0, 3) <I/2 + K - 0.75, 0.5*abs(J - 1.5)*K, J - 1.5> #end #end
        pigment { rgb <0.6 + 0.3*K, 0.5, 0.6 - 0.3*K> } }
    EndGroup(10*K*z)
  #end
EndGroup(30*y)
