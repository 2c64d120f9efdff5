#!/usr/bin/python3
"""Converts every sample file and prints, as a table, what came out or what was said. Usage: try_samples.py PROGRAM SAMPLES"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile


def outcome(program, path, folder):
    result = os.path.join(folder, "out.vdb")
    done = subprocess.run([program, "convert", str(path), "-o", result, "--resolution", "96"],
                          capture_output=True, text=True, timeout=600)
    said = [line.replace(str(path), path.name).replace("vdb_synth: ", "").replace("vdb_synth convert: ", "")
            for line in done.stderr.splitlines()]
    if done.returncode != 0:
        return f"exit {done.returncode}", " ".join(said[-1:])
    info = json.loads(subprocess.run([program, "info", result, "--json"], capture_output=True, text=True).stdout)
    os.remove(result)
    model = info["model"]
    words = "valid" if model["valid"] else "not valid"
    return f"{int(model['solid_voxels'])} solid voxels, {words}", "; ".join(said)


def main(program, samples):
    print("| file | result | what was said |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(pathlib.Path(samples).rglob("*")):
            if path.is_file() and path.suffix != ".md":
                result, said = outcome(program, path, folder)
                print(f"| {path.relative_to(samples)} | {result} | {said.replace('|', '/')} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
