"""Many commands from one file: what is checked before, what is run again, and what a kill leaves."""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

from support import PROGRAM, SOURCE, CliTest

MAKE = {"name": "ball", "command": "make", "inputs": "balls", "output": "ball.vdb", "options": {"resolution": 32}}


class BatchTest(CliTest):
    def jobs(self, *jobs, name="j.json", **more):
        return self.write(name, json.dumps({"jobs": jobs, **more}))

    def batch(self, *words, **options):
        return self.run_tool("batch", "j.json", *words, **options)

    def refused(self, says, *jobs, code=2, **more):
        self.jobs(*jobs, **more)
        result = self.fails(code, says, "batch", "j.json")
        self.assertEqual(self.files(), ["j.json"])
        return result

    def report(self):
        return json.loads(self.read("r.json"))["counts"]

    def states(self):
        return {job["name"]: job["state"] for job in self.report()["jobs"]}

    def run_and_states(self, *words):
        result = self.batch("--report", "r.json", *words)
        return result, self.states()

    def temporaries(self):
        return [str(p) for p in pathlib.Path(self.folder).rglob("*.tmp")]


class Plans(BatchTest):
    def test_smallest_form(self):
        self.ok("make", "grid", "grid.vdb", "--resolution", 24)
        self.jobs({"name": "more", "command": "synth", "inputs": ["grid.vdb"], "output": "more.vdb", "options": {"size": "2x,1x,1x"}})
        self.ok("batch", "j.json")
        self.ok("synth", "grid.vdb", "-o", "one.vdb", "--size", "2x,1x,1x")
        self.assertEqual(self.read("more.vdb"), self.read("one.vdb"))

    def test_the_example_in_both_languages(self):
        for name in ("batch.json", "batch.yaml"):
            shutil.copy(SOURCE / "docs/examples" / name, self.path(name))
        plans = [json.loads(self.ok("batch", name, "--dry-run", "--json").stdout) for name in ("batch.json", "batch.yaml")]
        self.assertEqual(plans[0], plans[1])
        self.assertEqual([job["name"] for job in plans[0]["jobs"]],
                         ["exemplar-balls", "exemplar-grid", "more-balls-1", "more-balls-2", "more-grid-1", "more-grid-2", "mesh-balls",
                          "mesh-grid", "print"])
        self.assertEqual(self.files(), ["batch.json", "batch.yaml"])  # a dry run makes nothing
        said = self.ok("batch", "batch.json", "--jobs", 2).stderr
        self.assertIn("9 done", said)
        self.assertEqual(sorted(os.listdir(self.path("results"))),
                         ["balls-1.vdb", "balls-2.vdb", "balls.json", "balls.ply", "grid-1.vdb", "grid-2.vdb", "grid.ply"])
        self.assertEqual(self.temporaries(), [])
        self.assertIn("9 up to date", self.ok("batch", "batch.json").stderr)

    def test_dry_run_as_text(self):
        self.jobs(MAKE, {"name": "ask", "command": "info", "inputs": "ball.vdb", "output": "an answer.json"})
        self.assertEqual(self.ok("batch", "j.json", "--dry-run").stdout,
                         "ball: vdb_synth make balls ball.vdb --resolution=32\n"
                         "ask: vdb_synth info ball.vdb '--output=an answer.json'  # after ball\n")

    def test_frames_depend_on_frames(self):
        self.jobs({"name": "sim", "command": "make", "inputs": "balls", "output": "sim.####.vdb", "frames": "8-10",
                   "options": {"resolution": 24, "seed": "${frame}"}},
                  {"name": "mesh", "command": "convert", "inputs": "sim.####.vdb", "output": "m.####.ply", "frames": "8-10"},
                  {"name": "all", "command": "compare", "inputs": ["sim.*.vdb"], "output": "all.json"},
                  {"name": "at-once", "command": "convert", "inputs": "sim.####.vdb", "output": "w.%02d.ply", "options": {"frames": "8,10"}})
        plan = {job["name"]: job for job in json.loads(self.ok("batch", "j.json", "--dry-run", "--json").stdout)["jobs"]}
        self.assertEqual(plan["mesh.0009"]["after"], ["sim.0009"])
        self.assertEqual(plan["all"]["words"][1:4], ["sim.0008.vdb", "sim.0009.vdb", "sim.0010.vdb"])
        self.assertEqual(plan["at-once"]["after"], ["sim.0008", "sim.0010"])
        self.ok("batch", "j.json")
        self.assertTrue({"m.0008.ply", "m.0010.ply", "w.08.ply", "w.10.ply", "all.json"} <= set(self.files()))
        self.assertIn("8 up to date", self.ok("batch", "j.json").stderr)

    def test_a_matrix_over_files(self):
        for seed in (1, 2):
            self.ok("make", "balls", f"in{seed}.vdb", "--resolution", 24, "--seed", seed)
        job = {"name": "mesh", "command": "convert", "inputs": "${model}", "output": "out/${model.stem}.${kind}",
               "matrix": {"model": "in*.vdb", "kind": ["ply", "obj"]}}
        self.jobs(job)
        self.ok("batch", "j.json")
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["in1.obj", "in1.ply", "in2.obj", "in2.ply"])
        self.jobs({**job, "output": "in-${model.stem}-${kind}.vdb"})
        self.fails(2, "write outputs to another folder", "batch", "j.json")

    def test_variables(self):
        self.jobs({**MAKE, "options": {"resolution": "${size}", "seed": "${n}"}, "output": "${name}.vdb"},
                  variables={"size": 24, "n": 3, "name": "b${size}-$${x}"})
        self.assertIn("'b24-${x}.vdb'", self.ok("batch", "j.json", "--dry-run").stdout)
        self.assertIn("--resolution=48", self.ok("batch", "j.json", "--dry-run", "--set", "size=48").stdout)
        self.fails(2, 'did you mean "size"?', "batch", "j.json", "--set", "sise=48")
        self.fails(2, "must be NAME=VALUE", "batch", "j.json", "--set", "48")

    def test_schema(self):
        schema = json.loads(self.ok("batch", "--schema").stdout)
        self.assertEqual(schema["definitions"]["synth"]["properties"]["size"]["anyOf"][1], {"type": "null"})
        self.assertNotIn("batch", schema["definitions"])
        self.assertEqual(self.files(), [])
        try:
            import jsonschema
        except ImportError:
            self.skipTest("python3-jsonschema is absent")
        jsonschema.validate(json.loads((SOURCE / "docs/examples/batch.json").read_text()), schema)


class Refusals(BatchTest):
    """Before any job runs."""

    def test_keys(self):
        self.refused('"comand": unknown key; did you mean "command"?', {"name": "a", "comand": "make"})
        self.refused('"job": unknown key; did you mean "jobs"?', MAKE, job=[])
        self.refused("resolutoin: unknown option of make; did you mean resolution?", {**MAKE, "options": {"resolutoin": 3}})
        self.refused('"synht": unknown key; did you mean "synth"?', MAKE, defaults={"synht": {}})
        self.refused('"name": missing', {"command": "make"})
        self.refused('did you mean "make"', {**MAKE, "command": "mkae"})
        self.refused("batch: unknown command", {**MAKE, "command": "batch"})
        self.refused('"jobs": must be a list', name="j.json")
        self.refused('"report": no option of a job', {**MAKE, "options": {"report": "r.json"}})

    def test_values(self):
        self.refused("job ball: --resolution 3: must be a whole number from 16 to 4096", {**MAKE, "options": {"resolution": 3}})
        self.refused("${sed}: unknown variable; did you mean ${seed}?", {**MAKE, "output": "${sed}.vdb"}, variables={"seed": 1})
        self.refused("unknown extension", {**MAKE, "command": "convert", "inputs": "j.json", "output": "a.xyy"})
        self.refused("must be true or false", {**MAKE, "options": {"force": "perhaps"}})
        self.refused("must have one value", {**MAKE, "options": {"seed": [1, 2]}})
        self.refused("must be numbers of frames", {**MAKE, "frames": "a"})
        self.refused("add --frames", {**MAKE, "output": "b.####.vdb"})
        self.refused("must be at most 200 letters", {**MAKE, "name": "two words"})
        self.refused("no standard streams", {**MAKE, "output": "-.vdb"})

    def test_dependencies(self):
        info = {"name": "a", "command": "info", "inputs": "bal.vdb"}
        self.refused("bal.vdb: does not exist, and no job writes it; did you mean ball.vdb?", MAKE, info, code=3)
        self.refused('"after": bal: no job has this name; did you mean ball?', MAKE, {**info, "inputs": "ball.vdb", "after": "bal"})
        self.refused("matches no file", {**info, "inputs": "*.ply"})
        self.refused("two jobs have this name", MAKE, MAKE)
        self.refused("job ball writes it too", MAKE, {**MAKE, "name": "b"})
        self.refused("would replace its own input", {"name": "a", "command": "convert", "inputs": "x.vdb", "output": "./x.vdb"})
        turn = [{"name": n, "command": "convert", "inputs": f"{i}.vdb", "output": f"{o}.vdb"} for n, i, o in (("a", 1, 2), ("b", 2, 3), ("c", 3, 1))]
        self.refused("in a circle: ", *turn)

    def test_files(self):
        self.write("j.json", '{"jobs": [\n  {"name": "a",}]}')
        self.fails(3, "line 2, column", "batch", "j.json")
        self.write("j.json", '{"jobs": [], "jobs": []}')
        self.fails(3, "stands twice", "batch", "j.json")
        self.write("j.yaml", "jobs:\n  - {name: a\n")
        self.fails(3, "no valid YAML: at line", "batch", "j.yaml")
        self.write("j.yaml", "a: &a [x,x,x,x,x,x,x,x,x,x]\n" + "".join(
            f"{n}: &{n} [{','.join(['*' + p] * 10)}]\n" for p, n in zip("abcdefg", "bcdefgh")))
        self.fails(3, "a million values", "batch", "j.yaml")
        self.write("deep.yaml", "[" * 5000)
        self.fails(3, "deep.yaml", "batch", "deep.yaml")
        self.write("deep.json", "[" * 100000)
        self.fails(3, "nested too deeply", "batch", "deep.json")
        self.fails(3, "missing.json", "batch", "missing.json")
        self.fails(2, "standard input", "batch", "-", input="{}")
        self.assertEqual(self.run_tool("batch", "-.json", input="{}").returncode, 2)

    def test_words(self):
        self.jobs(MAKE)
        self.fails(2, "give one of them", "batch", "j.json", "--keep-going", "--fail-fast")
        self.fails(2, "is more than the batch may use, 64M", "batch", self.jobs({**MAKE, "options": {"max-memory": "1G"}}), "--max-memory", "64M")
        self.fails(2, "--json: needs --dry-run", "batch", "j.json", "--json")
        self.fails(2, "--pictures: needs --page", "batch", "j.json", "--pictures")


class Runs(BatchTest):
    def tree(self):
        """Two exemplars, more of each, meshes of these."""
        seeds = [{"name": f"more{s}", "command": "synth", "inputs": "ball.vdb", "output": f"more{s}.vdb",
                  "options": {"size": "2x,2x,1x", "seed": s}} for s in (1, 2, 3)]
        return [MAKE, *seeds, {"name": "mesh", "command": "convert", "inputs": "more1.vdb", "output": "mesh.ply"}]

    def test_restart_runs_only_what_changed(self):
        jobs = self.tree()
        self.jobs(*jobs)
        self.ok("batch", "j.json", "--jobs", 2)
        before = {name: os.stat(self.path(name)).st_mtime_ns for name in self.files() if name.endswith(("vdb", "ply"))}
        jobs[2]["options"]["seed"] = 9
        self.jobs(*jobs)
        _, states = self.run_and_states()
        self.assertEqual([n for n, s in states.items() if s == "done"], ["more2"])
        after = {name: os.stat(self.path(name)).st_mtime_ns for name in before}
        self.assertEqual([n for n in before if before[n] != after[n]], ["more2.vdb"])
        # A lost output, a changed output, a changed number of threads.
        os.remove(self.path("mesh.ply"))
        self.write("more3.vdb", "damaged")
        _, states = self.run_and_states("--threads", 1)
        self.assertEqual([n for n, s in states.items() if s == "done"], ["more3", "mesh"])
        self.write("j.logs/manifest.json", "{")
        result, states = self.run_and_states()
        self.assertIn("is damaged", result.stderr)
        self.assertEqual(set(states.values()), {"done"})
        self.assertEqual(set(self.run_and_states()[1].values()), {"up to date"})

    def test_what_a_model_refers_to(self):
        self.write("m.mtl", "newmtl a\nKd 1 0 0\n")
        self.write("m.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        self.jobs({"name": "a", "command": "convert", "inputs": "m.obj", "output": "a.vdb", "options": {"resolution": 24}})
        self.ok("batch", "j.json")
        self.assertEqual(self.run_and_states()[1], {"a": "up to date"})
        self.write("m.mtl", "newmtl a\nKd 0 1 0\n")
        self.assertEqual(self.run_and_states()[1], {"a": "done"})

    def test_a_failing_job(self):
        self.write("bad.off", "OFF\n1 1 0\n0 0")
        bad = {"name": "bad", "command": "convert", "inputs": "bad.off", "output": "bad.vdb"}
        needs = {"name": "needs", "command": "info", "inputs": "bad.vdb"}
        more = {"name": "needs-too", "command": "info", "inputs": "ball.vdb", "after": "needs"}
        self.jobs(bad, needs, more, MAKE)
        result, states = self.run_and_states()
        self.assertEqual(result.returncode, 1)
        self.assertEqual(states, {"bad": "failed", "needs": "blocked", "needs-too": "blocked", "ball": "done"})
        self.assertIn("bad: failed: bad.off", result.stderr)
        self.assertIn("needs: not run: it needs bad, which was not done", result.stderr)
        self.assertEqual(len([l for l in result.stderr.splitlines() if "error:" in l]), 1)
        self.assertIn("1 failed, 2 blocked; first bad: bad.off", result.stderr)
        self.assertIn("bad.off", self.read("j.logs/bad.log").decode())
        self.assertEqual(json.loads(self.read("j.logs/ball.report.json"))["command"], "make")
        # Mended, the same command does the rest.
        self.ok("make", "balls", "bad.off", "--resolution", 24)
        self.assertEqual(self.run_and_states("-q")[1], {"bad": "done", "needs": "done", "needs-too": "done", "ball": "up to date"})

    def test_fail_fast(self):
        self.write("bad.off", "OFF\n1 1 0\n0 0")
        self.jobs({"name": "bad", "command": "convert", "inputs": "bad.off", "output": "bad.vdb"}, MAKE)
        result, states = self.run_and_states("--fail-fast")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(states, {"bad": "failed", "ball": "stopped"})

    def test_shares(self):
        self.jobs(MAKE, {**MAKE, "name": "own", "output": "own.vdb", "options": {"threads": 3, "max-memory": "300M"}})
        self.ok("batch", "j.json", "--jobs", 2, "--threads", 4, "--max-memory", "2G")
        options = [json.loads(self.read(f"j.logs/{name}.report.json"))["options"] for name in ("ball", "own")]
        self.assertEqual([(o["threads"], o["max-memory"]) for o in options], [("2", "1000000000"), ("3", "300M")])

    def test_a_job_waits_for_memory(self):
        for memory, waits in (("700M", True), ("300M", False)):
            with self.subTest(memory):
                self.jobs(*[{**MAKE, "name": n, "output": n + memory + ".vdb", "options": {"resolution": 96, "quiet": True, "max-memory": memory}}
                            for n in "ab"])
                self.ok("batch", "j.json", "--jobs", 2, "--max-memory", "1G")
                # A quiet job's log is written once, when it starts.
                began, ended = (os.stat(self.path(name)).st_mtime_ns for name in ("j.logs/b.log", f"a{memory}.vdb"))
                self.assertEqual(began > ended, waits)

    def test_a_share_that_does_not_suffice(self):
        self.jobs({**MAKE, "options": {"resolution": 128}},
                  {"name": "more", "command": "mask", "inputs": "ball", "output": "m.vdb",
                   "options": {"center": "0,0,0", "radius": 250, "voxel-size": 1}})
        result, states = self.run_and_states("--jobs", 64, "--max-memory", "4G")
        self.assertIn("runs again with all", result.stderr)
        self.assertEqual(states, {"ball": "done", "more": "done"}, result.stderr)

    def test_the_page(self):
        self.write("bad.off", "OFF\n1 1 0\n0 0")
        self.jobs(MAKE, {"name": "bad", "command": "convert", "inputs": "bad.off", "output": "<b>.vdb"})
        self.batch("--page", "p.html", "--pictures")
        page = self.read("p.html").decode()
        self.assertIn("data:image/png;base64,iVBOR", page)
        self.assertIn("1 done, 1 failed", page)
        self.assertIn("bad.off", page)
        self.assertNotIn("refresh", page)
        self.assertNotIn("<b>", page)
        self.assertTrue(self.read("j.logs/ball.0.png").startswith(b"\x89PNG"))
        self.assertFalse([name for name in os.listdir(self.path("j.logs")) if "picture" in name])
        self.batch("--page", "p.html", "--pictures")
        self.assertIn("1 up to date, 1 failed", self.read("p.html").decode())
        self.assertIn("data:image/png;base64,iVBOR", self.read("p.html").decode())
        self.fails(3, "no/p.html", "batch", "j.json", "--page", "no/p.html")


class Kills(BatchTest):
    def setUp(self):
        super().setUp()
        seeds = [{"name": f"more{s}", "command": "synth", "inputs": "ball.vdb", "output": [f"more{s}.vdb", f"more{s}.ply"],
                  "options": {"size": "3x,3x,1x", "seed": s}} for s in (1, 2, 3)]
        self.jobs(MAKE, *seeds)
        self.ok("batch", "j.json")
        self.whole = self.results()
        self.clean()

    def results(self):
        return {name: self.read(name) for name in self.files() if name.endswith((".vdb", ".ply"))}

    def clean(self):
        shutil.rmtree(self.path("j.logs"))
        for name in self.results():
            os.remove(self.path(name))

    def start(self, *words, **options):
        return subprocess.Popen([PROGRAM, "batch", "j.json", "--jobs", "2", *words], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **options)

    def started(self, process, name):
        """Waits for a job's log: the batch is at work."""
        end = time.monotonic() + 60
        while not os.path.exists(self.path(f"j.logs/{name}.log")) and time.monotonic() < end:
            time.sleep(0.01)
        self.assertIsNone(process.poll())

    def finish(self):
        """The same command again ends with the files of an undisturbed run."""
        self.ok("batch", "j.json", "--jobs", 2)
        self.assertEqual(self.results(), self.whole)
        self.assertEqual(self.temporaries(), [])

    def test_a_killed_batch_continues(self):
        draw = random.Random(3)
        for kill in range(12):
            process = self.start(start_new_session=True)
            time.sleep(draw.uniform(0.0, 2.0))
            if kill % 2:
                os.killpg(process.pid, signal.SIGKILL)  # with all jobs, as a machine that goes down
            else:
                process.kill()
            process.communicate()
            for name, content in self.results().items():
                self.assertEqual(content, self.whole[name])
            self.finish()
            self.clean()

    def test_a_killed_job(self):
        for parent in (True, False):
            process = self.start()
            job = ""
            while not job and process.poll() is None:
                names = subprocess.run(["pgrep", "-P", str(process.pid), "-f", "synth.*more"], capture_output=True, text=True).stdout.split()
                job = names[0] if names else ""
                time.sleep(0.01)
            time.sleep(0.3)
            if not parent:
                job = (subprocess.run(["pgrep", "-P", job], capture_output=True, text=True).stdout.split() or [job])[0]
            os.kill(int(job), signal.SIGKILL)
            _, words = process.communicate(timeout=100)
            self.assertIn(process.returncode, (0, 1), words)
            if process.returncode == 1:
                self.assertIn("1 failed", words)
                self.assertIn("killed", words)
            self.assertEqual(self.temporaries(), [])
            self.finish()
            self.clean()

    def stopped(self, number, code, send):
        process = self.start("--page", "p.html", start_new_session=True)
        self.started(process, "more1")
        time.sleep(0.2)
        send(process.pid, number)
        _, words = process.communicate(timeout=60)
        self.assertEqual(process.returncode, code, words)
        self.assertEqual(len([l for l in words.splitlines() if "error:" in l]), 1, words)
        self.assertIn("interrupted", words)
        self.assertEqual(self.temporaries(), [])
        self.assertIn("stopped", self.read("p.html").decode())
        os.remove(self.path("p.html"))
        self.finish()

    def test_interrupt(self):
        self.stopped(signal.SIGINT, 130, os.killpg)  # a terminal sends it to the jobs too

    def test_terminate(self):
        self.stopped(signal.SIGTERM, 143, os.kill)

    def test_two_files_that_write_one_output(self):
        first = {"name": "more", "command": "synth", "inputs": "ball.vdb", "output": "more1.vdb", "options": {"size": "4x,4x,1x", "seed": 1}}
        self.ok("make", "balls", "ball.vdb", "--resolution", 32)
        self.jobs(first)
        self.jobs({**first, "options": {"size": "2x,2x,1x"}}, {**MAKE, "name": "beside", "output": "beside.vdb"}, name="k.json")
        process = self.start()
        self.started(process, "more")
        result = self.run_tool("batch", "k.json")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("more: failed: more1.vdb: another batch writes it now", result.stderr)
        self.assertIn("1 done, 1 failed", result.stderr)
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0)
        whole = self.read("more1.vdb")
        self.assertEqual(self.temporaries(), [])
        # One after the other, each makes its own.
        self.assertIn("1 done, 1 up to date", self.ok("batch", "k.json").stderr)
        self.assertNotEqual(self.read("more1.vdb"), whole)
        self.ok("batch", "j.json")
        self.assertEqual(self.read("more1.vdb"), whole)

    def test_two_at_once(self):
        process = self.start()
        self.started(process, "ball")
        result = self.run_tool("batch", "j.json")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("another batch runs here", result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1)
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0)
        self.finish()


if __name__ == "__main__":
    unittest.main()
