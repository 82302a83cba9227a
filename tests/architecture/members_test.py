# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""scripts/members.py finds the classes that it is for."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import members

MEMBERS = "".join(f"  int value_{number} = {number};\n" for number in range(16))


class LargeClasses(unittest.TestCase):
    def large(self, text):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "src").mkdir()
            (Path(folder) / "src/one.hpp").write_text(text)
            return members.large_classes(Path(folder), members.MOST)[0]

    def test_a_class_of_sixteen_members_is_named(self):
        self.assertEqual(
            self.large(f"/// Much.\nstruct Large {{\n{MEMBERS}}};\n"), [(16, "Large", "src/one.hpp", None)]
        )

    def test_its_comment_gives_the_reason(self):
        text = f"/// Much. Many members: as the\n/// formula has.\nstruct Large {{\n{MEMBERS}}};\n"
        self.assertEqual(self.large(text), [(16, "Large", "src/one.hpp", "as the formula has.")])

    def test_static_members_do_not_count(self):
        text = MEMBERS.replace("  int value_0 =", "  static constexpr int value_0 =")
        self.assertEqual(self.large(f"struct Large {{\n{text}}};\n"), [])


if __name__ == "__main__":
    if not members.has_ctags():
        print("needs universal-ctags")
        sys.exit(members.SKIPPED)
    unittest.main()
