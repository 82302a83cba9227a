# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The example of MuJoCo's forces becomes counts, and these become its newtons again. Usage: mujoco_test.py DERMIS"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

DERMIS = sys.argv.pop(1)
EXAMPLE = Path(__file__).resolve().parents[2] / "examples/python/mujoco_field.py"
BALL_N, BOX_N = 0.3 * 9.81, 0.8 * 9.81
ARRAY = """
[array]
name = "sheet"
rows = 8
cols = 8
pitch_mm = [12.5, 12.5]

[readout]
circuit = "divider"
idle_rows = "grounded"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
"""


class Field(unittest.TestCase):
    def test_weights_of_another_simulator_come_back_as_newtons(self):
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "array.toml").write_text(ARRAY)

            def dermis(*command):
                subprocess.run([DERMIS, *command], cwd=place, check=True, capture_output=True)

            subprocess.run([sys.executable, EXAMPLE, place / "forces.npy"], check=True)
            field = numpy.load(place / "forces.npy")
            dermis("simulate", "--array", "array.toml", "--scene", "calibration", "--out", "calibration")
            samples = ["--frames", "calibration/frames.csv", "--loads", "calibration/loads.csv"]
            dermis("calibrate", "--array", "array.toml", *samples, "--out", "model.safetensors")
            dermis("simulate", "--array", "array.toml", "--field", "forces.npy", "--out", "counts")
            dermis("run", "--model", "model.safetensors", "--in", "counts/frames.csv", "--out", "forces.csv")

            newtons = numpy.genfromtxt(place / "forces.csv", delimiter=",", skip_header=1)[:, 2:].reshape(field.shape)
        self.assertAlmostEqual(field[-1].sum(), BALL_N + BOX_N, delta=0.01)
        self.assertAlmostEqual(newtons[-1].sum(), BALL_N + BOX_N, delta=0.1 * (BALL_N + BOX_N))
        apart = numpy.abs(newtons.sum(axis=(1, 2)) - field.sum(axis=(1, 2)))
        self.assertLess(numpy.median(apart), 0.05 * (BALL_N + BOX_N))


if __name__ == "__main__":
    unittest.main()
