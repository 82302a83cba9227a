# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Every source of src/touch is compiled for WebAssembly, and gives there the forces that it gives here. Usage:
wasm_test.py BUILD_FOLDER HIGHWAY_INCLUDES EIGEN_INCLUDES SIMULATE_FRAMES PROCESS_FRAMES"""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

CIRCUITS = ["grounded_rows", "floating_rows", "virtual_ground", "flexitac", "none"]
FRAMES = 1000
TAXELS = 64
# Products and sums are rounded otherwise there. Seen: newtons and sigmas up to 2.4e-5 apart, relative.
RELATIVE = 5e-5
NEWTONS = 1e-6
# The search for the place of a contact may end a step earlier. Seen: 1.4 % are more than 0.1 mm apart, one 2.6 mm.
MOST_METRES = 4e-3
USUAL_METRES = 1e-4
USUAL_SHARE = 0.97
OPTIONS = (
    "-target wasm32-wasi -std=c++20 -O2 -msimd128 -fno-exceptions -fopenmp-simd -fno-math-errno -ffp-contract=off"
).split()
HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]


def run(command, **more):
    finished = subprocess.run(command, capture_output=True, **more)
    if finished.returncode != 0:
        sys.exit(f"{' '.join(map(str, command[:4]))} fails\n{finished.stderr.decode()}")
    return finished.stdout


def node():
    """The command that runs a WebAssembly program, whose imports are those of WASI."""
    found = shutil.which("node")
    if not found or subprocess.run([found, "-e", "require('node:wasi')"], capture_output=True).returncode != 0:
        sys.exit("skipped: there is no node with WASI")
    return [found, "--no-warnings", HERE / "run.mjs"]


def build(folder, highway, eigen):
    """zig keeps objects in its cache, so only what has changed is compiled; it compiles one source after the other."""
    objects = folder / "objects"
    objects.mkdir(parents=True, exist_ok=True)
    for library, place in {"hwy": highway, "Eigen": eigen}.items():  # nothing else of this machine's headers
        link = folder / library
        link.unlink(missing_ok=True)
        link.symlink_to(place / library)
    sources = sorted((PROJECT / "src/touch").rglob("*.cpp")) + [HERE / "process_frames.cpp", HERE / "thread_exit.cpp"]
    includes = [f"-I{PROJECT / 'include'}", f"-I{PROJECT / 'src'}", "-isystem", folder]
    compiler = [sys.executable, "-m", "ziglang", "c++", *OPTIONS]

    def compiled(source):
        made = objects / ("_".join(source.relative_to(PROJECT).parts) + ".o")
        run([*compiler, *includes, "-c", source, "-o", made], cwd=PROJECT)
        return made

    program = folder / "process_frames.wasm"
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        run([*compiler, *pool.map(compiled, sources), "-o", program], cwd=PROJECT)
    return program


def check(circuit, here, there):
    """A row is a frame: its status, the newtons and sigmas of the taxels, and the place of a contact."""
    assert here.shape == there.shape == (FRAMES, 3 + 2 * TAXELS), (here.shape, there.shape)
    assert numpy.array_equal(here[:, 0], there[:, 0]), f"{circuit}: other statuses"
    assert (here[:, 1 : 1 + TAXELS] > 0.1).any(axis=1).mean() > 0.5, f"{circuit}: too little is pressed"
    numpy.testing.assert_allclose(there[:, 1:-2], here[:, 1:-2], RELATIVE, NEWTONS, err_msg=circuit)
    numpy.testing.assert_allclose(there[:, -2:], here[:, -2:], 0.0, MOST_METRES, err_msg=f"{circuit}: contacts")
    apart = numpy.abs(there[:, -2:] - here[:, -2:])[numpy.isfinite(here[:, -2:])]
    assert (apart < USUAL_METRES).mean() > USUAL_SHARE, f"{circuit}: contacts are elsewhere"


def main():
    folder, highway, eigen, simulate, process = map(Path, sys.argv[1:])
    in_node = node()
    program = build(folder, highway, eigen)
    for circuit in CIRCUITS:
        frames = run([simulate, circuit, str(FRAMES)])
        here, there = (
            numpy.frombuffer(run([*command, circuit], input=frames), numpy.float32).reshape(FRAMES, -1)
            for command in ([process], [*in_node, program])
        )
        check(circuit, here, there)
    print(f"{len(CIRCUITS)} circuits, {FRAMES} frames each: the same forces as WebAssembly")


if __name__ == "__main__":
    main()
