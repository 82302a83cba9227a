# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""kill -9 at random moments while 10,240 taxels are recorded at 1 kHz: no frame is missing before the last one, in the
file as it is left and after dermis info recover, and npm's reader reads the recovered file by its index.
Usage: kill_test.py BINARY MCAP_SAMPLE [KILLS [SEED]]
KILLS is for a machine that does nothing else: each frame that was taken 100 ms before a kill is to be read back,
too."""

import itertools
import random
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from devices.emulators import DEVICES

RATE_HZ = 1000
PROMISE_S = 0.100
SOURCE = f"sim:multitouch?rows=64&cols=160&rate={RATE_HZ}"
NPM_READER = Path(__file__).parent.parent / "bytes" / "recordings" / "npm_count.mjs"

BINARY = None
MCAP_SAMPLE = None
KILLS = None
SEED = None
FEW_KILLS = 3
PATIENCE = 120


def read_frames(path):
    """(sequence, arrival in ns since 1970, lost before) of each frame; the sample program checks every CRC."""
    result = subprocess.run([MCAP_SAMPLE, "times", path], capture_output=True, text=True, timeout=120)
    if result.returncode != 0:
        raise AssertionError(result.stderr)
    return [tuple(map(int, line.split())) for line in result.stdout.splitlines()]


class Kill(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)
        self.out = self.work / "rec.mcap"

    def record(self, source):
        with open(self.work / "stderr", "w") as messages:
            process = subprocess.Popen(
                [BINARY, "record", "--from", source, "--out", self.out],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=messages,
            )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, process, condition):
        deadline = time.monotonic() + PATIENCE
        while not condition() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertTrue(condition(), (self.work / "stderr").read_text())

    def kill_after(self, seconds):
        """Records until `seconds` after the first frame is in the file; returns the moment of the kill."""
        process = self.record(SOURCE)
        self.wait_for(process, self.out.exists)
        time.sleep(seconds)
        killed_ns = time.time_ns()
        process.kill()
        process.wait()
        return killed_ns

    def age_of_last(self, frames, killed_ns):
        """No frame is missing between the first and the last, whose age at the kill it returns."""
        self.assertTrue(frames)
        for before, after in itertools.pairwise(frames):
            self.assertEqual(after[0], before[0] + 1 + after[2], "a frame is missing that nobody said was lost")
        period_ns = 1e9 / RATE_HZ
        # A frame arrives when it was due or later: the schedule begins where the earliest frame puts it.
        start_ns = min(arrival - sequence * period_ns for sequence, arrival, _ in frames)
        last_due_ns = start_ns + frames[-1][0] * period_ns
        return (killed_ns - last_due_ns) / 1e9

    def test_kills(self):
        chance = random.Random(SEED)
        ages = []
        for kill in range(KILLS or FEW_KILLS):
            seconds = chance.uniform(0.0, 1.5)
            with self.subTest(kill=kill, seconds=seconds, seed=SEED):
                killed_ns = self.kill_after(seconds)
                frames = read_frames(self.out)
                ages.append(self.age_of_last(frames, killed_ns))
                if KILLS:
                    self.assertLess(ages[-1], PROMISE_S + 1 / RATE_HZ)
                recovered = self.work / "recovered.mcap"
                result = subprocess.run(
                    [BINARY, "info", "recover", self.out, "--out", recovered], capture_output=True, text=True
                )
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(read_frames(recovered), frames)
                npm = subprocess.run(["node", NPM_READER, recovered], capture_output=True, text=True)
                self.assertEqual(npm.returncode, 0, npm.stderr)
                self.assertEqual(int(re.search(r"sensor_msgs/msg/Image (\d+)", npm.stdout).group(1)), len(frames))
                self.out.unlink()
                recovered.unlink()
        print(
            f"{len(ages)} kills; age of the last frame at the kill: "
            f"{', '.join(f'{1000 * age:.0f}' for age in sorted(ages))} ms"
        )

    def test_frames_that_none_follows(self):
        """They come into the file without a further frame and without an end of the recording."""
        device = next(device for device in DEVICES if device.name == "dermis 12x32")
        frames, pieces = device.stream(random.Random(SEED), count=40)
        process = self.record("stdin:?protocol=dermis")
        process.stdin.write(b"".join(piece.data for piece in pieces))
        process.stdin.flush()
        self.wait_for(process, lambda: self.out.exists() and len(read_frames(self.out)) == len(frames))
        process.kill()
        process.wait()
        self.assertEqual(len(read_frames(self.out)), len(frames))


if __name__ == "__main__":
    BINARY, MCAP_SAMPLE = sys.argv[1:3]
    KILLS = int(sys.argv[3]) if len(sys.argv) > 3 else None
    SEED = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**6)
    unittest.main(argv=sys.argv[:1])
