# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Every example of examples/python does what it says."""

import os
import re
import runpy
import subprocess
import sys
import unittest.mock

import numpy as np
import workspace

import dermis

EXAMPLES = workspace.Path(__file__).parents[2] / "examples/python"


class Examples(workspace.CalibratedArray):
    def run_example(self, name, *arguments):
        run = subprocess.run(
            [sys.executable, EXAMPLES / name, *map(str, arguments)],
            capture_output=True,
            text=True,
            env=os.environ,
            timeout=120,
        )
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout

    def uri(self):
        return f"sim:contacts?rate=100&array={self.array}"

    def test_each_example_says_what_it_takes(self):
        for example in EXAMPLES.glob("*.py"):
            with self.subTest(example.name):
                said = self.run_example(example.name, "--help")
                self.assertIn("usage: " + example.name, said)
                self.assertIn(example.read_text().split('"""')[1].splitlines()[0], said)

    def test_live_view(self):
        self.assertRegex(self.run_example("live_view.py", self.uri(), self.model, 3), r"\d+: \d+\.\d N")

    def test_robot_sensor(self):
        self.assertRegex(self.run_example("robot_sensor.py", self.uri(), self.model), r"\(5, 4\)} \d+\.\d\d N")

    def test_grasp(self):
        said = self.run_example("grasp.py", self.model)
        closed, held = map(float, re.match(r"closed to ([\d.]+) mm; held ([\d.]+) N", said).groups())
        self.assertAlmostEqual(held, 2.0, delta=0.2)
        self.assertAlmostEqual(40 - closed, 2.0 / 0.8, delta=1.0)  # by the stiffness of the object

    def test_grasp_ends_where_the_pad_never_reads_the_force(self):
        grasp = runpy.run_path(str(EXAMPLES / "grasp.py"))
        names = grasp["main"].__globals__
        names["LONGEST_S"] = 0.3
        with self.assertRaisesRegex(SystemExit, r"^grasp.py: the pad has not held 1e\+06 N within 0.3 s; it reads"):
            grasp["main"](self.model, 1e6, 0.1)
        model = dermis.read_model(self.model)
        gripper = grasp["Gripper"](model)
        blind = unittest.mock.Mock()
        blind.process.return_value.total = float("nan")
        with unittest.mock.patch.object(dermis, "Pipeline", return_value=blind), self.assertRaises(TimeoutError):
            grasp["grasp"](gripper, model, 2.0, 0.1)
        self.assertEqual(gripper.opening_mm, grasp["WIDTH_MM"] + 15, "it does not move")

    def test_train_on_touch(self):
        said = self.run_example("train_on_touch.py", self.model, self.frames, self.frames, "--seconds", 0.5)
        self.assertRegex(said, r"steps of 2 episodes, [1-9]\d* batches")

    def test_imitation_dataset(self):
        joints = self.folder / "joints.csv"
        joints.write_text("time_s,shoulder,elbow\n0,0,1\n100,50,1\n")
        for name in ("session.npz", "session.h5"):
            self.run_example("imitation_dataset.py", self.frames, self.model, joints, self.folder / name)
        dataset = np.load(self.folder / "session.npz")
        recording = dermis.Recording.read(self.frames)
        np.testing.assert_array_equal(
            dataset["newtons"], dermis.Pipeline(dermis.read_model(self.model)).run(recording).newtons
        )
        np.testing.assert_allclose(dataset["joint_angles"][:, 0], np.minimum(recording.time_ns * 0.5e-9, 50), rtol=1e-6)
        self.assertGreater(dataset["contacts"]["force_n"].max(), 1.0)
        import h5py

        with h5py.File(self.folder / "session.h5") as file:
            np.testing.assert_array_equal(file["newtons"][()], dataset["newtons"])

    def test_calibrate_array(self):
        names = {
            "frames.csv": "calibration/frames.csv",
            "loads.csv": "calibration/loads.csv",
            "test.csv": "multitouch/frames.csv",
            "test_loads.csv": "multitouch/loads.csv",
        }
        for name, source in names.items():
            (self.folder / name).write_bytes((self.folder / source).read_bytes())
        said = self.run_example("calibrate_array.py", self.folder)
        self.assertIn("of them labelled", said)
        self.assertRegex(said, r"dermis: median error \d+\.\d\d%")


if __name__ == "__main__":
    workspace.main()
