# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""As WebAssembly, src/touch gives the forces that it gives here, and text the same numbers. Usage:
wasm_test.py SIMULATE_FRAMES PROCESS_FRAMES READ_NUMBERS"""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy

CIRCUITS = ["grounded_rows", "floating_rows", "floating_lines", "virtual_ground", "flexitac", "none"]
FRAMES = 1000
TAXELS = 256
# Products and sums are rounded otherwise there. Seen, relative and beyond a micronewton: newtons 5.5e-7 apart, sigmas
# 1.6e-5.
RELATIVE = 1e-5
RELATIVE_OF_SIGMAS = 5e-5
NEWTONS = 1e-6
# The search for the place of a contact may end a step earlier. Seen: 1.4 % are more than 0.1 mm apart, one 2.6 mm.
MOST_METRES = 4e-3
USUAL_METRES = 1e-4
USUAL_SHARE = 0.97
PLAIN_NUMBERS = """0 -0 1 -1.5 .5 -.5 5. 1e3 1E-3 1e 1e+ 0x10 -0x1p3 +1 --1 - . e3 inf -infinity infinit nan nano
1e400 -1e400 1e-400
1e39 1e-46 1e-310 4.9e-324 0.1 16777217 9007199254740993 123456789.123456789 1,5 2;3 3.4028236e38 7f x"""
OTHER_NUMBERS = ["", " 1", "1 2", "\t3", "9" * 400, "0." + "0" * 330 + "1", "1" + "0" * 30 + ".25"]
HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]


def run(command, **more):
    finished = subprocess.run(command, capture_output=True, **more)
    if finished.returncode != 0:
        sys.exit(f"{' '.join(map(str, command[:4]))} fails\n{finished.stderr.decode()}")
    return finished


def node():
    """The command that runs a WebAssembly program, whose imports are those of WASI."""
    found = shutil.which("node")
    if not found or subprocess.run([found, "-e", "require('node:wasi')"], capture_output=True).returncode != 0:
        sys.exit("skipped: there is no node with WASI")
    return [found, "--no-warnings", HERE / "run.mjs"]


def build(*programs):
    """Them, by the project's own build; their folder."""
    if not shutil.which("wasm-ld-16") or not Path("/usr/include/wasm32-wasi/c++/v1").is_dir():
        sys.exit("skipped: there is no compiler for WebAssembly (scripts/setup browser)")
    run(["cmake", "--preset", "browser"], cwd=PROJECT)
    run(["cmake", "--build", "--preset", "browser", "--target", *programs], cwd=PROJECT)
    return PROJECT / "build/browser/bindings/browser"


def check(circuit, here, there):
    """A row is a frame: its status, the newtons and sigmas of the taxels, and the place of a contact."""
    assert here.shape == there.shape == (FRAMES, 3 + 2 * TAXELS), (here.shape, there.shape)
    assert numpy.array_equal(here[:, 0], there[:, 0]), f"{circuit}: other statuses"
    assert (here[:, 1 : 1 + TAXELS] > 0.1).any(axis=1).mean() > 0.5, f"{circuit}: too little is pressed"
    newtons, sigmas = slice(1, 1 + TAXELS), slice(1 + TAXELS, -2)
    for part, relative in ((newtons, RELATIVE), (sigmas, RELATIVE_OF_SIGMAS)):
        numpy.testing.assert_allclose(there[:, part], here[:, part], relative, NEWTONS, err_msg=circuit)
    numpy.testing.assert_allclose(there[:, -2:], here[:, -2:], 0.0, MOST_METRES, err_msg=f"{circuit}: contacts")
    apart = numpy.abs(there[:, -2:] - here[:, -2:])[numpy.isfinite(here[:, -2:])]
    assert (apart < USUAL_METRES).mean() > USUAL_SHARE, f"{circuit}: contacts are elsewhere"


def main():
    simulate, process, read = map(Path, sys.argv[1:])
    in_node = node()
    folder = build("process_frames", "read_numbers")
    program = folder / "process_frames.wasm"
    numbers = "\n".join(PLAIN_NUMBERS.split() + OTHER_NUMBERS).encode()
    here, there = (run(command, input=numbers).stdout for command in ([read], [*in_node, folder / "read_numbers.wasm"]))
    assert here == there, f"other numbers:\n{here.decode()}\n{there.decode()}"
    for circuit in CIRCUITS:
        frames = run([simulate, circuit, str(FRAMES)]).stdout
        runs = [run([*command, circuit], input=frames) for command in ([process], [*in_node, program])]
        check(circuit, *(numpy.frombuffer(done.stdout, numpy.float32).reshape(FRAMES, -1) for done in runs))
        here_us, there_us = (float(done.stderr) for done in runs)
        print(f"{circuit}: a frame takes {here_us} us, as WebAssembly {there_us} us")
    print(f"{len(CIRCUITS)} circuits, {FRAMES} frames each: the same forces as WebAssembly")


if __name__ == "__main__":
    main()
