# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What goes wrong with devices: one line says what to do, and what was recorded before stays valid."""

import contextlib
import json
import os
import random
import signal
import socket
import struct
import tempfile
import time
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import support
from devices.campaign import Recorder
from devices.emulators import DEVICES, Piece
from devices.lines import Serial, TcpServer, free_port
from devices.recordings import read_frames
from support import dermis, files_limited_to


def device_named(name):
    return next(device for device in DEVICES if device.name == name)


FLEXITAC, WUJI, DERMIS = map(device_named, ("flexitac 12x32", "wuji 1550", "dermis 12x32"))


class Failures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)
        self.out = self.work / "rec.mcap"

    def start(self, line, device, parameters=None, out=None):
        uri = line.uri({**device.parameters(False), **(parameters or {})})
        recorder = Recorder(support.BINARY, uri, out or self.out)
        self.addCleanup(recorder.kill)
        line.wait_for_reader(recorder.is_running)
        return recorder

    def error_of(self, says, places):
        """The one line that begins with "dermis: ", which holds all of `places`."""
        errors = [line for line in says.splitlines() if line.startswith("dermis: ")]
        self.assertEqual(len(errors), 1, says)
        for place in places:
            self.assertIn(str(place), errors[0])
        return errors[0]

    def refuse(self, uri, places, status=(1, 2), **options):
        """`record` ends with one line and leaves no file."""
        result = dermis("record", "--from", uri, "--out", self.out, **options)
        self.assertIn(result.returncode, status, result.stderr)
        self.error_of(result.stderr, places)
        self.assertEqual(result.stdout, "")
        self.assertFalse(self.out.exists())

    def recorded(self, frames, complete=True):
        """The recording is valid, and holds exactly these frames."""
        result = dermis("info", self.out, "--json")
        self.assertEqual(result.returncode, 0 if complete else 1, result.stderr)
        info = json.loads(result.stdout)
        self.assertEqual(info["frames"], len(frames))
        self.assertEqual(info["complete"], complete)
        self.assertEqual(
            [list(record.counts) for record in read_frames(self.out)], [list(frame.counts) for frame in frames]
        )

    def test_interrupted(self):
        """Ctrl-C in the middle of a frame, or `kill`: all whole frames are there."""
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number), contextlib.closing(Serial(2_000_000)) as line:
                frames, pieces = DERMIS.stream(random.Random(1), count=50)
                recorder = self.start(line, DERMIS)
                half = Piece(pieces[-1].data[:300])
                line.play([*pieces[:-1], half], DERMIS.bytes_per_second, recorder.is_running)
                time.sleep(0.5)
                recorder.process.send_signal(number)
                status, says = recorder.finish(10)
                self.assertEqual(status, 0, says)
                self.recorded(frames[:-1])
                self.out.unlink()

    def test_unplugged(self):
        frames, pieces = FLEXITAC.stream(random.Random(2), count=200)
        link = self.work / "ttyTactile"
        line = Serial(2_000_000, link)
        recorder = self.start(line, FLEXITAC, parameters={"reconnect_s": 1})
        line.play([*pieces, Piece(b"\xaa\x55" + bytes(100))], FLEXITAC.bytes_per_second, recorder.is_running)
        time.sleep(0.5)
        link.unlink()
        line.close()
        status, says = recorder.finish(20)
        self.assertEqual(status, 1, says)
        self.error_of(says, [line.path])
        self.recorded(frames)

    def test_plugged_in_again(self):
        """Under the same name, as udev gives it, another pseudo-terminal; three times, in the middle of frames."""
        frames, pieces = DERMIS.stream(random.Random(3), count=120)
        link, whole = self.work / "ttyTactile", []
        line = Serial(2_000_000, link)
        recorder = self.start(line, DERMIS, parameters={"reconnect_s": 20})
        for part in range(4):
            if part > 0:
                line = Serial(2_000_000, link)
                line.wait_for_reader(recorder.is_running)
            begin = 30 * part
            mine = pieces[begin : begin + 30]
            mine[-1] = Piece(mine[-1].data[:400])
            whole += frames[begin + (part > 0) : begin + 29]
            if part > 0:
                mine[0] = Piece(mine[0].data[111:])
            line.play(mine, DERMIS.bytes_per_second, recorder.is_running)
            time.sleep(0.3)
            if part < 3:
                line.close()
        status, says = recorder.finish(10, interrupt=True)
        line.close()
        self.assertEqual(status, 0, says)
        self.assertEqual([notice for notice in says.splitlines() if "dermis: " in notice[:8]], [], says)
        self.recorded(whole)

    def test_full_disk(self):
        frames, pieces = DERMIS.stream(random.Random(4), count=400)
        with contextlib.closing(Serial(2_000_000)) as line:
            recorder = Recorder(
                support.BINARY, line.uri(DERMIS.parameters(False)), self.out, **files_limited_to(100_000)
            )
            line.wait_for_reader(recorder.is_running)
            line.play(pieces, DERMIS.bytes_per_second, recorder.is_running)
            status, says = recorder.finish(20)
        self.assertEqual(status, 1, says)
        self.error_of(says, [self.out])
        recorded = read_frames(self.out)
        self.assertGreater(len(recorded), 20)
        result = dermis("info", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["frames"], len(recorded))
        self.assertEqual(
            [list(record.counts) for record in recorded], [list(frame.counts) for frame in frames[: len(recorded)]]
        )

    def test_bytes_that_are_no_frames(self):
        """Of another protocol, which is named, and of none."""
        noise = [Piece(random.Random(6).randbytes(1_000_000))]
        cases = [
            (FLEXITAC, WUJI.stream(random.Random(5), seconds=2)[1], ["flexitac", "wuji"]),
            (WUJI, FLEXITAC.stream(random.Random(5), seconds=10)[1], ["wuji", "flexitac"]),
            (FLEXITAC, noise, ["flexitac"]),
            (DERMIS, noise, ["dermis"]),
        ]
        with ThreadPoolExecutor(len(cases)) as pool:
            for case, (status, says) in zip(cases, pool.map(lambda case: self.play_wrong(*case[:2]), cases)):
                with self.subTest(case[2]):
                    self.assertIn(status, (1, 2), says)
                    self.error_of(says, case[2])

    def play_wrong(self, device, pieces):
        with contextlib.closing(Serial(2_000_000)) as line:
            recorder = self.start(line, device, out=self.work / f"{id(line)}.mcap")
            line.play(pieces, 150_000, recorder.is_running)
            return recorder.finish(10)

    def test_silence(self):
        """Nothing comes: one notice, and it waits on."""
        with contextlib.closing(Serial(2_000_000)) as line:
            recorder = self.start(line, FLEXITAC)
            time.sleep(4)
            self.assertTrue(recorder.is_running())
            _, says = recorder.finish(10, interrupt=True)
        self.assertEqual(says.count("no bytes"), 1, says)

    def test_killed_peer(self):
        """A connection that is reset, and nobody to connect to afterwards."""
        frames, pieces = DERMIS.stream(random.Random(7), count=100)
        line = TcpServer()
        recorder = self.start(line, DERMIS, parameters={"reconnect_s": 1})
        line.play(pieces, DERMIS.bytes_per_second, recorder.is_running)
        time.sleep(0.5)
        line.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        line.connection.close()
        line.connection = None
        line.close()
        status, says = recorder.finish(20)
        self.assertIn(status, (0, 1), says)
        self.recorded(frames)

    def test_peer_that_comes_back(self):
        frames, pieces = DERMIS.stream(random.Random(8), count=100)
        line = TcpServer()
        recorder = self.start(line, DERMIS, parameters={"reconnect_s": 20})
        line.play(pieces[:50], DERMIS.bytes_per_second, recorder.is_running)
        line.connection.close()
        line.connection = None
        line.wait_for_reader(recorder.is_running)
        line.play(pieces[50:], DERMIS.bytes_per_second, recorder.is_running)
        time.sleep(0.5)
        status, says = recorder.finish(10, interrupt=True)
        line.close()
        self.assertEqual(status, 0, says)
        self.recorded(frames)

    def test_places_that_are_not_there(self):
        self.refuse("serial:///dev/ttyNobody?protocol=flexitac&rows=12&cols=32", ["/dev/ttyNobody"])
        self.refuse("serial:///dev/null?protocol=flexitac&rows=12&cols=32", ["/dev/null"])
        self.refuse(f"file:{self.work}/none.bin?protocol=m1616", ["none.bin"])
        self.refuse(f"file:{self.work}?protocol=m1616", [self.work])
        self.refuse(f"tcp://127.0.0.1:{free_port(socket.SOCK_STREAM)}?protocol=dermis&reconnect_s=0", ["127.0.0.1"])
        self.refuse("tcp://nowhere.invalid:7000?protocol=dermis&reconnect_s=0", ["nowhere.invalid"])

    def test_port_in_use(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            self.refuse(f"tcp-listen://127.0.0.1:{port}?protocol=dermis", [port, "in use"])
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", 0))
            port = taken.getsockname()[1]
            self.refuse(f"udp://127.0.0.1:{port}?protocol=dermis", [port, "in use"])

    def test_no_permission(self):
        user = support.as_nobody(self)
        self.work.chmod(0o777)
        with contextlib.closing(Serial(2_000_000)) as line:
            os.chmod(line.path, 0o600)
            result = dermis("record", "--from", line.uri(FLEXITAC.parameters(False)), "--out", self.out, **user)
            self.assertIn(result.returncode, (1, 2), result.stderr)
            self.error_of(result.stderr, [line.path, "dialout"])

    def test_busy_device(self):
        """Two recordings of one device would each get half of the bytes. Root opens what is busy."""
        user = support.as_nobody(self)
        self.work.chmod(0o777)
        with contextlib.closing(Serial(2_000_000)) as line:
            os.chmod(line.path, 0o666)
            self.start(line, FLEXITAC)
            result = dermis(
                "record", "--from", line.uri(FLEXITAC.parameters(False)), "--out", self.work / "second.mcap", **user
            )
            self.assertIn(result.returncode, (1, 2), result.stderr)
            self.error_of(result.stderr, [line.path])

    def test_a_recording_is_not_lost_to_one_that_fails(self):
        self.out.write_bytes(b"what was there")
        for uri in ("serial:///dev/ttyNobody?protocol=flexitac&rows=12&cols=32", "file:/dev/null?protocol=m1616"):
            result = dermis("record", "--from", uri, "--out", self.out)
            self.assertNotEqual(result.returncode, 0)
            self.error_of(result.stderr, [])
            self.assertEqual(self.out.read_bytes(), b"what was there")

    def test_out_that_cannot_be_written(self):
        _, pieces = DERMIS.stream(random.Random(9), count=50)
        stored = self.work / "device.bin"
        stored.write_bytes(b"".join(piece.data for piece in pieces))
        for out in ("/dev/full", self.work / "none" / "rec.mcap", self.work):
            result = dermis("record", "--from", f"file:{stored}?protocol=dermis", "--out", out)
            self.assertIn(result.returncode, (1, 2), result.stderr)
            self.error_of(result.stderr, [out])

    def test_files_that_are_no_recordings(self):
        for name, data in (("empty.mcap", b""), ("text.mcap", b"hello\n" * 100), ("cut.mcap", b"\x89MCAP0")):
            path = self.work / name
            path.write_bytes(data)
            for arguments in (("info", path), ("convert", path, self.work / "o.csv")):
                with self.subTest((arguments[0], name)):
                    result = dermis(*arguments)
                    self.assertIn(result.returncode, (1, 2), result.stderr)
                    self.error_of(result.stderr, [name])
                    self.assertFalse((self.work / "o.csv").exists())


if __name__ == "__main__":
    support.main()
