#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Every header compiles alone, and twice: check_headers.py [--all] COMPILER BINARY_INCLUDES

A unity build hides the include that a private header lacks, and so does scripts/tidy.

Without --all, those that have changed since the merge base with origin/main; where there is no such branch, since the
last commit of twelve hours ago; where git knows neither, all."""

import concurrent.futures
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from source_folders import PRODUCTION

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (ROOT / "include", ROOT / "src", ROOT / "apps/dermis")
LIBRARIES = ("/usr/include/eigen3", "/usr/include/hdf5/serial", "/usr/include/cairo", sysconfig.get_path("include"))
ALONE = ROOT / "build/headers"
# What has compiled before is found by ccache, in every clone.
ENVIRONMENT = {**os.environ, "CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1"}
FLAGS = [
    "-fvisibility=hidden",
    "-std=c++20",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Werror",
    "-c",
]


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True).stdout.strip()


def changed_since_base():
    """Paths below the project; None where there is nothing to compare with."""
    base = git("merge-base", "HEAD", "origin/main") or git("rev-list", "-1", "--before=12 hours ago", "HEAD")
    return git("diff", "--name-only", base, "--", *PRODUCTION).splitlines() if base else None


def errors_of(header, compiler, folders):
    """Asio 1.74 needs <utility> before it."""
    source = ALONE / header.relative_to(ROOT).with_suffix(".cpp")
    source.parent.mkdir(parents=True, exist_ok=True)
    source.write_text("#include <utility>\n" + f'#include "{os.path.relpath(header, source.parent)}"\n' * 2)
    options = [*(f"-I{folder}" for folder in folders), *(f"-isystem{folder}" for folder in LIBRARIES)]
    command = ["ccache", compiler, *options, *FLAGS, source, "-o", source.with_suffix(".o")]
    result = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)
    return result.stderr if result.returncode else ""


def main():
    arguments = sys.argv[1:]
    changed = None if "--all" in arguments else changed_since_base()
    compiler, *folders = [argument for argument in arguments if argument != "--all"]
    headers = sorted(
        path
        for place in PRODUCTION
        for path in (ROOT / place).rglob("*.hpp")
        if changed is None or str(path.relative_to(ROOT)) in changed
    )
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = [
            error
            for error in pool.map(lambda header: errors_of(header, compiler, [*FOLDERS, *folders]), headers)
            if error
        ]
    print(*errors, f"{len(headers)} headers compiled alone, {len(errors)} do not", sep="\n")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
