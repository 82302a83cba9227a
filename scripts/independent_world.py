#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A world of its own judges the sums of forces: a sheet, its circuit and its ADC in numpy, which share nothing with
src/learn/simulation.

It calibrates `dermis` on single presses, one at a time, and asks `dermis run --totals` about frames of which nothing
touches and frames with one to four contacts. It prints the mean of the untouched sums, the bias of the touched ones,
and how often the truth lies within one and two standard deviations. Run it after `make build`.
"""

import argparse
import csv
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
PRESSES = 10  # a taxel
IDLE_FRAMES = 200
JUDGED_FRAMES = 400
LEAST_NEWTONS, MOST_NEWTONS = 0.1, 50.0


@dataclass
class Rubber:
    """Conductive rubber on a contact resistance: G = 1 / (contact + 1 / (rest + a F^p)), another a and p a taxel."""

    level: numpy.ndarray
    exponent: numpy.ndarray
    rest_siemens: float = 1 / 200e3
    contact_ohm: float = 60.0

    @classmethod
    def random(cls, size, random):
        exponent = random.normal(0.9, 0.045, (size, size))
        at_ten_newtons = numpy.exp(random.normal(0.0, 0.15, (size, size))) / 900.0
        return cls(at_ten_newtons / 10.0**exponent, exponent)

    def siemens(self, newtons):
        return 1.0 / (self.contact_ohm + 1.0 / (self.rest_siemens + self.level * newtons**self.exponent))


def node_voltages(siemens, drive_ohm, load_ohm):
    """Of the rows, then of the columns, over the supply, as one row after another is driven [frames, nodes, rows]."""
    frames, rows, cols = siemens.shape
    nodal = numpy.zeros((frames, rows + cols, rows + cols))
    nodal[:, :rows, rows:] = -siemens
    nodal[:, rows:, :rows] = -siemens.transpose(0, 2, 1)
    nodal[:, range(rows), range(rows)] = siemens.sum(axis=2) + 1.0 / drive_ohm
    nodal[:, range(rows, rows + cols), range(rows, rows + cols)] = siemens.sum(axis=1) + 1.0 / load_ohm
    driven = numpy.zeros((rows + cols, rows))
    driven[range(rows), range(rows)] = 1.0 / drive_ohm
    return numpy.linalg.solve(nodal, driven[None])


@dataclass
class Instrument:
    """Rows driven in turn through their drivers, the others grounded through theirs; columns end in loads."""

    drive_ohm: float = 30.0
    load_ohm: float = 220.0
    bits: int = 12
    noise_counts: float = 0.6

    def ratio(self, siemens):
        """Column voltages over the supply, one scan of the rows a frame [frames, rows, cols]."""
        rows = siemens.shape[1]
        return node_voltages(siemens, self.drive_ohm, self.load_ohm)[:, rows:, :].transpose(0, 2, 1)

    def counts(self, siemens, random):
        full_scale = 2**self.bits - 1
        reading = full_scale * self.ratio(siemens) + random.normal(0.0, self.noise_counts, siemens.shape)
        return numpy.clip(numpy.rint(reading), 0, full_scale).astype(int)

    def describe(self, size, path):
        path.write_text(
            f"[array]\nrows = {size}\ncols = {size}\ntaxel_area_mm2 = 38.48\n"
            f'[readout]\ncircuit = "divider"\ndrive_ohm = {self.drive_ohm}\nload_ohm = {self.load_ohm}\n'
            f'adc_bits = {self.bits}\nadc_reference_v = "supply"\nsupply_v = 5.0\n'
        )


def single_presses(size, random):
    """Forces [frames, rows, cols]: idle frames, then each taxel alone with forces in even ratios, in any order."""
    steps = (numpy.arange(PRESSES) + random.uniform(0.0, 1.0, (size * size, PRESSES))) / PRESSES
    presses = LEAST_NEWTONS * (MOST_NEWTONS / LEAST_NEWTONS) ** steps
    order = random.permutation(size * size * PRESSES)
    newtons = numpy.zeros((IDLE_FRAMES + order.size, size * size))
    newtons[IDLE_FRAMES + order, numpy.repeat(numpy.arange(size * size), PRESSES)] = presses.ravel()
    return newtons.reshape(-1, size, size)


def hertz(size, centre, radius):
    """The pressure of a ball on an elastic sheet over each taxel, of which 8 x 8 points are asked, in all 1."""
    place = (numpy.arange(8 * size) + 0.5) / 8.0 - 0.5
    square = (place[:, None] - centre[0]) ** 2 + (place[None, :] - centre[1]) ** 2
    pressure = numpy.sqrt(numpy.clip(1.0 - square / radius**2, 0.0, None)).reshape(size, 8, size, 8).sum(axis=(1, 3))
    return pressure / pressure.sum()


def touches(size, random):
    """Forces of one to four balls a frame."""
    newtons = numpy.zeros((JUDGED_FRAMES, size, size))
    for frame in newtons:
        for _ in range(random.integers(1, 5)):
            force = numpy.exp(random.uniform(numpy.log(1.0), numpy.log(MOST_NEWTONS)))
            frame += force * hertz(size, random.uniform(0.0, size - 1.0, 2), random.uniform(1.0, 3.0))
    return newtons


def write_frames(path, counts):
    size = counts.shape[1]
    with open(path, "w", encoding="ascii") as file:
        file.write("time_s," + ",".join(f"r{row}c{col}" for row in range(size) for col in range(size)) + "\n")
        file.writelines(
            f"{0.01 * number:.2f}," + ",".join(map(str, frame)) + "\n"
            for number, frame in enumerate(counts.reshape(len(counts), -1).tolist())
        )


def write_loads(path, newtons):
    with open(path, "w", encoding="ascii") as file:
        file.write("frame,kind,where,value\n")
        for number, frame in enumerate(newtons):
            pressed = numpy.argwhere(frame)
            file.writelines(f"{number},force,r{row}c{col},{frame[row, col]:.6g}\n" for row, col in pressed)
            if not len(pressed):
                file.write(f"{number},force,all,0\n")


def dermis(binary, *arguments):
    done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr)


class World:
    """A sheet and its readout, and the model that `dermis` learned of them."""

    def __init__(self, binary, size, random, folder, instrument):
        self.binary, self.random, self.folder, self.instrument = binary, random, folder, instrument
        self.rubber = Rubber.random(size, random)
        instrument.describe(size, folder / "array.toml")
        newtons = single_presses(size, random)
        write_frames(folder / "calibration.csv", self.counts(newtons))
        write_loads(folder / "loads.csv", newtons)
        dermis(
            binary,
            "calibrate",
            "--array",
            folder / "array.toml",
            "--frames",
            folder / "calibration.csv",
            "--loads",
            folder / "loads.csv",
            "--out",
            folder / "model.safetensors",
        )

    def counts(self, newtons):
        pieces = numpy.array_split(newtons, len(newtons) // 100 + 1)
        return numpy.concatenate([self.instrument.counts(self.rubber.siemens(piece), self.random) for piece in pieces])

    def totals(self, newtons):
        """Sums and their standard deviations [frames] [N], as `dermis run --totals` writes them."""
        write_frames(self.folder / "frames.csv", self.counts(newtons))
        dermis(
            self.binary,
            "run",
            "--model",
            self.folder / "model.safetensors",
            "--in",
            self.folder / "frames.csv",
            "--totals",
            self.folder / "totals.csv",
            "--force",
        )
        with open(self.folder / "totals.csv", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        return (numpy.array([float(row[column]) for row in rows]) for column in ("total_n", "sigma_total_n"))


@dataclass
class Figures:
    """What was found: newtons, shares of frames, and the bias relative to the forces."""

    untouched_newtons: float
    untouched_within_2: float
    bias: float
    within_1: float
    within_2: float
    sigma_newtons: float

    def __str__(self):
        return (
            f"untouched {self.untouched_newtons:+.4f} N, within 2 sigma {100 * self.untouched_within_2:.1f} %; touched "
            f"bias {100 * self.bias:+.3f} %, within 1 and 2 sigma {100 * self.within_1:.0f} / "
            f"{100 * self.within_2:.0f} %, sigma {self.sigma_newtons:.3f} N"
        )


def judge(binary, size, seed):
    random = numpy.random.default_rng([seed, size])
    with tempfile.TemporaryDirectory() as folder:
        world = World(binary, size, random, Path(folder), Instrument())
        idle, idle_sigma = world.totals(numpy.zeros((JUDGED_FRAMES, size, size)))
        newtons = touches(size, random)
        total, sigma = world.totals(newtons)
    truth = newtons.sum(axis=(1, 2))
    error = total - truth
    return Figures(
        idle.mean(),
        numpy.mean(abs(idle) <= 2 * idle_sigma),
        error.sum() / truth.sum(),
        numpy.mean(abs(error) <= sigma),
        numpy.mean(abs(error) <= 2 * sigma),
        sigma.mean(),
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("binary", nargs="?", default=ROOT / "build/release/bin/dermis")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sizes", type=int, nargs="+", default=[8, 16, 32])
    arguments = parser.parse_args()
    for size in arguments.sizes:
        print(f"{size:2}x{size:<2} {judge(arguments.binary, size, arguments.seed)}", flush=True)


if __name__ == "__main__":
    main()
