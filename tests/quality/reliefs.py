#!/usr/bin/python3
"""Measures relief: known answers, statistics beside the sample's, seconds and memory. Prints the tables of docs/relief.md.
Usage: reliefs.py BUILD_FOLDER [TABLE...]
Tables: right (answers that are known), statistics (of results beside the samples'), methods (the default beside the exhaustive one), stages (seconds by stage),
growth (with resolution), part (a box for printing), blender (beside its Displace modifier); default all. Samples are those of VDBSYNTH_SAMPLES, default ../shared/data."""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = pathlib.Path(os.environ.get("VDBSYNTH_SAMPLES") or SOURCE.parent / "shared" / "data")
RELIEFS = [("meshes/ChineseDragon-10kv.off", ["--base-radius", "2.8"]), ("meshes/bumpy-cube.obj", []), ("meshes/thingi10k-88566-grooved-bars.stl", []),
           ("textures/print-knurling.jpg", []), ("textures/print-basket.png", []), ("textures/brick.png", []), ("textures/vistex-Bark-11.png", [])]
# Statistics only: pixels wider than voxels.
WIDE_PIXELS = [("textures/print-knurling.jpg", ["--resolution", "256", "--scale", "1.5"]),
               ("textures/vistex-Bark-11.png", ["--resolution", "256", "--scale", "1.5"])]
TARGETS = ["3holes.off", "bunny.off", "seahorse.obj", "fandisk.obj", "camelhead.off"]
# Wanted, of every known answer: at most, or at least.
WANTED = {"ball_relief": (0.05, "voxel"), "sine_transfer_error": (0.02, "of the amplitude"), "sine_sa_error": (0.01, ""), "sine_sq_error": (0.01, ""),
          "sine_sku_error": (0.01, ""), "cylinder_wavelength_error": (0.02, ""), "cylinder_amplitude_error": (0.05, ""),
          "torus_outside_error": (0.1, ""), "torus_inside_error": (0.1, ""), "sum_largest_error": (0.1, "voxel"), "own_base_identity_rms": (0.1, "voxel"),
          "undercut_share": (-0.9, "")}
CUBE = "OFF\n8 6 0\n" + "".join(f"{x} {y} {z}\n" for z in (0, 100) for y in (0, 150) for x in (0, 150)) + """4 0 2 3 1
4 4 5 7 6
4 0 1 5 4
4 2 6 7 3
4 0 4 6 2
4 1 3 7 5
"""
DISPLACE = """
import bpy, sys, time, resource
mesh, picture, out, strength, level = sys.argv[sys.argv.index("--") + 1:]
points, faces = [], []
words = [line.split() for line in open(mesh) if line.strip()]
count, sides = int(words[1][0]), int(words[1][1])
points = [tuple(map(float, w[:3])) for w in words[2:2 + count]]
faces = [tuple(map(int, w[1:])) for w in words[2 + count:2 + count + sides]]
start = time.time()
made = bpy.data.meshes.new("m")
made.from_pydata(points, [], faces)
thing = bpy.data.objects.new("o", made)
bpy.context.collection.objects.link(thing)
bpy.context.view_layer.objects.active = thing
thing.modifiers.new("s", "SUBSURF").levels = int(level)
texture = bpy.data.textures.new("t", "IMAGE")
texture.image = bpy.data.images.load(picture)
displace = thing.modifiers.new("d", "DISPLACE")
displace.texture, displace.strength, displace.mid_level = texture, float(strength), 0.5
displace.texture_coords = "LOCAL"
evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
evaluated.calc_loop_triangles()
seconds = time.time() - start
with open(out, "w") as file:
    file.write(f"OFF\\n{len(evaluated.vertices)} {len(evaluated.loop_triangles)} 0\\n")
    for v in evaluated.vertices: file.write("%.7g %.7g %.7g\\n" % tuple(v.co))
    for t in evaluated.loop_triangles: file.write("3 %d %d %d\\n" % tuple(t.vertices))
print("SECONDS", seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def row(*cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


def header(*cells):
    print()
    row(*cells)
    print("|" + "---|" * len(cells))


def short(path):
    return pathlib.Path(path).stem


class Programs:
    def __init__(self, build, folder):
        self.tool = str(pathlib.Path(build) / "tools" / "vdb_synth" / "vdb_synth")
        self.measure = str(pathlib.Path(build) / "tests" / "relief_quality")
        self.folder = pathlib.Path(folder)

    def numbers(self, *words):
        result = subprocess.run([self.measure, *map(str, words)], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip().splitlines()[-1])
        return [line.split() for line in result.stdout.splitlines()]

    def relief(self, *words):
        """The report of a run."""
        report = self.folder / "r.json"
        result = subprocess.run([self.tool, "relief", *map(str, words), "--report", str(report), "-q", "--force"], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip())
        return json.loads(report.read_text())


def right(programs):
    header("answer", "measured", "wanted")
    for name, value in programs.numbers("right"):
        if name not in WANTED:
            row(name, value, "")
            continue
        limit, unit = WANTED[name]
        holds = float(value) <= limit if limit > 0 else float(value) >= -limit
        row(name, value, f"{'at most' if limit > 0 else 'at least'} {abs(limit)} {unit}".strip() + ("" if holds else ": missed"))


def statistics(programs):
    header("sample", "target", "Sq of the sample", "Sq of the result", "W1 / Sq", "Ssk differs by", "Sku differs by", "octaves at most", "seconds")
    for target in TARGETS:
        for sample, words in RELIEFS + WIDE_PIXELS:
            try:
                # Of a scan the default copies what is rough; only whole samples have the sample's statistics.
                numbers = programs.numbers("statistics", SAMPLES / sample, SAMPLES / "meshes" / target, *words, "--whole-sample")[-1][1:]
            except RuntimeError as error:
                row(short(sample), short(target), error)
                continue
            before, after, distance, ssk, sku, seconds = map(float, numbers[:6])
            octaves = [tuple(map(float, word.split(":"))) for word in numbers[6:]]
            # Octaves that hold a tenth of the relief.
            worst = max((abs(b / a - 1) for _, a, b in octaves if a > 0.1 * before), default=0)
            row(short(sample), short(target), f"{before:.2f}", f"{after:.2f}", f"{distance:.2f}", f"{ssk:+.2f}", f"{sku:+.2f}", f"{100 * worst:.0f} %", f"{seconds:.1f}")


def methods(programs):
    header("method", "Sq beside the sample's", "W1 / Sq", "mean SSD within 4 voxels", "within 8")
    for name, sq, distance, near, far in programs.numbers("mismatch"):
        row(name, f"{float(sq):.2f}", f"{float(distance):.3f}", f"{float(near):.4f}", f"{float(far):.4f}")


def stages(programs):
    header("sample", "target", "reading and level sets", "base and charts", "matching", "editing", "output", "seconds", "peak memory")
    kinds = {"reading": 0, "mesh to level set": 0, "smoothing": 1, "charts": 1, "relief of": 1, "similar": 2, "texture": 2, "relief on": 3, "writing": 4,
             "level set to mesh": 4}
    for sample, words in RELIEFS:
        for target in ("3holes.off", "bunny.off"):
            report = programs.relief(SAMPLES / sample, SAMPLES / "meshes" / target, "-o", programs.folder / "r.obj", *words)
            sums, last = [0.0] * 5, 0
            for stage in report["stages"]:
                last = next((kind for word, kind in kinds.items() if stage["name"].startswith(word)), last)
                sums[last] += stage["seconds"]
            row(short(sample), short(target), *(f"{s:.1f}" for s in sums), f"{report['seconds']:.1f}", f"{report['peak_bytes'] / 2**20:.0f} MiB")


def growth(programs):
    header("voxels along the longest side", "active voxels", "seconds", "peak memory")
    for resolution in (64, 128, 256, 512):
        report = programs.relief(SAMPLES / "textures" / "print-knurling.jpg", SAMPLES / "meshes" / "3holes.off", "-o", programs.folder / "r.vdb",
                                 "--resolution", resolution)
        row(resolution, report["counts"]["active_voxels"], f"{report['seconds']:.1f}", f"{report['peak_bytes'] / 2**20:.0f} MiB")


def part(programs):
    header("voxel", "voxels along", "active voxels", "seconds", "peak memory")
    (programs.folder / "box.off").write_text(CUBE)
    for voxel in (0.4, 0.2):
        report = programs.relief(SAMPLES / "textures" / "print-knurling.jpg", programs.folder / "box.off", "-o", programs.folder / "part.stl",
                                 "--voxel-size", voxel, "--height", 1, "--pixel-size", 0.2)
        row(f"{voxel} mm", round(150 / voxel), report["counts"]["active_voxels"], f"{report['seconds']:.0f}", f"{report['peak_bytes'] / 2**30:.2f} GiB")


def slivers(path):
    """Triangles of an .off, and the share with an angle under 5 degrees."""
    lines = path.read_text().split("\n")
    points, faces = map(int, lines[1].split()[:2])
    place = [tuple(map(float, line.split()[:3])) for line in lines[2:2 + points]]
    thin = count = 0
    for line in lines[2 + points:2 + points + faces]:
        corner = [place[int(i)] for i in line.split()[1:]]
        for k in range(1, len(corner) - 1):
            a, b, c = corner[0], corner[k], corner[k + 1]
            least = 180.0
            for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                u, v = [q[i] - p[i] for i in range(3)], [r[i] - p[i] for i in range(3)]
                size = (sum(x * x for x in u) * sum(x * x for x in v))**0.5
                cosine = sum(x * y for x, y in zip(u, v)) / size if size else 1
                least = min(least, 0 if cosine > 0.99619 else 180)
            thin += least < 5
            count += 1
    return count, thin / count


def blender(programs):
    if not shutil.which("blender"):
        print("\nblender is not installed, so its row is left out")
        return
    header("3holes, print-knurling", "triangles", "seconds", "peak memory", "angles under 5 degrees")
    picture, mesh, made = SAMPLES / "textures" / "print-knurling.jpg", SAMPLES / "meshes" / "3holes.off", programs.folder / "b.off"
    report = programs.relief(picture, mesh, "-o", programs.folder / "v.off")
    count, share = slivers(programs.folder / "v.off")
    row("relief", count, f"{report['seconds']:.1f}", f"{report['peak_bytes'] / 2**20:.0f} MiB", f"{100 * share:.2f} %")
    script = programs.folder / "displace.py"
    script.write_text(DISPLACE)
    said = subprocess.run(["blender", "-b", "--factory-startup", "-P", str(script), "--", str(mesh), str(picture), str(made), "0.039", "2"],
                          capture_output=True, text=True, check=False).stdout
    words = [line.split() for line in said.splitlines() if line.startswith("SECONDS")]
    if not words:
        print("blender gave no result:", said.strip().splitlines()[-1:])
        return
    count, share = slivers(made)
    row("Blender's Displace", count, f"{float(words[0][1]):.1f}", f"{int(words[0][2]) / 1024:.0f} MiB", f"{100 * share:.2f} %")


TABLES = {"right": right, "statistics": statistics, "methods": methods, "stages": stages, "growth": growth, "part": part, "blender": blender}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join(TABLES))
    a = parser.parse_args()
    unknown = set(a.tables) - set(TABLES)
    if unknown:
        parser.error(f"no such table: {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory() as folder:
        for table in a.tables or TABLES:
            TABLES[table](Programs(a.build, folder))


if __name__ == "__main__":
    main()
