"""Reported files whose solids lost parts, signs, voids, thickness or places: what comes out is compared with what
went in, and the right values of the list hold."""
import json
import math
import struct
import unittest

from reported import Reported


def box(low, high, inward=False):
    """Twelve triangles of a box, as corner triples."""
    corner = lambda x, y, z: tuple((low, high)[b][a] for a, b in enumerate((x, y, z)))
    quads = [((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
             ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
             ((1, 1, 0), (0, 1, 0), (0, 1, 1), (1, 1, 1)), ((0, 1, 0), (0, 0, 0), (0, 0, 1), (0, 1, 1))]
    faces = []
    for q in quads:
        a, b, c, d = (corner(*p) for p in q)
        faces += [(a, b, c), (a, c, d)]
    return [tuple(reversed(f)) for f in faces] if inward else faces


def stl(faces):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *f[0], *f[1], *f[2], 0) for f in faces)
    return b"made by a test".ljust(80) + struct.pack("<I", len(faces)) + body


def cube(low, high, inward=False):
    return box((low,) * 3, (high,) * 3, inward)


class Solids(Reported):
    def said(self, outcome, *parts):
        for part in parts:
            self.assertIn(part, outcome.said)

    def mesh(self, *parts):
        return self.write("m.stl", stl([f for part in parts for f in part]))

    def test_12_caps_of_a_letter(self):
        done = self.convert("12-obj-c-shape-ngon-caps.obj")
        self.near(done.volume, 890.26)
        self.near(done.area, 842.5, 0.03)
        self.near(self.convert("12-obj-c-shape-ngon-caps.obj", "--sharp").area, 842.5, 0.001)

    def test_16_and_87_caps_of_many_corners(self):
        self.near(self.convert("16-obj-400gon.obj").volume, 1256.59)
        self.near(self.convert("87-obj-256gon-tall.obj").volume, 12564)

    def test_78_same_orientation_is_united(self):
        self.near(self.convert("78-stl-nested-same.stl").volume, 1000)

    def test_79_a_cavity_stays(self):
        for resolution in (40, 80, 150):
            done = self.convert("79-stl-cavity.stl", resolution=resolution)
            self.near(done.volume, 936)
            self.assertEqual(done.info["voids"], 1)

    def test_90_a_void_of_a_volume_stays(self):
        for resolution in (None, 80, 50):
            self.near(self.convert("90-npy-closed-void.npy", resolution=resolution).volume, 43776)

    def test_92_a_void_of_a_level_set_stays(self):
        path = self.file("92-vdb-hollow-cube.vdb")
        for resolution in (40, 80, 120):
            self.near(self.convert(path, resolution=resolution).volume, 936)
        self.near(self.convert(path, "--voxel-size", 0.3, resolution=None, to="v.ply").volume, 936)
        self.ok("mask", "inside", path, "-o", "mask.vdb", "--resolution", 50)
        report = json.loads(self.ok("compare", path, path, "--resolution", 50, "--json").stdout)
        self.assertTrue(report)

    def test_93_plates_are_thinner_than_a_voxel(self):
        done = self.convert("93-obj-offset2-thin.obj")
        self.assertEqual(done.code, 1)
        self.said(done, "thinner than a voxel", "of 45 closed parts", "--resolution", "--open shell")

    def test_94_95_and_96_thin_walls(self):
        for name in ("94-obj-havocglass-thin.obj", "95-obj-cray-left-thin-shell.obj", "96-stl-round-thin.stl"):
            done = self.convert(name)
            self.assertEqual(done.code, 1)
            self.said(done, "thinner than a voxel", "of its volume", "--resolution")

    def test_95_walls_of_more_than_a_voxel_are_kept(self):
        done = self.convert("95-obj-cray-left-thin-shell.obj", to="o.vdb", resolution=400)
        self.assertEqual(done.code, 0)
        self.near(done.model["signed_volume"], 1.9569e12, 0.02)
        self.assertEqual(done.model["voids"], 1)

    def test_97_a_tray_of_half_a_voxel(self):
        path = self.mesh(box((0, 0, 0.1), (100, 60, 0.7)))
        done = self.convert(path)
        self.assertEqual(done.code, 1)
        self.said(done, "thinner than a voxel")

    def test_99_seat_back_and_legs(self):
        done = self.convert("99-obj-chair-two-sided.obj")
        self.assertEqual(done.code, 0)
        # The legs reach down to the lowest point, the back to the highest.
        for low, right in zip(done.bounds[:3], (-0.2655, -0.3319, -0.2634)):
            self.assertLess(abs(low - right), 0.017)
        for high, right in zip(done.bounds[3:], (0.2655, 0.3319, 0.2634)):
            self.assertLess(abs(high - right), 0.017)
        self.said(done, "of its surface")

    def test_100_an_open_building(self):
        done = self.convert("100-glb-building.glb")
        self.assertTrue(done.code == 0 and "warning" in done.said or done.code == 1)

    def test_101_103_104_and_105_balls(self):
        self.near(self.convert("101-stl-two-sided-closed-and-open.stl").volume, 8.2)
        self.near(self.convert("103-stl-flipped-part-and-closed-part.stl").volume, 8.27)
        self.near(self.convert("104-stl-two-sided-both-closed.stl").volume, 8.27)
        stray = self.convert("105-stl-flipped-part-and-stray-triangle.stl")
        self.near(stray.volume, 8.27)
        self.said(stray, "warning", "1 open part")

    def test_106_at_each_resolution(self):
        for resolution in (80, 200, 400):
            done = self.convert("106-stl-small-flipped-part.stl", to="o.vdb", resolution=resolution)
            self.near(done.model["signed_volume"], 113.4, 0.01)
            self.assertEqual(done.model["closed_parts"], 2)

    def test_parts_of_every_orientation_generated(self):
        shell = lambda a, b: (cube(0, 20, a), cube(5, 15, b))
        for a in (False, True):
            for b in (False, True):
                with self.subTest(outer=a, inner=b):
                    done = self.convert(self.mesh(*shell(a, b)))
                    self.near(done.volume, 8000 if a == b else 7000)
        onion = [cube(0, 20), cube(2, 18, True), cube(4, 16), cube(6, 14, True)]
        for flip in (False, True):
            faces = [[tuple(reversed(f)) for f in part] if flip else part for part in onion]
            done = self.convert(self.mesh(*faces))
            self.near(done.volume, 8000 - 4096 + 1728 - 512, 0.03)
            self.assertEqual((done.info["closed_parts"], done.info["voids"]), (2, 2))

    def test_parts_that_vanish_are_said_generated(self):
        done = self.convert(self.mesh(cube(0, 20), box((40, 5, 5.3), (60, 15, 5.5))), resolution=60)
        self.assertEqual(done.code, 0)
        self.said(done, "1 of 2 closed parts", "its bounds shrink", "--resolution")
        small = self.convert(self.mesh(cube(0, 20), cube(9.65, 9.85, True)), resolution=40)
        self.assertEqual(small.code, 0)
        self.said(small, "1 of 1 void")

    def test_resampling_that_loses_is_said_generated(self):
        path = self.mesh(cube(0, 20), cube(30, 31.5))
        self.ok("convert", path, "-o", "fine.vdb", "--resolution", 126)
        done = self.convert(self.path("fine.vdb"), resolution=6, to="c.vdb")
        self.said(done, "1 of 2 closed parts")

    def test_the_report_tells_what_was_and_is(self):
        path = self.mesh(cube(0, 20), cube(5, 15, True))
        self.ok("convert", path, "-o", "o.vdb", "--resolution", 40, "--report", "r.json")
        counts = json.loads(self.read("r.json"))["counts"]
        for surface in (counts["input_surface"], counts["surface"]):
            self.near(surface["signed_volume"], 7000)
            self.near(surface["area"], 3000, 0.03)
            self.assertEqual((surface["closed_parts"], surface["voids"]), (1, 1))
        self.assertEqual(counts["lost_share"], 0)


class Places(Reported):
    """Far, large and tiny coordinates."""

    def test_17_and_21_a_survey(self):
        for name in ("17-obj-utm-sphere.obj", "21-ply-utm-double-points.ply"):
            done = self.convert(name)
            self.near(done.volume, 33.5, 0.01)
            self.near(done.area, 50.2, 0.02)
            self.assertLess(abs(done.bounds[1] - 5648347.895), 0.05)

    def test_23_bounds_of_points(self):
        info = self.info("23-xyz-agisoft-utm.xyz")
        self.assertLess(abs(info["bounds_min"][1] - 5648340.499471), 1e-3)
        self.assertLess(abs(info["bounds_max"][1] - 5648381.899135), 1e-3)

    def test_68_a_far_level_set(self):
        for resolution in (None, 80):
            done = self.convert("68-vdb-far.vdb", resolution=resolution)
            self.near(done.area, 12.57, 0.01)
            for axis, centre in enumerate((1e6, 2e6, 3e6)):
                self.assertLess(abs(done.bounds[axis] - (centre - 1)), 0.01)
        far = self.convert("68-vdb-far.vdb", to="o.stl", resolution=None)
        self.assertIn("steps of 0.25", far.said)
        for kind in ("obj", "off", "glb"):
            self.near(self.convert("68-vdb-far.vdb", to="o." + kind, resolution=None).area, 12.57, 0.01)

    def test_80_voxels_of_nanometres(self):
        done = self.convert("80-stl-micro-metres.stl")
        self.assertEqual(done.code, 1)
        self.assertIn("--unit-scale", done.said)
        self.assertNotIn("ArithmeticError", done.said)
        self.near(self.convert("80-stl-micro-metres.stl", "--unit-scale", 1e6).volume, 522, 0.01)

    def test_81_a_huge_ball(self):
        self.near(self.convert("81-stl-huge.stl").volume, 5.22e23, 0.01)

    def test_units_at_every_door_generated(self):
        path = self.write("m.stl", stl(cube(0, 2)))
        self.near(self.convert(path, "--unit-scale", 10).volume, 8000)
        self.ok("convert", path, "-o", "m.vdb", "--resolution", 20)
        done = self.convert(self.path("m.vdb"), "--unit-scale", 10, resolution=None, to="n.vdb")
        self.near(done.model["voxel_size"], 1, 1e-6)
        self.near(done.model["signed_volume"], 8000)
        self.fails(2, "--unit-scale 0", "convert", path, "-o", "x.vdb", "--unit-scale", 0)

    def test_a_scan_far_away_keeps_its_colours_generated(self):
        rows = []
        for i in range(4000):
            z = 1 - 2 * (i + 0.5) / 4000
            r, t = (1 - z * z) ** 0.5, 2.399963 * i
            x, y = r * math.cos(t), r * math.sin(t)
            rows.append("%.6f %.6f %.6f %.6f %.6f %.6f %d 0 0"
                        % (500000 + x, 4000000 + y, 100 + z, x, y, z, 255 if z > 0 else 0))
        path = self.write("far.xyz", "\n".join(rows) + "\n")
        done = self.convert(path, resolution=40)
        self.near(done.volume, 4.19, 0.03)
        self.assertLess(abs(done.bounds[1] - 3999999), 0.06)
        self.assertIn(b"property double x", self.read("o.ply")[:400])
        self.assertIn(b"property uchar red", self.read("o.ply")[:400])


class Unused(Reported):
    def test_options_for_another_kind_are_said(self):
        path = self.write("m.stl", stl(cube(0, 2)))
        said = self.ok("convert", path, "-o", "o.vdb", "--iso", 0.5, "--threshold", 3, "--grid", "density").stderr
        for option in ("--iso", "--threshold", "--grid"):
            self.assertIn(option + " has no effect on a mesh", said)
        said = self.ok("convert", "o.vdb", "-o", "p.vdb", "--open", "shell", "--thickness", 1).stderr
        self.assertIn("--open has no effect on a VDB", said)


if __name__ == "__main__":
    unittest.main()
