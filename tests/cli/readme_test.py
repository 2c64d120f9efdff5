"""The README's commands run, and print what it says."""
import os
import shlex
import subprocess
import unittest

from support import PROGRAM, SOURCE, CliTest


class Readme(CliTest):
    def test_console_blocks(self):
        commands = 0
        for block in (SOURCE / "README.md").read_text().split("```console\n")[1:]:
            words, said = None, []
            for line in block.split("```")[0].splitlines() + ["$ "]:
                if not line.startswith("$ "):
                    said.append(line)
                    continue
                if words:
                    environment = dict(os.environ, PATH=os.path.dirname(PROGRAM) + ":" + os.environ["PATH"])
                    result = subprocess.run(words, cwd=self.folder, env=environment, text=True, stdout=subprocess.PIPE,
                                            stderr=subprocess.STDOUT)
                    self.assertEqual(result.returncode, 0, result.stdout)
                    self.assertEqual(result.stdout.splitlines(), said, words)
                    commands += 1
                words, said = shlex.split(line[2:]), []
        self.assertGreaterEqual(commands, 5)


if __name__ == "__main__":
    unittest.main(verbosity=2)
