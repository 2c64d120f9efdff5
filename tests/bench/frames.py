#!/usr/bin/python3
"""Times --frames against a shell loop that runs the program once for each frame: the same files, in turns, the median of the rounds.
Every frame of both must have the same bytes. All models are made by `make`, and twisted here.
Usage: frames.py BUILD_FOLDER [--frames N] [--rounds N] [ROW...]"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time


sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/dev"))
sys.dont_write_bytecode = True
from twist_mesh import twisted  # noqa: E402: its folder was added above


# The words of a run; #### is the frame.
ROWS = {
    "analogy at rest": ("analogy", "A.vdb", "A2.vdb", "body.####.obj", "--rest", "body.obj", "--resolution", "48", "--draft", "--direction", "around:z",
                        "-o", "out.####.vdb"),
    "analogy": ("analogy", "A.vdb", "A2.vdb", "body.####.obj", "--resolution", "48", "--draft", "--direction", "around:z", "-o", "out.####.vdb"),
    "synth with a guide": ("synth", "grid.vdb", "--size", "2x,2x,1x", "--guide", "body.####.vdb:surface", "--exemplar-guide", "grid.vdb:surface",
                      "-o", "out.####.vdb"),
    "repeat": ("repeat", "map.vdb", "grid.####.vdb", "-o", "out.####.vdb"),
    "convert": ("convert", "body.####.obj", "--resolution", "100", "-o", "out.####.vdb"),
    "render": ("render", "body.####.vdb", "-o", "out.####.png", "--size", "320x240"),
}


class Frames:
    def __init__(self, program, count, folder):
        self.program, self.count, self.folder = program, count, folder

    def run(self, *words):
        subprocess.run([self.program, *map(str, words), "-q"], cwd=self.folder, check=True)

    def path(self, name):
        return pathlib.Path(self.folder, name)

    def make(self):
        """A pair, a body in poses of up to 60 degrees, an exemplar that moves, and its map."""
        self.run("make", "dilation", "A.vdb", "A2.vdb", "--resolution", 48)
        self.run("make", "three-tori", "body.vdb", "--resolution", 64)
        self.run("convert", "body.vdb", "-o", "body.obj")
        body = self.path("body.obj").read_text()
        self.run("make", "grid", "grid.vdb", "--resolution", 48)
        self.run("synth", "grid.vdb", "-o", "more.vdb", "--size", "3x,3x,1x", "--source-map", "map.vdb")
        for frame in range(1, self.count + 1):
            self.path("body.%04d.obj" % frame).write_text(twisted(body, 60 * (frame - 1) / max(self.count - 1, 1)))
            self.run("convert", "body.%04d.obj" % frame, "-o", "body.%04d.vdb" % frame, "--resolution", 64)
            self.run("make", "grid", "grid.%04d.vdb" % frame, "--resolution", 48, "--seed", frame)

    def outputs(self):
        """The bytes of all frames; they are removed."""
        held = {}
        for path in sorted(self.path(".").glob("out.*")):
            held[path.name] = path.read_bytes()
            path.unlink()
        return held

    def timed(self, words, at_once):
        began = time.monotonic()
        if at_once:
            self.run(*words, "--frames", f"1-{self.count}")
        else:
            for frame in range(1, self.count + 1):
                self.run(*[word.replace("####", "%04d" % frame) for word in words])
        return time.monotonic() - began, self.outputs()

    def row(self, name, rounds):
        once, loop, ratios = [], [], []
        for turn in range(rounds):
            order = (True, False) if turn % 2 == 0 else (False, True)
            taken = {at_once: self.timed(ROWS[name], at_once) for at_once in order}
            if taken[True][1] != taken[False][1] or len(taken[True][1]) != self.count:
                sys.exit(f"{name}: frames of one run are not those of single runs")
            once.append(taken[True][0])
            loop.append(taken[False][0])
            ratios.append(taken[False][0] / taken[True][0])
        print("| %-18s | %6.1f s | %6.1f s | %5.2f |" % (name, statistics.median(once), statistics.median(loop), statistics.median(ratios)), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("rows", nargs="*", metavar="ROW", help="of: " + ", ".join(ROWS))
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_intermixed_args()
    program = str(pathlib.Path(given.build).resolve() / "tools/vdb_synth/vdb_synth")
    unknown = [row for row in given.rows if row not in ROWS]
    if unknown:
        parser.error(f"unknown rows {unknown}; one of {list(ROWS)}")
    with tempfile.TemporaryDirectory(prefix="vdbsynth_frames_") as folder:
        frames = Frames(program, given.frames, folder)
        frames.make()
        print(f"{given.frames} frames, median of {given.rounds} rounds in turns; the ratio is the loop's time over that of --frames")
        print("| run                | --frames | a loop   | ratio |\n|---|---|---|---|", flush=True)
        for name in given.rows or ROWS:
            frames.row(name, given.rounds)


if __name__ == "__main__":
    main()
