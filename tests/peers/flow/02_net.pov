// A net filled by nested #while inside the patch.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -6> look_at 0 angle 40 }
light_source { <4, 8, -6>, rgb 1 }
#declare Height = array[4] { 0.2, 0.8, -0.3, 0.1 }
bicubic_patch {
  type 1 flatness 0 u_steps 6 v_steps 6
  #declare I = 0;
  #while (I < 4)
    #declare J = 0;
    #while (J < 4)
      <I - 1.5, Height[I]*cos(J*pi/3), J - 1.5>
      #if (I + J < 6) , #end
      #declare J = J + 1;
    #end
    #declare I = I + 1;
  #end
  pigment { rgb <0.3, 0.6, 0.9> } finish { phong 0.3 }
}
