# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Where an emulated device sends its bytes: a pseudo-terminal, TCP in both directions, UDP, a file. Bytes leave at the
rate of the device, by absolute deadlines."""

import contextlib
import os
import pty
import select
import socket
import termios
import time
from pathlib import Path
from urllib.parse import urlencode

TICK = 0.001  # [s] how often bytes leave: a frame of USB at full speed
PATIENCE = 60  # [s] for the reader to open its end


class Line:
    """One connection to a reader, which opens uri()."""

    worst_delay = 0.0  # [s] by which bytes left too late, because the reader or this program was slow

    def wait_for_reader(self, is_running):
        """Returns when the reader is ready; raises where it ends before."""
        end = time.monotonic() + PATIENCE
        while not self.is_open():
            if not is_running() or time.monotonic() > end:
                raise ConnectionError("the reader did not open its end")
            time.sleep(0.01)
        time.sleep(0.2)

    def play(self, pieces, bytes_per_second, is_running):
        """Sends the bytes as the device would and returns with the last one."""
        begin = time.monotonic()
        for sent, data in self.portions(pieces, bytes_per_second, begin):
            due = begin + (sent + len(data)) / bytes_per_second
            while is_running() and (wait := due - time.monotonic()) > 0:
                time.sleep(min(wait, 0.1))
            if not is_running():
                return
            self.send(data, is_running)
            self.worst_delay = max(self.worst_delay, time.monotonic() - due)

    def portions(self, pieces, bytes_per_second, begin):
        """What leaves at once, and the bytes before it: all that is due since the last time."""
        data = memoryview(b"".join(piece.data for piece in pieces))
        sent = 0
        while sent < len(data):
            due = int((time.monotonic() + TICK - begin) * bytes_per_second)
            portion = data[sent : max(due, sent + 1)]
            yield sent, portion
            sent += len(portion)

    def read(self, timeout):
        return b""

    def close(self):
        pass


class Descriptor(Line):
    """A line that is a file descriptor."""

    descriptor = None

    def send(self, data, is_running):
        while data and is_running():
            _, writable, _ = select.select([], [self.descriptor], [], 0.1)
            if writable:
                with contextlib.suppress(BlockingIOError):
                    data = data[os.write(self.descriptor, data) :]

    def read(self, timeout):
        readable, _, _ = select.select([self.descriptor], [], [], timeout)
        return os.read(self.descriptor, 4096) if readable else b""


class Serial(Descriptor):
    """A pseudo-terminal. The reader is ready when it has made the line raw."""

    def __init__(self, baud, link=None):
        self.descriptor, self.slave = pty.openpty()
        os.set_blocking(self.descriptor, False)
        self.path = os.ttyname(self.slave)
        self.baud = baud
        if link:
            link.unlink(missing_ok=True)
            link.symlink_to(self.path)
            self.path = str(link)

    def uri(self, parameters):
        return f"serial://{self.path}?{urlencode({'baud': self.baud, **parameters})}"

    def is_open(self):
        return not termios.tcgetattr(self.slave)[3] & termios.ICANON

    def close(self):
        os.close(self.slave)
        os.close(self.descriptor)


class TcpServer(Descriptor):
    """The device listens, the reader connects."""

    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.connection = None

    def uri(self, parameters):
        return f"tcp://127.0.0.1:{self.listener.getsockname()[1]}?{urlencode({'reconnect_s': 0, **parameters})}"

    def is_open(self):
        if not select.select([self.listener], [], [], 0)[0]:
            return False
        self.connection, _ = self.listener.accept()
        self.connection.setblocking(False)
        self.descriptor = self.connection.fileno()
        return True

    def close(self):
        self.listener.close()
        hang_up(self.connection)


class TcpClient(Descriptor):
    """The reader listens, the device connects."""

    def __init__(self):
        self.port = free_port(socket.SOCK_STREAM)
        self.connection = None

    def uri(self, parameters):
        return f"tcp-listen://127.0.0.1:{self.port}?{urlencode({'reconnect_s': 0, **parameters})}"

    def is_open(self):
        try:
            self.connection = socket.create_connection(("127.0.0.1", self.port), 1)
        except OSError:
            return False
        self.connection.setblocking(False)
        self.descriptor = self.connection.fileno()
        return True

    def close(self):
        hang_up(self.connection)


class Udp(Line):
    """Each piece is a datagram."""

    def __init__(self):
        self.port = free_port(socket.SOCK_DGRAM)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def uri(self, parameters):
        return f"udp://127.0.0.1:{self.port}?{urlencode(parameters)}"

    def is_open(self):
        return f":{self.port:04X} " in Path("/proc/net/udp").read_text()

    def portions(self, pieces, bytes_per_second, begin):
        sent = 0
        for piece in pieces:
            yield sent, piece.data
            sent += len(piece.data)

    def send(self, data, is_running):
        self.socket.sendto(data, ("127.0.0.1", self.port))

    def close(self):
        self.socket.close()


class Stored(Line):
    """All bytes at once, in a file."""

    def __init__(self, path):
        self.path = path

    def uri(self, parameters):
        return f"file:{self.path}?{urlencode(parameters)}"


def hang_up(connection):
    """In order: what the reader asked for meanwhile is taken, or the system would reset the connection."""
    if connection is None:
        return
    with contextlib.suppress(OSError), connection:
        connection.settimeout(1)
        connection.shutdown(socket.SHUT_WR)
        while connection.recv(4096):
            pass


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def open_line(transport, device):
    return {
        "serial": lambda: Serial(round(device.bytes_per_second * 10)),
        "tcp": TcpServer,
        "tcp-listen": TcpClient,
        "udp": Udp,
    }[transport]()
