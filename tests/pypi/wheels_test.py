# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Each wheel of make wheels runs in bare virtual environments, one for each numpy. The long gate runs this.

Usage: wheels_test.py DERMIS FOLDER, which has the wheels"""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "command_line"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "bindings/python"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import bare
import support
import wheels

TESTS = Path(__file__).resolve().parents[1]
FOLDER = Path(sys.argv.pop(2)).resolve()
NUMPYS = {"3.11": ("1.26.*", "2.*"), "3.12": ("1.26.*", "2.*"), "3.13": ("2.*",)}  # 1.26 has no wheel for 3.13
# Threads, and how frames show themselves.
OTHER_TESTS = ("threads", "everyday")


class Wheels(bare.BareTest):
    def check(self, python, wheel, numpy):
        inside = bare.environment(python, numpy, FOLDER / f"bare/{wheel.name.split('-')[2]}-{numpy.removesuffix('.*')}")
        bare.install(inside, wheel)
        self.assert_gives_the_bits_of_the_command(inside)
        for test in OTHER_TESTS:
            bare.run(inside, TESTS / f"python/{test}_test.py", Path(support.BINARY).resolve())

    def test_each_runs_with_each_numpy(self):
        pythons = list(wheels.found_pythons())
        self.assertNotEqual(pythons, [])
        for python in pythons:
            version = python.name.removeprefix("python")
            if version not in NUMPYS:
                print(f"skipped: Python {version}; NUMPYS says of none which numpy it takes")
                continue
            (wheel,) = FOLDER.glob(f"dermis-*-cp{version.replace('.', '')}-*.whl")
            for numpy in NUMPYS[version]:
                with self.subTest(python=version, numpy=numpy):
                    self.check(python, wheel, numpy)


if __name__ == "__main__":
    support.main()
