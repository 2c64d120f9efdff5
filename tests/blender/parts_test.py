"""The add-on's parts that need no Blender: options and .ply files."""
import os
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    np = None

for folder in ("blender/vdb_synth", "python"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / folder))
import methods


class Methods(unittest.TestCase):
    def test_defaults_that_stand_for_the_programs_choice_are_left_out(self):
        one = methods.method("synth")
        self.assertEqual(methods.options_of(one, {}, 3), {"size": "2x,2x,1x", "resolution": 128, "seed": 3})
        self.assertEqual(methods.options_of(one, {"block": 12, "border": "tile", "draft": True, "size": "64,64,64"}, 0),
                         {"size": "64,64,64", "resolution": 128, "block": 12, "border": "tile", "draft": True, "seed": 0})
        self.assertEqual(methods.options_of(one, {"border": "AUTO"}, 0).get("border"), None)
        with self.assertRaises(KeyError):
            methods.method("nothing")

    def test_every_option_is_one_of_the_program(self):
        import subprocess
        for one in methods.METHODS:
            text = subprocess.run([os.environ["VDBSYNTH_PROGRAM"], one.command, "--help"], capture_output=True, text=True, check=True).stdout
            for choice in one.options + ([methods.Choice("seed", "whole", 0, "")] if one.options else []):
                self.assertIn("--" + choice.name + ("" if choice.kind == "flag" else " "), text, one.command)


@unittest.skipIf(np is None, "numpy is absent")
class Ply(unittest.TestCase):
    def test_there_and_back(self):
        import vdbsynth_ply as ply
        points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]])
        colours = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [2, -1, 1]])
        for faces in ([(0, 1, 2, 3)], [(0, 1, 2), (0, 2, 3)], [(0, 1, 2), (0, 1, 2, 3), (1, 2, 3)], []):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "a.ply")
                ply.write_ply(path, points, faces, colours)
                back, read, attributes = ply.read_ply(path)
                self.assertTrue(np.allclose(back, points))
                self.assertEqual([tuple(face) for face in read], faces)
                self.assertTrue(np.allclose(ply.colours_of(attributes), np.clip(colours, 0, 1), atol=1 / 255))
                ply.write_off(path, points, faces)
                back, read = ply.read_off(path)
                self.assertTrue(np.allclose(back, points))
                self.assertEqual(read, faces)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "plain.ply")
            ply.write_ply(path, points, [(0, 1, 2)])
            self.assertIsNone(ply.colours_of(ply.read_ply(path)[2]))

    def test_what_the_program_writes(self):
        import vdbsynth_ply as ply
        import subprocess
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.obj")
            with open(path, "w") as file:
                file.write("".join(f"v {x} {y} {z}\n" for x in (0, 9) for y in (0, 9) for z in (0, 9)) +
                           "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
            out = os.path.join(folder, "a.ply")
            subprocess.run([os.environ["VDBSYNTH_PROGRAM"], "convert", path, "-o", out, "--resolution", "16", "-q"], check=True)
            points, faces, _ = ply.read_ply(out)
            self.assertGreater(len(points), 100)
            self.assertLess(max(max(face) for face in faces), len(points))
            self.assertTrue(np.allclose(points.max(0), 9, atol=0.1))


if __name__ == "__main__":
    unittest.main()
