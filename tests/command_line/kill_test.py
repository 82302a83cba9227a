# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""kill -9 at random moments while 10,240 taxels are recorded at 1 kHz: every frame that was taken 100 ms before is read
back, from the file as it is left and after dermis recover, and npm's reader reads the recovered file by its index.
Usage: kill_test.py BINARY MCAP_SAMPLE [KILLS] [SEED]"""
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

RATE_HZ = 1000
PROMISE_S = 0.100
SOURCE = f"sim:multitouch?rows=64&cols=160&rate={RATE_HZ}"
NPM_READER = Path(__file__).parent.parent / "recordings" / "npm_count.mjs"

BINARY = None
MCAP_SAMPLE = None
KILLS = 3
SEED = None


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

    def kill_after(self, seconds):
        """Records until `seconds` after the first frame is in the file; returns the file and the moment of the kill."""
        out = self.work / "rec.mcap"
        with open(self.work / "stderr", "w") as messages:
            process = subprocess.Popen([BINARY, "record", "--from", SOURCE, "--out", out], stdout=subprocess.DEVNULL,
                                       stderr=messages)
        try:
            deadline = time.monotonic() + 120
            while not out.exists() and process.poll() is None and time.monotonic() < deadline:
                time.sleep(0.01)
            self.assertTrue(out.exists(), (self.work / "stderr").read_text())
            time.sleep(seconds)
            killed_ns = time.time_ns()
            process.send_signal(signal.SIGKILL)
        finally:
            process.kill()
            process.wait()
        return out, killed_ns

    def check(self, frames, killed_ns):
        """No frame is missing between the first and the last, and the last is younger than the promise."""
        self.assertTrue(frames)
        for before, after in zip(frames, frames[1:]):
            self.assertEqual(after[0], before[0] + 1 + after[2], "a frame is missing that nobody said was lost")
        period_ns = 1e9 / RATE_HZ
        # A frame arrives when it was due or later: the schedule begins where the earliest frame puts it.
        start_ns = min(arrival - sequence * period_ns for sequence, arrival, _ in frames)
        last_due_ns = start_ns + frames[-1][0] * period_ns
        self.assertLess((killed_ns - last_due_ns) / 1e9, PROMISE_S + 1 / RATE_HZ)
        return (killed_ns - last_due_ns) / 1e9

    def test_kills(self):
        chance = random.Random(SEED)
        ages = []
        for kill in range(KILLS):
            seconds = chance.uniform(0.0, 1.5)
            with self.subTest(kill=kill, seconds=seconds, seed=SEED):
                out, killed_ns = self.kill_after(seconds)
                frames = read_frames(out)
                ages.append(self.check(frames, killed_ns))
                recovered = self.work / "recovered.mcap"
                result = subprocess.run([BINARY, "recover", out, "--out", recovered], capture_output=True, text=True)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(read_frames(recovered), frames)
                npm = subprocess.run(["node", NPM_READER, recovered], capture_output=True, text=True)
                self.assertEqual(npm.returncode, 0, npm.stderr)
                self.assertEqual(int(re.search(r"sensor_msgs/msg/Image (\d+)", npm.stdout).group(1)), len(frames))
                out.unlink()
                recovered.unlink()
        print(f"{len(ages)} of {KILLS} kills; age of the last frame at the kill: "
              f"{', '.join(f'{1000 * age:.0f}' for age in sorted(ages))} ms")


if __name__ == "__main__":
    BINARY, MCAP_SAMPLE = sys.argv[1:3]
    KILLS = int(sys.argv[3]) if len(sys.argv) > 3 else KILLS
    SEED = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**6)
    unittest.main(argv=sys.argv[:1])
