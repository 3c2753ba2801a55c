#!/bin/bash
# Writes a scene to standard output: a field of N teapots, all of them `object { Teapot }` of one #declare, 32 patches
# each.
#
#   examples/field.sh N
#
# The field fills the picture as far as its shape allows. The light is at the camera: every hit of a camera ray sends
# exactly one shadow ray, so counting these counts hits.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LC_ALL=C

count=${1:?how many teapots?}
case $count in *[!0-9]*) echo "$0: '$count' is no number of teapots" >&2 && exit 2 ;; esac
awk -v n="$count" '
  function teapots(k) {
    for (k = 0; k < n; k++)
      printf "object { Teapot translate <%g, 0, %g> }\n", 7 * (k % s - (s - 1) / 2), 5 * (int(k / s) - (s - 1) / 2)
  }
  BEGIN {
    s = int(sqrt(n)); while (s * s < n) s++
    y = 5 * s + 2; z = -6 * s - 3
    printf "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
    printf "camera { location <0, %g, %g> look_at <0, 1, 0> angle 42 }\n", y, z
    printf "light_source { <0, %g, %g>, rgb 1 }\nbackground { rgb <0.74, 0.80, 0.88> }\n", y, z
  }
  /^#declare/ { on = 1 }
  on && /^object/ { exit } # all of the teapot scene from its first #declare to the union of all parts
  on
  END { teapots() }' scenes/teapot.pscn
