# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""convert, info and recover, held against h5py, numpy and csv of Python."""

import csv
import itertools
import json
import random
import struct
from fractions import Fraction

import h5py
import numpy as np
import support
from support import SmallArray, dermis, error_lines, files_limited_to

ROWS, COLS, FRAMES = 4, 5, 200
SOURCE = f"sim:multitouch?rows={ROWS}&cols={COLS}&rate=1000&seed=3"
MAGIC = b"\x89MCAP0\r\n"
NAMES = ("a.csv", "a.mcap", "a.h5", "a.wiresens.hdf5", "a.npy")
TIMED = [name for name in NAMES if not name.endswith(".npy")]
WARM = ("a.csv", "a.mcap", "a.h5")  # with temperature and supply
# Nanoseconds between neighbouring doubles of seconds since 1970, rounded up: half when a time is written, half when the
# microsecond that shares its double is taken for it.
DOUBLE_SPACING = 239


def csv_frames(path):
    """Nanoseconds, counts, temperatures and supplies of a frames.csv."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    named = {name: [row[i] for row in rows] for i, name in enumerate(header)}
    taxels = [i for i, name in enumerate(header) if name.startswith("r")]
    nanos = [
        int(whole) * 10**9 + int(part.ljust(9, "0"))
        for whole, _, part in (text.partition(".") for text in named["time_s"])
    ]
    counts = np.array([[np.float32(row[i]) for i in taxels] for row in rows], np.float32)
    return nanos, counts, named.get("temperature_celsius"), named.get("supply_v")


def middle_chunk(mcap):
    """Where the chunk in the middle of the file begins and ends: records are an opcode, 8 bytes of length, the
    content."""
    chunks, at = [], 8
    while at + 9 < len(mcap) - 8:
        end = at + 9 + int.from_bytes(mcap[at + 1 : at + 9], "little")
        if mcap[at] == 0x06:
            chunks.append((at, end))
        at = end
    return chunks[len(chunks) // 2]


class FrameFiles(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.recording = cls.root / "recorded.mcap"
        result = dermis("record", "--from", SOURCE, "--array", cls.array, "--frames", FRAMES, "--out", cls.recording)
        if result.returncode != 0:
            raise AssertionError(result.stderr)

    def convert(self, source, name, *options):
        """Converts within the working folder; returns the path and what was said to be left out."""
        out = self.work / name
        result = dermis("convert", source, out, "--force", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, "")
        lines = error_lines(result)
        self.assertLessEqual(len(lines), 1, result.stderr)
        return out, lines[0].partition(": left out: ")[2] if lines else ""

    def frames_of(self, path, *options):
        return csv_frames(self.convert(path, f"{path.name}.of.csv", *options)[0])


class Convert(FrameFiles):
    def test_every_pair_of_formats_carries_the_same_frames(self):
        nanos, counts, temperatures, supplies = self.frames_of(self.recording)
        self.assertEqual(counts.shape, (FRAMES, ROWS * COLS))
        rate = ("--rate", "100")
        for first, second in itertools.product(NAMES, NAMES):
            with self.subTest(first=first, second=second):
                between = self.work / ("1" + first)
                if not between.exists():
                    self.convert(self.recording, between.name)
                out, _ = self.convert(between, "2" + second, *(rate if first == "a.npy" else ()))
                found = self.frames_of(out, *(rate if second == "a.npy" else ()))
                np.testing.assert_array_equal(found[1], counts)
                if first in TIMED and second in TIMED:
                    slack = DOUBLE_SPACING if "a.wiresens.hdf5" in (first, second) else 0
                    self.assertLessEqual(max(abs(a - b) for a, b in zip(found[0], nanos, strict=True)), slack)
                else:
                    self.assertEqual(found[0], [i * 10**7 for i in range(FRAMES)])
                if first in WARM and second in WARM:
                    self.assertEqual(found[2:], (temperatures, supplies))

    def test_hdf5_keeps_every_bit_of_a_recording(self):
        one, said = self.convert(self.recording, "1.h5")
        self.assertEqual(said, "")
        two, said = self.convert(one, "2.mcap")
        self.assertEqual(said, "")
        three, _ = self.convert(two, "3.h5")
        with h5py.File(one) as a, h5py.File(three) as b:
            self.assertEqual(set(a), set(b))
            for name in a:
                self.assertEqual(a[name][:].tobytes(), b[name][:].tobytes(), name)
            self.assertEqual(dict(a.attrs), dict(b.attrs))
            self.assertEqual(list(a["known"][:]), [15] * FRAMES)
            self.assertTrue((np.diff(a["sequence"][:].astype(np.int64)) > 0).all())

    def test_forces_are_the_same_from_every_format(self):
        expected = self.work / "expected.csv"
        self.succeed(*self.run_arguments(expected, **{"in": self.contacts / "frames.csv"}))
        for name in ("a.mcap", "a.h5"):
            out = self.work / "forces.csv"
            self.succeed(*self.run_arguments(out, **{"in": self.convert(self.contacts / "frames.csv", name)[0]}))
            self.assertEqual(out.read_bytes(), expected.read_bytes())

    def test_a_model_can_be_calibrated_from_a_recording(self):
        frames, _ = self.convert(self.calibration / "frames.csv", "calibration.mcap")
        model = self.work / "model.safetensors"
        self.succeed(*self.calibrate_arguments(model, frames=frames))
        one, other = self.work / "one.csv", self.work / "other.csv"
        self.succeed(*self.run_arguments(one))
        self.succeed(*self.run_arguments(other, model=model))
        self.assertEqual(one.read_bytes(), other.read_bytes())

    def test_h5py_reads_what_is_written(self):
        out, _ = self.convert(self.contacts / "frames.csv", "a.h5", "--array", self.array)
        nanos, counts, temperatures, supplies = csv_frames(self.contacts / "frames.csv")
        with h5py.File(out) as file:
            self.assertEqual(file["counts"].shape, (len(nanos), ROWS, COLS))
            self.assertEqual(file["counts"].dtype, np.uint16)
            np.testing.assert_array_equal(file["counts"][:].reshape(len(nanos), -1), counts)
            np.testing.assert_array_equal(file["time_ns"][:], nanos)
            np.testing.assert_array_equal(file["time_s"][:], np.array(nanos) / 1e9)
            np.testing.assert_array_equal(file["temperature_celsius"][:], np.array(temperatures, float))
            np.testing.assert_array_equal(file["supply_v"][:], [float(text or "nan") for text in supplies])
            self.assertTrue((file["known"][:] & 4 == 0).all())  # no sequence
            units = {
                name: file[name].attrs["units"] for name in ("counts", "time_s", "temperature_celsius", "supply_v")
            }
            self.assertEqual(units, {"counts": "counts", "time_s": "s", "temperature_celsius": "degC", "supply_v": "V"})
            self.assertEqual((file.attrs["format"], file.attrs["name"]), ("dermis frames", "small"))
            self.assertIn('name = "small"', file.attrs["array"])
            self.assertTrue(file.attrs["software"].startswith("dermis "))

    def test_missing_values_are_nan_in_hdf5(self):
        source = self.written("f.csv", "time_s,temperature_celsius,supply_v,r0c0\n-1.5,,5,1\n2,20,,nan\n3,nan,,2.5\n")
        out, _ = self.convert(source, "f.h5")
        with h5py.File(out) as file:
            np.testing.assert_array_equal(file["counts"][:, 0, 0], np.array([1, np.nan, 2.5], np.float32))
            self.assertEqual(file["counts"].dtype, np.float32)
            np.testing.assert_array_equal(file["temperature_celsius"][:], [np.nan, 20, np.nan])
            np.testing.assert_array_equal(file["supply_v"][:], [5, np.nan, np.nan])
            self.assertEqual(list(file["known"][:]), [2, 1, 1])
        self.assertEqual(self.convert(out, "g.csv")[0].read_text(), source.read_text())

    def test_hdf5_by_hand_is_read(self):
        counts = np.random.default_rng(1).integers(0, 4096, (50, 3, 4))
        for dtype, options in itertools.product(
            (np.uint8, np.int16, np.int64, np.float32, np.float64, ">u4"),
            ({}, {"chunks": (7, 2, 3)}, {"compression": "gzip", "shuffle": True}),
        ):
            path = self.work / "hand.h5"
            with h5py.File(path, "w") as file:
                file.create_dataset("counts", data=counts.astype(dtype), **options)
                file["time_s"] = np.arange(50) / 8
            nanos, found, temperatures, _ = self.frames_of(path)
            np.testing.assert_array_equal(found, counts.astype(dtype).reshape(50, -1).astype(np.float32))
            self.assertEqual(nanos, [125_000_000 * i for i in range(50)])
            self.assertEqual(set(temperatures), {""})

    def test_numpy_reads_what_is_written(self):
        out, said = self.convert(self.recording, "a.npy")
        self.assertTrue(said.startswith("times, temperature, supply, "), said)
        array = np.load(out)
        self.assertEqual((array.dtype, array.shape), (np.dtype("<u2"), (FRAMES, ROWS, COLS)))
        np.testing.assert_array_equal(array.reshape(FRAMES, -1), self.frames_of(self.recording)[1])
        out, _ = self.convert(self.written("f.csv", "time_s,r0c0,r0c1\n0,1,2\n1,0.5,nan\n"), "f.npy")
        np.testing.assert_array_equal(np.load(out), np.array([[[1, 2]], [[0.5, np.nan]]], "<f4"))

    def test_what_numpy_writes_is_read(self):
        counts = np.random.default_rng(2).integers(0, 128, (9, 3, 4))
        path = self.work / "f.npy"
        for dtype in ("u1", "i1", "<u2", ">u2", "<i2", ">i2", "<u4", ">i4", "<i8", ">u8", "<f4", ">f4", "<f8", ">f8"):
            np.save(path, counts.astype(dtype))
            np.testing.assert_array_equal(self.frames_of(path, "--rate", "50")[1], counts.reshape(9, -1))
        for version in ((1, 0), (2, 0), (3, 0)):
            with open(path, "wb") as file:
                np.lib.format.write_array(file, counts.astype("<u2"), version)
            np.testing.assert_array_equal(self.frames_of(path, "--rate", "50")[1], counts.reshape(9, -1))
        np.save(path, counts.reshape(9, -1))
        nanos, found, *_ = self.frames_of(path, "--rate", "50", "--rows", "3", "--cols", "4")
        np.testing.assert_array_equal(found, counts.reshape(9, -1))
        self.assertEqual(nanos, [20_000_000 * i for i in range(9)])

    def test_an_array_of_another_size_is_refused(self):
        source = self.written("f.csv", "time_s,r0c0\n0,1\n")
        self.refuse(
            ("convert", source, self.work / "f.h5", "--array", self.array),
            [f"{source}:1: has 1x1 taxels, the array is 4x5"],
        )

    def test_errors_name_the_mend(self):
        frames = self.contacts / "frames.csv"
        out = self.work / "a.h5"
        npy = self.work / "f.npy"
        np.save(npy, np.zeros((2, 6), "u1"))
        axes, last = self.work / "axes.npy", self.work / "last.npy"
        np.save(axes, np.zeros((2, 3, 4, 5)))
        np.save(last, np.zeros((3, 4, 50)))
        cut = self.written("cut.csv", "time_s,r0c0\n0,1\n1,x\n")
        for arguments, places in (
            ((frames, self.work / "a.txt"), ["a.txt", ".csv, .mcap, .h5"]),
            ((self.written("a.xyz", ""), out), ["a.xyz", ".csv, .mcap, .h5"]),
            ((self.work / "none.csv", out), ["none.csv", "No such file"]),
            ((npy, out), ["f.npy", "no times", "give a rate"]),
            ((npy, out, "--rate", "10"), ["f.npy", "6 numbers", "how many rows and cols"]),
            ((npy, out, "--rate", "0"), ["--rate", "more than 0"]),
            ((npy, out, "--rate", "nan"), ["--rate", "more than 0"]),
            ((npy, out, "--rate", "10", "--rows", "2"), ["--cols"]),
            ((npy, out, "--rate", "10", "--rows", "0", "--cols", "6"), ["--rows", "1 to 1024"]),
            ((npy, out, "--rate", "10", "--rows", "-2", "--cols", "6"), ["--rows", "must not be negative"]),
            ((npy, out, "--rate", "10", "--rows", "2", "--cols", "2"), ["6 numbers, the array is 2x2"]),
            ((npy, out, "--rate", "10", "--rows", "2", "--cols", "3", "--array", self.array), ["4x5 taxels"]),
            ((axes, out, "--rate", "10"), ["2 x 3 x 4 x 5", "axes.npy#[:, 0]"]),
            (
                (last, out, "--rate", "10"),
                ["3 frames of 4x50, as", "50 frames of 3x4, as", "last.npy#[rows, cols, frames]"],
            ),
            ((f"{last}#[0, frames]", out, "--rate", "10"), ["[0, frames]", "frames, rows and cols"]),
            ((frames, out, "--rate", "10"), ["--rate", "times of its own"]),
            ((cut, out), ["cut.csv:3", "r0c0", "'x'"]),
            ((frames, self.work / "a.mcap", "--rows", "3", "--cols", "3"), ["has 4x5 taxels, the array is 3x3"]),
            ((self.written("f.csv", "time_s,r0c0\n0,1.5\n"), self.work / "a.wiresens.h5"), ["frame 0", "1.5", "whole"]),
        ):
            with self.subTest(arguments=arguments):
                self.refuse(("convert", *arguments), places)
        self.refuse(("convert", frames, self.work / "none" / "a.h5"), ["none/a.h5", "No such file"], status=1)

    def test_hdf5_that_cannot_be_read(self):
        path = self.work / "f.h5"
        other = self.work / "other.h5"
        with h5py.File(other, "w") as file:
            file["counts"] = np.zeros((2, 3, 4), "u2")
        raw = self.written("raw.bin", "0" * 1000)
        layout = h5py.VirtualLayout((2, 3, 4), "u2")
        layout[:] = h5py.VirtualSource(other, "counts", (2, 3, 4))

        def lists(name, data, **options):
            return lambda file: file.create_dataset(name, data=data, **options)

        def external(file):
            file["counts"] = h5py.ExternalLink(str(other), "counts")

        whole = np.zeros((2, 3, 4), "u2")
        for fill, places in (
            ([], ["'counts'", "'pressure'"]),
            ([external], ["'counts'", "'pressure'"]),
            ([lists("counts", whole)], ["neither time_ns nor time_s"]),
            ([lists("counts", whole), lists("time_s", np.zeros(3))], ["'time_s'", "each of 2 frames"]),
            ([lists("counts", whole), lists("time_s", np.array([0, np.nan]))], ["'time_s'", "frame 1"]),
            ([lists("counts", whole), lists("time_s", np.array(["a", "b"], "S1"))], ["'time_s'", "numbers"]),
            ([lists("counts", np.zeros((2, 12)))], ["2 x 12", "frames x rows x cols"]),
            ([lists("counts", np.zeros((2, 1, 1025)))], ["2 x 1 x 1025", "1024x1024"]),
            ([lists("counts", np.full((2, 1, 1), 2**24 + 1)), lists("time_s", np.zeros(2))], ["frame 0", "16777217"]),
            ([lambda file: file.create_group("counts")], ["'counts'"]),
            ([lambda file: file.create_virtual_dataset("counts", layout)], ["other files", "h5repack"]),
            (
                [lambda file: file.create_dataset("counts", (2, 3, 4), "u2", external=[(str(raw), 0, 48)])],
                ["other files", "h5repack"],
            ),
            (
                [
                    lambda file: file.create_dataset(
                        "counts", (9, 1024, 1024), "f4", chunks=(17, 1024, 1024), maxshape=(None, 1024, 1024)
                    )
                ],
                ["'counts'"],
            ),
            (
                [lambda file: file.create_dataset("counts", (2**40, 3, 4), "u2", chunks=(1, 3, 4))],
                ["larger than the file"],
            ),
            ([lists("counts", whole, compression="lzf"), lists("time_s", np.zeros(2))], ["'counts'", "cannot be read"]),
        ):
            with self.subTest(places=places):
                with h5py.File(path, "w") as file:
                    for step in fill:
                        step(file)
                self.refuse(("convert", path, self.work / "out.csv"), [path, *places])

    def test_nothing_is_left_where_the_disk_is_full(self):
        for name in NAMES:
            with self.subTest(name=name):
                self.refuse(
                    ("convert", self.recording, self.work / name),
                    [f"cannot write '{self.work / name}'"],
                    status=1,
                    **files_limited_to(2000),
                )


class Wiresens(FrameFiles):
    """Files as the toolkit writes them: a copy of what its append_data() does, step by step."""

    BLOCK = 1024

    def record(self, path, frames, packets=None, skipped=()):
        """`frames` is (N, ground, read); `skipped` are numbers of frames that were counted but not recorded."""
        stamps = []
        with h5py.File(path, "w") as file:
            number = 0
            for count, reading in enumerate(frames):
                while number in skipped:
                    number += 1
                if count == 0:
                    file.create_dataset("frame_count", (1,), maxshape=(None,), dtype=np.uint32)
                    for name in ("ts", "predCount"):
                        file.create_dataset(name, (self.BLOCK,), maxshape=(None,), dtype=np.float64, chunks=True)
                    file.create_dataset(
                        "pressure",
                        (self.BLOCK, *reading.shape),
                        maxshape=(None, *reading.shape),
                        dtype=np.int32,
                        chunks=True,
                    )
                    if packets:
                        file.create_dataset(
                            "packetNumber",
                            (self.BLOCK, packets),
                            maxshape=(None, packets),
                            dtype=np.uint32,
                            chunks=True,
                        )
                if number == len(file["ts"]):
                    for name in set(file) - {"frame_count"}:
                        file[name].resize(number + self.BLOCK, axis=0)
                micros = 1_753_000_000_123_457 + 16_667 * number
                stamps.append(micros * 1000)
                file["frame_count"][0] = number
                file["ts"][number] = np.int64(micros) / 1e6
                file["predCount"][number] = number // 7
                file["pressure"][number] = reading
                number += 1
        return stamps

    def check(self, count, **options):
        frames = np.random.default_rng(count).integers(0, 4096, (count, 3, 4))
        stamps = self.record(self.work / "w.hdf5", frames, **options)
        nanos, found, *_ = self.frames_of(self.work / "w.hdf5")
        np.testing.assert_array_equal(found, frames.reshape(count, -1))
        self.assertEqual(nanos, stamps)
        self.assertEqual(json.loads(self.succeed("info", self.work / "w.hdf5", "--json"))["format"], "WiReSens HDF5")

    def test_all_whole_frames_are_read(self):
        for count in (1, 2, 1023, 1024, 1025, 1500):
            with self.subTest(count=count):
                self.check(count)

    def test_packet_numbers_make_no_difference(self):
        self.check(30, packets=2)

    def test_entries_that_were_never_written_are_no_frames(self):
        self.check(30, skipped=(0, 1, 7, 8, 20))

    def test_wiresens_reads_what_is_written(self):
        out, said = self.convert(self.recording, "a.wiresens.hdf5")
        self.assertIn("temperature, supply", said)
        with h5py.File(out) as file:  # as utils.py of the toolkit does
            count = file["frame_count"][0]
            stamps, pressure = np.array(file["ts"][:count]), np.array(file["pressure"][:count])
            self.assertEqual(set(file), {"frame_count", "ts", "predCount", "pressure"})
            self.assertEqual((pressure.dtype, file["frame_count"].dtype), (np.int32, np.uint32))
        nanos, counts, *_ = self.frames_of(self.recording)
        np.testing.assert_array_equal(pressure.reshape(count, -1), counts)
        np.testing.assert_array_equal(stamps, [float(Fraction(time, 10**9)) for time in nanos])


class Info(FrameFiles):
    def info(self, path):
        return json.loads(self.succeed("info", path, "--json"))

    def test_of_a_recording(self):
        info = self.info(self.recording)
        expected = {
            "format": "MCAP",
            "frames": FRAMES,
            "rows": ROWS,
            "cols": COLS,
            "lost": 0,
            "complete": True,
            "name": "small",
            "compression": "lz4",
            "size_bytes": self.recording.stat().st_size,
        }
        self.assertEqual({key: info[key] for key in expected}, expected)
        self.assertRegex(info["start_utc"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")
        self.assertIn('name = "small"', info["array_toml"])
        raw = [topic for topic in info["topics"] if topic["name"] == "/small/raw"]
        self.assertEqual(raw, [{"name": "/small/raw", "type": "sensor_msgs/msg/Image", "messages": FRAMES}])

    def test_of_every_format(self):
        source = self.written(
            "f.csv", "time_s,temperature_celsius,r0c0,r0c1,r0c2\n5,20,1,2,3\n6,,1,2,3\n7.5,-1,1,2,3\n"
        )
        for name in NAMES:
            with self.subTest(name=name):
                info = self.info(self.convert(source, name)[0])
                self.assertEqual((info["frames"], info["rows"], info["cols"], info["complete"]), (3, 1, 3, True))
                self.assertEqual(info["duration_s"], None if name == "a.npy" else 2.5)
                self.assertEqual(info["rate_hz"], None if name == "a.npy" else 0.8)
                self.assertEqual(info["lost"], 0 if name in ("a.mcap", "a.h5") else None)
                range_is_told = name in ("a.csv", "a.h5")
                self.assertEqual(info["temperature_celsius"], [-1, 20] if range_is_told else None)

    def test_as_text(self):
        text = self.succeed("info", self.convert(self.recording, "a.h5")[0])
        for line in (
            "format        HDF5",
            f"frames        {FRAMES}",
            "taxels        4x5",
            "complete      yes",
            "array         small (with its description)",
        ):
            self.assertIn(line + "\n", text)

    def test_names_what_cannot_be_read(self):
        self.refuse(("info", self.work / "a.xyz"), ["a.xyz", ".csv, .mcap"])
        self.refuse(("info", self.work / "a.mcap"), ["a.mcap", "No such file"])
        self.refuse(("info", self.written("a.csv", "time_s,r0c0\n0\n")), ["a.csv:2"])
        self.refuse(("info", self.written("b.mcap", "no recording")), ["b.mcap"])


def records(recording):
    """(opcode, begin, end) of each record, without its header."""
    place = len(MAGIC)
    while place < len(recording) - len(MAGIC):
        opcode, size = struct.unpack_from("<BQ", recording, place)
        yield opcode, place + 9, place + 9 + size
        place += 9 + size


def rewritten(recording, change):
    """The bytes of a recording of which `change` has changed some, and which says nothing of checksums of its own."""
    changed = bytearray(recording)
    change(changed)
    (summary,) = struct.unpack_from("<Q", changed, len(changed) - len(MAGIC) - 20)
    changed[summary - 4 : summary] = changed[-len(MAGIC) - 4 : -len(MAGIC)] = bytes(4)
    return bytes(changed)


def in_gzip(recording):
    recording[:] = recording.replace(b"\x03\0\0\0lz4", b"\x03\0\0\0gzi")


def in_json(recording):
    recording[:] = recording.replace(b"\x03\0\0\0cdr", b"\x03\0\0\0jsn")


def without_schemas(recording):
    for opcode, begin, _ in records(recording):
        if opcode == 4:
            recording[begin + 2 : begin + 4] = bytes(2)


class Unread(FrameFiles):
    """Recordings that others have written again, with the totals that dermis wrote."""

    def rewrite(self, change):
        path = self.work / f"{change.__name__}.mcap"
        path.write_bytes(rewritten(self.recording.read_bytes(), change))
        return path

    def test_info_tells_what_is_there_and_why_it_is_not_read(self):
        for change, why in (
            (in_json, "'/small/raw' are in 'jsn'; frames are read in 'cdr'"),
            (without_schemas, "'/small/raw' have no schema"),
            (in_gzip, "compressed with 'gzi'"),
        ):
            with self.subTest(change.__name__):
                path = self.rewrite(change)
                result = dermis("info", path)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertRegex(result.stdout, "frames +0\n")
                self.assertRegex(result.stdout, f"topic +/small/raw .*{FRAMES} messages")
                [line] = result.stderr.splitlines()
                self.assertIn(f"{path.name}: has no frame: ", line)
                self.assertIn(why, line)
                self.assertIn(why, json.loads(dermis("info", path, "--json").stdout)["unread"])
                self.refuse(("convert", path, self.work / "out.csv"), [path.name, why])

    def test_a_recovery_of_nothing_fails(self):
        self.refuse(
            ("info", "recover", self.rewrite(in_gzip), "--out", self.work / "out.mcap"),
            ["in_gzip.mcap: nothing can be recovered: the chunk is compressed with 'gzi'"],
            status=1,
        )


class Recover(FrameFiles):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.long = cls.root / "long.mcap"
        # 64x160 taxels fill a chunk of 1 MiB in 50 frames
        result = dermis(
            "record", "--from", "sim:multitouch?rows=64&cols=160&rate=1000&seed=1", "--frames", "400", "--out", cls.long
        )
        if result.returncode != 0:
            raise AssertionError(result.stderr)

    def recovered(self, name):
        return json.loads(self.succeed("info", self.work / name, "--json"))

    def told(self, name, statuses):
        result = dermis("info", self.work / name, "--json")
        self.assertIn(result.returncode, statuses, result.stderr)
        return json.loads(result.stdout)

    def test_a_complete_recording_stays_the_same(self):
        text = self.succeed("info", "recover", self.recording, "--out", self.work / "out.mcap")
        self.assertIn(f"out.mcap: {FRAMES} frames", text)
        self.assertIn("nothing was wrong", text)
        self.assertEqual(
            [list(part) for part in self.frames_of(self.work / "out.mcap")[::2]],
            [list(part) for part in self.frames_of(self.recording)[::2]],
        )

    def test_a_cut_recording_gives_the_frames_before_the_cut(self):
        whole = self.long.read_bytes()
        chooser = random.Random(1)
        previous = 0
        for size in sorted(chooser.randrange(1000, len(whole)) for _ in range(8)):
            cut = self.work / "cut.mcap"
            cut.write_bytes(whole[:size])
            left = self.told("cut.mcap", (1, 2))  # 2 where no frame is left
            self.assertFalse(left["complete"])
            if left["frames"] == 0:
                self.refuse(
                    ("info", "recover", cut, "--out", self.work / "out.mcap", "--force"),
                    ["cut.mcap: nothing can be recovered"],
                    status=1,
                )
                continue
            text = self.succeed("info", "recover", cut, "--out", self.work / "out.mcap", "--force")
            info = self.recovered("out.mcap")
            self.assertTrue(info["complete"])
            self.assertIn(f"{info['frames']} frames", text)
            self.assertGreaterEqual(info["frames"], previous)
            previous = info["frames"]
        self.assertGreater(previous, 0)

    def test_a_cut_recording_converts_and_says_so(self):
        cut = self.work / "cut.mcap"
        cut.write_bytes(self.recording.read_bytes()[:-20])
        result = dermis("convert", cut, self.work / "a.h5")
        self.assertEqual(result.returncode, 1)
        self.assertIn("was not written to its end", result.stderr)
        self.assertEqual(self.recovered("a.h5")["frames"], FRAMES)

    def test_a_damaged_chunk_is_left_out_and_told(self):
        damaged = bytearray(self.long.read_bytes())
        begin, end = middle_chunk(damaged)
        middle = (begin + end) // 2
        # One bit of LZ4 may lead a copy to other bytes that are the same; that loses nothing.
        damaged[middle : middle + 64] = bytes(byte ^ 0x5A for byte in damaged[middle : middle + 64])
        (self.work / "damaged.mcap").write_bytes(damaged)
        text = self.succeed("info", "recover", self.work / "damaged.mcap", "--out", self.work / "out.mcap")
        self.assertRegex(text, r"1 damaged chunk with \d+ messages is lost")
        info = self.recovered("out.mcap")
        self.assertTrue(info["complete"])
        self.assertTrue(0 < info["frames"] < 400, info["frames"])

    def test_errors_name_the_mend(self):
        copy = self.work / "a.mcap"
        copy.write_bytes(self.recording.read_bytes())
        self.refuse(("info", "recover", copy, "--out", copy), ["--out", "name another"])
        self.refuse(
            ("info", "recover", self.contacts / "frames.csv", "--out", self.work / "b.mcap"), ["frames.csv", ".mcap"]
        )
        self.refuse(("info", "recover", copy, "--out", self.work / "b.h5"), ["b.h5", ".mcap"])
        self.refuse(
            ("info", "recover", self.work / "none.mcap", "--out", self.work / "b.mcap"), ["none.mcap", "No such file"]
        )
        self.refuse(("info", "recover", self.written("t.mcap", "text"), "--out", self.work / "b.mcap"), ["t.mcap"])
        self.refuse(
            ("info", "recover", self.long, "--out", self.work / "b.mcap"),
            ["b.mcap"],
            status=1,
            **files_limited_to(100_000),
        )


if __name__ == "__main__":
    support.main()
