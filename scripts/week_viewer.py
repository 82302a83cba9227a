# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A client of `dermis serve` for scripts/week: it looks at every frame that it is sent, and sometimes it sleeps."""

import contextlib
import json
import socket
import struct
import threading
import time

from week_devices import COLS, ROWS

UPGRADE = """GET / HTTP/1.1\r
Host: 127.0.0.1:{port}\r
Upgrade: websocket\r
Connection: Upgrade\r
Sec-WebSocket-Version: 13\r
Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r
Sec-WebSocket-Protocol: foxglove.sdk.v1\r
\r
"""
TEXT, BINARY, PING, PONG = 1, 2, 9, 10
MESSAGE_DATA = 1
IMAGE_BYTES = 2 * ROWS * COLS
PATIENCE_S = 30
AGE_S = 2  # a frame that is younger is of now
SET_S = 60


class Stream:
    """A connection that has become a WebSocket."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), PATIENCE_S)
        self.socket.sendall(UPGRADE.format(port=port).encode())
        self.file = self.socket.makefile("rb")
        while self.file.readline().strip():
            pass

    def send(self, data, kind=TEXT):
        size = len(data)
        head = (
            struct.pack(">BB", 0x80 | kind, 0x80 | size) if size < 126 else struct.pack(">BBH", 0x80 | kind, 254, size)
        )
        self.socket.sendall(head + bytes(4) + data)

    def say(self, operation, **fields):
        self.send(json.dumps({"op": operation, **fields}).encode())

    def read(self, size):
        data = self.file.read(size)
        if len(data) < size:
            raise ConnectionError("the server has closed the stream")
        return data

    def messages(self):
        """(kind, data) without an end."""
        while True:
            kind, size = self.read(2)
            if size == 126:
                (size,) = struct.unpack(">H", self.read(2))
            elif size == 127:
                (size,) = struct.unpack(">Q", self.read(8))
            data = self.read(size)
            if kind & 15 == PING:
                self.send(data, PONG)
            else:
                yield kind & 15, data

    def close(self):
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()


class Viewer(threading.Thread):
    """Connects again where the server has dropped it."""

    def __init__(self, port, devices):
        super().__init__(daemon=True)
        self.port, self.devices = port, {device.name: device for device in devices}
        self.frames = self.connections = 0
        self.faults, self.notices = [], []
        self.seen = time.monotonic()  # a frame of now
        self.awake = threading.Event()
        self.awake.set()
        self.is_over = False

    def run(self):
        while not self.is_over:
            with contextlib.suppress(OSError):
                self.watch(Stream(self.port))
            time.sleep(0.5)

    def watch(self, stream):
        self.connections += 1
        channels, newest = {}, {}
        with contextlib.closing(stream):
            for kind, data in stream.messages():
                self.awake.wait()
                if self.is_over:
                    return
                if kind == TEXT:
                    self.hear(stream, json.loads(data), channels)
                elif data[0] == MESSAGE_DATA:
                    self.see(channels[struct.unpack_from("<I", data, 1)[0]], data[13:], newest)

    def hear(self, stream, told, channels):
        if told["op"] == "advertise":
            channels |= {channel["id"]: channel["topic"] for channel in told["channels"]}
            stream.say("subscribe", subscriptions=[{"id": k, "channelId": k} for k in channels])
        elif told["op"] == "status":
            self.notices.append(told["message"])

    def see(self, topic, message, newest):
        name, _, kind = topic[1:].partition("/")
        if kind != "raw":
            return
        device = self.devices[name]
        number = device.frames.number_in(message[-IMAGE_BYTES:])
        before = newest.get(name, -1)
        if number is None or not before < number <= device.number:
            self.faults.append(f"viewer: {name}: frame {number} after {before}")
            return
        newest[name] = number
        self.frames += 1
        if number + AGE_S * device.rate > device.number:
            self.seen = time.monotonic()


def ask(port, operation, **fields):
    """The parameters of the server's answer, by name; on a connection of its own, as a person would."""
    with contextlib.closing(Stream(port)) as stream:
        stream.say(operation, **fields, id="week")
        for kind, data in stream.messages():
            if kind == TEXT and (told := json.loads(data)).get("id") == "week":
                return {parameter["name"]: parameter.get("value") for parameter in told["parameters"]}
        return None


def set_parameter(port, name, value):
    """Again where the connection is lost, as it is where the machine is overloaded."""
    end = time.monotonic() + SET_S
    while True:
        try:
            return ask(port, "setParameters", parameters=[{"name": name, "value": value}])
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.5)


def parameter(port, name):
    return ask(port, "getParameters", parameterNames=[name])[name]
