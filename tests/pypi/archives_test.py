# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""What build_backend.py packs: the archive of the sources, and a wheel of a folder.

Usage: archives_test.py BUILD"""

import base64
import csv
import filecmp
import hashlib
import importlib.machinery
import io
import json
import subprocess
import sys
import tarfile
import tempfile
import types
import unittest
import unittest.mock
import zipfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "bindings/python"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import bill_of_materials
import build_backend
import components

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv.pop(1))


class Archives(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def folder(self, name):
        (self.work / name).mkdir()
        return self.work / name

    def wheel(self, name):
        contents = self.work / "contents"
        (contents / "dermis-9.data/scripts").mkdir(parents=True, exist_ok=True)
        (contents / "dermis-9.data/scripts/dermis").write_bytes(b"\x7fELF")
        (contents / "dermis-9.data/scripts/dermis").chmod(0o755)
        (contents / "module.py").write_text("text\n")
        folder = self.folder(name)
        return folder / build_backend.pack_wheel(contents, folder, "py3-none-any", {"zlib": b"free"}, ">=3.9,<3.15")

    def test_the_archive_of_the_sources_has_what_git_has(self):
        with tarfile.open(self.work / build_backend.build_sdist(self.work)) as archive:
            names = {name.split("/", 1)[1] for name in archive.getnames()}
            about = archive.extractfile(f"dermis-{build_backend.version()}/PKG-INFO").read().decode()
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        self.assertEqual(names - {"PKG-INFO"}, {name for name in listed.splitlines() if (ROOT / name).exists()})
        self.assertIn("Name: dermis", about)

    def test_the_same_sources_give_the_same_bytes_also_from_their_archive(self):
        first, again, copied = self.folder("first"), self.folder("again"), self.folder("copied")
        name = build_backend.build_sdist(first)
        build_backend.build_sdist(again)
        with tarfile.open(first / name) as archive:
            archive.extractall(self.work)
        unpacked = self.work / name.removesuffix(".tar.gz")
        program = "import build_backend, sys; build_backend.build_sdist(sys.argv[1])"
        subprocess.run([sys.executable, "-B", "-c", program, copied], cwd=unpacked / "bindings/python", check=True)
        self.assertTrue(filecmp.cmp(first / name, again / name, shallow=False))
        self.assertTrue(filecmp.cmp(first / name, copied / name, shallow=False))

    def test_the_same_contents_give_the_same_bytes_of_a_wheel(self):
        self.assertTrue(filecmp.cmp(self.wheel("first"), self.wheel("again"), shallow=False))

    def test_a_wheel_says_what_is_in_it_and_what_can_be_run(self):
        with zipfile.ZipFile(self.wheel("one")) as wheel:
            modes = {entry.filename: entry.external_attr >> 16 & 0o777 for entry in wheel.infolist()}
            info = build_backend.info()
            rows = list(csv.reader(io.TextIOWrapper(wheel.open(f"{info}/RECORD"))))
            for name, digest, size in rows[:-1]:
                content = wheel.read(name)
                self.assertEqual(
                    base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("="), digest[7:]
                )
                self.assertEqual(int(size), len(content))
            self.assertEqual([row[0] for row in rows], wheel.namelist())
            self.assertIn("Requires-Python: >=3.9,<3.15\n", wheel.read(f"{info}/METADATA").decode())
            self.assertEqual(wheel.read(f"{info}/licenses/zlib"), b"free")
        self.assertEqual({name for name, mode in modes.items() if mode == 0o755}, {"dermis-9.data/scripts/dermis"})

    def test_pythons_without_a_module_are_excluded(self):
        self.assertEqual(build_backend.pythons_of([9, 10, 12, 14]), ">=3.9,!=3.11.*,!=3.13.*,<3.15")

    def test_headers_of_pybind11_are_those_of_version_2(self):
        there = types.ModuleType("pybind11")
        there.__spec__ = importlib.machinery.ModuleSpec("pybind11", None)
        there.get_cmake_dir = lambda: "/there"
        for version, taken in (((2, 13, 6), ["-Dpybind11_DIR=/there"]), ((3, 0, 1), [])):
            there.version_info, there.__version__ = version, ".".join(map(str, version))
            with unittest.mock.patch.dict(sys.modules, {"pybind11": there}):
                self.assertEqual(build_backend.headers_of_pybind11(), taken)

    def test_the_bill_of_materials_has_what_the_build_compiled_and_linked(self):
        parts = components.components(BUILD, ["dermis_cli"])
        bill = bill_of_materials.document("9", "2026-01-01T00:00:00Z", parts)
        names = {package["name"] for package in bill["packages"]}
        self.assertLessEqual({"dermis", "zlib", "libzstd", "eigen3", "boost1.74", "gcc-12", "three"}, names)
        self.assertNotIn("googletest", names)
        known = {package["SPDXID"] for package in bill["packages"]} | {"SPDXRef-DOCUMENT"}
        self.assertEqual(len(known), len(bill["packages"]) + 1)
        for relation in bill["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, known)
        licenses = {text["licenseId"]: text["extractedText"] for text in bill["hasExtractedLicensingInfos"]}
        for package in bill["packages"][1:]:
            self.assertRegex(package["versionInfo"], r"\d")
            self.assertGreater(len(licenses[package["licenseDeclared"]]), 500, package["name"])
        json.dumps(bill)


if __name__ == "__main__":
    unittest.main(verbosity=2)
