# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The stubs say what is there: mypy holds them to the module, and the examples to the stubs."""
import subprocess
import sys
import unittest
from pathlib import Path

import dermis

ROOT = Path(__file__).parents[2]


class Stubs(unittest.TestCase):
    def run_mypy(self, *arguments):
        run = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_every_name_is_in_the_stubs_and_in_the_module(self):
        self.run_mypy("mypy.stubtest", "dermis", "--allowlist", str(Path(__file__).with_name("stubtest_allowed.txt")))

    def test_examples_agree_with_the_stubs(self):
        self.run_mypy("mypy", "--strict", "--ignore-missing-imports", *map(str, sorted((ROOT / "examples/python").glob("*.py"))))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
