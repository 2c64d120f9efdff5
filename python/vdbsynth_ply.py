"""Triangles and quads with colours as binary .ply, for hosts on the way to the program and back. Needs numpy, which Blender and Houdini bring."""
import numpy as np

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4", "double": "f8",
         "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"}


def write_ply(path, points, faces, colours=None):
    """points [n, 3]; faces: lists of vertex numbers; colours [n, 3] from 0 to 1, or None."""
    names = ["x", "y", "z"] + (["red", "green", "blue"] if colours is not None else [])
    kinds = ["<f4"] * 3 + (["u1"] * 3 if colours is not None else [])
    table = np.zeros(len(points), dtype=list(zip(names, kinds)))
    for axis, name in enumerate("xyz"):
        table[name] = np.asarray(points, dtype=np.float64)[:, axis]
    if colours is not None:
        levels = np.clip(np.rint(np.asarray(colours, dtype=np.float64)[:, :3] * 255), 0, 255)
        for channel, name in enumerate(("red", "green", "blue")):
            table[name] = levels[:, channel]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property {'float' if kind == '<f4' else 'uchar'} {name}" for name, kind in zip(names, kinds)]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(table.tobytes())
        for face in faces:
            file.write(bytes([len(face)]) + np.asarray(face, dtype="<i4").tobytes())


def write_off(path, points, faces):
    """points [n, 3]; faces: lists of vertex numbers. For commands that take a .ply as points."""
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        file.writelines("%.9g %.9g %.9g\n" % tuple(point) for point in points)
        file.writelines(f"{len(face)} {' '.join(str(corner) for corner in face)}\n" for face in faces)


def read_off(path):
    """(points [n, 3], faces) of an .off as the program writes it; colours are left out."""
    with open(path, encoding="ascii") as file:
        if file.readline().strip() not in ("OFF", "COFF"):
            raise ValueError(f"{path}: is no .off")
        count, faces, _ = (int(word) for word in file.readline().split())
        points = np.array([file.readline().split()[:3] for _ in range(count)], dtype=np.float64).reshape(-1, 3)
        rows = [[int(word) for word in file.readline().split()] for _ in range(faces)]
    return points, [tuple(row[1:1 + row[0]]) for row in rows]


def read_ply(path):
    """(points [n, 3], faces, {attribute: [n, channels]}) of a binary or ASCII little-endian .ply as the program writes it."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements, binary = [], True
    for line in data[:end].decode("ascii", "replace").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            binary = words[1] == "binary_little_endian"
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    if not binary:
        raise ValueError(f"{path}: is no binary little-endian .ply")
    at, points, faces, attributes = end, np.zeros((0, 3)), [], {}
    for name, count, properties in elements:
        if name == "vertex":
            table = np.frombuffer(data, dtype=[(p[1], "<" + TYPES[p[0]]) for p in properties], count=count, offset=at)
            at += table.nbytes
            points = np.stack([table[axis] for axis in "xyz"], axis=1).astype(np.float64)
            attributes = {p[1]: table[p[1]] for p in properties if p[1] not in "xyz"}
        elif name == "face":
            faces, at = read_faces(data, at, count, properties)
    return points, faces, attributes


def read_faces(data, at, count, properties):
    """All with as many corners as the first, as nearly all files have, are read at once."""
    length, number = "<" + TYPES[properties[0][1]], "<" + TYPES[properties[0][2]]
    rest = [(p[1], "<" + TYPES[p[0]]) for p in properties[1:]]
    faces = []
    while len(faces) < count:
        corners = int(np.frombuffer(data, dtype=length, count=1, offset=at)[0])
        row = np.dtype([("count", length), ("face", number, (corners,))] + rest)
        most = min(count - len(faces), (len(data) - at) // row.itemsize)
        table = np.frombuffer(data, dtype=row, count=most, offset=at)
        same = most if (table["count"] == corners).all() else int(np.argmax(table["count"] != corners))
        faces += table["face"][:same].tolist()
        at += same * row.itemsize
        if same == 0:
            raise ValueError("faces of no corners")
    return faces, at


def colours_of(attributes):
    """[n, 3] from 0 to 1, or None."""
    for names, scale in ((("red", "green", "blue"), None), (("Cd_0", "Cd_1", "Cd_2"), 1.0)):
        if all(name in attributes for name in names):
            table = np.stack([attributes[name] for name in names], axis=1)
            return table.astype(np.float64) / (255.0 if table.dtype == np.uint8 else scale or 1.0)
    return None
