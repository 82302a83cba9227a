# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A package that a group of scripts/setup lacks is named, and one that nothing uses.

Usage: check_packages_test.py ROOT"""

import re
import sys
import unittest
from pathlib import Path

from check_packages import groups_of, steps, texts_of, violations

ROOT = Path(sys.argv.pop())
SETUP = (ROOT / "scripts/setup").read_text()
MAKEFILE = (ROOT / "Makefile").read_text()
TEXTS = texts_of(ROOT)
STEPS = list(steps(MAKEFILE, TEXTS))


def without(package, group):
    row = re.compile(rf"(?<=^  {group}\) packages=\()[^)]*", re.MULTILINE)
    return row.sub(lambda found: " ".join(name for name in found[0].split() if name != package), SETUP)


class Packages(unittest.TestCase):
    def named(self, what, setup=SETUP, makefile=MAKEFILE, changed=None):
        texts = TEXTS | (changed or {})
        steps_of_targets = STEPS if makefile is MAKEFILE and not changed else steps(makefile, texts)
        lines = [line for line in violations(setup, steps_of_targets, texts) if what in line]
        self.assertTrue(lines, what)
        return lines[0]

    def test_each_package_that_is_taken_out_of_its_group_is_named(self):
        for group, packages in groups_of(SETUP).items():
            for package in packages:
                with self.subTest(group=group, package=package):
                    self.named(f" of {package}, which is in no group of ", without(package, group))

    def test_a_package_that_nothing_uses_is_named(self):
        setup = SETUP.replace("fuzz) packages=(", "fuzz) packages=(ngspice ")
        self.named("scripts/setup fuzz installs ngspice, which nothing uses", setup)

    def test_a_target_that_does_not_install_a_group_is_named(self):
        makefile = MAKEFILE.replace("\tscripts/setup site\n", "")
        self.named(
            "scripts/site uses doxygen of doxygen, which is in no group of make release, make site", makefile=makefile
        )

    def test_what_no_package_brings_is_named(self):
        for use, text in {
            "jq": "#!/bin/bash\njq . file\n",
            "yaml": "#!/usr/bin/python3\nimport yaml\n",
            "xz": '#!/usr/bin/python3\nsubprocess.run(["xz", "-d"])\n',
        }.items():
            self.named(f"scripts/new uses {use} of a package that is not in the table", changed={"scripts/new": text})

    def test_a_tool_of_the_tests_that_the_build_requires_is_named(self):
        changed = {"tests/c/CMakeLists.txt": "find_program(DERMIS_ABIDIFF abidiff REQUIRED)"}
        line = self.named("tests/c/CMakeLists.txt uses abidiff of abigail-tools", changed=changed)
        self.assertIn("make demo", line)
        self.assertNotIn("make test", line)


if __name__ == "__main__":
    unittest.main()
