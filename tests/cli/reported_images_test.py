"""Reported files: images and stacks of TIFF (rows 45 to 58, 83 and 84), and generated neighbours of each kind."""
import struct
import unittest
import zlib

from reported import Reported


def tiff(pages, order="<"):
    """Pages of (width, height, bits, pixels, {tag: (type, values)})."""
    out = bytearray((b"II" if order == "<" else b"MM") + struct.pack(order + "HI", 42, 0))
    link = 4
    for width, height, bits, pixels, extra in pages:
        if len(out) % 2:
            out += b"\0"
        data = len(out)
        out += pixels
        tags = {256: (4, [width]), 257: (4, [height]), 258: (3, [bits]), 259: (3, [1]), 262: (3, [1]), 273: (4, [data]),
                277: (3, [1]), 278: (4, [height]), 279: (4, [len(pixels)]), **extra}
        entries, values = b"", b""
        start = len(out) + len(out) % 2
        after = start + 6 + 12 * len(tags)
        for tag, (kind, given) in sorted(tags.items()):
            if kind == 2:
                count, raw = len(given) + 1, given.encode() + b"\0"
            else:
                count = len(given) // (2 if kind == 5 else 1)
                raw = struct.pack(order + str(len(given)) + {3: "H", 4: "I", 5: "I", 12: "d"}[kind], *given)
            if len(raw) > 4:
                place, values = after + len(values), values + raw
                raw = struct.pack(order + "I", place)
            entries += struct.pack(order + "HHI", tag, kind, count) + raw.ljust(4, b"\0")
        out = out.ljust(start, b"\0")
        out[link:link + 4] = struct.pack(order + "I", start)
        out += struct.pack(order + "H", len(tags)) + entries
        link = len(out)
        out += struct.pack(order + "I", 0) + values
    return bytes(out)


def rows_of_png(data):
    """Rows of numbers of a grey PNG of 16 bits; its transparency is left out."""
    at, packed = 8, b""
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if name == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
            assert bits == 16 and colour in (0, 4), (bits, colour)
            samples = 2 if colour == 4 else 1
        if name == b"IDAT":
            packed += body
        at += 12 + length
    raw, pixel = zlib.decompress(packed), 2 * samples
    step, before, rows = pixel * width, bytes(pixel * width), []
    for y in range(height):
        kind, line = raw[y * (step + 1)], bytearray(raw[y * (step + 1) + 1:(y + 1) * (step + 1)])
        for i in range(step):
            left, up, corner = (line[i - pixel] if i >= pixel else 0), before[i], (before[i - pixel] if i >= pixel else 0)
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v: abs(guess - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) % 256
        rows.append(struct.unpack(f">{width * samples}H", line)[::samples])
        before = bytes(line)
    return rows


def correlation(a, b):
    """Of two pictures of one size."""
    first, second = [v for row in a for v in row], [v for row in b for v in row]
    middle = sum(first) / len(first), sum(second) / len(second)
    pairs = [(x - middle[0], y - middle[1]) for x, y in zip(first, second, strict=True)]
    return sum(x * y for x, y in pairs) / (sum(x * x for x, _ in pairs) * sum(y * y for _, y in pairs)) ** 0.5


def across(picture):
    return [row[::-1] for row in picture]


def down(picture):
    return picture[::-1]


def exchanged(picture):
    return [tuple(column) for column in zip(*picture)]


def ball(columns, rows, slices, radius):
    centre = ((columns - 1) / 2, (rows - 1) / 2, (slices - 1) / 2)
    return [bytes(255 if sum((p - c) ** 2 for p, c in zip((x, y, z), centre)) < radius ** 2 else 0
                  for y in range(rows) for x in range(columns)) for z in range(slices)]


class Images(Reported):
    def heights(self, path):
        self.said = self.ok("convert", path, "-o", "h.png", "--height", 10, "--force").stderr
        return rows_of_png(self.read("h.png"))

    def sides(self, outcome):
        b = outcome.bounds
        return [high - low for low, high in zip(b[:3], b[3:])]

    def alike(self, picture, right):
        self.assertEqual((len(picture), len(picture[0])), (len(right), len(right[0])))
        self.assertGreater(correlation(picture, right), 0.98)

    def near_all(self, values, right, tolerance=0.02):
        for value, wanted in zip(values, right, strict=True):
            self.near(value, wanted, tolerance)

    def stored(self, name, orientation):
        """The same JPEG with EXIF orientation 1."""
        with open(self.file(name), "rb") as file:
            data = file.read()
        entry = b"\x12\x01\x03\x00\x01\x00\x00\x00"
        self.assertIn(entry + bytes([orientation]), data)
        return self.heights(self.write("stored.jpg", data.replace(entry + bytes([orientation]), entry + b"\x01")))

    def test_45_jpeg_exif_6(self):
        upright = self.heights(self.file("45-jpg-exif6.jpg"))
        self.assertIn("turned upright as its EXIF orientation 6 says", self.said)
        stored = self.stored("45-jpg-exif6.jpg", 6)
        self.alike(upright, exchanged(down(stored)))

    def test_46_jpeg_exif_2(self):
        upright = self.heights(self.file("46-jpg-exif2.jpg"))
        self.alike(upright, across(self.stored("46-jpg-exif2.jpg", 2)))

    def test_47_jpeg_extraneous_bytes(self):
        done = self.convert("47-jpg-extraneous.jpg")
        self.assertEqual(done.code, 0)
        self.assertIn("1214 extraneous bytes", done.said)
        self.near_all(self.sides(done)[:2], [500, 500])

    def test_48_jpeg_photoshop(self):
        done = self.convert("48-jpg-photoshop.jpg")
        self.assertEqual(done.code, 0)
        self.assertIn("warning", done.said)
        self.near_all(self.sides(done)[:2], [200, 200])

    def test_jpeg_that_is_cut(self):
        with open(self.file("47-jpg-extraneous.jpg"), "rb") as file:
            data = file.read()
        done = self.convert(self.write("half.jpg", data[:len(data) // 3]))
        self.assertEqual(done.code, 0)
        self.assertIn("of 500 on, parts may be missing", done.said)
        self.fails(3, "truncated", "convert", self.write("none.jpg", data[:data.index(b"\xff\xda") + 20]), "-o", "n.vdb")

    def test_49_tiff_1_bit_orientation_3(self):
        self.assertEqual(self.info("49-tif-orientation3.tif")["size"], [590, 88, 1])
        three = self.heights(self.file("49-tif-orientation3.tif"))
        self.alike(three, self.heights(self.file("50-tif-orientation6.tif")))  # the same page

    def test_50_tiff_1_bit_orientation_6(self):
        self.assertEqual(self.info("50-tif-orientation6.tif")["size"], [590, 88, 1])
        self.heights(self.file("50-tif-orientation6.tif"))
        self.assertIn("turned upright as its orientation tag 6 says", self.said)

    def test_51_tiff_mip_maps(self):
        done = self.convert("51-tif-mipmap.tif", resolution=None)
        self.assertEqual(done.code, 0)
        self.near_all(self.sides(done)[:2], [70, 80])
        self.assertIn("smaller copies (mip levels) are left out", done.said)
        self.assertEqual(self.info("51-tif-mipmap.tif")["arrays"][:2], ["page1", "page2"])
        self.assertEqual(self.info("51-tif-mipmap.tif", "--grid", "page2")["size"], [35, 40, 1])

    def test_52_geotiff_rotated(self):
        self.assertEqual([round(s, 6) for s in self.info("52-tif-modeltransformation-rotated.tif")["spacing"][:2]], [20, 10])
        said = self.ok("info", self.file("52-tif-modeltransformation-rotated.tif")).stderr
        self.assertIn("turned on the map", said)

    def test_53_geotiff_30_m(self):
        done = self.convert("53-tif-modeltransformation-30m.tif")
        self.near_all(self.sides(done)[:2], [1800, 1200])

    def test_54_tiff_12_bit(self):
        info = self.info("54-tif-12bit.tif")
        self.assertEqual(info["size"], [100, 100, 1])
        self.assertEqual((info["maximum"], info["white"]), (30, 4095))
        self.assertEqual(self.convert("54-tif-12bit.tif").code, 0)

    def test_55_png_ramp(self):
        done = self.convert("55-png-ramp16.png", "--pixel-size", 1.0417, "--height", 2.4, "--base", 0.8, resolution=400)
        self.near_all([self.sides(done)[0], self.sides(done)[2]], [100, 3.2], 0.03)

    def test_56_imagej_spacing(self):
        done = self.convert("56-tif-imagej-spacing3.tif", "--threshold", 127)
        self.near_all(self.sides(done), [500, 500, 480])
        self.assertIn("cells of 10 x 10 x 30 um", done.said)

    def test_58_ome_two_channels(self):
        done = self.convert("58-tif-ome-2channels.ome.tif", "--threshold", 250)
        self.assertEqual(done.code, 0)
        self.assertIn("channel1 is read; --grid chooses another", done.said)
        info = self.info("58-tif-ome-2channels.ome.tif")
        self.assertEqual((info["size"], info["arrays"]), ([40, 40, 16], ["channel1", "channel2"]))
        self.assertLess(self.sides(done)[2], 16.1)
        other = self.info("58-tif-ome-2channels.ome.tif", "--grid", "channel2")
        self.assertNotEqual(other["maximum"], info["maximum"])
        self.fails(3, "has channel1, channel2", "info", self.file("58-tif-ome-2channels.ome.tif"), "--grid", "channel3")

    def test_83_tiff_grey_orientations(self):
        first = self.heights(self.file("83-tif-grey-orientation1.tif"))
        for name in ("3", "4-botleft", "6"):
            with self.subTest(name):
                turned = self.heights(self.file(f"83-tif-grey-orientation{name}.tif"))
                self.assertIn("turned upright as its orientation tag " + name[0], self.said)
                stored = {"3": across(down(first)), "4-botleft": down(first), "6": exchanged(down(first))}[name]
                self.alike(turned, stored)

    def test_84_imagej_inverting_table(self):
        done = self.convert("84-tif-imagej-inverting-lut-mask.tif", resolution=None, to="o.vdb")
        self.near(done.model["solid_voxels"], 4224, 0.001)
        self.assertIn("inverting table", done.said)

    def test_every_orientation_generated(self):
        # The picture upright: dark at the top left, bright at the bottom right, and a bright spot.
        picture = [tuple(4 * x + 7 * y + (40 if (x, y) in ((3, 2), (4, 2), (3, 3), (4, 3)) else 0) for x in range(24))
                   for y in range(16)]
        stored = {1: picture, 2: across(picture), 3: across(down(picture)), 4: down(picture), 5: exchanged(picture),
                  6: down(exchanged(picture)), 7: across(down(exchanged(picture))), 8: across(exchanged(picture))}
        # Where tag 6 says that row 0 is the right side, the stored rows are columns of the picture from the right.
        for orientation, rows in stored.items():
            bits, order = ((8, "<"), (16, ">"), (32, "<"))[orientation % 3]
            pixels = b"".join(struct.pack(order + str(len(row)) + {8: "B", 16: "H", 32: "I"}[bits],
                                          *(v << (8 if bits == 16 else 0) for v in row)) for row in rows)
            page = (len(rows[0]), len(rows), bits, pixels, {274: (3, [orientation])})
            with self.subTest(orientation=orientation, bits=bits):
                self.alike(self.heights(self.write("a.tif", tiff([page], order))), picture)

    def test_pixel_size_of_each_axis(self):
        slices = ball(20, 20, 10, 4)
        path = self.write("a.tif", tiff([(20, 20, 8, s, {}) for s in slices]))
        done = self.convert(path, "--pixel-size", "2,2,5", resolution=None)
        self.near_all(self.sides(done), [16, 16, 40], 0.12)
        again = self.convert(path, "--pixel-size", 2, resolution=None, to="p.ply")
        self.near_all(self.sides(again), [16, 16, 16], 0.12)
        image = self.write("i.tif", tiff([(20, 10, 8, bytes(range(200)), {})]))
        wide = self.convert(image, "--pixel-size", "1,3", resolution=None, to="q.ply")
        self.near_all(self.sides(wide)[:2], [20, 30], 0.05)

    def test_pixel_size_errors(self):
        path = self.write("a.tif", tiff([(20, 20, 8, s, {}) for s in ball(20, 20, 10, 4)]))
        image = self.write("i.tif", tiff([(2, 1, 8, b"ab", {})]))
        for value in ("0", "1,0,1", "-1", "1,2,3,4", "x", "1,,2", "1,2,nan"):
            with self.subTest(value):
                self.fails(2, f"--pixel-size {value}", "convert", path, "-o", "a.vdb", "--pixel-size=" + value)
        self.fails(2, "is a volume; give one size, or three", "convert", path, "-o", "a.vdb", "--pixel-size", "1,2")
        self.fails(2, "is an image; give one size, or two", "convert", image, "-o", "a.vdb", "--pixel-size", "1,2,3")

    def test_hyperstacks_generated(self):
        slices = ball(16, 16, 8, 5)
        empty = bytes(256)
        pages = [page for s in slices for page in (empty[:-1] + b"\xff", s)]
        first = {270: (2, "ImageJ=1.53\nimages=16\nchannels=2\nslices=8\nhyperstack=true\nspacing=2.0\nunit=mm\n"),
                 282: (5, [1, 1]), 283: (5, [1, 1]), 296: (3, [1])}
        path = self.write("h.tif", tiff([(16, 16, 8, p, first if i == 0 else {}) for i, p in enumerate(pages)], ">"))
        done = self.convert(path, "--grid", "channel2", "--threshold", 127, resolution=None)
        self.near_all(self.sides(done), [10, 10, 16], 0.1)
        self.assertEqual(self.info(path)["size"], [16, 16, 8])

    def test_pages_of_other_sizes_generated(self):
        path = self.write("d.tif", tiff([(4, 2, 8, b"abcdefgh", {}), (9, 1, 8, b"abcdefghi", {})]))
        said = self.ok("convert", path, "-o", "d.vdb").stderr
        self.assertIn("its pages differ in size or kind", said)
        self.assertIn("page2 (9 x 1, 8 bits)", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
