# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""As WebAssembly, a calibration gives the networks that it gives here; both times are told. Usage:
calibration_test.py SIMULATE_PRESSES CALIBRATE_PRESSES"""

import json
import os
import sys
from pathlib import Path

import numpy
from wasm_test import build, node, run

CIRCUITS = ["grounded_rows", "auto"]
PRESSES = 300
# A training ends where its next step is too small to matter. Seen: 4.9e-7 apart with a known circuit, 3.3e-4 with
# "auto".
RELATIVE = 5e-3
LEAST = 1e-3


def parameters(model):
    """Those of the networks, of the bytes of a model file."""
    head = int.from_bytes(model[:8], "little")
    begin, end = json.loads(model[8 : 8 + head])["networks.parameters"]["data_offsets"]
    return numpy.frombuffer(model[8 + head :][begin:end], numpy.float32)


def main():
    simulate, calibrate = map(Path, sys.argv[1:])
    in_node = [*node(), build("calibrate_presses") / "calibrate_presses.wasm"]
    presses = run([simulate, "grounded_rows", str(PRESSES)]).stdout
    one_core = ["taskset", "-c", str(min(os.sched_getaffinity(0))), calibrate]
    for circuit in CIRCUITS:
        runs = [run([*command, circuit], input=presses) for command in (one_core, [calibrate], in_node)]
        here, _, there = (parameters(done.stdout) for done in runs)
        numpy.testing.assert_allclose(there, here, RELATIVE, LEAST, err_msg=circuit)
        one, all_cores, wasm = ([float(text) for text in done.stderr.split()] for done in runs)
        print(
            f"{circuit}, {PRESSES} presses: a calibration takes {one[1]} s on one core, {all_cores[1]} s on "
            f"{len(os.sched_getaffinity(0))}, as WebAssembly {wasm[1]} s ({wasm[0]} s the first time)"
        )


if __name__ == "__main__":
    main()
