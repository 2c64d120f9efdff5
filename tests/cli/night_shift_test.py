"""Signals at random times, two batches at once, many jobs in one batch, many threads: the same bytes as an undisturbed run.

VDBSYNTH_SIGNALS=200, VDBSYNTH_SOAK=500 and VDBSYNTH_MUTATIONS=2000 make it long. Signals come at times drawn from a seed; where
one arrives in the program depends on the machine, so a failure may not repeat."""
import json
import os
import random
import shutil
import signal
import statistics
import subprocess
import time
import unittest

from night_shift import PATIENCE, children_of, number, resident_bytes
from support import PROGRAM, CliTest, SOURCE

OLD = b"old\n"


def picture():
    """A small image of texture with noise, without a library: binary PPM."""
    draw = random.Random(1)
    pixels = bytes(value for y in range(24) for x in range(24) for value in (x * 10 % 256, y * 20 % 256, draw.randrange(256)))
    return b"P6 24 24 255\n" + pixels


def listening():
    """In a process group of its own. A test that runs in the background ignores SIGINT, and so would the program."""
    os.setpgrp()
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class NightTest(CliTest):
    def setUp(self):
        super().setUp()
        self.ok("make", "balls", "b.vdb", "--resolution", 32, "-q")
        self.ok("make", "grooves", "a.vdb", "a2.vdb", "--resolution", 40, "-q")
        self.ok("make", "bumps", "p.ply", "--resolution", 24, "-q")
        self.ok("convert", "b.vdb", "-o", "b.ply", "-q")
        self.write("i.ppm", picture())
        self.sources = self.files()

    def run_tool(self, *words, **options):
        options.setdefault("timeout", PATIENCE)
        return super().run_tool(*words, **options)

    def temporaries(self):
        return [os.path.join(folder, name) for folder, _, names in os.walk(self.folder) for name in names if name.endswith(".tmp")]

    def results(self):
        return {name: self.read(name) for name in self.files() if name not in self.sources and os.path.isfile(self.path(name))}

    def start(self, *words):
        return subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                preexec_fn=listening)

    def clean(self):
        for name in self.files():
            if name in self.sources:
                continue
            path = self.path(name)
            shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)


MIX = [["convert", "b.vdb", "-o", "x.obj", "-o", "x.vdb", "-o", "x.glb", "--report", "x.json"],
       ["synth", "b.vdb", "-o", "x.vdb", "-o", "x.ply", "--size", "2x,1x,1x", "--draft", "--source-map", "m.vdb"],
       ["render", "b.vdb", "-o", "x.png", "--size", "160x120"],
       ["texture", "b.ply", "i.ppm", "-o", "x.ply"],
       ["relief", "i.ppm", "b.vdb", "-o", "x.vdb", "--draft"],
       ["patch", "p.ply", "-o", "x.ply", "--size", "2x,2x", "--draft"],
       ["analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "x.vdb", "-o", "x.stl", "--draft"]]


class Signals(NightTest):
    def send(self, draw, process):
        """One signal, to the program, its child or both. Returns what it was."""
        kind = draw.choice([signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
        to = draw.choice(["program", "child", "all"])
        try:
            if to == "all":
                os.killpg(process.pid, kind)
            elif to == "program":
                os.kill(process.pid, kind)
            else:
                for child in children_of(process.pid):
                    os.kill(child, kind)
        except ProcessLookupError:
            pass  # it was quicker
        return kind, to

    def ended(self, kind, to, process):
        """The contract's exit code and last line."""
        _, words = process.communicate(timeout=PATIENCE)
        what = f"{kind.name} to {to}: {process.returncode}: {words}"
        # Until its handlers are installed, a program ends as the system ends it, which a shell calls 130 and 143, too.
        by_code = {signal.SIGINT: (130, -2), signal.SIGTERM: (143, -15), signal.SIGKILL: (1,) if to == "child" else (-9,)}
        self.assertIn(process.returncode, (0, *by_code[kind]), what)
        if process.returncode > 0:
            lines = [line for line in words.splitlines() if line]
            self.assertEqual(len([line for line in lines if "error:" in line]), 1, what)
            self.assertIn("error:", lines[-1], what)
            self.assertIn("killed" if kind == signal.SIGKILL else "interrupted", lines[-1], what)
        return process.returncode, what

    def gone(self):
        """Waits until no process of an ended program works in the folder."""
        end = time.monotonic() + 60
        while time.monotonic() < end:
            names = [os.path.basename(path).split(".")[-2].split("-")[0] for path in self.temporaries()]
            if not any(name.isdigit() and os.path.exists(f"/proc/{name}") for name in names):
                return
            time.sleep(0.01)

    def test_commands(self):
        draw, seconds, whole = random.Random(27), [], []
        for words in MIX:
            began = time.monotonic()
            self.ok(*words, "-q")
            seconds.append(time.monotonic() - began)
            whole.append({name: content for name, content in self.results().items() if name != "x.json"})
            self.clean()
        codes = []
        for round_ in range(number("VDBSYNTH_SIGNALS", 20)):
            i = round_ % len(MIX)
            for name in whole[i]:
                self.write(name, OLD)
            process = self.start(*MIX[i], "-q")
            time.sleep(draw.uniform(0, seconds[i]))
            kind, to = self.send(draw, process)
            code, what = self.ended(kind, to, process)
            codes.append(code)
            with self.subTest(round=round_, words=MIX[i], what=what):
                self.gone()
                now = self.results()
                for name, content in whole[i].items():
                    self.assertIn(now.get(name), ([content] if code == 0 else [OLD, content]), f"{name} is lost, or half a file")
                if code != -9:
                    self.assertEqual(self.temporaries(), [])
                self.ok(*MIX[i], "-q")
                self.assertEqual({name: content for name, content in self.results().items() if name != "x.json"}, whole[i])
                self.assertEqual(self.temporaries(), [])
                self.clean()
        print(f"signals to commands: {dict((c, codes.count(c)) for c in sorted(set(codes)))}", flush=True)

    def test_the_first_moments(self):
        """A worker that is stopped before it listens is no internal error."""
        codes = []
        for round_ in range(number("VDBSYNTH_SIGNALS", 20) // 2):
            process = self.start("convert", "b.vdb", "-o", "x.obj", "-q")
            kind = (signal.SIGTERM, signal.SIGINT)[round_ % 2]
            children = []
            while not children and process.poll() is None:
                children = children_of(process.pid)
            time.sleep(0.002 * (round_ // 2 % 5))
            try:
                os.killpg(process.pid, kind) if round_ % 4 < 2 else [os.kill(child, kind) for child in children]
            except ProcessLookupError:
                pass
            codes.append(self.ended(kind, "child", process)[0])
            self.assertEqual(self.temporaries(), [])
            self.clean()
        print(f"signals at the first moments: {dict((c, codes.count(c)) for c in sorted(set(codes)))}", flush=True)

    def test_a_batch(self):
        self.write("j.json", json.dumps({"jobs": [
            {"name": "more", "command": "synth", "inputs": "b.vdb", "output": ["m1.vdb", "m1.ply"], "options": {"size": "2x,1x,1x", "draft": True}},
            {"name": "mesh", "command": "convert", "inputs": "m1.vdb", "output": "mesh.obj"},
            {"name": "picture", "command": "render", "inputs": "m1.vdb", "output": "m1.png", "options": {"size": "160x120"}},
            {"name": "colour", "command": "texture", "inputs": ["b.ply", "i.ppm"], "output": "t.ply"},
            {"name": "sheet", "command": "patch", "inputs": "p.ply", "output": "s.ply", "options": {"size": "2x,2x", "draft": True}}]}))
        self.sources.append("j.json")
        began = time.monotonic()
        self.ok("batch", "j.json", "--jobs", 2, "-q")
        seconds, whole = time.monotonic() - began, self.results()
        self.clean()
        draw, codes = random.Random(72), []
        for round_ in range(-(-number("VDBSYNTH_SIGNALS", 20) // 4)):
            process = self.start("batch", "j.json", "--jobs", 2, "-q", "--page", "p.html")
            time.sleep(draw.uniform(0, 1.1 * seconds))
            kind, to = self.send(draw, process)
            _, words = process.communicate(timeout=PATIENCE)
            codes.append(process.returncode)
            what = f"{kind.name} to {to}: {process.returncode}: {words}"
            by_code = {signal.SIGINT: (130, -2), signal.SIGTERM: (143, -15), signal.SIGKILL: (-9,)}[kind] if to != "child" else (1,)
            self.assertIn(process.returncode, (0, *by_code), what)
            if process.returncode > 0:
                self.assertEqual(len([line for line in words.splitlines() if "error:" in line]), 1, what)
                self.assertIn("error:", words.splitlines()[-1], what)
            with self.subTest(round=round_, what=what):
                for name, content in self.results().items():
                    if name in whole:
                        self.assertEqual(content, whole[name], name)
                self.ok("batch", "j.json", "--jobs", 2, "-q", "--page", "p.html")
                self.assertEqual({name: content for name, content in self.results().items() if name != "p.html"}, whole)
                self.assertEqual(self.temporaries(), [])
                self.clean()
        print(f"signals to batches: {dict((c, codes.count(c)) for c in sorted(set(codes)))}", flush=True)


class TwoBatches(NightTest):
    def both(self, first, second):
        processes = [self.start("batch", name, "--jobs", 2) for name in (first, second)]
        said = [process.communicate(timeout=PATIENCE)[1] for process in processes]
        return [(process.returncode, words) for process, words in zip(processes, said)]

    def batches(self):
        """Two files whose jobs write the same outputs, in opposite order, from other seeds."""
        wholes = []
        for name, seed in (("j.json", 1), ("k.json", 2)):
            jobs = [{"name": f"n{n}", "command": "synth", "inputs": "b.vdb", "output": f"o{n}.vdb",
                     "options": {"size": "2x,1x,1x", "draft": True, "seed": seed}} for n in (1, 2, 3)]
            self.write(name, json.dumps({"jobs": jobs if seed == 1 else jobs[::-1]}))
            self.ok("synth", "b.vdb", "-o", "w.vdb", "--size", "2x,1x,1x", "--draft", "--seed", seed, "-q")
            wholes.append(self.read("w.vdb"))
            os.remove(self.path("w.vdb"))
        self.sources += ["j.json", "k.json"]
        self.assertNotEqual(*wholes)
        return wholes

    def test_one_folder(self):
        wholes = self.batches()
        for _ in range(number("VDBSYNTH_SIGNALS", 20) // 10):
            for code, words in self.both("j.json", "k.json"):
                self.assertIn(code, (0, 1), words)
                if code:
                    self.assertIn("another batch writes it now", words.splitlines()[-1])
            for content in self.results().values():
                self.assertIn(content, wholes)
            self.assertEqual(self.temporaries(), [])
            for name, whole in zip(("j.json", "k.json"), wholes):
                self.ok("batch", name, "-q")
                self.assertEqual([content == whole for content in self.results().values()], [True] * 3)
            self.clean()

    def test_one_file(self):
        wholes = self.batches()
        for _ in range(number("VDBSYNTH_SIGNALS", 20) // 10):
            ends = sorted(self.both("j.json", "j.json"))
            self.assertEqual(ends[0][0], 0, ends)
            self.assertIn(ends[1][0], (0, 3), ends)  # 0: it came when the other had ended
            if ends[1][0]:
                self.assertEqual(len(ends[1][1].splitlines()), 1, ends[1][1])
                self.assertIn("another batch runs here", ends[1][1])
            self.assertEqual([content == wholes[0] for content in self.results().values()], [True] * 3)
            self.assertEqual(self.temporaries(), [])
            self.clean()


class Soak(NightTest):
    SINGLE = [("convert", ["b.vdb"], ".obj", {}), ("synth", ["b.vdb"], ".vdb", {"size": "2x,1x,1x", "draft": True}),
              ("render", ["b.vdb"], ".png", {"size": "96x64"}), ("analogy", ["a.vdb", "a2.vdb", "b.vdb"], ".vdb", {"draft": True}),
              ("mask", ["ball"], ".vdb", {"center": "0,0,0", "radius": 9, "voxel-size": 1}), ("info", ["b.vdb"], ".json", {}),
              ("patch", ["p.ply"], ".ply", {"size": "2x,2x", "draft": True}), ("texture", ["b.ply", "i.ppm"], ".ply", {"draft": True})]

    def test_many_jobs(self):
        count = number("VDBSYNTH_SOAK", 40)
        jobs = []
        for n in range(count):
            command, inputs, extension, options = self.SINGLE[n % len(self.SINGLE)]
            jobs.append({"name": f"job{n}", "command": command, "inputs": inputs, "output": f"out/{n}{extension}", "options": options})
        self.write("j.json", json.dumps({"jobs": jobs}))
        process = self.start("batch", "j.json", "--jobs", 2, "-q", "--page", "p.html", "--report", "r.json")
        memory = []
        while process.poll() is None:
            memory.append(resident_bytes(process.pid))
            time.sleep(0.05)
        self.assertEqual(process.returncode, 0, process.communicate()[1])
        process.communicate()
        self.assertEqual(json.loads(self.read("r.json"))["counts"]["done"], count)
        memory = [bytes_ for bytes_ in memory if bytes_]
        parts = [memory[len(memory) * k // 10:len(memory) * (k + 1) // 10] or memory for k in range(10)]
        middles = [statistics.median(part) for part in parts]
        print(f"soak: {count} jobs, memory of the batch by tenths of its time (MB): {' '.join(f'{m / 1e6:.1f}' for m in middles)}", flush=True)
        # A record and a row of the page a job: under 4 kB each.
        self.assertLess(middles[9], middles[1] + 2e6 + 4e3 * count)
        for n, (command, inputs, extension, options) in enumerate(self.SINGLE):
            words = [f"--{name}" if value is True else f"--{name}={value}" for name, value in options.items()]
            self.ok(command, *inputs, *words, "-o", f"single{extension}", "-q")
            whole = self.read(f"single{extension}")
            for other in range(n, count, len(self.SINGLE)):
                self.assertEqual(self.read(f"out/{other}{extension}"), whole, (command, other))
        self.assertEqual(self.temporaries(), [])
        self.assertIn(f"{count} up to date", self.ok("batch", "j.json").stderr)


class Threads(NightTest):
    METHODS = [*MIX, ["analogy", "a.vdb", "a2.vdb", "b.vdb", "-o", "x.vdb", "--source-map"],
               ["synth", "b.vdb", "-o", "x.vdb", "-o", "x.ply", "--size", "2x,1x,1x", "--source-map", "m.vdb"],
               ["synth", "b.vdb", "-o", "x.vdb", "--size", "2x,1x,1x", "--method", "exact"],
               ["patch", "p.ply", "-o", "x.ply", "-o", "x.vdb", "--size", "2x,2x"],
               ["texture", "b.vdb", "i.ppm", "-o", "x.vdb"],
               ["relief", "i.ppm", "b.vdb", "-o", "x.vdb"],
               ["relief-extract", "b.vdb", "-o", "x.vdb", "--base-radius", "3"],
               ["mask", "ball", "--center", "16,16,16", "--radius", "9", "--voxel-size", "1", "-o", "x.vdb"],
               ["crop", "b.vdb", "-o", "x.vdb", "--box", "4,4,4,28,28,28"],
               ["convert", "b.ply", "-o", "x.vdb", "-o", "x.obj", "--resolution", "64"],
               ["convert", "i.ppm", "-o", "x.vdb"],
               ["render", "b.vdb", "b.ply", "-o", "x.html"],
               ["compare", "b.vdb", "a2.vdb", "--json", "-o", "x.json"],
               ["info", "b.vdb", "--json", "-o", "x.json"],
               ["match", "b.vdb", "b.vdb", "--at", "8,8,8", "-o", "x.json"]]

    def test_same_bytes(self):
        for words in self.METHODS:
            words = [word for word in words if word not in ("--report",)]
            words = words[:-1] if words[-1] == "x.json" and words[0] == "convert" else words  # a report holds times
            first = None
            for threads in (1, 2, 4, 8, 16):
                self.ok(*words, "-q", "--threads", threads)
                results = self.results()
                self.assertTrue(results, words)
                first = first or results
                with self.subTest(words=words, threads=threads):
                    self.assertEqual([name for name in first if results.get(name) != first[name]], [])
                self.clean()


class JobFiles(NightTest):
    """Files that a program wrote wrongly, or that were damaged: one line and exit code 2 or 3, nothing else."""

    def test_mutated_job_files(self):
        seeds = [(SOURCE / "docs/examples" / name).read_bytes() for name in ("batch.json", "batch.yaml")]
        pieces = [b"{", b"}", b"[", b"]", b'"', b",", b":", b"${", b"####", b"\n", b"  - ", b"&a ", b"*a", b"!!", b"1-999999999", b"-1", b"1e999",
                  b"null", b"\xff\xfe", b"\x00", b"../", b'"matrix": {"a": "1-9"},', b"<<: "]
        codes = []
        for seed in range(number("VDBSYNTH_MUTATIONS", 40)):
            draw = random.Random(seed)
            content, name = bytearray(seeds[seed % 2]), ("m.json", "m.yaml")[seed % 2]
            for _ in range(draw.choice([1, 2, 8])):
                at = draw.randrange(len(content))
                kind = draw.randrange(4)
                if kind == 0:
                    content[at:at + draw.choice([1, 1, 5, 40])] = b""
                elif kind == 1:
                    content[at:at] = draw.choice(pieces)
                elif kind == 2:
                    content[at:at + 1] = bytes([draw.randrange(256)])
                else:
                    content[at:at] = content[at:at + draw.choice([5, 40, 200])]
            self.write(name, bytes(content))
            result = subprocess.run([PROGRAM, "batch", name, "--dry-run"], cwd=self.folder, capture_output=True, timeout=60)
            said = result.stderr.decode(errors="replace")
            codes.append(result.returncode)
            with self.subTest(seed=seed):
                self.assertIn(result.returncode, (0, 2, 3), said)
                self.assertEqual(len([line for line in said.splitlines() if "error:" in line]), 1 if result.returncode else 0, said)
        self.assertEqual([name for name in self.files() if name not in self.sources], ["m.json", "m.yaml"])
        print(f"mutated job files: {dict((c, codes.count(c)) for c in sorted(set(codes)))}", flush=True)


if __name__ == "__main__":
    unittest.main()
