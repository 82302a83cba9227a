# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A disk that is full: status 1, one line that names the file, and nothing left behind. A limit on the size of files
stands for the disk, /dev/full for a device that takes nothing.
Usage: full_disk_test.py BINARY [SIZES]
SIZES is how many sizes of the disk a recording meets; 200 are a campaign."""

import subprocess
import sys

import support
from support import SmallArray, error_lines, files_limited_to

FEW_SIZES = 5
SIZES = FEW_SIZES


class FullDisk(SmallArray):
    def test_run(self):
        for size in (0, 1000, 10000):
            with self.subTest(size):
                self.refuse(self.run_arguments(self.work / "f.csv"), ["f.csv"], status=1, **files_limited_to(size))

    def test_run_keeps_the_file_that_was_there(self):
        out = self.written("f.csv", "what was there\n")
        self.refuse((*self.run_arguments(out), "--force"), ["f.csv"], status=1, **files_limited_to(1000))
        self.assertEqual(out.read_text(), "what was there\n")

    def test_calibrate(self):
        for size in (0, 1000, 10000):
            with self.subTest(size):
                self.refuse(self.calibrate_arguments(self.work / "m"), ["/m"], status=1, **files_limited_to(size))

    def test_simulate(self):
        """Frames without their loads, or loads without their frames, are worth nothing."""
        (self.work / "o").mkdir()
        for size in (0, 500, 3000):
            with self.subTest(size):
                self.refuse(
                    ["simulate", "--array", self.array, "--scene", "paper", "--out", self.work / "o"],
                    [self.work / "o"],
                    status=1,
                    **files_limited_to(size),
                )

    def test_report(self):
        (self.work / "o").mkdir()
        self.refuse(
            [*self.evaluate_arguments(), "--report", self.work / "o"],
            [self.work / "o"],
            status=1,
            **files_limited_to(1000),
        )


class FullDiskOfRecording(SmallArray):
    def record(self, size):
        """Returns the recording, if its beginning has room."""
        out = self.work / "rec.mcap"
        result = support.dermis(
            "record", "--from", "sim:contacts?rate=1000", "--seconds", 5, "--out", out, **files_limited_to(size)
        )
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count(f"dermis: cannot write '{out}'"), 1, result.stderr)
        self.assertEqual([file.name for file in self.work.glob("rec*")], ["rec.mcap"] if out.exists() else [])
        return out if out.exists() else None

    def test_ends_complete(self):
        """With its index, and with all frames up to the last."""
        least, most = 30_000, 230_000
        complete = 0
        for size in range(least, most, (most - least) // SIZES):
            with self.subTest(size):
                recording = self.record(size)
                if recording is None:
                    continue
                self.assertRegex(self.succeed("info", recording), r"lost +0 frames\ncomplete +yes")
                recording.unlink()
                complete += 1
        self.assertGreater(complete, SIZES // 2)


class FullDevice(SmallArray):
    def test_output_files(self):
        self.refuse(self.run_arguments("/dev/full"), ["/dev/full"], status=1)
        self.refuse(self.calibrate_arguments("/dev/full"), ["/dev/full"], status=1)

    def test_standard_output(self):
        for arguments in (
            self.evaluate_arguments(),
            (*self.evaluate_arguments(), "--json"),
            self.calibrate_arguments(self.work / "m"),
        ):
            with self.subTest(arguments[0]), open("/dev/full", "w") as full:
                result = subprocess.run(
                    [support.BINARY, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True
                )
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertEqual(len(error_lines(result)), 1, result.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 2:
        SIZES = int(sys.argv.pop(2))
    support.main()
