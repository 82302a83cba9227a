# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Forces of a live array in the terminal, without further packages.

Usage: live_view.py sim:contacts?rate=100 chest.safetensors
"""

import argparse
import contextlib
import time

import dermis

SHADES = " .:-=+*#%@"
FULL_SCALE_N = 20.0


def show(force: dermis.ForceFrame, contacts: list[dermis.Contact]) -> None:
    shades = (force.newtons / FULL_SCALE_N * len(SHADES)).clip(0, len(SHADES) - 1)
    rows = ["".join(2 * SHADES[int(shade)] if shade == shade else "??" for shade in row) for row in shades]
    touches = [f"{contact.id}: {contact.force_n:.1f} N" for contact in contacts]
    print("\033[H\033[J" + "\n".join(rows + touches), flush=True)


def main(uri: str, model_path: str, seconds: float = float("inf")) -> None:
    model = dermis.read_model(model_path)
    pipeline, tracker = dermis.Pipeline(model), dermis.ContactTracker(model)
    end = time.monotonic() + seconds
    next_picture = 0.0
    with dermis.open(uri, model.array) as source:
        for raw in source:
            force = pipeline.process(raw)
            contacts = tracker.process(force)
            if time.monotonic() >= next_picture:
                show(force, contacts)
                next_picture = time.monotonic() + 0.05
            if time.monotonic() >= end:
                break


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("uri", help="of a device, the simulator or a recording")
    parser.add_argument("model", help="model file of dermis calibrate")
    parser.add_argument(
        "seconds", type=float, nargs="?", default=float("inf"), help="how long; without it until Ctrl-C"
    )
    options = parser.parse_args()
    with contextlib.suppress(KeyboardInterrupt):
        main(options.uri, options.model, options.seconds)
