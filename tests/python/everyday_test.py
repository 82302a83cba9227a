# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What people do with arrays of numpy, notebooks, asyncio and processes."""

import asyncio
import concurrent.futures
import copy
import multiprocessing
import pickle
import struct
import threading
import time
from xml.etree import ElementTree

import numpy as np
import workspace

import dermis

SVG = "{http://www.w3.org/2000/svg}"


def figure_of(shown):
    return ElementTree.fromstring(shown._repr_html_().replace("<br>", "<br/>"))


def newtons_of(pipeline, counts):
    return pipeline.run(counts, rate_hz=10.0, supply_v=5.0).newtons


def size_of_png(data):
    """(width, height)"""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


class Everyday(workspace.CalibratedArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.loaded = dermis.read_model(cls.model)
        cls.recording = dermis.Recording.read(cls.frames)
        cls.forces = dermis.Pipeline(cls.loaded).run(cls.recording)

    def test_counts_of_numpy_are_run_as_they_are(self):
        beside = {
            "time_ns": self.recording.time_ns,
            "temperature_celsius": self.recording.temperature_celsius,
            "supply_v": self.recording.supply_v,
        }
        forces = dermis.Pipeline(self.loaded).run(self.recording.counts, **beside)
        np.testing.assert_array_equal(forces.newtons, self.forces.newtons)
        again = dermis.Pipeline(self.loaded).run(self.recording.counts.tolist(), rate_hz=20.0)
        np.testing.assert_array_equal(again.time_ns, np.arange(60) * 50_000_000)

    def test_what_counts_lack_or_have_too_much_is_said(self):
        pipeline = dermis.Pipeline(self.loaded)
        with self.assertRaisesRegex(ValueError, "give the times of the frames as time_ns, or their rate_hz"):
            pipeline.run(self.recording.counts)
        with self.assertRaisesRegex(ValueError, r"counts: has the shape \(4, 5\), expected is \(frames, 5, 4\)"):
            pipeline.run(np.zeros((4, 5)), rate_hz=10.0)
        with self.assertRaisesRegex(ValueError, r"has the shape \(20,\), expected is \(frames, rows, cols\)"):
            dermis.Recording(np.zeros(20), rate_hz=10.0)
        with self.assertRaisesRegex(ValueError, r"has the shape \(2, 4, 5\), expected is \(frames, 5, 4\)"):
            dermis.Recording(np.zeros((2, 4, 5)), rate_hz=10.0, array=self.array)
        with self.assertRaisesRegex(ValueError, "a recording has times, temperatures and supplies of its own"):
            pipeline.run(self.recording, rate_hz=10.0)
        with self.assertRaisesRegex(ValueError, "the frames have 1x2 taxels, the array of the model has 5x4"):
            pipeline.run(dermis.Recording(np.zeros((1, 1, 2)), rate_hz=10.0))

    def test_masked_readings_are_no_readings(self):
        counts = self.recording.counts[:3]
        mask = np.zeros(counts.shape, bool)
        mask[:, 2, 1] = True
        forces = dermis.Pipeline(self.loaded).run(
            np.ma.array(counts.astype(np.uint16), mask=mask), rate_hz=10.0, supply_v=5.0
        )
        expected = dermis.Pipeline(self.loaded).run(
            np.where(mask, np.nan, counts.astype(np.uint16)), rate_hz=10.0, supply_v=5.0
        )
        np.testing.assert_array_equal(forces.newtons, expected.newtons)
        self.assertTrue((forces.taxels[:, 2, 1] == dermis.TaxelStatus.INVALID).all())
        with self.assertRaisesRegex(TypeError, "time_ns: may not be masked"):
            dermis.Recording(counts, time_ns=np.ma.array([1, 2, 3]))

    def test_slices_are_recordings_and_forces(self):
        part = self.recording[10:40:3]
        self.assertIsInstance(part, dermis.Recording)
        self.assertEqual((len(part), part.name), (10, self.recording.name))
        for member in ("time_ns", "counts", "temperature_celsius", "supply_v"):
            np.testing.assert_array_equal(getattr(part, member), getattr(self.recording, member)[10:40:3])
        last = self.forces[-5:]
        self.assertIsInstance(last, dermis.Forces)
        for member in ("time_ns", "status", "newtons", "sigma_newtons", "taxels", "total", "total_sigma"):
            np.testing.assert_array_equal(getattr(last, member), getattr(self.forces, member)[-5:])
        self.assertEqual((len(self.recording[60:]), len(self.forces[3:3])), (0, 0))
        with self.assertRaisesRegex(TypeError, r"^one frame of Forces is forces.newtons\[3\], "):
            self.forces[3]
        part.write(self.folder / "part.csv")
        self.assertEqual(len(dermis.Recording.read(self.folder / "part.csv")), 10)

    def test_sensors_of_temperature_stay_with_their_frames(self):
        counts = np.arange(48.0).reshape(3, 4, 4)
        sensors = np.array([[20.0, 21.0], [20.5, np.nan], [22.0, 23.0]], np.float32)
        recording = dermis.Recording(counts, rate_hz=10.0, sensor_celsius=sensors)
        np.testing.assert_array_equal(recording.sensor_celsius, sensors)
        np.testing.assert_array_equal(recording[1:].sensor_celsius, sensors[1:])
        np.testing.assert_array_equal(recording[1].sensor_celsius, sensors[1])
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(recording)).sensor_celsius, sensors)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(recording[2])).sensor_celsius, sensors[2])
        for suffix in ("mcap", "csv", "h5"):
            path = self.folder / f"sensors.{suffix}"
            recording.write(path)
            np.testing.assert_array_equal(dermis.Recording.read(path).sensor_celsius, sensors)
        self.assertEqual(self.recording.sensor_celsius.shape, (len(self.recording), 0))
        with self.assertRaisesRegex(ValueError, "sensor_celsius"):
            dermis.Recording(counts, rate_hz=10.0, sensor_celsius=sensors[:2])
        with self.assertRaisesRegex(
            ValueError, "^sensor_celsius: has 1025 sensors; give at most 1024, or one a taxel$"
        ):
            dermis.Recording(counts, rate_hz=10.0, sensor_celsius=np.zeros((3, 1025)))

    def test_sensors_that_the_first_frame_lacks_are_read(self):
        layout = self.folder / "late.toml"
        layout.write_text('[layout]\nrows = 2\ncols = 2\nline = ["T {temperature} {temperature}", "{values}"]\n')
        text = self.folder / "late.txt"
        text.write_text("1 2 3 4\nT 20 21\n5 6 7 8\n")
        for suffix in ("mcap", "h5"):
            path = self.folder / f"late.{suffix}"
            workspace.dermis("convert", text, path, "--layout", layout, "--rate", 10)
            late = dermis.Recording.read(path)
            np.testing.assert_array_equal(late.sensor_celsius, [[np.nan, np.nan], [20.0, 21.0]])
            self.assertEqual(len(late.counts), 2)

    def test_a_pipeline_takes_a_temperature_or_those_of_sensors(self):
        counts = self.recording.counts[0]
        one = dermis.Pipeline(self.model).process(counts, 25.0)
        np.testing.assert_array_equal(
            dermis.Pipeline(self.model).process(counts, np.float32(25.0)).newtons, one.newtons
        )
        unknown = dermis.Pipeline(self.model).process(counts, [25.0, 25.0])
        self.assertTrue(unknown.status & dermis.FrameStatus.TEMPERATURE_UNKNOWN, "the array has one sensor")
        with self.assertRaises(TypeError):
            dermis.Pipeline(self.model).process(counts, object())

    def test_times_never_go_back(self):
        pipeline = dermis.Pipeline(self.loaded)
        for backwards in (lambda: self.recording[::-1], lambda: self.forces[::-1]):
            with self.assertRaisesRegex(ValueError, "^the step of a slice must be positive: times must not go back$"):
                backwards()
        for take in (dermis.Recording, pipeline.run):
            with self.assertRaisesRegex(ValueError, r"^time_ns: goes back at \[2\]; "):
                take(self.recording.counts[:3], time_ns=[5, 7, 6])
        self.assertEqual(len(dermis.Recording(self.recording.counts[:3], time_ns=[5, 5, 6])), 3)

    def test_a_pipeline_takes_the_path_of_a_model(self):
        for path in (self.model, str(self.model)):
            np.testing.assert_array_equal(dermis.Pipeline(path).run(self.recording).newtons, self.forces.newtons)
        with self.assertRaisesRegex(dermis.BadInput, "none.safetensors"):
            dermis.Pipeline("none.safetensors")

    def test_wrong_types_are_told_in_one_line(self):
        some = np.array([1, 2])
        for call, line in (
            (lambda: dermis.Pipeline(3), "model: is a Model or the path of its file"),
            (lambda: dermis.Pipeline(self.loaded).run(self.recording, 100), "name what comes beside, as rate_hz=100"),
            (lambda: self.forces[some], r"as in forces\.newtons\[index\]"),
            (lambda: self.recording[some], r"as in recording\.counts\[index\]"),
        ):
            with self.assertRaisesRegex(TypeError, f"^[^\\n]*{line}$"):
                call()
        self.assertEqual(self.recording[np.int64(3)].time_ns, self.recording.time_ns[3])

    def test_models_and_pipelines_are_copied(self):
        model = copy.copy(self.loaded)
        self.assertEqual(model.provenance, self.loaded.provenance)
        for copied in (copy.copy, copy.deepcopy, lambda pipeline: pickle.loads(pickle.dumps(pipeline))):
            pipeline = copied(dermis.Pipeline(self.loaded))
            np.testing.assert_array_equal(pipeline.run(self.recording).newtons, self.forces.newtons)

    def test_pipelines_go_to_other_processes(self):
        spawn = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(2, mp_context=spawn) as processes:
            parts = list(
                processes.map(newtons_of, 2 * [dermis.Pipeline(self.loaded)], np.array_split(self.recording.counts, 2))
            )
        expected = [newtons_of(dermis.Pipeline(self.loaded), part) for part in np.array_split(self.recording.counts, 2)]
        np.testing.assert_array_equal(np.concatenate(parts), np.concatenate(expected))

    def test_the_latest_frame_passes_older_ones_over(self):
        with dermis.open("sim:contacts?rate=500", self.array) as source:
            first = source.latest()
            time.sleep(0.2)
            second = source.latest()
            third = source.latest()
        self.assertGreater(second.sequence - first.sequence, 1)
        self.assertGreater(third.sequence, second.sequence)
        with (
            dermis.open("tcp-listen://127.0.0.1:0") as silent,
            self.assertRaisesRegex(TimeoutError, "tcp-listen://.*no frame"),
        ):
            silent.latest(0.1)
        with dermis.open(self.frames) as source:
            self.assertEqual([source.latest().time_ns for _ in range(3)], self.recording.time_ns[:3].tolist())
            while source.latest() is not None:
                pass

    def test_frames_come_to_asyncio_beside_other_tasks(self):
        async def read():
            turns = 0

            async def turn():
                nonlocal turns
                while True:
                    await asyncio.sleep(0.005)
                    turns += 1

            other = asyncio.create_task(turn())
            sequence = []
            with dermis.open("sim:contacts?rate=100", self.array) as source:
                async for raw in source:
                    sequence.append(raw.sequence)
                    if len(sequence) == 30:
                        break
            other.cancel()
            return sequence, turns

        sequence, turns = asyncio.run(read())
        self.assertEqual(sequence, list(range(sequence[0], sequence[0] + 30)))
        self.assertGreater(turns, 10)

    def test_a_recording_ends_an_asynchronous_loop(self):
        async def read():
            with dermis.open(self.frames) as source:
                return [raw.time_ns async for raw in source]

        self.assertEqual(asyncio.run(read()), self.recording.time_ns.tolist())

    def test_a_wait_that_asyncio_gives_up_is_over_at_once(self):
        async def give_up():
            with dermis.open("tcp-listen://127.0.0.1:0") as source, self.assertRaises(asyncio.TimeoutError):
                await asyncio.wait_for(source.__anext__(), 0.1)

        asyncio.run(give_up())
        self.assertFalse([thread for thread in threading.enumerate() if "asyncio" in thread.name])

    def test_every_object_shows_what_it_is(self):
        pipeline = dermis.Pipeline(self.loaded)
        force = pipeline.process(self.recording[5])
        with dermis.open(self.frames) as source:
            for shown, words in (
                (self.loaded, "Model of 'pad' 5x4"),
                (pipeline, "Pipeline of 'pad' 5x4"),
                (self.recording, r"Recording, 60 frames of 5x4, \d+\.\d{3} s"),
                (self.recording[0:0], "Recording, 0 frames of 5x4, 0 s"),
                (self.recording[5], r"RawFrame 5x4, \d+ to \d+ counts, at \d+\.\d{3} s"),
                (force, r"ForceFrame 5x4, [\d.]+ \u00b1 [\d.e-]+ N, OK"),
                (self.forces, r"Forces, 60 frames of 5x4, \d+\.\d{3} s, total at most [\d.]+ N"),
                (source, r"Source '.*frames.csv' 5x4"),
                (dermis.Load(3, (1, 2), newtons=5), "Load 5 N on r1c2 in frame 3"),
                (dermis.Load(3, (1, 2, 3, 3), pascals=2000), "Load 2000 Pa on r1c2:r3c3 in frame 3"),
            ):
                self.assertRegex(repr(shown), f"^<dermis.{words}>$")
        some = np.concatenate([self.recording.counts[:3], np.full((2, 5, 4), np.nan)])
        self.assertRegex(
            repr(dermis.Pipeline(self.loaded).run(some, rate_hz=10.0, supply_v=5.0)), "total at most .* N, 2 rejected>$"
        )
        rejected = pipeline.process(np.full((5, 4), np.nan))
        self.assertRegex(repr(rejected), "^<dermis.ForceFrame 5x4, nan .* N, .*REJECTED.*>$")

    def test_frames_are_pictures_in_notebooks(self):
        force = dermis.Pipeline(self.loaded).process(self.recording[5])
        sizes = {size_of_png(shown._repr_png_()) for shown in (self.recording[5], force, self.forces)}
        self.assertEqual(len(sizes), 1)
        self.assertGreater(min(*sizes.pop()), 100)
        self.assertNotEqual(force._repr_png_(), dermis.Pipeline(self.loaded).process(self.recording[6])._repr_png_())
        self.assertIsNone(self.forces[0:0]._repr_png_())

    def test_notebooks_show_maps_of_what_can_be_shown(self):
        pipeline = dermis.Pipeline(self.loaded)
        force = pipeline.process(self.recording[5])
        for shown in (self.recording, self.recording[5], force, pipeline):
            figure = figure_of(shown)
            self.assertEqual(figure.findtext("code").split(",")[0], repr(shown).split(",")[0])
            self.assertEqual(len(figure.findall(f".//{SVG}rect")), 20)
        titles = [title.text for title in figure_of(force).iter(f"{SVG}title")]
        self.assertEqual(titles[7], f"r1c3: {force.newtons[1, 3]:.4g} N")
        self.assertNotIn("<svg", self.recording[0:0]._repr_html_())
        self.assertNotIn("<svg", dermis.Recording(np.zeros((2, 65, 64)), rate_hz=1.0)._repr_html_())


if __name__ == "__main__":
    workspace.main()
