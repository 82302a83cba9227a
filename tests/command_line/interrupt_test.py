# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Ctrl-C in work of which a half is worth nothing: status 130, one line, and no file but those that were there."""

import os
import signal
import subprocess
import threading

import support
from support import SmallArray, error_lines, files_below

INTERRUPTED = 128 + signal.SIGINT


class Interrupted(SmallArray):
    def endless(self, name, beginning):
        """A pipe that has this beginning and no end, so that who reads it waits until it is interrupted."""
        path = self.work / name
        os.mkfifo(path)
        is_read = threading.Event()

        def feed():
            pipe = path.open("w")  # when somebody reads
            self.addCleanup(pipe.close)
            pipe.write(beginning)
            pipe.flush()
            is_read.set()

        threading.Thread(target=feed, daemon=True).start()
        return path, is_read

    def interrupt(self, is_busy, *arguments):
        before = files_below(self.work)
        process = subprocess.Popen(
            [support.BINARY, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        is_busy(process)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        self.assertEqual((process.returncode, output), (INTERRUPTED, ""), errors)
        lines = error_lines(subprocess.CompletedProcess([], process.returncode, output, errors))
        self.assertEqual(lines, ["dermis: interrupted; nothing is half-written"])
        self.assertEqual(files_below(self.work), before)

    def test_while_frames_are_read(self):
        beginning = (self.contacts / "frames.csv").read_text()
        labels = self.written("labels.csv", "id,first,last,class\n0,0,4,hand\n1,5,9,foot\n")
        for name, command in (
            ("convert.csv", lambda frames: ("convert", frames, self.work / "out.npy")),
            ("evaluate.csv", lambda frames: self.evaluate_arguments(frames=frames)),
            (
                "learn.csv",
                lambda frames: (
                    "recognise",
                    "learn",
                    "--in",
                    frames,
                    "--labels",
                    labels,
                    "--out",
                    self.work / "classes",
                ),
            ),
            ("calibrate.csv", lambda frames: self.calibrate_arguments(self.work / "m", frames=frames)),
        ):
            with self.subTest(name):
                frames, is_read = self.endless(name, beginning)
                self.interrupt(lambda process, is_read=is_read: is_read.wait(60), *command(frames))

    def test_while_it_calculates(self):
        def has_begun_to_write(process):
            while process.poll() is None and not any(file.stat().st_size for file in self.work.rglob("*.dermis.tmp")):
                pass

        (self.work / "out").mkdir()
        large = self.written(
            "large.toml", support.ARRAY.replace("rows = 4", "rows = 16").replace("cols = 5", "cols = 16")
        )
        self.interrupt(
            has_begun_to_write,
            "simulate",
            "--array",
            large,
            "--scene",
            "multitouch",
            "--frames",
            200000,
            "--out",
            self.work / "out",
        )


if __name__ == "__main__":
    support.main()
