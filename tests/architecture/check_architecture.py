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
SPDX = "// SPDX-License-Identifier: Apache-2.0\n// SPDX-FileCopyrightText: 2026 The dermis authors\n"


def allowed_includes(architecture):
    """The dependency table: rows `| module | may include |` below the heading "Dependencies"."""
    section = architecture.split("\n## Dependencies\n", 1)[1].split("\n## ", 1)[0]
    rows = re.findall(r"^\| `(\w+)` \|([^|]*)\|$", section, re.MULTILINE)
    return {module: {module} | set(re.findall(r"`(\w+)`", cell)) for module, cell in rows}


def folder_tables(architecture):
    """Of each module with a heading "Folders of": folder -> folders whose private headers it may include."""
    for section in architecture.split("\n### Folders of `")[1:]:
        module, text = section.split("`", 1)
        rows = re.findall(r"^\| `(\w+)` \|[^|]*\|([^|]*)\|$", text.split("\n## ", 1)[0], re.MULTILINE)
        yield module, {folder: {folder} | set(re.findall(r"`(\w+)`", cell)) for folder, cell in rows}


def sources(root):
    """(path, module) of every C++ file that the table is about; apps count as the module `apps`."""
    for folder in ("include/dermis", "src"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            yield path, path.relative_to(root / folder).parts[0]
    for path in sorted((root / "apps").rglob("*.[ch]pp")):
        yield path, "apps"


def is_shared(name, modules):
    """Kernels that are compiled anew for every instruction set cannot be public headers."""
    return name.endswith("-inl.hpp") and name.split("/")[0] in modules


def include_violations(root, allowed):
    for path, module in sources(root):
        place = path.relative_to(root)
        if module not in allowed:
            yield f"{place}: the module {module} is not in the table of ARCHITECTURE.md"
            continue
        for bracket, name in INCLUDE.findall(path.read_text()):
            parts = name.split("/")
            if parts[0] == "dermis" and len(parts) == 3:
                if parts[1] not in allowed[module]:
                    yield f"{place}: {module} must not include {parts[1]} ({name})"
            elif bracket == '"' and parts[0] in allowed and parts[0] != module and not is_shared(name, allowed[module]):
                yield f"{place}: {name} is private to the module {parts[0]}"


def plugin_violations(root):
    """A plugin knows its own headers, those of the module that loads it, and public ones of core."""
    for plugin, home in PLUGINS.items():
        for path in sorted((root / plugin).rglob("*.[ch]pp")):
            for _, name in INCLUDE.findall(path.read_text()):
                parts = name.split("/")
                is_public_of_others = parts[0] == "dermis" and parts[1] not in ("core", home)
                is_private_of_others = (root / "src" / parts[0]).is_dir() and parts[0] != home
                if is_public_of_others or is_private_of_others:
                    yield f"{path.relative_to(root)}: a plugin of {home} must not include {name}"


def folder_violations(root, architecture):
    for module, allowed in folder_tables(architecture):
        home = root / "src" / module
        used = {folder: {folder} for folder in allowed}
        for path in sorted(home.glob("*/**/*.[ch]pp")):
            place, folder = path.relative_to(root), path.relative_to(home).parts[0]
            if folder not in allowed:
                yield f"{place}: the folder {folder} is not in the table of ARCHITECTURE.md"
                continue
            for _, name in INCLUDE.findall(path.read_text()):
                parts = name.split("/")
                if parts[0] != module or len(parts) < 3:
                    continue
                used[folder].add(parts[1])
                if parts[1] not in allowed[folder]:
                    yield f"{place}: the folder {folder} must not include {parts[1]} ({name})"
        for folder, names in allowed.items():
            for name in sorted(names - used[folder]):
                yield f"ARCHITECTURE.md: {module}/{folder} makes no use of {name}"


def folder_order_violations(architecture):
    """A folder may include those above it, so there is no circle."""
    for module, allowed in folder_tables(architecture):
        folders = list(allowed)
        for place, folder in enumerate(folders):
            for name in sorted(allowed[folder] - set(folders[: place + 1])):
                yield f"ARCHITECTURE.md: {module}/{folder} may include {name}, which is not above it"


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
    """An error of the library names a field (bad_field() of core/result.hpp); the command knows its option."""
    for path in sorted((root / "src").rglob("*.[ch]pp")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if OPTION_IN_A_TEXT.search(line.split(" // ")[0]):
                yield f"{path.relative_to(root)}:{number}: a text of the library names an option of the command line"


def permission_violations(root, allowed):
    """Each permission of the table is used; a module may be linked for others to have it."""
    used = {module: {module} for module in allowed}
    for path, module in sources(root):
        used.get(module, set()).update(
            name.split("/")[1] if name.startswith("dermis/") else name.split("/")[0]
            for _, name in INCLUDE.findall(path.read_text())
            if "/" in name
        )
    for module, names in sorted(allowed.items()):
        for name in sorted(names - used[module]):
            yield f"ARCHITECTURE.md: {module} makes no use of {name}"


def version_violations(root):
    project = re.search(r"project\(dermis VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text()).group(1)
    for name, pattern in (("CITATION.cff", r"^version: \"?([\d.]+)\"?$"), ("CHANGELOG.md", r"^## \[([\d.]+)\]")):
        found = re.search(pattern, (root / name).read_text(), re.MULTILINE)
        version = found.group(1) if found else "none"
        if version != project:
            yield f"{name}: says version {version}, CMakeLists.txt {project}"


def violations(root):
    architecture = (root / "ARCHITECTURE.md").read_text()
    allowed = allowed_includes(architecture)
    yield from include_violations(root, allowed)
    yield from plugin_violations(root)
    yield from folder_violations(root, architecture)
    yield from folder_order_violations(architecture)
    yield from header_violations(root)
    yield from licence_violations(root)
    yield from message_violations(root)
    yield from permission_violations(root, allowed)
    yield from version_violations(root)


if __name__ == "__main__":
    found = list(violations(Path(sys.argv[1])))
    print("\n".join(found) if found else "all rules hold")
    sys.exit(1 if found else 0)
