"""One run of the program for a host: cached by content, with progress, cancel and every message. Plain Python, without hou."""
import hashlib
import json
import os
import time

import vdbsynth_tool as tool

FORMAT = "1"           # of the cache: another number makes every old entry void
UUID_AT, UUID_LENGTH = 21, 36
VDB_MAGIC = b" BDV\0\0\0\0"


class Request:
    """What to run. inputs: paths in the order of the command line; extension: of the result."""

    def __init__(self, command, inputs, options, extension, program=""):
        self.command, self.inputs, self.options, self.extension = command, list(inputs), dict(options), extension
        self.program = tool.find_program(program)


class Outcome:
    """Where the result lies. `cached`: it was there before."""

    def __init__(self, path, report, messages, cached):
        self.path, self.report, self.messages, self.cached = path, report, messages, cached

    @property
    def warnings(self):
        return [message[len("warning: "):] for message in self.messages if message.startswith("warning: ")]


def content_hash(path):
    """SHA-256 of a file. A .vdb's header has an identifier that is drawn anew on each write: it does not count."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        head = file.read(UUID_AT + UUID_LENGTH)
        digest.update(head[:UUID_AT] if head.startswith(VDB_MAGIC) else head)
        while True:
            block = file.read(1 << 20)
            if not block:
                return digest.hexdigest()
            digest.update(block)


def files_in_options(options):
    """Options may name files, also as FILE:GRID; what these hold counts as well as what they are called."""
    found = []
    for value in options.values():
        if isinstance(value, str):
            for path in (value, value.rpartition(":")[0]):
                if path and os.path.isfile(path):
                    found.append(path)
                    break
    return found


_versions = {}


def program_version(program):
    """Of the file as it is now: size and time stand for its content, so a new build makes new results."""
    state = os.stat(program)
    key = (program, state.st_size, state.st_mtime_ns)
    if key not in _versions:
        _versions[key] = hashlib.sha256(repr((state.st_size, state.st_mtime_ns)).encode()).hexdigest()
    return _versions[key]


def cache_key(request):
    """Names of the inputs do not count, their contents and order do."""
    parts = {"format": FORMAT, "command": request.command, "options": request.options, "extension": request.extension,
             "program": program_version(request.program), "inputs": [content_hash(path) for path in request.inputs],
             "kinds": [os.path.splitext(path)[1].lower() for path in request.inputs],
             "files": [content_hash(path) for path in files_in_options(request.options)]}
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def run(request, cache, progress=None, wait=0.1):
    """Runs the program, or takes the result of an earlier run from the folder `cache`. progress(stage, fraction) is called every `wait` seconds; when it
    raises, the program is stopped and the exception is raised again, which is how hosts cancel. Raises ToolError."""
    os.makedirs(cache, exist_ok=True)
    key = cache_key(request)
    result, record = os.path.join(cache, f"{key}.{request.extension}"), os.path.join(cache, f"{key}.record")
    if os.path.isfile(result) and os.path.isfile(record):
        try:
            with open(record) as file:
                kept = json.load(file)
            outcome = Outcome(result, kept["report"], kept["messages"], True)
            for path in (result, record):
                os.utime(path)
            return outcome
        except (ValueError, KeyError, OSError):
            pass  # a damaged record: run again
    report = os.path.join(cache, f"{key}.{os.getpid()}.report")
    try:
        job = follow(tool.Job(request.command, request.inputs, [result], {**request.options, "report": report}, request.program), progress, wait)
        with open(report) as file:
            facts = json.load(file)
    finally:
        if os.path.exists(report):
            os.remove(report)
    partial = f"{record}.{os.getpid()}"
    with open(partial, "w") as file:
        json.dump({"report": facts, "messages": job.state.messages}, file)
    os.replace(partial, record)  # last: an entry without a record is none
    return Outcome(result, facts, job.state.messages, False)


def follow(job, progress=None, wait=0.1):
    """Waits for a job. Whatever `progress` raises stops the program first."""
    try:
        while not job.poll().done:
            if progress:
                progress(job.state.stage, job.state.fraction)
            time.sleep(wait)
    except BaseException:
        job.cancel()
        job.wait()
        raise
    job.raise_on_error()
    return job


def trim(cache, most_bytes):
    """Removes the entries that were used longest ago until the rest takes at most `most_bytes`. Returns how many were removed."""
    entries = {}
    for name in os.listdir(cache):
        key = name.partition(".")[0]
        if len(key) == 32:
            entries.setdefault(key, []).append(os.path.join(cache, name))
    sized = sorted((max(os.path.getmtime(path) for path in paths), sum(os.path.getsize(path) for path in paths), paths)
                   for paths in entries.values())
    total, removed = sum(size for _, size, _ in sized), 0
    for _, size, paths in sized[:-1]:  # never the newest, which is in use
        if total <= most_bytes:
            break
        for path in paths:
            os.remove(path)
        total, removed = total - size, removed + 1
    return removed
