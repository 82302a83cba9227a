# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Workers do jobs, and one of them is killed: work_test.py DERMIS"""

import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

DERMIS = sys.argv.pop(1)
JOBS = 30
MOST_SECONDS = 120
ARRAY = Path(__file__).resolve().parents[3] / "examples/chest/array.toml"


def dermis(folder, *arguments):
    return subprocess.run([DERMIS, *arguments], cwd=folder, capture_output=True, text=True, check=False)


@unittest.skipIf(shutil.which("nats-server") is None, "nats-server is not installed")
class Work(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = Path(made.name)
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            port = listener.getsockname()[1]
        self.hub = f"nats://127.0.0.1:{port}"
        server = ["nats-server", "-a", "127.0.0.1", "-p", str(port), "-js", "-sd", "store"]
        self.start(server)
        while dermis(self.folder, "fleet", "jobs", self.hub).returncode != 0:
            time.sleep(0.1)
        source = "sim:multitouch?rows=4&cols=4&frames=200"
        self.assertEqual(dermis(self.folder, "record", "--from", source, "--out", "a.mcap").returncode, 0)

    def start(self, command):
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def submit(self, jobs):
        text = "".join(f"[[job]]\nwords = {list(words)}\n".replace("'", '"') for words in jobs)
        (self.folder / "jobs.toml").write_text(text)
        return dermis(self.folder, "fleet", "submit", self.hub, "jobs.toml")

    def wait_for(self, line):
        end = time.monotonic() + MOST_SECONDS
        while not (printed := dermis(self.folder, "fleet", "jobs", self.hub).stdout).startswith(line):
            self.assertLess(time.monotonic(), end, printed)
            time.sleep(0.2)
        return printed

    def test_each_output_is_there_once_and_whole_though_a_worker_is_killed(self):
        self.assertEqual(self.submit(("convert", "a.mcap", f"{k}.csv") for k in range(JOBS)).returncode, 0)
        workers = [self.start([DERMIS, "work", self.hub]) for _ in range(2)]
        time.sleep(0.3)
        workers[0].kill()
        self.wait_for(f"waiting 0, taken 0, done {JOBS}, given up 0")
        self.assertEqual(dermis(self.folder, "convert", "a.mcap", "expected.csv").returncode, 0)
        expected = (self.folder / "expected.csv").read_bytes()
        for k in range(JOBS):
            self.assertEqual((self.folder / f"{k}.csv").read_bytes(), expected)

    def test_a_job_of_a_range_of_a_stream_has_the_frames_of_the_robot(self):
        served = ["--from", "sim:contacts?rate=200", "--model", ARRAY, "--port", "0"]
        robot = self.start([DERMIS, "serve", *served, "--publish", self.hub, "--robot", "anna"])
        stream = "robot=anna&array=chest&from=1&to="
        by_hand = ("convert", f"{self.hub}?{stream}last", "expected.csv")
        end = time.monotonic() + MOST_SECONDS
        while dermis(self.folder, *by_hand).returncode != 0:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.2)
        robot.terminate()
        robot.wait()
        self.assertEqual(dermis(self.folder, *by_hand, "--force").returncode, 0)
        self.assertEqual(self.submit([("convert", f"nats://?{stream}last", "range.csv")]).returncode, 0)
        self.start([DERMIS, "work", self.hub])
        self.wait_for("waiting 0, taken 0, done 1, given up 0")
        self.assertEqual((self.folder / "range.csv").read_bytes(), (self.folder / "expected.csv").read_bytes())

    def test_a_job_that_fails_is_given_up_and_said(self):
        self.assertEqual(self.submit([("convert", "missing.mcap", "out.csv")]).returncode, 0)
        self.start([DERMIS, "work", self.hub])
        printed = self.wait_for("waiting 0, taken 0, done 0, given up 1")
        self.assertIn("given up: jobs.toml 1: exit status 2", printed)

    def test_no_link_leads_out_of_the_folder(self):
        inner = self.folder / "inner"
        inner.mkdir()
        (self.folder / "a.mcap").rename(inner / "a.mcap")
        (inner / "link").symlink_to(self.folder)
        self.assertEqual(self.submit([("convert", "a.mcap", "link/out.csv")]).returncode, 0)
        self.start([DERMIS, "work", self.hub, "--folder", "inner"])
        self.assertIn("leads out of the folder", self.wait_for("waiting 0, taken 0, done 0, given up 1"))
        self.assertFalse((self.folder / "out.csv").exists())

    def test_a_file_that_is_there_stays(self):
        (self.folder / "out.csv").write_text("mine")
        self.assertEqual(self.submit([("convert", "a.mcap", "out.csv")]).returncode, 0)
        self.start([DERMIS, "work", self.hub])
        self.wait_for("waiting 0, taken 0, done 0, given up 1")
        self.assertEqual((self.folder / "out.csv").read_text(), "mine")

    def test_a_job_is_no_shell(self):
        for words in (("sh", "-c", "touch x"), ("convert", "/etc/passwd", "x.csv"), ("convert", "a.mcap", "../x.csv")):
            refused = self.submit([words])
            self.assertEqual(refused.returncode, 2, words)
            self.assertIn("jobs.toml:2: job[0].words: ", refused.stderr)


if __name__ == "__main__":
    unittest.main()
