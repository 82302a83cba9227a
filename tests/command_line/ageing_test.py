# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis doctor check` and `dermis doctor recalibrate` on a sheet that has aged in the simulator."""

import shutil

import support
from support import SmallArray, dermis


class Ageing(SmallArray):
    def weights(self, gain, name):
        """Weights of 5, 15 and 5 N on four taxels of a sheet with that gain, twice."""
        physics = self.written("physics.toml", f"[rubber]\ngain = {gain}\n")
        out = self.work / name
        self.succeed(
            "simulate",
            "--array",
            self.array,
            "--scene",
            "two_weights",
            "--rate",
            10,
            "--seed",
            3,
            "--physics",
            physics,
            "--out",
            out,
        )
        return out

    def weigh(self, folder, weight=15):
        return dermis("doctor", "check", "--model", self.model, "--in", folder / "frames.csv", "--weight", weight)

    def test_a_healthy_sheet_is_well(self):
        result = self.weigh(self.weights(1.0, "fresh"))
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertIn("well: reads", result.stdout)

    def test_gains_that_have_changed_are_mended_by_known_weights_and_the_old_model_stays(self):
        aged = self.weights(1.1, "aged")
        before = self.weigh(aged)
        self.assertEqual(before.returncode, 3, before.stdout + before.stderr)
        self.assertRegex(before.stdout, r"recalibrate: gains have changed by about (9|10|11) % .*: it reads too much")
        model = self.work / "model.safetensors"
        shutil.copy(self.model, model)
        options = (
            "doctor",
            "recalibrate",
            "--model",
            model,
            "--frames",
            aged / "frames.csv",
            "--loads",
            aged / "loads.csv",
        )
        result = dermis(*options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"the sheet read (9|10)\.\d % too much")
        [kept] = self.work.glob("model-before-*.safetensors")
        self.assertRegex(kept.name, r"^model-before-\d{8}-\d{6}\.safetensors$")
        self.assertIn(f"'{model}' as it was: '{kept}'\n", result.stderr)
        self.assertEqual(kept.read_bytes(), self.model.read_bytes())
        after = dermis("doctor", "check", "--model", model, "--in", aged / "frames.csv", "--weight", 15)
        self.assertEqual(after.returncode, 0, after.stdout + after.stderr)
        mended = model.read_bytes()
        self.succeed(*options)
        earlier = {path.read_bytes() for path in self.work.glob("model-before-*.safetensors")}
        self.assertEqual(earlier, {self.model.read_bytes(), mended})

    def test_a_new_model_may_have_another_place(self):
        aged = self.weights(0.9, "aged")
        fresh = self.work / "new.safetensors"
        before = self.model.read_bytes()
        self.succeed(
            "doctor",
            "recalibrate",
            "--model",
            self.model,
            "--frames",
            aged / "frames.csv",
            "--loads",
            aged / "loads.csv",
            "--out",
            fresh,
        )
        self.assertEqual(self.model.read_bytes(), before)
        self.assertTrue(fresh.exists())

    def test_what_cannot_be_weighed_is_told(self):
        frames = self.calibration / "frames.csv"
        check = ("doctor", "check", "--model", self.model, "--in", frames)
        self.refuse((*check, "--weight", 0), ["--weight", "above 0"])
        self.refuse((*check, "--weight", "nan"), ["--weight"])
        self.refuse(check, ["--weight"])
        self.refuse((*check, "--weight", 1e5), [frames, "no press"], status=1)
        unloaded = self.written("unloaded.csv", "frame,kind,where,value\n0,force,all,0\n")
        self.refuse(
            (
                "doctor",
                "recalibrate",
                "--model",
                self.model,
                "--frames",
                frames,
                "--loads",
                unloaded,
                "--out",
                self.work / "new.safetensors",
            ),
            [unloaded, "a known weight is needed"],
        )
        self.refuse(
            ("doctor", "recalibrate", "--model", self.array, "--frames", frames, "--loads", unloaded),
            [self.array, "is no model"],
        )


if __name__ == "__main__":
    support.main()
