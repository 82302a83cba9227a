# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Files of other systems, made here as their programs write them, and arrays whose readings are forces."""

import csv
import json
from pathlib import Path

import h5py
import numpy
import support
from foreign_files import ALL, COLS, FRAMES, RATE, ROWS, TIMED, UNTIMED, counts

PRESSURES = """[array]
name = "mat"
rows = 4
cols = 5
taxel_area_mm2 = 100.0

[readout]
circuit = "pressure"
adc_noise_counts = 0.1
"""


class Imports(support.SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mat = cls.root / "mat.toml"
        cls.mat.write_text(PRESSURES)
        for name, write in ALL.items():
            write(cls.root / name)

    def source(self, name):
        path = self.root / name
        return path if name in TIMED else f"file:{path}?rate={RATE:g}&rows={ROWS}&cols={COLS}"

    def rows(self, path):
        with open(path) as file:
            header, *rows = csv.reader(file)
        return header, rows

    def test_every_file_becomes_the_same_frames(self):
        for name in ALL:
            with self.subTest(name):
                out = self.work / "out.csv"
                untimed = ("--rate", RATE, "--rows", ROWS, "--cols", COLS) if name in UNTIMED else ()
                result = support.dermis("convert", self.root / name, out, "--force", *untimed)
                self.assertEqual(result.returncode, 0, result.stderr)
                header, rows = self.rows(out)
                values = numpy.array([[float(cell or "nan") for cell in row] for row in rows])
                first = header.index("r0c0")
                numpy.testing.assert_array_equal(values[:, first:].reshape(-1, ROWS, COLS), counts())
                numpy.testing.assert_allclose(values[:, 0] - values[0, 0], numpy.arange(FRAMES) / RATE, atol=1e-9)

    def test_every_command_takes_every_file(self):
        for name in ALL:
            with self.subTest(name):
                out, contacts = self.work / "forces.csv", self.work / "contacts.csv"
                source = self.source(name)
                self.succeed("run", "--model", self.mat, "--in", source, "--out", out, "--contacts", contacts)
                _, rows = self.rows(out)
                self.assertEqual(len(rows), FRAMES)
                self.assertTrue(all(row[1] == "ok" for row in rows))
                self.assertAlmostEqual(sum(map(float, rows[-1][2:])), 25.0, places=3)  # 250 kPa on 100 mm2
                header, touched = self.rows(contacts)
                self.assertEqual({row[header.index("id")] for row in touched}, {"1"})
                self.assertAlmostEqual(float(touched[-1][header.index("force_n")]), 25.0, delta=0.1)
                self.assertAlmostEqual(float(touched[-1][header.index("x_mm")]), 20.0, delta=0.2)
                self.succeed("image", "--in", source, "--model", self.mat, "--frame", 40, "--out", self.work / "a.svg")
                self.succeed("image", "--in", source, "--frame", 40, "--out", self.work / "b.png")
                recording = self.work / "rec.mcap"
                result = support.dermis("record", "--from", source, "--model", self.mat, "--out", recording, "--force")
                self.assertEqual(result.returncode, 0, result.stderr)
                info = json.loads(self.succeed("info", recording, "--json"))
                self.assertEqual((info["frames"], info["rows"], info["cols"]), (FRAMES, ROWS, COLS))
                self.assertIn('circuit = "pressure"', info["array_toml"])
                self.succeed("image", "--in", recording, "--frame", 40, "--out", self.work / "c.svg")
                self.assertIn(" N<", (self.work / "c.svg").read_text())
                self.succeed("replay", recording, "--speed", 0, "--model", self.mat, "--out", self.work / "again.csv")
                self.assertEqual(
                    (self.work / "again.csv").read_text().splitlines()[1].split(",")[2:],
                    out.read_text().splitlines()[1].split(",")[2:],
                )

    def test_calibration_and_evaluation_take_them_too(self):
        """The counts of a calibration, as a stack without times and as one of the arrays of an archive."""
        _, rows = self.rows(self.calibration / "frames.csv")
        values = numpy.array([[float(cell) for cell in row[3:]] for row in rows]).reshape(-1, ROWS, COLS)
        stack, archive = self.work / "c.npy", self.work / "c.npz"
        numpy.save(stack, values)
        numpy.savez(archive, labels=values[:3], frames=values)
        header = "time_s," + ",".join(f"r{r}c{c}" for r in range(ROWS) for c in range(COLS)) + "\n"
        plain = self.written(
            "c.csv",
            header
            + "".join(f"{k / 100}," + ",".join(f"{v:g}" for v in frame.flat) + "\n" for k, frame in enumerate(values)),
        )
        expected = None
        for source in (plain, f"file:{stack}?rate=100", f"file:{archive}%23frames?rate=100"):
            model = self.work / "model"
            result = support.dermis(*self.calibrate_arguments(model, frames=source))  # poor without temperatures
            self.assertEqual(result.returncode, 0, result.stderr)
            judged = self.succeed(
                *self.evaluate_arguments(model=model, frames=source, loads=self.calibration / "loads.csv"), "--json"
            )
            expected = expected or judged
            self.assertEqual(judged, expected)
        self.refuse(self.calibrate_arguments(self.work / "m", frames="sim:idle?rate=100"), ["record it first"])

    def test_info_names_the_format(self):
        formats = {
            "a.asf": "Tekscan ASCII",
            "xsensor.csv": "XSENSOR ASCII",
            "a.lst": "novel listing",
            "a.dsa": "Weiss DSA",
            "a.txt": "text matrix",
            "pictures": "PNG",
            "a.npz": "NumPy archive",
        }
        for name, expected in formats.items():
            with self.subTest(name):
                info = json.loads(self.succeed("info", self.root / name, "--json"))
                self.assertEqual(info["format"], expected)
                self.assertEqual((info["frames"], info["rows"], info["cols"]), (FRAMES, ROWS, COLS))
                self.assertEqual(info["duration_s"] is None, name in UNTIMED)

    def same_frames(self, source, *options):
        """The frames of a file are those of all files here, by `convert`."""
        out = self.work / "out.npy"
        result = support.dermis("convert", source, out, "--force", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        numpy.testing.assert_array_equal(numpy.load(out), counts())

    def test_datasets_of_any_name(self):
        path = self.work / "episode.h5"
        with h5py.File(path, "w") as file:
            file["/observations/tactile"] = counts()
            file["/observations/flat"] = counts().reshape(FRAMES, -1)
            file["/observations/qpos"] = numpy.zeros((FRAMES, 7, 3))
        self.same_frames(f"{path}#/observations/tactile", "--rate", RATE)
        self.same_frames(f"{path}#observations/flat", "--rate", RATE, "--rows", ROWS, "--cols", COLS)
        self.refuse(
            ("info", path),
            ["name one", "'/observations/tactile' (60 x 4 x 5)", "'/observations/qpos' (60 x 7 x 3)"],
        )
        self.refuse(("info", f"{path}#/tactile"), ["no dataset '/tactile'", "'/observations/tactile'"])
        self.refuse(("record", "--from", f"{path}#/observations/tactile", "--out", self.work / "a.mcap"), ["rate"])
        source = f"file:{path}%23/observations/tactile?rate={RATE:g}"
        result = support.dermis("record", "--from", source, "--out", self.work / "a.mcap")
        self.assertEqual(result.returncode, 0, result.stderr)
        with h5py.File(path, "a") as file:
            file["/observations/time_s"] = 5.0 + numpy.arange(FRAMES) / RATE
        info = json.loads(self.succeed("info", f"{path}#/observations/tactile", "--json"))
        self.assertEqual((info["format"], info["frames"], info["rate_hz"]), ("HDF5 dataset", FRAMES, RATE))

    def test_links_out_of_a_file_are_no_datasets(self):
        inner, outer = self.work / "inner.h5", self.work / "outer.h5"
        with h5py.File(inner, "w") as file:
            file["/group/tactile"] = counts()
        with h5py.File(outer, "w") as file:
            file["group"] = h5py.ExternalLink(str(inner), "/group")
        self.refuse(("info", f"{outer}#/group/tactile"), ["no dataset '/group/tactile'"])

    def test_matlab_of_version_7_3(self):
        path = self.work / "a.mat"
        with h5py.File(path, "w", userblock_size=512) as file:
            file["data"] = counts().transpose(2, 0, 1)  # MATLAB has it as rows x frames x cols
            file["fs"] = numpy.full((1, 1), RATE)
        with open(path, "r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
        for source in (path, f"{path}#data"):
            self.same_frames(source)
        info = json.loads(self.succeed("info", path, "--json"))
        self.assertEqual((info["format"], info["rows"], info["rate_hz"]), ("MATLAB", ROWS, RATE))
        path.write_bytes(path.read_bytes()[:2000])
        self.refuse(("info", path), ["a.mat"])

    def test_samples_of_matlab_and_novel(self):
        folder = Path(__file__).parents[3] / "shared/data/layouts"
        if not folder.exists():
            self.skipTest("SKIPPED: ../shared/data/layouts is not there")
        out = self.work / "out.npy"
        for name, options in (("time_in_the_middle.mat", ("--rows", 12, "--cols", 14)), ("insole.asc", ())):
            with self.subTest(name):
                result = support.dermis("convert", folder / name, out, "--force", *options)
                self.assertEqual(result.returncode, 0, result.stderr)
                frames = numpy.load((folder / name).with_suffix(".npy"))
                numpy.testing.assert_array_equal(numpy.load(out), frames)
        self.refuse(("info", folder / "time_in_the_middle.mat"), ["12 x 30 x 14", "rows and cols must be given"])
        source = f"file:{folder / 'time_in_the_middle.mat'}?rows=12&cols=14"
        result = support.dermis("record", "--from", source, "--out", self.work / "a.mcap")
        self.assertEqual(result.returncode, 0, result.stderr)
        info = json.loads(self.succeed("info", self.work / "a.mcap", "--json"))
        self.assertEqual((info["frames"], info["rows"], info["cols"]), (30, 12, 14))

    def test_info_takes_a_shape_that_the_file_does_not_tell(self):
        for name in ("a.packed10", "a.txt", "a.asf"):
            info = json.loads(self.succeed("info", self.root / name, "--rows", ROWS, "--cols", COLS, "--json"))
            self.assertEqual((info["frames"], info["rows"], info["cols"]), (FRAMES, ROWS, COLS))
        self.refuse(("info", self.root / "a.packed10"), ["a.packed10", "rows and cols"])
        self.refuse(("info", self.root / "a.asf", "--rows", 2, "--cols", 2), ["a.asf", "4x5"])
        recording = self.work / "a.mcap"
        self.succeed("convert", self.root / "a.asf", recording)
        self.refuse(("info", recording, "--rows", 2, "--cols", 2), ["a.mcap", "4x5"])

    def test_a_frame_that_is_cut_costs_itself(self):
        whole = (self.contacts / "frames.csv").read_text().splitlines(True)
        cut = self.written("cut.csv", "".join(whole[:50]) + whole[50][:20])
        for source, place in (
            (cut, "cut.csv:51"),
            (self.written("cut.asf", (self.root / "a.asf").read_text()[:2000]), "cut.asf:"),
        ):
            out = self.work / "out.npy"
            result = support.dermis("convert", source, out, "--force")
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn(place, result.stderr)
            self.assertIn("is cut off", result.stderr)
        result = support.dermis("run", "--model", self.model, "--in", cut, "--out", self.work / "forces.csv")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("cut.csv:51: is cut off", result.stderr)
        self.assertEqual(len(self.rows(self.work / "forces.csv")[1]), 49)

    def test_what_is_wrong_is_said(self):
        out = self.work / "f.csv"
        header = (self.contacts / "frames.csv").read_text().splitlines()[0]
        tabs = self.written("tabs.csv", header.replace(",", "\t") + "\n")
        quotes = self.written("quotes.csv", ",".join(f'"{cell}"' for cell in header.split(",")) + "\n")
        wide = self.work / "wide.csv"
        wide.write_text(header + "\n", encoding="utf-16")
        loads = self.written("loads.csv", "frame\tkind\twhere\tvalue\n")
        for arguments, places in (
            (self.run_arguments(out, **{"in": tabs}), ["tabs.csv:1", "tabs", "commas"]),
            (self.run_arguments(out, **{"in": quotes}), ["quotes.csv:1", "quotes"]),
            (self.run_arguments(out, **{"in": wide}), ["wide.csv:1", "UTF-16", "UTF-8"]),
            (self.calibrate_arguments(self.work / "m", loads=loads), ["loads.csv:1", "tabs"]),
            (
                ("run", "--model", self.mat, "--in", self.root / "a.txt", "--out", out),
                ["a.txt", "has no times", "rate"],
            ),
            (
                ("run", "--model", self.mat, "--in", f"file:{self.root / 'a.asf'}?rate=5", "--out", out),
                ["times of its own", "rate"],
            ),
            (("convert", self.root / "a.asf", out, "--rate", 5), ["--rate", "times of its own"]),
            (("convert", self.root / "a.packed10", out, "--rate", 5), ["a.packed10", "rows and cols"]),
            (("convert", self.contacts / "frames.csv", self.work / "a.asf"), ["a.asf", "only read"]),
            (
                ("run", "--model", self.array, "--in", self.contacts / "frames.csv", "--out", out),
                [self.array, "a calibration makes one"],
            ),
            (("serve", "--model", self.mat, "--from", f"file:{self.root / 'a.txt'}?rate=5"), ["make a recording"]),
        ):
            with self.subTest(arguments):
                self.refuse(arguments, places)

    def test_run_tares_and_follows_drift_as_the_server_does(self):
        """An array that shows 5 kPa from the beginning, and 2 kPa more after a minute."""
        frames = ["time_s," + ",".join(f"r{r}c{c}" for r in range(ROWS) for c in range(COLS))]
        for k in range(1200):
            creep = min(2.0, 2.0 * k / 600)
            frames.append(f"{k / 10}," + ",".join(f"{5 + creep:.3f}" for _ in range(ROWS * COLS)))
        source = self.written("drift.csv", "\n".join(frames) + "\n")

        def last(*options):
            out = self.work / "f.csv"
            result = support.dermis("run", "--model", self.mat, "--in", source, "--out", out, *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            return sum(map(float, self.rows(out)[1][-1][2:]))

        self.assertAlmostEqual(last(), 7 * 0.1 * ROWS * COLS, places=3)
        self.assertAlmostEqual(last("--tare-force"), 2 * 0.1 * ROWS * COLS, delta=0.05)
        self.assertLessEqual(last("--tare-force", "--follow-drift"), last("--tare-force"))


if __name__ == "__main__":
    support.main()
