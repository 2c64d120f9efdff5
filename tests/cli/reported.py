"""What the tests of reported files share: one conversion, and what came out of it as numbers.

The files are samples of their own licences and never part of the project: a test without them is skipped."""
import json
import os

from support import CliTest, sample


class Outcome:
    """Of `convert FILE -o o.ply` (or .vdb): exit code, what was said, and `info` of the result."""

    def __init__(self, code, said, info):
        self.code, self.said, self.info = code, said, info
        self.model = (info or {}).get("model") or {}

    @property
    def volume(self):
        return self.info["signed_volume"]

    @property
    def area(self):
        return self.info["area"]

    @property
    def bounds(self):
        return self.info["bounds_min"] + self.info["bounds_max"]


class Reported(CliTest):
    def file(self, name):
        return sample(os.path.join("reported", name))

    def convert(self, name, *options, to="o.ply", resolution=80):
        """@param name  a file of the reported ones, or an absolute path"""
        path = name if os.path.isabs(name) else self.file(name)
        size = ["--resolution", resolution] if resolution else []
        done = self.run_tool("convert", path, "-o", to, *size, *options)
        info = None
        if done.returncode == 0:
            info = json.loads(self.ok("info", to, "--json").stdout)
        return Outcome(done.returncode, done.stderr, info)

    def info(self, name, *options):
        path = name if os.path.isabs(name) else self.file(name)
        return json.loads(self.ok("info", path, "--json", *options).stdout)

    def near(self, value, right, tolerance=0.02):
        """@param tolerance  relative"""
        self.assertLessEqual(abs(value - right), tolerance * abs(right), f"{value} is not {right}")
