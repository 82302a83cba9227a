# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What a subscriber of another vendor gets of a suit is what 'dermis run' makes of its recording, field by field."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[2] / "command_line"))
import support
from loopback import ENVIRONMENT, subscription
from support import SmallArray, dermis

READER = sys.argv.pop(2)
DOMAIN = 100 + os.getpid() % 100
SECONDS = 5
ROWS, COLS = 4, 5
HALF = 0.5**0.5
SUIT = """[suit]
name = "pair"

[[array]]
name = "left"
model = "{model}"
from = "sim:contacts?rows=4&cols=5&rate=100&seed=1"
base_from_array = {{translation_mm = [100, 200, 300], rotation_deg = [0, 90, 0]}}

[[array]]
name = "right"
model = "{model}"
from = "sim:contacts?rows=4&cols=5&rate=100&seed=2"
"""
TOPICS = {
    "/contacts": "dermis_msgs/Contacts",
    "/suit/points": "sensor_msgs/PointCloud2",
    "/suit/wrench": "geometry_msgs/WrenchStamped",
    "/diagnostics": "diagnostic_msgs/DiagnosticArray",
    "/tf_static": "tf2_msgs/TFMessage",
}
for array in ("left", "right"):
    TOPICS |= {
        f"/{array}/frame": "dermis_msgs/RawFrame",
        f"/{array}/raw": "sensor_msgs/Image",
        f"/{array}/force": "sensor_msgs/Image",
        f"/{array}/force_sigma": "sensor_msgs/Image",
        f"/{array}/wrench": "geometry_msgs/WrenchStamped",
    }


def nanos(stamp):
    return stamp["sec"] * 10**9 + stamp["nanosec"]


def time_of(message):
    return nanos(message["header"]["stamp"])


def vector(value):
    return np.array([value["x"], value["y"], value["z"]])


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def taxels(row):
    return np.array([float(row[f"r{r}c{c}"] or "nan") for r in range(ROWS) for c in range(COLS)], "f4")


class Rows:
    """Lines of a table by their time, which has 0.1 us where messages have nanoseconds."""

    def __init__(self, path):
        self.rows = rows_of(path)
        self.times = np.array([float(row["time_s"]) for row in self.rows])

    def at(self, time_ns):
        return [self.rows[k] for k in np.flatnonzero(np.abs(self.times - time_ns * 1e-9) < 1e-3)]


class Cyclone(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.serve_and_listen()
        cls.tables = {}
        for array in ("left", "right"):
            tables = {name: cls.root / f"{array}_{name}.csv" for name in ("out", "sigma", "contacts")}
            options = [word for name, path in tables.items() for word in (f"--{name}", path)]
            run = dermis("run", "--model", cls.model, "--in", f"{cls.recording}#{array}", "--follow-drift", *options)
            if run.returncode:
                raise AssertionError(run.stderr)
            cls.tables[array] = {name: Rows(path) for name, path in tables.items()}

    @classmethod
    def serve_and_listen(cls):
        suit = cls.root / "suit.toml"
        suit.write_text(SUIT.format(model=cls.model))
        cls.recording = cls.root / "rec.mcap"
        serve = [
            support.BINARY,
            "serve",
            "--suit",
            suit,
            "--port",
            0,
            "--record",
            cls.recording,
            "--dds",
            "--domain",
            DOMAIN,
        ]
        subscriptions = [subscription(*topic) for topic in TOPICS.items()]
        reader = subprocess.Popen(
            [READER, str(DOMAIN), str(SECONDS), "reliable", *subscriptions],
            env=ENVIRONMENT,
            stdout=subprocess.PIPE,
            text=True,
        )
        server = subprocess.Popen(list(map(str, serve)), env=ENVIRONMENT, stderr=subprocess.DEVNULL)
        lines, _ = reader.communicate(timeout=300)
        server.send_signal(signal.SIGINT)
        if reader.returncode or server.wait(60):
            raise AssertionError("the server or its subscriber failed")
        cls.messages = {topic: [] for topic in TOPICS}
        for line in lines.splitlines():
            if line != "ready":
                received = json.loads(line)
                cls.messages[received["topic"].removeprefix("rt")].append(received["message"])

    def of(self, topic, least=100):
        messages = self.messages[topic]
        self.assertGreaterEqual(len(messages), least, topic)
        return messages

    def test_no_frame_is_missing_between_the_first_and_the_last(self):
        for array in ("left", "right"):
            for name in ("frame", "raw", "force", "force_sigma", "wrench"):
                times = np.array([time_of(message) for message in self.of(f"/{array}/{name}")]) * 1e-9
                recorded = self.tables[array]["out"].times
                between = recorded[(recorded > times[0] - 1e-3) & (recorded < times[-1] + 1e-3)]
                self.assertEqual(len(times), len(between), f"{array} {name}")
                np.testing.assert_allclose(times, between, rtol=0, atol=1e-6)

    def test_counts_are_those_of_the_recording(self):
        for array in ("left", "right"):
            converted = self.work / f"{array}.csv"
            self.assertEqual(dermis("convert", f"{self.recording}#{array}", converted).returncode, 0)
            frames = rows_of(converted)
            times = self.tables[array]["out"].times
            self.assertEqual(len(frames), len(times))
            for message in self.of(f"/{array}/raw"):
                [k] = np.flatnonzero(np.abs(times - time_of(message) * 1e-9) < 1e-3)
                counts = np.frombuffer(bytes.fromhex(message["data"]), "<u2")
                np.testing.assert_array_equal(counts, taxels(frames[k]))
                image = {name: value for name, value in message.items() if name not in ("header", "data")}
                self.assertEqual(
                    image, {"height": ROWS, "width": COLS, "encoding": "16UC1", "is_bigendian": 0, "step": 2 * COLS}
                )

            for message in self.of(f"/{array}/frame"):
                [k] = np.flatnonzero(np.abs(times - time_of(message) * 1e-9) < 1e-3)
                np.testing.assert_array_equal(np.array(message["counts"], "f4"), taxels(frames[k]))
                self.assertEqual((message["rows"], message["cols"], message["has_temperature"]), (ROWS, COLS, True))
                self.assertAlmostEqual(
                    message["temperature_celsius"], float(frames[k]["temperature_celsius"]), places=5
                )
                self.assertAlmostEqual(message["acquisition"]["supply_v"], float(frames[k]["supply_v"]), places=5)

    def test_forces_and_their_sigmas_have_the_bits_of_the_command_line(self):
        for array in ("left", "right"):
            for topic, table in (("force", "out"), ("force_sigma", "sigma")):
                for message in self.of(f"/{array}/{topic}"):
                    [row] = self.tables[array][table].at(time_of(message))
                    values = np.frombuffer(bytes.fromhex(message["data"]), "<f4")
                    np.testing.assert_array_equal(values, taxels(row))
                    self.assertEqual(
                        (message["height"], message["width"], message["encoding"], message["step"]),
                        (ROWS, COLS, "32FC1", 4 * COLS),
                    )
                    self.assertEqual(message["header"]["frame_id"], array)

    def expect_contact(self, contact, row):
        expected = {
            "id": contact["id"],
            "phase": ["onset", "held", "release"][contact["phase"]],
            "taxels": contact["taxels"],
            "x_mm": 1e3 * contact["x"],
            "y_mm": 1e3 * contact["y"],
            "sigma_x_mm": 1e3 * contact["sigma_x"],
            "sigma_y_mm": 1e3 * contact["sigma_y"],
            "velocity_x_mm_per_s": 1e3 * contact["velocity_x"],
            "velocity_y_mm_per_s": 1e3 * contact["velocity_y"],
            "force_n": contact["force_n"],
            "sigma_force_n": contact["sigma_force_n"],
            "area_mm2": 1e6 * contact["area_m2"],
            "peak_pressure_kpa": 1e-3 * contact["peak_pressure_pa"],
            "mean_pressure_kpa": 1e-3 * contact["mean_pressure_pa"],
            "major_axis_mm": 1e3 * contact["major_axis_m"],
            "minor_axis_mm": 1e3 * contact["minor_axis_m"],
            "angle_rad": contact["angle_rad"],
        }
        self.assertEqual(set(expected), set(row) - {"time_s"})
        for name, value in expected.items():
            if isinstance(value, float):
                np.testing.assert_allclose(value, float(row[name]), rtol=1e-6, atol=1e-9, err_msg=name)
            else:
                self.assertEqual(str(value), row[name], name)

    def test_contacts_are_those_of_the_command_line_and_lie_where_their_array_does(self):
        found = 0
        for message in self.of("/contacts"):
            array = message["array"]
            rows = self.tables[array]["contacts"].at(time_of(message))
            self.assertEqual(len(message["touches"]), len(rows))
            for contact, row in zip(message["touches"], rows):
                found += 1
                self.expect_contact(contact, row)
                place = np.array([contact["x"], contact["y"], 0.0])
                if array == "left":  # turned about y by a right angle
                    place = np.array([0.1, 0.2, 0.3]) + [place[2], place[1], -place[0]]
                np.testing.assert_allclose(vector(contact["position"]), place, atol=1e-12)
                np.testing.assert_allclose(
                    vector(contact["normal"]), [1, 0, 0] if array == "left" else [0, 0, 1], atol=1e-12
                )
        self.assertGreater(found, 100)

    def test_wrenches_are_those_of_the_contacts(self):
        for array in ("left", "right"):
            pressed = 0
            for message in self.of(f"/{array}/wrench"):
                force, torque = np.zeros(3), np.zeros(3)
                for row in self.tables[array]["contacts"].at(time_of(message)):
                    press = np.array([0.0, 0.0, -float(row["force_n"])])
                    force += press
                    torque += np.cross([1e-3 * float(row["x_mm"]), 1e-3 * float(row["y_mm"]), 0.0], press)
                pressed += force[2] < 0
                np.testing.assert_allclose(vector(message["wrench"]["force"]), force, rtol=1e-6, atol=1e-9)
                np.testing.assert_allclose(vector(message["wrench"]["torque"]), torque, rtol=1e-6, atol=1e-9)
                self.assertEqual(message["header"]["frame_id"], array)
            self.assertGreater(pressed, 20, array)

    def wrenches_of(self, array):
        messages = self.of(f"/{array}/wrench")
        wrenches = [(vector(message["wrench"]["force"]), vector(message["wrench"]["torque"])) for message in messages]
        return np.array([time_of(message) for message in messages]), wrenches

    def test_the_wrench_of_the_suit_is_the_sum_of_what_its_arrays_had_last(self):
        (times_l, left), (times_r, right) = self.wrenches_of("left"), self.wrenches_of("right")
        place, turn = np.array([0.1, 0.2, 0.3]), np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
        left = np.array(
            [[turn @ force, turn @ torque + np.cross(place, turn @ force)] for force, torque in left]
        ).reshape(-1, 6)
        right = np.array(right).reshape(-1, 6)
        last = 500e6  # [ns]
        compared = 0
        for message in self.of("/suit/wrench", 50):
            time = time_of(message)
            if time - last < max(times_l[0], times_r[0]):
                continue
            wrench = np.concatenate([vector(message["wrench"]["force"]), vector(message["wrench"]["torque"])])
            near_l = left[(times_l >= time - last) & (times_l <= time)]
            near_r = right[(times_r >= time - last) & (times_r <= time)]
            self.assertLess(np.abs(near_l[:, None] + near_r[None] - wrench).max(axis=2).min(), 1e-9)
            compared += 1
        self.assertGreater(compared, 50)

    def test_points_stand_on_the_suit_with_the_forces_of_a_frame(self):
        rows = {array: [taxels(row) for row in self.tables[array]["out"].rows] for array in ("left", "right")}
        place = np.array([[0.01 * c, 0.01 * r, 0.0] for r in range(ROWS) for c in range(COLS)])
        left = np.array([0.1, 0.2, 0.3]) + place[:, [2, 1, 0]] * [1, 1, -1]
        kind = np.dtype([("xyz", "<f4", 3), ("newtons", "<f4"), ("status", "u1"), ("padding", "u1", 3)])
        for message in self.of("/suit/points", 50):
            points = np.frombuffer(bytes.fromhex(message["data"]), kind)
            self.assertEqual(
                (message["height"], message["width"], message["point_step"], message["row_step"]), (1, 40, 20, 800)
            )
            self.assertEqual(
                [(field["name"], field["offset"], field["datatype"], field["count"]) for field in message["fields"]],
                [("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("newtons", 12, 7, 1), ("status", 16, 2, 1)],
            )
            np.testing.assert_allclose(points["xyz"], np.concatenate([left, place]), atol=1e-6)
        last = self.messages["/suit/points"][-1]
        points = np.frombuffer(bytes.fromhex(last["data"]), kind)
        for array, newtons in (("left", points["newtons"][:20]), ("right", points["newtons"][20:])):
            self.assertTrue(any(np.array_equal(newtons, row) for row in rows[array]), array)

    def test_diagnostics_name_every_array(self):
        for message in self.of("/diagnostics", 3):
            self.assertEqual([status["name"] for status in message["status"]], ["left", "right"])
            self.assertEqual([status["level"] for status in message["status"]], [0, 0])
            self.assertEqual({status["hardware_id"] for status in message["status"]}, {"small"})

    def test_who_subscribes_late_gets_the_places_of_the_arrays(self):
        [message] = self.messages["/tf_static"]
        places = {one["child_frame_id"]: one for one in message["transforms"]}
        self.assertEqual({one["header"]["frame_id"] for one in places.values()}, {"suit"})
        np.testing.assert_allclose(vector(places["left"]["transform"]["translation"]), [0.1, 0.2, 0.3])
        turn = places["left"]["transform"]["rotation"]
        np.testing.assert_allclose([turn[axis] for axis in "xyzw"], [0.0, HALF, 0.0, HALF], atol=1e-12)
        np.testing.assert_array_equal(vector(places["right"]["transform"]["translation"]), 0.0)


class OtherSubscribers(SmallArray):
    def serve(self, *options, environment=ENVIRONMENT):
        command = [
            support.BINARY,
            "serve",
            "--from",
            "sim:contacts?rows=4&cols=5&rate=100",
            "--model",
            self.model,
            "--port",
            0,
            "--dds",
            *options,
        ]
        return subprocess.Popen(list(map(str, command)), env=environment, stderr=subprocess.PIPE, text=True)

    def test_subscribers_for_the_data_of_sensors_are_heard_and_the_domain_is_that_of_ros(self):
        domain = DOMAIN - 100
        reader = subprocess.Popen(
            [READER, str(domain), "1", "best_effort", subscription("/small/force", "sensor_msgs/Image")],
            env=ENVIRONMENT,
            stdout=subprocess.PIPE,
            text=True,
        )
        server = self.serve(environment={**ENVIRONMENT, "ROS_DOMAIN_ID": str(domain)})
        lines, _ = reader.communicate(timeout=300)
        server.send_signal(signal.SIGINT)
        server.communicate(timeout=60)
        self.assertEqual((reader.returncode, server.returncode), (0, 0))
        self.assertGreater(len(lines.splitlines()), 30)

    def test_what_is_no_domain_is_refused(self):
        for options, environment, line in (
            (["--domain", "233"], ENVIRONMENT, r"domain: must be 0 to 232, is 233"),
            ([], {**ENVIRONMENT, "ROS_DOMAIN_ID": "x"}, r"ROS_DOMAIN_ID: must be 0 to 232, is 'x'"),
        ):
            server = self.serve(*options, environment=environment)
            _, error = server.communicate(timeout=60)
            self.assertEqual(server.returncode, 2)
            self.assertTrue(re.search(line, error), error)


if __name__ == "__main__":
    support.main()
