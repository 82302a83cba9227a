# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Models go from a hub to a robot at work, and are refused, rolled back and kept: models_test.py DERMIS"""

import hashlib
import json
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

DERMIS = sys.argv.pop(1)
MOST_SECONDS = 120
PUSHES = 11
KEPT = 10

ARRAY = """[array]
name = "chest"
rows = {rows}
cols = 3
taxel_area_mm2 = 38.48

[readout]
circuit = "{circuit}"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = {bits}
adc_reference_v = 5.0
supply_v = 5.0
"""


def run(folder, *arguments):
    return subprocess.run([DERMIS, *map(str, arguments)], cwd=folder, capture_output=True, text=True, check=False)


def succeed(folder, *arguments):
    done = run(folder, *arguments)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: {done.stderr}")
    return done.stdout


def make_model(folder, name, seed=1, rows=2, bits=12, circuit="divider"):
    """A model of an array of rows x 3, calibrated in the simulator."""
    toml, data = folder / f"{name}.toml", folder / name
    toml.write_text(ARRAY.format(rows=rows, bits=bits, circuit=circuit))
    succeed(folder, "simulate", "--array", toml, "--scene", "calibration", "--seed", seed, "--out", data)
    files = ["--frames", data / "frames.csv", "--loads", data / "loads.csv"]
    succeed(folder, "calibrate", "--array", toml, *files, "--out", folder / f"{name}.safetensors")
    return folder / f"{name}.safetensors"


@unittest.skipIf(shutil.which("nats-server") is None, "nats-server is not installed")
class Models(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.folder = Path(made.name)
        cls.first = make_model(cls.folder, "first")
        cls.second = make_model(cls.folder, "second", seed=2)

    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.work = Path(made.name)
        shutil.copy(self.folder / "first.toml", self.work / "array.toml")
        self.log = self.work / "log"
        self.kept = self.work / "dermis-models/anna/chest"
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            self.port = listener.getsockname()[1]
        self.hub = f"nats://127.0.0.1:{self.port}"
        self.server = self.start(["nats-server", "-a", "127.0.0.1", "-p", str(self.port), "-js", "-sd", "store"])
        while run(self.work, "fleet", "list", self.hub).returncode != 0:
            time.sleep(0.1)

    def start(self, command, **options):
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **options}
        process = subprocess.Popen(command, cwd=self.work, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def serve(self, *more, log="log", rate=50):
        with open(self.work / log, "wb") as log:
            options = ["--from", f"sim:contacts?rate={rate}", "--model", "array.toml", "--port", "0"]
            fleet = ["--publish", self.hub, "--robot", "anna", *more]
            return self.start([DERMIS, "serve", *options, *fleet], stdout=log, stderr=log)

    def wait_for(self, line):
        end = time.monotonic() + MOST_SECONDS
        while line not in (text := self.log.read_text()):
            self.assertLess(time.monotonic(), end, f"no '{line}' in: {text}")
            time.sleep(0.05)

    def listed(self, *words):
        return succeed(self.work, "fleet", *words[:1], self.hub, *words[1:])

    def wait_for_words(self, pattern, *words):
        end = time.monotonic() + MOST_SECONDS
        while not re.search(pattern, text := self.listed(*words)):
            self.assertLess(time.monotonic(), end, f"no '{pattern}' in: {text}")
            time.sleep(0.2)

    def expect_refused(self, *words, said, status=2):
        refused = run(self.work, "fleet", *words)
        self.assertEqual(refused.returncode, status, refused)
        self.assertIn(said, refused.stderr)
        self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)

    def push(self, model):
        succeed(self.work, "fleet", "push", self.hub, model, "--for", "anna/chest")

    def served_array(self):
        url = re.search(r"http://\S+/", self.log.read_text()).group(0)
        with urllib.request.urlopen(url + "suit.json", timeout=10) as answer:
            return json.load(answer)["arrays"][0]

    def kept_file(self, model):
        return self.kept / (hashlib.sha256(model.read_bytes()).hexdigest() + ".safetensors")

    def expect_whole_files(self):
        models = list(self.kept.glob("*.safetensors"))
        for model in models:
            self.assertEqual(hashlib.sha256(model.read_bytes()).hexdigest(), model.stem)
        return models

    def damage(self, model):
        """Another client of the hub replaces the only piece of a model."""
        data = model.read_bytes()
        subject = f"dermis-models.anna.chest.{hashlib.sha256(data).hexdigest()}.0"
        with socket.create_connection(("127.0.0.1", self.port)) as hub:
            damaged = bytes([data[0] ^ 1]) + data[1:]
            hub.sendall(b"CONNECT {}\r\nPUB %s %d\r\n%s\r\nPING\r\n" % (subject.encode(), len(damaged), damaged))
            answer = b""
            while b"PONG" not in answer:
                answer += hub.recv(4096)
        time.sleep(0.5)

    def test_a_robot_at_work_takes_a_model_and_goes_back(self):
        robot = self.serve()
        self.wait_for("serving chest")
        self.assertFalse(self.served_array()["calibrated"])
        self.push(self.first)
        self.wait_for("chest: model 1 of the fleet is in use (first.safetensors, ")
        self.assertTrue(self.served_array()["calibrated"])
        self.assertEqual(self.kept_file(self.first).read_bytes(), self.first.read_bytes())
        self.push(self.second)
        self.wait_for("chest: model 2 of the fleet is in use")
        robot.kill()
        robot.wait()
        robot = self.serve()
        self.wait_for("chest: model 2 of the fleet is in use")
        succeed(self.work, "fleet", "rollback", self.hub, "--for", "anna/chest")
        self.wait_for("chest: model 1 of the fleet is in use")
        listed = succeed(self.work, "fleet", "models", self.hub)
        self.assertRegex(listed, r"anna/chest +\*1 [0-9a-f]{8} .+ first\.safetensors\n")
        self.assertRegex(listed, r"anna/chest +2 [0-9a-f]{8} .+ second\.safetensors\n")
        robot.terminate()
        self.assertEqual(robot.wait(30), 0)

    def test_without_its_hub_a_robot_uses_the_last_model(self):
        self.push(self.first)
        robot = self.serve()
        self.wait_for("chest: model 1 of the fleet is in use")
        self.wait_for("serving chest")
        self.server.kill()
        self.server.wait()
        self.assertTrue(self.served_array()["calibrated"])
        robot.kill()
        robot.wait()
        self.serve()
        self.wait_for("serving chest")
        self.assertIn("chest: model 1 of the fleet is in use", self.log.read_text())
        self.assertTrue(self.served_array()["calibrated"])

    def test_models_that_do_not_fit_are_refused(self):
        self.push(make_model(self.folder, "larger", rows=3))
        self.serve()
        self.wait_for("chest: model of the fleet: 1 is refused: it is of 3x3 taxels, the array of 2x3")
        self.wait_for("serving chest")
        self.assertFalse(self.served_array()["calibrated"])
        self.push(make_model(self.folder, "other", circuit="transimpedance"))
        self.wait_for(
            "chest: model of the fleet: 2 is refused: it is of the circuit transimpedance, the array of divider"
        )
        self.assertEqual(list(self.kept.glob("*")), [])
        self.push(self.first)
        self.wait_for("chest: model 3 of the fleet is in use")

    def test_a_refused_model_shows_as_refused_and_the_one_in_use_as_in_use(self):
        self.push(self.first)
        self.serve()
        self.wait_for("chest: model 1 of the fleet is in use")
        self.push(make_model(self.folder, "other", circuit="transimpedance"))
        self.wait_for("chest: model of the fleet: 2 is refused")
        self.wait_for_words(r"anna/chest +1 .+ in use +first\.safetensors\n", "models")
        use = "model 2 wanted, 1 in use: refused since \\d{4}-\\d\\d-\\d\\d [0-9:]{8} UTC: it is of the circuit"
        self.wait_for_words(rf"anna/chest +\*2 .+ refused +other\.safetensors\n  {use}", "models")
        self.wait_for_words(rf"anna +warning +[0-9-]+ [0-9:]+ .+\n  chest: {use}", "list")
        self.assertRegex(self.listed("history"), r"anna +chest: model 1 of the fleet is in use\n")
        self.assertRegex(self.listed("history"), r"anna +chest: model 2 is refused: it is of the circuit")
        succeed(self.work, "fleet", "rollback", self.hub, "--for", "anna/chest")
        self.wait_for_words(r"anna +well ", "list")
        self.wait_for_words(r"anna/chest +\*1 .+ in use +first\.safetensors\n", "models")

    def test_a_push_that_cannot_be_meant_is_refused(self):
        waiting = run(self.work, "fleet", "push", self.hub, self.first, "--for", "anna/chest")
        self.assertIn("the hub knows no robot yet", waiting.stderr)
        self.serve()
        self.wait_for_words(r"anna +well ", "list")
        larger = make_model(self.folder, "larger", rows=3)
        finer = make_model(self.folder, "finer", bits=14)
        for place, model, said in (
            ("anne/chest", self.first, "--for: the hub knows no robot 'anne'; it knows anna"),
            ("anna/back", self.first, "--for: robot 'anna' has no array 'back'; it has chest"),
            ("anna/chest", larger, "--for: the model is of 3x3 taxels, anna/chest has 2x3"),
            ("anna/chest", finer, "--for: the model does not fit anna/chest: it is of other readings"),
        ):
            self.expect_refused("push", self.hub, model, "--for", place, said=said)
        two = ("--for", "anna/chest", "--for", "anne/chest")
        self.expect_refused("push", self.hub, self.second, *two, said="no robot 'anne'")
        self.assertNotIn("second", self.listed("models"))  # all or none

    def test_a_second_robot_of_a_name_is_refused_or_takes_over(self):
        first = self.serve()
        self.wait_for_words(r"anna +(well|warning) ", "list")
        refused = self.serve(log="second")
        self.assertEqual(refused.wait(MOST_SECONDS), 2)
        said = (self.work / "second").read_text()
        self.assertRegex(said, r"another robot publishes as 'anna' \(process \d+ on \S+\); .+ have it take over\n")
        self.serve("--take-over", log="third")
        self.wait_for("has taken over the name 'anna'; nothing more is published")
        self.assertIsNone(first.poll())
        time.sleep(1)
        source = f"{self.hub}?robot=anna&array=chest&from=1&to=last"
        recorded = run(self.work, "record", "--from", source, "--out", "anna.csv")
        self.assertEqual(recorded.returncode, 0, recorded.stderr)
        self.assertEqual(recorded.stderr.count("another run of the robot begins"), 1, recorded.stderr)

    def test_a_full_disk_of_the_hub_and_the_age_of_what_is_shown_are_told(self):
        self.server.kill()
        self.server.wait()
        (self.work / "full.conf").write_text('jetstream { store_dir: "full", max_file_store: 1MB }\n')
        self.start(["nats-server", "-a", "127.0.0.1", "-p", str(self.port), "-c", "full.conf"])
        while run(self.work, "fleet", "list", self.hub).returncode != 0:
            time.sleep(0.1)
        self.serve(rate=1000)
        self.wait_for("its disk is full with 1 MB of streams; clear it, or raise max_file_store; frames wait")
        self.wait_for_words(r"anna +silent .+\n  no message for \d+ s: look whether it is on", "list")
        listed = run(self.work, "fleet", "list", self.hub)
        self.assertIn("the hub stores nothing more: ", listed.stderr)
        self.assertRegex(listed.stdout, r"anna +silent .+ 1 +- ")

    def test_a_trial_shows_two_robots_and_leaves_nothing_behind(self):
        empty = self.work / "empty"
        empty.mkdir()
        paths = {**os.environ, "TMPDIR": str(empty)}
        with open(self.log, "wb") as log:
            trial = self.start([DERMIS, "fleet", "try"], env=paths, stderr=log)
        self.wait_for("the fleet is shown at http://127.0.0.1:")
        hub = re.search(r"nats://\S+:\d+", self.log.read_text()).group(0)
        listed = run(self.work, "fleet", "list", hub).stdout
        self.assertRegex(listed, r"(?s)anna .*bob ")
        trial.send_signal(signal.SIGINT)
        self.assertEqual(trial.wait(30), 0)
        self.assertEqual(list(empty.iterdir()), [])
        self.assertEqual(run(self.work, "fleet", "list", hub).returncode, 1)

    def test_a_damaged_model_is_refused_until_it_is_pushed_again(self):
        self.push(self.first)
        self.damage(self.first)
        self.serve()
        self.wait_for("chest: model of the fleet: 1 is refused: its SHA-256 is wrong; push it again")
        self.assertEqual(list(self.kept.glob("*")), [])
        self.push(self.first)
        self.wait_for("chest: model 2 of the fleet is in use")
        self.expect_whole_files()

    def test_a_model_is_never_half_there_and_ten_are_kept(self):
        moments = random.Random(1)
        for number in range(1, PUSHES + 1):
            self.push(make_model(self.folder, f"model{number}", seed=10 + number))
            robot = self.serve()
            time.sleep(moments.uniform(0, 0.4))
            robot.kill()
            robot.wait()
            self.expect_whole_files()
            robot = self.serve()
            self.wait_for(f"chest: model {number} of the fleet is in use")
            robot.kill()
            robot.wait()
        models = self.expect_whole_files()
        self.assertEqual(len(models), KEPT)
        self.assertNotIn(self.kept_file(self.folder / "model1.safetensors"), models)

    def test_bad_words_are_refused_in_one_line(self):
        for words, said in (
            (("push", self.hub, self.first, "--for", "anna"), "--for: 'anna' must be ROBOT/ARRAY"),
            (("push", self.hub, self.first, "--for", "anna/a.b"), "--for: 'a.b' must be 1 to 64 letters"),
            (("push", self.hub, "array.toml", "--for", "anna/chest"), "array.toml: is no model file"),
            (("push", self.hub, "log", "--for", "anna/chest"), "log"),
            (("rollback", self.hub, "--for", "anna/chest"), "anna/chest: no model was pushed to it"),
        ):
            self.log.write_text("no model")
            refused = run(self.work, "fleet", *words)
            self.assertEqual(refused.returncode, 2, words)
            self.assertIn(said, refused.stderr)
            self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)
        nobody = "nats://127.0.0.1:1"
        for command in ("list", "models", "history", "watch", "page"):
            self.expect_refused(command, nobody, said="no server answers there; see that nats-server is on", status=1)
        self.expect_refused("watch", self.hub, said="the hub knows no robot that could be watched")
        self.expect_refused("history", self.hub, "--hours", "0", said="--hours: must be above 0")
        self.expect_refused("add", self.hub, "--robot", "a.b", said="robot: 'a.b' must be 1 to 64 letters")
        self.expect_refused("add", self.hub, "--robot=-rf", said="'_' or '-', a letter or digit first")
        self.push(self.first)
        refused = run(self.work, "fleet", "rollback", self.hub, "--for", "anna/chest")
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (2, 1))
        self.assertIn("anna/chest: has no model before the current one", refused.stderr)


if __name__ == "__main__":
    unittest.main()
