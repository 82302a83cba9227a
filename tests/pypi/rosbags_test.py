# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The package rosbags of PyPI reads a recording. Usage: rosbags_test.py DERMIS FRAMES_CSV"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
from rosbags.highlevel import AnyReader

DERMIS, FRAMES = sys.argv.pop(1), sys.argv.pop(1)
COLUMNS_BEFORE_COUNTS = 3  # time, temperature, supply


def messages_of(recording, topic):
    with AnyReader([recording]) as reader:
        connections = [connection for connection in reader.connections if connection.topic == topic]
        return [
            reader.deserialize(content, connection.msgtype) for connection, _, content in reader.messages(connections)
        ]


class Recording(unittest.TestCase):
    def test_its_frames_are_those_of_the_table_it_was_made_of(self):
        table = numpy.loadtxt(FRAMES, delimiter=",", skiprows=1)
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "frames.mcap"
            subprocess.run([DERMIS, "convert", FRAMES, recording], check=True, capture_output=True)
            images = messages_of(recording, "/array/raw")
            temperatures = messages_of(recording, "/array/temperature")
            supplies = [message.supply_v for message in messages_of(recording, "/array/acquisition")]
        kinds = {"16UC1": numpy.uint16, "32FC1": numpy.float32}
        counts = [image.data.view(kinds[image.encoding]) for image in images]
        numpy.testing.assert_array_equal(counts, table[:, COLUMNS_BEFORE_COUNTS:])
        numpy.testing.assert_array_equal([message.temperature for message in temperatures], table[:, 1])
        numpy.testing.assert_array_equal(supplies, table[:, 2])


if __name__ == "__main__":
    unittest.main()
