"""The common part of the scripts here: text to numbers, and lists of nets to a scene that pscn and POV-Ray read.

A net is 16 points (x, y, z): four rows of four.
"""
import sys


def read(path):
    try:
        with open(path, encoding="latin-1") as file:
            return file.read()
    except OSError as error:
        fail(path, error.strerror)


def fail(path, text):
    sys.exit(f"{sys.argv[0]}: {path}: {text}")


def number(x):
    return format(x, ".12g")


def write(nets):
    """Writes the nets as a declared Model, and a camera and a light for it."""
    low = [min(p[k] for net in nets for p in net) for k in range(3)]
    high = [max(p[k] for net in nets for p in net) for k in range(3)]
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    size = max(b - a for a, b in zip(low, high)) or 1
    eye = [middle[0] + 0.4 * size, middle[1] + 0.8 * size, middle[2] - 2 * size]
    lamp = [middle[0] - 2 * size, middle[1] + 4 * size, middle[2] - 3 * size]
    vector = lambda p: "<" + ", ".join(number(x) for x in p) + ">"
    print("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#declare Model = union {")
    for net in nets:
        print("  bicubic_patch { type 1 flatness 0 u_steps 5 v_steps 5")
        for row in range(4):
            print("    " + ", ".join(vector(p) for p in net[4 * row : 4 * row + 4]) + ("," if row < 3 else ""))
        print("  }")
    print("}\n#ifndef (Included)")
    print(f"camera {{ location {vector(eye)} look_at {vector(middle)} angle 36 }}")
    print(f"light_source {{ {vector(lamp)}, rgb 1 }}")
    print("object { Model pigment { rgb <0.8, 0.75, 0.65> } finish { ambient 0.15 phong 0.3 } }\n#end")


def run(usage, nets_of):
    """The program: nets_of(path) reads the file that the command line names."""
    if len(sys.argv) != 2:
        sys.exit(usage)
    try:
        nets = nets_of(sys.argv[1])
    except (ValueError, IndexError) as error:
        fail(sys.argv[1], f"not understood: {error}")
    write(nets or fail(sys.argv[1], "it has no bicubic Bezier patches"))
