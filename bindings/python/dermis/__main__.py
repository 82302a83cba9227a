# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""`python -m dermis` is the command `dermis` that was installed with this package."""

import os
import sys
from pathlib import Path

# Folders above this file that have bin/dermis: of pip --target, of a build, of a Python or a virtual environment.
ABOVE = (1, 2, 4)


def command():
    folders = enumerate(Path(__file__).absolute().parents)
    places = [folder / "bin/dermis" for above, folder in folders if above in ABOVE]
    there = next((place for place in places if os.access(place, os.X_OK)), None)
    return there or sys.exit(f"dermis: {places[-1]} is not there: install the command, too")


if __name__ == "__main__":
    os.execv(command(), ["dermis", *sys.argv[1:]])
