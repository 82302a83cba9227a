# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What cyclone_hand.c and modbus_hand.c send, and how a table of frames is read."""

import numpy as np

REGIONS = [(f"{finger}_{part}", *shape) for finger in ("little", "ring", "middle", "index")
           for part, shape in (("tip", (3, 3)), ("top", (12, 8)), ("palm", (10, 8)))]  # fmt: skip
REGIONS += [("thumb_tip", 3, 3), ("thumb_top", 12, 8), ("thumb_middle", 3, 3), ("thumb_palm", 12, 8), ("palm", 14, 8)]
FIRST = dict(zip((name for name, _, _ in REGIONS), np.cumsum([0] + [r * c for _, r, c in REGIONS]), strict=False))


def table_of(path):
    """Readings and temperatures of sensors in a frames.csv, a line a frame."""
    with open(path) as file:
        names = file.readline().strip().split(",")
    values = np.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2)
    taxels = [k for k, name in enumerate(names) if name[0] == "r" and name[1].isdigit()]
    sensors = [k for k, name in enumerate(names) if name.startswith("sensor")]
    return values[:, taxels], values[:, sensors]


def module_sent(k, m, messages):
    """Readings and temperatures that cyclone_hand sends."""
    n = np.arange(messages)[:, None]
    t = np.arange(12)
    pressures = (100000 + 1000 * k + 100 * m + t + 16 * (n % 5000)).astype(float)
    sensors = 20 + k + m / 2 + t / 16 + (n % 64) / 8
    if m == 8:
        pressures[:, 11] = sensors[:, 11] = np.nan
    return pressures, sensors


def touch_sent(seed, first, taxels, answers):
    return (1000 * seed + 7 * (first + np.arange(taxels)) + 13 * answers[:, None]) % 4096


def numbers_of(seed, first, readings):
    """Numbers of the answers that these are, modulo 4096, by their first taxel."""
    return (readings[:, 0] - 1000 * seed - 7 * first) * pow(13, -1, 4096) % 4096
