# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Many threads work at once: other threads run while the library works, and none of them crashes."""

import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import workspace

import dermis

THREADS = 8


def at_once(work, threads=THREADS):
    """Results of all threads, which begin at the same moment."""
    gate = threading.Barrier(threads)

    def begin(k):
        gate.wait()
        return work(k)

    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(begin, range(threads)))


class Threads(workspace.CalibratedArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.loaded = dermis.read_model(cls.model)
        cls.recording = dermis.Recording.read(cls.frames)
        cls.expected = dermis.Pipeline(cls.loaded).run(cls.recording).newtons

    def setUp(self):
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1e-6)
        self.addCleanup(sys.setswitchinterval, interval)

    def test_pipelines_of_one_model_give_the_same_bits(self):
        def work(k):
            pipeline = dermis.Pipeline(self.loaded)
            if k % 2:
                return pipeline.run(self.recording).newtons
            return np.array([pipeline.process(frame).newtons for frame in self.recording])

        for newtons in at_once(work):
            np.testing.assert_array_equal(newtons, self.expected)

    def test_a_pipeline_that_two_threads_use_says_so_or_works(self):
        pipeline = dermis.Pipeline(self.loaded)

        def work(_):
            done = 0
            for frame in self.recording:
                try:
                    done += pipeline.process(frame).newtons.shape == (5, 4)
                except RuntimeError as error:
                    self.assertIn("thread", str(error))
            return done

        self.assertGreater(sum(at_once(work)), 0)

    def test_files_are_read_and_written_beside_one_another(self):
        def work(k):
            path = self.folder / f"{k}.mcap"
            for _ in range(3):
                self.recording.write(path, force=True)
                again = dermis.Recording.read(path)
            return again.counts

        for counts in at_once(work):
            np.testing.assert_array_equal(counts, self.recording.counts)

    def test_a_source_is_closed_while_another_thread_waits_for_it(self):
        for _ in range(20):
            source = dermis.open("sim:contacts?rate=1000", self.array)

            def take(source=source):
                try:
                    for _ in source:
                        pass
                except (dermis.Error, ValueError):
                    pass

            readers = [threading.Thread(target=take) for _ in range(2)]
            for reader in readers:
                reader.start()
            next(iter([source.shape]))
            source.close()
            for reader in readers:
                reader.join(30)
                self.assertFalse(reader.is_alive())


if __name__ == "__main__":
    workspace.main()
