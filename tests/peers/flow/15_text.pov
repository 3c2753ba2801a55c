// Messages, and numbers from strings' lengths; a file included under a name that is put together in a loop.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare Title = concat("a net of ", str(16, 0, 0), " points");
#debug concat(Title, "\n")
#if (strlen(Title) != 18) #error "the title is of another length" #end
camera { location <0, 4, -6> look_at 0 angle 36 }
light_source { <4, 8, -6>, rgb 1 }
#include "math.inc"
#include "rand.inc"
#macro Point(I, J) <I - 1.5, clamp_to(I*J/9, 0.2, 0.7), J - 1.5> #end
#macro clamp_to(V, Low, High) (V < Low ? Low : V > High ? High : V) #end
#declare Stream = seed(7);
bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #for (I, 0, 3) #for (J, 0, 3) Point(I, J) + RRand(-0.1, 0.1, Stream)*y #end #end
  pigment { rgb VRand(Stream) } finish { ambient 0.3 } }
