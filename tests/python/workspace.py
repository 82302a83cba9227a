# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A calibrated array in a folder that goes when the test ends."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DERMIS = sys.argv[1]
ARRAY = """[array]
name = "pad"
rows = 5
cols = 4
pitch_mm = [10.0, 12.0]
taxel_area_mm2 = 60.0

[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
"""


def dermis(*arguments):
    environment = {
        name: value for name, value in os.environ.items() if name != "LD_PRELOAD"
    }  # of the sanitizers: it has them
    return subprocess.run(
        [DERMIS, *map(str, arguments)], check=True, capture_output=True, text=True, env=environment
    ).stdout


class CalibratedArray(unittest.TestCase):
    """folder/array.toml; folder/calibration and folder/multitouch of the simulator; folder/pad.safetensors."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.array = cls.folder / "array.toml"
        cls.array.write_text(ARRAY)
        for scene, more in (("calibration", ()), ("multitouch", ("--frames", "60"))):
            dermis("simulate", "--array", cls.array, "--scene", scene, "--out", cls.folder / scene, "--seed", 3, *more)
        cls.model = cls.folder / "pad.safetensors"
        cls.frames = cls.folder / "multitouch/frames.csv"
        cls.loads = cls.folder / "multitouch/loads.csv"
        dermis(
            "calibrate",
            "--array",
            cls.array,
            "--frames",
            cls.folder / "calibration/frames.csv",
            "--loads",
            cls.folder / "calibration/loads.csv",
            "--out",
            cls.model,
        )

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()


def main():
    unittest.main(argv=sys.argv[:1])
