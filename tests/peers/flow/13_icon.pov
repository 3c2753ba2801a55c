// An icon: what pscn does not support stands beside the patches, and is left out by --lenient. POV-Ray is given Plain.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 5 noise_generator 3 }
camera { location <0, 4, -7> look_at 0 angle 34 }
light_source { <4, 8, -5>, rgb 1 }
#declare Chance = seed(11);
#ifndef (Plain)
sky_sphere { pigment { gradient y color_map { [0 rgb 1] [1 rgb <0.3, 0.5, 1>] } } }
#declare Balls = difference { sphere { 0, 1 } box { 0, 2 } texture { pigment { checker rgb 1, rgb 0 } } }
object { Balls translate 20*y }
plane { y, -30 pigment { rgb 1 } finish { reflection 0.3 } }
#end
#for (K, 0, 3)
  bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
    #for (I, 0, 3) #for (J, 0, 3) <I/2 - 0.75, 0.3*sin(I*J), J/2 - 0.75> #end #end
    pigment { rgb <rand(Chance), 0.6, rand(Chance)> } hollow no_reflection
    finish { ambient 0.2 #ifndef (Plain) reflection { 0.2 } #end phong 0.2 }
    rotate 90*rand(Chance)*y translate <1.6*mod(K, 2) - 0.8, 0, 1.6*div(K, 2) - 0.8> }
  #ifndef (Plain) sphere { <0, -40, 0>, 1 } #else #local Nothing = 0; #end
#end
