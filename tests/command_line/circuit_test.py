# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis circuit: what a circuit reads, the way back, and advice to who designs one."""

import json
import math
import random
import tempfile
from pathlib import Path

import support
from support import ARRAY, SmallArray, dermis

ROWS, COLS = 4, 5
FLEXITAC = ARRAY.replace('"divider"', '"flexitac"')
AMPLIFIERS = ARRAY.replace('"divider"', '"transimpedance"')
CIRCUITS = {
    "divider": ARRAY,
    "idle rows floating": ARRAY + 'idle_rows = "floating"\n',
    "one load": ARRAY + 'idle_columns = "floating"\n',
    "two terminals": ARRAY + 'idle_rows = "floating"\nidle_columns = "floating"\n',
    "amplifiers": AMPLIFIERS,
    "real amplifiers": AMPLIFIERS + "column_switch_ohm = [1, 2, 3, 4, 5]\namplifier_gain = 1e4\n"
    "amplifier_offset_v = [0.001, -0.001, 0, 0.002, 0.001]\n",
    "real amplifiers, idle rows floating": AMPLIFIERS + 'column_switch_ohm = 5\nidle_rows = "floating"\n',
    "flexitac": FLEXITAC,
    "resistive lines": ARRAY + "row_segment_ohm = [1, 2, 0, 3]\ncolumn_segment_ohm = 2\n",
    "flexitac, resistive lines": FLEXITAC + "row_segment_ohm = 1\n",
}


def table(frames):
    return "\n".join("\n".join(",".join(map(repr, row)) for row in frame) + "\n" for frame in frames)


def numbers(path):
    """All numbers of a file, frame by frame, row by row."""
    return [float(cell) for line in Path(path).read_text().splitlines() if line for cell in line.split(",")]


def random_siemens(seed, frames=3):
    """Taxels of 500 ohm to 1 Mohm."""
    source = random.Random(seed)
    return [
        [[1.0 / math.exp(source.uniform(math.log(500), math.log(1e6))) for _ in range(COLS)] for _ in range(ROWS)]
        for _ in range(frames)
    ]


class Circuit(SmallArray):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name)

    def setUp(self):
        super().setUp()
        self.array = self.written("array.toml", ARRAY)
        self.siemens = self.written("siemens.csv", table(random_siemens(1)))
        self.readings = self.work / "readings.csv"
        self.back = self.work / "back.csv"

    def forward_arguments(self, **replaced):
        files = {"array": self.array, "conductance": self.siemens, "out": self.readings, **replaced}
        return [
            "circuit",
            "forward",
            "--force",
            *(part for name, value in files.items() for part in (f"--{name}", value)),
        ]

    def invert_arguments(self, **replaced):
        files = {"array": self.array, "readings": self.readings, "out": self.back, **replaced}
        return [
            "circuit",
            "invert",
            "--force",
            *(part for name, value in files.items() for part in (f"--{name}", value)),
        ]


class ForwardAndBack(Circuit):
    def test_what_went_forward_comes_back_in_every_circuit(self):
        for name, text in CIRCUITS.items():
            for falling in ("", "pressure_raises_reading = false\n"):
                with self.subTest(name + " " + falling):
                    self.written("array.toml", text + falling)
                    self.assertEqual(self.succeed(*self.forward_arguments()), "")
                    self.assertEqual(self.succeed(*self.invert_arguments(sigma=self.work / "sigma.csv")), "")
                    pairs = list(zip(numbers(self.siemens), numbers(self.back), strict=True))
                    self.assertLess(max(abs(back / siemens - 1.0) for siemens, back in pairs), 1e-8)
                    sigma = numbers(self.work / "sigma.csv")
                    self.assertEqual(len(sigma), len(pairs))
                    self.assertTrue(all(0.0 < value < math.inf for value in sigma))

    def test_one_taxel_is_a_voltage_divider(self):
        array = self.written("one.toml", ARRAY.replace("rows = 4", "rows = 1").replace("cols = 5", "cols = 1"))
        siemens = self.written("one.csv", "siemens of r0c0\n\n0.001\n0.0005\n")
        self.succeed(*self.forward_arguments(array=array, conductance=siemens))
        for reading, ohm in zip(numbers(self.readings), (1000.0, 2000.0), strict=True):
            self.assertAlmostEqual(reading, 200.0 / (20.0 + ohm + 200.0), places=15)

    def test_open_taxels_read_zero_without_a_sign(self):
        self.written("siemens.csv", table([[[0.0] * COLS] * ROWS]))
        self.succeed(*self.forward_arguments())
        self.assertEqual(self.readings.read_text(), ("0," * (COLS - 1) + "0\n") * ROWS)

    def test_frames_keep_their_place(self):
        self.succeed(*self.forward_arguments())
        blocks = self.readings.read_text().split("\n\n")
        self.assertEqual([len(block.strip().splitlines()) for block in blocks], [ROWS] * 3)
        single = self.written("single.csv", table(random_siemens(1)[1:2]))
        self.succeed(*self.forward_arguments(conductance=single, out=self.work / "single_readings.csv"))
        self.assertEqual((self.work / "single_readings.csv").read_text().strip(), blocks[1].strip())

    def test_sigma_is_the_noise_of_the_adc_unless_another_is_given(self):
        self.succeed(*self.forward_arguments())
        outs = {}
        for name, noise in (("default", []), ("adc", ["--noise", 1.0 / 4095.0]), ("twice", ["--noise", 2.0 / 4095.0])):
            outs[name] = self.work / f"{name}.csv"
            self.succeed(*self.invert_arguments(sigma=outs[name]), *noise)
        self.assertEqual(numbers(outs["default"]), numbers(outs["adc"]))
        for once, twice in zip(numbers(outs["adc"]), numbers(outs["twice"]), strict=True):
            self.assertAlmostEqual(twice / once, 2.0, places=12)

    def test_sigma_is_the_scatter_of_noisy_readings(self):
        self.written("siemens.csv", table(random_siemens(2, frames=1) * 400))
        self.succeed(*self.forward_arguments())
        source = random.Random(3)
        noise = 1e-6
        noisy = [value + noise * source.gauss(0.0, 1.0) for value in numbers(self.readings)]
        frames = [
            [noisy[(k * ROWS + row) * COLS : (k * ROWS + row + 1) * COLS] for row in range(ROWS)] for k in range(400)
        ]
        self.written("readings.csv", table(frames))
        self.succeed(*self.invert_arguments(sigma=self.work / "sigma.csv"), "--noise", noise)
        siemens, back, sigma = numbers(self.siemens), numbers(self.back), numbers(self.work / "sigma.csv")
        z = [(b - s) / e for s, b, e in zip(siemens, back, sigma, strict=True)]
        self.assertAlmostEqual(math.sqrt(sum(value * value for value in z) / len(z)), 1.0, delta=0.1)

    def test_a_frame_without_a_solution_is_nan_and_said(self):
        self.succeed(*self.forward_arguments())
        lines = self.readings.read_text().splitlines()
        lines[ROWS + 1] = ",".join(["0.9"] * COLS)  # the second frame; a column whose readings exceed the supply
        lines[ROWS + 2] = ",".join(["0.9"] * COLS)
        self.written("readings.csv", "\n".join(lines) + "\n")
        result = dermis(*self.invert_arguments())
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 1)
        for place in (f"{self.readings}:{ROWS + 2}", "1 of 3", self.back):
            self.assertIn(str(place), result.stderr)
        back = numbers(self.back)
        size = ROWS * COLS
        self.assertTrue(all(math.isnan(value) for value in back[size : 2 * size]))
        self.assertFalse(any(math.isnan(value) for value in back[:size] + back[2 * size :]))

    def test_output_to_a_pipe(self):
        piped = self.succeed(*self.forward_arguments(out="/dev/stdout"))
        self.succeed(*self.forward_arguments())
        self.assertEqual(piped, self.readings.read_text())


class Advise(Circuit):
    def advice(self, *more, text=ARRAY):
        self.written("array.toml", text)
        return self.succeed("circuit", "advise", "--array", self.array, "--range", 1000, 100000, *more)

    def test_the_best_load_has_the_least_error(self):
        for name, text in CIRCUITS.items():
            with self.subTest(name):
                advice = json.loads(self.advice("--json", text=text))
                self.assertEqual(
                    set(advice),
                    {"noise_ratio", "best_load_ohm", "best", "present", "ideal_drivers", "most_drive_ohm", "loads"},
                )
                self.assertAlmostEqual(advice["noise_ratio"], 1.0 / 4095.0, places=12)
                means = {
                    entry["load_ohm"]: entry["precision"]["mean"] for entry in advice["loads"] if entry["precision"]
                }
                self.assertEqual(min(means, key=means.get), advice["best_load_ohm"])
                self.assertLessEqual(advice["best"]["mean"], advice["present"]["mean"])
                for precision in (advice["best"], advice["present"], advice["ideal_drivers"]):
                    self.assertTrue(0.0 < precision["median"] <= precision["p95"] <= precision["worst"])

    def test_what_it_recommends_keeps_its_word(self):
        advice = json.loads(self.advice("--json"))
        best = ARRAY.replace("load_ohm = 200.0", f"load_ohm = {advice['best_load_ohm']}")
        again = json.loads(self.advice("--json", text=best))
        self.assertAlmostEqual(again["present"]["mean"] / advice["best"]["mean"], 1.0, places=9)
        weak = best.replace("drive_ohm = 20.0", f"drive_ohm = {advice['most_drive_ohm']}")
        growth = json.loads(self.advice("--json", text=weak))["present"]["mean"] / advice["ideal_drivers"]["mean"]
        self.assertAlmostEqual(growth, 1.1, delta=0.01)

    def test_an_amplifier_takes_the_largest_feedback_that_stays_within_the_adc(self):
        advice = json.loads(self.advice("--json", text=AMPLIFIERS))
        self.assertTrue(800.0 < advice["best_load_ohm"] < 1000.0 + 2 * 20.0)
        self.assertTrue(all(entry["precision"] is None for entry in advice["loads"] if entry["load_ohm"] > 1100.0))

    def test_text_names_load_and_drive(self):
        text = self.advice()
        for words in (
            "4 x 5 taxels of 1 kohm to 100 kohm, divider, idle rows grounded",
            "best\n",
            "Load: take",
            "Now, with 200 ohm",
            "Drive: the less the better",
            "grows by less than 10 %",
        ):
            self.assertIn(words, text)


class BadInput(Circuit):
    def test_circuits_that_cannot_be_computed(self):
        readings = self.written("readings.csv", table([[[0.1] * COLS] * ROWS]))
        for text, place in (
            (ARRAY.replace('"divider"', '"none"'), "none"),
            (ARRAY.replace("= 200.0", '= "fit"'), "fitted"),
            (ARRAY.replace('"divider"', '"auto"'), "fitted"),
        ):
            array = self.written("array.toml", text)
            for arguments in (
                self.forward_arguments(out=self.work / "o"),
                self.invert_arguments(readings=readings, out=self.work / "o"),
                ["circuit", "advise", "--array", array, "--range", 1e3, 1e5],
            ):
                with self.subTest((place, arguments[1])):
                    self.refuse(arguments, [array, place])

    def test_tables_of_another_size(self):
        self.written("siemens.csv", "1,2,3\n")
        self.refuse(self.forward_arguments(), [f"{self.siemens}:1", "3 values", "5 columns"])
        self.written("siemens.csv", table([[[1e-3] * COLS] * (ROWS - 1)]))
        self.refuse(self.forward_arguments(), [f"{self.siemens}:3", "3 lines", "4 rows"])

    def test_values_that_are_none(self):
        for value, place in (("-1e-3", "conductance"), ("nan", "finite"), ("one", "finite"), ("", "finite")):
            with self.subTest(value):
                self.written("siemens.csv", table([[[1e-3] * COLS] * ROWS]).replace("0.001", value, 1))
                self.refuse(self.forward_arguments(), [f"{self.siemens}:1", "value 1", place])
        self.readings.write_text(table([[[0.1] * COLS] * ROWS]).replace("0.1", "inf", 1))
        self.refuse(self.invert_arguments(), [f"{self.readings}:1", "finite"])

    def test_ranges_that_are_none(self):
        for least, most in ((0, 1e3), (1e3, 1e2), (1e3, 1e3), ("nan", 1e3), (1e3, "inf")):
            with self.subTest((least, most)):
                self.refuse(["circuit", "advise", "--array", self.array, "--range", least, most], ["--range"])
        self.refuse(["circuit", "advise", "--array", self.array, "--range", 1e3], ["--range"])

    def test_a_noise_that_is_none(self):
        self.readings.write_text(table([[[0.1] * COLS] * ROWS]))
        for noise in ("0", "-1", "nan", "much"):
            with self.subTest(noise):
                self.refuse([*self.invert_arguments(), "--noise", noise], ["--noise"])

    def test_two_outputs_in_one_file(self):
        arguments = self.invert_arguments()
        self.refuse([*arguments, "--sigma", arguments[arguments.index("--out") + 1]], ["--sigma", "--out"])

    def test_the_noise_of_an_adc_in_volts_needs_the_supply(self):
        self.readings.write_text(table([[[0.1] * COLS] * ROWS]))
        self.written("array.toml", ARRAY.replace("supply_v = 5.0\n", ""))
        self.refuse(self.invert_arguments(), [self.array, "supply_v"])
        self.succeed(*self.invert_arguments(), "--noise", 1e-4)

    def test_missing_words_and_files(self):
        self.refuse(["circuit"], ["subcommand"])
        self.refuse(["circuit", "forward", "--array", self.array], ["--conductance"])
        absent = self.work / "absent"
        self.refuse(self.forward_arguments(array=absent), [absent])
        self.refuse(self.forward_arguments(conductance=absent), [absent])
        self.refuse(self.invert_arguments(readings=absent), [absent])
        self.refuse(self.forward_arguments(out=absent / "r.csv"), [absent], status=1)


if __name__ == "__main__":
    support.main()
