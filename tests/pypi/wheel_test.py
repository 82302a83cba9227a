# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The package as a wheel runs in a bare virtual environment, and gives the bits of the command.

Usage: wheel_test.py DERMIS PACKAGE VENV, the last of which is kept"""

import importlib.machinery
import subprocess
import sys
import tarfile
import types
import unittest.mock
import zipfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "command_line"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "bindings/python"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import bare
import build_backend
import support
import wheels

ROOT = Path(__file__).resolve().parents[2]
PACKAGE, VENV = (Path(sys.argv.pop(2)) for _ in range(2))
NUMPY = "1.26.4"  # the last before numpy 2, with which the other tests run


class Wheel(bare.BareTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        raw = build_backend.pack_wheel(PACKAGE, cls.root, wheels.licenses_of(PACKAGE))
        cls.wheel = wheels.repair(Path(sys.prefix), cls.root / raw, cls.root / "repaired")
        cls.python = bare.environment(sys.executable, NUMPY, VENV)
        bare.install(cls.python, cls.wheel)

    def test_its_libraries_are_inside_and_it_gives_the_bits_of_the_command(self):
        self.assert_gives_the_bits_of_the_command(self.python)

    def test_it_has_the_licenses_of_its_libraries(self):
        names = zipfile.ZipFile(self.wheel).namelist()
        licenses = {name.split("/")[-1] for name in names if "/licenses/" in name}
        self.assertLessEqual({"libhdf5-103-1", "libcairo2"}, licenses)

    def test_the_archive_of_the_sources_has_what_git_has(self):
        with tarfile.open(self.work / build_backend.build_sdist(self.work)) as archive:
            names = {name.split("/", 1)[1] for name in archive.getnames()}
            about = archive.extractfile(f"dermis-{build_backend.version()}/PKG-INFO").read().decode()
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        self.assertEqual(names - {"PKG-INFO"}, {name for name in listed.splitlines() if (ROOT / name).exists()})
        self.assertIn("Name: dermis", about)

    def test_headers_of_pybind11_are_those_of_version_2(self):
        there = types.ModuleType("pybind11")
        there.__spec__ = importlib.machinery.ModuleSpec("pybind11", None)
        there.get_cmake_dir = lambda: "/there"
        for version, taken in (((2, 13, 6), ["-Dpybind11_DIR=/there"]), ((3, 0, 1), [])):
            there.version_info, there.__version__ = version, ".".join(map(str, version))
            with unittest.mock.patch.dict(sys.modules, {"pybind11": there}):
                self.assertEqual(build_backend.headers_of_pybind11(), taken)


if __name__ == "__main__":
    support.main()
