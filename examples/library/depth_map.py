#!/usr/bin/python3
"""Depth map of a scene: how far from the camera each pixel's ray meets it, by libpscn, ctypes and numpy.

    depth_map.py SCENE [FILE.png] [WIDTH HEIGHT]

Writes what was found to stdout, the distances to FILE.npy, and plots them into FILE.png by matplotlib or gnuplot,
whichever is installed. PSCN_LIBRARY is the path of libpscn.so where the system does not find it.
"""
import ctypes
import ctypes.util
import os
import shutil
import subprocess
import sys

import numpy as np

# The structures of pscn.h.
RAY = np.dtype([("origin", "3f8"), ("direction", "3f8"), ("t_min", "f8"), ("t_max", "f8")], align=True)
HIT = np.dtype([("t", "f8"), ("u", "f8"), ("v", "f8"), ("point", "3f8"), ("point_error", "f8"), ("clearance", "f8"),
                ("normal", "3f8"), ("du", "3f8"), ("dv", "3f8"), ("patch", "u4"), ("verdict", "i4"), ("certain", "i4"),
                ("reserved", "i4")], align=True)
CAMERA = np.dtype([("location", "3f8"), ("direction", "3f8"), ("right", "3f8"), ("up", "3f8")])
OK, HIT_VERDICT = 0, 1


def load_library():
    path = os.environ.get("PSCN_LIBRARY") or ctypes.util.find_library("pscn")
    if path is None:
        sys.exit("libpscn is not installed where the system looks; PSCN_LIBRARY may say where it is")
    pscn = ctypes.CDLL(path)
    pointer, size, stride = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_ssize_t
    pscn.pscn_version_text.restype = ctypes.c_char_p
    pscn.pscn_scene_messages.restype = ctypes.c_char_p
    pscn.pscn_scene_messages.argtypes = [pointer]
    pscn.pscn_scene_from_file.argtypes = [ctypes.c_char_p, pointer, ctypes.POINTER(pointer)]
    pscn.pscn_scene_camera.argtypes = [pointer, pointer]
    pscn.pscn_scene_free.argtypes = [pointer]
    pscn.pscn_nearest.argtypes = [pointer, size, pointer, stride, pointer, stride]
    return pscn


class Scene:
    """A scene from a file; a ctypes call lets go of Python's lock, so threads may share it."""

    def __init__(self, pscn, path):
        self.pscn, self.handle = pscn, ctypes.c_void_p()
        status = pscn.pscn_scene_from_file(os.fsencode(path), None, ctypes.byref(self.handle))
        messages = pscn.pscn_scene_messages(self.handle).decode()
        if status != OK:
            self.close()
            raise ValueError(messages)
        sys.stderr.write(messages)

    def close(self):
        self.pscn.pscn_scene_free(self.handle)
        self.handle = None

    def camera(self):
        camera = np.zeros((), CAMERA)
        self.pscn.pscn_scene_camera(self.handle, camera.ctypes.data)
        return camera

    def nearest(self, rays):
        """The nearest hit of each ray, an array of RAY of one dimension and any stride."""
        hits = np.empty(rays.shape, HIT)
        status = self.pscn.pscn_nearest(self.handle, rays.size, rays.ctypes.data, rays.strides[0], hits.ctypes.data,
                                        hits.strides[0])
        if status != OK:
            raise ValueError("some rays are not as they should be")
        return hits


def camera_rays(camera, width, height):
    """A ray through the middle of each pixel, from left to right and from top to bottom."""
    t, s = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    rays = np.zeros(width * height, RAY)
    rays["origin"] = camera["location"]
    rays["direction"] = (camera["direction"] + (s.ravel()[:, None] - 0.5) * camera["right"] +
                         (0.5 - t.ravel()[:, None]) * camera["up"])
    rays["t_max"] = np.inf
    return rays


def plot(depth, path):
    """By matplotlib or else gnuplot; the name of what did it."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        shown = pyplot.imshow(np.where(np.isfinite(depth), depth, np.nan), cmap="viridis_r")
        pyplot.colorbar(shown, label="distance")
        pyplot.savefig(path, dpi=120)
        return "matplotlib"
    except ImportError:
        pass
    if shutil.which("gnuplot") is None:
        return None
    height, width = depth.shape
    script = f"""set terminal pngcairo size {width + 160}, {height + 60}
set output '{path}'
set size ratio -1
set cblabel 'distance'
set yrange [{height - 0.5}:-0.5]
set xrange [-0.5:{width - 0.5}]
plot '-' binary array=({width},{height}) format='%float64' with image notitle
"""
    data = np.where(np.isfinite(depth), depth, np.nan).astype("<f8").tobytes()
    subprocess.run(["gnuplot"], input=script.encode() + data, check=True)
    return "gnuplot"


def main():
    if len(sys.argv) not in (2, 3, 5):
        sys.exit(__doc__)
    path = sys.argv[1]
    output = sys.argv[2] if len(sys.argv) > 2 else "depth.png"
    width, height = (int(sys.argv[3]), int(sys.argv[4])) if len(sys.argv) > 4 else (400, 300)
    pscn = load_library()
    scene = Scene(pscn, path)
    rays = camera_rays(scene.camera(), width, height)
    hits = scene.nearest(rays)
    scene.close()
    depth = (hits["t"] * np.linalg.norm(rays["direction"], axis=1)).reshape(height, width)
    hit = hits["verdict"] == HIT_VERDICT
    print(f"{hit.sum()} of {hit.size} rays hit, {(hits['certain'] == 0).sum()} are not proven")
    if hit.any():
        print(f"nearest {depth.min():.6f}, farthest {depth[np.isfinite(depth)].max():.6f}")
    np.save(os.path.splitext(output)[0] + ".npy", depth)
    print(f"plotted by {plot(depth, output) or 'nothing: neither matplotlib nor gnuplot is installed'}")


if __name__ == "__main__":
    main()
