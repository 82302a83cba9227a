# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A simulated suit behind `dermis serve`, and viewers that are not ours: for scripts that measure."""

import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BINARY = ROOT / "build/release/bin/dermis"


def make_model(binary, folder, array=ROOT / "examples/chest/array.toml", seed=1):
    """An array of the simulator, calibrated."""
    model = folder / "model.safetensors"
    scene = ["--scene", "calibration", "--seed", str(seed), "--out", folder]
    subprocess.run([binary, "simulate", "--array", array, *scene], check=True)
    tables = ["--frames", folder / "frames.csv", "--loads", folder / "loads.csv", "--out", model]
    subprocess.run([binary, "calibrate", "--array", array, *tables], check=True, stdout=subprocess.DEVNULL)
    return model


def write_suit(path, model, arrays, rate, sources=None):
    """`sources`: of each array; else they are simulated."""
    tables = []
    for k in range(arrays):
        source = sources[k] if sources else f"sim:contacts?rate={rate:g}&seed={k + 1}"
        tables.append(
            f'[[array]]\nname = "array{k}"\nfrom = "{source}"\n'
            f'model = "{model}"\n'
            f"base_from_array = {{translation_mm = [{170 * (k % 8)}, {170 * (k // 8)}, 0]}}\n"
        )
    path.write_text("\n".join(tables))


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until_served(server, port):
    while True:
        if server.poll() is not None:
            sys.exit(f"dermis serve ended with {server.returncode}")
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)


def processor_seconds(pid):
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def watch(url, seconds, viewers):
    """What each viewer has seen when the time is over."""
    if not (ROOT / "tests/npm/node_modules/@foxglove").exists():
        sys.exit("the viewers' packages are missing: run scripts/setup test")
    command = ["node", ROOT / "scripts/suit_viewer.mjs", url, str(seconds)]
    started = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(viewers)]
    return [json.loads(viewer.communicate(timeout=seconds + 60)[0]) for viewer in started]
