# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Runs the binary named on the command line on a small simulated array."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

# A shell makes what it starts in the background ignore SIGINT; what is started from here is to heed it.
signal.signal(signal.SIGINT, signal.default_int_handler)

BINARY = None
NOBODY = 65534
REPLACED = re.compile(r"'.+' (exists and will be replaced|as it was: '.+')")
WHERE = re.compile(r"\d+ frames?(, \d+ skipped)?: (forces|sigmas|totals|contacts) in .+")  # of run
PROGRESS = re.compile(r"(.+, )?\w+: \d+ %(, \d+ s left)?")  # "chest, networks: 25 %, 3 s left"

ARRAY = """[array]
name = "small"
rows = 4
cols = 5
taxel_area_mm2 = 38.48

[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
"""


def dermis(*arguments, prefix=(), **options):
    """Runs the binary; `prefix` is a command that runs it, such as taskset."""
    command = [*prefix, BINARY, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, **options)


def binary_without(plugin, folder):
    """A copy of the binary that looks for another plugin, libdermis_no.so, in the place of this one."""
    content, name = Path(BINARY).read_bytes(), plugin.encode()
    assert name in content
    binary = Path(folder) / "dermis"
    binary.write_bytes(content.replace(name, b"libdermis_no.so".ljust(len(name), b"\0")))
    binary.chmod(0o755)
    return binary


def files_limited_to(size):
    """Options of dermis() under which no file can grow beyond `size` bytes."""
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))}


def as_nobody(test):
    """Options of dermis() with which a user without rights runs a copy of the binary: the folders above the binary may
    be closed to others. Skips the test where that cannot be."""
    if os.geteuid() != 0:
        test.skipTest("only root can become somebody else")
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    os.chmod(folder.name, 0o755)
    options = {"executable": shutil.copy(BINARY, folder.name), "user": NOBODY, "group": NOBODY, "extra_groups": []}
    try:
        dermis("--version", **options).check_returncode()
    except (OSError, subprocess.CalledProcessError) as error:
        test.skipTest(f"nobody may not run a copy of the binary: {error}")
    return options


def error_lines(result):
    """What stderr says besides the progress of long work, the files that were replaced, and where frames went."""
    usual = (PROGRESS, REPLACED, WHERE)
    return [line for line in result.stderr.splitlines() if not any(kind.fullmatch(line) for kind in usual)]


def files_below(folder):
    return {str(path.relative_to(folder)) for path in Path(folder).rglob("*")}


class SmallArray(unittest.TestCase):
    """A 4x5 array with a calibration, a model and 200 frames of several contacts, made once for all tests of a class;
    `work` is an empty folder for each test."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name)
        cls.array = cls.root / "array.toml"
        cls.array.write_text(ARRAY)
        cls.calibration = cls.root / "calibration"
        cls.contacts = cls.root / "contacts"
        cls.model = cls.root / "model.safetensors"
        for step in (
            ("simulate", "--array", cls.array, "--scene", "calibration", "--out", cls.calibration),
            (
                "simulate",
                "--array",
                cls.array,
                "--scene",
                "multitouch",
                "--frames",
                200,
                "--seed",
                2,
                "--out",
                cls.contacts,
            ),
            cls.calibrate_arguments(cls.model),
        ):
            result = dermis(*step)
            if result.returncode != 0:
                raise AssertionError(f"{step}: {result.stderr}")

    @classmethod
    def calibrate_arguments(cls, out, **replaced):
        files = {"array": cls.array, "frames": cls.calibration / "frames.csv", "loads": cls.calibration / "loads.csv"}
        files.update(replaced)
        return (
            "calibrate",
            "--array",
            files["array"],
            "--frames",
            files["frames"],
            "--loads",
            files["loads"],
            "--out",
            out,
        )

    @classmethod
    def run_arguments(cls, out, **replaced):
        files = {"model": cls.model, "in": cls.contacts / "frames.csv"}
        files.update(replaced)
        return ("run", "--model", files["model"], "--in", files["in"], "--out", out)

    @classmethod
    def evaluate_arguments(cls, **replaced):
        files = {"model": cls.model, "frames": cls.contacts / "frames.csv", "loads": cls.contacts / "loads.csv"}
        files.update(replaced)
        return ("evaluate", "--model", files["model"], "--frames", files["frames"], "--loads", files["loads"])

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def succeed(self, *arguments, **options):
        result = dermis(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(error_lines(result), [])
        return result.stdout

    def refuse(self, arguments, places, status=2, **options):
        """The command ends with `status` and one line on stderr that holds all of `places`, and leaves no new file in
        the working folder."""
        before = files_below(self.work)
        result = dermis(*arguments, **options)
        self.assertEqual(result.returncode, status, result.stderr)
        lines = error_lines(result)
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("dermis: "), lines[0])
        for place in places:
            self.assertIn(str(place), lines[0])
        self.assertEqual(result.stdout, "")
        self.assertEqual(files_below(self.work), before)

    def written(self, name, text):
        path = self.work / name
        path.write_text(text)
        return path


def main():
    global BINARY
    BINARY = sys.argv.pop(1)
    unittest.main(module="__main__")
