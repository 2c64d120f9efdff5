#!/usr/bin/python3
"""Twists a mesh about its longest side: a pose for tests, pictures and benchmarks of surfaces that deform.
Usage: twist_mesh.py IN.obj OUT.obj DEGREES, which its one end is turned against the other."""
import math
import pathlib
import sys


def twisted(text, degrees):
    """The text of an .obj whose vertices are twisted about the longest side of their box; faces stay."""
    lines = text.split("\n")
    vertices = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    box = [(min(v[k] for v in vertices), max(v[k] for v in vertices)) for k in range(3)]
    along = max(range(3), key=lambda k: box[k][1] - box[k][0])
    across = [(along + 1) % 3, (along + 2) % 3]
    middle = [sum(box[k]) / 2 for k in across]
    low, high = box[along]
    moved = iter(vertices)
    for number, line in enumerate(lines):
        if not line.startswith("v "):
            continue
        place = list(next(moved))
        angle = math.radians(degrees) * ((place[along] - low) / (high - low) - 0.5)
        a, b = (place[k] - m for k, m in zip(across, middle))
        place[across[0]] = middle[0] + math.cos(angle) * a - math.sin(angle) * b
        place[across[1]] = middle[1] + math.sin(angle) * a + math.cos(angle) * b
        lines[number] = "v %.7f %.7f %.7f" % tuple(place)
    return "\n".join(lines)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[2]).write_text(twisted(pathlib.Path(sys.argv[1]).read_text(), float(sys.argv[3])))
