"""Reported files: OBJ and faces of many corners."""
import math
import random
import unittest

from reported import Reported


def ring(corners, radius, z):
    return [(radius * math.cos(2 * math.pi * i / corners), radius * math.sin(2 * math.pi * i / corners), z)
            for i in range(corners)]


def prism(outline, height, face="f {}", shift=1):
    """OBJ text of a prism over a counter-clockwise outline: two faces of all its corners, and quads around."""
    n = len(outline)
    rows = [f"v {x:.9f} {y:.9f} {z}" for z in (0, height) for x, y, *_ in outline]
    faces = [[n - i for i in range(n)], [n + i + 1 for i in range(n)]]
    faces += [[i + 1, (i + 1) % n + 1, n + (i + 1) % n + 1, n + i + 1] for i in range(n)]
    return "\n".join(rows + [face.format(" ".join(map(str, corners))) for corners in faces]) + "\n"


def shoelace(outline):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1])) / 2


class Polygons(Reported):
    def test_11_wall_with_a_hole_of_concave_polygons(self):
        info = self.info("11-obj-nonconvex-wallhole.obj")
        self.near(info["area"], 721.4213562, 1e-6)
        self.near(info["signed_volume"], 1066.6666667, 1e-6)
        self.assertTrue(info["closed_manifold"])
        done = self.convert("11-obj-nonconvex-wallhole.obj")
        self.assertEqual(done.code, 0)
        self.assertNotIn("warning", done.said)
        self.near(done.volume, 1066.67)

    def test_12_letter_with_caps_of_many_corners(self):
        info = self.info("12-obj-c-shape-ngon-caps.obj")
        self.near(info["area"], 842.378, 1e-4)
        self.near(info["signed_volume"], 890.26, 1e-4)
        done = self.convert("12-obj-c-shape-ngon-caps.obj")
        self.near(done.volume, 890.26)
        self.near(done.area, 842.5, 0.03)

    def test_13_one_concave_polygon(self):
        info = self.info("13-obj-concave66.obj")
        self.near(info["area"], 0.2455, 1e-4)
        self.assertEqual((info["faces"], info["non_manifold_edges"]), (64, 0))
        self.fails(1, "a sheet with 64 open edges", "convert", self.file("13-obj-concave66.obj"), "-o", "o.ply")

    def test_16_cylinder_with_caps_of_400_corners(self):
        info = self.info("16-obj-400gon.obj")
        self.near(info["signed_volume"], 1256.59, 1e-5)
        self.assertTrue(info["closed_manifold"])
        done = self.convert("16-obj-400gon.obj")
        self.assertNotIn("warning", done.said)
        self.near(done.volume, 1256.59)

    def test_25_ply_with_concave_polygons_that_are_not_flat(self):
        # The area of all faces as seen along their normals: triangles of those that are not flat have more.
        info = self.info("25-ply-shark-10gon.ply")
        self.near(info["area"], 8429.98, 0.002)
        self.assertEqual(info["open_edges"], 0)

    def test_87_tall_cylinder_of_256_corners(self):
        self.near(self.info("87-obj-256gon-tall.obj")["signed_volume"], 12565.1, 1e-5)
        done = self.convert("87-obj-256gon-tall.obj")
        self.assertNotIn("warning", done.said)
        self.near(done.volume, 12564)

    def test_88_off_with_400_corners(self):
        self.near(self.info("88-off-400gon.off")["signed_volume"], 1256.59, 1e-5)
        self.near(self.convert("88-off-400gon.off").volume, 1256.6)

    def test_prisms_over_random_outlines_in_obj_off_and_ply(self):
        for seed, corners in enumerate((5, 12, 66, 255, 256, 257, 400, 1000)):
            chance = random.Random(seed)
            outline = [(x * (k := chance.uniform(0.3, 1)), y * k) for x, y, _ in ring(corners, 10, 0)]
            text = prism(outline, 4)
            points = [row[2:] for row in text.splitlines() if row.startswith("v ")]
            faces = [[int(word) - 1 for word in row[2:].split()] for row in text.splitlines() if row[0] == "f"]
            rows = "\n".join(points + [f"{len(f)} {' '.join(map(str, f))}" for f in faces]) + "\n"
            head = (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
                    f"property double z\nelement face {len(faces)}\n"
                    "property list int int vertex_indices\nend_header\n")
            files = {"a.obj": text, "a.off": f"OFF\n{len(points)} {len(faces)} 0\n{rows}", "a.ply": head + rows}
            for name, content in files.items():
                with self.subTest(corners=corners, file=name):
                    info = self.info(self.write(name, content))
                    self.near(info["signed_volume"], 4 * shoelace(outline), 1e-5)
                    self.assertTrue(info["closed_manifold"])

    def test_face_that_crosses_itself_is_said(self):
        path = self.write("b.obj", "v 0 0 0\nv 4 4 0\nv 4 0 0\nv 0 4 0\nv -1 2 0\nv 0 0 9\nf 1 2 3 4 5\nf 1 2 6\nf 1 2\n")
        said = self.ok("info", path).stderr
        self.assertIn("b.obj: 1 of 3 faces cross themselves", said)
        self.assertIn("b.obj: 1 face with fewer than three corners left out", said)


class Dialects(Reported):
    def test_14_slashes_behind_texture_coordinates(self):
        info = self.info("14-obj-trailing-slash.obj")
        self.assertEqual((info["signed_volume"], info["area"], info["closed_manifold"]), (1, 6, True))
        self.near(self.convert("14-obj-trailing-slash.obj").volume, 1)

    def test_15_two_slashes_with_nothing_behind(self):
        info = self.info("15-obj-double-slash-empty.obj")
        self.assertEqual((info["signed_volume"], info["closed_manifold"]), (8, True))
        self.near(self.convert("15-obj-double-slash-empty.obj").volume, 8)

    def test_17_scan_in_utm(self):
        info = self.info("17-obj-utm-sphere.obj")
        self.near(info["signed_volume"], 33.42)
        self.near(info["area"], 50.2)
        done = self.convert("17-obj-utm-sphere.obj")
        self.near(done.volume, 33.42)

    def test_18_nan_names_its_line(self):
        rows = ["# a file with a coordinate that is no number"] * 11 + ["v nan 0 0", "v 1 0 0", "v 0 1 0"]
        for corners, code in (("1 2 3", 3), ("2 3 4", 0)):
            path = self.write("nan.obj", "\n".join(rows + ["v 0 0 1", "f " + corners]) + "\n")
            if code:
                self.fails(3, "nan.obj:12: a coordinate is not a finite number", "info", path)
            else:
                self.assertIn("1 vertices without finite coordinates", self.ok("info", path).stderr)

    def test_19_negative_indices(self):
        self.assertEqual(self.info("19-obj-negative.obj")["signed_volume"], 8)
        self.near(self.convert("19-obj-negative.obj").volume, 8)

    def test_99_chair_of_two_sided_faces_reads(self):
        info = self.info("99-obj-chair-two-sided.obj")
        self.assertGreater(info["faces"], 10000)

    def test_other_dialects(self):
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        plain = prism(square, 1)
        changed = {
            "upper case": plain.upper(),
            "old faces": plain.replace("f ", "fo "),
            "cr": plain.replace("\n", "\r"),
            "crlf": plain.replace("\n", "\r\n"),
            "crcrlf": plain.replace("\n", "\r\r\n"),
            "mark": "\ufeff" + plain,
            "path in comment": "# C:\\models\\\n" + plain,
            "comments": plain.replace("\n", " # end\n"),
            "faces first": "".join(sorted(plain.splitlines(True), key=lambda row: row[0])),
            "joined": plain.replace(" 3", " \\\n3"),
            "real numbers": "".join(row.replace("\n", ".0\n") if row[0] == "f" else row for row in plain.splitlines(True)),
            "weights": "".join(row.replace("\n", " 1.0\n") if row[0] == "v" else row for row in plain.splitlines(True)),
        }
        for name, text in changed.items():
            with self.subTest(name):
                info = self.info(self.write("a.obj", text.encode()))
                self.near(info["signed_volume"], 1, 1e-6)
                self.assertTrue(info["closed_manifold"])

    def test_what_cannot_be_read_says_why(self):
        triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
        for text, code, says in [
            (triangle.replace("0 0 0", "0,5 0 0"), 3, "a.obj:1: a comma in a coordinate"),
            (triangle + "f 0 1 2\n", 3, "a.obj:4: line 4 has a face with vertex 0; vertices of OBJ files count from 1"),
            (triangle + "f 1 2 7\n", 3, "a.obj:4: a face uses vertex 6 of 3"),
            (triangle + "f 1 2 -7\n", 3, "a.obj:4: a face uses vertex -7, but only 3 are above it"),
            (triangle + "surf 0 1 0 1 1 2 3\n", 3, "only free-form curves and surfaces"),
            (triangle + "l 1 2\n", 1, "no faces, only points and lines"),
            ("MZ\x90\x00\x03", 3, "not an OBJ file"),
        ]:
            self.fails(code, says, "info", self.write("a.obj", text.encode("latin1")))
        self.fails(3, "UTF-16", "info", self.write("a.obj", triangle.encode("utf-16")))

    def test_what_is_left_out_is_said(self):
        text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nsurf 0 1 0 1 1 2 3\n"
        said = self.ok("info", self.write("a.obj", text)).stderr
        self.assertIn("1 point or line (p, l) left out", said)
        self.assertIn("1 free-form curves and surfaces", said)


if __name__ == "__main__":
    unittest.main()
