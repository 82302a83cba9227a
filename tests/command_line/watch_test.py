# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis watch`: threats as lines and as an exit status, and a program that is stopped by them."""

import json
import signal
import subprocess
from pathlib import Path

import support
from support import SmallArray, dermis, error_lines

PUSHED = """[[threat]]
name = "pushed"
quantity = "taxel_force"
limit_n = {newtons}
"""


LIVE = "sim:multitouch?rate=200&seed=2"  # the array of the model, as a device


def runs(pid):
    """A process that has ended may wait for its parent (a zombie)."""
    try:
        return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except FileNotFoundError:
        return False


class Watch(SmallArray):
    def watch(self, newtons, *options, source=None, **keywords):
        threats = self.written("threats.toml", PUSHED.format(newtons=newtons))
        return dermis(
            "watch",
            "--threats",
            threats,
            "--model",
            self.model,
            "--in",
            source or self.contacts / "frames.csv",
            *options,
            **keywords,
        )

    def test_a_file_is_read_to_its_end(self):
        result = self.watch(30)
        self.assertEqual((result.returncode, result.stderr), (3, ""))
        begins = [line for line in result.stdout.splitlines() if "pushed begins: taxel force" in line]
        self.assertGreater(len(begins), 10)
        self.assertIn("N, limit 30, at x ", begins[0])

    def test_nothing_is_said_where_nothing_is_crossed(self):
        result = self.watch(1000)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_json_lines_tell_what_began_where(self):
        lines = [json.loads(line) for line in self.watch(30, "--json").stdout.splitlines()]
        self.assertEqual({line["event"] for line in lines}, {"begins", "ends"})
        first = lines[0]
        self.assertEqual(
            (first["threat"], first["quantity"], first["unit"], first["limit"]), ("pushed", "taxel_force", "N", 30.0)
        )
        self.assertGreater(first["value"] - 2 * first["sigma"], 30.0)
        self.assertEqual(first["crossed_ns"], first["time_ns"])

    def test_a_threat_stops_the_program_and_what_it_has_started(self):
        place = self.work / "pid"
        late = "sim:contacts?rate=50&rows=4&cols=5&seed=3"  # unloaded at first
        result = self.watch(1, "--", "sh", "-c", f"echo works; sleep 60 & echo $! > {place}; wait", source=late)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("works", result.stdout)
        self.assertIn("pushed begins", result.stdout)
        self.assertFalse(runs(place.read_text().strip()))

    def test_the_watch_ends_with_its_program(self):
        for status in (0, 7):
            result = self.watch(1000, "--", "sh", "-c", f"exit {status}", source=LIVE)
            self.assertEqual(result.returncode, status, result.stderr)

    def test_a_source_that_ends_ends_the_program(self):
        result = self.watch(1000, "--", "sleep", "60", source="sim:multitouch?frames=3000")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(error_lines(result), ["dermis: the source has ended: nothing is watched any more"])

    def test_what_cannot_be_watched_is_refused(self):
        threats = self.written("threats.toml", PUSHED.format(newtons=1000))
        arguments = ["watch", "--threats", threats, "--model", self.model, "--in"]
        frames = self.contacts / "frames.csv"
        self.refuse([*arguments, frames, "--", "true"], ["device alone"])
        self.refuse([*arguments, LIVE, "--", "no-such-program"], ["no-such-program", "No such file"])
        elsewhere = self.written(
            "elsewhere.toml",
            PUSHED.format(newtons=30) + 'zone = "z"\n[[zone]]\nname = "z"\n'
            'array = "arm"\nrows = [0, 1]\ncols = [0, 1]\n',
        )
        self.refuse(
            ["watch", "--threats", elsewhere, "--model", self.model, "--in", frames],
            ["elsewhere.toml", "no threat is for 'small'"],
        )


class Silence(SmallArray):
    def start(self, *arguments):
        process = subprocess.Popen(
            [support.BINARY, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_frames_that_stay_away_stop_the_program(self):
        threats = self.written("threats.toml", PUSHED.format(newtons=1000))
        device = self.start(
            "emulate",
            "--protocol",
            "dermis",
            "--in",
            "sim:multitouch?rate=200&rows=4&cols=5",
            "--to",
            "tcp-listen://127.0.0.1:0",
        )
        place = device.stdout.readline().strip()
        watch = self.start(
            "watch",
            "--threats",
            threats,
            "--model",
            self.model,
            "--in",
            f"tcp://{place}?protocol=dermis",
            "--",
            "sh",
            "-c",
            "echo works; exec sleep 60",
        )
        self.assertEqual(watch.stdout.readline(), "works\n")
        device.send_signal(signal.SIGSTOP)
        _, says = watch.communicate(timeout=60)
        self.assertEqual(watch.returncode, 1, says)
        self.assertIn("no frame with forces for 1 s", says)


if __name__ == "__main__":
    support.main()
