#!/usr/bin/python3
"""Converts every sample file and prints, as a table, what came out, what was said and whether that is right.

Right: the values of sample_values.json hold, or without values there the result is a valid level set that lost nothing
in silence. Refused: an exit code of the contract and one line with a reason. Wrong: everything else.
Usage: try_samples.py PROGRAM SAMPLES [PART]"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

VALUES = json.loads((pathlib.Path(__file__).parent / "sample_values.json").read_text())


def run(*words):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, errors="replace", timeout=600)


def differences(expected, values):
    """Of `values` from those expected: name to number, or to a number and its relative tolerance."""
    found = []
    for name, right in expected.items():
        right, tolerance = right if isinstance(right, list) else (right, 0.02)
        value = values.get(name)
        if value is None or abs(value - right) > tolerance * abs(right):
            found.append(f"{name} {value} is not {right}")
    return found


def figures(program, model):
    json_of = json.loads(run(program, "info", model, "--json").stdout)
    model = json_of.get("model") or json_of
    low, high = model.get("bounds_min"), model.get("bounds_max")
    values = dict(model)
    if low:
        values.update({f"{axis}{end}": b[i] for end, b in (("min", low), ("max", high)) for i, axis in enumerate("xyz")})
    return values


def verdict(program, path, name, folder):
    case = VALUES.get(name, {})
    result = os.path.join(folder, "out." + case.get("to", "vdb"))
    words = ["convert", path, "-o", result, *case.get("options", ["--resolution", "96"])]
    done = run(program, *words)
    said = [line.replace(str(path), path.name).replace("vdb_synth: ", "").replace("vdb_synth convert: ", "")
            for line in done.stderr.splitlines()]
    if done.returncode != 0:
        # A message of what helps stands for the file in the list.
        right = case.get("exit", done.returncode) == done.returncode and done.returncode in (1, 2, 3)
        right = right and len([line for line in said if "error: " in line]) == 1 and case.get("says", "") in done.stderr
        return f"exit {done.returncode}", "refused" if right and "values" not in case else "wrong", " ".join(said[-1:])
    values = figures(program, result)
    if case.get("info"):
        values = figures(program, path)
    wrong = differences(case.get("values", {}), values)
    if case.get("exit", 0) != 0 or case.get("says", "") not in done.stderr:
        wrong.append("nothing was said")
    if "valid" in values and not values["valid"]:
        wrong.append("not valid")
    os.remove(result)
    size = f"volume {values.get('signed_volume', 0):.6g}"
    return size, "wrong: " + ", ".join(wrong) if wrong else "right", "; ".join(said)


def main(program, samples, part=""):
    print("| file | result | verdict | what was said |\n|---|---|---|---|")
    count = {"right": 0, "refused": 0, "wrong": 0}
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(pathlib.Path(samples).rglob("*")):
            name = str(path.relative_to(samples))
            hidden = path.suffix in (".md", ".bin") or not path.is_file() or not name.startswith(part)
            if hidden or path.parent.name.startswith(("31-", "32-", "33-", "34-")) and path.suffix not in (".gltf", ".glb"):
                continue
            result, right, said = verdict(program, path, name, folder)
            count[right.split(":")[0]] += 1
            print(f"| {name} | {result} | {right} | {said.replace('|', '/')} |", flush=True)
    print(f"\n{count['right']} right, {count['refused']} refused with a reason, {count['wrong']} wrong.")
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
