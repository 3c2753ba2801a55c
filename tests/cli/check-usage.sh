# What check refuses, and a missing POV-Ray. None of this leaves a folder behind.
try pscn check
try pscn check $SCENES/bent.pscn --size 0x10
try pscn check $SCENES/bent.pscn --size 8193x8192
try pscn check $SCENES/bent.pscn --steps 9
try pscn check $SCENES/bent.pscn --grid x
try pscn check $SCENES/bent.pscn --fail -1
try env PATH=/nonexistent "$(command -v pscn)" check $SCENES/bent.pscn
try pscn check $SCENES/bent.pscn --povray ./povray
printf '#!/bin/sh\n' >silent
chmod +x silent
try pscn check $SCENES/bent.pscn --povray ./silent 2>&1 | sed "s|$PWD|HERE|"
# Sizes are those that the scene's own words stand for: no divisor is 0.
echo 'background { rgb 1 / (image_width - 8) / (image_height - 12) }' >sized.pscn
try pscn check sized.pscn --size 12x8 --povray ./silent 2>&1 | sed "s|$PWD|HERE|"
rm sized.pscn silent
# A file of the folder that cannot be written is reported before the work.
mkdir -p full/check.html full/chart.csv
try pscn check $SCENES/bent.pscn --povray ./povray -o full
try pscn chart $SCENES/bent.pscn --quick --size 1x1 --rays 1 --rounds 1 --no-peers -o full
ls full
rm -r full
ls
