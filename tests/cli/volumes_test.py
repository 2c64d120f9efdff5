"""Models as volumes: what is written comes back at its place, by this program and by others."""
import gzip
import json
import unittest

import numpy

from support import CliTest, sample

FORMATS = ("v.npy", "v.tif", "v.vti", "v.nii", "v.nii.gz")


def packed_by_others(path, values):
    """A NIfTI's header fields and voxels, read here without this program: shape, sform rows, unit, values."""
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        content = file.read()
    sides = numpy.frombuffer(content, "<i2", 3, 42)
    rows = numpy.frombuffer(content, "<f4", 12, 280).reshape(3, 4)
    voxels = numpy.frombuffer(content, values, int(numpy.prod(sides)), 352)
    return rows, content[123] & 7, voxels.reshape(sides[::-1])


class Outputs(CliTest):
    def make(self, name="ball.vdb", *more):
        """A texture with a domain, off the world's zero."""
        self.ok("make", "balls", name, "--size", "40,40,40", "--seed", "3", *more)
        return self.path(name)

    def solid_bounds(self, name):
        """Bounds of the solid in the world, its volume."""
        self.ok("convert", name, "-o", "again.vdb", "--report", "again.json", "--force")
        surface = json.loads(self.read("again.json"))["counts"]["surface"]
        return surface

    def test_round_trip_of_a_texture(self):
        self.make()
        first = self.solid_bounds("ball.vdb")
        for name in FORMATS:
            with self.subTest(name):
                self.ok("convert", "ball.vdb", "-o", name, "--values", "density")
                self.ok("convert", name, "-o", "back.vdb", "--threshold", "0.5", "--report", "back.json", "--force")
                back = json.loads(self.read("back.json"))["counts"]["surface"]
                self.assertAlmostEqual(back["signed_volume"] / first["signed_volume"], 1, delta=0.01)
                for low, other in zip(first["bounds_min"] + first["bounds_max"],
                                      back["bounds_min"] + back["bounds_max"]):
                    self.assertAlmostEqual(low, other, delta=0.1)

    def test_labels_need_no_threshold_and_keep_every_voxel(self):
        self.make()
        self.ok("convert", "ball.vdb", "-o", "a.nii.gz", "-o", "a.npy")
        values = numpy.load(self.path("a.npy"))
        self.assertEqual(values.dtype, numpy.uint8)
        self.assertEqual(set(numpy.unique(values)), {0, 1})
        self.ok("convert", "a.nii.gz", "-o", "b.vdb")
        self.ok("convert", "b.vdb", "-o", "b.npy")
        self.assertTrue(numpy.array_equal(values, numpy.load(self.path("b.npy"))))

    def test_values(self):
        self.make("ball.vdb", "--voxel-size", "0.5")
        read = {}
        for values in ("inside", "distance", "density"):
            self.ok("convert", "ball.vdb", "-o", "v.npy", "--values", values, "--force")
            read[values] = numpy.load(self.path("v.npy"))
        self.assertEqual(read["distance"].dtype, numpy.float32)
        self.assertTrue(numpy.array_equal(read["distance"] < 0, read["inside"] == 1))
        self.assertAlmostEqual(float(read["distance"].min()), -1.5, places=5)
        self.assertAlmostEqual(float(read["distance"].max()), 1.5, places=5)
        expected = numpy.clip(0.5 - read["distance"] / (2 * 0.5), 0, 1)
        self.assertLess(float(numpy.abs(read["density"] - expected).max()), 1e-6)

    def test_npy_says_its_place_in_one_line_and_in_the_report(self):
        self.ok("make", "balls", "b.vdb", "--size", "32,32,32", "--voxel-size", "0.25", "--seed", "1")
        said = self.ok("convert", "b.vdb", "-o", "v.npy", "--report", "r.json").stderr
        lines = [line for line in said.splitlines() if "v.npy" in line]
        self.assertEqual(len(lines), 1, said)
        self.assertIn("[z][y][x]", lines[0])
        self.assertIn("its first voxel lies at", lines[0])
        volume = json.loads(self.read("r.json"))["counts"]["volume"]
        self.assertEqual(volume["voxel_size"], 0.25)
        self.assertEqual(volume["values"], "inside")
        self.assertEqual(list(numpy.load(self.path("v.npy")).shape), volume["size"][::-1])
        self.assertEqual(volume["axes"], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        self.assertIsNone(volume["unit"])

    def test_axes_are_x_y_z(self):
        """A bar along x, a shorter one along y, none along z."""
        mesh = ("v 10 20 30\nv 18 20 30\nv 18 24 30\nv 10 24 30\nv 10 20 32\nv 18 20 32\nv 18 24 32\nv 10 24 32\n"
                "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
        self.write("bar.obj", mesh)
        self.ok("convert", "bar.obj", "--voxel-size", "0.5", "-o", "v.npy", "-o", "v.nii", "--report", "r.json")
        place = json.loads(self.read("r.json"))["counts"]["volume"]
        inside = numpy.argwhere(numpy.load(self.path("v.npy")))[:, ::-1]
        low, high = (numpy.array(place["first_voxel"]) + 0.5 * corner for corner in (inside.min(0), inside.max(0)))
        self.assertLess(numpy.abs(low - [10, 20, 30]).max(), 0.51)
        self.assertLess(numpy.abs(high - [18, 24, 32]).max(), 0.51)
        rows, _, voxels = packed_by_others(self.path("v.nii"), "u1")
        self.assertTrue(numpy.array_equal(voxels, numpy.load(self.path("v.npy"))))
        self.assertLess(numpy.abs(rows[:, 3] - place["first_voxel"]).max(), 1e-6)

    def test_the_same_bytes_on_any_number_of_threads(self):
        self.make()
        self.ok("convert", "ball.vdb", "-o", "a.npy", "--threads", "1")
        self.ok("convert", "ball.vdb", "-o", "b.npy", "--threads", "4")
        self.assertEqual(self.read("a.npy"), self.read("b.npy"))

    def test_other_commands_write_volumes(self):
        self.ok("make", "balls", "b.nii", "--size", "24,24,24", "--seed", "3", "--values", "density")
        self.ok("make", "balls", "b.vdb", "--size", "24,24,24", "--seed", "3")
        self.ok("crop", "b.vdb", "-o", "c.npy", "--box", "0,0,0,11,12,13")
        self.assertEqual(numpy.load(self.path("c.npy")).shape, (14, 13, 12))

    def test_refusals(self):
        self.make()
        self.fails(2, "--as volume: must be written to .npy, .tif, .vti, .nii, .nii.gz, unless an image is read",
                   "convert", "ball.vdb", "--as", "volume", "-o", "x.obj")
        self.fails(2, "--as mesh", "convert", "ball.vdb", "--as", "mesh", "-o", "x.npy")
        self.fails(2, "--as heightfield: must be written to .png or .exr", "convert", "ball.vdb", "--as",
                   "heightfield", "-o", "x.tif")
        self.fails(2, "volumes as .npy, .tif, .vti, .nii, .nii.gz", "convert", "ball.vdb", "-o", "x.npy.gz")
        self.fails(2, "--values", "convert", "ball.vdb", "-o", "x.npy", "--values", "labels")
        self.assertIn("--values has no effect", self.ok("convert", "ball.vdb", "-o", "x.obj", "--values",
                                                        "inside").stderr)
        self.assertIn("--spacing has no effect without --as points", self.ok("convert", "ball.vdb", "-o", "x.obj", "--spacing", 3).stderr)
        self.assertFalse([name for name in self.files() if name.startswith("x.n")])

    def test_distances_come_back_below_zero(self):
        self.make()
        self.ok("convert", "ball.vdb", "-o", "d.nii", "--values", "distance")
        self.ok("convert", "d.nii", "--below", "0", "-o", "back.vdb")
        self.ok("convert", "back.vdb", "-o", "back.npy", "--values", "distance")
        self.ok("convert", "ball.vdb", "-o", "first.npy", "--values", "distance")
        first, back = numpy.load(self.path("first.npy")), numpy.load(self.path("back.npy"))
        self.assertTrue(numpy.array_equal(first < 0, back < 0))
        # Where balls touch the model's values are no distances; they are measured anew.
        self.assertLess(float(numpy.abs(first - back)[numpy.abs(first) < 1].mean()), 0.03)
        self.fails(2, "--below and --threshold: give one of them",
                   "convert", "d.nii", "--below", "0", "--threshold", "1", "-o", "x.vdb")

    def test_a_domain_too_large_for_a_dense_file(self):
        """Two balls far apart are small as a level set."""
        try:
            import pyopenvdb as vdb
        except ImportError:
            raise unittest.SkipTest("pyopenvdb is missing")
        for name, apart in (("far.vdb", 9000), ("wide.vdb", 6000)):
            grid = vdb.createLevelSetSphere(radius=6, voxelSize=1)
            other = grid.deepCopy()
            writable = grid.getAccessor()
            for item in other.citerOnValues():
                for x in range(item.min[0], item.max[0] + 1):
                    writable.setValueOn((x + apart, item.min[1] + apart, item.min[2] + (apart > 6000) * apart),
                                        item.value)
            grid.signedFloodFill()
            grid.name = "surface"
            vdb.write(self.path(name), grid)
        self.fails(1, "over 256 GB; crop the model, use larger voxels, or write .vdb",
                   "convert", "far.vdb", "-o", "x.npy")
        self.fails(1, "one slice needs", "convert", "wide.vdb", "-o", "x.npy", "--max-memory", "150M")


class Readers(CliTest):
    """The same files by other programs' readers; each is skipped where it is missing."""

    def volume(self, name, values="distance"):
        self.ok("make", "balls", "b.vdb", "--size", "30,30,30", "--voxel-size", "0.25", "--seed", "2")
        self.ok("crop", "b.vdb", "-o", "c.vdb", "--box", "1,2,3,28,24,20")
        self.ok("convert", "c.vdb", "-o", name, "-o", "right.npy", "--values", values, "--report", "r.json")
        return numpy.load(self.path("right.npy")), json.loads(self.read("r.json"))["counts"]["volume"]

    def test_tifffile(self):
        try:
            import tifffile
        except ImportError:
            raise unittest.SkipTest("tifffile is missing")
        for values in ("inside", "distance"):
            right, place = self.volume("v.tif", values)
            with tifffile.TiffFile(self.path("v.tif")) as file:
                self.assertTrue(file.is_imagej)
                self.assertTrue(numpy.array_equal(file.asarray(), right))
                self.assertEqual(len(file.pages), right.shape[0])
                described = file.imagej_metadata
                self.assertEqual(described["spacing"], 0.25)
                self.assertEqual(described["slices"], right.shape[0])
                origin = [-0.25 * described.get(axis + "origin", 0) for axis in "xyz"]
                self.assertEqual(origin, place["first_voxel"])
                above, below = file.pages[0].tags["XResolution"].value
                self.assertEqual(below / above, 0.25)

    def test_skimage(self):
        try:
            from skimage import io
        except ImportError:
            raise unittest.SkipTest("scikit-image is missing")
        right, _ = self.volume("v.tif", "inside")
        self.assertTrue(numpy.array_equal(io.imread(self.path("v.tif")), right))

    def test_pages_by_pillow(self):
        try:
            from PIL import Image
        except ImportError:
            raise unittest.SkipTest("Pillow is missing")
        right, _ = self.volume("v.tif", "distance")
        with Image.open(self.path("v.tif")) as image:
            self.assertEqual(image.n_frames, right.shape[0])
            image.seek(5)
            self.assertTrue(numpy.array_equal(numpy.asarray(image), right[5]))

    def test_nibabel(self):
        try:
            import nibabel
        except ImportError:
            raise unittest.SkipTest("nibabel is missing")
        right, place = self.volume("v.nii.gz")
        image = nibabel.load(self.path("v.nii.gz"))
        self.assertTrue(numpy.array_equal(numpy.asarray(image.dataobj), right.T))
        self.assertTrue(numpy.allclose(image.affine[:3, 3], place["first_voxel"]))

    def test_scipy_measures_the_same_distances(self):
        try:
            from scipy import ndimage
        except ImportError:
            raise unittest.SkipTest("scipy is missing")
        right, _ = self.volume("v.npy", "distance")
        outside = 0.25 * ndimage.distance_transform_edt(right >= 0)
        near = (right > 0) & (right < 0.7)
        # Beside a cut the nearest surface may lie beyond it.
        inner = numpy.zeros(right.shape, bool)
        inner[4:-4, 4:-4, 4:-4] = True
        near &= inner
        # Distance to the nearest voxel inside is that to the surface and up to a voxel's diagonal more.
        self.assertGreater(int(near.sum()), 100)
        self.assertTrue(numpy.all(outside[near] >= right[near] - 0.01))
        self.assertTrue(numpy.all(outside[near] <= right[near] + 0.25 * 1.8))


class Scans(CliTest):
    """The way back from scans: units and places of the file survive."""

    def scan(self, source, name, *solid):
        self.ok("convert", source, *solid, "-o", "scan.vdb", "-o", name, "--values", "density", "--report", "a.json")
        self.ok("convert", name, "--threshold", "0.5", "-o", "back.vdb", "--report", "b.json")
        first, back = (json.loads(self.read(file))["counts"] for file in ("a.json", "b.json"))
        self.assertAlmostEqual(first["surface"]["signed_volume"] / back["surface"]["signed_volume"], 1, delta=0.02)
        voxel = first["volume"]["voxel_size"]
        for low, other in zip(first["surface"]["bounds_min"] + first["surface"]["bounds_max"],
                              back["surface"]["bounds_min"] + back["surface"]["bounds_max"]):
            self.assertAlmostEqual(low, other, delta=0.2 * voxel)
        return first["volume"]

    def test_nifti_in_millimetres(self):
        # The sample names no unit; this is where it would.
        with gzip.open(sample("volumes/aal.nii.gz"), "rb") as file:
            content = bytearray(file.read())
        content[123] = 2
        volume = self.scan(self.write("aal.nii", bytes(content)), "out.nii.gz", "--labels", "1-116")
        self.assertEqual(volume["unit"], "mm")
        rows, unit, _ = packed_by_others(self.path("out.nii.gz"), "<f4")
        self.assertEqual(unit, 2)
        self.assertLess(float(numpy.abs(rows[:, 3] - volume["first_voxel"]).max()), 1e-4)
        info = json.loads(self.ok("info", "out.nii.gz", "--json").stdout)
        self.assertEqual(info["unit"], "mm")

    def test_vti(self):
        self.scan(sample("volumes/heart.vti"), "out.vti", "--threshold", "100")

    def test_micrometres_of_imagej(self):
        self.ok("make", "balls", "b.tif", "--size", "24,24,24", "--seed", "3", "--voxel-size", "0.5")
        content = self.read("b.tif")
        # The unit as ImageJ writes it, in the place of a line that nothing here needs.
        self.assertIn(b"loop=false\n", content)
        self.write("um.tif", content.replace(b"loop=false\n", b"unit=um   \n"))
        for name in ("out.tif", "out.nii"):
            said = self.ok("convert", "um.tif", "-o", "scan.vdb", "-o", name, "--report", "r.json").stderr
            self.assertNotIn("no place", said)
            self.assertEqual(json.loads(self.read("r.json"))["counts"]["volume"]["unit"], "um")
            self.assertEqual(json.loads(self.ok("info", name, "--json").stdout)["unit"], "um")
        # By way of a VDB, and missed aloud where it has no place.
        self.assertIn("no place for its unit (um)", self.ok("convert", "scan.vdb", "-o", "out.vti").stderr)
        self.ok("convert", "scan.vdb", "-o", "again.nii")
        self.assertEqual(json.loads(self.ok("info", "again.nii", "--json").stdout)["unit"], "um")
        # What is made of it is in its unit; another unit beside it is none.
        self.ok("crop", "scan.vdb", "-o", "part.nii", "--box", "2,2,2,19,19,19")
        self.assertEqual(json.loads(self.ok("info", "part.nii", "--json").stdout)["unit"], "um")
        self.ok("synth", "scan.vdb", "-o", "more.tif", "-o", "more.vdb", "--size", "2x,1x,1x", "--draft")
        self.assertEqual(json.loads(self.ok("info", "more.tif", "--json").stdout)["unit"], "um")
        self.ok("convert", "more.vdb", "-o", "more.nii")
        self.assertEqual(json.loads(self.ok("info", "more.nii", "--json").stdout)["unit"], "um")
        # In another unit the name would be wrong.
        self.ok("convert", "scan.vdb", "--unit-scale", "0.001", "-o", "mm.nii")
        self.assertIsNone(json.loads(self.ok("info", "mm.nii", "--json").stdout)["unit"])


if __name__ == "__main__":
    unittest.main()
