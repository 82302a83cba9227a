#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Inverts the ghosting recordings of a real hand (docs/reasons/ghosts.md) under every divider circuit and shows what
remains.

A contact: readings above 50 counts. Remote: at least three taxels from it; shared: in a row or column of the contact.
The ratio: mean of the shared remote taxels over the mean of the other remote taxels. Run it after `make build`.
"""

import csv
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
DERMIS = ROOT / "build/release/bin/dermis"
RECORDINGS = ROOT.parent / "shared/data/dsa_recordings"
ROWS, COLS = 13, 6
CONTACT_COUNTS = 50.0
REMOTE_TAXELS = 3
FULL_SCALE_COUNTS = 4095.0
FRAMES = 300
CIRCUITS = [(rows, columns) for rows in ("grounded", "floating") for columns in ("loaded", "floating")]
RESISTANCES = [(1, 100), (100, 100), (300, 100), (100, 10000)]  # drive and load [ohm]
SCALES = [1.0, 0.15]  # of the readings: nobody knows what share of the supply a count of the vendor is


def read_frames(path):
    with open(path) as file:
        return [[float(value) for value in line[2:]] for line in list(csv.reader(file))[1:]]


def remote_taxels(frame):
    """Shared and other remote taxels of a frame."""
    contact = [divmod(taxel, COLS) for taxel, value in enumerate(frame) if value > CONTACT_COUNTS]
    shared, other = [], []
    for taxel in range(ROWS * COLS):
        row, col = divmod(taxel, COLS)
        if all(max(abs(row - r), abs(col - c)) >= REMOTE_TAXELS for r, c in contact):
            (shared if any(row == r or col == c for r, c in contact) else other).append(taxel)
    return shared, other


def ratio(values, frames):
    shared, other = [], []
    for value, frame in zip(values, frames):
        shared_taxels, other_taxels = remote_taxels(frame)
        shared += [value[taxel] for taxel in shared_taxels]
        other += [value[taxel] for taxel in other_taxels]
    return statistics.fmean(shared) / statistics.fmean(other)


def invert(folder, frames, idle_rows, idle_columns, drive_ohm, load_ohm, scale):
    """Conductances of each frame, and whether the circuit explains it."""
    array, readings, out = folder / "array.toml", folder / "readings.csv", folder / "siemens.csv"
    array.write_text(f"""[array]
rows = {ROWS}
cols = {COLS}
[readout]
circuit = "divider"
idle_rows = "{idle_rows}"
idle_columns = "{idle_columns}"
drive_ohm = {drive_ohm}
load_ohm = {load_ohm}
adc_bits = 12
adc_reference_v = "supply"
""")
    rows = (frame[row * COLS : (row + 1) * COLS] for frame in frames for row in range(ROWS))
    readings.write_text("".join(",".join(repr(v * scale / FULL_SCALE_COUNTS) for v in row) + "\n" for row in rows))
    subprocess.run(
        [DERMIS, "circuit", "invert", "--array", array, "--readings", readings, "--out", out, "--force"],
        stderr=subprocess.DEVNULL,
        check=False,
    )
    values = [float(value) for line in out.read_text().split() for value in line.split(",")]
    size = ROWS * COLS
    return [values[k * size : (k + 1) * size] for k in range(len(frames))]


def main():
    print("recording  idle rows  idle columns  drive    load  scale   solved     raw  inverted")
    for name in ("ghosting_m1", "ghosting_m5"):
        frames = [frame for frame in read_frames(RECORDINGS / f"{name}.csv") if max(frame) > CONTACT_COUNTS]
        frames = [frame for frame in frames if remote_taxels(frame)[0]]
        frames = frames[:: max(1, len(frames) // FRAMES)]
        with tempfile.TemporaryDirectory() as folder:
            for scale in SCALES:
                for idle_rows, idle_columns in CIRCUITS:
                    for drive_ohm, load_ohm in RESISTANCES:
                        inverted = invert(
                            pathlib.Path(folder), frames, idle_rows, idle_columns, drive_ohm, load_ohm, scale
                        )
                        solved = [k for k, values in enumerate(inverted) if values[0] == values[0]]
                        chosen = [frames[k] for k in solved]
                        print(
                            f"{name}  {idle_rows:>8}  {idle_columns:>11}  {drive_ohm:5d}  {load_ohm:6d}  {scale:5.2f}"
                            f"  {len(solved) / len(frames):6.0%}  {ratio(chosen, chosen):6.1f}"
                            f"  {ratio([inverted[k] for k in solved], chosen):8.1f}"
                        )


if __name__ == "__main__":
    main()
