"""Job files of `vdb_synth batch` and their plans. Plain Python, without hou and pdg."""
import json
import os
import subprocess

import vdbsynth_tool as tool


def variations(command, inputs, output, options, matrix):
    """A batch of one command with every combination of `matrix`, such as {"seed": "1-8", "size": ["2x,2x,1x", "3x,3x,1x"]}. Each key is one of the
    command's options; `output` has a ${key} for each. Raises ValueError where two jobs would write the same file."""
    missing = [key for key in matrix if "${%s}" % key not in output]
    if missing:
        raise ValueError(f"{output}: needs " + ", ".join("${%s}" % key for key in missing) + ", or jobs overwrite each other")
    return {"jobs": [{"name": command, "command": command, "inputs": list(inputs), "output": output,
                      "options": {**options, **{key: "${%s}" % key for key in matrix}}, "matrix": dict(matrix)}]}


def write_jobs(path, jobs):
    partial = f"{path}.{os.getpid()}.tmp"
    with open(partial, "w") as file:
        json.dump(jobs, file, indent=2)
        file.write("\n")
    os.replace(partial, path)


class Step:
    """One job of a plan: the words of its command line, absolute paths of what it writes, and the names of the steps before it."""

    def __init__(self, name, words, writes, after):
        self.name, self.words, self.writes, self.after = name, words, writes, after


def plan(path, program=""):
    """The steps of a job file, each after those that it waits for. Every mistake in the file is found here, before anything runs. Raises ToolError."""
    program = tool.find_program(program)
    answer = subprocess.run([program, "batch", path, "--dry-run", "--json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)
    if answer.returncode != 0:
        last = (answer.stderr.strip().splitlines() or [f"vdb_synth ended with code {answer.returncode}"])[-1]
        raise tool.ToolError(last.partition(": error: ")[2] or last, answer.returncode)
    whole = json.loads(answer.stdout)
    folder = os.path.join(os.path.dirname(os.path.abspath(path)), whole.get("folder", "."))
    steps = [Step(job["name"], [program] + job["words"], [os.path.normpath(os.path.join(folder, one)) for one in job["writes"]], job["after"])
             for job in whole["jobs"]]
    return folder, ordered(steps)


def ordered(steps):
    waiting, done, names = list(steps), [], set()
    while waiting:
        ready = [step for step in waiting if names.issuperset(step.after)]
        if not ready:
            raise ValueError("jobs wait for each other: " + ", ".join(step.name for step in waiting))
        done += ready
        names.update(step.name for step in ready)
        waiting = [step for step in waiting if step.name not in names]
    return done


def quoted(word):
    """For a shell on Linux and macOS."""
    import shlex
    return shlex.quote(word)


def shell_line(step, folder):
    """What a scheduler runs: in the job file's folder, with folders of outputs made first."""
    made = sorted({os.path.dirname(path) for path in step.writes})
    line = " ".join(quoted(word) for word in step.words + ["--progress", "off"])
    before = "mkdir -p " + " ".join(quoted(path) for path in made) + " && " if made else ""
    return f"sh -c {quoted(f'cd {quoted(folder)} && {before}exec {line}')}"
