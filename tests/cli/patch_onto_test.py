"""patch --onto with the real program: points, level sets and meshes over a model, and what is refused."""
import json
import math
import unittest

from patch_test import BOX, COLOURED, egg_crate, points_ply
from support import CliTest
from texture_test import ply_vertices


def tube_off(radius=26, height=90, around=96, rows=30):
    """A closed tube about z."""
    points = [(radius * math.cos(2 * math.pi * i / around), radius * math.sin(2 * math.pi * i / around), height * j / rows)
              for j in range(rows + 1) for i in range(around)]
    faces = []
    for j in range(rows):
        for i in range(around):
            a, b = j * around + i, j * around + (i + 1) % around
            faces += [(a, b, b + around), (a, b + around, a + around)]
    low, high = len(points), len(points) + 1
    points += [(0, 0, 0), (0, 0, height)]
    for i in range(around):
        faces += [(low, (i + 1) % around, i), (high, rows * around + i, rows * around + (i + 1) % around)]
    return (f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%.6f %.6f %.6f\n" % p for p in points) +
            "".join("3 %d %d %d\n" % f for f in faces))


class Over(CliTest):
    def setUp(self):
        super().setUp()
        self.write("crate.ply", points_ply(egg_crate(), BOX))
        self.write("tube.off", tube_off())

    def test_tube(self):
        self.ok("patch", "crate.ply", "--onto", "tube.off", "--direction", "axis:z", "-o", "over.ply", "-o", "over.vdb", "-o", "over.obj")
        rows = ply_vertices(self.read("over.ply"))
        far = [math.hypot(v["x"], v["y"]) for v in rows if 20 < v["z"] < 70]
        # 50 units of a tube of radius 26, a point to each square unit of the exemplar.
        self.assertAlmostEqual(len(far) / (2 * math.pi * 26 * 50), 1, delta=0.06)
        self.assertGreater(min(far), 23)
        self.assertLess(max(far), 29)
        self.assertGreater(max(far), 27.3)
        self.assertLess(min(far), 24.7)
        self.assertIn("patch", rows[0])
        self.assertIn("source", rows[0])

    def test_same_again(self):
        for name, threads in (("a.ply", 1), ("b.ply", 4)):
            self.ok("patch", "crate.ply", "--onto", "tube.off", "-o", name, "--threads", threads, "--scale", 1.2, "--height-offset", 2)
        self.assertEqual(self.read("a.ply"), self.read("b.ply"))


    def test_a_map_repeats(self):
        self.ok("patch", "crate.ply", "--onto", "tube.off", "--direction", "axis:z", "-o", "a.ply", "--source-map", "map.vdb", "--scale", 1.2)
        self.ok("repeat", "map.vdb", "crate.ply", "-o", "b.ply")
        self.assertEqual(self.read("a.ply"), self.read("b.ply"))
        self.write("coloured.ply", points_ply(egg_crate(colour=True), BOX, COLOURED))
        self.ok("repeat", "map.vdb", "coloured.ply", "-o", "c.ply", "-o", "c.vdb")
        self.assertEqual([v["source"] for v in ply_vertices(self.read("a.ply"))], [v["source"] for v in ply_vertices(self.read("c.ply"))])
        self.fails(1, "repeat MAP EXEMPLAR", "repeat", "map.vdb", "crate.ply", "tube.off", "-o", "d.ply")

    def test_colours_travel(self):
        self.write("coloured.ply", points_ply(egg_crate(colour=True), BOX, COLOURED))
        done = self.ok("patch", "coloured.ply", "--onto", "tube.off", "-o", "o.ply", "-o", "o.vdb", "-o", "o.obj", "--with-model")
        self.assertIn("own surface takes Cd", done.stderr)
        grids = {g["name"]: g for g in json.loads(self.ok("info", "o.vdb", "--json").stdout)["grids"]}
        self.assertEqual(sorted(grids), ["Cd", "surface"])
        self.assertEqual(len([line for line in self.read("o.obj").split(b"\n") if line.startswith(b"v ")][0].split()), 7)

    def test_refused(self):
        onto = ("patch", "crate.ply", "--onto", "tube.off", "-o", "x.ply")
        for more in (("--size", "4x,4x"), ("--tile",), ("--method", "paper"), ("--pairing-rounds", 2)):
            self.fails(2, more[0], *onto, *more)
        self.fails(2, "--with-model", *onto, "--with-model")
        sheet = ("patch", "crate.ply", "--size", "2x,2x", "-o", "x.ply")
        for more in (("--direction", "axis:z"), ("--scale", 2), ("--height-offset", 1), ("--with-model",)):
            self.fails(2, "without --onto", *sheet, *more)
        self.fails(2, "--onto MODEL", "patch", "crate.ply", "-o", "x.ply")


if __name__ == "__main__":
    unittest.main()
