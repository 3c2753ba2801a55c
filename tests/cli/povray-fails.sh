# A program in POV-Ray's place that fails in each possible way. The message says which, the exit code is right, and
# earlier results of check stay. A chart leaves it out.
scene=$SCENES/bent.pscn
small="--size 8x6 --steps 0 --grid 2 --failpercent 100 --failpsnr 0 --failmask 100 --quiet"
pscn render "$scene" --size 8x6 --quiet -o answer.png
pscn render "$scene" --size 8x5 --quiet -o other.png
pscn render "$scene" --size 9x6 --quiet -o wide.png
cat >povray <<END
#!/bin/bash
[ "\$MODE" = mute ] && exit
[ "\$MODE" = talks ] && seq 300000
echo "POV-Ray 3.7.0"
[ "\$1" = --version ] && exit
case \$MODE in
  fails) printf 'Parse Error: \\033[31mno\\377 <b>\\n'; exit 1 ;;
  raves | parses) seq 100; echo '==== [Parsing'; [ \$MODE = parses ] || seq 2000; echo 'Parse Error: no'; exit 1 ;;
  declares) printf '%s\n' "\$@" | grep 'Declare\|Clock'; exit 1 ;;
  told) echo "\$*, HOME \${HOME##*/}, POVINI \${POVINI-none}"; cat "\$HOME/.povray/3.7/povray.conf"; exit 1 ;;
  steps) ! grep 'u_steps 2' scene.pov || exit 1 ;;
  empty) exit 0 ;;
  other | wide) cp $PWD/\$MODE.png picture.png; exit ;;
  broken) echo broken >picture.png; exit ;;
  killed) kill -KILL \$\$ ;;
  slow) sleep 60 ;;
  writes) head -c 80M /dev/zero >big; sleep 60 ;;
  deaf) trap '' TERM; while :; do read -t 1 <> <(:); done ;;
esac
cp $PWD/answer.png picture.png
[ \$MODE = answers ] || sed -n 's/^Ask(.*/1e0 -/p' scene.pov >answers.txt
[ \$MODE = fewer ] && sed -i 3d answers.txt
[ \$MODE = timeless ] || printf 'Trace Time: 0 hours\\n  using 1 thread(s) with 0.1 CPU-seconds total\\n'
[ \$MODE = timeless ] && printf 'Trace Time: 0 hours\\n  using 1 thread(s) with x CPU-seconds total\\n'
exit 0
END
chmod +x povray
mkdir out && echo old >out/check.html
export MODE TMPDIR=$PWD/tmp
mkdir tmp
left() { # says what is there beside the page of an earlier run
  [ "$(ls -A tmp out; cat out/check.html)" = "$(printf 'out:\ncheck.html\n\ntmp:\nold')" ] || ls -A tmp out
}
for MODE in mute fails empty other wide broken killed slow deaf writes answers fewer; do
  echo "$MODE:"
  try timeout 60 pscn check "$scene" $small --povray ./povray --timeout $([ $MODE = writes ] && echo 30 || echo 1) -o out 2>&1 | cat -v | sed "s|$PWD|HERE|g"
  left
done
for MODE in talks timeless; do
  echo "$MODE:"
  try timeout 60 pscn check "$scene" ${small% --quiet} --povray ./povray -o done 2>&1 | grep 'exit\|arning\|Error\|old'
  left
done
for MODE in mute fails empty killed slow answers timeless talks; do
  echo "$MODE:"
  try pscn chart "$scene" --size 1x1 --rays 1 --rounds 1 --quick --quiet --povray ./povray --timeout 1 -o chart 2>&1 | grep -v -i 'embree\|gnuplot' | sed "s|$PWD|HERE|g"
  grep -o 'POV-Ray failed[^<]*\|POV-Ray 3.7.0: errors' chart/chart.html
  left
done
echo "where it begins to read, and no more than the end of much:"
for MODE in parses raves; do
  try pscn check "$scene" $small --povray ./povray -o out >said 2>&1
  grep -v 'povray: [0-9]' said
  grep -c 'povray: [0-9]' said
done
echo "what is declared for the scene as written:"
MODE=declares try pscn check "$scene" $small --clock 0.25 --declare A=0.1 --declare Longer=-3 --povray ./povray -o out 2>&1
echo "what it is to do, whatever its own settings are, and where it may read and write:"
POVINI=any.ini MODE=told try pscn check "$scene" $small --povray ./povray -o out 2>&1
echo "steps, and no flatness of the scene's:"
sed 's/flatness 0 /flatness 0.5 /' $SCENES/flat.pscn >rough.pscn
MODE=steps try pscn check rough.pscn $small --steps 2 --povray ./povray -o rough 2>&1
echo "within the limits:"
MODE=any try pscn check rough.pscn $small --povray ./povray -o rough
grep -o 'Within the limits[^<]*\|pscn check [^<]*' rough/check.html
echo "beyond a limit:"
MODE=any try pscn check $SCENES/flat.pscn ${small% --quiet} --failpsnr 100 --povray ./povray -o beyond 2>&1 | grep 'beyond\|exit'
ls beyond/check.html
echo "no room:"
(export TMPDIR=$PWD/none MODE=answers; try pscn check "$scene" $small --povray ./povray -o out 2>&1)
echo "ends of children are ignored where pscn is started:"
(trap '' CHLD; export MODE=fails; try pscn check "$scene" $small --povray ./povray -o out 2>&1 | cat -v)
