# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Frames of one dermis are those of another that hears them by DDS, bit by bit.

Usage: frames_test.py DERMIS"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "command_line"))
import support
from loopback import ENVIRONMENT
from support import SmallArray

DOMAIN = 100 + os.getpid() % 100
FRAMES = 200


class Frames(SmallArray):
    def start(self, *command):
        started = subprocess.Popen(
            [support.BINARY, *map(str, command)], env=ENVIRONMENT, stderr=subprocess.PIPE, text=True
        )
        self.addCleanup(started.stderr.close)
        self.addCleanup(started.wait)
        self.addCleanup(started.kill)
        return started

    def fields_of(self, recording):
        """All that a recording knows of its frames, by name."""
        table = recording.with_suffix(".h5")
        self.succeed("convert", recording, table)
        with h5py.File(table) as file:
            return {name: values[()] for name, values in file.items() if isinstance(values, h5py.Dataset)}

    def test_another_dermis_gets_all_of_every_frame(self):
        served, heard = self.work / "served.mcap", self.work / "heard.mcap"
        address = f"dds://{DOMAIN}/rt/small/frame?type=dermis_msgs/RawFrame&loopback=1"
        recorder = self.start("record", "--from", address, "--out", heard, "--frames", FRAMES)
        source = ("--from", "sim:contacts?rows=4&cols=5&rate=200", "--model", self.model, "--record", served)
        server = self.start("serve", *source, "--port", 0, "--dds", "--domain", DOMAIN)
        self.assertEqual(recorder.wait(60), 0, recorder.stderr.read())
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(60), 0, server.stderr.read())
        sent, received = self.fields_of(served), self.fields_of(heard)
        self.assertEqual(sent.keys(), received.keys())
        self.assertLessEqual({"counts", "temperature_celsius", "supply_v", "sequence", "device_time_ns"}, sent.keys())
        first = np.searchsorted(sent["sequence"], received["sequence"][0])
        for name in sent.keys() - {"arrival_steady_ns"}:
            np.testing.assert_array_equal(received[name], sent[name][first : first + FRAMES], err_msg=name)
        self.assertFalse(np.isnan(received["temperature_celsius"]).any())


if __name__ == "__main__":
    support.main()
