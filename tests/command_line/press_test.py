# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis describe --press: which channel of a board is where, from a recording and live."""

import contextlib
import json
import os
import pty
import re
import subprocess
import threading
import time
import tty

import numpy
import support

RATE = 50
PLACES = "x_mm,y_mm,name\n0,0,thumb\n12,3,\n20,11,index tip\n5,18,\n30,25,\n"
ORDER = [3, 0, 5, 1, 4]  # channels of the places; of six


def frames_of(order, channels, seed=1, level=300, press=600, held=0.5, between=0.5):
    """Presses one after another, with noise and crosstalk."""
    noise = numpy.random.default_rng(seed)
    steps = int(RATE * (1 + (held + between) * len(order)))
    frames = level + noise.normal(0, 2, (steps, channels))
    for place, channel in enumerate(order):
        if channel is None:
            continue
        first = int(RATE * (1 + (held + between) * place))
        shape = press * numpy.sin(numpy.linspace(0, numpy.pi, int(RATE * held)))
        frames[first : first + len(shape)] += 0.12 * shape[:, None]
        frames[first : first + len(shape), channel] += 0.88 * shape
    return frames.round().astype(numpy.uint16)


class Press(support.SmallArray):
    def setUp(self):
        super().setUp()
        self.places = self.work / "places.csv"
        self.places.write_text(PLACES)

    def recording(self, frames, rows, cols):
        path = self.work / "pressed.npy"
        numpy.save(path, frames.reshape(len(frames), rows, cols))
        return f"file:{path}?rate={RATE}"

    def described(self, source, places, *arguments, exit_code=0):
        out = self.work / "hand.toml"
        result = support.dermis("describe", source, "--press", places, "--out", out, *arguments)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result, out

    def frames(self, source, *arguments):
        out = self.work / "back.npy"
        recording = self.work / "back.mcap"
        result = support.dermis("record", "--from", source, "--out", recording, "--force", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = support.dermis("convert", recording, out, "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        return numpy.load(out)

    def test_what_comes_out_of_a_recording_reads_it_in_order(self):
        frames = frames_of(ORDER, 6)
        result, out = self.described(self.recording(frames, 1, 6), self.places)
        self.assertIn("place 3 of 5 (x 20 mm, y 11 mm; index tip): channel 5\n", result.stdout)
        self.assertIn("channel 2 never answered\n", result.stdout)
        suit = (self.work / "hand.suit.toml").read_text()
        source = next(line.split('"')[1] for line in suit.splitlines() if line.startswith("from"))
        self.assertIn(f"frames in this order: {source}\n", result.stdout)
        numpy.testing.assert_array_equal(self.frames(source), frames[:, None, ORDER])
        positions = (self.work / "hand.positions.csv").read_text()
        self.assertEqual(positions.splitlines()[:4], ["x_mm,y_mm,z_mm", "0,0,0", "12,3,0", "20,11,0"])
        again = support.dermis("describe", source.split("?")[0] + f"?rate={RATE}", "--press", self.places, "--out", out)
        self.assertEqual(again.returncode, 2)
        self.assertIn("exists", again.stderr)

    def test_taxels_in_no_grid_are_drawn_as_discs_at_their_places(self):
        source = self.recording(frames_of(ORDER, 6), 1, 6)
        result, _ = self.described(source, self.places)
        turned = result.stdout.splitlines()[-1].removeprefix("frames in this order: ")
        picture = self.work / "palm.svg"
        for model, discs in (([], 0), (["--model", self.work / "hand.suit.toml"], 5)):
            drawn = support.dermis("image", "--in", turned, *model, "--frame", "60", "--out", picture, "--force")
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            dots = re.findall(r'd="M([\d.]+)[ ,]([\d.]+) ?L\1[ ,]\2"', picture.read_text())
            self.assertEqual(len(set(dots)), discs, picture.read_text()[:3000])
        several = (self.work / "hand.suit.toml").read_text()
        (self.work / "two.suit.toml").write_text(several + several.replace('name = "hand"', 'name = "other"'))
        drawn = support.dermis("image", "--in", turned, "--model", self.work / "two.suit.toml", "--out", picture)
        self.assertIn("has several arrays; name the model of one", drawn.stderr)

    def test_the_bytes_of_a_device_are_read_by_the_description_that_comes_out(self):
        frames = frames_of(numpy.random.default_rng(4).permutation(12), 12)
        order = [int(channel) for channel in numpy.random.default_rng(4).permutation(12)]
        log = self.work / "log.txt"
        log.write_text("".join(" ".join(map(str, frame)) + "\n" for frame in frames))
        source = f"file:{log}?rows=2&cols=6&line={{values}}"
        _, out = self.described(source, "3x4", "--pitch", "8")
        text = out.read_text()
        self.assertIn("sent = [2, 6]", text)
        numpy.testing.assert_array_equal(self.frames(source, "--array", out).reshape(len(frames), 12), frames[:, order])

    def test_a_recording_with_a_place_too_few_is_refused(self):
        result, out = self.described(self.recording(frames_of(ORDER[:4], 6), 1, 6), self.places, exit_code=2)
        self.assertIn("4 presses were found for 5 places: a place was passed over", result.stderr)
        self.assertFalse(out.exists())

    def test_places_that_are_none_are_refused(self):
        for text, word in (
            ("x_mm\n1\n", "the first line must be x_mm,y_mm"),
            ("x_mm,y_mm\n1,far\n", "places.csv:2: must be what the first line says"),
            ("x_mm,y_mm\n", "there must be 1 to 1024 places, not 0"),
        ):
            self.places.write_text(text)
            result, _ = self.described(self.recording(frames_of(ORDER, 6), 1, 6), self.places, exit_code=2)
            self.assertIn(word, result.stderr)

    def test_a_person_is_led_from_place_to_place(self):
        board, terminal = pty.openpty()
        tty.setraw(terminal)
        keys, keyboard = pty.openpty()
        process = subprocess.Popen(
            [
                support.BINARY,
                "describe",
                f"serial://{os.ttyname(terminal)}?rows=1&cols=6&line={{values}}",
                "--press",
                self.places,
                "--out",
                self.work / "hand.toml",
                "--json",
            ],
            stdin=keyboard,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        pressed = [None]
        ends = threading.Event()

        def play():
            noise = numpy.random.default_rng(2)
            force = 0.0
            while not ends.wait(1 / RATE):
                force += 0.4 * ((0.0 if pressed[0] is None else 700.0) - force)
                frame = 200 + noise.normal(0, 2, 6) + 0.1 * force
                if pressed[0] is not None:
                    frame[pressed[0]] += 0.9 * force
                with contextlib.suppress(BlockingIOError, OSError):
                    os.write(board, (" ".join(str(int(x)) for x in frame.round()) + "\n").encode())

        os.set_blocking(board, False)
        player = threading.Thread(target=play)
        player.start()

        def press(channel):
            pressed[0] = channel
            time.sleep(0.4)
            pressed[0] = None

        def hear(word):
            while line := process.stderr.readline():
                if word in line:
                    return
            self.fail(f"'{word}' was not said")

        try:
            hear("take your hands off")
            hear("press place 1 of 5 (x 0 mm, y 0 mm; thumb)")
            press(3)
            hear("channel 3")
            hear("press place 2 of 5")
            press(3)
            hear("channel 3 again: it answered at place 1 already")
            press(0)
            hear("channel 0")
            hear("press place 3 of 5")
            os.write(keys, b"\n")
            hear("press place 4 of 5")
            os.write(keys, b"b\n")
            hear("press place 3 of 5")
            press(5)
            hear("channel 5")
            hear("press place 4 of 5")
            os.write(keys, b"\n")
            hear("press place 5 of 5")
            press(4)
            output, _ = process.communicate(timeout=20)
        finally:
            ends.set()
            player.join()
            process.kill()
            process.wait()
        self.assertEqual(process.returncode, 0)
        answer = json.loads(output)
        self.assertEqual(answer["channels"], [3, 0, 5, None, 4])
        self.assertIn("place 4 never answered", answer["remarks"])
        self.assertIn("taxel_order = [3, 0, 5, 4]", (self.work / "hand.toml").read_text())


if __name__ == "__main__":
    support.main()
