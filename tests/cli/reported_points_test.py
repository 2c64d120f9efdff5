#!/usr/bin/env python3
"""Files of points that people reported, and files of the same kinds, through the command line."""
import math
import struct
import sys
import unittest

from reported import Reported
from support import sample


def sphere(count=4000, centre=(10.25, 20.5, 5.125), radius=2.0):
    """Points of a Fibonacci lattice on a sphere, with their normals."""
    rows = []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        r = math.sqrt(1 - z * z)
        angle = i * math.pi * (3 - math.sqrt(5))
        n = (r * math.cos(angle), r * math.sin(angle), z)
        rows.append((tuple(c + radius * k for c, k in zip(centre, n)), n))
    return rows


def text(rows, line):
    return "".join(line(i, p, n) + "\n" for i, (p, n) in enumerate(rows))


def plain(i, p, n):
    return "%.5f %.5f %.5f" % p


VOLUME = 4 / 3 * math.pi * 8


class PointsCase(Reported):
    def is_sphere(self, name, *says, normals=False):
        """That `name` gives the sphere, saying these."""
        done = self.convert(name, resolution=40)
        self.assertEqual(done.code, 0, done.said)
        self.near(done.volume, VOLUME)
        self.near(done.area, 4 * math.pi * 4, 0.03)
        for got, right in zip(done.bounds, (8.25, 18.5, 3.125, 12.25, 22.5, 7.125)):
            self.assertAlmostEqual(got, right, delta=0.06)
        for part in says:
            self.assertIn(part, done.said)
        self.assertEqual("no normals" in done.said, not normals, done.said)
        return done

    def colour_of(self, name):
        """Mean of the colours of a .ply's vertices, and its property names."""
        raw = self.read(name)
        head, body = raw.split(b"end_header\n", 1)
        lines = head.decode().splitlines()
        count = int([l for l in lines if l.startswith("element vertex")][0].split()[2])
        vertex = lines[[i for i, l in enumerate(lines) if l.startswith("element vertex")][0] + 1:]
        names, form = [], "<"
        for line in vertex:
            if not line.startswith("property ") or " list " in line:
                break
            form += {"float": "f", "uchar": "B"}[line.split()[1]]
            names.append(line.split()[2])
        sums = [0.0] * len(names)
        for i in range(count):
            for k, value in enumerate(struct.unpack_from(form, body, i * struct.calcsize(form))):
                sums[k] += value / count
        return dict(zip(names, sums))

    def refused(self, code, says, name):
        done = self.run_tool("info", name)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(says, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1)


class Rows(PointsCase):
    def test_23_agisoft_utm(self):
        path = self.file("23-xyz-agisoft-utm.xyz")
        with open(path) as file:
            rows = [[float(w) for w in line.split()[:3]] for line in file if line.strip()]
        info = self.info("23-xyz-agisoft-utm.xyz")
        for axis in range(3):
            column = [row[axis] for row in rows]
            self.assertAlmostEqual(info["bounds_min"][axis], min(column), delta=0.001)
            self.assertAlmostEqual(info["bounds_max"][axis], max(column), delta=0.001)

    def test_36_decimal_comma(self):
        self.is_sphere("36-xyz-decimal-comma.xyz", "commas read as decimal points")

    def test_36_variants_of_decimal_commas(self):
        rows = sphere()
        comma = lambda value: ("%.4f" % value).replace(".", ",")
        for name, join, head in (("a.csv", ";", "X;Y;Z\n"), ("b.txt", "\t", ""), ("c.asc", " ", "// X Y Z\n"),
                                 ("d.csv", '","', ""), ("e.txt", "|", "x|y|z\n")):
            quote = '"' if '"' in join else ""
            body = text(rows, lambda i, p, n: quote + join.join(map(comma, p)) + quote)
            self.is_sphere(self.write(name, head + body), "commas read as decimal points")

    def test_36_commas_that_are_not_decimal(self):
        for name, join in (("a.csv", ","), ("b.csv", ", "), ("c.csv", " , "), ("d.csv", ";"), ("e.csv", "\t"),
                           ("f.csv", "|")):
            body = text(sphere(), lambda i, p, n: join.join("%.4f" % c for c in p))
            self.is_sphere(self.write(name, "x,y,z\n" + body if join == "," else body))

    def test_38_pts_with_intensity_and_colours(self):
        body = text(sphere(), lambda i, p, n: plain(i, p, n) + " %d 200 100 50" % (i % 4096 - 2048))
        for name in ("a.pts", "a.txt", "a.asc", "a.csv"):
            self.is_sphere(self.write(name, "4000\n" + body), "column 4 as intensity")
            colours = self.colour_of("o.ply")
            self.assertAlmostEqual(colours["red"], 200, delta=1)
            self.assertAlmostEqual(colours["blue"], 50, delta=1)
            self.assertIn("intensity", colours)

    def test_39_pts_of_one_and_of_several_blocks(self):
        rows = sphere()
        self.is_sphere(self.write("one.pts", "4000\n" + text(rows, plain)))
        self.is_sphere(self.write("none.pts", text(rows, plain)))
        blocks = "".join("1000\n" + text(rows[k:k + 1000], plain) for k in range(0, 4000, 1000))
        self.is_sphere(self.write("several.pts", blocks))
        done = self.is_sphere(self.write("wrong.pts", "5000\n" + text(rows, plain)))
        self.assertIn("line 1 counts 5000 points, 4000 rows are there", done.said)


class Columns(PointsCase):
    def test_43_cloudcompare_header(self):
        self.is_sphere("43-xyz-cc-header.xyz")
        colours = self.colour_of("o.ply")
        for name, right in (("red", 200), ("green", 100), ("blue", 50)):
            self.assertAlmostEqual(colours[name], right, delta=1)

    def test_43_headers_of_other_writers(self):
        rows = sphere()
        line = lambda i, p, n: "%.5f,%.5f,%.5f" % p + ",%.5f,%.5f,%.5f" % n + ",7.5,200,100,50"
        names = "x,y,z,nx,ny,nz,reflectance,red,green,blue"
        for name, head in (("a.csv", names), ("b.csv", "\ufeff" + names), ("c.txt", "# " + names.replace(",", " ")),
                           ("d.asc", "//" + names.upper() + "\n4000"),
                           ("e.csv", ",".join('"%s"' % n for n in names.split(",")))):
            self.is_sphere(self.write(name, head.encode() + b"\n" + text(rows, line).encode()), normals=True)
            colours = self.colour_of("o.ply")
            self.assertAlmostEqual(colours["green"], 100, delta=1)
            self.assertAlmostEqual(colours.get("reflectance", colours.get("REFLECTANCE")), 7.5, delta=0.1)
        moved = text(rows, lambda i, p, n: "%d;%.5f;tree;%.5f;%.5f" % (i, p[2], p[1], p[0]))
        self.is_sphere(self.write("f.csv", "id;Z (m);kind;Y (m);X (m)\n" + moved), "holds words in 4000 rows")

    def test_44_intensity_before_colours(self):
        self.is_sphere("44-xyz-intensity-rgb.xyz", "column 4 as intensity, columns 5 to 7 as red, green, blue")
        colours = self.colour_of("o.ply")
        for name, right in (("red", 200), ("green", 100), ("blue", 50)):
            self.assertAlmostEqual(colours[name], right, delta=1)
        self.assertIn("intensity", colours)

    def test_44_normals_colours_and_intensities_in_any_order(self):
        normal, colour, extra = " %.5f %.5f %.5f", " 200 100 50", " 0.375"
        for k, order in enumerate(("nc", "cnx", "xcn", "cx", "nx", "xn")):
            line = lambda i, p, n: plain(i, p, n) + "".join({"n": normal % n, "c": colour, "x": extra}[o] for o in order)
            done = self.is_sphere(self.write("%d.xyz" % k, text(sphere(), line)), "by the range of their numbers",
                                  normals="n" in order)
            colours = self.colour_of("o.ply")
            if "c" in order:
                self.assertAlmostEqual(colours["red"], 200, delta=1, msg=order)
            if "x" in order:
                self.assertAlmostEqual(colours["intensity"], 0.375, delta=0.01, msg=order)


class Files(PointsCase):
    def test_89_count_and_rows(self):
        self.is_sphere(self.write("a.xyz", "4000\n" + text(sphere(), plain)))
        both = "4000\n" + text(sphere(), plain) + text(sphere(), lambda i, p, n: "%.5f %.5f %.5f" % n)
        self.is_sphere(self.write("a.pwn", both), normals=True)

    def test_line_ends_and_files_cut_off(self):
        body = text(sphere(), plain)
        self.is_sphere(self.write("mac.xyz", body.replace("\n", "\r").encode()))
        self.is_sphere(self.write("dos.xyz", body.replace("\n", "\r\n").encode()))
        done = self.is_sphere(self.write("cut.xyz", body[:-12]))
        self.assertIn("line 4000, the last, is cut off and left out", done.said)
        self.write("few.xyz", "1 2 3\n4 5\n6 7 8\n")
        self.refused(3, "few.xyz:2: a row of 2 numbers where the first has 3", "few.xyz")

    def test_other_formats_are_named(self):
        self.write("a.las", b"LASF\0\1")
        self.write("b.laz", b"LASF\0\1")
        self.write("a.ptx", "2\n2\n")
        for name in ("a.las", "b.laz", "a.ptx"):
            self.refused(2, "files are not read; save the points as", name)
        self.write("c.txt", b"LASF\0\1")
        self.refused(3, "is a LAS file", "c.txt")
        self.write("p.pts", "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n")
        self.refused(3, "PTX", "p.pts")
        self.write("g.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n")
        self.refused(3, "ESRI ASCII grid", "g.asc")
        self.write("u.txt", "1 2 3\n".encode("utf-16"))
        self.refused(3, "UTF-16", "u.txt")


class Outliers(PointsCase):
    def test_points_that_distances_overflow(self):
        with open(sample("points/kitten.xyz")) as file:
            kitten = file.read().rstrip("\n") + "\n"
        right = self.convert(self.write("k.xyz", kitten)).volume
        for name, far in (("a", "1e30 0 0 1 0 0\n"), ("c", "0 1e38 0 1 0 0\n"),
                          ("e", "1e30 0 0 1 0 0\n1e30 1e24 0 1 0 0\n0 0 1e20 0 0 1\n"),
                          ("g", "1e300 0 0 1 0 0\n-1e300 0 0 1 0 0\n")):
            done = self.run_tool("convert", self.write(name + ".xyz", kitten + far), "-o", name + ".ply", "--resolution", 80)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("%d outlier%s of %d points left out" % (far.count("\n"), "s" if far.count("\n") > 1 else "", kitten.count("\n") + far.count("\n")),
                          done.stderr)
            self.near(self.info(self.path(name + ".ply"))["signed_volume"], right, 0.001)

    def test_zeros_in_a_survey(self):
        body = text(sphere(centre=(565021.25, 5648340.5, 105.125)), lambda i, p, n: "%.4f %.4f %.4f" % p)
        done = self.run_tool("convert", self.write("u.xyz", body + "0 0 0\n"), "-o", "u.vdb", "--resolution", 80)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 outlier of 4001 points left out", done.stderr)
        info = self.info(self.path("u.vdb"))["model"]
        self.near(info["solid_voxels"] * info["voxel_size"] ** 3, VOLUME)


class Pcd(PointsCase):
    def pcd(self, head, rows, form="<fff", line="\n"):
        body = b"".join(struct.pack(form, *p) for p, n in rows)
        return (head.replace("\n", line) + "DATA binary" + line).encode() + body

    def test_40_lower_case_types(self):
        self.is_sphere("40-pcd-lowercase-type.pcd")

    def test_41_columns(self):
        self.is_sphere("41-pcd-columns.pcd")

    def test_40_41_variants(self):
        rows = sphere()
        head = "FIELDS x y z\nSIZE 4 4 4\nTYPE f f f\nWIDTH 4000\nHEIGHT 1\nPOINTS 4000\n"
        self.is_sphere(self.write("crlf.pcd", self.pcd(head, rows, line="\r\n")))
        self.is_sphere(self.write("lower.pcd", self.pcd(head.lower(), rows)))
        self.is_sphere(self.write("double.pcd", self.pcd(head.replace("4 4 4\n", "8 8 8\n"), rows, "<ddd")))
        self.is_sphere(self.write("old.pcd", self.pcd("VERSION .5\nCOLUMNS x y z\nPOINTS 4000\n", rows)), "type F and size 4")
        grid = self.is_sphere(self.write("grid.pcd", self.pcd(head.replace("WIDTH 4000", "WIDTH 4001"), rows)))
        self.assertIn("WIDTH times HEIGHT is 4001, POINTS is 4000", grid.said)
        self.write("short.pcd", self.pcd(head, rows[:-1]))
        self.refused(3, "claims 4000 points of 12 bytes, more than the file holds; it has 47988 bytes", "short.pcd")

    def test_organised_with_nan(self):
        rows = [((math.nan,) * 3, None) if i % 3 == 0 else row for i, row in enumerate(sphere(6000))]
        head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 100\nHEIGHT 60\nPOINTS 6000\n"
        self.is_sphere(self.write("organised.pcd", self.pcd(head, rows)), "2000 points without finite coordinates")


class Arrays(PointsCase):
    def npy(self, kind, shape, data, fortran=False):
        head = "{'descr': %s, 'fortran_order': %s, 'shape': %s, }" % (kind, fortran, shape)
        head = head.ljust(117) + "\n"
        return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + data

    def test_63_array_of_points(self):
        info = self.info("63-npy-n-by-3-points.npy")
        self.assertEqual(info["kind"], "points")
        self.assertEqual(info["points"], 32314)
        self.assertIn("32314 points", self.convert("63-npy-n-by-3-points.npy").said)

    def test_63_variants(self):
        rows = sphere()
        by_row = [c for p, n in rows for c in p]
        by_axis = [p[axis] for axis in range(3) for p, n in rows]
        doubles = struct.pack("<12000d", *by_row)
        turned = struct.pack("<12000d", *by_axis)
        self.is_sphere(self.write("a.npy", self.npy("'<f8'", "(4000, 3)", doubles)), "4000 points")
        self.is_sphere(self.write("b.npy", self.npy("'<f8'", "(3, 4000)", turned)))
        self.is_sphere(self.write("c.npy", self.npy("'<f8'", "(4000, 3)", turned, True)))
        self.is_sphere(self.write("d.npy", self.npy("'>f4'", "(4000, 3)", struct.pack(">12000f", *by_row))))
        six = struct.pack("<24000f", *[c for p, n in rows for c in p + n])
        self.is_sphere(self.write("e.npy", self.npy("'<f4'", "(4000, 6)", six)), normals=True)

    def test_63_what_stays_a_picture_and_what_is_refused(self):
        self.write("i.npy", self.npy("'<f4'", "(400, 10)", struct.pack("<4000f", *[i % 7 for i in range(4000)])))
        self.assertEqual(self.info(self.path("i.npy"))["kind"], "image")
        self.write("v.npy", self.npy("'<f4'", "(400, 3)", struct.pack("<1200f", *[i % 7 for i in range(1200)])))
        self.assertEqual(self.info(self.path("v.npy"))["kind"], "points")
        self.ok("convert", "v.npy", "-o", "v.vdb", "--as", "volume", "--threshold", 3)
        record = "[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]"
        self.write("r.npy", self.npy(record, "(400,)", bytes(4800)))
        self.refused(3, "structured array", "r.npy")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[1:])
