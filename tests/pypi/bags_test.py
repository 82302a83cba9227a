# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A recording of a served array is a bag to the packages rosbags and mcap-ros2-support of PyPI, which decode every
topic alike; and dermis reads a bag that rosbags writes. Usage: bags_test.py DERMIS WRITTEN_MESSAGES"""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from mcap_ros2.reader import read_ros2_messages
from rosbags import rosbag1
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

sys.path.append(str(Path(__file__).parents[1] / "command_line"))
import support
from support import SmallArray, dermis

WRITTEN = sys.argv.pop(2)
THREATS = '[[threat]]\nname = "light"\nquantity = "contact_force"\nlimit_n = 0.2\n'
TACTILE_STATE = "tactile_msgs/msg/TactileState"
ENOUGH_BYTES = 300_000  # some 200 frames
LONGEST_S = 100
TOPICS = {
    "/small/acquisition": "dermis_msgs/msg/Acquisition",
    "/small/raw": "sensor_msgs/msg/Image",
    "/small/recognition": "vision_msgs/msg/Classification",
    "/threat": "dermis_msgs/msg/Threat",
}


def plain(value):
    """A value of either package as numbers, texts, lists, and the fields of a message by their names."""
    if isinstance(value, numpy.ndarray):
        return value.tolist()
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    names = getattr(value, "__slots__", None) or getattr(value, "__dataclass_fields__", None)
    if names is None:
        return value
    return {name: plain(getattr(value, name)) for name in names if not name.startswith("__") and not name.isupper()}


def size_of(path):
    return path.stat().st_size if path.exists() else 0


class Bags(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        threats = cls.root / "threats.toml"
        threats.write_text(THREATS)
        labels = cls.root / "labels.csv"
        labels.write_text(
            "id,first,last,class\n" + "".join(f"{k},{5 * k},{5 * k},{'hand' if k % 2 else 'foot'}\n" for k in range(40))
        )
        classes = cls.root / "classes"
        learned = dermis(
            "recognise", "learn", "--in", cls.contacts / "frames.csv", "--labels", labels, "--out", classes
        )
        if learned.returncode:
            raise AssertionError(learned.stderr)
        cls.recording = cls.root / "rec.mcap"
        source = ("--from", "sim:multitouch?rows=4&cols=5&rate=100", "--model", cls.model)
        options = ("--threats", threats, "--classes", classes, "--port", "0", "--record", cls.recording)
        server = subprocess.Popen(list(map(str, (support.BINARY, "serve", *source, *options))), stderr=subprocess.PIPE)
        until = time.monotonic() + LONGEST_S
        while server.poll() is None and time.monotonic() < until and size_of(cls.recording) < ENOUGH_BYTES:
            time.sleep(0.1)
        server.send_signal(signal.SIGINT)
        _, error = server.communicate(timeout=60)
        if server.returncode:
            raise AssertionError(error)

    def read(self, path):
        """(topic, time, message) by rosbags"""
        with AnyReader([path]) as reader:
            self.types = {connection.topic: connection.msgtype for connection in reader.connections}
            return [
                (connection.topic, stamp, plain(reader.deserialize(content, connection.msgtype)))
                for connection, stamp, content in reader.messages()
            ]

    def test_two_packages_decode_every_topic_alike(self):
        by_rosbags = self.read(self.recording)
        by_mcap = [
            (message.channel.topic, message.log_time_ns, plain(message.ros_msg))
            for message in read_ros2_messages(str(self.recording))
        ]
        self.assertLessEqual(TOPICS.items(), self.types.items())
        self.assertEqual({topic for topic, _, _ in by_rosbags}, set(self.types))
        self.assertEqual(len(by_rosbags), len(by_mcap))
        for topic in self.types:
            ours = [repr(one) for one in by_rosbags if one[0] == topic]  # repr(): NaN equals NaN
            others = [repr(one) for one in by_mcap if one[0] == topic]
            self.assertEqual(ours, others, topic)

    def test_messages_of_every_type_have_the_fields_that_were_written(self):
        lines = subprocess.run([WRITTEN], check=True, capture_output=True, text=True).stdout.splitlines()
        for message in map(json.loads, lines):
            name, definition, content = message["type"], message["definition"], bytes.fromhex(message["cdr"])
            types = get_typestore(Stores.EMPTY)
            types.register(get_types_from_msg(definition, name))
            self.assertEqual(plain(types.deserialize_cdr(content, name)), message["fields"], name)
            schema = Schema(id=1, name=name, encoding="ros2msg", data=definition.encode())
            decode = DecoderFactory().decoder_for("cdr", schema)
            self.assertEqual(plain(decode(content)), message["fields"], name)

    def test_a_bag_that_rosbags_writes_has_the_frames_of_the_recording(self):
        folder = self.work / "bag"
        with AnyReader([self.recording]) as reader, Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
            connections = {
                connection.id: bag.add_connection(connection.topic, connection.msgtype, typestore=reader.typestore)
                for connection in reader.connections
            }
            for connection, stamp, content in reader.messages():
                bag.write(connections[connection.id], stamp, content)
        (written,) = folder.glob("*.mcap")
        tables = []
        for path in (self.recording, written):
            table = self.work / f"{len(tables)}.csv"
            converted = dermis("convert", path, table)
            self.assertEqual(converted.returncode, 0, converted.stderr)
            tables.append(table.read_text())
        self.assertEqual(tables[0], tables[1])
        self.assertGreater(len(tables[0].splitlines()), 50)

    def expect_frames_of_sensors(self, recording):
        table = self.work / "frames.csv"
        converted = dermis("convert", recording, table)
        self.assertEqual(converted.returncode, 0, converted.stderr)
        frames = numpy.genfromtxt(table, delimiter=",", skip_header=1)
        numpy.testing.assert_array_equal(frames[:, -6:], [[k, k + 0.5, 2, 3, 4, 5] for k in range(5)])

    def write_touches(self, bag, store):
        """A hand with two tips, beside a camera."""
        types = store.types
        stamp = types["builtin_interfaces/msg/Time"](sec=7, nanosec=9)
        header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="", **({"seq": 0} if bag is self.ros_1 else {}))
        pixels = numpy.zeros(12, numpy.uint8)
        image = types["sensor_msgs/msg/Image"](header, 2, 2, "rgb8", 0, 6, pixels)
        tip = types["sensor_msgs/msg/ChannelFloat32"]
        serialize = store.serialize_ros1 if bag is self.ros_1 else store.serialize_cdr
        topics = {
            kind: bag.add_connection(topic, kind, typestore=store)
            for topic, kind in (("/camera", image.__msgtype__), ("/hand/touch", TACTILE_STATE))
        }
        for k in range(5):
            tips = [tip("first", numpy.float32([k, k + 0.5, 2])), tip("second", numpy.float32([3, 4, 5]))]
            state = types[TACTILE_STATE](header, tips)
            for message in (image, state):
                content = serialize(message, message.__msgtype__)
                bag.write(topics[message.__msgtype__], 10**9 + k * 10**7, content)

    def store_of(self, distribution):
        store = get_typestore(distribution)
        store.register(
            get_types_from_msg("std_msgs/Header header\nsensor_msgs/ChannelFloat32[] sensors", TACTILE_STATE)
        )
        return store

    ros_1 = None

    def test_touches_of_other_robots_are_frames(self):
        folder = self.work / "bag"
        with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
            self.write_touches(bag, self.store_of(Stores.ROS2_JAZZY))
        (written,) = folder.glob("*.mcap")
        self.expect_frames_of_sensors(written)

    def test_bags_of_ros_1_are_read_once_they_are_mcap(self):
        old, new = self.work / "old.bag", self.work / "new"
        with rosbag1.Writer(old) as self.ros_1:
            self.write_touches(self.ros_1, self.store_of(Stores.ROS1_NOETIC))
        convert = [Path(sys.executable).parent / "rosbags-convert", "--src", old, "--dst", new, "--dst-storage", "mcap"]
        subprocess.run(convert, check=True, capture_output=True)
        (written,) = new.glob("*.mcap")
        self.expect_frames_of_sensors(written)


if __name__ == "__main__":
    support.main()
