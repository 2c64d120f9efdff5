"""Reported STL, OFF and PLY files: each row of the list by its number, and files of the same kinds."""
import json
import math
import random
import struct
import subprocess
import unittest

from reported import Reported
from support import PROGRAM

BOX = [((0, 2, 3), (0, 3, 1)), ((4, 5, 7), (4, 7, 6)), ((0, 1, 5), (0, 5, 4)),
       ((2, 6, 7), (2, 7, 3)), ((0, 4, 6), (0, 6, 2)), ((1, 3, 7), (1, 7, 5))]


def box_facets(size=10):
    """Of a cube from 0 to `size`."""
    corner = [(size * (i & 1), size * (i >> 1 & 1), size * (i >> 2 & 1)) for i in range(8)]
    return [tuple(corner[i] for i in t) for pair in BOX for t in pair]


def binary(facets, count=None, header=b"exporter", order="<", attribute=0):
    count = len(facets) if count is None else count
    text = header.ljust(80, b"\0") + struct.pack(order + "I", count)
    for facet in facets:
        text += struct.pack(order + "12fH", 0, 0, 0, *[x for p in facet for x in p], attribute)
    return text


def ascii_facets(facets, form="%g"):
    text = ""
    for facet in facets:
        text += "facet normal 0 0 0\n outer loop\n"
        for p in facet:
            text += "  vertex " + " ".join(form % x for x in p) + "\n"
        text += " endloop\nendfacet\n"
    return text


def sphere(count, radius=2, centre=(0, 0, 0)):
    """Points spread evenly on a sphere, with their normals."""
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        side, turn = math.sqrt(1 - z * z), i * math.pi * (3 - math.sqrt(5))
        n = (side * math.cos(turn), side * math.sin(turn), z)
        yield tuple(c + radius * x for c, x in zip(centre, n)), n


class Files(Reported):
    """The rows of the list."""

    def read_as(self, name, volume, bounds=None, says="", tolerance=0.02):
        done = self.convert(name)
        self.assertEqual(done.code, 0, done.said)
        self.near(done.volume, volume, tolerance)
        for value, right in zip(done.bounds, bounds or []):
            self.assertAlmostEqual(value, right, delta=0.05)
        self.assertIn(says, done.said)
        if not says:
            self.assertEqual(done.said, "")

    def test_01_upper_case(self):
        self.read_as("01-stl-uppercase.stl", 61.024, [-1.9685] * 3 + [1.9685] * 3)

    def test_02_blank_before_solid(self):
        self.read_as("02-stl-leading-space.stl", 8, [0] * 3 + [2] * 3)

    def test_03_mixed_case(self):
        self.read_as("03-stl-mixed-case.stl", 2.343)
        self.assertEqual(self.info("03-stl-mixed-case.stl")["faces"], 288)

    def test_04_solid_header_and_one_byte_too_many(self):
        self.read_as("04-stl-solid-header-odd-byte.stl", 2.343, says="1 byte behind the last of 288 triangles")
        self.assertEqual(self.info("04-stl-solid-header-odd-byte.stl")["faces"], 288)

    def test_05_count_left_zero(self):
        self.read_as("05-stl-count-zero.stl", 1000, says="the size of the file says 12 triangles")

    def test_07_magics_colours(self):
        header = b"Magics COLOR=\xff\x80\x40\xff,MATERIAL=" + bytes(12)
        self.read_as(self.write("magics.stl", binary(box_facets(), header=header, attribute=0x801F)), 1000,
                     says="12 triangles with attribute words, such as colours, which are not read")

    def test_08_trailing_bytes(self):
        self.read_as("08-stl-trailing-bytes.stl", 1000, says="22 bytes behind the last of 12 triangles")

    def test_09_glued_off_header(self):
        self.read_as("09-off-header-glued.off", 12.317, says="colours of 6 faces are not read")
        self.assertEqual(self.info("09-off-header-glued.off")["faces"], 6)

    def test_20_unused_vertices_that_are_not_finite(self):
        self.read_as("20-ply-unused-nan.ply", 33.42, says="25 vertices without finite coordinates")

    def test_21_double_points_far_out(self):
        info = self.info("21-ply-utm-double-points.ply")
        self.assertEqual(info["points"], 20000)
        low, high = info["bounds_min"], info["bounds_max"]
        for axis in range(3):
            self.assertAlmostEqual(high[axis] - low[axis], 4, delta=0.01)
            self.assertNotEqual(low[axis] % 0.5, 0)

    def test_24_gaussian_splats(self):
        names = ["x", "y", "z", "nx", "ny", "nz"] + [f"f_rest_{i}" for i in range(45)] + \
                ["f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
        head = "ply\nformat binary_little_endian 1.0\nelement vertex 8000\n" + \
               "".join(f"property float {name}\n" for name in names) + "end_header\n"
        body = b"".join(struct.pack(f"<{len(names)}f", *p, *[0] * (len(names) - 3)) for p, n in sphere(8000))
        done = self.convert(self.write("splats.ply", head.encode() + body))
        self.assertEqual(done.code, 0, done.said)
        self.near(done.volume, 33.5, 0.03)
        self.assertIn("8000 of 8000 normals have no length", done.said)

    def test_26_more_on_a_line_than_declared(self):
        self.assertEqual(self.info("26-ply-vcg-ascii-extra-list.ply")["faces"], 1000)
        done = self.convert("26-ply-vcg-ascii-extra-list.ply")
        self.assertEqual(done.code, 0, done.said)
        self.assertIn("1000 lines have more words than the header declares", done.said)

    def test_27_old_mac_line_ends(self):
        self.read_as("27-ply-mac-cr.ply", 1)

    def test_82_big_endian_colours(self):
        done = self.convert("82-ply-mesh-colours-big-endian.ply")
        self.assertEqual(done.code, 0, done.said)
        with open(self.path("o.ply"), "rb") as file:
            head, body = file.read().split(b"end_header\n", 1)
        names = [line.split()[-1] for line in head.decode().splitlines() if line.startswith("property") and " list " not in line]
        rows = int(next(l for l in head.decode().splitlines() if l.startswith("element vertex")).split()[-1])
        form = "<" + "".join({"float": "f", "uchar": "B", "double": "d", "ushort": "H"}[line.split()[1]] for line in
                             head.decode().splitlines() if line.startswith("property") and " list " not in line)
        vertices = [dict(zip(names, v)) for v in struct.iter_unpack(form, body[:rows * struct.calcsize(form)])]
        top, bottom = max(vertices, key=lambda v: v["z"]), min(vertices, key=lambda v: v["z"])
        self.assertGreater(top["red"], 200)
        self.assertGreater(bottom["blue"], 200)
        self.assertLess(top["blue"], 60)


class Kinds(Reported):
    """Files of the same kinds, by other writers."""

    def read_as(self, name, volume, says=""):
        done = self.ok("info", name, "--json")
        self.near(json.loads(done.stdout)["signed_volume"], volume, 1e-6)
        self.assertIn(says, done.stderr)
        if not says:
            self.assertEqual(done.stderr, "")

    def refused(self, name, says):
        done = self.fails(3, says, "info", name)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_ascii_stl(self):
        facets = box_facets()
        plain = "solid box\n" + ascii_facets(facets) + "endsolid box\n"
        silent = [plain.upper(), "\t " + plain, "\n\n" + plain, "\ufeff" + plain, plain.replace("\n", "\r"),
                  plain.replace("\n", "\r\n"), plain.replace("endloop", "end loop").replace("endfacet", "End Facet"),
                  "solid a\n" + ascii_facets(facets[:4]) + "endsolid a\nsolid b\n" + ascii_facets(facets[4:]) + "endsolid b",
                  "solid box\n" + ascii_facets(facets, "%.17e") + "endsolid box\n"]
        for number, text in enumerate(silent):
            with self.subTest(number=number):
                self.read_as(self.write("a.stl", text.encode()), 1000)
        self.read_as(self.write("b.stl", "solid box\n" + ascii_facets(facets)), 1000, says="warning: ")
        self.read_as(self.write("c.stl", plain.replace("vertex 10", "vertex 10,0")), 1000, says="decimal commas")
        for size in range(20, len(plain) - 20, 193):
            done = self.run_tool("info", self.write("d.stl", plain[:size]))
            self.assertIn("truncated" if done.returncode else "whole facets are read, more may be missing", done.stderr)

    def test_binary_stl(self):
        facets = box_facets()
        whole = binary(facets)
        self.read_as(self.write("a.stl", binary(facets, header=b"solid in name")), 1000)
        self.read_as(self.write("a.stl", binary(facets, 0xFFFFFFFF)), 1000, says="says 12 triangles")
        self.read_as(self.write("a.stl", binary(facets, 3)), 1000, says="warning: ")
        self.read_as(self.write("a.stl", binary(facets, 5000)), 1000, says="the file has 12 triangles")
        self.read_as(self.write("a.stl", binary(facets, order=">")), 1000, says="big-endian")
        self.read_as(self.write("a.stl", whole + b"\0" * 100), 1000, says="100 bytes behind")
        self.read_as(self.write("a.stl", binary(facets[:3]) + binary(facets[3:])), 1000, says="2 binary solids")
        for size in (len(whole) - 1, len(whole) - 50, len(whole) // 2, 90):
            there = (size - 84) // 50
            self.refused(self.write("cut.stl", whole[:size]), f"claims 12 triangles, {there} of them are there")

    def test_messages_hold_no_raw_bytes(self):
        junk = bytes([0x1B, 0x5B, 0x32, 0x4A, 0xFF, 0x80, 0xC3, 0x01])
        files = {"a.stl": b"solid x\n facet normal 0 0 0\nouter loop\nvertex 0 " + junk, "a.off": b"OFF\n3 1 0\n" + junk + b" 0 0\n",
                 "b.off": junk, "a.ply": b"ply\nformat " + junk + b"\n", "a.obj": b"v 0 " + junk + b" 0\n", "a.xyz": junk + b" 1 2\n",
                 "a.pcd": junk + b"\n", "a.mesh": b"MeshVersionFormatted " + junk, "a.stl.gz": b"\x1f\x8b" + junk}
        for name, content in files.items():
            with self.subTest(name=name):
                done = subprocess.run([PROGRAM, "info", self.write(name, content)], capture_output=True)
                self.assertEqual(done.returncode, 3, done.stderr)
                text = done.stderr.decode("utf-8")  # strict
                self.assertTrue(text.rstrip("\n").isprintable(), repr(text))

    def test_changed_bytes_never_crash(self):
        facets = box_facets()
        wholes = {"m.stl": binary(facets), "n.stl": ("solid\n" + ascii_facets(facets) + "endsolid").encode(),
                  "m.off": b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"}
        for name, whole in wholes.items():
            for seed in range(8):
                draw = random.Random(seed)
                content = bytearray(whole)
                for _ in range(draw.choice([1, 3, 20])):
                    content[draw.randrange(len(content))] = draw.randrange(256)
                done = self.run_tool("info", self.write(name, bytes(content)), timeout=20)
                self.assertIn(done.returncode, (0, 1, 3), f"{name} {seed}: {done.stderr}")
                self.assertNotIn("crashed", done.stderr)


if __name__ == "__main__":
    unittest.main()
