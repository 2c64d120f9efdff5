"""README and docs/: links lead somewhere, and the program accepts every command that the pages show."""
import re
import shlex
import unittest

from support import SOURCE, CliTest

PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", SOURCE / "houdini_examples" / "README.md",
         *sorted((SOURCE / "docs").glob("*.md")), *sorted((SOURCE / "docs" / "decisions").glob("*.md"))]
FENCE = re.compile(r"^```.*?^```", re.M | re.S)


def anchors(page):
    """The anchors that its headings get on GitHub."""
    found = {}
    for title in re.findall(r"^#+ +(.+?) *$", FENCE.sub("", page.read_text()), re.M):
        name = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower()).replace(" ", "-")
        number = found[name] = found.get(name, -1) + 1
        yield f"{name}-{number}" if number else name


class Links(unittest.TestCase):
    def test_links_lead_somewhere(self):
        lost = []
        for page in PAGES:
            text = re.sub(r"`[^`\n]*`", "", FENCE.sub("", page.read_text()))
            for link in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"[a-z]+:", link):
                    continue
                path, _, anchor = link.partition("#")
                target = (page.parent / path).resolve() if path else page
                if not target.exists() or (anchor and anchor not in anchors(target)):
                    lost.append(f"{page.relative_to(SOURCE)}: {link}")
        self.assertFalse(lost)

    def test_every_page_is_named_in_the_readme(self):
        readme = (SOURCE / "README.md").read_text()
        self.assertFalse([page.name for page in (SOURCE / "docs").glob("*.md") if f"](docs/{page.name})" not in readme])


def commands(page):
    """Command lines in a page's blocks and, where they are whole, in its running text and tables."""
    text = page.read_text()
    for block in FENCE.findall(text):
        for line in block.splitlines()[1:]:
            match = re.match(r"\s*(?:\$ )?(?:[A-Z_]+=\S+ )?(vdb_synth .+)", line)
            if match:
                yield re.split(r"   +| [<>|] |\)$", match[1])[0]
    for line in re.findall(r"`(vdb_synth [^`\n]+)`", FENCE.sub("", text)):
        yield line


def is_whole(words):
    """No pattern such as COMMAND or `...`, no make rule, and a file with an extension after each -o."""
    outputs = [word for flag, word in zip(words, words[1:]) if flag in ("-o", "--output")]
    return not any(re.search(r"\.\.\.|^[\[<]|\$[<@]|^(COMMAND|EXEMPLAR|OUT|JOBS|MAP|A2|IN|X|N|V|K|RAD)$", word) for word in words) and \
        len(words) > 2 and all("." in word for word in outputs)


def shown(pages):
    """(page, line, words) of each whole command on these pages, once."""
    seen = set()
    for page in pages:
        for line in commands(page):
            words = shlex.split(line)[1:]
            if line not in seen and is_whole(["vdb_synth", *words]) and words[0] not in ("completion", "doctor", "help"):
                seen.add(line)
                yield page, line, words


class Options(unittest.TestCase):
    def test_commands_have_the_options_of_their_help(self):
        pages = [page for page in PAGES if page.parent.name != "decisions"]  # those tell of the past
        unknown, lines = [], 0
        for page, line, words in shown(pages):
            lines += 1
            help_page = SOURCE / "docs" / "cli" / f"{words[0]}.txt"
            text = help_page.read_text() if help_page.exists() else ""
            taken = set(re.findall(r"^  (?:-\w, )?(--[a-z0-9-]+)", text, re.M)) | set(re.findall(r"^  (-\w),", text, re.M))
            given = [word.partition("=")[0] for word in words[1:] if re.match(r"--?[A-Za-z]", word) and not word.startswith("-.")]
            unknown += [f"{page.name}: {line}: {option}" for option in given if option not in taken]
        self.assertFalse(unknown)
        self.assertGreaterEqual(lines, 100)


class Commands(CliTest):
    def test_the_readme_s_table_is_accepted(self):
        """In an empty folder the first thing missing is a file, not an option or a value."""
        lines = [found for found in shown(PAGES[:1]) if f"| `{found[1]}`" in PAGES[0].read_text()]
        self.assertGreaterEqual(len(lines), 20)
        for _, line, words in lines:
            self.assertEqual(self.run_tool(*words, "--no-supervisor").returncode, 3, line)


if __name__ == "__main__":
    unittest.main(verbosity=2)
