# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""examples/bluetooth/bridge.py, with a stand-in for the client of bleak. Usage: bluetooth_test.py DERMIS"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import support
from support import dermis

BRIDGE = Path(__file__).parents[2] / "examples/bluetooth/bridge.py"
BLEAK = """import asyncio

class BleakClient:
    def __init__(self, address, disconnected_callback):
        assert address == "AA:BB"
    async def __aenter__(self):
        return self
    async def __aexit__(self, *error):
        self.task.cancel()
    async def start_notify(self, characteristic, callback):
        assert characteristic == "2A37"
        self.task = asyncio.create_task(self.notify(callback))
    async def notify(self, callback):
        for k in range(10**6):
            callback(None, bytearray([0xAA, 0x55, k % 256, 1, 2, 3, 4, 5]))
            await asyncio.sleep(0.005)
"""


class Bluetooth(unittest.TestCase):
    def test_notifications_are_the_bytes_of_a_source(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "bleak.py").write_text(BLEAK)
            bridge = subprocess.Popen(
                [sys.executable, BRIDGE, "AA:BB", "2A37", "0"],
                env={**os.environ, "PYTHONPATH": folder},
                stdout=subprocess.PIPE,
                text=True,
            )
            self.addCleanup(bridge.stdout.close)
            self.addCleanup(bridge.wait)
            self.addCleanup(bridge.kill)
            place = bridge.stdout.readline().split()[-1]
            source = f"{place}?rows=2&cols=3&packet=AA 55,values u8"
            recording, table = Path(folder) / "a.mcap", Path(folder) / "a.csv"
            recorded = dermis("record", "--from", source, "--out", recording, "--frames", 20)
            self.assertEqual(recorded.returncode, 0, recorded.stderr)
            converted = dermis("convert", recording, table)
            self.assertEqual(converted.returncode, 0, converted.stderr)
            rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
            self.assertEqual([row[-5:] for row in rows], [["1", "2", "3", "4", "5"]] * 20)
            first = [int(row[-6]) for row in rows]
            self.assertEqual(first, list(range(first[0], first[0] + 20)))


if __name__ == "__main__":
    support.main()
