# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Batches of a dataset of `dermis dataset` by the loaders of others: LeRobot's, or zarr.

Usage: load_dataset.py FOLDER [ARRAY]
FOLDER was made with --format lerobot (needs the package lerobot) or --format zarr (needs zarr).
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

BATCH = 16


def batches_of_lerobot(folder: Path, array: str) -> Iterator[NDArray[Any]]:
    from lerobot.datasets.lerobot_dataset import LeRobotDataset
    from torch.utils.data import DataLoader

    dataset = LeRobotDataset("dermis/touch", root=folder)
    for batch in DataLoader(dataset, batch_size=BATCH, shuffle=True):
        yield batch[f"observation.tactile.{array}"].numpy()


def batches_of_zarr(folder: Path, array: str) -> Iterator[NDArray[Any]]:
    import zarr

    buffer = zarr.open(str(folder), mode="r")
    forces = buffer["data"][f"tactile_{array}"][:]
    order = np.random.default_rng(1).permutation(int(buffer["meta/episode_ends"][-1]))
    for first in range(0, len(order), BATCH):
        yield forces[order[first : first + BATCH]]


def main(folder: str, array: str) -> None:
    place = Path(folder)
    batches = batches_of_lerobot if (place / "meta/info.json").exists() else batches_of_zarr
    steps = 0
    for batch in batches(place, array):
        steps += len(batch)
    print(f"{steps} steps, the last batch of the shape {tuple(batch.shape)}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("array", nargs="?", default="array")
    main(**vars(parser.parse_args()))
