# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Reads a recording: MCAP (mcap.dev/spec) with CDR messages described by their own ros2msg schemas. Nothing here is
shared with dermis."""

import ctypes
import struct
import zlib
from array import array
from typing import NamedTuple


class Recorded(NamedTuple):
    counts: array
    acquisition: dict  # of the message on the topic .../acquisition
    temperature: float  # [C], or None


def read_frames(path):
    """The frames of a recording in the order of the file; a file that is cut ends with its last whole record."""
    messages = {"raw": [], "acquisition": [], "temperature": []}
    for topic, schema, data in read_messages(path.read_bytes()):
        messages.setdefault(topic.rsplit("/", 1)[1], []).append(decode(schema, data))
    images, acquisitions = messages["raw"], messages["acquisition"]
    assert len(images) == len(acquisitions), f"{len(images)} images, {len(acquisitions)} acquisitions"
    temperatures = {
        nanoseconds(message["header"]["stamp"]): message["temperature"] for message in messages["temperature"]
    }
    return [
        Recorded(counts_of(image), acquisition, temperatures.get(nanoseconds(image["header"]["stamp"])))
        for image, acquisition in zip(images, acquisitions)
    ]


def nanoseconds(stamp):
    return stamp["sec"] * 10**9 + stamp["nanosec"]


def counts_of(image):
    counts = array({"mono16": "H", "16UC1": "H", "32FC1": "f"}[image["encoding"]], image["data"])
    assert len(counts) == image["height"] * image["width"] and not image["is_bigendian"]
    return counts


def read_messages(data):
    assert data[:8] == b"\x89MCAP0\r\n", data[:8]
    schemas, channels = {}, {}
    yield from messages_in(records_in(data, 8), schemas, channels)


def messages_in(records, schemas, channels):
    for opcode, body in records:
        if opcode == 3:
            number = struct.unpack_from("<H", body)[0]
            name, at = text_at(body, 2)
            _, at = text_at(body, at)
            schemas[number] = (name, text_at(body, at)[0])
        elif opcode == 4:
            number, schema = struct.unpack_from("<HH", body)
            channels[number] = (text_at(body, 4)[0], schema)
        elif opcode == 5:
            topic, schema = channels[struct.unpack_from("<H", body)[0]]
            yield topic, schemas[schema], body[22:]
        elif opcode == 6:
            yield from messages_in(records_in(unpacked_chunk(body), 0), schemas, channels)


def records_in(data, at):
    while at + 9 <= len(data):
        opcode, size = struct.unpack_from("<BQ", data, at)
        if data[at : at + 8] == b"\x89MCAP0\r\n" or at + 9 + size > len(data):
            return
        yield opcode, data[at + 9 : at + 9 + size]
        at += 9 + size


def text_at(data, at):
    size = struct.unpack_from("<I", data, at)[0]
    return data[at + 4 : at + 4 + size].decode(), at + 4 + size


def unpacked_chunk(body):
    _, _, size, crc = struct.unpack_from("<QQQI", body)
    compression, at = text_at(body, 28)
    packed = body[at + 8 :]
    data = {"": lambda: packed, "lz4": lambda: unpack_lz4(packed, size), "zstd": lambda: unpack_zstd(packed, size)}[
        compression
    ]()
    assert len(data) == size and crc in (0, zlib.crc32(data)), "chunk"
    return data


def unpack_lz4(packed, size):
    lz4, context = ctypes.CDLL("liblz4.so.1"), ctypes.c_void_p()
    lz4.LZ4F_decompress.restype = ctypes.c_size_t
    assert lz4.LZ4F_createDecompressionContext(ctypes.byref(context), 100) == 0
    target, begin, written = ctypes.create_string_buffer(size + 1), 0, 0
    while True:
        room, taken = ctypes.c_size_t(size + 1 - written), ctypes.c_size_t(len(packed) - begin)
        hint = lz4.LZ4F_decompress(
            context, ctypes.byref(target, written), ctypes.byref(room), packed[begin:], ctypes.byref(taken), None
        )
        begin, written = begin + taken.value, written + room.value
        if hint == 0 or taken.value == 0:
            break
    lz4.LZ4F_freeDecompressionContext(context)
    return target.raw[:written]


def unpack_zstd(packed, size):
    zstd = ctypes.CDLL("libzstd.so.1")
    zstd.ZSTD_decompress.restype = ctypes.c_size_t
    target = ctypes.create_string_buffer(size)
    assert zstd.ZSTD_decompress(target, ctypes.c_size_t(size), packed, ctypes.c_size_t(len(packed))) == size
    return target.raw


PRIMITIVES = {
    "bool": "?",
    "byte": "B",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}


def decode(schema, data):
    """A CDR message (little-endian) as a dictionary by the names of its ros2msg schema."""
    name, text = schema
    definitions = {name.split("/")[-1]: text.split("=" * 80)[0]}
    for part in text.split("=" * 80)[1:]:
        head, _, definition = part.strip().partition("\n")
        definitions[head.removeprefix("MSG:").strip().split("/")[-1]] = definition
    assert data[:4] == b"\x00\x01\x00\x00", data[:4]
    return Cdr(data[4:], definitions).message(name.split("/")[-1])


class Cdr:
    def __init__(self, data, definitions):
        self.data, self.definitions, self.at = data, definitions, 0

    def message(self, name):
        fields = {}
        for line in self.definitions[name].splitlines():
            words = line.split("#")[0].split()
            if len(words) == 2 and "=" not in line.split("#")[0]:
                fields[words[1]] = self.value(words[0])
        return fields

    def value(self, kind):
        if kind.endswith("[]"):
            size = self.value("uint32")
            if kind == "uint8[]":
                self.at += size
                return self.data[self.at - size : self.at]
            return [self.value(kind[:-2]) for _ in range(size)]
        if kind == "string":
            size = self.value("uint32")
            self.at += size
            return self.data[self.at - size : self.at - 1].decode()
        if kind not in PRIMITIVES:
            kind = {"time": "builtin_interfaces/Time"}.get(kind, kind)
            return self.message(kind.split("/")[-1])
        code = PRIMITIVES[kind]
        size = struct.calcsize(code)
        self.at += -self.at % size
        self.at += size
        return struct.unpack_from("<" + code, self.data, self.at - size)[0]
