#!/bin/bash
# Files written as people do, with loops, macros, arrays, functions and clock, tests/peers/flow: their pictures are POV-Ray's,
# at 45 dB or better. What each of these means in numbers meaning.sh compares.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
failed=0 count=0
for file in "$PSCN_SOURCE_DIR"/tests/peers/flow/*.pov "$PSCN_SOURCE_DIR/scenes/sunflower.pscn"; do
  name=$(basename "$file" .pov)
  cp "$file" "$name.pov"
  clock=0
  [[ $name != *clock* && $name != sunflower* ]] || clock=0.7
  "$PSCN" render "$name.pov" --lenient --clock $clock --size 160x120 -o ours.png --stats stats --quiet 2>said || { cat said; failed=1; }
  povray "+I$name.pov" +W160 +H120 -D +FN +Otheirs.png "+K$clock" Declare=Plain=1 -GA </dev/null >said 2>&1 ||
    { grep -i error said; failed=1; }
  psnr=$({ "$PSCN" compare ours.png theirs.png 2>said || true; } | sed -n 's/^psnr *//p')
  echo "$name $psnr"
  [[ $psnr == inf* || ${psnr%%[. ]*} -ge 45 ]] || failed=1
  [ "$(sed -n 's/.*"accepted": \([0-9]*\).*/\1/p' stats)" -gt 500 ] || { echo "nothing is seen"; failed=1; }
  rm -f ours.png theirs.png
  count=$((count + 1))
done
[ $count -ge 11 ]
exit $failed
