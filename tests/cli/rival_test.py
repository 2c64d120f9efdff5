"""Agreement with vdb_tool and pyopenvdb on closed meshes, where they are installed."""
import json
import shutil
import subprocess
import unittest

from support import CliTest, sample

try:
    import numpy
    import pyopenvdb
except ImportError:
    pyopenvdb = None


@unittest.skipUnless(pyopenvdb and shutil.which("vdb_tool"), "python3-openvdb, numpy or vdb_tool is absent")
class Rival(CliTest):
    def compare(self, name, voxel):
        mesh = sample(name)
        self.ok("convert", mesh, "-o", "ours.vdb", "--voxel-size", voxel)
        source = mesh
        if not name.endswith((".obj", ".ply", ".stl")):
            # vdb_tool reads no .off.
            points, faces = self.read_off(mesh)
            source = self.write("mesh.obj", "".join(f"v {p}\n" for p in points) + "".join(f"f {f}\n" for f in faces))
        subprocess.run(["vdb_tool", "-read", source, "-mesh2ls", f"voxel={voxel}", "width=3", "-write", "theirs.vdb"], cwd=self.folder, check=True,
                       capture_output=True)
        ours = pyopenvdb.read(self.path("ours.vdb"), "surface")
        theirs = pyopenvdb.readAll(self.path("theirs.vdb"))[0][0]
        low, high = theirs.evalActiveVoxelBoundingBox()
        shape = tuple(h - l + 1 for l, h in zip(low, high))
        a, b = numpy.zeros(shape, dtype=numpy.float32), numpy.zeros(shape, dtype=numpy.float32)
        ours.copyToArray(a, ijk=low)
        theirs.copyToArray(b, ijk=low)
        self.assertLess(float(numpy.abs(a - b).max()) / voxel, 1e-4)

    @staticmethod
    def read_off(path):
        lines = [line for line in open(path).read().splitlines()[1:] if line.strip() and not line.startswith("#")]
        vertices, faces = map(int, lines[0].split()[:2])
        points = [" ".join(line.split()[:3]) for line in lines[1:1 + vertices]]
        corners = [line.split() for line in lines[1 + vertices:1 + vertices + faces]]
        return points, [" ".join(str(int(i) + 1) for i in c[1:1 + int(c[0])]) for c in corners]

    def test_bunny(self):
        self.compare("meshes/bunny.off", 0.0075)

    def test_fandisk(self):
        # A voxel size that float and double both hold: vdb_tool keeps it as a float.
        self.compare("meshes/fandisk.obj", 0.015625)

    def test_they_read_what_we_write(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 32)
        self.ok("convert", "g.vdb", "-o", "g.ply", "-o", "g.obj", "-o", "g.stl")
        grid = pyopenvdb.read(self.path("g.vdb"), "surface")
        self.assertEqual(grid.gridClass, pyopenvdb.GridClass.LEVEL_SET)
        for mesh in ("g.ply", "g.obj", "g.stl"):
            subprocess.run(["vdb_tool", "-read", mesh, "-mesh2ls", "voxel=1", "-write", "back.vdb"], cwd=self.folder, check=True, capture_output=True)
            self.assertGreater(pyopenvdb.readAll(self.path("back.vdb"))[0][0].activeVoxelCount(), 1000)
        text = subprocess.run(["vdb_print", "g.vdb"], cwd=self.folder, check=True, capture_output=True, text=True).stdout
        self.assertIn("surface", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
