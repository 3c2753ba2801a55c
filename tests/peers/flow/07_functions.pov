// Points of a surface of revolution by functions of vectors.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -7> look_at <0, 0.6, 0> angle 34 }
light_source { <-4, 7, -6>, rgb 1 }
background { rgb <0.2, 0.25, 0.3> }
#declare Profile = array[4] { <0.4, 0, 0>, <1.4, 0.3, 0>, <1.1, 1.2, 0>, <0.7, 1.6, 0> }
#declare Handle = 4/3*tan(radians(90)/4);
#for (Quarter, 0, 3)
  bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
    #for (I, 0, 3)
      #local P = vrotate(Profile[I], 90*Quarter*y);
      #local Q = vaxis_rotate(Profile[I], y, 90*Quarter + 90);
      #local Side = vnormalize(vcross(y, vrotate(x, 90*Quarter*y)));
      #local Other = vnormalize(vcross(y, vrotate(x, (90*Quarter + 90)*y)));
      #local R = vlength(<P.x, 0, P.z>)*Handle;
      P, P + R*Side, Q - R*Other, Q
    #end
    pigment { rgb <0.8, 0.6, 0.4> } finish { specular 0.3 roughness 0.05 } }
#end
