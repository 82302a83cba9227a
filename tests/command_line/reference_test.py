# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Manual pages and completion: what --help shows, and what real shells make of it."""

import os
import pty
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import support
from support import dermis

HELP_OPTION = re.compile(r"^  (?:-\w,)?(--[\w-]+)", re.MULTILINE)
HELP_COMMAND = re.compile(r"^  (\w+) {3,}", re.MULTILINE)
PAGE_OPTION = re.compile(r"^\.TP\n.*?\\fB(\\-\\-[\w\\-]+)\\fR", re.MULTILINE)
DOCS = Path(__file__).resolve().parents[2] / "docs"
MOST_WORDS = 2500
LINT_OF_NO_DATE = re.compile(r".*WARNING: missing date, using \"\": TH")  # builds at any time have the same bytes


def commands_of(*command):
    """Names below the headings of commands in the help of a command."""
    heading = re.compile(r"^(?:Subcommands|Begin):$", re.MULTILINE)
    _, *named = heading.split(dermis(*command, "--help").stdout, maxsplit=1)
    return HELP_COMMAND.findall(named[0]) if named else []


def options_of(*command):
    return HELP_OPTION.findall(dermis(*command, "--help").stdout)


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.share = Path(folder.name) / "share"
        result = dermis("reference", folder.name)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        cls.pages = sorted((cls.share / "man/man1").iterdir())

    def test_every_command_has_a_page_with_the_options_of_its_help(self):
        commands = commands_of()
        self.assertGreater(len(commands), 15)
        self.assertEqual({page.name for page in self.pages}, {"dermis.1", *(f"dermis-{name}.1" for name in commands)})
        for command in commands:
            with self.subTest(command):
                expected = options_of(command)
                for part in commands_of(command):
                    expected += options_of(command, part)
                text = (self.share / f"man/man1/dermis-{command}.1").read_text()
                self.assertEqual([name.replace("\\", "") for name in PAGE_OPTION.findall(text)], expected)

    def test_every_command_says_more_than_its_options(self):
        for page in (page for page in self.pages if page.name != "dermis.1"):
            self.assertIn(".SH DESCRIPTION\n", page.read_text(), page)

    def test_options_stand_below_what_they_are_for(self):
        shown = dermis("calibrate", "--help").stdout
        headings = [shown.index(f"\n{name}:\n") for name in ("Reads", "Writes", "Options", "Examples")]
        self.assertEqual(headings, sorted(headings))

    def test_the_documents_of_commands_are_those_of_the_help(self):
        written = self.share / "doc/dermis"
        names = [path.relative_to(written) for path in written.rglob("*.md")]
        self.assertEqual(
            {path.name for path in (DOCS / "commands").iterdir()}, {p.name for p in names} - {"command-line.md"}
        )
        for name in names:
            text = (written / name).read_text()
            self.assertEqual((DOCS / name).read_text(), text, f"docs/{name} is old: make reference")
            self.assertLessEqual(len(text.split()), MOST_WORDS, name)

    def test_pages_are_the_same_in_every_run(self):
        with tempfile.TemporaryDirectory() as folder:
            dermis("reference", folder)
            for page in self.pages:
                self.assertEqual((Path(folder) / "share/man/man1" / page.name).read_bytes(), page.read_bytes())

    def test_a_folder_that_cannot_be_written_gives_one_line(self):
        result = dermis("reference", "/dev/null")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"\Adermis: cannot create '/dev/null/share/man/man1': .*\n\Z")

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_groff_warns_of_nothing(self):
        for page in self.pages:
            result = subprocess.run(["groff", "-man", "-ww", "-z", "-K", "utf8", page], capture_output=True, text=True)
            self.assertEqual((result.returncode, result.stderr), (0, ""), page)

    @unittest.skipUnless(shutil.which("mandoc"), "no mandoc")
    def test_mandoc_misses_no_more_than_a_date(self):
        for page in self.pages:
            lint = subprocess.run(
                ["mandoc", "-Tlint", "-Wwarning", page], capture_output=True, text=True
            ).stdout.splitlines()
            self.assertEqual([line for line in lint if not LINT_OF_NO_DATE.fullmatch(line)], [])


class Completion:
    """A shell at work in a folder with two files; `dermis` in it is a function that prints what it is given."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        dermis("reference", folder.name)
        (self.folder / "chest one.safetensors").touch()
        (self.folder / "frames.csv").touch()
        (self.folder / "rc").write_text(self.beginning() + "\ndermis() { printf '<%s>' \"$@\"; echo; }\necho ready\n")

    def completed(self, line):
        """What dermis is given if somebody types this, where a tab completes."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.folder)
            os.execvpe(self.shell[0], self.shell, {**os.environ, "TERM": "dumb", "HOME": str(self.folder), "PS1": "$ "})
        try:
            self.wait_for(terminal, "$ ")
            os.write(terminal, b"source ./rc\n")
            self.wait_for(terminal, "ready\r\n")
            os.write(terminal, line.encode() + b"\n")
            return re.findall("<([^>]*)>", self.wait_for(terminal, ">\r\n"))
        finally:
            os.close(terminal)
            os.waitpid(process, 0)

    def wait_for(self, terminal, text):
        seen = ""
        while text not in seen:
            seen += os.read(terminal, 4096).decode()
        return seen

    def test_names_of_commands(self):
        self.assertEqual(self.completed("dermis ser\t"), ["serve"])
        self.assertEqual(self.completed("dermis circuit inv\t"), ["circuit", "invert"])

    def test_options_of_the_command(self):
        self.assertEqual(self.completed("dermis serve --mod\t x"), ["serve", "--model", "x"])
        self.assertEqual(self.completed("dermis circuit invert --sig\t"), ["circuit", "invert", "--sigma"])

    def test_names_that_an_option_knows(self):
        self.assertEqual(self.completed("dermis simulate --memory ru\t"), ["simulate", "--memory", "rubber"])
        self.assertEqual(self.completed("dermis emulate --protocol flex\t"), ["emulate", "--protocol", "flexitac"])

    def test_files_as_values_and_arguments(self):
        self.assertEqual(self.completed("dermis run --model che\t"), ["run", "--model", "chest one.safetensors"])
        self.assertEqual(self.completed("dermis convert fra\t"), ["convert", "frames.csv"])

    def test_no_file_where_a_number_is_due(self):
        self.assertEqual(self.completed("dermis run --settle fra\t"), ["run", "--settle", "fra"])


class Bash(Completion, unittest.TestCase):
    shell = ("bash", "--norc", "--noprofile", "-i")

    def beginning(self):
        return "source share/bash-completion/completions/dermis"


@unittest.skipUnless(shutil.which("zsh"), "no zsh")
class Zsh(Completion, unittest.TestCase):
    shell = ("zsh", "-f", "-i")

    def beginning(self):
        return "fpath=(share/zsh/site-functions $fpath); autoload -Uz compinit; compinit -u -D"


if __name__ == "__main__":
    support.main()
