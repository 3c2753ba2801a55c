// Arguments by reference: a macro that returns two values, and one that fills an array.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -7> look_at 0 angle 34 }
light_source { <3, 8, -5>, rgb 1 }
#macro Polar(A, R, X, Z) #declare X = R*cos(A); #declare Z = R*sin(A); #end
#macro Fill(Net, Bump)
  #local I = 0;
  #while (I < dimension_size(Net, 1))
    #for (J, 0, dimension_size(Net, 2) - 1) #declare Net[I][J] = <I/1.5 - 1, Bump*sin(I + J), J/1.5 - 1>; #end
    #local I = I + 1;
  #end
#end
#declare Points = array[4][4];
Fill(Points, 0.5)
#declare PX = 0; #declare PZ = 0;
#for (K, 0, 4)
  Polar(2*pi*K/5, 1.6, PX, PZ)
  bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
    #for (I, 0, 3) #for (J, 0, 3) Points[I][J] #end #end
    scale 0.6 translate <PX, 0, PZ> pigment { rgb <0.4 + 0.1*K, 0.7, 1 - 0.15*K> } }
#end
