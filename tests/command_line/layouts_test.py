# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Streams and files in any form, as layouts describe them. The samples of ../shared/data/layouts give the frames
beside them, and a device is read as a file is."""

import json
import os
import pty
import threading
import tty
from pathlib import Path

import numpy
import support

LAYOUTS = Path(__file__).parents[2] / "examples/layouts"
SAMPLES = Path(__file__).parents[3] / "shared/data/layouts"
ENDINGS = (".stream", ".csv", ".txt", ".CSV", ".asc")
# Of those that hold several: the arrays whose frames stand beside them, along an axis of their own where there are two.
ARRAYS = {"two_feet_sum8": ("left", "right"), "quoted_matrices": ("Matrix_0", "Matrix_1"), "SENSORLOG": ("right",)}


class Layouts(support.SmallArray):
    def completed(self, *arguments):
        result = support.dermis(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)

    def frames_of(self, sample, layout, array):
        out = self.work / "out.npy"
        self.completed("convert", "--layout", layout, f"{sample}#{array}" if array else sample, out, "--force")
        return numpy.load(out)

    def test_samples_give_the_frames_that_are_in_them(self):
        if not SAMPLES.exists():
            self.skipTest("SKIPPED: ../shared/data/layouts is not there")
        for layout in sorted(LAYOUTS.glob("*.toml")):
            name = layout.stem
            with self.subTest(name):
                [sample] = (SAMPLES / (name + ending) for ending in ENDINGS if (SAMPLES / (name + ending)).exists())
                found = [self.frames_of(sample, layout, array) for array in ARRAYS.get(name, (None,))]
                wanted = numpy.load(SAMPLES / f"{name}.npy")
                found = numpy.stack(found, axis=1) if len(found) > 1 else found[0]
                numpy.testing.assert_array_equal(found, wanted.astype(numpy.float32))

    def test_every_layout_of_the_examples_has_a_sample(self):
        if not SAMPLES.exists():
            self.skipTest("SKIPPED: ../shared/data/layouts is not there")
        self.assertEqual(
            {path.stem for path in SAMPLES.glob("*.npy")} - {path.stem for path in LAYOUTS.glob("*.toml")},
            {"time_in_the_middle"},
        )

    def test_a_device_is_read_as_a_file_is(self):
        layout = self.written("mat.toml", '[layout]\nrows = 2\ncols = 2\nline = "Frame {frame}: {values}"\n')
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        lines = "".join(f"Frame {k}: {k} 1 2 3\r\n" for k in range(50)).encode()
        device = f"serial://{os.ttyname(theirs)}?layout={layout}&reconnect_s=0"
        sender = threading.Timer(0.5, os.write, (ours, lines))
        sender.start()
        out = self.work / "rec.mcap"
        self.completed("record", "--from", device, "--out", out, "--frames", 50)
        sender.join()
        os.close(ours)
        os.close(theirs)
        self.completed("convert", out, self.work / "rec.npy")
        numpy.testing.assert_array_equal(numpy.load(self.work / "rec.npy")[:, 0, 0], numpy.arange(50))

    def test_times_of_a_file_are_those_of_its_frames(self):
        layout = self.written("log.toml", '[layout]\nrows = 1\ncols = 2\nline = "{time_ms},{values}"\n')
        log = self.written("LOG.TXT", "time,a,b\n1000,1,2\n1010,3,4\n1030,5,6\n")
        self.completed("record", "--from", f"file:{log}?layout={layout}", "--out", self.work / "log.csv")
        self.completed("convert", "--layout", layout, log, self.work / "again.csv")
        for name in ("log.csv", "again.csv"):
            rows = [line.split(",")[0] for line in (self.work / name).read_text().splitlines()[1:]]
            self.assertEqual([round(float(row) - float(rows[0]), 6) for row in rows], [0.0, 0.01, 0.03], name)

    def test_every_command_reads_a_file_with_its_layout(self):
        layout = self.written("log.toml", '[layout]\nrows = 1\ncols = 2\nline = "{time_ms},{values}"\n')
        log = self.written("LOG.TXT", "".join(f"{10 * k},{k},7\n" for k in range(30)))
        by_name, by_keys = f"file:{log}?layout={layout}", f"file:{log}?rows=1&cols=2&line={{time_ms}},{{values}}"
        for source in (by_name, by_keys):
            said = support.dermis("info", source)
            self.assertIn("frames        30", said.stdout)
            self.assertIn("100.000 Hz", said.stdout)
            self.completed("convert", source, self.work / "out.npy", "--force")
            self.assertEqual(numpy.load(self.work / "out.npy").shape, (30, 1, 2))
            self.completed("image", "--in", source, "--out", self.work / "out.png", "--force")
        said = support.dermis("info", "--layout", layout, log)
        self.assertIn("frames        30", said.stdout)

    def test_info_lists_the_arrays_of_a_layout(self):
        feet = self.written(
            "feet.toml",
            '[layout]\nline = "{time_ms};{left};{right}"\n'
            + "".join(
                f'[[layout.array]]\nname = "{name}"\nrows = 1\ncols = {cols}\n'
                for name, cols in (("left", 2), ("right", 3))
            ),
        )
        log = self.written("feet.txt", "".join(f"{10 * k};{k},7;{k},8,9\n" for k in range(31)))
        said = support.dermis("info", "--layout", feet, log)
        for words in (
            "frames        62",
            "duration      0.300 s",
            "left  1x2  31 frames, 0 lost",
            "right  1x3  31 frames",
        ):
            self.assertIn(words, said.stdout)
        arrays = json.loads(support.dermis("info", "--json", "--layout", feet, log).stdout)["arrays"]
        self.assertEqual(
            [(array["name"], array["cols"], array["frames"]) for array in arrays], [("left", 2, 31), ("right", 3, 31)]
        )
        self.assertIn("taxels        1x3", support.dermis("info", "--layout", feet, f"{log}#right").stdout)

    def test_rates_that_are_not_as_described_and_late_frames_are_told(self):
        layout = self.written(
            "log.toml", '[layout]\nrows = 1\ncols = 2\nline = "{time_ms},{frame},{values}"\nrate = 100\n'
        )
        times = [9 * k for k in range(40)]
        times[20], times[21] = times[21], times[20]
        log = self.written("log.txt", "".join(f"{time},{time // 9},{time},7\n" for time in times))
        said = support.dermis("record", "--from", f"file:{log}?layout={layout}", "--out", self.work / "log.mcap")
        self.assertIn("111 frames a second where 100 are described", said.stderr)
        self.assertIn("0 lost, 0 damaged, 1 late", said.stderr)

    def test_units_of_layout_and_description_agree(self):
        log = self.written("log.txt", "0,1,2\n10,3,4\n")
        keys = '[layout]\nrows = 1\ncols = 2\nline = "{time_ms},{values}"\nunit = '
        array = '[array]\nname = "mat"\nrows = 1\ncols = 2\npitch_mm = [10, 10]\n[readout]\n'
        divider = 'circuit = "divider"\nidle_rows = "grounded"\ndrive_ohm = 20\nload_ohm = 200\nadc_bits = 12\n'
        counts = self.written("counts.toml", array + divider + "adc_reference_v = 5\nsupply_v = 5\n")
        record = ["record", "--out", self.work / "log.mcap", "--array", counts, "--from"]
        for unit, words in (("kPa", 'circuit = "pressure"'), ("newtons", 'circuit = "force"'), ("volts", "times 819")):
            layout = self.written(f"{unit}.toml", f'{keys}"{unit}"\n')
            self.refuse([*record, f"file:{log}?layout={layout}"], [f"readings are {unit}", words])
        self.completed(*record, f"file:{log}?layout={self.written('c.toml', keys + chr(34) + 'counts' + chr(34))}")

    def test_what_does_not_fit_is_one_line(self):
        layout = self.written("mat.toml", '[layout]\nrows = 2\ncols = 2\nline = "{row}: {values}"\n')
        wrong = self.written("wrong.toml", '[layout]\nrows = 2\ncols = 2\nline = "{row}: {vales}"\n')
        feet = self.written("feet.toml", (LAYOUTS / "two_feet_sum8.toml").read_text())
        text = self.written("it.txt", "hello\n0: 1 2\n1: x\n")
        out = self.work / "out.npy"
        convert = ["convert", text, out, "--layout"]
        self.refuse([*convert, layout], [f"'{text}'", f"do not fit {layout}", "line 3", "at 'x'", "a reading"])
        self.refuse([*convert, wrong], [f"{wrong}:4", "layout.line", "did you mean 'values'?"])
        self.refuse([*convert, feet], [str(feet), "several arrays", "left, right"])
        self.refuse([*convert, self.work / "none.toml"], ["none.toml"])
        self.refuse(["convert", text, self.work / "out.csv", "--layout", layout], ["no times", "give a rate"])
        self.assertFalse(out.exists())


if __name__ == "__main__":
    support.main()
