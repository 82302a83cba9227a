# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""One piece of work for many recordings, on the machines of a Ray cluster (docs/campaigns.md).

Usage: ray_campaign.py calibrate --array FILE --out FOLDER RECORDING...
       ray_campaign.py evaluate --model FILE --out FOLDER RECORDING...
       ray_campaign.py convert [--ending .h5] --out FOLDER RECORDING...
       ray_campaign.py dataset [--model FILE] --out FOLDER RECORDING...

All machines see the files under the same names. The loads of monday.mcap are in monday.loads.csv beside it. Outputs
appear whole or not at all, and one that is there is not made again. So the work of a machine that is lost is done by
another, and a campaign that was interrupted goes on where it was.
"""

import argparse
import json
import os
import sys
from pathlib import Path

import ray

import dermis

ENDINGS = {"calibrate": ".safetensors", "evaluate": ".json", "convert": ".h5", "dataset": ""}
MOST_TRIES = 3  # of work whose process was lost; an error is final


def calibrate(recording: Path, options: argparse.Namespace, out: Path) -> None:
    model, _ = dermis.calibrate(options.array, recording, recording.with_suffix(".loads.csv"))
    model.write(out)


def evaluate(recording: Path, options: argparse.Namespace, out: Path) -> None:
    model = dermis.read_model(options.model)
    judged = dermis.evaluate(model, recording, recording.with_suffix(".loads.csv"))
    part = out.with_name(f".{out.name}.{os.getpid()}")
    part.write_text(json.dumps(judged, indent=2) + "\n")
    part.rename(out)


def convert(recording: Path, options: argparse.Namespace, out: Path) -> None:
    dermis.Recording.read(recording).write(out)


def dataset(recording: Path, options: argparse.Namespace, out: Path) -> None:
    dermis.Dataset(recording, model=options.model).write(out, format=options.format)


def do(recording: Path, options: argparse.Namespace, out: Path) -> None:
    if not out.exists():
        {"calibrate": calibrate, "evaluate": evaluate, "convert": convert, "dataset": dataset}[options.work](
            recording, options, out
        )


def place(name: str) -> Path:
    return Path(name).absolute()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", choices=ENDINGS)
    parser.add_argument("recordings", nargs="+", type=place)
    parser.add_argument("--out", type=place, required=True)
    parser.add_argument("--array", type=place)
    parser.add_argument("--model", type=place)
    parser.add_argument("--ending", default="", help="of the converted files: .h5, .mcap, .csv")
    parser.add_argument("--format", default="lerobot", help="of the datasets: lerobot, hdf5, robomimic, zarr")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    ray.init(log_to_driver=False)  # the cluster of RAY_ADDRESS, or the cores of this machine
    remote = ray.remote(num_cpus=1, max_retries=MOST_TRIES)(do)
    ending = options.ending or ENDINGS[options.work]
    outputs = {recording: options.out / (recording.stem + ending) for recording in options.recordings}
    tasks = {remote.remote(recording, options, out): recording for recording, out in outputs.items()}
    failures = 0
    while tasks:
        (ended,), _ = ray.wait(list(tasks))
        recording = tasks.pop(ended)
        try:
            ray.get(ended)
        except ray.exceptions.RayError as error:
            failures += 1
            print(f"{recording}: {getattr(error, 'cause', None) or error}", file=sys.stderr)
    print(f"{len(outputs) - failures} of {len(outputs)} are done")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
