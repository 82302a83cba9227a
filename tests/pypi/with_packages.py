# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Runs a test with the packages of tests/requirements.txt, which Debian lacks. Usage: with_packages.py VENV [TEST
ARGUMENT...]

Without a test it makes their virtual environment, where that is not there. Where PyPI cannot be reached it says so, and
each of the tests says that it is skipped."""

import os
import subprocess
import sys
from pathlib import Path

REQUIREMENTS = Path(__file__).resolve().parent.parent / "requirements.txt"
NO_ANSWER = "Retrying ("  # what pip says of an index that cannot be reached


def is_made(venv):
    installed = venv / "requirements.txt"
    return installed.exists() and installed.read_text() == REQUIREMENTS.read_text()


def make(venv):
    subprocess.run([sys.executable, "-m", "venv", "--clear", venv], check=True)
    install = [
        venv / "bin/pip",
        "install",
        "--quiet",
        "--retries",
        "1",
        "--timeout",
        "15",
        "--requirement",
        REQUIREMENTS,
    ]
    pip = subprocess.run(install, capture_output=True, text=True)
    if pip.returncode != 0:
        sys.exit(f"{'skipped: PyPI cannot be reached' if NO_ANSWER in pip.stderr else 'pip fails'}\n{pip.stderr}")
    (venv / "requirements.txt").write_text(REQUIREMENTS.read_text())


def main():
    venv, test = Path(sys.argv[1]), sys.argv[2:]
    if test and not is_made(venv):
        sys.exit("skipped: the packages of tests/requirements.txt are not there")
    if test:
        python = venv / "bin/python"
        os.execv(python, [python, *test])
    if not is_made(venv):
        make(venv)


if __name__ == "__main__":
    main()
