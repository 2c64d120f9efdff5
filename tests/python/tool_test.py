"""python/vdbsynth_tool.py with the real program."""
import json
import os
import pathlib
import shutil
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import vdbsynth_tool as tool

PROGRAM = os.environ["VDBSYNTH_PROGRAM"]


class Tool(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_tool_")

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_tool(self, *words, **more):
        return tool.run(*words, program=PROGRAM, folder=self.folder, **more)

    def test_option_words(self):
        self.assertEqual(tool.option_words({"size": "2x,2x,1x", "seed": 7, "draft": True, "exemplar_box": None, "exact": False, "scale": 0.1,
                                            "add-points": ["a.csv", "b.csv"]}),
                         ["--size", "2x,2x,1x", "--seed", "7", "--draft", "--scale", "0.1", "--add-points", "a.csv", "--add-points", "b.csv"])

    def test_find_program(self):
        self.assertEqual(tool.find_program(PROGRAM), PROGRAM)
        self.assertEqual(tool.find_program(os.path.dirname(PROGRAM)), PROGRAM)
        with self.assertRaisesRegex(tool.ToolError, "is no program"):
            tool.find_program(self.folder)
        before = dict(os.environ)
        try:
            os.environ["PATH"] = self.folder
            os.environ.pop("VDB_SYNTH", None)
            with self.assertRaisesRegex(tool.ToolError, "not on PATH"):
                tool.find_program()
            os.environ["VDB_SYNTH"] = PROGRAM
            self.assertEqual(tool.find_program(), PROGRAM)
        finally:
            os.environ.clear()
            os.environ.update(before)

    def test_run_and_answer(self):
        job = self.run_tool("make", ["balls"] + ["a.vdb"], [], {"resolution": 32, "seed": 3})
        self.assertEqual(job.state.code, 0)
        self.assertEqual(job.state.fraction, 1)
        model = json.loads(self.run_tool("info", ["a.vdb"], [], {"json": True}).answer)["model"]
        self.assertGreater(model["solid_voxels"], 1000)

    def test_progress_and_messages(self):
        self.run_tool("make", ["balls", "a.vdb"], [], {"resolution": 48})
        job = tool.Job("synth", ["a.vdb"], ["b.vdb"], {"size": "2x,2x,2x", "draft": True}, PROGRAM, self.folder)
        stages = set()
        while not job.poll().done:
            stages.add(job.state.stage)
            self.assertTrue(0 <= job.state.fraction <= 1)
            time.sleep(0.01)
        job.raise_on_error()
        self.assertGreater(len(stages), 2)
        self.assertTrue(os.path.exists(self.path("b.vdb")))

    def test_errors_are_the_programs_line(self):
        for code, words in ((3, ("info", ["none.vdb"], [])), (2, ("synth", ["a.vdb"], ["b.vdb"], {"sise": 1})), (2, ("nothing", [], []))):
            with self.assertRaises(tool.ToolError) as caught:
                self.run_tool(*words)
            self.assertEqual(caught.exception.code, code)
            self.assertNotIn("vdb_synth", str(caught.exception).split(":")[0])
        with self.assertRaisesRegex(tool.ToolError, "did you mean --size"):
            self.run_tool("synth", ["a.vdb"], ["b.vdb"], {"sise": 1})

    def test_cancel(self):
        self.run_tool("make", ["sponge", "a.vdb"], [], {"resolution": 96})
        job = tool.Job("synth", ["a.vdb"], ["b.vdb"], {"size": "4x,4x,4x"}, PROGRAM, self.folder)
        time.sleep(0.5)
        began = time.monotonic()
        job.cancel()
        job.wait(30)
        self.assertLess(time.monotonic() - began, 20)
        self.assertTrue(job.state.cancelled)
        with self.assertRaisesRegex(tool.ToolError, "cancelled"):
            job.raise_on_error()
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.vdb"])


if __name__ == "__main__":
    unittest.main()
