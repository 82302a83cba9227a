# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Frames of devices, recordings and the simulator, and a server in the background."""

import os
import signal
import subprocess
import sys
import threading
import time
import urllib.request

import numpy as np
import workspace

import dermis


class Sources(workspace.CalibratedArray):
    def test_a_scene_of_the_simulator_is_read_to_its_end(self):
        with dermis.open("sim:multitouch?seed=3&frames=20", self.array) as source:
            counts = [raw.counts for raw in source]
        self.assertEqual((len(counts), counts[0].shape, source.shape), (20, (5, 4), (5, 4)))

    def test_a_live_source_loses_nothing_while_the_program_is_busy(self):
        with dermis.open("sim:contacts?rate=1000", self.array) as source:
            next(source)
            time.sleep(0.5)
            frames = [next(source) for _ in range(800)]
        self.assertTrue(source.is_live)
        self.assertEqual(source.dropped, 0)
        sequence = np.array([raw.sequence for raw in frames], dtype=np.int64)
        self.assertTrue((np.diff(sequence) == 1).all())

    def test_ctrl_c_ends_a_wait_for_a_device(self):
        with dermis.open("tcp-listen://127.0.0.1:0") as source:
            threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                next(source)

    def test_a_closed_source_says_so(self):
        source = dermis.open(self.frames)
        source.close()
        source.close()
        with self.assertRaisesRegex(ValueError, "the source is closed"):
            next(source)

    def test_what_is_not_there_is_one_line(self):
        for name in ("nothing.csv", "serial:///dev/nothing", "sim:nothing", "tcp://127.0.0.1"):
            with self.subTest(name=name), self.assertRaises(dermis.Error) as caught:
                dermis.open(name)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(dermis.BadInput, "5x4"):
            dermis.open("sim:idle?rows=3&cols=3", self.array)

    def test_a_server_answers_until_it_is_stopped(self):
        with dermis.serve(f"sim:contacts?rate=50&array={self.array}", self.model, port=0) as server:
            self.assertEqual(urllib.request.urlopen(server.url).status, 200)
            url = server.url
        with self.assertRaises(OSError):
            urllib.request.urlopen(url)
        with self.assertRaises(dermis.Error):
            dermis.serve("nothing.csv", self.model, port=0)

    def test_serve_needs_no_model_of_the_simulator(self):
        with dermis.serve("sim:contacts?rate=50&rows=3&cols=4", port=0) as server:
            self.assertEqual(urllib.request.urlopen(server.url).status, 200)
        with self.assertRaisesRegex(dermis.BadInput, "name its model, too, or its array.toml"):
            dermis.serve("tcp://127.0.0.1:7000", port=0)

    def test_the_package_is_the_command_that_was_installed_with_it(self):
        version = [sys.executable, "-m", "dermis", "--version"]
        said = subprocess.run(version, check=True, capture_output=True, text=True).stdout
        self.assertEqual(said, f"{dermis.__version__}\n")


class Recordings(workspace.CalibratedArray):
    def test_every_format_gives_back_what_was_written(self):
        recording = dermis.Recording.read(self.frames)
        described = dermis.Recording(
            recording.counts,
            time_ns=recording.time_ns,
            supply_v=recording.supply_v,
            temperature_celsius=recording.temperature_celsius,
            array=self.array,
        )
        for name in ("a.mcap", "a.h5", "a.csv"):
            described.write(self.folder / name)
            back = dermis.Recording.read(self.folder / name)
            for member in ("counts", "time_ns", "temperature_celsius", "supply_v"):
                np.testing.assert_array_equal(getattr(back, member), getattr(described, member), f"{name} {member}")
        back = dermis.Recording.read(self.folder / "a.mcap")
        self.assertEqual((back.name, back.array.rows, back.array.circuit), ("pad", 5, "divider"))

    def test_a_file_that_exists_is_not_overwritten(self):
        recording, model = dermis.Recording.read(self.frames), dermis.read_model(self.model)
        for written, name in ((recording, "there.mcap"), (model, "there.safetensors")):
            path = self.folder / name
            path.write_bytes(b"an earlier session")
            with self.assertRaisesRegex(dermis.BadInput, "there.* exists; name another, or replace it with force=True"):
                written.write(path)
            self.assertEqual(path.read_bytes(), b"an earlier session")
            written.write(path, force=True)
            self.assertGreater(path.stat().st_size, 1000)

    def test_a_file_that_is_cut_is_read_as_far_as_it_goes_with_a_warning(self):
        cut = self.folder / "cut.csv"
        cut.write_text(self.frames.read_text()[:-20])
        whole = dermis.Recording.read(self.frames)
        with self.assertWarnsRegex(UserWarning, "cut off"):
            self.assertEqual(len(dermis.Recording.read(cut)), len(whole) - 1)
        with dermis.open(cut) as source:
            self.assertEqual(len(list(source)), len(whole) - 1)
            self.assertIn("cut off", source.notices()[0])

    def test_times_are_given_or_follow_from_the_rate(self):
        counts = np.zeros((3, 5, 4))
        np.testing.assert_array_equal(dermis.Recording(counts, rate_hz=200.0).time_ns, [0, 5_000_000, 10_000_000])
        self.assertTrue(np.isnan(dermis.Recording(counts, rate_hz=1.0).supply_v).all())
        for wrong in (
            {},
            {"rate_hz": 1.0, "time_ns": [0, 1, 2]},
            {"rate_hz": 0.0},
            {"time_ns": [0, 1]},
            {"rate_hz": 1.0, "supply_v": [5.0, 5.0]},
            {"rate_hz": 1.0, "array": self.array, "counts": counts[:, 1:]},
        ):
            arguments = {"counts": counts, **wrong}
            with self.subTest(wrong=wrong), self.assertRaises(ValueError):
                dermis.Recording(**arguments)


if __name__ == "__main__":
    workspace.main()
