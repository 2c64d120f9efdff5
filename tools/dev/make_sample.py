#!/usr/bin/python3
"""Draws a sample for `texture`, tileable and the same for everyone: make_sample.py bricks|pebbles OUT.png [SIDE].
Pictures of docs/ and the check of tests/quality/textures.py are made with it."""
import colorsys
import random
import struct
import sys
import zlib


def png(width, height, rows):
    """A picture of 8 bit colours; rows from the top, each a list of (r, g, b) from 0 to 1."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    raw = b"".join(b"\0" + bytes(max(0, min(255, round(255 * v))) for pixel in row for v in pixel) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def smooth(t):
    t = max(0.0, min(1.0, t))
    return t * t * (3 - 2 * t)


class Noise:
    """Values between a lattice's random ones, which repeats after `cells`."""

    def __init__(self, cells, draw):
        self.cells = cells
        self.values = [[draw.random() for _ in range(cells)] for _ in range(cells)]

    def at(self, u, v):
        x, y = u * self.cells, v * self.cells
        i, j = int(x), int(y)
        a, b = smooth(x - i), smooth(y - j)
        value = lambda p, q: self.values[q % self.cells][p % self.cells]
        low = value(i, j) * (1 - a) + value(i + 1, j) * a
        return low * (1 - b) + (value(i, j + 1) * (1 - a) + value(i + 1, j + 1) * a) * b


def bricks(draw):
    columns, lines = 4, 8
    colours = [[colorsys.hsv_to_rgb(draw.uniform(0.01, 0.06), draw.uniform(0.5, 0.75), draw.uniform(0.5, 0.85))
                for _ in range(columns)] for _ in range(lines)]
    coarse, fine = Noise(16, draw), Noise(64, draw)

    def colour(u, v):
        line = int(v * lines)
        x = u * columns + 0.5 * (line % 2) + 0.02 * (coarse.at(u, v) - 0.5)
        column = int(x) % columns
        # Distance to the brick's border, in heights of a brick.
        edge = min((x - int(x)) * 2, (1 - (x - int(x))) * 2, v * lines - line, 1 - (v * lines - line))
        brick = smooth((edge - 0.05 - 0.06 * coarse.at(v, u)) / 0.06)
        grain = 0.78 + 0.28 * fine.at(u, v) + 0.16 * coarse.at(u, v)
        return tuple((0.74 * (1 - brick) + c * brick) * grain for c in colours[line][column])

    return colour


def pebbles(draw):
    count = 9
    stones = [[(draw.uniform(0.15, 0.85), draw.uniform(0.15, 0.85),
                colorsys.hsv_to_rgb(draw.uniform(0.04, 0.14), draw.uniform(0.08, 0.4), draw.uniform(0.45, 0.95)))
               for _ in range(count)] for _ in range(count)]
    fine = Noise(64, draw)

    def colour(u, v):
        x, y = u * count, v * count
        near = []
        for j in range(int(y) - 1, int(y) + 2):
            for i in range(int(x) - 1, int(x) + 2):
                at = stones[j % count][i % count]
                near.append((((i + at[0] - x) ** 2 + (j + at[1] - y) ** 2) ** 0.5, at[2]))
        near.sort(key=lambda entry: entry[0])
        gap = near[1][0] - near[0][0]
        light = (0.18 + 0.82 * smooth((gap - 0.02) / 0.22)) * (0.85 + 0.3 * fine.at(u, v))
        return tuple(c * light for c in near[0][1])

    return colour


def main():
    if len(sys.argv) < 3 or sys.argv[1] not in KINDS:
        sys.exit(__doc__)
    side = int(sys.argv[3]) if len(sys.argv) > 3 else 256
    colour = KINDS[sys.argv[1]](random.Random(7))
    rows = [[colour((x + 0.5) / side, (y + 0.5) / side) for x in range(side)] for y in range(side)]
    with open(sys.argv[2], "wb") as out:
        out.write(png(side, side, rows))


KINDS = {"bricks": bricks, "pebbles": pebbles}
if __name__ == "__main__":
    main()
