#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Writes feed_forward.csv: outputs, error and gradient of small BP networks on random samples, with numpy alone.

Layers are matrix products over all samples; the gradient is a complex-step derivative of the error (exact to
rounding), so no backward pass is shared with dermis. Run from any folder: generate_feed_forward.py
"""

import pathlib

import numpy as np

SEED = 20261121

# Of a hidden or output layer: numpy's function on complex numbers.
TRANSFER = {
    "log_sigmoid": lambda z: 1.0 / (1.0 + np.exp(-z)),
    "tanh": np.tanh,
    "relu": lambda z: np.where(z.real > 0.0, z, 0.0),
    "linear": lambda z: z,
}

CASES = [  # inputs, layers, samples
    (2, [(5, "log_sigmoid"), (1, "linear")], 61),
    (2, [(20, "log_sigmoid"), (1, "linear")], 33),
    (8, [(16, "tanh"), (16, "tanh"), (1, "linear")], 40),
    (3, [(4, "log_sigmoid"), (3, "log_sigmoid")], 17),
    (1, [(1, "tanh")], 1),
    (5, [(7, "relu"), (6, "tanh"), (5, "log_sigmoid"), (4, "linear")], 150),
]


def forward(inputs, layers, parameters, x):
    place = 0
    for units, transfer in layers:
        weights = parameters[place : place + units * inputs].reshape(units, inputs)
        place += units * inputs
        thresholds = parameters[place : place + units]
        place += units
        x = TRANSFER[transfer](x @ weights.T + thresholds)
        inputs = units
    assert place == len(parameters)
    return x


def error(inputs, layers, parameters, x, targets, weights):
    difference = forward(inputs, layers, parameters, x) - targets
    return 0.5 * np.sum(weights[:, None] * difference**2)


def gradient(inputs, layers, parameters, x, targets, weights):
    values = []
    for k in range(len(parameters)):
        moved = parameters.astype(complex)
        moved[k] += 1e-30j
        values.append(error(inputs, layers, moved, x, targets, weights).imag / 1e-30)
    return values


def rounded(values):
    """To float, so that single and double precision see the same numbers."""
    return values.astype(np.float32).astype(np.float64)


def line(kind, values):
    return kind + "," + ",".join(repr(float(value)) for value in np.ravel(values)) + "\n"


def main():
    random = np.random.default_rng(SEED)
    path = pathlib.Path(__file__).with_name("feed_forward.csv")
    with path.open("w", encoding="ascii") as out:
        out.write(f"# written by {pathlib.Path(__file__).name}, seed {SEED}, numpy {np.__version__}; do not edit\n")
        for inputs, layers, samples in CASES:
            count, fan_in = 0, inputs
            for units, _ in layers:
                count += units * (fan_in + 1)
                fan_in = units
            parameters = rounded(random.standard_normal(count))
            x = rounded(random.uniform(-2.0, 2.0, (samples, inputs)))
            targets = rounded(random.uniform(-1.0, 1.0, (samples, fan_in)))
            weights = rounded(random.uniform(0.1, 3.0, samples))
            out.write(f"shape,{inputs}," + ",".join(f"{units},{transfer}" for units, transfer in layers) + "\n")
            out.write(line("parameters", parameters))
            out.write(line("inputs", x))
            out.write(line("targets", targets))
            out.write(line("weights", weights))
            out.write(line("outputs", forward(inputs, layers, parameters.astype(complex), x).real))
            out.write(line("error", error(inputs, layers, parameters.astype(complex), x, targets, weights).real))
            out.write(line("gradient", gradient(inputs, layers, parameters, x, targets, weights)))


if __name__ == "__main__":
    main()
