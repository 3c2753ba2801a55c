#!/usr/bin/env python3
"""Newell's teapot and its like as a scene: bpt.py FILE > SCENE.pscn

Reads .bpt files, whose patches are a line of the two degrees and then the points, and Newell's own form: the number of
patches, a line of 16 numbers of points for each, the number of points, and these. In both z is up; y is here.
"""
import re

import patches


def nets_of(path):
    words = re.split(r"[\s,]+", patches.read(path).strip())
    lines = [re.split(r"[\s,]+", line.strip()) for line in patches.read(path).splitlines() if line.strip()]
    try:
        numbers = [float(word) for word in words if word]
        count = int(numbers[0])
        indexed = len(lines[1]) == 16
        at = 1
        nets = []
        if indexed:
            rows = [[int(x) for x in numbers[at + 16 * k : at + 16 * k + 16]] for k in range(count)]
            at += 16 * count + 1
            points = [tuple(numbers[k : k + 3]) for k in range(at, at + 3 * int(numbers[at - 1]), 3)]
            nets = [[points[index - 1] for index in row] for row in rows]
        for _ in range(0 if indexed else count):
            if numbers[at : at + 2] != [3, 3]:
                patches.fail(path, "a patch is not of degree 3 by 3")
            nets.append([tuple(numbers[k : k + 3]) for k in range(at + 2, at + 50, 3)])
            at += 50
    except (ValueError, IndexError):
        patches.fail(path, "this is no list of patches")
    if not nets or any(len(point) != 3 for net in nets for point in net):
        patches.fail(path, "the file ends within a patch")
    return [[(x, z, y) for x, y, z in net] for net in nets]


if __name__ == "__main__":
    patches.run(__doc__, nets_of)
