#!/usr/bin/python3
"""Draws coloured points with normals, a picture beside the other: splat_points.py OUT.png FILE.ply... [--size N] [--view X,Y,Z]
[--up X,Y,Z]. Every point is a disc; the nearest to the eye is seen. Needs numpy. For pictures of docs/: points of `texture`
are many, and `render` draws level sets."""
import argparse
import struct
import zlib

import numpy as np

KINDS = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}


def read(path):
    """Points, normals and colours (0 to 1) of a binary little-endian .ply whose vertices come first."""
    with open(path, "rb") as file:
        content = file.read()
    at = content.index(b"end_header\n") + len(b"end_header\n")
    element, count, properties = None, 0, []
    for words in (line.split() for line in content[:at].decode("latin1").splitlines()):
        if words[0] == "element":
            element = words[1]
            count = int(words[2]) if element == "vertex" else count
        elif words[0] == "property" and element == "vertex":
            properties.append((words[2], KINDS[words[1]]))
    rows = np.frombuffer(content, np.dtype(properties), count, at)
    several = lambda *names: np.stack([rows[n].astype(float) for n in names], axis=1)
    white = 255 if rows["red"].dtype == np.uint8 else 1
    return several("x", "y", "z"), several("nx", "ny", "nz"), several("red", "green", "blue") / white


def splat(points, normals, colours, size, view, up):
    view, right = view / np.linalg.norm(view), np.cross(up, view)
    right /= np.linalg.norm(right)
    above = np.cross(view, right)
    flat = points @ np.stack([right, above], axis=1)
    scale = 0.97 * size / np.ptp(flat, axis=0).max()
    spacing = scale * np.sqrt(3 * np.prod(np.ptp(flat, axis=0)) / len(points))
    flat = (flat - (flat.max(axis=0) + flat.min(axis=0)) / 2) * scale * [1, -1] + size / 2
    seen = normals @ view > 0
    light = 0.3 + 0.7 * np.clip(normals @ (0.8 * view + 0.5 * above - 0.35 * right), 0, 1)
    flat, colours, near = flat[seen], np.clip(colours * light[:, None], 0, 1)[seen], (points @ view)[seen] * scale
    picture, depth = np.ones((size * size, 3)), np.full(size * size, -np.inf)
    radius = max(1, int(np.ceil(0.7 * spacing)))
    for dy in range(-radius, radius + 1):
        for dx in range(-radius, radius + 1):
            away = dx * dx + dy * dy
            if away > radius * radius:
                continue
            at = (flat + [dx, dy]).astype(int)
            inside = np.all((at >= 0) & (at < size), axis=1)
            pixel, height = at[inside, 1] * size + at[inside, 0], near[inside] - 0.15 * away
            order = np.argsort(height, kind="stable")  # the last that is written stays: the nearest
            best, colour = np.full(size * size, -np.inf), np.zeros((size * size, 3))
            best[pixel[order]] = height[order]
            colour[pixel[order]] = colours[inside][order]
            nearer = best > depth
            depth[nearer], picture[nearer] = best[nearer], colour[nearer]
    return (picture.reshape(size, size, 3) * 255 + 0.5).astype(np.uint8)


def write(path, picture):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    height, width, _ = picture.shape
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    raw = b"".join(b"\0" + line.tobytes() for line in picture)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def vector(text):
    return np.array([float(v) for v in text.split(",")])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("file", nargs="+")
    parser.add_argument("--size", type=int, default=480)
    parser.add_argument("--view", type=vector, default=vector("0.5,-0.8,0.45"), help="from the model to the eye")
    parser.add_argument("--up", type=vector, default=vector("0,0,1"))
    a = parser.parse_args()
    write(a.out, np.concatenate([splat(*read(f), 2 * a.size, a.view, a.up).reshape(a.size, 2, a.size, 2, 3).mean(axis=(1, 3))
                                 .astype(np.uint8) for f in a.file], axis=1))


if __name__ == "__main__":
    main()
