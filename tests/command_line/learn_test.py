# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`dermis recognise learn`: a data set in plain files becomes classes and predictions; what cannot be learned gives one
line. `dermis recognise` names what it has learned."""

import csv
import io
import json
import random
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import support
from support import dermis, error_lines, files_below

ROWS, COLS = 8, 6
KINDS = ("dot", "bar", "pair")


def npy(path, rows):
    """Floats as numpy.save writes them."""
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({len(rows)}, {len(rows[0])}), }}\n".encode()
    data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data)


def touch(generator, kind):
    row, col = generator.randint(1, 3), generator.randint(1, 4)
    taxels = {
        "dot": [(row, col)],
        "bar": [(row, col), (row + 1, col), (row + 2, col)],
        "pair": [(row, col), (row + 4, col)],
    }[kind]
    frame = [generator.random() for _ in range(ROWS * COLS)]
    for r, c in taxels:
        frame[r * COLS + c] += generator.uniform(300, 900)
    return frame


class Learn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)
        generator = random.Random(1)
        self.kinds = [KINDS[i % len(KINDS)] for i in range(36)]
        npy(self.work / "frames.npy", [touch(generator, kind) for kind in self.kinds])
        (self.work / "arrays.csv").write_text(f"array,rows,cols,first_column\nskin,{ROWS},{COLS},0\n")
        self.write_labels(f"t{i},{i},{i},{kind}" for i, kind in enumerate(self.kinds))

    def write_labels(self, lines):
        (self.work / "labels.csv").write_text("\n".join(["id,first,last,class", *lines]) + "\n")

    def learn(self, *arguments, **replaced):
        files = {
            name: self.work / f"{name}.{ending}"
            for name, ending in (("frames", "npy"), ("arrays", "csv"), ("labels", "csv"))
        }
        files.update(replaced)
        return dermis(
            "recognise", "learn", *(part for name, path in files.items() for part in (f"--{name}", path)), *arguments
        )

    def refuse(self, *places, arguments=None, **replaced):
        before = files_below(self.work)
        result = self.learn(*(arguments or ("--out", self.work / "c.safetensors")), **replaced)
        self.assertEqual(result.returncode, 2, result.stderr)
        lines = error_lines(result)
        self.assertEqual(len(lines), 1, result.stderr)
        for place in places:
            self.assertIn(str(place), lines[0])
        self.assertEqual(files_below(self.work), before)

    def test_classes_and_a_report(self):
        result = self.learn("--out", self.work / "c.safetensors")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.work / "c.safetensors").exists())
        self.assertIn("3 classes, 36 examples", result.stdout)
        self.assertIn("cross-validated accuracy", result.stdout)
        self.assertIn("in order of time", result.stdout)
        self.assertIn("answered", result.stdout)

    def test_predictions_of_splits(self):
        (self.work / "splits.csv").write_text("split,id\n" + "".join(f"s{i % 2},t{i}\n" for i in range(18)))
        result = self.learn("--splits", self.work / "splits.csv", "--predictions", self.work / "p.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        header, *lines = (self.work / "p.csv").read_text().splitlines()
        self.assertEqual(header, "split,id,class,probability")
        answers = [line.split(",") for line in lines]
        self.assertEqual({(split, label) for split, label, *_ in answers}, {(f"s{i % 2}", f"t{i}") for i in range(18)})
        right = sum(answer == self.kinds[int(label[1:])] for _, label, answer, _ in answers)
        self.assertGreaterEqual(right, 15)
        self.assertTrue(all(1 / 3 < float(probability) <= 1 for *_, probability in answers))

    def test_predictions_of_classes_that_were_never_learned(self):
        lines = [
            f"o0,{'unknown' if kind == 'pair' else 'known' if i < 12 else 'train'},t{i}"
            for i, kind in enumerate(self.kinds)
        ]
        (self.work / "open.csv").write_text("\n".join(["split,role,id", *lines]) + "\n")
        result = self.learn("--open", self.work / "open.csv", "--open-predictions", self.work / "o.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        header, *answers = (self.work / "o.csv").read_text().splitlines()
        self.assertEqual(header, "split,id,class,probability,unknown_score")
        self.assertEqual(len(answers), 12 + 8)
        self.assertTrue(all(answer.split(",")[2] in ("dot", "bar", "unknown") for answer in answers))

    def recognised(self, *arguments):
        self.assertEqual(self.learn("--out", self.work / "c.safetensors").returncode, 0)
        return dermis(
            "recognise",
            "--classes",
            self.work / "c.safetensors",
            "--in",
            f"file:{self.work / 'frames.npy'}?rate=30",
            *arguments,
        )

    def test_poses_are_recognised_frame_by_frame(self):
        result = self.recognised()
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = list(csv.DictReader(io.StringIO(result.stdout)))
        self.assertEqual(len(lines), len(self.kinds))
        right = sum(line["likeliest"] == kind for line, kind in zip(lines, self.kinds))
        self.assertGreaterEqual(right, 33)
        self.assertTrue(all((line["class"] == "unknown") == bool(line["reason"]) for line in lines))

    def test_it_ends_when_nobody_takes_what_is_recognised(self):
        self.assertEqual(self.learn("--out", self.work / "c.safetensors", "--rate", 200).returncode, 0)
        frames = f"file:{self.work / 'frames.npy'}?rate=200&rows={ROWS}&cols={COLS}"
        device = [support.BINARY, "emulate", "--protocol", "dermis", "--in", frames, "--loop", "--to", "stdout:"]
        with subprocess.Popen(device, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as endless:
            self.addCleanup(endless.kill)
            result = dermis(
                "recognise",
                "--classes",
                self.work / "c.safetensors",
                "--in",
                "stdin:?protocol=dermis",
                "--out",
                "/dev/full",
                stdin=endless.stdout,
            )
            self.assertIsNone(endless.poll())
            endless.kill()
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(error_lines(result)), 1, result.stderr)
        self.assertIn("/dev/full", result.stderr)

    def test_lines_of_json(self):
        result = self.recognised("--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([line["first"] for line in lines], list(range(len(self.kinds))))
        for line in lines:
            self.assertEqual(sorted(line["probabilities"]), sorted(KINDS))
            self.assertAlmostEqual(sum(line["probabilities"].values()), 1.0)

    def test_classes_and_frames_that_do_not_fit(self):
        self.assertEqual(self.learn("--out", self.work / "c.safetensors").returncode, 0)
        npy(self.work / "other.npy", [[1.0] * 12])
        for classes, source, place in (
            (self.work / "absent", "frames.npy", "absent"),
            (self.work / "frames.npy", "frames.npy", "frames.npy"),
            (self.work / "c.safetensors", "other.npy", "other.npy"),
        ):
            with self.subTest(place):
                result = dermis("recognise", "--classes", classes, "--in", f"file:{self.work / source}?rate=30")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(len(error_lines(result)), 1, result.stderr)
                self.assertIn(place, result.stderr)

    def test_options_that_belong_together(self):
        self.refuse("--out", "--splits", arguments=["--rate", 30])
        self.refuse("--splits", "--predictions", arguments=["--splits", self.work / "labels.csv"])
        self.refuse("--open", "--open-predictions", arguments=["--open", self.work / "labels.csv"])
        self.refuse("--rate", arguments=["--out", self.work / "c.safetensors", "--rate", -1])
        self.refuse("--rate: must be 0.001 to 1e6", arguments=["--out", self.work / "c.safetensors", "--rate", "2e6"])

    def test_each_missing_file(self):
        for name in ("frames", "arrays", "labels"):
            with self.subTest(name):
                self.refuse(self.work / "absent", **{name: self.work / "absent"})
        self.refuse(self.work / "absent", arguments=["--out", self.work / "c", "--extra", self.work / "absent"])
        self.refuse(
            self.work / "absent", arguments=["--splits", self.work / "absent", "--predictions", self.work / "p.csv"]
        )

    def test_labels_that_overlap(self):
        self.write_labels(["a,0,3,dot", "b,3,5,bar"])
        self.refuse("labels.csv", "'b' overlaps label 'a'", "frame 3")

    def test_one_example(self):
        self.write_labels(["a,0,0,dot", "b,1,1,bar", "c,2,2,bar"])
        self.refuse("class 'dot' has one example")

    def test_one_class(self):
        self.write_labels(["a,0,0,dot", "b,1,1,dot"])
        self.refuse("all examples are of class 'dot'")

    def test_ten_thousand_classes(self):
        npy(self.work / "frames.npy", [[1.0] * (ROWS * COLS)] * 10000)
        self.write_labels(f"t{i},{i},{i},class {i}" for i in range(10000))
        self.refuse("10000 classes", "1000")

    def test_a_reading_that_is_no_number(self):
        npy(self.work / "frames.npy", [[1.0] * (ROWS * COLS)] * 35 + [[float("nan")] * (ROWS * COLS)])
        self.refuse("frames.npy", "reading 0 of frame 35 is not a number")

    def test_a_class_called_unknown(self):
        self.write_labels(["a,0,0,dot", "b,1,1,unknown"])
        self.refuse("labels.csv:3", "'unknown'")

    def test_arrays_that_do_not_fit(self):
        (self.work / "arrays.csv").write_text("array,rows,cols,first_column\nskin,9,6,0\n")
        self.refuse("arrays.csv", "'skin'", "48 readings")


if __name__ == "__main__":
    support.main()
