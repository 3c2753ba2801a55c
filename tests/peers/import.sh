#!/bin/bash
# The scripts of examples/import: one net in each format is the same model, all bases of RenderMan's are converted to the
# same surface, and periodic meshes close.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" python3
scripts=$PSCN_SOURCE_DIR/examples/import
python3 - <<'END'
rows = [[(u - 1.5, u * v % 3 - 0.25, v - 1.5 + u * u / 7) for u in range(4)] for v in range(4)]
net = [p for row in rows for p in row]
text = lambda p: " ".join(repr(x) for x in p)
swapped = [(x, z, y) for x, y, z in net]
open("holmes.bpt", "w").write("1\n3 3\n" + "\n".join(map(text, swapped)) + "\n")
open("newell.bpt", "w").write(
    "1\n" + ",".join(str(16 - k) for k in range(16)) + "\n16\n" + "\n".join(",".join(map(repr, p)) for p in swapped[::-1]) + "\n")
open("one.obj", "w").write(
    "".join(f"v {x!r} {y!r} {-z!r}\n" for x, y, z in net) + "cstype bezier\ndeg 3 3\nsurf 0 1 0 1 "
    + " ".join(str(k - 16) for k in range(16)) + "\nparm u 0 1\nparm v 0 1\nend\n")
open("one.rib", "w").write('# a comment\nWorldBegin\nTranslate 1 2 3\nTransformBegin\nTranslate -1 -2 -3\nPatch "bicubic" "P" ['
    + " ".join(map(text, net)) + ']\nTransformEnd\nSphere 1 -1 1 360\nWorldEnd\n')
wide = [(u / 3, (u * v) % 2, v) for v in range(4) for u in range(7)]
open("two.obj", "w").write("".join(f"v {x!r} {y!r} {z!r} 1\n" for x, y, z in wide) + "cstype bezier\ndeg 3 3\nsurf 0 2 0 1 "
    + " ".join(f"{k + 1}/1/1" for k in range(28)) + "\nparm u 0 1 2\nparm v 0 1\nend\n")
open("ring.rib", "w").write('Basis "b-spline" 1 "catmull-rom" 1\nPatchMesh "bicubic" 6 "periodic" 5 "nonperiodic" "P" ['
    + " ".join(f"{(2 + v) * (1, .5, -.5, -1, -.5, .5)[u]} {v * v / 3} {(2 + v) * (0, .87, .87, 0, -.87, -.87)[u]}"
               for v in range(5) for u in range(6)) + ']\n')
END
for file in holmes.bpt newell.bpt one.obj one.rib two.obj ring.rib; do
  python3 "$scripts/${file##*.}.py" $file >$file.pscn
  "$PSCN" dump $file.pscn >$file.dump
done
for file in newell.bpt one.obj one.rib; do cmp holmes.bpt.dump $file.dump; done
[ "$(grep -c bicubic_patch two.obj.dump)" = 2 ] && [ "$(grep -c bicubic_patch ring.rib.dump)" = 12 ]
# Rays from the axis of the closed ring hit it in every direction, across all its seams.
for k in {0..359}; do echo "0 1 0 $(awk "BEGIN { a = $k*3.14159265358979/180; print cos(a), 0.05, sin(a) }")"; done |
  "$PSCN" trace ring.rib.pscn --quiet | grep -c '^hit' | grep -qx 360
PYTHONPATH=$scripts python3 - <<'END'
import random
import rib
random.seed(5)
powers = lambda x: [x**3, x**2, x, 1]
bernstein = lambda x: [(1 - x) ** 3, 3 * x * (1 - x) ** 2, 3 * x * x * (1 - x), x**3]
for name, (matrix, step) in rib.BASES.items():
    points = [tuple(random.uniform(-1, 1) for _ in range(3)) for _ in range(16)]
    net = next(rib.mesh_nets(points, (4, False), (4, False), [(matrix, step), rib.BASES["b-spline"]]))
    for u, v in ((0, 0), (1, 0.25), (0.3, 0.6)):
        for k in range(3):
            blend = [[sum(powers(x)[r] * m[r][c] for r in range(4)) for c in range(4)]
                     for x, m in ((u, matrix), (v, rib.BASES["b-spline"][0]))]
            meant = sum(blend[1][i] * blend[0][j] * points[4 * i + j][k] for i in range(4) for j in range(4))
            got = sum(bernstein(v)[i] * bernstein(u)[j] * net[4 * i + j][k] for i in range(4) for j in range(4))
            assert abs(meant - got) < 1e-12, (name, meant, got)
END
for wrong in 'Patch "bicubic" "Pw" [1 2 3]' 'PatchMesh "bicubic" 4 "nonperiodic" 4 "nonperiodic" "P" [1 2 3]' ''; do
  echo "$wrong" >wrong.rib
  { ! python3 "$scripts/rib.py" wrong.rib >out 2>said && [ -s said ] && [ ! -s out ]; } || exit 1
done
