# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A calibration step by step, as in a notebook: describe the array, label what pressed, calibrate, judge.

Usage: calibrate_array.py FOLDER
array.toml, frames.csv, loads.csv, test.csv and test_loads.csv are in it.
"""

import argparse
from pathlib import Path

import dermis


def main(folder: str) -> None:
    # What is known: the circuit of the array.
    place = Path(folder)
    array = dermis.read_array(place / "array.toml")

    # What was recorded, and what pressed meanwhile. Loads can be made in code: Load(frame, (row, col), newtons=5.0).
    recording = dermis.Recording.read(place / "frames.csv")
    loads = dermis.read_loads(place / "loads.csv", array, len(recording))
    print(f"{len(recording)} frames, {len({load.frame for load in loads})} of them labelled")

    # What is learned.
    model, report = dermis.calibrate(array, recording, loads)
    print(report.choice)
    print(
        f"loads of {report.lightest_newtons:.2f} to {report.heaviest_newtons:.2f} N, fit {report.median_fit_error:.2%}"
    )
    model.write(place / "model.safetensors", force=True)  # that of an earlier run is replaced

    # How good it is on frames that it has not seen, beside plain tables.
    for estimator in dermis.evaluate(model, place / "test.csv", place / "test_loads.csv")["estimators"]:
        error = estimator["median_relative_error"]
        print(f"{estimator['name']}: " + ("no force to judge" if error is None else f"median error {error:.2%}"))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    main(parser.parse_args().folder)
