# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis image and dermis top: pictures read back by Python, a terminal played by it."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import termios
import time
import xml.etree.ElementTree as ElementTree
import zlib

import support
from support import SmallArray, dermis, error_lines

SOURCE = "sim:multitouch?rows=4&cols=5&rate=200&seed=3"
PNG = b"\x89PNG\r\n\x1a\n"


def chunks_of(path):
    """Type and data of the chunks of a PNG file, checksums verified."""
    data = path.read_bytes()
    assert data.startswith(PNG)
    place, chunks = len(PNG), []
    while place < len(data):
        (size,) = struct.unpack_from(">I", data, place)
        body = data[place + 4 : place + 8 + size]
        assert zlib.crc32(body) == struct.unpack_from(">I", data, place + 8 + size)[0]
        chunks.append((body[:4].decode(), body[4:]))
        place += size + 12
    return chunks


class Image(SmallArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.recording = cls.root / "rec.mcap"
        result = dermis("record", "--from", SOURCE, "--array", cls.array, "--frames", 200, "--out", cls.recording)
        if result.returncode != 0:
            raise AssertionError(result.stderr)

    def draw(self, out, *options):
        result = dermis("image", "--in", self.recording, "--out", out, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, "")

    def test_png_holds_a_whole_picture(self):
        for name, options in (
            ("counts.png", ()),
            ("force.png", ("--model", self.model, "--at", 0.5)),
            ("number.png", ("--model", self.model, "--frame", 100, "--high", 7)),
        ):
            out = self.work / name
            self.draw(out, *options)
            (kind, header), *rest = chunks_of(out)
            self.assertEqual(kind, "IHDR")
            width, height, depth, colour = struct.unpack(">IIBB", header[:10])
            self.assertEqual((depth, colour), (8, 2))
            pixels = zlib.decompress(b"".join(data for kind, data in rest if kind == "IDAT"))
            self.assertEqual(len(pixels), height * (1 + 3 * width))
        self.assertEqual((self.work / "force.png").read_bytes()[:33], (self.work / "number.png").read_bytes()[:33])

    def test_without_what_paints_pixels_there_are_still_drawings(self):
        binary = support.binary_without("libdermis_pictures.so", self.work)
        for name, status in (("frame.png", 2), ("film.gif", 2), ("frame.svg", 0)):
            out = self.work / name
            span = ("--from", 0, "--to", 0.5) if name == "film.gif" else ()
            result = dermis("image", "--in", self.recording, "--out", out, *span, executable=binary)
            self.assertEqual((result.returncode, out.exists()), (status, status == 0), result.stderr)
            if status:
                line = r"^dermis: a \.png or \.gif needs libdermis_no\.so .*libcairo2.* which \.svg does not: .*\n$"
                self.assertRegex(result.stderr, line)

    def test_svg_says_unit_scale_and_forces(self):
        out = self.work / "force.svg"
        self.draw(out, "--model", self.model, "--at", 0.5, "--high", 20)
        texts = [element.text for element in ElementTree.parse(out).iter() if element.tag.endswith("text")]
        self.assertIn("small", texts)
        self.assertIn("N", texts)
        self.assertIn("20", texts)
        self.assertTrue(any(text.startswith("0.500 s") for text in texts), texts)

        self.draw(out)
        texts = [element.text for element in ElementTree.parse(out).iter() if element.tag.endswith("text")]
        self.assertIn("counts", texts)
        self.assertIn("4000", texts)

    def test_seconds_become_a_film(self):
        out = self.work / "moving.gif"
        self.draw(out, "--model", self.model, "--from", 0.2, "--to", 0.6)
        film = out.read_bytes()
        self.assertTrue(film.startswith(b"GIF89a"))
        self.assertTrue(film.endswith(b";"))
        self.assertEqual(film.count(b"\x21\xf9\x04\x04\x04\x00"), 10, "pictures that are shown for 40 ms")

    def test_wrong_wishes_are_one_line(self):
        for options, said in (
            (("--out", "a.gif"), "must end in .png or .svg; a film (.gif) needs --from and --to"),
            (("--out", "a.png", "--at", 100), "has 200 frames"),
            (("--out", "a.png", "--from", 0, "--to", 1), "must end in .gif, as a film does"),
            (("--out", "a.gif", "--from", 2, "--to", 1), "later than --from"),
            (("--out", "a.png", "--high", 0), "more than 0"),
        ):
            result = dermis("image", "--in", self.recording, *options, cwd=self.work)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(len(error_lines(result)), 1, result.stderr)
            self.assertIn(said, result.stderr)
        self.assertEqual(list(self.work.iterdir()), [])


class Terminal:
    """A terminal in which a command runs."""

    def __init__(self, lines, columns, *command, **environment):
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.environ.update({"TERM": "xterm-256color", "COLORTERM": "", "NO_COLOR": "", **environment})
            os.execv(support.BINARY, [support.BINARY, *map(str, command)])
        self.shown = b""
        self.resize(lines, columns)

    def resize(self, lines, columns):
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))

    def read_until(self, pattern):
        """What is shown from now on up to `pattern`."""
        self.shown = b""
        deadline = time.monotonic() + 60
        while not re.search(pattern, self.shown, re.DOTALL):
            assert time.monotonic() < deadline, (pattern, self.shown[-2000:])
            if not select.select([self.terminal], [], [], 1)[0]:
                continue
            self.shown += os.read(self.terminal, 65536)
        return self.shown

    def end(self, keys=b"\x03"):
        """Types, and waits for the end; what was shown, and the status."""
        os.write(self.terminal, keys)
        try:
            while data := os.read(self.terminal, 65536):
                self.shown += data
        except OSError:  # the other side has closed it
            pass
        os.close(self.terminal)
        return self.shown, os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


def screens_of(shown):
    """The whole screens in what was written, each as lines without their colours."""
    plain = re.sub(rb"\x1b\[[0-9;?]*m", b"", shown)
    return [
        [line.replace("\x1b[K", "").rstrip("\r") for line in screen.decode(errors="replace").split("\n")]
        for screen in plain.split(b"\x1b[H")[1:-1]
    ]


class Top(SmallArray):
    def test_colours_contacts_and_the_end(self):
        for environment, colour in (
            ({"COLORTERM": "truecolor"}, rb"\x1b\[38;2;\d+;\d+;\d+m"),
            ({}, rb"\x1b\[38;5;\d+m"),
        ):
            terminal = Terminal(24, 80, "top", "--from", SOURCE, "--model", self.model, **environment)
            shown = terminal.read_until(rb"#\d+ +\d+\.\d\d N +[\d.-]+ +[\d.-]+ mm")
            self.assertIn(b"\x1b[?1049h", shown)
            self.assertRegex(shown, colour)
            self.assertIn("\u2580".encode(), shown)
            terminal.read_until(rb"small  4x5  \d+\.\d frames/s  0 lost  0 damaged")
            shown, status = terminal.end()
            self.assertEqual(status, 0)
            self.assertTrue(shown.endswith(b"\x1b[0m\x1b[?25h\x1b[?1049l"), shown[-100:])

    def test_without_colours_and_model(self):
        terminal = Terminal(24, 80, "top", "--from", SOURCE, TERM="dumb")
        terminal.read_until(rb"frames/s")
        shown = terminal.read_until(rb"[.:=+*#%@-]{8}.* counts")
        self.assertNotIn("\u2580".encode(), shown)
        self.assertEqual(terminal.end()[1], 0)

    def test_follows_the_size_of_the_terminal(self):
        terminal = Terminal(24, 80, "top", "--from", SOURCE, "--model", self.model)
        terminal.read_until(rb"frames/s")
        for lines, columns in ((50, 132), (10, 30), (2, 5), (1, 1)):
            terminal.resize(lines, columns)
            terminal.read_until(rb"(\x1b\[H.*){6}")
            screen = screens_of(terminal.shown)[-1]
            self.assertLessEqual(len(screen), lines)
            self.assertLessEqual(max(len(line.replace("\x1b[J", "")) for line in screen), columns, screen)
        self.assertEqual(terminal.end()[1], 0)

    def test_q_ends_it(self):
        terminal = Terminal(24, 80, "top", "--from", SOURCE)
        terminal.read_until(rb"frames/s")
        self.assertEqual(terminal.end(b"xq")[1], 0)

    def test_errors_are_shown_on_the_own_screen(self):
        terminal = Terminal(24, 80, "top", "--from", "nothing.mcap")
        shown, status = terminal.end(b"")
        self.assertEqual(status, 2)
        self.assertIn(b"nothing.mcap", shown)
        self.assertNotIn(b"\x1b", shown)

    def test_needs_a_terminal(self):
        result = dermis("top", "--from", SOURCE)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn("no terminal", result.stderr)

    def test_a_hang_up_ends_it(self):
        terminal = Terminal(24, 80, "top", "--from", SOURCE)
        terminal.read_until(rb"frames/s")
        os.kill(terminal.pid, signal.SIGTERM)
        self.assertEqual(terminal.end(b"")[1], 0)

    def test_record_shows_how_far_a_scene_is_simulated(self):
        terminal = Terminal(
            24, 80, "record", "--from", "sim:contacts?rows=4&cols=5&rate=100", "--out", self.work / "r.mcap"
        )
        terminal.read_until(rb"simulating the scene: \d+ %")
        terminal.read_until(rb"[1-9]\d* frames, ")
        self.assertEqual(terminal.end()[1], 0)


if __name__ == "__main__":
    support.main()
