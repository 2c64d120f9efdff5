"""Other programs read what we write: OpenVDB's tools, its Python module, Blender."""
import os
import shutil
import subprocess
import unittest

from support import CliTest

BLENDER_SCRIPT = """
import bpy, sys, numpy
numpy.bool = bool  # Debian's glTF importer asks for it, its numpy has it no more
for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    kind = path.rsplit(".", 1)[1]
    if kind == "obj": bpy.ops.wm.obj_import(filepath=path)
    elif kind == "ply": bpy.ops.import_mesh.ply(filepath=path)
    elif kind == "stl": bpy.ops.import_mesh.stl(filepath=path)
    elif kind == "vdb": bpy.ops.object.volume_import(filepath=path, files=[{"name": path}])
    else: bpy.ops.import_scene.gltf(filepath=path)
    for item in bpy.data.objects:
        if item.type == "MESH":
            print("READ", kind, len(item.data.vertices), len(item.data.color_attributes))
        if item.type == "VOLUME":
            item.data.grids.load()
            print("READ", kind, *sorted(f"{g.name}:{g.data_type}" for g in item.data.grids))
"""


class Programs(CliTest):
    def setUp(self):
        super().setUp()
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = ("0 1 3 2", "4 6 7 5", "0 4 5 1", "2 3 7 6", "0 2 6 4", "1 5 7 3")
        rows = [f"{x} {y} {z} {255 * x} {255 * y} {255 * z} 255" for x, y, z in corners] + [f"4 {f}" for f in faces]
        self.write("cube.off", "COFF\n8 6 0\n" + "\n".join(rows) + "\n")
        self.ok("convert", "cube.off", *[w for k in ("vdb", "obj", "ply", "stl", "glb", "gltf") for w in ("-o", f"out.{k}")],
                "--resolution", 20)

    def run_other(self, *words):
        if not shutil.which(words[0]):
            self.skipTest(f"{words[0]} is absent")
        result = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, (result.stderr + result.stdout)[-2000:])
        return result.stdout

    def test_openvdb_tools(self):
        listing = self.run_other("vdb_print", "-l", "out.vdb")
        self.assertIn("Name: surface", listing)
        self.assertIn("Name: Cd", listing)
        self.run_other("vdb_render", "out.vdb", "out.ppm", "-name", "surface", "-res", "64x48")
        self.assertGreater(os.path.getsize(self.path("out.ppm")), 64 * 48 * 3)
        self.run_other("vdb_tool", "-read", "out.vdb", "-ls2mesh", "-write", "again.ply")
        self.assertTrue(self.read("again.ply").startswith(b"ply"))

    def test_python_module(self):
        script = ("import pyopenvdb as v\ng, m = v.readAll('out.vdb')\nn = {x.name: x for x in g}\n"
                  "assert m['vdbsynth:command'] == 'convert', m\ns = n['surface']\nassert s.gridClass == 'level set'\n"
                  "assert abs(s.transform.voxelSize()[0] - 0.05) < 1e-6\nassert s.getConstAccessor().getValue((10, 10, 10)) < 0\n"
                  "assert n['Cd'].activeVoxelCount() == s.activeVoxelCount()\n")
        result = subprocess.run(["/usr/bin/python3", "-c", script], cwd=self.folder, capture_output=True, text=True)
        if "No module named" in result.stderr:
            self.skipTest("python3-openvdb is absent")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_blender(self):
        self.write("read.py", BLENDER_SCRIPT)
        words = self.run_other("blender", "-b", "--python-exit-code", "1", "-P", self.path("read.py"), "--",
                               *[self.path(f"out.{k}") for k in ("obj", "ply", "stl", "glb", "gltf", "vdb")])
        read = dict(line.split(" ", 2)[1:] for line in words.splitlines() if line.startswith("READ "))
        self.assertEqual(read["vdb"], "Cd:VECTOR_FLOAT surface:FLOAT")
        for kind in ("obj", "ply", "glb", "gltf"):
            vertices, colours = read[kind].split()
            self.assertEqual(colours, "1", kind)
            self.assertEqual(vertices, read["obj"].split()[0])
        self.assertEqual(read["stl"].split()[0], read["obj"].split()[0])


if __name__ == "__main__":
    unittest.main(verbosity=2)
