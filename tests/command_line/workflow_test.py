# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
import csv
import json
import math
import re

import support
from support import SmallArray, dermis

ESTIMATOR_KEYS = {
    "name",
    "median_relative_error",
    "p95_relative_error",
    "p99_relative_error",
    "max_relative_error",
    "taxels_judged",
    "ghost_p99_n",
    "ghost_max_n",
    "ghost_taxels_judged",
    "total_rmse_n",
    "total_median_relative_error",
    "total_max_relative_error",
    "totals_judged",
}
COVERAGE_KEYS = {"coverage_68", "coverage_95", "coverage_taxels"}
BREAKDOWNS = ("by_force", "by_temperature", "by_supply", "by_contacts")
OVER_TIME = ("by_onset", "by_direction", "after_release")


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.reader(file))


class Workflow(SmallArray):
    def test_forces_have_a_line_for_each_frame_and_a_column_for_each_taxel(self):
        out = self.work / "forces.csv"
        self.assertEqual(self.succeed(*self.run_arguments(out)), "")
        rows = rows_of(out)
        self.assertEqual(rows[0], ["time_s", "status"] + [f"r{r}c{c}" for r in range(4) for c in range(5)])
        self.assertEqual(len(rows), 1 + 200)
        for row, frame in zip(rows[1:], rows_of(self.contacts / "frames.csv")[1:]):
            self.assertEqual(row[0], frame[0])
            self.assertTrue(all(math.isfinite(float(cell)) and float(cell) >= 0 for cell in row[2:]))

    def test_forces_are_close_to_the_truth(self):
        result = json.loads(self.succeed(*self.evaluate_arguments(), "--json"))
        estimators = {entry["name"]: entry for entry in result["estimators"]}
        self.assertEqual(result["estimators"][0]["name"], "dermis")
        self.assertLess(estimators["dermis"]["median_relative_error"], 0.01)
        self.assertLess(estimators["dermis"]["p99_relative_error"], 0.05)
        self.assertLess(estimators["dermis"]["ghost_max_n"], 0.1)
        self.assertGreater(estimators["raw_lookup"]["median_relative_error"], 0.2)

    def test_evaluation_as_json(self):
        result = json.loads(self.succeed(*self.evaluate_arguments(), "--json"))
        self.assertEqual(
            set(result),
            {
                "frames",
                "frames_rejected",
                "judged_from_n",
                "estimators",
                "sums",
                *BREAKDOWNS,
                *OVER_TIME,
                "cramer_rao_bound",
            },
        )
        self.assertEqual((result["frames"], result["frames_rejected"]), (200, 0))
        names = [entry["name"] for entry in result["estimators"]]
        self.assertEqual(names, ["dermis", "raw_lookup", "temperature_lookup", "crosstalk_lookup"])
        for entry in result["estimators"]:
            self.assertEqual(set(entry), ESTIMATOR_KEYS | (COVERAGE_KEYS if entry["name"] == "dermis" else set()))
            self.assertEqual(entry["taxels_judged"], result["estimators"][0]["taxels_judged"])
            self.assertIsNone(entry["total_rmse_n"])  # these loads name single taxels only
        for breakdown in BREAKDOWNS:
            self.assertGreater(len(result[breakdown]), 0, breakdown)
            for row in result[breakdown]:
                self.assertEqual(set(row), {"from", "to", "count", "estimators"})
                self.assertEqual(set(row["estimators"]), set(names))
        judged = result["estimators"][0]["taxels_judged"]
        for breakdown in BREAKDOWNS:
            self.assertEqual(sum(row["count"] for row in result[breakdown]), judged, breakdown)

    def test_totals_have_a_line_for_each_frame_and_evaluate_judges_them(self):
        totals = self.work / "totals.csv"
        self.succeed(*self.run_arguments(self.work / "forces.csv"), "--totals", totals)
        rows = rows_of(totals)
        self.assertEqual(rows[0], ["time_s", "status", "total_n", "sigma_total_n", "left_out"])
        self.assertEqual([row[:2] for row in rows[1:]], [row[:2] for row in rows_of(self.work / "forces.csv")[1:]])
        self.assertTrue(all(float(row[3]) > 0 and row[4] == "0" for row in rows[1:]))
        sums = json.loads(self.succeed(*self.evaluate_arguments(), "--json"))["sums"]
        self.assertEqual(sums["untouched_frames"] + sums["touched_frames"], 200)
        self.assertLess(abs(sums["relative_bias"]), 0.005, sums)
        self.assertGreater(sums["coverage_95"], 0.85, sums)

    def test_standard_deviations_have_the_shape_of_the_forces_and_cover_the_truth(self):
        out, sigma = self.work / "forces.csv", self.work / "sigma.csv"
        self.succeed(*self.run_arguments(out), "--sigma", sigma)
        forces, sigmas = rows_of(out), rows_of(sigma)
        self.assertEqual(sigmas[0], forces[0])
        self.assertEqual([row[:2] for row in sigmas], [row[:2] for row in forces])
        self.assertTrue(all(float(cell) > 0 for row in sigmas[1:] for cell in row[2:]))
        result = json.loads(self.succeed(*self.evaluate_arguments(), "--json"))
        self.assertTrue(0.63 <= result["estimators"][0]["coverage_68"] <= 0.75, result["estimators"][0])
        self.assertTrue(0.92 <= result["estimators"][0]["coverage_95"] <= 0.98, result["estimators"][0])
        self.assertLess(
            result["cramer_rao_bound"]["median_relative_bound"], result["cramer_rao_bound"]["median_relative_deviation"]
        )

    def test_evaluation_as_text_names_all_estimators(self):
        text = self.succeed(*self.evaluate_arguments())
        for name in ("dermis", "raw look-up", "temperature look-up", "crosstalk look-up"):
            self.assertIn(f"\n{name} ", text)

    def test_report(self):
        report = self.work / "report"
        self.succeed(*self.evaluate_arguments(), "--report", report)
        page = (report / "index.html").read_text()
        self.assertIn("<html", page)
        self.assertIn("small", page)
        self.assertNotIn("<script", page)
        self.assertIn("Simulated frames (sim:multitouch?seed=2).", page)
        other = self.written("frames.csv", (self.contacts / "frames.csv").read_text().replace("\n0,", "\n0.0,", 1))
        self.succeed(*self.evaluate_arguments(frames=other), "--report", report)
        self.assertIn("Measured frames, as far as their file tells.", (report / "index.html").read_text())
        self.assertTrue(list(report.glob("*.svg")))

    def test_a_simulated_recording_is_called_simulated(self):
        recording, report = self.work / "sim.mcap", self.work / "report"
        source = "sim:multitouch?frames=5&rows=3&cols=4&seed=4"
        self.assertEqual(dermis("record", "--from", source, "--out", recording).returncode, 0)
        self.assertIn(f"simulated     {source}", self.succeed("info", recording))
        self.succeed("convert", self.contacts / "frames.csv", self.work / "frames.mcap")
        self.succeed(*self.evaluate_arguments(frames=self.work / "frames.mcap"), "--report", report)
        self.assertIn("Simulated frames (sim:multitouch?seed=2).", (report / "index.html").read_text())

    def test_calibration_report_as_json(self):
        report = json.loads(self.succeed(*self.calibrate_arguments(self.work / "model.safetensors"), "--json"))
        self.assertEqual(report["frames"], 5 * (20 + 14 * 20))
        self.assertEqual(report["frames_rejected"], 0)
        self.assertEqual((report["own_networks"], report["shared_networks"]), (20, 0))
        self.assertTrue(report["uses_temperature"])
        self.assertEqual(report["dead_taxels"], [])
        self.assertTrue(0.9 < report["adc_noise_counts"] < 1.2, report["adc_noise_counts"])
        self.assertTrue(0.2 < report["temperature_sigma_celsius"] < 0.4, report["temperature_sigma_celsius"])

    def test_calibration_finds_the_circuit(self):
        known = self.array.read_text()
        for circuit in ('drive_ohm = "fit"', 'circuit = "auto"'):
            key = circuit.split(" ")[0]
            array = self.work / "unknown.toml"
            kept = [
                line for line in known.splitlines() if not line.startswith((key, "idle_" if "auto" in circuit else key))
            ]
            array.write_text("\n".join(kept).replace("[readout]", "[readout]\n" + circuit) + "\n")
            arguments = self.calibrate_arguments(self.work / "fitted.safetensors", array=array)
            found = json.loads(self.succeed(*arguments, "--json"))["circuit"]
            self.assertEqual(found["kind"], "divider")
            self.assertEqual(len(found["candidates"]), 6 if "auto" in circuit else 0)
            self.assertIn(
                "drive_ohm", self.succeed(*arguments, "--verbose") if circuit.startswith("drive") else "drive_ohm"
            )

    def test_a_calibration_says_five_lines_and_all_else_where_it_is_asked(self):
        model = self.work / "five.safetensors"
        told = self.succeed(*self.calibrate_arguments(model))
        lines = [re.split(r" +", line, maxsplit=1) for line in told.splitlines()]
        self.assertEqual([name for name, _ in lines], ["fitted", "unseen", "doubted", "next", "model"])
        said = dict(lines)
        self.assertRegex(
            said["fitted"], "^a law of its own for each of 20 taxels, from 1500 labelled frames: loads 0.5 to"
        )
        self.assertIn("fewer than eight presses on two to six taxels", said["doubted"])
        self.assertIn("add twenty presses", said["next"])
        self.assertEqual(said["model"], str(model))
        detailed = self.succeed(*self.calibrate_arguments(self.work / "more.safetensors"), "--verbose")
        self.assertEqual(detailed.splitlines()[:3], told.splitlines()[:3])
        for words in ("fit: median", "1-sigma: ", "have a network of their own", "time: "):
            self.assertIn(words, detailed)
            self.assertNotIn(words, told)

    def test_what_a_calibration_says_of_unseen_loads_holds_on_a_second_recording(self):
        model = self.work / "judged.safetensors"
        unseen = json.loads(self.succeed(*self.calibrate_arguments(model), "--json"))["unseen"]
        presses = self.work / "paper"
        self.succeed("simulate", "--array", self.array, "--scene", "paper", "--seed", 9, "--out", presses)
        arguments = self.evaluate_arguments(
            model=self.model, frames=presses / "frames.csv", loads=presses / "loads.csv"
        )
        error = json.loads(self.succeed(*arguments, "--json"))["estimators"][0]["median_relative_error"]
        self.assertLess(unseen["median"], unseen["p95"])
        self.assertLess(error, 2.0 * unseen["median"])
        self.assertGreater(error, 0.5 * unseen["median"])

    def test_contacts_have_a_line_from_onset_to_release(self):
        scene, out, forces = self.work / "scene", self.work / "contacts.csv", self.work / "forces.csv"
        self.succeed("simulate", "--array", self.array, "--scene", "contacts", "--seed", 3, "--out", scene)
        self.succeed("run", "--model", self.model, "--in", scene / "frames.csv", "--contacts", out, "--out", forces)
        with open(out, newline="") as file:
            lines = list(csv.DictReader(file))
        self.assertEqual(list(lines[0])[:7], ["time_s", "id", "phase", "x_mm", "y_mm", "sigma_x_mm", "sigma_y_mm"])
        phases = {}
        for line in lines:
            self.assertTrue(
                all(
                    math.isfinite(float(cell)) for name, cell in line.items() if name not in ("phase", "sigma_force_n")
                ),
                line,
            )
            self.assertEqual(float(line["force_n"]) == 0, line["phase"] == "release")
            phases.setdefault(line["id"], []).append(line["phase"])
        for phase in phases.values():
            self.assertEqual(phase[0], "onset")
            self.assertLessEqual(set(phase[1:-1]), {"held"})
        self.assertTrue(any(phase[-1] == "release" for phase in phases.values()))
        times = {row[0] for row in rows_of(forces)[1:]}
        self.assertLessEqual({line["time_s"] for line in lines}, times)

        alone = self.work / "alone.csv"
        self.succeed("run", "--model", self.model, "--in", scene / "frames.csv", "--contacts", alone)
        self.assertEqual(alone.read_text(), out.read_text())

    def test_contacts_are_where_the_scene_presses(self):
        scene, out = self.work / "scene", self.work / "contacts.csv"
        self.succeed("simulate", "--array", self.array, "--scene", "contacts", "--seed", 4, "--out", scene)
        self.succeed("run", "--model", self.model, "--in", scene / "frames.csv", "--contacts", out)
        times = [row[0] for row in rows_of(scene / "frames.csv")[1:]]
        found = {}
        for row in rows_of(out)[1:]:
            found.setdefault(row[0], []).append((float(row[3]), float(row[4])))
        pressed = near = 0
        for frame, _, _, x, y, _, _, newtons in rows_of(scene / "contacts.csv")[1:]:
            if float(newtons) < 0.5:
                continue
            pressed += 1
            near += any(math.hypot(float(x) - a, float(y) - b) < 10 for a, b in found.get(times[int(frame)], []))
        self.assertGreater(pressed, 100)
        self.assertGreater(near, 0.98 * pressed)

    def test_settling_leaves_out_the_first_seconds(self):
        out = self.work / "forces.csv"
        self.succeed(*self.run_arguments(out), "--settle", 10)
        self.assertLess(len(rows_of(out)), 1 + 200)

    def test_output_to_a_pipe(self):
        piped = self.succeed(*self.run_arguments("/dev/stdout"))
        out = self.work / "forces.csv"
        self.succeed(*self.run_arguments(out))
        self.assertEqual(piped, out.read_text())

    def test_help_and_version(self):
        self.assertRegex(self.succeed("--version"), r"^\d+\.\d+\.\d+\n$")
        self.assertIn("calibrate", self.succeed("--help"))
        for command in ("simulate", "calibrate", "run", "evaluate"):
            self.assertIn("--", self.succeed(command, "--help"))


class PaperBank(SmallArray):
    def train(self, bank, *arguments, **keywords):
        return self.succeed(
            "paper",
            "calibrate",
            "--array",
            self.array,
            "--frames",
            self.calibration / "frames.csv",
            "--loads",
            self.calibration / "loads.csv",
            "--bank",
            bank,
            *arguments,
            **keywords,
        )

    def test_a_bank_is_one_more_estimator(self):
        bank = self.work / "bank.safetensors"
        self.assertIn("the paper's bank: 17620 unknowns", self.train(bank))
        arguments = (
            "paper",
            "evaluate",
            "--model",
            self.model,
            "--bank",
            bank,
            "--frames",
            self.calibration / "frames.csv",
            "--loads",
            self.calibration / "loads.csv",
        )
        estimators = json.loads(self.succeed(*arguments, "--json"))["estimators"]
        self.assertEqual([entry["name"] for entry in estimators][-1], "paper_bank")
        self.assertLess(estimators[-1]["median_relative_error"], 0.25)
        self.assertIn("\npaper bank ", self.succeed(*arguments))
        self.succeed(*arguments, "--report", self.work / "report")
        self.assertIn("N-N-N-1", (self.work / "report" / "index.html").read_text())

    def test_a_bank_gives_the_same_bytes_on_one_core(self):
        found = json.loads(self.train(self.work / "a", "--json"))
        self.assertEqual(found["never_loaded"], [])
        self.train(self.work / "b", prefix=("taskset", "-c", "0"))
        self.assertEqual((self.work / "a").read_bytes(), (self.work / "b").read_bytes())

    def test_who_asks_a_daily_command_for_the_bank_is_told_where_it_is(self):
        taken = "unknown option '--bank'; it is one of 'dermis paper calibrate' and 'dermis paper evaluate'"
        self.refuse([*self.calibrate_arguments(self.work / "m"), "--bank", self.work / "b"], [taken])
        self.refuse([*self.evaluate_arguments(), "--bank", self.work / "b"], [taken])


class Paper(SmallArray):
    def test_json_names_what_the_paper_claims(self):
        found = json.loads(self.succeed("paper", "--quick", "--json"))
        self.assertEqual(found["unknowns"], 2 * 16**3 + 16**2 + 2 * 16**2 + 16)
        self.assertGreater(found["peaks"]["hidden_5"]["best_mse"], 0.001)
        self.assertAlmostEqual(
            found["peaks"]["hidden_5"]["best_mse_normalised"],
            found["peaks"]["hidden_5"]["best_mse"] / found["peaks"]["range"] ** 2,
        )
        self.assertEqual(set(found["peaks"]["smallest_hidden"]), {"raw", "normalised"})
        self.assertEqual(len(found["convergence"]), 3)
        self.assertLess(found["points"]["dermis"]["max_relative_error"], 0.05)
        self.assertGreater(found["points"]["bank"]["max_relative_error"], 0.0)

    def test_text_and_report(self):
        text = self.succeed("paper", "--quick", "--report", self.work / "report")
        for words in ("2-5-1", "8976 unknowns", "48 points"):
            self.assertIn(words, text)
        page = (self.work / "report" / "index.html").read_text()
        for words in ("Fig. 6", "Fig. 10", "Fig. 11"):
            self.assertIn(words, page)


class Loads(SmallArray):
    """The rigs that people have, other than a weight on each taxel."""

    def test_air_bladder(self):
        folder, model = self.work / "uniform", self.work / "model.safetensors"
        self.succeed("simulate", "--array", self.array, "--scene", "uniform", "--out", folder)
        self.succeed(*self.calibrate_arguments(model, frames=folder / "frames.csv", loads=folder / "loads.csv"))
        result = json.loads(self.succeed(*self.evaluate_arguments(model=model), "--json"))
        self.assertLess(result["estimators"][0]["median_relative_error"], 0.05)

    def test_load_cell_under_the_whole_pad(self):
        """The taxels of a contact share a total in a way that nobody told."""
        totals = {}
        for frame, _, _, value in rows_of(self.contacts / "loads.csv")[1:]:
            totals[frame] = totals.get(frame, 0.0) + float(value)
        lines = [f"{frame},force,all,{0.0 if int(frame) < 20 else total}" for frame, total in totals.items()]
        frames = rows_of(self.contacts / "frames.csv")
        unloaded = rows_of(self.calibration / "frames.csv")[1:21]
        for k, row in enumerate(unloaded):  # the first frames become unloaded ones
            frames[1 + k] = [frames[1 + k][0], *row[1:]]
        frames_csv = self.written("frames.csv", "".join(",".join(row) + "\n" for row in frames))
        loads_csv = self.written("loads.csv", "frame,kind,where,value\n" + "\n".join(lines) + "\n")
        model = self.work / "model.safetensors"
        text = self.succeed(*self.calibrate_arguments(model, frames=frames_csv, loads=loads_csv))
        self.assertRegex(text, r"^fitted +one law for 20 taxels, from 200 labelled frames: loads ")
        result = json.loads(
            self.succeed(*self.evaluate_arguments(model=model, frames=frames_csv, loads=loads_csv), "--json")
        )
        dermis_result = result["estimators"][0]
        self.assertEqual(dermis_result["totals_judged"], 180)
        self.assertEqual(dermis_result["taxels_judged"], 0)
        self.assertIsNone(dermis_result["median_relative_error"])
        self.assertLess(dermis_result["total_median_relative_error"], 0.2)
        self.assertLess(dermis_result["total_rmse_n"], result["estimators"][1]["total_rmse_n"])


class Temperature(SmallArray):
    def without_temperature(self, name, source):
        rows = rows_of(source)
        self.assertEqual(rows[0][1], "temperature_celsius")
        return self.written(name, "".join(",".join([row[0], *row[2:]]) + "\n" for row in rows))

    def statuses(self, model, frames):
        out = self.work / "forces.csv"
        self.succeed(*self.run_arguments(out, model=model, **{"in": frames}))
        return {flag for row in rows_of(out)[1:] for flag in row[1].split("+")}

    def test_frames_without_temperature_say_so(self):
        frames = self.without_temperature("frames.csv", self.contacts / "frames.csv")
        self.assertIn("temperature_unknown", self.statuses(self.model, frames))

    def test_a_model_that_was_never_told_a_temperature_asks_for_none(self):
        calibration = self.without_temperature("calibration.csv", self.calibration / "frames.csv")
        model = self.work / "model.safetensors"
        report = json.loads(self.succeed(*self.calibrate_arguments(model, frames=calibration), "--json"))
        self.assertFalse(report["uses_temperature"])
        for frames in (
            self.contacts / "frames.csv",
            self.without_temperature("frames.csv", self.contacts / "frames.csv"),
        ):
            self.assertEqual({flag for flag in self.statuses(model, frames) if "temperature" in flag}, set())


class Memory(SmallArray):
    """Scenes that are continuous in time, on rubber that remembers."""

    def simulated(self, name, scene, *options):
        folder = self.work / name
        self.succeed("simulate", "--array", self.array, "--scene", scene, "--seed", 3, *options, "--out", folder)
        return rows_of(folder / "frames.csv")[1:], rows_of(folder / "loads.csv")[1:]

    def test_touches_come_at_the_rate_asked(self):
        frames, loads = self.simulated("touches", "touches", "--rate", 50, "--frames", 500, "--memory", "rubber")
        self.assertEqual(len(frames), 500)
        for k, frame in enumerate(frames):
            self.assertAlmostEqual(float(frame[0]), 0.02 * (k + 1), places=6)
        self.assertEqual({int(load[0]) for load in loads}, set(range(500)))

    def test_two_weights_lie_on_the_taxels_asked(self):
        frames, loads = self.simulated(
            "weights", "two_weights", "--taxels", 2, "--rate", 20, "--memory", "rubber", "--touch-gain", 0
        )
        self.assertEqual(len(frames), 20 * (10 + 2 * 2 * 55))
        self.assertEqual({float(load[3]) for load in loads}, {0.0, 5.0, 15.0})
        self.assertEqual(len({load[2] for load in loads}), 3)  # two taxels and "all" that is unloaded

    def test_the_memory_is_that_of_the_options(self):
        seen = set()
        for options in (
            (),
            ("--memory", "simple"),
            ("--memory", "rubber"),
            ("--memory", "rubber", "--touch-gain", 0),
            ("--memory", "rubber", "--creep-per-decade", 0.2),
        ):
            frames, _ = self.simulated(
                "o" + str(len(options)) + str(options[-1:]), "touches", "--frames", 600, *options
            )
            seen.add(str(frames))
        self.assertEqual(len(seen), 4)  # simple is what it is without an option

    def test_the_film_is_that_of_the_option(self):
        seen = set()
        for options in ((), ("--film", 300), ("--film", "300,300,20"), ("--film", "50000,300,2")):
            frames, _ = self.simulated("film" + str(options[-1:]), "touches", "--frames", 600, *options)
            seen.add(str(frames))
        self.assertEqual(len(seen), 3)  # one resistance is a film that loads do not change


class Determinism(SmallArray):
    def simulated(self, name, *options, prefix=()):
        folder = self.work / name
        self.succeed(
            "simulate",
            "--array",
            self.array,
            "--scene",
            "multitouch",
            "--frames",
            50,
            *options,
            "--out",
            folder,
            prefix=prefix,
        )
        return (folder / "frames.csv").read_bytes() + (folder / "loads.csv").read_bytes()

    def test_simulation_depends_on_its_seed_alone(self):
        first = self.simulated("first", "--seed", 7)
        self.assertEqual(self.simulated("second", "--seed", 7), first)
        self.assertNotEqual(self.simulated("third", "--seed", 8), first)

    def test_a_calibration_gives_the_same_bytes_again_and_on_one_core(self):
        first = self.model.read_bytes()
        again, one_core = self.work / "again", self.work / "one_core"
        self.succeed(*self.calibrate_arguments(again))
        self.succeed(*self.calibrate_arguments(one_core), prefix=("taskset", "-c", "0"))
        self.assertEqual(again.read_bytes(), first)
        self.assertEqual(one_core.read_bytes(), first)

    def test_forces_and_evaluation_are_the_same_again_and_on_one_core(self):
        again, one_core = self.work / "again.csv", self.work / "one_core.csv"
        self.succeed(*self.run_arguments(again))
        self.succeed(*self.run_arguments(one_core), prefix=("taskset", "-c", "0"))
        self.assertEqual(again.read_bytes(), one_core.read_bytes())
        first = self.succeed(*self.evaluate_arguments(), "--json", "--report", self.work / "first")
        second = self.succeed(
            *self.evaluate_arguments(), "--json", "--report", self.work / "second", prefix=("taskset", "-c", "0")
        )
        self.assertEqual(first, second)
        self.assertEqual((self.work / "first/index.html").read_bytes(), (self.work / "second/index.html").read_bytes())


class RejectedFrames(SmallArray):
    """A frame that cannot be used costs that frame, not the recording."""

    def test_run_goes_on_and_says_so(self):
        rows = rows_of(self.contacts / "frames.csv")
        for row in (rows[10], rows[20]):
            row[3:] = ["nan"] * len(row[3:])
        frames = self.written("frames.csv", "".join(",".join(row) + "\n" for row in rows))
        out = self.work / "forces.csv"
        result = dermis(*self.run_arguments(out, **{"in": frames}))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 of 200 frames rejected", result.stderr)
        self.assertIn(f"{frames}:11", result.stderr)
        forces = rows_of(out)
        self.assertEqual([row[1] for row in (forces[10], forces[20])], ["rejected", "rejected"])
        self.assertTrue(all(cell == "nan" for cell in forces[10][2:]))
        self.assertEqual(sum(row[1] == "rejected" for row in forces[1:]), 2)

    def test_a_taxel_without_a_reading_costs_its_own_force_alone(self):
        rows = rows_of(self.contacts / "frames.csv")
        for row in rows[1:]:
            row[-1] = "nan"
        rows[10][-2] = "5000"
        rows[20][-2] = ""
        frames = self.written("frames.csv", "".join(",".join(row) + "\n" for row in rows))
        out = self.work / "forces.csv"
        result = dermis(*self.run_arguments(out, **{"in": frames}))
        self.assertEqual(result.returncode, 0, result.stderr)
        last, before = rows[0][-1], rows[0][-2]
        self.assertIn(f"of {last} in 200, {before} in 2 of 200 frames", result.stderr)
        forces = rows_of(out)
        self.assertTrue(all(row[-1] == "nan" for row in forces[1:]))
        self.assertEqual([k for k, row in enumerate(forces) if row[-2] == "nan"], [10, 20])
        self.assertFalse(any("nan" in row[:-2] for row in forces[1:]))


if __name__ == "__main__":
    support.main()
