"""repeat: the maps of every method give their results back, whatever kind of grids they are written as."""
import subprocess
import unittest

from support import CliTest, sample

READ_MAP = """
import sys, pyopenvdb as v
grids = {g['name'] if isinstance(g, dict) else g.name: g for g in v.readAllGridMetadata(sys.argv[1])}
assert 'source' in grids and 'exemplar' in grids, sorted(grids)
source = v.read(sys.argv[1], 'source')
assert source.activeVoxelCount() > 1000
print(' '.join(sorted(grids)))
"""


class Repeat(CliTest):
    def same_surface(self, a, b):
        """Meshes of equal grids are equal bytes; metadata of the two files differs."""
        for name in (a, b):
            self.ok("convert", name, "-o", name + ".stl")
        self.assertEqual(self.read(a + ".stl"), self.read(b + ".stl"))

    def python(self, *words):
        done = subprocess.run(["/usr/bin/python3", "-c", READ_MAP, *words], cwd=self.folder, capture_output=True, text=True)
        if "No module named" in done.stderr:
            self.skipTest("python3-openvdb is absent")
        return done

    def test_an_analogy(self):
        self.ok("make", "grooves", "a.vdb", "a2.vdb", "--resolution", 48)
        self.ok("make", "three-tori", "b.vdb", "--resolution", 64)
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "made.vdb", "--source-map", "map.vdb", "--direction", "around:z",
                "--scale", 1.1, "--levels", 2)
        self.ok("repeat", "map.vdb", "a2.vdb", "b.vdb", "-o", "again.vdb")
        self.same_surface("made.vdb", "again.vdb")
        # Another A2 over the same A: another look, and a word that it is another.
        self.ok("make", "grooves", "c.vdb", "c2.vdb", "--resolution", 48, "--seed", 5)
        other = self.ok("repeat", "map.vdb", "c2.vdb", "b.vdb", "-o", "other.vdb")
        self.assertIn("is not the one that the map was made with", other.stderr)
        self.fails(1, "repeat MAP A2 B", "repeat", "map.vdb", "a2.vdb", "-o", "o.vdb")
        self.fails(2, "--carry-blend", "repeat", "map.vdb", "a2.vdb", "b.vdb", "-o", "o.vdb", "--carry-blend")

    def test_an_analogy_on_a_mesh(self):
        bunny = sample("meshes/bunny.off")
        self.ok("make", "pits", "a.vdb", "a2.vdb", "--resolution", 64)
        self.ok("analogy", "a.vdb", "a2.vdb", bunny, "-o", "made.vdb", "--source-map", "--resolution", 60, "--direction", "axis:z")
        # The map lies beside the surface; the mesh is read at the map's voxel size.
        self.ok("repeat", "made.vdb", "a2.vdb", bunny, "-o", "again.vdb")
        self.same_surface("made.vdb", "again.vdb")

    def test_a_filled_hole(self):
        self.ok("make", "sponge", "whole.vdb", "--resolution", 64)
        for words, inputs in (([], []), (["other.vdb"], ["other.vdb"])):
            self.ok("make", "sponge", "other.vdb", "--resolution", 48, "--seed", 3)
            self.ok("synth", *words, "--keep", "whole.vdb", "--hole", "24,24,24,39,39,39", "-o", "filled.vdb", "--source-map", "map.vdb")
            self.ok("repeat", "map.vdb", *inputs, "whole.vdb", "-o", "again.vdb")
            self.same_surface("filled.vdb", "again.vdb")
        self.fails(1, "repeat MAP EXEMPLAR KEPT", "repeat", "map.vdb", "whole.vdb", "-o", "o.vdb")

    def test_a_map_that_python_reads(self):
        self.ok("make", "grid", "grid.vdb", "--resolution", 40)
        self.ok("synth", "grid.vdb", "-o", "more.vdb", "--size", "2x,1x,1x", "--source-map", "--map-types", "float")
        done = self.python("more.vdb")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.split(), ["exemplar", "source", "surface", "vote_source", "vote_weight"])
        self.ok("repeat", "more.vdb", "grid.vdb", "-o", "again.vdb")
        self.same_surface("more.vdb", "again.vdb")
        # As whole numbers, the default, this module refuses the file's whole list.
        self.ok("synth", "grid.vdb", "-o", "whole.vdb", "--size", "2x,1x,1x", "--source-map")
        self.assertNotEqual(self.python("whole.vdb").returncode, 0)
        self.same_surface("more.vdb", "whole.vdb")

    def test_models_in_another_order(self):
        self.ok("make", "grooves", "a.vdb", "a2.vdb", "--resolution", 48)
        self.ok("make", "three-tori", "b.vdb", "--resolution", 48)
        self.ok("analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "made.vdb", "--source-map", "map.vdb", "--levels", 1, "--sweeps", 1)
        self.fails(1, "b.vdb: was model 2 of the map's run", "repeat", "map.vdb", "b.vdb", "a2.vdb", "-o", "o.vdb")
        self.fails(2, "--resolution", "repeat", "map.vdb", "a2.vdb", "b.vdb", "-o", "o.vdb", "--resolution", 30)
        self.fails(3, "none.vdb: no such file", "repeat", "map.vdb", "none.vdb", "b.vdb", "-o", "o.vdb")
        size = len(self.read("map.vdb"))
        self.write("cut.vdb", self.read("map.vdb")[: size // 2])
        self.fails(3, "truncated", "repeat", "cut.vdb", "a2.vdb", "b.vdb", "-o", "o.vdb")

    def test_a_map_replaces_no_model(self):
        self.ok("make", "grid", "s.vdb", "--resolution", 40)
        self.ok("make", "grid", "g.vdb", "--resolution", 40, "--seed", 2)
        before = self.read("s.vdb")
        self.fails(2, "put a --source-map without FILE last", "synth", "-o", "x.vdb", "--size", "1x,1x,1x", "--source-map", "s.vdb", "g.vdb")
        self.assertEqual(self.read("s.vdb"), before)
        self.fails(2, "--map-types: needs --source-map", "synth", "g.vdb", "-o", "x.vdb", "--size", "1x,1x,1x", "--map-types", "float")
        # A map is replaced by a map, and a report replays a run that wrote one.
        for _ in range(2):
            self.ok("synth", "g.vdb", "-o", "x.vdb", "--size", "1x,1x,1x", "--source-map", "m.vdb")
        self.ok("synth", "g.vdb", "-o", "y.vdb", "--size", "1x,1x,1x", "--source-map", "--report", "r.json")
        self.assertIn('"source-map": true', self.read("r.json").decode())
        self.ok("synth", "-o", "z.vdb", "--config", "r.json")
        self.assertEqual(self.read("y.vdb"), self.read("z.vdb"))

    def test_what_is_no_map(self):
        self.ok("make", "grid", "grid.vdb", "--resolution", 40)
        self.fails(3, "holds no source map", "repeat", "grid.vdb", "grid.vdb", "-o", "o.vdb")
        self.fails(2, "--map-types", "synth", "grid.vdb", "-o", "o.vdb", "--size", "2x,1x,1x", "--source-map", "--map-types", "big")


if __name__ == "__main__":
    unittest.main()
