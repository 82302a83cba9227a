#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Usage: wheels.py [ARCHITECTURE...]

Makes one wheel for each architecture, with a module for each Python of 3.9 to 3.14 that has headers here, and the
archive of the sources, in build/wheels. A wheel has its libraries inside: it runs where only glibc 2.31 is."""

import subprocess
import sys

import components

sys.path.append(str(components.ROOT / "bindings/python"))
import build_backend

ROOT = components.ROOT

WHEELS = ROOT / "build/wheels"
TOOLS = ROOT / "packaging/wheels"
REQUIREMENTS = TOOLS / "requirements.txt"
ARCHITECTURES = ("x86_64", "aarch64")
GLIBC = "2_31"
TARGETS = ("dermis_cli", "dermis_python")


def find_headers():
    """Minor version -> folder."""
    found = {}
    for minor in build_backend.MINORS:
        tried = subprocess.run([TOOLS / "python_headers", str(minor)], stdout=subprocess.PIPE, text=True)
        if tried.returncode == 0:
            found[minor] = tried.stdout.strip()
        else:
            print(f"Python 3.{minor}: no headers; the wheels are not for it", file=sys.stderr)
    return found


def add_tools():
    """Puts what REQUIREMENTS names before the packages of this Python."""
    venv = WHEELS / "tools"
    installed = venv / "requirements.txt"
    if not (installed.exists() and installed.read_text() == REQUIREMENTS.read_text()):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", venv], check=True)
        subprocess.run([venv / "bin/pip", "install", "--quiet", "--requirement", REQUIREMENTS], check=True)
        installed.write_text(REQUIREMENTS.read_text())
    sys.path[:0] = map(str, venv.glob("lib/python3*/site-packages"))


def make_wheel(architecture, headers):
    """Returns its path."""
    subprocess.run([TOOLS / "prefix", architecture], check=True, stdout=sys.stderr)
    folder = ROOT / f"build/wheel_{architecture}"
    options = (
        f"CMAKE_TOOLCHAIN_FILE={TOOLS / 'toolchain.cmake'}",
        f"DERMIS_WHEEL_ARCH={architecture}",
        "DERMIS_BUILD_MODBUS=ON",
    )
    contents = build_backend.build(folder, headers.values(), *(f"-D{option}" for option in options))
    licenses = {part.name: part.license.encode() for part in components.components(folder, TARGETS)}
    tag = f"py3-none-manylinux_{GLIBC}_{architecture}"
    return WHEELS / build_backend.pack_wheel(contents, WHEELS, tag, licenses, build_backend.pythons_of(headers))


def main():
    WHEELS.mkdir(parents=True, exist_ok=True)
    for old in WHEELS.glob("dermis-*"):
        old.unlink()
    add_tools()
    headers = find_headers()
    made = [make_wheel(architecture, headers) for architecture in sys.argv[1:] or ARCHITECTURES]
    made.append(WHEELS / build_backend.build_sdist(WHEELS))
    for path in made:
        print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
