# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The UTC clock of a robot is set while its server is away: set_clock_test.py DERMIS"""

import contextlib
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

DERMIS = sys.argv.pop(1)
ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts"))

from served_suit import free_port  # noqa: E402
from week_viewer import MESSAGE_DATA, TEXT, Stream, parameter, set_parameter  # noqa: E402
from week_world import ROBOT, Hub, SetClock  # noqa: E402

MOST_SECONDS = 60
HOUR_S = 3600


@unittest.skipIf(shutil.which("nats-server") is None, "nats-server is not installed")
@unittest.skipIf(shutil.which("cc") is None, "there is no compiler")
class SetClockTest(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = Path(made.name)
        self.clock, self.hub = SetClock(self.folder), Hub(self.folder / "hub")
        self.addCleanup(self.hub.close)
        self.environment = {**os.environ, **self.clock.environment}
        array = ROOT / "examples/chest/array.toml"
        self.port = free_port()
        command = [DERMIS, "serve", "--from", "sim:contacts?rate=100", "--model", array, "--port", self.port]
        command += ["--publish", self.hub.robots_url, "--robot", ROBOT]
        self.robot = subprocess.Popen(list(map(str, command)), stderr=subprocess.DEVNULL, env=self.environment)
        self.addCleanup(self.robot.wait)
        self.addCleanup(self.robot.kill)

    def await_messages(self, more_than):
        end = time.monotonic() + MOST_SECONDS
        while (self.hub.messages() or 0) <= more_than:
            self.assertIsNone(self.robot.poll())
            self.assertLess(time.monotonic(), end, "nothing is published")
            time.sleep(0.1)

    def test_clock_of_a_process_is_set(self):
        self.clock.step(-HOUR_S)
        told = subprocess.run(["date", "+%s"], env=self.environment, capture_output=True, check=True).stdout
        self.assertAlmostEqual(float(told), time.time() - HOUR_S, delta=MOST_SECONDS)

    def times(self, stream, topics):
        """The newest time of each of the topics, when all have come [s since 1970]."""
        channels, times = {}, {}
        for kind, data in stream.messages():
            if kind == TEXT and (told := json.loads(data))["op"] == "advertise":
                channels |= {channel["id"]: channel["topic"] for channel in told["channels"]}
                stream.say("subscribe", subscriptions=[{"id": k, "channelId": k} for k in channels])
            elif kind != TEXT and data[0] == MESSAGE_DATA:
                channel, nanoseconds = struct.unpack_from("<IQ", data, 1)
                times[channels[channel]] = nanoseconds / 1e9
                if set(topics) <= set(times):
                    return [times[topic] for topic in topics]
        return None

    def test_messages_of_a_server_have_the_clock_of_its_frames_when_the_clock_is_set(self):
        self.await_messages(0)
        for step in (HOUR_S, -2 * HOUR_S):
            self.clock.step(step)
            with contextlib.closing(Stream(self.port)) as stream:
                of_frame, of_statistics = self.times(stream, ("/chest/raw", "/statistics"))
            self.assertAlmostEqual(of_frame, of_statistics, delta=MOST_SECONDS)

    def test_tare_can_be_undone_for_a_minute_though_the_clock_was_set(self):
        self.await_messages(0)
        set_parameter(self.port, "/tare", True)
        end = time.monotonic() + MOST_SECONDS
        while not parameter(self.port, "/tare/undo"):
            self.assertLess(time.monotonic(), end, "nothing was tared")
            if parameter(self.port, "/tare/refused"):
                set_parameter(self.port, "/tare/force", True)
            time.sleep(0.2)
        self.clock.step(HOUR_S)
        self.assertTrue(parameter(self.port, "/tare/undo"))

    def test_robot_publishes_again_though_its_clock_was_set_back_meanwhile(self):
        self.await_messages(0)
        self.hub.cut()
        time.sleep(1)  # it tries to connect, and waits between
        self.clock.step(-HOUR_S)
        time.sleep(1)
        published = self.hub.messages()
        self.hub.connect()
        self.await_messages(published)


if __name__ == "__main__":
    unittest.main()
