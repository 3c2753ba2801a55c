#!/usr/bin/python3
"""How far from the camera each pixel of a scene is: depth_map.py SCENE FILE.npy [WIDTH HEIGHT]"""
import sys
import numpy as np
import pscn
path, output, width, height = (sys.argv[1:] + [400, 300])[:4] if len(sys.argv) > 2 else sys.exit(__doc__)
origins, directions = (scene := pscn.Scene.from_file(path)).camera_rays(int(width), int(height))
hits = scene.nearest(origins, directions)
np.save(output, hits.t * np.linalg.norm(directions, axis=-1))
print(f"{hits.hit.sum()} of {hits.hit.size} rays hit, {(~hits.certain).sum()} are not proven")
