"""analogy with the real program: its outputs, its words, what it refuses."""
import json
import subprocess
import unittest

from support import CliTest


class Analogy(CliTest):
    def model(self, name):
        return json.loads(self.ok("info", name, "--json").stdout)["model"]

    def setUp(self):
        super().setUp()
        self.ok("make", "dilation", "a.vdb", "a2.vdb", "--resolution", 48)
        self.ok("make", "three-tori", "b.vdb", "--resolution", 64)

    def test_result_report_and_map(self):
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "-o", "m.ply", "--direction", "around:z", "--source-map", "--write-directions",
                "--report", "r.json")
        with open(self.path("r.json")) as file:
            report = json.load(file)
        self.assertEqual(report["counts"]["levels"][-1]["voxels"] > 1000, True)
        self.assertIn("singularities", report["counts"])
        self.assertEqual(report["quality"]["band_gaps"], 0)
        self.assertGreater(self.model("m.vdb")["solid_voxels"], 1.2 * self.model("b.vdb")["solid_voxels"])
        names = {grid["name"] for grid in json.loads(self.ok("info", "m.vdb", "--json").stdout)["grids"]}
        self.assertLessEqual({"surface", "source", "exemplar", "source_rotation", "direction"}, names)
        self.ok("render", "b.vdb", "-o", "d.png", "--directions", "m.vdb:direction", "--size", "160x120")
        self.ok("render", "b.vdb", "-o", "e.png", "--size", "160x120")
        self.assertNotEqual(self.read("d.png"), self.read("e.png"))
        self.fails(3, "vectors of floats", "render", "b.vdb", "-o", "d.png", "--directions", "b.vdb")
        # The field that was written gives the same result when it is read.
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "n.vdb", "--direction", "m.vdb:direction")
        self.assertAlmostEqual(self.model("n.vdb")["solid_voxels"] / self.model("m.vdb")["solid_voxels"], 1, places=2)
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "t1.vdb", "--direction", "radial", "--threads", 1)
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "t2.vdb", "--direction", "radial", "--threads", 3)
        self.assertEqual(self.read("t1.vdb"), self.read("t2.vdb"))

    def test_a_pair_of_level_sets_is_resampled_together(self):
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--exemplar-resolution", 40)
        self.assertGreater(self.model("m.vdb")["solid_voxels"], 1.2 * self.model("b.vdb")["solid_voxels"])

    def test_texture_size_is_the_scale_in_world_units(self):
        corners = list(map(int, self.model("a.vdb")["domain"].split(",")))
        side = max(corners[k + 3] - corners[k] + 1 for k in range(3))
        voxel = self.model("b.vdb")["voxel_size"]
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "s.vdb", "--scale", 0.5)
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "t.vdb", "--texture-size", 0.5 * side * voxel)
        self.assertEqual(self.model("s.vdb")["solid_voxels"], self.model("t.vdb")["solid_voxels"])
        words = ("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "x.vdb", "--texture-size")
        self.fails(2, "give one of them", *words, 10, "--scale", 1)
        self.fails(2, "a scale of", *words, 1000 * side * voxel)
        self.fails(2, f"here sizes from {0.25 * side * voxel:.4g} to {4 * side * voxel:.4g} fit", *words, 1000 * side * voxel)

    def test_strokes(self):
        self.write("s.csv", "32,10,32,1,0,0\n32,54,32,-1,0,0\n")
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "s.csv")
        self.write("s.json", json.dumps([{"position": [32, 10, 32], "direction": [1, 0, 0]}]))
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "s.json")
        # As spreadsheets write them: with a header, in any order.
        self.write("h.csv", "x,y,z,dx,dy,dz\n32,10,32,1,0,0\n32,54,32,-1,0,0\n")
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "h.vdb", "--direction", "h.csv")
        self.write("o.csv", "\"name\",DX,DY,DZ,X,Y,Z\n1,1,0,0,32,10,32\n2,-1,0,0,32,54,32\n")
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "o.vdb", "--direction", "o.csv")
        self.write("w.csv", "x,y,z,u,v,w\n32,10,32,1,0,0\n")
        self.fails(3, "w.csv:1: neither six numbers nor a header", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "w.csv")
        self.write("n.csv", "1,2,3,0,x,0\n")
        self.fails(3, "n.csv:1: column dy is no number", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "n.csv")
        self.write("bad.csv", "1,2,3,0,0,0\n")
        self.fails(3, "stroke 1 has no position or no direction", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "bad.csv")
        self.write("bad.json", "[{\"position\": 1}]")
        self.fails(3, "not a list of", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "bad.json")
        self.write("short.csv", "1,2,3,4\n")
        self.fails(3, "short.csv", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "short.csv")

    def test_refusals(self):
        self.fails(2, "too few inputs", "analogy", "a.vdb", "a2.vdb", "-o", "m.vdb")
        self.fails(2, "an even number of inputs", "analogy", "a.vdb", "a2.vdb", "a.vdb", "b.vdb", "-o", "m.vdb")
        self.fails(2, "--direction", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--direction", "axis:w")
        self.fails(2, "--sweeps 0: must be a whole number from 1 to 10", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--sweeps", 0)
        self.fails(2, "--samples", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--samples", 4)
        self.fails(2, "--scale", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--scale", 100)
        self.fails(2, "takes no direction", "analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb", "--naive", "--direction", "radial")
        self.fails(3, "no-such.vdb", "analogy", "no-such.vdb", "a2.vdb", "b.vdb", "-o", "m.vdb")
        for length in (200, 3000, 20000):
            self.write("cut.vdb", self.read("a2.vdb")[:length])
            self.fails(3, "truncated", "analogy", "a.vdb", "cut.vdb", "b.vdb", "-o", "m.vdb")
        self.ok("make", "dilation", "c.vdb", "c2.vdb", "--resolution", 48, "--voxel-size", 0.5)
        self.fails(1, "same --voxel-size", "analogy", "a.vdb", "c2.vdb", "b.vdb", "-o", "m.vdb")
        self.fails(2, "give two outputs", "make", "grooves", "g.vdb")
        self.fails(1, "gives no direction", "analogy", "a.vdb", "a2.vdb", self.slab(), "-o", "m.vdb")

    def test_filter_on_numbers(self):
        """--naive on fog volumes learns what was done to the numbers and says how far off it is."""
        self.fog("f.vdb", 1)
        self.fog("g.vdb", 2)
        self.ok("analogy", "f.vdb", "f.vdb", "g.vdb", "-o", "same.vdb", "--naive", "--report", "r.json")
        with open(self.path("r.json")) as file:
            counts = json.load(file)["counts"]
        self.assertGreater(counts["rows"], 1000)
        self.assertLess(counts["affine_error"], 1e-3)
        grid = json.loads(self.ok("info", "same.vdb", "--json").stdout)["grids"][0]
        self.assertEqual((grid["name"], grid["class"]), ("density", "fog volume"))
        self.fails(2, "--scale", "analogy", "f.vdb", "f.vdb", "g.vdb", "-o", "o.vdb", "--naive", "--scale", 2)
        self.fails(2, "o.ply", "analogy", "f.vdb", "f.vdb", "g.vdb", "-o", "o.ply", "--naive")
        self.fails(1, "is a level set", "analogy", "f.vdb", "f.vdb", "b.vdb", "-o", "o.vdb", "--naive")

    def fog(self, name, seed):
        """A fog volume of two balls."""
        script = ("import sys, pyopenvdb as v\n"
                  "g = v.FloatGrid()\n"
                  "g.name, g.gridClass = 'density', v.GridClass.FOG_VOLUME\n"
                  "a = g.getAccessor()\n"
                  "for x in range(32):\n"
                  "  for y in range(32):\n"
                  "    for z in range(32):\n"
                  "      d = min(((x-10)**2+(y-12)**2+(z-12-k)**2)**.5-6 for k in (0, 3 * int(sys.argv[2])))\n"
                  "      if d < 1: a.setValueOn((x, y, z), min(1, .5 - d / 2))\n"
                  "v.write(sys.argv[1], g)\n")
        done = subprocess.run(["/usr/bin/python3", "-c", script, self.path(name), str(seed)], capture_output=True, text=True, check=False)
        if "No module named" in done.stderr:
            self.skipTest("pyopenvdb is absent")
        self.assertEqual(done.returncode, 0, done.stderr)

    def slab(self):
        self.ok("make", "pits", "slab.vdb", "slab2.vdb")
        return "slab.vdb"


if __name__ == "__main__":
    unittest.main()
