#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Usage: wheels.py [PYTHON...]

Makes a wheel for each Python of 3.11 to 3.13 that this machine has, and the archive of the sources, in build/wheels.
Each wheel has its libraries inside: it runs where nothing but glibc 2.36 and the library of C++ is installed."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "bindings/python"))
import build_backend

ROOT = Path(__file__).resolve().parent.parent
WHEELS = ROOT / "build/wheels"
REQUIREMENTS = ROOT / "packaging/wheels/requirements.txt"
PLATFORM = "manylinux_2_36_x86_64"
PYTHONS = ("3.11", "3.12", "3.13")
# The platform lets a wheel expect these, but a server or a container has them not.
NOT_EVERYWHERE = {"libX11.so.6", "libXext.so.6", "libXrender.so.1", "libexpat.so.1", "libz.so.1"}
LIBRARY = re.compile(r"=> (/\S+)")


def has_headers(python):
    code = "import os, sysconfig; print(os.path.exists(sysconfig.get_path('include') + '/Python.h'))"
    return subprocess.run([python, "-c", code], capture_output=True, text=True).stdout.strip() == "True"


def found_pythons():
    """Those that pyenv has, else that of the path."""
    for version in PYTHONS:
        name = f"python{version}"
        places = [*Path.home().glob(f".pyenv/versions/{version}.*/bin/{name}"), Path("/usr/bin") / name]
        there = next((place for place in places if place.exists() and has_headers(place)), None)
        print(
            f"{name}: {there}"
            if there
            else f"{name}: is not here, or without its headers; there will be no wheel of it"
        )
        if there:
            yield there


def make_tools(venv):
    """The environment with what REQUIREMENTS names."""
    installed = venv / "requirements.txt"
    if installed.exists() and installed.read_text() == REQUIREMENTS.read_text():
        return venv
    subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", venv], check=True)
    subprocess.run([venv / "bin/pip", "install", "--quiet", "--requirement", REQUIREMENTS], check=True)
    installed.write_text(REQUIREMENTS.read_text())
    return venv


def expect_less(tools):
    """Takes NOT_EVERYWHERE from what auditwheel expects of a machine."""
    for policy in tools.glob("lib/python3*/site-packages/auditwheel/policy/manylinux-policy.json"):
        rules = json.loads(policy.read_text())
        for rule in rules:
            rule["lib_whitelist"] = [name for name in rule["lib_whitelist"] if name not in NOT_EVERYWHERE]
        policy.write_text(json.dumps(rules))


def licenses_of(package):
    """The copyright files of Debian for the libraries that the module and its plugin load."""
    loaded = subprocess.run(["ldd", *package.glob("*.so")], check=True, capture_output=True, text=True).stdout
    paths = {os.path.realpath(path) for path in LIBRARY.findall(loaded)}
    owners = subprocess.run(["dpkg-query", "-S", *paths], capture_output=True, text=True).stdout
    names = sorted({line.split(":")[0] for line in owners.splitlines()} - {"libc6"})
    texts = {name: Path("/usr/share/doc") / name / "copyright" for name in names}
    return {name: path.read_bytes() for name, path in texts.items() if path.exists()}


def repair(tools, wheel, folder):
    """Puts its libraries into a wheel, which gets the name of the platform. Returns its new path."""
    expect_less(tools)
    environment = {**os.environ, "PATH": f"{tools / 'bin'}:{os.environ['PATH']}"}
    command = [tools / "bin/auditwheel", "repair", "--plat", PLATFORM, "--only-plat", "--strip", "-w", folder, wheel]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"auditwheel: {done.stdout}{done.stderr}")
    (repaired,) = Path(folder).glob(wheel.name.split("-linux")[0] + f"-{PLATFORM}.whl")
    return repaired


def make_wheel(python, tools):
    raw = WHEELS / "raw"
    shutil.rmtree(raw, ignore_errors=True)
    raw.mkdir(parents=True)
    (packages,) = tools.glob("lib/python3*/site-packages")
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    build = (
        "import build_backend, wheels; package = build_backend.build_package(); "
        "print(build_backend.pack_wheel(package, 'build/wheels/raw', wheels.licenses_of(package)))"
    )
    environment = {
        **os.environ,
        "CMAKE_ARGS": " ".join(launcher),
        "PYTHONPATH": f"{ROOT / 'bindings/python'}:{ROOT / 'scripts'}:{packages}",
    }
    subprocess.run([python, "-c", build], cwd=ROOT, env=environment, check=True, stdout=sys.stderr)
    (wheel,) = raw.glob("*.whl")
    return repair(tools, wheel, WHEELS)


def main():
    WHEELS.mkdir(parents=True, exist_ok=True)
    tools = make_tools(WHEELS / "tools")
    made = [make_wheel(python, tools) for python in map(Path, sys.argv[1:] or found_pythons())]
    made.append(WHEELS / build_backend.build_sdist(WHEELS))
    shutil.rmtree(WHEELS / "raw", ignore_errors=True)
    for path in made:
        print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
