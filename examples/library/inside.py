#!/usr/bin/python3
"""Which points are inside the closed surface of a scene, by the proven parity of hits: inside.py SCENE [POINTS]"""
import sys
import numpy as np
import pscn
scene = pscn.Scene.from_file(sys.argv[1]) if len(sys.argv) > 1 else sys.exit(__doc__)
low, high = scene.bounds()
points = np.random.default_rng(1).uniform(low, high, (int((sys.argv + [1000])[2]), 3))
found = scene.all(points, [0.3, 0.5, 0.8], most=1)
inside = found.count % 2 == 1
print(f"{inside.sum()} of {len(points)} are inside, {(~found.certain).sum()} have no proven number of hits,",
      f"volume {inside.mean() * np.prod(high - low):.4g}")
