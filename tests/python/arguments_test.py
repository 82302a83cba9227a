# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Whatever Python hands over, the answer is a result or an exception that says what was expected."""

import concurrent.futures
import random
import subprocess
import sys

import numpy as np
import workspace

import dermis

CALLS = 3000
FIRST_ARRAYS = """
import sys, threading
import dermis

def make():
    together.wait()
    dermis.Recording([[[1.0]]], rate_hz=1.0)

sys.setswitchinterval(1e-6)
together = threading.Barrier(4)
threads = [threading.Thread(target=make) for _ in range(4)]
for thread in threads: thread.start()
for thread in threads: thread.join()
"""
EXPECTED = (TypeError, ValueError, IndexError, OverflowError, RuntimeError, dermis.Error)


class Arguments(workspace.CalibratedArray):
    def anything(self, choose):
        shape = choose.choice([(5, 4), (4, 5), (20,), (0, 4), (5, 4, 1), (), (3, 5, 4), (0, 5, 4), (1, 1)])
        values = np.random.default_rng(choose.getrandbits(32)).uniform(-1e3, 5e3, shape)
        dtype = choose.choice(["f4", "f8", ">f4", "u1", "i8", "f2", "c8", "O", "S3", "M8[ns]", "?", "u2"])
        with np.errstate(all="ignore"):
            array = values.astype("i8").astype(dtype) if dtype == "M8[ns]" else values.astype(dtype)
        return choose.choice(
            [
                array,
                array.T,
                np.flip(array),
                np.full((5, 4), choose.choice([np.nan, np.inf, -np.inf, 1e300])),
                None,
                True,
                -1,
                2**70,
                1.5,
                float("nan"),
                "",
                "\0",
                "nothing",
                b"bytes",
                [],
                [[1, 2], [3]],
                {},
                object(),
                self.model,
                self.array,
                str(self.frames),
                self.made["model"],
                self.made["recording"],
                self.made["closed"],
                self.made["force"],
                (0, 0),
                (9, 9),
                (0, 0, 4, 3),
                (4, 3, 0, 0),
                lambda *_: 1,
                slice(1, 5),
                slice(None, None, -1),
                slice(0, 1, 0),
                slice(2**70),
                np.ma.masked_all((5, 4)),
            ]
        )

    def make(self):
        """Objects of every kind, and what can be called of them."""
        recording = dermis.Recording.read(self.frames)
        closed = dermis.open(self.frames)
        closed.close()
        model = dermis.read_model(self.model)
        pipeline, tracker = dermis.Pipeline(model), dermis.ContactTracker(model)
        self.made = {"model": model, "recording": recording, "closed": closed, "force": pipeline.process(recording[0])}
        source = dermis.open(self.frames)
        self.addCleanup(source.close)
        return [
            dermis.read_model,
            dermis.read_array,
            dermis.Pipeline,
            pipeline.process,
            pipeline.run,
            tracker.process,
            dermis.ContactTracker,
            dermis.Recording,
            recording.__getitem__,
            dermis.Load,
            dermis.circuit.forward,
            dermis.circuit.invert,
            dermis.ArrayDescription.from_toml,
            model.array.taxel_name,
            dermis.open,
            next,
            dermis.Recording.read,
            dermis.evaluate,
            lambda array, loads: dermis.calibrate(array, recording, loads),
            lambda counts, **more: dermis.Recording(counts, rate_hz=10.0, **more),
            pipeline.tare,
            lambda: next(source),
            source.latest,
            pipeline.run(recording).__getitem__,
            dermis.ThreatMonitor,
            dermis.Recogniser,
            dermis.Suit,
        ]

    def call_at_random(self, calls, choose, count):
        """How many calls were refused, and the errors that are none of ours."""
        names = [
            "temperature",
            "supply",
            "time_ns",
            "rate_hz",
            "supply_v",
            "temperature_celsius",
            "array",
            "newtons",
            "pascals",
            "onset_sigma",
            "most_contacts",
        ]
        refused, wrong = 0, []
        for _ in range(count):
            call = choose.choice(calls)
            arguments = [self.anything(choose) for _ in range(choose.randint(0, 3))]
            named = {choose.choice(names): self.anything(choose)} if choose.random() < 0.3 else {}
            try:
                call(*arguments, **named)
            except EXPECTED as error:
                refused += 1
                if not str(error):
                    wrong.append(f"{call}: {error!r} says nothing")
            except StopIteration:
                pass
            except Exception as error:
                wrong.append(f"{call}{arguments}{named}: {error!r}")
        return refused, wrong

    def test_random_arguments_never_end_the_process(self):
        seed = random.randrange(2**32)
        refused, wrong = self.call_at_random(self.make(), random.Random(seed), CALLS)
        self.assertEqual(wrong, [], f"seed {seed}")
        self.assertGreater(refused, CALLS // 2)

    def test_nor_do_they_from_several_threads_at_once(self):
        seed = random.randrange(2**32)
        calls = self.make()
        with concurrent.futures.ThreadPoolExecutor(4) as threads:
            parts = [threads.submit(self.call_at_random, calls, random.Random(seed + k), CALLS // 4) for k in range(4)]
        for refused, wrong in (part.result() for part in parts):
            self.assertEqual(wrong, [], f"seed {seed}")
            self.assertGreater(refused, CALLS // 8)

    def test_the_first_arrays_may_come_from_several_threads(self):
        subprocess.run([sys.executable, "-c", FIRST_ARRAYS], check=True, timeout=100)


if __name__ == "__main__":
    workspace.main()
