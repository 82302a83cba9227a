#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""check_budget.py finds what is too long in a house of its own."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = Path(__file__).with_name("check_budget.py")
SHORT = "int f() {\n  return 1;\n}\n"
LONG = "int g() {\n" + "  // a line\n" * 8 + "  return 1;\n}\n"
BUDGET = """[lines]
touch = 30
[most]
commands = 1
lines_a_file = 20
lines_a_function = 10
words_a_document = 9
words_of_the_readme = 5
[longer]
"""


class Budget(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.house = Path(folder.name)
        subprocess.run(["git", "init", "--quiet", self.house], check=True)
        self.write("src/touch/pipeline/short.cpp", SHORT)
        self.write("README.md", "Newtons from robot touch.\n")

    def write(self, path, text):
        (self.house / path).parent.mkdir(parents=True, exist_ok=True)
        (self.house / path).write_text(text)

    def found(self, more="", *dermis):
        self.write("tests/architecture/budget.toml", BUDGET + more)
        result = subprocess.run([CHECK, self.house, *dermis], capture_output=True, text=True)
        if result.returncode == 77:
            self.skipTest("no universal-ctags")
        self.assertEqual(bool(result.stdout.strip()), result.returncode != 0, result.stderr)
        return result.stdout

    def test_nothing_is_said_of_a_house_within_it(self):
        self.assertEqual(self.found().strip(), "")

    def test_a_long_function_is_found_unless_it_has_a_reason(self):
        self.write("src/touch/pipeline/long.cpp", LONG)
        self.assertEqual(self.found(), "src/touch/pipeline/long.cpp: g has 11 lines, at most 10\n")
        self.assertEqual(self.found('"src/touch/pipeline/long.cpp g" = "a table"\n').strip(), "")

    def test_a_long_file_and_a_large_wing_are_found(self):
        self.write("include/dermis/touch/pipeline/long.hpp", SHORT * 7)
        self.write("src/touch/network/another.cpp", SHORT * 3)
        self.assertEqual(
            self.found(),
            "include/dermis/touch/pipeline/long.hpp: has 21 lines, at most 20\ntouch: has 33 lines, at most 30\n",
        )

    def test_a_wing_without_a_budget_and_a_reason_without_need_are_found(self):
        self.write("apps/dermis/main.cpp", SHORT)
        found = self.found('"src/touch/pipeline/short.cpp" = "it was long"\n')
        self.assertIn("apps: has 3 lines, at most 0\n", found)
        self.assertIn("src/touch/pipeline/short.cpp: is no longer too long; take it out of budget.toml\n", found)

    def test_a_long_document_is_found_unless_it_has_a_reason(self):
        self.write("README.md", "a word " * 3)
        self.write("docs/reasons/long.md", "a word " * 5)
        self.write("docs/short.md", "a word " * 4)
        found = self.found().splitlines()
        self.assertEqual([line.split(":")[0] for line in found], ["README.md", "docs/reasons/long.md"])
        self.assertIn("has 10 words, at most 9", found[1])
        self.assertEqual(len(self.found('"docs/reasons/long.md" = "made from the help"\n').splitlines()), 1)

    def test_one_command_too_many_is_found(self):
        dermis = self.house / "dermis"
        dermis.write_text(
            "#!/bin/sh\nprintf -- '--version\\n\\nOne:\\n  run    It runs\\n\\nTwo:\\n  stop    It stops\\n'\n"
        )
        dermis.chmod(0o755)
        self.assertEqual(self.found("", dermis), "2 commands, at most 1\n")


if __name__ == "__main__":
    sys.exit(unittest.main())
