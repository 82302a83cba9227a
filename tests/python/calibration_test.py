# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Models made in Python are those of the command line."""

import workspace

import dermis


class Calibration(workspace.CalibratedArray):
    def test_calibrating_in_python_gives_the_forces_of_the_command_line(self):
        stages = []
        calibration = self.folder / "calibration"
        recording = dermis.Recording.read(calibration / "frames.csv")
        loads = dermis.read_loads(calibration / "loads.csv", self.array, len(recording))
        model, report = dermis.calibrate(
            self.array, recording, loads, progress=lambda stage, share: stages.append(stage)
        )
        self.assertTrue(stages)
        self.assertEqual(report.frames, len({load.frame for load in loads}))
        model.write(self.folder / "python.safetensors")
        judged = [
            dermis.evaluate(dermis.read_model(path), self.frames, self.loads)
            for path in (self.model, self.folder / "python.safetensors")
        ]
        self.assertEqual(judged[0], judged[1])
        self.assertLess(judged[0]["estimators"][0]["median_relative_error"], 0.02)

    def test_loads_are_checked_against_the_array_and_the_recording(self):
        recording = dermis.Recording.read(self.folder / "calibration/frames.csv")
        for load, text in (
            (dermis.Load(10**9, (0, 0), newtons=1.0), "names frame 1000000000"),
            (dermis.Load(0, (9, 0), newtons=1.0), "no such taxels"),
        ):
            with self.assertRaisesRegex(ValueError, text):
                dermis.calibrate(self.array, recording, [load])
        for wrong in ({}, {"newtons": 1.0, "pascals": 1.0}, {"newtons": -1.0}, {"newtons": float("nan")}):
            with self.assertRaises(ValueError):
                dermis.Load(0, (0, 0), **wrong)

    def test_what_the_progress_raises_is_raised(self):
        def progress(stage, share):
            raise KeyError(stage)

        with self.assertRaises(KeyError):
            dermis.calibrate(
                self.array,
                self.folder / "calibration/frames.csv",
                self.folder / "calibration/loads.csv",
                progress=progress,
            )


if __name__ == "__main__":
    workspace.main()
