"""What the tests of the night shift need: a small disk, a folder that cannot be written, a group with little memory."""
import os
import pathlib
import subprocess
import unittest

PAGE = 4096  # tmpfs gives space in pages
PATIENCE = 1800  # seconds for a step of a second, on a machine that does other things


def number(variable, default):
    """How many rounds a test makes: an environment variable makes it longer."""
    return int(os.environ.get(variable, default))


def mount(*words):
    if subprocess.run(["mount", *words], capture_output=True).returncode:
        raise unittest.SkipTest("mounting needs root, and a system that permits it")


class SmallDisk:
    """A disk in memory with `room` bytes that are free, in whole pages."""

    def __init__(self, folder, room=0):
        self.folder = folder
        os.makedirs(folder, exist_ok=True)
        mount("-t", "tmpfs", "-o", "size=64m", "none", folder)
        self.fill(room)

    def fill(self, room):
        """Leaves that much room, whatever else is on the disk."""
        ballast = os.path.join(self.folder, "ballast")
        with open(ballast, "wb"):
            pass
        state = os.statvfs(self.folder)
        size = state.f_bavail * state.f_frsize - -(-room // PAGE) * PAGE
        with open(ballast, "wb") as file:
            os.posix_fallocate(file.fileno(), 0, size) if size > 0 else None

    def free(self):
        os.remove(os.path.join(self.folder, "ballast"))

    def names(self):
        return sorted(name for name in os.listdir(self.folder) if name != "ballast")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "--lazy", self.folder], capture_output=True)


class ReadOnly:
    """The same folder under another name, where nothing can be written, not even by root."""

    def __init__(self, folder, name):
        self.name = name
        os.makedirs(name, exist_ok=True)
        mount("--bind", folder, name)
        if subprocess.run(["mount", "-o", "remount,ro,bind", name], capture_output=True).returncode:
            self.__exit__()
            raise unittest.SkipTest("a folder cannot be mounted read-only here")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "--lazy", self.name], capture_output=True)


class MemoryGroup:
    """A control group, of version 1 or 2, whose processes the kernel kills when they take more than `bytes_`."""

    def __init__(self, bytes_):
        first = pathlib.Path("/sys/fs/cgroup/memory")
        limit, root = ("memory.limit_in_bytes", first) if first.is_dir() else ("memory.max", pathlib.Path("/sys/fs/cgroup"))
        self.folder = root / f"vdbsynth_test_{os.getpid()}"
        try:
            self.folder.mkdir()
            (self.folder / limit).write_text(str(bytes_))
            if (self.folder / "memory.swap.max").exists():
                (self.folder / "memory.swap.max").write_text("0")
        except OSError as error:
            self.__exit__()
            raise unittest.SkipTest(f"a control group with a limit of memory cannot be made here: {error}")

    def enter(self):
        """For a child before it executes the program."""
        (self.folder / "cgroup.procs").write_text(str(os.getpid()))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.folder.is_dir():
            self.folder.rmdir()


def children_of(process):
    """Ids of the processes that this one started."""
    try:
        return [int(word) for word in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []


def resident_bytes(process):
    """Memory that a process has now; 0 when it ended."""
    try:
        for line in pathlib.Path(f"/proc/{process}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return 0
