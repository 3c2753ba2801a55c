#!/bin/bash
# python.sh LIBRARY: the Python module answers as `pscn trace` does, its examples run, and its errors are exceptions.
set -euo pipefail
for python in python3 /usr/bin/python3 none; do
  "$python" -c 'import numpy' 2>/dev/null && break
done
[ "$python" != none ] || { echo "skipped: python3-numpy is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
scenes=$PSCN_SOURCE_DIR/scenes examples=$PSCN_SOURCE_DIR/examples/library
export PSCN_LIBRARY=$1 PYTHONPATH=$PSCN_SOURCE_DIR/src/python PYTHONDONTWRITEBYTECODE=1
diff - <("$python" "$examples/depth_map.py" "$scenes/dome.pscn" depth.npy 40 30) <<<'1200 of 1200 rays hit, 0 are not proven'

cp "$PSCN_SOURCE_DIR/tests/library/wedge.pscn" .
diff - <("$python" "$examples/inside.py" wedge.pscn 200 | sed 's/^[0-9]* of 200 are inside/some are inside/; s/volume 2[0-9.]*/volume 2x/') \
  <<<'some are inside, 0 have no proven number of hits, volume 2x'
"$python" "$examples/two_solvers.py" "$scenes/dome.pscn" | grep -c 'error of t' | grep -qx 10
"$python" - "$scenes/dome.pscn" <<'END'
import os, subprocess, sys, threading
import numpy as np
import pscn
scene = pscn.Scene.from_file(sys.argv[1])
origins, directions = scene.camera_rays(8, 6)
hits = scene.nearest(origins, directions)
lines = "".join(" ".join("%.17g" % x for x in (*o, *d)) + "\n" for o, d in zip(origins.reshape(-1, 3), directions.reshape(-1, 3)))
told = subprocess.run([os.environ["PSCN"], "trace", sys.argv[1]], input=lines, stdout=subprocess.PIPE, text=True, check=True)
for n, line in enumerate(told.stdout.splitlines()):
    k = np.unravel_index(n, hits.t.shape)
    t, u, v, patch, *normal = map(float, line.split()[1:])
    assert (u, v, patch, *normal) == (hits.u[k], hits.v[k], hits.patch[k], *hits.normal[k])
    assert abs(t - hits.t[k] * np.linalg.norm(directions[k])) <= 4e-16 * t
assert hits.hit.all() and hits.certain.all() and np.load("depth.npy").shape == (30, 40)

# The same patches as arrays and by indices; any shape of rays, also none; threads.
nets = np.array([scene.patch(n) for n in range(len(scene))])
vertices, index = np.unique(nets.reshape(-1, 3), axis=0, return_inverse=True)
for same in (pscn.Scene(nets), pscn.Scene.from_indexed(vertices, index.reshape(-1, 16)),
             pscn.Scene.from_indexed(vertices, index.reshape(-1, 16), instances=[np.eye(4)[:, :3]])):
    again = same.nearest(origins[::-1, :, None], directions[::-1, :, None])
    assert (again.t[::-1, :, 0] == hits.t).all() and len(same) == len(scene)
assert scene.nearest(np.zeros((0, 3)), [0, 0, 1]).t.shape == (0,)
assert scene.nearest(origins[0, 0], directions[0, 0]).t == hits.t[0, 0]
results = [None] * 4
def run(n):
    results[n] = scene.nearest(origins, directions)
threads = [threading.Thread(target=run, args=(n,)) for n in range(4)]
[thread.start() for thread in threads], [thread.join() for thread in threads]
assert all((result.t == hits.t).all() for result in results)

# The other calls.
assert scene.occluded(origins, directions).all()
assert not scene.occluded(origins, directions, t_max=hits.t * 0.999).any()
found = scene.all(origins, directions, most=2)
assert (found.count >= 1).all() and (found.hits.patch[..., 0] == hits.patch).all() and found.hits.t.shape == (6, 8, 2)
surface = scene.surface(hits.patch, hits.u, hits.v)
assert np.abs(surface.point - hits.point).max() < 1e-13
assert np.allclose(np.abs((surface.normal * hits.normal).sum(-1)), 1, atol=1e-12)
low, high = scene.bounds()
assert (low <= nets.min((0, 1, 2))).all() and (scene.bounds(0) == [nets[0].min((0, 1)), nets[0].max((0, 1))]).all()

# Options, and the objects of a text.
options = dict(numbers={"Far": 1.5}, clock=0.25, image_size=(30, 20), lenient=True, folders=["."], solver=None)
made = pscn.Scene.from_text('camera { location <Far, clock, image_width> look_at 0 } sphere { 0, 1 } #include "wedge.pscn"'
                            " #declare Lid = object { bicubic_patch { type 0 " + " ".join(f"<{k % 4},{k // 4},0>" for k in range(16))
                            + " } } object { Lid } union { object { Lid } object { Lid } }", **options)
assert made.camera_rays(1, 1)[0].tolist() == [[[1.5, 0.25, 30]]] and "sphere" in made.messages
assert [(part.name, len(part.patches)) for part in made.parts[-2:]] == [("Lid", 1), ("", 2)]
assert made.parts[-1].patches.stop == len(made) and not pscn.Scene(nets).parts

# Errors.
def fails(kind, words, call, *arguments, **options):
    try:
        call(*arguments, **options)
    except kind as error:
        assert words in str(error), error
    else:
        raise SystemExit(f"no error: {words}")
fails(pscn.Error, "text:1:10: error: unknown word 'loaction'", pscn.Scene.from_text, "camera { loaction 1 }")
fails(pscn.Error, "is not a number", pscn.Scene, np.full((1, 4, 4, 3), np.nan))
fails(pscn.Error, "wrong", scene.nearest, [0, 0, 0], [0, 0, 0])
fails(pscn.Error, "solver", pscn.Scene, nets, solver="nosuch")
fails(pscn.Error, "untrusted", pscn.Scene.from_text, "global_settings { solver newton }", untrusted=True)
fails(MemoryError, "memory", pscn.Scene, nets, max_memory=1000)
fails(TypeError, "'tolerence'", pscn.Scene, nets, tolerence=1e-3)
fails(ValueError, "(4, 4, 3)", pscn.Scene, [1.0])
fails(pscn.Error, "argument", scene.patch, len(scene))
END
