# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Runs the commands of README and the guides as printed, in the order in which a newcomer reads them.

Usage: guides_test.py DERMIS"""

import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
# What a page tells the reader to write: the language of the block, and its number among those of the page.
WRITTEN = {
    "first-suit.md": {"suit.toml": ("toml", 0)},
    "connect-a-robot.md": {"robot.py": ("python", 0), "move.py": ("python", 1)},
}
FOR_A_MOMENT = Path(__file__).with_name("for_a_moment.py")


def blocks(page, language):
    text = (ROOT / page).read_text()
    return [textwrap.dedent(body) for _, name, body in BLOCK.findall(text) if name == language]


def commands(page):
    """All but those of make and pip, which scripts/bare_machine and scripts/bare_pip run, and what needs a terminal."""
    lines = "".join(blocks(page, "sh")).splitlines(keepends=True)
    return "".join(
        line
        for line in lines
        if not re.match(r"(make|sudo|git|cd dermis|python3 -m venv|venv/bin|export PATH|dermis top)\b", line)
    )


class Guides(unittest.TestCase):
    """`home` is a clone as a newcomer has it, with the binary of this build; `work` is the folder that the first guide
    makes."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.home = Path(folder.name)
        (cls.home / "examples").symlink_to(ROOT / "examples")
        (cls.home / "bin").mkdir()
        (cls.home / "bin/dermis").write_text(f'#!/bin/sh\nexec {FOR_A_MOMENT} {shlex.quote(BINARY)} "$@"\n')
        (cls.home / "bin/dermis").chmod(0o755)
        cls.work = cls.home / "first"

    def follow(self, page, folder):
        for name, (language, number) in WRITTEN.get(Path(page).name, {}).items():
            (folder / name).write_text(blocks(page, language)[number])
        script = (
            f'export PATH="{self.home}/bin:$PATH" DEVICE="sim:contacts?rate=100"\nset -exo pipefail\n{commands(page)}'
        )
        result = subprocess.run(
            ["bash", "-c", script], cwd=folder, capture_output=True, text=True, timeout=1200, check=False
        )
        self.assertEqual(result.returncode, 0, f"{page}:\n{result.stdout[-2000:]}\n{result.stderr[-4000:]}")

    def test_1_first_array(self):
        self.follow("docs/guides/first-array.md", self.home)
        self.assertTrue((self.work / "first.png").exists())

    def test_2_calibrate(self):
        self.follow("docs/guides/calibrate.md", self.work)

    def test_3_first_suit(self):
        self.follow("docs/guides/first-suit.md", self.work)

    def test_4_recognise(self):
        self.follow("docs/guides/recognise.md", self.work)

    def test_5_connect_a_robot(self):
        self.follow("docs/guides/connect-a-robot.md", self.work)

    def test_6_readme(self):
        """The files that it names are those of a newcomer's own array: here, the ones of the guides."""
        for name, place in {
            "array.toml": "chest.toml",
            "frames.csv": "cal/frames.csv",
            "loads.csv": "cal/loads.csv",
            "new_frames.csv": "test/frames.csv",
            "test.csv": "test/frames.csv",
            "test_loads.csv": "test/loads.csv",
        }.items():
            (self.work / name).symlink_to(place)
        self.follow("README.md", self.work)


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main(verbosity=2)
