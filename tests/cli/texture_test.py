"""texture with the real program: points, meshes and level sets coloured like an image, and what is refused."""
import json
import signal
import struct
import subprocess
import time
import unittest
import zlib

from support import PROGRAM, CliTest, sample


def png(width, height, pixel, kind=2, bits=8):
    """A picture; pixel(x, y) gives its bytes. kind: 0 grey, 2 rgb, 6 rgba."""
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def checks(x, y):
    return (200, 40, 40) if (x // 4 + y // 4) % 2 else (40, 40, 200)


def ply_vertices(content):
    head, body = content.split(b"end_header\n", 1)
    kinds = {"float": "f", "uchar": "B", "double": "d"}
    names, form, count, vertex = [], "<", 0, False
    for line in head.decode("latin1").splitlines():
        words = line.split()
        if words[0] == "element":
            vertex = words[1] == "vertex"
            count = int(words[2]) if vertex else count
        elif words[0] == "property" and vertex:
            names.append(words[2])
            form += kinds[words[1]]
    size = struct.calcsize(form)
    return [dict(zip(names, struct.unpack_from(form, body, i * size))) for i in range(count)]


def glb_json(content):
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20:20 + length]), content[28 + length:]


SQUARE = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
"""


class Texture(CliTest):
    def setUp(self):
        super().setUp()
        self.write("checks.png", png(32, 32, checks))
        self.ok("make", "balls", "b.vdb", "--resolution", 24)
        self.ok("convert", "b.vdb", "-o", "b.off")

    def test_the_issue_s_command(self):
        """bunny.off and brick.png as a coloured mesh, with the picture, and as a level set."""
        bunny, brick = sample("meshes/bunny.off"), sample("textures/brick.png")
        said = self.ok("texture", bunny, brick, "-o", "bunny.ply", "-o", "bunny.glb", "-o", "bunny.vdb", "--report", "r.json", "-v").stderr
        self.assertIn("used as not tileable", said)
        vertices = ply_vertices(self.read("bunny.ply"))
        self.assertEqual(len(vertices), 34835)
        self.assertGreater(len({v["red"] for v in vertices}), 50)
        self.assertAlmostEqual(vertices[7]["nx"]**2 + vertices[7]["ny"]**2 + vertices[7]["nz"]**2, 1, places=4)
        gltf, binary = glb_json(self.read("bunny.glb"))
        view = gltf["bufferViews"][gltf["images"][0]["bufferView"]]
        picture = binary[view.get("byteOffset", 0):][:view["byteLength"]]
        self.assertTrue(picture.startswith(b"\x89PNG"))
        self.assertEqual(struct.unpack_from(">II", picture, 16), (512, 512))
        self.assertIn("TEXCOORD_0", gltf["meshes"][0]["primitives"][0]["attributes"])
        self.assertEqual(json.loads(self.ok("info", "bunny.glb", "--json").stdout)["faces"], 69666)
        grids = {g["name"]: g for g in json.loads(self.ok("info", "bunny.vdb", "--json").stdout)["grids"]}
        self.assertLessEqual({"surface", "Cd", "source_u", "source_v", "source_exemplar"}, set(grids))
        self.assertEqual(grids["Cd"]["active_voxels"], grids["surface"]["active_voxels"])
        with open(self.path("r.json")) as file:
            counts = json.load(file)["counts"]
        self.assertEqual(counts["points"], 34835)
        self.assertGreater(counts["texel"], 0)
        self.assertTrue(counts["levels"])

    def test_points(self):
        kitten = sample("points/kitten.xyz")
        self.ok("texture", kitten, "checks.png", "-o", "k.ply", "-o", "k.vdb")
        self.assertEqual(json.loads(self.ok("info", "k.ply", "--json").stdout)["kind"], "points")
        grid = json.loads(self.ok("info", "k.vdb", "--json").stdout)["grids"][0]
        self.assertEqual((grid["name"], grid["type"]), ("points", "ptdataidx32"))
        colours = {(v["red"], v["green"], v["blue"]) for v in ply_vertices(self.read("k.ply"))}
        self.assertGreater(len(colours), 1)

    def test_texture_size_is_the_scale_in_world_units(self):
        base = ("texture", "b.vdb", "checks.png", "-o")
        self.ok(*base, "s.ply", "--report", "s.json", "--texture-size", 12)
        with open(self.path("s.json")) as file:
            texel = json.load(file)["counts"]["texel"]
        self.assertAlmostEqual(32 * texel, 12, places=5)
        # Points of half the distance: the same width of a pixel.
        self.ok("texture", "b.off", "checks.png", "-o", "f.ply", "--as", "levelset", "--voxel-size", 0.5, "--report", "f.json", "--texture-size", 12)
        with open(self.path("f.json")) as file:
            self.assertAlmostEqual(json.load(file)["counts"]["texel"], texel, places=6)
        self.fails(2, "--scale and --texture-size: give one of them", *base, "x.ply", "--texture-size", 12, "--scale", 2)
        self.fails(2, "a scale of", *base, "x.ply", "--texture-size", 1e6)

    def test_kinds_of_target(self):
        self.ok("texture", "b.vdb", "checks.png", "-o", "l.vdb", "-o", "l.ply", "-o", "l.obj", "-o", "l.off", "-o", "l.gltf", "-o", "l.3mf")
        self.ok("texture", "b.off", "checks.png", "-o", "p.ply", "--as", "points")
        self.assertEqual(json.loads(self.ok("info", "p.ply", "--json").stdout)["kind"], "points")
        self.ok("texture", "b.off", "checks.png", "-o", "v.vdb", "--as", "levelset", "--resolution", 30)
        said = self.ok("texture", "l.ply", "checks.png", "-o", "f.ply").stderr
        self.assertIn("--as mesh textures them", said)
        self.ok("texture", "l.ply", "checks.png", "-o", "f.glb", "--as", "mesh")
        said = self.ok("texture", "b.off", "checks.png", "-o", "q.ply", "--resolution", 40).stderr
        self.assertIn("--resolution has no effect", said)

    def test_same_bytes_on_any_number_of_threads(self):
        for threads in (1, 3):
            self.ok("texture", "b.off", "checks.png", "--threads", threads,
                    *[w for e in ("ply", "glb", "vdb", "obj") for w in ("-o", f"t{threads}.{e}")])
            self.ok("texture", "b.off", "checks.png", "--as", "points", "-o", f"p{threads}.vdb", "--threads", threads)
        for name in ("t{}.ply", "t{}.glb", "t{}.vdb", "t{}.obj", "p{}.vdb"):
            self.assertEqual(self.read(name.format(1)), self.read(name.format(3)), name)

    def test_repeat(self):
        self.ok("texture", "b.off", "checks.png", "-o", "map.ply")
        self.ok("repeat", "map.ply", "checks.png", "-o", "again.ply", "-o", "again.glb")
        self.assertEqual(self.read("again.ply"), self.read("map.ply"))
        self.write("large.png", png(64, 64, lambda x, y: (0, 255, 0)))
        said = self.ok("repeat", "map.ply", "large.png", "-o", "green.ply").stderr
        self.assertIn("scaled by 2 and 2", said)
        self.assertEqual({v["green"] for v in ply_vertices(self.read("green.ply"))}, {255})
        self.ok("convert", "b.vdb", "-o", "plain.ply")
        self.fails(3, "no textured file", "repeat", "plain.ply", "checks.png", "-o", "x.ply")
        self.fails(1, "1 samples; 2 are given", "repeat", "map.ply", "checks.png", "checks.png", "-o", "x.ply")
        self.fails(2, "--carry", "repeat", "map.ply", "checks.png", "-o", "x.ply", "--carry", "all")

    def test_maps_regions_and_displacement(self):
        self.write("h.png", png(32, 32, lambda x, y: (255,), kind=0))
        self.ok("texture", "b.off", "checks.png", "--channel", "height=h.png", "--channel", "roughness=h.png", "-o", "d.ply", "-o", "d.glb",
                "--displace", "height", "--amplitude", 2)
        before, after = ply_vertices(self.plain("b.off")), ply_vertices(self.read("d.ply"))
        moved = [sum((a[c] - b[c])**2 for c in "xyz")**0.5 for a, b in zip(after, before)]
        self.assertAlmostEqual(min(moved), 2, places=3)
        self.assertAlmostEqual(max(moved), 2, places=3)
        self.assertEqual({v["roughness"] for v in after}, {1.0})
        gltf, _ = glb_json(self.read("d.glb"))
        self.assertIn("metallicRoughnessTexture", gltf["materials"][0]["pbrMetallicRoughness"])
        self.write("green.png", png(16, 16, lambda x, y: (0, 255, 0)))
        self.ok("mask", "ball", "-o", "m.vdb", "--center", "0,0,0", "--radius", 3)
        self.ok("crop", "b.vdb", "-o", "half.vdb", "--box", "-50,-50,-50,11,50,50")
        self.ok("texture", "b.off", "checks.png", "green.png", "--region", "half.vdb", "-o", "r.ply")
        self.assertEqual({v["source_exemplar"] for v in ply_vertices(self.read("r.ply"))}, {0.0, 1.0})

    def test_regions_by_shape(self):
        """A cube's faces take an image each; colours cross-fade on request."""
        pictures = []
        for k in range(6):
            self.write(f"{k}.png", png(16, 16, lambda x, y: (40 * k, 0, 0)))
            pictures.append(f"{k}.png")
        side, points = range(15), []
        for x in side:
            for y in side:
                for z in side:
                    normal = [(c == 14) - (c == 0) for c in (x, y, z)]
                    if any(normal):
                        points.append(f"{x} {y} {z} {normal[0]} {normal[1]} {normal[2]}")
        self.write("cube.xyzn", "\n".join(points))
        said = self.ok("texture", "cube.xyzn", *pictures, "--region", "auto", "-o", "c.ply").stderr
        self.assertIn("by shape the images take", said)
        vertices = ply_vertices(self.read("c.ply"))
        faces = {tuple(round(v[n]) for n in ("nx", "ny", "nz")): set() for v in vertices}
        for v in vertices:
            faces[tuple(round(v[n]) for n in ("nx", "ny", "nz"))].add(v["source_exemplar"])
        single = [faces[tuple(s * (axis == a) for a in range(3))] for axis in range(3) for s in (-1, 1)]
        self.assertEqual([len(f) for f in single], [1] * 6)
        self.assertEqual(set.union(*single), {0, 1, 2, 3, 4, 5})
        said = self.ok("texture", "cube.xyzn", *pictures, "--region", "auto", "-o", "s.ply", "--region-blend", 3, "-o", "s.vdb").stderr
        self.assertIn("points near borders of regions mix images", said)
        soft = ply_vertices(self.read("s.ply"))
        self.assertGreater(len({v["red"] for v in soft}), 12)
        self.assertTrue(all((v["red"] % 40 == 0) or v["source_blended"] for v in soft))
        self.assertIn("takes the strongest", self.ok("repeat", "s.ply", *pictures, "-o", "again.ply").stderr)
        said = self.ok("texture", "b.off", "0.png", "1.png", "--region", "auto", "-o", "b.ply", "-o", "b.glb", "--region-blend", 2).stderr
        self.assertIn("meet without it", said)

    def test_regions_by_a_grid(self):
        self.write("green.png", png(16, 16, lambda x, y: (0, 255, 0)))
        self.ok("mask", "ball", "-o", "m.vdb", "--center", "12,12,12", "--radius", 8)
        base = ("texture", "b.off", "checks.png", "green.png", "-o", "r.ply", "--region")
        self.ok(*base, "m.vdb:mask")
        found = {}
        for v in ply_vertices(self.read("r.ply")):
            inside = sum((v[c] - 12)**2 for c in "xyz")**0.5
            if abs(inside - 8) > 1.5:
                found.setdefault(inside < 8, set()).add(v["source_exemplar"])
        self.assertEqual(found, {True: {1.0}, False: {0.0}})
        self.ok(*base, "b.vdb:surface")
        self.fails(2, "divides two images", "texture", "b.off", "checks.png", "green.png", "green.png", "-o", "x.ply", "--region", "m.vdb:mask")
        self.fails(3, "no grid", *base, "m.vdb:none")
        self.ok("mask", "ball", "-o", "far.vdb", "--center", "900,0,0", "--radius", 3)
        self.assertIn("green.png: is not used", self.ok(*base, "far.vdb:mask").stderr)

    def plain(self, name):
        self.ok("texture", name, "checks.png", "-o", "plain_.ply")
        return self.read("plain_.ply")

    def test_directions(self):
        for direction in ("axis:z", "around:y", "radial", "curvature"):
            self.ok("texture", "b.off", "checks.png", "-o", "d.ply", "--direction", direction, "--draft")
        self.write("s.csv", "0,0,0,1,0,0\n")
        self.ok("texture", "b.off", "checks.png", "-o", "d.ply", "--direction", "s.csv")

    def test_a_stop_leaves_nothing(self):
        bunny = sample("meshes/bunny.off")
        self.write("old.ply", "old")
        process = subprocess.Popen([PROGRAM, "texture", bunny, self.path("checks.png"), "-o", self.path("old.ply"), "--passes", "20"],
                                   stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        time.sleep(0.6)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, said)
        self.assertEqual(self.read("old.ply"), b"old")
        self.assertFalse([f for f in self.files() if f.endswith(".tmp")])


class Pictures(CliTest):
    def setUp(self):
        super().setUp()
        self.write("checks.png", png(32, 32, checks))
        self.write("q.obj", SQUARE)

    def test_bake(self):
        self.write("r.png", png(32, 32, lambda x, y: (77,), kind=0))
        self.ok("texture", "q.obj", "checks.png", "--channel", "roughness=r.png", "--tile", "yes", "--scale", 0.03, "--bake", "--bake-size", 64,
                "-o", "albedo.png", "-o", "q_roughness.exr", "-o", "q.glb")
        self.assertEqual(struct.unpack_from(">IIBB", self.read("albedo.png"), 16), (64, 64, 8, 2))
        self.ok("texture", "q.obj", "checks.png", "--tile", "yes", "--bake", "--bake-bits", 16, "--bake-size", 32, "-o", "t.<UDIM>.png")
        self.assertIn("t.1001.png", self.files())
        self.assertEqual(self.read("t.1001.png")[24], 16)

    def test_what_cannot_be_baked(self):
        self.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.fails(1, "no texture coordinates", "texture", "bare.obj", "checks.png", "-o", "a.png", "--bake")
        self.fails(2, "--bake", "texture", "q.obj", "checks.png", "-o", "a.png")
        self.fails(2, "--bake", "texture", "q.obj", "checks.png", "-o", "a.glb", "--bake")
        self.fails(2, "--bake-size", "texture", "q.obj", "checks.png", "-o", "a.glb", "--bake-size", 64)
        self.assertEqual([f for f in self.files() if f.startswith("a.")], [])


class Hostile(CliTest):
    def setUp(self):
        super().setUp()
        self.write("good.png", png(16, 16, checks))
        self.write("p.xyz", "".join(f"{i % 5} {i // 5} 0\n" for i in range(25)))

    def test_few_or_bad_points(self):
        points = {"three": "0 0 0\n1 0 0\n0 1 0\n", "equal": "1 1 1\n" * 9, "line": "".join(f"{i} 0 0\n" for i in range(30)), "one": "0 0 0\n",
                  "nan": "0 0 0\nnan 1 1\n1 0 0\n0 1 0\n1 1 0\n"}
        for name, rows in points.items():
            with self.subTest(name):
                self.write(f"{name}.xyz", rows)
                said = self.ok("texture", f"{name}.xyz", "good.png", "-o", f"{name}.ply", "-o", f"{name}.vdb").stderr
                self.assertIn("normals", said)
                seen = {tuple(v[c] for c in "xyz"): (v["red"], v["green"], v["blue"]) for v in ply_vertices(self.read(f"{name}.ply"))}
                for v in ply_vertices(self.read(f"{name}.ply")):
                    self.assertEqual(seen[tuple(v[c] for c in "xyz")], (v["red"], v["green"], v["blue"]))
        self.write("none.xyz", "nan nan nan\n")
        self.fails(1, "none.xyz", "texture", "none.xyz", "good.png", "-o", "x.ply")

    def test_images(self):
        self.write("grey.png", png(8, 8, lambda x, y: (30 * x,), kind=0))
        self.write("deep.png", png(8, 8, lambda x, y: (x, y), kind=0, bits=16))
        self.write("half.png", png(8, 8, lambda x, y: (1, 2, 3, 128), kind=6))
        for name in ("grey", "deep", "half"):
            self.ok("texture", "p.xyz", f"{name}.png", "-o", "x.ply")
        good = self.read("good.png")
        huge = good[:16] + struct.pack(">II", 65000, 65000) + good[24:29]
        bad = {"one": (png(1, 1, checks), 1), "hole": (png(8, 8, lambda x, y: (1, 2, 3, 255 * (x != y)), kind=6), 1), "empty": (b"", 3),
               "cut": (good[:60], 3), "text": (b"not a picture", 3), "huge": (huge + struct.pack(">I", zlib.crc32(huge[12:29])) + good[33:], 3)}
        for name, (content, code) in bad.items():
            with self.subTest(name):
                self.write(f"{name}.png", content)
                self.fails(code, f"{name}.png", "texture", "p.xyz", f"{name}.png", "-o", "y.ply")
        self.fails(3, "missing.png", "texture", "p.xyz", "missing.png", "-o", "y.ply")
        self.assertNotIn("y.ply", self.files())

    def test_words(self):
        base = ("texture", "p.xyz", "good.png", "-o", "x.ply")
        self.fails(2, "too few inputs", "texture", "p.xyz", "-o", "x.ply")
        self.fails(2, "is no image", "texture", "good.png", "p.xyz", "-o", "x.ply")
        self.fails(2, "--output x.stl", "texture", "p.xyz", "good.png", "-o", "x.stl")
        self.fails(1, "needs faces", "texture", "p.xyz", "good.png", "-o", "x.glb")
        self.fails(1, "--as levelset", "texture", "p.xyz", "good.png", "-o", "x.ply", "--as", "mesh")
        self.fails(2, "--region", "texture", "p.xyz", "good.png", "good.png", "-o", "x.ply")
        self.fails(2, "--region auto: needs several images", *base, "--region", "auto")
        self.fails(2, "--region-blend: has no effect on one image", *base, "--region-blend", 2)
        self.fails(2, "--region-blend 2000", *base, "--region-blend", 2000)
        self.fails(2, "or auto", *base, "--region", "automatic")
        self.fails(1, "no attribute part", "texture", "p.xyz", "good.png", "good.png", "-o", "x.ply", "--region-attribute", "part")
        self.fails(2, "--scale 0", *base, "--scale", 0)
        self.fails(2, "--direction", *base, "--direction", "axis:w")
        self.fails(2, "--coherent: has no effect", *base, "--coherent")
        self.fails(2, "give both", *base, "--displace", "height")
        self.fails(2, "add it with --channel", *base, "--displace", "height", "--amplitude", 1)
        self.fails(2, "NAME=FILE", *base, "--channel", "rough.png")
        self.fails(2, "one rough too many", *base, "--channel", "rough=good.png", "--channel", "rough=good.png")
        self.fails(2, "taken by texturing", *base, "--channel", "source_u=good.png")
        self.fails(2, "give one of them", *base, "--draft", "--passes", 3)


if __name__ == "__main__":
    unittest.main()
