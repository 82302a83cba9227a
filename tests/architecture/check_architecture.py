# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Holds the rules of ARCHITECTURE.md against the sources. Usage: check_architecture.py ROOT"""

import re
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from source_folders import ALL, PLUGINS

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
STANDARD_HEADER = re.compile(r"[a-z_]+")
OPTION_IN_A_TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*"')
# Counts to newtons needs nothing of the machine: it runs in another program, and as WebAssembly.
NOT_IN_TOUCH = re.compile(
    r"^\s*#\s*include\s*<(?:fstream|filesystem|mutex|thread|unistd\.h|(?:sys|fmt|toml\+\+|nlohmann)/[^>]+)>"
    r"|\b(?:throw|try|catch)\b"
)
SPDX = "// SPDX-License-Identifier: Apache-2.0\n// SPDX-FileCopyrightText: 2026 The dermis authors\n"


def table(text, columns):
    """Rows `| `name` | ... |` of so many columns: name -> the names in its last cell."""
    cells = r"[^|\n]*\|" * (columns - 2)
    rows = re.findall(rf"^\| `(\w+)` \|{cells}([^|\n]*)\|$", text, re.MULTILINE)
    return {name: set(re.findall(r"`(\w+)`", last)) for name, last in rows}


def section(text, heading):
    found = text.split(f"\n{heading}\n", 1)
    return re.split(r"^##", found[1], maxsplit=1, flags=re.MULTILINE)[0] if len(found) == 2 else ""


# What judges the others shares no formula with them.
JUDGE = ("learn", "simulation")
KNOWN_TO_THE_JUDGE = {("touch", "frames"), ("bytes", "files"), ("bytes", "bodies")}
KNOWN_TO_PLUGINS = ("touch/frames/", "bytes/system/")


class Rules:
    """The tables of ARCHITECTURE.md: which wing may include which and, in a wing, which room which."""

    def __init__(self, architecture):
        self.wings = table(section(architecture, "## Wings"), 3)
        self.rooms_of = {wing: table(section(architecture, f"### Rooms of `{wing}`"), 4) for wing in self.wings}

    def place(self, name):
        """(wing, room) of a path below src or include/dermis; None: no such wing; a wing without rooms is its own."""
        wing, *rest = name.split("/")
        if wing not in self.wings:
            return None
        return wing, rest[0] if self.rooms_of[wing] and len(rest) > 1 else wing

    def allows(self, here, there):
        if here == there:
            return True
        if here == JUDGE:
            return there in KNOWN_TO_THE_JUDGE
        if here[0] != there[0]:
            return there[0] in self.wings[here[0]]
        return there[1] in self.rooms_of[here[0]].get(here[1], ())


def included(path):
    """(name, is public) of the files of the project that a source includes."""
    for bracket, name in INCLUDE.findall(path.read_text()):
        if bracket == '"':
            yield name.removeprefix("dermis/"), name.startswith("dermis/")


def sources(root, rules):
    """(path, its place) of every C++ file of the wings."""
    for folder in ("include/dermis", "src"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            yield path, rules.place(path.relative_to(root / folder).as_posix())


def include_violations(root, rules):
    for path, here in sources(root, rules):
        shown = path.relative_to(root)
        if here is None or (rules.rooms_of[here[0]] and here[1] not in rules.rooms_of[here[0]]):
            yield f"{shown}: is in no wing and room of ARCHITECTURE.md"
            continue
        for name, is_public in included(path):
            there = rules.place(name)
            if there is None:
                continue
            if not rules.allows(here, there):
                yield f"{shown}: {here[1]} must not include {there[1]} ({name})"
            elif not is_public and there != here and not name.endswith("-inl.hpp"):
                yield f"{shown}: {name} is private to {there[1]}"


def app_violations(root, rules):
    """The command knows what is public, and kernels that are compiled anew for every instruction set."""
    for path in sorted((root / "apps").rglob("*.[ch]pp")):
        for name, is_public in included(path):
            if rules.place(name) and not is_public and not name.endswith("-inl.hpp"):
                yield f"{path.relative_to(root)}: {name} is private to {rules.place(name)[1]}"


def plugin_violations(root, rules):
    """A plugin knows its own headers, those of the room that loads it and of its rooms, and what all may know."""
    for plugin, home in PLUGINS.items():
        wing, _, room = home.partition("/")
        known = (*KNOWN_TO_PLUGINS, *(f"{wing}/{other}/" for other in rules.rooms_of.get(wing, {}).get(room, ())))
        for path in sorted((root / "plugins" / plugin).rglob("*.[ch]pp")):
            for name, is_public in included(path):
                is_its_own = name.startswith(f"{home}/") or (is_public and name.startswith(known))
                if rules.place(name) and not is_its_own:
                    yield f"{path.relative_to(root)}: a plugin of {home} must not include {name}"


def permission_violations(root, rules):
    """Each permission of the tables is used."""
    used = set()
    for path, here in sources(root, rules):
        for name, _ in included(path):
            there = rules.place(name)
            if here and there:
                used |= {(here[0], there[0]), (*here, there[1])}
    for wing, names in rules.wings.items():
        for name in sorted(names):
            if (wing, name) not in used:
                yield f"ARCHITECTURE.md: {wing} makes no use of {name}"
        for room, others in rules.rooms_of[wing].items():
            for name in sorted(others):
                if (wing, room, name) not in used:
                    yield f"ARCHITECTURE.md: {room} makes no use of {name}"


def order_violations(architecture, rules):
    """A wing may include those above it, a room and a folder likewise: so there is no circle."""
    folders = [table for _, table in folder_tables(architecture)]
    for rows in (rules.wings, *rules.rooms_of.values(), *folders):
        above = set()
        for name, others in rows.items():
            for other in sorted(others - above - {name}):
                yield f"ARCHITECTURE.md: {name} may include {other}, which is not above it"
            above.add(name)


def folder_tables(architecture):
    """Of each room with a heading "Folders of": folder -> folders whose private headers it may include."""
    for text in architecture.split("\n### Folders of `")[1:]:
        room = text.split("`", 1)[0]
        yield room, table(section(architecture, f"### Folders of `{room}`"), 3)


def folder_violations(root, architecture):
    for room, allowed in folder_tables(architecture):
        home = next((root / "src").glob(f"*/{room}"))
        prefix = home.relative_to(root / "src").as_posix() + "/"
        used = {folder: set() for folder in allowed}
        for path in sorted(home.glob("*/**/*.[ch]pp")):
            place, folder = path.relative_to(root), path.relative_to(home).parts[0]
            if folder not in allowed:
                yield f"{place}: the folder {folder} is not in the table of ARCHITECTURE.md"
                continue
            for name, is_public in included(path):
                other = name.removeprefix(prefix).split("/")
                if is_public or not name.startswith(prefix) or len(other) < 2 or other[0] == folder:
                    continue
                used[folder].add(other[0])
                if other[0] not in allowed[folder]:
                    yield f"{place}: the folder {folder} must not include {other[0]} ({name})"
        for folder, names in allowed.items():
            for name in sorted(names - used[folder]):
                yield f"ARCHITECTURE.md: {room}/{folder} makes no use of {name}"


def header_violations(root):
    include = root / "include"
    for path in sorted(include.rglob("*.hpp")):
        place = path.relative_to(root)
        text = path.read_text()
        if not text.startswith(SPDX + "#pragma once\n"):
            yield f"{place}: must begin with the two SPDX lines and #pragma once"
        for bracket, name in INCLUDE.findall(text):
            if bracket == "<" and not STANDARD_HEADER.fullmatch(name):
                yield f"{place}: a public header must not include <{name}>"
            if bracket == '"' and not name.startswith("dermis/"):
                yield f'{place}: a public header must not include the private "{name}"'
        header = path.relative_to(include / "dermis")
        test = root / "tests" / header.parent / f"{header.stem}_test.cpp"
        if not test.exists():
            yield f"{place}: needs the test file {test.relative_to(root)}"


def licence_violations(root):
    for folder in ALL:
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            if not path.read_text().startswith(SPDX):
                yield f"{path.relative_to(root)}: must begin with the two SPDX lines"


def message_violations(root):
    """An error of the library names a field (bad_field() of frames/result.hpp); the command knows its option."""
    for path in sorted((root / "src").rglob("*.[ch]pp")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if OPTION_IN_A_TEXT.search(line.split(" // ")[0]):
                yield f"{path.relative_to(root)}:{number}: a text of the library names an option of the command line"


def touch_violations(root):
    for folder in ("include/dermis/touch", "src/touch"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if found := NOT_IN_TOUCH.search(line.split("//")[0]):
                    yield f"{path.relative_to(root)}:{number}: touch stands alone, without {found.group().strip()}"


# Files that cannot take the version from CMakeLists.txt.
VERSIONS = {
    "CITATION.cff": r"^version: \"?([\d.]+)\"?$",
    "CHANGELOG.md": r"^## \[([\d.]+)\]",
    "bindings/ros/dermis_msgs/package.xml": r"<version>([\d.]+)</version>",
}


def version_violations(root):
    project = re.search(r"project\(dermis VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text()).group(1)
    for name, pattern in VERSIONS.items():
        found = re.search(pattern, (root / name).read_text(), re.MULTILINE)
        version = found.group(1) if found else "none"
        if version != project:
            yield f"{name}: says version {version}, CMakeLists.txt {project}"


def violations(root):
    architecture = (root / "ARCHITECTURE.md").read_text()
    rules = Rules(architecture)
    yield from include_violations(root, rules)
    yield from app_violations(root, rules)
    yield from plugin_violations(root, rules)
    yield from permission_violations(root, rules)
    yield from order_violations(architecture, rules)
    yield from folder_violations(root, architecture)
    yield from header_violations(root)
    yield from licence_violations(root)
    yield from message_violations(root)
    yield from touch_violations(root)
    yield from version_violations(root)


if __name__ == "__main__":
    found = list(violations(Path(sys.argv[1])))
    print("\n".join(found) if found else "all rules hold")
    sys.exit(1 if found else 0)
