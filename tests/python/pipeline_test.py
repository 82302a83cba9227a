# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Forces from Python are those of the command line, whatever holds the counts; what cannot be used is refused."""

import csv
import pickle
import re
import threading

import numpy as np
import workspace

import dermis


def forces_csv(path, rows, cols):
    with open(path) as file:
        lines = list(csv.reader(file))[1:]
    newtons = [[float(cell) if cell else np.nan for cell in line[2:]] for line in lines]
    return np.array(newtons, dtype=np.float32).reshape(-1, rows, cols)


class Pipeline(workspace.CalibratedArray):
    def setUp(self):
        self.loaded = dermis.read_model(self.model)
        self.recording = dermis.Recording.read(self.frames)

    def test_whole_recordings_give_the_forces_of_the_command_line(self):
        workspace.dermis("run", "--model", self.model, "--in", self.frames, "--out", self.folder / "forces.csv")
        expected = forces_csv(self.folder / "forces.csv", 5, 4)
        forces = dermis.Pipeline(self.loaded).run(self.recording)
        np.testing.assert_array_equal(forces.newtons, expected)
        self.assertEqual(len(forces), 60)

    def test_frame_by_frame_gives_the_same_bits(self):
        forces = dermis.Pipeline(self.loaded).run(self.recording)
        one_by_one, by_frame = dermis.Pipeline(self.loaded), dermis.Pipeline(self.loaded)
        for k, raw in enumerate(self.recording):
            force = one_by_one.process(raw.counts, raw.temperature_celsius, raw.supply_v, raw.time_ns)
            for result in (force, by_frame.process(raw)):
                np.testing.assert_array_equal(result.newtons, forces.newtons[k])
                np.testing.assert_array_equal(result.sigma_newtons, forces.sigma_newtons[k])
                np.testing.assert_array_equal(result.taxels, forces.taxels[k])
                self.assertEqual(result.status, forces.status[k])

    def test_totals_are_those_of_the_command_line(self):
        workspace.dermis("run", "--model", self.model, "--in", self.frames, "--totals", self.folder / "totals.csv")
        table = np.genfromtxt(self.folder / "totals.csv", delimiter=",", names=True, dtype=None, encoding="ascii")
        forces = dermis.Pipeline(self.loaded).run(self.recording)
        np.testing.assert_allclose(forces.total, table["total_n"])
        np.testing.assert_allclose(forces.total_sigma, table["sigma_total_n"])

    def test_a_total_is_the_sum_of_its_regions(self):
        pipeline = dermis.Pipeline(self.loaded)
        left = np.zeros((5, 4), bool)
        left[:, :2] = True
        for raw in self.recording:
            force = pipeline.process(raw)
            newtons, sigma = force.total_of(left)
            self.assertAlmostEqual(newtons + force.total_of(~left)[0], force.total, places=6)
            self.assertGreater(sigma, 0.0)
            self.assertGreaterEqual(force.newtons.sum(), force.total - 0.05 * abs(force.total))
        with self.assertRaisesRegex(ValueError, "mask: has the shape"):
            force.total_of(left.T)
        with self.assertRaisesRegex(TypeError, "mask: has the dtype int64, not bool"):
            force.total_of(left.astype(int))

    def test_any_array_of_numbers_will_do(self):
        raw = self.recording[5]
        expected = dermis.Pipeline(self.loaded).process(raw).newtons
        strided = np.zeros((10, 8))
        strided[::2, ::2] = raw.counts
        for counts in (
            raw.counts.astype(np.uint16),
            raw.counts.astype(np.float64),
            raw.counts.tolist(),
            np.asfortranarray(raw.counts),
            strided[::2, ::2],
            raw.counts.astype(">f4"),
        ):
            force = dermis.Pipeline(self.loaded).process(counts, raw.temperature_celsius, raw.supply_v, raw.time_ns)
            np.testing.assert_array_equal(force.newtons, expected)

    def test_a_model_of_before_there_were_checksums_is_read_with_a_warning(self):
        whole = self.model.read_bytes()
        checksum = re.search(rb'"checksum":"fnv1a64:[0-9a-f]{16}",', whole).group()
        old = self.folder / "old.safetensors"
        old.write_bytes(whole.replace(checksum, b" " * len(checksum)).replace(b"dermis model 3", b"dermis model 2"))
        with self.assertWarnsRegex(UserWarning, "has no checksum"):
            newtons = dermis.Pipeline(dermis.read_model(old)).run(self.recording).newtons
        np.testing.assert_array_equal(newtons, dermis.Pipeline(self.loaded).run(self.recording).newtons)
        old.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
        with self.assertRaisesRegex(dermis.BadInput, "its checksum differs"):
            dermis.read_model(old)

    def test_views_outlive_what_they_were_taken_from(self):
        newtons = dermis.Pipeline(dermis.read_model(self.model)).process(self.recording[5]).newtons
        counts = dermis.Recording.read(self.frames).counts
        self.assertEqual((newtons.shape, newtons.dtype), ((5, 4), np.float32))
        np.testing.assert_array_equal(counts, self.recording.counts)

    def test_unusable_counts_are_refused_by_their_name(self):
        pipeline = dermis.Pipeline(self.loaded)
        for counts, error, text in (
            (np.zeros((4, 5)), ValueError, "counts: has the shape (4, 5), expected is (5, 4)"),
            (np.zeros(20), ValueError, "counts: has the shape (20,)"),
            (np.zeros((5, 4), complex), TypeError, "dtype complex128"),
            ("counts", TypeError, "counts: "),
            (None, TypeError, "counts: "),
            ([[1, 2], [3]], TypeError, "counts: "),
        ):
            with self.subTest(counts=counts), self.assertRaisesRegex(error, "^.*" + re.escape(text)):
                pipeline.process(counts)

    def test_a_frame_that_is_no_frame_is_told_by_its_status(self):
        force = dermis.Pipeline(self.loaded).process(np.full((5, 4), np.nan))
        self.assertIn(dermis.FrameStatus.REJECTED, force.status)
        self.assertTrue(np.isnan(force.newtons).all())

    def test_a_supply_that_cannot_be_is_told_with_what_is_expected(self):
        pipeline = dermis.Pipeline(self.loaded)
        counts = self.recording.counts[0]
        for supply, flag in (
            (5.0, 0),
            (2.0, dermis.FrameStatus.SUPPLY_IMPLAUSIBLE),
            (5.7, dermis.FrameStatus.SUPPLY_CLAMPED),
        ):
            status = pipeline.process(counts, temperature=25.0, supply=supply).status
            flags = dermis.FrameStatus.SUPPLY_IMPLAUSIBLE | dermis.FrameStatus.SUPPLY_CLAMPED
            self.assertEqual((status & flags, pipeline.why_rejected), (flag, ""), supply)
        self.assertIn(dermis.FrameStatus.REJECTED, pipeline.process(counts, supply=5000.0).status)
        self.assertRegex(pipeline.why_rejected, r"^a supply of 5000 V .*millivolts")

    def test_a_tare_under_a_load_is_refused_with_a_warning_until_it_is_forced(self):
        counts = self.recording.counts[0]
        pipeline = dermis.Pipeline(self.loaded)

        def second(begin_s):
            for k in range(25):
                force = pipeline.process(counts, temperature=25.0, supply=5.0, time_ns=int((begin_s + 0.05 * k) * 1e9))
            return force.newtons.sum()

        pressed_n = second(0)
        self.assertGreater(pressed_n, 0.5)
        pipeline.tare()
        self.assertTrue(pipeline.taring)
        with self.assertWarnsRegex(UserWarning, r"not tared: .* reads? .* N: take it off and tare again"):
            self.assertAlmostEqual(second(2), pressed_n, delta=1e-3)
        pipeline.tare(force=True)
        with self.assertWarnsRegex(UserWarning, r"the tare takes .* N on .* as zero"):
            self.assertLess(second(4), 0.02 * pressed_n)
        pipeline.undo_tare()
        self.assertAlmostEqual(second(6), pressed_n, delta=1e-3)

    def test_two_threads_in_one_pipeline_are_refused_and_others_run_meanwhile(self):
        pipeline = dermis.Pipeline(self.loaded)
        many = dermis.Recording(np.tile(self.recording.counts, (400, 1, 1)), rate_hz=100.0, supply_v=5.0)
        worker = threading.Thread(target=pipeline.run, args=(many,))
        worker.start()
        refused = turns = 0
        while worker.is_alive():
            turns += 1
            try:
                pipeline.process(many[0])
            except RuntimeError as error:
                refused += "in another thread" in str(error)
        worker.join()
        self.assertGreater(refused, 0)
        self.assertGreater(turns, 1)

    def test_a_tracker_refuses_the_forces_of_another_array(self):
        force = dermis.Pipeline(self.loaded).process(self.recording[5])
        other = dermis.ArrayDescription.from_toml(workspace.ARRAY.replace("rows = 5", "rows = 9"))
        with self.assertRaisesRegex(ValueError, "another shape"):
            dermis.ContactTracker(other).process(force)

    def test_results_can_be_pickled(self):
        pipeline = dermis.Pipeline(self.loaded)
        force = pipeline.process(self.recording[5])
        contacts = dermis.ContactTracker(self.loaded).process(force)
        self.assertTrue(contacts)
        copied = pickle.loads(pickle.dumps(contacts))
        self.assertEqual(copied, contacts)
        self.assertEqual((copied[0].force_n, copied[0].position_m), (contacts[0].force_n, contacts[0].position_m))
        for result, members in (
            (force, ("time_ns", "status", "newtons", "sigma_newtons", "signal_to_noise", "taxels", "total")),
            (self.recording[3], ("time_ns", "temperature_celsius", "supply_v", "counts")),
            (self.recording, ("time_ns", "temperature_celsius", "supply_v", "counts", "name")),
            (pipeline.run(self.recording), ("time_ns", "status", "newtons", "taxels", "total", "total_sigma")),
            (self.loaded.array, ("name", "rows", "cols", "circuit", "taxel_area_m2")),
        ):
            back = pickle.loads(pickle.dumps(result))
            for member in members:
                np.testing.assert_array_equal(getattr(back, member), getattr(result, member), member)

    def test_enumerations_are_those_of_the_library(self):
        header = (workspace.Path(__file__).parents[2] / "include/dermis/touch/frames/frames.hpp").read_text()
        for kind in (dermis.FrameStatus, dermis.TaxelStatus):
            body = header.split(f"enum class {kind.__name__} ")[1].split("{", 1)[1].split("};")[0]
            code = [line.split("//")[0].strip() for line in body.splitlines()]
            names = [line.split(",")[0].split("=")[0].strip() for line in code if line]
            self.assertEqual([member.name.lower() for member in kind.__members__.values()], names)


class Circuit(workspace.CalibratedArray):
    def test_inverting_what_the_circuit_gives_returns_conductances_that_read_the_same(self):
        seed = int.from_bytes(np.random.bytes(4), "little")
        siemens = 10.0 ** np.random.default_rng(seed).uniform(-6, -3, (5, 4))
        ratio = dermis.circuit.forward(self.array, siemens)
        inversion = dermis.circuit.invert(self.array, ratio)
        hundredth_of_a_count = 0.01 / 4095
        self.assertTrue(inversion.solved, f"seed {seed}")
        self.assertLessEqual(inversion.residual_ratio, hundredth_of_a_count)
        read_again = dermis.circuit.forward(self.array, inversion.siemens)
        np.testing.assert_allclose(read_again, ratio, atol=1.01 * hundredth_of_a_count, err_msg=f"seed {seed}")

    def test_impossible_conductances_are_refused(self):
        for bad in (-1.0, np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, "siemens: "):
                dermis.circuit.forward(self.array, np.full((5, 4), bad))


if __name__ == "__main__":
    workspace.main()
