# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""kill -9 at random moments while commands write: the next start removes what they have left, a recording to a table
keeps its frames in the recording beside it, and two that begin together lose nothing.
Usage: killed_outputs_test.py BINARY MCAP_SAMPLE [TIMES [SEED]]
TIMES is for a machine that does nothing else: each frame that came a second before a kill is to be read back, too."""

import itertools
import random
import signal
import subprocess
import sys
import time

import kill_test
import support
from support import SmallArray, dermis

FEW = 10
TIMES = None
SEED = None
PROMISE_S = 1.0
SOURCE = "sim:multitouch?rows=16&cols=16&rate=1000"
TABLES = ("csv", "h5", "npy", "wiresens.h5")
UNFINISHED = "*.dermis.tmp"


class KilledOutputs(SmallArray):
    def start(self, *arguments):
        process = subprocess.Popen(
            [support.BINARY, *map(str, arguments)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            text=True,
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def commands(self, session, number):
        """What writes files, folders and models, for a second or more."""
        out = self.work / f"out{number}"
        endless = ("--from", SOURCE, "--out")
        return (
            *(("record", *endless, f"{out}.{ending}") for ending in (*TABLES, "mcap")),
            ("convert", session, f"{out}.csv"),
            ("convert", session, f"{out}.h5"),
            ("run", "--model", self.model, "--in", self.contacts / "frames.csv", "--out", f"{out}.csv"),
            ("replay", session, "--out", f"{out}.npy"),
            ("dataset", session, "--model", self.model, "--format", "zarr", "--out", out),
            ("simulate", "--array", self.array, "--scene", "multitouch", "--out", self.work),
            self.calibrate_arguments(f"{out}.safetensors"),
        )

    def test_the_next_start_removes_what_killed_ones_have_left(self):
        chance = random.Random(SEED)
        session = self.root / "session.mcap"
        made = dermis("record", "--from", "sim:contacts?rows=4&cols=5&seed=3&frames=20000", "--out", session)
        self.assertEqual(made.returncode, 0, made.stderr)
        times = TIMES or FEW
        left = 0
        for number in range(times):
            command = chance.choice(self.commands(session, number))
            process = self.start(*command)
            deadline = time.monotonic() + chance.uniform(0.0, 1.0)
            while process.poll() is None and time.monotonic() < deadline:
                time.sleep(0.002)
            process.kill()
            process.communicate()
            left = max(left, len(list(self.work.glob(UNFINISHED))))
        at_the_end = len(list(self.work.glob(UNFINISHED)))
        self.succeed("convert", self.contacts / "frames.csv", self.work / "new.csv")
        print(f"{times} kills, seed {SEED}: up to {left} unfinished, {at_the_end} at the end, then a new start")
        self.assertEqual([path.name for path in self.work.glob(UNFINISHED)], [])

    def test_a_killed_recording_to_a_table_keeps_its_frames(self):
        chance = random.Random(SEED)
        ages = []
        for number, ending in zip(range(TIMES or len(TABLES)), itertools.cycle(TABLES)):
            out = self.work / f"rec{number}.{ending}"
            beside = self.work / f"{out.name}.mcap"
            process = self.start("record", "--from", SOURCE, "--out", out)
            while process.poll() is None and not beside.exists():
                time.sleep(0.01)
            time.sleep(chance.uniform(0.0, 1.5))
            self.assertIsNone(process.poll())
            killed_ns = time.time_ns()
            process.kill()
            process.communicate()
            with self.subTest(ending=ending, seed=SEED):
                frames = kill_test.read_frames(beside)
                self.assertTrue(frames)
                for before, after in itertools.pairwise(frames):
                    self.assertEqual(after[0], before[0] + 1 + after[2], "a frame is missing that nobody said was lost")
                ages.append((killed_ns - frames[-1][1]) / 1e9)
                if TIMES:
                    self.assertLess(ages[-1], PROMISE_S)
                self.assertFalse(out.exists())
                self.assertIn("was not written to its end", dermis("convert", beside, out).stderr)
                self.assertEqual(list(self.work.glob(UNFINISHED)), [])
                rate = ("--rate", 1000) if ending == "npy" else ()
                back = self.work / f"back{number}.mcap"
                self.assertEqual(dermis("convert", out, back, *rate).returncode, 0)
                self.assertEqual(len(kill_test.read_frames(back)), len(frames))
        print(f"{len(ages)} kills of tables, seed {SEED}: the last frame was {1000 * max(ages):.0f} ms old at most")

    def test_what_a_killed_recording_has_kept_is_not_overwritten(self):
        out = self.work / "rec.csv"
        kept = self.written("rec.csv.mcap", "frames")
        result = dermis("record", "--from", SOURCE, "--frames", 3, "--out", out)
        self.assertEqual(
            (result.returncode, result.stderr),
            (2, f"dermis: --out: '{kept}' exists; name another, or replace it with --force\n"),
        )
        self.assertEqual(kept.read_text(), "frames")

    def test_of_two_that_begin_together_one_is_told(self):
        for number, ending in zip(range(TIMES or FEW), itertools.cycle(("mcap", *TABLES))):
            out = self.work / f"rec{number}.{ending}"
            forced = ("--force",) if number % 2 else ()
            both = [self.start("record", "--from", SOURCE, "--seconds", 1, "--out", out, *forced) for _ in range(2)]
            told = [process.communicate()[1] for process in both]
            with self.subTest(ending=ending, forced=forced):
                self.assertEqual(sorted(process.returncode for process in both), [0, 2], told)
                error = told[0 if both[0].returncode == 2 else 1]
                self.assertRegex(error, r"^dermis: .*(is being written by another|exists; name another).*\n$")
                self.assertTrue(out.exists())
                self.assertEqual([path.name for path in self.work.glob(f"rec{number}.*")], [out.name])


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if len(sys.argv) > 4:
        SEED = int(sys.argv.pop(4))
    if len(sys.argv) > 3:
        TIMES = int(sys.argv.pop(3))
    SEED = SEED if SEED is not None else random.randrange(10**6)
    kill_test.MCAP_SAMPLE = sys.argv.pop(2)
    support.main()
