"""A build of some commands (VDBSYNTH_COMMANDS of CMake): configured in a folder of its own, and linked of the objects that this
build has compiled, so that it shows in seconds whether it has all that these commands need."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from support import SOURCE, CliTest

BUILD = os.environ.get("VDBSYNTH_BUILD", "")
# What both builds must have in common, so that objects of one fit the other.
KEPT = ["CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_LAUNCHER", "CMAKE_CXX_FLAGS", "CMAKE_CXX_FLAGS_DEBUG",
        "CMAKE_CXX_FLAGS_RELEASE", "CMAKE_EXE_LINKER_FLAGS", "VDBSYNTH_SANITIZE", "VDBSYNTH_TIFF"]


def demo_commands():
    presets = json.loads((SOURCE / "CMakePresets.json").read_text())["configurePresets"]
    return next(p for p in presets if p["name"] == "demo")["cacheVariables"]["VDBSYNTH_COMMANDS"]


def all_commands():
    return re.search(r"set\(VDBSYNTH_ALL_COMMANDS ([^)]+)\)", (SOURCE / "cmake" / "commands.cmake").read_text())[1].split()


def run(*words, **options):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=600, **options)


class SomeCommands(CliTest):
    def configure(self, commands, *more):
        """The folder of a build that has these commands, and what CMake said."""
        if not BUILD:
            raise unittest.SkipTest("VDBSYNTH_BUILD names no build folder")
        cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (pathlib.Path(BUILD) / "CMakeCache.txt").read_text(), re.M))
        kept = [f"-D{name}={cache[name]}" for name in KEPT if cache.get(name)]
        folder = tempfile.mkdtemp(dir=self.folder)
        return folder, run("cmake", "-G", "Ninja", "-S", SOURCE, "-B", folder, *kept, "-DVDBSYNTH_BUILD_TESTS=OFF",
                           f"-DVDBSYNTH_COMMANDS={commands}", *more)

    def objects(self, folder):
        result = run("ninja", "-C", folder, "-t", "inputs", "vdb_synth")
        self.assertEqual(result.returncode, 0, result.stderr)
        return {line for line in result.stdout.splitlines() if line.endswith(".o")}

    def linked(self, commands):
        """The program of these commands, of the objects of VDBSYNTH_BUILD."""
        folder, configured = self.configure(commands)
        self.assertEqual(configured.returncode, 0, configured.stderr)
        for name in self.objects(folder):
            compiled, target = pathlib.Path(BUILD) / name, pathlib.Path(folder) / name
            self.assertTrue(compiled.exists(), f"{name} of {commands} is no object of the build of all commands")
            if not name.endswith("/commands.cpp.o"):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.symlink_to(compiled)
        for line in run("ninja", "-C", folder, "-t", "commands", "vdb_synth").stdout.splitlines():
            if " -c " not in line or line.endswith("/commands.cpp"):
                result = run("sh", "-c", line, cwd=folder)
                self.assertEqual(result.returncode, 0, f"{commands}: {result.stderr[-2000:]}")
        return os.path.join(folder, "tools", "vdb_synth", "vdb_synth")


class Demo(SomeCommands):
    def test_it_has_the_commands_of_the_demo_and_compiles_far_less(self):
        program = self.linked(demo_commands())
        overview = run(program, "--help").stdout
        self.assertEqual(set(re.findall(r"^  ([a-z-]+)  ", overview, re.M)), set(demo_commands().split(";")))
        folder, _ = self.configure("all")
        everything = len(self.objects(folder))
        folder, _ = self.configure(demo_commands())
        self.assertLess(len(self.objects(folder)), 0.6 * everything)
        # What the script runs.
        script = (SOURCE / "tools" / "run_demo.sh").read_text()
        used = set(re.findall(r'^"\$vdb_synth" ([a-z-]+)', script, re.M))
        self.assertTrue(used and used <= set(demo_commands().split(";")), used)
        made = run(program, "make", "grid", self.path("grid.vdb"), "--resolution", "24")
        self.assertEqual(made.returncode, 0, made.stderr)
        drawn = run(program, "render", self.path("grid.vdb"), "-o", self.path("grid.png"), "--size", "64x48")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        refused = run(program, "analogy", "a.vdb")
        self.assertEqual((refused.returncode, refused.stdout), (2, ""))
        self.assertEqual(refused.stderr, "vdb_synth: error: analogy: this build leaves it out; build all commands with: "
                                         "cmake --preset release && cmake --build --preset release\n")
        self.assertIn("anology: unknown command", run(program, "anology").stderr)

    def test_the_list_is_that_of_the_program(self):
        overview = self.ok("--help").stdout
        self.assertEqual(re.findall(r"^  ([a-z-]+)  ", overview, re.M), all_commands())

    def test_what_is_wrong_is_said(self):
        for commands, more, says in [("make;sinth", (), "sinth is no command"), ("", (), "is empty"),
                                     ("make", ("-DVDBSYNTH_BUILD_TESTS=ON",), "VDBSYNTH_BUILD_TESTS needs all commands")]:
            _, configured = self.configure(commands, *more)
            self.assertNotEqual(configured.returncode, 0)
            self.assertIn(says, " ".join(configured.stderr.split()))

    def test_it_is_not_installed(self):
        folder, configured = self.configure("make")
        self.assertEqual(configured.returncode, 0, configured.stderr)
        installed = run("cmake", "--install", folder, "--prefix", self.path("prefix"))
        self.assertNotEqual(installed.returncode, 0)
        self.assertIn("this build leaves commands out", " ".join(installed.stderr.split()))


class Each(SomeCommands):
    def test_every_command_alone_has_what_it_needs(self):
        for command in all_commands():
            with self.subTest(command=command):
                program = self.linked(command)
                self.assertEqual(run(program, command, "--help").returncode, 0)
                shutil.rmtree(os.path.dirname(os.path.dirname(os.path.dirname(program))))


if __name__ == "__main__":
    unittest.main()
