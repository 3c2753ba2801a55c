# The scene of a stranger reads nothing but files below its folder, and those of -I; chooses no solver; and nothing is
# written where the stranger may have laid a trap.
mkdir -p up/sub lib out
cp "$SCENES/flat.pscn" up/scene.pscn
echo '#declare Here = 1;' | tee up/here.inc up/sub/below.inc lib/library.inc secret.inc >/dev/null
ln -s ../secret.inc up/link.inc
ln -s .. up/parent
ln -s ../secret.inc lib/link.inc
ln -s ../secret.inc up/linked.pscn
small="--size 8x6 --quiet"
asked() { # a line of the scene
  { echo "$1"; cat "$SCENES/flat.pscn"; } >up/asks.pscn
  pscn dump up/asks.pscn --untrusted -I lib >/dev/null
  echo "exit $?: $1" | head -n 1 | cut -c 1-60
}
for name in here.inc sub/below.inc library.inc here; do asked "#include \"$name\""; done
for name in /etc/passwd ../secret.inc sub/../here.inc .. link.inc parent/secret.inc nothing.inc \
  /proc/self/environ; do
  asked "#include \"$name\""
done
# A folder of -I is trusted, a link in it is not followed out of it.
asked '#include "link.inc"'
try pscn dump up/linked.pscn --untrusted
# From standard input there is no folder but those of -I.
echo '#include "library.inc"' | try pscn dump - --untrusted -I lib | tail -n 1
echo '#include "secret.inc"' | try pscn dump - --untrusted -I lib
for text in 'global_settings { solver newton }' '#ifdef (pscn) global_settings { solver aberth { polish off } } #end'; do
  asked "$text"
done
try pscn dump up/scene.pscn --untrusted --solver newton | grep -c newton
asked "$(for k in {1..64}; do echo "light_source { $k*x, 1 }"; done)"
try pscn trace up/scene.pscn --untrusted --stats up/stats.json </dev/null
# A loop prints a thousand lines at most; it ends where loops end.
echo '#while (1) #debug "line\n" #end' >up/flood.pscn
pscn dump up/flood.pscn --untrusted 2>&1 | grep -c '^line$'
rm up/flood.pscn
# Outputs.
try pscn render up/scene.pscn --untrusted $small
try pscn render up/scene.pscn --untrusted $small -o up/picture.png
try pscn render up/scene.pscn --untrusted $small -o up/sub/picture.png
try pscn render up/scene.pscn --untrusted $small -o out/picture.png --stats up/stats.json
ln -s up folder
try pscn render up/scene.pscn --untrusted $small -o folder/picture.png
try pscn render folder/scene.pscn --untrusted $small -o up/picture.png
try pscn render up/scene.pscn --untrusted $small -o out/picture.png --stats -  | grep -c '"certain"'
(cd up && try pscn render scene.pscn --untrusted $small -o picture.png)
try pscn render - --untrusted $small -o out/other.png <up/scene.pscn
# Sizes.
try pscn render up/scene.pscn --untrusted -o out/large.png --size 8192x4096
try pscn render up/scene.pscn --untrusted -o out/large.png --size 2048x2048 --samples 9
# Time: a loop of the scene's ends as `ulimit -St` would end it, and what is set is not changed.
(ulimit -St 1; exec pscn render up/scene.pscn --untrusted -o out/long.png --size 1024x1024 --samples 16 --quiet); echo "exit $?"
rm -f out/long.png.part.exr # if there was time to keep it
find up out -type f | LC_ALL=C sort
