"""What the SOPs do when they cook: the real program, under a small fake of hou."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    np = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "houdini_examples" / "scripts" / "python"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import fake_hou as hou

hou.install()
from vdbsynth_houdini import assets, methods

PROGRAM = os.environ["VDBSYNTH_PROGRAM"]
CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
OUTWARD = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # counter-clockwise from outside
CLOCKWISE = [face[::-1] for face in OUTWARD]                                                     # as Houdini winds them


def volume(points, faces):
    """Signed: positive where faces are counter-clockwise seen from outside."""
    total = 0.0
    for face in faces:
        for second, third in zip(face[1:], face[2:]):
            total += np.dot(points[face[0]], np.cross(points[second], points[third])) / 6
    return total


@unittest.skipIf(np is None, "numpy is absent")
class Cook(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_cook_test_")
        hou.InterruptableOperation.interrupt_after = None
        hou.InterruptableOperation.calls = []

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def make(self, *words):
        subprocess.run([PROGRAM, "make", *words], cwd=self.folder, check=True, capture_output=True)

    def node(self, command, inputs=(), inside=False, **values):
        one = methods.method(command)
        parms = {}
        for name, _, kind, default, _, _, _, choices in assets.parameters(one):
            parms[name] = hou.Parm(values.get(name, default), [token for token, _ in choices])
        parms["vdbsynth_program"] = hou.Parm(PROGRAM)
        parms["vdbsynth_cache"] = hou.Parm(self.path("cache"))
        wired = [geometry and hou.SopNode({}, geometry=geometry) for geometry in inputs]
        if inside:
            return hou.SopNode({}, wired, parent=hou.SopNode(parms))
        return hou.SopNode(parms, wired, inputs[0] if inputs else None)

    def cook(self, command, node):
        code = compile(assets.code(methods.method(command)), command, "exec")
        hou.pwd = lambda: node
        exec(code, {})

    def test_vdb_in_and_out(self):
        self.make("balls", "a.vdb", "--resolution", "24")
        for inside in (False, True):
            node = self.node("synth", [hou.Geometry(vdb=self.path("a.vdb"))], inside, size="2x,1x,1x")
            self.cook("synth", node)
            result = node.geometry()
            self.assertTrue(result.loaded.endswith(".vdb"))
            self.assertEqual(json.loads(result.globals["vdbsynth_report"])["command"], "synth")
            answer = subprocess.run([PROGRAM, "info", result.loaded, "--json"], check=True, capture_output=True, text=True)
            self.assertIn("surface", answer.stdout)
        self.assertEqual(len(os.listdir(self.path("cache"))), 2)  # the second cook took the first one's result
        self.assertTrue(hou.InterruptableOperation.calls)

    def test_result_is_a_grid_that_other_programs_read(self):
        try:
            import pyopenvdb
        except ImportError:
            self.skipTest("pyopenvdb is absent")
        self.make("balls", "a.vdb", "--resolution", "24")
        node = self.node("synth", [hou.Geometry(vdb=self.path("a.vdb"))], size="2x,1x,1x")
        self.cook("synth", node)
        before, after = (pyopenvdb.read(path, "surface") for path in (self.path("a.vdb"), node.geometry().loaded))
        self.assertEqual(after.gridClass, before.gridClass)
        self.assertEqual(after.transform.voxelSize(), before.transform.voxelSize())
        self.assertAlmostEqual(after.background, 3 * after.transform.voxelSize()[0], 5)

    def test_polygons_keep_side_place_and_winding(self):
        points = [tuple(2 * value + 10 for value in point) for point in CUBE]
        node = self.node("synth", [hou.Geometry(points, CLOCKWISE)], size="1x,1x,1x", resolution=24, vdbsynth_result="mesh")
        self.cook("synth", node)
        result = node.geometry()
        faces = [[vertex.point().number() for vertex in prim.vertices()] for prim in result.iterPrims()]
        table = np.array(result.points)
        self.assertAlmostEqual(volume(table, faces), -8, delta=0.5)  # clockwise again
        self.assertTrue(np.allclose(table.min(0), 10, atol=0.1) and np.allclose(table.max(0), 12, atol=0.1))

    def test_texture_gives_colours(self):
        self.make("terrain", "height.vdb", "--resolution", "32", "-o", "height.png")
        node = self.node("texture", [hou.Geometry([tuple(3 * v for v in p) for p in CUBE], CLOCKWISE)], image_file=self.path("height.png"), scale=0.5)
        self.cook("texture", node)
        result = node.geometry()
        self.assertEqual(len(result.attributes["Cd"]), 3 * len(result.points))
        self.assertTrue(result.prims)

    def test_analogy_and_relief_order_of_inputs(self):
        self.make("spikes", "plain.vdb", "textured.vdb", "--resolution", "64")
        plain, textured = (hou.Geometry(vdb=self.path(name)) for name in ("plain.vdb", "textured.vdb"))
        node = self.node("analogy", [hou.Geometry(CUBE, CLOCKWISE), plain, textured], resolution=24)
        self.cook("analogy", node)
        self.assertTrue(node.geometry().loaded.endswith(".vdb"))
        # A file stands in for an input that is not connected.
        node = self.node("relief", [hou.Geometry(CUBE, CLOCKWISE), None], resolution=24, sample_file=self.path("textured.vdb"), draft=1)
        try:
            self.cook("relief", node)
        except hou.NodeWarning:
            pass
        self.assertTrue(node.geometry().loaded.endswith(".vdb"))

    def test_compare_keeps_the_geometry(self):
        self.make("balls", "a.vdb", "--resolution", "24")
        self.make("balls", "b.vdb", "--resolution", "24", "--seed", "2")
        geometry = hou.Geometry(vdb=self.path("b.vdb"))
        node = self.node("compare", [geometry, hou.Geometry(vdb=self.path("a.vdb"))])
        self.cook("compare", node)
        self.assertEqual(geometry.loaded, "")
        self.assertTrue(json.loads(geometry.globals["vdbsynth_report"]))

    def test_errors_and_warnings(self):
        def says(pattern, command, inputs=(), **values):
            with self.assertRaisesRegex(hou.NodeError, pattern):
                self.cook(command, self.node(command, inputs, **values))
        says("Exemplar: connect input 1 or choose a file", "synth")
        says("Image: choose a file", "texture", [hou.Geometry(CUBE, CLOCKWISE)])
        says("gone.vdb is not there", "synth", exemplar_file=self.path("gone.vdb"))
        says("neither polygons", "synth", [hou.Geometry()])
        says("neither polygons", "synth", [hou.Geometry(CUBE, others=2)])
        says("no closed polygons", "synth", [hou.Geometry(CUBE, curves=[(0, 1, 2)])])
        self.make("balls", "a.vdb", "--resolution", "24")
        says("polygons and VDBs", "synth", [hou.Geometry(CUBE, CLOCKWISE, vdb=self.path("a.vdb"))])
        says("--size", "synth", [hou.Geometry(vdb=self.path("a.vdb"))], size="many")
        node = self.node("synth", [hou.Geometry(CUBE, CLOCKWISE, others=1, curves=[(0, 1, 2)])], size="1x,1x,1x", resolution=24)
        with self.assertRaisesRegex(hou.NodeWarning, "1 primitives are neither.*\n.*1 open curves"):
            self.cook("synth", node)
        self.assertTrue(node.geometry().loaded)  # the result is there in spite of the warning

    def test_escape_stops_the_program(self):
        self.make("balls", "a.vdb", "--resolution", "64")
        hou.InterruptableOperation.interrupt_after = 3
        geometry = hou.Geometry(vdb=self.path("a.vdb"))
        with self.assertRaises(hou.OperationInterrupted):
            self.cook("synth", self.node("synth", [geometry], size="4x,4x,4x"))
        self.assertEqual(os.listdir(self.path("cache")), [])
        self.assertEqual(geometry.loaded, "")


if __name__ == "__main__":
    unittest.main()
