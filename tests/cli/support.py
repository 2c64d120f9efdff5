"""Helpers of the command-line tests: runs the real binary in a folder of its own."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["VDBSYNTH_PROGRAM"]
SAMPLES = os.environ.get("VDBSYNTH_SAMPLES", "")
SOURCE = pathlib.Path(os.environ["VDBSYNTH_SOURCE"])


def sample(name):
    """Path of a sample file; the test is skipped, saying so, where the samples are absent."""
    path = os.path.join(SAMPLES, name)
    if not SAMPLES or not os.path.exists(path):
        raise unittest.SkipTest(f"sample {name} is absent (VDBSYNTH_SAMPLES)")
    return path


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_cli_")
        os.chmod(self.folder, 0o777)

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        mode = "wb" if isinstance(content, bytes) else "w"
        with open(self.path(name), mode) as file:
            file.write(content)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def files(self):
        return sorted(os.listdir(self.folder))

    def run_tool(self, *words, **options):
        options.setdefault("cwd", self.folder)
        options.setdefault("timeout", 240)
        return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, **options)

    def ok(self, *words, **options):
        result = self.run_tool(*words, **options)
        self.assertEqual(result.returncode, 0, f"{words}: {result.stderr}")
        return result

    def fails(self, code, says, *words, **options):
        """The contract's error: the exit code, one line that says `says`, nothing on standard output."""
        result = self.run_tool(*words, **options)
        lines = [l for l in result.stderr.splitlines() if "error:" in l]
        self.assertEqual(result.returncode, code, f"{words}: {result.stderr}")
        self.assertEqual(len(lines), 1, f"{words}: {result.stderr}")
        self.assertIn(says, lines[0])
        self.assertEqual(result.stdout, "")
        self.assertFalse([f for f in self.files() if f.endswith(".tmp")])
        return result
