"""The Blender add-on in Debian's Blender without a window: installed from its zip, every method operated. Skipped where Blender is absent."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CHECKS = ["analogy", "synth", "texture", "relief", "patch", "compare", "errors_are_the_programs", "settings_come_back", "cancel", "picture", "disabled"]


class Headless(unittest.TestCase):
    def test_all_methods(self):
        blender = shutil.which("blender")
        if not blender:
            raise unittest.SkipTest("Blender is absent: apt-get install blender")
        with tempfile.TemporaryDirectory(prefix="vdbsynth_blender_") as folder:
            addon = os.path.join(folder, "addon.zip")
            subprocess.run([SOURCE / "tools" / "dev" / "blender_addon.sh", addon], check=True, capture_output=True)
            done = subprocess.run([blender, "-b", "--factory-startup", "--python", SOURCE / "tests" / "blender" / "in_blender.py", "--", addon,
                                   os.environ["VDBSYNTH_PROGRAM"], folder],
                                  capture_output=True, text=True, timeout=900, env={**os.environ, "HOME": folder, "BLENDER_USER_SCRIPTS": folder})
            passed = {line.split()[1] for line in done.stdout.splitlines() if line.startswith("OK ")}
            self.assertEqual(passed, set(CHECKS), done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
