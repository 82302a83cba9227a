# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Holds the groups of scripts/setup against what is used. Usage: check_packages.py ROOT

A target of the Makefile installs groups, and reaches the files that its recipe names, and those which these name.
What they need is in one of its groups. What they can do without is in any group. Nothing is installed for nobody."""

import functools
import re
import sys
from collections import defaultdict
from pathlib import Path

# Packages, and the names of what they bring: for cmake to find, commands, modules of Python.
BRINGS = {
    "autoconf": "autoreconf",
    "ninja-build": "ninja",
    "python3": "Python3 python3",
    "cmake": "cmake ctest",
    "ccache": "ccache",
    "nodejs": "node",
    "npm": "npm",
    "build-essential": "c++ cc nm objdump dpkg-architecture dpkg-buildpackage",
    "pkg-config": "PkgConfig",
    "libeigen3-dev": "Eigen3",
    "libhwy-dev": "HWY",
    "libtomlplusplus-dev": "tomlplusplus",
    "libcli11-dev": "CLI11",
    "libfmt-dev": "fmt",
    "nlohmann-json3-dev": "nlohmann_json",
    "libboost-dev": "Boost",
    "liblz4-dev": "liblz4",
    "libzstd-dev": "libzstd",
    "zlib1g-dev": "ZLIB",
    "libdeflate-dev": "libdeflate",
    "libbz2-dev": "BZip2",
    "libzip-dev": "libzip",
    "libexpat1-dev": "EXPAT",
    "libpng-dev": "PNG",
    "libgif-dev": "GIF",
    "libcairo2-dev": "cairo",
    "libhdf5-dev": "hdf5-serial",
    "pybind11-dev": "pybind11",
    "libfastrtps-dev": "fastrtps",
    "libmodbus-dev": "libmodbus",
    "libnats-dev": "libnats",
    "libssl-dev": "libcrypto",
    "nats-server": "nats-server",
    "iproute2": "ip tc",
    "parallel": "parallel",
    "python3-numpy": "numpy",
    "libgtest-dev": "GTest",
    "libbenchmark-dev": "benchmark",
    "ngspice": "ngspice",
    "python3-h5py": "h5py",
    "abigail-tools": "abidiff",
    "chromium": "chromium",
    "cyclonedds-dev": "CycloneDDS",
    "cyclonedds-tools": "idlc",
    "libopenmpi-dev": "MPI",
    "openmpi-bin": "mpirun",
    "universal-ctags": "ctags",
    "ament-cmake": "ament_cmake",
    "colcon": "colcon",
    "rosidl-generator-c-cpp": "rosidl_generator_cpp",
    "clang-format-16": "clang-format-16",
    "clang-tidy-16": "clang-tidy-16",
    "llvm-16": "llvm-cov-16 llvm-profdata-16",
    "libtorch-dev": "torch torch_cpu c10 torch/csrc/api/include/torch/torch.h",
    "libfann-dev": "floatfann floatfann.h",
    "libopenblas-dev": "openblas openblas_config.h",
    "lintian": "lintian",
    "linux-perf": "perf",
    "mmdebstrap": "mmdebstrap",
    "debhelper": "dh dh_compress dh_installsystemd dh_shlibdeps dh_strip",
    "systemd": "systemd-analyze",
    "systemd-container": "systemd-nspawn",
    "groff-base": "groff",
    "mandoc": "mandoc",
    "zsh": "zsh",
    "mkdocs": "mkdocs",
    "doxygen": "doxygen",
}
PACKAGE_OF = {name: package for package, names in BRINGS.items() for name in names.split()}
# What has no name of its own: a text, and the packages that are needed where it stands.
TRACES = {
    "LANGUAGES CXX": "build-essential",
    "Interpreter Development.Module": "python3-dev",
    "npm ci": "ca-certificates",
    "cmake --preset": "ninja-build",
    "cmake --preset asan": "clang-16 libclang-rt-16-dev",
    "cmake --preset lint": "cyclonedds-dev cyclonedds-tools",
    "cmake --preset browser": "clang-16 llvm-16 lld-16 wasi-libc libc++-16-dev-wasm32 libc++abi-16-dev-wasm32"
    " libclang-rt-16-dev-wasm32",
    "#include <clang/": "libclang-16-dev llvm-16-dev",
    '"mypy.stubtest"': "mypy",
    '"-m", "venv"': "python3-venv",
    "python3 -m venv": "python3-venv",
    "dh $@ --with python3": "dh-python",
    '"name": "material"': "mkdocs-material",
    "--target dermis_python": "python3-numpy",
    "dermis_fast_dds dermis_open_mpi": "libopenmpi-dev",
    '"colcon", "build"': "python3-colcon-cmake python3-colcon-ros",
    '"--oversubscribe"': "libopenmpi-dev openmpi-bin",
    "#!/usr/bin/python3": "python3",
    '"--zstd"': "zstd",
    "$triplet-$language-12": "g++-12-aarch64-linux-gnu",
    "qemu-$arch-static": "qemu-user-static",
    "autoreconf --install": "automake libtool",
    "build/release/tests/": "libgtest-dev libbenchmark-dev",
}
# What a bare Debian has, with make, git and sudo, and what bash is made of.
BARE = set(
    """apt-cache apt-config apt-get bash case cat cd chmod cksum cmp command compgen cp cut date declare dirname do
done dpkg dpkg-deb dpkg-query echo elif else env esac exec exit export fi find flock for git grep gzip id if install
ldd ln local ls make mapfile mkdir mktemp mount mv nproc printf readlink realpath return rm sed set sh sha256sum
shift sort sudo tail tar then touch tr trap umount uname wait while xargs""".split()
)
# Our own package and what makes its wheel, what ROS 2 brings to a launch file, what an example asks of PyPI, and what
# tests/requirements.txt names.
MODULES_OF_OTHERS = {
    "bleak",
    "build_backend",
    "datasets",
    "dermis",
    "launch",
    "lerobot",
    "mcap",
    "mcap_ros2",
    "pandas",
    "mujoco",
    "pyarrow",
    "ray",
    "rosbags",
    "safetensors",
    "torch",
    "zarr",
}

FOLDERS = ("scripts", ".ci", "tests", "packaging", "examples", "viewer")
# Projects of others, what is built, and this table.
LEFT_OUT = (
    "tests/install",
    "tests/npm",
    "tests/ros/reader",
    "bindings/ros",
    "build",
    "viewer/node_modules",
    "tests/architecture/check_packages",
)
COMMENT = re.compile(r"(?:^\s*|\s{2})(?:#|//) .*$", re.MULTILINE)
LONG_TEXT = re.compile(r'(^\s*)?""".*?"""', re.MULTILINE | re.DOTALL)  # a docstring begins its line
IMPORT = re.compile(r'^\s*(?:import|from) (\w+)\b(?! from ")', re.MULTILINE)
IMPORT_OF_NODE = re.compile(r'^import .* from "[./\w]*?(\w+\.mjs)";', re.MULTILINE)
FIND = re.compile(r"\b(find_(?:package|program|path|library)|pkg_check_modules)\(([^)]*)\)")
STARTED = re.compile(r'(?:subprocess\.\w+|spawn|execFileSync)\(\[?\s*"([\w.+-]+)"')
TRIED = re.compile(r'shutil\.which\("([\w.+-]+)"\)')
QUOTED = re.compile(r'"(?:/usr/bin/)?([\w.+-]+)[" ]')
# Arrays and texts.
NO_COMMANDS = re.compile(
    r"""\w+\+?=\([^)]*\)|(?<=[=\s])"(?:[^"$\n]|\$(?!\())*"|'[^'\n]*'|<<END$.*?^END$""", re.MULTILINE | re.DOTALL
)
FUNCTION = re.compile(r"^([\w-]+)\(\)", re.MULTILINE)
COMMAND = re.compile(
    r"(?:^\s*|\$\(|[|&;{]\s+|\b(?:if|then|do|else|while|exec)\s+)(?:!\s+)?(?:\w+=[^\s(]*\s+)*"
    r"([a-z][\w.+-]*)(?=[\s;]|$|\)(?!\s))",
    re.MULTILINE,
)


def groups_of(setup):
    """group -> its packages"""
    rows = re.findall(r"^  (\w+)\) packages=\(([^)]*)\)", setup, re.MULTILINE)
    return {group: packages.split() for group, packages in rows}


def targets_of(makefile):
    """target -> its recipe, after those of what it depends on"""
    rows = re.findall(r"^([\w-]+):(.*)\n((?:\t.*\n)*)", makefile, re.MULTILINE)
    rules = {name: (needs.split() + re.findall(r"\$\(MAKE\) (\w+)", recipe), recipe) for name, needs, recipe in rows}

    def recipes(name):
        needs, recipe = rules[name]
        return "".join(map(recipes, needs)) + recipe

    return {name: recipes(name) for name in rules}


def is_of_cmake(name):
    return name.endswith(("CMakeLists.txt", ".cmake"))


def texts_of(root):
    """file -> its text without comments, of all that find or run something"""
    texts = {}
    paths = [path for folder in FOLDERS for path in (root / folder).rglob("*")]
    for path in [*paths, *root.rglob("CMakeLists.txt"), *root.rglob("*.cmake")]:
        name = str(path.relative_to(root))
        if path.is_file() and not name.startswith(LEFT_OUT):
            text = LONG_TEXT.sub(lambda found: found[0] if found[1] is None else "", path.read_text(errors="replace"))
            text = COMMENT.sub("", text)
            if path.suffix in (".py", ".mjs", ".cpp") or text.startswith("#!") or is_of_cmake(name):
                texts[name] = text
    return texts


@functools.cache
def known_as(name):
    """By what a text reaches a file: its path, one of its folders, an import. What is in tests is run by ctest."""
    folders = ["/".join(name.split("/")[:depth]) for depth in range(2, name.count("/") + 1)]
    return {name, *folders, f"import {name.split('/')[-1]}"} | ({"ctest"} if name.startswith("tests/") else set())


@functools.cache
def mentioned(text):
    imported = [f"import {name}.py" for name in IMPORT.findall(text)]
    imported += [f"import {name}" for name in IMPORT_OF_NODE.findall(text)]
    return {word.strip("./") for word in re.findall(r"[\w./-]+", text)} | set(imported)


def reached(recipe, texts):
    """The files of a target. cmake reads all of its files, whatever the target; what they name is run by ctest."""
    scripts = {name for name in texts if not is_of_cmake(name)}
    found, open_ends = set(), [recipe]
    while open_ends:
        mentions = mentioned(open_ends.pop())
        new = {name for name in scripts - found if not mentions.isdisjoint(known_as(name))}
        found |= new
        open_ends += [texts[name] for name in new]
    return found | (set(texts) - scripts if "cmake --preset" in recipe else set())


def found_by_cmake(text):
    """(name, is it needed)"""
    for function, arguments in FIND.findall(text):
        words = arguments.split()
        name = {"find_package": words[0], "pkg_check_modules": words[-1]}.get(function, words[1])
        yield name, "REQUIRED" in words


def used_in_program(text):
    """(name, is it needed) of a program in Python, JavaScript or C++"""
    names = set(IMPORT.findall(text)) | set(STARTED.findall(text)) | (set(QUOTED.findall(text)) & PACKAGE_OF.keys())
    tried = set(TRIED.findall(text))
    return {(name, name not in tried) for name in names - sys.stdlib_module_names - MODULES_OF_OTHERS}


def used_in_shell(text):
    """(name, is it needed) of a script for bash or of a recipe"""
    functions = set(FUNCTION.findall(text))
    text = NO_COMMANDS.sub("", text)
    words = set(re.findall(r"(?<![\w./$-])[\w.+-]+(?![\w/=-])", text))
    return {(name, True) for name in (words & PACKAGE_OF.keys()) | set(COMMAND.findall(text)) - functions}


@functools.cache
def uses(name, text):
    """(name, its package or None, is it needed) of all that a file uses"""
    if is_of_cmake(name):
        found = set(found_by_cmake(text))
    elif name.endswith((".py", ".mjs", ".cpp")) or "python3" in text.split("\n")[0]:
        found = used_in_program(text)
    else:
        found = used_in_shell(text)
    named = [(used, PACKAGE_OF.get(used), is_needed) for used, is_needed in found if used not in BARE]
    traces = [trace for trace in TRACES if trace in text]
    return named + [(trace, package, True) for trace in traces for package in TRACES[trace].split()]


def steps(makefile, texts):
    """(who, groups that are installed, file -> text) of each target, and of what no target runs"""
    by_hand = dict(texts)
    for target, recipe in targets_of(makefile).items():
        files = {name: texts[name] for name in reached(recipe, texts)}
        by_hand = {name: text for name, text in by_hand.items() if name not in files}
        installed = re.findall(r"scripts/setup (\w+)", recipe)
        yield f"make {target}", installed, {"Makefile": recipe, **files}
    yield "who runs it by hand", [], by_hand


def violations(setup, steps_of_targets, texts):
    groups = groups_of(setup)
    everything = {package for packages in groups.values() for package in packages}
    own_modules = {name.removesuffix("/__init__.py").split("/")[-1].removesuffix(".py") for name in texts}
    idle = {(group, package) for group, packages in groups.items() for package in packages}
    lacking = defaultdict(list)
    for who, installed, files in steps_of_targets:
        group_of = {package: group for group in reversed(installed) for package in groups.get(group, [])}
        for name, text in files.items():
            for what, package, is_needed in uses(name, text):
                idle.discard((group_of.get(package), package))
                if what not in own_modules and package not in (group_of if is_needed and installed else everything):
                    lacking[name, what, package or "a package that is not in the table"].append(who)
    for (name, what, package), who in sorted(lacking.items()):
        yield f"{name} uses {what} of {package}, which is in no group of {', '.join(who)}"
    for group, package in sorted(idle):
        yield f"scripts/setup {group} installs {package}, which nothing uses"


def main():
    root = Path(sys.argv[1])
    texts = texts_of(root)
    found = list(violations((root / "scripts/setup").read_text(), steps((root / "Makefile").read_text(), texts), texts))
    print("\n".join(found) if found else "each target installs what it uses")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
