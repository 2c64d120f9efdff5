"""relief-extract with the real program: base and relief of scans, and what is refused."""
import json
import math
import signal
import subprocess
import time
import unittest

from support import PROGRAM, CliTest, sample
from texture_test import ply_vertices, png


def waves(x, y):
    """A relief of waves 16 pixels long, for a picture."""
    return (128 + round(85 * math.sin(math.pi * x / 8)),)


class ReliefExtract(CliTest):
    def setUp(self):
        super().setUp()
        self.write("waves.png", png(64, 48, waves, kind=0))

    def report(self, name="r.json"):
        return json.loads(self.read(name))["counts"]

    def test_a_picture_gives_its_waves_again(self):
        said = self.ok("relief-extract", "waves.png", "-o", "r.vdb", "-o", "r.ply", "-o", "r.png", "-o", "r.exr", "--height", 3,
                       "--base-radius", 8, "--report", "r.json").stderr
        self.assertIn("black is a height of", said)
        relief = self.report()["relief"]
        # Half of 170 of 255 levels of 3 units, and a sine's deviation.
        self.assertAlmostEqual(relief["Sq"], 3 * 85 / 255 / 2**0.5, delta=0.06)
        self.assertAlmostEqual(relief["Sku"], 1.5, delta=0.1)
        grids = {g["name"]: g for g in json.loads(self.ok("info", "r.vdb", "--json").stdout)["grids"]}
        self.assertEqual(grids["base"]["class"], "level set")
        self.assertEqual(grids["relief"]["type"], "float")
        vertices = ply_vertices(self.read("r.ply"))
        self.assertTrue(all(name in vertices[0] for name in ("relief", "relief_vector_x", "relief_vector_z")), vertices[0])
        self.assertGreater(max(v["relief"] for v in vertices), 0.7)

    def test_strength_one_is_the_scan_and_zero_the_base(self):
        self.ok("relief-extract", "waves.png", "-o", "one.vdb", "-o", "one.obj", "--height", 3, "--base-radius", 5, "--strength", 1)
        self.ok("convert", "waves.png", "-o", "scan.vdb", "--height", 3)
        self.ok("convert", "one.vdb", "-o", "again.vdb", "--grid", "surface")
        answer = json.loads(self.ok("compare", "scan.vdb", "again.vdb", "--json").stdout)
        self.assertLess(answer["others"][0]["distances"]["surface"]["hausdorff"], 0.1)
        self.assertGreater(len(self.read("one.obj")), 10000)

    def test_bytes_do_not_depend_on_threads(self):
        for threads in (1, 8):
            self.ok("relief-extract", "waves.png", "-o", f"{threads}.vdb", "--height", 3, "--threads", threads, "--strength", -1)
        self.assertEqual(self.read("1.vdb"), self.read("8.vdb"))

    def test_the_radius_is_explained(self):
        said = self.ok("relief-extract", "waves.png", "-o", "r.vdb", "--height", 3, "-v").stderr
        self.assertIn("base radius", said)
        self.assertIn("takes off", said)

    def test_what_cannot_be_is_refused(self):
        self.fails(2, "--base-radius 0.01: must be from 1 to 1000 (world)", "relief-extract", "waves.png", "-o", "r.vdb", "--base-radius", 0.01)
        self.fails(2, "--strength", "relief-extract", "waves.png", "-o", "r.obj")
        self.fails(2, "--strength 200", "relief-extract", "waves.png", "-o", "r.vdb", "--strength", 200)
        self.fails(2, "--base square", "relief-extract", "waves.png", "-o", "r.vdb", "--base", "square")
        self.fails(2, "unknown extension", "relief-extract", "waves.png", "-o", "r.txt")
        self.fails(2, "--output: missing", "relief-extract", "waves.png")
        self.fails(3, "missing.off", "relief-extract", "missing.off", "-o", "r.vdb")
        self.ok("make", "balls", "balls.vdb", "--resolution", 32)
        self.fails(1, "not flat", "relief-extract", "balls.vdb", "-o", "r.png", "--base-radius", 1.5)
        self.assertNotIn("r.png", self.files())

    def test_a_plain_model_is_said_to_have_no_relief(self):
        self.write("tet.off", "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
        self.ok("relief-extract", "tet.off", "-o", "r.vdb", "--resolution", 24)
        self.write("flat.png", png(32, 32, lambda x, y: (99,), kind=0))
        self.assertIn("no relief", self.ok("relief-extract", "flat.png", "-o", "f.vdb", "--height", 2).stderr)

    def test_a_stop_leaves_nothing(self):
        model = sample("meshes/ChineseDragon-10kv.off")
        run = subprocess.Popen([PROGRAM, "relief-extract", model, "-o", self.path("d.vdb"), "--resolution", "200"],
                               stderr=subprocess.PIPE, text=True)
        time.sleep(2)
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=60)
        self.assertEqual(run.returncode, 130)
        self.assertEqual(self.files(), ["waves.png"])

    def test_a_dragon_adds_up_to_itself(self):
        model = sample("meshes/ChineseDragon-10kv.off")
        self.ok("relief-extract", model, "-o", "d.vdb", "--resolution", 96, "--strength", 1, "--report", "d.json")
        counts = self.report("d.json")
        self.assertEqual(counts["topology"]["base"]["solid_parts"], counts["topology"]["scan"]["solid_parts"])
        self.assertLess(counts["relief"]["lost_share"], 0.001)
        self.assertGreater(counts["relief"]["Sq"], 0.2)


if __name__ == "__main__":
    unittest.main()
