# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What a build is made of: the packages of Debian and npm whose headers it compiled and whose libraries it linked, by
the build's own lists."""

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

ROOT = Path(__file__).resolve().parent.parent
# Those that packages are in: this machine's, and those that wheels are compiled for (packaging/wheels/prefix).
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
DEBIANS = (Path("/"), *sorted((CACHE / "dermis/wheels").glob("*")))


@dataclass(frozen=True)
class Component:
    name: str
    version: str
    license: str  # its text
    url: str  # as of https://github.com/package-url/purl-spec


def files_of(build, targets):
    """Those from outside of this folder that the targets were made of, with what links among them lead to."""

    def told(tool, *of):
        said = subprocess.run(["ninja", "-C", build, "-t", tool, *of], check=True, capture_output=True, text=True)
        return [line.strip() for line in said.stdout.splitlines()]

    inputs = told("inputs", *targets)
    headers = told("deps", *(name for name in inputs if name.endswith(".o")))
    names = {line for line in [*inputs, *headers] if line.startswith("/")}
    outside = {name for name in map(os.path.normpath, names) if not Path(name).is_relative_to(ROOT)}
    return outside | {os.path.realpath(name) for name in outside}


def debian_packages(files, root):
    """The sources of those of a Debian below `root`."""
    query = ["dpkg-query", f"--admindir={root / 'var/lib/dpkg'}"]
    names = sorted("/" + str(Path(name).relative_to(root)) for name in files if Path(name).is_relative_to(root))
    if not names:
        return []
    asked = subprocess.run([*query, "-S", *names], capture_output=True, text=True)
    if asked.returncode > 1:  # 1: one has no owner
        sys.exit(asked.stderr)
    owners = [owner for line in asked.stdout.splitlines() for owner in line.split(": ")[0].split(", ")]
    packages = sorted({owner.split(":")[0] for owner in owners})
    if not packages:
        return []
    show = ["-W", "-f", "${Package} ${source:Package} ${source:Version}\n", *packages]
    sources = {}
    for line in subprocess.run([*query, *show], check=True, capture_output=True, text=True).stdout.splitlines():
        package, name, version = line.split()
        text = (root / "usr/share/doc" / package / "copyright").read_text()
        sources[name] = Component(name, version, text, f"pkg:deb/debian/{name}@{quote(version, safe='')}?arch=source")
    return list(sources.values())


def npm_packages():
    """Those that the page has inside."""
    for place, package in json.loads((ROOT / "viewer/package-lock.json").read_text())["packages"].items():
        if not place or package.get("dev"):
            continue
        name, version = place.removeprefix("node_modules/"), package["version"]
        texts = sorted((ROOT / "viewer" / place).glob("[Ll][Ii][Cc][Ee][Nn][SsCc][Ee]*"))
        yield Component(name, version, "\n".join(map(Path.read_text, texts)), f"pkg:npm/{name}@{version}")


def components(build, targets):
    files = files_of(build, targets)
    return [*(part for root in DEBIANS for part in debian_packages(files, root)), *npm_packages()]
