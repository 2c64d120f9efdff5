"""docs/troubleshooting.md: each heading that quotes a message has the words of the sources, and of a real run."""
import functools
import os
import re
import unittest

from support import SOURCE, CliTest

PAGE = SOURCE / "docs" / "troubleshooting.md"
FOLDERS = ["libvdbsynth", "tools/vdb_synth", "python", "blender", "houdini_examples/scripts"]
# Comments and characters are matched too, so that a quote in them opens no text.
TOKEN = re.compile(r"""//[^\n]*|/\*.*?\*/|'(?:[^'\\\n]|\\.){1,4}'|"((?:[^"\\\n]|\\.)*)\"""", re.S)
PYTHON_TOKEN = re.compile(r"""\"{3}.*?\"{3}|(?<![\w"])#[^\n]*|"((?:[^"\\\n]|\\.)*)\"""", re.S)
ESCAPES = {"\\n": "\n", "\\t": "\t", '\\"': '"', "\\\\": "\\"}
LEAST = 40  # messages on the page


def headings():
    return re.findall(r"^### `(.+)`$", PAGE.read_text(), re.M)


def fragments(heading):
    """The fixed words of a heading: what stands between its <placeholders>."""
    parts = [part.strip(" :") for part in re.split(r"<[^<>]*>", heading)]
    return [part for part in parts if len(re.findall(r"[A-Za-z]", part)) >= 3]


def spoken(text):
    """A message as the command line prints it: `maxMemory` is --max-memory."""
    return re.sub(r"`([a-z][A-Za-z]*)`", lambda field: "--" + re.sub("[A-Z]", lambda c: "-" + c[0].lower(), field[1]), text)


def literals(path):
    """All texts of a source file, one a line; those that the language joins are one."""
    source, texts, end = path.read_text(errors="replace"), [], None
    for token in (PYTHON_TOKEN if path.suffix == ".py" else TOKEN).finditer(source):
        if token[1] is None:
            continue
        text = "".join(ESCAPES.get(piece, piece) for piece in re.split(r"(\\.)", token[1]))
        if end is not None and re.fullmatch(r"\s*f?", source[end:token.start()]):
            texts[-1] += text
        else:
            texts.append(text)
        end = token.end()
    return spoken("\n".join(texts))


@functools.lru_cache(maxsize=None)
def said():
    return [literals(path) for path in sources()]


def holds(text, part):
    """Whether `part` is in `text`, whole or as at most three pieces of six characters or more."""
    for _ in range(3):
        length = next((n for n in range(len(part), min(6, len(part)) - 1, -1) if part[:n] in text), 0)
        part = part[length:]
        if not part or not length:
            break
    return not part


def is_said(heading, texts):
    return any(all(holds(text, part) for part in fragments(heading)) for text in texts)


def sources():
    for folder in FOLDERS:
        for path in sorted((SOURCE / folder).rglob("*")):
            if path.suffix in (".cpp", ".h", ".py"):
                yield path


class Words(unittest.TestCase):
    def test_each_message_is_in_one_source_file(self):
        quoted = headings()
        self.assertGreaterEqual(len(quoted), LEAST)
        lost = [heading for heading in quoted if not is_said(heading, said())]
        self.assertFalse(lost, "these headings of docs/troubleshooting.md are no messages of the sources any more")

    def test_each_message_has_words_of_its_own(self):
        for heading in headings():
            self.assertGreaterEqual(sum(len(part) for part in fragments(heading)), 7, heading)

    def test_no_heading_twice(self):
        quoted = headings()
        self.assertEqual(len(quoted), len(set(quoted)))

    def test_a_changed_message_would_be_noticed(self):
        for wrong in ("<file>: no such fylum", "<output>: named as an output thrice"):
            self.assertFalse(is_said(wrong, said()), wrong)


class Provoked(CliTest):
    """Messages as they are really printed match their headings."""

    def setUp(self):
        super().setUp()
        self.patterns = [re.compile(".+?".join(re.escape(p) for p in re.split(r"<[^<>]*>", h))) for h in headings()]

    def meets(self, code, *words):
        result = self.run_tool(*words)
        lines = [line for line in result.stderr.splitlines() if "error:" in line]
        self.assertEqual((result.returncode, len(lines)), (code, 1), f"{words}: {result.stderr}")
        self.assertTrue(any(p.search(lines[0]) for p in self.patterns), f"no heading for: {lines[0]}")

    def test_command_line(self):
        self.meets(2, "cnvert")
        self.meets(2, "convert", "--resolutoin", 12)
        self.meets(2, "convert", "a.obj", "-o")
        self.meets(2, "convert", "a.obj", "-o", "a.vdb", "--seed", 1, "--seed", 2)
        self.meets(2, "convert", "a.obj", "-o", "a.vdb", "--resolution", "many")
        self.meets(2, "convert", "-o", "a.vdb")
        self.meets(2, "analogy", "a.vdb", "-o", "a.vdb")
        self.meets(2, "convert", "a.obj", "b.obj", "-o", "a.vdb")
        self.meets(2, "convert", "a.obj")
        self.meets(2, "synth", "a.vdb", "-o", "b.vdb")
        self.meets(2, "convert", "a.obj", "-o", "a.vdb", "--voxel-size", 1, "--resolution", 9)
        self.meets(2, "convert", "a.obj", "-o", "a.vdb", "--open", "shell")
        self.meets(2, "convert", "a.obj", "-o", "a.####.vdb")
        self.meets(2, "convert", "a.####.obj", "-o", "a.vdb", "--frames", "1-2")
        self.meets(2, "analogy", "a.vdb", "b.vdb", "c.vdb", "d.vdb", "-o", "e.vdb")
        self.meets(2, "make", "grooves", "a.vdb")
        self.meets(2, "make", "nothing", "a.vdb")

    def test_files(self):
        for name in ("a.fbx", "a.zip", "a.laz", "a.vdb", "a.obj", "a.off"):
            self.write(name, "OFF\n9999999 1 0\n" if name == "a.off" else "nothing\n")
        self.write("empty.obj", "")
        self.write("comma.obj", "v 1,5 0,5 0,0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
        os.mkdir(self.path("folder.obj"))
        for code, name in ((3, "none.obj"), (3, "folder.obj"), (2, "a.fbx"), (2, "a.zip"), (2, "a.laz"), (3, "a.vdb"), (3, "empty.obj"),
                           (3, "comma.obj"), (3, "a.off")):
            self.meets(code, "convert", name, "-o", "out.vdb")
        self.meets(2, "convert", "a.obj", "-o", "a.obj")
        self.meets(3, "convert", "a.obj", "-o", "x.vdb")
        self.meets(2, "convert", "a.obj", "-o", "x.docx")
        self.meets(3, "make", "grid", "none/x.vdb")

    def test_models(self):
        self.write("points.obj", "v 0 0 0\nv 0 1 0\nv 0 0 1\n")
        self.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
        self.meets(1, "convert", "points.obj", "-o", "x.vdb")
        self.meets(1, "convert", "sheet.obj", "-o", "x.vdb")
        self.meets(2, "convert", "sheet.obj", "-o", "x.vdb", "--open", "shell", "--thickness", 1e-4)
        self.ok("make", "grid", "grid.vdb", "--resolution", 24)
        self.meets(1, "synth", "grid.vdb", "-o", "x.vdb", "--size", "8,8,8")
        self.meets(1, "crop", "grid.vdb", "-o", "x.vdb", "--box", "900,900,900,950,950,950")
        self.meets(1, "match", "grid.vdb", "grid.vdb", "--block", 40, "--at", "0,0,0")
        self.meets(3, "convert", "grid.vdb", "-o", "x.vdb", "--grid", "nothing")
        self.meets(3, "repeat", "grid.vdb", "grid.vdb", "-o", "x.vdb")
        self.meets(1, "synth", "grid.vdb", "-o", "x.vdb", "--size", "400x,400x,400x", "--max-memory", "200M")

    def test_batches(self):
        self.write("broken.json", '{"jobs": [')
        self.write("key.json", '{"jobs": [{"name": "a", "command": "info", "inputs": "a", "inptus": "b"}]}')
        self.write("variable.json", '{"jobs": [{"name": "a", "command": "info", "inputs": "${b}"}]}')
        self.write("missing.json", '{"jobs": [{"name": "a", "command": "info", "inputs": "a.vdb"}]}')
        self.write("circle.json", '{"jobs": [{"name": "a", "command": "make", "inputs": "grid", "output": "a.vdb", "after": "b"},'
                                  '{"name": "b", "command": "make", "inputs": "grid", "output": "b.vdb", "after": "a"}]}')
        self.write("after.json", '{"jobs": [{"name": "a", "command": "make", "inputs": "grid", "output": "a.vdb", "after": "c"}]}')
        for code, name in ((3, "broken"), (2, "key"), (2, "variable"), (3, "missing"), (2, "circle"), (2, "after")):
            self.meets(code, "batch", name + ".json")


if __name__ == "__main__":
    unittest.main(verbosity=2)
