# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What README, a guide, docs/embedding.md and docs/c.md show of C++ and C compiles as printed.

Usage: snippets_test.py C++-COMPILER C-COMPILER GENERATED-HEADERS"""

import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CXX, CC, GENERATED = sys.argv[1:4]
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only")


def snippet(page, language):
    return re.search(rf"^```{language}\n(.*?)^```$", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)[1]


class Snippets(unittest.TestCase):
    def compile(self, compiler, *options, text):
        result = subprocess.run(
            [compiler, *options, *WARNINGS, "-"], input=text, capture_output=True, text=True, check=False
        )
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_lines_of_cpp_name_their_header_and_are_the_body_of_a_function_that_may_fail(self):
        for page in ("README.md", "docs/guides/connect-a-robot.md"):
            with self.subTest(page):
                includes, body = snippet(page, "cpp").split("\n\n", 1)
                self.compile(
                    CXX,
                    "-std=c++20",
                    "-x",
                    "c++",
                    f"-I{ROOT}/include",
                    f"-I{GENERATED}",
                    text=f"{includes}\n"
                    f"dermis::Status work(const dermis::RawFrame& raw) {{\n{body}return dermis::Done{{}};\n}}\n",
                )

    def test_the_program_of_the_page_on_embedding_is_whole(self):
        self.compile(CXX, "-std=c++20", "-x", "c++", f"-I{ROOT}/include", text=snippet("docs/embedding.md", "cpp"))

    def test_the_program_of_the_page_on_c_is_whole(self):
        self.compile(CC, "-std=c99", "-x", "c", f"-I{ROOT}/bindings/c", text=snippet("docs/c.md", "c"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
