"""compare on the command line: words, JSON, the page in a real browser, and measures that other libraries have too."""
import json
import os
import re
import shutil
import subprocess
import unittest

from support import CliTest, sample

# Reads a level set as numpy, over its domain, and prints what scipy, scikit-image and numpy's FFT say of it.
LIBRARIES = """
import json, sys, numpy as np, pyopenvdb, scipy.ndimage as nd, skimage.measure as sk
grid = [g for g in pyopenvdb.readAllGridMetadata(sys.argv[1]) if g.name == 'surface'][0]
grid = pyopenvdb.read(sys.argv[1], 'surface')
low = [int(v) for v in grid.metadata['vdbsynth:domain'].split(',')]
size = [h - l + 1 for l, h in zip(low[:3], low[3:])]
values = np.empty(size, np.float32)
grid.copyToArray(values, ijk=low[:3])
solid = values < 0
full = np.ones((3, 3, 3))
area_box = values[1:-1, 1:-1, 1:-1]
points, faces, _, _ = sk.marching_cubes(area_box, 0.0)
pad = np.zeros([2 * n for n in size]); pad[:size[0], :size[1], :size[2]] = solid
ones = np.zeros_like(pad); ones[:size[0], :size[1], :size[2]] = 1
auto = np.fft.irfftn(abs(np.fft.rfftn(pad)) ** 2, pad.shape)
pairs = np.fft.irfftn(abs(np.fft.rfftn(ones)) ** 2, pad.shape)
reach = 12
offsets = [np.minimum(np.arange(n), n - np.arange(n)) for n in pad.shape]
r = np.sqrt(offsets[0][:, None, None] ** 2 + offsets[1][None, :, None] ** 2 + offsets[2][None, None, :] ** 2)
shell = np.floor(r + 0.5).astype(int)
keep = (shell <= reach) & (pairs > 0.5)
radial = np.bincount(shell[keep], auto[keep]) / np.bincount(shell[keep], pairs[keep])
print(json.dumps({
    'fraction': float(solid.mean()),
    'solid_parts': sorted(np.bincount(nd.label(solid, full)[0].ravel())[1:].tolist(), reverse=True),
    'void_parts': sorted(np.bincount(nd.label(~solid)[0].ravel())[1:].tolist(), reverse=True),
    'euler': int(sk.euler_number(solid, 3)),
    'area': float(sk.mesh_surface_area(points, faces)) / np.prod([n - 3 for n in size]),
    's2x': [float(auto[i, 0, 0] / pairs[i, 0, 0]) for i in range(reach + 1)],
    's2': radial.tolist(),
}))
"""


def values(model, name):
    entry = [s for s in model["statistics"] if s["name"] == name][0]
    return entry.get("voxels", entry.get("curve"))


class Compare(CliTest):
    def setUp(self):
        super().setUp()
        for name, kind, seed in (("a", "balls", 1), ("b", "balls", 2), ("s", "sponge", 1)):
            self.ok("make", kind, f"{name}.vdb", "--resolution", 40, "--seed", seed, "--voxel-size", "0.5")

    def comparison(self, *words):
        return json.loads(self.ok("compare", *words, "--json").stdout)

    def test_words_and_json_agree(self):
        text = self.ok("compare", "a.vdb", "b.vdb").stdout
        for word in ("in voxels", "in world units", "volume fraction", "sliced Wasserstein", "verdict: ", "novelty: copies"):
            self.assertIn(word, text)
        found = self.comparison("a.vdb", "b.vdb")
        fraction = values(found["reference"], "volume fraction")[0]
        self.assertIn(f"{fraction:.4g}", text)
        self.assertEqual(found["reference"]["kind"], "texture")
        area = [s for s in found["reference"]["statistics"] if s["name"] == "surface area per volume"][0]
        self.assertAlmostEqual(area["world"][0], area["voxels"][0] * 2, places=9)
        self.assertEqual(found["stationary"], "xyz")
        self.assertEqual(found["sub_volumes"], 8)
        # Patches of one scale, and the fraction against the standard error of its correlations.
        verdicts = found["others"][0]["distances"]["verdicts"]
        self.assertEqual(len(verdicts), len(found["others"][0]["statistics"]) + 2)
        self.assertEqual(verdicts[-1]["name"], "volume fraction, standard error")

    def test_a_copy_passes_and_another_material_does_not(self):
        self.assertTrue(self.comparison("a.vdb", "a.vdb")["others"][0]["distances"]["passes"])
        self.assertFalse(self.comparison("a.vdb", "s.vdb")["others"][0]["distances"]["passes"])

    def test_several_others_and_the_yardstick(self):
        found = self.comparison("a.vdb", "b.vdb", "a.vdb", "--process", "make balls", "--fresh", 3)
        self.assertEqual([o["name"] for o in found["others"]], ["b.vdb", "a.vdb"])
        self.assertGreater(len(found["yardstick"]), 15)
        for entry in found["yardstick"]:
            self.assertGreater(max(entry["fresh"], entry["shifted"]), 0, entry)
        self.assertNotEqual(found["yardstick"],
                            self.comparison("a.vdb", "b.vdb", "a.vdb", "--process", "make balls", "--fresh", 3, "--seed", 5)["yardstick"])

    def test_same_bytes_for_any_threads(self):
        texts = {self.ok("compare", "a.vdb", "b.vdb", "--json", "--process", "make balls", "--fresh", 2, "--threads", n).stdout
                 for n in (1, 2, 5)}
        self.assertEqual(len(texts), 1)

    def test_source_map_of_a_synthesis(self):
        self.ok("synth", "a.vdb", "-o", "more.vdb", "-o", "more.obj", "--size", "2x,1x,1x", "--source-map")
        novelty = self.comparison("a.vdb", "more.vdb")["others"][0]["distances"]["novelty"]
        self.assertGreater(novelty["map_verified_share"], 0.5)
        self.assertEqual(novelty["sources"] == "map", novelty["map_verified_share"] >= 0.9)
        self.assertGreater(novelty["reference_used"], 0.1)
        by_file = self.comparison("a.vdb", "more.vdb", "--map", "more.vdb")["others"][0]["distances"]["novelty"]
        self.assertEqual(by_file, novelty)

    def test_a_mesh_takes_the_voxels_of_the_reference(self):
        self.ok("convert", "a.vdb", "-o", "a.obj")
        other = self.comparison("a.vdb", "a.obj")["others"][0]
        self.assertEqual(other["voxel_size"], 0.5)
        self.assertEqual(other["kind"], "object")
        self.assertLess(other["distances"]["surface"]["mean"], 0.3)

    def test_errors(self):
        self.fails(2, "too few inputs", "compare", "a.vdb")
        self.fails(2, "--stationary xyw: must be axes", "compare", "a.vdb", "b.vdb", "--stationary", "xyw")
        self.fails(2, "--process", "compare", "a.vdb", "b.vdb", "--process", "make bread")
        self.fails(2, "--process", "compare", "a.vdb", "b.vdb", "--process", "bake balls")
        self.fails(2, "from 4 to 256", "compare", "a.vdb", "b.vdb", "--process", "make balls --feature 1")
        self.fails(2, "--fresh: needs --process", "compare", "a.vdb", "b.vdb", "--fresh", 3)
        self.fails(2, "--page page.pdf: unknown extension; must be a .html or .htm file", "compare", "a.vdb", "b.vdb", "--page", "page.pdf")
        self.fails(2, "--map: belongs to one OTHER", "compare", "a.vdb", "b.vdb", "s.vdb", "--map", "m.vdb")
        self.fails(2, "--map m.obj: must be a .vdb file", "compare", "a.vdb", "b.vdb", "--map", "m.obj")
        self.fails(3, 'has no grid "source"', "compare", "a.vdb", "b.vdb", "--map", "b.vdb")
        self.fails(3, "missing.vdb", "compare", "a.vdb", "missing.vdb")
        self.fails(3, "", "compare", "a.vdb", "b.vdb", "--page", "no/such/folder/page.html")
        self.ok("convert", "a.vdb", "-o", "a.stl")
        self.fails(1, "--process", "compare", "a.stl", "b.vdb", "--process", "make balls", "--resolution", 40)
        self.assertNotIn("page.pdf", self.files())

    def test_real_files(self):
        found = self.comparison(sample("meshes/bunny.off"), sample("meshes/bunny.off"), "--resolution", 60)
        self.assertEqual(found["reference"]["euler_characteristic"], 1)
        self.assertEqual(found["others"][0]["distances"]["surface"]["hausdorff"], 0)


class Libraries(CliTest):
    def test_scipy_scikit_image_and_numpy_agree(self):
        script = self.write("libraries.py", LIBRARIES)
        for kind in ("balls", "sponge", "fibres"):
            self.ok("make", kind, f"{kind}.vdb", "--resolution", 56, "--seed", 3)
            result = subprocess.run(["/usr/bin/python3", script, self.path(f"{kind}.vdb")], capture_output=True, text=True)
            if "No module named" in result.stderr:
                self.skipTest(result.stderr.strip().splitlines()[-1])
            self.assertEqual(result.returncode, 0, result.stderr)
            theirs = json.loads(result.stdout)
            found = json.loads(self.ok("compare", f"{kind}.vdb", f"{kind}.vdb", "--json").stdout)
            ours, reach = found["reference"], found["curve_reach_voxels"] + 1
            with self.subTest(kind=kind):
                self.assertAlmostEqual(values(ours, "volume fraction")[0], theirs["fraction"], places=9)
                self.assertEqual(ours["solid"]["largest_voxels"], theirs["solid_parts"][:100])
                self.assertEqual(ours["solid"]["count"], len(theirs["solid_parts"]))
                self.assertEqual(ours["void"]["largest_voxels"], theirs["void_parts"][:100])
                self.assertAlmostEqual(values(ours, "surface area per volume")[0], theirs["area"], delta=0.03 * theirs["area"])
                axis = values(ours, "two-point correlation by axis")
                for r, expected in enumerate(theirs["s2x"][:reach]):
                    self.assertAlmostEqual(axis[r], expected, places=6)
                for r, expected in enumerate(theirs["s2"][:reach]):
                    self.assertAlmostEqual(values(ours, "two-point correlation")[r], expected, delta=0.006)
        # The Euler characteristic of what a box cuts is theirs for an object, ours a density elsewhere.
        self.ok("convert", "sponge.vdb", "-o", "sponge.ply")
        self.ok("convert", "sponge.ply", "-o", "object.vdb", "--voxel-size", 1)
        ours = json.loads(self.ok("compare", "object.vdb", "object.vdb", "--json").stdout)["reference"]
        box = ours["domain"]
        count = ("import sys, pyopenvdb, numpy as np, skimage.measure as sk\ng = pyopenvdb.read(sys.argv[1], 'surface')\n"
                 f"v = np.empty({[h - l + 5 for l, h in zip(box['min'], box['max'])]}, np.float32)\n"
                 f"g.copyToArray(v, ijk={[l - 2 for l in box['min']]})\nprint(sk.euler_number(v < 0, 3))\n")
        theirs = subprocess.run(["/usr/bin/python3", "-c", count, self.path("object.vdb")], capture_output=True, text=True, check=True)
        self.assertEqual(ours["euler_characteristic"], int(theirs.stdout))


class Page(CliTest):
    def test_the_page_in_a_browser(self):
        browser = shutil.which("chromium") or shutil.which("chromium-browser")
        if not browser:
            self.skipTest("chromium is absent")
        self.ok("make", "balls", "a<b>&\"c\".vdb", "--resolution", 40)
        self.ok("make", "balls", "other.vdb", "--resolution", 40, "--seed", 2)
        self.ok("compare", "a<b>&\"c\".vdb", "other.vdb", "--page", "page.html", "--process", "make balls", "--fresh", 2)
        page = self.read("page.html").decode()
        self.assertEqual(re.findall(r"(?:src|href)=\"(?!data:)[^\"]*", page), [])
        address = "file://" + self.path("page.html")
        words = [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--enable-logging=stderr",
                 f"--user-data-dir={self.path('profile')}"]
        environment = {**os.environ, "HOME": self.folder}
        result = subprocess.run([*words, "--dump-dom", address], capture_output=True, text=True, timeout=120, env=environment)
        self.assertIn('data-ready="yes"', result.stdout, result.stderr[-2000:])  # its script ran to its end
        self.assertEqual([l for l in result.stderr.splitlines() if "CONSOLE" in l], [])
        self.assertIn("a&lt;b&gt;&amp;", result.stdout)
        self.assertEqual(result.stdout.count("<svg"), page.count("<svg"))
        self.assertGreater(page.count("<polyline"), 20)
        # An error in the page would be seen.
        broken = self.write("broken.html", page.replace('document.body.dataset.ready', 'nothing.body.dataset.ready'))
        result = subprocess.run([*words, "--dump-dom", "file://" + broken], capture_output=True, text=True, timeout=120, env=environment)
        self.assertNotIn('data-ready="yes"', result.stdout)
        self.assertTrue([l for l in result.stderr.splitlines() if "CONSOLE" in l])
        subprocess.run([*words, f"--screenshot={self.path('page.png')}", "--window-size=1100,1500", address], capture_output=True,
                       timeout=120, env=environment)
        self.assertGreater(os.path.getsize(self.path("page.png")), 100000)


if __name__ == "__main__":
    unittest.main(verbosity=2)
