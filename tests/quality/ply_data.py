"""Reads .ply files into numpy arrays, for the measures of rings.py and patches.py; other files through `vdb_synth convert`."""
import os
import pathlib
import subprocess
import tempfile

import numpy as np

TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4",
         "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}


class Ply:
    """`points` (n x 3), `normals` (n x 3) or None, `triangles` (m x 3, none: points only), `columns` by name, `comments`."""

    def __init__(self, points, normals=None, triangles=(), columns=None, comments=()):
        self.points = np.asarray(points, float).reshape(-1, 3)
        self.normals = None if normals is None else np.asarray(normals, float).reshape(-1, 3)
        self.triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
        self.columns = columns or {}
        self.comments = list(comments)

    def comment(self, key):
        """What follows `key` in the last comment that begins with it, or None."""
        found = [line[len(key):].strip() for line in self.comments if line.startswith(key + " ")]
        return found[-1] if found else None

    def domain(self):
        """Both corners of the domain (2 x 3), or None."""
        text = self.comment("vdbsynth:domain")
        return None if text is None else np.array(text.split(","), float).reshape(2, 3)

    def part(self, kept):
        """The points for which `kept` is true, with the triangles that lose no corner."""
        number = np.cumsum(kept) - 1
        whole = kept[self.triangles].all(1) if len(self.triangles) else []
        return Ply(self.points[kept], None if self.normals is None else self.normals[kept], number[self.triangles[whole]],
                   {name: values[kept] for name, values in self.columns.items()}, self.comments)


def _element(body, at, count, properties, order):
    """An element without lists: its columns, and where it ends."""
    kind = np.dtype([(name, order + TYPES[words[0]]) for name, words in properties])
    return np.frombuffer(body, kind, count, at), at + kind.itemsize * count


def _faces(body, at, count, properties, order):
    """Corners of triangles and of quads, in halves."""
    if len(properties) != 1 or properties[0][1][0] != "list":
        raise ValueError("faces that have more than a list of corners are not read")
    _, (_, length, corner) = properties[0]
    length, corner = np.dtype(order + TYPES[length]), np.dtype(order + TYPES[corner])
    triangles = []
    while count > 0:
        # Runs of faces with as many corners as the first, for files hold all triangles, then all quads.
        corners = int(np.frombuffer(body, length, 1, at)[0])
        kind = np.dtype([("n", length), ("c", corner, (corners,))])
        run = np.frombuffer(body, kind, min(count, (len(body) - at) // kind.itemsize), at)
        other = np.nonzero(run["n"] != corners)[0]
        run = run[:other[0]] if len(other) else run
        for k in range(1, corners - 1):
            triangles.append(run["c"][:, [0, k, k + 1]].astype(np.int64))
        at, count = at + kind.itemsize * len(run), count - len(run)
    return (np.concatenate(triangles) if triangles else np.zeros((0, 3), np.int64)), at


def read_ply(path):
    """A binary .ply as vdb_synth writes it. @raise ValueError"""
    content = pathlib.Path(path).read_bytes()
    head, mark, body = content.partition(b"end_header\n")
    lines = head.decode("utf-8", "replace").splitlines()
    if not mark or lines[0] != "ply" or not lines[1].startswith("format binary_"):
        raise ValueError(f"{path}: no binary .ply")
    order = "<" if "little" in lines[1] else ">"
    elements, comments = [], []
    for line in lines[2:]:
        words = line.split()
        if line.startswith("comment "):
            comments.append(line[8:].strip())
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append((words[-1], words[1:-1]))
    at, rows, triangles = 0, None, ()
    for name, count, properties in elements:
        if name == "face":
            triangles, at = _faces(body, at, count, properties, order)
        else:
            values, at = _element(body, at, count, properties, order)
            rows = values if name == "vertex" else rows
    if rows is None or not all(axis in rows.dtype.names for axis in "xyz"):
        raise ValueError(f"{path}: no points")
    columns = {name: rows[name].astype(float) if rows.dtype[name].kind == "f" else rows[name].astype(np.int64) for name in rows.dtype.names}
    points = np.stack([columns.pop(axis) for axis in "xyz"], 1)
    names = ("nx", "ny", "nz")
    normals = np.stack([columns.pop(name) for name in names], 1) if all(name in columns for name in names) else None
    return Ply(points, normals, triangles, columns, comments)


def write_ply(path, ply):
    """Points, normals, whole-numbered (int) and other (float) columns and triangles."""
    kind, arrays = [(axis, "<f4") for axis in "xyz"], list(ply.points.T)
    if ply.normals is not None:
        kind += [(name, "<f4") for name in ("nx", "ny", "nz")]
        arrays += list(ply.normals.T)
    for name, values in ply.columns.items():
        kind.append((name, "<i4" if values.dtype.kind in "iu" else "<f4"))
        arrays.append(values)
    rows = np.zeros(len(ply.points), np.dtype(kind))
    for (name, _), values in zip(kind, arrays):
        rows[name] = values
    head = ["ply", "format binary_little_endian 1.0"] + ["comment " + line for line in ply.comments] + [f"element vertex {len(rows)}"]
    head += [f"property {'int' if code == '<i4' else 'float'} {name}" for name, code in kind]
    body = rows.tobytes()
    if len(ply.triangles):
        head += [f"element face {len(ply.triangles)}", "property list uchar uint vertex_indices"]
        faces = np.zeros(len(ply.triangles), np.dtype([("n", "u1"), ("c", "<u4", (3,))]))
        faces["n"], faces["c"] = 3, ply.triangles
        body += faces.tobytes()
    pathlib.Path(path).write_bytes("\n".join(head + ["end_header", ""]).encode() + body)


def load(path, tool="vdb_synth"):
    """A .ply, or any other model as the mesh that `vdb_synth convert` makes of it. @raise RuntimeError (its message)"""
    if str(path).endswith(".ply"):
        return read_ply(path)
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.ply")
        made = subprocess.run([tool, "convert", str(path), "-o", mesh, "-q"], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            raise RuntimeError(made.stderr.strip())
        return read_ply(mesh)


def pairs_within(points, radius):
    """Yields arrays of pairs (a, b), a != b, that together hold every two points within `radius` once. Cost O(points x neighbours)."""
    cell = np.floor((points - points.min(0)) / radius).astype(np.int64) + 1
    size = cell.max(0) + 2
    key = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    order = np.argsort(key, kind="stable")
    cells, first, count = np.unique(key[order], return_index=True, return_counts=True)
    steps = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) >= (0, 0, 0)]
    for x, y, z in steps:
        other = cells + (x * size[1] + y) * size[2] + z
        at = np.minimum(np.searchsorted(cells, other), len(cells) - 1)
        met = np.nonzero(cells[at] == other)[0]
        # Every point of a cell with every one of the other.
        na, nb = count[met], count[at[met]]
        total = na * nb
        which = np.repeat(np.arange(len(met)), total)
        within = np.arange(total.sum()) - np.repeat(np.cumsum(total) - total, total)
        a = order[first[met][which] + within // nb[which]]
        b = order[first[at[met]][which] + within % nb[which]]
        kept = ((points[a] - points[b]) ** 2).sum(1) <= radius * radius
        if (x, y, z) == (0, 0, 0):
            kept &= a < b
        yield a[kept], b[kept]


def joined(count, pairs):
    """The component of each of `count` elements, numbered from 0, that pairs (a, b) join."""
    label = np.arange(count)
    pairs = [(np.asarray(a), np.asarray(b)) for a, b in pairs if len(a)]
    a = np.concatenate([p[0] for p in pairs]) if pairs else np.zeros(0, int)
    b = np.concatenate([p[1] for p in pairs]) if pairs else np.zeros(0, int)
    while len(a):
        # Roots hang on the smaller of two, then every element on its root.
        low, high = np.minimum(label[a], label[b]), np.maximum(label[a], label[b])
        np.minimum.at(label, high, low)
        while True:
            shorter = label[label]
            if (shorter == label).all():
                break
            label = shorter
        apart = label[a] != label[b]
        a, b = a[apart], b[apart]
    return np.unique(label, return_inverse=True)[1]
