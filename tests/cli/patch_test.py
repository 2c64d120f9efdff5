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


def box_off(low, high):
    corners = [tuple((low, high)[i >> a & 1][a] for a in range(3)) for i in range(8)]
    faces = ("0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5")
    return "OFF\n8 6 0\n" + "".join("%g %g %g\n" % c for c in corners) + "".join("4 %s\n" % f for f in faces)


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
        self.ok("patch", "coloured.ply", "--size", "60,60", "-o", "s.ply", "-o", "s.vdb", "-o", "s.obj")
        grids = {g["name"]: g for g in json.loads(self.ok("info", "s.vdb", "--json").stdout)["grids"]}
        self.assertEqual(sorted(grids), ["Cd", "surface"])
        self.assertEqual(len([l for l in self.read("s.obj").split(b"\n") if l.startswith(b"v ")][0].split()), 7)
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


class Repairs(Case):
    """Of a hole that is punched into a sheet."""
    BOX = (30, 28, 46, 44)

    def punch(self, rows, name="holed.ply", columns=("x", "y", "z", "nx", "ny", "nz")):
        x, y, X, Y = self.BOX
        kept = [r for r in rows if not (x < r[0] < X and y < r[1] < Y)]
        self.write(name, points_ply(kept, columns=columns))
        return kept

    def hole(self):
        x, y, X, Y = self.BOX
        return "%g,%g,-9,%g,%g,9" % (x, y, X, Y)

    def beyond(self, v):
        x, y, X, Y = self.BOX
        return max(x - v["x"], v["x"] - X, y - v["y"], v["y"] - Y)

    def far_points(self, name, reach):
        return sorted(tuple(v[k] for k in ("x", "y", "z", "nx", "ny", "nz")) for v in ply_vertices(self.read(name)) if self.beyond(v) > reach)

    def test_an_egg_crate_is_whole_again(self):
        kept = self.punch(egg_crate(72, 4))
        self.ok("patch", "holed.ply", "--hole", self.hole(), "-o", "fixed.ply", "-o", "fixed.vdb", "--report", "r.json")
        worst, height = self.heights("fixed.ply")
        self.assertLess(worst, 0.2)
        self.assertAlmostEqual(height, 1.5, delta=0.05)
        counts = self.counts()
        self.assertEqual(counts["points_in"], len(kept))
        self.assertGreater(counts["points_out"], len(kept) + 200)
        # Once written as floats, what is far comes out as it went in.
        self.ok("patch", "fixed.ply", "--hole", self.hole(), "-o", "again.ply")
        reach = 2 * counts["overlap"] + 10
        far = self.far_points("fixed.ply", reach)
        self.assertGreater(len(far), 200)
        self.assertEqual(far, self.far_points("again.ply", reach))
        self.ok("patch", "holed.ply", "--hole", self.hole(), "-o", "b.ply", "--threads", 3)
        self.assertEqual(self.read("fixed.ply"), self.read("b.ply"))

    def test_from_an_exemplar_with_a_model_as_the_hole(self):
        self.punch([r + (0.25, 0.5, 0.75) for r in egg_crate(72, 4)], columns=COLOURED)
        self.write("coloured.ply", points_ply(egg_crate(colour=True), BOX, COLOURED))
        self.write("box.off", box_off((30, 28, -9), (46, 44, 9)))
        self.ok("patch", "coloured.ply", "--keep", "holed.ply", "--hole", "box.off", "-o", "fixed.ply")
        worst, _ = self.heights("fixed.ply")
        self.assertLess(worst, 0.2)
        self.assertGreater(len({v["patch"] for v in ply_vertices(self.read("fixed.ply"))}), 1)

    def test_command_lines(self):
        self.punch(egg_crate(72, 4))
        for code, says, words in (
                (2, "--hole: missing", ("--keep", "holed.ply")),
                (2, "must be a model, or a box", ("holed.ply", "--hole", "auto")),
                (2, "every minimum below", ("holed.ply", "--hole", "5,5,5,1,9,9")),
                (2, "cannot be combined with --hole", ("holed.ply", "--hole", self.hole(), "--size", "3x,3x")),
                (2, "no sheets", ("holed.ply", "--hole", self.hole(), "--method", "paper")),
                (2, "EXEMPLAR's", ("holed.ply", "--hole", self.hole(), "--margin", 3)),
                (1, "outside the sheet", ("holed.ply", "--hole", "500,0,-9,600,9,9")),
                (1, "whole sheet", ("holed.ply", "--hole", "-99,-99,-9,200,200,9")),
                (1, "smaller --patch", ("holed.ply", "--hole", self.hole(), "--patch", 50))):
            self.fails(code, says, "patch", "-o", "s.ply", *words)
        self.assertNotIn("s.ply", self.files())


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
