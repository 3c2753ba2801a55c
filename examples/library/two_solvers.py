#!/usr/bin/python3
"""How exact two solvers are, and how fast, without the proof: two_solvers.py SCENE [SOLVER SOLVER]"""
import sys
import time

import numpy as np
import pscn

if len(sys.argv) not in (2, 4):
    sys.exit(__doc__)
origins, directions = pscn.Scene.from_file(sys.argv[1]).camera_rays(200, 150)
exact = pscn.Scene.from_file(sys.argv[1]).nearest(origins, directions)
for solver in sys.argv[2:] or ["newton { polish off }", "aberth { polish off }"]:
    scene = pscn.Scene.from_file(sys.argv[1], solver=solver)
    start = time.process_time()
    hits = scene.nearest(origins, directions)
    seconds = time.process_time() - start
    both = hits.hit & exact.hit
    error = np.abs(hits.t[both] / exact.t[both] - 1)
    print(f"{solver}: {1e9 * seconds / hits.t.size:.0f} ns a ray, {(hits.hit != exact.hit).sum()} hits lost or invented")
    for low, high in [(0, 1e-15), (1e-15, 1e-12), (1e-12, 1e-9), (1e-9, 1e-6), (1e-6, np.inf)]:
        part = ((error >= low) & (error < high)).mean() if error.size else 0
        print(f"  error of t from {low:.0e}  {part:7.2%} {'#' * round(50 * part)}")
