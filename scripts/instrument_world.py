#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Judges instruments that are not ideal, in a world that shares nothing with src/learn/simulation.

A 10x10 divider with grounded idle rows: 30 ohm drivers, 60 ohm of contact in series with each taxel, 220 ohm loads,
12 bits. Readings come from the nodal equations, solved by numpy. Each fault is told in array.toml, fitted ("fit"), or
neither. What is printed: the error of touched taxels, that of the same world without the fault (the floor), coverage,
and what calibrate and doctor say.

usage: scripts/instrument_world.py BINARY [--faults a,b] [--modes a,b] [--seeds 1,2] [--presses single|pairs|proofs]
"""

import argparse
import csv
import pathlib
import re
import subprocess
import tempfile

import numpy
from independent_world import node_voltages, write_frames

ROWS = COLS = 10
DRIVE_OHM, LOAD_OHM, CONTACT_OHM = 30.0, 220.0, 60.0
FULL, VOLTS = 4095, 5.0
SUPPLY_OHM = 12.0  # takes 5 % of a row of four firm taxels
TOUCHES = 24  # at once, at work
FAULTS = ("none", "settling", "sag", "offset", "curve", "multiplexer", "esp32")
FORCES = (0.7, 1.5, 3.0, 6.0, 12.0, 20.0)


class World:
    """A sheet of rubber and what reads it."""

    def __init__(self, fault, seed):
        self.fault = fault
        sheet = numpy.random.default_rng(seed)
        shape = (ROWS, COLS)
        self.at_ten = 900.0 * numpy.exp(0.15 * sheet.standard_normal(shape))
        self.exponent = 0.9 + 0.03 * sheet.standard_normal(shape)
        self.contact = CONTACT_OHM * (1 + 0.05 * sheet.standard_normal(shape))
        self.leak = 1 / 300e3
        self.drive = numpy.full(ROWS, DRIVE_OHM)
        if fault == "multiplexer":
            self.drive = sheet.uniform(70.0, 150.0, ROWS)
        self.random = numpy.random.default_rng(seed + 1000)
        self.held = None

    def siemens(self, force):
        """Each press about its law by half a percent."""
        ohm = self.at_ten * (10.0 / numpy.maximum(force, 1e-9)) ** self.exponent + self.contact
        scatter = numpy.exp(0.005 * self.random.standard_normal(force.shape))
        return self.leak + scatter * (force > 0) / ohm

    def volts(self, siemens):
        """Over the supply, by the nodal equations with one row driven after another."""
        solved = node_voltages(siemens[None], self.drive, LOAD_OHM)[0]
        taken = (1 - numpy.diag(solved[:ROWS])) / self.drive
        supply_ohm = SUPPLY_OHM if self.fault == "sag" else 0.0
        return (solved[ROWS:] / (1 + supply_ohm * taken)).T

    def counts(self, force):
        ideal = self.volts(self.siemens(force)).ravel() * FULL
        if self.fault == "settling":
            for k in range(ideal.size):
                ideal[k] += 0.03 * ((ideal[k] if self.held is None else self.held) - ideal[k])
                self.held = ideal[k]
        if self.fault == "offset":
            ideal = ideal + 10
        if self.fault == "curve":
            ideal = ideal + 0.004 * FULL * numpy.sin(numpy.pi * ideal / FULL)
        if self.fault == "esp32":  # nothing below 0.15 V, bent above 2.6 V
            above = 0.52 * FULL
            ideal = numpy.where(ideal > above, above + (ideal - above) * 0.8, ideal) - 0.03 * FULL
        return numpy.clip(numpy.round(ideal + 0.7 * self.random.standard_normal(ideal.size)), 0, FULL)

    def told(self):
        """What a user who knows the instrument writes."""
        if self.fault == "settling":
            return "adc_settling = 0.03\n"
        if self.fault == "sag":
            return f"supply_ohm = {SUPPLY_OHM}\n"
        if self.fault == "offset":
            return "adc_offset_counts = 10\n"
        if self.fault == "curve":
            ideal = numpy.linspace(0, FULL, 33)
            sent = ideal + 0.004 * FULL * numpy.sin(numpy.pi * ideal / FULL)
            return "adc_curve = " + str([[float(s), float(i * VOLTS / FULL)] for s, i in zip(sent, ideal)]) + "\n"
        return ""


FITTED = {"settling": 'adc_settling = "fit"\n', "sag": 'supply_ohm = "fit"\n', "offset": 'adc_offset_counts = "fit"\n'}


def description(world, mode):
    drive = str(DRIVE_OHM)
    if world.fault == "multiplexer" and mode == "told":
        drive = str([float(ohm) for ohm in world.drive])
    if world.fault == "multiplexer" and mode == "fitted":
        drive = '"fit"'
    extra = world.told() if mode == "told" else FITTED.get(world.fault, "") if mode == "fitted" else ""
    return (
        f'[array]\nrows = {ROWS}\ncols = {COLS}\n\n[readout]\ncircuit = "divider"\ndrive_ohm = {drive}\n'
        f"load_ohm = {LOAD_OHM}\nadc_bits = 12\nadc_reference_v = {VOLTS}\nsupply_v = {VOLTS}\n{extra}"
    )


def single(force, taxel):
    field = numpy.zeros(ROWS * COLS)
    field[taxel] = force
    return field


def calibration(world, presses):
    """Frames, and lines of loads.csv."""
    frames, loads = [], []

    def hold(field, labels):
        for _ in range(3):
            loads.extend(f"{len(frames)},{label}" for label in labels)
            frames.append(world.counts(field.reshape(ROWS, COLS)))

    def name(taxel):
        return f"r{taxel // COLS}c{taxel % COLS}"

    for _ in range(7):
        hold(numpy.zeros(ROWS * COLS), ["force,all,0"])
    for taxel in range(ROWS * COLS):
        for force in FORCES:
            hold(single(force, taxel), [f"force,{name(taxel)},{force}"])
    if presses == "pairs":
        for row in range(ROWS):
            for _ in range(8):
                cols = world.random.choice(COLS, 2, replace=False)
                force = float(world.random.choice(FORCES[2:]))
                pair = [int(row * COLS + col) for col in cols]
                hold(sum(single(force, taxel) for taxel in pair), [f"force,{name(t)},{force}" for t in pair])
    if presses == "proofs":
        for _ in range(20):
            row, col = world.random.integers(ROWS), world.random.integers(COLS - 3)
            shares = world.random.dirichlet(numpy.full(4, 20.0)) * 20.0
            field = numpy.zeros(ROWS * COLS)
            field[row * COLS + col : row * COLS + col + 4] = shares
            hold(field, [f"force,r{row}c{col}:r{row}c{col + 3},20"])
    return frames, loads


def work(world, count=300):
    """Frames of several touches, and their forces."""
    fields, frames = [], []
    for _ in range(count):
        field = numpy.zeros(ROWS * COLS)
        taxels = world.random.choice(ROWS * COLS, TOUCHES, replace=False)
        field[taxels] = numpy.exp(world.random.uniform(0.0, numpy.log(20.0), TOUCHES))
        fields.append(field)
        frames.append(world.counts(field.reshape(ROWS, COLS)))
    return numpy.array(fields), frames


def as_counts(frames):
    return numpy.array(frames).astype(int).reshape(-1, ROWS, COLS)


def read_table(path):
    with open(path, encoding="ascii") as file:
        rows = list(csv.reader(file))
    first = rows[0].index("r0c0")
    return numpy.array([[float(cell or "nan") for cell in row[first : first + ROWS * COLS]] for row in rows[1:]])


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def judge(binary, fault, mode, seed, presses, folder):
    """Median error and coverage of touched taxels, and the lines that name the instrument."""
    world = World(fault, seed)
    frames, loads = calibration(world, presses)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "array.toml").write_text(description(world, mode))
    write_frames(folder / "frames.csv", as_counts(frames))
    (folder / "loads.csv").write_text("frame,kind,where,value\n" + "\n".join(loads) + "\n")
    code, said = run(
        binary,
        "calibrate",
        "--array",
        folder / "array.toml",
        "--frames",
        folder / "frames.csv",
        "--loads",
        folder / "loads.csv",
        "--out",
        folder / "model",
        "--verbose",
    )
    (folder / "calibrate.txt").write_text(said)
    if code != 0:
        return None, said
    fields, touched = work(world)
    write_frames(folder / "work.csv", as_counts(touched))
    code, output = run(
        binary,
        "run",
        "--model",
        folder / "model",
        "--in",
        folder / "work.csv",
        "--out",
        folder / "forces.csv",
        "--sigma",
        folder / "sigma.csv",
    )
    if code != 0:
        return None, output
    _, doctor = run(binary, "doctor", "--model", folder / "model", "--in", folder / "work.csv")
    (folder / "doctor.txt").write_text(doctor)
    forces, sigma = read_table(folder / "forces.csv"), read_table(folder / "sigma.csv")
    is_touched = (fields >= 1.0) & numpy.isfinite(forces)
    error = (forces - fields)[is_touched]
    sigmas = numpy.abs(error) / sigma[is_touched]
    figures = {
        "median": 100 * numpy.median(numpy.abs(error / fields[is_touched])),
        "bias": 100 * numpy.median(error / fields[is_touched]),
        "within 1": 100 * numpy.mean(sigmas < 1),
        "within 2": 100 * numpy.mean(sigmas < 2),
    }
    words = r"settl|supply_ohm|sags|offset_counts|bent|drive_ohm|driver|tell nothing|add up"
    named = [line.strip() for line in (said + doctor).splitlines() if re.search(words, line)]
    return figures, "\n".join(named)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("--faults", default=",".join(FAULTS))
    parser.add_argument("--modes", default="told,fitted,neither")
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--presses", default="pairs", choices=("single", "pairs", "proofs"))
    parser.add_argument("--keep", type=pathlib.Path, help="folder for all files")
    options = parser.parse_args()
    print(f"{'fault':12}{'mode':9}{'seed':>5}{'median %':>10}{'bias %':>8}{'1 sigma':>9}{'2 sigma':>9}")
    with tempfile.TemporaryDirectory() as scratch:
        for seed in options.seeds.split(","):
            for fault in options.faults.split(","):
                for mode in ("told",) if fault == "none" else options.modes.split(","):
                    folder = (options.keep or pathlib.Path(scratch)) / f"{fault}-{mode}-{seed}-{options.presses}"
                    figures, named = judge(options.binary, fault, mode, int(seed), options.presses, folder)
                    if figures is None:
                        print(f"{fault:12}{mode:9}{seed:>5}  failed: {named.strip()}")
                        continue
                    print(
                        f"{fault:12}{mode:9}{seed:>5}{figures['median']:10.2f}{figures['bias']:8.2f}"
                        f"{figures['within 1']:9.0f}{figures['within 2']:9.0f}",
                        flush=True,
                    )
                    for line in named.splitlines():
                        print(f"    {line[:180]}")


if __name__ == "__main__":
    main()
