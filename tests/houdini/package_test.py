"""Houdini's package without Houdini: options, cache, cancel, batches, the text of the assets, and the thin layer over a small fake of hou."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    np = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "houdini_examples"
sys.path.insert(0, str(PACKAGE / "scripts" / "python"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import fake_hou

fake_hou.install()
from vdbsynth_houdini import assets, batches, methods, runs, tops
import vdbsynth_tool as tool

PROGRAM = os.environ["VDBSYNTH_PROGRAM"]


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_houdini_test_")
        fake_hou.InterruptableOperation.interrupt_after = None
        fake_hou.InterruptableOperation.calls = []

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def make(self, *words):
        subprocess.run([PROGRAM, "make", *words], cwd=self.folder, check=True, capture_output=True)

    def model(self, path):
        answer = subprocess.run([PROGRAM, "info", path, "--json"], check=True, capture_output=True, text=True)
        return json.loads(answer.stdout)["model"]


class Methods(Folder):
    def test_every_option_is_one_of_the_program(self):
        for one in methods.METHODS:
            text = subprocess.run([PROGRAM, one.command, "--help"], capture_output=True, text=True, check=True).stdout
            for option in one.options:
                self.assertIn("--" + option.name + ("" if option.kind == "flag" else " "), text, one.command)
            self.assertEqual(sorted(one.order), sorted(role.name for role in one.roles))
            names = [row[0] for row in assets.parameters(one)]
            self.assertEqual(len(set(names)), len(names), one.command)

    def test_options(self):
        one = methods.method("synth")
        self.assertEqual(methods.options_of(one, {}, ["ply"]), {"size": "2x,2x,1x", "resolution": 128, "seed": 0})
        self.assertEqual(methods.options_of(one, {"border": "automatic", "draft": 1, "seed": 3}, ["vdb"]), {"size": "2x,2x,1x", "draft": True, "seed": 3})
        self.assertEqual(methods.options_of(methods.method("texture"), {"scale": 0.1}), {"scale": 0.1, "seed": 0, "as": "mesh"})
        with self.assertRaisesRegex(ValueError, "unknown parameter colour"):
            methods.options_of(one, {"colour": 1})
        with self.assertRaisesRegex(ValueError, "none of mesh"):
            methods.method("texture").extension("vdb")
        with self.assertRaises(KeyError):
            methods.method("nothing")


class Runs(Folder):
    def request(self, **options):
        return runs.Request("synth", [self.path("a.vdb")], {"size": "2x,1x,1x", **options}, "vdb", PROGRAM)

    def test_cache_by_content(self):
        self.make("balls", "a.vdb", "--resolution", "24")
        first = runs.run(self.request(seed=1), self.path("cache"))
        self.assertFalse(first.cached)
        self.assertEqual(first.report["command"], "synth")
        again = runs.run(self.request(seed=1), self.path("cache"))
        self.assertTrue(again.cached)
        self.assertEqual((again.path, again.messages, again.report), (first.path, first.messages, first.report))
        self.assertNotEqual(runs.cache_key(self.request(seed=2)), runs.cache_key(self.request(seed=1)))
        # Another name does not count, another content does.
        key = runs.cache_key(self.request())
        os.rename(self.path("a.vdb"), self.path("b.vdb"))
        self.assertEqual(runs.cache_key(runs.Request("synth", [self.path("b.vdb")], {"size": "2x,1x,1x"}, "vdb", PROGRAM)), key)
        self.make("balls", "a.vdb", "--resolution", "24", "--seed", "5")
        self.assertNotEqual(runs.cache_key(self.request()), key)
        # A damaged record: run again, to the same bytes.
        before = pathlib.Path(first.path).read_bytes()
        for name in os.listdir(self.path("cache")):
            if name.endswith(".record"):
                pathlib.Path(self.path("cache"), name).write_text("{")
        os.rename(self.path("b.vdb"), self.path("a.vdb"))
        repeated = runs.run(self.request(seed=1), self.path("cache"))
        self.assertFalse(repeated.cached)
        self.assertEqual(pathlib.Path(repeated.path).read_bytes(), before)
        self.assertEqual(len(os.listdir(self.path("cache"))), 2)

    def test_files_in_options_count(self):
        pathlib.Path(self.path("a.vdb")).write_text("x")
        mask = pathlib.Path(self.path("mask.vdb"))
        mask.write_text("one")
        keys = {runs.cache_key(self.request(mask=f"{mask}:weight"))}
        mask.write_text("two")
        keys.add(runs.cache_key(self.request(mask=f"{mask}:weight")))
        self.assertEqual(len(keys), 2)

    def test_identifier_of_a_vdb_does_not_count(self):
        try:
            import pyopenvdb
        except ImportError:
            self.skipTest("pyopenvdb is absent")
        for name in ("a.vdb", "b.vdb", "c.vdb"):
            grid = pyopenvdb.FloatGrid(1.0)
            grid.fill((0, 0, 0), (3, 3, 3), 0.5 if name != "c.vdb" else 0.25)
            pyopenvdb.write(self.path(name), grids=[grid])
        a, b, c = (pathlib.Path(self.path(name)) for name in ("a.vdb", "b.vdb", "c.vdb"))
        self.assertNotEqual(a.read_bytes(), b.read_bytes())
        self.assertEqual(runs.content_hash(str(a)), runs.content_hash(str(b)))
        self.assertNotEqual(runs.content_hash(str(a)), runs.content_hash(str(c)))

    def test_cancel_leaves_nothing(self):
        self.make("balls", "a.vdb", "--resolution", "64")

        class Stop(Exception):
            pass

        def stop(stage, fraction):
            if fraction > 0:
                raise Stop
        with self.assertRaises(Stop):
            runs.run(runs.Request("synth", [self.path("a.vdb")], {"size": "4x,4x,4x"}, "vdb", PROGRAM), self.path("cache"), stop, 0.02)
        self.assertEqual(os.listdir(self.path("cache")), [])

    def test_errors(self):
        with self.assertRaisesRegex(tool.ToolError, "a.vdb"):
            pathlib.Path(self.path("a.vdb")).write_text("nonsense")
            runs.run(self.request(), self.path("cache"))
        self.assertEqual(os.listdir(self.path("cache")), [])

    def test_trim(self):
        os.mkdir(self.path("cache"))
        for age, key in enumerate("abc"):
            for end in ("vdb", "record"):
                path = pathlib.Path(self.path("cache"), key * 32 + "." + end)
                path.write_bytes(b"x" * 50)
                os.utime(path, (1000 - age, 1000 - age))
        pathlib.Path(self.path("cache"), "other.txt").write_text("not ours")
        self.assertEqual(runs.trim(self.path("cache"), 220), 1)
        self.assertEqual(sorted(name[:2] for name in os.listdir(self.path("cache"))), ["aa", "aa", "bb", "bb", "ot"])
        self.assertEqual(runs.trim(self.path("cache"), 0), 1)


class Batches(Folder):
    class Item:
        def __init__(self, name, index):
            self.name, self.index, self.strings, self.outputs, self.before = name, index, {}, [], []

        def setCommand(self, command):
            self.command = command

        def setStringAttrib(self, name, value, index=0):
            self.strings[name] = value

        def stringAttribValue(self, name, index=0):
            return self.strings[name]

        def addExpectedOutputFile(self, path, tag="", own=True):
            self.outputs.append(path)

    class Holder:
        def __init__(self):
            self.items = []

        def addWorkItem(self, name="", index=0):
            self.items.append(Batches.Item(name, index))
            return self.items[-1]

        @staticmethod
        def addDependency(item, dependency):
            item.before.append(dependency)

    def test_work_items_make_what_the_batch_makes(self):
        jobs = batches.variations("make", ["balls"], "a dir/b-${seed}.vdb", {"resolution": 16}, {"seed": "1-2"})
        jobs["jobs"].insert(0, {"name": "more", "command": "synth", "inputs": "a dir/b-1.vdb", "output": "more.vdb", "options": {"size": "2x,1x,1x"}})
        batches.write_jobs(self.path("jobs.json"), jobs)
        holder = self.Holder()
        tops.generate(holder, self.path("jobs.json"), PROGRAM)
        tops.add_dependencies(holder, holder.items)
        names = [item.name for item in holder.items]
        self.assertEqual(names, ["make-1", "make-2", "more"])
        self.assertEqual([item.name for item in holder.items[2].before], ["make-1"])
        for item in holder.items:
            subprocess.run(item.command, shell=True, check=True, capture_output=True, cwd="/")
            for path in item.outputs:
                self.assertTrue(os.path.isfile(path), path)
        made = [pathlib.Path(path).read_bytes() for item in holder.items for path in item.outputs]
        shutil.rmtree(self.path("a dir"))
        os.remove(self.path("more.vdb"))
        subprocess.run([PROGRAM, "batch", self.path("jobs.json")], check=True, capture_output=True)
        self.assertEqual([pathlib.Path(path).read_bytes() for item in holder.items for path in item.outputs], made)

    def test_mistakes_are_found_before_anything_runs(self):
        with self.assertRaisesRegex(ValueError, r"needs \$\{seed\}"):
            batches.variations("make", ["balls"], "b.vdb", {}, {"seed": "1-2"})
        batches.write_jobs(self.path("jobs.json"), {"jobs": [{"name": "a", "command": "sinth", "inputs": "a.vdb", "output": "b.vdb"}]})
        with self.assertRaisesRegex(tool.ToolError, "sinth"):
            batches.plan(self.path("jobs.json"), PROGRAM)
        with self.assertRaisesRegex(ValueError, "wait for each other: a, b"):
            batches.ordered([batches.Step("a", [], [], ["b"]), batches.Step("b", [], [], ["a"])])


class Assets(Folder):
    def test_the_text_in_otls_is_that_of_the_table(self):
        assets.write(self.folder)
        found = {str(path.relative_to(self.folder)): path.read_text() for path in pathlib.Path(self.folder).rglob("*") if path.is_file()}
        kept = {str(path.relative_to(PACKAGE / "otls")): path.read_text() for path in (PACKAGE / "otls").rglob("*") if path.is_file()}
        self.assertEqual(kept, found)

    def test_text(self):
        for one in methods.METHODS:
            files = assets.files(one)
            inner = f"vdbsynth_8_8Sop_1{one.command}_8_81.0"
            for line in files[f"{inner}/Sections.list"].splitlines()[1:]:
                self.assertIn(f"{inner}/{line.split(chr(9))[0]}", files)
            script = files[f"{inner}/DialogScript"]
            self.assertEqual(script.count("{"), script.count("}"))
            self.assertEqual(script.count('"') % 2, 0)
            compile(files[f"{inner}/PythonCook"], one.command, "exec")
            self.assertIn(f"Operator:     vdbsynth::{one.command}::1.0\n", files["INDEX__SECTION"])
            import xml.dom.minidom
            xml.dom.minidom.parseString(files[f"{inner}/Tools.shelf"].encode())
        self.assertEqual(assets.text('a "b" \\'), '"a \\"b\\" \\\\"')

    def test_build_script(self):
        sys.path.insert(0, str(PACKAGE))
        import build_assets
        import contextlib
        import io
        for words in ([], ["--collapse"]):
            with contextlib.redirect_stdout(io.StringIO()) as said:
                build_assets.main([self.folder] + words)
            self.assertEqual(len(said.getvalue().splitlines()), len(methods.METHODS))
        path = self.path("vdbsynth_analogy.hda")
        build_assets.build(methods.method("analogy"), path)
        definition = fake_hou.libraries[path][0]
        self.assertIn("strength", [template.name for template in definition.group.templates])
        self.assertEqual(sorted(definition.sections), ["Help", "Tools.shelf"])

    def test_package_file(self):
        package = json.loads((PACKAGE / "packages" / "vdb_synth.json").read_text())
        self.assertEqual(package["path"], "$VDBSYNTH_HOUDINI")
        self.assertEqual([key for entry in package["env"] for key in entry], ["VDBSYNTH_HOUDINI", "VDB_SYNTH"])

    def test_zip_works_anywhere(self):
        made = subprocess.run([str(ROOT / "tools" / "dev" / "houdini_package.sh"), self.path("package.zip")], check=True, capture_output=True, text=True)
        shutil.unpack_archive(made.stdout.strip(), self.folder)
        package = self.path("vdb_synth_houdini")
        self.assertTrue(os.path.isfile(os.path.join(package, "otls", "vdbsynth_synth.hda", "INDEX__SECTION")))
        script = "import vdbsynth_houdini.runs as r; print(r.tool.__file__)"
        answer = subprocess.run([sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": os.path.join(package, "scripts", "python")}, cwd="/",
                                check=True, capture_output=True, text=True)
        self.assertEqual(answer.stdout.strip(), os.path.join(package, "scripts", "python", "vdbsynth_tool.py"))


if __name__ == "__main__":
    unittest.main()
