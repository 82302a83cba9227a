# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""colcon builds dermis_msgs as Debian installs it, and the type support of ROS 2 reads what we write, field by field.

Usage: package_test.py WRITTEN_MESSAGES BUILD WORKSPACE"""

import json
import subprocess
import sys
import unittest
from pathlib import Path

from colcon_workspace import build

WRITTEN, BUILD, WORKSPACE = sys.argv.pop(1), sys.argv.pop(1), Path(sys.argv.pop(1))
INSTALL = ["cmake", "--install", BUILD, "--component", "ros", "--prefix", WORKSPACE / "debian"]


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        lines = subprocess.run([WRITTEN], check=True, capture_output=True, text=True).stdout.splitlines()
        cls.written = [json.loads(line) for line in lines]
        subprocess.run(INSTALL, check=True, capture_output=True)
        cls.reader = build(WORKSPACE / "debian/share/dermis/ros/dermis_msgs", WORKSPACE)

    def test_every_message_is_read_as_it_was_written(self):
        lines = "".join(f"{message['type']} {message['cdr']}\n" for message in self.written)
        read = subprocess.run([self.reader], input=lines, check=True, capture_output=True, text=True).stdout
        self.assertEqual(len({message["type"] for message in self.written}), 15)
        for message, line in zip(self.written, read.splitlines(), strict=True):
            self.assertEqual(json.loads(line), message["fields"], message["type"])

    def test_a_message_with_a_byte_more_or_less_is_none_of_its_type(self):
        message = self.written[0]
        for changed in (message["cdr"] + "00", message["cdr"][:-2]):
            read = subprocess.run([self.reader], input=f"{message['type']} {changed}\n", capture_output=True, text=True)
            self.assertEqual(read.returncode, 1)


if __name__ == "__main__":
    unittest.main()
