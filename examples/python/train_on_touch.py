# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A small network that is trained on episodes of touch with plain numpy: the force on the array one step ahead.

Usage: train_on_touch.py MODEL RECORDING [RECORDING...] [--seconds 60]
The last fifth of the steps of each recording is left out of the training, and judges it.
"""

import argparse
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

import dermis

HIDDEN = 32
BATCH = 64
RATE = 1e-3


def examples_of(episode: dict[str, NDArray[Any]], array: str) -> tuple[NDArray[Any], NDArray[Any]]:
    """Windows of forces, and the sum of the forces in the step after each."""
    forces = episode[array]
    return forces[:-1].reshape(len(forces) - 1, -1), forces[1:, -1].sum(axis=(1, 2))


class Network:
    """One hidden layer, trained by Adam."""

    def __init__(self, inputs: int, random: np.random.Generator) -> None:
        shapes = [(inputs, HIDDEN), (HIDDEN,), (HIDDEN, 1), (1,)]
        self.weights = [
            random.normal(0, shape[0] ** -0.5, shape) if len(shape) == 2 else np.zeros(shape) for shape in shapes
        ]
        self.mean = [np.zeros_like(each) for each in self.weights]
        self.square = [np.zeros_like(each) for each in self.weights]
        self.steps = 0

    def predict(self, inputs: NDArray[Any]) -> NDArray[Any]:
        into, bias, out, offset = self.weights
        outputs: NDArray[Any] = np.tanh(inputs @ into + bias) @ out + offset
        return outputs[:, 0]

    def train(self, inputs: NDArray[Any], wanted: NDArray[Any]) -> None:
        into, bias, out, offset = self.weights
        hidden = np.tanh(inputs @ into + bias)
        error = ((hidden @ out + offset)[:, 0] - wanted)[:, None] / len(wanted)
        back = (error @ out.T) * (1 - hidden**2)
        slopes = [inputs.T @ back, back.sum(0), hidden.T @ error, error.sum(0)]
        self.steps += 1
        for weight, mean, square, slope in zip(self.weights, self.mean, self.square, slopes):
            mean += 0.1 * (slope - mean)
            square += 0.001 * (slope**2 - square)
            step = mean / (1 - 0.9**self.steps) / (np.sqrt(square / (1 - 0.999**self.steps)) + 1e-8)
            weight -= RATE * step


def main(model: str, recordings: list[str], seconds: float) -> None:
    dataset = dermis.Dataset(recordings, model=model, fps=30, window=5, columns=["forces"])
    array = next(name for name in dataset[0] if name != "time_ns")
    training, judging = [], []
    for episode in (dataset[k] for k in range(len(dataset))):
        inputs, wanted = examples_of(episode, array)
        cut = len(wanted) * 4 // 5
        training.append((inputs[:cut], wanted[:cut]))
        judging.append((inputs[cut:], wanted[cut:]))
    inputs, wanted = (np.concatenate(parts) for parts in zip(*training))
    scale, largest = max(inputs.std(), 1e-9), max(wanted.std(), 1e-9)
    random = np.random.default_rng(1)
    network = Network(inputs.shape[1], random)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        batch = random.integers(0, len(wanted), BATCH)
        network.train(inputs[batch] / scale, wanted[batch] / largest)
    unseen, truth = (np.concatenate(parts) for parts in zip(*judging))
    error = np.abs(network.predict(unseen / scale) * largest - truth).mean()
    print(f"{len(wanted)} steps of {len(dataset)} episodes, {network.steps} batches")
    print(f"mean error on steps that it has not seen: {error:.3f} N, of forces of {np.abs(truth).mean():.3f} N")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--seconds", type=float, default=60.0)
    arguments = parser.parse_args()
    main(arguments.model, arguments.recordings, arguments.seconds)
