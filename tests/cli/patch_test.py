"""patch with the real program: sheets of points, level sets and meshes, maps, and what is refused."""
import json
import math
import random
import signal
import subprocess
import time
import unittest

from support import PROGRAM, CliTest, sample
from texture_test import ply_vertices


def points_ply(rows, comments=(), columns=("x", "y", "z", "nx", "ny", "nz")):
    head = "ply\nformat ascii 1.0\n" + "".join(f"comment {c}\n" for c in comments)
    head += f"element vertex {len(rows)}\n" + "".join(f"property float {c}\n" for c in columns) + "end_header\n"
    return head + "".join(" ".join("%.7g" % v for v in row) + "\n" for row in rows)


def egg_crate(side=48, margin=12, period=16, height=1.5, colour=False):
    """Points a unit apart of z = height sin sin, beyond a box of `side`."""
    w, made, rows = 2 * math.pi / period, random.Random(1), []
    for i in range(-margin, side + margin):
        for j in range(-margin, side + margin):
            x, y = i + 0.5 + made.uniform(-0.2, 0.2), j + 0.5 + made.uniform(-0.2, 0.2)
            nx, ny = -height * w * math.cos(w * x) * math.sin(w * y), -height * w * math.sin(w * x) * math.cos(w * y)
            length = math.sqrt(nx * nx + ny * ny + 1)
            row = (x, y, height * math.sin(w * x) * math.sin(w * y), nx / length, ny / length, 1 / length)
            rows.append(row + ((i % 16) / 16, (j % 16) / 16, 0.5) if colour else row)
    return rows


BOX = ("vdbsynth:domain 0,0,-4,48,48,4", "vdbsynth:plane xy")
COLOURED = ("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue")


class Case(CliTest):
    def setUp(self):
        super().setUp()
        self.write("crate.ply", points_ply(egg_crate(), BOX))

    def counts(self, name="r.json"):
        return json.loads(self.read(name))["counts"]

    def heights(self, name, period=16):
        """The distance in height that 995 of 1000 points are under from the egg-crate of the best phase, of points away from the ends."""
        rows = [(v["x"], v["y"], v["z"]) for v in ply_vertices(self.read(name))]
        w = 2 * math.pi / period
        # z = h sin(w x + a) sin(w y + b) is a sum of four products whose factors follow from a and b.
        sums = {}
        for f, p in (("s", math.sin), ("c", math.cos)):
            for g, q in (("s", math.sin), ("c", math.cos)):
                sums[f + g] = 4 * sum(z * p(w * x) * q(w * y) for x, y, z in rows) / len(rows)
        away = []
        for x, y, z in rows:
            fit = sum(sums[f + g] * p(w * x) * q(w * y) for f, p in (("s", math.sin), ("c", math.cos))
                      for g, q in (("s", math.sin), ("c", math.cos)))
            away.append(abs(z - fit))
        return sorted(away)[int(0.995 * len(away))], math.sqrt(sum(v * v for v in sums.values()))


class Sheets(Case):
    def test_an_egg_crate_stays_one(self):
        self.ok("patch", "crate.ply", "--size", "4x,4x", "-o", "sheet.ply", "--report", "r.json")
        worst, height = self.heights("sheet.ply")
        self.assertLess(worst, 0.1)
        self.assertAlmostEqual(height, 1.5, delta=0.05)
        counts = self.counts()
        self.assertGreater(counts["patches"], 16)
        self.assertAlmostEqual(counts["points"] / (192 * 192), 1, delta=0.03)
        self.assertLess(counts["borders"]["apart_after"], 0.1)

    def test_the_papers_method(self):
        self.ok("patch", "crate.ply", "--size", "2x,2x", "-o", "sheet.ply", "--method", "paper", "--report", "r.json")
        worst, height = self.heights("sheet.ply")
        # It has no alignment: phases drift from patch to patch, so one fit for all is lower than any part.
        self.assertLess(worst, 1.5)
        self.assertGreater(height, 0.5)
        self.assertGreater(self.counts()["pairs"], 50)
        self.ok("patch", "crate.ply", "--size", "60,60", "-o", "given.ply", "--method", "paper", "--weight-normal", 3, "--weight-variation", 30,
                "--weight-length", 9, "--weight-direction", 7, "--seed-patch", "0,0,0", "--pairing-rounds", 2, "--report", "r.json")
        self.assertEqual(self.counts()["weights"]["length"], 9)

    def test_all_kinds_of_outputs_come_from_one_run(self):
        self.ok("patch", "crate.ply", "--size", "70,50", "-o", "s.ply", "-o", "s.vdb", "-o", "s.obj", "-o", "s.stl")
        info = json.loads(self.ok("info", "s.vdb", "--json").stdout)
        text = json.dumps(info)
        self.assertIn("surface", text)
        self.assertIn("domain", text)
        self.ok("compare", "s.vdb", "s.obj", "--json")

    def test_colours_and_sources_travel(self):
        rows = egg_crate(colour=True)
        self.write("coloured.ply", points_ply(rows, BOX, COLOURED))
        done = self.ok("patch", "coloured.ply", "--size", "60,60", "-o", "s.ply", "-o", "s.vdb")
        self.assertIn("Cd", done.stderr)
        for v in ply_vertices(self.read("s.ply"))[:500]:
            self.assertLess(int(v["source"]), len(rows))
            self.assertGreaterEqual(v["patch"], 0)

    def test_a_tile_continues_at_its_sides(self):
        self.ok("patch", "crate.ply", "--size", "80,80", "--tile", "-o", "tile.ply")
        worst, _ = self.heights("tile.ply")
        self.assertLess(worst, 0.1)

    def test_seeds_threads_and_repeats(self):
        for name, words in (("a", ()), ("b", ("--threads", 3)), ("c", ("--seed", 1))):
            self.ok("patch", "crate.ply", "--size", "100,100", "-o", name + ".ply", *words)
        self.assertEqual(self.read("a.ply"), self.read("b.ply"))
        self.assertNotEqual(self.read("a.ply"), self.read("c.ply"))

    def test_a_map_repeats(self):
        self.ok("patch", "crate.ply", "--size", "100,80", "-o", "a.ply", "--source-map", "map.vdb")
        self.ok("repeat", "map.vdb", "crate.ply", "-o", "b.ply")
        self.assertEqual(self.read("a.ply"), self.read("b.ply"))
        self.write("coloured.ply", points_ply(egg_crate(colour=True), BOX, COLOURED))
        self.ok("repeat", "map.vdb", "coloured.ply", "-o", "c.ply", "-o", "c.vdb")
        self.assertEqual([v["source"] for v in ply_vertices(self.read("a.ply"))], [v["source"] for v in ply_vertices(self.read("c.ply"))])

    def test_the_made_chainmail_is_read_with_its_box(self):
        self.ok("make", "chainmail", "mail.ply")
        done = self.ok("patch", "mail.ply", "--size", "60,60", "--draft", "-o", "s.ply", "--report", "r.json")
        self.assertNotIn("does not say its box", done.stderr)
        self.assertGreater(self.counts()["points"], 10000)

    def test_other_planes_and_models(self):
        turned = [(z, x, y, nz, nx, ny) for x, y, z, nx, ny, nz in egg_crate()]
        self.write("yz.ply", points_ply(turned))
        done = self.ok("patch", "yz.ply", "--size", "60,60", "-o", "s.ply", "--margin", 8)
        self.assertIn("yz", done.stderr)
        xs = [v["x"] for v in ply_vertices(self.read("s.ply"))]
        self.assertLess(max(xs) - min(xs), 6)
        self.ok("make", "terrain", "t.vdb", "--resolution", 48)
        self.ok("patch", "t.vdb", "--size", "2x,2x", "-o", "t2.vdb", "--seed", 2)


class Refused(Case):
    def test_command_lines(self):
        for says, words in (
                ("--size: is missing", ()),
                ("two sizes", ("--size", "4x")),
                ("two sizes", ("--size", "0,3")),
                ("no effect with --method paper", ("--size", "1x,1x", "--method", "paper", "--tile")),
                ("no effect with --method default", ("--size", "1x,1x", "--limit-normal", "20")),
                ("give all four weights", ("--size", "1x,1x", "--method", "paper", "--weight-normal", "2")),
                ("from 0.05 to 0.8", ("--size", "1x,1x", "--overlap", "0.9")),
                ("source-map", ("--size", "1x,1x", "--method", "paper", "--source-map", "m.vdb"))):
            self.fails(2, says, "patch", "crate.ply", "-o", "s.ply", *words)
        self.assertNotIn("s.ply", self.files())

    def test_files(self):
        rows = egg_crate(24, 0)
        self.write("one.ply", points_ply(rows[:1]))
        self.fails(1, "too few", "patch", "one.ply", "--size", "9,9", "-o", "s.ply")
        self.write("same.ply", points_ply(rows[:1] * 100))
        self.fails(1, "coincide", "patch", "same.ply", "--size", "9,9", "-o", "s.ply")
        self.write("small.ply", points_ply(rows, ("vdbsynth:domain 8,8,-4,13,13,4", "vdbsynth:plane xy")))
        self.fails(1, "too small for a patch", "patch", "small.ply", "--size", "30,30", "-o", "s.ply")
        self.write("crate2.ply", points_ply(egg_crate(), ("vdbsynth:domain 0,0,-4,48,nan,4",)))
        self.fails(3, "domain", "patch", "crate2.ply", "--size", "9,9", "-o", "s.ply")
        self.fails(3, "no such file", "patch", "none.ply", "--size", "9,9", "-o", "s.ply")
        self.fails(1, "larger than the exemplar", "patch", "crate.ply", "--size", "90,90", "--patch", 60, "-o", "s.ply")
        self.write("bare.ply", points_ply(rows))
        self.fails(1, "margin", "patch", "bare.ply", "--size", "9,9", "--margin", 1000, "-o", "s.ply")

    def test_messy_points_are_said_and_do(self):
        rows = egg_crate()
        bare = [row[:3] for row in rows]
        self.write("bare.ply", points_ply(bare, BOX, ("x", "y", "z")))
        self.assertIn("no normals", self.ok("patch", "bare.ply", "--size", "60,60", "-o", "s.ply").stderr)
        worst, _ = self.heights("s.ply")
        self.assertLess(worst, 0.5)
        holes = rows + [(float("nan"), 0, 0, 0, 0, 1)] * 5 + rows[:200]
        self.write("holes.ply", points_ply(holes, BOX))
        self.assertIn("5 points", self.ok("patch", "holes.ply", "--size", "60,60", "-o", "s.ply").stderr)
        flipped = [row[:3] + tuple(-n for n in row[3:]) for row in rows]
        self.write("flipped.ply", points_ply(flipped, BOX))
        self.ok("patch", "flipped.ply", "--size", "60,60", "-o", "s.ply")

    def test_ctrl_c_leaves_nothing(self):
        run = subprocess.Popen([PROGRAM, "patch", "crate.ply", "--size", "3000,3000", "-o", "s.ply"], cwd=self.path("."),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1.5)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(30), 130)
        self.assertEqual([n for n in self.files() if n.startswith(".") or n == "s.ply"], [])


if __name__ == "__main__":
    unittest.main()
