#!/usr/bin/env python3
"""RenderMan's bicubic patches as a scene: rib.py FILE.rib > SCENE.pscn

Reads `Patch "bicubic"` and `PatchMesh "bicubic"`, periodic or not, of the bases bezier, b-spline, catmull-rom, hermite
and power or of 16 numbers, and the transforms around them. Everything else is left out. Rational points ("Pw") are
refused.
"""
import math
import re

import patches

# Rows: the powers u^3 to 1; columns: the four points. The step from one patch of a mesh to the next.
BASES = {
    "bezier": ([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]], 3),
    "b-spline": ([[x / 6 for x in row] for row in [[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]], 1),
    "catmull-rom": ([[x / 2 for x in row] for row in [[-1, 3, -3, 1], [2, -5, 4, -1], [-1, 0, 1, 0], [0, 2, 0, 0]]], 1),
    "hermite": ([[2, 1, -2, 1], [-3, -2, 3, -1], [0, 1, 0, 0], [1, 0, 0, 0]], 2),
    "power": ([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], 4),
}
TO_BEZIER = [[0, 0, 0, 1], [0, 0, 1 / 3, 1], [0, 1 / 3, 2 / 3, 1], [1, 1, 1, 1]]
IDENTITY = [[float(i == j) for j in range(4)] for i in range(4)]
TOKEN = re.compile(r'"([^"]*)"|([\[\]])|(#[^\n]*)|([^\s\[\]"#]+)')


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(len(b[0]))] for i in range(4)]


def moved(point, matrix):
    return tuple(sum(c * matrix[k][j] for k, c in enumerate((*point, 1))) for j in range(3))


def rotation(angle, x, y, z):
    """RenderMan's Rotate, for row vectors."""
    length = math.sqrt(x * x + y * y + z * z)
    x, y, z, s, c = x / length, y / length, z / length, math.sin(math.radians(angle)), math.cos(math.radians(angle))
    t = 1 - c
    return [
        [t * x * x + c, t * x * y + s * z, t * x * z - s * y, 0],
        [t * x * y - s * z, t * y * y + c, t * y * z + s * x, 0],
        [t * x * z + s * y, t * y * z - s * x, t * z * z + c, 0],
        [0, 0, 0, 1],
    ]


def statements(text):
    """The words of each statement: its name, then strings, numbers and lists of these."""
    words, inner = [], None
    for string, bracket, comment, word in TOKEN.findall(text):
        if comment:
            continue
        if bracket:
            if bracket == "]" and inner is not None:
                words.append(inner)
            inner = [] if bracket == "[" else None
            continue
        if word and word[0].isalpha() and inner is None:
            if words:
                yield words
            words = [word]
            continue
        (words if inner is None else inner).append(float(word) if word else string)
    if words:
        yield words


def mesh_nets(points, across, along, bases):
    """The Bezier nets of a mesh of points, u running fastest. Each of across and along: how many points, periodic?"""
    (columns, wraps_u), (rows, wraps_v) = across, along
    starts = []
    for (count, wraps), (_, step) in zip((across, along), bases):
        starts.append(range(0, count if wraps else count - 3, step))
    change = [product(TO_BEZIER, matrix) for matrix, _ in bases]
    for v in starts[1]:
        for u in starts[0]:
            grid = [[points[(v + i) % rows * columns + (u + j) % columns] for j in range(4)] for i in range(4)]
            net = [[[0.0] * 3 for _ in range(4)] for _ in range(4)]
            for k in range(3):
                part = product(change[1], [[p[k] for p in row] for row in grid])
                part = product(part, [list(column) for column in zip(*change[0])])
                for i in range(4):
                    for j in range(4):
                        net[i][j][k] = part[i][j]
            yield [tuple(p) for row in net for p in row]


def basis(name, step):
    if isinstance(name, list):
        return [name[4 * i : 4 * i + 4] for i in range(4)], int(step)
    return BASES[name][0], int(step)


def nets_of(path):
    nets, stack = [], []
    matrix, bases = IDENTITY, [BASES["bezier"], BASES["bezier"]]
    for words in statements(patches.read(path)):
        name, values = words[0], words[1:]
        if len(values) == 1 and isinstance(values[0], list):
            values = values[0]
        try:
            if name in ("TransformBegin", "AttributeBegin", "WorldBegin"):
                stack.append((matrix, bases))
                matrix = IDENTITY if name == "WorldBegin" else matrix  # the camera's is not the model's
            elif name in ("TransformEnd", "AttributeEnd", "WorldEnd"):
                matrix, bases = stack.pop()
            elif name == "Translate":
                matrix = product([*IDENTITY[:3], [*values, 1]], matrix)
            elif name == "Scale":
                matrix = product([[values[i] * (i == j) if i < 3 else float(j == 3) for j in range(4)] for i in range(4)], matrix)
            elif name == "Rotate":
                matrix = product(rotation(*values), matrix)
            elif name in ("ConcatTransform", "Transform"):
                given = [values[4 * i : 4 * i + 4] for i in range(4)]
                matrix = product(given, matrix) if name == "ConcatTransform" else given
            elif name == "Basis":
                bases = [basis(*values[:2]), basis(*values[2:4])]
            elif name in ("Patch", "PatchMesh") and values[0] == "bicubic":
                if "P" not in values:
                    patches.fail(path, f"a {name} has no points \"P\"; rational ones are not supported")
                numbers = values[values.index("P") + 1]
                points = [moved(numbers[k : k + 3], matrix) for k in range(0, len(numbers), 3)]
                sides = ((4, False), (4, False))
                if name == "PatchMesh":
                    sides = tuple((int(values[k]), values[k + 1] == "periodic") for k in (1, 3))
                if len(points) != sides[0][0] * sides[1][0]:
                    patches.fail(path, f"a {name} has {len(points)} points, not {sides[0][0]} x {sides[1][0]}")
                nets.extend(mesh_nets(points, *sides, bases))
        except (ValueError, IndexError, KeyError, TypeError):
            patches.fail(path, f"not understood: {name} ...")
    return nets


if __name__ == "__main__":
    patches.run(__doc__, nets_of)
