# Rays and answers.
scene=$SCENES/flat.pscn
try pscn trace "$scene" </dev/null
printf '%s\n' '0 0 -4 0 0 1' '0.5 -0.25 3 0 0 -1' '0 0 -4 0 0 -1' '2 0 -4 0 0 1' '0.5 0.5 -4 0 0 1e-200' \
  '0.5 0.5 -4 0 0 1e200' '  +.5   5e-1 -4. 0 -0 2  ' '0.25 -0.5 -1 0 0 8' '1e-3 2e-3 -8 0 0 1' |
  try pscn trace "$scene"
# Lines may end with CR LF, and the last one need not end.
printf '0.5 0 -4 0 0 1\r\n0\t0.5 -4 0 0 1' | try pscn trace "$scene"
# In text and in binary the same hits.
printf '0.5 0 -4 0 0 1\n9 0 -4 0 0 1\n' | pscn trace "$scene" --solver aberth
zero='\0\0\0\0\0\0\0\0' half='\0\0\0\0\0\0\340\077' one='\0\0\0\0\0\0\360\077'
nine='\0\0\0\0\0\0\042\100' minus_four='\0\0\0\0\0\0\020\300'
printf "$half$zero$minus_four$zero$zero$one" >one
printf "$nine$zero$minus_four$zero$zero$one" >two
cat one two | pscn trace "$scene" --binary | LC_ALL=C od -A n -v -t f8 -w56 | sed 's/  */ /g'
