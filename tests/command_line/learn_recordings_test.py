# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis recognise learn --in`: recordings become classes, by the forces of a model or by tared readings, which
`dermis recognise` names in other recordings."""

import bisect
import csv
import io
import json
import random
import re
import signal
import subprocess
import time
import unittest

import support
from support import SmallArray, dermis

ROWS, COLS, RATE, IDLE = 6, 6, 50, 75


class Forces(SmallArray):
    """Each frame of the scene "multitouch" has loads of its own: few taxels are pressed, or many."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.kinds = {}
        for seed in (3, 4, 5):
            folder = cls.root / f"scene{seed}"
            recording = cls.root / f"rec{seed}.mcap"
            for step in (
                (
                    "simulate",
                    "--array",
                    cls.array,
                    "--scene",
                    "multitouch",
                    "--frames",
                    150,
                    "--seed",
                    seed,
                    "--out",
                    folder,
                ),
                ("convert", folder / "frames.csv", recording),
            ):
                result = dermis(*step)
                if result.returncode != 0:
                    raise AssertionError(f"{step}: {result.stderr}")
            pressed = [0] * 150
            with open(folder / "loads.csv") as loads:
                for load in csv.DictReader(loads):
                    pressed[int(load["frame"])] += load["where"] != "all" and float(load["value"]) > 0.3
            cls.kinds[seed] = {
                frame: "few" if count <= 2 else "many"
                for frame, count in enumerate(pressed)
                if 0 < count <= 2 or count >= 6
            }

    def labels(self, *seeds, header="id,first,last,class,recording"):
        lines = [
            f"r{seed}f{frame},{frame},{frame},{kind},rec{seed}.mcap"
            for seed in seeds
            for frame, kind in self.kinds[seed].items()
        ]
        return self.written("labels.csv", "\n".join([header, *lines]) + "\n")

    def learn(self, *seeds, model=True, labels=None, arguments=()):
        recordings = [self.root / f"rec{seed}.mcap" for seed in seeds]
        return [
            "recognise",
            "learn",
            "--in",
            *recordings,
            "--labels",
            labels or self.labels(*seeds),
            "--out",
            self.work / "c.safetensors",
            *(("--model", self.model) if model else ()),
            *arguments,
        ]

    def recognised(self, seed):
        output = self.succeed(
            "recognise",
            "--classes",
            self.work / "c.safetensors",
            "--model",
            self.model,
            "--in",
            self.root / f"rec{seed}.mcap",
        )
        return {int(line["last"]): line for line in csv.DictReader(io.StringIO(output))}

    def right_share(self, seed):
        lines = self.recognised(seed)
        right = [lines[frame]["likeliest"] == kind for frame, kind in self.kinds[seed].items()]
        return sum(right) / len(right)

    def test_what_was_learned_from_recordings_is_recognised_in_another(self):
        output = self.succeed(*self.learn(3, 4))
        self.assertIn("2 folds of whole recordings, subjects or sessions", output)
        self.assertIn("at 1 frames a second", output)
        self.assertGreaterEqual(self.right_share(3), 0.95)
        self.assertGreaterEqual(self.right_share(5), 0.9)

    def test_the_same_frames_give_the_same_answer_in_every_file(self):
        self.succeed(*self.learn(3))
        recorded = self.recognised(3)
        output = self.succeed(
            "recognise",
            "--classes",
            self.work / "c.safetensors",
            "--model",
            self.model,
            "--in",
            self.root / "scene3" / "frames.csv",
        )
        from_text = {int(line["last"]): line for line in csv.DictReader(io.StringIO(output))}
        self.assertEqual(len(recorded), 150)
        for frame, line in recorded.items():
            self.assertEqual(
                (line["likeliest"], line["probability"]),
                (from_text[frame]["likeliest"], from_text[frame]["probability"]),
            )

    def test_a_report_compares_with_other_estimators(self):
        self.refuse(
            [
                "recognise",
                "learn",
                "--in",
                self.root / "rec3.mcap",
                "--labels",
                self.labels(3),
                "--report",
                self.work / "page",
            ],
            ["nothing would be written", "--out"],
        )
        self.succeed(*self.learn(3, 4, arguments=["--report", self.work / "page"]))
        page = (self.work / "page" / "index.html").read_text()
        shares = {
            name: float(share)
            for name, share in re.findall(r"(dermis|nearest frame|BP network)</th><td[^>]*>([\d.]+) %", page)
        }
        self.assertEqual(set(shares), {"dermis", "nearest frame"})
        self.assertGreaterEqual(shares["dermis"], 90)
        self.assertTrue((self.work / "page" / "confusion.svg").exists())

    def test_the_network_of_the_paper_is_compared_with_the_recipe(self):
        table = self.succeed(
            "paper",
            "learn",
            "--in",
            self.root / "rec3.mcap",
            self.root / "rec4.mcap",
            "--model",
            self.model,
            "--labels",
            self.labels(3, 4),
        )
        shares = {name: float(share) for name, share in re.findall(r"(?m)^(\S.*?) +([\d.]+) %", table)}
        self.assertEqual(set(shares), {"dermis", "nearest frame", "BP network"})
        self.assertGreaterEqual(shares["BP network"], 85)

    def evaluate(self, seed, *arguments):
        return [
            "evaluate",
            "--classes",
            self.work / "c.safetensors",
            "--in",
            self.root / f"rec{seed}.mcap",
            "--model",
            self.model,
            "--labels",
            self.labels(seed),
            *arguments,
        ]

    def test_classes_are_judged_by_a_recording_that_they_have_not_seen(self):
        self.succeed(*self.learn(3, 4))
        text = self.succeed(*self.evaluate(5))
        self.assertIn("accuracy", text)
        self.assertIn("calibration error", text)
        self.assertIn("answered", text)
        judged = json.loads(self.succeed(*self.evaluate(5, "--json")))
        self.assertEqual(judged["judged"], len(self.kinds[5]))
        self.assertEqual(judged["classes"], ["few", "many"])
        self.assertEqual(sum(judged["confusion"]), judged["judged"])
        self.assertAlmostEqual(judged["accuracy"], self.right_share(5))
        self.assertLessEqual(judged["calibration_error"], 0.1)

    def test_classes_are_judged_by_plain_files_and_by_new_classes(self):
        frames = [
            "--frames",
            self.work / "frames.npy",
            "--arrays",
            self.written("arrays.csv", "array,rows,cols,first_column\nskin,4,5,0\n"),
        ]
        self.assertEqual(dermis("convert", self.root / "rec3.mcap", self.work / "frames.npy").returncode, 0)
        labels = self.labels(3)
        self.succeed("recognise", "learn", *frames, "--labels", labels, "--out", self.work / "c.safetensors")
        text = self.succeed("evaluate", "--classes", self.work / "c.safetensors", *frames, "--labels", labels)
        self.assertIn(f"of {len(self.kinds[3])}, calibration error", text)
        first, *others = labels.read_text().splitlines()
        labels.write_text(
            "\n".join([first, *others[:10], *(line.replace("few", "new") for line in others[10:])]) + "\n"
        )
        text = self.succeed("evaluate", "--classes", self.work / "c.safetensors", *frames, "--labels", labels)
        self.assertRegex(text, r"of \d+ examples of classes that were not learned, \d+ are called unknown")

    def test_what_cannot_be_judged(self):
        self.succeed(*self.learn(3))
        classes = self.work / "c.safetensors"
        self.refuse(self.evaluate(4)[:-2], ["--labels"])
        self.refuse(self.evaluate(4, "--report", self.work / "page"), ["--classes", "--report"])
        self.refuse(
            ["evaluate", "--classes", classes, "--in", self.root / "rec4.mcap", "--labels", self.labels(4)],
            [classes, "--model"],
        )
        self.refuse([*self.evaluate_arguments(), "--labels", self.labels(4)], ["--labels", "--classes"])
        never = self.written("never.csv", "id,first,last,class\na,0,0,never\n")
        self.refuse([*self.evaluate(4), "--label", "subject"], ["subject"])
        self.refuse(
            [
                "evaluate",
                "--classes",
                classes,
                "--model",
                self.model,
                "--in",
                self.root / "rec4.mcap",
                "--labels",
                never,
            ],
            [classes, "no label"],
        )

    def test_one_recording_needs_no_column_that_names_it(self):
        lines = [f"f{frame},{frame},{frame},{kind}" for frame, kind in self.kinds[3].items()]
        labels = self.written("labels.csv", "\n".join(["id,first,last,class", *lines]) + "\n")
        output = self.succeed(*self.learn(3, labels=labels))
        self.assertIn("in order of time", output)

    def test_labels_that_do_not_fit(self):
        header = "id,first,last,class,recording\na,0,0,few,rec3.mcap\n"
        for line, places in (
            ("b,150,150,many,rec3.mcap", ["rec3.mcap", "'b'", "frame 150", "150 frames"]),
            ("b,0,1,many,rec3.mcap", ["rec3.mcap", "'b' overlaps label 'a'", "frame 0"]),
            ("b,0,1,many,rec9.mcap", [":3", "'rec9.mcap'", "rec3.mcap, rec4.mcap"]),
            ("a,0,0,many,rec4.mcap", ["'a' stands twice"]),
        ):
            with self.subTest(line):
                self.refuse(
                    self.learn(3, 4, labels=self.written("labels.csv", header + line + "\n")), ["labels.csv", *places]
                )

    def test_several_recordings_need_the_column_that_names_them(self):
        labels = self.written("labels.csv", "id,first,last,class\na,0,0,few\nb,1,1,many\n")
        self.refuse(self.learn(3, 4, labels=labels), ["labels.csv", "recording"])

    def test_recordings_that_do_not_go_together(self):
        twin = self.work / "folder"
        twin.mkdir()
        (twin / "rec3.mcap").write_bytes((self.root / "rec3.mcap").read_bytes())
        arguments = self.learn(3)
        self.refuse([*arguments[:3], twin / "rec3.mcap", *arguments[3:]], ["two recordings are called rec3.mcap"])
        other = self.written("other.csv", "time_s,r0c0,r0c1\n0,1,2\n1,2,3\n")
        self.refuse(
            [*self.learn(3, model=False)[:3], other, *self.learn(3, model=False)[3:]], ["other.csv", "1x2", "4x5"]
        )
        self.refuse(
            ["recognise", "learn", "--in", "sim:idle?rate=100&rows=4&cols=5", *self.learn(3)[3:]], ["record it first"]
        )

    def test_examples_that_are_named_twice_or_not_at_all(self):
        labels, out = self.labels(3), self.work / "c.safetensors"
        self.refuse(
            ["recognise", "learn", "--labels", labels, "--out", out], ["name the examples", "recordings", "frames"]
        )
        self.refuse(["recognise", "learn", "--labels", labels, "--out", out, "--frames", labels], ["with their arrays"])
        self.refuse(
            ["recognise", "learn", "--labels", labels, "--out", out, "--frames", labels, "--arrays", labels, "--tare"],
            ["--frames", "tare"],
        )
        self.refuse(self.learn(3, arguments=["--frames", labels]), ["--in", "excludes frames"])

    def test_classes_and_sources_that_do_not_fit(self):
        self.succeed(*self.learn(3))
        recording, classes = self.root / "rec4.mcap", self.work / "c.safetensors"
        self.refuse(["recognise", "--classes", classes, "--in", recording], [classes, "--model"])
        self.refuse(
            ["recognise", "--classes", classes, "--model", self.model, "--in", "sim:idle?rows=3&cols=3"], ["3x3"]
        )
        self.succeed(*self.learn(3, model=False))
        self.refuse(["recognise", "--classes", classes, "--model", self.model, "--in", recording], [classes, "--model"])
        other = self.written("other.csv", "time_s,r0c0,r0c1\n0,1,2\n1,2,3\n")
        self.refuse(["recognise", "--classes", classes, "--in", other], ["other.csv"])


class TaredReadings(unittest.TestCase):
    """Taps and holds of a device whose readings rest at 100 counts and more."""

    setUp = SmallArray.setUp
    succeed = SmallArray.succeed
    refuse = SmallArray.refuse
    written = SmallArray.written

    def recording(self, name, seed, touches=24, idle=IDLE):
        """Returns what happens: first and last frame, and kind."""
        generator = random.Random(seed)
        offsets = [generator.uniform(100, 300) for _ in range(ROWS * COLS)]
        frames = [offsets] * idle
        happened = []
        for touch in range(touches):
            kind = ("tap", "hold")[touch % 2]
            length = generator.randint(5, 8) if kind == "tap" else generator.randint(35, 50)
            taxel = generator.randrange(ROWS * COLS)
            force = generator.uniform(300, 800)
            happened.append((len(frames), len(frames) + length - 1, kind))
            frames += [[o + force * (i == taxel) for i, o in enumerate(offsets)]] * length
            frames += [offsets] * generator.randint(20, 30)
        header = ",".join(["time_s", *(f"r{r}c{c}" for r in range(ROWS) for c in range(COLS))])
        lines = [
            ",".join([f"{i / RATE}", *(f"{value + generator.gauss(0, 1):.0f}" for value in frame)])
            for i, frame in enumerate(frames)
        ]
        text = self.written(f"{name}.csv", "\n".join([header, *lines]) + "\n")
        self.succeed("convert", text, self.work / f"{name}.mcap")
        return happened

    def learn(self, happened, *arguments):
        lines = [f"t{i},{first},{last},{kind}" for i, (first, last, kind) in enumerate(happened)]
        labels = self.written("labels.csv", "\n".join(["id,first,last,class", *lines]) + "\n")
        return [
            "recognise",
            "learn",
            "--in",
            self.work / "taught.mcap",
            "--labels",
            labels,
            "--out",
            self.work / "c.safetensors",
            "--tare",
            *arguments,
        ]

    def test_gestures_are_found_and_named_in_another_recording(self):
        self.succeed(*self.learn(self.recording("taught", 1)))
        happened = self.recording("other", 2)
        output = self.succeed(
            "recognise", "--classes", self.work / "c.safetensors", "--tare", "--in", self.work / "other.mcap"
        )
        lines = list(csv.DictReader(io.StringIO(output)))
        self.assertEqual(len(lines), len(happened))
        for line, (first, last, kind) in zip(lines, happened):
            self.assertEqual(line["likeliest"], kind)
            self.assertLessEqual(abs(int(line["first"]) - first), 2)
            self.assertLessEqual(abs(int(line["last"]) - last), 2)

    def test_no_example_lies_in_the_tare(self):
        self.refuse(
            self.learn([(RATE - 1, RATE + 3, "tap"), *self.recording("taught", 1)]),
            ["labels.csv", "taught.mcap", "'t0'", f"first {RATE} frames are the tare"],
        )

    def test_a_recording_that_ends_before_it_is_tared(self):
        self.recording("taught", 1, touches=0, idle=RATE // 2)
        self.refuse(self.learn([(0, 1, "tap")]), ["taught.mcap", "1 s"])

    def test_further_readings_tell_apart_what_feels_the_same(self):
        def joints(name, happened):
            """The elbow is bent in every second pair of touches, alike for taps and holds."""
            lines = [
                f"{name}.mcap,{(first - 3) / RATE},{90 * (i % 4 >= 2)},{i % 3}"
                for i, (first, _, _) in enumerate(happened)
            ]
            lines += [
                f"{name}.mcap,{(last + first) / 2 / RATE},{90 * (i % 4 >= 2) + 1},{i % 3}"
                for i, (first, last, _) in enumerate(happened)
            ]
            return sorted(lines, key=lambda line: float(line.split(",")[1]))

        def bent(happened):
            return [
                (first, last, f"{kind}_{'bent' if i % 4 >= 2 else 'straight'}")
                for i, (first, last, kind) in enumerate(happened)
            ]

        taught, other = self.recording("taught", 1, touches=40), self.recording("other", 2)
        header = ["recording,time_s,elbow,wrist"]
        table = self.written("joints.csv", "\n".join(header + joints("taught", taught) + joints("other", other)) + "\n")
        learned = dermis(*self.learn(bent(taught), "--extra", table))
        self.assertEqual(learned.returncode, 0, learned.stderr)
        # Between touches the table is silent.
        self.assertRegex(learned.stderr, r"joints.csv: \d+ of \d+ frames of taught.mcap lack a reading")
        recognise = ["recognise", "--classes", self.work / "c.safetensors", "--tare", "--in", self.work / "other.mcap"]
        self.refuse(recognise, ["c.safetensors", "--extra"])
        result = dermis(*recognise, "--extra", table)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = list(csv.DictReader(io.StringIO(result.stdout)))
        self.assertEqual(len(lines), len(other))
        right = sum(line["likeliest"] == kind for line, (_, _, kind) in zip(lines, bent(other)))
        self.assertGreaterEqual(right, 0.9 * len(other))
        self.refuse(
            [*self.learn(bent(taught)), "--extra", self.written("away.csv", "time_s,elbow\n99999,1\n")],
            ["away.csv", "'elbow'", "time_s"],
        )
        self.refuse(
            [*self.learn(bent(taught)), "--extra", self.written("text.csv", "time_s,elbow\n0,bent\n")],
            ["text.csv:2", "'bent'"],
        )

    def test_poses_without_a_rate_are_told_so(self):
        happened = self.recording("taught", 1)
        labels = "".join(
            f"{i},{first + 2},{first + 2},{'left' if i % 2 else 'right'}\n" for i, (first, _, _) in enumerate(happened)
        )
        arrays = self.written("arrays.csv", f"array,rows,cols,first_column\nskin,{ROWS},{COLS},0\n")
        self.assertEqual(dermis("convert", self.work / "taught.csv", self.work / "taught.npy").returncode, 0)
        self.succeed(
            "recognise",
            "learn",
            "--frames",
            self.work / "taught.npy",
            "--arrays",
            arrays,
            "--labels",
            self.written("labels.csv", "id,first,last,class\n" + labels),
            "--out",
            self.work / "c.safetensors",
        )
        recognise = ["recognise", "--classes", self.work / "c.safetensors", "--in", self.work / "taught.csv"]
        result = dermis(*recognise)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(support.error_lines(result)), 1)
        self.assertIn("does not know the rate", result.stderr)
        self.refuse([*recognise, "--rate", 10], ["--rate", "c.safetensors"])


class Suit(SmallArray):
    """Two arrays at once. Each frame of the scene "multitouch" has loads of its own: one array is pressed more than the
    other."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.suit = cls.root / "suit.toml"
        cls.suit.write_text(
            "".join(
                f'[[array]]\nname = "{name}"\nfrom = "sim:multitouch?rows=4&cols=5&rate=50&seed={seed}"\n'
                f'model = "{cls.model}"\n'
                for seed, name in enumerate(("left", "right"), 5)
            )
        )
        cls.recordings = [cls.root / "monday.mcap", cls.root / "friday.mcap"]
        for recording in cls.recordings:
            cls.record(recording)

    @classmethod
    def record(cls, recording, patience=120):
        """Serves the suit until 3 s of it are in the recording."""
        process = subprocess.Popen(
            [support.BINARY, "serve", "--port", "0", "--suit", cls.suit, "--record", recording],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        process.stdout.close()
        try:
            for _ in range(10 * patience):
                time.sleep(0.1)
                info = dermis("info", recording, "--json") if recording.exists() else None
                if info and info.stdout and json.loads(info.stdout)["frames"] >= 300:
                    break
            process.send_signal(signal.SIGINT)
            if process.wait(patience) != 0:
                raise AssertionError("the recording failed")
        finally:
            process.kill()

    def totals(self, recording, array):
        """Time and total force of each frame."""
        forces = self.work / "forces.csv"
        result = dermis("run", "--model", self.model, "--in", f"{recording}#{array}", "--out", forces)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(forces) as lines:
            return [
                (float(line["time_s"]), sum(float(line[f"r{r}c{c}"]) for r in range(4) for c in range(5)))
                for line in csv.DictReader(lines)
            ]

    def kinds(self, recording):
        """Which array is pressed more, by the number of the frame of the first."""
        left, right = self.totals(recording, "left"), self.totals(recording, "right")
        times = [time_s for time_s, _ in right]
        kinds = {}
        for frame, (time_s, force) in enumerate(left):
            last = bisect.bisect_right(times, time_s) - 1
            other = right[last][1] if last >= 0 else 0.0
            if max(force, other) > 3 * min(force, other):
                kinds[frame] = "left" if force > other else "right"
        return kinds

    def labels(self, recording):
        lines = [f"{frame},{frame},{frame},{kind}" for frame, kind in self.kinds(recording).items()]
        return self.written(f"{recording.stem}.csv", "\n".join(["id,first,last,class", *lines]) + "\n")

    def learn(self, *arguments):
        """At one frame a second, so that no frame is looked at together with those before."""
        monday = self.recordings[0]
        return [
            "recognise",
            "learn",
            "--in",
            monday,
            "--labels",
            self.labels(monday),
            "--rate",
            1,
            "--out",
            self.work / "c.safetensors",
            *arguments,
        ]

    def test_what_was_learned_from_two_arrays_is_recognised_in_both(self):
        _, friday = self.recordings
        for model in (["--model", self.suit], []):
            with self.subTest(model=model):
                self.succeed(*self.learn(*model))
                classes = ["--classes", self.work / "c.safetensors", *model]
                output = self.succeed("recognise", *classes, "--in", friday)
                answers = {int(line["last"]): line["likeliest"] for line in csv.DictReader(io.StringIO(output))}
                kinds = self.kinds(friday)
                right = sum(answers[frame] == kind for frame, kind in kinds.items())
                self.assertGreaterEqual(right / len(kinds), 0.9)
                judged = json.loads(
                    self.succeed("evaluate", *classes, "--in", friday, "--labels", self.labels(friday), "--json")
                )
                self.assertGreaterEqual(judged["accuracy"], 0.9)

    def test_arrays_and_models_that_do_not_fit(self):
        monday, friday = self.recordings
        self.refuse(self.learn("--model", self.model), [monday, f"{monday}#left", "suit.toml", "--model"])
        other = self.written("other.toml", self.suit.read_text().replace('"right"', '"top"'))
        self.refuse(self.learn("--model", other), [monday, "'top'", "'left', 'right'"])
        self.succeed(*self.learn("--model", self.suit))
        classes = ["--classes", self.work / "c.safetensors"]
        self.refuse(["recognise", *classes, "--in", friday, "--model", other], ["other.toml", "'right'"])
        self.refuse(["recognise", *classes, "--in", friday], [classes[1], "--model"])
        self.refuse(
            ["recognise", *classes, "--in", f"{friday}#left", "--model", self.model], [classes[1], "1 arrays", "had 2"]
        )
        self.succeed(
            "recognise", "learn", "--in", f"{monday}#left", "--labels", self.work / "monday.csv", "--out", classes[1]
        )
        self.refuse(["recognise", *classes, "--in", friday], [friday, "name one", "'left', 'right'"])


if __name__ == "__main__":
    support.main()
