"""What the program tells of itself: versions, doctor, manual pages, and words for the shells."""
import json
import os
import pty
import re
import select
import shutil
import subprocess
import unittest

from support import PROGRAM, CliTest


def other(*words, **options):
    """Another program, which the test needs: skipped, saying so, where it is absent."""
    if not shutil.which(words[0]):
        raise unittest.SkipTest(f"{words[0]} is absent")
    return subprocess.run(words, capture_output=True, text=True, timeout=120, **options)


class Versions(CliTest):
    def test_libraries_as_they_run(self):
        lines = self.ok("--version").stdout.splitlines()
        self.assertRegex(lines[0], r"^vdb_synth \d+\.\d+\.\d+ \(OpenVDB \d+\.\d+\.\d+\)$")
        # What the system's linker would load, by the file's own name.
        loaded = other("ldd", PROGRAM).stdout
        for name, library in (("OpenVDB", "libopenvdb"), ("TBB", "libtbb"), ("Boost", "libboost_program_options"), ("zlib", "libz")):
            line = next(line for line in lines[1:] if line.split()[0] == name)
            path = re.search(rf"{library}\.so\S* => (\S+)", loaded).group(1)
            self.assertIn(os.path.basename(os.path.realpath(path)), line)
        self.assertEqual(self.ok("synth", "--version").stdout.splitlines(), lines)


class Doctor(CliTest):
    def test_text(self):
        text = self.ok("doctor").stdout
        for name in ("program", "built", "libraries", "system", "processor", "memory", "limits", "temporary files", "working folder",
                     "locale", "terminal", "note"):
            self.assertRegex(text, rf"(?m)^{name}  *\S")
        self.assertIn("no standard stream is one", text)

    def test_json_is_the_same_to_a_file(self):
        report = json.loads(self.ok("doctor", "--json", "--threads", 3, "--max-memory", "2G").stdout)
        self.assertEqual(report["processor"]["threads"], 3)
        self.assertEqual(report["memory"]["most_used"], 2000000000)
        self.assertIsNone(report["limits"]["virtual memory"])
        self.assertEqual(self.ok("doctor", "-o", "d.json").stdout, "")
        self.assertEqual(json.loads(self.read("d.json"))["program"], report["program"])
        self.fails(2, "one input too many", "doctor", "x.vdb")

    def test_limits_are_those_of_the_caller(self):
        result = subprocess.run(["bash", "-c", "ulimit -n 321; ulimit -f 5000000; exec \"$0\" doctor --json", PROGRAM], capture_output=True, text=True,
                                cwd=self.folder, timeout=60)
        report = json.loads(result.stdout)
        self.assertEqual(report["limits"]["open files"], 321)
        self.assertEqual(report["limits"]["file size"], 5000000 * 1024)
        self.assertTrue([note for note in report["notes"] if "file size is 5.12 GB" in note], report["notes"])

    def test_no_secrets(self):
        secret = {"API_TOKEN": "hunter2", "PASSWORD": "hunter2", "HOME": self.folder, "LANG": "de_XX.UTF-8", "TMPDIR": self.folder}
        for words in (["doctor"], ["doctor", "--json"]):
            text = self.ok(*words, env={**os.environ, **secret, "LC_ALL": "de_XX.UTF-8"}).stdout
            self.assertNotIn("hunter2", text)
            self.assertNotIn(self.folder, text)
            self.assertNotIn(os.uname().nodename + " ", text)
            self.assertIn("de_XX.UTF-8", text)
            self.assertIn("the locale of the environment is not installed", text)

    def test_trouble_is_a_note(self):
        text = self.ok("doctor", env={**os.environ, "TMPDIR": "/no/such/folder"}).stdout
        self.assertIn("note            the folder for temporary files is not there; set TMPDIR to one that is", text)


class Manual(CliTest):
    def pages(self):
        commands = re.findall(r"(?m)^  ([a-z-]+)  ", self.ok("--help").stdout)
        self.assertGreater(len(commands), 15)
        pages = {"vdb_synth": self.ok("help", "--man").stdout}
        for command in commands:
            pages["vdb_synth-" + command] = self.ok("help", "--man", command).stdout
        return pages

    def test_groff_and_mandoc_have_no_complaint(self):
        checked = []
        for name, page in self.pages().items():
            path = self.write(name + ".1", page)
            for tool in (["groff", "-man", "-Tutf8", "-ww", "-z"], ["mandoc", "-T", "lint", "-W", "warning"]):
                if shutil.which(tool[0]):
                    result = other(*tool, path)
                    self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""), (tool, name))
                    checked.append(tool[0])
        if not checked:
            self.skipTest("neither groff nor mandoc is here")

    def test_man_shows_the_options(self):
        path = self.write("vdb_synth-synth.1", self.ok("help", "--man", "synth").stdout)
        result = other("man", "--no-hyphenation", "--no-justification", "-l", path, env={**os.environ, "MANWIDTH": "200", "LC_ALL": "C.UTF-8"})
        self.assertEqual(result.returncode, 0, result.stderr)
        text = result.stdout
        for words in ("vdb_synth synth EXEMPLAR... -o OUT --size X,Y,Z [options]", "-o, --output FILE", "--longest-run S", "EXIT STATUS",
                      "texture optimization"):
            self.assertIn(words, text)

    def test_help_of_a_command(self):
        self.assertEqual(self.ok("help", "synth").stdout, self.ok("synth", "--help").stdout)
        self.assertEqual(self.ok("help").stdout, self.ok("--help").stdout)
        self.fails(2, "help sinth: unknown command; did you mean synth?", "help", "sinth")


class Completion(CliTest):
    def setUp(self):
        super().setUp()
        for name in ("a.vdb", "b.obj", "c.txt.bak", "d.png", "e.json", "f.STL", "g.ply.gz"):
            self.write(name, "")
        os.mkdir(self.path("folder"))
        self.environment = {**os.environ, "PATH": os.path.dirname(PROGRAM) + ":" + os.environ["PATH"]}

    def bash(self, line):
        """What bash offers at the end of the line, by its own cutting of words."""
        words = re.findall(r"[=:]+|[^\s=:]+", line) + ([""] if line.endswith((" ", "=", ":")) else [])
        script = f"""source <("$0" completion bash)
            complete -p vdb_synth >/dev/null || exit 9
            COMP_WORDS=({" ".join("'" + w + "'" for w in words)}) COMP_CWORD={len(words) - 1} COMP_LINE='{line}' COMP_POINT={len(line)}
            _vdb_synth
            printf '%s\\n' "${{COMPREPLY[@]}}" """
        result = other("bash", "-c", script, PROGRAM, cwd=self.folder, env=self.environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        return sorted(set(result.stdout.split()))

    def test_bash_has_no_complaint(self):
        path = self.write("vdb_synth.bash", self.ok("completion", "bash").stdout)
        result = other("bash", "-n", path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        if shutil.which("shellcheck"):
            self.assertEqual(other("shellcheck", "-s", "bash", "-S", "error", path).stdout, "")

    def test_bash(self):
        models = ["a.vdb", "b.obj", "d.png", "f.STL", "folder", "g.ply.gz"]
        for line, offered in {
                "vdb_synth sy": ["synth"],
                "vdb_synth relief": ["relief", "relief-extract"],
                "vdb_synth comp": ["compare", "completion"],
                "vdb_synth synth --longest": ["--longest-run"],
                "vdb_synth synth --method ": ["default", "exact", "paper"],
                "vdb_synth synth --method e": ["exact"],
                "vdb_synth synth --method=e": ["exact"],
                "vdb_synth synth -method p": ["paper"],
                "vdb_synth synth ": models,
                "vdb_synth synth a.vdb --draft b": ["b.obj"],
                "vdb_synth synth --threads ": [],
                "vdb_synth render a.vdb -o ": ["d.png", "folder"],
                "vdb_synth synth --config ": ["e.json", "folder"],
                "vdb_synth synth --index-cache ": ["folder"],
                "vdb_synth synth --report c": ["c.txt.bak"],
                "vdb_synth mask in": ["inside"],
                "vdb_synth mask inside ": models,
                "vdb_synth make chain": ["chainmail"],
                "vdb_synth analogy --direction axis:": ["-x", "-y", "-z", "x", "y", "z"],
                "vdb_synth analogy --direction rad": ["radial"],
                "vdb_synth batch ": ["e.json", "folder"],
                "vdb_synth completion ": ["bash", "fish", "zsh"],
                "vdb_synth help --man dec": [],
                "vdb_synth help --man doc": ["doctor"]}.items():
            with self.subTest(line):
                self.assertEqual(self.bash(line), offered)

    def test_bash_on_a_terminal(self):
        """Tab pressed in an interactive bash: its readline cuts the words and inserts the rest."""
        first, second = pty.openpty()
        process = subprocess.Popen(["bash", "--norc", "--noprofile", "-i"], stdin=second, stdout=second, stderr=second, cwd=self.folder,
                                   env={**self.environment, "PS1": "", "TERM": "dumb", "HISTFILE": ""}, start_new_session=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.addCleanup(os.close, first)
        self.addCleanup(os.close, second)

        def answer(keys, until):
            os.write(first, keys)
            said = b""
            while until not in said:
                self.assertTrue(select.select([first], [], [], 20)[0], said)
                said += os.read(first, 4096)
            return said.decode()

        answer(b"source <(vdb_synth completion bash); vdb_synth() { printf '[%s]' \"$@\"; echo; }; echo rea''dy\n", b"ready")
        for typed, run in {"conv\ta.v\t-o b.ob\t": "[convert][a.vdb][-o][b.obj]", "synth --meth\tex\t": "[synth][--method][exact]",
                           "synth --method=ex\t": "[synth][--method=exact]", "analogy --direction axis:-x\t": "[analogy][--direction][axis:-x]",
                           "batch e\t": "[batch][e.json]", "synth --index-cache fo\t": "[synth][--index-cache][folder/]"}.items():
            with self.subTest(typed):
                self.assertIn(run, answer(b"vdb_synth " + typed.encode() + b"; echo en''d\n", b"end\r\n"))

    def test_bash_asks_for_every_option(self):
        for command in ("synth", "doctor", "batch"):
            named = set(re.findall(r"(?m)^  (?:-\w, )?(--[a-z-]+)", self.ok(command, "--help").stdout))
            self.assertEqual(set(self.bash(f"vdb_synth {command} --")), named)

    def zsh(self, lines):
        """What a real zsh makes of each line and Tab, on a terminal of its own."""
        if not shutil.which("zsh"):
            self.skipTest("zsh is absent")
        os.mkdir(self.path(".functions"))
        self.write(".functions/_vdb_synth", self.ok("completion", "zsh").stdout)
        # A word in two parts is not found in the echo of what is typed, only in what is printed.
        asked = "\n".join(f"""zpty -w -n shell $'{line}\\t'
sleep 0.7
zpty -w -n shell $'\\x15print ne""xt\\n'
await next""" for line in lines)
        script = f"""zmodload zsh/zpty
zpty shell 'zsh -f -i'
await() {{ while zpty -r shell got; do print -r -- "$got"; [[ $got == *$1* ]] && break; done; }}
zpty -w shell "PS1=''; fpath=({self.path('.functions')} \\$fpath); autoload -Uz compinit; compinit -u -D; cd {self.folder}; stty cols 300; print rea''dy"
await ready >/dev/null
{asked}
zpty -d shell
"""
        result = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True, timeout=100, env=self.environment, cwd=self.folder)
        answers = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", " ", result.stdout).split("next")[:-1]
        self.assertEqual(len(answers), len(lines), result.stdout + result.stderr)
        return answers

    def test_zsh(self):
        expected = {"vdb_synth conv": ("vdb_synth convert", "compare"),
                    "vdb_synth synth --longest": ("--longest-run", "--size"),
                    "vdb_synth synth --method e": ("--method exact", "paper"),
                    "vdb_synth render -o d": ("-o d.png", "a.vdb"),
                    "vdb_synth synth f.": ("synth f.STL", "a.vdb"),
                    "vdb_synth analogy --direction rad": ("--direction radial", "axis"),
                    "vdb_synth make chain": ("make chainmail", "a.vdb"),
                    "vdb_synth batch e": ("batch e.json", "a.vdb"),
                    "vdb_synth completion f": ("completion fish", "zsh")}
        for (line, (offered, not_offered)), text in zip(expected.items(), self.zsh(expected)):
            with self.subTest(line):
                self.assertIn(offered, text)
                self.assertNotIn(not_offered, text)
                self.assertNotIn("_arguments:", text)

    def fish(self, line):
        self.write("vdb_synth.fish", self.ok("completion", "fish").stdout)
        result = other("fish", "--no-config", "-c", f"source vdb_synth.fish; complete -C '{line}'", cwd=self.folder,
                       env={**self.environment, "HOME": self.folder})
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return sorted({l.split("\t")[0] for l in result.stdout.splitlines()})

    def test_fish(self):
        models = ["a.vdb", "b.obj", "d.png", "f.STL", "folder/", "g.ply.gz"]
        for line, offered in {"vdb_synth conv": ["convert"],
                              "vdb_synth synth --longest": ["--longest-run"],
                              "vdb_synth synth --method ": ["default", "exact", "paper"],
                              "vdb_synth synth --method e": ["exact"],
                              "vdb_synth synth ": models,
                              "vdb_synth synth a.vdb --draft b": ["b.obj"],
                              "vdb_synth synth --threads ": [],
                              "vdb_synth render a.vdb -o ": ["d.png", "folder/"],
                              "vdb_synth mask in": ["inside"],
                              "vdb_synth mask inside ": models,
                              "vdb_synth make chain": ["chainmail"],
                              "vdb_synth batch ": ["e.json", "folder/"],
                              "vdb_synth completion ": ["bash", "fish", "zsh"],
                              "vdb_synth help doc": ["doctor"]}.items():
            with self.subTest(line):
                self.assertEqual(self.fish(line), offered)


if __name__ == "__main__":
    unittest.main(verbosity=2)
