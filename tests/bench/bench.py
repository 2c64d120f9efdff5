#!/usr/bin/python3
"""Runs every benchmark: those of the command line here, those in the process by Google Benchmark. Prints a table of budget,
measured, rival and ratio, and the growth of time and memory with active voxels; writes both to bench.json.
Usage: bench.py BUILD_FOLDER [--quick] [ROW...]"""
import contextlib
import json
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = os.environ.get("VDBSYNTH_SAMPLES", str(SOURCE.parent / "shared" / "data"))


def measured(words, folder, timeout=900):
    """Seconds and peak bytes of a command; None if it fails or takes longer."""
    began = time.monotonic()
    process = subprocess.Popen([str(w) for w in words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    timer = None
    try:

        timer = threading.Timer(timeout, process.terminate)
        timer.start()
        error = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    finally:
        timer.cancel()
    if process.returncode != 0:
        print(f"  {' '.join(map(str, words))}: {error.decode(errors='replace').strip()[-200:]}", file=sys.stderr)
        return None
    return time.monotonic() - began, usage.ru_maxrss * 1024


class Failed(RuntimeError):
    """A command of a row did not work: the row is left out and the run fails in the end."""


class Bench:
    def __init__(self, build, quick, words):
        self.program = str(pathlib.Path(build).resolve() / "tools/vdb_synth/vdb_synth")
        self.match = str(pathlib.Path(build).resolve() / "tests/bench/block_match_bench")
        self.quick, self.words = quick, words
        self.folder = tempfile.mkdtemp(prefix="vdbsynth_bench_")
        self.rows, self.growth, self.failures = [], [], 0

    def wanted(self, name):
        return not self.words or any(word in name for word in self.words)

    def tool(self, *words, timeout=900):
        """Seconds of the work, peak bytes, and the report."""
        result = measured([self.program, *words, "-q", "--report", "report.json"], self.folder, timeout)
        if result is None:
            raise Failed(" ".join(map(str, words)))
        with open(os.path.join(self.folder, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
        return result[0], report["peak_bytes"], report

    def seconds(self, *words):
        """Median of five runs of a command."""
        runs = [measured(words, self.folder) for _ in range(5)]
        if None in runs:
            raise Failed(" ".join(map(str, words)))
        return statistics.median(run[0] for run in runs)

    @contextlib.contextmanager
    def attempt(self, name):
        """One row's failure does not end the others."""
        try:
            yield
        except (Failed, subprocess.CalledProcessError) as error:
            self.failures += 1
            print(f"{name:34} failed: {error}", flush=True)

    def row(self, name, budget, ours, rival, ratio, note=""):
        self.rows.append({"name": name, "budget": budget, "measured": ours, "rival": rival, "ratio": ratio, "note": note})
        print(f"{name:34} {budget:26} {ours:26} {rival:22} {ratio:8} {note}", flush=True)

    def grow(self, work, voxels, seconds, peak):
        self.growth.append({"work": work, "active_voxels": voxels, "seconds": seconds, "peak_bytes": peak})
        print(f"{work:34} {voxels:>12} active voxels {seconds:8.2f} s {peak / 1e6:8.0f} MB", flush=True)

    def block_match(self):
        for kind in ("balls_0.4", "balls_0.75", "balls_1", "balls_1.5", "sponge", "terrain"):
            for size in ("64/8", "128/16", "256/32"):
                name = f"match {kind} {size}"
                if not self.wanted(name):
                    continue
                with self.attempt(name):
                    self.block_match_row(name, kind, size)

    def block_match_row(self, name, kind, size):
        # A scan of 11 million positions takes minutes a query.
        large = size == "256/32"
        environment = {**os.environ, "VDBSYNTH_BENCH_QUERIES": "10" if large else "20" if self.quick else "200"}
        result = subprocess.run([self.match, f"--benchmark_filter=^(ours|near|fftw{'' if large else '|brute'}|faiss)/{kind}/{size}/", "--benchmark_format=json"],
                                env=environment, capture_output=True, text=True, check=True)
        found = {b["name"].split("/")[0]: b for b in json.loads(result.stdout)["benchmarks"]}
        ours, rival = found["ours"], found["fftw"]
        each = lambda b: b["real_time"] / b["queries"]
        radius = kind.startswith("balls_") and float(kind[6:]) >= 0.75
        budget = "3x" if radius and size == "128/16" else "5x" if radius and size == "256/32" else "at most 4x slower"
        near, faiss = found["near"], found["faiss"]
        if faiss.get("error_occurred"):
            side, block = map(int, size.split("/"))  # every block is a vector of its own
            others = f"Faiss would need {(side - block + 1) ** 3 * block ** 3 * 4 / 1e9:.0f} GB"
        else:
            others = f"Faiss {each(faiss):.0f} ms, {faiss['index_MB']:.0f} MB"
        self.row(name, f"{budget} of FFTW", f"{each(ours):.2f} ms a query", f"{each(rival):.2f} ms", f"{each(rival) / each(ours):.2f}x",
                 f"index {ours['build_seconds']:.1f} s, {ours['index_MB']:.0f} MB; costlier: {ours['dearer_than_rival']:.0f}; by FFT: {ours['transforms'] * 100:.0f} %; "
                 f"{'' if large else 'scan %.0f ms; ' % each(found['brute'])}{others}; "
                 f"tolerance 0.1: {each(near):.2f} ms, ratio {near['exactness_ratio']:.3f}, recall {near['recall']:.2f}")

    def synthesis(self):
        for kind in ("balls", "grid", "foam", "sponge"):
            name = f"synth {kind} 64^3 to 128^3"
            if not self.wanted(name):
                continue
            with self.attempt(name):
                self.tool("make", kind, "exemplar.vdb", "--resolution", 64)
                result = self.tool("synth", "exemplar.vdb", "-o", "more.vdb", "--size", "2x,2x,2x", "--block", 16, "--levels", 3)
                self.row(name, "3 s, 1 GB", f"{result[0]:.1f} s, {result[1] / 1e9:.2f} GB", "1 to 12 h (2004)", "",
                         "the paper's time, on its machine")
        name = "synth grid 64^3 to 512^3"
        if self.wanted(name) and not self.quick:
            with self.attempt(name):
                self.tool("make", "grid", "exemplar.vdb", "--resolution", 64)
                result = self.tool("synth", "exemplar.vdb", "-o", "more.vdb", "--size", "8x,8x,8x", timeout=1800)
                self.row(name, "180 s, 4 GB", f"{result[0]:.0f} s, {result[1] / 1e9:.2f} GB", "none", "")

    def analogy(self):
        name, path = "analogy grooves bunny 200", os.path.join(SAMPLES, "meshes", "bunny.off")
        if not self.wanted(name) or not os.path.exists(path):
            return
        with self.attempt(name):
            self.tool("make", "grooves", "A.vdb", "A2.vdb")
            result = self.tool("analogy", "A.vdb", "A2.vdb", path, "-o", "grooved.vdb", "--resolution", 200, "--direction", "axis:z")
            self.tool("convert", path, "-o", "bunny.vdb", "--resolution", 200)
            bench = subprocess.run([str(pathlib.Path(self.match).parent / "analogy_bench"), "bunny.vdb"], cwd=self.folder, capture_output=True,
                                   text=True, check=True)
            found = json.loads(bench.stdout)
            self.row(name, "30 s, 10x under FLANN", f"{result[0]:.1f} s, {result[1] / 1e9:.2f} GB", f"{found['flann_seconds']:.0f} s of queries",
                     f"{found['flann_seconds'] / result[0]:.1f}x",
                     f"synthesis alone {found['seconds']:.1f} s; a query {found['index_query_us']:.2f} us, FLANN's {found['flann_query_us']:.1f} us; "
                     f"feature distance over the exact one: index {found['distance_over_exact_index']:.3f}, FLANN {found['distance_over_exact_flann']:.3f}, "
                     f"copied {found['distance_over_exact_copied']:.3f}")

    def compare(self):
        for kind in ("balls", "sponge", "terrain"):
            name = f"compare {kind} 256^3"
            if not self.wanted(name):
                continue
            with self.attempt(name):
                for seed in (1, 2):
                    self.tool("make", kind, f"{seed}.vdb", "--resolution", 256, "--seed", seed)
                result = self.tool("compare", "1.vdb", "2.vdb")
                self.row(name, "20 s", f"{result[0]:.1f} s, {result[1] / 1e9:.2f} GB", "none", "", "both models, verdict included")

    def meshes(self):
        for file, resolution in (("bunny.off", 200), ("bunny.off", 500), ("dragon_vrip_res2.ply.gz", 300), ("fandisk.obj", 300)):
            name = f"convert {file} {resolution}"
            path = os.path.join(SAMPLES, "meshes", file)
            if self.wanted(name) and os.path.exists(path):
                with self.attempt(name):
                    self.mesh_row(name, path, resolution)

    def mesh_row(self, name, path, resolution):
        rival = shutil.which("vdb_tool")
        voxels = self.tool("convert", path, "-o", "at.vdb", "--resolution", resolution)[2]["counts"]["active_voxels"]
        info = json.loads(subprocess.run([self.program, "info", "at.vdb", "--json"], cwd=self.folder, capture_output=True, text=True,
                                         check=True).stdout)
        voxel = info["model"]["voxel_size"]
        # Both read the same .ply, as vertices and triangles.
        self.tool("convert", path, "-o", "high.vdb", "--resolution", 400)
        self.tool("convert", "high.vdb", "-o", "mesh.ply")
        ours = self.seconds(self.program, "convert", "mesh.ply", "-o", "ours.vdb", "--voxel-size", voxel, "-q")
        if rival:
            theirs = self.seconds(rival, "-read", "mesh.ply", "-mesh2ls", f"voxel={voxel}", "width=3", "-write", "t.vdb")
            self.row(name, "1.1x of vdb_tool's time", f"{ours:.2f} s", f"{theirs:.2f} s", f"{ours / theirs:.2f}x", f"{voxels} active voxels")
        else:
            self.row(name, "1.1x of vdb_tool's time", f"{ours:.2f} s", "not installed", "", f"{voxels} active voxels")

    def growth_curves(self):
        bunny = os.path.join(SAMPLES, "meshes", "bunny.off")
        for resolution in (64, 128, 256, 512, 1024):
            if self.wanted("growth convert") and os.path.exists(bunny):
                with self.attempt("growth convert"):
                    result = self.tool("convert", bunny, "-o", "g.vdb", "--resolution", resolution)
                    self.grow("growth convert bunny", result[2]["counts"]["active_voxels"], result[0], result[1])
        for size in ("1x,1x,1x", "2x,2x,1x", "4x,4x,1x", "4x,4x,4x") if not self.quick else ("1x,1x,1x", "2x,2x,1x"):
            if self.wanted("growth synth"):
                with self.attempt(f"growth synth {size}"):
                    self.tool("make", "grid", "exemplar.vdb", "--resolution", 64)
                    result = self.tool("synth", "exemplar.vdb", "-o", "g.vdb", "--size", size)
                    self.grow(f"growth synth grid {size}", result[2]["counts"]["active_voxels"], result[0], result[1])
        for resolution in (64, 128, 256):
            if self.wanted("growth compare"):
                with self.attempt(f"growth compare {resolution}"):
                    made = self.tool("make", "sponge", "1.vdb", "--resolution", resolution)
                    self.tool("make", "sponge", "2.vdb", "--resolution", resolution, "--seed", 2)
                    result = self.tool("compare", "1.vdb", "2.vdb")
                    self.grow(f"growth compare sponge {resolution}", made[2]["counts"]["active_voxels"], result[0], result[1])

    def run(self):
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            models = [l.split(":")[1].strip() for l in file if l.startswith("model name")]
        machine = f"{models[0] if models else platform.processor()}, {os.cpu_count()} cores"
        print(machine)
        print(f"{'row':34} {'budget':26} {'measured':26} {'rival':22} {'ratio':8} note")
        for part in (self.meshes, self.synthesis, self.analogy, self.compare, self.block_match, self.growth_curves):
            part()
        shutil.rmtree(self.folder, ignore_errors=True)
        return {"machine": machine, "rows": self.rows, "growth": self.growth, "failures": self.failures}


def markdown(result):
    """The tables of docs/performance.md."""
    lines = [f"Machine: {result['machine']}.", "", "| row | budget | measured | rival | ratio | note |", "|---|---|---|---|---|---|"]
    lines += ["| " + " | ".join(str(row[k]) for k in ("name", "budget", "measured", "rival", "ratio", "note")) + " |" for row in result["rows"]]
    lines += ["", "| work | active voxels | seconds | peak memory (MB) | ns a voxel | bytes a voxel |", "|---|---|---|---|---|---|"]
    for g in result["growth"]:
        lines.append(f"| {g['work']} | {g['active_voxels']} | {g['seconds']:.2f} | {g['peak_bytes'] / 1e6:.0f} | "
                     f"{g['seconds'] / g['active_voxels'] * 1e9:.0f} | {g['peak_bytes'] / g['active_voxels']:.0f} |")
    return "\n".join(lines) + "\n"


def main(words):
    build, quick = words[0], "--quick" in words
    result = Bench(build, quick, [w for w in words[1:] if not w.startswith("--")]).run()
    with open(os.path.join(build, "bench.json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
    with open(os.path.join(build, "bench.md"), "w", encoding="utf-8") as file:
        file.write(markdown(result))
    return 1 if result["failures"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
