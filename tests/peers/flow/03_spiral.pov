// A spiral of bowls, turned and coloured by random numbers.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 7, -7> look_at 0 angle 36 }
light_source { <-4, 9, -5>, rgb 1 }
background { rgb 0.4 }
#declare Bowl = bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  <-1,.4,-1> <-.3,.1,-1> <.3,.1,-1> <1,.4,-1>   <-1,.1,-.3> <-.3,-.4,-.3> <.3,-.4,-.3> <1,.1,-.3>
  <-1,.1,.3> <-.3,-.4,.3> <.3,-.4,.3> <1,.1,.3>  <-1,.4,1> <-.3,.1,1> <.3,.1,1> <1,.4,1> scale 0.5 }
#declare Chance = seed(2718);
#declare N = 0;
#while (N < 12)
  #local Paint = rgb <0.3 + 0.6*rand(Chance), 0.3 + 0.6*rand(Chance), 0.4>;
  object { Bowl rotate <20*rand(Chance), 90*rand(Chance), 0> translate (0.5 + 0.2*N)*x rotate 50*N*y
    pigment { Paint } }
  #declare N = N + 1;
#end
