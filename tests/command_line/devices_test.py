# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis record` on every device of devices/emulators.py: each frame is recorded once and in order, whatever the
transport; damaged bytes cost the frames they are in; `protocol=auto` sees no difference. The long form of this is
scripts/device_campaign."""

import random
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import support
from devices.campaign import damage, record
from devices.emulators import DEVICES

AT_ONCE = 6
SECONDS = 1.0


def bytes_of(device):
    """Of a damaged stream: at least 20 damages and, of any array, many frames."""
    return 200_000 + 200 * device.rows * device.cols


class Devices(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_all(self, runs):
        """Runs record() with each of the (device, keywords) at the same time."""
        with ThreadPoolExecutor(AT_ONCE) as pool:
            outcomes = pool.map(lambda run: record(support.BINARY, self.folder, run[0], **run[1]), runs)
            for (device, _), outcome in zip(runs, outcomes):
                with self.subTest(outcome.name):
                    self.assertGreater(outcome.sent, 0)
                    self.assertEqual(list(outcome.failures(device.checksum)), [], outcome.says)

    def test_every_frame_is_recorded(self):
        self.run_all(
            [
                (device, {"transport": transport, "seconds": SECONDS})
                for device in DEVICES
                for transport in device.transports
            ]
        )

    def test_the_protocol_is_recognised(self):
        self.run_all(
            [
                (device, {"transport": "file", "seconds": SECONDS, "auto": True})
                for device in DEVICES
                if device.recognised
            ]
        )

    def test_it_may_begin_in_the_middle_of_a_frame(self):
        self.run_all(
            [
                (device, {"transport": "file", "seconds": SECONDS, "joined": True})
                for device in DEVICES
                if device.is_independent
            ]
        )

    def test_damage_costs_the_frames_it_hits(self):
        self.run_all(
            [
                (device, {"transport": "file", "seconds": bytes_of(device) / device.bytes_per_second, "corrupt": True})
                for device in DEVICES
                if device.is_independent
            ]
        )


class Damage(unittest.TestCase):
    def test_frames_that_are_not_hit_keep_their_bytes(self):
        for device in DEVICES:
            generator = random.Random(device.name)
            _, pieces = device.stream(generator, count=20)
            spoilt, hit = damage(pieces, generator, 1e-3)
            with self.subTest(device.name):
                self.assertEqual(len(spoilt), len(pieces))
                for before, after in zip(pieces, spoilt):
                    if not hit.intersection(before.frames):
                        self.assertTrue(after.data.endswith(before.data))


if __name__ == "__main__":
    support.main()
