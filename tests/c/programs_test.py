# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Programs of C99 get the forces of the command line, linked to libdermis_c or loading it."""

import csv
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DERMIS, FORCES, BY_DLOPEN, LIBRARY = sys.argv[1:5]
ARRAY = """[array]
name = "pad"
rows = 4
cols = 3

[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
"""


def run(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def bits(text):
    return struct.pack("f", float(text) if text else float("nan"))


class Programs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = cls.folder = Path(cls.temporary.name)
        (folder / "array.toml").write_text(ARRAY)
        for scene, more in (("calibration", ()), ("multitouch", ("--frames", 50))):
            run(DERMIS, "simulate", "--array", folder / "array.toml", "--scene", scene, "--out", folder / scene, *more)
        cls.model, cls.frames = folder / "pad.safetensors", folder / "multitouch/frames.csv"
        run(
            DERMIS,
            "calibrate",
            "--array",
            folder / "array.toml",
            "--frames",
            folder / "calibration/frames.csv",
            "--loads",
            folder / "calibration/loads.csv",
            "--out",
            cls.model,
        )

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_the_example_prints_the_forces_of_the_command_line(self):
        run(DERMIS, "run", "--model", self.model, "--in", self.frames, "--out", self.folder / "forces.csv")
        with open(self.folder / "forces.csv") as file:
            expected = [[bits(cell) for cell in row[2:]] for row in list(csv.reader(file))[1:]]
        printed = [
            [bits(cell) for cell in line.split(",")] for line in run(FORCES, self.model, self.frames).splitlines()
        ]
        self.assertEqual(len(printed), 50)
        self.assertEqual(printed, expected)

    def test_errors_are_one_line(self):
        wrong = subprocess.run([FORCES, "/nothing", self.frames], capture_output=True, text=True)
        self.assertEqual(wrong.returncode, 1)
        self.assertRegex(wrong.stderr, r"^model: .*/nothing.*\n$")

    def test_the_library_can_be_loaded_and_takes_wrong_arguments(self):
        run(BY_DLOPEN, LIBRARY, self.model, self.frames)

    def test_the_symbols_are_the_functions_of_the_header(self):
        names = {line.split()[-1] for line in run("nm", "-D", "--defined-only", LIBRARY).splitlines()}
        header = (Path(__file__).parents[2] / "bindings/c/dermis.h").read_text()
        declared = set(re.findall(r"^[a-z][\w *]*?[ *](dermis_\w+)\(", header, flags=re.MULTILINE))
        self.assertEqual(names - {"DERMIS_0.1"}, {f"{name}@@DERMIS_0.1" for name in declared})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
