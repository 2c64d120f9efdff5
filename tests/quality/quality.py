#!/usr/bin/python3
"""Makes more of every exemplar of a fixed set and measures how good it is by `vdb_synth compare`: prints a table, writes
quality.json, the pages of compare and a contact sheet (quality.png).
Usage: quality.py BUILD_FOLDER [--seeds N] [--size X,Y,Z] [--synth "OPTIONS"] [--name NAME] [EXEMPLAR...]
An exemplar is run if its name contains one of the words. --synth gives options to synth, to choose defaults with."""
import argparse
import json
import os
import pathlib
import shlex
import struct
import subprocess
import sys
import time
import zipfile
import zlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = os.environ.get("VDBSYNTH_SAMPLES", str(SOURCE.parent / "shared" / "data"))

# name: (how to make it, size of the result, process to draw afresh from)
SHEETS = ("chainmail", "terrain", "weave")  # one layer: more of it is wider, not higher
MADE = {kind: (["make", kind, "exemplar.vdb", "--resolution", 64, "--seed", 1], "2x,2x,1x" if kind in SHEETS else "2x,2x,2x",
               f"make {kind}")
        for kind in ("balls", "grid", "chainmail", "fibres", "foam", "sponge", "terrain", "weave")}
REAL = {
    "dem": (["convert", "terrain/dem.tif", "-o", "exemplar.vdb", "--height", 4000, "--resolution", 96], "2x,2x,1x", None),
    "brick": (["convert", "textures/brick.png", "-o", "exemplar.vdb", "--height", 60, "--resolution", 96], "2x,2x,1x", None),
    "gravel": (["convert", "textures/gravel.png", "-o", "exemplar.vdb", "--height", 80, "--resolution", 96], "2x,2x,1x", None),
    "metal": (["convert", "textures/metal.pgm", "-o", "exemplar.vdb", "--height", 32, "--resolution", 96], "2x,2x,1x", None),
    "ketton": (["convert", "volumes/ketton.zip", "-o", "whole.vdb"], "2x,2x,2x", None),
    "cheese": (["convert", "meshes/cheese.off", "-o", "whole.vdb", "--resolution", 128], "2x,2x,1x", None),
}
# What is cut out of a whole model to be the exemplar.
CROPS = {"cheese": "-63,-63,-56,0,0,-1", "ketton": "64,64,64,159,159,159"}
PICTURE = (320, 240)


def paeth(a, b, c):
    pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def read_png(path):
    """Rows of RGB bytes of an 8-bit colour PNG."""
    data, at, body = pathlib.Path(path).read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (depth, colour) == (8, 2), path
        if kind == b"IDAT":
            body += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, rows, last = zlib.decompress(body), 3 * width, [], bytearray(3 * width)
    for y in range(height):
        filter_type, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (row[i - 3] if i > 2 else 0), last[i], (last[i - 3] if i > 2 else 0)
            guess = (0, left, up, (left + up) // 2, paeth(left, up, corner))[filter_type]
            row[i] = (row[i] + guess) & 255
        rows.append(row)
        last = row
    return rows


def write_png(path, rows):
    body = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 6)
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b""))


def contact_sheet(pairs, path):
    """Pairs of pictures, exemplar beside result, two pairs a row."""
    blank, rows = [bytearray(b"\xff" * 3 * PICTURE[0])] * PICTURE[1], []
    for first in range(0, len(pairs), 2):
        pictures = [read_png(p) for pair in pairs[first:first + 2] for p in pair]
        pictures += [blank] * (4 - len(pictures))
        rows += [bytearray(b"".join(p[y] for p in pictures)) for y in range(PICTURE[1])]
    write_png(path, rows)


class Quality:
    def __init__(self, arguments):
        self.program = str(pathlib.Path(arguments.build).resolve() / "tools/vdb_synth/vdb_synth")
        self.folder = pathlib.Path(arguments.build).resolve() / "quality" / arguments.name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.arguments, self.results, self.pictures = arguments, {}, []

    def tool(self, *words):
        result = subprocess.run([self.program, *map(str, words), "-q"], cwd=self.folder, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, words))}: {result.stderr.strip()}")
        return result.stdout

    def exemplar(self, name, words):
        words = list(words)
        if words[0] == "convert":
            words[1] = os.path.join(SAMPLES, words[1])
            if not os.path.exists(words[1]):
                return False
            if words[1].endswith(".zip"):
                words[1] = zipfile.ZipFile(words[1]).extract(pathlib.Path(words[1]).stem + ".tif", self.folder)
        self.tool(*words)
        if name in CROPS:
            self.tool("crop", "whole.vdb", "-o", "exemplar.vdb", "--box", CROPS[name])
        os.replace(self.folder / "exemplar.vdb", self.folder / f"{name}.vdb")
        return True

    def run(self, name, words, size, process):
        if not self.exemplar(name, words):
            print(f"{name:10} skipped: its sample is absent", flush=True)
            return
        results, seconds = [], 0
        for seed in range(1, self.arguments.seeds + 1):
            results.append(f"{name}_{seed}.vdb")
            began = time.monotonic()
            self.tool("synth", f"{name}.vdb", "-o", results[-1], "--size", size, "--seed", seed, "--source-map",
                      *shlex.split(self.arguments.synth))
            seconds += (time.monotonic() - began) / self.arguments.seeds
        yardstick = ["--process", process] if process else []
        found = json.loads(self.tool("compare", f"{name}.vdb", *results, "--json", "--page", f"{name}.html", *yardstick))
        self.report(name, found, seconds)
        for model in (name, results[0][:-4]):
            self.tool("render", f"{model}.vdb", "-o", f"{model}.png", "--size", f"{PICTURE[0]}x{PICTURE[1]}")
        self.pictures.append((self.folder / f"{name}.png", self.folder / f"{results[0][:-4]}.png"))

    def report(self, name, found, seconds):
        mean = lambda values: sum(values) / max(1, len(values))
        others = found["others"]
        ratios = {y["name"]: y["ratio"] for y in found["yardstick"]}
        worst = max(ratios, key=ratios.get) if ratios else ""
        verdicts = [v for o in others for v in o["distances"]["verdicts"]]
        novelty = [o["distances"]["novelty"] for o in others]
        exemplar = found["reference"]["statistics"]
        fields = {
            "seconds": seconds,
            "yardstick_mean": mean(list(ratios.values())) if ratios else None,
            "yardstick_worst": ratios.get(worst), "worst": worst,
            "within_1": sum(r <= 1 for r in ratios.values()), "of": len(ratios),
            "verdicts_passed": mean([v["passes"] for v in verdicts]),
            "seam_ratio": mean([n.get("seam_ratio", 0) for n in novelty]),
            "verbatim_share": mean([n.get("verbatim_share", 0) for n in novelty]),
            "largest_run_share": max(n.get("largest_run_share", 0) for n in novelty),
            "gradient_error": mean([o["gradient_error_mean"] for o in others]),
            "crumbs": sum(o["crumbs"] for o in others),
        }
        self.results[name] = {**fields, "ratios": ratios, "statistics": len(exemplar)}
        text = lambda v, form: format(v, form) if v is not None else "-"
        print(f"{name:10} {seconds:6.1f} s  yardstick {text(fields['yardstick_mean'], '6.2f')} mean {text(fields['yardstick_worst'], '7.2f')} worst "
              f"({fields['within_1']:2} of {fields['of']:2} within 1)  verdict {100 * fields['verdicts_passed']:4.0f} %  seam {fields['seam_ratio']:5.2f}  "
              f"grad {fields['gradient_error']:.3f}  crumbs {fields['crumbs']:3}  largest run {100 * fields['largest_run_share']:3.0f} %  {worst}", flush=True)

    def finish(self):
        (self.folder / "quality.json").write_text(json.dumps({"synth": self.arguments.synth, "size": self.arguments.size, "seeds": self.arguments.seeds,
                                                              "results": self.results}, indent=1), encoding="utf-8")
        if self.pictures:
            contact_sheet(self.pictures, self.folder / "quality.png")
            print(f"pictures: {self.folder / 'quality.png'}, numbers: {self.folder / 'quality.json'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("exemplars", nargs="*")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--size", default="", help="of all results, default what suits each exemplar")
    parser.add_argument("--synth", default="")
    parser.add_argument("--name", default="default")
    quality = Quality(parser.parse_intermixed_args())
    failures = 0
    for name, (words, size, process) in {**MADE, **REAL}.items():
        if quality.arguments.exemplars and not any(word in name for word in quality.arguments.exemplars):
            continue
        try:
            quality.run(name, words, quality.arguments.size or size, process)
        except RuntimeError as error:
            print(f"{name:10} failed: {error}", flush=True)
            failures += 1
    quality.finish()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
