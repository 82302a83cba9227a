# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis evaluate --leave-out press: each press is judged by the calibration of all others."""

import csv
import json
import tempfile
from pathlib import Path

import support
from support import ARRAY, SmallArray, dermis


def lines_of(path):
    return path.read_text().splitlines(keepends=True)


class LeaveOut(SmallArray):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        root = Path(folder.name)
        cls.array = root / "array.toml"
        cls.array.write_text(ARRAY)
        cls.touches = root / "touches"
        scene = ("--scene", "touches", "--rate", 10, "--frames", 400)
        dermis("simulate", "--array", cls.array, *scene, "--out", cls.touches).check_returncode()
        cls.frames = lines_of(cls.touches / "frames.csv")
        cls.loads = lines_of(cls.touches / "loads.csv")

    def files(self, **replaced):
        files = {"array": self.array, "frames": self.touches / "frames.csv", "loads": self.touches / "loads.csv"}
        return [part for name, path in (files | replaced).items() if path for part in (f"--{name}", path)]

    def leave_out(self, *options, **replaced):
        return ("evaluate", "--leave-out", "press", *self.files(**replaced), *options)

    def loads_where(self, number_of):
        """loads.csv with another number of each frame; without those that get None."""
        rows = [line.split(",", 1) for line in self.loads[1:]]
        numbered = [(number_of(int(frame)), rest) for frame, rest in rows]
        kept = [f"{frame},{rest}" for frame, rest in numbered if frame is not None]
        return self.written("loads.csv", "".join(self.loads[:1] + kept))

    def forces_without(self, first, count):
        """What the calibration of all other frames makes of these."""
        head, *frames = self.frames
        seen = self.written("seen.csv", "".join([head, *frames[:first], *frames[first + count :]]))
        unseen = self.written("unseen.csv", "".join([head, *frames[first : first + count]]))
        loads = self.loads_where(lambda k: k if k < first else k - count if k >= first + count else None)
        model, forces = self.work / "model.safetensors", self.work / "unseen_forces.csv"
        self.succeed("calibrate", *self.files(frames=seen, loads=loads), "--out", model)
        self.succeed("run", "--model", model, "--in", unseen, "--out", forces)
        return lines_of(forces)[1:]

    def test_a_press_is_judged_by_a_calibration_without_it(self):
        out = self.work / "forces.csv"
        result = json.loads(self.succeed(*self.leave_out("--out", out, "--json")))
        presses = result["presses"]
        self.assertEqual(len(presses), 3)
        self.assertEqual(sum(press["frames"] for press in presses), 400)
        middle = presses[1]
        first, count = middle["first_frame"], middle["frames"]
        self.assertEqual(lines_of(out)[1 + first : 1 + first + count], self.forces_without(first, count))
        for press in presses:
            self.assertLess(abs(press["estimate_n"] / press["newtons"] - 1), 0.1)

    def test_totals_and_contacts_are_those_of_the_same_calibrations(self):
        totals, contacts = self.work / "totals.csv", self.work / "contacts.csv"
        line = self.succeed(*self.leave_out("--totals", totals, "--contacts", contacts))
        self.assertRegex(line, r"^3 presses, each by a calibration without it: [\d.]+ N RMSE, median [\d.]+ %, worst ")
        with totals.open(newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 400)
        self.assertGreater(len(lines_of(contacts)), 100)

    def test_one_press_cannot_be_left_out(self):
        loads = self.loads_where(lambda k: k if k < 35 else None)
        self.refuse(self.leave_out("--out", self.work / "forces.csv", loads=loads), ["fewer than two presses"])

    def test_options_that_do_not_fit_are_refused(self):
        model = self.written("model.safetensors", "")
        self.refuse(self.leave_out("--model", model), ["--leave-out", "--model"])
        self.refuse(self.leave_out("--report", self.work / "report"), ["--leave-out", "--report"])
        self.refuse(self.leave_out("--labels", self.touches / "loads.csv"), ["--leave-out", "--labels"])
        self.refuse(self.leave_out("--in", self.touches / "frames.csv"), ["--leave-out", "--in"])
        self.refuse(self.leave_out(array=None), ["--leave-out: needs --array"])
        self.refuse(("evaluate", "--leave-out", "band", *self.files()), ["--leave-out band"])
        self.refuse(("evaluate", *self.files()), ["--array", "--leave-out press"])

    def test_a_table_that_cannot_be_written_is_an_error_before_the_work(self):
        self.refuse(self.leave_out("--out", self.work / "missing/forces.csv"), ["missing/forces.csv"], status=1)


if __name__ == "__main__":
    support.main()
