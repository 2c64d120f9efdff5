"""Disks that are full, read-only or gone, and memory that does not suffice: never a half file, never a lost earlier one."""
import json
import os
import resource
import subprocess
import time
import unittest

from night_shift import MemoryGroup, PAGE, PATIENCE, ReadOnly, SmallDisk
from support import PROGRAM, CliTest

OLD = b"old\n"


class NightTest(CliTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("disk"))
        self.ok("make", "balls", "b.vdb", "--resolution", 32, "-q")

    def run_tool(self, *words, **options):
        options.setdefault("timeout", PATIENCE)
        return super().run_tool(*words, **options)

    def temporaries(self):
        return [os.path.join(folder, name) for folder, _, names in os.walk(self.folder) for name in names if name.endswith(".tmp")]

    def error_line(self, result):
        lines = [line for line in result.stderr.splitlines() if line]
        self.assertEqual(len([line for line in lines if "error:" in line]), 1, result.stderr)
        self.assertIn("error:", lines[-1], result.stderr)
        return lines[-1]

    def jobs(self, *jobs, name="j.json"):
        return self.write(name, json.dumps({"jobs": jobs}))


class FullDisk(NightTest):
    """Each kind of output meets the end of the disk at its beginning, within, and at its last page."""

    def fails_at_any_size(self, name, *words, beside=()):
        """`words` write disk/`name`; `beside` are outputs elsewhere, which must not appear either."""
        with SmallDisk(self.path("disk"), 1 << 25) as disk:
            self.ok(*words, "-q")
            size = os.path.getsize(self.path(f"disk/{name}"))
            pages = -(-size // PAGE)
            self.write(f"disk/{name}", OLD)
            for room in sorted({0, 1, pages // 3, pages - 1}):
                for output in beside:
                    self.write(output, OLD)
                disk.fill(room * PAGE)
                result = self.run_tool(*words, "-q")
                with self.subTest(name=name, size=size, room=room * PAGE):
                    if room >= pages:
                        continue  # it fits
                    self.assertEqual(result.returncode, 3, result.stderr)
                    self.assertIn(f"disk/{name}", self.error_line(result))
                    self.assertEqual(self.read(f"disk/{name}"), OLD)
                    self.assertEqual(disk.names(), [name])
                    for output in beside:
                        self.assertEqual(self.read(output), OLD)
                    self.assertEqual(self.temporaries(), [])
            disk.free()
            self.ok(*words, "-q")
            self.assertNotEqual(self.read(f"disk/{name}"), OLD)

    def test_models(self):
        for kind in ("vdb", "obj", "ply", "stl", "glb", "3mf"):
            self.fails_at_any_size(f"x.{kind}", "convert", "b.vdb", "-o", f"disk/x.{kind}")

    def test_pictures_and_pages(self):
        self.fails_at_any_size("x.png", "render", "b.vdb", "-o", "disk/x.png", "--size", "320x240")
        self.fails_at_any_size("x.html", "render", "b.vdb", "-o", "disk/x.html")

    def test_what_is_written_beside_a_result(self):
        self.fails_at_any_size("r.json", "convert", "b.vdb", "-o", "x.vdb", "-o", "x.ply", "--report", "disk/r.json", beside=["x.vdb", "x.ply"])
        synth = ["synth", "b.vdb", "-o", "s.vdb", "--size", "2x,1x,1x"]
        self.fails_at_any_size("m.vdb", *synth, "--draft", "--source-map", "disk/m.vdb", beside=["s.vdb"])
        self.ok(*synth, "-q")
        self.fails_at_any_size("c.html", "compare", "b.vdb", "s.vdb", "-o", "c.json", "--page", "disk/c.html", beside=["c.json"])

    def test_an_index_that_cannot_be_kept(self):
        synth = ["synth", "b.vdb", "-o", "s.vdb", "--size", "2x,1x,1x", "--index-cache", "disk", "-q"]
        with SmallDisk(self.path("disk"), 1 << 25) as disk:
            self.ok(*synth)
            whole, kept = self.read("s.vdb"), disk.names()
            self.assertEqual([os.path.splitext(name)[1] for name in kept], [".blockindex"] * len(kept))
            size = sum(os.path.getsize(self.path(f"disk/{name}")) for name in kept)
            for room in (0, size // 2 // PAGE * PAGE):
                for name in disk.names():
                    os.remove(self.path(f"disk/{name}"))
                self.write("s.vdb", OLD)
                disk.fill(room)
                result = self.run_tool(*synth)
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertIn(".blockindex", self.error_line(result))
                self.assertEqual(self.read("s.vdb"), OLD)
                self.assertEqual(self.temporaries(), [])
                self.assertTrue(set(disk.names()) <= set(kept))
            disk.free()
            self.ok(*synth)
            self.assertEqual((self.read("s.vdb"), disk.names()), (whole, kept))

    def test_streams(self):
        with open("/dev/full", "w") as full:
            for words in (["info", "b.vdb"], ["convert", "b.vdb", "-o", "-.ply"], ["batch", "--schema"], ["synth", "--help"]):
                result = subprocess.run([PROGRAM, *words], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE)
                self.assertEqual(result.returncode, 3, f"{words}: {result.stderr}")
                self.assertIn("standard output", self.error_line(result))
            # Nobody hears it: the exit code says it all the same.
            for words, code in ((["info", "none.vdb"], 3), (["convert", "b.vdb", "-o", "x.ply"], 0)):
                self.assertEqual(subprocess.run([PROGRAM, *words], cwd=self.folder, stderr=full, timeout=PATIENCE).returncode, code)
        self.assertEqual(self.files(), ["b.vdb", "disk", "x.ply"])


class FullDiskOfBatch(NightTest):
    def setUp(self):
        super().setUp()
        self.jobs({"name": "a", "command": "convert", "inputs": "b.vdb", "output": "a.obj"},
                  {"name": "b", "command": "convert", "inputs": "b.vdb", "output": "b.ply"})

    def continues(self, *words):
        self.ok("batch", "j.json", *words)
        for name in ("a.obj", "b.ply"):
            self.ok("convert", "b.vdb", "-o", f"single.{name}", "-q")
            self.assertEqual(self.read(f"single.{name}"), self.read(name))
        self.assertIn("2 up to date", self.ok("batch", "j.json", *words).stderr)
        self.assertEqual(self.temporaries(), [])

    def test_logs_and_manifest(self):
        for pages in range(8):
            with self.subTest(pages=pages), SmallDisk(self.path("disk")) as disk:
                disk.fill(pages * PAGE)
                result = self.run_tool("batch", "j.json", "--logs", "disk/logs")
                self.assertIn(result.returncode, (0, 1, 3), result.stderr)
                if result.returncode:
                    self.assertIn("disk/logs", self.error_line(result))
                self.assertEqual(self.temporaries(), [])
                disk.free()
                self.continues("--logs", "disk/logs")
            for name in ("a.obj", "b.ply"):
                os.remove(self.path(name))

    def test_manifest_of_before_is_kept(self):
        with SmallDisk(self.path("disk"), 1 << 20) as disk:
            self.ok("batch", "j.json", "--logs", "disk/logs")
            before = self.read("disk/logs/manifest.json")
            os.remove(self.path("a.obj"))
            disk.fill(0)  # enough for the log and the report, in place of the earlier ones
            result = self.run_tool("batch", "j.json", "--logs", "disk/logs")
            self.assertIn(result.returncode, (1, 3), result.stderr)
            self.error_line(result)
            self.assertEqual(self.read("disk/logs/manifest.json"), before)
            disk.free()
            self.continues("--logs", "disk/logs")

    def test_page(self):
        with SmallDisk(self.path("disk"), 1 << 20) as disk:
            self.write("disk/p.html", OLD)
            disk.fill(0)
            result = self.run_tool("batch", "j.json", "--page", "disk/p.html")
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("disk/p.html", self.error_line(result))
            self.assertEqual(disk.names(), ["p.html"])
            self.assertEqual(self.read("disk/p.html"), OLD)
            self.assertNotIn("a.obj", self.files())

    def test_an_output(self):
        with SmallDisk(self.path("disk"), PAGE) as disk:
            self.jobs({"name": "a", "command": "convert", "inputs": "b.vdb", "output": "disk/a.obj"},
                      {"name": "b", "command": "convert", "inputs": "b.vdb", "output": "b.ply"})
            result = self.run_tool("batch", "j.json")
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("1 done, 1 failed; first a: disk/a.obj: ", self.error_line(result))
            self.assertEqual(disk.names(), [])
            disk.free()
            self.assertIn("1 done, 1 up to date", self.ok("batch", "j.json").stderr)


class Folders(NightTest):
    def test_a_read_only_folder(self):
        os.mkdir(self.path("kept"))
        self.write("kept/x.vdb", OLD)
        cases = [("closed/x.vdb", ["convert", "b.vdb", "-o", "closed/x.vdb"]),
                 ("closed/x.png", ["render", "b.vdb", "-o", "closed/x.png"]),
                 ("closed/r.json", ["convert", "b.vdb", "-o", "y.vdb", "--report", "closed/r.json"]),
                 ("closed", ["synth", "b.vdb", "-o", "y.vdb", "--size", "2x,1x,1x", "--index-cache", "closed"]),
                 ("closed/logs", ["batch", "j.json", "--logs", "closed/logs"]),
                 ("closed/p.html", ["batch", "j.json", "--page", "closed/p.html"])]
        self.jobs({"name": "a", "command": "convert", "inputs": "b.vdb", "output": "a.ply"})
        with ReadOnly(self.path("kept"), self.path("closed")):
            for says, words in cases:
                with self.subTest(words=words):
                    result = self.run_tool(*words)
                    self.assertEqual(result.returncode, 3, result.stderr)
                    self.assertIn(says, self.error_line(result))
            self.jobs({"name": "a", "command": "convert", "inputs": "b.vdb", "output": "closed/a.ply"},
                      {"name": "b", "command": "convert", "inputs": "b.vdb", "output": "b.ply"})
            result = self.run_tool("batch", "j.json")
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("1 done, 1 failed; first a: closed/a.ply: cannot be written: Read-only file system", self.error_line(result))
        self.assertEqual(self.read("kept/x.vdb"), OLD)
        self.assertEqual(os.listdir(self.path("kept")), ["x.vdb"])
        self.assertNotIn("y.vdb", self.files())

    def started(self, folder, *words):
        """A long run that has reserved its output in `folder`, and the work before it."""
        process = subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + PATIENCE
        while not [name for name in os.listdir(folder) if name.endswith(".tmp")]:
            self.assertIsNone(process.poll(), "it ended too early")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.002)
        return process

    def ended(self, process, says):
        _, words = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 3, words)
        lines = [line for line in words.splitlines() if "error:" in line]
        self.assertEqual(len(lines), 1, words)
        self.assertIn(says, lines[0])

    SYNTH = ["synth", "b.vdb", "-o", "disk/x.vdb", "--size", "4x,4x,1x"]

    def test_a_folder_that_is_renamed(self):
        self.write("disk/x.vdb", OLD)
        process = self.started(self.path("disk"), *self.SYNTH)
        os.rename(self.path("disk"), self.path("elsewhere"))
        self.ended(process, "disk/x.vdb: cannot be written")
        self.assertEqual(self.read("elsewhere/x.vdb"), OLD)

    def test_a_folder_that_is_replaced(self):
        """By another of its name: what was reserved is gone, and the result belongs into the first."""
        process = self.started(self.path("disk"), *self.SYNTH)
        os.rename(self.path("disk"), self.path("elsewhere"))
        os.mkdir(self.path("disk"))
        self.ended(process, "disk/x.vdb: cannot be written")
        self.assertEqual(os.listdir(self.path("disk")), [])

    def test_a_share_that_vanishes(self):
        """Below its name is the empty folder it was mounted on, which takes files; a share that comes back would hide them."""
        with SmallDisk(self.path("disk"), 1 << 25):
            self.write("disk/x.vdb", OLD)
            process = self.started(self.path("disk"), *self.SYNTH)
            subprocess.run(["umount", "--lazy", self.path("disk")], check=True)
            self.ended(process, "disk/x.vdb: cannot be written")
            self.assertEqual(os.listdir(self.path("disk")), [])

    def test_a_share_that_vanishes_under_a_batch(self):
        self.jobs({"name": "a", "command": "synth", "inputs": "b.vdb", "output": "disk/x.vdb", "options": {"size": "4x,4x,1x"}},
                  {"name": "b", "command": "convert", "inputs": "b.vdb", "output": "b.ply", "after": ["a"]},
                  {"name": "c", "command": "convert", "inputs": "b.vdb", "output": "c.ply"})
        with SmallDisk(self.path("disk"), 1 << 25):
            process = subprocess.Popen([PROGRAM, "batch", "j.json"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            end = time.monotonic() + PATIENCE
            while not [name for name in os.listdir(self.path("disk")) if name.startswith(".x.vdb.") and "batch" not in name]:
                self.assertIsNone(process.poll(), "it ended too early")
                self.assertLess(time.monotonic(), end)
                time.sleep(0.002)
            subprocess.run(["umount", "--lazy", self.path("disk")], check=True)
            _, words = process.communicate(timeout=PATIENCE)
            self.assertEqual(process.returncode, 1, words)
            self.assertIn("1 done, 1 failed, 1 blocked; first a: disk/x.vdb: cannot be written", words.splitlines()[-1])
            self.assertEqual(os.listdir(self.path("disk")), [])
        # It is back.
        with SmallDisk(self.path("disk"), 1 << 25):
            self.assertIn("2 done, 1 up to date", self.ok("batch", "j.json").stderr)


class Memory(NightTest):
    MODEL = ["convert", "b.vdb", "-o", "x.vdb", "--voxel-size", "0.05", "--threads", "2"]

    def setUp(self):
        super().setUp()
        self.write("x.vdb", OLD)

    def short_of_memory(self, *words, **options):
        result = self.run_tool(*words, **options)
        line = self.error_line(result)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("memory", line)
        self.assertEqual(self.read("x.vdb"), OLD)
        self.assertEqual(self.temporaries(), [])
        return line

    def test_max_memory(self):
        for most in ("1M", "20M", "60M"):
            self.short_of_memory(*self.MODEL, "--max-memory", most)

    def test_a_hard_limit(self):
        """Below about 150 MB of addresses the libraries cannot be loaded, which no program can report better than the system."""
        for most in (200, 250, 300):
            self.short_of_memory(*self.MODEL, preexec_fn=lambda most=most: resource.setrlimit(resource.RLIMIT_AS, (most << 20, most << 20)))

    def test_the_kernel_kills_the_worker(self):
        with MemoryGroup(100 << 20) as group:
            line = self.short_of_memory(*self.MODEL, "--max-memory", "8G", preexec_fn=group.enter)
            self.assertIn("killed, most likely out of memory", line)

    def test_the_kernel_kills_a_job(self):
        self.jobs({"name": "big", "command": "convert", "inputs": "b.vdb", "output": "x.vdb", "options": {"voxel-size": 0.05}},
                  {"name": "small", "command": "convert", "inputs": "b.vdb", "output": "b.ply"})
        with MemoryGroup(100 << 20) as group:
            result = self.run_tool("batch", "j.json", "--max-memory", "8G", preexec_fn=group.enter)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("1 done, 1 failed; first big: ", self.error_line(result))
            self.assertIn("killed", self.error_line(result))
        self.assertEqual(self.read("x.vdb"), OLD)
        self.assertEqual(self.temporaries(), [])
        self.assertIn("b.ply", self.files())


if __name__ == "__main__":
    unittest.main()
