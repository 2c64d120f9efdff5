"""Each example's run.sh, which is its pipeline without Houdini, on data that `vdb_synth make` generates."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "houdini_examples" / "examples"
PROGRAM = os.environ["VDBSYNTH_PROGRAM"]


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_examples_test_")

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def run_example(self, name, *outputs):
        answer = subprocess.run([str(EXAMPLES / name / "run.sh"), self.folder], env={**os.environ, "VDB_SYNTH": PROGRAM}, capture_output=True,
                                text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        for output in outputs:
            self.assertGreater(os.path.getsize(os.path.join(self.folder, output)), 0, output)

    def grid(self, name):
        try:
            import pyopenvdb
        except ImportError:
            self.skipTest("pyopenvdb is absent")
        found = pyopenvdb.read(os.path.join(self.folder, name), "surface")
        self.assertEqual(found.gridClass, "level set")
        self.assertGreater(found.activeVoxelCount(), 1000)
        return found

    def test_synth(self):
        self.run_example("synth", "more.vdb", "more.ply")
        low, high = self.grid("more.vdb").evalActiveVoxelBoundingBox()
        self.assertGreater(high[0] - low[0], 60)

    def test_analogy(self):
        self.run_example("analogy", "spiky.vdb")
        self.grid("spiky.vdb")

    def test_patch(self):
        self.run_example("patch", "sheet.vdb", "sheet.obj")
        self.grid("sheet.vdb")

    def test_texture(self):
        self.run_example("texture", "coloured.ply")
        with open(os.path.join(self.folder, "coloured.ply"), "rb") as file:
            self.assertRegex(file.read(2000), rb"property \w+ (red|Cd_0)")

    def test_relief(self):
        self.run_example("relief", "carved.vdb")
        self.grid("carved.vdb")

    def test_compare(self):
        self.run_example("compare", "numbers.json", "page.html")
        with open(os.path.join(self.folder, "numbers.json")) as file:
            self.assertTrue(json.load(file))

    def test_batch(self):
        self.run_example("batch", "status.html", *[f"more-{seed}.{end}" for seed in (1, 2, 3) for end in ("vdb", "ply")])

    def test_each_has_a_readme_that_names_its_asset_and_script(self):
        for folder in EXAMPLES.iterdir():
            text = (folder / "README.md").read_text()
            self.assertIn("run.sh", text)
            if folder.name != "batch":
                self.assertIn(f"otls/vdbsynth_{folder.name}.hda", text)
            for link in re.findall(r"\]\(([^)#]+)\)", text):
                self.assertTrue((folder / link).exists(), link)


if __name__ == "__main__":
    unittest.main()
