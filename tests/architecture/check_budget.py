#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Holds the house to tests/architecture/budget.toml: lines of each wing, of a file, of a function, words of a document,
and commands.

Usage: check_budget.py PROJECT [DERMIS]
Exit status 77 where there is no universal-ctags."""

import json
import re
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path

ENDINGS = {".cpp", ".hpp", ".c", ".h", ".py", ".pyi", ".ts", ".css", ".html"}
FOLDERS = ("include", "src", "apps", "bindings", "plugins", "viewer/src")
KINDS = ["--kinds-C++=f", "--kinds-C=f", "--kinds-Python=fm", "--kinds-TypeScript=fm"]
COMMAND = re.compile(r"^  (\w+) {3,}", re.MULTILINE)
SKIPPED = 77


def wing_of(path):
    """Wings are the folders below src and include/dermis; what stands beside them is of touch."""
    parts = path.parts
    if parts[0] not in ("include", "src"):
        return parts[0]
    inner = parts[2:] if parts[0] == "include" else parts[1:]
    return inner[0] if len(inner) > 1 else "touch"


def sources_of(project):
    listed = subprocess.run(
        ["git", "-C", project, "ls-files", "--cached", "--others", "--exclude-standard", *FOLDERS],
        check=True,
        capture_output=True,
        text=True,
    ).stdout.splitlines()
    return [Path(path) for path in listed if Path(path).suffix in ENDINGS and (project / path).is_file()]


def line_counts(project, sources):
    return {path: len((project / path).read_bytes().splitlines()) for path in sources}


def functions(project, sources):
    """(path, name, lines) of each that has a name."""
    tags = subprocess.run(
        ["ctags", "--fields=+ne", "--output-format=json", *KINDS, "-L", "-", "-f", "-"],
        cwd=project,
        input="\n".join(map(str, sources)),
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    for tag in map(json.loads, tags.splitlines()):
        if "end" in tag and not tag["name"].startswith("__anon"):
            yield tag["path"], tag["name"], tag["end"] - tag["line"] + 1


def commands_of(dermis):
    text = subprocess.run([dermis, "--help"], check=True, capture_output=True, text=True).stdout
    return COMMAND.findall(text.split("--version", 1)[1])


def too_wordy(project, most, longer):
    pages = [project / "README.md", *(project / "docs").rglob("*.md")]
    for page in pages:
        words = len(page.read_text().split())
        limit = most["words_of_the_readme" if page == pages[0] else "words_a_document"]
        path = str(page.relative_to(project))
        if words > limit and longer.pop(path, None) is None:
            yield f"{path}: has {words} words, at most {limit}: reasons and measurements go to docs/reasons"


def too_much(project, budget, dermis):
    """Yields a line for each that is over the budget, and for each exception that nobody needs."""
    sources = sources_of(project)
    counts = line_counts(project, sources)
    most, longer = budget["most"], dict(budget["longer"])
    wings = Counter()
    for path, lines in counts.items():
        wings[wing_of(path)] += lines
        if lines > most["lines_a_file"] and longer.pop(str(path), None) is None:
            yield f"{path}: has {lines} lines, at most {most['lines_a_file']}"
    for wing in wings.keys() | budget["lines"].keys():
        if wings[wing] > budget["lines"].get(wing, 0):
            yield f"{wing}: has {wings[wing]} lines, at most {budget['lines'].get(wing, 0)}"
    for path, name, lines in functions(project, sources):
        if lines > most["lines_a_function"] and longer.pop(f"{path} {name}", None) is None:
            yield f"{path}: {name} has {lines} lines, at most {most['lines_a_function']}"
    yield from too_wordy(project, most, longer)
    if dermis and len(commands_of(dermis)) > most["commands"]:
        yield f"{len(commands_of(dermis))} commands, at most {most['commands']}"
    for place in longer:
        yield f"{place}: is no longer too long; take it out of budget.toml"


def main():
    project = Path(sys.argv[1]).resolve()
    version = subprocess.run(["ctags", "--version"], check=False, capture_output=True, text=True).stdout
    if "Universal Ctags" not in version:
        return SKIPPED
    budget = tomllib.loads((project / "tests/architecture/budget.toml").read_text())
    over = sorted(too_much(project, budget, sys.argv[2] if len(sys.argv) > 2 else None))
    print(*over, sep="\n")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
