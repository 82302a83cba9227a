# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis describe: the layout of bytes that nobody has described, from a file or a device."""

import contextlib
import json
import os
import pty
import re
import select
import socket
import subprocess
import threading
import time
import tty
from pathlib import Path

import numpy
import support

SAMPLES = Path(__file__).parents[3] / "shared/data/layouts"
SHAPES = {  # where the last axes of NAME.npy are not those of an array
    "SENSORLOG": (1, 16),
    "insole": (1, 99),
    "python_floats": (1, 8),
}
FEWEST_RIGHT = 11
STRANGERS = Path(__file__).parents[3] / "shared/data/strangers"
STRANGE = {  # rows, columns, the array whose frames stand beside the file, a word of its doubts
    "finger25.bin": (5, 5, "", ""),
    "packets_that_end_in_ff.bin": (16, 16, "", ""),
    "no_mark_u16be.bin": (8, 8, "", "nothing marks"),
    "marker_then_numbers.txt": (6, 9, "", ""),
    "bare_numbers.txt": (3, 3, "", "nothing marks"),
    "secs_and_nsecs.jsonl": (12, 6, "_thumb", "absent = -1"),
    "labelled_places.jsonl": (1, 6, "", "'volt'"),
}


def pressed(frames, rows, cols):
    """A press that comes and goes, over noise."""
    noise = numpy.random.default_rng(1)
    row, col = numpy.mgrid[0:rows, 0:cols]
    shape = numpy.exp(-((row - rows / 2) ** 2 + (col - cols / 2) ** 2) / 3)
    return [
        (900 * max(0, numpy.sin(k / 6)) * shape + noise.integers(0, 6, (rows, cols))).astype(int) for k in range(frames)
    ]


LINES = "".join(" ".join(map(str, frame.ravel())) + "\n" for frame in pressed(40, 4, 6))
BINARY = b"".join(b"\xaa\x55" + bytes([k]) + frame.astype(">u2").tobytes() for k, frame in enumerate(pressed(60, 4, 4)))


def play(board, ask, goes_on, lines):
    """A board that sends lines over TCP once it was asked, or one for each time."""
    connection, _ = board.accept()
    with connection, contextlib.suppress(OSError):
        for place, line in enumerate(lines * 20):
            while (place == 0 or not goes_on) and ask not in (heard := connection.recv(64)):
                if not heard:
                    return
            time.sleep(0.02)
            connection.sendall(line.encode())


class Describe(support.SmallArray):
    def described(self, source, *arguments):
        result = support.dermis("describe", source, "--json", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def frames(self, layout, source):
        arrays = re.findall(r'^name = "(.*)"', Path(layout).read_text(), re.MULTILINE)
        found = []
        for array in arrays or [None]:
            out = self.work / "out.npy"
            result = support.dermis(
                "convert", "--layout", layout, f"{source}#{array}" if array else source, out, "--force"
            )
            self.assertEqual(result.returncode, 0, result.stderr)
            found.append(numpy.load(out))
        return numpy.stack(found, axis=1) if len(found) > 1 else found[0]

    def reads_as_meant(self, sample, wanted):
        rows, cols = SHAPES.get(sample.stem, wanted.shape[-2:])
        layout = self.work / "layout.toml"
        result = support.dermis(
            "describe", sample, "--rows", rows, "--cols", cols, "--out", layout, "--force", stdin=subprocess.DEVNULL
        )
        if result.returncode != 0:
            return "is known" if "dermis reads them as they are" in result.stdout else False
        found = self.frames(layout, sample)
        if found.ndim == 4 and wanted.ndim == 3:
            found = found[:, 0]  # the right foot comes first
        return found.shape == wanted.shape and bool((found == wanted.astype(numpy.float32)).all())

    def test_the_first_layout_of_the_samples_is_right(self):
        if not SAMPLES.exists():
            self.skipTest("SKIPPED: ../shared/data/layouts is not there")
        outcomes = {}
        for frames in sorted(SAMPLES.glob("*.npy")):
            [sample] = (path for path in SAMPLES.glob(frames.stem + ".*") if path != frames)
            outcomes[sample.name] = self.reads_as_meant(sample, numpy.load(frames))
        self.assertGreaterEqual(sum(map(bool, outcomes.values())), FEWEST_RIGHT, outcomes)
        for known in ("time_in_the_middle.mat", "insole.asc"):
            self.assertEqual(outcomes[known], "is known")

    def test_the_first_layout_of_strangers_is_right_and_tells_its_doubt(self):
        if not STRANGERS.exists():
            self.skipTest("SKIPPED: ../shared/data/strangers is not there")
        for name, (rows, cols, array, doubt) in STRANGE.items():
            with self.subTest(name):
                sample = STRANGERS / name
                layout = self.work / "layout.toml"
                shown = self.succeed(
                    *("describe", sample, "--rows", rows, "--cols", cols, "--out", layout, "--force"),
                    stdin=subprocess.DEVNULL,
                )
                self.assertIn(doubt, shown)
                wanted = numpy.load(STRANGERS / f"{sample.stem}{array}.npy").astype(numpy.float32)
                found = self.frames(layout, sample)
                numpy.testing.assert_array_equal(found[:, 0] if array else found, wanted)

    def test_two_numbers_of_one_time_are_read_as_it(self):
        if not STRANGERS.exists():
            self.skipTest("SKIPPED: ../shared/data/strangers is not there")
        layout = self.work / "layout.toml"
        sample = STRANGERS / "secs_and_nsecs.jsonl"
        self.succeed("describe", sample, "--rows", 12, "--cols", 6, "--out", layout, stdin=subprocess.DEVNULL)
        said = self.succeed("info", "--layout", layout, f"{sample}#thumb_matrix")
        for words in ("frames        60", "1.475 s", "40.000 Hz"):
            self.assertIn(words, said)

    def test_what_a_silent_device_waits_for_is_found(self):
        frames = pressed(60, 4, 6)
        lines = [",".join(map(str, frame.ravel())) + "\n" for frame in frames]
        for key, ask, arguments in (
            ("start", b"s", ["--ask"]),
            ("request", b"r", ["--ask"]),
            ("start", b"\xaa\x07", ["--ask=\\xAA\\x07"]),
        ):
            with self.subTest(key=key, ask=ask):
                board = socket.create_server(("127.0.0.1", 0))
                source = f"tcp://127.0.0.1:{board.getsockname()[1]}"
                thread = threading.Thread(target=play, args=(board, ask, key == "start", lines), daemon=True)
                thread.start()
                layout = self.work / "asked.toml"
                self.succeed(*("describe", source, *arguments, "--out", layout, "--force"), stdin=subprocess.DEVNULL)
                board.close()
                written = '"s"' if ask == b"s" else '"r"' if ask == b"r" else "[0xAA, 0x07]"
                self.assertIn(f"\n{key} = {written}\n", layout.read_text())
        self.refuse(["describe", self.written("it.log", LINES), "--ask"], ["--ask", "no device"])

    def test_what_speaks_for_a_layout_is_shown(self):
        source = self.written("it.log", "boot v1\n" + LINES)
        shown = self.succeed("describe", source)
        for text in ("rows=4, cols=6?", "40 frames", "the first line", 'line = "{values}"', "? rows, cols", "|"):
            self.assertIn(text, shown)
        found = self.described(source)
        self.assertIsNone(found["known"])
        self.assertLessEqual(len(found["proposals"]), 3)
        first = found["proposals"][0]
        self.assertEqual((first["rows"], first["cols"], first["frames"]), (4, 6, 40))
        self.assertEqual(first["open"], ["rows", "cols"])
        self.assertEqual(len(first["example"]), 24)

    def test_what_is_given_is_not_asked(self):
        source = self.written("it.log", LINES)
        first = self.described(source, "--rows", 6, "--cols", 4, "--unit", "kPa")["proposals"][0]
        self.assertEqual((first["rows"], first["cols"], first["open"]), (6, 4, []))
        self.assertIn('unit = "kPa"', first["layout"])

    def test_a_device_is_described_and_then_read(self):
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        device = f"serial://{os.ttyname(theirs)}"
        layout = self.work / "mat.toml"
        sender = threading.Timer(0.3, os.write, (ours, BINARY))
        sender.start()
        shown = self.succeed("describe", device, "--out", layout, stdin=subprocess.DEVNULL)
        sender.join()
        os.close(ours)
        os.close(theirs)
        self.assertIn("packets of 35 bytes", shown)
        self.assertIn('packet = ["AA 55", "frame u8", "values u16be"]', layout.read_text())
        stream = self.work / "bytes"
        stream.write_bytes(BINARY)
        self.assertEqual(self.frames(layout, stream).shape, (60, 4, 4))

    def test_a_terminal_is_asked_for_what_the_bytes_cannot_tell(self):
        source = self.written("it.log", LINES)
        layout = self.work / "layout.toml"
        ours, theirs = pty.openpty()
        command = [support.BINARY, "describe", str(source), "--out", str(layout)]
        with subprocess.Popen(command, stdin=theirs, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            for question, answer in ((b"rows [4]: ", b"6\n"), (b"columns [6]: ", b"4\n")):
                self.assertTrue(select.select([process.stderr], [], [], 60)[0])
                self.assertEqual(process.stderr.read(len(question)), question)
                os.write(ours, answer)
            self.assertEqual(process.wait(60), 0)
        os.close(ours)
        os.close(theirs)
        self.assertIn("rows = 6\ncols = 4\n", layout.read_text())

    def test_nothing_is_overwritten_in_silence(self):
        source = self.written("it.log", LINES)
        layout = self.written("layout.toml", "mine")
        self.refuse(["describe", source, "--out", layout], ["layout.toml", "--force"])
        self.assertEqual(layout.read_text(), "mine")

    def test_what_dermis_knows_is_said_in_a_line(self):
        shown = self.succeed("describe", self.contacts / "frames.csv")
        self.assertEqual(
            shown, f"{self.contacts / 'frames.csv'}: these bytes are frames.csv: dermis reads them as they are\n"
        )
        lines = self.written("rows.txt", LINES.replace(" ", ","))
        self.assertEqual(self.described(f"file:{lines}")["known"], "csv")

    def test_what_dermis_cannot_read_is_said_as_it_looks(self):
        shown = self.succeed("info", self.written("bare.csv", LINES.replace(" ", ",")))
        self.assertRegex(
            shown, r"(?m)^or +The bytes look like 40 lines of 24 numbers: rows=4, cols=6\?; 'dermis describe "
        )
        log = self.written("LOG.DAT", LINES)
        self.refuse(["info", log], ["tells no format", "40 lines of 24 numbers", f"'dermis describe {log}' shows more"])
        triples = "".join(
            "".join(f"{row},{col},{value}\n" for (row, col), value in numpy.ndenumerate(frame)) + "\n"
            for frame in pressed(30, 4, 6)
        )
        source = f"file:{self.written('triples', triples)}"
        refused = support.dermis("record", "--from", source, "--out", self.work / "out.npy")
        self.assertEqual(refused.returncode, 2)
        for part in ("no known protocol", "720 lines of 1 number: rows=4, cols=6", f"'dermis describe {source}' shows"):
            self.assertIn(part, refused.stderr.splitlines()[-1])

    def test_bad_input_is_one_line(self):
        prose = self.written("prose.txt", "The quick brown fox jumps over the lazy dog.\n" * 50)
        self.refuse(["describe", prose], ["prose.txt", "no layout reads most of these bytes"])
        self.refuse(["describe", self.work / "none.log"], ["none.log"])
        self.refuse(["describe", self.written("empty.log", "")], ["empty.log", "not a single byte"])
        self.refuse(["describe", "sim:multitouch"], ["simulation"])
        self.refuse(["describe", prose, "--rows", 0], ["--rows", "1 to 1024"])
        self.refuse(["describe", prose, "--unit", "pounds"], ["--unit", "newtons"])


if __name__ == "__main__":
    support.main()
