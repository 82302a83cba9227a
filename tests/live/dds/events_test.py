# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Threats, what is recognised and a calibration reach a subscriber of another vendor; Python serves them.

Usage: events_test.py DERMIS READER, with the Python package on PYTHONPATH"""

import base64
import json
import os
import socket
import struct
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "command_line"))
import loopback
import support

import dermis

READER = sys.argv.pop(2)
DOMAIN = 100 + os.getpid() % 100
SECONDS = 3
TOPICS = {
    "/threat": "dermis_msgs/Threat",
    "/small/recognition": "vision_msgs/Classification",
    "/calibration": "dermis_msgs/CalibrationState",
}
THREATS = '[[threat]]\nname = "light"\nquantity = "contact_force"\nlimit_n = 0.2\n'
BINARY, TEXT = 2, 1
SERVICE_CALL, SERVICE_ANSWER = 2, 3  # of the Foxglove protocol


class Client:
    """As much of a WebSocket as a call of a service needs."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n".encode()
        )
        self.stream = self.socket.makefile("rb")
        while self.stream.readline() != b"\r\n":
            pass

    def receive(self):
        kind, length = self.stream.read(2)
        if length == 126:
            (length,) = struct.unpack(">H", self.stream.read(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self.stream.read(8))
        return kind & 15, self.stream.read(length)

    def call(self, name, request):
        service = None
        while service is None:
            kind, content = self.receive()
            services = json.loads(content).get("services", []) if kind == TEXT else []
            service = next((one["id"] for one in services if one["name"] == name), None)
        content = json.dumps(request).encode()
        call = struct.pack("<BIII4s", SERVICE_CALL, service, 1, 4, b"json") + content
        self.socket.sendall(struct.pack(">BBI", 128 + BINARY, 128 + len(call), 0) + call)  # masked by zeros
        while True:
            kind, content = self.receive()
            if kind == BINARY and content[0] == SERVICE_ANSWER:
                return
            if kind == TEXT and json.loads(content)["op"] == "serviceCallFailure":
                raise AssertionError(content)

    def close(self):
        self.stream.close()
        self.socket.close()


class Events(support.SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.threats = cls.root / "threats.toml"
        cls.threats.write_text(THREATS)
        labels = cls.root / "labels.csv"
        labels.write_text(
            "id,first,last,class\n" + "".join(f"{k},{5 * k},{5 * k},{'hand' if k % 2 else 'foot'}\n" for k in range(40))
        )
        cls.classes = cls.root / "classes"
        learned = support.dermis(
            "recognise", "learn", "--in", cls.contacts / "frames.csv", "--labels", labels, "--out", cls.classes
        )
        if learned.returncode:
            raise AssertionError(learned.stderr)

    def serve(self, **options):
        return dermis.serve("sim:multitouch?rows=4&cols=5&rate=100", self.model, port=0, **options)

    def test_threats_recognition_and_calibration_are_topics(self):
        subscriptions = [loopback.subscription(*topic) for topic in TOPICS.items()]
        reader = subprocess.Popen(
            [READER, str(DOMAIN), str(SECONDS), "reliable", *subscriptions],
            env=loopback.ENVIRONMENT,
            stdout=subprocess.PIPE,
            text=True,
        )
        os.environ["ROS_LOCALHOST_ONLY"] = "1"
        with self.serve(classes=self.classes, threats=self.threats, dds=True, domain=DOMAIN) as server:
            client = Client(server.port)
            self.addCleanup(client.close)
            client.call("/calibration/start", {"array": "small", "weights_n": [1], "taxels": [0]})
            lines, _ = reader.communicate(timeout=300)
        self.assertEqual(reader.returncode, 0)
        seen = {topic: [] for topic in TOPICS}
        for line in lines.splitlines():
            if line != "ready":
                message = json.loads(line)
                seen[message["topic"].removeprefix("rt")].append(message["message"])
        self.assertEqual({message["name"] for message in seen["/threat"]}, {"light"})
        self.assertTrue(any(message["state"] == 2 and message["value"] > 0.2 for message in seen["/threat"]))
        for message in seen["/small/recognition"]:
            self.assertLessEqual({"hand", "foot"}, {result["class_id"] for result in message["results"]})
        self.assertGreater(len(seen["/small/recognition"]), 5)
        self.assertEqual({message["array"] for message in seen["/calibration"]}, {"small"})
        self.assertEqual(seen["/calibration"][-1]["presses_total"], 1)

    def test_a_domain_is_one_of_dds(self):
        with self.assertRaisesRegex(dermis.BadInput, "domain: is that of dds=True"):
            self.serve(domain=1)
        with self.assertRaisesRegex(dermis.BadInput, "domain: must be 0 to 232, is 233"):
            self.serve(dds=True, domain=233)


if __name__ == "__main__":
    support.main()
