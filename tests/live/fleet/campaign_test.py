# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A fleet of two robots, of which some are killed, and how it is judged: campaign_test.py BUILD"""

import subprocess
import sys
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

CAMPAIGN = Path(__file__).resolve().parents[3] / "scripts/fleet_campaign"
SMALL = ["--robots", "2", "--arrays", "2", "--seconds", "8", "--kill", "1", "--cut", "2"]
BUILD = sys.argv.pop(1)

sys.dont_write_bytecode = True
sys.path.insert(0, str(CAMPAIGN.parent))
campaign = SourceFileLoader("fleet_campaign", str(CAMPAIGN)).load_module()


class Robot:
    """Runs of a publisher: the frames that it has recorded, and the last one that its server had at the kill."""

    name = "robot0"

    def __init__(self, *runs):
        self.runs = [{"own": own, "held": {} if held is None else {"array0": held}} for own, held in runs]

    def recorded(self, run, _array):
        return run["own"]


def frames(first, end):
    return [f"{k}.5,{k}" for k in range(first, end)]


def faults(robot, stored):
    comparison = campaign.Comparison()
    comparison.compare(robot, "array0", stored)
    return comparison.faults


class Judged(unittest.TestCase):
    def setUp(self):
        killed = (frames(0, 10), frames(7, 8))
        self.robot = Robot(killed, (frames(100, 110), None))

    def test_a_run_that_was_killed_may_end_after_what_the_server_had(self):
        self.assertEqual(faults(self.robot, frames(0, 8) + frames(100, 110)), [])
        self.assertEqual(faults(self.robot, frames(0, 12) + frames(100, 110)), [])  # its last ones were not recorded

    def test_a_frame_that_the_server_had_must_be_there(self):
        self.assertIn("had is not on the hub", faults(self.robot, frames(0, 7) + frames(100, 110))[0])

    def test_a_frame_is_missing_or_another(self):
        self.assertIn("frame 3 of a run", faults(self.robot, frames(0, 3) + frames(4, 10) + frames(100, 110))[0])
        self.assertIn(
            "frame 2 of a run", faults(self.robot, [*frames(0, 2), "2.5,7", *frames(3, 8), *frames(100, 110)])[0]
        )
        self.assertIn("9 frames of 10", faults(self.robot, frames(0, 8) + frames(100, 109))[0])

    def test_a_frame_is_there_twice(self):
        self.assertIn("doubled", faults(self.robot, frames(0, 8) + frames(7, 8) + frames(100, 110))[0])


class Small(unittest.TestCase):
    def test_every_frame_is_on_the_hub_once(self):
        done = subprocess.run([CAMPAIGN, "--build", BUILD, *SMALL], check=False, capture_output=True, text=True)
        print(done.stdout)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
