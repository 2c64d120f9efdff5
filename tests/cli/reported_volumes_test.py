"""Volumes that people reported, and others of their kinds: where they lie, which array is read, what is said."""
import gzip
import json
import struct
import unittest

from reported import Reported


def ball(size, centre, radius):
    """Samples in which a ball has value 1, x fastest."""
    return bytes(1 if sum((p - c) ** 2 for p, c in zip((x, y, z), centre)) <= radius ** 2 else 0
                 for z in range(size[2]) for y in range(size[1]) for x in range(size[0]))


def box_samples(size, low, high):
    return bytes(1 if all(l <= p <= h for p, l, h in zip((x, y, z), low, high)) else 0
                 for z in range(size[2]) for y in range(size[1]) for x in range(size[0]))


def vti(image, arrays, order="Little", header="UInt32", root=""):
    """@param arrays  lists of (kind, name, type, components, bytes): PointData or CellData, appended raw"""
    elements, appended = {"PointData": "", "CellData": ""}, b""
    for kind, name, form, components, data in arrays:
        elements[kind] += (f'<DataArray type="{form}" Name="{name}" NumberOfComponents="{components}" '
                           f'format="appended" offset="{len(appended)}"/>\n')
        appended += len(data).to_bytes(8 if header == "UInt64" else 4, order.lower()) + data
    extent = image.split('"')[1]
    return (f'<?xml version="1.0"?>\n<VTKFile type="ImageData" version="1.0" byte_order="{order}Endian" '
            f'header_type="{header}" {root}>\n<ImageData {image}>\n<Piece Extent="{extent}">'
            f'<PointData>{elements["PointData"]}</PointData><CellData>{elements["CellData"]}</CellData></Piece>'
            f'</ImageData>\n<AppendedData encoding="raw">\n_').encode() + appended + b"\n</AppendedData></VTKFile>\n"


def nifti(size, voxels, rows=None, order="<", datatype=2, quaternion=None, magic=b"n+1\0", pixdim=(1, 1, 1)):
    """@param size  sides, then the number of volumes"""
    head = bytearray(352)
    dims = [len(size), *size] + [1] * (7 - len(size))
    struct.pack_into(order + "i", head, 0, 348)
    struct.pack_into(order + "8h", head, 40, *dims)
    struct.pack_into(order + "h", head, 70, datatype)
    struct.pack_into(order + "8f", head, 76, 1, *pixdim, 1, 1, 1, 1)
    struct.pack_into(order + "f", head, 108, 352)
    head[123] = 2
    struct.pack_into(order + "2h", head, 252, 1 if quaternion else 0, 1 if rows else 0)
    struct.pack_into(order + "6f", head, 256, *(quaternion or [0] * 6))
    struct.pack_into(order + "12f", head, 280, *(rows or [0] * 12))
    head[344:348] = magic
    return bytes(head) + voxels


def npy(shape, data, form="|u1", fortran=False):
    header = f"{{'descr': '{form}', 'fortran_order': {fortran}, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(header)) + header.encode() + data


class Volumes(Reported):
    def within(self, outcome, right, voxel=1.0, centre=0.16):
        """Corners and tips of few voxels are rounded off, the middle is not. @param centre  [voxels]"""
        self.assertEqual(outcome.code, 0, outcome.said)
        text = f"{outcome.bounds} is not {right}"
        for value, wanted in zip(outcome.bounds, right):
            self.assertLessEqual(abs(value - wanted), voxel, text)
        for axis in range(3):
            middle = (outcome.bounds[axis] + outcome.bounds[axis + 3] - right[axis] - right[axis + 3]) / 2
            self.assertLessEqual(abs(middle), centre * voxel, text)


class VtiFiles(Volumes):
    def test_59_direction_of_lps(self):
        self.within(self.convert("59-vti-direction-lps.vti"), [70.5, 180.5, 1.5, 95.5, 197.5, 9.5], 0.1)

    def test_98_vectors_before_scalars(self):
        done = self.convert("98-vti-vector-first.vti", "--threshold", 0)
        self.assertEqual(done.code, 0, done.said)
        self.assertIn("holds velocity, pressure; pressure is read; --grid chooses another", done.said)
        self.assertEqual(self.info("98-vti-vector-first.vti")["arrays"], ["velocity", "pressure"])
        named = self.convert("98-vti-vector-first.vti", "--threshold", 0, "--grid", "pressure")
        self.assertEqual(named.bounds, done.bounds)
        lengths = self.run_tool("info", self.file("98-vti-vector-first.vti"), "--grid", "velocity")
        self.assertIn("vectors of 3 components; their lengths are read", lengths.stderr)
        self.fails(3, "--grid speed: not in", "convert", self.file("98-vti-vector-first.vti"), "-o", "p.ply",
                   "--threshold", 0, "--grid", "speed")

    def test_108_vectors_before_scalars_of_cells(self):
        done = self.convert("108-vti-amr-vector-first.vti", "--threshold", 0)
        self.assertEqual(done.code, 0, done.said)
        self.assertIn("TestX is read", done.said)
        self.assertIn("values of cells", done.said)
        info = self.info("108-vti-amr-vector-first.vti")
        self.assertEqual(info["size"], [4, 3, 3])
        for value, right in zip(info["origin"], [-1.75 + 0.41666667, -1.25 + 0.41666667, 0.33333333]):
            self.assertAlmostEqual(value, right, 5)
        self.assertEqual(len(info["arrays"]), 5)
        self.assertIn("Fractal Volume Fraction", info["arrays"])
        chosen = self.info("108-vti-amr-vector-first.vti", "--grid", "Fractal Volume Fraction")
        self.assertAlmostEqual(chosen["maximum"], 5.2631578947, 4)

    def test_every_direction_along_the_axes(self):
        size, low, high = (12, 10, 8), (2, 3, 1), (8, 5, 6)
        data = box_samples(size, low, high)
        plain = self.convert(self.write("p.npy", npy((8, 10, 12), data)), resolution=None)
        for columns in ([(1, 0, 0), (0, -1, 0), (0, 0, 1)], [(0, 1, 0), (0, 0, 1), (1, 0, 0)],
                        [(0, 0, -1), (0, -1, 0), (-1, 0, 0)], [(0, -1, 0), (1, 0, 0), (0, 0, 1)]):
            direction = " ".join(str(columns[c][r]) for r in range(3) for c in range(3))
            path = self.write("d.vti", vti(f'WholeExtent="5 16 0 9 -2 5" Origin="10 20 30" Spacing="1 1 1" '
                                           f'Direction="{direction}"', [("PointData", "m", "UInt8", 1, data)]))
            corners = []
            for c in range(8):
                i = [(high if c >> a & 1 else low)[a] + (0.5 if c >> a & 1 else -0.5) + (5, 0, -2)[a] for a in range(3)]
                corners.append([(10, 20, 30)[r] + sum(columns[a][r] * i[a] for a in range(3)) for r in range(3)])
            right = [f(p[a] for p in corners) for f in (min, max) for a in range(3)]
            done = self.convert(path, resolution=None)
            self.within(done, right)
            self.near(done.volume, plain.volume, 1e-3)

    def test_oblique_direction(self):
        # A box of 20 x 6 x 6 turned by 30 degrees about z.
        data = box_samples((30, 16, 16), (5, 5, 5), (24, 10, 10))
        path = self.write("o.vti", vti('WholeExtent="0 29 0 15 0 15" Origin="100 0 0" Spacing="1 1 1" Direction="'
                                       '0.8660254037844386 -0.5 0 0.5 0.8660254037844386 0 0 0 1"',
                                       [("PointData", "m", "UInt8", 1, data)]))
        done = self.convert(path, resolution=None)
        c, s = 0.8660254037844386, 0.5
        right = [100 + c * 4.5 - s * 10.5, s * 4.5 + c * 4.5, 4.5, 100 + c * 24.5 - s * 4.5, s * 24.5 + c * 10.5, 10.5]
        self.within(done, right)
        self.assertIn("turned by 30 degrees", done.said)
        plain = self.convert(self.write("p.npy", npy((16, 16, 30), data)), resolution=None)
        self.near(done.volume, plain.volume, 1e-3)
        axes = self.info(path)["axes"]
        self.assertAlmostEqual(axes[0][1], 0.5, 9)

    def test_byte_orders_and_headers(self):
        values = [v * 1000 for v in ball((12, 12, 12), (5, 5, 5), 4)]
        for order, mark in (("Little", "<"), ("Big", ">")):
            for header in ("UInt32", "UInt64"):
                data = struct.pack(f"{mark}{len(values)}h", *values)
                path = self.write("b.vti", vti('WholeExtent="0 11 0 11 0 11" Origin="0 0 0" Spacing="1 1 1"',
                                               [("PointData", "m", "Int16", 1, data)], order, header))
                self.assertEqual(self.info(path)["maximum"], 1000)
                self.within(self.convert(path, resolution=None), [0.5] * 3 + [9.5] * 3)

    def test_refusals(self):
        data = bytes(8)
        image = 'WholeExtent="0 1 0 1 0 1" Origin="0 0 0" Spacing="1 1 1"'
        for root in ("vtkLZ4DataCompressor", "vtkLZMADataCompressor"):
            path = self.write("c.vti", vti(image, [("PointData", "m", "UInt8", 1, data)], root=f'compressor="{root}"'))
            self.fails(3, f"compressed with {root}; only zlib", "convert", path, "-o", "o.ply")
        path = self.write("v.vti", vti(image, [("PointData", "u", "UInt8", 3, bytes(24))]))
        self.fails(3, "--grid u reads their lengths", "convert", path, "-o", "o.ply")


class NiftiFiles(Volumes):
    def test_60_oblique(self):
        done = self.convert("60-nii-oblique-epi.nii.gz", "--threshold", 60, resolution=None)
        self.assertEqual(done.code, 0, done.said)
        self.assertIn("turned by 17.2 degrees", done.said)
        # The world positions of the samples over 60 by the file's affine, and half a voxel of 3.
        right = [-78, -95.5, -64, 78, 92.21, 64.95]
        for value, wanted, side in zip(done.bounds, right, [-1] * 3 + [1] * 3):
            self.assertLessEqual((value - wanted) * side, 3)
            self.assertGreaterEqual((value - wanted) * side, -0.5)
        self.near(done.volume, 874692, 0.04)

    def test_62_left_posterior(self):
        right = [-44.25, -29.25, 4.5, -6.75, -3.75, 28.5]
        self.within(self.convert("62-nii-lps-flip.nii"), right, 0.1)

    def test_oblique_boxes_of_other_cells(self):
        # 20 x 20 x 40 in cells of 1 x 1 x 2, tilted by 20 degrees about x; by sform, and the same by qform.
        c, s = 0.9396926, 0.3420201
        data = box_samples((30, 30, 30), (5, 5, 5), (24, 24, 24))
        by_rows = nifti((30, 30, 30), data, [1, 0, 0, -15, 0, c, -2 * s, 7, 0, s, 2 * c, 0])
        by_quaternion = nifti((30, 30, 30), data, pixdim=(1, 1, 2), quaternion=[0.1736482, 0, 0, -15, 7, 0])
        corners = [(y * c - 2 * z * s + 7, y * s + 2 * z * c) for y in (4.5, 24.5) for z in (4.5, 24.5)]
        right = [-10.5, min(p[0] for p in corners), min(p[1] for p in corners),
                 9.5, max(p[0] for p in corners), max(p[1] for p in corners)]
        for content in (by_rows, by_quaternion):
            done = self.convert(self.write("t.nii", content), resolution=None)
            self.within(done, right)
            self.near(done.volume, 20 * 20 * 40, 0.05)
            self.assertIn("turned by 20 degrees", done.said)

    def test_sheared(self):
        # Slices of a tilted gantry: each lies half a sample further along y.
        data = box_samples((24, 40, 24), (4, 10, 4), (19, 25, 19))
        content = nifti((24, 40, 24), data, [1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1, 0])
        done = self.convert(self.write("s.nii", content), resolution=None)
        self.assertIn("not at right angles", done.said)
        self.within(done, [3.5, 9.5 + 0.5 * 3.5, 3.5, 19.5, 25.5 + 0.5 * 19.5, 19.5])
        self.near(done.volume, 16 ** 3, 0.1)

    def test_volumes_of_time(self):
        rows = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
        data = ball((12, 12, 12), (4, 5, 5), 3) + ball((12, 12, 12), (7, 5, 5), 3)
        for order in "<>":
            path = self.write("t.nii.gz", gzip.compress(nifti((12, 12, 12, 2), data, rows, order)))
            done = self.convert(path, resolution=None)
            self.assertIn("holds volume1, volume2; volume1 is read; --grid chooses another", done.said)
            self.within(done, [0.5, 1.5, 1.5, 7.5, 8.5, 8.5])
            self.within(self.convert(path, "--grid", "volume2", resolution=None), [3.5, 1.5, 1.5, 10.5, 8.5, 8.5])
            self.assertEqual(self.info(path)["arrays"], ["volume1", "volume2"])

    def test_refusals(self):
        rows = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
        for says, content in (("RGB24", nifti((2, 2, 2), bytes(24), rows, datatype=128)),
                              ("Analyze 7.5", nifti((2, 2, 2), bytes(8), magic=bytes(4))),
                              (".img", nifti((2, 2, 2), bytes(8), magic=b"ni1\0")),
                              ("truncated", nifti((2, 2, 2, 9), bytes(8), rows))):
            self.fails(3, says, "convert", self.write("r.nii", content), "-o", "o.ply")
        self.fails(2, "convert it to one .nii", "convert", self.write("r.hdr", bytes(348)), "-o", "o.ply")


class ArrayFiles(Volumes):
    def test_64_truths(self):
        done = self.convert("64-npy-porespy-bool.npy", resolution=None)
        self.assertIn("two values, of which 1 is solid; --labels changes that", done.said)

    def test_volume_that_smoothing_takes_is_said(self):
        def block(side, low, high):
            inside = range(low, high)
            return npy((side,) * 3, bytes(x in inside and y in inside and z in inside for x in range(side) for y in range(side) for z in range(side)))

        large = self.convert(self.write("l.npy", block(70, 5, 65)), resolution=None)
        self.assertNotIn("of its solid samples", large.said)
        some = self.convert(self.write("s.npy", block(40, 5, 35)), resolution=None)
        self.assertIn("s.npy: 2 % of the volume of its solid samples is lost by smoothing", some.said)
        self.assertIn("--threshold 0.5, which smooths less", some.said)
        self.assertNotIn("warning", some.said)
        for options in ((), ("--threshold", 0.5)):
            small = self.convert(self.write("m.npy", block(12, 4, 8)), *options, resolution=None)
            self.assertRegex(small.said, r"warning: .*m.npy: \d+ % of the volume of its solid samples is lost")

    def test_90_closed_void_at_its_own_size(self):
        done = self.convert("90-npy-closed-void.npy", resolution=None)
        self.near(done.volume, 43776, 0.01)

    def test_55_ramp(self):
        ramp = self.file("55-png-ramp16.png")
        done = self.convert(ramp, "--pixel-size", 1.0417, "--height", 2.4, "--base", 0.8, resolution=400)
        self.assertEqual(done.code, 0, done.said)
        self.assertAlmostEqual(done.bounds[3] - done.bounds[0], 100, delta=0.2)
        self.assertAlmostEqual(done.bounds[5] - done.bounds[2], 3.2, delta=0.13)

    def test_four_dimensions(self):
        one, other = ball((12, 10, 8), (4, 4, 4), 3), ball((12, 10, 8), (7, 4, 4), 3)
        first = self.write("f.npy", npy((2, 8, 10, 12), one + other))
        last = self.write("l.npy", npy((8, 10, 12, 2), bytes(v for pair in zip(one, other) for v in pair)))
        for path, word in ((first, "first"), (last, "last")):
            done = self.convert(path, resolution=None)
            self.assertIn(f"the {word} is taken for channels", done.said)
            self.assertIn("channel1 is read; --grid chooses another", done.said)
            self.within(done, [0.5, 0.5, 0.5, 7.5, 7.5, 7.5])
            self.within(self.convert(path, "--grid", "channel2", resolution=None), [3.5, 0.5, 0.5, 10.5, 7.5, 7.5])
        path = self.write("s.npy", npy((1, 1, 8, 10, 12), one))
        self.within(self.convert(path, resolution=None), [0.5, 0.5, 0.5, 7.5, 7.5, 7.5])
        self.fails(3, "of 5 dimensions", "convert", self.write("m.npy", npy((2, 2, 8, 10, 12), (one + other) * 2)), "-o", "o.ply")

    def test_orders(self):
        size, data = (12, 10, 8), ball((12, 10, 8), (5, 4, 4), 3)
        at = lambda x, y, z: data[(z * size[1] + y) * size[0] + x]
        turned = [at(x, y, z) for x in range(12) for y in range(10) for z in range(8)]
        for content in (npy((8, 10, 12), bytes(turned), fortran=True),
                        npy((8, 10, 12), struct.pack(">960h", *data), ">i2"),
                        npy((8, 10, 12), struct.pack("<960d", *data), "<f8")):
            self.within(self.convert(self.write("o.npy", content), resolution=None), [1.5, 0.5, 0.5, 8.5, 7.5, 7.5])

    def test_refusals(self):
        self.fails(3, "type 'c8'", "convert", self.write("c.npy", npy((2, 2, 2), bytes(64), "<c8")), "-o", "o.ply")
        records = npy((8, 8, 8), bytes(4096)).replace(b"'|u1'", b"[('a', '<f4')]", 1)
        self.fails(3, "structured array", "convert", self.write("r.npy", records), "-o", "o.ply")

    def test_a_name_for_a_file_of_one_array(self):
        path = self.write("b.npy", npy((12, 12, 12), ball((12, 12, 12), (5, 5, 5), 4)))
        self.assertIn("--grid does not apply", self.convert(path, "--grid", "x", resolution=None).said)


class TextVolumes(Volumes):
    def rows(self, *columns):
        return "".join(" ".join(str(c) for c in row) + "\n" for row in zip(*columns))

    def test_gslib(self):
        one, other = ball((12, 10, 8), (4, 4, 4), 3), ball((12, 10, 8), (7, 4, 4), 3)
        for first in ("12 10 8", "TI (12x10x8)"):
            path = self.write("g.sgems", first + "\n2\nsand\nclay\n" + self.rows(one, other))
            done = self.convert(path, resolution=None)
            self.assertIn("holds sand, clay; sand is read; --grid chooses another", done.said)
            self.within(done, [0.5, 0.5, 0.5, 7.5, 7.5, 7.5])
            self.within(self.convert(path, "--grid", "clay", resolution=None), [3.5, 0.5, 0.5, 10.5, 7.5, 7.5])
        path = self.write("g.gslib", "12 10 8 2 2 2 100 0 -50\n1\nsand\n" + self.rows(one))
        self.within(self.convert(path, resolution=None), [102, 2, -48, 116, 16, -34], 2)

    def test_inrimage(self):
        fields = ("#INRIMAGE-4#{\nXDIM=12\nYDIM=10\nZDIM=8\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\n"
                  "CPU=decm\nVX=0.5\nVY=0.5\nVZ=0.5\nTX=10\nTY=0\nTZ=-4\n").ljust(252, "\n") + "##}\n"
        path = self.write("i.inr", fields.encode() + ball((12, 10, 8), (4, 4, 4), 3))
        self.within(self.convert(path, resolution=None), [10.25, 0.25, -3.75, 13.75, 3.75, -0.25], 0.5)


class TurnedVolumes(Volumes):
    """A turned level set goes through the other commands."""

    def setUp(self):
        super().setUp()
        c, s = 0.8660254037844386, 0.5
        data = ball((40, 32, 32), (16, 16, 16), 10)
        self.turned = self.write("t.nii", nifti((40, 32, 32), data, [c, -s, 0, 5, s, c, 0, 6, 0, 0, 1, 7]))
        self.centre = [5 + 16 * c - 16 * s, 6 + 16 * s + 16 * c, 23]
        self.ok("convert", self.turned, "-o", "t.vdb")

    def right(self, radius=10.3):
        return [c - radius for c in self.centre] + [c + radius for c in self.centre]

    def test_meshes(self):
        self.within(self.convert(self.turned, resolution=None), self.right())
        self.within(self.convert(self.turned, resolution=60), self.right())
        self.within(self.convert(self.turned, "--sharp", resolution=None), self.right())
        self.within(self.convert(self.path("t.vdb"), resolution=None), self.right())

    def test_crop_compare_render_synth(self):
        self.ok("crop", "t.vdb", "-o", "c.ply", "--box", "0,0,0,39,31,31")
        cropped = json.loads(self.ok("info", "c.ply", "--json").stdout)
        for value, wanted in zip(cropped["bounds_min"] + cropped["bounds_max"], self.right()):
            self.assertLessEqual(abs(value - wanted), 0.5)
        self.assertIn("volume fraction", self.ok("compare", "t.vdb", self.turned).stdout)
        self.ok("render", "t.vdb", "-o", "r.png")
        self.ok("crop", "t.vdb", "-o", "c.vdb", "--box", "8,8,8,31,31,31")
        self.ok("synth", "c.vdb", "-o", "s.vdb", "--size", "24,24,24")
        self.ok("convert", "s.vdb", "-o", "s.ply")


del Volumes

if __name__ == "__main__":
    unittest.main()
