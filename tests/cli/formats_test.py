"""Files of another version of the program: each is said in one line, and nothing is misread in silence."""
import json
import os
import struct
import unittest

from support import CliTest


def text_entry(name, value):
    """An entry of metadata as OpenVDB stores it."""
    word = lambda text: struct.pack("<I", len(text)) + text.encode()
    return word(name) + word("string") + word(value)


class Formats(CliTest):
    def replace(self, path, old, new):
        content = self.read(path)
        self.assertGreaterEqual(content.count(old), 1)
        self.write(path, content.replace(old, new))

    def warnings(self, *words):
        return [l for l in self.ok(*words).stderr.splitlines() if "warning" in l]

    def test_metadata_of_a_newer_program(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        for words in (["info", "g.vdb"], ["convert", "g.vdb", "-o", "x.obj"]):
            self.assertEqual(self.warnings(*words), [])
        self.replace("g.vdb", text_entry("vdbsynth:format", "1"), text_entry("vdbsynth:format", "2"))
        said = "vdb_synth: warning: g.vdb: its metadata are of format 2, written by vdb_synth "
        for words in (["info", "g.vdb"], ["convert", "g.vdb", "-o", "x.obj"], ["synth", "g.vdb", "-o", "x.vdb", "--size", "32,24,24"]):
            with self.subTest(words):
                lines = self.warnings(*words)
                self.assertEqual(len(lines), 1, lines)
                self.assertTrue(lines[0].startswith(said), lines)
                self.assertIn("this version knows format 1", lines[0])

    def test_a_source_map_of_another_program(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        self.ok("synth", "g.vdb", "-o", "m.vdb", "--size", "32,24,24", "--source-map")
        self.ok("repeat", "m.vdb", "g.vdb", "-o", "r.vdb")
        self.replace("m.vdb", text_entry("vdbsynth:map:format", "2"), text_entry("vdbsynth:map:format", "3"))
        self.fails(3, "m.vdb: its source map is of format 3, of another version of vdb_synth; this one reads format 2: create the map again",
                   "repeat", "m.vdb", "g.vdb", "-o", "r.vdb")

    def test_a_kept_index_of_another_program(self):
        self.ok("make", "grid", "g.vdb", "--resolution", 24)
        os.mkdir(self.path("kept"))
        match = ["match", "g.vdb", "g.vdb", "--block", 8, "--at", "2,3,4", "--index-cache", "kept"]
        answer = self.ok(*match).stdout
        name, = os.listdir(self.path("kept"))
        self.replace("kept/" + name, b"UVDBIDX2", b"UVDBIDX9")
        result = self.ok(*match)
        self.assertEqual(result.stdout, answer)
        self.assertEqual(result.stderr.splitlines(), [
            f"vdb_synth: warning: kept/{name}: is a search index of format 9, of another version of vdb_synth; this one reads format 2; it is rebuilt"])
        self.assertEqual(self.read("kept/" + name)[:8], b"UVDBIDX2")
        self.assertEqual(self.warnings(*match), [])

    def test_a_batch_record_of_another_program(self):
        self.write("j.json", json.dumps({"jobs": [{"name": "a", "command": "make", "inputs": "grid", "output": "a.vdb", "options": {"resolution": 16}}]}))
        self.ok("batch", "j.json")
        self.assertIn("1 up to date", self.ok("batch", "j.json").stderr)
        record = json.loads(self.read("j.logs/manifest.json"))
        for change, said in (({"format": 7, "version": "9.8.7"}, "is of format 7, written by vdb_synth 9.8.7; this version reads format 1: it is made anew and all jobs run"),
                             ({"version": "0.0.1"}, "was written by vdb_synth 0.0.1; with ")):
            with self.subTest(change):
                self.write("j.logs/manifest.json", json.dumps({**record, **change}))
                lines = [l for l in self.ok("batch", "j.json").stderr.splitlines() if "manifest.json" in l]
                self.assertEqual(len(lines), 1, lines)
                self.assertIn(said, lines[0])
        self.assertEqual([l for l in self.ok("batch", "j.json").stderr.splitlines() if "manifest.json" in l], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
