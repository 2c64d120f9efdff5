"""The main path, end to end, and what every output promises."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest


from support import PROGRAM, SOURCE, CliTest, sample


def npy(values, shape, kind="|u1"):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(118).encode()
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(values)


class Doors(CliTest):
    def model(self, name):
        return json.loads(self.ok("info", name, "--json").stdout)["model"]

    def test_an_image_becomes_a_slab_and_an_image_again(self):
        pixels = bytes((x * 5 + y * 3) % 256 for y in range(24) for x in range(32))
        self.write("a.pgm", b"P5 32 24 255\n" + pixels)
        result = self.ok("convert", "a.pgm", "-o", "a.vdb", "-o", "a.png", "-o", "a.exr", "--height", 20, "--base", 3.5)
        self.assertIn("white one of 20 (world)", result.stderr)
        model = self.model("a.vdb")
        self.assertTrue(model["valid"], model)
        self.assertTrue(model["domain_recorded"])
        self.assertTrue(model["domain"].startswith("0,0,-3,31,23,"), model)
        self.assertEqual(json.loads(self.ok("info", "a.png", "--json").stdout)["white"], 65535)
        self.ok("convert", "a.exr", "-o", "b.exr", "--base", 3.5)
        again = self.model_heights("a.exr"), self.model_heights("b.exr")
        self.assertLess(abs(again[0] - again[1]), 0.2)  # the highest pixel is at an edge, where the cap is near
        self.ok("convert", "a.pgm", "-o", "c.vdb", "--plane", "zx", "--pixel-size", 2)
        self.assertTrue(self.model("c.vdb")["domain"].endswith(",31"))

    def model_heights(self, name):
        return json.loads(self.ok("info", name, "--json").stdout)["maximum"]

    def test_volumes_need_to_know_what_is_solid(self):
        values = [z * 10 for z in range(12) for _ in range(100)]
        self.write("v.npy", npy(values, "(12, 10, 10)"))
        self.fails(1, "v.npy: choose what is solid with --threshold VALUE or --labels LIST; its values range from 0 to 110",
                   "convert", "v.npy", "-o", "v.vdb")
        self.ok("convert", "v.npy", "-o", "v.vdb", "--threshold", 55)
        self.assertEqual(self.model("v.vdb")["solid_voxels"], 600)
        self.ok("convert", "v.npy", "-o", "v.vdb", "--labels", "0,40-60")
        self.assertEqual(self.model("v.vdb")["solid_voxels"], 400)
        self.fails(2, "--labels", "convert", "v.npy", "-o", "v.vdb", "--labels", "5-1")
        self.fails(2, "give one of them", "convert", "v.npy", "-o", "v.vdb", "--labels", "5", "--threshold", 5)
        self.fails(1, "values of v.npy range from 0 to 110", "convert", "v.npy", "-o", "v.vdb", "--threshold", 500)
        self.write("flat.npy", npy([0, 1, 1, 0] * 16, "(8, 8)"))
        self.fails(2, "with --as volume it is a volume", "convert", "flat.npy", "-o", "f.vdb", "--threshold", 0.5)
        self.ok("convert", "flat.npy", "-o", "f.vdb", "--as", "volume")
        self.assertEqual(self.model("f.vdb")["domain"], "0,0,0,7,7,0")

    def test_every_image_and_volume_of_the_samples(self):
        for name, options in (("textures/embark-1.jpg", []), ("textures/embark-4.png", []), ("textures/metal.pgm", []), ("terrain/elev.tif", []),
                              ("volumes/heart.vti", ["--threshold", 60]), ("volumes/skull_2.9.inr", ["--threshold", 2.9]),
                              ("volumes/aal.nii.gz", ["--labels", "1-20"]), ("volumes/TI1_3D.SGEMS", []), ("volumes/blobs_3d_fiji_skeleton.tif", [])):
            with self.subTest(name):
                self.ok("convert", sample(name), "-o", "a.vdb", *options)
                model = self.model("a.vdb")
                self.assertEqual(model["band_gaps"], 0)
                self.assertGreater(model["solid_voxels"], 100)


class Attributes(CliTest):
    def grids(self, name):
        return {g["name"]: g["type"] for g in json.loads(self.ok("info", name, "--json").stdout)["grids"]}

    def test_colour_goes_through_a_level_set(self):
        # A cube whose colour is its place: red along x, green along y, blue along z.
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = ("0 1 3 2", "4 6 7 5", "0 4 5 1", "2 3 7 6", "0 2 6 4", "1 5 7 3")
        header = ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                  "property uchar green\nproperty uchar blue\nproperty float heat\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n")
        rows = [f"{x} {y} {z} {255 * x} {255 * y} {255 * z} {10 * z}" for x, y, z in corners]
        self.write("cube.ply", header + "\n".join(rows + [f"4 {f}" for f in faces]) + "\n")
        self.ok("convert", "cube.ply", "-o", "cube.vdb", "-o", "out.obj", "-o", "out.ply", "-o", "out.glb", "--resolution", 24)
        self.assertEqual(self.grids("cube.vdb"), {"surface": "float", "Cd": "vec3s", "heat": "float"})
        for line in self.read("out.obj").decode().splitlines():
            if not line.startswith("v "):
                continue
            x, y, z, r, g, b = map(float, line.split()[1:])
            for place, colour in ((x, r), (y, g), (z, b)):
                self.assertAlmostEqual(place, colour, delta=0.05)
        self.ok("convert", "out.glb", "-o", "again.vdb", "--resolution", 24)
        self.assertEqual(self.grids("again.vdb"), {"surface": "float", "Cd": "vec3s", "heat": "float"})
        self.ok("convert", "out.ply", "-o", "points.ply", "--as", "points", "--resolution", 24)
        self.assertIn(b"property uchar red", self.read("points.ply")[:400])
        self.assertIn(b"property float heat", self.read("points.ply")[:400])

    def test_info_welds_the_seams_of_a_texture(self):
        rows = [f"v {x} {y} {z}" for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
        texture = [f"vt {i / 24} 0" for i in range(24)]
        corners = iter(range(1, 25))
        lines = ["f " + " ".join(f"{v}/{next(corners)}" for v in face) for face in faces]
        self.write("uv.obj", "\n".join(rows + texture + lines) + "\n")
        info = json.loads(self.ok("info", "uv.obj", "--json").stdout)
        self.assertEqual((info["open_edges"], info["closed_manifold"]), (0, True))

    def test_grids_of_a_vdb_are_carried(self):
        script = ("import pyopenvdb as v\n"
                  "s = v.createLevelSetSphere(radius=8, voxelSize=1)\ns.name = 'surface'\n"
                  "c = v.Vec3SGrid(); c.name = 'Cd'; c.fill((-9, -9, -9), (9, 9, 9), (0.2, 0.4, 0.6))\n"
                  "b = v.BoolGrid(); b.name = 'picked'; b.fill((0, 0, 0), (20, 20, 20), True)\n"
                  "v.write('in.vdb', grids=[s, c, b])")
        if subprocess.run(["/usr/bin/python3", "-c", script], cwd=self.folder, capture_output=True).returncode:
            self.skipTest("python3-openvdb is absent")
        self.ok("convert", "in.vdb", "-o", "out.vdb", "-o", "out.obj")
        self.assertEqual(self.grids("out.vdb"), {"surface": "float", "Cd": "vec3s", "picked": "bool"})
        self.assertIn(" 0.2 0.4 0.6\n", self.read("out.obj").decode())
        self.ok("crop", "in.vdb", "-o", "part.vdb", "--box", "0,0,0,10,10,10")
        grids = json.loads(self.ok("info", "part.vdb", "--json").stdout)["grids"]
        box = {g["name"]: (g["active_min"], g["active_max"]) for g in grids}
        self.assertEqual(box["Cd"], ([0, 0, 0], [9, 9, 9]))
        self.assertEqual(box["picked"], ([0, 0, 0], [10, 10, 10]))


class StandardStreams(CliTest):
    def piped(self, content, *words):
        return subprocess.run([PROGRAM, *map(str, words)], input=content, capture_output=True, cwd=self.folder, timeout=240)

    def test_in_and_out(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.ok("convert", "g.vdb", "-o", "g.obj")
        for words in (["-.obj"], ["-", "--as", "obj"]):
            result = self.piped(self.read("g.obj"), "convert", *words, "-o", "-.ply")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue(result.stdout.startswith(b"ply"))
            self.assertIn(b"-.obj: voxel size" if len(words) == 1 else b"-: voxel size", result.stderr)
        made = self.piped(b"", "make", "grid", "-.vdb", "--resolution", 24)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual(made.stdout, self.read("g.vdb"))
        told = self.piped(made.stdout, "info", "-", "--json")
        self.assertTrue(json.loads(told.stdout)["model"]["valid"])
        self.ok("convert", "g.obj", "-o", "a.vdb", "--resolution", 30)
        self.piped(self.read("g.obj"), "convert", "-.obj", "-o", "b.vdb", "--resolution", 30)
        names = [json.loads(self.ok("info", f, "--json").stdout)["metadata"]["vdbsynth:inputs"] for f in ("a.vdb", "b.vdb")]
        self.assertEqual(json.loads(names[0])[0]["hash"], json.loads(names[1])[0]["hash"])
        self.assertEqual(json.loads(names[1])[0]["name"], "-.obj")
        self.assertIn(b'"file": "-.obj"', self.piped(self.read("g.obj"), "info", "-.obj", "--json").stdout)
        # A report replays the run, streams and all.
        self.piped(self.read("g.obj"), "convert", "-.obj", "-o", "c.vdb", "--report", "c.json")
        self.assertEqual(json.loads(self.read("c.json"))["options"]["inputs"], ["-.obj"])
        self.assertEqual(self.piped(self.read("g.obj"), "convert", "--config", "c.json").returncode, 0)

    def test_temporaries_are_private(self):
        """Others write to the folder of temporaries too: no name is known before, and nobody else can look."""
        shared = self.path("shared")
        os.mkdir(shared)
        self.write("precious", "precious")
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.ok("convert", "g.vdb", "-o", "g.obj")
        # Links where the names of old were, for every process number that the worker may get.
        script = 'for i in $(seq $$ $(($$ + 60))); do for e in in.obj out.ply; do ln -s "$0" "$TMPDIR/vdb_synth.$i.$e"; done; done; exec "$@"'
        process = subprocess.Popen(["sh", "-c", script, self.path("precious"), PROGRAM, "convert", "-.obj", "-o", "-.ply"], cwd=self.folder,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, "TMPDIR": shared})
        process.stdin.write(self.read("g.obj")[:100])
        process.stdin.flush()
        made, deadline = [], time.time() + 30
        while not made and time.time() < deadline:
            made = [os.path.join(at, name) for at, _, names in os.walk(shared) for name in names if not name.endswith((".in.obj", ".out.ply"))]
            time.sleep(0.05)
        self.assertTrue(made)
        for path in made:
            self.assertEqual(os.stat(path).st_mode & 0o777, 0o600)
            self.assertEqual(os.stat(os.path.dirname(path)).st_mode & 0o777, 0o700)
        words = process.communicate(self.read("g.obj")[100:], timeout=60)
        self.assertEqual(process.returncode, 0, words[1])
        self.assertTrue(words[0].startswith(b"ply"))
        self.assertEqual(self.read("precious"), b"precious")
        self.assertFalse([name for name in os.listdir(shared) if not os.path.islink(os.path.join(shared, name))])

    def test_a_killed_worker_leaves_no_temporaries(self):
        shared = self.path("shared")
        os.mkdir(shared)
        process = subprocess.Popen([PROGRAM, "convert", "-.obj", "-o", "a.vdb"], cwd=self.folder, stdin=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, env={**os.environ, "TMPDIR": shared})
        deadline = time.time() + 30
        while not any(names for _, _, names in os.walk(shared)) and time.time() < deadline:
            time.sleep(0.05)
        self.assertTrue(os.listdir(shared))
        worker = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
        os.kill(int(worker[0]), signal.SIGKILL)
        process.wait(timeout=60)
        process.stdin.close()
        self.assertEqual(os.listdir(shared), [])

    def test_errors(self):
        for content, words, code, says in (
                (b"", ["convert", "-.obj", "-o", "a.vdb"], 3, b"-.obj: standard input is empty"),
                (b"v 0 0 0", ["convert", "-", "-o", "a.vdb"], 2, b"the kind of file on standard input is unknown"),
                (b"plx", ["convert", "-.ply", "-o", "a.vdb"], 3, b"-.ply:"),
                (b"x", ["convert", "-.ply", "-o", "-"], 2, b"as -.EXT"),
                (b"x", ["convert", "-.ply", "--as", "obj", "-o", "a.vdb"], 2, b"no input is -"),
                (b"x", ["convert", "-.ply", "-.obj", "-o", "a.vdb"], 2, b"one input only")):
            result = self.piped(content, *words)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(says, result.stderr)
            self.assertEqual(result.stdout, b"")
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        process = subprocess.Popen([PROGRAM, "convert", "g.vdb", "-o", "-.ply"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.folder)
        process.stdout.close()
        self.assertIn(b"standard output cannot be written", process.communicate()[1])
        self.assertEqual(process.returncode, 3)


class MainPath(CliTest):
    def test_make_synth_render(self):
        self.ok("make", "grid", "grid.vdb", "--resolution", 40)
        self.ok("synth", "grid.vdb", "-o", "more.vdb", "-o", "more.obj", "-o", "more.ply", "--size", "2x,2x,1x")
        self.ok("render", "more.vdb", "-o", "more.png")
        self.assertTrue(self.read("more.png").startswith(b"\x89PNG"))
        for mesh in ("more.obj", "more.ply"):
            info = json.loads(self.ok("info", mesh, "--json").stdout)
            self.assertTrue(info["closed_manifold"], info)
        info = json.loads(self.ok("info", "more.vdb", "--json").stdout)
        self.assertEqual(info["model"]["domain"], "0,0,0,79,79,39")
        self.assertTrue(info["model"]["domain_recorded"])
        self.assertTrue(info["model"]["valid"], info["model"])
        self.assertEqual(info["grids"][0]["name"], "surface")
        self.assertEqual(info["grids"][0]["class"], "level set")
        self.assertEqual(info["grids"][0]["background"], 3)

    def test_real_mesh(self):
        cheese = sample("meshes/cheese.off")
        self.ok("synth", cheese, "-o", "more.vdb", "-o", "more.stl", "--resolution", 64,
                "--exemplar-box", "-31,-31,-28,0,0,-1", "--size", "2x,2x,1x")
        info = json.loads(self.ok("info", "more.vdb", "--json").stdout)
        self.assertEqual(info["model"]["domain"], "-31,-31,-28,32,32,-1")
        self.assertTrue(info["model"]["valid"], info["model"])
        self.assertTrue(json.loads(self.ok("info", "more.stl", "--json").stdout)["closed_manifold"])

    def test_plain_call_and_draft(self):
        self.ok("make", "balls", "balls.vdb", "--resolution", 40)
        self.ok("synth", "balls.vdb", "-o", "a.vdb", "--size", "2x,2x,2x")
        self.ok("synth", "balls.vdb", "-o", "b.vdb", "--size", "2x,2x,2x", "--draft", "--report", "b.json")
        report = json.loads(self.read("b.json"))
        self.assertGreater(report["counts"]["matches"], 10)
        self.assertGreater(report["peak_bytes"], 1e6)
        self.assertLess(report["quality"]["gradient_error_mean"], 0.15)
        self.assertEqual(report["quality"]["band_gaps"], 0)
        self.assertTrue(all(s["seconds"] >= 0 and s["name"] for s in report["stages"]))

    def test_options_are_normalised_in_the_output(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.ok("synth", "g.vdb", "-o", "a.vdb", "--size", "2x,1x,1x", "--half-width", "3.0", "--draft")
        self.ok("synth", "g.vdb", "--draft", "-o", "b.vdb", "--size=2.0x,1x,1.0x", "--threads", 1, "--drift", 0)
        self.assertEqual(self.read("a.vdb"), self.read("b.vdb"))
        options = json.loads(self.ok("info", "a.vdb", "--json").stdout)["metadata"]["vdbsynth:options"]
        self.assertEqual(json.loads(options)["size"], "2x,1x,1x")
        self.assertEqual(json.loads(options)["drift"], "0")

    def test_another_voxel_size_resamples(self):
        self.ok("make", "balls", "b.vdb", "--resolution", 32)
        result = self.ok("convert", "b.vdb", "-o", "c.vdb", "--voxel-size", "0.5")
        self.assertIn("resampled", result.stderr)
        model = json.loads(self.ok("info", "c.vdb", "--json").stdout)["model"]
        self.assertEqual(model["voxel_size"], 0.5)
        self.assertTrue(model["domain_recorded"])
        self.assertTrue(model["valid"], model)

    def test_a_mask_is_the_domain(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 40)
        self.ok("mask", "box", "-o", "m.vdb", "--box", "8,0,0,39,39,31")
        self.ok("synth", "g.vdb", "-o", "a.vdb", "--size", "2x,1x,1x", "--exemplar-mask", "m.vdb")
        model = json.loads(self.ok("info", "a.vdb", "--json").stdout)["model"]
        self.assertEqual(model["domain"], "8,0,0,71,39,31")

    def test_what_standard_output_cannot_take(self):
        with open("/dev/full", "w") as full:
            for words in (["--help"], ["synth", "--help"], ["--version"]):
                done = subprocess.run([PROGRAM, *words], stdout=full, stderr=subprocess.PIPE, text=True)
                self.assertEqual(done.returncode, 3, done.stderr)

    def test_repeat_gives_the_same_surface(self):
        self.ok("make", "weave", "w.vdb", "--resolution", 40)
        self.ok("synth", "w.vdb", "-o", "a.vdb", "--source-map", "--size", "2x,1x,1x")
        self.ok("synth", "w.vdb", "-o", "b.vdb", "--source-map", "map.vdb", "--size", "2x,1x,1x")
        for number, source in enumerate(("a.vdb", "map.vdb")):
            self.ok("repeat", source, "w.vdb", "-o", f"r{number}.obj", "-o", f"r{number}.vdb")
        self.ok("convert", "a.vdb", "-o", "a.obj")
        self.assertEqual(self.read("a.obj"), self.read("r0.obj"))
        self.assertEqual(self.read("a.obj"), self.read("r1.obj"))

    def test_match_prints_json(self):
        self.ok("make", "sponge", "s.vdb", "--resolution", 32)
        result = self.ok("match", "s.vdb", "s.vdb", "--block", 8, "--at", "5,6,7", "--count", 3)
        found = json.loads(result.stdout)["matches"]
        self.assertEqual(found[0], {"position": [5, 6, 7], "cost": 0.0, "rms_voxels": 0.0})
        self.assertEqual(len(found), 3)

    def test_crop_mask_points_slice(self):
        self.ok("make", "balls", "b.vdb", "--resolution", 32)
        self.ok("crop", "b.vdb", "-o", "c.vdb", "--box", "4,4,4,27,27,19")
        self.assertEqual(json.loads(self.ok("info", "c.vdb", "--json").stdout)["model"]["domain"], "4,4,4,27,27,19")
        for words in (["box", "--box", "-4,4,4,20,20,19"], ["ball", "--center", "9,9,9", "--radius", "6"],
                      ["inside", "b.vdb"], ["range", "b.vdb", "--range", "-1,1"]):
            self.ok("mask", *words, "-o", "m.vdb")
            self.assertGreater(json.loads(self.ok("info", "m.vdb", "--json").stdout)["grids"][0]["active_voxels"], 500)
        self.ok("mask", "box", "--box", "0,0,0,31,31,31", "-o", "m.vdb")
        self.ok("synth", "b.vdb", "-o", "s.vdb", "--size", "40,32,32", "--exemplar-mask", "m.vdb", "--block", 8)
        self.ok("convert", "b.vdb", "-o", "p.ply", "--as", "points", "--spacing", 2)
        self.assertIn(b"property float nx", self.read("p.ply"))
        self.ok("render", "b.vdb", "-o", "s.png", "--slice", "x=0.5", "--size", "200x160")

    def test_every_kind_is_made_and_varies(self):
        for kind in "balls grid chainmail fibres foam sponge terrain weave flowers bumps".split():
            for seed in (0, 1):
                self.ok("make", kind, f"{kind}{seed}.vdb", "--resolution", 24, "--seed", seed)
            self.assertNotEqual(self.read(f"{kind}0.vdb"), self.read(f"{kind}1.vdb"))

    def test_a_texture_as_points_goes_on_beyond_its_domain(self):
        self.ok("make", "weave", "w.ply", "-o", "w.obj", "-o", "w.vdb", "--resolution", 32, "--margin", 5, "--voxel-size", 0.5, "--report", "r.json")
        header = self.read("w.ply").split(b"end_header")[0].decode()
        self.assertIn("\ncomment vdbsynth:domain -0.25,-0.25,-0.25,15.75,15.75,9.75\ncomment vdbsynth:plane xy\n", header)
        self.assertNotIn("element face", header)
        points = json.loads(self.ok("info", "w.ply", "--json").stdout)
        self.assertTrue(points["normals"])
        self.assertEqual(points["points"], json.loads(self.read("r.json"))["counts"]["points"])
        for low, high in zip(points["bounds_min"][:2], points["bounds_max"][:2]):
            self.assertTrue(-2.75 <= low < -2.5 and 18 < high <= 18.25, points)
        self.assertTrue(json.loads(self.ok("info", "w.obj", "--json").stdout)["closed_manifold"])
        self.ok("make", "weave", "f.ply", "--resolution", 32, "--spacing", 0.5)
        self.assertGreater(len(self.read("f.ply")), len(self.read("w.ply")))
        self.fails(2, "--margin", "make", "weave", "f.ply", "--margin", -1)
        self.fails(2, "--spacing", "make", "weave", "f.ply", "--spacing", 0.1)


class Determinism(CliTest):
    def test_bytes_do_not_depend_on_threads_path_or_time(self):
        self.ok("make", "fibres", "f.vdb", "--resolution", 32)
        outputs = []
        for threads, name in ((1, "a"), (2, "b"), (7, "a")):
            self.ok("synth", "f.vdb", "-o", f"{name}.vdb", "-o", f"{name}.ply", "--source-map", "--size", "2x,1.5x,1x", "--threads", threads)
            self.ok("render", f"{name}.vdb", "-o", f"{name}.png", "--size", "200x150", "--threads", threads)
            outputs.append([self.read(f"{name}.{kind}") for kind in ("vdb", "ply", "png")])
        self.assertEqual(outputs[0], outputs[1])
        self.assertEqual(outputs[0], outputs[2])

    def test_a_report_replays_its_run(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 32)
        self.ok("synth", "g.vdb", "-o", "a.vdb", "--size", "2x,1x,1x", "--block", 8, "--seed", 5, "--report", "r.json")
        first = self.read("a.vdb")
        self.ok("synth", "--config", "r.json")
        self.assertEqual(first, self.read("a.vdb"))
        self.ok("synth", "--config", "r.json", "--seed", 6, "-o", "b.vdb")
        self.assertNotEqual(first, self.read("b.vdb"))

    def test_metadata_tells_what_made_it(self):
        """Every command that writes a VDB, with its inputs in one folder and in another: the same bytes."""
        self.ok("make", "grid", "g.vdb", "--resolution", 40)
        self.ok("make", "grooves", "plain.vdb", "textured.vdb", "--resolution", 48)
        self.ok("mask", "box", "-o", "m.vdb", "--box", "8,0,0,39,39,39")
        self.ok("synth", "g.vdb", "-o", "map.vdb", "--source-map", "--size", "2x,1x,1x")
        commands = [
            (["make", "grid", "OUT", "--resolution", 24, "--seed", 3], []),
            (["convert", "g.vdb", "-o", "OUT", "--half-width", 4], ["g.vdb"]),
            (["crop", "g.vdb", "-o", "OUT", "--box", "4,4,4,30,30,30"], ["g.vdb"]),
            (["mask", "box", "-o", "OUT", "--box", "1,2,3,4,5,6"], []),
            (["synth", "g.vdb", "-o", "OUT", "--size", "2x,1x,1x", "--exemplar-mask", "m.vdb"], ["g.vdb", "m.vdb"]),
            (["repeat", "map.vdb", "g.vdb", "-o", "OUT"], ["map.vdb", "g.vdb"]),
            (["analogy", "plain.vdb", "textured.vdb", "plain.vdb", "-o", "OUT", "--levels", 1], ["plain.vdb", "textured.vdb", "plain.vdb"]),
        ]
        for words, inputs in commands:
            with self.subTest(command=words[0]):
                written = []
                for place in ("here", "there/deep"):
                    os.makedirs(self.path(place), exist_ok=True)
                    for name in inputs:
                        shutil.copy(self.path(name), self.path(f"{place}/{name}"))
                    moved = [f"{place}/out.vdb" if w == "OUT" else self.path(f"{place}/{w}") if w in inputs else w for w in words]
                    self.ok(*moved)
                    written.append(self.read(f"{place}/out.vdb"))
                self.assertEqual(written[0], written[1])
                self.assertNotIn(self.folder.encode(), written[0])
                self.assertNotIn(b"here/", written[0])
                metadata = json.loads(self.ok("info", "here/out.vdb", "--json").stdout)["metadata"]
                self.assertEqual(metadata["vdbsynth:command"], words[0])
                self.assertEqual(metadata["vdbsynth:seed"], "3" if words[0] == "make" else "0")
                self.assertTrue(metadata["vdbsynth:version"])
                options = json.loads(metadata["vdbsynth:options"])
                for option in [w for w in words if str(w).startswith("--") and w not in ("--seed", "--exemplar-mask")]:
                    self.assertIn(option[2:], options)
                told = json.loads(metadata["vdbsynth:inputs"])
                self.assertEqual(sorted({i["name"] for i in told}), sorted(set(inputs)))
                for item in told:
                    self.assertRegex(item["hash"], "^[0-9a-f]{32}$")


class Words(CliTest):
    def test_help_equals_the_documentation(self):
        for path in sorted((SOURCE / "docs/cli").glob("*.txt")):
            self.assertEqual(self.ok(path.stem, "--help").stdout, path.read_text(), path)
        overview = self.ok("--help").stdout
        for path in (SOURCE / "docs/cli").glob("*.txt"):
            self.assertIn(f"  {path.stem} ", overview)

    def test_version_in_both_spellings(self):
        self.assertEqual(self.ok("--version").stdout, self.ok("-version").stdout)
        self.assertIn("OpenVDB", self.ok("make", "--version").stdout)

    def test_progress_json_is_one_object_a_line(self):
        result = self.ok("make", "sponge", "s.vdb", "--resolution", 32, "--progress", "json")
        lines = [json.loads(line) for line in result.stderr.splitlines()]
        self.assertGreater(len(lines), 2)
        for line in lines:
            self.assertEqual(set(line), {"stage", "done", "total"})
        self.assertEqual(result.stdout, "")

    def test_quiet_says_nothing_and_default_resolution_is_said(self):
        self.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        self.assertIn("128 voxels along the longest side", self.ok("convert", "t.obj", "-o", "t.vdb").stderr)
        self.assertEqual(self.ok("convert", "t.obj", "-o", "t.vdb", "-q").stderr, "")
        self.assertIn("voxel size", self.ok("convert", "t.obj", "-o", "t.vdb", "--resolution", 20, "-v").stderr)

    def test_nothing_gpl_is_linked(self):
        libraries = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
        for name in ("fftw", "gsl", "cgal", "readline", "gmp", "mpfr", "poppler"):
            self.assertNotIn(f"lib{name}", libraries)
        # JBIG-KIT comes with Debian's libtiff alone, and goes with VDBSYNTH_TIFF=OFF (docs/decisions/003-libraries.md).
        if "libtiff" not in libraries:
            self.assertNotIn("libjbig", libraries)


if __name__ == "__main__":
    unittest.main(verbosity=2)
