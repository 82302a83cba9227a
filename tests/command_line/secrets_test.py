# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Neither the token of a server nor the password of a hub shows anywhere: not in ps, in no log, no file and no page."""

import base64
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

import support
from support import SmallArray, dermis

PATIENCE = 120  # [s]
TOKEN = "token-0f3c9a"
PASSWORD = "password-71be55"
LIVE = "sim:contacts?rows=4&cols=5&rate=100"
HUB = 'jetstream {{ store_dir: "store" }}\nauthorization {{ {} }}\n'
USER = f'user: "anna", password: "{PASSWORD}"'


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def command_line_of(pid):
    return Path(f"/proc/{pid}/cmdline").read_bytes().decode()


def get(address):
    with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
        return answer.read()


def stream_of(port, token, least):
    """The first bytes of all topics, parameters and services that the server has."""
    with socket.create_connection(("127.0.0.1", port), PATIENCE) as stream:
        key = base64.b64encode(os.urandom(16)).decode()
        stream.sendall(
            f"GET /?token={token} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n".encode()
        )
        got = b""
        while b"\r\n\r\n" not in got:  # who sends sooner breaks the protocol
            got += stream.recv(65536)
        wanted = {"op": "subscribe", "subscriptions": [{"id": k, "channelId": k} for k in range(30)]}
        for request in (wanted, {"op": "getParameters", "parameterNames": [], "id": "all"}):
            text = json.dumps(request).encode().ljust(126)  # of the second form of lengths
            stream.sendall(b"\x81\xfe" + len(text).to_bytes(2, "big") + bytes(4) + text)
        while len(got) < least:
            part = stream.recv(65536)
            if not part:
                raise AssertionError(f"the stream ended: {got[:300]}")
            got += part
        return got


class Secrets(SmallArray):
    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.hidden = Path(folder.name)

    def secret_file(self, name, secret, mode=0o600):
        path = self.hidden / name
        path.write_text(secret + "\n")
        path.chmod(mode)
        return path

    def ways(self, secret, variable, credential):
        """Environments and files that give it; the last one gives both, and the file counts."""
        folder = self.secret_file(credential, secret).parent
        return [
            ({variable: secret}, None),
            ({"CREDENTIALS_DIRECTORY": str(folder)}, None),
            ({variable: "of-the-environment"}, folder / credential),
        ]

    def start(self, *command, environment=None):
        """A command at work, whose words go to a file of the working folder."""
        said = self.work / f"said-{len(list(self.work.iterdir()))}"
        with open(said, "w") as log:
            words = [support.BINARY, *map(str, command)]
            process = subprocess.Popen(
                words, cwd=self.work, stdout=log, stderr=log, env=os.environ | (environment or {})
            )
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        process.said = said
        return process

    def await_line(self, process, expression):
        end = time.monotonic() + PATIENCE
        while not (found := re.search(expression, process.said.read_text())):
            self.assertIsNone(process.poll(), process.said.read_text())
            self.assertLess(time.monotonic(), end, process.said.read_text())
            time.sleep(0.02)
        return found

    def end(self, process):
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(PATIENCE), 0, process.said.read_text())

    def assert_nothing_shows(self, secret, *texts):
        """Nor in any file of the working folder."""
        for path in filter(Path.is_file, self.work.rglob("*")):
            self.assertNotIn(secret.encode(), path.read_bytes(), path)
        for recording in self.work.rglob("*.mcap"):
            self.assertNotIn(secret, dermis("info", recording, "--json").stdout)
        for text in texts:
            self.assertNotIn(secret, text if isinstance(text, str) else text.decode(errors="replace"))


class Tokens(Secrets):
    def check_served(self, process):
        port = int(self.await_line(process, r"at http://127.0.0.1:(\d+)/ with its token")[1])
        address = f"http://127.0.0.1:{port}/"
        with self.assertRaises(urllib.error.HTTPError) as refused:
            get(address + "suit.json")
        self.assertEqual(refused.exception.code, 401)
        refused.exception.close()
        pages = [get(address), get(f"{address}suit.json?token={TOKEN}"), stream_of(port, TOKEN, 200_000)]
        shown = command_line_of(process.pid)
        self.end(process)
        self.assert_nothing_shows(TOKEN, shown, *pages)

    def test_a_token_is_taken_from_a_file_the_environment_and_systemd(self):
        for k, (environment, file) in enumerate(self.ways(TOKEN, "DERMIS_TOKEN", "token")):
            named = ("--token-file", file) if file else ()
            record = ("--record", self.work / f"{k}.mcap")
            source = ("--from", LIVE, "--model", self.model, "--port", 0)
            process = self.start("serve", *source, *record, *named, environment=environment)
            self.check_served(process)
            self.assertNotIn("could see it", process.said.read_text())

    def test_a_token_of_the_command_line_is_hidden_and_told_once(self):
        for words in (("--token", TOKEN), (f"--token={TOKEN}",)):
            process = self.start("serve", "--from", LIVE, "--model", self.model, "--port", 0, *words)
            self.check_served(process)
            self.assertEqual(process.said.read_text().count("--token: others could see it in ps"), 1)

    def test_a_token_that_others_could_read_is_refused(self):
        serve = ("serve", "--from", LIVE, "--model", self.model, "--port", 0, "--token-file")
        self.refuse([*serve, self.secret_file("open", TOKEN, 0o644)], ["open", "chmod o="])
        self.refuse([*serve, self.hidden / "none"], ["none", "No such file"])
        self.refuse([*serve, self.secret_file("two", f"{TOKEN}\n{TOKEN}")], ["two", "only line"])
        short = self.secret_file("short", "brief")
        self.refuse([*serve, short], ["token", "8 characters"])
        result = dermis(*serve, short, "--token", TOKEN)
        self.assertEqual(result.returncode, 2)
        self.assert_nothing_shows(TOKEN, result.stderr)


class Passwords(Secrets):
    def begin_hub(self, authorization=USER):
        if not shutil.which("nats-server"):
            self.skipTest("nats-server is not installed")
        folder = self.hidden / "hub"
        folder.mkdir()
        (folder / "nats.conf").write_text(HUB.format(authorization))
        port = free_port()
        command = ["nats-server", "-c", "nats.conf", "-a", "127.0.0.1", "-p", str(port)]
        with open(folder / "log", "w") as log:
            hub = subprocess.Popen(command, cwd=folder, stdout=log, stderr=log)
        self.addCleanup(hub.wait)
        self.addCleanup(hub.kill)
        end = time.monotonic() + PATIENCE
        while "ready" not in (folder / "log").read_text():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        tried = dermis("fleet", "list", f"nats://127.0.0.1:{port}")
        if "of a build with DERMIS_BUILD_NATS" in tried.stderr:
            self.skipTest(tried.stderr)
        self.assertIn("does not know this user", tried.stderr)
        return port

    def publish(self, hub, environment=None):
        """A robot that publishes, until some frames are on the hub."""
        robot = ("--publish", hub, "--robot", "anna")
        record = ("--record", self.work / "robot.mcap", "--port", 0)
        process = self.start("serve", "--from", LIVE, "--model", self.model, *record, *robot, environment=environment)
        self.await_line(process, r"serving small at")
        end = time.monotonic() + PATIENCE
        while "anna" not in dermis("fleet", "list", hub, env=os.environ | (environment or {})).stdout:
            self.assertLess(time.monotonic(), end, process.said.read_text())
        return process

    def use(self, hub, environment=None):
        """Every command that asks a hub, and what they said."""
        array = f"{hub}{'&' if '?' in hub else '?'}robot=anna&array=small"
        whole = f"{array}&from=1&to=last"
        commands = [
            ("fleet", "list", hub),
            ("fleet", "history", hub),
            ("fleet", "models", hub),
            ("fleet", "push", hub, self.model, "--for", "anna/small"),
            ("fleet", "watch", hub, "--once"),
            ("record", "--from", whole, "--out", self.work / "heard.mcap", "--force"),
            ("record", "--from", array, "--out", self.work / "live.h5", "--frames", 20, "--force"),
            ("run", "--in", whole, "--model", self.model, "--out", self.work / "forces.csv", "--force"),
            ("doctor", "--in", whole, "--array", self.array),
            ("evaluate", "--frames", array, "--model", self.model, "--loads", self.contacts / "loads.csv"),
        ]
        said = ""
        for command in commands:
            result = dermis(*command, cwd=self.work, env=os.environ | (environment or {}))
            said += result.stdout + result.stderr
            if command[0] not in ("evaluate", "doctor") and "watch" not in command:
                self.assertEqual(result.returncode, 0, f"{command}: {result.stderr}")
        return said

    def show(self, hub, environment=None):
        """What the page of the fleet tells."""
        page = self.start("fleet", "page", hub, "--port", 0, environment=environment)
        address = self.await_line(page, r"at (http://127.0.0.1:\d+/)")[1]
        told = [get(address), get(address + "fleet.json"), get(address + "history.json")]
        self.assertIn(b"anna", told[1])
        told.append(command_line_of(page.pid))
        self.end(page)
        return told

    def check(self, hub, environment=None, others=()):
        """`others`: hubs and environments that give the same, too."""
        robot = self.publish(hub, environment)
        said = "".join(self.use(*one) for one in ((hub, environment), *others))
        told = self.show(hub, environment)
        told.append(command_line_of(robot.pid))
        self.end(robot)
        self.assert_nothing_shows(PASSWORD, said, *told)
        return said

    def test_a_password_is_taken_from_a_file_the_environment_and_systemd(self):
        hub = f"nats://anna@127.0.0.1:{self.begin_hub()}"
        ways = [
            (hub + (f"?password-file={file}" if file else ""), environment)
            for environment, file in self.ways(PASSWORD, "DERMIS_HUB_PASSWORD", "hub-password")
        ]
        self.assertNotIn("could see it", self.check(*ways[0], ways[1:]))

    def test_a_password_of_the_command_line_is_hidden_and_told_once(self):
        said = self.check(f"nats://anna:{PASSWORD}@127.0.0.1:{self.begin_hub()}")
        self.assertIn("the password in an address: others could see it in ps", said)

    def test_a_token_of_a_hub_is_no_user(self):
        port = self.begin_hub(f'token: "{PASSWORD}"')
        hub = f"127.0.0.1:{port}"
        others = [(f"nats://{hub}", {"DERMIS_HUB_PASSWORD": PASSWORD})]
        self.assertIn("others could see it in ps", self.check(f"nats://{PASSWORD}@{hub}", others=others))

    def test_what_cannot_be_opened_shows_nothing(self):
        port = self.begin_hub()
        wrong = f"nats://anna:{PASSWORD}-not@127.0.0.1:{port}"
        for hub in (
            wrong,
            f"{wrong}?robt=anna",
            f"nats://anna:{PASSWORD}@127.0.0.1:1",
            f"tls://{PASSWORD}@127.0.0.1:1",
        ):
            array = f"{hub}{'&' if '?' in hub else '?'}robot=anna&array=small"
            for command in (
                ("fleet", "list", hub),
                ("fleet", "lst", hub),
                ("record", "--from", array, "--out", self.work / "x.mcap"),
                ("run", "--in", array, "--model", self.work / "none", "--out", self.work / "x.csv"),
                ("doctor", "--in", array, "--array", self.array),
                ("serve", "--from", LIVE, "--model", self.model, "--port", 0, "--publish", hub, "--robot", "a b"),
                ("convert", array, self.work / "x.csv"),
                ("info", array),
            ):
                result = dermis(*command, cwd=self.work)
                self.assertIn(result.returncode, (1, 2), f"{command}: {result.stderr}")
                self.assert_nothing_shows(PASSWORD, result.stderr, result.stdout)

    def test_a_password_in_a_file_that_is_kept_is_refused(self):
        suit = self.written(
            "suit.toml",
            f'[suit]\nname = "s"\n[[array]]\nname = "a"\nmodel = "{self.model}"\n'
            f'from = "nats://anna:{PASSWORD}@127.0.0.1:1?robot=anna&array=small"\n',
        )
        result = dermis("serve", "--suit", suit, "--port", 0)
        self.assertEqual(result.returncode, 2)
        self.assertIn("DERMIS_HUB_PASSWORD or password-file=FILE", result.stderr)
        suit.unlink()
        self.assert_nothing_shows(PASSWORD, result.stderr)

    def test_two_hubs_have_a_password_each_in_a_file(self):
        hubs = [f"nats://a:{PASSWORD}{k}@127.0.0.1:1?robot=r&array=a" for k in range(2)]
        result = dermis("serve", "--from", hubs[0], "--model", self.model, "--publish", hubs[1], "--robot", "r")
        self.assertEqual(result.returncode, 2)
        self.assertIn("password-file=FILE", result.stderr)
        self.assert_nothing_shows(PASSWORD, result.stderr)


if __name__ == "__main__":
    support.main()
