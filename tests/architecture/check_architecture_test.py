# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The rules are worth something only if they find what breaks them."""

import tempfile
import unittest
from pathlib import Path

from check_architecture import SPDX, violations

HEADER = SPDX + "#pragma once\n"
TABLE = """# Architecture

### Folders of `fusion`

| folder | what it does | may include |
|---|---|---|
| `tables` | look up | |
| `fit` | learns | `tables` |

## Dependencies

| module | may include |
|---|---|
| `core` | |
| `fusion` | `core` |
| `simulation` | |
| `apps` | `fusion` |

## End
"""


class Rules(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("ARCHITECTURE.md", TABLE)
        self.write("CMakeLists.txt", "project(dermis VERSION 1.2.3 LANGUAGES CXX)\n")
        self.write("CITATION.cff", "version: 1.2.3\n")
        self.write("CHANGELOG.md", "# Changelog\n\n## [1.2.3] - 2026-01-01\n")
        self.write("include/dermis/core/frames.hpp", HEADER + "#include <vector>\n")
        self.write("include/dermis/fusion/force.hpp", HEADER + '#include "dermis/core/frames.hpp"\n')
        self.write(
            "src/fusion/force.cpp",
            SPDX + '#include "dermis/core/frames.hpp"\n#include "fusion/table.hpp"\n#include <tbb/tbb.h>\n',
        )
        self.write("src/fusion/table.hpp", HEADER)
        self.write("src/fusion/fit/fit.cpp", SPDX + '#include "fusion/table.hpp"\n#include "fusion/tables/knots.hpp"\n')
        self.write("apps/dermis/main.cpp", SPDX + '#include "dermis/fusion/force.hpp"\n')
        self.write("tests/core/frames_test.cpp", SPDX)
        self.write("tests/fusion/force_test.cpp", SPDX)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def expect(self, *messages):
        found = list(violations(self.root))
        self.assertEqual(len(found), len(messages), found)
        for message in messages:
            self.assertTrue(any(message in line for line in found), (message, found))

    def test_accepts_a_tree_that_keeps_them(self):
        self.expect()

    def test_a_folder_includes_one_that_its_row_does_not_name(self):
        self.write("src/fusion/tables/knots.cpp", SPDX + '#include "fusion/fit/fit.hpp"\n')
        self.expect("tables must not include fit")

    def test_a_folder_may_include_one_that_is_below_it(self):
        self.write("ARCHITECTURE.md", TABLE.replace("| look up | |", "| look up | `fit` |"))
        self.write("src/fusion/tables/knots.cpp", SPDX + '#include "fusion/fit/fit.hpp"\n')
        self.expect("fusion/tables may include fit, which is not above it")

    def test_a_permission_of_a_folder_that_nobody_uses(self):
        self.write("src/fusion/fit/fit.cpp", SPDX + '#include "fusion/table.hpp"\n')
        self.expect("fusion/fit makes no use of tables")

    def test_a_folder_is_not_in_the_table(self):
        self.write("src/fusion/plots/plot.cpp", SPDX)
        self.expect("the folder plots is not in the table")

    def test_a_module_includes_one_that_the_table_does_not_allow(self):
        self.write("src/simulation/scene.cpp", SPDX + '#include "dermis/fusion/force.hpp"\n')
        self.expect("simulation must not include fusion")

    def test_a_private_header_of_another_module(self):
        self.write("src/fusion/fit/fit.cpp", SPDX + '#include "fusion/table.hpp"\n#include "fusion/tables/knots.hpp"\n')
        self.write("apps/dermis/main.cpp", SPDX + '#include "fusion/table.hpp"\n')
        self.expect("private to the module fusion")

    def test_a_plugin_that_knows_more_than_the_module_which_loads_it(self):
        self.write("nats/broker.cpp", SPDX + '#include "dermis/core/frames.hpp"\n#include "fleet/broker.hpp"\n')
        self.expect()
        self.write("nats/broker.cpp", SPDX + '#include "dermis/fusion/force.hpp"\n')
        self.expect("nats/broker.cpp: a plugin of fleet must not include dermis/fusion/force.hpp")

    def test_kernels_are_shared_with_the_modules_whose_row_names_theirs(self):
        self.write("src/fusion/table-inl.hpp", HEADER)
        self.write("src/fusion/fit/fit.cpp", SPDX + '#include "fusion/table.hpp"\n#include "fusion/tables/knots.hpp"\n')
        self.write("apps/dermis/main.cpp", SPDX + '#include "fusion/table-inl.hpp"\n')
        self.expect()
        self.write("src/simulation/scene.cpp", SPDX + '#include "fusion/table-inl.hpp"\n')
        self.expect("src/simulation/scene.cpp: fusion/table-inl.hpp is private to the module fusion")

    def test_a_module_that_is_not_in_the_table(self):
        self.write("src/utils/text.cpp", SPDX)
        self.expect("utils is not in the table")

    def test_a_third_party_header_in_a_public_one(self):
        self.write("include/dermis/fusion/force.hpp", HEADER + "#include <Eigen/Core>\n")
        self.expect("must not include <Eigen/Core>")

    def test_a_permission_that_nobody_uses(self):
        self.write("src/fusion/fit/fit.cpp", SPDX + '#include "fusion/table.hpp"\n#include "fusion/tables/knots.hpp"\n')
        self.write("apps/dermis/main.cpp", SPDX)
        self.expect("apps makes no use of fusion")

    def test_a_text_of_the_library_that_names_an_option(self):
        self.write(
            "src/fusion/force.cpp",
            SPDX + 'auto text = "give the rate, --rate";  // "--rate" in a comment is none\nx--y;\n',
        )
        self.expect("src/fusion/force.cpp:3: a text of the library names an option")

    def test_a_private_header_in_a_public_one(self):
        self.write("include/dermis/fusion/force.hpp", HEADER + '#include "fusion/table.hpp"\n')
        self.expect('must not include the private "fusion/table.hpp"')

    def test_a_header_without_licence_or_guard(self):
        self.write("include/dermis/core/frames.hpp", SPDX)
        self.expect("#pragma once")

    def test_a_header_without_a_test(self):
        (self.root / "tests/core/frames_test.cpp").unlink()
        self.expect("needs the test file tests/core/frames_test.cpp")

    def test_a_source_without_licence(self):
        self.write("src/fusion/force.cpp", "")
        self.expect("src/fusion/force.cpp: must begin with the two SPDX lines")

    def test_versions_that_differ(self):
        self.write("CITATION.cff", "version: 1.2.2\n")
        self.write("CHANGELOG.md", "# Changelog\n\n## [1.3.0]\n\n## [1.2.3]\n")
        self.expect("CITATION.cff: says version 1.2.2, CMakeLists.txt 1.2.3", "CHANGELOG.md: says version 1.3.0")


if __name__ == "__main__":
    unittest.main()
