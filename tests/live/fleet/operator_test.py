# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""An operator who knows only docs/fleet.md asks a real hub eight questions: operator_test.py DERMIS DOCUMENT

anna is well, bob refuses a model, carl is silent, dora is behind: her server reaches the hub by a slow line.
"""

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from datetime import UTC, datetime
from pathlib import Path

DOCUMENT = Path(sys.argv.pop(2))
DERMIS = Path(sys.argv.pop(1)).resolve()
MAKE_FLEET = DOCUMENT.resolve().parents[1] / "deploy/nats/make_fleet"
ROBOTS = ("anna", "bob", "carl", "dora")
RATES = {"dora": 1000}
MOST_SECONDS = 90
SLOW_BYTES_A_SECOND = 15000
TIME = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d"

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


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class SlowLine:
    """Passes a connection on; what goes up, so many bytes a second once it is slow."""

    def __init__(self, port):
        self.is_slow = False
        self.to = port
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            robot, _ = self.listener.accept()
            try:
                hub = socket.create_connection(("127.0.0.1", self.to))
            except ConnectionRefusedError:
                robot.close()  # the hub has not begun; the robot comes again
                continue
            for one, other, is_up in ((robot, hub, True), (hub, robot, False)):
                threading.Thread(target=self.pump, args=(one, other, is_up), daemon=True).start()

    def pump(self, source, target, is_up):
        try:
            while data := source.recv(1500):
                target.sendall(data)
                if is_up and self.is_slow:
                    time.sleep(len(data) / SLOW_BYTES_A_SECOND)
        except OSError:
            pass
        target.close()


def commands_of_the_document():
    """The lines of the first code below the heading, without their remarks."""
    section = DOCUMENT.read_text().split("## Running a fleet\n", 1)[1]
    code = section.split("```sh\n", 1)[1].split("```", 1)[0]
    return [line.split("  #", 1)[0].strip() for line in code.splitlines()]


def missing():
    for program in ("nats-server", "openssl"):
        if shutil.which(program) is None:
            return f"{program} is not installed"
    tried = subprocess.run([DERMIS, "fleet", "list", "nats://127.0.0.1:1"], capture_output=True, text=True, check=False)
    return f"no plugin: {tried.stderr}" if tried.returncode == 2 else ""


class Operator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if why := missing():
            raise unittest.SkipTest(why)
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.work = Path(made.name)
        cls.begin_servers()
        cls.begin_robots()
        cls.make_trouble()

    @classmethod
    def start(cls, command, folder, log):
        with open(cls.work / log, "wb") as out:
            process = subprocess.Popen([*map(str, command)], cwd=folder, stdout=out, stderr=out)
        cls.addClassCleanup(process.wait)
        cls.addClassCleanup(process.kill)
        return process

    @classmethod
    def dermis(cls, *words):
        done = subprocess.run([DERMIS, *map(str, words)], cwd=cls.work, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.stderr}")
        return done.stdout

    @classmethod
    def begin_servers(cls):
        subprocess.run([MAKE_FLEET, "fleet", "127.0.0.1", *ROBOTS], cwd=cls.work, check=True, capture_output=True)
        robots_port, port = free_port(), free_port()
        conf = cls.work / "fleet/hub/nats.conf"
        conf.write_text(conf.read_text().replace("0.0.0.0:7422", f"127.0.0.1:{robots_port}"))
        cls.start(["nats-server", "-c", "nats.conf", "-a", "127.0.0.1", "-p", port], conf.parent, "hub.log")
        cls.slow_line = SlowLine(robots_port)
        cls.ports = {}
        for robot in ROBOTS:
            cls.ports[robot] = free_port()
            conf = cls.work / f"fleet/robots/{robot}/nats.conf"
            to = cls.slow_line.port if robot == "dora" else robots_port
            conf.write_text(conf.read_text().replace(":7422", f":{to}"))
            cls.start(["nats-server", "-c", "nats.conf", "-p", cls.ports[robot]], conf.parent, f"server-{robot}.log")
        cls.hub = f"nats://127.0.0.1:{port}?ca=fleet/ca.pem&key=fleet/operator.pem"
        cls.wait_for(lambda: cls.ask(f"'{DERMIS}' fleet list '{cls.hub}'").returncode == 0)
        named = [word for robot in ROBOTS for word in ("--robot", robot)]
        cls.dermis("fleet", "add", cls.hub, *named)

    @classmethod
    def make_model(cls, name, circuit="divider"):
        (cls.work / f"{name}.toml").write_text(ARRAY.format(rows=2, bits=12, circuit=circuit))
        data = cls.work / name
        cls.dermis("simulate", "--array", f"{name}.toml", "--scene", "calibration", "--out", data)
        files = ["--frames", data / "frames.csv", "--loads", data / "loads.csv"]
        cls.dermis("calibrate", "--array", f"{name}.toml", *files, "--out", f"{name}.safetensors")

    @classmethod
    def begin_robots(cls):
        cls.make_model("chest")
        cls.make_model("other", circuit="transimpedance")
        cls.robots = {}
        for robot in ROBOTS:
            folder = cls.work / f"at-{robot}"
            folder.mkdir()
            shutil.copy(cls.work / "chest.safetensors", folder)
            keys = cls.work / f"fleet/robots/{robot}"
            server = f"nats://127.0.0.1:{cls.ports[robot]}?ca={keys}/ca.pem&key={keys}/{robot}.pem"
            source = f"sim:contacts?rate={RATES.get(robot, 50)}"
            command = [DERMIS, "serve", "--from", source, "--model", "chest.safetensors", "--port", "0"]
            command += ["--publish", server, "--robot", robot]
            cls.robots[robot] = cls.start(command, folder, f"{robot}.log")
        cls.wait_for(lambda: len(re.findall(r" well ", cls.dermis("fleet", "list", cls.hub))) == len(ROBOTS))

    @classmethod
    def make_trouble(cls):
        cls.dermis("fleet", "push", cls.hub, "other.safetensors", "--for", "bob/chest")
        cls.robots["carl"].send_signal(signal.SIGKILL)
        cls.slow_line.is_slow = True
        wanted = r"bob +warning(?s:.)*carl +silent(?s:.)*dora +behind"
        cls.wait_for(lambda: re.search(wanted, cls.dermis("fleet", "list", cls.hub)))

    @classmethod
    def wait_for(cls, holds):
        end = time.monotonic() + MOST_SECONDS
        while not holds():
            if time.monotonic() > end:
                logs = "\n".join(f"{log.name}: {log.read_text()[-300:]}" for log in cls.work.glob("*.log"))
                listed = cls.ask(f"'{DERMIS}' fleet list '{cls.hub}'")
                raise AssertionError(f"waited in vain: {listed.stdout}{listed.stderr}\n{logs}")
            time.sleep(0.5)

    @classmethod
    def ask(cls, command, **options):
        paths = f"{cls.work}/bin:{DERMIS.parent}:{os.environ['PATH']}"
        environment = {**os.environ, "PATH": paths}
        return subprocess.run(
            command, shell=True, cwd=cls.work, env=environment, capture_output=True, text=True, check=False, **options
        )

    def asked(self, beginning, *also):
        """The command of the document that begins so, about this hub."""
        for command in commands_of_the_document():
            if command.startswith(beginning) and all(word in command for word in also):
                encrypted = command.replace("nats://hub.local?", self.hub + "&")
                return re.sub(r"nats://hub\.local(?= |$)", f"'{self.hub}'", encrypted)
        raise AssertionError(f"docs/fleet.md has no '{beginning}'")

    def answer(self, beginning, *also, status=0):
        done = self.ask(self.asked(beginning, *also))
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout

    def test_1_which_robots_are_there_and_how_are_they(self):
        listed = self.answer("dermis fleet list")
        states = dict(re.findall(r"^(\w+) +(well|silent|warning|behind) ", listed, re.MULTILINE))
        self.assertEqual(states, {"anna": "well", "bob": "warning", "carl": "silent", "dora": "behind"})
        (carl,) = re.findall(r"^carl .*$", listed, re.MULTILINE)
        self.assertNotIn("50.0", carl)  # no rate of a silent robot

    def test_2_which_is_not_well_and_why(self):
        listed = self.answer("dermis fleet list")
        self.assertRegex(
            listed, r"bob .+\n  chest: model 1 wanted, its own in use: refused .+ of the circuit transimpedance"
        )
        self.assertRegex(listed, r"carl .+\n  no message for \d+ s: look whether it is on")
        self.assertRegex(
            listed, r"dora .+\n  (the hub still lacks \d+ of its messages|its messages reach the hub \d+ s late)\n"
        )

    def test_3_since_when(self):
        listed = self.answer("dermis fleet list")
        for robot, state in (("bob", "warning"), ("carl", "silent"), ("dora", "behind")):
            (text,) = re.findall(rf"^{robot} +{state} +({TIME}) ", listed, re.MULTILINE)
            age = datetime.now(UTC) - datetime.fromisoformat(text + "+00:00")
            self.assertLess(age.total_seconds(), 10 * MOST_SECONDS)
            self.assertGreater(age.total_seconds(), 0)

    def test_4_what_is_to_be_done(self):
        states = re.findall(r" (silent|warning|behind) ", self.answer("dermis fleet list"))
        table = DOCUMENT.read_text().split("| state | meaning | to do |", 1)[1]
        for state in states:
            (to_do,) = re.findall(rf"^\| \*{state}\* \|[^|]+\|([^|]+)\|$", table, re.MULTILINE)
            self.assertGreater(len(to_do.split()), 3)

    def test_5_which_model_does_each_array_use_and_which_was_refused_and_why(self):
        models = self.answer("dermis fleet models")
        self.assertRegex(models, r"bob/chest +\*1 .+ refused +other\.safetensors\n  model 1 wanted, its own in use: ")
        self.assertRegex(models, r"refused since .+ UTC: it is of the circuit")

    def test_6_what_happened_last_night(self):
        history = self.answer("dermis fleet history")
        self.assertRegex(history, rf"{TIME} UTC  anna +begins to publish\n")
        self.assertRegex(history, rf"{TIME} UTC  bob +chest: model 1 is refused: it is of the circuit")
        self.assertRegex(history, rf"{TIME} UTC  carl +is silent since then\n")

    def test_7_how_am_i_alarmed(self):
        once = self.ask(self.asked("dermis fleet watch", "--once"))
        self.assertEqual(once.returncode, 3, once.stderr)
        self.assertRegex(once.stdout, rf"carl: silent since {TIME} UTC: no message for")
        mail = self.work / "bin/mail"
        mail.parent.mkdir(exist_ok=True)
        mail.write_text(f'#!/bin/sh\necho "$@" >>{self.work}/sent\n')
        mail.chmod(0o755)
        command = self.asked("dermis fleet watch", "mail")
        watch = subprocess.Popen(
            f"exec {command}",
            shell=True,
            cwd=self.work,
            env={**os.environ, "PATH": f"{mail.parent}:{DERMIS.parent}:{os.environ['PATH']}"},
            stdout=subprocess.DEVNULL,
        )
        self.addCleanup(watch.wait)
        self.addCleanup(watch.kill)
        sent = self.work / "sent"
        self.wait_for(lambda: sent.exists() and sent.read_text().count("\n") >= 3)
        self.assertRegex(sent.read_text(), rf"-s carl: silent since {TIME} UTC: no message for.+ me@example\.org\n")
        watch.terminate()
        self.assertEqual(watch.wait(30), 0)

    def test_8_how_do_i_get_a_robots_recording(self):
        self.answer("dermis record")
        self.assertRegex(self.dermis("info", "anna.mcap"), "2 ?x ?3")

    def test_words_that_a_fleet_with_keys_refuses_are_told_in_one_line(self):
        hub = self.hub.split("?")[0]
        keys = "fleet/robots/anna"
        own = f"nats://127.0.0.1:{self.ports['anna']}?ca={keys}/ca.pem&key={keys}/anna.pem"
        push = ("chest.safetensors", "--for", "anna/chest")
        for words, said in (
            (("list", f"{hub}?ca=fleet/ca.pem"), "give key=FILE"),
            (("list", f"{hub}?ca=fleet/none.pem"), "fleet/none.pem: cannot be read"),
            (("list", f"{hub}?ca=fleet/ca.pem&key=fleet/none.pem"), "fleet/none.pem: cannot be read"),
            (("push", own, *push), "this is the server of robot 'anna'; models are pushed to the hub"),
            (("push", f"{hub}?ca=fleet/ca.pem&key=fleet/reader.pem", *push), "the user of this key may not do that"),
        ):
            refused = subprocess.run(
                [DERMIS, "fleet", *words], cwd=self.work, capture_output=True, text=True, check=False
            )
            self.assertNotEqual(refused.returncode, 0, words)
            self.assertIn(said, refused.stderr)
            self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)


if __name__ == "__main__":
    unittest.main()
