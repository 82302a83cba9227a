#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Writes perceptron_fit.csv: a 2-3-1 perceptron fitted to 40 noisy samples, with numpy alone.

The fit is a Gauss-Newton iteration on numpy.linalg.lstsq with a backtracking line search, without damping and without
normal equations: another algorithm than dermis' Levenberg-Marquardt, so both meet only at the minimum itself.
Run from any folder: generate_perceptron_fit.py  (numpy; the seed below decides every number)
"""

import pathlib

import numpy as np

SEED = 20260117
INPUTS, HIDDEN, SAMPLES = 2, 3, 40
PARAMETERS = HIDDEN * (INPUTS + 2) + 1 + INPUTS


def unpack(p):
    """For every hidden unit b, w0, w1; then c; then v; then s."""
    units = p[: HIDDEN * (INPUTS + 1)].reshape(HIDDEN, INPUTS + 1)
    c = p[HIDDEN * (INPUTS + 1)]
    v = p[HIDDEN * (INPUTS + 1) + 1 : HIDDEN * (INPUTS + 2) + 1]
    s = p[HIDDEN * (INPUTS + 2) + 1 :]
    return units[:, 0], units[:, 1:], c, v, s


def model(p, x):
    b, w, c, v, s = unpack(p)
    return c + x @ s + (1.0 / (1.0 + np.exp(-(b + x @ w.T)))) @ v


def jacobian(p, x):
    """Complex-step derivatives: exact to rounding, no formula shared with dermis."""
    columns = []
    for k in range(PARAMETERS):
        q = p.astype(complex)
        q[k] += 1e-30j
        columns.append(model(q, x).imag / 1e-30)
    return np.array(columns).T


def fit(p, x, y):
    error = 0.5 * np.sum((model(p, x) - y) ** 2)
    for _ in range(500):
        step = np.linalg.lstsq(jacobian(p, x), y - model(p, x), rcond=1e-12)[0]
        length = 1.0
        while length > 1e-8:
            trial = p + length * step
            trial_error = 0.5 * np.sum((model(trial, x) - y) ** 2)
            if trial_error < error:
                break
            length *= 0.5
        else:
            break
        p, error = trial, trial_error
    gradient = jacobian(p, x).T @ (model(p, x) - y)
    assert np.max(np.abs(gradient)) < 1e-9, gradient
    return p, error


def line(kind, values):
    return kind + "," + ",".join(repr(float(value)) for value in values) + "\n"


def main():
    random = np.random.default_rng(SEED)
    truth = np.array([0.5, 2.0, -1.0, -1.5, -1.0, 2.5, 0.3, 1.5, 1.5, 0.2, 2.0, -1.5, 1.0, 0.4, -0.3])
    x = random.uniform(-2.0, 2.0, (SAMPLES, INPUTS))
    y = model(truth, x) + 0.02 * random.standard_normal(SAMPLES)
    start = truth + 0.15 * random.standard_normal(PARAMETERS)
    fitted, error = fit(start, x, y)
    path = pathlib.Path(__file__).with_name("perceptron_fit.csv")
    with path.open("w", encoding="ascii") as out:
        out.write(f"# written by {pathlib.Path(__file__).name}, seed {SEED}, numpy {np.__version__}; do not edit\n")
        out.write("# start: parameters; error: half the sum of squares; sample: x0, x1, y, prediction of the fit\n")
        out.write(line("start", start))
        out.write(line("error", [error]))
        for row, target, prediction in zip(x, y, model(fitted, x)):
            out.write(line("sample", [*row, target, prediction]))


if __name__ == "__main__":
    main()
