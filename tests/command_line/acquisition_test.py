# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Devices, real ones as far as a computer has them: pseudo-terminals, sockets, and the emulated device on the other
side. Contents are compared, never times."""

import contextlib
import fcntl
import glob
import os
import pty
import signal
import socket
import struct
import subprocess
import termios
import time
import tty

import support
from support import SmallArray, dermis, error_lines, files_limited_to

PATIENCE = 120  # [s], for a loaded computer
PROTOCOLS = [
    "3dvitac",
    "csv",
    "dermis",
    "flexitac",
    "m1616",
    "pressure-mat",
    "stag",
    "tactileglove",
    "wiresens",
    "wuji",
]
SHAPES = {"m1616": (16, 16), "pressure-mat": (56, 28), "wuji": (24, 32), "tactileglove": (8, 8)}
MOST_COUNTS = {"flexitac": 255, "pressure-mat": 207, "3dvitac": 1023, "stag": 1023}


def finish(process, patience=PATIENCE):
    out, err = process.communicate(timeout=patience)
    return process.returncode, out, [line for line in err.splitlines() if line]


def read_until(process, word):
    """The line of stderr that holds `word`."""
    lines = []
    for line in process.stderr:
        lines.append(line)
        if word in line:
            return line
    raise AssertionError(f"the process ended without '{word}': {lines}")


def table(path):
    """The taxels of a frames.csv or forces.csv, as text."""
    lines = [line.split(",") for line in path.read_text().splitlines()]
    first = lines[0].index("r0c0")
    return [line[first : first + len(lines[0]) - first] for line in lines[1:]]


class FramesOfAnyShape:
    """frames.csv with whole counts that differ from frame to frame."""

    @staticmethod
    def write(path, rows, cols, count, most=4095, period=0.01):
        names = ",".join(f"r{row}c{col}" for row in range(rows) for col in range(cols))
        state = 12345
        with open(path, "w") as out:
            out.write(f"time_s,{names}\n")
            for frame in range(count):
                values = []
                for _ in range(rows * cols):
                    state = (state * 1103515245 + 12345) % (1 << 31)
                    values.append(str((state >> 8) % (most + 1)))
                out.write(f"{frame * period:.6f},{','.join(values)}\n")
        return path


class Terminal:
    """A pseudo-terminal behind a name of its own, as a serial device behind its udev link."""

    def __init__(self, link):
        self.link = link
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        if os.path.lexists(link):
            os.unlink(link)
        os.symlink(os.ttyname(self.slave), link)

    def send(self, data):
        while data:
            data = data[os.write(self.master, data) :]

    def is_open_elsewhere(self):
        name, own = os.ttyname(self.slave), f"/proc/{os.getpid()}/"
        for file in glob.iglob("/proc/[0-9]*/fd/*"):
            with contextlib.suppress(OSError):  # of a process that has just ended
                if not file.startswith(own) and os.readlink(file) == name:
                    return True
        return False

    def wait_until_read(self):
        """Until a program has opened it and taken all that was sent. On a busy machine the system itself holds what was
        sent for a while, so that nothing seems to wait."""
        patience = time.monotonic() + 60
        while not self.is_open_elsewhere() and time.monotonic() < patience:
            time.sleep(0.02)
        idle = 0
        while idle < 10:
            waiting = fcntl.ioctl(self.slave, termios.FIONREAD, struct.pack("i", 0))
            idle = 0 if struct.unpack("i", waiting)[0] else idle + 1
            time.sleep(0.02)

    def unplug(self):
        os.unlink(self.link)
        os.close(self.slave)
        os.close(self.master)


class Devices(SmallArray):
    def start(self, *arguments):
        command = [support.BINARY, *map(str, arguments)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.put_away, process)
        return process

    @staticmethod
    def put_away(process):
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()

    def encoded(self, protocol, rows, cols, count, **options):
        """Frames and the bytes of a device that sends them."""
        frames = FramesOfAnyShape.write(
            self.work / f"{protocol}.csv", rows, cols, count, MOST_COUNTS.get(protocol, 4095), **options
        )
        result = subprocess.run(
            [
                support.BINARY,
                "emulate",
                "--protocol",
                protocol,
                "--in",
                str(frames),
                "--rate",
                "1e6",
                "--to",
                "stdout:",
            ],
            capture_output=True,
            timeout=PATIENCE,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return table(frames), result.stdout

    def replayed(self, recording):
        out = self.work / "replayed.csv"
        result = dermis("replay", recording, "--speed", 0, "--out", out, "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        return table(out)

    def assert_recorded(self, recording, frames):
        self.assertEqual(self.replayed(recording), frames)


class Emulation(Devices):
    def test_every_protocol_comes_through_a_pty(self):
        for protocol in PROTOCOLS:
            if protocol == "stag" or protocol == "pressure-mat":
                continue  # asked for each frame: below
            with self.subTest(protocol):
                self.emulate_and_record(protocol)

    def test_devices_that_are_asked_for_each_frame(self):
        for protocol in ("stag", "pressure-mat"):
            with self.subTest(protocol):
                self.emulate_and_record(protocol)

    def emulate_and_record(self, protocol):
        rows, cols = SHAPES.get(protocol, (6, 10))
        frames = FramesOfAnyShape.write(self.work / "in.csv", rows, cols, 60, MOST_COUNTS.get(protocol, 4095))
        recording = self.work / f"{protocol}.mcap"
        device = self.start("emulate", "--protocol", protocol, "--in", frames, "--rate", 200)
        name = device.stdout.readline().strip()
        result = dermis(
            "record",
            "--from",
            f"serial://{name}?protocol={protocol}&rows={rows}&cols={cols}",
            "--frames",
            60,
            "--out",
            recording,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(finish(device)[0], 0)
        self.assert_recorded(recording, table(frames))

    def test_sockets(self):
        frames = FramesOfAnyShape.write(self.work / "in.csv", 6, 10, 60)
        device = self.start("emulate", "--protocol", "dermis", "--in", frames, "--to", "tcp-listen://127.0.0.1:0")
        place = device.stdout.readline().strip()
        recording = self.work / "tcp.mcap"
        result = dermis("record", "--from", f"tcp://{place}?protocol=dermis&reconnect_s=0", "--out", recording)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(finish(device)[0], 0)
        self.assert_recorded(recording, table(frames))

    def test_standard_input(self):
        frames, data = self.encoded("dermis", 6, 10, 60)
        recording = self.work / "stdin.mcap"
        result = subprocess.run(
            [support.BINARY, "record", "--from", "stdin:?protocol=auto", "--out", str(recording)],
            input=data,
            capture_output=True,
            timeout=PATIENCE,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_recorded(recording, frames)

    def test_a_wrong_output_is_told_before_the_device_speaks(self):
        missing = self.work / "missing" / "r.mcap"
        for out, word, status in [(self.work / "r.foo", "format of frames", 2), (missing, "No such file", 1)]:
            with self.subTest(out.name):
                with subprocess.Popen(
                    [support.BINARY, "record", "--from", "stdin:?protocol=dermis", "--out", out],
                    stdin=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    text=True,
                ) as silent:
                    self.addCleanup(silent.kill)
                    self.assertEqual(silent.wait(PATIENCE), status)
                    lines = silent.stderr.read().splitlines()
                self.assertEqual(len(lines), 1)
                self.assertIn(word, lines[0])


class Unplugged(Devices):
    def test_a_device_that_comes_back(self):
        frames, data = self.encoded("dermis", 6, 10, 60)
        half = len(data) // 2
        link, recording = self.work / "tty", self.work / "r.mcap"
        terminal = Terminal(link)
        process = self.start("record", "--from", f"serial://{link}?protocol=dermis", "--frames", 59, "--out", recording)
        terminal.send(data[:half])  # and half a frame is cut off
        terminal.wait_until_read()
        terminal.unplug()
        read_until(process, "unplugged")
        terminal = Terminal(link)
        read_until(process, "is back")
        terminal.send(data[half:])
        status, _, errors = finish(process)
        self.assertEqual(status, 0, errors)
        self.assertIn("reconnected", errors[-1])
        recorded = self.replayed(recording)
        self.assertEqual(len(recorded), 59)
        self.assertEqual([frame for frame in frames if frame in recorded], recorded)
        terminal.unplug()

    def test_a_device_that_does_not(self):
        frames, data = self.encoded("dermis", 6, 10, 20)
        link, recording = self.work / "tty", self.work / "r.mcap"
        terminal = Terminal(link)
        process = self.start("record", "--from", f"serial://{link}?protocol=dermis&reconnect_s=0.3", "--out", recording)
        terminal.send(data)
        terminal.wait_until_read()
        terminal.unplug()
        status, _, errors = finish(process)
        self.assertEqual(status, 1)
        self.assertTrue(errors[-1].startswith("dermis: "), errors)
        self.assertIn("did not come back within 0.3 s", errors[-1])
        self.assert_recorded(recording, frames)


class Interrupted(Devices):
    def test_ctrl_c_leaves_a_complete_recording(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                frames, data = self.encoded("dermis", 6, 10, 30)
                link, recording = self.work / "tty", self.work / f"{number.name}.mcap"
                terminal = Terminal(link)
                process = self.start("record", "--from", f"serial://{link}?protocol=dermis", "--out", recording)
                terminal.send(data)
                terminal.wait_until_read()
                process.send_signal(number)
                status, _, errors = finish(process)
                self.assertEqual(status, 0, errors)
                self.assertIn("30 frames", errors[-1])
                self.assert_recorded(recording, frames)
                terminal.unplug()

    def test_ctrl_c_ends_run_with_a_complete_file(self):
        _, data = self.encoded("dermis", 4, 5, 30)
        link, out = self.work / "tty", self.work / "forces.csv"
        terminal = Terminal(link)
        process = self.start("run", "--model", self.model, "--in", f"serial://{link}?protocol=dermis", "--out", out)
        terminal.send(data)
        terminal.wait_until_read()
        process.send_signal(signal.SIGINT)
        status, _, errors = finish(process)
        self.assertEqual(status, 1, errors)  # the device's counts are no array's
        self.assertIn("30 of 30 frames have no force", errors[-1])
        self.assertEqual(len(table(out)), 30)
        terminal.unplug()

    def test_nobody_who_reads_the_messages(self):
        """A log on a full disk, and a standard error that is closed."""
        for redirection in ("2>/dev/full", "2>&-"):
            with self.subTest(redirection):
                recording = self.work / "r.mcap"
                source = "sim:multitouch?rows=4&cols=4&rate=100"
                command = f"'{support.BINARY}' record --from '{source}' --seconds 6 --out '{recording}' --force"
                result = subprocess.run(["sh", "-c", f"{command} {redirection}"], timeout=PATIENCE)
                self.assertEqual(result.returncode, 0)
                self.assertGreater(len(self.replayed(recording)), 100)
                self.assertNotIn(b"0 damaged", recording.read_bytes())

    def test_a_device_that_says_nothing_is_given_up_by_the_user(self):
        link = self.work / "tty"
        terminal = Terminal(link)
        process = self.start("record", "--from", f"serial://{link}?protocol=dermis", "--out", self.work / "r.mcap")
        read_until(process, "no bytes from")
        process.send_signal(signal.SIGINT)
        status, _, errors = finish(process)
        self.assertEqual(status, 1)
        self.assertIn("not a single frame", errors[-1])
        self.assertFalse((self.work / "r.mcap").exists())
        terminal.unplug()


class Refused(Devices):
    def record(self, uri, *options):
        return ["record", "--from", uri, "--out", self.work / "r.mcap", *options]

    def test_a_device_that_is_not_there(self):
        self.refuse(self.record("serial:///dev/no_such_tty?protocol=csv"), ["/dev/no_such_tty", "not there"], status=1)

    def test_a_port_in_use(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            place = f"127.0.0.1:{server.getsockname()[1]}"
            self.refuse(self.record(f"tcp-listen://{place}"), [place, "in use"], status=1)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            place = f"127.0.0.1:{other.getsockname()[1]}"
            self.refuse(self.record(f"udp://{place}"), [place, "in use"], status=1)

    def test_nobody_listens(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            place = f"127.0.0.1:{server.getsockname()[1]}"
        self.refuse(self.record(f"tcp://{place}"), [place, "nothing listens"], status=1)

    def test_a_device_that_another_program_has(self):
        link = self.work / "tty"
        terminal = Terminal(link)
        process = self.start(*self.record(f"serial://{link}?protocol=csv"))
        read_until(process, "no bytes from")  # it has the device
        again = ["record", "--from", f"serial://{link}?protocol=csv", "--out", self.work / "again.mcap"]
        self.refuse(again, [link, "in use by another program"], status=1)
        process.send_signal(signal.SIGINT)
        finish(process)
        terminal.unplug()

    def test_no_permission(self):
        user = support.as_nobody(self)
        master, slave = pty.openpty()
        name = os.ttyname(slave)
        os.chmod(name, 0o000)
        result = dermis("record", "--from", f"serial://{name}?protocol=csv", "--out", "/dev/null", **user)
        self.assertEqual(result.returncode, 1)
        self.assertIn("dialout", error_lines(result)[0])
        os.close(master)
        os.close(slave)

    def test_the_wrong_protocol(self):
        _, data = self.encoded("dermis", 6, 10, 60)
        path = self.work / "bytes"
        path.write_bytes(data)
        self.refuse(self.record(f"file:{path}?protocol=wuji"), ["not wuji", "protocol=dermis"])

    def test_text_that_lacks_something(self):
        row = ",".join(map(str, range(10))) + "\n"
        line = ",".join(map(str, range(120))) + "\n"
        times = [f"{20 * k}," for k in range(40)]
        separators = ["rows of 10 readings", "print an empty line between frames, or whole frames in one line"]
        for text, query, words in [
            (line * 40, "", ["120 readings", "rows=12&cols=10"]),
            ("".join(moment + line for moment in times), "", ["a time and 120 readings", "rows=12&cols=10"]),
            (row * 120, "", ["10 readings", "print an empty line between frames"]),
            (row * 120, "?rows=12&cols=10", separators),
            ("ready\n" + row * 120, "?rows=12&cols=10", separators),
            ("\n" + row * 120, "?rows=12&cols=10", separators),
            ("[" + line[:-1] + "]\n", "", ["json", "120 readings", "rows=12&cols=10"]),
        ]:
            path = self.work / "bytes"
            path.write_text(text * 5 if text.startswith("[") else text)
            with self.subTest(text=text[:30], query=query):
                result = dermis(*self.record(f"file:{path}{query}"))
                self.assertEqual(result.returncode, 2, result.stderr)
                for word in words:
                    self.assertIn(word, result.stderr.splitlines()[-1])

    def test_garbage_on_a_line_that_goes_on(self):
        link = self.work / "tty"
        terminal = Terminal(link)
        os.set_blocking(terminal.master, False)
        process = self.start(*self.record(f"serial://{link}?protocol=dermis&rows=4&cols=4&baud=9600"))
        while process.poll() is None:
            try:
                os.write(terminal.master, bytes(range(1, 100)))
            except BlockingIOError:
                pass  # it has given up, and looks at what came
            except OSError:
                break
            time.sleep(0.02)
        status, _, errors = finish(process)
        self.assertEqual(status, 2, errors)
        errors = [line for line in errors if not line.startswith("0 frames, ")]  # every 5 s, on a slow machine
        self.assertEqual(len(errors), 1, errors)
        self.assertIn("check protocol=", errors[0])
        terminal.unplug()

    def test_a_parameter_with_a_slip(self):
        self.refuse(self.record("serial:///dev/ttyACM0?boud=9600"), ["boud", "did you mean 'baud'"])
        self.refuse(self.record("modbus-tcp://hand?mpa=inspire-rh56"), ["lacks map=NAME"])
        self.refuse(self.record("dds://0/rt/chest/raw?type=sensor_msgs/msg/Imag"), ["'sensor_msgs/msg/Image'"])

    def test_an_array_of_another_shape(self):
        self.refuse(self.record("sim:idle?rows=3&cols=3&array=" + str(self.array)), ["4x5"])
        self.refuse(self.record("serial:///dev/null?protocol=csv&rows=9&cols=9", "--array", self.array), ["9x9", "4x5"])

    def test_forces_without_a_place(self):
        self.refuse(
            ["record", "--from", "sim:idle?frames=3", "--model", self.model, "--out", self.work / "r.csv"], [".mcap"]
        )

    def test_what_was_there_stays_where_nothing_comes(self):
        recording = self.written("r.mcap", "what was there")
        self.refuse(self.record("file:/dev/null?protocol=m1616", "--force"), ["not a single byte"])
        self.assertEqual(recording.read_text(), "what was there")

    def test_a_full_disk(self):
        """Whatever room it leaves, the recording ends with its index."""
        for kilobytes in range(90, 116):
            with self.subTest(kilobytes):
                recording = self.work / f"{kilobytes}.mcap"
                result = dermis(
                    "record",
                    "--from",
                    "sim:multitouch?rows=16&cols=16&rate=500",
                    "--seconds",
                    60,
                    "--out",
                    recording,
                    **files_limited_to(1024 * kilobytes),
                )
                self.assertEqual(result.returncode, 1)
                self.assertIn(recording.name, result.stderr.splitlines()[-1])
                self.succeed("info", recording)  # which it fails of what is not complete
                self.assertGreater(len(self.replayed(recording)), 0)


class MovingContacts(Devices):
    def test_a_live_array_shows_the_scene_that_the_simulator_writes(self):
        self.succeed("simulate", "--array", self.array, "--scene", "contacts", "--frames", 300, "--out", self.work)
        live = self.work / "live.csv"
        recording = self.work / "r.mcap"
        result = dermis(
            "record",
            "--from",
            f"sim:contacts?rate=200&frames=300&array={self.array}",
            "--frames",
            500,
            "--out",
            recording,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.succeed("replay", recording, "--speed", 0, "--out", live)
        exact = [
            [float(cell) for cell in line.split(",")]
            for line in (self.work / "frames.csv").read_text().splitlines()[1:]
        ]
        lines = [[float(cell) for cell in line.split(",")] for line in live.read_text().splitlines()[1:]]
        compared = 0
        for line in lines:
            moment = round((line[0] - lines[0][0]) * 200)
            if moment % 2 == 1:
                continue
            compared += 1
            for counts, expected in zip(line[3:], exact[moment // 2][3:]):
                self.assertLess(abs(counts - expected), 8.0 + 0.005 * expected)
        self.assertGreater(compared, 100)
        self.assertGreater(max(max(line[3:]) for line in lines), 100)

    def test_the_truth_of_contacts(self):
        self.succeed("simulate", "--array", self.array, "--scene", "contacts", "--frames", 300, "--out", self.work)
        lines = [line.split(",") for line in (self.work / "contacts.csv").read_text().splitlines()]
        self.assertEqual(",".join(lines[0]), "frame,id,shape,x_mm,y_mm,diameter_mm,force_n,taxel_force_n")
        on_taxels, loads = {}, {}
        for line in lines[1:]:
            on_taxels[line[0]] = on_taxels.get(line[0], 0.0) + float(line[7])
        for line in (self.work / "loads.csv").read_text().splitlines()[1:]:
            frame, _, _, newtons = line.split(",")
            loads[frame] = loads.get(frame, 0.0) + float(newtons)
        self.assertGreater(len(on_taxels), 100)
        for frame, newtons in on_taxels.items():
            self.assertAlmostEqual(newtons, loads[frame], delta=1e-4 * newtons + 1e-6)


class Replay(Devices):
    def test_forces_are_the_same_at_any_speed_and_as_they_were_live(self):
        source = "sim:multitouch?rate=100&seed=4"
        recording, live = self.work / "r.mcap", self.work / "live.csv"
        result = dermis("record", "--from", source, "--model", self.model, "--frames", 60, "--out", recording)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.succeed("run", "--model", self.model, "--in", recording, "--out", live)
        for speed in (0, 1, 7.5):
            with self.subTest(speed):
                out = self.work / "replayed.csv"
                self.succeed("replay", recording, "--model", self.model, "--speed", speed, "--out", out)
                self.assertEqual(out.read_bytes(), live.read_bytes())
                again = self.work / f"again_{speed}.mcap"
                self.succeed("replay", recording, "--speed", 0, "--out", again)
                self.succeed("run", "--model", self.model, "--in", again, "--out", out)
                self.assertEqual(out.read_bytes(), live.read_bytes())

    def test_forces_of_a_live_device_are_those_of_its_recording(self):
        """One device, read by run and by record at once, through two sockets."""
        frames = self.contacts / "frames.csv"
        live, replayed = self.work / "live.csv", self.work / "replayed.csv"
        for out, command in ((live, ["run", "--model", self.model]), (self.work / "r.mcap", ["record"])):
            device = self.start(
                "emulate", "--protocol", "dermis", "--in", frames, "--rate", 500, "--to", "tcp-listen://127.0.0.1:0"
            )
            place = device.stdout.readline().strip()
            option = "--in" if command[0] == "run" else "--from"
            result = dermis(*command, option, f"tcp://{place}?protocol=dermis&reconnect_s=0", "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(finish(device)[0], 0)
        self.succeed("replay", self.work / "r.mcap", "--model", self.model, "--speed", 0, "--out", replayed)
        self.assertEqual(table(live), table(replayed))

    def test_lines_on_stdout_come_as_the_time_goes_by(self):
        frames = FramesOfAnyShape.write(self.work / "in.csv", 2, 2, 3, period=1000.0)
        process = self.start("replay", frames)
        self.assertIn("r1c1", process.stdout.readline())
        self.assertTrue(process.stdout.readline().startswith("0"))
        process.send_signal(signal.SIGINT)
        self.assertEqual(finish(process)[0], 0)

    def test_nothing_to_replay(self):
        empty = self.written("e.csv", "time_s,r0c0\n")
        self.refuse(["replay", empty], ["no frame"])
        self.refuse(["replay", self.contacts / "frames.csv", "--speed", -1], ["--speed"])


if __name__ == "__main__":
    support.main()
