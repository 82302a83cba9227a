# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Closes a gripper until it holds an object with 2 N, and keeps that force.

Usage: grasp.py chest.safetensors

The gripper is simulated: its pad, an array of that model, sends counts over TCP as a device does. For one of your own
replace Gripper; grasp() stays as it is.
"""

import argparse
import math
import socket
import sys
import threading
import time

import numpy as np

import dermis

RATE_HZ = 100
WIDTH_MM = 40.0  # of the object
STIFFNESS_N_PER_MM = 0.8
FASTEST_MM_S = 25.0
LONGEST_S = 20.0  # until the force has been held


class Gripper:
    """Two fingers that close on an elastic object, and the pad of one of them."""

    def __init__(self, model: dermis.Model) -> None:
        self.opening_mm = WIDTH_MM + 15
        self.speed_mm_s = 0.0  # at which it closes
        # The pad answers a force with the counts that the model reads as that force, on four taxels.
        with dermis.open("sim:idle", model.array) as idle:
            self._unloaded = next(idle).counts.astype(np.float64)
        rows, cols = self._unloaded.shape
        self._pressed = np.zeros((rows, cols))
        self._pressed[rows // 2 - 1 : rows // 2 + 1, cols // 2 - 1 : cols // 2 + 1] = 1.0
        pipeline = dermis.Pipeline(model)
        self._counts = np.linspace(0, 2**model.array.adc_bits / 4, 200)
        totals = [pipeline.process(self._unloaded + counts * self._pressed).total for counts in self._counts]
        self._forces = np.maximum.accumulate(np.nan_to_num(totals))
        self._server = socket.create_server(("127.0.0.1", 0))
        self.uri = f"tcp://127.0.0.1:{self._server.getsockname()[1]}?protocol=csv&rows={rows}&cols={cols}"
        threading.Thread(target=self._send, daemon=True).start()

    def _send(self) -> None:
        random = np.random.default_rng(1)
        connection, _ = self._server.accept()
        while True:
            self.opening_mm -= self.speed_mm_s / RATE_HZ
            force = STIFFNESS_N_PER_MM * max(WIDTH_MM - self.opening_mm, 0.0)
            counts = self._unloaded + np.interp(force, self._forces, self._counts) * self._pressed
            counts += random.normal(0, 0.5, counts.shape)
            line = ",".join(str(count) for count in np.rint(counts.clip(0)).astype(int).ravel())
            try:
                connection.sendall(line.encode() + b"\n")
            except OSError:
                return  # nobody listens any more
            time.sleep(1 / RATE_HZ)


def grasp(gripper: Gripper, model: dermis.Model, newtons: float, seconds: float) -> float:
    """Closes until the force is there, and holds it for some seconds. The result is the mean force of that time."""
    gain_mm_s_per_n = 4.0
    pipeline = dermis.Pipeline(model)
    held: list[float] = []
    ends = time.monotonic() + LONGEST_S + seconds
    with dermis.open(gripper.uri, model.array) as pad:
        while len(held) < seconds * RATE_HZ:
            raw = pad.latest(timeout_s=2.0)
            if raw is None:
                raise ConnectionError("the pad has ended")
            force = pipeline.process(raw).total
            if time.monotonic() > ends:
                gripper.speed_mm_s = 0.0
                raise TimeoutError(f"the pad has not held {newtons:g} N within {LONGEST_S:g} s; it reads {force:.2f} N")
            if math.isnan(force):
                gripper.speed_mm_s = 0.0  # nobody knows how it holds
                continue
            gripper.speed_mm_s = float(np.clip(gain_mm_s_per_n * (newtons - force), -FASTEST_MM_S, FASTEST_MM_S))
            is_held = abs(force - newtons) < 0.1 * newtons
            held = [*held, force] if is_held else []
    gripper.speed_mm_s = 0.0
    return float(np.mean(held))


def main(model_path: str, newtons: float, seconds: float) -> None:
    model = dermis.read_model(model_path)
    gripper = Gripper(model)
    try:
        force = grasp(gripper, model, newtons, seconds)
    except (ConnectionError, TimeoutError) as error:
        sys.exit(f"grasp.py: {error}")
    print(f"closed to {gripper.opening_mm:.1f} mm; held {force:.2f} N for {seconds:g} s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", help="model file of dermis calibrate")
    parser.add_argument("--newtons", type=float, default=2.0)
    parser.add_argument("--seconds", type=float, default=1.0, help="how long to hold")
    options = parser.parse_args()
    main(options.model, options.newtons, options.seconds)
