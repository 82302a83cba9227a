# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What hands of other vendors' libraries send is what dermis records, number by number."""

import os
import pty
import signal
import subprocess
import sys
import tempfile
import time
import tty
import unittest
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[2] / "command_line"))
sys.path.append(str(Path(__file__).parents[1] / "dds"))
import support
from hand_values import FIRST, REGIONS, module_sent, numbers_of, table_of, touch_sent
from loopback import ENVIRONMENT
from support import dermis

MODBUS_HAND = sys.argv.pop(3)
CYCLONE_HAND = sys.argv.pop(2)
DOMAIN = 100 + os.getpid() % 100

ENOUGH_BYTES = 600_000  # some 100 frames of each region of two hands; a busy machine reads some rarely
MODULE = "unitree_hg/msg/HandState"
INSPIRE = "inspire/inspire_hand_touch"


def recorded(path):
    """Readings and temperatures of a recording, or of one of its arrays, a line a frame."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "frames.csv"
        result = dermis("convert", path, table)
        if result.returncode:
            raise AssertionError(result.stderr)
        return table_of(table)


class Hands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def start(self, *command, pass_fds=()):
        started = subprocess.Popen(
            list(map(str, command)), env=ENVIRONMENT, stdout=subprocess.PIPE, text=True, pass_fds=pass_fds
        )
        self.addCleanup(started.stdout.close)
        self.addCleanup(started.wait)
        self.addCleanup(started.kill)
        return started

    def record(self, name, address, *options):
        out = self.work / f"{name}.mcap"
        return out, self.start(support.BINARY, "record", "--from", address, "--out", out, *options)

    def listen(self, sources, topics, rate, seconds, reliability="reliable"):
        """Records the sources while a hand publishes; returns their recordings and the number of messages."""
        messages = int(rate * seconds)
        recorders = [self.record(name, address, "--frames", messages) for name, address in sources.items()]
        hand = self.start(CYCLONE_HAND, DOMAIN, len(sources), rate, seconds, reliability, *topics)
        lines, _ = hand.communicate(timeout=60)
        self.assertEqual(lines, f"ready\nsent {messages}\n")
        for _, recorder in recorders:
            self.assertEqual(recorder.wait(60), 0)
        return dict(zip(sources, (path for path, _ in recorders), strict=True)), messages

    def address(self, topic, kind, array=""):
        return f"dds://{DOMAIN}/{topic}?type={kind}&loopback=1" + (f"&array={array}" if array else "")

    def test_modules_of_a_hand_have_their_pressures_and_temperatures(self):
        topic = "rt/dex3/left/state"
        sources = {f"module_{m}": self.address(topic, MODULE, f"module_{m}") for m in (0, 8)}
        paths, messages = self.listen(sources, [f"{topic}=hand_state"], 500, 1)
        for m in (0, 8):
            pressures, celsius = recorded(paths[f"module_{m}"])
            sent, temperatures = module_sent(0, m, messages)
            np.testing.assert_array_equal(pressures, sent)
            np.testing.assert_array_equal(celsius, temperatures)

    def test_regions_of_a_hand_by_dds(self):
        topic = "rt/inspire_hand/touch/l"
        names = ("little_tip", "thumb_middle", "palm")
        sources = {name: self.address(topic, INSPIRE, name) for name in names}
        paths, messages = self.listen(sources, [f"{topic}=inspire_touch"], 100, 1)
        for name in names:
            readings, _ = recorded(paths[name])
            sent = touch_sent(0, FIRST[name], readings.shape[1], np.arange(messages))
            np.testing.assert_array_equal(readings, sent)

    def test_writers_that_send_nothing_again_are_heard_too(self):
        topic = "rt/mat"
        messages = 200
        out, recorder = self.record("mat", self.address(topic, "std_msgs/Float32MultiArray"), "--frames", messages)
        self.start(CYCLONE_HAND, DOMAIN, 1, 200, 60, "best_effort", f"{topic}=float_array")
        self.assertEqual(recorder.wait(60), 0)
        readings, _ = recorded(out)
        np.testing.assert_array_equal(readings, readings[:, :1] + np.arange(20) / 4)
        np.testing.assert_array_equal(np.diff(readings[:, 0]), 1)

    def check_regions(self, seed, hand, out, region, taxels):
        """Every answer of the hand is a frame, in its order, until the recording ends."""
        lines, _ = hand.communicate(timeout=60)
        answered = {int(a): int(n) for a, n in (line.split() for line in lines.splitlines())}
        readings, _ = recorded(out)
        first = FIRST[region]
        self.assertGreaterEqual(answered[3000 + 2 * first], len(readings))
        self.assertGreater(len(readings), 20)
        np.testing.assert_array_equal(readings, touch_sent(seed, first, taxels, np.arange(len(readings))))

    def test_regions_of_a_hand_by_modbus_tcp(self):
        hand = self.start(MODBUS_HAND, "tcp", 3, 2)
        port = hand.stdout.readline().split()[1]
        address = f"modbus-tcp://127.0.0.1:{port}?map=inspire-rh56&array=palm"
        out, recorder = self.record("palm", address, "--frames", 100)
        self.assertEqual(recorder.wait(60), 0)
        self.check_regions(3, hand, out, "palm", 112)

    def test_regions_of_a_hand_by_a_serial_line(self):
        device, line = pty.openpty()
        computer, other = pty.openpty()
        for end in (device, line, computer, other):
            tty.setraw(end)
        forward = subprocess.Popen(
            [sys.executable, "-c", FORWARD, str(device), str(computer)], pass_fds=(device, computer)
        )
        self.addCleanup(forward.wait)
        self.addCleanup(forward.kill)
        hand = self.start(MODBUS_HAND, os.ttyname(line), 5, 0)
        self.assertEqual(hand.stdout.readline(), "open\n")
        address = f"modbus-rtu://{os.ttyname(other)}?map=inspire-rh56&array=thumb_middle"
        out, recorder = self.record("thumb", address, "--frames", 50)
        self.assertEqual(recorder.wait(60), 0)
        readings, _ = recorded(out)
        np.testing.assert_array_equal(readings, touch_sent(5, FIRST["thumb_middle"], 9, np.arange(50)))

    def test_a_late_answer_on_a_serial_line_is_taken_for_none(self):
        device, line = pty.openpty()
        for end in (device, line):
            tty.setraw(end)
        table = self.work / "pad.toml"
        table.write_text('[registers]\narray = [{name = "pad", address = 0, rows = 16, cols = 16}]\n')
        slave = self.start(sys.executable, "-c", LATE_SLAVE, device, pass_fds=(device,))
        address = f"modbus-rtu://{os.ttyname(line)}?map={table}&array=pad"
        out, recorder = self.record("pad", address, "--frames", 30)
        self.assertEqual(recorder.wait(120), 0)
        slave.kill()
        readings, _ = recorded(out)
        np.testing.assert_array_equal(readings - readings[:, :1], np.broadcast_to(np.arange(256), (30, 256)))

    def test_both_hands_are_served_and_recorded(self):
        hands = [self.start(MODBUS_HAND, "tcp", side, 1) for side in (1, 2)]
        ports = [hand.stdout.readline().split()[1] for hand in hands]
        suit = ['[suit]\nname = "hands"\n']
        for name, rows, cols in REGIONS:
            array = self.work / f"{rows}x{cols}.toml"
            array.write_text(
                f'[array]\nrows = {rows}\ncols = {cols}\n[readout]\ncircuit = "force"\nadc_noise_counts = 1.0\n'
            )
            for side, port in zip(("left", "right"), ports, strict=True):
                suit.append(f'[[array]]\nname = "{side}_{name}"\nmodel = "{array.name}"\n')
                suit.append(f'from = "modbus-tcp://127.0.0.1:{port}?map=inspire-rh56&array={name}"\n')
        (self.work / "suit.toml").write_text("\n".join(suit))
        out = self.work / "hands.mcap"
        server = self.start(support.BINARY, "serve", "--suit", self.work / "suit.toml", "--port", 0, "--record", out)
        end = time.monotonic() + 120
        while server.poll() is None and not (out.exists() and out.stat().st_size >= ENOUGH_BYTES):
            self.assertLess(time.monotonic(), end, "the hands are not recorded")
            time.sleep(0.05)
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(60), 0)
        for side, hand in zip(("left", "right"), hands, strict=True):
            self.assertEqual(hand.wait(60), 0)
            seed = 1 if side == "left" else 2
            for name, rows, cols in REGIONS:
                readings, _ = recorded(f"{out}#{side}_{name}")
                self.assertGreater(len(readings), 10)
                numbers = numbers_of(seed, FIRST[name], readings)
                self.assertTrue((np.diff(numbers) % 4096 == 1).all(), "an answer is missing")
                expected = touch_sent(seed, FIRST[name], rows * cols, numbers)
                np.testing.assert_array_equal(readings, expected)


# Carries bytes between two lines.
FORWARD = """
import os, select, sys
ends = list(map(int, sys.argv[1:]))
while True:
    for end in select.select(ends, [], [])[0]:
        os.write(ends[1 - ends.index(end)], os.read(end, 4096))
"""

# A device on a serial line: register a holds a + the number of the round. Each tenth answer comes too late.
LATE_SLAVE = """
import os, sys, time
line = int(sys.argv[1])
def checked(frame):
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return frame + bytes([crc & 0xFF, crc >> 8])
question, asked, rounds = b'', 0, 0
while True:
    question += os.read(line, 8 - len(question))
    if len(question) < 8:
        continue
    address, words = question[2] << 8 | question[3], question[4] << 8 | question[5]
    rounds += address == 0
    asked += 1
    if asked % 10 == 0:
        time.sleep(0.7)
    values = b''.join((address + k + rounds).to_bytes(2, 'big') for k in range(words))
    os.write(line, checked(question[:2] + bytes([2 * words]) + values))
    question = b''
"""


if __name__ == "__main__":
    support.main()
