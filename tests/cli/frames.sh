# Frames of an animation: their names, what the scene knows of them, going on where an earlier run was ended.
cat >turn.pscn <<'END'
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -5> look_at 0 angle 40 }
light_source { <5, 8, -5>, rgb 1 }
#ifndef (Still) #debug concat("frame ", str(frame_number, 0, 0), " of ", str(initial_frame, 0, 0), " to ",
  str(final_frame, 0, 0), ", clock ", str(clock, 0, 3), " in steps of ", str(clock_delta, 0, 3), "\n") #end
#ifdef (Bad) #if (frame_number = Bad) #error "this frame is bad" #end #end
bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3
  #for (I, 0, 3) #for (J, 0, 3) <I - 1.5, mod(I*J, 2), J - 1.5> #end #end
  pigment { rgb <1, clock, 0> } rotate 90*clock*y }
END
frames() { pscn render turn.pscn --size 40x30 "$@" 2>&1 | grep 'frame\|rror'; }
frames --frames 8-10
ls turn*.png
rm turn09.png
frames --frames 8-10 --resume
frames --frames 1-3 --declare Bad=2 -o bad.exr
ls bad*
frames --frames 1-1 -o one
# One of them by itself, as on a farm, is the same picture.
pscn render turn.pscn --size 40x30 --quiet --clock 0.5 --declare frame_number=9 -o nine.png
pscn compare nine.png turn09.png --quiet && echo same
for wrong in 3 0-2 3-1 a-b 1- 1-9999999; do try pscn render turn.pscn --frames $wrong; done
try pscn render turn.pscn --frames 1-2 --stats x.json
try pscn render turn.pscn --frames 1-2 -o -
