#!/usr/bin/python3
"""Prints what runs are expected to need beside what they need, as a table: how the constants of the memory models
(requireMemoryFor in pipeline/synth/synth_steps.cpp, madeAnalogy in pipeline/analogy/analogy.cpp) are tuned. An estimate
should be over the peak, by less than three times. Usage: memory_models.py PROGRAM [--small]"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

UNITS = {"MB": 1e6, "GB": 1e9}


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def expected(program, arguments):
    """Most bytes that the run says it needs, step by step: each time it may have a little more than the last."""
    most, said = 0.0, ""
    for _ in range(8):
        said = run(program, *arguments, "--max-memory", f"{max(1, int(most * 1.01 / 1e6 + 1))}M").stderr.strip()
        match = re.search(r"needs about ([\d.]+) (\w+)", said)
        if not match:
            break
        most = float(match.group(1)) * UNITS[match.group(2)]
    return most


def main():
    program, small = sys.argv[1], "--small" in sys.argv
    folder = pathlib.Path(tempfile.mkdtemp())
    sizes = ["128,128,128"] if small else ["128,128,128", "256,256,256"]
    rows = []
    for kind in ["balls", "foam", "grid", "sponge", "fibres"]:
        run(program, "make", kind, folder / f"{kind}.vdb", "-q")
        for size in sizes:
            rows.append((f"synth {kind} {size}", ["synth", folder / f"{kind}.vdb", "--size", size]))
    run(program, "make", "weave", folder / "weave.vdb", "-q")
    rows.append(("synth weave 4x,4x,1x", ["synth", folder / "weave.vdb", "--size", "4x,4x,1x"]))
    run(program, "make", "grooves", folder / "a.vdb", folder / "a2.vdb", "-q")
    run(program, "make", "three-tori", folder / "b.vdb", "-q", "--resolution", "96" if small else "196")
    rows.append(("analogy grooves three-tori", ["analogy", folder / "a.vdb", folder / "a2.vdb", folder / "b.vdb"]))
    print("| run | expected MB | peak MB | expected / peak |\n|---|---|---|---|")
    for name, arguments in rows:
        out = ["-o", folder / "out.vdb", "-q"]
        plan = expected(program, arguments + out)
        report = folder / "report.json"
        run(program, *arguments, *out, "--report", report)
        peak = json.loads(report.read_text())["peak_bytes"]
        print(f"| {name} | {plan / 1e6:.0f} | {peak / 1e6:.0f} | {plan / peak:.1f} |")


if __name__ == "__main__":
    main()
