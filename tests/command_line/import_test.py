# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Files of other systems, made here as their programs write them, and arrays whose readings are forces."""
import bz2
import csv
import json
import struct
import unittest
import zlib

import numpy

import support

ROWS, COLS, FRAMES, RATE = 4, 5, 60, 50.0
PRESSURES = """[array]
name = "mat"
rows = 4
cols = 5
taxel_area_mm2 = 100.0

[readout]
circuit = "pressure"
adc_noise_counts = 0.1
"""


def counts():
    """A weight of 3x3 taxels, whole numbers of kilopascals, that comes after a third of the frames."""
    frames = numpy.zeros((FRAMES, ROWS, COLS))
    frames[FRAMES // 3:, 0:3, 1:4] = [[20, 30, 20], [30, 50, 30], [20, 30, 20]]
    return frames


def lines(frame, separator=","):
    return "".join(separator.join(f"{value:g}" for value in row) + "\n" for row in frame)


def text_matrix(path):
    path.write_text("\n".join(lines(frame, "\t") for frame in counts()))


def tekscan(path):
    head = f"DATA_TYPE MOVIE\nROWS {ROWS}\nCOLS {COLS}\nSECONDS_PER_FRAME {1 / RATE}\nUNITS kPa\nASCII_DATA @@\n\n"
    path.write_text(head + "\n".join(f"Frame {k}\n{lines(frame)}" for k, frame in enumerate(counts())) + "@@\n")


def xsensor(path):
    text = '"File:","C:\\\\a,b.XSN"\n"Units:","kPa"\n\n'
    for k, frame in enumerate(counts()):
        text += f'"FRAME","{k}"\n"Time","{k / RATE}"\n"SENSOR","mat"\n"Rows","{ROWS}"\n"Columns","{COLS}"\n"SENSELS"\n'
        text += lines(frame) + "\n"
    path.write_text(text)


def novel(path):
    text = f"Time per picture:  {1000 / RATE:.2f} [ms]\n"
    for k, frame in enumerate(counts()):
        text += f"Page {k}\nPict-No.: {k}\n\n\t" + "\t".join(str(c + 1) for c in range(COLS)) + "\tForce\n"
        text += "".join(f"{r + 1}\t" + "\t".join(f"{v:.1f}" for v in row) + "\t0\n" for r, row in enumerate(frame))
        text += "Force\t0\n\n\x0c\n"
    path.write_text(text)


def dsa(path):
    def number(value):
        return struct.pack(">f", value).hex().upper()

    text = f"<root><sensor><matrix><cells_x>{COLS}</cells_x><cells_y>{ROWS}</cells_y></matrix></sensor><data>"
    for k, frame in enumerate(counts()):
        code = "".join(number(value) if value else number(-1) for value in frame.flat)
        text += f"<frame><time_stamp>{round(1000 * k / RATE)}</time_stamp><frame_data>{code}</frame_data></frame>"
    path.write_bytes(bz2.compress((text + "</data></root>").encode()))


def png(path):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.mkdir()
    for k, frame in enumerate(counts()):
        raw = b"".join(b"\0" + bytes(int(value) for value in row) for row in frame)
        header = struct.pack(">IIBBBBB", COLS, ROWS, 8, 0, 0, 0, 0)
        (path / f"{k}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                                        chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def packed10(path):
    bits = "".join(f"{int(value):010b}" for frame in counts() for value in frame.flat)  # 20 readings: 25 bytes
    path.write_bytes(int(bits, 2).to_bytes(len(bits) // 8, "big"))


TIMED = {"a.asf": tekscan, "tekscan.csv": tekscan, "xsensor.csv": xsensor, "a.lst": novel, "a.dsa": dsa}
UNTIMED = {"a.txt": text_matrix, "matrix.csv": text_matrix, "pictures": png, "a.packed10": packed10,
           "a.npz": lambda path: numpy.savez_compressed(path, counts()),
           "b.npz": lambda path: numpy.savez(path, counts().astype(numpy.uint8))}


class Imports(support.SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mat = cls.root / "mat.toml"
        cls.mat.write_text(PRESSURES)
        for name, write in (TIMED | UNTIMED).items():
            write(cls.root / name)

    def source(self, name):
        path = self.root / name
        return path if name in TIMED else f"file:{path}?rate={RATE:g}&rows={ROWS}&cols={COLS}"

    def rows(self, path):
        with open(path) as file:
            header, *rows = csv.reader(file)
        return header, rows

    def test_every_file_becomes_the_same_frames(self):
        for name in TIMED | UNTIMED:
            with self.subTest(name):
                out = self.work / "out.csv"
                untimed = ("--rate", RATE, "--rows", ROWS, "--cols", COLS) if name in UNTIMED else ()
                result = support.dermis("convert", self.root / name, out, *untimed)
                self.assertEqual(result.returncode, 0, result.stderr)
                header, rows = self.rows(out)
                values = numpy.array([[float(cell or "nan") for cell in row] for row in rows])
                first = header.index("r0c0")
                numpy.testing.assert_array_equal(values[:, first:].reshape(-1, ROWS, COLS), counts())
                numpy.testing.assert_allclose(values[:, 0] - values[0, 0], numpy.arange(FRAMES) / RATE, atol=1e-9)

    def test_every_command_takes_every_file(self):
        for name in TIMED | UNTIMED:
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
                result = support.dermis("record", "--from", source, "--model", self.mat, "--out", recording)
                self.assertEqual(result.returncode, 0, result.stderr)
                info = json.loads(self.succeed("info", recording, "--json"))
                self.assertEqual((info["frames"], info["rows"], info["cols"]), (FRAMES, ROWS, COLS))
                self.assertIn('circuit = "pressure"', info["array_toml"])
                self.succeed("image", "--in", recording, "--frame", 40, "--out", self.work / "c.svg")
                self.assertIn(" N<", (self.work / "c.svg").read_text())
                self.succeed("replay", recording, "--speed", 0, "--model", self.mat, "--out", self.work / "again.csv")
                self.assertEqual((self.work / "again.csv").read_text().splitlines()[1].split(",")[2:],
                                 out.read_text().splitlines()[1].split(",")[2:])

    def test_calibration_and_evaluation_take_them_too(self):
        """The counts of a calibration, as a stack without times and as one of the arrays of an archive."""
        _, rows = self.rows(self.calibration / "frames.csv")
        values = numpy.array([[float(cell) for cell in row[3:]] for row in rows]).reshape(-1, ROWS, COLS)
        stack, archive = self.work / "c.npy", self.work / "c.npz"
        numpy.save(stack, values)
        numpy.savez(archive, labels=values[:3], frames=values)
        header = "time_s," + ",".join(f"r{r}c{c}" for r in range(ROWS) for c in range(COLS)) + "\n"
        plain = self.written("c.csv", header + "".join(f"{k / 100}," + ",".join(f"{v:g}" for v in frame.flat) + "\n"
                                                       for k, frame in enumerate(values)))
        expected = None
        for source in (plain, f"file:{stack}?rate=100", f"file:{archive}%23frames?rate=100"):
            model = self.work / "model"
            result = support.dermis(*self.calibrate_arguments(model, frames=source))  # poor without temperatures
            self.assertEqual(result.returncode, 0, result.stderr)
            judged = self.succeed(*self.evaluate_arguments(model=model, frames=source,
                                                           loads=self.calibration / "loads.csv"), "--json")
            expected = expected or judged
            self.assertEqual(judged, expected)
        self.refuse(self.calibrate_arguments(self.work / "m", frames="sim:idle?rate=100"), ["dermis record"])

    def test_info_names_the_format(self):
        formats = {"a.asf": "Tekscan ASCII", "xsensor.csv": "XSENSOR ASCII", "a.lst": "novel listing",
                   "a.dsa": "Weiss DSA", "a.txt": "text matrix", "pictures": "PNG", "a.npz": "NumPy archive"}
        for name, expected in formats.items():
            with self.subTest(name):
                info = json.loads(self.succeed("info", self.root / name, "--json"))
                self.assertEqual(info["format"], expected)
                self.assertEqual((info["frames"], info["rows"], info["cols"]), (FRAMES, ROWS, COLS))
                self.assertEqual(info["duration_s"] is None, name in UNTIMED)

    def test_a_frame_that_is_cut_costs_itself(self):
        whole = (self.contacts / "frames.csv").read_text().splitlines(True)
        cut = self.written("cut.csv", "".join(whole[:50]) + whole[50][:20])
        for source, place in ((cut, "cut.csv:51"), (self.written("cut.asf", (self.root / "a.asf").read_text()[:2000]),
                                                    "cut.asf:")):
            out = self.work / "out.npy"
            result = support.dermis("convert", source, out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(place, result.stderr)
            self.assertIn("is cut off", result.stderr)
        result = support.dermis("run", "--model", self.model, "--in", cut, "--out", self.work / "forces.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
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
            (("run", "--model", self.mat, "--in", self.root / "a.txt", "--out", out), ["a.txt", "has no times", "rate"]),
            (("run", "--model", self.mat, "--in", f"file:{self.root / 'a.asf'}?rate=5", "--out", out),
             ["times of its own", "rate"]),
            (("convert", self.root / "a.asf", out, "--rate", 5), ["--rate", "times of its own"]),
            (("convert", self.root / "a.packed10", out, "--rate", 5), ["a.packed10", "rows and cols"]),
            (("convert", self.contacts / "frames.csv", self.work / "a.asf"), ["a.asf", "only read"]),
            (("run", "--model", self.array, "--in", self.contacts / "frames.csv", "--out", out),
             [self.array, "dermis calibrate"]),
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
            self.succeed("run", "--model", self.mat, "--in", source, "--out", out, *options)
            return sum(map(float, self.rows(out)[1][-1][2:]))

        self.assertAlmostEqual(last(), 7 * 0.1 * ROWS * COLS, places=3)
        self.assertAlmostEqual(last("--tare"), 2 * 0.1 * ROWS * COLS, delta=0.05)
        self.assertLessEqual(last("--tare", "--follow-drift"), last("--tare"))


if __name__ == "__main__":
    support.main()
