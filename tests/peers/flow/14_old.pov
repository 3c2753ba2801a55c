// An old file: no version, no semicolons behind objects, colours in words, a macro with commas left out.
camera { location <0, 4, -7> look_at 0 angle 34 }
light_source { <-4, 8, -5> color red 1 green 1 blue 1 }
#macro Wave(A B) bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6
  #local I = 0; #while (I < 4) #local J = 0; #while (J < 4)
    <I - 1.5, A*sin(I*B), J - 1.5> #local J = J + 1; #end #local I = I + 1; #end } #end
#declare Sea = object { Wave(0.4 2) pigment { color red 0.2 green 0.5 blue 0.9 } }
object { Sea translate -0.4*y }
object { Sea scale <0.5, 1, 0.5> translate 0.6*y rotate 45*y }
