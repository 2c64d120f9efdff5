"""VDB files as other programs write them: what people reported, and what is near it."""
import math
import resource
import struct
import unittest

from reported import Reported

try:
    import numpy
    import pyopenvdb as vdb
except ImportError:
    numpy = vdb = None

BOX = 2 * 1.2 * 0.8
BALL = 4 / 3 * math.pi * 1.5 ** 3


def used():
    """[s] of processor time that programs run from here have taken: no other load counts."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Files(Reported):
    """Rows 66 to 76 of the reports."""

    def test_66_mirrored_transform(self):
        self.near(self.convert("66-vdb-mirrored.vdb", resolution=None).volume, 1.92)

    def test_67_anisotropic_voxels(self):
        done = self.convert("67-vdb-anisotropic.vdb")
        self.near(done.volume, 9.6, 0.03)
        self.assertIn("voxels are not cubes", done.said)

    def test_68_far_from_the_origin(self):
        model = self.info("68-vdb-far.vdb")["model"]
        for axis, centre in enumerate((1e6, 2e6, 3e6)):
            self.assertAlmostEqual(model["bounds_min"][axis], centre - 1, delta=0.01)
            self.assertAlmostEqual(model["bounds_max"][axis], centre + 1, delta=0.01)

    def test_69_signs_turned(self):
        done = self.convert("69-vdb-inverted.vdb", resolution=None)
        self.near(done.volume, 4.19)
        self.assertIn("signs are turned", done.said)

    def test_70_dense_field_of_unknown_class(self):
        for options in ((), ("--iso", 0)):
            done = self.convert("70-vdb-dense-sdf-unknown-class.vdb", *options, resolution=None)
            self.near(done.volume, BOX)
            self.assertIn("values are distances", done.said)

    def test_71_three_grids_of_one_name(self):
        path = self.file("71-vdb-arnold-grids.vdb")
        names = [grid["name"] for grid in self.info(path)["grids"]]
        self.assertEqual(names, ["density[0]", "density[1]", "density[2]"])
        first = self.convert(path, "--iso", 0.5, resolution=None)
        self.assertIn("density[0]", first.said)
        self.assertIn("--grid", first.said)
        volumes = [self.convert(path, "--iso", 0.5, "--grid", name, resolution=None).volume for name in names]
        self.assertEqual(volumes[0], first.volume)
        self.assertEqual(len(set(volumes)), 3)
        self.fails(3, "density[2]", "convert", path, "-o", "x.ply", "--iso", 0.5, "--grid", "density[3]")

    def test_72_fog(self):
        done = self.convert("72-vdb-arnold-torus.vdb", "--iso", 0.5, resolution=None)
        self.assertEqual(done.code, 0)
        self.assertGreater(done.volume, 0)

    def test_73_points(self):
        done = self.convert("73-vdb-points.vdb")
        self.assertEqual(done.code, 3)
        self.assertIn("points (ptdataidx32)", done.said)
        self.assertIn(".ply", done.said)

    def test_74_two_level_sets_of_one_name(self):
        path = self.file("74-vdb-same-name.vdb")
        done = self.convert(path, resolution=None)
        self.assertIn("density[0]", done.said)
        self.assertLess(done.bounds[3], 1.5)
        self.assertGreater(self.convert(path, "--grid", "density[1]", resolution=None).bounds[0], 3)

    def test_75_bool_mask(self):
        done = self.convert("75-vdb-bool-mask.vdb")
        self.assertEqual(done.code, 3)
        self.assertIn("mask (bool)", done.said)

    def test_76_half_precision_and_a_band_of_two(self):
        self.near(self.convert("76-vdb-half-band2.vdb", resolution=None).volume, 4.18)


@unittest.skipIf(vdb is None, "python3-openvdb is absent")
class Dialects(Reported):
    """The same kinds, written here."""

    def axes(self, reach, voxel):
        line = numpy.arange(-reach, reach + 1) * voxel
        return numpy.meshgrid(line, line, line, indexing="ij")

    def box(self, reach=25, voxel=0.1):
        x, y, z = self.axes(reach, voxel)
        q = numpy.stack([abs(x) - 1, abs(y) - 0.6, abs(z) - 0.4], -1)
        return numpy.linalg.norm(numpy.maximum(q, 0), axis=-1) + numpy.minimum(q.max(-1), 0)

    def ball(self, reach=25, voxel=0.1):
        x, y, z = self.axes(reach, voxel)
        return numpy.sqrt(x * x + y * y + z * z) - 1.5

    def dense(self, values, background=0.0, level_set=False, voxel=0.1, name="sdf"):
        grid = vdb.FloatGrid(background)
        grid.copyFromArray(values.astype(numpy.float32), ijk=(-(values.shape[0] // 2),) * 3)
        grid.transform = vdb.createLinearTransform(voxel)
        grid.name = name
        if level_set:
            grid.gridClass = vdb.GridClass.LEVEL_SET
        return grid

    def saved(self, *grids, name="in.vdb"):
        vdb.write(self.path(name), grids=list(grids))
        return self.path(name)

    def volume(self, *grids, says="", **options):
        done = self.convert(self.saved(*grids), resolution=None, **options)
        self.assertEqual(done.code, 0, done.said)
        self.assertIn(says, done.said)
        return done.volume

    def test_dense_fields_with_any_background(self):
        for background in (0.0, 1.0, -1.0, 1e10, 0.3):
            for level_set in (False, True):
                for sign in (1, -1):
                    with self.subTest(background=background, level_set=level_set, sign=sign):
                        grid = self.dense(sign * self.ball(), background, level_set)
                        self.near(self.volume(grid, says="grid \"sdf\""), BALL)

    def test_clamped_and_in_voxels(self):
        for band in (0.1, 0.2, 0.5):
            self.near(self.volume(self.dense(numpy.clip(self.box(), -band, band))), BOX, 0.05)
        self.near(self.volume(self.dense(self.box() / 0.1), says="in voxels"), BOX, 0.04)

    def test_cut_by_the_end_of_its_voxels(self):
        said = "cut open at low x, high x, low y, high y, low z, high z"
        volume = self.volume(self.dense(self.ball(12)), says=said)
        cap = math.pi * 0.25 ** 2 * (3 * 1.5 - 0.25) / 3
        self.near(volume, BALL - 6 * cap)

    def test_numbers_that_are_no_distances(self):
        noise = numpy.random.default_rng(1).normal(size=(31, 31, 31))
        done = self.convert(self.saved(self.dense(noise, 5.0)), resolution=None)
        self.assertEqual(done.code, 1)
        self.assertIn("--iso", done.said)

    def test_the_second_of_two_fields(self):
        path = self.saved(self.dense(self.box(), name="a"), self.dense(self.ball(), name="a"))
        self.assertEqual([grid["name"] for grid in self.info(path)["grids"]], ["a[0]", "a[1]"])
        done = self.convert(path, resolution=None)
        self.assertIn("a[0]", done.said)
        other = self.convert(path, "--grid", "a[1]", resolution=None)
        self.assertGreater(abs(other.volume - done.volume), 5)

    def test_frustum_and_tiny_voxels_are_named(self):
        grid = self.dense(self.ball(20))
        path = self.saved(grid)
        with open(path, "rb") as file:
            content = file.read()
        # Smaller voxels than OpenVDB lets anybody make, as its own reader takes them.
        content = content.replace(struct.pack("<d", 0.1), struct.pack("<d", 1e-6))
        self.write("tiny.vdb", content)
        done = self.convert(self.path("tiny.vdb"), resolution=None)
        self.assertNotEqual(done.code, 0)
        self.assertNotIn("ArithmeticError", done.said)
        self.assertIn("0.000015", done.said)


@unittest.skipIf(vdb is None, "python3-openvdb is absent")
class Damage(Reported):
    def test_damaged_counts_are_told_at_once(self):
        ball = vdb.createLevelSetSphere(radius=10)
        vdb.write(self.path("a.vdb"), grids=[ball])
        good = self.read("a.vdb")
        began = used()
        for cut in (10, 60, 200, len(good) // 2, len(good) - 1):
            self.write("b.vdb", good[:cut])
            self.fails(3, "b.vdb", "info", "b.vdb")
        for at in (57, 61, 65, *range(100, len(good), len(good) // 20)):
            self.write("b.vdb", good[:at] + b"\xff" * 8 + good[at + 8:])
            self.assertIn(self.run_tool("info", "b.vdb").returncode, (0, 3))
        self.assertLess(used() - began, 30)


if __name__ == "__main__":
    unittest.main(verbosity=2)
