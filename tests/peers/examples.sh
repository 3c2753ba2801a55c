#!/bin/bash
# Patches made by others, from Debian's povray-examples: the teapot's file, included unchanged in a scene that declares
# its names; and the patch of the Bezier example, in a plain texture. Both programs render them, and agree within the
# limits of `pscn check` if POV-Ray cuts the patches finely.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
find_example() { # FILE: its place, wherever the package puts it, packed or not
  { dpkg -L povray-examples 2>/dev/null || find /usr/share/doc/povray* -type f 2>/dev/null; } |
    grep -E "/$1(\.gz)?$" | head -1
}
teapot=$(find_example advanced/teapot/teapot.inc || true)
bezier=$(find_example objects/bezier.pov || true)
[ -n "$teapot" ] && [ -n "$bezier" ] || { echo "skipped: povray-examples is not installed" >&2; exit 77; }
failed=0

zcat -f "$teapot" >teapot.inc
cat >teapot.pscn <<'END'
#version 3.7;
global_settings { assumed_gamma 1 }
#declare Teapot_Texture = texture { pigment { color rgb <0.6, 0.4, 0.2> } finish { phong 0.5 } }
#declare Teapot_Orientation = <-110, 20, 0>;
#include "teapot.inc"
camera { location <0, 0, -10> angle 55 up y right x*image_width/image_height }
light_source { <10, 40, -30> color rgb 1 }
background { color rgb <0.1, 0.1, 0.3> }
END

# From `bicubic_patch` to the brace that closes it. Its checkered texture, which only POV-Ray has, becomes one colour.
zcat -f "$bezier" | tr -d '\r' | awk '
  /bicubic_patch/ { inside = 1 }
  inside { for (k = 1; k <= length($0); k++) { c = substr($0, k, 1); depth += (c == "{") - (c == "}") }
           if (/checker/) sub(/checker.*/, "color rgb <0.9, 0.3, 0.2>"); else if (/quick_color/) next
           print; if (depth == 0) exit }' >bezier.inc
[ "$(grep -c '<.*>.*<.*>.*<.*>.*<.*>' bezier.inc)" -eq 4 ] ||
  { echo "the patch of $bezier is not where it was"; failed=1; }
cat >bezier.pscn <<'END'
#version 3.7;
global_settings { assumed_gamma 1 }
#include "bezier.inc"
camera { location <0, 0, -15> right x*image_width/image_height angle 50 }
light_source { <5, 7, -5> color rgb 1 }
background { color rgb 0.1 }
END

same() {
  "$PSCN" check "../$1.pscn" --size 240x180 -o page >out || { cat out; exit 1; }
  grep -E '^(as written|u_steps 6)' out
}
for scene in teapot bezier; do beside same $scene; done
all_right || failed=1
exit "$failed"
