# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""colcon builds ros/dermis_msgs, and the type support of ROS 2 reads what we write, field by field.

Usage: package_test.py WRITTEN_MESSAGES WORKSPACE"""

import json
import subprocess
import sys
import unittest
from pathlib import Path

from colcon_workspace import ROOT, build

WRITTEN, WORKSPACE = sys.argv.pop(1), Path(sys.argv.pop(1))


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reader = build(ROOT / "ros/dermis_msgs", WORKSPACE)

    def test_every_message_is_read_as_it_was_written(self):
        written = subprocess.run([WRITTEN], check=True, capture_output=True, text=True).stdout.splitlines()
        messages = [line.split(" ", 2) for line in written]
        lines = "".join(f"{kind} {content}\n" for kind, content, _ in messages)
        read = subprocess.run([self.reader], input=lines, check=True, capture_output=True, text=True).stdout
        self.assertEqual(len({kind for kind, _, _ in messages}), 14)
        for (kind, _, expected), line in zip(messages, read.splitlines(), strict=True):
            self.assertEqual(json.loads(line), json.loads(expected), kind)

    def test_a_message_with_a_byte_more_or_less_is_none_of_its_type(self):
        for change in (lambda text: text + "00", lambda text: text[:-2]):
            kind, content, _ = subprocess.run([WRITTEN], check=True, capture_output=True, text=True).stdout.split(" ", 2)
            read = subprocess.run([self.reader], input=f"{kind} {change(content)}\n", capture_output=True, text=True)
            self.assertEqual(read.returncode, 1, kind)


if __name__ == "__main__":
    unittest.main()
