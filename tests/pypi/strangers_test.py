# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Recordings that packages of PyPI write as others do: bags of rosbags and mcap with arrays, images and JSON, and
arrays of numpy and h5py. Usage: strangers_test.py DERMIS"""

import json
import pickle
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy
from mcap.writer import CompressionType, Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

sys.path.append(str(Path(__file__).parents[1] / "command_line"))
import support
from support import dermis, error_lines

STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = STORE.types
BEGIN_NS, STEP_NS = 1_700_000_000_000_000_000, 25_000_000
FRAMES, ROWS, COLS = 40, 5, 4
NUMBERS = {
    "Float32": "float32",
    "Float64": "float64",
    "UInt8": "uint8",
    "Int8": "int8",
    "UInt16": "uint16",
    "Int16": "int16",
    "UInt32": "uint32",
    "Int32": "int32",
}
PIXELS = {
    "mono8": "uint8",
    "8SC1": "int8",
    "mono16": "uint16",
    "16SC1": "int16",
    "32SC1": "int32",
    "32FC1": "float32",
    "64FC1": "float64",
}
COUNTS = numpy.arange(FRAMES)[:, None, None] + numpy.arange(ROWS * COLS).reshape(ROWS, COLS)


def multi_array(kind, values, dimensions=None, offset=0):
    sizes = values.shape if dimensions is None else dimensions
    strides = [int(numpy.prod(sizes[k:])) for k in range(len(sizes))]
    dim = [TYPES["std_msgs/msg/MultiArrayDimension"]("", size, stride) for size, stride in zip(sizes, strides)]
    layout = TYPES["std_msgs/msg/MultiArrayLayout"](dim, offset)
    data = numpy.concatenate([numpy.zeros(offset, values.dtype), values.reshape(-1)])
    return TYPES[f"std_msgs/msg/{kind}MultiArray"](layout, data)


def image(encoding, values, is_big_endian=False):
    stamp = TYPES["builtin_interfaces/msg/Time"](sec=7, nanosec=9)
    header = TYPES["std_msgs/msg/Header"](stamp=stamp, frame_id="touch")
    values = values.astype(values.dtype.newbyteorder(">" if is_big_endian else "<"))
    data = numpy.frombuffer(values.tobytes(), numpy.uint8)
    step = values.shape[1] * values.itemsize
    return TYPES["sensor_msgs/msg/Image"](header, *values.shape, encoding, int(is_big_endian), step, data)


def text(value):
    return TYPES["std_msgs/msg/String"](value if isinstance(value, str) else json.dumps(value))


class Strangers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def write_bag(self, topics, name="bag", packing=None):
        """topics: {"/touch": messages}, one a step"""
        folder = self.work / name
        writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
        if packing:
            writer.set_compression(*packing)
        with writer as bag:
            for topic, messages in topics.items():
                kind = messages[0].__msgtype__
                connection = bag.add_connection(topic, kind, typestore=STORE)
                for k, message in enumerate(messages):
                    bag.write(connection, BEGIN_NS + k * STEP_NS, STORE.serialize_cdr(message, kind))
        return folder

    def convert(self, source, *options):
        table = self.work / "converted.csv"
        table.unlink(missing_ok=True)
        return dermis("convert", source, table, *options), table

    def expect(self, source, counts, *options):
        done, table = self.convert(source, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        counts = numpy.asarray(counts).reshape(len(counts), -1)
        frames = numpy.genfromtxt(table, delimiter=",", skip_header=1)
        numpy.testing.assert_array_equal(frames[:, -counts.shape[1] :], counts)
        return frames[:, 0], done.stderr

    def expect_refusal(self, source, *words):
        done, _ = self.convert(source)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(error_lines(done)), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_arrays_of_every_number_are_frames_at_the_times_of_the_log(self):
        for kind, dtype in NUMBERS.items():
            with self.subTest(kind):
                bag = self.write_bag({"/touch": [multi_array(kind, frame.astype(dtype)) for frame in COUNTS]}, kind)
                times, _ = self.expect(bag, COUNTS)
                numpy.testing.assert_allclose(times, BEGIN_NS / 1e9 + numpy.arange(FRAMES) * STEP_NS / 1e9, atol=1e-6)

    def test_layouts_may_have_dimensions_of_one_an_offset_or_nothing(self):
        frames = [frame.astype("uint16") for frame in COUNTS]
        one = self.write_bag({"/t": [multi_array("UInt16", frame, (1, ROWS, COLS), 3) for frame in frames]}, "one")
        self.expect(one, COUNTS)
        none = self.write_bag({"/t": [multi_array("UInt16", frame, ()) for frame in frames]}, "none")
        self.expect(none, COUNTS)
        self.expect(none, COUNTS, "--rows", ROWS, "--cols", COLS)
        info = dermis("info", none, "--rows", ROWS, "--cols", COLS)
        self.assertIn("5x4", info.stdout + info.stderr)
        recorded = dermis("record", "--from", f"file:{none}?rows={ROWS}&cols={COLS}", "--out", self.work / "a.mcap")
        self.assertEqual(recorded.returncode, 0, recorded.stderr)
        self.assertIn("5x4", dermis("info", self.work / "a.mcap").stdout)
        column = self.write_bag({"/t": [multi_array("UInt16", frame.reshape(-1, 1)) for frame in frames]}, "column")
        self.assertIn("20x1", dermis("info", column).stdout)
        large = numpy.arange(3 * 48 * 48).reshape(3, 48, 48)
        flat = self.write_bag({"/t": [multi_array("Float32", one.astype("float32"), ()) for one in large]}, "flat")
        self.expect(flat, large, "--rows", 48, "--cols", 48)
        self.expect_refusal(flat, "2304 numbers", "how many rows and cols")
        done, _ = self.convert(none, "--rows", 3, "--cols", 3)
        self.assertIn("has 1x20 taxels, the array is 3x3", done.stderr)

    def test_images_of_one_channel_are_frames(self):
        for encoding, dtype in PIXELS.items():
            for is_big_endian in (False, True):
                with self.subTest(encoding, is_big_endian=is_big_endian):
                    images = [image(encoding, frame.astype(dtype), is_big_endian) for frame in COUNTS]
                    self.expect(self.write_bag({"/raw": images}, f"{encoding}{is_big_endian}"), COUNTS)

    def test_texts_of_json_hold_several_arrays(self):
        fingers = [
            {"stamp": {"secs": k, "nsecs": 5}, "thumb": frame.tolist(), "palm": (frame[:2] + 7).tolist()}
            for k, frame in enumerate(COUNTS)
        ]
        bag = self.write_bag({"/touch": [text(one) for one in fingers], "/robot": [text("<robot/>")]})
        self.expect_refusal(bag, "/touch.thumb", "/touch.palm")
        self.expect(f"{bag}#/touch.thumb", COUNTS)
        self.expect(f"{bag}#/touch.palm", COUNTS[:, :2] + 7)
        flat = self.write_bag({"/touch": [text(frame.reshape(-1).tolist()) for frame in COUNTS]}, "flat")
        self.expect(flat, COUNTS)
        info = dermis("info", bag)
        self.assertIn("/touch.thumb", info.stdout)

    def test_topics_are_named_where_there_are_several(self):
        left = [multi_array("Float32", frame.astype("float32")) for frame in COUNTS]
        right = [image("mono16", (frame + 1).astype("uint16")) for frame in COUNTS]
        camera = [image("rgb8", numpy.zeros((2, 6), "uint8")) for _ in COUNTS]
        bag = self.write_bag({"/camera": camera, "/left": left, "/right": right})
        self.expect_refusal(bag, "/left", "/right")
        self.expect(f"{bag}#/left", COUNTS)
        self.expect(f"{bag}#/right", COUNTS + 1)
        self.expect_refusal(f"{bag}#/middle", "has no array", "/left")
        deep = [multi_array("Float32", numpy.zeros((2, 5, 4), "float32")) for _ in COUNTS]
        self.expect_refusal(self.write_bag({"/deep": deep}, "deep"), "'/deep'", "more than two dimensions")
        alone = self.write_bag({"/camera": camera, "/left": left}, "alone")
        self.expect(alone, COUNTS)
        self.expect(f"{alone}#/left", COUNTS)

    def test_a_node_may_begin_with_nothing(self):
        nothing = multi_array("Float32", numpy.zeros(0, "float32"), ())
        messages = [nothing, nothing, *(multi_array("Float32", frame.astype("float32")) for frame in COUNTS), nothing]
        self.expect(self.write_bag({"/touch": messages}), COUNTS)

    def test_channels_of_json_are_read_as_texts_are(self):
        path = self.work / "json.mcap"
        with path.open("wb") as file:
            writer = McapWriter(file)
            writer.start()
            channel = writer.register_channel("/touch", "json", writer.register_schema("touch", "jsonschema", b"{}"))
            for k, frame in enumerate(COUNTS):
                data = json.dumps({"data": frame.tolist(), "battery": 3.9}).encode()
                writer.add_message(channel, BEGIN_NS + k * STEP_NS, data, BEGIN_NS + k * STEP_NS)
            writer.finish()
        self.expect(path, COUNTS)

    def test_bags_are_compressed_as_their_writers_like(self):
        messages = {"/touch": [multi_array("Int16", frame.astype("int16")) for frame in COUNTS]}
        packed = self.write_bag(messages, "storage", (CompressionMode.STORAGE, CompressionFormat.ZSTD))
        self.expect(packed, COUNTS)
        self.expect_refusal(self.write_bag(messages, "file", (CompressionMode.FILE, CompressionFormat.ZSTD)), "zstd -d")
        kind = "std_msgs/msg/Int16MultiArray"
        for compression in CompressionType:
            for is_whole in (True, False):
                path = self.work / f"{compression.name}{is_whole}.mcap"
                with path.open("wb") as file:
                    writer = McapWriter(file, compression=compression, chunk_size=400, use_summary_offsets=is_whole)
                    writer.start(profile="ros2")
                    definition, _ = STORE.generate_msgdef(kind, ros_version=2)
                    schema = writer.register_schema(kind, "ros2msg", definition.encode())
                    channel = writer.register_channel("/touch", "cdr", schema)
                    for k, message in enumerate(messages["/touch"]):
                        data = bytes(STORE.serialize_cdr(message, kind))
                        writer.add_message(channel, BEGIN_NS + k * STEP_NS, data, BEGIN_NS + k * STEP_NS)
                    writer.finish()
                self.expect(path, COUNTS)

    def test_arrays_of_numpy_whose_frames_may_stand_last_are_asked_for(self):
        time = numpy.arange(120) / 20
        last = (500 + 400 * numpy.sin(time + numpy.arange(14 * 6).reshape(14, 6, 1))).astype("uint16")
        path = self.work / "last.npy"
        numpy.save(path, last)
        first = numpy.moveaxis(last, 2, 0)
        done, _ = self.convert(path, "--rate", 40)
        self.assertIn("[frames, rows, cols]", done.stderr)
        self.assertIn("[rows, cols, frames]", done.stderr)
        self.expect(f"{path}#[rows, cols, frames]", first, "--rate", 40)
        self.expect(f"{path}#[frames, rows, cols]", last, "--rate", 40)
        self.expect(path, first, "--rate", 40, "--rows", 14, "--cols", 6)
        numpy.save(path, numpy.asfortranarray(first))
        self.expect(path, first, "--rate", 40)

    def test_four_axes_and_times_beside_them(self):
        axes = numpy.stack([COUNTS, COUNTS + 1, COUNTS + 2], axis=-1)
        path = self.work / "four.npz"
        times = 1_700_000_000 + numpy.arange(FRAMES) / 40
        numpy.savez(path, tactile=axes, timestamps=times)
        stamps, _ = self.expect(f"{path}#tactile[..., 2]", COUNTS + 2)
        numpy.testing.assert_allclose(stamps, times, atol=1e-6)
        self.expect(f"{path}#tactile[..., -1]", COUNTS + 2, "--rate", 10)
        self.expect_refusal(f"{path}#tactile", "take three of its axes")
        numpy.savez(path, tactile=numpy.moveaxis(axes, -1, 0), timestamps=times)
        self.expect(f"{path}#tactile[1]", COUNTS + 1)
        numpy.savez(path, tactile=COUNTS, t=numpy.arange(FRAMES) * 25)
        self.expect_refusal(path, "time_s or time_ns")

    def test_datasets_of_hdf5_have_the_same_axes_and_times(self):
        path = self.work / "four.h5"
        axes = numpy.stack([COUNTS, COUNTS + 1, COUNTS + 2], axis=-1)
        smooth = (500 + 400 * numpy.sin(numpy.arange(120) / 20 + numpy.arange(84).reshape(14, 6, 1))).astype("int32")
        for name in ("timestamps", "timestamp", "t"):
            with h5py.File(path, "w") as file:
                group = file.create_group("observations")
                group["tactile"] = axes.astype("int64")
                group[name] = numpy.arange(FRAMES) / 40
                file["last"] = smooth
            times, _ = self.expect(f"{path}#/observations/tactile[..., 0]", COUNTS)
            numpy.testing.assert_allclose(times, numpy.arange(FRAMES) / 40)
        self.expect(f"{path}#/last[rows, cols, frames]", numpy.moveaxis(smooth, 2, 0), "--rate", 10)
        done, _ = self.convert(f"{path}#/last", "--rate", 10)
        self.assertIn("which can be read in two ways", done.stderr)
        self.expect_refusal(f"{path}#/observations/tactile", "take three of its axes")

    def test_what_is_refused_says_why(self):
        path = self.work / "frames.pkl"
        path.write_bytes(pickle.dumps(COUNTS))
        self.expect_refusal(path, "pickle", "any program")
        named = self.work / "frames.npy"
        named.write_bytes(pickle.dumps(COUNTS))
        done, _ = self.convert(named, "--rate", 10)
        self.assertIn("pickle", done.stderr)
        numpy.save(named, numpy.array([COUNTS, None], dtype=object), allow_pickle=True)
        done, _ = self.convert(named, "--rate", 10)
        self.assertIn("pickle", done.stderr)
        for name in ("a.parquet", "a.zarr"):
            (self.work / name).write_bytes(b"")
            self.expect_refusal(self.work / name, "dermis.Recording.read()")


if __name__ == "__main__":
    support.main()
