"""`render`: pictures, rows, turntables, fog, slices and pages."""
import os
import re
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import CliTest, sample


def picture(data):
    """Width, height, channels and rows of bytes of a PNG of 8 bits."""
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert depth == 8 and kind in (2, 6), (depth, kind)
    channels, packed, at = 3 if kind == 2 else 4, b"", 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += length + 12
    raw, stride, rows, before = zlib.decompress(packed), width * channels, [], None
    for y in range(height):
        how, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a = row[i - channels] if i >= channels else 0
            b = before[i] if before else 0
            c = before[i - channels] if before and i >= channels else 0
            p = a + b - c
            near = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            row[i] = (row[i] + (0, a, b, (a + b) // 2, near)[how]) & 255
        rows.append(row)
        before = row
    return width, height, channels, rows


def warm(row, x, channels=3):
    return row[x * channels] > row[x * channels + 2] + 8


# A cloud of points with a colour for each half, and a fog volume with OpenVDB's own module.
FOG = """
import sys, numpy as np, pyopenvdb
x, y, z = np.mgrid[-1:1:40j, -1:1:40j, -1:1:40j]
grid = pyopenvdb.FloatGrid()
grid.copyFromArray(np.clip(1 - np.sqrt(x * x + y * y + z * z), 0, 1).astype(np.float32))
grid.name, grid.gridClass = "density", pyopenvdb.GridClass.FOG_VOLUME
pyopenvdb.write(sys.argv[1], grids=[grid])
"""


def tall_box(height, axis):
    """A .obj of a box that is `height` along an axis and 1 along the others, red below and blue above."""
    lines = []
    for i in range(8):
        p = [i >> 2, i >> 1 & 1, i & 1]
        p[axis] *= height
        lines.append("v %d %d %d %s" % (*p, "0.1 0.1 0.9" if p[axis] else "0.9 0.1 0.1"))
    lines += ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"]
    return "\n".join(lines) + "\n"


class Pictures(CliTest):
    def setUp(self):
        super().setUp()
        self.ok("make", "balls", "g.vdb", "--resolution", 32)

    def draw(self, *words, inputs=("g.vdb",), size="160x120"):
        result = self.ok("render", *inputs, "-o", "x.png", "--size", size, *words)
        return picture(self.read("x.png")), result.stderr

    def box_of(self, rows, channels=3):
        """The box of what is warm."""
        places = [(x, y) for y, row in enumerate(rows) for x in range(len(row) // channels) if warm(row, x, channels)]
        xs, ys = [x for x, _ in places], [y for _, y in places]
        return min(xs), min(ys), max(xs), max(ys)

    def test_the_model_fills_the_picture_and_any_threads_give_the_same(self):
        (width, height, channels, rows), _ = self.draw()
        self.assertEqual((width, height, channels), (160, 120, 3))
        left, top, right, bottom = self.box_of(rows)
        self.assertGreater(max((right - left) / 160, (bottom - top) / 120), 0.87)
        first = self.read("x.png")
        for threads in (1, 2, 5):
            self.draw("--threads", threads)
            self.assertEqual(self.read("x.png"), first)

    def test_transparent_and_coloured_backgrounds(self):
        (_, _, channels, rows), _ = self.draw("--background", "transparent")
        self.assertEqual(channels, 4)
        self.assertEqual(rows[0][3], 0)
        self.assertEqual(rows[60][80 * 4 + 3], 255)
        for name, value in (("white", (255, 255, 255)), ("black", (0, 0, 0)), ("#204060", (0x20, 0x40, 0x60))):
            (_, _, channels, rows), _ = self.draw("--background", name, "--no-ground")
            self.assertEqual(channels, 3)
            for have, want in zip(rows[0][:3], value):
                self.assertLessEqual(abs(have - want), 24 if want == 255 else 1, name)

    def test_up(self):
        # A tower along y stands by itself in a .obj, and lies with --up z.
        self.write("t.obj", tall_box(5, 1))
        (_, _, _, rows), said = self.draw("--color", "none", "--no-ground", "--resolution", 40, inputs=["t.obj"])
        left, top, right, bottom = self.box_of(rows)
        self.assertGreater(bottom - top, 2 * (right - left))
        self.assertIn("drawn with y up, as .obj files are by custom; --up z changes it", said)
        (_, _, _, rows), said = self.draw("--color", "none", "--no-ground", "--resolution", 40, "--up", "z", inputs=["t.obj"])
        left, top, right, bottom = self.box_of(rows)
        self.assertGreater(right - left, bottom - top)
        self.assertNotIn("y up", said)
        # --view is a direction of the model's world, whatever is up: a tower along z from its front, and one along y.
        self.write("z.obj", tall_box(5, 2))
        a, _ = self.draw("--up", "z", "--view", "0,-1,0", "--resolution", 40, inputs=["z.obj"])
        b, _ = self.draw("--up", "y", "--view", "0,0,1", "--resolution", 40, inputs=["t.obj"])
        for one, other in zip(a[3][30][240:243], b[3][30][240:243]):
            self.assertLessEqual(abs(one - other), 12)
        self.assertGreater(a[3][30][242], a[3][30][240] + 40)  # blue above

    def test_colours(self):
        self.write("t.obj", tall_box(2, 1))
        (_, _, _, rows), _ = self.draw("--resolution", 40, inputs=["t.obj"])
        above, below = rows[25][80 * 3:81 * 3], rows[95][80 * 3:81 * 3]
        self.assertGreater(above[2], above[0] + 40)
        self.assertGreater(below[0], below[2] + 40)
        self.ok("convert", "t.obj", "-o", "t.vdb", "--resolution", 40)
        (_, _, _, same), _ = self.draw("--up", "y", inputs=["t.vdb"])
        self.assertEqual(same, rows)
        self.fails(3, "--color nothing: not in t.vdb, which has Cd", "render", "t.vdb", "-o", "y.png", "--color", "nothing")

    def test_rows_have_captions(self):
        self.ok("make", "grid", "h.vdb", "--resolution", 64)
        (width, height, _, rows), _ = self.draw(inputs=["g.vdb", "h.vdb"])
        self.assertEqual((width, height), (320, 120))
        for part in (0, 160):
            # Dark letters below, and a model above them.
            dark = sum(row[x * 3] < 110 for row in rows[107:118] for x in range(part, part + 160))
            self.assertGreater(dark, 30)
            self.assertGreater(sum(warm(rows[60], x) for x in range(part, part + 160)), 60)
        (_, _, _, none), _ = self.draw("--captions", "none", inputs=["g.vdb", "h.vdb"])
        self.assertNotEqual(none, rows)
        (_, _, _, named), _ = self.draw("--captions", "g.vdb,h.vdb", inputs=["g.vdb", "h.vdb"])
        self.assertEqual(named, rows)
        # One of 64 voxels beside one of 32.
        (_, _, _, scaled), _ = self.draw("--same-scale", "--captions", "none", "--no-ground", inputs=["g.vdb", "h.vdb"], size="120x120")
        halves = [self.box_of([row[:360] for row in scaled]), self.box_of([row[360:] for row in scaled])]
        self.assertLess((halves[0][2] - halves[0][0]) * 1.5, halves[1][2] - halves[1][0])
        (width, height, _, _), _ = self.draw("--columns", 2, inputs=["g.vdb", "h.vdb", "g.vdb"])
        self.assertEqual((width, height), (320, 240))
        self.fails(2, "--captions a: has 1 captions for 2 models", "render", "g.vdb", "h.vdb", "-o", "y.png", "--captions", "a")

    def test_turntable(self):
        self.ok("render", "g.vdb", "-o", "turn.###.png", "--turntable", 4, "--size", "64x48")
        self.assertEqual([f for f in self.files() if f.startswith("turn")], [f"turn.00{i}.png" for i in (1, 2, 3, 4)])
        self.assertEqual(len({self.read(f"turn.00{i}.png") for i in (1, 2, 3, 4)}), 4)
        self.ok("render", "g.vdb", "-o", "one.png", "--size", "64x48")
        # The first looks as one alone does, but for the room that the others need.
        self.assertEqual(picture(self.read("turn.001.png"))[:3], picture(self.read("one.png"))[:3])
        self.fails(2, "write #### where", "render", "g.vdb", "-o", "turn.png", "--turntable", 4)
        self.fails(2, "--turntable and --frames", "render", "g.vdb", "-o", "t.##.png", "--turntable", 4, "--frames", "1-2")
        self.fails(2, "add --frames", "render", "g.vdb", "-o", "t.##.png")

    def test_wireframe(self):
        self.write("t.obj", tall_box(2, 1))
        (_, _, _, plain), _ = self.draw("--color", "none", "--resolution", 40, inputs=["t.obj"])
        (_, _, _, wired), _ = self.draw("--color", "none", "--wireframe", "--resolution", 40, inputs=["t.obj"])
        darker = sum(a > b + 30 for p, w in zip(plain, wired) for a, b in zip(p[::3], w[::3]))
        self.assertTrue(100 < darker < 1500, darker)  # the edges of six quads, and no more
        (_, _, _, level), _ = self.draw("--wireframe")
        (_, _, _, bare), _ = self.draw()
        self.assertGreater(sum(a > b + 10 for p, w in zip(bare, level) for a, b in zip(p[::3], w[::3])), 2000)

    def test_slices(self):
        (_, _, _, rows), _ = self.draw("--slice", "z=0.5", size="320x240")
        self.assertTrue(any(warm(row, x) for row in rows for x in range(320)))
        # The scale bar's box below on the right is white.
        white = sum(min(row[x * 3:x * 3 + 3]) > 225 for row in rows[200:] for x in range(200, 320))
        self.assertGreater(white, 500)
        (width, _, _, _), _ = self.draw("--slice", "z=0.5", inputs=["g.vdb", "g.vdb"], size="320x240")
        self.assertEqual(width, 640)

    def test_refusals(self):
        for says, words in [
            ("--background blue: must be studio", ["--background", "blue"]),
            ("--background #12345: must be", ["--background", "#12345"]),
            ("--view: cannot be combined with --slice", ["--view", "1,0,0", "--slice", "z=0.5"]),
            ("--wireframe: cannot be combined with --slice", ["--wireframe", "--slice", "z=0.5"]),
            ("--directions: cannot be combined with --color", ["--directions", "g.vdb", "--color", "Cd"]),
            ("--turntable 1: must be", ["--turntable", "1"]),
            ("--up x: must be", ["--up", "x"]),
            ("--density 0: must be", ["--density", "0"]),
        ]:
            with self.subTest(words=words):
                self.fails(2, says, "render", "g.vdb", "-o", "x.png", *words)
        self.fails(2, "--size: is for pictures", "render", "g.vdb", "-o", "x.html", "--size", "64x64")
        self.assertEqual(self.files(), ["g.vdb"])


class Fog(CliTest):
    def setUp(self):
        super().setUp()
        script = self.write("fog.py", FOG)
        result = subprocess.run(["/usr/bin/python3", script, self.path("f.vdb")], capture_output=True, text=True)
        if "No module named" in result.stderr:
            self.skipTest(result.stderr.strip().splitlines()[-1])
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_fog_is_drawn_as_fog(self):
        said = self.ok("render", "f.vdb", "-o", "x.png", "--size", "80x80", "--background", "transparent").stderr
        self.assertIn('grid "density" is drawn as fog; --iso draws its surface', said)
        _, _, channels, rows = picture(self.read("x.png"))
        self.assertEqual(channels, 4)
        self.assertGreater(rows[38][40 * 4 + 3], 200)
        self.assertEqual(rows[2][2 * 4 + 3], 0)
        between = sum(20 < row[x * 4 + 3] < 230 for row in rows for x in range(80))
        self.assertGreater(between, 300)  # soft, where a surface has an edge
        first = self.read("x.png")
        self.ok("render", "f.vdb", "-o", "x.png", "--size", "80x80", "--background", "transparent", "--threads", 1)
        self.assertEqual(self.read("x.png"), first)
        self.ok("render", "f.vdb", "-o", "y.png", "--size", "80x80", "--background", "transparent", "--density", 0.03)
        self.assertLess(picture(self.read("y.png"))[3][38][40 * 4 + 3], 200)

    def test_with_iso_it_is_a_surface(self):
        self.ok("render", "f.vdb", "-o", "x.png", "--size", "80x80", "--iso", 0.5)
        self.assertTrue(warm(picture(self.read("x.png"))[3][40], 40))
        self.fails(2, "is fog, which has no surface", "render", "f.vdb", "-o", "x.png", "--wireframe")
        self.fails(1, "", "render", "f.vdb", "-o", "x.png", "--slice", "z=0.5")

    def test_real_smoke(self):
        self.ok("render", sample("volumes/elyg-pyro-fog.vdb"), "-o", "x.png", "--size", "120x120")
        self.assertGreater(len(set(bytes(row[i:i + 3]) for row in picture(self.read("x.png"))[3] for i in range(0, 360, 3))), 200)


class Pages(CliTest):
    """A page in a real browser, headless, with its software renderer."""

    def setUp(self):
        super().setUp()
        self.browser = shutil.which("chromium") or shutil.which("chromium-browser")

    def opened(self, name, *words):
        if not self.browser:
            self.skipTest("chromium is absent")
        command = [self.browser, "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--enable-logging=stderr",
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
                   f"--user-data-dir={self.path('profile')}", *words, "file://" + self.path(name)]
        return subprocess.run(command, capture_output=True, text=True, timeout=180, env={**os.environ, "HOME": self.folder})

    def test_a_page_turns_the_model(self):
        self.ok("make", "balls", "a<b>.vdb", "--resolution", 40)
        self.ok("make", "grid", "b.vdb", "--resolution", 40)
        self.ok("render", "a<b>.vdb", "b.vdb", "-o", "view.html")
        page = self.read("view.html").decode()
        self.assertEqual(re.findall(r"(?:src|href)=\"(?!data:)[^\"]*", page), [])
        self.assertIn("a&lt;b&gt;.vdb", page)
        self.ok("render", "a<b>.vdb", "b.vdb", "-o", "again.html", "--threads", 1)
        self.assertEqual(self.read("again.html"), self.read("view.html"))
        dom = self.opened("view.html#check", "--window-size=1000,600", "--dump-dom")
        self.assertIn('data-viewers="2"', dom.stdout, dom.stderr[-2000:])
        covered = [int(n) for n in re.findall(r'data-drawn="(\d+)"', dom.stdout)]
        self.assertEqual(len(covered), 2, dom.stderr[-2000:])
        for pixels in covered:
            self.assertGreater(pixels, 20000)
        # Half of it is cut off; turned it looks otherwise.
        cut = self.opened("view.html#check&cut=x,0.3", "--window-size=1000,600", "--dump-dom")
        for less, all_of_it in zip(re.findall(r'data-drawn="(\d+)"', cut.stdout), covered):
            self.assertTrue(1000 < int(less) < 0.9 * all_of_it, (less, all_of_it))
        shots = []
        for part in ("", "#turn=0.8", "#cut=z,0.5"):
            self.opened("view.html" + part, f"--screenshot={self.path('shot.png')}", "--window-size=1000,600")
            shots.append(self.read("shot.png"))
        self.assertEqual(len(set(shots)), 3)
        for shot in shots:
            _, _, channels, rows = picture(shot)
            self.assertGreater(len({bytes(rows[y][x:x + 3]) for y in range(100, 500, 3) for x in range(0, 1000 * channels, 4 * channels)}), 300)

    def test_a_large_result_stays_under_five_megabytes(self):
        self.ok("make", "sponge", "s.vdb", "--resolution", 128)
        said = self.ok("render", "s.vdb", "-o", "view.html").stderr
        self.assertLess(os.path.getsize(self.path("view.html")), 5e6)
        self.assertIn("triangles are in the page", said)

    def test_compare_shows_both_models_so(self):
        self.ok("make", "balls", "a.vdb", "--resolution", 40)
        self.ok("make", "balls", "b.vdb", "--resolution", 40, "--seed", 2)
        self.ok("compare", "a.vdb", "b.vdb", "--page", "page.html")
        dom = self.opened("page.html#check", "--window-size=1000,1200", "--dump-dom")
        self.assertIn('data-viewers="2"', dom.stdout, dom.stderr[-2000:])
        self.assertIn('data-ready="yes"', dom.stdout)
        for pixels in re.findall(r'data-drawn="(\d+)"', dom.stdout):
            self.assertGreater(int(pixels), 10000)


if __name__ == "__main__":
    unittest.main(verbosity=2)
