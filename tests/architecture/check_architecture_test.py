# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The rules are worth something only if they find what breaks them."""

import tempfile
import unittest
from pathlib import Path

from check_architecture import SPDX, violations

HEADER = SPDX + "#pragma once\n"
TABLE = """# Architecture

## Wings

| wing | what it does | may include |
|---|---|---|
| `touch` | forces | |
| `learn` | learns | `touch` |

### Rooms of `touch`

| room | what it does | begin reading at | may include |
|---|---|---|---|
| `frames` | frames | | |
| `fusion` | forces | | `frames` |

### Rooms of `learn`

| room | what it does | begin reading at | may include |
|---|---|---|---|
| `simulation` | a judge | | |
| `calibration` | learns | | |

### Folders of `fusion`

| folder | what it does | may include |
|---|---|---|
| `tables` | look up | |
| `fit` | learns | `tables` |

## End
"""
FIT = SPDX + '#include "touch/fusion/table.hpp"\n#include "touch/fusion/tables/knots.hpp"\n'
CALIBRATION = SPDX + '#include "dermis/touch/fusion/force.hpp"\n'


class Rules(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("ARCHITECTURE.md", TABLE)
        self.write("CMakeLists.txt", "project(dermis VERSION 1.2.3 LANGUAGES CXX)\n")
        self.write("CITATION.cff", "version: 1.2.3\n")
        self.write("CHANGELOG.md", "# Changelog\n\n## [1.2.3] - 2026-01-01\n")
        self.write("bindings/ros/dermis_msgs/package.xml", "<version>1.2.3</version>\n")
        self.write("include/dermis/touch/frames/frames.hpp", HEADER + "#include <vector>\n")
        self.write("include/dermis/touch/fusion/force.hpp", HEADER + '#include "dermis/touch/frames/frames.hpp"\n')
        self.write(
            "src/touch/fusion/force.cpp",
            SPDX
            + '#include "dermis/touch/frames/frames.hpp"\n#include "touch/fusion/table.hpp"\n#include <Eigen/Core>\n',
        )
        self.write("src/touch/fusion/table.hpp", HEADER)
        self.write("src/touch/fusion/fit/fit.cpp", FIT)
        self.write("src/learn/calibration/calibrate.cpp", CALIBRATION)
        self.write("apps/dermis/main.cpp", SPDX + '#include "dermis/touch/fusion/force.hpp"\n')
        self.write("tests/touch/frames/frames_test.cpp", SPDX)
        self.write("tests/touch/fusion/force_test.cpp", SPDX)

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
        self.write("src/touch/fusion/tables/knots.cpp", SPDX + '#include "touch/fusion/fit/fit.hpp"\n')
        self.expect("tables must not include fit")

    def test_a_folder_may_include_one_that_is_below_it(self):
        self.write("ARCHITECTURE.md", TABLE.replace("| look up | |", "| look up | `fit` |"))
        self.write("src/touch/fusion/tables/knots.cpp", SPDX + '#include "touch/fusion/fit/fit.hpp"\n')
        self.expect("tables may include fit, which is not above it")

    def test_a_permission_of_a_folder_that_nobody_uses(self):
        self.write("src/touch/fusion/fit/fit.cpp", SPDX + '#include "touch/fusion/table.hpp"\n')
        self.expect("fusion/fit makes no use of tables")

    def test_a_folder_is_not_in_the_table(self):
        self.write("src/touch/fusion/plots/plot.cpp", SPDX)
        self.expect("the folder plots is not in the table")

    def test_a_room_includes_one_that_its_row_does_not_name(self):
        self.write(
            "src/learn/calibration/calibrate.cpp", CALIBRATION + '#include "dermis/learn/simulation/scene.hpp"\n'
        )
        self.expect("calibration must not include simulation")

    def test_a_wing_includes_one_that_its_row_does_not_name(self):
        self.write("src/touch/fusion/force.cpp", FIT + '#include "dermis/learn/calibration/calibrate.hpp"\n')
        self.write("src/touch/fusion/frames.cpp", SPDX + '#include "dermis/touch/frames/frames.hpp"\n')
        self.expect("fusion must not include calibration")

    def test_the_judge_knows_nothing_but_frames(self):
        self.write("src/learn/simulation/scene.cpp", SPDX + '#include "dermis/touch/fusion/force.hpp"\n')
        self.expect("simulation must not include fusion")

    def test_a_wing_that_may_include_one_below_it(self):
        self.write("ARCHITECTURE.md", TABLE.replace("| forces | |\n| `learn`", "| forces | `learn` |\n| `learn`"))
        self.expect("touch may include learn, which is not above it", "touch makes no use of learn")

    def test_a_private_header_of_another_room(self):
        self.write("apps/dermis/main.cpp", SPDX + '#include "touch/fusion/table.hpp"\n')
        self.write("src/learn/calibration/calibrate.cpp", CALIBRATION + '#include "touch/fusion/table.hpp"\n')
        self.expect("main.cpp: touch/fusion/table.hpp is private", "calibrate.cpp: touch/fusion/table.hpp is private")

    def test_a_plugin_that_knows_more_than_the_room_which_loads_it(self):
        self.write(
            "plugins/nats/broker.cpp",
            SPDX + '#include "dermis/touch/frames/frames.hpp"\n#include "live/fleet/broker.hpp"\n',
        )
        self.expect()
        self.write("plugins/nats/broker.cpp", SPDX + '#include "dermis/touch/fusion/force.hpp"\n')
        self.expect("plugins/nats/broker.cpp: a plugin of live/fleet must not include touch/fusion/force.hpp")

    def test_kernels_are_shared_with_those_who_may_include_their_room(self):
        self.write("src/touch/fusion/table-inl.hpp", HEADER)
        self.write("src/learn/calibration/calibrate.cpp", CALIBRATION + '#include "touch/fusion/table-inl.hpp"\n')
        self.expect()
        self.write("src/learn/simulation/scene.cpp", SPDX + '#include "touch/fusion/table-inl.hpp"\n')
        self.expect("simulation must not include fusion")

    def test_a_room_that_is_in_no_table(self):
        self.write("src/utils/text.cpp", SPDX)
        self.write("src/touch/text/text.cpp", SPDX)
        self.expect("src/utils/text.cpp: is in no wing", "src/touch/text/text.cpp: is in no wing and room")

    def test_touch_uses_files_locks_exceptions_or_libraries(self):
        text = "#include <mutex>\n#include <sys/resource.h>\n#include <fmt/core.h>\nvoid f() { throw 1; }\n"
        self.write("src/touch/fusion/table.hpp", HEADER + text + "// catch of a try\n")
        self.expect("table.hpp:4: touch", "<sys/resource.h>", "<fmt/core.h>", "table.hpp:7: touch stands alone")
        self.write("src/touch/fusion/table.hpp", HEADER)
        self.write("src/learn/calibration/calibrate.cpp", CALIBRATION + text)
        self.expect()

    def test_a_third_party_header_in_a_public_one(self):
        self.write("include/dermis/touch/fusion/force.hpp", HEADER + "#include <Eigen/Core>\n")
        self.expect("must not include <Eigen/Core>")

    def test_a_permission_that_nobody_uses(self):
        self.write("src/learn/calibration/calibrate.cpp", SPDX)
        self.expect("learn makes no use of touch")

    def test_a_text_of_the_library_that_names_an_option(self):
        self.write(
            "src/touch/fusion/force.cpp",
            SPDX + 'auto text = "give the rate, --rate";  // "--rate" in a comment is none\nx--y;\n',
        )
        self.expect("src/touch/fusion/force.cpp:3: a text of the library names an option")

    def test_a_private_header_in_a_public_one(self):
        self.write("include/dermis/touch/fusion/force.hpp", HEADER + '#include "touch/fusion/table.hpp"\n')
        self.expect('must not include the private "touch/fusion/table.hpp"')

    def test_a_header_without_licence_or_guard(self):
        self.write("include/dermis/touch/frames/frames.hpp", SPDX)
        self.expect("#pragma once")

    def test_a_header_without_a_test(self):
        (self.root / "tests/touch/frames/frames_test.cpp").unlink()
        self.expect("needs the test file tests/touch/frames/frames_test.cpp")

    def test_a_source_without_licence(self):
        self.write("src/touch/fusion/force.cpp", "")
        self.expect("src/touch/fusion/force.cpp: must begin with the two SPDX lines")

    def test_versions_that_differ(self):
        self.write("CITATION.cff", "version: 1.2.2\n")
        self.write("CHANGELOG.md", "# Changelog\n\n## [1.3.0]\n\n## [1.2.3]\n")
        self.write("bindings/ros/dermis_msgs/package.xml", "<package/>\n")
        self.expect(
            "CITATION.cff: says version 1.2.2, CMakeLists.txt 1.2.3",
            "CHANGELOG.md: says version 1.3.0",
            "bindings/ros/dermis_msgs/package.xml: says version none",
        )


if __name__ == "__main__":
    unittest.main()
