"""Errors by the contract: exit code, one line that names the file or option, nothing written."""
import json
import os
import random
import shutil
import signal
import subprocess
import time
import unittest

from support import PROGRAM, CliTest, sample


class BadOptions(CliTest):
    def test_command_line(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        cases = [
            ("did you mean synth", ["sinth", "g.vdb"]),
            ("did you mean --size", ["synth", "g.vdb", "-o", "x.vdb", "--sise", "2x,2x,2x"]),
            ("--size: missing", ["synth", "g.vdb", "-o", "x.vdb"]),
            ("--size 2x,2x: must be", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x"]),
            ("--size nanx,2x,2x", ["synth", "g.vdb", "-o", "x.vdb", "--size", "nanx,2x,2x"]),
            ("--size 0.5x,1x,1x", ["synth", "g.vdb", "-o", "x.vdb", "--size", "0.5x,1x,1x"]),
            ("--block 3", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--block", 3]),
            ("--border tiles", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--border", "tiles"]),
            ("--exemplar-box 1,2,3", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--exemplar-box", "1,2,3"]),
            ("--output: missing", ["synth", "g.vdb", "--size", "2x,2x,2x"]),
            ("x.doc: unknown extension", ["convert", "g.vdb", "-o", "x.doc"]),
            ("g.doc: unknown extension", ["convert", "g.doc", "-o", "x.vdb"]),
            ("no input", ["convert", "-o", "x.vdb"]),
            ("one input too many", ["convert", "g.vdb", "h.vdb", "-o", "x.vdb"]),
            ("--threads two", ["convert", "g.vdb", "-o", "x.vdb", "--threads", "two"]),
            ("--seed -1", ["make", "grid", "x.vdb", "--seed", "-1"]),
            ("--max-memory 3", ["convert", "g.vdb", "-o", "x.vdb", "--max-memory", "3"]),
            ("--progress fast", ["convert", "g.vdb", "-o", "x.vdb", "--progress", "fast"]),
            ("--voxel-size 0", ["convert", "g.vdb", "-o", "x.vdb", "--voxel-size", "0"]),
            ("give one of them", ["convert", "g.vdb", "-o", "x.vdb", "--voxel-size", "1", "--resolution", "9"]),
            ("--size: given twice", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--size", "2x,2x,2x"]),
            ("named as an output twice", ["convert", "g.vdb", "-o", "x.vdb", "-o", "x.vdb"]),
            ("unknown kind", ["make", "cubes", "x.vdb"]),
            ("--resolution 5", ["make", "grid", "x.vdb", "--resolution", 5]),
            ("--slice q=1", ["render", "g.vdb", "-o", "x.png", "--slice", "q=1"]),
            ("--size 9x9", ["render", "g.vdb", "-o", "x.png", "--size", "9x9"]),
            ("--directions: cannot be combined with --slice", ["render", "g.vdb", "-o", "x.png", "--directions", "g.vdb", "--slice", "z=0.5"]),
            ("x.jpg: unknown extension; must be a .png, .html or .htm file", ["render", "g.vdb", "-o", "x.jpg"]),
            ("--at: missing", ["match", "g.vdb", "g.vdb"]),
            ("mask blob: unknown kind", ["mask", "blob", "-o", "x.vdb"]),
            ("--box: missing", ["crop", "g.vdb", "-o", "x.vdb"]),
            ("needs a value", ["convert", "g.vdb", "-o"]),
            ("--iso: is no option of make; ", ["make", "grid", "x.vdb", "--iso", "1"]),
            ("--seed: is no option of render; ", ["render", "g.vdb", "-o", "x.png", "--seed", "1"]),
            ("--which: is now --exemplar-map", ["synth", "g.vdb", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--which", "g.vdb"]),
            ("--guide-weight 0: must be a number from 0.001 to 1000", ["synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--guide-weight", 0]),
            ("--view 1e+300,0,0", ["render", "g.vdb", "-o", "x.png", "--view", "1e300,0,0"]),
        ]
        for says, words in cases:
            with self.subTest(words=words):
                self.fails(2, says, *words)
        self.assertEqual(self.files(), ["g.vdb"])

    def test_masks_that_are_missing(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.fails(3, "m.vdb: no such file", "synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--exemplar-mask", "m.vdb")
        self.fails(3, "m.vdb: no such file", "match", "g.vdb", "g.vdb", "--at", "0,0,0", "--mask", "m.vdb")
        self.assertEqual(self.files(), ["g.vdb"])

    def test_no_words_at_all(self):
        result = self.run_tool()
        self.assertEqual(result.returncode, 2)
        self.assertIn("Usage: vdb_synth COMMAND", result.stderr)


class BadFiles(CliTest):
    def test_files(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        whole = self.read("g.vdb")
        self.write("empty.vdb", b"")
        self.write("cut.vdb", whole[:len(whole) // 2])
        self.write("text.vdb", b"hello there")
        self.write("empty.obj", "")
        self.write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.write("config.json", "[1, 2]")
        self.write("other.json", '{"blok": 3}')
        os.mkdir(self.path("folder.vdb"))
        os.mkfifo(self.path("pipe.obj"))
        cases = [
            (3, "missing.vdb: no such file", ["info", "missing.vdb"]),
            (3, "missing.obj: no such file", ["info", "missing.obj"]),
            (3, "folder.vdb: is a directory", ["info", "folder.vdb"]),
            (3, "empty.vdb: the file is empty", ["info", "empty.vdb"]),
            (3, "cut.vdb: truncated", ["info", "cut.vdb"]),
            (3, "text.vdb: not a VDB file", ["info", "text.vdb"]),
            (3, "empty.obj: the file is empty", ["convert", "empty.obj", "-o", "x.vdb"]),
            (3, "nan.obj:1: a coordinate is not a finite number", ["convert", "nan.obj", "-o", "x.vdb"]),
            (3, "no/x.vdb: the folder no does not exist", ["convert", "g.vdb", "-o", "no/x.vdb"]),
            (3, "folder.vdb: is a directory", ["convert", "g.vdb", "-o", "folder.vdb"]),
            (3, "holds no source map", ["repeat", "g.vdb", "g.vdb", "-o", "x.vdb"]),
            (3, "config.json: not a JSON object", ["synth", "g.vdb", "-o", "x.vdb", "--config", "config.json"]),
            (2, "other.json: blok: unknown option of synth; did you mean block?", ["synth", "g.vdb", "-o", "x.vdb", "--config", "other.json"]),
            (3, "folder.vdb: is a directory", ["synth", "g.vdb", "-o", "x.vdb", "--config", "folder.vdb"]),
            (2, "the same file as", ["convert", "g.vdb", "-o", "x.vdb", "-o", "./x.vdb"]),
            (3, "/dev/null: is not a regular file", ["convert", "g.vdb", "-o", "x.vdb", "--report", "/dev/null"]),
            (3, "is not a regular file", ["info", "pipe.obj"]),
            (3, "nothing.json: no such file", ["synth", "g.vdb", "-o", "x.vdb", "--config", "nothing.json"]),
        ]
        for code, says, words in cases:
            with self.subTest(words=words):
                self.fails(code, says, *words)
        self.assertNotIn("x.vdb", self.files())

    def test_unusable(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.write("points.obj", "v 0 0 0\nv 1 1 1\n")
        self.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.fails(1, "points.obj: no faces", "convert", "points.obj", "-o", "x.vdb")
        self.fails(1, "flat.obj: a sheet with 3 open edges", "convert", "flat.obj", "-o", "x.vdb")
        self.fails(1, "--block 32: larger than the exemplar", "synth", "g.vdb", "-o", "x.vdb", "--size", "2x,2x,2x", "--block", 32)
        self.fails(1, "smaller than the exemplar's domain", "synth", "g.vdb", "-o", "x.vdb", "--size", "20,24,24")
        self.fails(3, "--grid rock", "convert", "g.vdb", "-o", "x.vdb", "--grid", "rock")
        self.fails(1, "outside the query's domain", "match", "g.vdb", "g.vdb", "--at", "99,0,0")
        self.fails(1, "over --max-memory", "synth", "g.vdb", "-o", "x.vdb", "--size", "20000,20000,20000")
        self.fails(1, "over --max-memory", "make", "grid", "x.vdb", "--resolution", 4096, "--max-memory", "1G")
        self.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        self.fails(1, "over --max-memory", "convert", "t.obj", "-o", "x.vdb", "--voxel-size", "2e-5")
        self.fails(1, "no surface in it", "crop", "g.vdb", "-o", "x.vdb", "--box", "500,500,500,520,520,520")

    def test_open_samples_are_refused_with_their_open_edges(self):
        self.fails(1, "a sheet with 112 open edges", "convert", sample("bad/moebius.obj"), "-o", "x.vdb", "-q")
        self.fails(3, "more than the file can hold", "convert", sample("bad/assimp-OutOfMemory.off"), "-o", "x.vdb")
        self.fails(1, "no faces", "convert", sample("bad/assimp-point_cloud.obj"), "-o", "x.vdb")
        self.fails(1, "--iso", "convert", sample("volumes/elyg-pyro-fog.vdb"), "-o", "x.vdb")
        self.fails(3, "line 28", "convert", sample("bad/assimp-malformed.obj"), "-o", "x.vdb")

    def test_mutated_vdb_files_never_crash_or_hang(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        whole = self.read("g.vdb")
        for seed in range(40):
            draw = random.Random(seed)
            bytes_ = bytearray(whole)
            for _ in range(draw.choice([1, 3, 20])):
                at = draw.randrange(len(bytes_) if seed % 2 else 2000)
                bytes_[at] = draw.randrange(256)
            self.write("m.vdb", bytes(bytes_))
            result = self.run_tool("convert", "m.vdb", "-o", "x.obj", env=dict(os.environ, VDBSYNTH_READ_TIMEOUT="4"))
            self.assertIn(result.returncode, (0, 1, 3), f"seed {seed}: {result.stderr}")
            if result.returncode:
                self.assertEqual(len([l for l in result.stderr.splitlines() if "error:" in l]), 1, result.stderr)
            self.assertFalse([f for f in self.files() if f.endswith(".tmp")], f"seed {seed}")


class Disk(CliTest):
    def limited(self, bytes_):
        import resource

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))

        return limit

    def test_a_write_that_fails_harms_nothing(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        for name in ("x.vdb", "x.obj", "x.ply", "x.stl", "x.off", "x.glb", "x.gltf", "x.3mf", "x.png", "x.exr"):
            self.ok("convert", "g.vdb", "-o", name, "--quiet")
            size = os.path.getsize(self.path(name))
            for room in (0, 1, size // 3, size - 1):
                self.write(name, "old")
                self.fails(3, name, "convert", "g.vdb", "-o", name, "--quiet", preexec_fn=self.limited(room))
                self.assertEqual(self.read(name), b"old")
            os.remove(self.path(name))
        self.write("x.png", "old")
        self.fails(3, "x.png", "render", "g.vdb", "-o", "x.png", preexec_fn=self.limited(5000))
        self.assertEqual(self.read("x.png"), b"old")

    def test_a_full_disk(self):
        disk = self.path("disk")
        os.mkdir(disk)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", disk], capture_output=True).returncode:
            self.skipTest("mounting a small disk needs root")
        try:
            for name in ("x.vdb", "x.obj"):
                self.fails(3, f"disk/{name}", "make", "grid", "-o", f"disk/{name}") if name == "x.vdb" else None
                self.ok("make", "grid", "g.vdb", "--resolution", 24)
                self.fails(3, f"disk/{name}", "convert", "g.vdb", "-o", f"disk/{name}")
            self.assertEqual(os.listdir(disk), [])
        finally:
            subprocess.run(["umount", disk])

    def test_a_folder_that_vanishes(self):
        self.ok("make", "balls", "b.vdb", "--resolution", 64)
        os.mkdir(self.path("gone"))
        process = subprocess.Popen([PROGRAM, "synth", "b.vdb", "-o", "gone/x.vdb", "--size", "2x,2x,1x", "--draft"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.time() + 20
        while not os.listdir(self.path("gone")) and time.time() < deadline:
            time.sleep(0.005)
        shutil.rmtree(self.path("gone"))
        _, words = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 3, words)
        self.assertIn("error: gone/x.vdb: cannot be written", words)

    def test_a_read_only_folder(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        closed = self.path("closed")
        os.mkdir(closed)
        os.chmod(closed, 0o555)
        options = {}
        if os.geteuid() == 0:
            # The program may lie where only its builder may look.
            shutil.copy(PROGRAM, self.path("tool"))
            options["executable"] = self.path("tool")
            options["preexec_fn"] = lambda: os.setuid(65534)
        self.fails(3, "closed/x.vdb: cannot be written", "convert", "g.vdb", "-o", "closed/x.vdb", **options)


class Signals(CliTest):
    def setUp(self):
        super().setUp()
        self.ok("make", "balls", "b.vdb", "--resolution", 64)
        self.write("x.vdb", "old")

    def start(self, *more):
        return subprocess.Popen([PROGRAM, "synth", "b.vdb", "-o", "x.vdb", "--size", "6x,6x,6x", *more], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def stopped(self, number, code):
        process = self.start()
        time.sleep(1.0)
        process.send_signal(number)
        _, words = process.communicate(timeout=60)
        self.assertEqual(process.returncode, code, words)
        self.assertEqual(len([l for l in words.splitlines() if "interrupted" in l]), 1, words)
        self.assertEqual(self.read("x.vdb"), b"old")
        self.assertEqual(self.files(), ["b.vdb", "x.vdb"])

    def test_interrupt(self):
        self.stopped(signal.SIGINT, 130)

    def test_terminate(self):
        self.stopped(signal.SIGTERM, 143)

    def test_a_killed_worker_is_one_line(self):
        process = self.start()
        time.sleep(1.0)
        children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 1)
        os.kill(int(children[0]), signal.SIGKILL)
        _, words = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("killed, most likely out of memory", words)
        self.assertEqual(self.files(), ["b.vdb", "x.vdb"])

    def test_random_kills_never_leave_a_half_file(self):
        names = ("x.obj", "x.ply", "x.vdb", "x.glb")
        for name in names:
            self.ok("convert", "b.vdb", "-o", f"whole.{name}", "--quiet")
        draw = random.Random(1)
        kept = 0
        for kill in range(200):
            name = names[kill % len(names)]
            self.write(name, "old")
            process = subprocess.Popen([PROGRAM, "convert", "b.vdb", "-o", name, "--quiet"], cwd=self.folder, stderr=subprocess.DEVNULL)
            time.sleep(draw.uniform(0.0, 0.35))
            process.kill()
            process.wait()
            time.sleep(0.02)
            self.assertIn(self.read(name), (b"old", self.read(f"whole.{name}")))
            kept += self.read(name) == b"old"
        self.assertGreater(kept, 20)  # most were killed before the end
        time.sleep(0.5)
        for name in names:
            self.ok("convert", "b.vdb", "-o", name, "--quiet")
        self.assertFalse([f for f in self.files() if f.endswith(".tmp")])

    def test_process_one(self):
        """A container's entry point is process 1, which a child without a parent is given to as well."""
        own = ["unshare", "--user", "--map-root-user", "--pid", "--fork", "--mount-proc"]
        if not shutil.which("unshare") or subprocess.run([*own, "true"], capture_output=True).returncode:
            self.skipTest("a namespace of processes cannot be made here")
        number = subprocess.run([*own, "sh", "-c", "echo $$"], capture_output=True, text=True).stdout
        self.assertEqual(number, "1\n")
        result = subprocess.run([*own, PROGRAM, "make", "grid", "g.vdb", "--resolution", "24"], cwd=self.folder,
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("g.vdb", self.files())
        result = subprocess.run([*own, PROGRAM, "info", "none.vdb"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 3)
        self.assertIn("none.vdb: no such file", result.stderr)

    def in_a_namespace(self, *words):
        """The tool as process 1, and its number outside."""
        own = ["unshare", "--user", "--map-root-user", "--pid", "--fork", "--mount-proc", "--kill-child"]
        if not shutil.which("unshare") or subprocess.run([*own, "true"], capture_output=True).returncode:
            self.skipTest("a namespace of processes cannot be made here")
        outer = subprocess.Popen([*own, PROGRAM, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(outer.communicate)
        self.addCleanup(outer.kill)
        time.sleep(1.5)
        children = subprocess.run(["pgrep", "-P", str(outer.pid)], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 1, "it ended too early")
        return outer, int(children[0])

    def test_process_one_ends_on_sigterm(self):
        synth = ["synth", "b.vdb", "-o", "x.vdb", "--size", "6x,6x,6x"]
        self.write("j.json", json.dumps({"jobs": [{"name": "a", "command": "synth", "inputs": "b.vdb", "output": "x.vdb",
                                                   "options": {"size": "6x,6x,6x"}}]}))
        for words, number, code in ((synth, signal.SIGTERM, 143), (synth, signal.SIGINT, 130), (["batch", "j.json"], signal.SIGTERM, 143)):
            with self.subTest((words[0], code)):
                outer, one = self.in_a_namespace(*words)
                began = time.monotonic()
                os.kill(one, number)
                _, said = outer.communicate(timeout=60)
                self.assertEqual(outer.returncode, code, said)
                self.assertLess(time.monotonic() - began, 20)
                self.assertIn("interrupted", said)
                self.assertEqual(self.read("x.vdb"), b"old")
                self.assertFalse([f for f in self.files() if f.endswith(".tmp")])

    def test_process_one_leaves_no_zombies(self):
        outer, one = self.in_a_namespace("synth", "b.vdb", "-o", "x.vdb", "--size", "6x,6x,6x")
        # Others come into a container (docker exec) and leave processes without a parent behind.
        enter = ["nsenter", "--target", str(one), "--user", "--pid", "--preserve-credentials"]
        if subprocess.run([*enter, "true"], capture_output=True).returncode:
            self.skipTest("nsenter cannot enter a namespace of processes here")
        subprocess.run([*enter, "sh", "-c", "sleep 0.2 & sleep 0.3 & exit 0"], check=True, timeout=20)
        time.sleep(1.5)
        states = subprocess.run(["ps", "--ppid", str(one), "-o", "stat=,comm="], capture_output=True, text=True).stdout.split("\n")
        states = [line for line in states if line]
        self.assertEqual(len(states), 1, states)  # the worker
        self.assertNotEqual(states[0][0], "Z")
        os.kill(one, signal.SIGTERM)
        self.assertEqual(outer.wait(timeout=60), 143)

    def test_a_worker_without_its_parent_ends(self):
        result = self.run_tool("make", "grid", "g.vdb", "--resolution", 24,
                               env={**os.environ, "VDBSYNTH_SUPERVISOR_LINE": f"9,{os.getppid()}"})
        self.assertEqual(result.returncode, 1)
        self.assertNotIn("g.vdb", self.files())


if __name__ == "__main__":
    unittest.main(verbosity=2)
