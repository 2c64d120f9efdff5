"""Frames and poses with the real program: sequences in one run, and textures that stay on a surface that deforms."""
import json
import math
import unittest

from support import CliTest, sample


def twisted(text, degrees):
    """An .off file turned about z, more the higher."""
    lines = text.split("\n")
    counts = lines[1].split()
    vertices = [tuple(map(float, line.split()[:3])) for line in lines[2:2 + int(counts[0])]]
    low, high = min(v[2] for v in vertices), max(v[2] for v in vertices)
    moved = []
    for x, y, z in vertices:
        angle = math.radians(degrees) * (z - low) / (high - low)
        c, s = math.cos(angle), math.sin(angle)
        moved.append("%.7f %.7f %.7f" % (c * x - s * y, s * x + c * y, z))
    return "\n".join(lines[:2] + moved + lines[2 + int(counts[0]):])


def capsule():
    """A closed tube about z with rounded ends."""
    rings, around = 40, 48
    points = [(0.0, 0.0, 0.0)]
    for ring in range(1, rings):
        turn = math.pi * ring / rings
        points += [(12 * math.sin(turn) * math.cos(2 * math.pi * a / around), 12 * math.sin(turn) * math.sin(2 * math.pi * a / around),
                    30 - 30 * math.cos(turn)) for a in range(around)]
    points.append((0.0, 0.0, 60.0))
    at = lambda ring, a: 1 + (ring - 1) * around + a % around
    faces = []
    for a in range(around):
        faces += [(0, at(1, a + 1), at(1, a)), (len(points) - 1, at(rings - 1, a), at(rings - 1, a + 1))]
        for ring in range(1, rings - 1):
            faces += [(at(ring, a), at(ring, a + 1), at(ring + 1, a)), (at(ring, a + 1), at(ring + 1, a + 1), at(ring + 1, a))]
    return (f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%.7f %.7f %.7f\n" % p for p in points) +
            "".join("3 %d %d %d\n" % f for f in faces))


def box_of_quads(side, moved=None):
    """A cube of quads of side 8; `moved` corners by where they are on the lattice."""
    numbers, faces = {}, []
    for axis in range(3):
        for end in (0, side):
            for i in range(side):
                for j in range(side):
                    ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    corners = [tuple([end, *p][(k - axis) % 3] for k in range(3)) for p in (ring if end else ring[::-1])]
                    faces.append([numbers.setdefault(c, len(numbers)) for c in corners])
    places = [[8 * x for x in (moved or {}).get(corner, corner)] for corner in numbers]
    return (f"OFF\n{len(places)} {len(faces)} 0\n" + "".join("%g %g %g\n" % tuple(p) for p in places) +
            "".join("4 %d %d %d %d\n" % tuple(f) for f in faces))


class Frames(CliTest):
    def setUp(self):
        super().setUp()
        self.base = capsule()
        for frame, degrees in ((8, 0), (9, 5), (10, 10)):
            self.write("b.%04d.off" % frame, twisted(self.base, degrees))

    def test_same_as_one_by_one(self):
        said = self.ok("convert", "b.####.off", "-o", "f.####.vdb", "-o", "f%d.obj", "--frames", "8-10", "--resolution", 48, "--report", "r.##.json").stderr
        self.assertIn("frame 9, 2 of 3", said)
        for frame in (8, 9, 10):
            self.ok("convert", "b.%04d.off" % frame, "-o", "one.vdb", "--resolution", 48)
            self.assertEqual(self.read("f.%04d.vdb" % frame), self.read("one.vdb"))
            self.assertIn("f%d.obj" % frame, self.files())
            self.assertIn("r.%02d.json" % frame, self.files())

    def test_shared_models_are_read_once_and_every_frame_is_the_same(self):
        self.ok("make", "balls", "a.vdb", "--resolution", 48)
        words = ("match", "a.vdb", "b.####.off", "--block", 8, "--at", "0,0,20", "--resolution", 48)
        self.ok(*words, "-o", "m.####.json", "--frames", "8,10")
        self.ok(*[w.replace("####", "0010") if isinstance(w, str) else w for w in words], "-o", "one.json")
        self.assertEqual(self.read("m.0010.json"), self.read("one.json"))

    def test_a_frame_that_fails(self):
        self.write("b.0009.off", "OFF\n1 1 0\n0 0")
        result = self.fails(3, "b.0009.off", "convert", "b.####.off", "-o", "f.####.vdb", "--frames", "8-10", "--resolution", 32)
        self.assertIn("stopped at frame 9; the 1 before it are written", result.stderr)
        self.assertIn("f.0008.vdb", self.files())
        self.assertNotIn("f.0010.vdb", self.files())

    def test_refused(self):
        self.fails(2, "every frame would replace it", "convert", "b.####.off", "-o", "f.vdb", "--frames", "8-10")
        self.fails(2, "no file names frames", "convert", "b.0008.off", "-o", "f.vdb", "--frames", "8")
        self.fails(2, "numbers of frames", "convert", "b.####.off", "-o", "f.####.vdb", "--frames", "10-8")
        self.fails(2, "each once", "convert", "b.####.off", "-o", "f.####.vdb", "--frames", "8,8-10")
        self.fails(2, "add --frames", "convert", "b.####.off", "-o", "f.####.vdb")
        self.fails(2, "is the file of the input", "convert", "b.####.off", "-o", "b.####.off", "--frames", "8-10")


class Poses(CliTest):
    """A texture made at rest, carried to other poses."""

    def setUp(self):
        super().setUp()
        self.base = capsule()
        self.write("rest.off", self.base)
        for frame, degrees in ((1, 0), (2, 20)):
            self.write("b.%d.off" % frame, twisted(self.base, degrees))
        self.ok("make", "dilation", "a.vdb", "a2.vdb", "--resolution", 48)
        self.words = ("analogy", "a.vdb", "a2.vdb", "b.#.off", "--rest", "rest.off", "--resolution", 64, "--direction", "axis:z")

    def test_frames(self):
        said = self.ok(*self.words, "-o", "p.#.vdb", "--frames", "1-2", "--write-directions", "--threads", 1).stderr
        self.assertEqual(said.count("singularities"), 1, "of what is made once")
        # The pose at rest: what a run without --rest makes, but for the rebuilt band.
        self.ok("analogy", "a.vdb", "a2.vdb", "rest.off", "-o", "plain.vdb", "--resolution", 64, "--direction", "axis:z")
        solid = [json.loads(self.ok("info", name, "--json").stdout)["model"]["solid_voxels"] for name in ("plain.vdb", "p.1.vdb", "p.2.vdb")]
        self.assertAlmostEqual(solid[1] / solid[0], 1, delta=0.003)
        self.assertAlmostEqual(solid[2] / solid[0], 1, delta=0.01)
        # One frame alone, with other threads: the same bytes.
        self.ok(*[w.replace("#", "2") if isinstance(w, str) else w for w in self.words], "-o", "one.vdb", "--write-directions", "--threads", 3)
        self.assertEqual(self.read("p.2.vdb"), self.read("one.vdb"))

    def test_quads_that_become_concave(self):
        """They are read as two triangles; the faces are still those of the pose at rest."""
        self.write("r.off", box_of_quads(4))
        self.write("q.off", box_of_quads(4, {(2, 2, 4): (2.7, 2.7, 4)}))
        said = self.ok("analogy", "a.vdb", "a2.vdb", "q.off", "--rest", "r.off", "-o", "p.vdb", "--resolution", 48, "--direction", "axis:z", "--draft").stderr
        self.assertNotIn("warning", said)
        self.ok("analogy", "a.vdb", "a2.vdb", "r.off", "-o", "plain.vdb", "--resolution", 48, "--direction", "axis:z", "--draft")
        solid = [json.loads(self.ok("info", name, "--json").stdout)["model"]["solid_voxels"] for name in ("plain.vdb", "p.vdb")]
        self.assertAlmostEqual(solid[1] / solid[0], 1, delta=0.02)

    def test_refused(self):
        self.write("other.off", "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
        # Before anything is made.
        result = self.fails(1, "other.off: has 4 vertices and 4 triangles, rest.off (--rest) has",
                            "analogy", "a.vdb", "a2.vdb", "other.off", "--rest", "rest.off", "-o", "x.vdb", "-v")
        self.assertNotIn("level 1", result.stderr)
        self.fails(2, "--rest b.1.off: is another file for every frame", "analogy", "a.vdb", "a2.vdb", "b.#.off", "--rest", "b.#.off",
                   "-o", "x.#.vdb", "--frames", "1-2", "--resolution", 32)
        self.fails(1, "a2.vdb: the model at rest", "analogy", "a.vdb", "a2.vdb", "a2.vdb", "--rest", "rest.off", "-o", "x.vdb", "--resolution", 32,
                   "--draft")
        self.fails(2, "--source-map", *self.words, "-o", "x.#.vdb", "--frames", "1", "--source-map", "m.#.vdb")
        self.fails(1, "rest", "analogy", "a.vdb", "a2.vdb", "a2.vdb", "--rest", "rest.off", "-o", "x.vdb", "--resolution", 32)


class MovingExemplars(CliTest):
    def test_repeat_keeps_the_arrangement(self):
        """An exemplar that swells by 0.7 voxels: so does the result, everywhere and on its place."""
        self.ok("make", "grid", "e.1.vdb", "--resolution", 32)
        self.ok("convert", "e.1.vdb", "-o", "e.npy", "--values", "distance")
        self.ok("convert", "e.npy", "-o", "e.2.vdb", "--below", 0.7, "--pixel-size", 1)
        self.ok("synth", "e.1.vdb", "-o", "s.vdb", "--size", "2x,2x,1x", "--source-map", "map.vdb")
        self.ok("repeat", "map.vdb", "e.#.vdb", "-o", "r.#.vdb", "--frames", "1-2")
        others = json.loads(self.ok("compare", "s.vdb", "r.1.vdb", "r.2.vdb", "--json").stdout)["others"]
        first, second = (other["distances"]["surface"] for other in others)
        self.assertEqual(first["hausdorff"], 0)
        self.assertAlmostEqual(second["mean"], 0.7, delta=0.05)
        self.assertAlmostEqual(second["rms"], 0.7, delta=0.05)


def obj_mesh(text):
    lines = [line.split() for line in text.decode().split("\n")]
    vertices = [tuple(map(float, w[1:4])) for w in lines if w and w[0] == "v"]
    faces = [[int(word.split("/")[0]) - 1 for word in w[1:]] for w in lines if w and w[0] == "f"]
    return vertices, faces


def vertex_normals(vertices, faces):
    sums = [[0.0, 0.0, 0.0] for _ in vertices]
    for face in faces:
        a, b, c = vertices[face[0]], vertices[face[1]], vertices[face[2]]
        u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for corner in face:
            for k in range(3):
                sums[corner][k] += n[k]
    return [[x / (math.sqrt(sum(y * y for y in n)) or 1) for x in n] for n in sums]


def steps_to_surface(points, vertices, normals, voxel):
    """From every point to the tangent plane of the nearest vertex; infinite where none is within two voxels."""
    cells = {}
    for number, v in enumerate(vertices):
        cells.setdefault(tuple(int(x // voxel) for x in v), []).append(number)
    steps = []
    for p in points:
        i, j, k = (int(x // voxel) for x in p)
        near = [n for a in range(i - 1, i + 2) for b in range(j - 1, j + 2) for c in range(k - 1, k + 2) for n in cells.get((a, b, c), ())]
        best = min(near, key=lambda n: sum((x - y) ** 2 for x, y in zip(p, vertices[n])), default=None)
        steps.append(math.inf if best is None else abs(sum((x - y) * n for x, y, n in zip(p, vertices[best], normals[best]))))
    return sorted(steps)


class TwistedBunny(CliTest):
    def test_thorns_stay_on_their_places(self):
        with open(sample("meshes/bunny.off")) as file:
            bunny = file.read()
        heights = [float(line.split()[2]) for line in bunny.split("\n")[2:2 + int(bunny.split("\n")[1].split()[0])]]
        low, high = min(heights), max(heights)
        for frame, degrees in ((0, 0), (1, 3)):
            self.write("bunny.%d.off" % frame, twisted(bunny, degrees))
        self.ok("make", "thorns", "a.vdb", "a2.vdb", "--resolution", 64)
        self.ok("analogy", "a.vdb", "a2.vdb", "bunny.#.off", "--rest", "bunny.0.off", "-o", "t.#.obj", "--frames", "0-1", "--resolution", 80)
        rest, _ = obj_mesh(self.read("t.0.obj"))
        voxel = max(max(v[k] for v in rest) - min(v[k] for v in rest) for k in range(3)) / 80
        vertices, faces = obj_mesh(self.read("t.1.obj"))
        moved = []
        for x, y, z in rest[::5]:
            angle = math.radians(3) * (z - low) / (high - low)
            c, s = math.cos(angle), math.sin(angle)
            moved.append((c * x - s * y, s * x + c * y, z))
        steps = steps_to_surface(moved, vertices, vertex_normals(vertices, faces), voxel)
        self.assertLess(steps[len(steps) // 2] / voxel, 0.1)
        # The others are tips of thorns, which the mesh of a frame cuts elsewhere within a voxel.
        self.assertLess(steps[len(steps) * 98 // 100] / voxel, 0.5)


if __name__ == "__main__":
    unittest.main()
