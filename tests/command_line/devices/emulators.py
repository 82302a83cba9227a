# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The devices that dermis speaks to, written from their published byte layouts and from nothing of dermis itself: what
each sends for given frames, and which of its bytes belong to which frame.

Data imitate the marks of their protocol wherever the coding allows it: AA 55 among the readings of a FlexiTac, the
number of a WiReSens packet that reads "wr", FF FE FE FF on a pressure mat."""

import binascii
import itertools
import json
import struct
import zlib
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple


class Frame(NamedTuple):
    """What the device measured, and what is to be recorded."""

    counts: array  # row-major
    temperature: float = None  # [C]
    supply: float = None  # [V]
    lost_before: int = 0  # frames that the device took and could not send
    sequence: int = None  # counted on where the device's number wraps
    device_time: int = None  # [ns], counted on where the device's clock wraps


class Piece(NamedTuple):
    """Bytes that are sent together, and the numbers of the frames whose readings they carry."""

    data: bytes
    frames: tuple = ()


@dataclass(frozen=True)
class Device:
    name: str
    protocol: str
    rows: int
    cols: int
    bytes_per_second: float
    pieces: Callable  # (device, random, frames) -> Piece after Piece; `frames` may be changed to what is to be recorded
    full_scale: int
    code: str = "H"  # of array: B, H, h or f
    mark: tuple = ()  # readings that imitate the protocol's own mark
    options: dict = field(default_factory=dict)  # of the URI
    shape_is_known: bool = False  # the protocol has one shape, or says it on the wire, or it can be learnt
    checksum: bool = False
    request: bytes = b""  # what the device waits for
    request_per_frame: bool = False
    transports: tuple = ("serial",)
    recognised: bool = True  # protocol=auto is enough
    is_independent: bool = True  # a frame is known from its own bytes alone

    def parameters(self, auto, shape=False):
        given = {} if auto else {"protocol": self.protocol}
        if shape or not self.shape_is_known:
            given.update(rows=self.rows, cols=self.cols)
        return {**given, **self.options}

    def frames(self, random, first=0):
        """Frame after frame: noise at rest, a hand that moves over the array, and now and then the mark."""
        rest = bytes(min(self.full_scale, value * value // 4096) for value in range(256))  # 0 ... 15
        for number in itertools.count(first):
            counts = array(self.code, list(random.randbytes(self.rows * self.cols).translate(rest)))
            height, width = random.randint(1, min(6, self.rows)), random.randint(1, min(6, self.cols))
            top, left = random.randint(0, self.rows - height), random.randint(0, self.cols - width)
            for row in range(top, top + height):
                begin = row * self.cols + left
                counts[begin : begin + width] = array(
                    self.code, [random.randint(0, self.full_scale) for _ in range(width)]
                )
            if self.mark and number % 3 == 0:
                begin = random.randint(0, len(counts) - len(self.mark))
                counts[begin : begin + len(self.mark)] = array(self.code, self.mark)
            yield Frame(counts)

    def stream(self, random, seconds=None, count=None):
        """Frames and their pieces: `count` frames, or as many as the device sends in `seconds`."""
        source = self.frames(random)
        if count is None:
            sample = list(itertools.islice(self.frames(random), 16))
            sent = sum(len(piece.data) for piece in self.pieces(self, random, sample) if piece.frames)
            count = max(8, round(seconds * self.bytes_per_second * len(sample) / sent))
        frames = list(itertools.islice(source, count))
        pieces = list(self.pieces(self, random, frames))
        return without_unsent_frames(frames, pieces)


def without_unsent_frames(frames, pieces):
    """A frame of which nothing was sent is one that the next one tells of."""
    sent = sorted({number for piece in pieces for number in piece.frames})
    if len(sent) < len(frames):
        place = {number: index for index, number in enumerate(sent)}
        gaps = [number - before - 1 for before, number in zip([-1, *sent], sent)]
        frames = [frames[number]._replace(lost_before=gap) for number, gap in zip(sent, gaps)]
        pieces = [Piece(piece.data, tuple(place[number] for number in piece.frames)) for piece in pieces]
    return frames, pieces


def baud(rate):
    """Bytes per second of 8N1: ten bits a byte."""
    return rate / 10


# FlexiTac (PyFlexiTac, flexitac/protocol.py): AA 55, then a byte a taxel, not escaped.
def flexitac(device, random, frames):
    for number, frame in enumerate(frames):
        yield Piece(b"\xaa\x55" + frame.counts.tobytes(), (number,))


# 3D-ViTac (MatrixArray.ino): "%u " per taxel, CRLF per row, an empty line per frame.
def vitac(device, random, frames):
    for number, frame in enumerate(frames):
        text = "".join("".join(f"{value} " for value in row) + "\r\n" for row in rows_of(device, frame))
        yield Piece(text.encode() + b"\r\n", (number,))


# WiReSens (WiSensToolkit.cpp, createBuffer): packets of a fixed number of readings that straddle the frames.
@dataclass(frozen=True)
class WireSens:
    nodes: int
    delimiter: bytes
    first_packet: int = 1
    skipping: float = 0.0  # share of the packets that the device leaves to the prediction
    boot: bytes = b""

    def __call__(self, device, random, frames):
        if self.boot:
            yield Piece(self.boot)
        taxels = device.rows * device.cols
        readings = [value for frame in frames for value in frame.counts]
        held = readings[:taxels]
        packet = self.first_packet
        for begin in range(0, len(readings), self.nodes):
            # the last packet is filled up with the beginning of a frame that is never finished
            values = [readings[index % len(readings)] for index in range(begin, begin + self.nodes)]
            whole = taxels <= begin < len(readings) - taxels  # the first and the last frame are sent
            if whole and random.random() < self.skipping:
                self.hold(frames, taxels, held, begin)
            else:
                of = range(begin // taxels, min((begin + self.nodes - 1) // taxels + 1, len(frames)))
                yield Piece(self.packet(begin % taxels, values, packet), tuple(of))
                for offset, value in enumerate(values):
                    held[(begin + offset) % taxels] = value
            packet += 1

    def hold(self, frames, taxels, held, begin):
        """What was not sent is recorded as it was last."""
        for index in range(begin, min(begin + self.nodes, taxels * len(frames))):
            frames[index // taxels].counts[index % taxels] = held[index % taxels]

    def packet(self, start, values, number):
        return struct.pack(f"<bH{len(values)}HI", 1, start, *values, number & 0xFFFFFFFF) + self.delimiter


class WireSensNodes(WireSens):
    """readNode: start index 20000 says that the readings are pairs of an index and a value. After one scan a program
    asks for some nodes in no order, a few of them twice."""

    def __call__(self, device, random, frames):
        yield from WireSens.__call__(self, device, random, frames[:1])
        held = array("H", frames[0].counts)
        for number, frame in enumerate(frames[1:], 1):
            nodes = random.choices(range(len(held)), k=self.nodes // 2)
            for node in nodes:
                held[node] = frame.counts[node]
            values = [item for node in nodes for item in (node, frame.counts[node])]
            frame.counts[:] = held
            yield Piece(self.packet(20000, values, self.first_packet + len(held) // self.nodes + number - 1), (number,))


# STAG glove (ActionNet TouchStreamer.py): two bytes a reading, 11 added to each, so that none is a line feed.
def stag_bytes(values, shift):
    return bytes(part + 11 for value in values for part in (value >> shift, value & ((1 << shift) - 1)))


def stag_request(device, random, frames):
    shift = device.options["bit_shift"]
    for number, frame in enumerate(frames):
        yield Piece(bytes([number % 200 + 11]) + stag_bytes(frame.counts, shift) + b"\n", (number,))


def stag_stream(device, random, frames):
    shift = device.options["bit_shift"]
    for number, frame in enumerate(frames):
        yield Piece(
            b"".join(
                bytes([number % 200 + 11, index + 11]) + stag_bytes(row, shift) + b"\n"
                for index, row in enumerate(rows_of(device, frame))
            ),
            (number,),
        )


# M1616 (PiezoresistiveArray_SerialMonitor, main.py): AA AB AC, 256 big-endian readings, four bytes of unknown meaning.
def m1616(device, random, frames):
    for number, frame in enumerate(frames):
        yield Piece(b"\xaa\xab\xac" + struct.pack(">256H", *frame.counts) + random.randbytes(4), (number,))


# Wuji glove (wujihandcpp, data/tactile.hpp): length, sequence, milliseconds, CRC-16-CCITT from byte 2 on.
@dataclass(frozen=True)
class Wuji:
    head: bytes  # hand and padding

    def __call__(self, device, random, frames):
        for number, frame in enumerate(frames):
            sequence, time = 65000 + number, 2**32 - 10**4 + 8 * number
            readings = frame.counts.tobytes()
            size = 4 + len(self.head) + len(readings) + 8
            body = (
                struct.pack("<H", size)
                + self.head
                + readings
                + struct.pack("<HI", sequence & 0xFFFF, time & 0xFFFFFFFF)
            )
            frames[number] = frame._replace(sequence=sequence, device_time=time * 10**6)
            yield Piece(b"\xaa\x55" + body + struct.pack("<H", binascii.crc_hqx(body, 0xFFFF)), (number,))


@dataclass(frozen=True)
class Fractions(Device):
    """Readings between 0 and 1, some of them invalid."""

    def frames(self, random, first=0):
        for number, frame in enumerate(Device.frames(self, random, first)):
            counts = array("f", [value / self.full_scale for value in frame.counts])
            counts[random.randrange(len(counts))] = float("nan")
            if number % 3 == 0:
                counts[random.randrange(len(counts))] = struct.unpack("<f", b"\xaa\x55\x10\x0c")[0]
            yield Frame(counts)


@dataclass(frozen=True)
class Stuck(Device):
    """Two neighbours that read the mark, from the 10th frame on in each at the same place."""

    def frames(self, random, first=0):
        for number, frame in enumerate(Device.frames(self, random, first)):
            if number >= 10:
                frame.counts[100 : 100 + len(self.mark)] = array(self.code, self.mark)
            yield frame


# Pressure mat (willowec/pressure-mat): one request, then a byte a taxel and FF FE FE FF for ever.
def pressure_mat(device, random, frames):
    for number, frame in enumerate(frames):
        yield Piece(frame.counts.tobytes() + b"\xff\xfe\xfe\xff", (number,))


# Bielefeld TactileGlove (SerialInput.cpp): five bytes a taxel.
def tactileglove(device, random, frames):
    for number, frame in enumerate(frames):
        yield Piece(
            b"".join(
                bytes([0x3C + index, 1, (index % 16) << 4 | value >> 8, value & 0xFF, 0])
                for index, value in enumerate(frame.counts)
            ),
            (number,),
        )


# The Arduino family: text, one dialect a sketch.
@dataclass(frozen=True)
class Csv:
    separator: str
    frame_end: str = ""  # after the rows; empty: all readings on one line
    line_end: str = "\r\n"
    boot: bytes = b""
    trailing: bool = False
    width: int = 0
    first_time: int = None  # of millis() or micros(), printed before each line
    time_step: int = 20

    def __call__(self, device, random, frames):
        if self.boot:
            yield Piece(self.boot)
        time = self.first_time
        for number, frame in enumerate(frames):
            rows = rows_of(device, frame) if self.frame_end else [frame.counts]
            if time is not None:
                time += self.time_step + random.randint(-1, 1)
                rows = [[time, *row] for row in rows]
            text = "".join(self.line(row) for row in rows)
            yield Piece((text + self.frame_end).encode(), (number,))

    def line(self, values):
        text = self.separator.join(f"{value:{self.width}d}" for value in values)
        return text + (self.separator if self.trailing else "") + self.line_end


# JSON lines, as ArduinoJson and MicroPython print them.
def json_rows(device, random, frames):
    for number, frame in enumerate(frames):
        line = {"t": 20 * number, "id": "mat [1]", "data": [list(row) for row in rows_of(device, frame)]}
        yield Piece(json.dumps(line).encode() + b"\n", (number,))


def json_list(device, random, frames):
    for number, frame in enumerate(frames):
        yield Piece(json.dumps(list(frame.counts), separators=(",", ":")).encode() + b"\r\n", (number,))


# dermis's own protocol (docs/wire-protocol.md).
def cobs(packet):
    """Consistent overhead byte stuffing (Cheshire and Baker 1999)."""
    stuffed = bytearray()
    for block in packet.split(b"\x00"):
        while len(block) >= 254:
            stuffed += b"\xff" + block[:254]
            block = block[254:]
        stuffed += bytes([len(block) + 1]) + block
    return bytes(stuffed)


@dataclass(frozen=True)
class DermisWire:
    first_sequence: int = 0
    first_time_us: int = 0
    period_us: int = 4000
    skipping: float = 0.0  # share of the frames that the device takes and cannot send

    def __call__(self, device, random, frames):
        sequence = self.first_sequence
        for number, frame in enumerate(frames):
            lost = 0
            while number > 0 and random.random() < self.skipping:
                lost += 1
            sequence += lost
            temperature, supply = random.randint(-1000, 8000), random.randint(2900, 5100)
            time = self.first_time_us + (sequence - self.first_sequence) * self.period_us
            packet = (
                struct.pack(
                    "<BBIIhHHH",
                    1,
                    7,
                    sequence & 0xFFFFFFFF,
                    time & 0xFFFFFFFF,
                    temperature,
                    supply,
                    device.rows,
                    device.cols,
                )
                + frame.counts.tobytes()
            )
            packet += struct.pack("<I", zlib.crc32(packet))
            frames[number] = Frame(frame.counts, temperature / 100, supply / 1000, lost, sequence, time * 1000)
            yield Piece(cobs(packet) + b"\x00", (number,))
            sequence += 1


@dataclass(frozen=True)
class Dense(Device):
    """Readings without a byte that is 0: the longest blocks of COBS."""

    def frames(self, random, first=0):
        while True:
            yield Frame(array("H", random.randbytes(2 * self.rows * self.cols).replace(b"\x00", b"\x01")))


def rows_of(device, frame):
    return [frame.counts[row * device.cols : (row + 1) * device.cols] for row in range(device.rows)]


USB_FULL_SPEED = 1_000_000  # bytes per second, what CDC reaches
BOOT = b"ets Jun  8 2016 00:22:57\r\nrst:0x1 (POWERON_RESET),boot:0x13\r\nSensor array ready\r\nCalibrating...\r\n"
WIRESENS_BOOT = b"Initializing Toolkit\r\nNumber of pins\r\n5\r\n"

DEVICES = [
    Device("flexitac 12x32", "flexitac", 12, 32, baud(2_000_000), flexitac, 255, "B", mark=(0xAA, 0x55)),
    Device(
        "flexitac 16x32, learnt",
        "flexitac",
        16,
        32,
        baud(2_000_000),
        flexitac,
        255,
        "B",
        mark=(0xAA, 0x55),
        shape_is_known=True,
    ),
    Stuck("flexitac 16x16, stuck", "flexitac", 16, 16, baud(2_000_000), flexitac, 255, "B", mark=(0xAA, 0x55)),
    Device("3dvitac 16x16", "3dvitac", 16, 16, baud(2_000_000), vitac, 1023, shape_is_known=True),
    Device("3dvitac 16x32", "3dvitac", 16, 32, baud(2_000_000), vitac, 1023),
    Device("wiresens 32x32", "wiresens", 32, 32, baud(250_000), WireSens(120, b"wr", first_packet=0x7277 - 40), 4095),
    Device(
        "wiresens 32x32, boot",
        "wiresens",
        32,
        32,
        baud(921_600),
        WireSens(120, b"wr", first_packet=1, boot=WIRESENS_BOOT),
        4095,
    ),
    Device(
        "wiresens 16x16, 16 bits",
        "wiresens",
        16,
        16,
        baud(921_600),
        WireSens(64, b"wr"),
        32767,
        mark=(0x7277,),
        options={"nodes_per_packet": 64},
    ),
    Device(
        "wiresens 16x16, skipping",
        "wiresens",
        16,
        16,
        baud(250_000),
        WireSens(100, b"wr", skipping=0.2),
        4095,
        options={"nodes_per_packet": 100},
        is_independent=False,
    ),
    Device(
        "wiresens 16x16, tcp",
        "wiresens",
        16,
        16,
        baud(921_600),
        WireSens(120, b"", first_packet=0xFFFFFF00),
        4095,
        options={"delimited": "false"},
        transports=("tcp-listen", "udp"),
    ),
    Device(
        "wiresens 16x16, nodes",
        "wiresens",
        16,
        16,
        baud(250_000),
        WireSensNodes(64, b"wr"),
        4095,
        options={"nodes_per_packet": 64},
        recognised=False,
        is_independent=False,
    ),
    Device(
        "stag, request",
        "stag",
        32,
        32,
        baud(1_000_000),
        stag_request,
        4095,
        options={"bit_shift": 5},
        shape_is_known=True,
        request=b"a",
        request_per_frame=True,
    ),
    Device(
        "stag, request, 6 bits",
        "stag",
        32,
        32,
        baud(1_000_000),
        stag_request,
        4095,
        options={"bit_shift": 6},
        shape_is_known=True,
        request=b"a",
        request_per_frame=True,
    ),
    Device(
        "stag, stream",
        "stag",
        32,
        32,
        baud(1_000_000),
        stag_stream,
        4095,
        options={"bit_shift": 5},
        shape_is_known=True,
    ),
    Device("m1616", "m1616", 16, 16, baud(115_200), m1616, 4095, mark=(0xAAAB, 0xACAA, 0xABAC), shape_is_known=True),
    Fractions(
        "wuji 3088", "wuji", 24, 32, USB_FULL_SPEED, Wuji(b"\x01\x00\x00\x00"), 4095, checksum=True, shape_is_known=True
    ),
    Device(
        "wuji 1550",
        "wuji",
        24,
        32,
        USB_FULL_SPEED,
        Wuji(b"\x01\x00"),
        4095,
        "h",
        mark=(0x55AA, 0x060E, -1),
        checksum=True,
        shape_is_known=True,
    ),
    Device(
        "pressure-mat",
        "pressure-mat",
        56,
        28,
        USB_FULL_SPEED / 4,
        pressure_mat,
        207,
        "B",
        mark=(0xFF, 0xFE, 0xFE, 0xFF),
        shape_is_known=True,
        request=b"start_reading\n",
    ),
    Device("tactileglove", "tactileglove", 1, 64, baud(115_200), tactileglove, 4095, shape_is_known=True),
    Device("csv, rows", "csv", 8, 10, baud(115_200), Csv(",", "-----\r\n", boot=BOOT), 1023, shape_is_known=True),
    Device("csv, tabs", "csv", 4, 4, baud(9_600), Csv("\t", "\r\n", trailing=True), 1023, shape_is_known=True),
    Device(
        "csv, spaces",
        "csv",
        16,
        16,
        baud(921_600),
        Csv(" ", "=====\n", line_end="\n", width=4),
        4095,
        shape_is_known=True,
    ),
    Device("csv, line", "csv", 5, 8, baud(115_200), Csv(" ", boot=BOOT), 1023),
    Device("csv, line, learnt", "csv", 10, 10, baud(230_400), Csv(" ", boot=BOOT), 1023, shape_is_known=True),
    Device("csv, semicolons", "csv", 4, 6, baud(921_600), Csv(";", trailing=True, line_end="\n"), 4095),
    Device("csv, CFG", "csv", 12, 16, baud(921_600), Csv(",", boot=b"CFG,12,16\r\n"), 4095, shape_is_known=True),
    Device("csv, millis and a line", "csv", 12, 10, baud(115_200), Csv(",", boot=BOOT, first_time=1234), 1023),
    Device(
        "csv, micros and a square line",
        "csv",
        10,
        10,
        baud(230_400),
        Csv(",", first_time=3_000_000_000, time_step=20_000),
        1023,
        shape_is_known=True,
    ),
    Device(
        "csv, millis and rows", "csv", 12, 10, baud(115_200), Csv(",", "\r\n", first_time=0), 1023, shape_is_known=True
    ),
    Device("json, rows", "json", 12, 10, baud(115_200), json_rows, 1023, shape_is_known=True),
    Device("json, a list", "json", 5, 8, baud(115_200), json_list, 4095),
    Device(
        "dermis 12x32",
        "dermis",
        12,
        32,
        baud(2_000_000),
        DermisWire(2**32 - 300, 2**32 - 10**6),
        65535,
        checksum=True,
        shape_is_known=True,
        transports=("serial", "tcp", "udp"),
    ),
    Device(
        "dermis 16x16, skipping",
        "dermis",
        16,
        16,
        baud(921_600),
        DermisWire(skipping=0.1),
        65535,
        checksum=True,
        shape_is_known=True,
    ),
    Dense(
        "dermis 17x19, dense", "dermis", 17, 19, baud(921_600), DermisWire(), 65535, checksum=True, shape_is_known=True
    ),
    Device(
        "dermis 64x160",
        "dermis",
        64,
        160,
        2_200_000,
        DermisWire(period_us=10_000),
        4095,
        checksum=True,
        shape_is_known=True,
        transports=("tcp",),
    ),
]
