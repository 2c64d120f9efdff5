#!/usr/bin/python3
"""Measures textures on points: how good they are and how fast they are made. Prints the tables of docs/texturing.md.
Usage: textures.py BUILD_FOLDER [--texture "OPTIONS"] [TABLE...]
Tables: quality (the default method on every sample), methods (beside the paper's three), blend (colours mixed at seams), loss (what mixing does to each sample),
angles (of charts to given directions), speed (beside the paper's table 1), growth (with the number of points); default all. `check` is a short run with a sample of
its own, which fails if a number is not finite. OPTIONS are of texture_quality, of the default method, in all tables. Samples are those of VDBSYNTH_SAMPLES, default ../shared/data."""
import argparse
import math
import os
import pathlib
import shlex
import statistics
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = pathlib.Path(os.environ.get("VDBSYNTH_SAMPLES") or SOURCE.parent / "shared" / "data")
VISTEX = ["Bark-11", "Brick-04", "Fabric-11", "Fabric-13", "Flowers-00", "Food-08", "Sand-05"]
TEXTURES = [SAMPLES / "textures" / name for name in [f"vistex-{v}.png" for v in VISTEX] + ["gravel.png", "brick.png", "metal.pgm"]]
FEW = [t for t in TEXTURES if t.stem in ("vistex-Flowers-00", "vistex-Fabric-11", "gravel", "brick")]
BUNNY = str(SAMPLES / "meshes" / "bunny.off")
COLUMNS = ["W1", "steps", "seams", "patches", "wide", "coherent", "points/s", "by a core"]
# Table 1 of the paper: model here, points, side of the sample, k, levels, coherent, points a second there.
PAPER = [
    ("parameterize", "sphere:16386", 64, 25, 1, False, 54620), ("parameterize", BUNNY, 128, 36, 1, False, 26285),
    ("parameterize", "sphere:75781", 128, 25, 1, False, 41410), ("parameterize", "sphere:56194", 64, 36, 1, False, 36969),
    ("match", "sphere:56194", 64, 25, 1, False, 839), ("match", "sphere:56194", 64, 49, 1, False, 466),
    ("match", "sphere:56194", 128, 25, 1, False, 230), ("match", "sphere:56194", 64, 25, 4, False, 431),
    ("match", "sphere:56194", 128, 49, 4, False, 62), ("match", "sphere:56194", 64, 25, 1, True, 31012),
    ("match", "sphere:56194", 128, 49, 1, True, 12361), ("hybrid", BUNNY, 64, 25, 1, False, 4254),
    ("hybrid", BUNNY, 64, 25, 4, False, 2559), ("hybrid", BUNNY, 64, 49, 4, False, 1433),
    ("hybrid", "sphere:75781", 64, 25, 3, False, 3203), ("hybrid", "sphere:75781", 128, 25, 3, False, 920),
    ("hybrid", "sphere:56194", 64, 25, 4, False, 1417), ("hybrid", "sphere:56194", 128, 49, 1, True, 19133),
]


def short(target):
    return pathlib.Path(target).stem if "/" in target else target


def row(*cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


def header(*cells):
    print()
    row(*cells)
    print("|" + "---|" * len(cells))


def rounded(speed):
    """Three digits."""
    digits = max(0, len(str(int(speed))) - 3)
    return f"{int(round(speed, -digits)):,}".replace(",", " ")


class Program:
    def __init__(self, build, options):
        self.program = str(pathlib.Path(build) / "tests" / "texture_quality")
        self.options = options

    def lines(self, target, samples, *options):
        """(sample, numbers) of each sample."""
        result = subprocess.run([self.program, target, *map(str, samples), *self.options, *map(str, options)], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip())
        return [(line.split()[0], [float(v) for v in line.split()[1:]]) for line in result.stdout.splitlines()[1:]]

    def speed(self, target, sample, *options):
        """Points a second: all cores, and a second of one core's time."""
        return self.lines(target, [sample], "--speed", *options)[0][1]


def written(numbers):
    return [f"{v:.2f}" for v in numbers[:-2]] + [rounded(v) for v in numbers[-2:]]


def quality(program):
    for target in ("plane:256", BUNNY):
        header(short(target), *COLUMNS[:-2])
        for texture in TEXTURES:
            name, numbers = program.lines(target, [texture])[0]
            row(pathlib.Path(name).stem, *written(numbers)[:-2])


def compared(program, options, samples):
    for target in ("plane:256", BUNNY):
        header(short(target), "samples", *COLUMNS)
        for name, words in options:
            numbers = [n for _, n in program.lines(target, samples, *words)]
            row(name, len(samples), *written([statistics.median(c) for c in zip(*numbers)]))


def methods(program):
    names = ("default", "parameterize", "match", "match4", "hybrid")
    compared(program, [(name, ["--method", name, "--crop", 128]) for name in names], FEW)  # match takes long on larger samples


def blend(program):
    compared(program, [("off", ["--blend", 0]), ("histogram", ["--blend", 1])], FEW)


def speed(program):
    sample = SAMPLES / "textures" / "vistex-Flowers-00.png"
    header("method", "points", "sample", "k", "levels", "points/s", "by a core", "the paper", "default: points/s", "by a core")
    default = {}
    for method, target, side, k, levels, coherent, paper in PAPER:
        words = ["--crop", side, "--neighbours", k, "--levels", levels] + ["--coherent"] * coherent
        ours = program.speed(target, sample, "--method", method, *words)
        if (target, side) not in default:
            default[target, side] = program.speed(target, sample, "--crop", side)
        row(method + ", coherent" * coherent, rounded_count(target), f"{side}x{side}", k, levels, *map(rounded, ours), rounded(paper),
            *map(rounded, default[target, side]))


def rounded_count(target):
    return target.split(":")[1] if ":" in target else "34835"


def angles(program):
    header("target", "sample", "counted", "median", "99 %", "largest")
    for target in (BUNNY, str(SAMPLES / "meshes" / "3holes.off"), "sphere:56194"):
        for texture in FEW:
            numbers = program.lines(target, [texture], "--angles")[0][1]
            row(short(target), texture.stem, *(f"{v:.2f}" for v in numbers))


def growth(program):
    sample = SAMPLES / "textures" / "vistex-Flowers-00.png"
    header("points", "default: points/s", "by a core", "parameterize: points/s", "by a core")
    for count in (10_000, 100_000, 1_000_000, 10_000_000):
        speeds = [program.speed(f"sphere:{count}", sample, "--method", m) for m in ("default", "parameterize")]
        row(count, *(rounded(v) for pair in speeds for v in pair))


def check(program, folder):
    sample = folder / "pebbles.png"
    subprocess.run([sys.executable, str(SOURCE / "tools" / "dev" / "make_sample.py"), "pebbles", str(sample), "64"], check=True)
    for method in ("default", "parameterize"):
        name, numbers = program.lines("plane:48", [sample], "--method", method)[0]
        print(name, method, *numbers)
        if len(numbers) != len(COLUMNS) or not all(math.isfinite(v) and v >= 0 for v in numbers):
            sys.exit("a number is missing or not finite")


def loss(program):
    result = subprocess.run([program.program, "loss", *map(str, TEXTURES)], capture_output=True, text=True, check=True)
    header("sample", "blendLoss")
    for name, value in sorted((line.split() for line in result.stdout.splitlines()), key=lambda words: float(words[1])):
        row(pathlib.Path(name).stem, f"{float(value):.2f}")


TABLES = {"quality": quality, "methods": methods, "blend": blend, "loss": loss, "angles": angles, "speed": speed, "growth": growth}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--texture", default="")
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join([*TABLES, "check"]))
    a = parser.parse_intermixed_args()
    unknown = set(a.tables) - {*TABLES, "check"}
    if unknown:
        parser.error(f"no such table: {', '.join(sorted(unknown))}")
    program = Program(a.build, shlex.split(a.texture))
    if "check" in a.tables:
        folder = pathlib.Path(a.build) / "quality"
        folder.mkdir(exist_ok=True)
        check(program, folder)
        return
    for table in a.tables or TABLES:
        TABLES[table](program)


if __name__ == "__main__":
    main()
