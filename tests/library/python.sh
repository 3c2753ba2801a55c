#!/bin/bash
# python.sh LIBRARY: the Python example answers as `pscn render` does, and plots its result.
set -euo pipefail
for python in python3 /usr/bin/python3 none; do
  "$python" -c 'import numpy' 2>/dev/null && break
done
[ "$python" != none ] || { echo "skipped: python3-numpy is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
scene=$PSCN_SOURCE_DIR/scenes/dome.pscn
export PSCN_LIBRARY=$1
"$python" "$PSCN_SOURCE_DIR/examples/library/depth_map.py" "$scene" depth.png 40 30 >said
cat said
grep -q ' of 1200 rays hit, 0 are not proven$' said
if grep -q 'plotted by [mg]' said; then
  head -c 8 depth.png | grep -q PNG
fi
"$python" - "$PSCN_SOURCE_DIR/examples/library" "$scene" <<'END'
# The same scene through the example's own functions: the answers of pscn trace, strides, errors with their places.
import os, subprocess, sys
sys.path.insert(0, sys.argv[1])
import numpy as np
import depth_map
pscn = depth_map.load_library()
scene = depth_map.Scene(pscn, sys.argv[2])
rays = depth_map.camera_rays(scene.camera(), 8, 6)
hits = scene.nearest(rays)
lines = "".join(" ".join("%.17g" % x for x in (*ray["origin"], *ray["direction"])) + "\n" for ray in rays)
told = subprocess.run([os.environ["PSCN"], "trace", sys.argv[2]], input=lines, stdout=subprocess.PIPE, text=True, check=True)
for line, hit, ray in zip(told.stdout.splitlines(), hits, rays):
    word, *numbers = line.split()
    t, u, v, patch, *normal = map(float, numbers)
    assert (u, v, patch, *normal) == (hit["u"], hit["v"], hit["patch"], *hit["normal"])
    assert abs(t - hit["t"] * np.linalg.norm(ray["direction"])) <= 4e-16 * t
again = scene.nearest(rays[::-1])
assert (hits == again[::-1]).all()
apart = np.zeros(rays.size, np.dtype([("name", "i4"), ("ray", depth_map.RAY), ("more", "3f4")], align=True))
apart["ray"] = rays
assert (scene.nearest(apart["ray"]) == hits).all()
assert np.load("depth.npy").shape == (30, 40)
scene.close()
open("wrong.pscn", "w").write("camera {\n  loaction 1\n}\n")
try:
    depth_map.Scene(pscn, "wrong.pscn")
    raise SystemExit("a wrong scene is read")
except ValueError as error:
    assert "wrong.pscn:2:3: error: unknown word 'loaction'" in str(error), error
END
