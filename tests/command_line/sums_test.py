# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Sums of forces in a world that shares nothing with the simulator (scripts/independent_world.py)."""

import importlib.util
import sys
import unittest
from pathlib import Path

import support

try:
    import numpy
except ImportError:
    numpy = None


@unittest.skipIf(numpy is None, "numpy is not installed: scripts/setup python")
class Sums(unittest.TestCase):
    def test_sums_are_unbiased_and_as_sure_as_they_say(self):
        path = Path(__file__).parents[2] / "scripts/independent_world.py"
        spec = importlib.util.spec_from_file_location("independent_world", path)
        world = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(world)
        seed = 4
        figures = world.judge(support.BINARY, 8, seed)
        said = f"seed {seed}: {figures}"
        self.assertLess(abs(figures.untouched_newtons), 0.02, said)
        self.assertGreater(figures.untouched_within_2, 0.92, said)
        self.assertLess(abs(figures.bias), 0.002, said)
        self.assertTrue(0.58 < figures.within_1 < 0.82, said)
        self.assertGreater(figures.within_2, 0.9, said)


if __name__ == "__main__":
    support.main()
