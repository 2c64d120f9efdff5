"""synth's ways, borders and holes, with the real program."""
import json
import unittest

from support import CliTest, sample


class Synth(CliTest):
    def model(self, name):
        return json.loads(self.ok("info", name, "--json").stdout)["model"]

    def test_methods_tile_and_their_words(self):
        self.ok("make", "sponge", "e.vdb", "--resolution", 32)
        hashes = set()
        for method in ("default", "exact", "paper"):
            with self.subTest(method):
                self.ok("synth", "e.vdb", "-o", "m.vdb", "--size", "2x,2x,1x", "--method", method, "--source-map", "--report", "r.json")
                model = self.model("m.vdb")
                self.assertTrue(model["valid"], model)
                self.assertEqual(model["domain"], "0,0,0,63,63,31")
                self.ok("repeat", "m.vdb", "e.vdb", "-o", "again.vdb")
                distances = json.loads(self.ok("compare", "m.vdb", "again.vdb", "--json").stdout)["others"][0]["distances"]
                self.assertEqual(distances["surface"]["hausdorff"], 0)
                hashes.add(json.dumps(model["solid_voxels"]))
        self.assertEqual(len(hashes), 3)
        self.ok("synth", "e.vdb", "-o", "t.vdb", "--size", "48,48,32", "--border", "tile,tile,cut")
        self.assertEqual(self.model("t.vdb")["domain"], "0,0,0,47,47,31")
        self.ok("synth", "e.vdb", "-o", "w.vdb", "--size", "48.2w,48w,1x", "--draft")
        self.assertEqual(self.model("w.vdb")["domain"], "0,0,0,47,47,31")
        self.fails(2, "or a length (world, with a w)", "synth", "e.vdb", "-o", "m.vdb", "--size", "2.5m,2x,1x")
        self.fails(2, "must be 1 to 1048576 voxels of 1 (world)", "synth", "e.vdb", "-o", "m.vdb", "--size", "0.1w,2x,1x")
        self.fails(2, "--method", "synth", "e.vdb", "-o", "m.vdb", "--size", "2x,2x,1x", "--method", "best")
        self.fails(2, "--border tile: needs --method default", "synth", "e.vdb", "-o", "m.vdb", "--size", "2x,2x,1x", "--border", "tile",
                   "--method", "exact")
        self.fails(2, "a power of two", "synth", "e.vdb", "-o", "m.vdb", "--size", "2x,2x,1x", "--block", 12, "--method", "paper")

    def test_controls(self):
        self.ok("make", "sponge", "a.vdb", "--resolution", 32)
        self.ok("make", "grid", "b.vdb", "--resolution", 32)
        self.ok("mask", "box", "-o", "left.vdb", "--box", "0,0,0,31,63,31")
        self.ok("synth", "a.vdb", "b.vdb", "-o", "m.vdb", "--size", "2x,2x,1x", "--exemplar-map", "left.vdb", "--source-map")
        self.assertEqual(self.model("m.vdb")["domain"], "0,0,0,63,63,31")
        self.ok("repeat", "m.vdb", "a.vdb", "b.vdb", "-o", "again.vdb")
        distances = json.loads(self.ok("compare", "m.vdb", "again.vdb", "--json").stdout)["others"][0]["distances"]
        self.assertEqual(distances["surface"]["hausdorff"], 0)
        self.fails(1, "repeat MAP EXEMPLAR1 EXEMPLAR2", "repeat", "m.vdb", "a.vdb", "-o", "again.vdb")
        # Inside any model the second; a grid of several by its name.
        self.ok("make", "balls", "ball.vdb", "--resolution", 64, "--feature", 40)
        self.ok("convert", "ball.vdb", "-o", "ball.ply")
        self.ok("synth", "a.vdb", "b.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--exemplar-map", "ball.ply")
        self.fails(3, "name the one for --guide", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--guide", "m.vdb", "--exemplar-guide", "a.vdb")
        self.ok("synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--guide", "m.vdb:surface", "--exemplar-guide", "a.vdb", "--guide-weight", 8)
        self.ok("synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--rotation-map", "ball.vdb", "--source-map")
        self.ok("repeat", "n.vdb", "a.vdb", "-o", "again.vdb")
        distances = json.loads(self.ok("compare", "n.vdb", "again.vdb", "--json").stdout)["others"][0]["distances"]
        self.assertEqual(distances["surface"]["hausdorff"], 0)
        self.fails(1, "give scales from 0.25 to 4", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--scale-map", "ball.vdb")
        self.fails(2, "give at least two", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--exemplar-map", "left.vdb")
        self.fails(2, "--guide and --exemplar-guide: give both", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--guide", "a.vdb")
        self.fails(2, "once for each exemplar", "synth", "a.vdb", "b.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--guide", "a.vdb", "--exemplar-guide", "a.vdb")
        self.fails(2, "cannot be combined with --keep", "synth", "--keep", "a.vdb", "--hole", "4,4,4,9,9,9", "-o", "n.vdb", "--exemplar-map", "left.vdb")
        self.fails(2, "needs --method default", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,2x,1x", "--rotation-map", "a.vdb", "--draft")

    def test_colours_come_along(self):
        self.ok("make", "sponge", "e.vdb", "--resolution", 32)
        self.ok("convert", "e.vdb", "-o", "e.obj")
        lines = self.read("e.obj").decode().splitlines()
        self.write("c.obj", "\n".join(f"{l} 0.25 0.5 1" if l.startswith("v ") else l for l in lines).encode() + b"\n")
        self.ok("synth", "c.obj", "-o", "m.ply", "-o", "m.vdb", "--voxel-size", 1, "--exemplar-box", "0,0,0,31,31,31", "--size", "2x,1x,1x", "--source-map")
        self.assertIn(b"property uchar red", self.read("m.ply")[:600])
        self.ok("repeat", "m.vdb", "c.obj", "-o", "again.ply", "--voxel-size", 1)
        self.assertEqual(self.read("again.ply"), self.read("m.ply"))
        self.ok("synth", "c.obj", "-o", "n.ply", "--voxel-size", 1, "--exemplar-box", "0,0,0,31,31,31", "--size", "2x,1x,1x", "--carry", "Cd")
        self.assertEqual(self.read("n.ply"), self.read("m.ply"))
        # One colour throughout: its mean is the same, but for rounding to bytes.
        self.ok("repeat", "m.vdb", "c.obj", "-o", "again.ply", "--voxel-size", 1, "--carry", "Cd", "--carry-blend")
        again, before = self.read("again.ply"), self.read("m.ply")
        self.assertEqual(len(again), len(before))
        self.assertLess(sum(a != b for a, b in zip(again, before)), len(before) / 20)
        self.fails(2, "--carry colour", "repeat", "m.vdb", "c.obj", "-o", "n.ply", "--voxel-size", 1, "--carry", "colour")
        self.fails(2, "--longest-run", "synth", "c.obj", "-o", "n.ply", "--voxel-size", 1, "--size", "2x,1x,1x", "--longest-run", 0)
        self.fails(2, "--carry colour", "synth", "c.obj", "-o", "n.ply", "--voxel-size", 1, "--exemplar-box", "0,0,0,31,31,31", "--size", "2x,1x,1x", "--carry", "colour")

    def test_holes_of_real_meshes(self):
        for name, folder in (("camelhead.off", "meshes"), ("elephant-with-holes.off", "bad")):
            with self.subTest(name):
                self.ok("convert", sample(f"{folder}/{name}"), "-o", "closed.vdb", "--resolution", 100)
                self.ok("synth", "--keep", sample(f"{folder}/{name}"), "--hole", "auto", "--resolution", 100, "-o", "filled.vdb", "-o", "filled.obj")
                self.assertTrue(self.model("filled.vdb")["valid"])
                self.assertTrue(json.loads(self.ok("info", "filled.obj", "--json").stdout)["closed_manifold"])
                closed, filled = (self.model(f"{n}.vdb")["solid_voxels"] for n in ("closed", "filled"))
                self.assertLess(abs(filled - closed) / closed, 0.05)

    def test_words_of_holes(self):
        self.ok("make", "balls", "e.vdb", "--resolution", 48)
        self.ok("synth", "--keep", "e.vdb", "--hole", "16,16,16,31,31,31", "-o", "a.vdb")
        self.ok("make", "balls", "other.vdb", "--resolution", 48, "--seed", 4)
        self.ok("synth", "other.vdb", "--keep", "e.vdb", "--hole", "16,16,16,31,31,31", "-o", "b.vdb", "--block", 8)
        self.ok("crop", "e.vdb", "-o", "mask.vdb", "--box", "16,16,16,31,31,31")
        self.ok("synth", "--keep", "e.vdb", "--hole", "mask.vdb", "-o", "c.vdb")
        for name in ("a.vdb", "b.vdb", "c.vdb"):
            self.assertTrue(self.model(name)["valid"], name)
        self.fails(2, "--hole: missing", "synth", "--keep", "e.vdb", "-o", "x.vdb")
        self.fails(2, "--hole: needs --keep", "synth", "e.vdb", "--size", "2x,2x,1x", "--hole", "auto", "-o", "x.vdb")
        self.fails(2, "--size: cannot be combined with --keep", "synth", "--keep", "e.vdb", "--hole", "auto", "--size", "2x,2x,1x", "-o", "x.vdb")
        self.fails(1, "--hole: needs a mesh", "synth", "--keep", "e.vdb", "--hole", "auto", "-o", "x.vdb")
        self.fails(1, "outside the model's domain", "synth", "--keep", "e.vdb", "--hole", "160,16,16,171,31,31", "-o", "x.vdb")
        self.fails(3, "nothere.vdb", "synth", "--keep", "nothere.vdb", "--hole", "auto", "-o", "x.vdb")


if __name__ == "__main__":
    unittest.main()
