"""What options promise: nothing is lost, nothing says where files lay, help tells what a command can use."""
import json
import os
import unittest

from support import CliTest

COMMANDS = "convert info crop mask match synth analogy texture repeat compare render make relief-extract".split()


class Answers(CliTest):
    """info, match and compare write JSON with -o; before, -o left the user's file empty."""

    def setUp(self):
        super().setUp()
        self.ok("make", "grid", "a.vdb", "--resolution", 24)
        self.ok("make", "balls", "b.vdb", "--resolution", 24)
        self.write("old.json", "kept")
        self.write("old.vdb", "kept")

    def test_an_answer_goes_into_the_file(self):
        for words in (["info", "a.vdb"], ["match", "a.vdb", "b.vdb", "--block", 8, "--at", "0,0,0"], ["compare", "a.vdb", "b.vdb"]):
            with self.subTest(words):
                printed = self.ok(*words, "--json").stdout
                result = self.ok(*words, "-o", "old.json")
                self.assertEqual(result.stdout, "")
                self.assertEqual(self.read("old.json").decode(), printed)
                self.assertEqual(self.ok(*words, "-o", "-.json").stdout, printed)
                json.loads(printed)

    def test_another_kind_of_file_is_refused_and_kept(self):
        for words in (["info", "a.vdb"], ["match", "a.vdb", "b.vdb", "--at", "0,0,0"], ["compare", "a.vdb", "b.vdb"]):
            with self.subTest(words):
                self.fails(2, "--output old.vdb: unknown extension; must be a .json file", *words, "-o", "old.vdb")
                self.fails(2, "--output: given twice", *words, "-o", "old.json", "-o", "new.json")
        self.assertEqual(self.read("old.vdb"), b"kept")
        self.assertEqual(self.read("old.json"), b"kept")
        self.assertEqual(self.files(), ["a.vdb", "b.vdb", "old.json", "old.vdb"])

    def test_a_failed_run_keeps_the_file(self):
        self.fails(1, "outside the query's domain", "match", "a.vdb", "b.vdb", "--at", "99,0,0", "-o", "old.json")
        self.fails(3, "missing.vdb", "info", "missing.vdb", "-o", "old.json")
        self.assertEqual(self.read("old.json"), b"kept")


class Overwriting(CliTest):
    def setUp(self):
        super().setUp()
        self.ok("make", "grid", "a.vdb", "--resolution", 24)
        self.ok("mask", "box", "-o", "m.vdb", "--box", "0,0,0,23,23,23")
        os.symlink("a.vdb", self.path("link.vdb"))
        os.link(self.path("a.vdb"), self.path("hard.vdb"))
        self.write("c.json", "{}")

    def test_an_output_that_is_an_input_needs_force(self):
        before = {name: self.read(name) for name in ("a.vdb", "m.vdb", "c.json")}
        synth = ["synth", "a.vdb", "--size", "2x,1x,1x"]
        for words in (["convert", "a.vdb", "-o", "a.vdb"], ["convert", "a.vdb", "-o", "./a.vdb"], ["convert", "a.vdb", "-o", self.path("a.vdb")],
                      ["convert", "a.vdb", "-o", "link.vdb"], ["convert", "link.vdb", "-o", "hard.vdb"],
                      ["convert", "a.vdb", "-o", "new.vdb", "-o", "a.vdb"], ["convert", "a.vdb", "-o", "new.vdb", "--report", "a.vdb"],
                      ["convert", "a.vdb", "-o", "new.vdb", "--config", "c.json", "--report", "c.json"],
                      [*synth, "-o", "m.vdb", "--exemplar-mask", "m.vdb"], [*synth, "-o", "new.vdb", "--source-map", "a.vdb"],
                      [*synth, "-o", "m.vdb", "--guide", "m.vdb:mask", "--exemplar-guide", "a.vdb"],
                      ["synth", "--keep", "a.vdb", "--hole", "m.vdb", "-o", "a.vdb"],
                      ["match", "a.vdb", "a.vdb", "--at", "0,0,0", "--mask", "m.vdb", "--report", "m.vdb"],
                      ["compare", "a.vdb", "a.vdb", "--map", "m.vdb", "--report", "m.vdb"]):
            with self.subTest(words):
                self.fails(2, "--force", *words)
        for name, content in before.items():
            self.assertEqual(self.read(name), content, name)
        self.assertNotIn("new.vdb", self.files())

    def test_with_force_it_is_replaced_at_the_end(self):
        self.ok("convert", "a.vdb", "-o", "a.ply")
        self.ok("crop", "a.vdb", "-o", "a.vdb", "--box", "0,0,0,11,23,23", "--force")
        model = json.loads(self.ok("info", "a.vdb", "--json").stdout)["model"]
        self.assertEqual(model["domain"], "0,0,0,11,23,23")

    def test_force_comes_from_a_config_too(self):
        self.write("f.json", '{"force": true, "output": "a.vdb", "half-width": 4}')
        self.ok("convert", "a.vdb", "--config", "f.json")
        self.write("g.json", '{"output": "a.vdb"}')
        self.fails(2, "--force", "convert", "a.vdb", "--config", "g.json")


class Help(CliTest):
    def options(self, command):
        return {word.strip(",") for line in self.ok(command, "--help").stdout.splitlines() if line.startswith("  -")
                for word in line.split()[:2] if word.startswith("--")}

    def test_a_command_shows_what_it_takes(self):
        for option in ("--labels", "--height", "--iso", "--plane", "--open"):
            self.assertNotIn(option, self.options("make"))
            self.assertIn(option, self.options("convert"))
        self.assertNotIn("--seed", self.options("render"))
        for command in COMMANDS:
            shown = self.options(command)
            self.assertLessEqual({"--output", "--threads", "--config", "--report", "--force", "--help"}, shown)
            # What is shown is taken: another error than that of an option nobody knows.
            for option in shown - {"--help", "--version"}:
                self.assertNotRegex(self.run_tool(command, option, "x").stderr, "is no option of|unknown option")

    def test_lines_fit_a_terminal(self):
        for command in COMMANDS:
            lines = self.ok(command, "--help").stdout.splitlines()
            for line in [l for l in lines if l.startswith("  ")][:-1]:
                self.assertLessEqual(len(line), 110, line)


class Moved(CliTest):
    """Bytes do not depend on the folders that inputs lie in: of every option that names a file."""

    def setUp(self):
        super().setUp()
        for folder in ("one", "two"):
            os.mkdir(self.path(folder))
        self.make("one")
        for name in os.listdir(self.path("one")):
            os.rename(self.path(f"one/{name}"), self.path(name))

    def make(self, folder):
        place = {"cwd": self.path(folder)}
        self.ok("make", "sponge", "a.vdb", "--resolution", 32, **place)
        self.ok("make", "grid", "b.vdb", "--resolution", 32, **place)
        self.ok("mask", "box", "-o", "left.vdb", "--box", "0,0,0,31,31,31", **place)
        self.ok("mask", "box", "-o", "all.vdb", "--box", "-9,-9,-9,63,63,63", **place)
        self.ok("crop", "a.vdb", "-o", "hole.vdb", "--box", "10,10,10,19,19,19", **place)
        self.ok("make", "grooves", "p.vdb", "p2.vdb", "--resolution", 48, **place)
        self.ok("make", "three-tori", "t.vdb", "--resolution", 32, **place)

    def both(self, *words, output="o.vdb"):
        """Runs in the folder with plain names, and from another folder with absolute paths; `@` marks a path."""
        plain = [str(w).replace("@", "") for w in words]
        self.ok(*plain, "-o", "one/" + output)
        far = [str(w).replace("@", self.folder + "/") for w in words]
        self.ok(*far, "-o", self.path("two/" + output), cwd="/")
        first = self.read("one/" + output)
        self.assertEqual(first, self.read("two/" + output), words)
        self.assertNotIn(self.folder.encode(), first)
        return first

    def test_options_of_synth(self):
        synth = ["synth", "@a.vdb", "--size", "2x,1x,1x", "--draft"]
        default = ["synth", "@a.vdb", "--size", "40,32,32"]
        self.both(*synth, "--exemplar-mask", "@left.vdb")
        self.both("synth", "@a.vdb", "@b.vdb", "--size", "40,32,32", "--exemplar-map", "@left.vdb")
        self.both("synth", "@a.vdb", "@b.vdb", "--size", "40,32,32", "--exemplar-map", "@b.vdb")
        self.both(*default, "--guide", "@b.vdb:surface", "--exemplar-guide", "@a.vdb:surface")
        self.both(*default, "--rotation-map", "@left.vdb")
        self.both(*default, "--scale-map", "@all.vdb")
        self.both("synth", "--keep", "@a.vdb", "--hole", "@hole.vdb")
        self.both("synth", "--keep", "@a.vdb", "--hole", "10,10,10,19,19,19")

    def test_options_of_analogy(self):
        analogy = ["analogy", "@p.vdb", "@p2.vdb", "@t.vdb", "--sweeps", 1, "--levels", 1]
        self.ok(*[str(w).replace("@", "") for w in analogy], "-o", "d.vdb", "--write-directions")
        self.both(*analogy, "--direction", "@d.vdb:direction")
        self.write("s.csv", "32,10,32,1,0,0\n32,54,32,-1,0,0\n")
        self.both(*analogy, "--direction", "@s.csv", "--exemplar-direction", "axis:x")
        self.both(*analogy, "--mask", "@b.vdb")

    def test_other_commands(self):
        self.both("convert", "@a.vdb", "--half-width", 4)
        self.both("crop", "@a.vdb", "--box", "0,0,0,9,9,9")
        self.both("mask", "inside", "@a.vdb")
        self.both("mask", "range", "@a.vdb", "--range", "-1,1")
        self.ok("synth", "a.vdb", "-o", "m.vdb", "--size", "2x,1x,1x", "--source-map")
        self.both("repeat", "@m.vdb", "@a.vdb")

    def test_a_config_leaves_no_path(self):
        with open(self.path("c.json"), "w", encoding="utf-8") as file:
            json.dump({"exemplar-mask": self.path("left.vdb"), "size": "2x,1x,1x", "draft": True}, file)
        self.assertNotIn(b"left.vdb:", self.both("synth", "@a.vdb", "--config", "@c.json"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
