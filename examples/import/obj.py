#!/usr/bin/env python3
"""Bezier surfaces of an OBJ file as a scene: obj.py FILE.obj > SCENE.pscn

Reads `cstype bezier` surfaces of degree 3 by 3, of any number of patches each. OBJ's coordinates are right-handed: z
changes its sign. Polygons and curves are left out.
"""
import patches


def surface(path, points, words, parameters):
    """The nets of one `surf`: u runs fastest in its list of points, and neighbours share a row."""
    indices = [int(word.split("/")[0]) for word in words[4:]]
    net = [points[i - 1 if i > 0 else len(points) + i] for i in indices]
    across, along = (max(1, len(parameters.get(axis, "01")) - 1) for axis in "uv")
    width = 3 * across + 1
    if len(net) != width * (3 * along + 1):
        patches.fail(path, f"a surface has {len(net)} points, not {width * (3 * along + 1)}")
    for v in range(0, 3 * along, 3):
        for u in range(0, 3 * across, 3):
            yield [net[(v + i) * width + u + j] for i in range(4) for j in range(4)]


def nets_of(path):
    points, nets, kind, degree, surf, parameters = [], [], "", [], None, {}
    for line in patches.read(path).replace("\\\n", " ").splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            if words[0] == "v":
                x, y, z = (float(word) for word in words[1:4])
                points.append((x, y, -z))
            elif words[0] == "cstype":
                kind = " ".join(words[1:])
            elif words[0] == "deg":
                degree = words[1:]
            elif words[0] == "surf":
                surf, parameters = words[1:], {}
            elif words[0] == "parm":
                parameters[words[1]] = words[2:]
            elif words[0] == "end" and surf:
                if kind != "bezier" or degree != ["3", "3"]:
                    patches.fail(path, f"a surface is '{kind}' of degree {' '.join(degree)}, not bezier of 3 3")
                nets.extend(surface(path, points, surf, parameters))
                surf = None
        except (ValueError, IndexError):
            patches.fail(path, f"not understood: {line.strip()}")
    return nets


if __name__ == "__main__":
    patches.run(__doc__, nets_of)
