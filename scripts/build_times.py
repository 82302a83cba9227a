# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What a build and its tests took: python3 scripts/build_times.py build/release

Prints the seconds that compilers and linkers ran, by folder, and those of the slowest tests. Two run side by side on
two cores, so the sums are about twice what a clock shows."""

import sys
from collections import Counter
from pathlib import Path

MOST = 8


def build_seconds(tree: Path) -> Counter:
    """By folder; a file that was built twice counts as the last time."""
    seconds = {}
    for line in (tree / ".ninja_log").read_text().splitlines()[1:]:
        start, end, _, target, _ = line.split("\t")
        seconds[target] = (int(end) - int(start)) / 1000
    folders = Counter()
    for target, took in seconds.items():
        parts = target.split("/")
        folders["/".join(parts[:2]) if parts[0] == "src" else parts[0]] += took
    return folders


def test_seconds(tree: Path) -> Counter:
    rows = [line.split() for line in (tree / "Testing/Temporary/CTestCostData.txt").read_text().splitlines()]
    return Counter({row[0]: float(row[2]) for row in rows if len(row) == 3})


def main() -> None:
    tree = Path(sys.argv[1])
    for what, seconds in (("built", build_seconds(tree)), ("tested", test_seconds(tree))):
        shares = ", ".join(f"{name} {took:.0f}" for name, took in seconds.most_common(MOST))
        print(f"    {what} in {sum(seconds.values()):.0f} s of both cores: {shares}")


if __name__ == "__main__":
    main()
