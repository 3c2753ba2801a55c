#!/bin/bash
# The page of `pscn check` in headless Chromium: its console is empty, it asks no network for anything, and a screenshot
# shows both pictures at their places.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
browser=$(command -v chromium || command -v chromium-browser || true)
[ -n "$browser" ] || { echo "skipped: chromium is not installed" >&2; exit 77; }
failed=0
fail() { echo "$*"; failed=1; }

# 590 pixels wide: at this width the page shows the pictures pixel for pixel, whatever the browser does to larger ones.
WIDTH=590 HEIGHT=300
"$PSCN" check "$PSCN_SOURCE_DIR/tests/cli/scenes/bent.pscn" -o out --size ${WIDTH}x$HEIGHT --steps 2 \
  --failpercent 100 --failpsnr 0 --failmask 100 --quiet
grep -Eq '(src|href)="(https?:|//|file:)|url\(|@import' out/check.html &&
  fail "the page asks for something beside itself"

# browse FILE OPTION...: the console's messages come on stderr, as INFO:CONSOLE.
browse() {
  timeout 100 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --hide-scrollbars \
    --force-device-scale-factor=1 --force-color-profile=srgb --enable-logging=stderr --user-data-dir="$folder/profile" \
    --window-size=1300,5000 "${@:2}" "file://$PWD/$1" >dom 2>log || { cat log; exit 1; }
}
browse out/check.html --screenshot=shot.png
[ -s shot.png ] || { fail "no screenshot"; cat log; exit 1; }
! grep 'CONSOLE' log || fail "the page has something to say on the console"
# A page with an error is noticed, or this could not fail. It also says where the pictures are.
sed 's|</body>|<script>document.title = [...document.images].slice(0, 2).map(i => {\
  const r = i.getBoundingClientRect();\
  return [r.left, r.top, r.width, r.height].map(Math.round).join(",") }).join(" "); undefined_name()</script></body>|' \
  out/check.html >places.html
browse places.html --dump-dom
grep -q 'CONSOLE' log || fail "an error of a page would not be noticed"
read -r first second <<<"$(sed -n 's|.*<title>\(.*\)</title>.*|\1|p' dom)"
# shown PLACE PICTURE: the screenshot holds the picture there, pixel for pixel.
shown() {
  IFS=, read -r x y w h <<<"$1"
  [ "$w" = "$WIDTH" ] && [ "$h" = "$HEIGHT" ] || { fail "$2 is shown at ${w}x$h"; return; }
  oiiotool shot.png --ch R,G,B --crop "${w}x$h+$x+$y" --origin +0+0 --fullpixels -o part.png
  "$PSCN" compare part.png "$2" --fail 2/255 --failpercent 0.1 --quiet || fail "$2 is not where it should be"
}
command -v oiiotool >/dev/null || { echo "skipped: openimageio-tools is not installed" >&2; exit 77; }
shown "$first" out/pscn.png
shown "$second" out/povray-2.png
exit "$failed"
