# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis doctor`: a healthy array is called healthy, and each fault by its name, its place and its first frame."""

import json
import random

import support
from support import SmallArray, dermis, error_lines


class Doctor(SmallArray):
    def recording(self, faults):
        """Frames of several contacts with faults."""
        physics = self.written("physics.toml", "[faults]\n" + faults)
        self.succeed(
            "simulate",
            "--array",
            self.array,
            "--scene",
            "multitouch",
            "--frames",
            300,
            "--seed",
            5,
            "--physics",
            physics,
            "--out",
            self.work / "faulty",
        )
        return self.work / "faulty" / "frames.csv"

    def examine(self, frames, *options):
        return dermis("doctor", "--model", self.model, "--in", frames, *options)

    def unhealthy(self, frames):
        result = self.examine(frames, "--json")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(error_lines(result)), 1)
        self.assertIn("not healthy", result.stderr)
        report = json.loads(result.stdout)
        self.assertFalse(report["healthy"])
        return report

    def test_a_healthy_array(self):
        result = self.examine(self.calibration / "frames.csv")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertTrue(result.stdout.endswith("healthy\n"), result.stdout)
        report = json.loads(self.examine(self.calibration / "frames.csv", "--json").stdout)
        self.assertTrue(report["healthy"])
        self.assertEqual((report["faults"], report["problems"], report["frames_unsolved"]), ([], [], 0))
        self.assertAlmostEqual(report["noise_counts"], 1.04, delta=0.2)
        self.assertAlmostEqual(report["offset_drift"], 0.0, delta=0.05)

    def test_contacts_are_no_noise_and_noise_is_no_contact(self):
        contacts = self.recording("open_rows = []\n")
        report = json.loads(self.examine(contacts, "--json").stdout)
        self.assertEqual(report["problems"], [])
        physics = self.written("physics.toml", "[environment]\nadc_noise_lsb = 4\n")
        self.succeed(
            "simulate",
            "--array",
            self.array,
            "--scene",
            "idle",
            "--frames",
            100,
            "--physics",
            physics,
            "--out",
            self.work / "noisy",
        )
        report = self.unhealthy(self.work / "noisy" / "frames.csv")
        self.assertIn("counts of noise", report["problems"][0])

    def test_counts_without_a_model(self):
        frames = self.calibration / "frames.csv"
        result = dermis("doctor", "--in", frames, "--array", self.array, "--loads", self.calibration / "loads.csv")
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertTrue(result.stdout.endswith("nothing to doubt in these counts\n"), result.stdout)
        report = json.loads(dermis("doctor", "--in", frames, "--json").stdout)
        self.assertEqual((report["healthy"], report["problems"], report["remarks"]), (True, [], []))

    def test_doubts_of_counts_without_a_model(self):
        lines = (self.calibration / "frames.csv").read_text().splitlines()
        first = lines[0].split(",").index("r0c0")
        rows = 1 + max(int(name[1 : name.index("c")]) for name in lines[0].split(",")[first:])
        cols = (len(lines[0].split(",")) - first) // rows

        def turned(fields):
            taxels = fields[first:]
            return fields[:first] + [value for row in reversed(range(rows)) for value in taxels[row * cols :][:cols]]

        flipped = [lines[0]] + [",".join(turned(line.split(","))) for line in lines[1:]]
        frames = self.written("flipped.csv", "\n".join(flipped) + "\n")
        self.assertEqual(dermis("doctor", "--in", frames).returncode, 0)  # nothing but the loads can tell
        result = dermis("doctor", "--in", frames, "--loads", self.calibration / "loads.csv")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("turn the frames (flip_rows=1)", result.stdout)
        self.assertIn("the readings are doubtful: 1 finding", result.stderr)

    def test_times_that_cannot_be(self):
        header = "time_s," + ",".join(f"r{k // 4}c{k % 4}" for k in range(16))
        noise = random.Random(1)

        def written(times):
            rows = [[f"{time:.4f}", *(str(noise.randint(18, 22)) for _ in range(16))] for time in times]
            return self.written("times.csv", "\n".join([header, *map(",".join, rows)]) + "\n")

        halves = [k * 0.02 for k in range(200)]
        for times, words in (
            ([1 + time for time in halves] + [0.9 + time for time in halves], "the clock restarts at frame 200"),
            ([1035.2 * time for time in halves], "look like milliseconds"),
            (halves + [4 + 2 * time for time in halves], "the rate jumps from 50 to 25 frames a second"),
        ):
            frames = written(times)
            result = dermis("doctor", "--in", frames)
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn(words, result.stdout)
            [doubt] = json.loads(dermis("info", frames, "--json").stdout)["doubts"]
            self.assertIn(words, doubt)
        self.assertEqual(json.loads(dermis("info", written(halves), "--json").stdout)["doubts"], [])

    def test_nothing_but_zeros_without_a_model(self):
        lines = (self.calibration / "frames.csv").read_text().splitlines()
        first = lines[0].split(",").index("r0c0")
        zeros = [",".join(line.split(",")[:first] + ["0"] * (line.count(",") + 1 - first)) for line in lines[1:101]]
        frames = self.written("zeros.csv", "\n".join([lines[0], *zeros]) + "\n")
        result = dermis("doctor", "--in", frames)
        self.assertEqual(result.returncode, 0, result.stderr)  # it may be untouched
        self.assertIn("remark: every reading of 100 frames is 0", result.stdout)
        lowers = self.written(
            "lowers.toml", self.array.read_text().replace("adc_bits", "pressure_raises_reading = false\nadc_bits", 1)
        )
        result = dermis("doctor", "--in", frames, "--array", lowers)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("every reading of 100 frames is 0", result.stdout)

    def test_an_open_row_in_plain_words(self):
        frames = self.recording("open_rows = [2]\nfrom_frame = 120\n")
        result = self.examine(frames)
        self.assertEqual(result.returncode, 1)
        sentence = next(line for line in result.stdout.splitlines() if line.startswith("row 2 is open"))
        for part in (
            "since frame 120",
            "check the wire or crimp of row 2",
            "5 taxels are masked",
            "the rest is still good",
        ):
            self.assertIn(part, sentence)
        report = self.unhealthy(frames)
        self.assertEqual(
            [(fault["kind"], fault["place"], fault["since_frame"]) for fault in report["faults"]],
            [("silent_row", "row 2", 120)],
        )

    def test_other_faults_by_name(self):
        for faults, kind, place in (
            ("open_columns = [1]", "silent_column", "column 1"),
            ("supplied_columns = [3]", "supplied_column", "column 3"),
            ("dead_taxels = ['r1c3']", "dead_taxel", "taxel r1c3"),
            ("stuck_taxels = ['r3c0']", "stuck_taxel", "taxel r3c0"),
        ):
            with self.subTest(faults):
                report = self.unhealthy(self.recording(faults + "\n"))
                self.assertEqual([(fault["kind"], fault["place"]) for fault in report["faults"]], [(kind, place)])

    def test_a_fault_that_comes_and_goes(self):
        report = self.unhealthy(self.recording("open_columns = [1]\nfrom_frame = 50\nuntil_frame = 100\n"))
        self.assertIn(report["faults"][0]["since_frame"], (50, 51))  # four taxels near the noise
        self.assertLessEqual(report["faults"][0]["until_frame"], 120)
        self.assertIn("loose contact", report["problems"][0])

    def held(self, name, frame, count):
        """The same frame of the calibration, 20 times a second, with a count of noise."""
        header, *lines = (self.calibration / "frames.csv").read_text().splitlines()
        first = next(k for k, column in enumerate(header.split(",")) if column == "r0c0")
        _, *cells = lines[frame].split(",")
        noise = random.Random(7)
        for i in range(count):
            readings = [str(max(0, int(cell) + noise.choice((-1, 0, 1)))) for cell in cells[first - 1 :]]
            lines[i:] = [",".join([f"{0.05 * i:.2f}", *cells[: first - 1], *readings])]
        return self.written(name, "\n".join([header, *lines]) + "\n")

    def test_a_load_that_was_never_released(self):
        pressed = self.held("pressed.csv", self.pressed_frame(), 150)
        [problem] = self.unhealthy(pressed)["problems"]
        self.assertRegex(
            problem, r"^r\dc\d (was|.*were) never released and reads? [\d.]+ N: take off what lies there, or tare"
        )
        result = dermis(*self.run_arguments(self.work / "forces.csv", **{"in": pressed}))
        self.assertEqual((result.returncode, error_lines(result)), (0, [problem]))

    def test_a_tare_under_a_load_is_refused_until_it_is_forced(self):
        pressed = self.held("pressed.csv", self.pressed_frame(), 60)
        out = self.work / "forces.csv"
        self.refuse(
            (*self.run_arguments(out, **{"in": pressed}), "--tare"),
            ["pressed.csv", "not tared", " N: take it off and tare again", "--tare-force", "nothing is written"],
            1,
        )
        self.assertFalse(out.exists())
        result = dermis(*self.run_arguments(out, **{"in": pressed}), "--tare-force")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(" ".join(error_lines(result)), r"^the tare takes [\d.]+ N on \S+ as zero$")
        idle = self.held("idle.csv", 0, 60)
        self.assertEqual(dermis(*self.run_arguments(out, **{"in": idle}), "--tare").returncode, 0)

    def pressed_frame(self):
        """The first of the calibration in which a force of 5 N or more is said."""
        lines = (self.calibration / "loads.csv").read_text().splitlines()[1:]
        loads = [line.split(",") for line in lines]
        return next(int(frame) for frame, kind, _, value in loads if kind == "force" and float(value) >= 5)

    def test_forces_are_masked_and_run_says_so(self):
        frames = self.recording("open_rows = [2]\n")
        result = dermis(*self.run_arguments(self.work / "forces.csv", **{"in": frames}))
        self.assertEqual(result.returncode, 0)
        self.assertIn("a diagnosis tells which", result.stderr)
        last = (self.work / "forces.csv").read_text().splitlines()[-1].split(",")
        self.assertIn("line_fault", last[1])
        self.assertEqual([k for k, cell in enumerate(last[2:]) if cell == "nan"], list(range(10, 15)))

    def test_faults_that_the_array_cannot_have(self):
        for faults, places in (
            ("open_rows = [4]", ["faults.open_rows", "below 4"]),
            ("open_rows = 1", ["physics.toml:2", "faults.open_rows", "list"]),
            ("dead_taxels = ['r9c9']", ["faults.dead_taxels", "r9c9"]),
            ("dead_taxels = [9]", ["faults.dead_taxels", "texts"]),
            ("broken_rows = [1]", ["broken_rows"]),
        ):
            with self.subTest(faults):
                physics = self.written("physics.toml", "[faults]\n" + faults + "\n")
                self.refuse(
                    (
                        "simulate",
                        "--array",
                        self.array,
                        "--scene",
                        "idle",
                        "--physics",
                        physics,
                        "--out",
                        self.work / "o",
                    ),
                    places,
                )


if __name__ == "__main__":
    support.main()
