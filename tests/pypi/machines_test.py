# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The wheels on bare machines with an old glibc and Python: what they give there is what the command gives here.

Usage: machines_test.py DERMIS FOLDER [MACHINE...], the folder of the wheels, and those of MACHINES (all without any).
It needs root, the network, and the packages of "scripts/setup bare", "scripts/setup wheels" and "scripts/setup test"."""

import csv
import re
import shutil
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path += [str(TESTS / "command_line"), str(TESTS.parent / "scripts")]
import machines
import support

MACHINES = {  # release of Debian, architecture, its name for wheels
    "debian_11": ("bullseye", None, "x86_64"),
    "debian_11_arm64": ("bullseye", "arm64", "aarch64"),
}
FOLDER = Path(sys.argv.pop(2)).resolve()
WANTED = [sys.argv.pop() for _ in sys.argv[2:]] or list(MACHINES)
RELATIVE = 1e-6  # arm64 rounds the product and the sum of Eigen's loops once, x86-64 rounds them twice
STEPS = """set -e
python3 -m venv v
v/bin/pip install --quiet ./dermis-*.whl
PATH=/root/v/bin:$PATH
test "$(python -m dermis --version)" = "$(dermis --version)"
dermis simulate --array array.toml --scene calibration --out calibration
dermis calibrate --array array.toml --frames calibration/frames.csv --loads calibration/loads.csv --out own.safetensors
dermis evaluate --model own.safetensors --frames contacts/frames.csv --loads contacts/loads.csv
dermis run --model own.safetensors --in contacts/frames.csv --out own.csv
dermis run --model model.safetensors --in contacts/frames.csv --out forces.csv
dermis convert contacts/frames.csv frames.h5 --array array.toml
dermis run --model model.safetensors --in frames.h5 --out hdf5.csv
cmp forces.csv hdf5.csv
dermis emulate --protocol dermis --in contacts/frames.csv --rate 50 --loop >emulated.txt 2>&1 &
until port=$(grep --only-matching --max-count=1 "/dev/pts/[0-9]*" emulated.txt); do sleep 0.1; done
dermis record --from "serial://$port?protocol=dermis" --frames 50 --out board.csv
kill %1
"""


def rows(path):
    with open(path, newline="") as file:
        return [[float(value or "nan") for value in row] for row in list(csv.reader(file))[1:]]


class Machines(support.SmallArray):
    def assert_same_forces(self, there, here):
        there, here = rows(there), rows(here)
        self.assertEqual(len(there), len(here))
        largest = max(max(map(abs, row[2:])) for row in here)
        furthest = max(abs(a - b) for one, other in zip(there, here) for a, b in zip(one[2:], other[2:]))
        print(f"forces differ by {furthest / largest:.1e} of the largest")
        self.assertLessEqual(furthest, RELATIVE * largest)

    def assert_shows_newtons(self, machine):
        serve = "v/bin/dermis serve --from 'sim:contacts?rate=100' --port 0"
        server = subprocess.Popen(machine.line("root", serve, "/root"), stderr=subprocess.PIPE, text=True)
        try:
            address = next(found[0] for line in server.stderr if (found := re.search(r"http://\S+/", line)))
            judge = ["node", TESTS / "viewer/newtons.mjs", address]
            shown = subprocess.run(judge, capture_output=True, text=True, timeout=600)
            self.assertRegex(shown.stdout, r"^\d+\.\d+", shown.stderr)
        finally:
            server.terminate()
            server.communicate()

    def check(self, machine, architecture):
        (wheel,) = FOLDER.glob(f"dermis-*_{architecture}.whl")
        for file in (wheel, self.array, self.model):
            shutil.copy(file, machine.path("/root"))
        shutil.copytree(self.contacts, machine.path("/root/contacts"))
        done = subprocess.run(machine.line("root", STEPS, "/root"), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        own, given = self.work / "own.csv", self.work / "forces.csv"
        self.assertEqual(support.dermis(*self.run_arguments(own)).returncode, 0)
        self.assert_same_forces(machine.path("/root/forces.csv"), own)
        self.assert_same_forces(machine.path("/root/own.csv"), own)
        self.assertEqual(len(rows(machine.path("/root/board.csv"))), 50)
        self.assert_shows_newtons(machine)

    def test_forces_are_those_of_this_machine(self):
        for name in WANTED:
            with self.subTest(machine=name):
                suite, debian, architecture = MACHINES[name]
                if debian:
                    machines.emulate(architecture)
                image = machines.make_image(name, suite, ("python3-venv", "ca-certificates"), debian)
                with machines.unpacked(image) as (folder, lower), machines.Machine(folder, lower) as machine:
                    self.check(machine, architecture)


if __name__ == "__main__":
    support.main()
