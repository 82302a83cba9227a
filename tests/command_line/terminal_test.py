# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What people type and read at a terminal: streams by "-", help in words, models in words, units, nearest names."""

import json
import os
import signal
import subprocess

import support
from support import SmallArray, dermis

# Each command that reads or writes a model or classes, a recording or a folder, by an option of that.
NO_STREAMS = (
    ("calibrate", "--frames"),
    ("calibrate", "--out"),
    ("doctor check", "--model"),
    ("doctor", "--model"),
    ("evaluate", "--model"),
    ("evaluate", "--classes"),
    ("evaluate", "--report"),
    ("image", "--model"),
    ("recognise learn", "--model"),
    ("recognise learn", "--out"),
    ("recognise learn", "--report"),
    ("paper", "--report"),
    ("paper calibrate", "--bank"),
    ("paper evaluate", "--bank"),
    ("doctor recalibrate", "--model"),
    ("doctor recalibrate", "--out"),
    ("recognise", "--classes"),
    ("recognise", "--model"),
    ("record", "--model"),
    ("replay", "--model"),
    ("run", "--model"),
    ("simulate", "--out"),
    ("top", "--model"),
    ("watch", "--model"),
)


class Terminal(SmallArray):
    def piped(self, *arguments, frames=None):
        """What a command makes of frames at its standard input."""
        text = (frames or self.contacts / "frames.csv").read_text()
        result = dermis(*arguments, input=text)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_a_dash_is_the_standard_input_and_output(self):
        self.succeed(*self.run_arguments(self.work / "forces.csv"))
        forces = (self.work / "forces.csv").read_text()
        self.assertEqual(self.piped("run", "--model", self.model, "--in", "-", "--out", "-"), forces)
        frames = (self.contacts / "frames.csv").read_text()
        self.assertEqual(self.piped("convert", "-", "-"), frames)
        self.assertEqual(self.piped("record", "--from", "-", "--out", "-"), frames)
        self.assertEqual(self.piped("replay", "-", "--speed", 0, "--out", "-"), frames)
        self.piped("convert", "-", self.work / "rec.mcap")
        self.assertEqual(json.loads(dermis("info", self.work / "rec.mcap", "--json").stdout)["frames"], 200)

    def test_a_dash_is_a_table_where_the_shell_leads_it_to_a_file(self):
        frames, copy = self.contacts / "frames.csv", self.work / "copy.csv"
        for command in (("convert", "-", "-"), ("record", "--from", "-", "--out", "-")):
            with self.subTest(command[0]), frames.open() as read, copy.open("w") as written:
                result = subprocess.run(
                    [support.BINARY, *command], stdin=read, stdout=written, stderr=subprocess.PIPE, timeout=60
                )
                self.assertEqual((result.returncode, copy.read_text()), (0, frames.read_text()), result.stderr)

    def test_who_has_read_enough_ends_a_command_in_silence(self):
        for command in (self.run_arguments("-", **{"in": "sim:touches?frames=20000"}), ("help", "run")):
            reader, writer = os.pipe()
            os.close(reader)
            with self.subTest(command[0]), open(writer, "wb") as closed:
                result = subprocess.run(
                    [support.BINARY, *map(str, command)], stdout=closed, stderr=subprocess.PIPE, timeout=60
                )
                self.assertEqual((result.returncode, result.stderr), (128 + signal.SIGPIPE, b""))

    def test_every_command_that_reads_frames_once_reads_a_pipe(self):
        for command in (
            ("doctor", "--model", self.model, "--in", "-"),
            ("image", "--in", "-", "--out", self.work / "map.png"),
            ("emulate", "--in", "-", "--to", "stdout:", "--protocol", "dermis", "--rate", 1000),
            ("evaluate", "--model", self.model, "--frames", "-", "--loads", self.contacts / "loads.csv"),
            (
                "evaluate",
                "--model",
                self.model,
                "--frames",
                "-",
                "--loads",
                self.contacts / "loads.csv",
                "--report",
                self.work / "report",
            ),
        ):
            with self.subTest(command[0]):
                with (self.contacts / "frames.csv").open("rb") as frames:
                    cat = subprocess.Popen(["cat"], stdin=frames, stdout=subprocess.PIPE)
                    self.addCleanup(cat.wait)
                    self.addCleanup(cat.stdout.close)
                    result = subprocess.run(
                        [support.BINARY, *map(str, command)], stdin=cat.stdout, capture_output=True, timeout=60
                    )
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_two_options_cannot_share_a_stream(self):
        self.refuse(
            self.evaluate_arguments(frames="-", loads="-"), ["--loads: --frames reads the standard input; name a file"]
        )
        self.refuse(
            (*self.run_arguments("-"), "--totals", "-"), ["--totals: --out writes the standard output; name a file"]
        )

    def test_a_stream_that_is_a_file_of_the_command_is_found(self):
        frames = self.written("f.csv", (self.contacts / "frames.csv").read_text())
        with frames.open() as stream:
            self.refuse(
                self.run_arguments(frames, **{"in": "-"}), ["--out: is the file of --in; name another"], stdin=stream
            )

    def test_what_is_no_table_is_no_stream(self):
        for command, option in NO_STREAMS:
            with self.subTest(command=command, option=option):
                self.refuse((*command.split(), option, "-"), [f"{option}: '-' is no file; name one"])
        self.refuse(("image", "--in", self.contacts / "frames.csv", "--out", "-"), ["--out: '-' is no file; name one"])
        self.refuse(("info", "-"), ["'-' is no file; name one"])
        self.refuse(("info", "recover", "-", "--out", self.work / "r.mcap"), ["'-' is no file; name one"])

    def test_help_is_a_command_too(self):
        self.assertEqual(self.succeed("help"), dermis("--help").stdout)
        for command in (("run",), ("circuit",), ("circuit", "forward")):
            self.assertEqual(self.succeed("help", *command), dermis(*command, "--help").stdout)
        self.refuse(("help", "evalute"), ["unknown command 'evalute'; did you mean 'evaluate'?"])
        self.refuse(("help", "run", "fast"), ["'fast' is one argument too many"])
        self.assertRegex(self.succeed("help"), r"(?m)^Begin:\n  serve {3,}(.*\n)*dermis help COMMAND: .*guides: .*\n\Z")

    def test_a_command_below_another_is_named(self):
        self.refuse(("recover", "a.mcap"), ["unknown command 'recover'; there is 'dermis info recover'"])
        self.refuse(("doctor", "--model", self.model), ["--in is required"])

    def test_a_model_is_told_in_words(self):
        text = self.succeed("info", self.model)
        for line in (
            r"format +model",
            r"name +small",
            r"taxels +4 rows x 5 columns",
            r"circuit +divider",
            r"drive +20 ohm",
            r"load +200 ohm",
            r"ADC +12 bit",
            r"labelled frames +1500",
            r"loads +0.5 to 50 N",
            r"temperature +-0.5 to 50.5 C",
            r"memory +none was learned",
            r"uncertainty +readings \u00b1 ",
            r"dead taxels +none",
            r"frames hash +fnv1a64:",
            r"dermis version +\d",
        ):
            self.assertRegex(text, r"(?m)^" + line)
        told = json.loads(self.succeed("info", self.model, "--json"))
        self.assertEqual((told["format"], told["array"]["circuit"]), ("model", "divider"))
        self.assertEqual(told["calibration"]["loads"], "0.5 to 50 N")
        self.assertIn('name = "small"', told["array_toml"])

    def test_a_description_is_told_in_words(self):
        text = self.succeed("info", self.array)
        self.assertRegex(text, r"(?m)^format +description of an array\nname +small\ntaxels +4 rows x 5 columns$")
        self.refuse(("info", self.written("other.toml", "[suit]\nname = 1\n")), ["other.toml:1"])

    def test_run_says_where_the_frames_went(self):
        forces, contacts = self.work / "forces.csv", self.work / "contacts.csv"
        result = dermis(*self.run_arguments(forces), "--contacts", contacts)
        self.assertEqual(result.stderr, f"200 frames: forces in {forces}, contacts in {contacts}\n")
        result = dermis(*self.run_arguments("-", **{"in": "sim:idle?frames=1"}))
        self.assertEqual(result.stderr, "1 frame: forces in the standard output\n")
        result = dermis(*self.run_arguments(self.work / "late.csv", **{"in": "sim:touches?frames=150"}), "--settle", 1)
        self.assertRegex(result.stderr, r"^50 frames, 100 skipped: forces in .*late.csv\n")

    def test_a_number_that_is_none_is_told_in_a_line(self):
        for arguments, words in (
            (("serve", "--port", "abc"), "--port: 'abc' is no whole number; write one such as 200"),
            (("serve", "--port", "80x"), "--port: '80x' is no whole number; write one such as 200"),
            (("serve", "--port", "99999"), "--port: must be 0 to 65535"),
            (("simulate", "--rate", "fast"), "--rate: 'fast' is no number"),
            (("circuit", "advise", "--range", "1k", "10"), "--range: '1k' is no number"),
        ):
            self.refuse(arguments, [words])

    def test_a_scene_in_nearly_its_name_is_known(self):
        self.refuse(
            self.run_arguments(self.work / "f.csv", **{"in": "sim:contact"}),
            ["sim:contact", 'did you mean "contacts"?'],
        )
        self.refuse(
            ("simulate", "--array", self.array, "--scene", "two-weights", "--out", self.work / "s"),
            ['did you mean "two_weights"?'],
        )
        self.refuse(
            ("simulate", "--array", self.array, "--scene", "earthquake", "--out", self.work / "s"),
            ["unknown; there are calibration, uniform"],
        )

    def test_a_weight_in_two_arguments_is_told_how_to_write_it(self):
        self.refuse(
            ("doctor", "check", "--model", self.model, "--in", self.contacts / "frames.csv", "--weight", 200, "g"),
            ["'g' is one argument too many; write '200 g' in quotes, or 200g (see"],
        )
        self.refuse(("doctor", "check", "--weight", 200, 5), ["'5' is one argument too many (see"])

    def test_a_weight_may_be_given_by_its_mass(self):
        array = self.written(
            "direct.toml", '[array]\nrows = 1\ncols = 1\n[readout]\ncircuit = "force"\nadc_noise_counts = 0.01\n'
        )
        lines = [f"{k / 10},{2 if 30 <= k % 200 < 120 else 0}" for k in range(600)]
        frames = self.written("press.csv", "time_s,r0c0\n" + "\n".join(lines) + "\n")
        told = {
            dermis("doctor", "check", "--model", array, "--in", frames, "--weight", weight).stdout
            for weight in ("0.2 kg", "200g", "1.96133", "1.96133 N")
        }
        said = dermis("doctor", "check", "--model", array, "--in", frames, "--weight", "200 g").stderr
        self.assertIn("--weight: 200 g, taken for 1.961 N\n", said)
        self.assertEqual(len(told), 1)
        self.assertRegex(told.pop(), r"^weight +1.961 N, put on 3 times\n")
        self.refuse(
            ("doctor", "check", "--model", array, "--in", frames, "--weight", 200),
            ["3 read something else, the last 2 N; if it weighs 200 grams, write '200 g'"],
            status=1,
        )
        self.refuse(
            ("doctor", "check", "--model", array, "--in", frames, "--weight", "two"),
            ["--weight: 'two' is no force; write newtons, or a unit as in 2 N, 200 g or 0.2 kg"],
        )

    def test_loads_in_grams_are_newtons(self):
        loads = [line.split(",") for line in (self.calibration / "loads.csv").read_text().splitlines()]
        grams = [
            ",".join(line if k == 0 or line[1] != "force" else [*line[:3], f"{float(line[3]) / 0.00980665!r} g"])
            for k, line in enumerate(loads)
        ]
        loads = self.written("g.csv", "\n".join(grams) + "\n")
        result = dermis(*self.calibrate_arguments(self.work / "grams", loads=loads))
        self.assertIn("loads 0.5 to 50 N", result.stdout)
        self.assertIn(f"{loads}: 50.98581064889641 g, taken for 0.5 N\n", result.stderr)

    def test_loads_in_kilograms_are_told_by_the_name_of_their_column(self):
        lines = [line.split(",") for line in (self.calibration / "loads.csv").read_text().splitlines()[1:]]
        kilograms = [",".join([*line[:3], repr(float(line[3]) / 9.80665)]) for line in lines]
        loads = self.written("kg.csv", "\n".join(["frame,kind,where,kg", *kilograms]) + "\n")
        result = dermis(*self.calibrate_arguments(self.work / "kilograms", loads=loads))
        self.assertIn("loads 0.5 to 50 N", result.stdout)
        self.assertRegex(result.stderr, rf"{loads}: \S+ kg, taken for \S+ N\n")

    def test_nothing_on_the_terminal_is_written_as_in_a_program(self):
        said = [
            self.succeed(*self.calibrate_arguments(self.work / "m")),
            self.succeed(*self.evaluate_arguments()),
            dermis("doctor", "--model", self.model, "--in", self.contacts / "frames.csv").stdout,
            self.succeed("info", self.model),
        ]
        for text in said:
            self.assertNotIn("+-", text)
            self.assertNotRegex(text.replace("adc_bits", "").replace(str(self.work), ""), r"\b[a-z]+_[a-z_]+\b")


if __name__ == "__main__":
    support.main()
