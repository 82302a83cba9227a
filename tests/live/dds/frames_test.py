# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Frames of one dermis are those of another that hears them by DDS, bit by bit.

Usage: frames_test.py DERMIS"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np

sys.path.append(str(Path(__file__).parents[2] / "command_line"))
import support
from loopback import ENVIRONMENT
from support import SmallArray

DOMAIN = 100 + os.getpid() % 100
FRAMES = 200
SOURCE = "sim:contacts?rows=4&cols=5&rate=200"
SOME_BYTES = 20_000


class Frames(SmallArray):
    def start(self, *command):
        started = subprocess.Popen(
            [support.BINARY, *map(str, command)], env=ENVIRONMENT, stderr=subprocess.PIPE, text=True
        )
        self.addCleanup(started.stderr.close)
        self.addCleanup(started.wait)
        self.addCleanup(started.kill)
        return started

    def fields_of(self, recording, left_out=None):
        """All that a recording knows of its frames, by name. `left_out`: what a table of frames has no place for."""
        table = recording.with_suffix(".h5")
        result = support.dermis("convert", recording, table)
        lines = [f"{table}: left out: {left_out}"] if left_out else []
        self.assertEqual((result.returncode, support.error_lines(result)), (0, lines))
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
        sent = self.fields_of(served, left_out="forces (the model gives them again)")
        received = self.fields_of(heard)
        self.assertEqual(sent.keys(), received.keys())
        self.assertLessEqual({"counts", "temperature_celsius", "supply_v", "sequence", "device_time_ns"}, sent.keys())
        first = np.searchsorted(sent["sequence"], received["sequence"][0])
        for name in sent.keys() - {"arrival_steady_ns"}:
            np.testing.assert_array_equal(received[name], sent[name][first : first + FRAMES], err_msg=name)
        self.assertFalse(np.isnan(received["temperature_celsius"]).any())

    def await_bytes(self, recording):
        end = time.monotonic() + 60
        while not (recording.exists() and recording.stat().st_size >= SOME_BYTES):
            self.assertLess(time.monotonic(), end, "nothing is recorded")
            time.sleep(0.05)

    def serve(self, model, source):
        return self.start("serve", "--from", source, "--model", model, "--port", 0, "--dds", "--domain", DOMAIN)

    def test_a_server_that_is_started_again_is_heard(self):
        heard = self.work / "heard.mcap"
        frames = 5 * FRAMES
        address = f"dds://{DOMAIN}/rt/small/frame?type=dermis_msgs/RawFrame&loopback=1"
        recorder = self.start("record", "--from", address, "--out", heard, "--frames", frames)
        first = self.serve(self.model, SOURCE)
        self.await_bytes(heard)
        first.send_signal(signal.SIGINT)
        self.assertEqual(first.wait(60), 0)
        self.serve(self.model, SOURCE)
        self.assertEqual(recorder.wait(60), 0)
        received = self.fields_of(heard)
        self.assertEqual(len(received["counts"]), frames)
        steps = np.diff(received["sequence"].astype(np.int64))
        self.assertEqual(np.count_nonzero(steps != 1), 1, "the numbers of each server rise by one")

    def test_images_of_another_size_on_the_same_topic_are_left_out(self):
        heard = self.work / "heard.mcap"
        address = f"dds://{DOMAIN}/rt/small/raw?type=sensor_msgs/Image&loopback=1"
        recorder = self.start("record", "--from", address, "--out", heard)
        self.serve(self.model, SOURCE)
        self.await_bytes(heard)
        large = self.work / "large.toml"
        large.write_text(support.ARRAY.replace("rows = 4", "rows = 64").replace("cols = 5", "cols = 64"))
        self.serve(large, "sim:contacts?rows=64&cols=64&rate=50")
        notice = "frames that are 64x64 are left out, as the array is 4x5"
        self.assertTrue(any(notice in line for line in recorder.stderr))
        recorder.send_signal(signal.SIGINT)
        self.assertEqual(recorder.wait(60), 0)
        self.assertEqual(self.fields_of(heard)["counts"].shape[1:], (4, 5))


if __name__ == "__main__":
    support.main()
