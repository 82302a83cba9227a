# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Arrays that come and go, for scripts/week. Each frame carries its number in the lowest bits of ten readings, in which
nothing of dermis is interested. So whoever has a frame knows which one it is, and whether all its bits are right."""

import contextlib
import fcntl
import os
import random
import select
import socket
import struct
import sys
import termios
import threading
import time
import zlib

from served_suit import ROOT

sys.path.insert(0, str(ROOT / "tests/command_line"))

from devices.emulators import cobs
from devices.lines import Serial, TcpServer

ROWS = COLS = 16
BITS = 3  # of the number, in each of ten readings
HOLDERS = 10
BAUD = 2_000_000
DRAIN_S = 10
RESTING = 8  # [counts]
QUIET_S = 0.5
TOUCHES = 64  # different frames


class Frames:
    """The frames of one array by their number."""

    def __init__(self, seed):
        chance = random.Random(seed)
        self.touches = [self.touch(chance, number) for number in range(TOUCHES)]

    @staticmethod
    def touch(chance, number):
        """A hand comes and goes; the rest is noise."""
        counts = [RESTING + chance.randrange(4) for _ in range(ROWS * COLS)]
        strength = max(0, 2 * number - TOUCHES) * 20
        for row in range(6, 10):
            for col in range(5, 9):
                counts[row * COLS + col] += strength
        return struct.pack(f"<{len(counts)}H", *counts)

    def bytes_of(self, number):
        data = bytearray(self.touches[number // 8 % TOUCHES])
        for place in range(HOLDERS):
            data[2 * place] = data[2 * place] & ~7 | number >> BITS * place & 7
        return bytes(data)

    def number_in(self, data):
        """None: no frame of this array has these bits."""
        number = sum((data[2 * place] & 7) << BITS * place for place in range(HOLDERS))
        return number if data == self.bytes_of(number) else None


class Pty(Serial):
    """A serial device at a name that stays."""

    def __init__(self, link):
        super().__init__(BAUD, link)
        self.link = link

    def unread(self):
        return struct.unpack("i", fcntl.ioctl(self.slave, termios.FIONREAD, b"\0" * 4))[0]

    def plug(self):
        self.__init__(self.link)

    def drain(self):
        """Unplugs when the reader has all."""
        end = quiet = time.monotonic()
        while time.monotonic() < min(end + DRAIN_S, quiet + QUIET_S):
            quiet = time.monotonic() if self.unread() else quiet
            time.sleep(0.01)
        self.pull()

    def pull(self):
        """The name goes with the device, before another one gets it."""
        self.link.unlink()
        self.close()


class Tcp(TcpServer):
    """A device that listens."""

    def plug(self):
        """It listens all the time."""

    def drain(self):
        """The reader closes its end when it has all."""
        with contextlib.suppress(OSError), self.connection as connection:
            connection.settimeout(DRAIN_S)
            connection.shutdown(socket.SHUT_WR)
            while connection.recv(4096):
                pass

    def pull(self):
        """Without a word: what is on the way is lost."""
        self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.connection.close()


class Device(threading.Thread):
    """Sends frames at its rate, by the protocol of dermis. Frames that it takes while nobody is there are lost, and it
    counts on; without power it takes none, and begins anew at 0."""

    def __init__(self, name, line, rate, seed):
        super().__init__(daemon=True)
        self.name, self.line, self.rate, self.frames = name, line, rate, Frames(seed)
        self.whole = bytearray()  # of each frame that was taken: has all of it gone out?
        self.first = 0  # number of the first frame since it has power
        self.is_plugged, self.has_power, self.is_heard, self.is_over = True, False, False, False
        self.lock = threading.Lock()

    @property
    def number(self):
        """Of the next frame."""
        return len(self.whole)

    def run(self):
        due = time.monotonic()
        while not self.is_over:
            due = max(due + 1 / self.rate, time.monotonic() - 0.5)
            time.sleep(max(0.0, due - time.monotonic()))
            with self.lock:
                if self.is_plugged and not self.is_heard and self.line.is_open():
                    self.is_heard = self.has_power = True
                    self.write(b"\0")
                if self.has_power:
                    self.whole.append(self.is_heard and self.write(self.packet()))

    def packet(self):
        sequence = self.number - self.first
        time_us = round(sequence * 1e6 / self.rate) & 0xFFFFFFFF
        packet = struct.pack("<BBIIhHHH", 1, 7, sequence, time_us, 2500, 5000, ROWS, COLS)
        packet += self.frames.bytes_of(self.number)
        return cobs(packet + struct.pack("<I", zlib.crc32(packet))) + b"\0"

    def write(self, data):
        """Is all of it on the way?"""
        end = time.monotonic() + DRAIN_S
        while data and time.monotonic() < end:
            try:
                if select.select([], [self.line.descriptor], [], 0.1)[1]:
                    data = data[os.write(self.line.descriptor, data) :]
            except BlockingIOError:
                continue
            except OSError:  # the reader has hung up
                break
        return not data

    def pull(self):
        """In the middle of a frame."""
        with self.lock:
            if self.is_heard:
                packet = self.packet()
                self.write(packet[: len(packet) // 2])
                self.whole.append(False)
                self.line.pull()
            self.is_plugged = self.is_heard = False

    def switch_off(self):
        """After its last frame has been read; not while nobody hears it, as it would forget what it lost."""
        with self.lock:
            if self.is_heard:
                self.line.drain()
                self.is_plugged = self.is_heard = self.has_power = False
                self.first = self.number

    def plug(self):
        with self.lock:
            if not self.is_plugged:
                self.line.plug()
            self.is_plugged = True

    def end(self):
        self.switch_off()
        self.is_over = True
