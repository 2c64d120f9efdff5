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

    def test_direction(self):
        self.ok("make", "fibres", "a.vdb", "--resolution", 32)
        base = ("synth", "a.vdb", "-o", "m.vdb", "--size", "2x,2x,1x")
        self.assertIn("--exemplar-direction: not given; the exemplar is taken to run along axis:x", self.ok(*base, "--direction", "around:z").stderr)
        around = self.read("m.vdb")
        # A grid of the same directions, and strokes.
        self.write("s.csv", b"x,y,z,dx,dy,dz\n0,0,16,1,0,0\n64,64,16,0,1,0\n")
        self.assertNotIn("not given", self.ok(*base, "--direction", "s.csv", "--exemplar-direction", "1,0,0").stderr)
        self.assertNotEqual(self.read("m.vdb"), around)
        self.ok(*base, "--direction", "a.vdb", "--exemplar-direction", "axis:x")
        self.fails(2, "--direction and --rotation-map: give one", *base, "--direction", "around:z", "--rotation-map", "a.vdb")
        self.fails(2, "--exemplar-direction: needs --direction", *base, "--exemplar-direction", "axis:x")
        self.fails(2, "--exemplar-direction not an axis: must be an axis", *base, "--direction", "around:z", "--exemplar-direction", "radial")
        self.fails(2, "space has not", *base, "--direction", "curvature")
        self.fails(2, "--direction 0,0,0: must be", *base, "--direction", "0,0,0")
        self.fails(2, "--direction: needs --method default", *base, "--direction", "around:z", "--draft")
        self.fails(2, "--direction: an object border", *base, "--direction", "around:z", "--border", "object")
        self.fails(2, "cannot be combined with --keep", "synth", "--keep", "a.vdb", "--hole", "4,4,4,9,9,9", "-o", "n.vdb", "--direction", "around:z")

    def test_boxes_in_world_units(self):
        self.ok("make", "balls", "a.vdb", "--resolution", 40, "--voxel-size", 0.5)
        self.ok("crop", "a.vdb", "-o", "c.vdb", "--box", "4,4,4,23,23,23")
        self.ok("crop", "a.vdb", "-o", "w.vdb", "--box", "2w,2w,2w,12w,12w,12w")
        self.assertEqual(self.model("w.vdb")["domain"], "4,4,4,23,23,23")
        self.assertEqual(self.model("w.vdb")["solid_voxels"], self.model("c.vdb")["solid_voxels"])
        self.ok("crop", "a.vdb", "-o", "m.vdb", "--box", "2w,4,4,12w,23,23")
        self.assertEqual(self.model("m.vdb")["domain"], "4,4,4,23,23,23")
        # Half the voxels, the same box.
        self.ok("crop", "a.vdb", "-o", "h.vdb", "--box", "2w,2w,2w,12w,12w,12w", "--voxel-size", 0.25)
        self.assertEqual(self.model("h.vdb")["domain"], "8,8,8,47,47,47")
        self.ok("synth", "a.vdb", "-o", "s.vdb", "--exemplar-box", "2w,2w,2w,12w,12w,12w", "--size", "15w,1x,1x")
        self.assertEqual(self.model("s.vdb")["domain"], "4,4,4,33,23,23")
        self.assertNotIn("--voxel-size", self.ok("mask", "box", "-o", "k.vdb", "--box", "0w,0w,0w,1w,2w,3w", "--voxel-size", 0.5).stderr)
        self.assertIn("voxels are 1 wide (world), and the box takes 1 x 2 x 3 of them",
                      self.ok("mask", "box", "-o", "wide.vdb", "--box", "0w,0w,0w,1w,2w,3w").stderr)
        grid = json.loads(self.ok("info", "k.vdb", "--json").stdout)["grids"][0]
        self.assertEqual(grid["active_voxels"], 2 * 4 * 6)
        self.ok("synth", "--keep", "a.vdb", "--hole", "8,8,8,23,23,23", "-o", "x.vdb")
        self.ok("synth", "--keep", "a.vdb", "--hole", "4w,4w,4w,12w,12w,12w", "-o", "y.vdb")
        self.assertEqual(self.model("x.vdb")["solid_voxels"], self.model("y.vdb")["solid_voxels"])
        self.fails(2, "--box 2m,2w,2w,12w,12w,12w: must be six numbers", "crop", "a.vdb", "-o", "n.vdb", "--box", "2m,2w,2w,12w,12w,12w")
        self.fails(2, "with a w (world)", "synth", "a.vdb", "-o", "n.vdb", "--exemplar-box", "2x,2w,2w,12w,12w,12w", "--size", "2x,1x,1x")
        self.fails(2, "--box 2.1w,2w,2w,2.2w,12w,12w: holds no voxel", "crop", "a.vdb", "-o", "n.vdb", "--box", "2.1w,2w,2w,2.2w,12w,12w")

    def world_corner(self, name):
        """Of the domain: half a voxel outside its first voxel, from a mesh's box in the world."""
        self.ok("convert", name, "-o", "corner.ply")
        return json.loads(self.ok("info", "corner.ply", "--json").stdout)["bounds_min"]

    def test_origin(self):
        # A grid whose bars reach every face of its domain.
        self.ok("make", "foam", "a.vdb", "--resolution", 32, "--voxel-size", 0.5)
        self.ok("synth", "a.vdb", "-o", "p.vdb", "--size", "2x,1x,1x")
        self.ok("synth", "a.vdb", "-o", "m.vdb", "--size", "2x,1x,1x", "--origin", "10w,-2,3.25", "--source-map")
        plain, moved = self.world_corner("p.vdb"), self.world_corner("m.vdb")
        for axis, (at, by) in enumerate(zip(moved, (10, -2, 3.25))):
            self.assertAlmostEqual(at - plain[axis], by + 0.25, places=4)
        self.ok("repeat", "m.vdb", "a.vdb", "-o", "again.vdb")
        self.assertEqual(json.loads(self.ok("compare", "m.vdb", "again.vdb", "--json").stdout)["others"][0]["distances"]["surface"]["hausdorff"], 0)
        self.ok("repeat", "m.vdb", "a.vdb", "-o", "r.vdb", "--origin", "0,0,0")
        self.assertAlmostEqual(self.world_corner("r.vdb")[0] - plain[0], 0.25, places=4)
        self.fails(2, "--origin 1m,0,0: must be three numbers", "synth", "a.vdb", "-o", "n.vdb", "--size", "2x,1x,1x", "--origin", "1m,0,0")
        self.fails(2, "cannot be combined with --keep", "synth", "--keep", "a.vdb", "--hole", "4,4,4,9,9,9", "-o", "n.vdb", "--origin", "0,0,0")
        self.ok("synth", "--keep", "a.vdb", "--hole", "8,8,8,23,23,23", "-o", "k.vdb", "--source-map")
        self.fails(2, "--origin: only results of a synthesis", "repeat", "k.vdb", "a.vdb", "-o", "n.vdb", "--origin", "0,0,0")

    def test_masks_of_other_voxels_and_kinds(self):
        self.ok("make", "balls", "a.vdb", "--resolution", 48)
        base = ("synth", "a.vdb", "--size", "2x,1x,1x", "-o")
        self.ok("mask", "box", "-o", "k.vdb", "--box", "0,0,0,31,47,47")
        self.ok("mask", "box", "-o", "h.vdb", "--box", "0,0,0,63,95,95", "--voxel-size", 0.5)
        self.ok(*base, "o.vdb", "--exemplar-mask", "k.vdb")
        self.ok(*base, "s.vdb", "--exemplar-mask", "h.vdb")
        self.assertEqual(self.model("o.vdb")["solid_voxels"], self.model("s.vdb")["solid_voxels"])
        # A box as a mesh, as a level set of other bands and voxels, as fog.
        ends = [(x, y, z) for x in (-0.4, 31.4) for y in (-0.4, 47.4) for z in (-0.4, 47.4)]
        faces = ("0 1 3 2", "4 6 7 5", "0 4 5 1", "2 3 7 6", "0 2 6 4", "1 5 7 3")
        self.write("b.off", "OFF\n8 6 0\n" + "".join("%g %g %g\n" % e for e in ends) + "".join(f"4 {f}\n" for f in faces))
        self.ok("convert", "b.off", "-o", "b2.vdb", "--voxel-size", 1.37, "--half-width", 2)
        self.ok("convert", "b.off", "-o", "b8.vdb", "--voxel-size", 0.5, "--half-width", 8)
        for mask in ("b.off", "b2.vdb", "b8.vdb"):
            self.ok(*base, "s.vdb", "--exemplar-mask", mask)
            self.assertEqual(self.model("s.vdb")["domain"], self.model("o.vdb")["domain"], mask)
            # Voxels of 1.37 round the box's edges.
            self.assertAlmostEqual(self.model("s.vdb")["solid_voxels"] / self.model("o.vdb")["solid_voxels"], 1, delta=0.01 if mask == "b2.vdb" else 0)
        found = json.loads(self.ok("match", "a.vdb", "a.vdb", "--block", 8, "--at", "28,8,8", "--mask", "b.off").stdout)
        self.assertEqual(found["known_samples"], 4 * 8 * 8)
        self.assertEqual(found["matches"][0]["position"], [28, 8, 8])

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
