"""Batches on a real Slurm: arrays, failures, cancelling, jobs put back into the queue, batches that are interrupted and continued."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

import slurm_cluster
from support import PROGRAM, CliTest

MAKE = {"name": "ball", "command": "make", "inputs": "balls", "output": "ball.vdb", "options": {"resolution": 32}}
# Some seconds of work.
LONG = {"name": "long", "command": "synth", "inputs": "ball.vdb", "output": ["long.vdb", "long.ply"], "options": {"size": "5x,5x,1x", "seed": 1}}
LOCAL = {}  # results by job file


class SlurmTest(CliTest):
    environment = None

    def jobs(self, *jobs):
        self.write("j.json", json.dumps({"jobs": jobs}))

    def start(self, *words, executor="slurm"):
        return subprocess.Popen([PROGRAM, "batch", "j.json", "--executor", executor, "--report", "r.json", *map(str, words)], cwd=self.folder,
                                env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0)

    def batch(self, *words, executor="slurm"):
        """Exit code, state of each job by name, and what was said."""
        process = self.start(*words, executor=executor)
        try:
            _, said = process.communicate(timeout=200)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        self.said = said
        states = {}
        if os.path.exists(self.path("r.json")):
            states = {job["name"]: job["state"] for job in json.loads(self.read("r.json"))["counts"]["jobs"]}
            os.remove(self.path("r.json"))
        return process.returncode, states

    def until(self, met, what, seconds=60):
        end = time.monotonic() + seconds
        while not met():
            self.assertLess(time.monotonic(), end, f"waited for {what}")
            time.sleep(0.05)

    def said_until(self, process, text):
        """What a batch says up to and with a text."""
        said = ""
        while text not in said:
            line = process.stderr.readline()
            self.assertTrue(line, said)
            said += line
        return said

    def results(self):
        return {str(p.relative_to(self.folder)): p.read_bytes() for p in sorted(pathlib.Path(self.folder).rglob("*"))
                if p.suffix in (".vdb", ".ply")}

    def clean(self):
        shutil.rmtree(self.path("j.logs"), ignore_errors=True)
        for name in self.results():
            os.remove(self.path(name))

    def local_results(self):
        """What the same jobs make on this machine; all is removed again."""
        jobs = self.read("j.json")
        if jobs not in LOCAL:
            self.assertEqual(self.batch(executor="local")[0], 0, self.said)
            LOCAL[jobs] = self.results()
            self.clean()
        return LOCAL[jobs]

    def assert_nothing_left(self):
        self.assertFalse(os.path.exists(self.path("j.logs/slurm.json")))
        self.assertEqual([str(p) for p in pathlib.Path(self.folder).rglob("*.tmp")], [])
        self.assertEqual([p.name for p in pathlib.Path(self.path("j.logs")).glob("slurm/*") if p.suffix != ".out"], [])


class Refusals(SlurmTest):
    """No cluster is needed."""

    def test_no_slurm(self):
        self.jobs(MAKE)
        self.fails(3, "sbatch: is no command of this machine", "batch", "j.json", "--executor", "slurm", env={"PATH": self.folder})
        self.assertEqual(self.files(), ["j.json"])

    def test_a_controller_that_does_not_answer(self):
        self.jobs(MAKE)
        for name in ("sbatch", "squeue", "scancel"):
            self.write(name, f"#!/bin/sh\necho '{name}: error: Unable to contact slurm controller' >&2\nexit 1\n")
            os.chmod(self.path(name), 0o755)
        env = {"PATH": self.folder + ":/usr/bin:/bin"}
        self.fails(1, "sbatch: error: Unable to contact slurm controller", "batch", "j.json", "--executor", "slurm", env=env)
        # Whether the array is in the queue is unknown.
        self.fails(3, "squeue: does not answer", "batch", "j.json", "--executor", "slurm", env=env)
        self.fails(3, "handed to Slurm and not followed to their end", "batch", "j.json")
        self.write("squeue", "#!/bin/sh\nexit 0\n")
        self.fails(1, "Unable to contact", "batch", "j.json", "--executor", "slurm", env=env)
        self.assertFalse(os.path.exists(self.path("j.logs/slurm.json")))
        self.ok("batch", "j.json")

    def test_words(self):
        self.jobs(MAKE)
        self.fails(2, "--slurm-time: needs --executor slurm", "batch", "j.json", "--slurm-time", "5")
        self.fails(2, "--array=1: batch sets this itself", "batch", "j.json", "--executor", "slurm", "--slurm-arguments=--array=1")
        self.fails(2, "a quote has no end", "batch", "j.json", "--executor", "slurm", "--slurm-arguments=--comment='a b")
        self.fails(2, "--executor", "batch", "j.json", "--executor", "slrum")
        self.fails(3, "is no file of tasks", "batch", "j.json", "--task", "1")
        self.assertEqual(self.files(), ["j.json"])


class Cluster(SlurmTest):
    @classmethod
    def setUpClass(cls):
        reason = slurm_cluster.missing()
        if reason:
            raise unittest.SkipTest(reason)
        cls.cluster = slurm_cluster.Cluster()
        cls.environment = cls.cluster.environment

    @classmethod
    def tearDownClass(cls):
        cls.cluster.stop()

    def tearDown(self):
        self.cluster.run("scancel", "--user=root")
        self.until(lambda: not self.cluster.queue(), "an empty queue")
        super().tearDown()

    def running(self, name):
        """The id of a running task of an entry."""
        return next((id for id, state, job in self.cluster.queue() if state == "RUNNING" and job.startswith(name + "-")), None)

    @staticmethod
    def words_of(process):
        try:
            return (process / "cmdline").read_bytes().split(b"\0")
        except OSError:
            return []

    def arrays(self):
        """Names of all arrays that Slurm has seen in this folder's batches."""
        text = self.cluster.run("squeue", "-h", "--states=all", "-o", "%j %Z").stdout
        return {line.split()[0] for line in text.splitlines() if line.split()[1] == self.folder}


class Runs(Cluster):
    def test_a_plan_becomes_arrays(self):
        more = {"name": "more-${s}", "command": "synth", "inputs": "ball.vdb", "output": "more${s}.vdb",
                "options": {"size": "2x,2x,1x", "seed": "${s}"}, "matrix": {"s": "1-3"}}
        mesh = {"name": "mesh-${s}", "command": "convert", "inputs": "more${s}.vdb", "output": "out/mesh${s}.ply", "matrix": {"s": "1-3"}}
        good = [MAKE, more, mesh]
        self.jobs(*good)
        expected = self.local_results()
        self.write("bad.off", "OFF\n1 1 0\n0 0")
        bad = [{"name": "bad", "command": "convert", "inputs": "bad.off", "output": "bad.vdb"},
               {"name": "needs", "command": "info", "inputs": "bad.vdb"},
               {"name": "needs-too", "command": "info", "inputs": "ball.vdb", "after": "needs"}]
        self.jobs(*good, *bad)
        code, states = self.batch("-v", "--page", "p.html", "--threads", 2, "--max-memory", "1G", "--slurm-time", "10",
                                  "--slurm-partition", "work", "--slurm-arguments=--comment='two words'")
        done = {name: "done" for name in ("ball", "more-1", "more-2", "more-3", "mesh-1", "mesh-2", "mesh-3")}
        self.assertEqual(states, {**done, "bad": "failed", "needs": "blocked", "needs-too": "blocked"}, self.said)
        self.assertEqual(code, 1)
        self.assertIn("7 done, 1 failed, 2 blocked; first bad: bad.off:3: the file ends", self.said)
        self.assertIn("more-${s}: 3 jobs in array", self.said)
        self.assertIn("mesh-${s}: 3 jobs in array", self.said)
        self.assertEqual(len([line for line in self.said.splitlines() if "error:" in line]), 1)
        self.assertEqual(self.results(), expected)
        self.assert_nothing_left()
        self.assertIn("7 done, 1 failed, 2 blocked", self.read("p.html").decode())
        report = json.loads(self.read("j.logs/more-2.report.json"))
        self.assertEqual(report["options"]["threads"], "2")
        self.assertLess(int(report["options"]["max-memory"]), 1e9)
        self.assertIn("$ vdb_synth synth", self.read("j.logs/more-2.log").decode())
        # Asked for: two cores, 953 MiB, and what was given.
        seen = self.cluster.run("squeue", "-h", "--states=all", "-o", "%j %c %m %l %k").stdout
        self.assertRegex(seen, r"(?m)^ball-[0-9a-f]{8}-\d+ 2 953M 10:00 two words$")
        # The same command again: only what failed; a figure of memory is known now.
        before = self.arrays()
        code, states = self.batch()
        self.assertEqual(states["mesh-3"], "up to date")
        self.assertEqual(code, 1)
        self.assertEqual(sorted(name.split("-")[0] for name in self.arrays() - before), ["bad", "needs", "needs"])
        # Mended, and on this machine.
        self.ok("make", "balls", "bad.off", "--resolution", 24)
        code, states = self.batch(executor="local")
        self.assertEqual((code, states["bad"], states["mesh-1"]), (0, "done", "up to date"), self.said)
        os.remove(self.path("out/mesh1.ply"))
        code, states = self.batch()
        self.assertEqual((code, states["mesh-1"], states["mesh-2"]), (0, "done", "up to date"), self.said)
        self.assertEqual({name: content for name, content in self.results().items() if name in expected}, expected)

    def test_memory_that_does_not_suffice(self):
        mask = {"name": "mask", "command": "mask", "inputs": "ball", "output": "m.vdb",
                "options": {"center": "0,0,0", "radius": 250, "voxel-size": 1}}
        self.jobs(mask, {"name": "ask", "command": "info", "inputs": "m.vdb"})
        code, states = self.batch("--max-memory", "64M")
        self.assertIn("mask: its share of memory did not suffice; it runs again with all", self.said)
        self.assertEqual((code, states), (0, {"mask": "done", "ask": "done"}), self.said)
        self.assert_nothing_left()

    def test_a_queue_that_is_full(self):
        # The second array is refused at first.
        self.write("sbatch", "#!/bin/sh\necho >>calls\n[ $(wc -l <calls) = 2 ] && { echo 'sbatch: error: QOSMaxSubmitJobPerUserLimit' >&2; exit 1; }\n"
                             f"exec {shutil.which('sbatch')} \"$@\"\n")
        os.chmod(self.path("sbatch"), 0o755)
        self.jobs(MAKE, {**MAKE, "name": "other", "output": "other.vdb"}, {"name": "ask", "command": "info", "inputs": "other.vdb"})
        self.environment = dict(self.environment, PATH=self.folder + ":" + self.environment["PATH"])
        code, states = self.batch()
        self.assertIn("QOSMaxSubmitJobPerUserLimit; jobs that wait for this are handed over later", self.said)
        self.assertEqual((code, set(states.values())), (0, {"done"}), self.said)
        self.assert_nothing_left()

    def test_fail_fast(self):
        self.write("bad.off", "OFF\n1 1 0\n0 0")
        self.jobs({"name": "bad", "command": "convert", "inputs": "bad.off", "output": "bad.vdb"},
                  {**MAKE, "name": "ball${s}", "output": "ball${s}.vdb", "options": {"resolution": 128, "seed": "${s}"}, "matrix": {"s": "1-9"}})
        code, states = self.batch("--fail-fast", "--jobs", 1)
        self.assertEqual((code, states["bad"]), (1, "failed"), self.said)
        self.assertEqual(set(states.values()) - {"failed", "done"}, {"stopped"}, self.said)
        self.assert_nothing_left()
        self.assertEqual(self.cluster.queue(), [])

    def test_a_cancelled_job(self):
        self.jobs(MAKE, LONG, {"name": "after", "command": "info", "inputs": "long.vdb"})
        process = self.start()
        self.until(lambda: self.running("long"), "a long job")
        self.cluster.run("scancel", self.running("long"))
        _, said = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("long: failed: cancelled in Slurm", said)
        self.assertIn("1 done, 1 failed, 1 blocked", said)
        self.assert_nothing_left()

    def test_cancelled_while_nobody_follows(self):
        self.jobs(MAKE)
        process = self.start("--slurm-arguments=--hold")
        self.until(lambda: self.cluster.queue(), "a job")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        self.cluster.run("scancel", "--user=root")
        self.assertEqual(self.batch(), (0, {"ball": "done"}), self.said)
        self.assertIn("handed over again", self.said)
        self.assert_nothing_left()

    def test_a_changed_job_file(self):
        self.jobs(MAKE)
        process = self.start("--slurm-arguments=--hold")
        self.said_until(process, "ball: waits in Slurm's queue: JobHeldUser")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        self.jobs({**MAKE, "options": {"resolution": 24}})
        self.assertEqual(self.batch()[0], 2, self.said)
        self.assertIn("was changed after jobs of it were handed to Slurm; end those first: scancel", self.said)
        self.cluster.run("scancel", self.said.split("scancel ")[1].split()[0])
        self.assertEqual(self.batch()[1], {"ball": "done"}, self.said)
        self.assert_nothing_left()


class Kills(Cluster):
    def test_jobs_killed_and_put_back_into_the_queue(self):
        """One by an administrator, one as its node fails."""
        self.jobs(MAKE, {**LONG, "name": "long-${s}", "output": ["long${s}.vdb", "long${s}.ply"], "options": {"size": "5x,5x,1x", "seed": "${s}"},
                         "matrix": {"s": "1-2"}})
        expected = self.local_results()
        process = self.start()
        self.until(lambda: all(os.path.exists(self.path(f"j.logs/long-{s}.log")) for s in (1, 2)), "long jobs")
        time.sleep(0.5)
        running = [id for id, state, job in self.cluster.queue() if state == "RUNNING" and job.startswith("long")]
        self.assertEqual(len(running), 2, "a long job is too short")
        node = self.cluster.run("squeue", "-h", "-o", "%N", "-j", running[1]).stdout.strip()
        self.cluster.run("scontrol", "requeue", running[0])
        self.cluster.run("scontrol", "update", f"NodeName={node}", "State=DOWN", "Reason=test")
        time.sleep(1)
        self.cluster.run("scontrol", "update", f"NodeName={node}", "State=RESUME")
        _, said = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0, said)
        self.assertEqual(self.results(), expected)
        self.assert_nothing_left()

    def test_a_job_that_the_kernel_kills(self):
        self.jobs(MAKE, LONG)
        expected = self.local_results()
        process = self.start()
        self.until(lambda: os.path.exists(self.path("j.logs/long.log")), "a long job")
        time.sleep(0.5)
        tasks = [int(p.name) for p in pathlib.Path("/proc").glob("[0-9]*")
                 if b"--task" in self.words_of(p) and any(self.folder.encode() in word for word in self.words_of(p))]
        self.assertEqual(len(tasks), 1)
        os.kill(tasks[0], signal.SIGKILL)
        _, said = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("long: failed: ended without a result; Slurm says FAILED", said)
        self.assert_nothing_left()
        self.assertEqual(self.batch()[1], {"ball": "up to date", "long": "done"})
        self.assertEqual(self.results(), expected)

    def test_interrupted_and_followed_from_elsewhere(self):
        self.jobs(MAKE, LONG, {**LONG, "name": "other", "output": "other.vdb", "options": {"size": "2x,2x,1x"}})
        expected = self.local_results()
        process = self.start()
        self.until(lambda: self.running("long"), "a long job")
        # Another one is refused while the first follows.
        self.assertEqual(self.batch()[0], 3)
        self.assertIn("another batch runs here", self.said)
        os.killpg(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("left in Slurm's queue: ", said)
        arrays = self.arrays()
        self.assertTrue(self.running("long"))
        # Elsewhere the jobs would be run twice.
        self.assertEqual(self.batch(executor="local")[0], 3)
        self.assertIn("were handed to Slurm", self.said)
        # A second one is killed, a third follows to the end.
        process = self.start()
        self.said_until(process, "handed to Slurm before")
        process.kill()
        process.communicate()
        code, states = self.batch()
        self.assertIn("handed to Slurm before", self.said)
        self.assertEqual(code, 0, self.said)
        self.assertEqual(set(states.values()) - {"done", "up to date"}, set())
        self.assertEqual(self.arrays(), arrays)
        self.assertEqual(self.results(), expected)
        self.assert_nothing_left()

    def test_interrupted_and_cancelled(self):
        self.jobs(MAKE, LONG, {"name": "after", "command": "info", "inputs": "long.vdb"})
        process = self.start("--on-interrupt", "cancel", "--page", "p.html")
        self.until(lambda: os.path.exists(self.path("j.logs/long.log")), "a long job")
        time.sleep(0.3)
        process.terminate()
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 143, said)
        self.assertIn("interrupted: 1 done, 2 stopped", said)
        self.assertEqual(self.cluster.queue(), [])
        self.assert_nothing_left()
        self.assertEqual([name for name in self.results()], ["ball.vdb"])

    def test_a_controller_that_restarts(self):
        self.jobs(MAKE, LONG)
        process = self.start()
        self.until(lambda: self.running("long"), "a long job")
        time.sleep(1)
        self.cluster.kill("slurmctld", signal.SIGTERM)
        time.sleep(2)
        self.cluster.start_controller(recover=True)
        _, said = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("2 done", said)
        self.assert_nothing_left()


if __name__ == "__main__":
    unittest.main()
