# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Every bad input: status 2 (1 where the input was right and the work failed), one line that names the place, and no
output file."""

import os
import re

import support
from support import ARRAY, SmallArray, dermis, files_limited_to


class Usage(SmallArray):
    def test_no_command(self):
        self.refuse([], ["name a command"])

    def test_unknown_command(self):
        self.refuse(["calibrat"], ["unknown command 'calibrat'", "did you mean 'calibrate'?"])
        self.refuse(["circuit", "forwards"], ["unknown command 'forwards'", "did you mean 'forward'?"])
        self.refuse(["xyzzy"], ["unknown command 'xyzzy'"])

    def test_unknown_option(self):
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--fast"], ["unknown option '--fast'"])
        self.refuse(["run", "--modle", self.model], ["unknown option '--modle'", "did you mean '--model'?"])
        self.refuse(["run", "--model=m", "frames.csv"], ["'frames.csv' is one argument too many"])

    def test_missing_options(self):
        for command, option in (
            ("simulate", "--array"),
            ("calibrate", "--array"),
            ("run", "--in"),
            ("evaluate", "--model"),
            ("doctor", "--in"),
        ):
            with self.subTest(command):
                self.refuse([command], [option])

    def test_frames_that_hold_no_model(self):
        self.refuse(["run", "--in", self.calibration / "frames.csv", "--out", self.work / "f.csv"], ["name one"])
        recording = self.work / "bare.mcap"
        self.succeed("convert", self.calibration / "frames.csv", recording)
        self.refuse(
            ["run", "--in", recording, "--out", self.work / "f.csv"], [recording, "without a model", "name one"]
        )

    def test_a_number_that_is_none(self):
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--settle", "soon"], ["--settle"])
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--settle", "-1"], ["--settle"])
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--settle", "nan"], ["--settle"])

    def test_two_outputs_in_one_file(self):
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--sigma", self.work / "f.csv"], ["--sigma", "--out"])

        self.refuse(
            [*self.run_arguments(self.work / "f.csv"), "--contacts", self.work / "f.csv"], ["--contacts", "--out"]
        )

    def test_a_run_that_writes_nothing(self):
        self.refuse(["run", "--model", self.model, "--in", self.contacts / "frames.csv"], ["--out", "--contacts"])

    def test_a_count_below_zero(self):
        for option in ("--frames", "--seed"):
            with self.subTest(option):
                self.refuse(
                    [
                        "simulate",
                        "--array",
                        self.array,
                        "--scene",
                        "multitouch",
                        "--out",
                        self.work / "o",
                        option,
                        "-1",
                    ],
                    [option],
                    **files_limited_to(1000000),
                )

    def test_results_are_no_frames(self):
        self.succeed(
            *self.run_arguments(self.work / "f.csv"), "--contacts", self.work / "c.csv", "--totals", self.work / "t.csv"
        )
        for file, content in (
            (self.work / "f.csv", "forces"),
            (self.work / "c.csv", "contacts"),
            (self.work / "t.csv", "total forces"),
            (self.contacts / "loads.csv", "loads"),
        ):
            with self.subTest(content):
                self.refuse(
                    self.run_arguments(self.work / "o.csv", **{"in": file}),
                    [f"{file}:1: is a table of {content}, not of raw counts"],
                )

    def test_a_folder_with_frames_is_told_which(self):
        self.refuse(
            self.run_arguments(self.work / "o.csv", **{"in": self.contacts}),
            [f"{self.contacts}: is a folder; name {self.contacts / 'frames.csv'}"],
        )

    def test_a_count_beyond_its_range(self):
        self.refuse(
            ["serve", "--from", "sim:idle?rate=10", "--model", self.model, "--port", 99999],
            ["--port", "must be 0 to 65535"],
        )

    def test_unknown_scene(self):
        self.refuse(
            ["simulate", "--array", self.array, "--scene", "party", "--out", self.work / "o"], ["party", "multitouch"]
        )

    def test_options_of_other_scenes_and_memories(self):
        simulate = ["simulate", "--array", self.array, "--out", self.work / "o", "--scene"]
        self.refuse([*simulate, "idle", "--rate", 50], ["idle", "rate"])
        self.refuse([*simulate, "touches", "--rate", 5], ["touches", "10 to 1000"])
        self.refuse([*simulate, "touches", "--taxels", 3], ["touches", "taxels"])
        self.refuse([*simulate, "two_weights", "--taxels", 21], ["two_weights", "1 to 20"])
        self.refuse([*simulate, "touches", "--memory", "elephant"], ["--memory", "simple", "rubber", "elephant"])
        self.refuse([*simulate, "touches", "--touch-gain", 0.1], ["--touch-gain", "--memory rubber"])
        self.refuse(
            [*simulate, "touches", "--memory", "rubber", "--creep-per-decade", 0.5], ["creep_per_decade", "0.02 to 0.3"]
        )
        physics = self.written("physics.toml", "[rubber]\ncreep = 0.1\n")
        self.refuse([*simulate, "touches", "--memory", "rubber", "--physics", physics], ["rubber.creep", "simple"])

    def test_a_film_that_is_none(self):
        simulate = ["simulate", "--array", self.array, "--out", self.work / "o", "--scene", "touches", "--film"]
        self.refuse([*simulate, "5000,1000"], ["--film", "UNLOADED,LOADED,NEWTONS"])
        self.refuse([*simulate, "1000,5000,20"], ["--film", "load lowers the resistance"])
        self.refuse([*simulate, "0"], ["--film", "more than 0 ohm"])
        self.refuse([*simulate, "5000,1000,0"], ["--film", "more than 0 N"])

    def test_a_scene_of_fixed_length_with_another_length(self):
        self.refuse(
            ["simulate", "--array", self.array, "--scene", "paper", "--frames", "3", "--out", self.work / "o"],
            ["paper", "fixed"],
        )


class MissingFiles(SmallArray):
    def test_each_input(self):
        absent = self.work / "absent"
        model, forces = self.work / "m", self.work / "f.csv"
        cases = [
            self.calibrate_arguments(model, array=absent),
            self.calibrate_arguments(model, frames=absent),
            self.calibrate_arguments(model, loads=absent),
            ("doctor", "--model", self.model, "--in", absent),
            ("doctor", "check", "--model", self.model, "--in", absent, "--weight", 5),
            ("doctor", "recalibrate", "--model", self.model, "--frames", absent, "--loads", absent),
            self.run_arguments(forces, model=absent),
            self.run_arguments(forces, **{"in": absent}),
            self.evaluate_arguments(model=absent),
            self.evaluate_arguments(frames=absent),
            self.evaluate_arguments(loads=absent),
            ("simulate", "--array", absent, "--scene", "idle", "--out", self.work / "o"),
            ("simulate", "--array", self.array, "--physics", absent, "--scene", "idle", "--out", self.work / "o"),
        ]
        for arguments in cases:
            with self.subTest(arguments):
                self.refuse(arguments, [absent])

    def test_a_bank(self):
        absent = self.work / "absent"
        evaluate = ["paper", *self.evaluate_arguments(), "--bank"]
        self.refuse([*evaluate, absent], [absent])
        self.refuse([*evaluate, self.model], [self.model, "not a bank of the paper", "the paper's calibration"])

    def test_a_folder_instead_of_a_file(self):
        self.refuse(self.run_arguments(self.work / "f.csv", **{"in": self.root}), [self.root])


class BodyOfASuit(SmallArray):
    ROBOT = '<robot name="r"><link name="trunk"/></robot>'

    def refuse_suit(self, suit, places, link=""):
        suit = self.written(
            "suit.toml",
            f'[suit]\n{suit}\n[[array]]\nname = "chest"\nfrom = "sim:idle?rate=50"\nmodel = "{self.model}"\n{link}\n',
        )
        self.refuse(["serve", "--suit", suit, "--port", 0], places)

    def test_a_body_that_cannot_be_read(self):
        self.written("broken.urdf", "<robot>\n<link>\n")
        self.written("hinge.urdf", self.ROBOT.replace("/></robot>", '/>\n<joint name="j" type="hinge"/></robot>'))
        self.refuse_suit('body = "absent.urdf"', [self.work / "absent.urdf"])
        self.refuse_suit('body = "robot.dae"', ["robot.dae", ".urdf, .stl or .glb"])
        self.refuse_suit('body = "broken.urdf"', ["broken.urdf:2", "<link> needs name"])
        self.refuse_suit('body = "hinge.urdf"', ["hinge.urdf:2", "hinge", "no type of a joint"])
        self.refuse_suit('body = "robot.stl"\nbody_scale = 0', ["body_scale", "more than 0"])

    def test_a_link_that_is_not_there(self):
        self.written("robot.urdf", self.ROBOT)
        self.refuse_suit('body = "robot.urdf"', ["chest", "'r' has no 'arm'"], 'link = "arm"')
        self.refuse_suit("", ["chest", "link: needs the body"], 'link = "arm"')


class ArrayFile(SmallArray):
    def refuse_array(self, text, places):
        array = self.written("array.toml", text)
        self.refuse(["simulate", "--array", array, "--scene", "idle", "--out", self.work / "o"], [array, *places])

    def test_unknown_key(self):
        self.refuse_array(ARRAY.replace("load_ohm", "laod_ohm"), [":10", "laod_ohm", "load_ohm"])

    def test_unknown_table(self):
        self.refuse_array(ARRAY + "[redaout]\n", ["redaout"])

    def test_missing_key(self):
        self.refuse_array(ARRAY.replace("rows = 4\n", ""), ["array.rows"])

    def test_text_where_a_number_belongs(self):
        self.refuse_array(ARRAY.replace("cols = 5", 'cols = "five"'), [":4", "array.cols"])

    def test_out_of_range(self):
        self.refuse_array(ARRAY.replace("rows = 4", "rows = 0"), [":3", "array.rows"])
        self.refuse_array(ARRAY.replace("load_ohm = 200.0", "load_ohm = -1"), [":10", "load_ohm"])
        self.refuse_array(ARRAY.replace("adc_bits = 12", "adc_bits = 99"), [":11", "adc_bits"])

    def test_metres_for_millimetres(self):
        self.refuse_array(
            ARRAY.replace("cols = 5", "cols = 5\npitch_mm = [0.015, 0.015]"),
            [":5", "pitch_mm", "0.05 to 1000", "write 15"],
        )

    def test_a_list_of_the_wrong_length(self):
        self.refuse_array(ARRAY.replace("load_ohm = 200.0", "load_ohm = [1.0, 2.0]"), [":10", "load_ohm", "5"])

    def test_unknown_circuit(self):
        self.refuse_array(ARRAY.replace("divider", "dividr"), [":8", "circuit", "divider"])

    def test_broken_toml(self):
        self.refuse_array(ARRAY.replace("rows = 4", "rows 4"), [":3"])

    def test_a_key_of_another_circuit(self):
        self.refuse_array(ARRAY + "amplifier_gain = 1e5\n", [":14", "amplifier_gain", "transimpedance"])

    def test_an_instrument_that_cannot_be(self):
        self.refuse_array(ARRAY + "adc_settling = 1.5\n", [":14", "adc_settling", "0 to 0.5"])
        self.refuse_array(ARRAY + "adc_curve = [[0, 0], [5, 5], [4, 6]]\n", [":14", "adc_curve", "rise", "point 2"])
        self.refuse_array(ARRAY + "supply_ohm = -3\n", [":14", "supply_ohm", "0 or more"])
        self.refuse_array(ARRAY + "column_switch_ohm = 80\n", [":14", "column_switch_ohm", "idle_columns"])

    def test_a_circuit_that_is_not_known_yet(self):
        for text in (
            ARRAY.replace("load_ohm = 200.0", 'load_ohm = "fit"'),
            ARRAY.replace('"divider"', '"auto"'),
            ARRAY + 'adc_settling = "fit"\n',
            ARRAY + 'supply_ohm = "fit"\n',
        ):
            self.refuse_array(text, ["fitted"])

    def test_unknown_physics(self):
        physics = self.written("physics.toml", "[rubber]\nexponnt = 0.9\n")
        self.refuse(
            ["simulate", "--array", self.array, "--physics", physics, "--scene", "idle", "--out", self.work / "o"],
            [physics, ":2", "exponnt", "exponent"],
        )


class FramesFile(SmallArray):
    def refuse_frames(self, change, places):
        lines = (self.contacts / "frames.csv").read_text().splitlines()
        change(lines)
        frames = self.written("frames.csv", "\n".join(lines) + "\n")
        out = self.work / "out"
        for arguments in (
            self.run_arguments(out, **{"in": frames}),
            self.evaluate_arguments(frames=frames),
            self.calibrate_arguments(out, frames=frames, loads=self.contacts / "loads.csv"),
        ):
            with self.subTest(arguments[0]):
                self.refuse(arguments, [frames, *places])

    def test_missing_column(self):
        def change(lines):
            lines[:] = [line.rpartition(",")[0] for line in lines]

        self.refuse_frames(change, [":1", "r3c4"])

    def test_missing_time(self):
        def change(lines):
            lines[:] = [line.partition(",")[2] for line in lines]

        self.refuse_frames(change, [":1", "time_s"])

    def test_ragged_row(self):
        def change(lines):
            lines[6] = lines[6].rpartition(",")[0]

        self.refuse_frames(change, [":7", "22", "23"])

    def test_text_in_a_number(self):
        def change(lines):
            cells = lines[6].split(",")
            cells[5] = "12a"
            lines[6] = ",".join(cells)

        self.refuse_frames(change, [":7", "r0c2", "12a"])

    def test_wrong_size_for_the_array(self):
        def change(lines):
            names = lines[0].split(",")[:3] + [f"r{r}c{c}" for r in range(5) for c in range(4)]
            lines[0] = ",".join(names)

        self.refuse_frames(change, [":1", "5x4", "4x5"])

    def test_empty_file(self):
        self.refuse_frames(lambda lines: lines.clear(), [":1"])

    def test_binary_file(self):
        frames = self.work / "frames.csv"
        frames.write_bytes(bytes(range(256)) * 100)
        self.refuse(self.run_arguments(self.work / "out", **{"in": frames}), [frames])

    def test_decimals_with_a_comma(self):
        def change(lines):
            lines[6] = lines[6].replace(".", ",")

        self.refuse_frames(change, [":7", "the header 23", "decimals with a point"])


class WhatCannotBe(SmallArray):
    """Frames of another unit, and of an array that is not there: `run` names the mend in its last line, with status 1,
    and `doctor` as its finding. `calibrate` refuses them, and loads that exchange rows and columns."""

    def changed(self, path, change):
        header, *rows = [line.split(",") for line in path.read_text().splitlines()]
        columns = {name: column for column, name in enumerate(header)}
        for row in rows:
            change(row, columns)
        return self.written("frames.csv", "".join(",".join(row) + "\n" for row in [header, *rows]))

    def assert_named(self, change, words):
        frames = self.changed(self.contacts / "frames.csv", change)
        result = support.dermis(*self.run_arguments(self.work / "forces.csv", **{"in": frames}))
        self.assertEqual(result.returncode, 1, result.stderr)
        [line] = result.stderr.splitlines()
        for word in (f"dermis: {frames}: 200 of 200 frames ", *words):
            self.assertIn(word, line)
        doctor = support.dermis("doctor", "--model", self.model, "--in", frames)
        self.assertEqual(doctor.returncode, 1, doctor.stderr)
        self.assertIn(words[-1], doctor.stdout.splitlines()[-1])
        (self.work / "forces.csv").unlink()
        frames = self.changed(self.calibration / "frames.csv", change)
        self.refuse(
            self.calibrate_arguments(self.work / "m", frames=frames),
            ["1400 of 1400 loaded frames cannot be: the first is frame 20: ", words[-1]],
        )

    def test_temperature_in_kelvin(self):
        def change(row, columns):
            row[columns["temperature_celsius"]] = str(float(row[columns["temperature_celsius"]]) + 273.15)

        self.assert_named(change, ["it looks like kelvin, give degrees Celsius"])

    def test_supply_in_millivolts(self):
        def change(row, columns):
            row[columns["supply_v"]] = str(float(row[columns["supply_v"]]) * 1000)

        self.assert_named(change, ["looks like millivolts, give volts"])

    def test_nothing_but_zeros(self):
        def change(row, columns):
            row[columns["r0c0"] :] = ["0"] * 20

        self.assert_named(change, ["all readings 0", "is the array connected and powered?"])

    def test_zeros_for_some_seconds(self):
        lost = set(map(str, range(60, 100)))  # seconds: a frame a second

        def change(row, columns):
            if row[0] in lost:
                row[columns["r0c0"] :] = ["0"] * 20

        frames = self.changed(self.contacts / "frames.csv", change)
        said = "40 of 200 frames with all readings 0, where untouched taxels read more"
        line = f"{said}: is the array connected and powered?"
        result = support.dermis(*self.run_arguments(self.work / "forces.csv", **{"in": frames}))
        self.assertEqual((result.returncode, result.stderr.splitlines()[-1]), (0, line))
        doctor = support.dermis("doctor", "--model", self.model, "--in", frames)
        self.assertEqual((doctor.returncode, doctor.stdout.splitlines()[-1]), (1, line))
        self.assertNotIn("calibrate again", doctor.stdout)

    def test_zeros_of_an_array_that_may_read_so_are_told(self):
        bare = self.written("bare.toml", ARRAY.replace('"divider"\ndrive_ohm = 20.0\nload_ohm = 200.0', '"none"'))
        model = self.work / "bare.safetensors"
        self.succeed("simulate", "--array", bare, "--scene", "calibration", "--out", self.work / "bare")
        self.succeed(
            *self.calibrate_arguments(
                model, array=bare, frames=self.work / "bare/frames.csv", loads=self.work / "bare/loads.csv"
            )
        )
        frames = self.written(
            "zeros.csv",
            "time_s,"
            + ",".join(f"r{k // 5}c{k % 5}" for k in range(20))
            + "\n"
            + "".join(f"{k},{','.join('0' * 20)}\n" for k in range(100)),
        )
        result = support.dermis(*self.run_arguments(self.work / "forces.csv", model=model, **{"in": frames}))
        line = "all readings of all 100 frames are 0: nothing touches the array, or it is not connected"
        self.assertEqual((result.returncode, result.stderr.splitlines()[-1]), (0, line))
        self.assertIn(line, support.dermis("doctor", "--model", model, "--in", frames).stdout)

    def test_rows_and_columns_of_the_loads_exchanged(self):
        square = self.written("square.toml", ARRAY.replace("cols = 5", "cols = 4"))
        self.succeed("simulate", "--array", square, "--scene", "calibration", "--out", self.work / "square")
        exchanged = re.sub(r"r(\d)c(\d)", r"r\2c\1", (self.work / "square/loads.csv").read_text())
        self.refuse(
            self.calibrate_arguments(
                self.work / "m.safetensors",
                array=square,
                frames=self.work / "square/frames.csv",
                loads=self.written("loads.csv", exchanged),
            ),
            ["exchange rows and columns", "r1c0 answers where they name r0c1", "12 of 12 taxels"],
        )
        model = self.work / "square.safetensors"
        self.succeed(
            *self.calibrate_arguments(
                model, array=square, frames=self.work / "square/frames.csv", loads=self.work / "square/loads.csv"
            )
        )
        for command in (("doctor", "recalibrate"), ("evaluate",)):
            self.refuse(
                (
                    *command,
                    "--model",
                    model,
                    "--frames",
                    self.work / "square/frames.csv",
                    "--loads",
                    self.work / "loads.csv",
                ),
                ["exchange rows and columns", "12 of 12 taxels"],
            )


class WrongDatasets(SmallArray):
    def refuse_dataset(self, options, places, more_recordings=(), status=2):
        frames = self.contacts / "frames.csv"
        command = ("dataset", frames, *more_recordings, "--format", "zarr", "--out", self.work / "set", *options)
        self.refuse(command, places, status)

    def frames_with(self, lines, cols=5):
        header = "time_s," + ",".join(f"r{k // cols}c{k % cols}" for k in range(4 * cols))
        rows = [f"{k / 100},{','.join(['5'] * 4 * cols)}" for k in range(lines)]
        return self.written("others.csv", "\n".join([header, *rows]) + "\n")

    def test_a_state_of_another_clock(self):
        state = self.written("joints.csv", "time_s,elbow\n1764480000,1\n1764480009.5,2\n")
        self.refuse_dataset(
            ("--state", state), [state, "its times are 1764480000.000 to 1764480009.500 s", "the frames of", "0.000 to"]
        )

    def test_a_state_whose_rows_go_back(self):
        state = self.written("joints.csv", "time_s,elbow\n0.5,1\n0.4,2\n")
        self.refuse_dataset(("--state", state), [f"{state}:3: time_s goes back"])

    def test_a_window_that_no_recording_fills(self):
        self.refuse_dataset(("--window", 900), ["window: no episode has 900 frames", "the longest that one can fill"])

    def test_a_hold_out_of_all_or_none(self):
        for wanted, place in (
            ("0.2", "there is 1 episode; give more recordings"),
            ("0", "must be more than 0 and less than 1"),
            ("1.5", "must be more than 0 and less than 1"),
            ("frames.csv", "names all recordings, so none is left to train on"),
            ("other.csv", "'other.csv' is none of the recordings"),
        ):
            with self.subTest(wanted):
                self.refuse_dataset(("--hold-out", wanted), ["hold-out", place])

    def test_a_cut_without_marks(self):
        self.refuse_dataset(("--cut",), ["cut: ", "frames.csv' has no mark with a label", "or leave it out"])

    def test_recordings_of_two_arrays(self):
        other = self.frames_with(20, cols=6)
        self.refuse_dataset((), [other, "has other arrays than the first recording", "4x5"], [other])

    def test_a_model_of_another_array(self):
        other = self.frames_with(20, cols=6)
        command = ("dataset", other, "--format", "zarr", "--out", self.work / "set", "--model", self.model)
        self.refuse(command, [other, "is 4x6, its model is of 4x5"])

    def test_a_tare_that_cannot_be(self):
        self.refuse_dataset(("--tare",), ["tare: needs a model"])
        self.refuse_dataset(("--follow-drift",), ["follow-drift: needs a model"])
        short = self.frames_with(20)
        command = ("dataset", short, "--format", "zarr", "--out", self.work / "set", "--model", self.model, "--tare")
        self.refuse(command, [short, "is over before its tare, which takes 1 s and 10 frames"], 1)

    def test_steps_that_come_faster_than_frames_are_told(self):
        frames = self.frames_with(100)
        command = ("dataset", frames, "--format", "zarr", "--out", self.work / "set", "--fps", 300)
        result = support.dermis(*command)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("steps have no new frame: 300 steps a second", result.stderr)


class EveryCommand(SmallArray):
    """All that read frames, on frames that are missing, cut or beyond the ADC."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.threats = cls.root / "threats.toml"
        cls.threats.write_text('[[threat]]\nname = "hard"\nquantity = "contact_force"\nlimit_n = 1e6\n')
        cls.labels = cls.root / "labels.csv"
        cls.labels.write_text(
            "id,first,last,class\n" + "".join(f"{k},{5 * k},{5 * k},{'hand' if k % 2 else 'foot'}\n" for k in range(40))
        )
        cls.classes = cls.root / "classes"
        cls.recording = cls.root / "rec.mcap"
        for step in (
            ("recognise", "learn", "--in", cls.contacts / "frames.csv", "--labels", cls.labels, "--out", cls.classes),
            ("convert", cls.contacts / "frames.csv", cls.recording),
        ):
            result = support.dermis(*step)
            if result.returncode != 0:
                raise AssertionError(f"{step}: {result.stderr}")

    def with_forces(self, frames):
        """Commands that compute forces, and what each writes."""
        out = self.work / "out.csv"
        yield self.run_arguments(out, **{"in": frames}), out
        yield self.evaluate_arguments(frames=frames), None
        yield ("watch", "--threats", self.threats, "--model", self.model, "--in", frames), None
        yield (
            ("replay", frames, "--speed", 0, "--model", self.model, "--out", self.work / "replayed.csv"),
            self.work / "replayed.csv",
        )
        yield (
            ("record", "--from", frames, "--model", self.model, "--out", self.work / "forces.mcap"),
            self.work / "forces.mcap",
        )
        yield (
            ("image", "--in", frames, "--model", self.model, "--frame", 150, "--out", self.work / "forces.png"),
            self.work / "forces.png",
        )

    def all_commands(self, frames):
        yield from self.with_forces(frames)
        yield self.calibrate_arguments(self.work / "model", frames=frames, loads=self.contacts / "loads.csv"), None
        yield ("convert", frames, self.work / "frames.npy"), self.work / "frames.npy"
        yield ("dataset", frames, "--format", "zarr", "--out", self.work / "set"), self.work / "set"
        yield ("info", frames), None
        yield ("replay", frames, "--speed", 0, "--out", self.work / "counts.csv"), self.work / "counts.csv"
        yield ("record", "--from", frames, "--out", self.work / "counts.mcap"), self.work / "counts.mcap"
        yield ("image", "--in", frames, "--frame", 150, "--out", self.work / "counts.png"), self.work / "counts.png"
        yield (
            ("recognise", "learn", "--in", frames, "--labels", self.labels, "--out", self.work / "classes"),
            self.work / "classes",
        )
        yield (
            ("recognise", "--classes", self.classes, "--in", frames, "--out", self.work / "r.csv"),
            self.work / "r.csv",
        )
        yield ("emulate", "--protocol", "csv", "--in", frames, "--to", "stdout:", "--rate", 1000), None

    def test_a_header_alone(self):
        header = (self.contacts / "frames.csv").read_text().splitlines()[0]
        frames = self.written("frames.csv", header + "\n")
        for arguments, _ in self.all_commands(frames):
            with self.subTest(arguments[0]):
                self.refuse(arguments, [frames, "has no frame"])
        self.refuse(("doctor", "--model", self.model, "--in", frames), [frames, "has no frame"])

    def end_with(self, arguments, out, places):
        """Status 1 and one line; what could be read is written."""
        result = support.dermis(*arguments)
        self.assertEqual(result.returncode, 1, result.stderr)
        lines = [line for line in support.error_lines(result) if line.startswith("dermis: ")]
        self.assertEqual(len(lines), 1, result.stderr)
        for place in places:
            self.assertIn(str(place), lines[0])
        self.assertTrue(out is None or out.stat().st_size > 0)

    def test_a_recording_that_is_cut(self):
        cut = self.work / "cut.mcap"
        cut.write_bytes(self.recording.read_bytes()[:-20])
        for arguments, out in self.all_commands(cut):
            if arguments[0] in ("calibrate", "image"):
                continue  # too few frames to calibrate by; the picture is of a frame that is there
            with self.subTest(arguments[0]):
                self.end_with(arguments, out, [cut, "recover"])

    def test_a_table_that_is_cut(self):
        cut = self.written("cut.csv", (self.contacts / "frames.csv").read_text()[:-20])
        loads = self.work / "loads.csv"
        lines = (self.contacts / "loads.csv").read_text().splitlines()
        loads.write_text("\n".join(line for line in lines if not line.startswith("199,")) + "\n")
        self.end_with(
            self.run_arguments(self.work / "f.csv", **{"in": cut}), self.work / "f.csv", [f"{cut}:201", "cut off"]
        )
        self.end_with(self.evaluate_arguments(frames=cut, loads=loads), None, [f"{cut}:201", "cut off"])
        self.end_with(("info", cut), None, [cut, "cut off"])
        self.refuse(self.evaluate_arguments(frames=cut), [f"{cut}:201", "cut off", "loads.csv", "frame 199"])

    def scaled(self, factor):
        """The frames with all counts times `factor`."""
        lines = [line.split(",") for line in (self.contacts / "frames.csv").read_text().splitlines()]
        first = lines[0].index("r0c0")
        rows = [line[:first] + [str(factor * int(count)) for count in line[first:]] for line in lines[1:]]
        return self.written("scaled.csv", "".join(",".join(row) + "\n" for row in [lines[0], *rows]))

    def test_counts_that_are_a_hundred_times_too_large(self):
        frames = self.scaled(100)
        for arguments, out in self.with_forces(frames):
            with self.subTest(arguments[0]):
                self.end_with(arguments, out, ["have no force", "but the ADC gives 0 to 4095 (adc_bits = 12)"])
        self.refuse(
            self.calibrate_arguments(self.work / "m", frames=frames, loads=self.contacts / "loads.csv"),
            ["the ADC gives 0 to 4095 (adc_bits = 12)"],
        )

    def test_settling_beyond_the_end(self):
        self.refuse([*self.run_arguments(self.work / "f.csv"), "--settle", "1e6"], ["frames.csv", "settling"], status=1)


class WrongFiles(SmallArray):
    def test_what_a_file_is_is_said(self):
        recording = self.work / "rec.mcap"
        self.succeed("convert", self.contacts / "frames.csv", recording)
        frames = self.contacts / "frames.csv"
        out = self.work / "out"
        for arguments, file, kind in (
            (self.run_arguments(out, model=recording), recording, "an MCAP recording, not a safetensors file"),
            (self.run_arguments(out, model=frames), frames, "a table (CSV), not a safetensors file"),
            (self.calibrate_arguments(out, array=recording), recording, "an MCAP recording, not a TOML file"),
            (self.calibrate_arguments(out, array=frames), frames, "a table (CSV), not a TOML file"),
            (self.calibrate_arguments(out, loads=recording), recording, "an MCAP recording, not a table (CSV)"),
            (self.calibrate_arguments(out, loads=self.array), self.array, "a TOML file, not a table (CSV)"),
        ):
            with self.subTest(kind):
                self.refuse(arguments, [file, kind])
        for name in ("frames.csv", "frames.h5", "frames.npy", "frames.npz"):
            with self.subTest(name):
                wrong = self.work / name
                wrong.write_bytes(self.model.read_bytes())
                self.refuse(("info", wrong), [wrong, "is a safetensors file, not "])


class LoadsFile(SmallArray):
    def refuse_loads(self, lines, places):
        loads = self.written("loads.csv", "\n".join(["frame,kind,where,value", *lines]) + "\n")
        for arguments in (self.evaluate_arguments(loads=loads), self.calibrate_arguments(self.work / "m", loads=loads)):
            with self.subTest(arguments[0]):
                self.refuse(arguments, places if places == [""] else [loads, *places])

    def test_a_taxel_that_does_not_exist(self):
        self.refuse_loads(["0,force,all,0", "1,force,r4c0,10"], [":3", "r4c0", "4x5"])
        self.refuse_loads(["0,force,all,0", "1,force,r0c0:r3c5,10"], [":3", "r3c5", "4x5"])

    def test_a_frame_that_does_not_exist(self):
        self.refuse_loads(["0,force,all,0", "1500,force,r0c0,10"], [":3", "1500"])

    def test_a_value_that_is_no_load(self):
        for value in ("-1", "ten", "nan", "inf", ""):
            with self.subTest(value):
                self.refuse_loads(["0,force,all,0", f"1,force,r0c0,{value}"], [":3"])

    def test_unknown_kind(self):
        self.refuse_loads(["0,force,all,0", "1,weight,r0c0,1"], [":3", "weight"])

    def test_two_loads_on_one_taxel(self):
        self.refuse_loads(["0,force,all,0", "1,force,r0c0,1", "1,force,r0c0:r1c1,1"], [":4", "r0c0"])

    def test_another_header(self):
        loads = self.written("loads.csv", "frame,where,value\n0,all,0\n")
        self.refuse(self.evaluate_arguments(loads=loads), [loads, ":1", "frame,kind,where,value"])

    def test_no_load(self):
        self.refuse_loads([], [""])

    def test_a_pressure_on_an_array_without_area(self):
        array = self.written("array.toml", ARRAY.replace("taxel_area_mm2 = 38.48\n", ""))
        loads = self.written("loads.csv", "frame,kind,where,value\n0,force,all,0\n1,pressure,all,20\n")
        self.refuse(self.calibrate_arguments(self.work / "m", array=array, loads=loads), [":3", "taxel_area_mm2"])


class Calibration(SmallArray):
    def test_no_unloaded_frame(self):
        text = (self.calibration / "loads.csv").read_text()
        loads = self.written("loads.csv", "".join(line for line in text.splitlines(True) if ",all,0" not in line))
        self.refuse(self.calibrate_arguments(self.work / "m", loads=loads), ["unloaded", "force,all,0"])

    def test_only_unloaded_frames(self):
        loads = self.written("loads.csv", "frame,kind,where,value\n0,force,all,0\n1,force,all,0\n")
        self.refuse(self.calibrate_arguments(self.work / "m", loads=loads), ["zero"])

    def test_frames_and_loads_that_do_not_belong_together(self):
        lines = (self.calibration / "frames.csv").read_text().splitlines()
        flat = [lines[0]] + [f"{k}," + lines[1].partition(",")[2] for k in range(len(lines) - 1)]
        frames = self.written("frames.csv", "\n".join(flat) + "\n")
        self.refuse(self.calibrate_arguments(self.work / "m", frames=frames), ["no taxel answers"])

    def test_readings_beyond_the_adc(self):
        array = self.written("array.toml", ARRAY.replace("adc_bits = 12", "adc_bits = 8"))
        self.refuse(self.calibrate_arguments(self.work / "m", array=array), ["outside the ADC", "adc_bits"])

    def test_all_frames_settle(self):
        self.refuse([*self.calibrate_arguments(self.work / "m"), "--settle", "1e6"], ["settling"])

    def test_a_reference_in_volts_without_any_supply(self):
        """Readings cannot be put over a supply that nobody knows."""
        array = self.written("array.toml", ARRAY.replace("supply_v = 5.0\n", ""))
        rows = [line.split(",") for line in (self.calibration / "frames.csv").read_text().splitlines()]
        frames = self.written("frames.csv", "".join(",".join(row[:2] + row[3:]) + "\n" for row in rows))
        self.refuse(self.calibrate_arguments(self.work / "m", array=array, frames=frames), ["supply"])


class ModelFile(SmallArray):
    def test_cut_short_anywhere(self):
        whole = self.model.read_bytes()
        header = 8 + int.from_bytes(whole[:8], "little")
        cut = self.work / "model"
        for size in (
            0,
            1,
            7,
            8,
            9,
            header // 2,
            header - 1,
            header,
            header + 1,
            (header + len(whole)) // 2,
            len(whole) - 1,
        ):
            with self.subTest(size):
                cut.write_bytes(whole[:size])
                self.refuse(self.run_arguments(self.work / "f.csv", model=cut), [cut])
                self.refuse(self.evaluate_arguments(model=cut), [cut])

    def test_another_file(self):
        self.refuse(self.run_arguments(self.work / "f.csv", model=self.array), [self.array])
        self.refuse(self.run_arguments(self.work / "f.csv", model=self.contacts / "frames.csv"), ["frames.csv"])

    def test_tensors_that_were_exchanged_or_flipped(self):
        whole = self.model.read_bytes()
        changed = self.work / "model"
        for place in range(len(whole) - 1, len(whole) // 2, -997):
            with self.subTest(place):
                changed.write_bytes(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :])
                self.refuse(self.run_arguments(self.work / "f.csv", model=changed), [changed, "its checksum differs"])

    def test_a_model_without_a_checksum_is_used_and_a_line_says_so(self):
        whole = self.model.read_bytes()
        checksum = re.search(rb'"checksum":"fnv1a64:[0-9a-f]{16}",', whole).group()
        lost = self.work / "lost"
        lost.write_bytes(whole.replace(checksum, b" " * len(checksum)))
        self.refuse(self.run_arguments(self.work / "f.csv", model=lost), [lost, "has lost its checksum"])
        self.assertNotIn("has no checksum", dermis(*self.run_arguments(self.work / "f.csv", model=lost)).stderr)
        old = self.work / "old"
        old.write_bytes(lost.read_bytes().replace(b"dermis model 3", b"dermis model 2"))
        for arguments in (self.run_arguments(self.work / "f.csv", model=old), self.evaluate_arguments(model=old)):
            result = dermis(*arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stderr.count("has no checksum"), 1, result.stderr)
            self.assertIn(f"{old}: is of an older dermis", result.stderr)
        self.assertNotIn("checksum", dermis(*self.run_arguments(self.work / "f.csv")).stderr)

    def test_a_header_that_was_changed(self):
        whole = self.model.read_bytes()
        changed = self.work / "model"
        for old, new in (
            (b"dermis model 3", b"dermis model 9"),
            (b"rows = 4", b"rows = 3"),
            (b"networks.gain", b"networks.gone"),
            (b"F64", b"F32"),
        ):
            with self.subTest(new):
                self.assertIn(old, whole)
                changed.write_bytes(whole.replace(old, new, 1))
                self.refuse(self.run_arguments(self.work / "f.csv", model=changed), [changed])

    def test_a_model_of_another_array(self):
        other = self.work / "array.toml"
        other.write_text(ARRAY.replace("rows = 4", "rows = 5"))
        frames = self.work / "other"
        self.succeed("simulate", "--array", other, "--scene", "multitouch", "--frames", "5", "--out", frames)
        self.refuse(self.run_arguments(self.work / "f.csv", **{"in": frames / "frames.csv"}), [":1", "5x5", "4x5"])
        self.refuse(
            self.evaluate_arguments(frames=frames / "frames.csv", loads=frames / "loads.csv"), [":1", "5x5", "4x5"]
        )


class Outputs(SmallArray):
    def test_a_folder_that_does_not_exist(self):
        absent = self.work / "absent"
        self.refuse(self.run_arguments(absent / "f.csv"), [absent], status=1)
        self.refuse(self.calibrate_arguments(absent / "m"), [absent], status=1)

    def test_a_folder_as_file(self):
        folder = self.work / "folder"
        folder.mkdir()
        self.refuse(self.run_arguments(folder), [folder], status=1)
        self.refuse(self.calibrate_arguments(folder), [folder], status=1)

    def test_a_file_as_folder(self):
        file = self.written("file", "")
        self.refuse(["simulate", "--array", self.array, "--scene", "paper", "--out", file], [file], status=1)
        self.refuse([*self.evaluate_arguments(), "--report", file], [file], status=1)

    def test_a_folder_that_cannot_be_written(self):
        folder = self.work / "locked"
        folder.mkdir(mode=0o555)
        is_root = os.geteuid() == 0  # who may write everywhere
        user = support.as_nobody(self) if is_root else {}
        self.work.chmod(0o755)
        self.root.chmod(0o755)
        self.refuse(self.run_arguments(folder / "f.csv"), [folder], status=1, **user)
        self.refuse(
            ["simulate", "--array", self.array, "--scene", "paper", "--out", folder / "o"], [folder], status=1, **user
        )
        self.refuse([*self.evaluate_arguments(), "--report", folder / "o"], [folder], status=1, **user)
        self.refuse(["paper", "--report", folder / "o"], [folder], status=1, **user)  # before the work


if __name__ == "__main__":
    support.main()
