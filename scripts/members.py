#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Lists the classes with more than 15 data members, the most first. Usage: scripts/members.py [MOST]

A class may have more if the comment above it says why, after the words "Many members:". Exit status 1 if one does not.
Static members do not count, nor do those of base classes. Exit status 77 where there is no universal-ctags."""

import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

from source_folders import PRODUCTION

ROOT = Path(__file__).resolve().parent.parent
MOST = 15
STATIC = re.compile(r"\bstatic\b")
SKIPPED = 77


def has_ctags():
    try:
        return (
            "Universal Ctags"
            in subprocess.run(["ctags", "--version"], check=False, capture_output=True, text=True).stdout
        )
    except FileNotFoundError:
        return False


def members(root):
    """(file, class) of every data member that is not static."""
    sources = [
        str(path.relative_to(root)) for folder in PRODUCTION for path in sorted((root / folder).rglob("*.[ch]pp"))
    ]
    command = ["ctags", "--output-format=json", "--c++-kinds=m", "--map-c++=+.hpp", "--fields=+s", "-f", "-", *sources]
    for line in subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout.splitlines():
        tag = json.loads(line)
        if not STATIC.search(tag["pattern"].split(tag["name"])[0]):
            yield tag["path"], tag["scope"]


def reason(path, name):
    """What the comment above the class in this file says, or None."""
    own = re.escape(name.split("::")[-1])
    head = re.compile(r"((?:^ *///[^\n]*\n)+) *(?:struct|class) (?:\w+::)*" + own + r"\b[^;{]*\{", re.MULTILINE)
    found = head.search(path.read_text())
    told = re.search(r"Many members: ((?:.|\n)+?\.)\n", found.group(1)) if found else None
    return " ".join(told.group(1).replace("///", " ").split()) if told else None


def large_classes(root, most):
    """(members, class, file, reason or None), the most first; and how many classes there are."""
    counts = Counter(members(root))
    large = [
        (count, name, path, reason(root / path, name)) for (path, name), count in counts.most_common() if count > most
    ]
    return large, len(counts)


def main():
    if not has_ctags():
        print("needs universal-ctags")
        return SKIPPED
    most = int(sys.argv[1]) if len(sys.argv) > 1 else MOST
    large, classes = large_classes(ROOT, most)
    for count, name, path, why in large:
        print(f"{count:4d} {name} ({path}): {why or 'NO REASON'}")
    unexplained = sum(why is None for *_, why in large)
    print(f"{len(large)} of {classes} classes have more than {most} data members, {unexplained} without a reason")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
