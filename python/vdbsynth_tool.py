"""Runs the vdb_synth program from Python 3.7 or later: command lines, progress, cancel and errors, with nothing but the standard library.

What Blender's and Houdini's examples stand on: a process of its own can be cancelled, uses all cores without the host's lock, and cannot take the host
down with it. Nothing here blocks but Job.wait and run.

    job = Job("synth", ["rock.vdb"], ["more.vdb"], {"size": "2x,2x,1x", "seed": 7})
    while not job.poll().done:
        print(job.state.stage, job.state.fraction)
    job.raise_on_error()
"""
import json
import os
import queue
import shutil
import signal
import subprocess
import threading

PROGRAM_VARIABLE = "VDB_SYNTH"  # a path in this variable of the environment goes before PATH
CANCELLED = (130, 143)


class ToolError(Exception):
    """The program's one-line error. `code` is its exit code: 1 unusable input, 2 a bad option, 3 a bad file, 130 cancelled."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


def find_program(given=""):
    """The program's path: `given`, the environment's VDB_SYNTH, or what PATH has. Raises ToolError, saying where it was looked for."""
    for path in (given, os.environ.get(PROGRAM_VARIABLE, "")):
        if not path:
            continue
        path = os.path.expanduser(path)
        if os.path.isdir(path):
            path = os.path.join(path, "vdb_synth")
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
        raise ToolError(f"{path}: is no program; give the path of vdb_synth", 2)
    found = shutil.which("vdb_synth")
    if not found:
        raise ToolError(f"vdb_synth is not on PATH; install it, or set {PROGRAM_VARIABLE} to its path", 2)
    return found


def option_words(options):
    """{"size": "2x,2x,1x", "draft": True, "seed": 7, "scale": None} as words: names without dashes, _ or - inside; True is a flag; None and False are left
    out; a list repeats the option."""
    words = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is None or one is False:
                continue
            words.append(flag)
            if one is not True:
                words.append(repr(one) if isinstance(one, float) else str(one))
    return words


def command_line(command, inputs, outputs, options=None, program=""):
    words = [find_program(program), command]
    words += [str(path) for path in inputs]
    for path in outputs:
        words += ["-o", str(path)]
    return words + option_words(options or {})


class State:
    """How far a job is."""

    def __init__(self):
        self.stage = ""      # what it does
        self.fraction = 0.0  # of the stage
        self.messages = []   # notes and warnings, without the program's name
        self.error = ""      # the last line of an error
        self.code = None     # exit code, once it is done

    @property
    def done(self):
        return self.code is not None

    @property
    def cancelled(self):
        return self.code in CANCELLED


class Job:
    """One run of the program, in the background from the start. Call poll from a timer; it never blocks."""

    def __init__(self, command, inputs, outputs, options=None, program="", folder=None):
        self.words = command_line(command, inputs, outputs, options, program) + ["--progress", "json"]
        self.state = State()
        self._lines = queue.Queue()
        try:
            # A group of its own: a host's ctrl-C is the host's to pass on.
            self._process = subprocess.Popen(self.words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                             errors="replace", cwd=folder, start_new_session=True)
        except OSError as error:
            raise ToolError(f"{self.words[0]}: {error.strerror}", 3) from error
        self._answer = []
        self._threads = [threading.Thread(target=self._read, args=(self._process.stderr, self._lines.put), daemon=True),
                         threading.Thread(target=self._read, args=(self._process.stdout, self._answer.append), daemon=True)]
        for thread in self._threads:
            thread.start()

    @staticmethod
    def _read(stream, take):
        for line in stream:
            take(line)
        stream.close()

    @property
    def answer(self):
        """What the program printed on standard output, such as the JSON of info and compare; complete once it is done."""
        return "".join(self._answer)

    def poll(self):
        code = self._process.poll()
        if code is not None:
            for thread in self._threads:
                thread.join()
        while True:
            try:
                self._take(self._lines.get_nowait().rstrip("\n"))
            except queue.Empty:
                break
        if code is not None:
            self.state.code = code if code >= 0 else 128 - code
            if code == 0:
                self.state.fraction = 1.0
        return self.state

    def _take(self, line):
        if line.startswith("{"):
            try:
                progress = json.loads(line)
                self.state.stage = str(progress["stage"])
                self.state.fraction = float(progress["done"]) / max(1.0, float(progress["total"]))
                return
            except (ValueError, KeyError, TypeError):
                pass
        if not line:
            return
        head, _, rest = line.partition(": error: ")
        if rest and head.startswith("vdb_synth"):
            self.state.error = rest
        elif line.startswith("vdb_synth: "):
            self.state.messages.append(line[len("vdb_synth: "):])
        else:
            self.state.messages.append(line)

    def cancel(self):
        """Asks the program to stop; it ends within moments, with nothing half-written."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)

    def wait(self, seconds=None):
        """Raises subprocess.TimeoutExpired."""
        self._process.wait(seconds)
        return self.poll()

    def raise_on_error(self):
        state = self.state
        if not state.done or state.code == 0:
            return
        if state.cancelled:
            raise ToolError("cancelled", state.code)
        raise ToolError(state.error or f"vdb_synth ended with code {state.code}", state.code)


def run(command, inputs, outputs, options=None, program="", folder=None):
    """Runs the program to its end. Returns the finished job; raises ToolError. ctrl-C cancels it and is raised again."""
    job = Job(command, inputs, outputs, options, program, folder)
    try:
        job.wait()
    except KeyboardInterrupt:
        job.cancel()
        job.wait()
        raise
    job.raise_on_error()
    return job
