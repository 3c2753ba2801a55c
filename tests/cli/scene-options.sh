# Folders of included files, names declared on the command line, warnings for a scene that shows nothing.
mkdir first second
echo '#declare Where = 1;' >first/where.inc
echo '#declare Where = 2;' >second/where.inc
echo '#declare Where = 3;' >second/here.inc
echo '#include "where.inc" background { rgb Where }' >scene.pscn
try pscn dump scene.pscn
pscn dump scene.pscn -I first | grep background
pscn dump scene.pscn -I nowhere -I second/ -I first | grep background
PSCN_INCLUDE=nowhere:second:first pscn dump scene.pscn | grep background
PSCN_INCLUDE=second pscn dump scene.pscn --include=first | grep background
PSCN_INCLUDE=:::second: pscn dump scene.pscn | grep background
PSCN_INCLUDE=$(printf 'nowhere/%.0s' {1..600}):$(printf 'nowhere:%.0s' {1..600})first pscn dump scene.pscn | grep background
cp second/here.inc where.inc
pscn dump scene.pscn -I first | grep background

echo 'background { rgb Level } #ifdef (Other) camera { location Other } #end' >scene.pscn
for level in 0.5 -1e-3 Level; do try pscn dump scene.pscn --declare Level=$level | grep 'background\|exit'; done
pscn dump scene.pscn --declare Level=1 --declare Other=2 --declare Level=3 | grep 'background\|location'
for text in clock=0.5 Level Level= =1 1a=2 x=1 sphere=1 'a b=1' Level=1x Level=1e999; do try pscn dump scene.pscn --declare "$text"; done

# As many as there is room for.
folders=$(printf -- '-I nowhere%.0s ' {1..32}) numbers=$(printf -- '--declare N%d=1 ' {1..64})
try pscn dump scene.pscn $folders ${numbers%--declare*} --declare Level=1 >/dev/null
try pscn dump scene.pscn $folders $numbers --declare Level=1 >/dev/null
try pscn dump scene.pscn $folders -I first >/dev/null

cat >scene.pscn <<'END'
background { rgb 1 }
END
try pscn render scene.pscn -o a.png --size 4x3 2>&1 | grep 'warning\|exit'
try pscn render scene.pscn -o a.png --size 4x3 --quiet
try pscn dump scene.pscn --quiet >/dev/null

# With every command that reads a scene.
echo '#include "where.inc" background { rgb Where * Level }' >scene.pscn
rm where.inc
for command in 'render -o a.png --size 4x3' trace dump 'check --povray nowhere' 'chart --no-peers --quiet --size 2x2 --rays 1 --rounds 1'; do
  echo "$command"
  try pscn $command scene.pscn -I first --declare Level=1 --max-memory 1 </dev/null 2>&1 | grep 'more memory\|unknown\|exit'
  try pscn $command scene.pscn -I first --declare Level=1 </dev/null 2>&1 | grep 'error\|exit'
done
