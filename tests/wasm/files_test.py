# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A program uses files in a page as it does here: the same bytes and words. Usage: files_test.py DERMIS USE_FILES"""

import filecmp
import sys
import tempfile
from pathlib import Path

from wasm_test import HERE, PROJECT, build, node, run

ARRAY = PROJECT / "examples/chest/array.toml"


def make_inputs(dermis, folder):
    folder.mkdir()
    (folder / "array.toml").write_bytes(ARRAY.read_bytes())
    run([dermis, "simulate", "--array", ARRAY, "--scene", "calibration", "--out", folder / "sheet"])
    tables = ["--frames", folder / "sheet/frames.csv", "--loads", folder / "sheet/loads.csv"]
    run([dermis, "calibrate", "--array", ARRAY, *tables, "--out", folder / "sheet.model"])


def copied(inputs, folder):
    folder.mkdir()
    for name in ("array.toml", "sheet.model"):
        (folder / name).write_bytes((inputs / name).read_bytes())
    return folder


def files_of(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


def main():
    dermis, use_files = map(Path, sys.argv[1:])
    in_node = [*node()[:-1], HERE / "run_in_page.mjs"]
    program = build("use_files") / "use_files.wasm"
    with tempfile.TemporaryDirectory() as temporary:
        make_inputs(dermis, Path(temporary, "inputs"))
        here, there = (copied(Path(temporary, "inputs"), Path(temporary, name)) for name in ("here", "there"))
        run([use_files], cwd=here)
        run([*in_node, program, there])
        files = files_of(here)
        assert files == files_of(there), f"{files}\n{files_of(there)}"
        told = [(folder / "told.txt").read_text().splitlines() for folder in (here, there)]
        for number, (one, other) in enumerate(zip(*told, strict=True)):
            assert one == other, f"line {number}: {one!r} here, {other!r} in the page"
        for file in files:
            assert filecmp.cmp(here / file, there / file, shallow=False), f"{file}: other bytes"
        assert filecmp.cmp(here / "out/sheet.model", Path(temporary, "inputs/sheet.model"), shallow=False)
    print(f"{len(told[0])} lines of answers and {len(files)} files: the same")


if __name__ == "__main__":
    main()
